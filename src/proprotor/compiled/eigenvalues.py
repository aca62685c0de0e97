"""Eigenvalues and right vectors of many small real matrices by the compiled functions.

Each matrix is checked: sums of its eigenvalues and of their squares against traces, and with vectors one combination of
these against the matrix. LAPACK takes every matrix that is not finite, that does not converge or that fails its check.
"""

from __future__ import annotations

import ctypes
from collections.abc import Sequence

import numpy as np

from proprotor.compiled.columns import address, lane_room, start_of
from proprotor.compiled.library import library
from proprotor.typing import Array

MOST_STATES = 256  # of eigen.h


def eigvals(matrices: Array) -> Array:
    """Return the eigenvalues (..., n) of real matrices (..., n, n), as `numpy.linalg.eigvals` does.

    Raises
    ------
    Unavailable
        Without a library; `proprotor.compiled.library.why_not` says why.
    LinAlgError
        For a matrix that is not finite, as NumPy does.
    """
    flat = _flat(matrices)
    if flat.shape[-1] > MOST_STATES:
        return np.linalg.eigvals(matrices)
    values, _, rest = _solved(flat, vectors=False)
    if rest.any():
        values[rest] = np.linalg.eigvals(flat[rest])
    return values.reshape(matrices.shape[:-1])


def eig(matrices: Array) -> tuple[Array, Array]:
    """Return eigenvalues (..., n) and right vectors (..., n, n) of length one, as `numpy.linalg.eig` does.

    Raises
    ------
    Unavailable, LinAlgError
        As `eigvals`.
    """
    flat = _flat(matrices)
    if flat.shape[-1] > MOST_STATES:
        values, right = np.linalg.eig(matrices)
        return values.astype(complex, copy=False), right.astype(complex, copy=False)
    values, right, rest = _solved(flat, vectors=True)
    if rest.any():
        values[rest], right[rest] = np.linalg.eig(flat[rest])
    return values.reshape(matrices.shape[:-1]), right.reshape(matrices.shape)


def roots_of_motion(
    mass: Array, damping: Array, stiffness: Array, held: Sequence[int]
) -> tuple[Array, Array]:
    """Return the eigenvalues (points, states) of real equations of motion (points, n, n), and which points have none.

    `held` are the coordinates whose displacement is a state. A point without eigenvalues has a mass matrix that takes
    exchanges of rows, or is one that the compiled functions hand over: its numbers mean nothing.
    """
    values, _, rest = _of_motion((mass, damping, stiffness), held, vectors=False)
    return values, rest


def modes_of_motion(
    mass: Array, damping: Array, stiffness: Array, held: Sequence[int]
) -> tuple[Array, Array, Array]:
    """Return the same with right vectors (points, states, states) of length one between both."""
    return _of_motion((mass, damping, stiffness), held, vectors=True)


def _of_motion(
    matrices: tuple[Array, Array, Array], held: Sequence[int], vectors: bool
) -> tuple[Array, Array, Array]:
    """Return eigenvalues, right vectors or nothing, and which points have none."""
    count, n, _ = matrices[0].shape
    states, wide = n + len(held), 2 * n + len(held)
    parts = [np.ascontiguousarray(part, dtype=float) for part in matrices]
    places = np.array(held, dtype=np.int32)
    values, rest = np.empty((count, states), dtype=complex), np.zeros(count, dtype=bool)
    right = np.empty((count, states, states) if vectors else 0, dtype=complex)
    if states > MOST_STATES:
        return values, right, ~rest
    room = lane_room(5 * states * states + 4 * states + n * wide)
    library().roots_of_motion(
        ctypes.c_int(n),
        ctypes.c_int(len(held)),
        address(places),
        ctypes.c_ssize_t(count),
        (ctypes.c_void_p * 3)(*map(start_of, parts)),
        address(values),
        address(right) if vectors else None,
        address(rest),
        address(room),
    )
    return values, right, rest


def handed_over(matrices: Array, vectors: bool = False) -> Array:
    """Return which of the matrices (..., n, n) the compiled functions hand over to LAPACK."""
    return _solved(_flat(matrices), vectors)[2].reshape(matrices.shape[:-2])


def _flat(matrices: Array) -> Array:
    """Return matrices (points, n, n) side by side in memory."""
    n = matrices.shape[-1]
    return np.ascontiguousarray(matrices.reshape(-1, n, n), dtype=float)


def _solved(matrices: Array, vectors: bool) -> tuple[Array, Array, Array]:
    """Return values (points, n), right vectors (points, n, n) or nothing, and which are handed over."""
    count, n, _ = matrices.shape
    values = np.empty((count, n), dtype=complex)
    right = np.empty((count, n, n) if vectors else 0, dtype=complex)
    rest = np.zeros(count, dtype=bool)
    room = lane_room(4 * n * n + 4 * n)
    library().eigenvalues(
        ctypes.c_int(n),
        ctypes.c_ssize_t(count),
        address(matrices),
        address(values),
        address(right) if vectors else None,
        address(rest),
        address(room),
    )
    return values, right, rest
