"""Linear equations of a few unknowns at many points, points last: an elimination without calls for each matrix.

Arrays are (rows, columns, ...) with points along the last axes, so that each operation runs over all points at once.
Rows are eliminated in their order where this loses no digits. LAPACK, which exchanges rows, solves the other points.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from proprotor.typing import Array

# Largest multiple of a row that is taken off another, rows scaled to a largest entry of one: four rows then lose three
# digits at most.
_LARGEST_FACTOR = 10.0


def points_last(matrix: Array) -> Array:
    """Return matrices (..., k, m) as an array (k, m, ...) of its own."""
    return np.ascontiguousarray(np.moveaxis(matrix, (-2, -1), (0, 1)))


def eliminate(matrix: Array, right: Array) -> Array:
    """Return the solutions (k, m, ...) of real equations (k, k, ...) with right sides (k, m, ...).

    A point has the same bits in every batch. A point whose matrix has no inverse has NaN.
    """
    size = len(matrix)
    whole = np.concatenate([matrix, right], axis=1)
    whole /= np.abs(matrix).max(axis=1)[:, None]
    for place in range(size - 1):
        factors, others = whole[place + 1 :, place], whole[place + 1 :, place + 1 :]
        factors /= whole[place, place]
        others -= factors[:, None] * whole[place, place + 1 :]
    found = whole[:, size:]
    for place in range(size - 1, 0, -1):
        found[place] /= whole[place, place]
        found[:place] -= whole[:place, place, None] * found[place]
    found[0] /= whole[0, 0]
    safe = (np.abs(whole[_below(size)]) <= _LARGEST_FACTOR).all(axis=0) & (whole[-1, size - 1] != 0)
    if not safe.all():
        found[..., ~safe] = by_lapack(matrix[..., ~safe], right[..., ~safe])
    return found


@cache
def _below(size: int) -> tuple[Array, Array]:
    """Return rows and columns of the places below the diagonal, where the factors are left."""
    return np.tril_indices(size, -1)


def by_lapack(matrix: Array, right: Array) -> Array:
    """Return the solutions as `eliminate` does, with exchanges of rows: faster for a few points alone."""
    return points_last(solve(*(np.moveaxis(part, (0, 1), (-2, -1)) for part in (matrix, right))))


def solve(matrix: Array, right: Array) -> Array:
    """Return matrix⁻¹ right, (..., k, m), by LAPACK; NaN at the points whose matrix has no inverse."""
    try:
        return np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError:  # raised for all points if the matrix of one is singular
        good = np.isfinite(matrix).all(axis=(-2, -1)) & (np.abs(np.linalg.det(matrix)) > 0)
        found = np.full(right.shape, np.nan, dtype=np.result_type(matrix, right))
        found[good] = np.linalg.solve(matrix[good], right[good])
        return found
