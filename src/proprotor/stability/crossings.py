"""Search for crossings of a damping level along lines of models, all lines at once.

Over a step from one point to the next a root is followed by its vectors, and the cubic that has values and slopes of
both ends, in a band of its likely error, tells how often the growth G changes its sign: `proprotor.stability.parting`.
Where the cubic does not tell, the step is parted at the point in question, until it is settled; the error of the cubic
is known by then. Each crossing is then found by Newton's method: `proprotor.stability.brackets`.

Where the lowest onset of each line is all that is wanted, the points are solved for their eigenvalues alone, matched by
the nearest ones (`proprotor.stability.screening`). Differences stand for derivatives, and only the steps that may hold
the onset by these differences have their ends solved with vectors.

Whether G has a sign is a matter of its error (`proprotor.stability.root_error`). A root within its error is neutral,
and counts as not beyond the level; a root that is neutral all along crosses nothing.
"""

from __future__ import annotations

import numpy as np

from proprotor.stability.matching import match_modes
from proprotor.stability.parting import where_to_part
from proprotor.stability.points import Models, Solved, solve_points
from proprotor.stability.points_ahead import PointsAhead
from proprotor.stability.screening import screened
from proprotor.stability.steps import first_steps, parted
from proprotor.typing import Array

_ROUNDS = 20  # of parting
_MOST_SOLVES = 1000  # of a line, after which no more of its steps are parted
_HALVINGS = 6  # of a step at whose other end nothing can be analysed


class Search:
    """Points and steps of lines, and the crossings in them.

    Parameters
    ----------
    models : callable
        Takes lines (k,) and positions (k,) and returns the models of these points; analytic in the positions, or
        refuses complex positions.
    line, position : array (k,)
        The points of all lines, in the order of their lines and rising along each line.
    level : float
        Damping ratio.
    names : bool
        Whether steps are parted wherever they do not tell which root is which, and not only near the level.
    onset_only : bool
        Whether the lowest onset of each line is all that is wanted.
    forgiving : bool
        Whether an impossible input is the reason of its points, and not raised.
    states : int, optional
        Number of eigenvalues that arrays have room for; by default that of the given point with the most.
    """

    def __init__(
        self,
        models: Models,
        line: Array,
        position: Array,
        level: float = 0.0,
        *,
        names: bool = False,
        onset_only: bool = False,
        forgiving: bool = False,
        states: int | None = None,
    ) -> None:
        self.level, self.names, self.onset_only = level, names, onset_only
        self._models, self._forgiving, self._states = models, forgiving, states
        # Line and both ends of steps of lines on which nothing settles, as where the trim jumps back and forth.
        self.unsettled: list[tuple[int, float, float]] = []
        self._ahead = PointsAhead()
        self.scanned = self.solve(line, position, plain=onset_only)
        self.solves = np.bincount(line[self.scanned.works], minlength=int(line.max(initial=-1)) + 1)
        if self.scanned.points is not None:
            self.points = self.scanned.points
            self._states = self.points.growth.shape[1]
            self._reach_edges(line, position)
            self.first_points = self.points
            order = np.lexsort((self.points.position, self.points.line))
            same = np.diff(self.points.line[order]) == 0
            before, after = order[:-1][same], order[1:][same]
            if onset_only:
                before, after = self._screen(before, after)
            self.steps = first_steps(before, after, *match_modes(self.points.spectrum, before, after))
            self._settle()

    def solve(self, line: Array, position: Array, plain: bool = False) -> Solved:
        """Solve further points of the lines (k,), see `proprotor.stability.points.solve_points`."""
        return solve_points(self._models, line, position, self.level, self._forgiving, self._states, plain)

    def _screen(self, before: Array, after: Array) -> tuple[Array, Array]:
        """Solve the ends of the steps that may hold the lowest onset with vectors, and return these steps.

        Parameters
        ----------
        before, after : array (steps,) of int
            All steps of the points, which have eigenvalues alone.

        Returns
        -------
        two arrays (steps,) of int
            The steps, between points that have vectors and derivatives.
        """
        points = self.points
        asked, onsets = screened(points, before, after, self.level, self.scanned.is_compiled)
        kept = asked & self._not_beyond(before, onsets)
        linked = np.stack([before[kept], after[kept]])
        ends = np.unique(linked)
        exact = self.solve(points.line[ends], points.position[ends]) if len(ends) else None
        if exact is None or exact.points is None:
            none = np.array([], dtype=int)
            return none, none
        np.add.at(self.solves, exact.points.line, 1)
        place = np.full(len(points.position), -1)
        place[ends[exact.works]] = np.arange(len(exact.points.position))
        self.points, linked = exact.points, place[linked]
        first, last = linked[:, (linked >= 0).all(axis=0)]
        return first, last

    def _reach_edges(self, line: Array, position: Array) -> None:
        """Halve the steps from a point that works to a point that fails: a boundary may lie within such a step."""
        works = self.scanned.works
        edges = np.flatnonzero((line[1:] == line[:-1]) & (works[1:] != works[:-1]))
        good, bad = (np.where(works[edges], edges + k, edges + 1 - k) for k in (0, 1))
        line, good, bad = line[edges], position[good], position[bad]
        for _ in range(_HALVINGS if len(line) else 0):
            middle = (good + bad) / 2
            found = self.solve(line, middle, plain=self.onset_only)
            good, bad = np.where(found.works, middle, good), np.where(found.works, bad, middle)
            if found.points is not None:
                self.points = self.points.joined(found.points)
                np.add.at(self.solves, found.points.line, 1)

    def _settle(self) -> None:
        """Part steps until each tells how often every root crosses."""
        for _ in range(_ROUNDS):
            wanted = np.flatnonzero(self.steps.open & self._before_onset())
            share = where_to_part(self.steps.at(wanted), self.points, self.names, self.level)
            self.steps.open[wanted] = False
            line = self.points.line[self.steps.before[wanted]]
            left = np.isfinite(share) & (self.solves[line] > _MOST_SOLVES)
            ends = self.points.position[np.stack([self.steps.before, self.steps.after], axis=1)]
            self.unsettled += zip(line[left].tolist(), *ends[wanted[left]].T.tolist(), strict=True)
            chosen = np.isfinite(share) & ~left
            if not chosen.any() or not self._part(wanted[chosen], share[chosen]):
                break
        np.add.at(self.solves, self._ahead.lines, 1)
        order = np.lexsort((self.points.position[self.steps.before], self.points.line[self.steps.before]))
        self.steps = self.steps.at(order)

    def _before_onset(self) -> Array:
        """Return which steps do not lie beyond a step of their line over which a root becomes unstable for certain."""
        if not self.onset_only:
            return np.ones(len(self.steps.before), dtype=bool)
        return self._not_beyond(self.steps.before, self.steps.onsets(self.points))

    def _not_beyond(self, before: Array, onsets: Array) -> Array:
        """Return which steps, by the points before them, do not lie beyond the first of some steps of their line."""
        start, line = self.points.position[before], self.points.line[before]
        first = np.full(len(self.solves), np.inf)
        np.minimum.at(first, line[onsets], start[onsets])
        return np.asarray(start <= first[line])

    def _part(self, chosen: Array, share: Array) -> bool:
        """Put a point into each of some steps; return whether any of these points could be analysed."""
        few, first = self.steps.at(chosen), len(self.points.position)
        line = self.points.line[few.before]
        ends = self.points.position[np.stack([few.before, few.after])]
        between, works = self._ahead.within(line, ends, share, self.solve)
        if between is None:
            return False
        self.points = self.points.joined(between)
        np.add.at(self.solves, line[works], 1)
        self.steps = parted(self.steps, chosen[works], self.points, first)
        return True
