"""Branches: exact roots followed along a path, each labelled after what moves in it at the anchor.

A label belongs to a root and not to a motion: where two roots veer, each keeps its label though they exchange their
motions. It is the same in any range and for any step, as long as each step tells which root is which; `trust` says
how far that holds. A pair that parts into two real roots does not tell which of them it becomes: both have its label,
the one that decays faster as the second root. A pair in which roots of two labels have joined has the first of them in
the order of the coordinates.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from proprotor.rotor.motions import SECOND
from proprotor.stability.following import Path
from proprotor.stability.matching import NOT_TOLD, POOR, conjugate
from proprotor.typing import Array

if TYPE_CHECKING:
    import xarray


class Named(NamedTuple):
    """What the states of one point of a path are called, in the order of its spectrum.

    point : place of the point in the path; known : all names of the model; place (states,) : which of them each state
    has; trust (states,) : in the steps from the anchor to the point; told : where names were given; eigen_solves : what
    that took beyond the path's own.
    """

    point: int
    known: list[str]
    place: Array
    trust: Array
    told: str
    eigen_solves: int

    @property
    def names(self) -> list[str]:
        """The name of each state."""
        return [self.known[place] for place in self.place]


class Branches(NamedTuple):
    """Branches at the points of a line.

    Attributes
    ----------
    label : array (points, states) of object
        As text; empty at failed points.
    trust : array (points, states)
        Least quality of all steps between the anchor and a point, 0 to 1: where it is low, the label may be that of
        another root. NaN at failed points.
    doubt : array (points,) of object
        Which branches the step to a point does not tell apart, as a sentence; empty where it does.
    """

    label: Array
    trust: Array
    doubt: Array


def branches(path: Path, named: Named, points: int) -> Branches:
    """Labels of all states at the first points of a path's spectrum, those of its line."""
    states = path.spectrum.values.shape[1]
    label = np.full((points, states), "", dtype=object)
    trust = np.full((points, states), np.nan)
    doubt = np.full(points, "", dtype=object)
    rows = np.flatnonzero(path.points < points)
    if not len(rows):
        return Branches(label, trust, doubt)
    own = path.points[rows]
    values = path.spectrum.values[own]
    start = path.places[named.point]  # of the followed states, where they have their names
    kept = np.empty((len(rows), states), dtype=int)
    np.put_along_axis(kept, path.places[rows], np.broadcast_to(named.place[start], kept.shape), 1)
    kept = np.minimum(kept, np.take_along_axis(kept, conjugate(values), 1))
    label[own] = _as_text(kept, values, named.known)
    ways = np.empty((len(rows), states))
    np.put_along_axis(ways, path.places[rows], _from_anchor(path, named.point, named.trust[start])[rows], 1)
    trust[own] = np.minimum(ways, np.take_along_axis(ways, conjugate(values), 1))
    _tell(doubt, path, label, points)
    return Branches(label, trust, doubt)


def _as_text(kept: Array, values: Array, known: list[str]) -> Array:
    """Labels by name; of two states that are modes and have one label, the one that decays faster is the second."""
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


def _from_anchor(path: Path, point: int, start: Array) -> Array:
    """Least quality (k, states) of the steps between a point of the path, with its own, and each other one."""
    trust = np.ones((len(path.points), len(start)))
    trust[point] = start
    trust[point + 1 :], trust[:point] = path.quality[point:], path.quality[:point]
    trust[point:] = np.minimum.accumulate(trust[point:], axis=0)
    trust[: point + 1] = np.minimum.accumulate(trust[point::-1], axis=0)[::-1]
    return trust


def _tell(doubt: Array, path: Path, label: Array, points: int) -> None:
    """Name the branches that the step to a point does not tell apart."""
    by_place = np.empty((points, label.shape[1]))
    np.put_along_axis(by_place, path.order(points), path.trust(points), 1)
    for point in np.flatnonzero((by_place < POOR).any(axis=1) & (label != "").all(axis=1)):
        names = dict.fromkeys(label[point, by_place[point] < POOR])
        doubt[point] = f"{NOT_TOLD}: {', '.join(names)}"


def by_branch(sweep: xarray.Dataset) -> xarray.Dataset:
    """A sweep with an exact root, in place of a motion, in each place.

    Parameters
    ----------
    sweep : xarray.Dataset
        Of `Case.sweep`.

    Returns
    -------
    xarray.Dataset
        The same numbers with the dimension ``branch`` in place of ``mode``; name (..., branch), what moves in a root at
        a point. NaN where a root is not there: a second root is only where a pair has parted.
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
