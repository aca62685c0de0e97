"""Eigenvalues and mode shapes of a linear model.

Signs: s = -ζω ± iω√(1 - ζ²), damping ratio ζ = -Re s / |s|, so a negative ratio is an instability. The rotor's
azimuth has no stiffness unless a shaft gives it one, and enters as a rate: n coordinates have 2n - 1 states.
In a batch in which a shaft holds the azimuth at some points only, each point has the same states as outside the batch;
arrays have room for 2n, and where a point has one state fewer its last eigenvalue is NaN.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from types import EllipsisType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from proprotor.model import stamp
from proprotor.model.first_order import (
    first_order,
    have_modes,
    held_coordinates,
    lack_azimuth,
    missing_roots,
    some_points,
)
from proprotor.model.linear_model import LinearModel
from proprotor.model.massless import with_reasons
from proprotor.rotor.motions import ROTOR_SPEED
from proprotor.stability.matching import Spectrum
from proprotor.typing import Array

if TYPE_CHECKING:
    import xarray

    from proprotor.stability.parameter_lines import ParameterLine


class Eigensystem(NamedTuple):
    """All eigenvalues of a batch of models, with vectors in the state space.

    values (..., states), right (..., states, states) in columns, left (..., states, states) in rows with
    left @ right = 1; displacement (..., n, states) is each mode's motion of the model's n coordinates.
    NaN at failed points, and the last eigenvalue of a point that has fewer than others.
    """

    values: Array
    right: Array
    left: Array
    displacement: Array


def eigensystem(model: LinearModel) -> Eigensystem:
    """Return all eigenvalues and vectors; eigenvalues of a point in no particular order, each pair side by side."""
    spectrum, held = decomposition(model), held_coordinates(model)
    values, right, left = spectrum.all_modes
    return Eigensystem(values, right, left, coordinate_motion(held, len(model.dofs), values, right))


def decomposition(model: LinearModel, held: list[int] | None = None) -> Spectrum:
    """Return eigenvalues and right vectors in the state space; of a complex model, those of its real part.

    The eigenvalue of a state that a point does not have is NaN, and stands last. States are those of the batch, or with
    `held`, places of coordinates whose displacement is a state, those of another batch with the same coordinates.
    """
    model = _real(model)
    states = len(held_coordinates(model) if held is None else held) + len(model.dofs)
    parts = [
        (points, with_azimuth(Spectrum(*_solved(first_order(part)), part.shapes), model.dofs, states))
        for points, part in _alike(model)
    ]
    if len(parts) == 1 and parts[0][0] is ...:
        return parts[0][1]
    values = np.full((*model.M.shape[:-2], states), complex(np.nan, np.nan))
    right = np.full((*values.shape, states), np.nan, dtype=complex)
    for points, found in parts:
        values[points], right[points] = found.values, found.right
    return Spectrum(values, right, model.shapes)


def eigenvalues(model: LinearModel) -> Array:
    """Return the eigenvalues (..., states) alone, in no particular order; NaN where `decomposition` has NaN."""
    states, shape = len(held_coordinates(model)) + len(model.dofs), model.M.shape[:-2]
    values = np.full((*shape, states), complex(np.nan, np.nan))
    for points, part in _alike(_real(model)):
        found = np.linalg.eigvals(first_order(part))
        values[points, : found.shape[-1]] = found
    return values


def _alike(model: LinearModel) -> Iterator[tuple[Array | EllipsisType, LinearModel]]:
    """Yield points that have modes, in parts with the same states: places of the points, and their model."""
    good, free = have_modes(model), lack_azimuth(model)
    if good.all() and not free.any():
        yield ..., model
        return
    for points in (good & ~free, good & free):
        if points.any():
            yield points, some_points(model, points)


def with_azimuth(spectrum: Spectrum, dofs: tuple[str, ...], states: int) -> Spectrum:
    """Return states of points where nothing holds the azimuth among the states, one more, of points with a shaft.

    The azimuth moves by its rate over the eigenvalue. The additional state has no eigenvalue, as the azimuth alone
    moves nothing else: the root at zero tends to this state as the shaft stiffness vanishes.
    """
    values, right, shapes = spectrum
    if values.shape[-1] == states:
        return spectrum
    place = dofs.index(ROTOR_SPEED)
    zero, rate = values == 0, right[..., len(dofs) - 1 + place, :]
    whole = np.zeros((*values.shape[:-1], states, states), dtype=complex)
    whole[..., np.delete(np.arange(states), place), :-1] = right
    whole[..., place, :-1] = np.where(zero, 0, rate / np.where(zero, 1, values))
    whole[..., place, -1] = 1
    none = np.full((*values.shape[:-1], 1), complex(np.nan, np.nan))
    return Spectrum(np.concatenate([values, none], axis=-1), whole, shapes)


def _solved(matrix: Array) -> tuple[Array, Array]:
    values, right = np.linalg.eig(matrix)
    return values.astype(complex, copy=False), right.astype(complex, copy=False)


def _real(model: LinearModel) -> LinearModel:
    if not any(np.iscomplexobj(getattr(model, name)) for name in "MCK"):
        return model
    return replace(model, M=model.M.real, C=model.C.real, K=model.K.real)


def coordinate_motion(held: list[int], n: int, values: Array, right: Array) -> Array:
    """Return the motion (..., n, modes) of the coordinates; that of a mere rate is the rate over the eigenvalue."""
    shapes = right[..., -n:, :].copy()
    shapes[..., held, :] = right[..., : len(held), :]
    rates = [place for place in range(n) if place not in held]
    with np.errstate(all="ignore"):
        shapes[..., rates, :] /= np.where(values == 0, np.nan, values)[..., None, :]
    return shapes


def participation(model: LinearModel, system: Eigensystem) -> Array:
    """Return the share of each coordinate in each mode (..., n, states), from left times right vector; it sums to 1.

    The share depends neither on units nor on the scale of vectors, unlike the largest component of a mode that mixes
    lengths and angles.
    """
    return coordinate_shares(held_coordinates(model), len(model.dofs), system.left, system.right)


def coordinate_shares(held: list[int], n: int, left: Array, right: Array) -> Array:
    """Return shares (..., n, modes) as `participation`, of left vectors in rows and right ones in columns."""
    products = np.swapaxes(left, -1, -2) * right
    products = np.sqrt(products.real**2 + products.imag**2)
    sums = products[..., -n:, :].copy()
    sums[..., held, :] += products[..., : len(held), :]
    shares: Array = sums / sums.sum(axis=-2, keepdims=True)
    return shares


def modes(model: LinearModel) -> xarray.Dataset:
    """Return modes with frequency at or above zero, by frequency.

    Parameters
    ----------
    model : LinearModel
        Leading axes of a batch are kept.

    Returns
    -------
    xarray.Dataset
        eigenvalue (rad/s), eigenvalue_error (rad/s, the bound on its rounding error, `proprotor.stability.root_error`),
        frequency (|Im s|, rad/s), natural_frequency (|s|, rad/s), damping_ratio (NaN for a root at zero within its
        error), shape (complex, largest component 1), dominant (name of the coordinate with the largest participation),
        name (what moves, see `proprotor.stability.mode_names`) and share (how much of the mode is that motion, 0 to 1);
        dimensions (..., mode) and dof. A real root is a mode of its own, with frequency 0. Points with fewer modes end
        in NaN; where a batch has points with fewer eigenvalues than others, missing gives the reason.

    Raises
    ------
    InputError
        When the mass matrix has no inverse, as that of a rotor alone may not.
    """
    from proprotor.stability.mode_names import moving  # which needs the vectors of this module
    from proprotor.stability.root_error import errors_of  # here, because it is built on this module

    system = eigensystem(model)
    model = with_reasons(model) if model.hub is None else model
    values = system.values
    moves = moving(model, values, system.left, system.right)
    error = errors_of(model, Spectrum(values, system.right))
    kept = np.where(values.imag >= 0, np.abs(values.imag), np.inf)
    order = np.argsort(kept, axis=-1, kind="stable")
    count = int(np.isfinite(kept).sum(axis=-1).max(initial=0))
    order = order[..., :count]
    there = np.isfinite(np.take_along_axis(kept, order, -1))
    values = np.where(there, np.take_along_axis(values, order, -1), np.nan)
    shapes = np.take_along_axis(system.displacement, order[..., None, :], -1)
    shares = np.take_along_axis(participation(model, system), order[..., None, :], -1)
    data = mode_dataset(model, values, np.take_along_axis(error, order, -1), shapes, shares)
    by_mode = data.eigenvalue.dims
    names = np.where(there, np.take_along_axis(moves.names, order, -1), "").astype(str)
    data["name"] = by_mode, names, {"long_name": "what moves"}
    share = np.where(there, np.take_along_axis(moves.share, order, -1), np.nan)
    data["share"] = by_mode, share, {"units": "1", "long_name": "participation of what the name says"}
    return data


def mode_dataset(
    model: LinearModel,
    values: Array,
    error: Array,
    shapes: Array,
    shares: Array,
    line: ParameterLine | None = None,
) -> xarray.Dataset:
    """Return the dataset of `modes` from eigenvalues and errors (..., mode), motions and participations (..., n, mode).

    A root at zero within its error has no damping ratio.
    """
    import xarray  # here, because it takes long to import

    leading = tuple(f"point_{axis}" for axis in range(model.airspeed.ndim))
    if len(leading) == 1:
        leading = ("airspeed" if line is None else line.name,)
    by_mode = (*leading, "mode")
    with np.errstate(all="ignore"):
        ratio = np.where(np.abs(values) <= error, np.nan, -values.real / np.abs(values))
        largest = np.take_along_axis(shapes, np.abs(np.nan_to_num(shapes)).argmax(axis=-2)[..., None, :], -2)
        shapes = np.where(np.isnan(values)[..., None, :], np.nan, shapes / largest)
    dominant = np.array(model.dofs, dtype=object)[np.nan_to_num(shares).argmax(axis=-2)]
    dominant = np.where(np.isnan(values), "", dominant)
    data = {
        "eigenvalue": (by_mode, values, {"units": "rad/s"}),
        "eigenvalue_error": (
            by_mode,
            np.where(np.isnan(values), np.nan, error),
            {"units": "rad/s", "long_name": "bound on the rounding error of the eigenvalue"},
        ),
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
    missing = missing_roots(model)
    if (missing != "").any():
        data["missing"] = (
            leading,
            missing.astype(str),
            {"long_name": "why a point has fewer roots than others"},
        )
    coordinates = {"dof": list(model.dofs), "airspeed": (leading, model.airspeed, {"units": "m/s"})}
    if line is not None and line.name != "airspeed":
        coordinates[line.name] = (leading, line.positions, {"units": line.units})
    return xarray.Dataset(data, coords=coordinates, attrs=stamp.of_model(model))
