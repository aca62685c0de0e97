"""Equations of motion of many points by the compiled functions: on a support, and whether every motion has mass."""

from __future__ import annotations

import ctypes

import numpy as np

from proprotor.compiled.columns import address, column, lane_room
from proprotor.compiled.library import library
from proprotor.typing import Array

MOST_ROWS = 64  # of motion.c, of the result


def on_support(matrix: Array, hub: Array, addition: Array) -> Array:
    """Return Tᵀ (...) T of matrices (points, size, size), T = diag(Φ, 1), plus a matrix of the support's coordinates.

    Parameters
    ----------
    matrix : array (points, size, size)
        The hub's six coordinates first.
    hub : array (6, m) or (points, 6, m)
        Φ, motion of the hub with the support's coordinates.
    addition : array (m, m) or (points, m, m)
    """
    points, size, _ = matrix.shape
    modes = hub.shape[-1]
    n = modes + size - 6
    found, kept = np.empty((points, n, n)), [np.ascontiguousarray(matrix, dtype=float)]
    columns = [
        column(part.reshape(*part.shape[:-2], part.shape[-2] * modes), kept) for part in (hub, addition)
    ]
    library().on_support(
        ctypes.c_ssize_t(points),
        ctypes.c_int(size),
        ctypes.c_int(modes),
        address(kept[0]),
        *map(ctypes.byref, columns),
        address(found),
    )
    return found


def have_mass(mass: Array) -> Array:
    """Return in which mass matrices (points, n, n) every motion has mass for certain, (points,)."""
    points, n, _ = mass.shape
    given, found = np.ascontiguousarray(mass, dtype=float), np.empty(points, dtype=bool)
    room = lane_room(n * n)
    library().have_mass(ctypes.c_ssize_t(points), ctypes.c_int(n), *map(address, (given, found, room)))
    return found
