"""The bound on the path to a trim for many points by the compiled functions."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence

import numpy as np

from proprotor.compiled.columns import address, start_of
from proprotor.compiled.library import library
from proprotor.typing import Array


def lead_to_end(sprung: Array, before: Sequence[Array], after: Sequence[Array]) -> Array:
    """Return which points (n,) have one path from the undeflected blade to their trim, by the bound.

    Parameters
    ----------
    sprung : array (k,) of bool
        Which rows are flap and lag.
    before, after : two arrays (n, k, k)
        Slopes at the undeflected blade and at the trim: with all of the airloads, and the part of the airloads.
    """
    return _answers("lead_to_end", sprung, before, after)


def near_each_other(sprung: Array, slopes: Sequence[Array], expected: Sequence[Array]) -> Array:
    """Return which slopes, as of `lead_to_end`, are so near to the expected ones that one trim has both."""
    return _answers("near_each_other", sprung, slopes, expected)


def _answers(function: str, sprung: Array, one: Sequence[Array], other: Sequence[Array]) -> Array:
    """Return what a function of the library says of two sets of slopes."""
    kept = [np.ascontiguousarray(matrix, dtype=float) for matrix in (*one, *other)]
    points, size, _ = kept[0].shape
    rows, found = np.ascontiguousarray(sprung, dtype=bool), np.zeros(points, dtype=bool)
    pairs = [(ctypes.c_void_p * 2)(*map(start_of, pair)) for pair in (kept[:2], kept[2:])]
    getattr(library(), function)(
        ctypes.c_ssize_t(points), ctypes.c_int(size), address(rows), *pairs, address(found)
    )
    return found
