"""Exact derivatives of eigenvalues, from matrices evaluated a complex step away.

With (λ²M + λC + K) x = 0 and yᴴ its left companion, λ' = -yᴴ(λ²M' + λC' + K') x / yᴴ(2λM + C) x. The matrices are
analytic in every input, so that M' = Im M(p + ih)/h to rounding for any small h. Vectors are those of the state space:
rows of rates of the left ones, times the inverse of M, are yᴴ over its denominator, and a rate that is no displacement
needs no division by λ.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from proprotor.errors import InputError
from proprotor.model.first_order import held_coordinates
from proprotor.model.linear_model import LinearModel
from proprotor.stability.matching import Modes
from proprotor.typing import Array

_DIFFERENCE = 1e-3  # of an input that takes no complex step
STEP = 1e-30  # its square vanishes beside any number of the model


def matrix_derivatives(model: LinearModel) -> tuple[Array, Array, Array]:
    """Return M', C', K' (..., n, n) of a model evaluated `STEP` away in the imaginary direction."""
    return tuple(np.imag(getattr(model, name)) / STEP for name in "MCK")


def with_changes(
    linearize: Callable[[Array], LinearModel], positions: Array
) -> tuple[LinearModel, tuple[Array, Array, Array]]:
    """Return models at positions (k,), and how M, C and K change with the position.

    The changes come from a complex step; where complex positions are refused, as by the numbers of a file, from
    extrapolated differences.
    """
    try:
        model = linearize(positions + 1j * STEP)
    except InputError:
        return linearize(positions), differences(linearize, positions)
    return model, matrix_derivatives(model)


def differences(linearize: Callable[[Array], LinearModel], positions: Array) -> tuple[Array, Array, Array]:
    """Return M', C', K' by central differences of two steps, extrapolated."""
    by_step = []
    for share in (_DIFFERENCE, _DIFFERENCE / 2):
        step = share * np.where(positions == 0, 1.0, np.abs(positions))
        ends = [linearize(positions + sign * step) for sign in (1, -1)]
        by_step.append(
            [(getattr(ends[0], m) - getattr(ends[1], m)) / (2 * step[..., None, None]) for m in "MCK"]
        )
    return tuple((4 * fine - coarse) / 3 for coarse, fine in zip(*by_step, strict=True))


def second_order_left(model: LinearModel, left: Array) -> Array:
    """Return yᴴ / yᴴ(2λM + C)x (..., modes, n) of left vectors in rows of the state space (..., modes, states)."""
    rates = left[..., -len(model.dofs) :]
    mass = np.swapaxes(np.real(model.M), -1, -2)
    return np.swapaxes(np.linalg.solve(mass, np.swapaxes(rates, -1, -2)), -1, -2)


def eigenvalue_change(
    model: LinearModel,
    changes: tuple[Array, Array, Array],
    modes: Modes,
) -> Array:
    """Return the first-order change (..., modes) of eigenvalues by changes of M, C and K (..., n, n).

    Parameters
    ----------
    model : LinearModel
        The model that has the vectors; its leading axes and those of the changes broadcast.
    changes : three arrays (..., n, n)
    modes : Modes
    """
    values, right, left = modes
    n, held = len(model.dofs), held_coordinates(model, right.shape[-2])
    mass, damping, stiffness = np.broadcast_arrays(*changes)
    rates, displacement = right[..., -n:, :], right[..., : len(held), :]
    motion = np.concatenate([values[..., None, :] * rates, rates, displacement], axis=-2)
    load = real_times(np.concatenate([mass, damping, stiffness[..., held]], axis=-1), motion)
    for place in set(range(n)) - set(held):  # an azimuth that nothing holds, and that a shaft would hold
        load = load + _pull(stiffness[..., place], rates[..., place, :], values)
    return np.asarray(-(second_order_left(model, left) * np.swapaxes(load, -1, -2)).sum(axis=-1))


def _pull(stiffness: Array, rate: Array, values: Array) -> Array:
    """Return the load (..., n, modes) of a change of stiffness (..., n) on a coordinate that has a rate alone."""
    with np.errstate(all="ignore"):
        motion = rate / np.where(values == 0, np.nan, values)
    column = stiffness[..., None]
    return np.where(column == 0, 0.0, column * motion[..., None, :])


def real_times(matrices: Array, vectors: Array) -> Array:
    """Multiply real matrices by complex columns in real numbers, which is half the work."""
    count = vectors.shape[-1]
    parts = matrices @ np.concatenate([vectors.real, vectors.imag], axis=-1)
    return np.asarray(parts[..., :count] + 1j * parts[..., count:])


def defect(modes: Modes) -> Array:
    """Return how nearly defective modes are (..., modes): Σ |l_k r_k| over the states, dimensionless, 1 at best.

    The sum grows without bound where two modes fall into one and derivatives cease to exist.
    """
    return np.asarray(np.abs(np.swapaxes(modes.left, -1, -2) * modes.right).sum(axis=-2))
