"""What doubtful inputs leave of a result: damping curves and boundaries of a Latin hypercube of designs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from benchmarks.paper_figures.mode_following import follow_support_modes, support_names, support_share
from proprotor.errors import InputError
from proprotor.needs import check_memory
from proprotor.stability.modes import eigensystem
from proprotor.typing import Array

if TYPE_CHECKING:
    from proprotor.case import Case
    from proprotor.model.linear_model import LinearModel
    from proprotor.stability.modes import Eigensystem

PERCENTILES = (5, 50, 95)
_BYTES_PER_POINT = 200.0  # of what is kept: eigenvalues of the modes of a support, and their damping
_CHUNK = 2500  # points analysed at once, for the sake of memory
_OF_THE_SUPPORT = 0.1  # participation of the support from which on a mode counts for the boundary


@dataclass(frozen=True, kw_only=True)
class InputRange:
    """Between what an input may lie, and why.

    Attributes
    ----------
    name : str
        What varies, for tables.
    paths : tuple of str
        Numbers of the deck that vary together.
    low, high : float
        In `unit`.
    unit : str
        Of `low` and `high`; ``"×"`` for factors on what the deck has.
    reason : str
        Why the input may be anywhere in the range.
    logarithmic : bool
        Whether all factors between the ends are equally likely, rather than all differences.
    """

    name: str
    paths: tuple[str, ...]
    low: float
    high: float
    unit: str
    reason: str
    logarithmic: bool = False

    def at(self, share: ArrayLike) -> Array:
        """The value in `unit` below which a share of the range lies, 0 to 1."""
        share = np.asarray(share)
        if self.logarithmic:
            return self.low * (self.high / self.low) ** share
        return self.low + (self.high - self.low) * share

    def __str__(self) -> str:
        unit = "times" if self.unit == "×" else self.unit
        return f"{self.low:g} to {self.high:g} {unit}".strip()


@dataclass(frozen=True, eq=False)
class Band:
    """Damping and boundaries of a sample of designs.

    Attributes
    ----------
    airspeed : array (airspeeds,)
        m/s.
    modes : tuple of str
        Of the support.
    damping : array (designs, airspeeds, modes)
        Damping ratio, NaN where a point failed.
    least_damping : array (designs, airspeeds)
        Of all modes in which the support takes part with a tenth or more, whatever their name.
    values : dict of array (designs,)
        SI values of the sampled numbers by deck path.
    """

    airspeed: Array
    modes: tuple[str, ...]
    damping: Array
    least_damping: Array
    values: Mapping[str, Array]

    def percentiles(self, mode: str, percent: Sequence[float] = PERCENTILES) -> Array:
        """Damping ratio (percentiles, airspeeds) of a mode, each airspeed by itself."""
        return np.nanpercentile(self.damping[..., self.modes.index(mode)], percent, axis=0)

    def boundaries(self, mode: str | None = None) -> Array:
        """Boundary (designs,) in m/s of a mode, or of the first one that moves the support; infinite beyond the end."""
        damping = self.least_damping if mode is None else self.damping[..., self.modes.index(mode)]
        return boundary(self.airspeed, damping)

    def boundary_percentiles(self, mode: str | None = None, percent: Sequence[float] = PERCENTILES) -> Array:
        """Percentiles of `boundaries`, m/s."""
        return np.percentile(self.boundaries(mode), percent, method="inverted_cdf")


def boundary(airspeed: Array, damping: Array) -> Array:
    """Lowest airspeed (...) at which damping (..., airspeeds) falls through zero, by linear interpolation.

    Infinite where it does not; the first airspeed where it is negative there already.
    """
    falls = (damping[..., :-1] > 0) & (damping[..., 1:] <= 0)
    first = falls.argmax(axis=-1)
    above, below = (np.take_along_axis(damping, (first + step)[..., None], -1)[..., 0] for step in (0, 1))
    with np.errstate(all="ignore"):
        place = airspeed[first] + above / (above - below) * (airspeed[first + 1] - airspeed[first])
    found = np.where(falls.any(axis=-1), place, np.inf)
    return np.where(damping[..., 0] < 0, airspeed[0], found)


def least_damping(model: LinearModel, system: Eigensystem | None = None) -> Array:
    """Lowest damping ratio (...) of all modes in which the support takes part; NaN at failed points."""
    system = eigensystem(model) if system is None else system
    shares = support_share(model, system).sum(axis=-2)
    with np.errstate(all="ignore"):
        ratio = -system.values.real / np.abs(system.values)
    counts = (shares >= _OF_THE_SUPPORT) & (system.values.imag > 0)
    least = np.where(counts, ratio, np.inf).min(axis=-1)
    return np.where(np.isfinite(least), least, np.nan)


def sample(case: Case, ranges: Sequence[InputRange], count: int, seed: int = 0) -> dict[str, Array]:
    """A Latin hypercube of `count` designs: SI values (count,) by deck path.

    Raises
    ------
    InputError
        When a range names no number of the deck.
    """
    from scipy.stats import qmc  # here, because it takes long to import

    from proprotor.deck.vary import design_inputs

    known = design_inputs(case)
    shares = qmc.LatinHypercube(len(ranges), rng=seed).random(count)
    factors: dict[str, Array] = {}
    for one, share in zip(ranges, shares.T, strict=True):
        for path in one.paths:
            if path not in known:
                raise InputError(path, one.name, f"is no number of the deck {case.name}")
            factors[path] = factors.get(path, 1.0) * _relative(one, share, known[path])
    return {path: _si(known[path].si, factor) for path, factor in factors.items()}


def _relative(one: InputRange, share: Array, number: Any) -> Array:
    """Values of a range as factors on the deck's number; themselves in SI where that number is zero."""
    from proprotor.units import factor_to_si

    value = one.at(share)
    if one.unit == "×":
        return value
    si = value * (factor_to_si(one.unit, one.unit, number.unit) if one.unit else 1.0)
    return si / number.si if number.si else si


def _si(deck: float, factor: Array) -> Array:
    return deck * factor if deck else factor


def damping_band(
    case: Case,
    airspeeds: Array,
    ranges: Sequence[InputRange],
    *,
    count: int = 300,
    seed: int = 0,
    advance: Callable[[float], object] = lambda share: None,
    **options: Any,
) -> Band:
    """Damping of the support's modes for a Latin hypercube of designs.

    Parameters
    ----------
    case : Case
        Made from a deck.
    airspeeds : array (airspeeds,)
        m/s, rising.
    ranges : sequence of InputRange
    count : int
        Number of designs.
    seed : int
    advance : callable
        Told the share of the work done since it was told last.
    **options
        See `proprotor.rotor.options.Options`.

    Raises
    ------
    InputError
        For a range of no number of the deck, an option that does not exist, or more than there is memory for.
    """
    points = float(count * len(airspeeds))
    check_memory("count", count, _BYTES_PER_POINT * points, f"the damping of {points:.4g} points")
    values = sample(case, ranges, count, seed)
    size = max(1, _CHUNK // len(airspeeds))
    followed, least = [], []
    for start in range(0, count, size):
        some = {path: array[start : start + size, None] for path, array in values.items()}
        model = case.vary(some).linearize(airspeeds, **options)
        system = eigensystem(model)
        followed.append(follow_support_modes(model, system))
        least.append(least_damping(model, system))
        advance(min(size, count - start) / count)
    values_of_modes = np.concatenate(followed)
    damping = -values_of_modes.real / np.abs(values_of_modes)
    return Band(airspeeds, support_names(model), damping, np.concatenate(least), values)
