"""Steps of scans with eigenvalues alone by the compiled functions: nearest roots, and which steps may hold a crossing.

In: the eigenvalues of points and the steps between them. Out: what `proprotor.stability.screening` finds, by the same
criteria.
"""

from __future__ import annotations

import ctypes

import numpy as np

from proprotor.compiled.columns import address, start_of
from proprotor.compiled.eigenvalues import MOST_STATES
from proprotor.compiled.library import library
from proprotor.typing import Array


class _Scan(ctypes.Structure):
    """Steps of scans, see screening.h."""

    _fields_ = (
        ("states", ctypes.c_int),
        ("steps", ctypes.c_ssize_t),
        ("points", ctypes.c_ssize_t),
        ("level", ctypes.c_double),
        *(
            (name, ctypes.c_void_p)
            for name in (
                "line",
                "before",
                "after",
                "successor",
                "block",
                "position",
                "values",
                "error",
                "change",
            )
        ),
    )


def serves_screening(values: Array) -> bool:
    """Return whether the compiled functions take eigenvalues (points, states): all finite, and not too many."""
    return values.shape[-1] <= MOST_STATES and bool(np.isfinite(values).all())


def nearest_roots(values: Array, block: Array, before: Array, after: Array) -> tuple[Array, Array]:
    """Return the nearest root at the later point of each step, and the steps in which two roots have the same.

    Parameters
    ----------
    values : array (points, states)
        Eigenvalues, rad/s, finite.
    block : array (states,) of int
        The nearest root is one of the same block.
    before, after : array (steps,) of int
        The points of each step.

    Returns
    -------
    array (steps, states) of int, array (steps,) of bool
    """
    steps, states = len(before), values.shape[-1]
    successor, shared = np.empty((steps, states), dtype=np.int64), np.empty(steps, dtype=bool)
    given = (*_whole(before, after), _complex(values), *_whole(block))
    library().nearest_roots(
        ctypes.c_ssize_t(steps), ctypes.c_int(states), *map(address, (*given, successor, shared))
    )
    return successor, shared


def screened_steps(
    values: Array,
    error: Array,
    block: Array,
    position: Array,
    line: Array,
    steps: tuple[Array, Array, Array],
    level: float,
) -> tuple[Array, Array]:
    """Return which steps may hold a crossing of the level, and in which a root becomes unstable without doubt.

    Parameters
    ----------
    values, error : array (points, states)
        Eigenvalues, finite, and the error of the growth of each, rad/s.
    block : array (states,) of int
        The block of each state; roots of different blocks do not meet.
    position : array (points,)
        Where the points are, in any unit.
    line : array (points,) of int
        The line of each point.
    steps : three arrays (steps,), (steps,), (steps, states) of int
        The points before and after each step, and where each root is after it; all steps of a line follow each other.
    level : float
        Damping ratio.

    Returns
    -------
    two arrays (steps,) of bool
    """
    count, (points, states) = len(steps[0]), values.shape
    asked, onsets = np.empty(count, dtype=bool), np.empty(count, dtype=bool)
    before, after, successor = _whole(*steps)
    (places,), weight = _whole(line[before]), np.empty(points)
    change, numbers = np.empty(values.shape, dtype=complex), (position, _complex(values), error)
    own = (*_whole(block), *(np.ascontiguousarray(part) for part in numbers), change)
    arrays = (places, before, after, successor, *own)
    scan = _Scan(states, count, points, level, *map(start_of, arrays))
    library().screen_steps(ctypes.byref(scan), *map(address, (weight, asked, onsets)))
    return asked, onsets


def _whole(*arrays: Array) -> list[Array]:
    return [np.ascontiguousarray(one, dtype=np.int64) for one in arrays]


def _complex(values: Array) -> Array:
    return np.ascontiguousarray(values, dtype=complex)
