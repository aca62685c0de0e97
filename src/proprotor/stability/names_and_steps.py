"""What moves in the modes of many points, and which mode is which at the next point; names and steps share vectors."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from proprotor.model.first_order import held_coordinates, some_points
from proprotor.model.linear_model import LinearModel
from proprotor.stability.matching import Spectrum, match_modes
from proprotor.stability.mode_names import named_after
from proprotor.stability.participation import participation
from proprotor.stability.real_modes import RealModes, by_pairs, mode_of_states
from proprotor.typing import Array


class NamedPoints(NamedTuple):
    """What is known of each state of some points (points, states).

    Attributes
    ----------
    name : array of int
        Place of the name in `proprotor.rotor.motions.name_list`; -1 at failed points.
    share : array
        Participation of the motion that the name says, 0 to 1; NaN at failed points.
    group_share : array
        Participation of the coordinates of a group; NaN at failed points.
    main : array of int
        Place of the coordinate that takes most part; 0 at failed points.
    """

    name: Array
    share: Array
    group_share: Array
    main: Array


class Steps(NamedTuple):
    """Steps along lines, from each point that works to the next.

    Attributes
    ----------
    before, after : array (steps,) of int
        Points at both ends, by their place among the points of all lines.
    successor, quality : array (steps, states)
        As `proprotor.stability.matching.Matches`.
    """

    before: Array
    after: Array
    successor: Array
    quality: Array


class Walk(NamedTuple):
    """Eigenvalues (points, states) of many lines, one line after the other, what moves in them, and the steps."""

    values: Array
    named: NamedPoints
    steps: Steps


def names_and_steps(model: LinearModel, spectrum: Spectrum, group: list[int]) -> Walk:
    """Return what moves in the states of the points of some lines, and the steps along each line.

    Parameters
    ----------
    model : LinearModel
        Points (lines, points), few enough for their vectors to stay in the cache.
    spectrum : Spectrum
        Eigenvalues and vectors of the model.
    group : list of int
        Places of some coordinates, whose participation is asked for.
    """
    lines, points, states = spectrum.values.shape
    flat = Spectrum(
        spectrum.values.reshape(-1, states),
        spectrum.right.reshape(-1, states, states),
        blocks=spectrum.blocks,
    )
    shape = flat.values.shape
    share, of_group = np.full((2, *shape), np.nan)
    named, real = NamedPoints(np.full(shape, -1), share, of_group, np.zeros(shape, dtype=int)), {}
    for places, pairs in by_pairs(flat.values):
        values = flat.values[places]
        real[pairs] = RealModes.of(values, flat.right[places], pairs)
        own = some_points(model, np.unravel_index(places, (lines, points)))
        for array, part in zip(named, _named(own, values, real[pairs], group), strict=True):
            array[places] = part
    before, after = _neighbours(spectrum.works)
    return Walk(flat.values, named, Steps(before, after, *match_modes(flat, before, after, real)))


def joined(walks: Sequence[Walk]) -> Walk:
    """Return the lines of all walks, in their order."""
    values = np.concatenate([walk.values for walk in walks])
    named = NamedPoints(*map(np.concatenate, zip(*(walk.named for walk in walks), strict=True)))
    first = np.cumsum([0, *(len(walk.values) for walk in walks[:-1])])
    steps = (
        Steps(start + walk.steps.before, start + walk.steps.after, *walk.steps[2:])
        for start, walk in zip(first, walks, strict=True)
    )
    return Walk(values, named, Steps(*map(np.concatenate, zip(*steps, strict=True))))


def _named(model: LinearModel, values: Array, real: RealModes, group: list[int]) -> NamedPoints:
    """Return what is known of points with one number of pairs."""
    taken = participation(model, held_coordinates(model, values.shape[-1]), real.left, real.right)
    name = named_after(model, values, real.upper, taken.names)
    of_modes = (
        name,
        np.take_along_axis(taken.names, name[None], 0)[0],
        taken.coordinates[group].sum(axis=0),
        taken.coordinates.argmax(axis=0),
    )
    mode = mode_of_states(values, real.upper)
    return NamedPoints(*(np.take_along_axis(array.T, mode, 1) for array in of_modes))


def _neighbours(works: Array) -> tuple[Array, Array]:
    """Return the points at both ends of each step along a line, over its failed points, from (lines, points)."""
    points = np.flatnonzero(works)
    same_line = np.diff(points // works.shape[1]) == 0
    return points[:-1][same_line], points[1:][same_line]
