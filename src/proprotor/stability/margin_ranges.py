"""The airspeeds over which control loops keep the margins that are needed, to a hundredth of a knot."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from proprotor.model.configuration import Configuration
from proprotor.model.options_of_result import options_of
from proprotor.stability.margins import margins
from proprotor.typing import Array, Dataset

_CLOSE = 0.005  # m/s
_MARGINS = ("gain margin", "phase margin")


class Needed(NamedTuple):
    """What a loop must keep: decibels of gain, either way, and phase in rad."""

    gain: float = 6.0
    phase: float = math.pi / 4

    @property
    def text(self) -> str:
        """The margins in words, such as "6 dB and 45 deg"."""
        return f"{self.gain:g} dB and {math.degrees(self.phase):g} deg"


class Kept(NamedTuple):
    """A range of airspeeds over which a loop keeps the margins that are needed.

    Attributes
    ----------
    loop : str
    start, stop : float
        m/s, to a hundredth of a knot where the range ends within the airspeeds that were analysed.
    open_start, open_stop : bool
        Whether the range goes on beyond the airspeeds that were analysed.
    lost_by : str
        What is too small above the range: "gain margin", "phase margin", or "instability"; empty where it goes on.
    """

    loop: str
    start: float
    stop: float
    open_start: bool
    open_stop: bool
    lost_by: str


def decibels(found: Dataset) -> Array:
    """Return the gain margin (airspeed, loop) in dB: the smaller of what factors above and below 1 allow."""
    with np.errstate(divide="ignore"):
        up, down = (20 * np.log10(found[name].values) for name in ("gain_margin", "gain_reduction"))
    return np.asarray(np.minimum(up, -down))


def kept_ranges(
    case: Configuration, found: Dataset, needed: Needed | None = None, **options: Any
) -> list[Kept]:
    """Return the ranges of airspeeds over which each loop keeps the margins that are needed.

    Ranges are those of the airspeeds of the result; each end between two airspeeds is then looked for by halving. What
    comes and goes between two airspeeds is not seen. Where the closed loop is unstable no margin is kept.

    Parameters
    ----------
    case : Case
        The case of the result.
    found : xarray.Dataset
        Of `Case.margins`.
    needed : Needed
        6 dB and 45° by default.
    **options
        Options of the model that the result cannot repeat by itself, see `proprotor.model.options_of_result`.

    Returns
    -------
    list of Kept
        By loop, then by airspeed.

    Raises
    ------
    InputError
        For another case than that of the result.
    """
    own, needed = options_of(found.attrs, case, options), needed or Needed()
    return [
        kept
        for place, loop in enumerate(found.loop.values.tolist())
        for kept in _ranges(_Search(case, own, needed, place), found, loop)
    ]


class _Search(NamedTuple):
    """What is searched: a case with options, the margins that are needed, and the place of a loop."""

    case: Configuration
    options: Mapping[str, Any]
    needed: Needed
    place: int

    def spare(self, found: Dataset) -> Array:
        """Return how much of both margins (2, airspeed) is left, as a part of what is needed; -1 where unstable."""
        parts = np.stack(
            [
                decibels(found)[:, self.place] / self.needed.gain,
                found.phase_margin.values[:, self.place] / self.needed.phase,
            ]
        )
        return np.asarray(np.clip(np.nan_to_num(parts, nan=0.0, posinf=2.0) - 1, -1.0, 1.0))

    def end(self, kept: float, lost: float) -> float:
        """Return the airspeed at which the margins just suffice, between one where they do and one where not."""
        while abs(kept - lost) > _CLOSE:
            middle = (kept + lost) / 2
            here = margins(self.case, np.array([middle]), **self.options)
            kept, lost = (middle, lost) if self.spare(here).min() >= 0 else (kept, middle)
        return kept


def _ranges(search: _Search, found: Dataset, loop: str) -> Iterator[Kept]:
    """Yield the ranges of one loop."""
    speeds, spare = found.airspeed.values, search.spare(found)
    good = np.concatenate([[False], spare.min(axis=0) >= 0, [False]])
    edges = np.flatnonzero(np.diff(good.astype(int))).reshape(-1, 2)
    for first, after in edges.tolist():
        open_start, open_stop = first == 0, after == len(speeds)
        start = speeds[0] if open_start else search.end(speeds[first], speeds[first - 1])
        stop = speeds[-1] if open_stop else search.end(speeds[after - 1], speeds[after])
        yield Kept(loop, float(start), float(stop), open_start, open_stop, _lost(search, stop, open_stop))


def _lost(search: _Search, stop: float, open_stop: bool) -> str:
    """Return what is too small above the end of a range."""
    if open_stop:
        return ""
    above = margins(search.case, np.array([stop + _CLOSE]), **search.options)
    return _MARGINS[int(search.spare(above)[:, 0].argmin())] if above.stable.values[0] else "instability"
