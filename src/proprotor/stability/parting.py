"""Where steps are to be parted, until the ends of each step tell how often every root crosses the level.

The growth G of a root over a step is the cubic that has values and slopes of its ends, with a band about the cubic that
is as wide as the cubic is likely to be wrong: zero at the ends, widest in the middle. A step is settled when every line
within the band crosses the level as often as its ends say, once or not at all; otherwise it is parted where the band
leaves it open. Two roots that cannot be told apart are judged together: `proprotor.stability.root_pairs`. As long as
nothing better is known the width of the band is a share of how far the cubic bends away from the straight line, and
after a parting the error of the cubic at the new point.
"""

from __future__ import annotations

import numpy as np

from proprotor.stability.cubic import band, bend, hermite, hermite_extrema, hermite_slope
from proprotor.stability.matching import POOR
from proprotor.stability.points import Points
from proprotor.stability.root_pairs import (
    PairsWithin,
    by_derivatives,
    joining_roots,
    keep_off,
    may_meet,
)
from proprotor.stability.steps import Ends, Steps
from proprotor.typing import Array

_UNSEEN = 0.5  # of the bend: error of a cubic that nothing was compared with
_SEEN = 0.1  # of the bend: least error of a cubic that was compared with a point within its step
_FOR_NAMES = 7  # halvings of a step whose roots cannot be told apart: of 5 kt, to 0.04 kt
_NEAR_LEVEL = 15  # halvings where such a root comes near the level: of 70 kt, to 0.002 kt
_GRID = np.linspace(0.0, 1.0, 17)[1:-1]
_DEEPEST_JOINT = 12  # partings of a step to find where two real roots join
_EDGE = 0.04  # of a step: a new point stays that far from its ends


def where_to_part(
    steps: Steps,
    points: Points,
    names: bool,
    level: float = 0.0,
    trust: float = 1.0,
    pairs: PairsWithin = by_derivatives,
) -> Array:
    """Return where each step is to be parted (steps,), as a share of the step; NaN where the step is settled.

    Parameters
    ----------
    steps : Steps
    points : Points
    names : bool
        Whether to part steps as well where roots far from the level cannot be told apart.
    level : float
        Damping ratio.
    trust : float
        In the cubics: the less, the wider their bands.
    pairs : callable
        Returns how two roots that may meet run over a step.
    """
    share = np.full(len(steps.before), np.nan)
    if not len(share):
        return share
    ends = Ends(steps, points)
    sides, square, bends = ends.sides, _squares(ends), bend(ends.cubics)
    width = np.where(np.isnan(steps.wrong), _UNSEEN * bends, np.fmax(steps.wrong, _SEEN * bends)) / trust
    # A root that is neutral all along crosses nothing.
    counts = ends.counts & (sides != 0).any(axis=0)
    near = counts & _may_reach(ends, width + _most_parted(*square))
    _learn_quality(ends, near)
    poor = counts & (steps.quality < POOR)
    row, state = np.nonzero(poor & near)
    near[row, state] = ~keep_off(ends, row, state, level, trust, pairs)
    reasons = (
        _band_is_open(near, ends.cubics, sides, width, ends.errors, *square),
        _roots_are_alike(steps, poor, near, names),
        _real_roots_join(ends, trust),
    )
    for place in reasons:  # the last reason counts
        share = np.where(np.isnan(place), share, place)
    return share


def _band_is_open(
    near: Array, ends: Array, sides: Array, width: Array, errors: Array, *square: Array
) -> Array:
    """Return where (steps,) the band of the first root that is not settled leaves open how often the root crosses."""
    row, state = np.nonzero(near)
    at = (..., row, state)
    place = _open_at(ends[at], sides[at], width[at], errors[at], *(part[at] for part in square))
    found = np.flatnonzero(np.isfinite(place))
    rows, first = np.unique(row[found], return_index=True)  # one point in a step and round
    share = np.full(len(near), np.nan)
    share[rows] = place[found[first]]
    return share


def _roots_are_alike(steps: Steps, poor: Array, near: Array, names: bool) -> Array:
    """Return the middle (steps,) of steps in which roots cannot be told apart, down to a length."""
    deepest = np.where((poor & near).any(axis=1), _NEAR_LEVEL, _FOR_NAMES if names else 0)
    return np.where(poor.any(axis=1) & (steps.depth < deepest), 0.5, np.nan)


def _real_roots_join(ends: Ends, trust: float) -> Array:
    """Return where (steps,) to part steps in which two real roots of one end are one pair at the other end.

    Such a step is parted where its ends do not tell how often the two roots cross the level. The mean μ of the two
    roots and the square of half their distance, δ², run smoothly through the point at which the roots join; the roots
    μ ± δ do not, and a cubic through their own values and slopes is worth nothing.
    """
    share, sides, depth = np.full(len(ends.length), np.nan), ends.sides, ends.steps.depth
    rows, couples, real_end, mean, square = joining_roots(ends)
    if not len(rows):
        return share
    one, other = sides[real_end, rows, couples[0]], sides[real_end, rows, couples[1]]
    pair = sides[1 - real_end, rows, couples[0]]
    joint = np.clip(square[0] / (square[0] - square[1]), _EDGE, 1 - _EDGE)
    highest, where = _reach_of_couple(mean, square, pair, trust)
    reaches = (one == other) & (one == pair) & (pair != 0) & (highest >= 0)
    # On different sides one of the two crosses before they join, or both do after.
    place = np.where(one * other < 0, joint, np.where(reaches, where, np.nan))
    found = np.isfinite(place) & (depth[rows] < _DEEPEST_JOINT)
    share[rows[found]] = place[found]
    return share


def _reach_of_couple(mean: Array, square: Array, side: Array, trust: float) -> tuple[Array, Array]:
    """Return how far (k,) two real roots may come beyond the level from one side in a step, and at which share.

    A real root crosses every level where it crosses zero.
    """
    spread = _UNSEEN * band(_GRID) / trust
    of_mean, of_square = (hermite(_GRID, ends[:, :, None]) for ends in (mean, square))
    apart = np.sqrt(np.maximum(of_square + spread * bend(square)[:, None], 0))
    reach = -side[:, None] * of_mean + spread * bend(mean)[:, None] + apart
    # Where the two roots are no longer real they have their mean as real part, whose own cubic is judged.
    reach = np.where(apart > 0, reach, -np.inf)
    place = reach.argmax(axis=1)
    return reach[np.arange(len(place)), place], _GRID[place]


def _may_reach(ends: Ends, width: Array) -> Array:
    """Return which roots come as near to the level as they may go over the step, or cross the level."""
    reach = ends.ways + width + np.abs(ends.cubics[2:]).max(axis=0)
    return np.asarray((np.abs(ends.cubics[:2]).min(axis=0) <= reach) | (ends.sides[0] * ends.sides[1] < 0))


def _learn_quality(ends: Ends, near: Array) -> None:
    """Set the quality of some states of steps by values alone: 0 where a state may meet another, else 1."""
    quality, block = ends.steps.quality, ends.points.spectrum.block
    row, state = np.nonzero(near & np.isnan(quality))
    if len(row):
        first, last = ends.values[:, row]
        meeting = may_meet(first, last, ends.ways[row], state[:, None], block)
        quality[row, state] = ~meeting[:, 0].any(axis=1)


def _squares(ends: Ends) -> tuple[Array, Array]:
    """Return the cubics of (Im λ)² over steps, by their ends (4, steps, states), and how wrong they may be.

    The error (steps, states) is minus infinity for roots that are no pairs at both ends. Where a cubic is below zero a
    pair has parted into two real roots, by the square root of what is missing.
    """
    frequency = ends.values.imag
    cubics = np.concatenate([frequency**2, 2 * frequency * ends.changes.imag * ends.length])
    return cubics, np.where((cubics[:2] > 0).all(axis=0), _UNSEEN * bend(cubics), -np.inf)


def _most_parted(square: Array, width: Array) -> Array:
    """Return how far (steps, states) real roots may part from each other's mean where a pair becomes real in a step.

    A cubic leaves the straight line between its ends by at most 4/27 of the sum of the differences between its slopes
    and the line's.
    """
    rise = square[1] - square[0]
    away = 4 / 27 * (np.abs(square[2] - rise) + np.abs(square[3] - rise))
    return np.asarray(np.sqrt(np.maximum(away + width - square[:2].min(axis=0), 0)))


def _open_at(
    ends: Array, sides: Array, width: Array, errors: Array, square: Array, square_width: Array
) -> Array:
    """Return where (m,) a cubic with its band leaves open how often it crosses; NaN where nothing is open."""
    t = np.concatenate([np.broadcast_to(_GRID, (len(width), len(_GRID))), hermite_extrema(ends)], axis=1)
    t = np.sort(np.where(np.isnan(t), 0.5, t), axis=1)
    spread = band(t)
    value, slope = hermite(t, ends[:, :, None]), hermite_slope(t, ends[:, :, None])
    with np.errstate(invalid="ignore"):
        split = np.sqrt(np.maximum(square_width[:, None] * spread - hermite(t, square[:, :, None]), 0))
    split = np.where(np.isfinite(square_width)[:, None], split, 0)
    half = width[:, None] * spread
    side = np.where(sides[0] != 0, sides[0], sides[1])[:, None]
    noise = np.where((sides == 0).any(axis=0), 10 * errors.max(axis=0), 0)[:, None]
    # With both ends on one side, all of the band must be on that side.
    inside = side * value - half - np.where(side < 0, split, 0) + noise
    # With ends on different sides, the band must go one way where it holds the level.
    certain = np.where(np.abs(value) > half + split, np.sign(value), 0)
    forward = -side * slope - 4 * width[:, None] * np.minimum(1, 4 * t * (1 - t))
    gone = np.maximum.accumulate(certain == -side, axis=1)
    back = gone & (certain == side)
    one_way = np.where(back, -1.0, np.where(certain == 0, forward, 1.0))
    margin = np.where(((sides[0] * sides[1]) < 0)[:, None], one_way, inside)
    rows, worst = np.arange(len(t)), margin.argmin(axis=1)
    place = np.clip(t[rows, worst], _EDGE, 1 - _EDGE)
    return np.where(margin[rows, worst] <= 0, place, np.nan)
