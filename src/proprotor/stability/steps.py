"""Steps between points of lines, and what they tell of how often each root crosses the level.

G of a root over a step is the cubic that has values and slopes of its ends, with a band about it that is as wide as the
cubic is likely to be wrong: zero at the ends, widest in the middle. A step is settled when every line within the band
crosses the level as often as its ends say, once or not at all; else it is parted where the band leaves it open. Two
roots that cannot be told apart are judged together: `proprotor.stability.root_pairs`. As long
as nothing better is known the width is a share of how far the cubic bends away from the straight line, and after
parting what the cubic was seen to be wrong by.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from proprotor.stability.cubic import hermite, hermite_extrema, hermite_slope
from proprotor.stability.matching import POOR, Spectrum, link
from proprotor.stability.root_pairs import PairsWithin, by_derivatives, keep_off, may_meet
from proprotor.typing import Array

if TYPE_CHECKING:
    from proprotor.stability.crossings import Points

_UNSEEN = 0.5  # of the bend: error of a cubic that nothing was compared with
_SEEN = 0.1  # and after it was
_SAFETY = 4.0  # the error of a cubic over half a step is a sixteenth; a quarter is taken
_FOR_NAMES = 7  # halvings of a step whose roots cannot be told apart: of 5 kt, to 0.04 kt
_NEAR_LEVEL = 15  # and where one of them comes near the level: of 70 kt, to 0.002 kt
_GRID = np.linspace(0.0, 1.0, 17)[1:-1]
_DEEPEST_JOINT = 12  # partings of a step to find where two real roots join
_EDGE = 0.04  # of a step: a new point stays that far from its ends


@dataclass
class Steps:
    """Pairs of neighbouring points of one line.

    before, after (steps,) of int; successor (steps, states) of int and quality (steps, states), see
    `proprotor.stability.matching.link`, NaN where it is not known yet; wrong (steps, states), the error of the cubic
    by what was seen when the step was parted from a longer one, NaN where it was not; depth (steps,), how often that
    was; open (steps,), whether it is still to be looked at.
    """

    before: Array
    after: Array
    successor: Array
    quality: Array
    wrong: Array
    depth: Array
    open: Array

    def at(self, rows: Array) -> Steps:
        """Some of the steps."""
        return Steps(*(getattr(self, entry.name)[rows] for entry in fields(self)))

    def joined(self, other: Steps) -> Steps:
        """The steps of both."""
        return Steps(
            *(np.concatenate([getattr(self, one.name), getattr(other, one.name)]) for one in fields(self))
        )

    def ends(self, points: Points) -> Array:
        """Growth at both ends, and both slopes times the length of the step (4, steps, states)."""
        length = (points.position[self.after] - points.position[self.before])[:, None]
        value, slope = (self.later(part) for part in (points.growth, points.slope))
        return np.stack(
            [points.growth[self.before], value, points.slope[self.before] * length, slope * length]
        )

    def errors(self, points: Points) -> Array:
        """Error of the growth at both ends (2, steps, states)."""
        return np.stack([points.error[self.before], self.later(points.error)])

    def counts(self, points: Points) -> Array:
        """Which states are not the conjugates of others."""
        values = points.spectrum.values
        return ~((values[self.before].imag < 0) & (self.later(values).imag < 0))

    def sides(self, points: Points) -> Array:
        """On which side of the level roots are at both ends (2, steps, states); 0 where they are neutral."""
        value = np.stack([points.growth[self.before], self.later(points.growth)])
        return np.where(np.abs(value) <= self.errors(points), 0.0, np.sign(value))

    def crossing(self, points: Points) -> tuple[Array, Array, Array]:
        """Steps and states that are beyond the level at one end alone, with the ends (4, k) of their cubics."""
        beyond, ends = self.sides(points) > 0, self.ends(points)
        rows, states = np.nonzero(self.counts(points) & (beyond[0] != beyond[1]))
        return rows, states, ends[:, rows, states]

    def onsets(self, points: Points) -> Array:
        """Steps over which a root becomes unstable, and is followed without doubt."""
        sides = self.sides(points)
        certain = (sides[0] < 0) & (sides[1] > 0) & (self.quality >= POOR)
        return np.flatnonzero((certain & self.counts(points)).any(axis=1))

    def later(self, part: Array) -> Array:
        """What states (points, states) have at the later end, in the places of the earlier one (steps, states)."""
        return np.take_along_axis(part[self.after], self.successor, 1)


def first_steps(spectrum: Spectrum, before: Array, after: Array) -> Steps:
    """Steps from points to those that follow them."""
    linked = link(spectrum, before, after)
    nothing = np.full(linked.quality.shape, np.nan)
    count = len(before)
    return Steps(before, after, *linked, nothing, np.zeros(count, dtype=int), np.ones(count, dtype=bool))


def parted(steps: Steps, rows: Array, points: Points, first: int) -> Steps:
    """The steps with some of them, `rows`, parted at the points from `first` on."""
    old, new = steps.at(rows), np.arange(first, first + len(rows))
    halves = [link(points.spectrum, *ends) for ends in ((old.before, new), (new, old.after))]
    start, end = points.position[old.before], points.position[old.after]
    share = ((points.position[new] - start) / (end - start))[:, None]
    seen = np.take_along_axis(points.growth[new], halves[0].successor, 1)
    wrong = np.abs(hermite(share, old.ends(points)) - seen) / _SAFETY
    later = np.empty(wrong.shape)
    np.put_along_axis(later, halves[0].successor, wrong, 1)
    rest = np.ones(len(steps.before), dtype=bool)
    rest[rows] = False
    depth, is_open = old.depth + 1, np.ones(len(rows), dtype=bool)
    return (
        steps.at(rest)
        .joined(Steps(old.before, new, *halves[0], wrong, depth, is_open))
        .joined(Steps(new, old.after, *halves[1], later, depth, is_open))
    )


def undecided(
    steps: Steps,
    points: Points,
    names: bool,
    level: float = 0.0,
    trust: float = 1.0,
    pairs: PairsWithin = by_derivatives,
) -> Array:
    """Where each step is to be parted (steps,), as a share of it; NaN where it is settled.

    With `names` also where roots far from the level cannot be told apart. The less the trust in the cubics, the wider
    their bands; `pairs` tells of roots that may meet.
    """
    share = np.full(len(steps.before), np.nan)
    if not len(share):
        return share
    ends, sides, counts = steps.ends(points), steps.sides(points), steps.counts(points)
    bend = _bend(ends)
    width = np.where(np.isnan(steps.wrong), _UNSEEN * bend, np.fmax(steps.wrong, _SEEN * bend))
    width = width / trust
    counts = counts & (sides != 0).any(axis=0)  # neutral all along is no crossing
    square, square_width = _squares(steps, points)
    near = _may_reach(steps, points, ends, sides, width + _most_parted(square, square_width))
    _learn_quality(steps, points, near & counts)
    poor = (steps.quality < POOR) & counts
    row, state = np.nonzero(poor & near)
    near[row, state] = ~keep_off(steps, points, row, state, level, trust, pairs)
    looked = np.flatnonzero((counts & near).any(axis=1))
    row, state = np.nonzero((counts & near)[looked])
    row = looked[row]
    open_at = _open_at(
        ends[:, row, state], sides[:, row, state], width[row, state],
        steps.errors(points)[:, row, state], square[:, row, state], square_width[row, state],
    )  # fmt: skip
    for one, place in zip(row[np.isfinite(open_at)], open_at[np.isfinite(open_at)], strict=True):
        if np.isnan(share[one]):  # one point in a step and round
            share[one] = place
    deepest = np.where((poor & near).any(axis=1), _NEAR_LEVEL, _FOR_NAMES if names else 0)
    share[poor.any(axis=1) & (steps.depth < deepest)] = 0.5
    for one, place in _where_real_roots_join(steps, points, sides, trust):
        share[one] = place
    return share


def _where_real_roots_join(
    steps: Steps, points: Points, sides: Array, trust: float
) -> Iterator[tuple[int, float]]:
    """Yield steps in which two real roots of one end are one pair at the other end, and where to part such a step.

    Such a step is parted where its ends do not tell how often the two roots cross the level. The mean μ of the two
    roots and the square of half their distance, δ², run smoothly through the point at which the roots join; the roots
    μ ± δ do not, and a cubic through their own values and slopes is worth nothing.
    """
    rows, couples, real_end = _couples(steps, points)
    if not len(rows):
        return
    mean, square = _mean_and_distance(steps, points, rows, couples)
    one, other = sides[real_end, rows, couples[0]], sides[real_end, rows, couples[1]]
    pair = sides[1 - real_end, rows, couples[0]]
    joint = np.clip(square[0] / (square[0] - square[1]), _EDGE, 1 - _EDGE)
    highest, where = _reach_of_couple(mean, square, pair, trust)
    for k in np.flatnonzero(steps.depth[rows] < _DEEPEST_JOINT).tolist():
        if one[k] * other[k] < 0:  # one of them crosses before the two join, or two roots do after
            yield int(rows[k]), float(joint[k])
        elif one[k] == other[k] == pair[k] != 0 and highest[k] >= 0:
            yield int(rows[k]), float(where[k])


def _couples(steps: Steps, points: Points) -> tuple[Array, Array, Array]:
    """Return steps (k,), two states (2, k) that are real at one end and a pair at the other, and which end that is."""
    values = points.spectrum.values
    ends = np.stack([values[steps.before], steps.later(values)])
    real = ends.imag == 0
    found = []
    for end in (0, 1):
        mixed = real[end] & ~real[1 - end] & np.isfinite(ends[0]) & np.isfinite(ends[1])
        for row in np.flatnonzero(mixed.sum(axis=1) > 1).tolist():
            pair = ends[1 - end, row]
            found += [
                (row, one, other, end)
                for one, other in combinations(np.flatnonzero(mixed[row]).tolist(), 2)
                if pair[one] == pair[other].conjugate()
            ]
    rows, *couples, ends_of = np.array(found, dtype=int).reshape(-1, 4).T
    return np.asarray(rows), np.stack(couples), np.asarray(ends_of)


def _mean_and_distance(steps: Steps, points: Points, rows: Array, couples: Array) -> tuple[Array, Array]:
    """Return the cubics (4, k) of the mean of two roots, and of the square of half their distance, by their ends."""
    before, after = steps.before[rows], steps.after[rows]
    length = points.position[after] - points.position[before]
    later = steps.successor[rows, couples]
    values = np.stack([points.spectrum.values[before, couples], points.spectrum.values[after, later]])
    changes = np.stack([points.change[before, couples], points.change[after, later]]) * length
    half, moved = (values[:, 0] - values[:, 1]) / 2, (changes[:, 0] - changes[:, 1]) / 2
    mean = np.concatenate([values.mean(axis=1), changes.mean(axis=1)]).real
    return mean, np.concatenate([half**2, 2 * half * moved]).real


def _reach_of_couple(mean: Array, square: Array, side: Array, trust: float) -> tuple[Array, Array]:
    """Return how far (k,) two real roots may come beyond the level from one side of it in a step, and where that is.

    A real root crosses every level where it crosses zero.
    """
    band = 16 * _GRID**2 * (1 - _GRID) ** 2 / trust
    of_mean, of_square = (hermite(_GRID, ends[:, :, None]) for ends in (mean, square))
    apart = np.sqrt(np.maximum(of_square + band * _UNSEEN * _bend(square)[:, None], 0))
    reach = -side[:, None] * of_mean + band * _UNSEEN * _bend(mean)[:, None] + apart
    # Where the two roots are no longer real it is their mean that moves, and its own cubic that tells.
    reach = np.where(apart > 0, reach, -np.inf)
    place = reach.argmax(axis=1)
    return reach[np.arange(len(place)), place], _GRID[place]


def _bend(ends: Array) -> Array:
    """Return how far cubics, by their ends (4, ...), may leave the straight line between the ends."""
    rise = ends[1] - ends[0]
    bend: Array = np.maximum(np.abs(ends[2] - rise), np.abs(ends[3] - rise)) / 4
    return bend


def _may_reach(steps: Steps, points: Points, ends: Array, sides: Array, width: Array) -> Array:
    """Which roots come as near to the level as they move over the step, or cross it."""
    values = points.spectrum.values
    move = np.abs(steps.later(values) - values[steps.before])
    reach = move + width + np.abs(ends[2:]).max(axis=0)
    return np.asarray((np.abs(ends[:2]).min(axis=0) <= reach) | (sides[0] * sides[1] < 0))


def _learn_quality(steps: Steps, points: Points, near: Array) -> None:
    """Give some states of steps by values alone their quality, for those only: whether they may meet others."""
    row, state = np.nonzero(near & np.isnan(steps.quality))
    if len(row):
        values = points.spectrum.values
        first, last = values[steps.before[row]], values[steps.after[row]]
        last = np.take_along_axis(last, steps.successor[row], 1)
        steps.quality[row, state] = ~may_meet(first, last, state[:, None])[:, 0].any(axis=1)


def _squares(steps: Steps, points: Points) -> tuple[Array, Array]:
    """Return the cubics of (Im λ)² over steps, by their ends (4, steps, states), and how wrong they may be.

    The error (steps, states) is minus infinity for roots that are no pairs at both ends. Where a cubic is below zero a
    pair has parted into two real roots, by the square root of what is missing.
    """
    values, length = (
        points.spectrum.values,
        (points.position[steps.after] - points.position[steps.before])[:, None],
    )
    change = 2 * values.imag * points.change.imag
    ends = np.stack([
        values[steps.before].imag ** 2,
        steps.later(values).imag ** 2,
        change[steps.before] * length,
        steps.later(change) * length,
    ])  # fmt: skip
    return ends, np.where((ends[:2] > 0).all(axis=0), _UNSEEN * _bend(ends), -np.inf)


def _most_parted(square: Array, width: Array) -> Array:
    """Return how far (steps, states) real roots may part from each other's mean where a pair becomes real in a step.

    A cubic leaves the straight line between its ends by at most 4/27 of the sum of what its slopes differ from it.
    """
    rise = square[1] - square[0]
    bend = 4 / 27 * (np.abs(square[2] - rise) + np.abs(square[3] - rise))
    most: Array = np.sqrt(np.maximum(bend + width - square[:2].min(axis=0), 0))
    return most


def _open_at(
    ends: Array, sides: Array, width: Array, errors: Array, square: Array, square_width: Array
) -> Array:
    """Where (m,) a cubic with its band leaves open how often it crosses; NaN where it does not."""
    if not len(width):
        return np.empty(0)
    t = np.concatenate([np.broadcast_to(_GRID, (len(width), len(_GRID))), hermite_extrema(ends)], axis=1)
    t = np.sort(np.where(np.isnan(t), 0.5, t), axis=1)
    band = 16 * t**2 * (1 - t) ** 2
    value, slope = hermite(t, ends[:, :, None]), hermite_slope(t, ends[:, :, None])
    with np.errstate(invalid="ignore"):
        split = np.sqrt(np.maximum(square_width[:, None] * band - hermite(t, square[:, :, None]), 0))
    split = np.where(np.isfinite(square_width)[:, None], split, 0)
    half = width[:, None] * band
    side = np.where(sides[0] != 0, sides[0], sides[1])[:, None]
    noise = np.where((sides == 0).any(axis=0), 10 * errors.max(axis=0), 0)[:, None]
    # Ends on one side: all of the band must be.
    inside = side * value - half - np.where(side < 0, split, 0) + noise
    # Ends on either side: where the band holds the level it must go one way, and elsewhere be on the side of its end.
    certain = np.where(np.abs(value) > half + split, np.sign(value), 0)
    forward = -side * slope - 4 * width[:, None] * np.minimum(1, 4 * t * (1 - t))
    gone = np.maximum.accumulate(certain == -side, axis=1)
    back = gone & (certain == side)
    one_way = np.where(back, -1.0, np.where(certain == 0, forward, 1.0))
    margin = np.where(((sides[0] * sides[1]) < 0)[:, None], one_way, inside)
    rows, worst = np.arange(len(t)), margin.argmin(axis=1)
    place = np.clip(t[rows, worst], _EDGE, 1 - _EDGE)
    return np.where(margin[rows, worst] <= 0, place, np.nan)
