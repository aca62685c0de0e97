"""Shapes of batches, and their points a few at a time: what is computed on the way stays in the cache of a core."""

from __future__ import annotations

from collections.abc import Iterator
from math import prod
from types import EllipsisType

import numpy as np

from proprotor.typing import Array

Rows = slice | EllipsisType
_LARGEST = 32 * 2**20 - 2**16  # bytes of a block after which glibc raises its limits
_FEW = 256  # points: what a state matrix takes on the way is then half of a megabyte


def joint_shape(*shapes: tuple[int, ...]) -> tuple[int, ...]:
    """Return the shape of arrays that are broadcast together; what is the same for all arrays needs no NumPy."""
    first, *others = {*shapes}
    return np.broadcast_shapes(first, *others) if others else first


def keep_memory() -> None:
    """Let arrays take memory that arrays before them gave back, and not fresh pages, which cost a tenth of a study.

    The allocator of glibc returns a large block to the system when it is freed, and takes this as a sign that blocks of
    that size come and go: it keeps later ones. The block here is never written to, so that it takes no memory.
    """
    np.empty(_LARGEST, dtype=np.uint8)


def few_at_once(shape: tuple[int, ...]) -> Iterator[Rows]:
    """Yield slices of the first axis of a batch, a few points each; all of a small batch as ..., also of one point."""
    count = prod(shape)
    if count <= _FEW:
        yield ...
        return
    step = max(1, _FEW * shape[0] // count)
    for start in range(0, shape[0], step):
        yield slice(start, start + step)


def at_rows(matrices: Array, rows: Rows, shape: tuple[int, ...]) -> Array:
    """Return matrices (..., n, m) at some rows of a batch; what all points have in common is returned as it is."""
    if rows is ...:
        return matrices
    varies = matrices.ndim == len(shape) + 2 and matrices.shape[:1] == shape[:1]
    return matrices[rows] if varies else matrices
