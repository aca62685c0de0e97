"""Modes followed along a line of points, each one under its own name."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from proprotor.errors import InputError
from proprotor.model import LinearModel
from proprotor.modes import Eigensystem, eigensystem, mode_dataset, participation

if TYPE_CHECKING:
    import xarray

_CYCLIC = ("_1c", "_1s")


def track(system: Eigensystem) -> NDArray:
    """Order (points, states) that keeps each state of the eigensystem in its place along the points.

    One-to-one assignment by the product of left and right vectors of neighbouring points, which is 1 for the same mode
    and 0 for another, and by distance in the complex plane where vectors do not tell. Failed points are passed over.
    """
    points, states = system.values.shape
    order = np.tile(np.arange(states), (points, 1))
    good = np.flatnonzero(np.isfinite(system.values).all(axis=1))
    for before, after in pairwise(good):
        order[after] = _assign(system, before, order[before], after)
    return order


def _assign(system: Eigensystem, before: int, order: NDArray, after: int) -> NDArray:
    from scipy.optimize import linear_sum_assignment  # here, because it takes long to import

    forward = np.abs(system.left[before][order] @ system.right[after])
    backward = np.abs(system.left[after] @ system.right[before][:, order]).T
    likeness = np.sqrt(forward * backward)
    distance = np.abs(system.values[before][order, None] - system.values[after][None, :])
    scale = np.abs(system.values[before]).max()
    _, columns = linear_sum_assignment(distance / scale - likeness)
    return columns


def sweep(model: LinearModel) -> xarray.Dataset:
    """Modes of a line of points, tracked and named.

    Returns
    -------
    xarray.Dataset
        As `LinearModel.modes`, with mode names as coordinate and the same mode in the same place at every point.

    Raises
    ------
    InputError
        When the points do not form a line.
    """
    if model.airspeed.ndim != 1:
        raise InputError(
            "airspeed", f"array of shape {model.airspeed.shape}", "must be a list of speeds to sweep"
        )
    system = eigensystem(model)
    order = track(system)
    values = np.take_along_axis(system.values, order, 1)
    shapes = np.take_along_axis(system.displacement, order[:, None, :], 2)
    shares = np.take_along_axis(participation(model, system), order[:, None, :], 2)
    good = np.isfinite(values).all(axis=1)
    kept = _one_of_each_pair(values[good])
    values, shapes, shares = values[:, kept], shapes[..., kept], shares[..., kept]
    # Of a pair that parts into two real roots the second is a mode only where it is real.
    values = np.where(values.imag < 0, np.nan, values)
    names, by_frequency = _names(model.dofs, values[good], shares[good])
    data = mode_dataset(model, values[:, by_frequency], shapes[..., by_frequency], shares[..., by_frequency])
    return data.assign_coords(mode=names)


def _one_of_each_pair(values: NDArray) -> NDArray:
    """Columns that are in the upper half plane more than in the lower, and those that are real somewhere."""
    if not len(values):  # no point worked: there are no modes
        return np.empty(0, dtype=int)
    return np.flatnonzero((values.imag.sum(axis=0) > 0) | (values.imag == 0).any(axis=0))


def _names(dofs: tuple[str, ...], values: NDArray, shares: NDArray) -> tuple[list[str], NDArray]:
    """Names from the coordinates that take part most over the sweep, and the order of their mean frequency."""
    if not len(values):
        return [], np.empty(0, dtype=int)
    frequency = np.nan_to_num(np.abs(np.where(np.isnan(values), 0, values.imag)).mean(axis=0))
    order = np.argsort(frequency, kind="stable")
    mean_shares = shares.mean(axis=0)[:, order]
    groups = [_group(dof) for dof in dofs]
    labels = sorted(set(groups), key=groups.index)
    by_group = np.stack([mean_shares[[g == label for g in groups]].sum(axis=0) for label in labels])
    names = [labels[place] for place in by_group.argmax(axis=0)]
    real = frequency[order] == 0
    return _distinct(names, real), order


def _group(dof: str) -> str:
    """A mode's family: support mode, rotor speed, or collective or cyclic motion of a blade angle or the gimbal."""
    if dof == "azimuth":
        return "rotor speed"
    if dof.startswith("gimbal"):
        return "gimbal"
    if dof.endswith(_CYCLIC):
        return f"cyclic {dof[: dof.rindex('_')]}"
    if dof.endswith("_0"):
        return {"flap_0": "coning"}.get(dof, f"collective {dof[:-2]}")
    return dof


def _distinct(names: list[str], real: NDArray) -> list[str]:
    """The same family twice is told apart as low and high, more often by number; a real root is said to be one."""
    names = [
        f"{name} (real)" if is_real and name != "rotor speed" else name
        for name, is_real in zip(names, real, strict=True)
    ]
    count, seen = Counter(names), Counter()
    distinct = []
    for name in names:
        seen[name] += 1
        if count[name] == 1:
            distinct.append(name)
        elif count[name] == 2:
            distinct.append(f"{'low' if seen[name] == 1 else 'high'} {name}")
        else:
            distinct.append(f"{name} {seen[name]}")
    return distinct
