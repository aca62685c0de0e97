"""Eigenvalues and mode shapes of a linear model.

Signs: s = -ζω ± iω√(1 - ζ²), damping ratio ζ = -Re s / |s|, so a negative ratio is an instability. The rotor's
azimuth has no stiffness unless a shaft gives it one, and enters as a rate: n coordinates have 2n - 1 states.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from proprotor.arrays import Array
from proprotor.errors import InputError
from proprotor.massless import massless, massless_coordinates
from proprotor.model import ROTOR_SPEED, LinearModel
from proprotor.tracking import Spectrum

if TYPE_CHECKING:
    import xarray

    from proprotor.path import Line

_NEUTRAL = 1e-12  # of the largest eigenvalue: a root at zero has no damping ratio


class Eigensystem(NamedTuple):
    """All eigenvalues of a batch of models, with vectors in the state space.

    values (..., states), right (..., states, states) in columns, left (..., states, states) in rows with
    left @ right = 1; displacement (..., n, states) is each mode's motion of the model's n coordinates.
    NaN at failed points.
    """

    values: Array
    right: Array
    left: Array
    displacement: Array


def state_matrix(model: LinearModel) -> Array:
    """A of ẋ = A x with x the displacements without the azimuth, then all velocities; (..., 2n - 1, 2n - 1)."""
    _check_inertia(model)
    return first_order(model)


def first_order(model: LinearModel) -> Array:
    """The same for a model whose mass matrices are known to have inverses, see `have_modes`."""
    n = len(model.dofs)
    held = held_coordinates(model)
    acceleration = -np.linalg.solve(model.M, np.concatenate([model.K[..., held], model.C], axis=-1))
    matrix = np.zeros((*model.M.shape[:-2], len(held) + n, len(held) + n))
    matrix[..., np.arange(len(held)), len(held) + np.array(held)] = 1
    matrix[..., len(held) :, :] = acceleration
    return matrix


def _check_inertia(model: LinearModel) -> None:
    """A rotor alone has massless directions: its hub may move against azimuth and gimbal without moving any mass."""
    singular = massless(model.M)
    if singular.any():
        names = massless_coordinates(model.M[singular][0], model.dofs)
        rule = "give the mass matrix no inverse: mount the rotor on a support, or hold some of them with submodel"
        raise InputError("dofs", ", ".join(names), rule)


def held_coordinates(model: LinearModel) -> list[int]:
    """Places of the coordinates whose displacement is a state: all but an azimuth that no shaft holds."""
    return [
        place for place, name in enumerate(model.dofs) if name != ROTOR_SPEED or model.shaft_holds_azimuth
    ]


def have_modes(model: LinearModel) -> Array:
    """Which points of a batch (...) did not fail; a rotor alone with motions that have no mass is refused."""
    good = np.asarray(np.isfinite(model.M).all(axis=(-2, -1)))
    if model.hub is None:
        _check_inertia(model)
        return good
    return good & ~massless(model.M)


def eigensystem(model: LinearModel) -> Eigensystem:
    """All eigenvalues and vectors; eigenvalues of a point in no particular order, each pair side by side."""
    spectrum, held = decomposition(model), held_coordinates(model)
    values, right, left = spectrum.all_modes
    return Eigensystem(values, right, left, coordinate_motion(held, len(model.dofs), values, right))


def decomposition(model: LinearModel) -> Spectrum:
    """Eigenvalues and right vectors in the state space; of a complex model, those of its real part."""
    good, model = have_modes(model), _real(model)
    if good.all():
        return Spectrum(*_solved(first_order(model)), model.shapes)
    states = len(held_coordinates(model)) + len(model.dofs)
    values = np.full((*good.shape, states), complex(np.nan, np.nan))
    right = np.full((*good.shape, states, states), np.nan, dtype=complex)
    if good.any():
        values[good], right[good] = _solved(first_order(some_points(model, good)))
    return Spectrum(values, right, model.shapes)


def _solved(matrix: Array) -> tuple[Array, Array]:
    values, right = np.linalg.eig(matrix)
    return values.astype(complex, copy=False), right.astype(complex, copy=False)


def _real(model: LinearModel) -> LinearModel:
    if not np.iscomplexobj(model.K):
        return model
    return replace(model, M=model.M.real, C=model.C.real, K=model.K.real)


def some_points(model: LinearModel, points: Any) -> LinearModel:
    """M, C and K of a model at some of its points."""
    parts = {name: getattr(model, name)[points] for name in "MCK"}
    shapes = None if model.shapes is None else model.shapes[points]
    return replace(model, **parts, B=None, hub=None, rotor=None, shapes=shapes)


def coordinate_motion(held: list[int], n: int, values: Array, right: Array) -> Array:
    """Motion (..., n, modes) of the coordinates: that of a rate alone is the rate divided by the eigenvalue."""
    shapes = right[..., -n:, :].copy()
    shapes[..., held, :] = right[..., : len(held), :]
    rates = [place for place in range(n) if place not in held]
    with np.errstate(all="ignore"):
        shapes[..., rates, :] /= np.where(values == 0, np.nan, values)[..., None, :]
    return shapes


def participation(model: LinearModel, system: Eigensystem) -> Array:
    """Share of each coordinate in each mode (..., n, states), from left times right vector; sums to 1.

    Free of units and of how vectors are scaled, unlike the largest component of a mode that mixes lengths and angles.
    """
    return coordinate_shares(held_coordinates(model), len(model.dofs), system.left, system.right)


def coordinate_shares(held: list[int], n: int, left: Array, right: Array) -> Array:
    """Shares (..., n, modes) as `participation`, of left vectors in rows and right ones in columns."""
    products = np.swapaxes(left, -1, -2) * right
    products = np.sqrt(products.real**2 + products.imag**2)
    sums = products[..., -n:, :].copy()
    sums[..., held, :] += products[..., : len(held), :]
    shares: Array = sums / sums.sum(axis=-2, keepdims=True)
    return shares


def modes(model: LinearModel) -> xarray.Dataset:
    """Modes with frequency at or above zero, by frequency.

    Parameters
    ----------
    model : LinearModel
        Leading axes of a batch are kept.

    Returns
    -------
    xarray.Dataset
        eigenvalue (rad/s), frequency (|Im s|, rad/s), natural_frequency (|s|, rad/s), damping_ratio, shape (complex,
        largest component 1), dominant (name of the coordinate with the largest participation), name (what moves, see
        `proprotor.mode_names`) and share (how much of the mode that is, 0 to 1); dimensions (..., mode) and dof. A real
        root is a mode of its own, with frequency 0. Points with fewer modes end in NaN.

    Raises
    ------
    InputError
        When the mass matrix has no inverse, as that of a rotor alone may not.
    """
    from proprotor.mode_names import moving  # which needs the vectors of this module

    system = eigensystem(model)
    values = system.values
    moves = moving(model, values, system.left, system.right)
    kept = np.where(values.imag >= 0, np.abs(values.imag), np.inf)
    order = np.argsort(kept, axis=-1, kind="stable")
    count = int(np.isfinite(kept).sum(axis=-1).max(initial=0))
    order = order[..., :count]
    there = np.isfinite(np.take_along_axis(kept, order, -1))
    values = np.where(there, np.take_along_axis(values, order, -1), np.nan)
    shapes = np.take_along_axis(system.displacement, order[..., None, :], -1)
    shares = np.take_along_axis(participation(model, system), order[..., None, :], -1)
    data = mode_dataset(model, values, shapes, shares)
    by_mode = data.eigenvalue.dims
    names = np.where(there, np.take_along_axis(moves.names, order, -1), "").astype(str)
    data["name"] = by_mode, names, {"long_name": "what moves"}
    share = np.where(there, np.take_along_axis(moves.share, order, -1), np.nan)
    data["share"] = by_mode, share, {"units": "1", "long_name": "participation of what the name says"}
    return data


def mode_dataset(
    model: LinearModel, values: Array, shapes: Array, shares: Array, line: Line | None = None
) -> xarray.Dataset:
    """The dataset of `modes` from eigenvalues (..., mode), motions and participations (..., n, mode)."""
    import xarray  # here, because it takes long to import

    leading = tuple(f"point_{axis}" for axis in range(model.airspeed.ndim))
    if len(leading) == 1:
        leading = ("airspeed" if line is None else line.name,)
    by_mode = (*leading, "mode")
    with np.errstate(all="ignore"):
        neutral = np.abs(values) < _NEUTRAL * np.nanmax(np.abs(values), initial=0)
        ratio = np.where(neutral, np.nan, -values.real / np.abs(values))
        largest = np.take_along_axis(shapes, np.abs(np.nan_to_num(shapes)).argmax(axis=-2)[..., None, :], -2)
        shapes = np.where(np.isnan(values)[..., None, :], np.nan, shapes / largest)
    dominant = np.array(model.dofs, dtype=object)[np.nan_to_num(shares).argmax(axis=-2)]
    dominant = np.where(np.isnan(values), "", dominant)
    data = {
        "eigenvalue": (by_mode, values, {"units": "rad/s"}),
        "frequency": (
            by_mode,
            np.where(np.isnan(values), np.nan, np.abs(values.imag)),
            {"units": "rad/s", "long_name": "damped frequency"},
        ),
        "natural_frequency": (by_mode, np.abs(values), {"units": "rad/s"}),
        "damping_ratio": (by_mode, ratio, {"units": "1", "long_name": "fraction of critical damping"}),
        "shape": ((*by_mode, "dof"), np.moveaxis(shapes, -1, -2)),
        "participation": ((*by_mode, "dof"), np.moveaxis(shares, -1, -2)),
        "dominant": (by_mode, dominant.astype(str)),
        "warning": (leading, model.trim.warning.astype(str), {"long_name": "what makes a point doubtful"}),
        "reason": (leading, model.trim.reason.astype(str), {"long_name": "why a point failed"}),
    }
    coordinates = {"dof": list(model.dofs), "airspeed": (leading, model.airspeed, {"units": "m/s"})}
    if line is not None and line.name != "airspeed":
        coordinates[line.name] = (leading, line.positions, {"units": line.units})
    return xarray.Dataset(data, coords=coordinates)
