"""Motion of the coordinates in the modes of many points by the compiled functions."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence

import numpy as np

from proprotor.compiled.columns import address
from proprotor.compiled.library import library
from proprotor.typing import Array


def coordinate_motions(n: int, held: Sequence[int], values: Array, right: Array, order: Array) -> Array:
    """Return the motion (points, n, states) of n coordinates in the modes, the largest component of a mode 1.

    Parameters
    ----------
    n : int
    held : sequence of int
        The coordinates whose displacement is a state, in the order of these states.
    values, right : array (points, states), (points, states, states)
        Eigenvalues, NaN for states that a point has not, and right vectors.
    order : array (points, states) of int
        Which mode comes where.
    """
    points, states = values.shape
    displaced = np.full(n, -1, dtype=np.int32)
    displaced[list(held)] = np.arange(len(held))
    found = np.empty((points, n, states), dtype=complex)
    given = [np.ascontiguousarray(part, dtype=complex) for part in (values, right)]
    places = np.ascontiguousarray(order, dtype=np.int64)
    library().coordinate_motions(
        ctypes.c_ssize_t(points),
        ctypes.c_int(n),
        ctypes.c_int(states),
        *map(address, (displaced, *given, places, found)),
    )
    return found
