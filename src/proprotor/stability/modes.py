"""Eigenvalues and mode shapes of a linear model.

Signs: s = -ζω ± iω√(1 - ζ²), damping ratio ζ = -Re s / |s|, so a negative ratio is an instability. The rotor's
azimuth has no stiffness unless a shaft gives it one, and enters as a rate: n coordinates have 2n - 1 states.
In a batch in which a shaft holds the azimuth at some points only, each point has the same states as outside the batch;
arrays have room for 2n, and where a point has one state fewer its last eigenvalue is NaN. Blocks of coordinates that do
not couple are problems of their own: their eigenvalues stand one block after the other, and vectors are exactly zero in
other blocks.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from types import EllipsisType
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.compiled import eigenvalues as compiled_eigenvalues
from proprotor.model import stamp
from proprotor.model.batches import few_at_once
from proprotor.model.first_order import (
    blocks,
    first_order,
    first_order_at,
    have_modes,
    held_coordinates,
    lack_azimuths,
    missing_roots,
    some_points,
)
from proprotor.model.linear_model import LinearModel
from proprotor.model.massless import with_reasons
from proprotor.stability.matching import Modes, Spectrum
from proprotor.stability.participation import coordinate_shares
from proprotor.typing import Array, Dataset

_ROUNDING = 10 * float(np.finfo(float).eps)  # of the largest root: what a root at zero may be off by

if TYPE_CHECKING:
    from proprotor.stability.parameter_lines import ParameterLine


def decomposition(model: LinearModel, held: list[int] | None = None) -> Spectrum:
    """Return eigenvalues and right vectors in the state space; of a complex model, those of its real part.

    The eigenvalue of a state that a point does not have is NaN, and stands last. States are the states of the batch, or
    with `held`, places of coordinates whose displacement is a state, of another batch with the same coordinates.
    """
    held = held_coordinates(model) if held is None else held
    states = len(held) + len(model.dofs)
    parts = [(points, with_azimuths(_by_block(part), part, states)) for points, part in _alike(model)]
    if len(parts) == 1 and parts[0][0] is ...:
        return parts[0][1]
    values = np.full((*model.M.shape[:-2], states), complex(np.nan, np.nan))
    right = np.full((*values.shape, states), np.nan, dtype=complex)
    for points, found in parts:
        values[points], right[points] = found.values, found.right
    return Spectrum(values, right, model.shapes, tuple(held), blocks(model, held))


def few_spectra(model: LinearModel) -> Iterator[tuple[LinearModel, Spectrum]]:
    """Yield the points of a batch a few at a time, with M, C and K only, and their eigenvalues and right vectors.

    The vectors of all points of a large batch would not stay in the cache.
    """
    held = held_coordinates(model)
    for rows in few_at_once(model.M.shape[:-2]):
        some = some_points(model, rows)
        yield some, decomposition(some, held)


def eigenvalues(model: LinearModel) -> Array:
    """Return the eigenvalues (..., states) alone, in no particular order; NaN where `decomposition` has NaN."""
    held, shape = held_coordinates(model), model.M.shape[:-2]
    values = np.full((*shape, len(held) + len(model.dofs)), complex(np.nan, np.nan))
    places = blocks(model, held)
    for points, part in _alike(model):
        for (_, columns), own in zip(places, part.blocks, strict=True):
            found = _eigenvalues(_of_block(part, own))
            values[points, columns.start : columns.start + found.shape[-1]] = found
    return values


def _eigenvalues(model: LinearModel) -> Array:
    """Return the eigenvalues (..., states) of points with the same states, whose coordinates may all couple."""
    found = _compiled_roots(model) if model.is_compiled else _roots(model)
    if (noise := _pairs_of_noise(found)).any():
        found[noise] = 0
    return found


def _roots(model: LinearModel) -> Array:
    """Return eigenvalues by LAPACK."""
    states = len(held_coordinates(model)) + len(model.dofs)
    found = np.empty((*model.M.shape[:-2], states), dtype=complex)
    for rows in few_at_once(model.M.shape[:-2]):  # the matrices of all points would not stay in the cache
        found[rows] = np.linalg.eigvals(first_order_at(model, rows))
    return found


def _alike(model: LinearModel) -> Iterator[tuple[Array | EllipsisType, LinearModel]]:
    """Yield points that have modes, in parts with the same states: places of the points, and their real model."""
    good, lacks = have_modes(model), lack_azimuths(model).sum(axis=-1)
    model = _real(model)
    if good.all() and not lacks.any():
        yield ..., model
        return
    for count in range(len(model.azimuths) + 1):
        points = good & (lacks == count)
        if points.any():
            yield points, some_points(model, points)


def _by_block(model: LinearModel) -> Spectrum:
    """Return eigenvalues and right vectors of points with the same states, each block by itself."""
    held = held_coordinates(model)
    places = blocks(model, held)
    if len(places) == 1:
        return Spectrum(*_solved(model), model.shapes, tuple(held), places)
    states = len(held) + len(model.dofs)
    values = np.empty((*model.M.shape[:-2], states), dtype=complex)
    right = np.zeros((*values.shape, states), dtype=complex)
    for (rows, columns), own in zip(places, model.blocks, strict=True):
        values[..., columns], right[..., rows, columns] = _solved(_of_block(model, own))
    return Spectrum(values, right, model.shapes, tuple(held), places)


def _of_block(model: LinearModel, places: list[int]) -> LinearModel:
    """Return the model of a block of coordinates alone; the whole model where the block is all of the model."""
    if len(places) == len(model.dofs):
        return model
    return model.submodel(tuple(model.dofs[place] for place in places))


def with_azimuths(spectrum: Spectrum, model: LinearModel, states: int) -> Spectrum:
    """Return states of points where nothing holds some azimuth among the states, more of them, of points with shafts.

    An azimuth moves by its rate over the eigenvalue. The additional state has no eigenvalue, as the azimuth alone
    moves nothing else: the root at zero tends to this state as the shaft stiffness vanishes.

    Parameters
    ----------
    spectrum : Spectrum
    model : LinearModel
        A model with the coordinates of the spectrum.
    states : int
        Number of states of the points with shafts.
    """
    values, right = spectrum.values, spectrum.right
    if values.shape[-1] == states:
        return spectrum
    n, held = len(model.dofs), held_coordinates(model, states)
    own = held_coordinates(model, values.shape[-1])
    later = blocks(model, held)
    columns = [
        np.arange(new.start, new.start + old.stop - old.start)
        for (_, old), (_, new) in zip(blocks(model, own), later, strict=True)
    ]
    kept = np.concatenate(columns)
    rows = np.array([*(held.index(place) for place in own), *(len(held) + np.arange(n))])
    whole = np.zeros((*values.shape[:-1], states, states), dtype=complex)
    found = np.full((*values.shape[:-1], states), complex(np.nan, np.nan))
    found[..., kept] = values
    whole[..., rows[:, None], kept] = right
    free = iter(np.setdiff1d(np.arange(states), kept).tolist())  # in the order of the blocks
    for own_block in model.blocks:
        for place in own_block:
            if place in held and place not in own:
                rate = right[..., len(own) + place, :]
                whole[..., held.index(place), kept] = np.where(
                    values == 0, 0, rate / np.where(values == 0, 1, values)
                )
                whole[..., held.index(place), next(free)] = 1
    return Spectrum(found, whole, spectrum.shapes, tuple(held), later)


def _compiled_roots(model: LinearModel) -> Array:
    """Return eigenvalues by the compiled functions, and by LAPACK where they hand over."""
    found, rest = compiled_eigenvalues.roots_of_motion(*_in_one_axis(model), held_coordinates(model))
    shape = model.M.shape[:-2]
    found = found.reshape(*shape, -1)
    if rest.any():
        points = rest.reshape(shape)
        found[points] = np.linalg.eigvals(first_order(some_points(model, points)))
    return found


def _in_one_axis(model: LinearModel) -> tuple[Array, Array, Array]:
    """Return M, C and K (points, n, n)."""
    mass, damping, stiffness = (part.reshape(-1, *part.shape[-2:]) for part in (model.M, model.C, model.K))
    return mass, damping, stiffness


def _compiled_modes(model: LinearModel) -> tuple[Array, Array]:
    """Return eigenvalues and right vectors by the compiled functions, and by LAPACK where they hand over."""
    values, right, rest = compiled_eigenvalues.modes_of_motion(*_in_one_axis(model), held_coordinates(model))
    shape, states = model.M.shape[:-2], values.shape[-1]
    values, right = values.reshape(*shape, states), right.reshape(*shape, states, states)
    if rest.any():
        points = rest.reshape(shape)
        values[points], right[points] = np.linalg.eig(first_order(some_points(model, points)))
    return values, right


def _solved(model: LinearModel) -> tuple[Array, Array]:
    """Return eigenvalues and right vectors as complex numbers, also where all of them are real."""
    values, right = _compiled_modes(model) if model.is_compiled else np.linalg.eig(first_order(model))
    values, right = values.astype(complex, copy=False), right.astype(complex, copy=False)
    if not (noise := _pairs_of_noise(values)).any():
        return values, right
    upper = (noise & (values.imag > 0))[..., None, :]
    right = np.where(upper, right.real, np.where(noise[..., None, :], right.imag, right))
    right = np.where(noise[..., None, :], right / np.linalg.norm(right, axis=-2, keepdims=True), right)
    return np.where(noise, 0, values), right


def _pairs_of_noise(values: Array) -> Array:
    """Return which eigenvalues (..., states) are pairs that rounding has made of two real roots at zero.

    Coordinates that have a rate alone have such roots, as many as nothing damps.
    """
    square = values.real**2 + values.imag**2
    noise = square <= _ROUNDING**2 * square.max(axis=-1, keepdims=True, initial=0)
    return np.asarray(noise & (values.imag != 0))


def _real(model: LinearModel) -> LinearModel:
    """Return the model with the real parts of its matrices."""
    if not any(map(np.iscomplexobj, (model.M, model.C, model.K))):
        return model
    return replace(model, M=model.M.real, C=model.C.real, K=model.K.real)


def coordinate_motion(held: list[int], n: int, values: Array, right: Array) -> Array:
    """Return the motion (..., n, modes) of the coordinates: of a coordinate without displacement, its rate over λ."""
    shapes = right[..., -n:, :].copy()
    shapes[..., held, :] = right[..., : len(held), :]
    rates = [place for place in range(n) if place not in held]
    with np.errstate(all="ignore"):
        shapes[..., rates, :] /= np.where(values == 0, np.nan, values)[..., None, :]
    return shapes


def modes(model: LinearModel) -> Dataset:
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

    model = with_reasons(model) if model.hub is None else model
    spectrum = decomposition(model)
    every = spectrum.all_modes
    moves = moving(model, every.values, every.left, every.right)
    kept = np.where(every.values.imag >= 0, np.abs(every.values.imag), np.inf)
    order = np.argsort(kept, axis=-1, kind="stable")
    is_there = np.isfinite(np.take_along_axis(kept, order, -1))
    columns = np.where(is_there, order, -1)[..., : is_there.sum(axis=-1).max(initial=0)]
    data = mode_dataset(model, every, errors_of(model, spectrum), columns)
    by_mode = data.eigenvalue.dims
    data["name"] = by_mode, at_columns(moves.names, columns).astype(str), {"long_name": "what moves"}
    meaning = {"units": "1", "long_name": "participation of what the name says"}
    data["share"] = by_mode, at_columns(moves.share, columns), meaning
    return data


def mode_dataset(
    model: LinearModel, every: Modes, error: Array, columns: Array, line: ParameterLine | None = None
) -> Dataset:
    """Return the dataset of `modes` from all states of the points, with the error (..., states) of each eigenvalue.

    `columns` (..., mode) tells which state each mode is, -1 where a point lacks the mode. A root at zero within its
    error has no damping ratio.
    """
    import xarray  # here, because it takes long to import

    n, held = len(model.dofs), held_coordinates(model, every.right.shape[-2])
    leading = leading_dims(model, line)
    by_mode = (*leading, "mode")
    chosen = every.at(np.maximum(columns, 0))
    values, error = at_columns(every.values, columns), at_columns(error, columns)
    lacks = (columns < 0)[..., None, :]
    shapes = coordinate_motion(held, n, values, chosen.right)
    shares = np.where(lacks, np.nan, coordinate_shares(held, n, chosen.left, chosen.right))
    with np.errstate(all="ignore"):
        ratio = np.where(np.abs(values) <= error, np.nan, -values.real / np.abs(values))
        largest = np.take_along_axis(shapes, np.abs(np.nan_to_num(shapes)).argmax(axis=-2)[..., None, :], -2)
        shapes = np.where(np.isnan(values)[..., None, :], np.nan, shapes / largest)
    dominant = np.array(model.dofs, dtype=object)[np.nan_to_num(shares).argmax(axis=-2)]
    dominant = np.where(np.isnan(values), "", dominant)
    meaning = "bound on the rounding error of the eigenvalue"
    data = {
        "eigenvalue": (by_mode, values, {"units": "rad/s"}),
        "eigenvalue_error": (by_mode, error, {"units": "rad/s", "long_name": meaning}),
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
        **doubt_and_failure(model, leading),
    }
    missing = missing_roots(model)
    if (missing != "").any():
        meaning = "why a point has fewer roots than others"
        data["missing"] = leading, missing.astype(str), {"long_name": meaning}
    coordinates = {"dof": list(model.dofs), "airspeed": (leading, model.airspeed, {"units": "m/s"})}
    if line is not None and line.name != "airspeed":
        coordinates[line.name] = (leading, line.positions, {"units": line.units})
    return xarray.Dataset(data, coords=coordinates, attrs=stamp.of_model(model))


def at_columns(values: Array, columns: Array) -> Array:
    """Return values (..., states) of the states in the columns (..., modes) of each point; nothing at column -1."""
    nothing = "" if values.dtype == object else np.nan
    return np.where(columns >= 0, np.take_along_axis(values, np.maximum(columns, 0), -1), nothing)


def leading_dims(model: LinearModel, line: ParameterLine | None = None) -> tuple[str, ...]:
    """Return the names of the axes of a batch in a dataset: one axis is that of the airspeed or of the line's input."""
    if model.airspeed.ndim == 1:
        return ("airspeed" if line is None else line.name,)
    return tuple(f"point_{axis}" for axis in range(model.airspeed.ndim))


def doubt_and_failure(model: LinearModel, leading: tuple[str, ...]) -> dict[str, Any]:
    """Return the variables of a dataset that tell why its points (...) are doubtful, and why points failed."""
    return {
        "warning": (leading, model.trim.warning.astype(str), {"long_name": "what makes a point doubtful"}),
        "reason": (leading, model.trim.reason.astype(str), {"long_name": "why a point failed"}),
    }
