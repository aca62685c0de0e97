"""Branches: the roots of a line of points followed from point to point, with points put in between where needed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from proprotor.errors import InputError
from proprotor.model.first_order import held_coordinates
from proprotor.model.linear_model import LinearModel
from proprotor.stability.matching import POOR, Matches, Spectrum, chain, keep_upper, match_modes
from proprotor.stability.modes import decomposition
from proprotor.stability.parameter_lines import ParameterLine
from proprotor.typing import Array

_MOST_PARTS = 128  # of a step: where two roots pass each other a few dozen parts are needed
_AHEAD = 16  # points that are solved at once before it is known whether they are needed
_HALVINGS = 24  # of a step whose modes cannot be told apart: of 20 kt, to 1e-6 kt


@dataclass(frozen=True, eq=False)
class Branches:
    """The states of the points of a line, followed one to one in the order of the points.

    Attributes
    ----------
    spectrum : Spectrum
        Of the points of the line, then of points between them; NaN at failed points.
    points : array (k,) of int
        Places of the points in the spectrum, in the order along the line; failed points are left out.
    steps : Matches
        From each point to the next.
    positions : array
        Of the points of the spectrum; NaN where positions are not known.
    """

    spectrum: Spectrum
    points: Array
    steps: Matches
    positions: Array

    @cached_property
    def places(self) -> Array:
        """Which state of a point each branch is there (k, states)."""
        states = self.spectrum.values.shape[1]
        if not len(self.points):
            return np.empty((0, states), dtype=int)
        places = chain(self.steps.successor, np.arange(states))
        followed = np.take_along_axis(self.spectrum.values[self.points], places, 1)
        return np.take_along_axis(places, keep_upper(followed, self.spectrum.block), 1)

    @cached_property
    def quality(self) -> Array:
        """Trust in each step of each branch (k - 1, states)."""
        return np.take_along_axis(self.steps.quality, self.places[:-1], 1)

    def _with_points(self, after: Array, positions: Array, between: Spectrum) -> Branches:
        """Return the branches with one more point in each of the steps `after`, at `positions` within the steps."""
        first = len(self.spectrum.values)
        spectrum = self.spectrum.joined(between)
        points = np.insert(self.points, after + 1, np.arange(first, len(spectrum.values)))
        successor, quality = (np.insert(part, after, part[after], axis=0) for part in self.steps)
        parted = np.flatnonzero((points[:-1] >= first) | (points[1:] >= first))
        successor[parted], quality[parted] = match_modes(spectrum, points[parted], points[parted + 1])
        return Branches(
            spectrum, points, Matches(successor, quality), np.concatenate([self.positions, positions])
        )


class _Ahead:
    """Points between others, solved some halvings ahead: a batch of a few points takes hardly longer than one point."""

    def __init__(self, linearize: Callable[[Array], LinearModel], held: list[int]) -> None:
        self.linearize, self.held = linearize, held
        self.place: dict[float, int] = {}
        self.spectrum: Spectrum | None = None

    def middles(self, start: Array, end: Array) -> tuple[Array, Spectrum]:
        """Return the middles (k,) of some steps, and their eigenvalues and vectors."""
        middle = (start + end) / 2
        unknown = np.array([float(one) not in self.place for one in middle])
        if unknown.any():
            self._solve(_dyadic(start[unknown], end[unknown]), middle[unknown])
        assert self.spectrum is not None
        return middle, self.spectrum.at([self.place[float(one)] for one in middle])

    def _solve(self, wished: Array, needed: Array) -> None:
        """Solve points that will be wished for; those that are needed alone where one of the others cannot be."""
        try:
            found, points = decomposition(self.linearize(wished), self.held), wished
        except (InputError, np.linalg.LinAlgError):
            found, points = decomposition(self.linearize(needed), self.held), needed
        first = 0 if self.spectrum is None else len(self.spectrum.values)
        self.place |= {float(one): first + place for place, one in enumerate(points)}
        self.spectrum = found if self.spectrum is None else self.spectrum.joined(found)


def _dyadic(start: Array, end: Array) -> Array:
    """Return the middles of steps, of their halves, and so on, as far as the points are few."""
    found = []
    while True:
        middle = (start + end) / 2
        found.append(middle)
        start, end = np.concatenate([start, middle]), np.concatenate([middle, end])
        if sum(map(len, found)) + len(start) > _AHEAD:
            return np.concatenate(found)


def _branches_of(spectrum: Spectrum, positions: Array) -> Branches:
    """Return the branches through points in their order; failed points are passed over."""
    good = np.flatnonzero(spectrum.works)
    return Branches(spectrum, good, match_modes(spectrum, good[:-1], good[1:]), positions)


def follow(model: LinearModel, line: ParameterLine | None = None, held: list[int] | None = None) -> Branches:
    """Follow the states of the points of a line of models one to one.

    A step whose quality is poor is halved until the quality is good, where the line can be linearised between its
    points. A step that stays poor keeps its quality as a warning; where roots are alike all along a step, as two
    motions with one frequency, the step is given up after a number of parts.

    Parameters
    ----------
    model : LinearModel
        One point for each position of the line.
    line : ParameterLine, optional
        Positions, and the function that linearises between them.
    held : list of int, optional
        Coordinates whose displacement is a state, as for `proprotor.stability.modes.decomposition`.
    """
    held = held_coordinates(model) if held is None else held
    spectrum = decomposition(model, held)
    positions = np.full(len(spectrum.values), np.nan) if line is None else np.real(np.ravel(line.positions))
    branches = _branches_of(spectrum, np.asarray(positions, dtype=float))
    if line is None or line.linearize is None:
        return branches
    ahead = _Ahead(line.linearize, held)
    hopeless = np.zeros(max(len(branches.points) - 1, 0), dtype=bool)
    origin = np.arange(len(hopeless))  # of each step: the step of the line that it is a part of
    for _ in range(_HALVINGS):
        hopeless |= np.bincount(origin, minlength=1)[origin] > _MOST_PARTS
        poor = np.flatnonzero((branches.steps.quality.min(axis=1, initial=1) < POOR) & ~hopeless)
        if not len(poor):
            break
        ends = branches.positions[branches.points]
        middle, between = ahead.middles(ends[poor], ends[poor + 1])
        works = between.works
        hopeless[poor[~works]] = True
        branches = branches._with_points(poor[works], middle[works], between.at(works))
        hopeless, origin = (np.insert(part, poor[works], part[poor[works]]) for part in (hopeless, origin))
    return branches
