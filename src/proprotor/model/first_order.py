"""The equations of motion in first order: which coordinates and points have states, and the matrix of those states."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from proprotor.errors import InputError
from proprotor.model.linear_model import LinearModel
from proprotor.model.massless import massless, massless_coordinates
from proprotor.rotor.motions import ROTOR_SPEED
from proprotor.typing import Array

_NO_SHAFT = "no shaft holds the azimuth: its rate has one root, where a shaft gives two"


def state_matrix(model: LinearModel) -> Array:
    """A of ẋ = A x with x the displacements without the azimuth, then all velocities; (..., 2n - 1, 2n - 1).

    With a shaft the azimuth is among the displacements: (..., 2n, 2n), NaN in its row and column at points without.
    """
    model = without_massless(model)
    matrix = first_order(model)
    matrix[~np.isfinite(model.M).all(axis=(-2, -1))] = np.nan
    return matrix


def first_order(model: LinearModel) -> Array:
    """The same for a model whose mass matrices are known to have inverses, see `have_modes`."""
    n = len(model.dofs)
    held = held_coordinates(model)
    acceleration = -np.linalg.solve(model.M, np.concatenate([model.K[..., held], model.C], axis=-1))
    matrix = np.zeros((*model.M.shape[:-2], len(held) + n, len(held) + n))
    matrix[..., np.arange(len(held)), len(held) + np.array(held)] = 1
    matrix[..., len(held) :, :] = acceleration
    free = lack_azimuth(model)
    if free.any():
        azimuth = model.dofs.index(ROTOR_SPEED)
        matrix[free, azimuth, :] = np.nan
        matrix[free, :, azimuth] = np.nan
    return matrix


def without_massless(model: LinearModel) -> LinearModel:
    """The model with NaN for a mass matrix that has no inverse, so that it spoils no other point."""
    good = have_modes(model)
    return model if good.all() else replace(model, M=np.where(good[..., None, None], model.M, np.nan))


def held_coordinates(model: LinearModel, states: int | None = None) -> list[int]:
    """Places of the coordinates whose displacement is a state anywhere: all but an azimuth that no shaft holds.

    With the number of states of a larger batch, those of that batch.
    """
    n = len(model.dofs)
    held = bool(model.shaft_holds_azimuth.any()) if states is None else states == 2 * n
    return [place for place, name in enumerate(model.dofs) if name != ROTOR_SPEED or held]


def lack_azimuth(model: LinearModel) -> Array:
    """Which points (...) do not have the azimuth among their states, while others of the batch do."""
    holds = model.shaft_holds_azimuth
    if not holds.any():
        return np.zeros(holds.shape, dtype=bool)
    return np.asarray(~holds & np.isfinite(model.K).all(axis=(-2, -1)))


def missing_roots(model: LinearModel, states: int | None = None) -> Array:
    """Why a point (...) has fewer eigenvalues than `states`, by default the most of its batch; "" where it has not."""
    n, holds = len(model.dofs), model.shaft_holds_azimuth
    most = n + len(held_coordinates(model)) if states is None else states
    own = 2 * n - ((ROTOR_SPEED in model.dofs) & ~holds)
    fewer = (own < most) & np.isfinite(model.K).all(axis=(-2, -1))
    return np.where(fewer, _NO_SHAFT, "").astype(object)


def have_modes(model: LinearModel) -> Array:
    """Which points of a batch (...) did not fail and have mass in every motion.

    A rotor alone has massless directions: its hub may move against azimuth and gimbal without moving any mass. It is
    refused where no point is left.
    """
    good, singular = np.asarray(np.isfinite(model.M).all(axis=(-2, -1))), massless(model.M)
    if model.hub is None and singular.any() and not (good & ~singular).any():
        names = massless_coordinates(model.M[singular][0], model.dofs)
        rule = "give the mass matrix no inverse: mount the rotor on a support, or hold some of them with submodel"
        raise InputError("dofs", ", ".join(names), rule)
    return good & ~singular


def some_points(model: LinearModel, points: Any) -> LinearModel:
    """M, C and K of a model at some of its points."""
    parts = {name: getattr(model, name)[points] for name in "MCK"}
    shapes = None if model.shapes is None else model.shapes[points]
    return replace(model, **parts, B=None, hub=None, rotor=None, shapes=shapes)
