"""Steps between neighbouring points of lines: how a root runs over each step, by values and slopes at its ends."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np

from proprotor.stability.cubic import hermite
from proprotor.stability.matching import POOR, Matches, match_modes, size_of
from proprotor.stability.points import Points
from proprotor.typing import Array

_SAFETY = 4.0  # the error of a cubic over half a step is a sixteenth; a quarter is taken


class Steps(NamedTuple):
    """Pairs of neighbouring points of one line.

    before, after (steps,) of int : the points; successor (steps, states) of int, quality (steps, states) : see
    `proprotor.stability.matching.match_modes`, NaN where the quality is not known yet; wrong (steps, states) : the
    error of the cubic as seen when a longer step was parted into this one, NaN for a first step; depth (steps,) :
    number of partings; open (steps,) : whether the step is still to be looked at.
    """

    before: Array
    after: Array
    successor: Array
    quality: Array
    wrong: Array
    depth: Array
    open: Array

    def at(self, rows: Array | slice) -> Steps:
        """Return some of the steps; those of a slice share their arrays with these steps."""
        return Steps(*(part[rows] for part in self))

    def crossing(self, points: Points) -> tuple[Array, Array, Array]:
        """Return steps and states that are beyond the level at one end alone, with the ends (4, k) of their cubics."""
        ends = Ends(self, points)
        beyond = ends.sides > 0
        rows, states = np.nonzero(ends.counts & (beyond[0] != beyond[1]))
        return rows, states, ends.cubics[:, rows, states]

    def onsets(self, points: Points) -> Array:
        """Return steps over which a root becomes unstable, and is followed without doubt."""
        ends = Ends(self, points)
        certain = (ends.sides[0] < 0) & (ends.sides[1] > 0) & (self.quality >= POOR)
        return np.flatnonzero((certain & ends.counts).any(axis=1))

    def length(self, points: Points) -> Array:
        """Return the length of each step (steps, 1), in the unit of the positions."""
        return np.asarray(points.position[self.after] - points.position[self.before])[:, None]

    def later(self, part: Array) -> Array:
        """Return values (points, states) at the later end in the places of the earlier end (steps, states)."""
        return np.take_along_axis(part[self.after], self.successor, 1)


class Ends:
    """What the followed states have at both ends of some steps (2, steps, states), each part put together once.

    Parameters
    ----------
    steps : Steps
    points : Points
    """

    def __init__(self, steps: Steps, points: Points) -> None:
        self.steps, self.points = steps, points
        self.length = steps.length(points)
        self._later = steps.after[:, None] * steps.successor.shape[1] + steps.successor

    def of(self, part: Array) -> Array:
        """Return values (points, states) at both ends."""
        found = np.empty((2, *self._later.shape), dtype=part.dtype)
        found[0] = part[self.steps.before]
        found[1] = part.ravel()[self._later]
        return found

    @cached_property
    def values(self) -> Array:
        """The eigenvalues, rad/s."""
        return self.of(self.points.spectrum.values)

    @cached_property
    def changes(self) -> Array:
        """How the eigenvalues change with the position."""
        return self.of(self.points.change)

    @cached_property
    def errors(self) -> Array:
        """The errors of the growth, 1/s."""
        return self.of(self.points.error)

    @cached_property
    def cubics(self) -> Array:
        """Growth at both ends, and both slopes times the length of the step (4, steps, states)."""
        return np.concatenate([self.of(self.points.growth), self.of(self.points.slope) * self.length])

    @cached_property
    def sides(self) -> Array:
        """On which side of the level roots are; 0 where they are neutral."""
        growth = self.cubics[:2]
        return np.where(np.abs(growth) <= self.errors, 0.0, np.sign(growth))

    @cached_property
    def counts(self) -> Array:
        """Which states (steps, states) are not the conjugates of others."""
        return np.asarray(~(self.values.imag < 0).all(axis=0))

    @cached_property
    def ways(self) -> Array:
        """How far (steps, states) each root may go over its step, by its ends or by its change at both ends."""
        first, last = self.values
        return np.asarray(np.fmax(size_of(last - first), size_of(self.changes).sum(axis=0) * self.length))


def first_steps(before: Array, after: Array, successor: Array, quality: Array) -> Steps:
    """Return steps from points to the points that follow, none of them parted yet."""
    depth, is_open = np.zeros(len(before), dtype=int), np.ones(len(before), dtype=bool)
    return Steps(before, after, successor, quality, np.full(successor.shape, np.nan), depth, is_open)


def parted(steps: Steps, rows: Array, points: Points, first: int) -> Steps:
    """Return the steps with some of them, `rows`, parted at the points from `first` on."""
    old, new = steps.at(rows), np.arange(first, first + len(rows))
    before, after = np.concatenate([old.before, new]), np.concatenate([new, old.after])
    both = match_modes(points.spectrum, before, after)
    halves = [Matches(*(part[half] for part in both)) for half in np.split(np.arange(2 * len(new)), 2)]
    share = (points.position[new] - points.position[old.before])[:, None] / old.length(points)
    seen = np.take_along_axis(points.growth[new], halves[0].successor, 1)
    wrong = np.abs(hermite(share, Ends(old, points).cubics) - seen) / _SAFETY
    later = np.take_along_axis(wrong, halves[0].successor.argsort(axis=1), 1)
    rest = np.delete(np.arange(len(steps.before)), rows)
    depth, is_open = old.depth + 1, np.ones(len(rows), dtype=bool)
    earlier = Steps(old.before, new, *halves[0], wrong, depth, is_open)
    further = Steps(new, old.after, *halves[1], later, depth, is_open)
    return Steps(*map(np.concatenate, zip(steps.at(rest), earlier, further, strict=True)))
