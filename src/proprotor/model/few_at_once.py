"""Take the points of a batch a few at a time, so that what is computed on the way stays in the cache of a core."""

from __future__ import annotations

from collections.abc import Iterator
from math import prod
from types import EllipsisType

from proprotor.typing import Array

Rows = slice | EllipsisType
_FEW = 256  # points: what a state matrix takes on the way is then half of a megabyte


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
    varies = matrices.ndim == len(shape) + 2 and matrices.shape[0] == shape[0] if shape else False
    return matrices[rows] if varies else matrices
