"""Steps between points whose eigenvalues alone are known: each root is matched with the nearest one at the next point.

The nearest root at the next point is the same root unless two roots may have met on the way. Roots that may have met
have no trust, like roots that vectors cannot tell apart. Differences from point to point stand for derivatives, and
cubics by differences are trusted half as much. The compiled functions have the same criteria.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from proprotor.compiled.screening import nearest_roots, screened_steps, serves_screening
from proprotor.stability.assignment import best_assignment
from proprotor.stability.parting import where_to_part
from proprotor.stability.points import Points, growth_rate
from proprotor.stability.root_pairs import MANY, along_scan
from proprotor.stability.steps import Steps, first_steps
from proprotor.typing import Array

_TRUST = 0.5  # in cubics whose slopes are differences
_LINES_AT_ONCE = 32  # whose steps stay in the cache while they are looked at
_BLOCK = 64  # steps whose distances stay in the cache
_OTHER_BLOCK = 1e305  # its root is more than many of the next
_NEVER = 1e300  # the square of the distance between a root and a state that a point does not have


def screened(
    points: Points, before: Array, after: Array, level: float, compiled: bool = False
) -> tuple[Array, Array]:
    """Return which steps may hold a crossing, and in which a root becomes unstable and is followed without doubt.

    Parameters
    ----------
    points : Points
        With eigenvalues alone.
    before, after : array (steps,) of int
        All steps of the lines, those of a line one after the other.
    level : float
        Damping ratio.
    compiled : bool
        Whether to take compiled functions, where these serve the points.

    Returns
    -------
    array (steps,) of bool, array of int
        Then the places of the steps with an onset.
    """
    values, block = points.spectrum.values, points.spectrum.block
    if compiled and serves_screening(values):
        linked = before, after, _compiled_successors(values, block, before, after)
        asked, certain = screened_steps(
            values, points.error, block, points.position, points.line, linked, level
        )
        onsets = np.flatnonzero(certain)
    else:
        steps = _steps_by_values(values, block, before, after)
        points = _with_differences(points, steps, level)
        asked = np.isfinite(_where_by_differences(steps, points, level))
        asked[steps.crossing(points)[0]] = True
        onsets = steps.onsets(points)
    few = np.bincount(points.line) < MANY  # points of a line, for differences to be of use
    return asked | few[points.line[before]], onsets


def _compiled_successors(values: Array, block: Array, before: Array, after: Array) -> Array:
    """Return the successors (steps, states) of `_steps_by_values` by the compiled functions."""
    successor, shared = nearest_roots(values, block, before, after)
    rows = np.flatnonzero(shared)
    if len(rows):
        successor[rows] = _nearest(values[before[rows]], values[after[rows]], block)
    return successor


def _steps_by_values(values: Array, block: Array, before: Array, after: Array) -> Steps:
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


def _where_by_differences(steps: Steps, points: Points, level: float) -> Array:
    """Return where first steps are to be parted (steps,), by points with differences, some lines at a time."""
    share = np.full(len(steps.before), np.nan)
    begins = np.flatnonzero(np.diff(points.line[steps.before], prepend=-1))[::_LINES_AT_ONCE]
    for ends in pairwise([*begins, len(share)]):
        some = slice(*ends)
        share[some] = where_to_part(steps.at(some), points, False, level, _TRUST, along_scan)
    return share


def _with_differences(points: Points, steps: Steps, level: float) -> Points:
    """Return the points with differences to their neighbours in place of derivatives."""
    values = points.spectrum.values
    length = steps.length(points)
    rate = (steps.later(values) - values[steps.before]) / length
    there = np.take_along_axis(rate, steps.successor.argsort(axis=1), 1)
    sums, weights = np.zeros(values.shape, dtype=complex), np.zeros((len(values), 1))
    # A point is the start of one step at most, and the end of one; the nearer neighbour counts more.
    for place, part in ((steps.before, rate), (steps.after, there)):
        sums[place] += part / length
        weights[place] += 1 / length
    change = sums / np.where(weights > 0, weights, 1)
    return points._replace(change=change, slope=growth_rate(values, change, level))
