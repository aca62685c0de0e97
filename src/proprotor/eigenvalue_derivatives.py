"""Exact derivatives of eigenvalues, from matrices evaluated a complex step away.

With (λ²M + λC + K) x = 0 and yᴴ its left companion, λ' = -yᴴ(λ²M' + λC' + K') x / yᴴ(2λM + C) x. The matrices are
analytic in every input, so that M' = Im M(p + ih)/h to rounding for any small h. Vectors are those of the state space:
rows of rates of the left ones, times the inverse of M, are yᴴ over its denominator, and a rate that is no displacement
needs no division by λ.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from proprotor.model import LinearModel
from proprotor.modes import held_coordinates
from proprotor.tracking import Spectrum

STEP = 1e-30  # its square vanishes beside any number of the model


def matrix_derivatives(model: LinearModel) -> tuple[NDArray, NDArray, NDArray]:
    """M', C', K' (..., n, n) of a model evaluated `STEP` away in the imaginary direction."""
    return tuple(np.imag(getattr(model, name)) / STEP for name in "MCK")


def second_order_left(model: LinearModel, left: NDArray) -> NDArray:
    """yᴴ / yᴴ(2λM + C)x (..., modes, n) of left vectors in rows of the state space (..., modes, states)."""
    rates = left[..., -len(model.dofs) :]
    mass = np.swapaxes(np.real(model.M), -1, -2)
    return np.swapaxes(np.linalg.solve(mass, np.swapaxes(rates, -1, -2)), -1, -2)


def eigenvalue_change(
    model: LinearModel,
    changes: tuple[NDArray, NDArray, NDArray],
    modes: Spectrum,
) -> NDArray:
    """First-order change (..., modes) of eigenvalues by changes of M, C and K (..., n, n).

    Parameters
    ----------
    model : LinearModel
        Whose M and coordinates the vectors belong to; its leading axes and those of the changes broadcast.
    changes : three arrays (..., n, n)
    modes : Spectrum
        values (..., modes), right (..., states, modes), left (..., modes, states), of `Spectrum.modes`.
    """
    values, right, left = modes
    n, held = len(model.dofs), held_coordinates(model)
    mass, damping, stiffness = changes
    rates, displacement = right[..., -n:, :], right[..., : len(held), :]
    load = mass @ (values[..., None, :] * rates) + damping @ rates + stiffness[..., held] @ displacement
    return -np.einsum("...mn,...nm->...m", second_order_left(model, left), load)


def defect(modes: Spectrum) -> NDArray:
    """How nearly defective modes are (..., modes): the sum of |l_k r_k| over the states, free of units, 1 at best.

    It grows without bound where two modes fall into one and derivatives cease to exist.
    """
    return np.abs(np.swapaxes(modes.left, -1, -2) * modes.right).sum(axis=-2)
