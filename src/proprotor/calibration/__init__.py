"""Model and test: the values of a few inputs with which the modes of a case fit test points best.

In come a case, test points with error bars (`tables.points`) and the inputs that may vary; out come the values, their
covariance, what the points do not tell, and a deck with the values.

    targets          the numbers of test points that a mode of the case has to meet
    predicted        these numbers by the model, with their exact derivatives by the inputs
    identifiability  which combinations of inputs the points do not tell
    calibrate        the fit by weighted least squares, as a dataset with the calibrated case
    calibrated_deck  the deck of the calibrated case, with the provenance of its numbers
    modal_comparison    measured modes of the structure beside those of the model

The room may import the rooms above it, from `errors` to `tables`.
"""

from proprotor.calibration.calibrate import Calibration, calibrate
from proprotor.calibration.calibrated_deck import calibrated_deck
from proprotor.calibration.modal_comparison import compare_modes

__all__ = ["Calibration", "calibrate", "calibrated_deck", "compare_modes"]
