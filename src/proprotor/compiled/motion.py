"""Equations of motion of many points by the compiled functions: on a support, and whether every motion has mass."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence

import numpy as np

from proprotor.compiled.columns import Column, address, column, lane_room, start_of
from proprotor.compiled.library import library
from proprotor.typing import Array

MOST_ROWS = 64  # of motion.c, of the result
_POINTERS = ctypes.c_void_p * 4


class Support:
    """A support as `on_support` takes it, prepared once for all points at which it is the same.

    Parameters
    ----------
    hub : array (6, m) or (points, 6, m)
        Φ, motion of the hub with the support's coordinates.
    additions : three arrays (m, m) or (points, m, m)
        Matrices of the support's coordinates.
    """

    def __init__(self, hub: Array, additions: Sequence[Array]) -> None:
        self.modes, self.kept = hub.shape[-1], list[Array]()
        at_hub, *own = (
            column(
                np.ascontiguousarray(part).reshape(*part.shape[:-2], part.shape[-2] * self.modes), self.kept
            )
            for part in (hub, *additions)
        )
        self.places = ctypes.byref(at_hub), (Column * 3)(*own)


def on_support(matrices: Sequence[Array], support: Support) -> tuple[list[Array], Array]:
    """Return Tᵀ (...) T of M, C, K, T = diag(Φ, 1), plus matrices of the support's coordinates; and Tᵀ B, if given.

    The second result says in which of the mass matrices every motion has mass for certain, (points,).

    Parameters
    ----------
    matrices : arrays (points, size, size), and B (points, size, inputs) if there is one
        The hub's six coordinates first.
    support : Support
    """
    given = [np.ascontiguousarray(matrix, dtype=float) for matrix in matrices]
    points, size, inputs = given[-1].shape
    n = support.modes + size - 6
    found = [np.empty((points, n, n if place < 3 else inputs)) for place in range(len(given))]
    certain, room = np.empty(points, dtype=bool), lane_room(n * n)
    library().on_support(
        ctypes.c_ssize_t(points),
        ctypes.c_int(size),
        ctypes.c_int(support.modes),
        ctypes.c_int(inputs),
        _POINTERS(*map(start_of, given)),
        *support.places,
        _POINTERS(*map(start_of, found)),
        address(certain),
        address(room),
    )
    return found, certain


def have_mass(mass: Array) -> Array:
    """Return in which mass matrices (points, n, n) every motion has mass for certain, (points,)."""
    points, n, _ = mass.shape
    given, found = np.ascontiguousarray(mass, dtype=float), np.empty(points, dtype=bool)
    room = lane_room(n * n)
    library().have_mass(ctypes.c_ssize_t(points), ctypes.c_int(n), *map(address, (given, found, room)))
    return found


def state_matrices(mass: Array, damping: Array, stiffness: Array, held: Sequence[int]) -> tuple[Array, Array]:
    """Return state matrices (points, states, states) of equations of motion (points, n, n), and which are not solved.

    `held` are the coordinates whose displacement is a state. The mass matrix of a point that is not solved takes
    exchanges of rows, or has no inverse: its numbers mean nothing.
    """
    points, n, _ = mass.shape
    states, places = n + len(held), np.array(held, dtype=np.int32)
    given = [np.ascontiguousarray(part, dtype=float) for part in (mass, damping, stiffness)]
    found, unsafe = np.empty((points, states, states)), np.empty(points, dtype=bool)
    room = lane_room(states * states + n * (n + states))
    library().state_matrices(
        ctypes.c_int(n),
        ctypes.c_int(len(held)),
        address(places),
        ctypes.c_ssize_t(points),
        _POINTERS(*map(start_of, given)),
        *map(address, (found, unsafe, room)),
    )
    return found, unsafe
