"""Shapes of batches, and their points a few at a time: what is computed on the way stays in the cache of a core."""

from __future__ import annotations

from collections.abc import Iterator
from math import prod
from types import EllipsisType

import numpy as np

from proprotor.typing import Array

_Rows = slice | EllipsisType
_FEW = 256  # points: what a state matrix takes on the way is then half of a megabyte


def joint_shape(*shapes: tuple[int, ...]) -> tuple[int, ...]:
    """Return the shape of arrays that are broadcast together; what is the same for all arrays needs no NumPy."""
    first, *others = {*shapes}
    return np.broadcast_shapes(first, *others) if others else first


def few_at_once(shape: tuple[int, ...]) -> Iterator[_Rows]:
    """Yield slices of the first axis of a batch, a few points each; all of a small batch as ..., also of one point."""
    count = prod(shape)
    if count <= _FEW:
        yield ...
        return
    step = max(1, _FEW * shape[0] // count)
    for start in range(0, shape[0], step):
        yield slice(start, start + step)


def at_rows(matrices: Array, rows: _Rows, shape: tuple[int, ...]) -> Array:
    """Return matrices (..., n, m) at some rows of a batch; what all points have in common is returned as it is."""
    if rows is ...:
        return matrices
    varies = matrices.ndim == len(shape) + 2 and matrices.shape[:1] == shape[:1]
    return matrices[rows] if varies else matrices
