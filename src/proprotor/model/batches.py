"""Shapes of batches, and their points a few at a time: what is computed on the way stays in the cache of a core."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
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


def as_grid(numbers: Mapping[str, Array], positions: Array) -> tuple[dict[str, Array], Array]:
    """Return numbers (designs, 1) and positions (designs, count) where points are designs at so many positions each.

    What does not depend on the position is then derived once for each design. Other points stay as they are.

    Parameters
    ----------
    numbers : mapping of array (points,)
        What differs from design to design.
    positions : array (points,)
        Airspeeds.
    """
    points, same = np.shape(positions), dict(numbers)
    if not same or len(points) != 1 or any(np.shape(one) != points for one in same.values()):
        return same, positions
    changes = np.flatnonzero(np.any([one[1:] != one[:-1] for one in same.values()], axis=0)) + 1
    count = int(changes[0]) if len(changes) else points[0]
    if count == 1 or points[0] % count or (changes % count).any():
        return same, positions
    return {name: one[::count, None] for name, one in same.items()}, positions.reshape(-1, count)


def at_rows(matrices: Array, rows: Rows, shape: tuple[int, ...]) -> Array:
    """Return matrices (..., n, m) at some rows of a batch; what all points have in common is returned as it is."""
    if rows is ...:
        return matrices
    varies = matrices.ndim == len(shape) + 2 and matrices.shape[:1] == shape[:1]
    return matrices[rows] if varies else matrices
