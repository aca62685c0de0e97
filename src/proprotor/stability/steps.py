"""Steps between neighbouring points of lines: how a root runs over each step, by values and slopes at its ends."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from proprotor.stability.cubic import hermite
from proprotor.stability.matching import POOR, Matches, match_modes
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

    def ends(self, points: Points) -> Array:
        """Return growth at both ends, and both slopes times the length of the step (4, steps, states)."""
        slopes = self.at_ends(points.slope) * self.length(points)
        return np.concatenate([self.at_ends(points.growth), slopes])

    def counts(self, points: Points) -> Array:
        """Return which states are not the conjugates of others."""
        return np.asarray(~(self.at_ends(points.spectrum.values).imag < 0).all(axis=0))

    def sides(self, points: Points) -> Array:
        """Return on which side of the level roots are at both ends (2, steps, states); 0 where they are neutral."""
        value = self.at_ends(points.growth)
        return np.where(np.abs(value) <= self.at_ends(points.error), 0.0, np.sign(value))

    def crossing(self, points: Points) -> tuple[Array, Array, Array]:
        """Return steps and states that are beyond the level at one end alone, with the ends (4, k) of their cubics."""
        beyond, ends = self.sides(points) > 0, self.ends(points)
        rows, states = np.nonzero(self.counts(points) & (beyond[0] != beyond[1]))
        return rows, states, ends[:, rows, states]

    def onsets(self, points: Points) -> Array:
        """Return steps over which a root becomes unstable, and is followed without doubt."""
        sides = self.sides(points)
        certain = (sides[0] < 0) & (sides[1] > 0) & (self.quality >= POOR)
        return np.flatnonzero((certain & self.counts(points)).any(axis=1))

    def length(self, points: Points) -> Array:
        """Return the length of each step (steps, 1), in the unit of the positions."""
        return np.asarray(points.position[self.after] - points.position[self.before])[:, None]

    def at_ends(self, part: Array) -> Array:
        """Return values (points, states) of the followed states at both ends (2, steps, states)."""
        return np.stack([part[self.before], self.later(part)])

    def later(self, part: Array) -> Array:
        """Return values (points, states) at the later end in the places of the earlier end (steps, states)."""
        return np.take_along_axis(part[self.after], self.successor, 1)


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
    wrong = np.abs(hermite(share, old.ends(points)) - seen) / _SAFETY
    later = np.take_along_axis(wrong, halves[0].successor.argsort(axis=1), 1)
    rest = np.delete(np.arange(len(steps.before)), rows)
    depth, is_open = old.depth + 1, np.ones(len(rows), dtype=bool)
    earlier = Steps(old.before, new, *halves[0], wrong, depth, is_open)
    further = Steps(new, old.after, *halves[1], later, depth, is_open)
    return Steps(*map(np.concatenate, zip(steps.at(rest), earlier, further, strict=True)))
