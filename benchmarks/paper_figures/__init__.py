"""The analytical figures of AIAA-2002-1604, made with this model.

    python -m benchmarks.paper_figures --out figures

From the top down: `command` is that program; `catalogue` knows which figure shows what; `analyses` keeps what figures
share; `wing_modes` has the damping and boundaries of a wing's modes, `sample_band` those of a sample of
`input_ranges`, `blade_state` trim, couplings and the rotor on a rigid hub; `content` is a figure before it is drawn and
`drawing` draws it; `published` holds numbers of other sources.
"""

from benchmarks.paper_figures.analyses import Analyses
from benchmarks.paper_figures.catalogue import NUMBERS, make_figure
from benchmarks.paper_figures.content import Content, Curve, csv_of

__all__ = ["NUMBERS", "Analyses", "Content", "Curve", "csv_of", "make_figure"]
