"""Steps between points whose eigenvalues alone are known: each root is matched with the nearest one at the next point.

The nearest root at the next point is the same root unless two roots may have met on the way. Roots that may have met
have no trust, like roots that vectors cannot tell apart.
"""

from __future__ import annotations

import numpy as np

from proprotor.stability.assignment import best_assignment
from proprotor.stability.steps import Steps, first_steps
from proprotor.typing import Array

_BLOCK = 64  # steps whose distances stay in the cache
_OTHER_BLOCK = 1e305  # its root is more than many of the next
_NEVER = 1e300  # the square of the distance between a root and a state that a point does not have


def steps_by_values(values: Array, block: Array, before: Array, after: Array) -> Steps:
    """Return steps from points to the next points, by eigenvalues (points, states); their quality is not known.

    Each root stays in its block (states,), which does not couple with others.
    """
    successor = np.empty((len(before), values.shape[1]), dtype=int)
    for start in range(0, len(before), _BLOCK):
        rows = slice(start, start + _BLOCK)
        successor[rows] = _nearest(values[before[rows]], values[after[rows]], block)
    return first_steps(before, after, successor, np.full(successor.shape, np.nan))


def _nearest(first: Array, last: Array, block: Array) -> Array:
    """Return places (steps, states) of the nearest root at the later point, a different one for each root."""
    real, imaginary = (
        first.real[:, :, None] - last.real[:, None, :],
        first.imag[:, :, None] - last.imag[:, None, :],
    )
    square = real**2 + imaginary**2
    none, none_later = np.isnan(first)[:, :, None], np.isnan(last)[:, None, :]
    if none.any() or none_later.any():
        square = np.where(none & none_later, 0.0, np.where(none | none_later, _NEVER, square))
    if block.any():
        square[:, block[:, None] != block] = _OTHER_BLOCK
    successor: Array = square.argmin(axis=2)
    taken_once = (np.sort(successor, axis=1) == np.arange(successor.shape[1])).all(axis=1)
    for step in np.flatnonzero(~taken_once):
        successor[step] = best_assignment(-np.sqrt(square[step]))
    return successor
