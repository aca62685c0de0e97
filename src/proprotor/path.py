"""States followed along a line of points, with more points put between them where that is needed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from proprotor.model import LinearModel
from proprotor.modes import decomposition
from proprotor.tracking import POOR, Spectrum, Steps, chain, keep_upper, link

Linearize = Callable[[NDArray], LinearModel]  # positions (k,) along a line to the models there

_HALVINGS = 7  # of a step whose modes cannot be told apart: of 5 kt, to 0.04 kt


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

    positions: NDArray
    linearize: Linearize | None = None
    name: str = "airspeed"
    units: str = "m/s"
    end: float | None = None

    def __post_init__(self) -> None:
        if self.end is None and np.size(self.positions):
            object.__setattr__(self, "end", float(np.asarray(self.positions)[-1]))


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
        Of the points of the spectrum; None where they were not told.
    """

    spectrum: Spectrum
    points: NDArray
    steps: Steps
    positions: NDArray | None = None

    @cached_property
    def places(self) -> NDArray:
        """Which of the states of a point each followed state is (k, states)."""
        states = self.spectrum.values.shape[1]
        if not len(self.points):
            return np.empty((0, states), dtype=int)
        places = chain(self.steps.successor, np.arange(states))
        followed = np.take_along_axis(self.spectrum.values[self.points], places, 1)
        return np.take_along_axis(places, keep_upper(followed), 1)

    @cached_property
    def values(self) -> NDArray:
        """Followed eigenvalues (k, states)."""
        return np.take_along_axis(self.spectrum.values[self.points], self.places, 1)

    @cached_property
    def quality(self) -> NDArray:
        """Trust in each step of each followed state (k - 1, states)."""
        return np.take_along_axis(self.steps.quality, self.places[:-1], 1)

    def order(self, points: int) -> NDArray:
        """Places (points, states) at the points of the line; at failed ones they mean nothing."""
        order = np.tile(np.arange(self.spectrum.values.shape[1]), (points, 1))
        own = self.points < points
        order[self.points[own]] = self.places[own]
        return order

    def trust(self, points: int) -> NDArray:
        """Least quality (points, states) of the steps that led to each point of the line; 1 at the first."""
        trust = np.ones((points, self.spectrum.values.shape[1]))
        own = np.flatnonzero(self.points < points)
        if len(own) > 1:
            trust[self.points[own[1:]]] = np.minimum.reduceat(self.quality, own[:-1], axis=0)
        return trust

    def with_points(self, after: NDArray, positions: NDArray, between: Spectrum) -> Path:
        """The path with one more point in each of the steps `after`, at `positions` within them."""
        first = len(self.spectrum.values)
        spectrum = self.spectrum.joined(between)
        points = np.insert(self.points, after + 1, np.arange(first, len(spectrum.values)))
        successor, quality = (np.insert(part, after, part[after], axis=0) for part in self.steps)
        parted = np.flatnonzero((points[:-1] >= first) | (points[1:] >= first))
        successor[parted], quality[parted] = link(spectrum, points[parted], points[parted + 1])
        return Path(spectrum, points, Steps(successor, quality), np.concatenate([self.positions, positions]))


def path_of(spectrum: Spectrum, positions: NDArray | None = None) -> Path:
    """The path through points in their order, failed ones passed over."""
    good = np.flatnonzero(spectrum.works)
    return Path(spectrum, good, link(spectrum, good[:-1], good[1:]), positions)


def follow(model: LinearModel, line: Line | None = None) -> Path:
    """States of the points of a line of models, followed one to one.

    A step whose quality is poor is halved until it is not, where the line can be linearised between its points. A step
    that stays poor keeps its quality as a warning.
    """
    if line is None or line.linearize is None:
        return path_of(decomposition(model))
    path = path_of(decomposition(model), np.asarray(line.positions, dtype=float))
    hopeless = np.zeros(max(len(path.points) - 1, 0), dtype=bool)
    for _ in range(_HALVINGS):
        poor = np.flatnonzero((path.steps.quality.min(axis=1, initial=1) < POOR) & ~hopeless)
        if not len(poor):
            break
        ends = path.positions[path.points]
        middle = (ends[poor] + ends[poor + 1]) / 2
        between = decomposition(line.linearize(middle))
        works = between.works
        hopeless[poor[~works]] = True
        path = path.with_points(poor[works], middle[works], between.at(works))
        hopeless = np.insert(hopeless, poor[works], hopeless[poor[works]])
    return path
