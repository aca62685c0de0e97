"""States followed along a line of points, with more points put between them where that is needed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from proprotor.errors import InputError
from proprotor.model.first_order import held_coordinates
from proprotor.model.linear_model import LinearModel
from proprotor.stability.matching import POOR, Spectrum, Steps, chain, keep_upper, link
from proprotor.stability.modes import decomposition
from proprotor.typing import Array

Linearize = Callable[[Array], LinearModel]  # positions (k,) along a line to the models there

_MOST_PARTS = 128  # of a step: where two roots pass each other it takes a few dozens
_HALVINGS = 24  # of a step whose modes cannot be told apart: of 20 kt, to 1e-6 kt


@dataclass(frozen=True, eq=False)
class Line:
    """Points along which modes are followed.

    Parameters
    ----------
    positions : array (points,)
        Where the points are: airspeeds in m/s, or another input in SI.
    linearize : callable, optional
        Models at positions (k,), for points between those of the line.
    name, units : str
        Of the input.
    end : float, optional
        Where an approach ends on the line that it leads to; its last position by default.
    """

    positions: Array
    linearize: Linearize | None = None
    name: str = "airspeed"
    units: str = "m/s"
    end: float | None = None

    def __post_init__(self) -> None:
        if self.end is None and np.size(self.positions):
            object.__setattr__(self, "end", float(np.asarray(self.positions)[-1]))

    def models(self, positions: Array) -> LinearModel:
        """Models at positions (k,) on or between those of the line.

        Raises
        ------
        InputError
            When the line came without what linearises it.
        """
        if self.linearize is None:
            raise InputError("line", self.name, "must come with a function that linearises at its positions")
        return self.linearize(positions)


@dataclass(frozen=True, eq=False)
class Path:
    """States of points in the order in which they are passed, one to one.

    Attributes
    ----------
    spectrum : Spectrum
        Of the points of a line, then of those between them; NaN at failed ones.
    points : array (k,) of int
        Places in the spectrum, failed points left out.
    steps : Steps
        From each point to the next.
    positions : array
        Of the points of the spectrum; NaN where they were not told.
    """

    spectrum: Spectrum
    points: Array
    steps: Steps
    positions: Array

    @cached_property
    def places(self) -> Array:
        """Which of the states of a point each followed state is (k, states)."""
        states = self.spectrum.values.shape[1]
        if not len(self.points):
            return np.empty((0, states), dtype=int)
        places = chain(self.steps.successor, np.arange(states))
        followed = np.take_along_axis(self.spectrum.values[self.points], places, 1)
        return np.take_along_axis(places, keep_upper(followed), 1)

    @cached_property
    def values(self) -> Array:
        """Followed eigenvalues (k, states)."""
        return np.take_along_axis(self.spectrum.values[self.points], self.places, 1)

    @cached_property
    def quality(self) -> Array:
        """Trust in each step of each followed state (k - 1, states)."""
        return np.take_along_axis(self.steps.quality, self.places[:-1], 1)

    def order(self, points: int) -> Array:
        """Places (points, states) at the points of the line; at failed ones they mean nothing."""
        order = np.tile(np.arange(self.spectrum.values.shape[1]), (points, 1))
        own = self.points < points
        order[self.points[own]] = self.places[own]
        return order

    def trust(self, points: int) -> Array:
        """Least quality (points, states) of the steps that led to each point of the line; 1 at the first."""
        trust = np.ones((points, self.spectrum.values.shape[1]))
        own = np.flatnonzero(self.points < points)
        if len(own) > 1:
            trust[self.points[own[1:]]] = np.minimum.reduceat(self.quality, own[:-1], axis=0)
        return trust

    def with_points(self, after: Array, positions: Array, between: Spectrum) -> Path:
        """The path with one more point in each of the steps `after`, at `positions` within them."""
        first = len(self.spectrum.values)
        spectrum = self.spectrum.joined(between)
        points = np.insert(self.points, after + 1, np.arange(first, len(spectrum.values)))
        successor, quality = (np.insert(part, after, part[after], axis=0) for part in self.steps)
        parted = np.flatnonzero((points[:-1] >= first) | (points[1:] >= first))
        successor[parted], quality[parted] = link(spectrum, points[parted], points[parted + 1])
        return Path(spectrum, points, Steps(successor, quality), np.concatenate([self.positions, positions]))


def path_of(spectrum: Spectrum, positions: Array | None = None) -> Path:
    """The path through points in their order, failed ones passed over."""
    good = np.flatnonzero(spectrum.works)
    told = np.full(len(spectrum.values), np.nan) if positions is None else positions
    return Path(spectrum, good, link(spectrum, good[:-1], good[1:]), told)


def follow(model: LinearModel, line: Line | None = None, held: list[int] | None = None) -> Path:
    """States of the points of a line of models, followed one to one.

    A step whose quality is poor is halved until it is not, where the line can be linearised between its points. A step
    that stays poor keeps its quality as a warning; where roots are alike all along it, as two motions with one
    frequency, it is given up after a number of parts. `held` as `decomposition` has it.
    """
    held = held_coordinates(model) if held is None else held
    if line is None or line.linearize is None:
        return path_of(
            decomposition(model, held), None if line is None else np.ravel(np.real(line.positions))
        )
    path = path_of(decomposition(model, held), np.asarray(line.positions, dtype=float))
    hopeless = np.zeros(max(len(path.points) - 1, 0), dtype=bool)
    origin = np.arange(len(hopeless))  # of each step: the step of the line that it is a part of
    for _ in range(_HALVINGS):
        hopeless |= np.bincount(origin, minlength=1)[origin] > _MOST_PARTS
        poor = np.flatnonzero((path.steps.quality.min(axis=1, initial=1) < POOR) & ~hopeless)
        if not len(poor):
            break
        ends = path.positions[path.points]
        middle = (ends[poor] + ends[poor + 1]) / 2
        between = decomposition(line.linearize(middle), held)
        works = between.works
        hopeless[poor[~works]] = True
        path = path.with_points(poor[works], middle[works], between.at(works))
        hopeless, origin = (np.insert(part, poor[works], part[poor[works]]) for part in (hopeless, origin))
    return path
