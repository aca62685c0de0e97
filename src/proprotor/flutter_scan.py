"""The lowest airspeed at which each of many designs becomes unstable: scanned, then refined for all at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from proprotor.arrays import Array

TOLERANCE = 1e-5  # m/s, on the airspeed
NOT_UNSTABLE = 1e-9  # of the largest eigenvalue: a growth below that is rounding of a neutral root
STABLE = "stable throughout"
UNSTABLE = "unstable at the lowest airspeed"
_MOST_STEPS = 100

Growth = Callable[[Array, Array], Array]  # rows and airspeeds (m,) to the growth of each, 1/s


class Brackets(NamedTuple):
    """Two neighbouring airspeeds of the scan for each design, with the growth at both, and where there are none why.

    low, high, growth_low, growth_high (designs,), NaN without a bracket; note (designs,) of str, empty with one.
    """

    low: Array
    high: Array
    growth_low: Array
    growth_high: Array
    note: Array


def brackets(growth: Array, airspeed: Array, reason: Array, neutral: Array) -> Brackets:
    """First step of the scan over which the growth turns positive.

    Parameters
    ----------
    growth : array (designs, speeds)
        Largest real part, 1/s; NaN where a speed failed: failed speeds are passed over.
    airspeed : array (speeds,)
        Increasing, m/s.
    reason : array (designs, speeds) of str
        Why a speed failed.
    neutral : array (designs, speeds)
        Growth that does not count, 1/s.
    """
    ends = np.full((4, len(growth)), np.nan)
    note = np.full(len(growth), "", dtype=object)
    for row, line in enumerate(growth):
        good = np.flatnonzero(np.isfinite(line))
        unstable = line[good] > neutral[row, good]
        crossings = np.flatnonzero(~unstable[:-1] & unstable[1:])
        if not len(good):
            note[row] = reason[row, 0] or "no airspeed could be analysed"
        elif unstable[0]:
            note[row] = UNSTABLE
        elif not len(crossings):
            note[row] = STABLE + _beyond(np.flatnonzero(np.isnan(line)), airspeed, reason[row])
        else:
            last, first = good[crossings[0]], good[crossings[0] + 1]
            ends[:, row] = airspeed[last], airspeed[first], line[last], line[first]
    low, high, growth_low, growth_high = ends
    return Brackets(low, high, growth_low, growth_high, note)


def _beyond(failed: Array, airspeed: Array, reason: Array) -> str:
    """What leaves open whether a design is stable."""
    if not len(failed):
        return ""
    return f"; {len(failed)} airspeeds failed, at {airspeed[failed[0]]:.6g} m/s: {reason[failed[0]]}"


def refine(found: Brackets, growth: Growth, tolerance: float = TOLERANCE) -> Array:
    """Airspeed (designs,) at which the growth vanishes, within the tolerance; NaN without a bracket or a value.

    Chandrupatla's method (Advances in Engineering Software 28, 1997) on all designs at once: inverse quadratic
    interpolation where that is safe, else bisection. The end of a converged bracket with the smaller growth is taken.
    """
    newest, best = found.low.copy(), found.low.copy()
    other, before = found.high.copy(), found.high.copy()
    at_newest, at_other, at_before = (
        found.growth_low.copy(),
        found.growth_high.copy(),
        found.growth_high.copy(),
    )
    share = _first_share(at_newest, at_other)
    active = np.flatnonzero(np.isfinite(newest))
    for _ in range(_MOST_STEPS):
        if not len(active):
            break
        trial = newest[active] + share[active] * (other - newest)[active]
        at_trial = growth(active, trial)
        same = np.sign(at_trial) == np.sign(at_newest[active])
        before[active] = np.where(same, newest[active], other[active])
        at_before[active] = np.where(same, at_newest[active], at_other[active])
        other[active] = np.where(same, other[active], newest[active])
        at_other[active] = np.where(same, at_other[active], at_newest[active])
        newest[active], at_newest[active] = trial, at_trial
        closest = np.abs(at_newest[active]) < np.abs(at_other[active])
        best[active] = np.where(closest, newest[active], other[active])
        best[active[np.isnan(at_trial)]] = np.nan
        width = np.abs(other - newest)[active]
        done = (width <= tolerance) | (at_trial == 0) | np.isnan(at_trial)
        share[active] = _share(
            *(array[active] for array in (newest, other, before, at_newest, at_other, at_before)),
            least=np.minimum(0.5, 0.5 * tolerance / np.where(width > 0, width, 1)),
        )
        active = active[~done]
    best[active] = np.nan
    return best


def _first_share(at_low: Array, at_high: Array) -> Array:
    """Where the straight line between the ends vanishes, kept off them."""
    with np.errstate(all="ignore"):
        share: Array = np.clip(at_low / (at_low - at_high), 0.05, 0.95)
    return share


def _share(
    newest: Array,
    other: Array,
    before: Array,
    at_newest: Array,
    at_other: Array,
    at_before: Array,
    *,
    least: Array,
) -> Array:
    """Part of the way from the newest point to the other end of the bracket, where to look next."""
    with np.errstate(all="ignore"):
        x = (newest - other) / (before - other)
        y = (at_newest - at_other) / (at_before - at_other)
        safe = (1 - np.sqrt(1 - x) < y) & (y < np.sqrt(x))
        of_other = at_newest / (at_other - at_newest) * at_before / (at_other - at_before)
        of_before = at_newest / (at_before - at_newest) * at_other / (at_before - at_other)
        step = of_other + (before - newest) / (other - newest) * of_before
    return np.clip(np.where(safe & np.isfinite(step), step, 0.5), least, 1 - least)
