"""The bound on the path to a trim for many points by the compiled functions, as far as most points need it."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence

import numpy as np

from proprotor.compiled.columns import address
from proprotor.compiled.library import library
from proprotor.typing import Array


def lead_to_end(before: Sequence[Array], after: Sequence[Array]) -> Array:
    """Return which points (n,) have one path from the undeflected blade to their trim, by a bound in a few windows.

    Parameters
    ----------
    before, after : two arrays (n, k, k)
        Slopes at the undeflected blade and at the trim: with all of the airloads, and the part of the airloads.
    """
    slopes = [np.ascontiguousarray(matrix, dtype=float) for matrix in (*before, *after)]
    points, size, _ = slopes[0].shape
    found = np.zeros(points, dtype=bool)
    ends = [
        (ctypes.c_void_p * 2)(*(matrix.ctypes.data for matrix in pair)) for pair in (slopes[:2], slopes[2:])
    ]
    library().lead_to_end(ctypes.c_ssize_t(points), ctypes.c_int(size), *ends, address(found))
    return found


def near_each_other(slopes: Array, expected: Array) -> Array:
    """Return which slopes (n, k, k) are so near to the expected ones that one trim has both."""
    points, size, _ = slopes.shape
    given = [np.ascontiguousarray(matrix, dtype=float) for matrix in (slopes, expected)]
    found = np.zeros(points, dtype=bool)
    library().near_each_other(ctypes.c_ssize_t(points), ctypes.c_int(size), *map(address, (*given, found)))
    return found
