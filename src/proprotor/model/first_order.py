"""The equations of motion in first order, ẋ = A x: which points and coordinates have states, and the state matrix.

The state x is the displacements, then the velocities of all n coordinates. A coordinate along which nothing has
stiffness is no displacement of x, only a velocity: the rates of the model, and an azimuth that no shaft holds.
Coordinates that do not couple have states of their own (`blocks`), and eigenvalues of their own, one block after the
other.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, replace
from functools import lru_cache
from typing import Any

import numpy as np

from proprotor.compiled.motion import state_matrices
from proprotor.errors import InputError
from proprotor.model.batches import Rows, at_rows, few_at_once
from proprotor.model.linear_model import LinearModel
from proprotor.model.massless import massless_coordinates
from proprotor.typing import Array

StateBlocks = tuple[
    tuple[Array, slice], ...
]  # rows of the state vector, and columns of the modes, of each block
_NO_SHAFT = "no shaft holds the azimuth: its rate has one root, where a shaft gives two"


def state_matrix(model: LinearModel) -> Array:
    """Return the state matrix A.

    Parameters
    ----------
    model : LinearModel

    Returns
    -------
    array (..., states, states)
        SI units, NaN at points without modes; 2n states, less one for each coordinate that has a rate alone. In a batch
        with a shaft at some points only, the row and column of the azimuth are NaN at the other points.

    Raises
    ------
    InputError
        For a rotor alone in which some motion has no mass at every point.
    """
    model = without_massless(model)
    matrix = first_order(model)
    if not model.finite.all():
        matrix[~model.finite] = np.nan
    return matrix


def first_order(model: LinearModel) -> Array:
    """Return A as `state_matrix` does, for a model whose mass matrices all have an inverse, see `have_modes`."""
    if model.is_compiled and all(part.dtype.kind == "f" for part in (model.M, model.C, model.K)):
        matrix = _compiled(model)
    else:
        states, shape = len(held_coordinates(model)) + len(model.dofs), model.M.shape[:-2]
        matrix = np.empty((*shape, states, states), dtype=np.result_type(model.M, model.C, model.K))
        for rows in few_at_once(shape):
            first_order_at(model, rows, matrix[rows])
    for state, free in lacking_states(model):
        matrix[free, state, :] = np.nan
        matrix[free, :, state] = np.nan
    return matrix


def _compiled(model: LinearModel) -> Array:
    """Return A by compiled functions, and by LAPACK where the mass matrix takes exchanges of rows."""
    n, shape = len(model.dofs), model.M.shape[:-2]
    mass, damping, stiffness = (part.reshape(-1, n, n) for part in (model.M, model.C, model.K))
    matrix, left = state_matrices(mass, damping, stiffness, held_coordinates(model))
    matrix = matrix.reshape(*shape, *matrix.shape[-2:])
    if left.any():
        points = left.reshape(shape)
        matrix[points] = first_order_at(some_points(model, points), ...)
    return matrix


def first_order_at(model: LinearModel, rows: Rows, out: Array | None = None) -> Array:
    """Return A of some rows of a batch, all of whose points have the same states, and a mass matrix with an inverse.

    Parameters
    ----------
    model : LinearModel
    rows : slice or ...
        Of the first axis of the batch.
    out : array (rows, ..., states, states), optional
        Where the matrices are put.
    """
    held, shape = held_coordinates(model), model.M.shape[:-2]
    rates = _rates(tuple(held), len(model.dofs))
    mass, damping, stiffness = (at_rows(part, rows, shape) for part in (model.M, model.C, model.K))
    loads = np.concatenate([stiffness.take(held, -1), damping], axis=-1)
    matrix = np.empty((*loads.shape[:-2], *rates.shape[1:] * 2), dtype=loads.dtype) if out is None else out
    matrix[..., : len(held), :] = rates
    np.negative(np.linalg.solve(mass, loads), out=matrix[..., len(held) :, :])
    return matrix


@lru_cache(maxsize=32)
def _rates(held: tuple[int, ...], n: int) -> Array:
    """Return the rows of A that say that the rate of a displacement is a state, (held, held + n)."""
    found = np.zeros((len(held), len(held) + n))
    found[np.arange(len(held)), len(held) + np.array(held, dtype=int)] = 1
    return found


def without_massless(model: LinearModel) -> LinearModel:
    """Return the model with NaN in place of each mass matrix that has no inverse, so that no other point fails."""
    good = have_modes(model)
    return model if good.all() else replace(model, M=np.where(good[..., None, None], model.M, np.nan))


def have_modes(model: LinearModel) -> Array:
    """Return which points of a batch (...) have a trim and mass in every motion.

    A rotor alone has motions without mass: its hub can move against azimuth and gimbal so that no mass moves.

    Raises
    ------
    InputError
        For a rotor alone of which no point is left.
    """
    good, singular = model.finite, model.massless
    if model.hub is None and singular.any() and not (good & ~singular).any():
        names = massless_coordinates(model.M[singular][0], model.dofs)
        rule = "give the mass matrix no inverse: mount the rotor on a support, or hold some of them with submodel"
        raise InputError("dofs", ", ".join(names), rule)
    return good & ~singular


def some_points(model: LinearModel, points: Any) -> LinearModel:
    """Return the model at some of its points, with M, C and K only."""
    parts = {name: getattr(model, name)[points] for name in "MCK"}
    shapes = None if model.shapes is None else model.shapes[points]
    none: dict[str, Any] = dict.fromkeys(("B", "hub", "rotor", "left", "left_hub", "feedback"))
    return replace(model, **parts, **none, shapes=shapes)


def in_one_axis(model: LinearModel) -> LinearModel:
    """Return the model with one axis of points in place of two; it then has M, C, K and the motion of the hub only."""
    if model.airspeed.ndim != 2:
        return model
    n, trim = len(model.dofs), model.trim
    parts: dict[str, Any] = {name: getattr(model, name).reshape(-1, n, n) for name in "MCK"}
    shapes = None if model.shapes is None else model.shapes.reshape(-1, *model.shapes.shape[-2:])
    flat = {one.name: getattr(trim, one.name).reshape(-1) for one in fields(trim)}
    hub = model.hub
    if hub is not None and hub.ndim > 2:
        hub = np.broadcast_to(hub, (*model.M.shape[:-2], *hub.shape[-2:])).reshape(-1, *hub.shape[-2:])
    none: dict[str, Any] = dict.fromkeys(("B", "rotor", "left", "left_hub"))
    return replace(
        model,
        **parts,
        **none,
        hub=hub,
        shapes=shapes,
        trim=replace(trim, **flat),
        airspeed=model.airspeed.reshape(-1),
    )


def held_coordinates(model: LinearModel, states: int | None = None) -> list[int]:
    """Return the places of the coordinates whose displacement is a state: all but rates and azimuths without shaft.

    Parameters
    ----------
    model : LinearModel
    states : int, optional
        Number of states of the larger batch that the model is a part of, where the shaft may hold other points.
    """
    azimuths = model.azimuths
    if states is None:
        count = int(np.count_nonzero(_anywhere(model.azimuths_held)))
    else:
        count = states - (2 * len(model.dofs) - len(model.rates) - len(azimuths))
    return list(_places_without(model.dofs, (*model.rates, *azimuths[count:])))


@lru_cache(maxsize=32)
def _places_without(dofs: tuple[str, ...], loose: tuple[str, ...]) -> tuple[int, ...]:
    """Return the places of all but some coordinates."""
    return tuple(place for place, name in enumerate(dofs) if name not in loose)


def lack_azimuths(model: LinearModel) -> Array:
    """Return which azimuths points (..., azimuths) lack among their states though other points of the batch do not."""
    holds = model.azimuths_held
    if holds.ndim == 1:
        return np.zeros_like(holds)
    lacks = np.asarray(_anywhere(holds) & ~holds)
    if lacks.any():
        lacks &= np.asarray(np.isfinite(model.K).all(axis=(-2, -1)))[..., None]
    return lacks


def _anywhere(holds: Array) -> Array:
    """Return which azimuths (azimuths,) a shaft holds at some point (..., azimuths)."""
    return holds if holds.ndim == 1 else np.asarray(holds.any(axis=tuple(range(holds.ndim - 1))))


def lacking_states(model: LinearModel) -> Iterator[tuple[int, Array]]:
    """Yield the place of each azimuth among the states that some points lack, with these points (...)."""
    if model.azimuths_held.ndim == 1 or not (lacks := lack_azimuths(model)).any():
        return
    held = held_coordinates(model)
    for name, free in zip(model.azimuths, np.moveaxis(lacks, -1, 0), strict=True):
        if free.any():
            yield held.index(model.dofs.index(name)), free


def missing_roots(model: LinearModel, states: int | None = None) -> Array:
    """Return the reason for which a point (...) has fewer eigenvalues than `states`, else "".

    `states` is by default the largest number of states in the batch.
    """
    n, holds = len(model.dofs), model.azimuths_held
    most = n + len(held_coordinates(model)) if states is None else states
    own = 2 * n - len(model.rates) - (~holds).sum(axis=-1)
    fewer = (own < most) & np.isfinite(model.K).all(axis=(-2, -1))
    return np.where(fewer, _NO_SHAFT, "").astype(object)


def blocks(model: LinearModel, held: list[int]) -> StateBlocks:
    """Return the states of each group of coordinates that do not couple with others: rows, and columns of modes.

    Parameters
    ----------
    model : LinearModel
    held : list of int
        Places of the coordinates whose displacement is a state.
    """
    found, start = [], 0
    for own in model.blocks:
        rows = [held.index(place) for place in own if place in held] + [len(held) + place for place in own]
        found.append((np.array(rows, dtype=int), slice(start, start + len(rows))))
        start += len(rows)
    return tuple(found)
