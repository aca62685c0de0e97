"""Find motions that move no mass, such as flapping about the centre of rotation against the tilt of a gimbal.

Such coordinates describe one motion twice. Their mass matrix has no inverse, though rounding may hide this, so the
motion has no eigenvalue.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from proprotor.compiled.motion import have_mass
from proprotor.model.batches import few_at_once
from proprotor.typing import Array

if TYPE_CHECKING:
    from proprotor.model.linear_model import LinearModel

_CLEARLY_MASS = 1e-6  # pivot of a mass matrix scaled to a unit diagonal, above which an inverse exists
_NO_INERTIA = 1e13  # condition number of the scaled matrix, above which the matrix has no inverse
_TAKES_PART = 0.01  # component of a unit vector


def massless(mass: Array, compiled: bool = False) -> Array:
    """Return which mass matrices of a batch (..., n, n) have no inverse, (...); False at failed points.

    Compiled functions may find those that have one for certain.
    """
    if compiled and not np.iscomplexobj(mass):
        flat = mass.reshape(-1, *mass.shape[-2:])
        left = ~have_mass(flat)
        if left.any():
            left[left] = massless(flat[left])
        return np.asarray(left.reshape(mass.shape[:-2]))
    mass, found = np.real(mass), np.zeros(mass.shape[:-2], dtype=bool)
    for rows in few_at_once(found.shape):
        if _clearly_positive(some := mass[rows]):  # which matrices with NaN are not
            continue
        finite = np.isfinite(some).all(axis=(-2, -1))
        if not _clearly_positive(numbers := some[finite]):
            found[rows][finite] = np.linalg.cond(_scaled(numbers)) > _NO_INERTIA
    return found


def massless_coordinates(mass: Array, dofs: tuple[str, ...]) -> list[str]:
    """Return the names of the coordinates that take part in the massless motions of one singular matrix (n, n)."""
    _, sizes, motions = np.linalg.svd(_scaled(np.real(mass)))
    without = motions[sizes * _NO_INERTIA < sizes[0]]
    share = np.abs(without).max(axis=0, initial=0.0)
    return [name for name, part in zip(dofs, share, strict=True) if part > _TAKES_PART]


def with_reasons(model: LinearModel) -> LinearModel:
    """Return the model with each singular point marked as failed, with its reason; the matrices are kept."""
    singular = model.massless
    if not singular.any():
        return model
    reason = np.array(model.trim.reason, dtype=object)
    for place in map(tuple, np.argwhere(singular)):
        names = ", ".join(massless_coordinates(model.M[place], model.dofs))
        reason[place] = f"{names}: move against each other without any mass; lock or hold some of them"
    trim = replace(model.trim, reason=reason, converged=model.trim.converged & ~singular)
    return replace(model, trim=trim)


def _scaled(mass: Array) -> Array:
    """Return mass matrices scaled to a unit diagonal."""
    diagonal = np.sqrt(np.abs(np.diagonal(mass, axis1=-2, axis2=-1)))
    diagonal = np.where(diagonal > 0, diagonal, 1)
    return np.asarray(mass / diagonal[..., None, :] / diagonal[..., None])


def _clearly_positive(mass: Array) -> bool:
    """Return whether every motion has mass, from a Cholesky factor of M + Mᵀ: much cheaper than singular values."""
    twice = mass + np.swapaxes(mass, -1, -2)
    try:
        pivots = np.linalg.cholesky(twice).diagonal(0, -2, -1) ** 2
    except np.linalg.LinAlgError:
        return False
    return bool((pivots > _CLEARLY_MASS * twice.diagonal(0, -2, -1)).all())
