"""Labels of branches: exact roots followed along a line, each labelled after what moves in it at the anchor.

A label belongs to a root and not to a motion: where two roots veer, each keeps its label though they exchange their
motions. A label is the same in any range and for any step, as long as each step tells which root is which; `trust` says
how far a label holds. A pair that parts into two real roots does not tell which of the two it becomes: both have the
label of the pair, the one that decays faster as the second root. A pair in which roots of two labels have joined has
the label that comes first in the order of the coordinates.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from proprotor.model.first_order import held_coordinates, some_points
from proprotor.model.linear_model import LinearModel
from proprotor.rotor.motions import SECOND, name_list
from proprotor.stability.following import Branches, follow
from proprotor.stability.matching import NOT_TOLD, POOR, Spectrum, conjugate, match_modes
from proprotor.stability.mode_names import moving
from proprotor.stability.modes import with_azimuths
from proprotor.stability.parameter_lines import ParameterLine
from proprotor.typing import Array, Dataset


class NamedStates(NamedTuple):
    """Names of the states of one point of some branches, in the order of the point's spectrum.

    point : place of the point among the points of the branches; known : all names of the model; place (states,) : place
    of each state's name in `known`; trust (states,) : in the steps from the anchor to the point; where : position at
    which names were given, as text; eigen_solves : number of eigen-solves beyond the points of the branches.
    """

    point: int
    known: list[str]
    place: Array
    trust: Array
    where: str
    eigen_solves: int = 0

    @property
    def names(self) -> list[str]:
        """The name of each state."""
        return [self.known[place] for place in self.place]


class BranchLabels(NamedTuple):
    """Labels of branches at the points of a line.

    Attributes
    ----------
    label : array (points, states) of object
        As text; empty at failed points.
    trust : array (points, states)
        Least quality of all steps between the anchor and a point, 0 to 1: where it is low, the label may be that of
        another root. NaN at failed points.
    doubt : array (points,) of object
        Which branches the step to a point does not tell apart, as a sentence; empty where all branches are told apart.
    """

    label: Array
    trust: Array
    doubt: Array


# Names ---------------------------------------------------------------------------------------------------------------


def name_states(branches: Branches, line: ParameterLine, approach: ParameterLine | None) -> NamedStates:
    """Name the states of one point of some branches of a line.

    With an approach that can be followed from end to end: at the point that is nearest to the end of the approach, by
    the names that the states have at the anchor. Without an approach: at the first point of the line that works, by
    what moves at this point.
    """
    if approach is not None and len(branches.points):
        named = _named_by_approach(branches, approach)
        if named is not None:
            return named
    own = np.flatnonzero(branches.points < len(line.positions))  # points of the line, and none between
    return named_at(branches, line, int(own[0]) if len(own) else 0)


def named_at(branches: Branches, line: ParameterLine, place: int) -> NamedStates:
    """Name the states of a point of some branches by what moves at the point."""
    if not len(branches.points):
        return NamedStates(place, [], np.empty(0, dtype=int), np.empty(0), "")
    point = int(branches.points[place])
    position = np.asarray(line.positions)[[point]]
    model = line.models(position) if line.model is None else some_points(line.model, [point])
    where = f"{line.name} {float(position[0]):.6g} {line.units}"
    names = names_of(model, branches.spectrum.at([point]))
    return NamedStates(place, name_list(model.dofs), names, np.ones(len(names)), where)


def names_of(model: LinearModel, spectrum: Spectrum) -> Array:
    """Return what moves in each state (states,) of a model of one point, by its place in `name_list`."""
    values, right, left = spectrum.all_modes
    return np.asarray(moving(model, values, left, right).place[0])


def _named_by_approach(branches: Branches, approach: ParameterLine) -> NamedStates | None:
    """Name states by their names at the anchor; None where the approach cannot be followed from end to end."""
    near = approach.models()
    n, states = len(near.dofs), branches.spectrum.values.shape[1]
    # A shaft may hold the azimuth on one of the two lines only.
    held = held_coordinates(near, max(states, n + len(held_coordinates(near))))
    leg, last = follow(near, approach, held), len(approach.positions) - 1
    if not len(leg.points) or [leg.points[0], leg.points[-1]] != [0, last]:
        return None
    end = approach.positions[-1] if approach.end is None else approach.end
    nearest = int(np.argmin(np.abs(branches.positions[branches.points] - end)))
    here = branches.spectrum.at([int(branches.points[nearest])])
    at_anchor = names_of(some_points(near, [0]), leg.spectrum.at([0]))[leg.places[0]]
    ends = leg.spectrum.at([last]).joined(with_azimuths(here, near, n + len(held)))
    arrived = match_modes(ends, np.array([0]), np.array([1])).successor[0][leg.places[-1]]
    place, trust = np.empty_like(at_anchor), np.empty(len(at_anchor))
    place[arrived], trust[arrived] = at_anchor, leg.quality.min(axis=0, initial=1)
    where = f"{approach.name} {approach.positions[0]:.6g} {approach.units}"
    return NamedStates(nearest, name_list(near.dofs), place[:states], trust[:states], where, len(leg.points))


# Labels --------------------------------------------------------------------------------------------------------------


def branch_labels(branches: Branches, named: NamedStates, points: int) -> BranchLabels:
    """Return the labels of all states at the points of a line, the first in the spectrum of its branches."""
    states = branches.spectrum.values.shape[1]
    label = np.full((points, states), "", dtype=object)
    trust = np.full((points, states), np.nan)
    rows = np.flatnonzero(branches.points < points)
    if not len(rows):
        return BranchLabels(label, trust, np.full(points, "", dtype=object))
    own = branches.points[rows]
    values = branches.spectrum.values[own]
    start = branches.places[named.point]  # places of the branches at the point where they have their names
    branch = branches.places[rows].argsort(axis=1)  # of each state
    kept = named.place[start][branch]
    kept = np.minimum(kept, np.take_along_axis(kept, conjugate(values), 1))
    label[own] = _as_text(kept, values, named.known)
    ways = np.take_along_axis(_from_anchor(branches, named.point, named.trust[start])[rows], branch, 1)
    trust[own] = np.minimum(ways, np.take_along_axis(ways, conjugate(values), 1))
    return BranchLabels(label, trust, _doubts(branches, label, points))


def _as_text(kept: Array, values: Array, known: list[str]) -> Array:
    """Return labels by name; of two modes of a point with one label, the one that decays faster is the second root."""
    text = np.array(known, dtype=object)[kept]
    is_mode = values.imag >= 0
    for name in range(len(known)):
        alike = is_mode & (kept == name)
        for row in np.flatnonzero(alike.sum(axis=1) > 1):
            places = np.flatnonzero(alike[row])
            first = places[np.lexsort((-values[row, places].imag, -values[row, places].real))[0]]
            second = places[places != first]
            text[row, [*second, *conjugate(values[row])[second]]] = known[name] + SECOND
    return text


def _from_anchor(branches: Branches, point: int, start: Array) -> Array:
    """Return the least quality (k, states) of the steps between a point of the branches and each other point.

    `start` (states,) is the trust in the point itself.
    """
    trust = np.ones((len(branches.points), len(start)))
    trust[point] = start
    trust[point + 1 :], trust[:point] = branches.quality[point:], branches.quality[:point]
    trust[point:] = np.minimum.accumulate(trust[point:], axis=0)
    trust[: point + 1] = np.minimum.accumulate(trust[point::-1], axis=0)[::-1]
    return trust


def _doubts(branches: Branches, label: Array, points: int) -> Array:
    """Return the sentence (points,) that names the branches which the step to a point does not tell apart."""
    doubt = np.full(points, "", dtype=object)
    own = np.flatnonzero(branches.points < points)  # points of the line, and none between
    if len(own) > 1:
        # In any step since the point before.
        poor = np.minimum.reduceat(branches.quality, own[:-1], axis=0) < POOR
        for row in np.flatnonzero(poor.any(axis=1)):
            point, places = branches.points[own[row + 1]], branches.places[own[row + 1]]
            names = dict.fromkeys(label[point, np.sort(places[poor[row]])])
            doubt[point] = f"{NOT_TOLD}: {', '.join(names)}"
    return doubt


def by_branch(sweep: Dataset) -> Dataset:
    """Return a sweep by exact roots in place of motions.

    Parameters
    ----------
    sweep : xarray.Dataset
        Of `Case.sweep`.

    Returns
    -------
    xarray.Dataset
        The same numbers with the dimension ``branch`` in place of ``mode``; name (..., branch), what moves in a root at
        a point. NaN where a root does not exist: a second root exists only where a pair has parted.
    """
    import xarray  # here, because it takes long to import

    line, label = str(sweep.branch.dims[0]), sweep.branch.values
    labels = [str(text) for text in dict.fromkeys(label.T[label.T != ""].tolist())]
    is_there = label[:, :, None] == np.array(labels)
    places = xarray.DataArray(is_there.argmax(axis=1), dims=(line, "branch"))
    points = xarray.DataArray(np.arange(len(label)), dims=line)
    there = xarray.DataArray(is_there.any(axis=1), dims=(line, "branch"))
    by_mode = {
        name: part for name, part in sweep.drop_vars("branch").data_vars.items() if "mode" in part.dims
    }
    found = {name: part.isel({line: points, "mode": places}) for name, part in by_mode.items()}
    found["name"] = sweep.mode.isel(mode=places)
    kept = {
        name: part.drop_vars("mode", errors="ignore").where(there, "" if part.dtype.kind in "UO" else np.nan)
        for name, part in found.items()
    }
    others = sweep.drop_vars([*by_mode, "branch", "mode"])
    return others.assign(kept).assign_coords(branch=labels).assign_attrs(sweep.attrs)
