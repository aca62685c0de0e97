"""Flutter speeds that lie beyond the airspeeds of a study: what is known of each is a limit, which is a result too.

The flutter speed of a design that no mode makes unstable lies above the airspeeds that were analysed, and the one of a
design that is unstable at the lowest airspeed lies below. Statistics call such values censored.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from proprotor.errors import InputError
from proprotor.study.variables import ABOVE, BELOW, STABLE, UNSTABLE
from proprotor.typing import Array, Dataset

_SPEED = "flutter_speed"


class Bounds(NamedTuple):
    """What is known of a result of each design: an interval, whose ends are equal where the result is a number.

    Parameters
    ----------
    low, high : array (designs,)
        In SI; -inf or inf where nothing is known on that side, NaN for a design that failed.
    """

    low: Array
    high: Array

    @property
    def failed(self) -> Array:
        """Designs (designs,) of which nothing is known."""
        return np.isnan(self.low)

    @property
    def known(self) -> Array:
        """Designs (designs,) whose result is a number."""
        return np.asarray(np.isfinite(self.low) & (self.low == self.high))

    @property
    def above(self) -> Array:
        """Designs (designs,) whose result lies above a limit."""
        return np.isposinf(self.high)

    @property
    def below(self) -> Array:
        """Designs (designs,) whose result lies below a limit."""
        return np.isneginf(self.low)


def bounds_of(results: Dataset, of: str) -> Bounds:
    """Return what is known of a result of each design.

    Parameters
    ----------
    results : xarray.Dataset
        Of `proprotor.study`.
    of : str
        A variable with one number for each design.

    Raises
    ------
    InputError
        For flutter speeds without the limits of those that lie beyond the airspeeds, as earlier versions wrote them.
    """
    values = np.asarray(results[of].values, dtype=float)
    low, high = values.copy(), values.copy()
    if of != _SPEED:
        return Bounds(low, high)
    if not {ABOVE, BELOW} <= set(results.data_vars):
        raise InputError("results", None, f"must have the variables {ABOVE} and {BELOW}: run the study again")
    least, most = (np.asarray(results[name].values, dtype=float) for name in (ABOVE, BELOW))
    above, below = (
        np.isfinite(least),
        np.isfinite(most),
    )  # below also where another mode follows at a higher speed
    low[above], high[above] = least[above], np.inf
    low[below], high[below] = -np.inf, most[below]
    return Bounds(low, high)


def put_limits(found: dict[str, Array], speeds: Array) -> None:
    """Put the limits of flutter speeds that lie beyond the airspeeds of a batch in their places.

    A failed airspeed ends what is known to be stable: the limit is the last airspeed before the failed one.

    Parameters
    ----------
    found : dict of array
        The variables of the batch, with reasons (designs, speeds) and notes (designs,).
    speeds : array (speeds,)
        m/s, rising.
    """
    works = found["reason"] == ""
    first = works.argmax(axis=1)
    begun = np.arange(works.shape[1]) >= first[:, None]
    ended = begun & ~works
    last = np.where(ended.any(axis=1), ended.argmax(axis=1), works.shape[1]) - 1
    notes = found["flutter_note"].astype(str)
    stable = np.char.startswith(notes, STABLE) & np.isnan(found["flutter_speed"])
    unstable = notes == UNSTABLE
    found[ABOVE][stable] = speeds[last[stable]]
    found[BELOW][unstable] = speeds[first[unstable]]
