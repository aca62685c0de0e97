"""Find neutral structural (hysteretic) damping: springs S (1 + ig), which are defined in steady oscillation, s = iω."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError
from proprotor.model.linear_model import LinearModel
from proprotor.typing import Array

_ROUNDING = 1e-6  # largest part, relative to the whole, that counts as zero


class NeutralDamping(NamedTuple):
    """Structural dampings at which a model oscillates steadily, from the largest down, then NaN.

    damping : array (..., n²)
        g, dimensionless; above the largest value no mode changes its stability.
    frequency : array (..., n²)
        ω, rad/s, above zero.
    shape : array (..., n², n)
        Motion of the model's coordinates, complex amplitudes of exp(iωt), of unit length.
    """

    damping: Array
    frequency: Array
    shape: Array


def neutral_damping(model: LinearModel, springs: ArrayLike) -> NeutralDamping:
    """Return all structural dampings g of the springs S at which a mode is neutrally stable, without iteration.

    With s = iω the equations are (A + igS) u = 0, A = K - ω²M + iωC. For a real g the conjugate equations have
    the same g, and both together give equations without g: (A ⊗ S + S ⊗ A*)(u ⊗ u*) = 0, or

        s² (M ⊗ S + S ⊗ M) + s (C ⊗ S - S ⊗ C) + (K ⊗ S + S ⊗ K) = 0

    whose eigenvalues on the imaginary axis contain every ω; g is then an eigenvalue of iS⁻¹A.

    Parameters
    ----------
    model : LinearModel
        The model without structural damping; its stiffness contains the elastic springs S, its damping is viscous.
    springs : array_like, shape (n, n)
        S, SI (N/m, N m/rad), invertible, such as the stiffness of the support of a rigid propeller.

    Returns
    -------
    NeutralDamping
        From the largest damping down, dampings dimensionless, frequencies in rad/s.

    Raises
    ------
    InputError
        When S is not invertible: a coordinate without a spring has no structural damping.
    """
    springs = np.asarray(springs, dtype=float)
    if np.linalg.matrix_rank(springs) < len(model.dofs):
        raise InputError("springs", springs.tolist(), f"must be invertible on {', '.join(model.dofs)}")
    frequency = _frequencies(model, springs)
    s = 1j * frequency[..., None, None]
    M, C, K = (getattr(model, name)[..., None, :, :] for name in "MCK")
    damping, shapes = np.linalg.eig(1j * np.linalg.solve(springs, np.nan_to_num(s**2 * M + s * C + K)))
    nearest = np.abs(damping.imag).argmin(axis=-1)[..., None]
    damping = np.take_along_axis(damping, nearest, -1)[..., 0]
    shapes = np.take_along_axis(shapes, nearest[..., None], -1)[..., 0]
    neutral = (frequency > 0) & (np.abs(damping.imag) < _ROUNDING * (1 + np.abs(damping)))
    damping = np.where(neutral, damping.real, np.nan)
    order = np.argsort(-damping, axis=-1)
    found = np.take_along_axis(neutral, order, -1)
    return NeutralDamping(
        damping=np.take_along_axis(damping, order, -1),
        frequency=np.where(found, np.take_along_axis(frequency, order, -1), np.nan),
        shape=np.where(found[..., None], np.take_along_axis(shapes, order[..., None], -2), np.nan),
    )


def _frequencies(model: LinearModel, springs: Array) -> Array:
    """Return frequencies (..., n²) at which a damping may be real, 0 in place of roots off the imaginary axis."""
    M, C, K = (getattr(model, name) for name in "MCK")
    mass, stiffness = (np.kron(matrix, springs) + np.kron(springs, matrix) for matrix in (M, K))
    damping = np.kron(C, springs) - np.kron(springs, C)
    n = mass.shape[-1]
    companion = np.zeros((*mass.shape[:-2], 2 * n, 2 * n))
    companion[..., :n, n:] = np.eye(n)
    companion[..., n:, :n] = -np.linalg.solve(mass, stiffness)
    companion[..., n:, n:] = -np.linalg.solve(mass, damping)
    s = np.linalg.eigvals(np.nan_to_num(companion))  # failed points of a rotor are NaN
    s = np.take_along_axis(s, np.argsort(-s.imag, axis=-1)[..., :n], -1)  # the roots are pairs ±s
    return np.where(np.abs(s.real) < _ROUNDING * np.abs(s), s.imag, 0.0)
