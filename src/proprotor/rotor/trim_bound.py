"""A bound that shows, without following the path, that one equilibrium leads to another.

With J_λ(x) the slopes at a share λ, P the inverse of their mean over a step in λ and x, and N the largest
|P J_λ(x) - 1| in the step entry by entry, Newton's iteration with P contracts for every λ of the step where N has a
spectral radius below one: then each λ has one equilibrium within reach, and together these equilibria are a curve that
does not turn. The share of the airloads makes J linear in λ, so that the ends of the step hold the extremes. Where the
blade is, its precone included, J is known at both ends; J is taken to change twice as much within reach of the path as
between the ends, and the radius may be one half at most.

The bound is computed in blocks of points that stay in the cache, with matrices as arrays (k, k, windows, points).
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator

import numpy as np

from proprotor.compiled import bounds
from proprotor.rotor.airfoil import Airfoil
from proprotor.rotor.elimination import eliminate, points_last, solve
from proprotor.rotor.trim import UNKNOWNS
from proprotor.rotor.trim_balance import Balance, Slopes, State
from proprotor.typing import Array

CONTRACTION = 0.5  # largest spectral radius of N
# Change of slopes within reach of the path, in multiples of the change between the ends of a step.
_REACH = 2.0
_WINDOWS = (4, 8, 16)  # parts of the whole path in λ, each with a P of its own, in which the bound may hold
_POWER_STEPS = (2, 2, 4)  # after which the bound is looked at
_FLOOR = 1e-9
# The fewest windows of the path of one point: half of their length, and 1 - λ at their middles (windows, 1, 1).
_HALF_WINDOW = 0.5 / _WINDOWS[0]
_LEFT_OUT = 1 - (2 * np.arange(_WINDOWS[0])[:, None, None] + 1) * _HALF_WINDOW
_BLOCK = 2048  # windows and points whose matrices stay in the cache

_Solution = Callable[[Array, Array], Array]


def contraction(
    sprung: Array,
    before: Slopes,
    after: Slopes,
    share: Array,
    to: Array,
    *,
    windows: int = 1,
    between: Slopes | None = None,
    enough: float = CONTRACTION,
    solution: _Solution = eliminate,
) -> Array:
    """Return the spectral radius (n,) of N in a step; up to `CONTRACTION` the path leads to the other end unturned.

    Parameters
    ----------
    sprung : array (k,)
        Which rows are flap and lag.
    before, after : Slopes
        At the two equilibria.
    share, to : array (n,)
        λ of the two equilibria.
    windows : int
        Parts of the step in λ in which the bound has to hold, each with a P of its own.
    between : Slopes, optional
        Slopes half-way, for section models whose slopes may change between the ends in other ways.
    enough : float
        Radius that needs no sharper bound: above it, slopes by moments are tried as well as slopes by angles.
    solution : callable
        `eliminate`, or `by_lapack` for one point.
    """

    def radius(rows: Array, *slopes: Slopes) -> Array:
        """Return the largest radius among all windows."""
        half = (to - share)[rows] / (2 * windows)
        middles = share[rows] + (2 * np.arange(windows)[:, None] + 1) * half
        found = np.empty(len(rows))
        for some in _blocks(len(rows), windows):
            here = (part.of(some) for part in slopes)
            moved = _moved(half[some], middles[:, some], *here, solution=solution)
            found[some] = _radius(moved, enough).max(axis=0)
        return found

    slopes = (before, after) if between is None else (before, after, between)
    return _by_angles_or_moments(sprung, radius, *slopes, enough=enough)


def near_each_other(balance: Balance, found: Slopes, expected: Slopes) -> Array:
    """Return whether slopes at all of the loads are so near the expected ones that one equilibrium has both."""
    if balance.compiled:
        return bounds.near_each_other(balance.sprung, found, expected)

    def radius(_: Array, found: Slopes, expected: Slopes) -> Array:
        """Return the radius of the relative difference of the slopes."""
        matrix, right = points_last(expected.full), points_last(found.full - expected.full)
        return _radius(np.abs(eliminate(matrix, right)), CONTRACTION)

    return _by_angles_or_moments(balance.sprung, radius, found, expected) <= CONTRACTION


def leads_to_end(ends: Array) -> bool:
    """Return whether one point with slopes at the start and after the search is at the end of the path.

    The bound is that of `at_end` in the fewest windows, with slopes by angles, for an airfoil with a straight lift
    line. A point without this bound may still have that of `at_end`.

    Parameters
    ----------
    ends : array (2, 2, k, k)
        Slopes at the start and after the search, at each with all of the airloads, and the part of the airloads.
    """
    before, after = ends
    (full, airloads), (full_aside, airloads_aside) = (before + after) / 2, (after - before) / 2
    size = len(full)
    right = np.empty((len(_LEFT_OUT), size, 2 * size))
    right[..., :size] = _HALF_WINDOW * airloads
    np.subtract(full_aside, _LEFT_OUT * airloads_aside, out=right[..., size:])
    moved = np.abs(solve(full - _LEFT_OUT * airloads, right))
    matrix = moved[..., :size] + _REACH * moved[..., size:]
    return bool((_radius(matrix.transpose(1, 2, 0), CONTRACTION) <= CONTRACTION).all())


def at_end(
    balance: Balance,
    before: Slopes,
    after: Slopes,
    start: State,
    state: State,
    rows: Array,
    solution: _Solution = eliminate,
) -> Array:
    """Return whether points (n,) with these slopes at the start and here are at the end of the path, by the bound."""
    smooth = isinstance(balance.sections.airfoil, Airfoil)
    if smooth and balance.compiled:
        return bounds.lead_to_end(balance.sprung, before, after)
    half_way = {name: (start[name] + state[name]) / 2 for name in UNKNOWNS}
    between = None if smooth else balance.near(half_way, rows, share=0.5).slopes
    found, left = np.zeros(len(rows), dtype=bool), np.arange(len(rows))
    for windows in _WINDOWS:
        if not len(left):
            break
        ends = np.zeros(len(left)), np.ones(len(left))
        middle = None if between is None else between.of(left)
        slopes = before.of(left), after.of(left)
        radius = contraction(
            balance.sprung, *slopes, *ends, windows=windows, between=middle, solution=solution
        )
        found[left] = radius <= CONTRACTION
        left = left[~found[left]]
    return found


def _by_angles_or_moments(
    sprung: Array, radius: Callable[..., Array], *slopes: Slopes, enough: float = CONTRACTION
) -> Array:
    """Return the spectral radius (n,) with slopes by angles or, where smaller and needed, with slopes by moments."""
    rows = np.arange(len(slopes[0].full))
    found = radius(rows, *slopes)
    rows = np.flatnonzero(~(found <= enough))
    if len(rows):
        by_moments = (part.of(rows).by_moments(sprung) for part in slopes)
        found[rows] = np.fmin(found[rows], radius(rows, *by_moments))
    return found


def _blocks(points: int, windows: int) -> Iterator[slice]:
    """Yield blocks of points."""
    most = max(1, _BLOCK // windows)
    return (slice(start, start + most) for start in range(0, points, most))


def _moved(
    half: Array,
    middle: Array,
    before: Slopes,
    after: Slopes,
    *between: Slopes,
    solution: _Solution = eliminate,
) -> Array:
    """Return N (k, k, windows, n) of windows in λ, given by half lengths (n,) and middles (windows, n)."""
    ends = [tuple(points_last(matrix)[:, :, None] for matrix in part) for part in (before, after, *between)]
    first, *others = ends
    mean = tuple((a + b) / 2 for a, b in zip(first, others[0], strict=True))
    left_out, size = 1 - middle, len(mean[0])
    right = np.empty((size, (1 + len(others)) * size, *middle.shape))
    right[:, :size] = half * mean[1]
    for place, part in enumerate(others, start=1):
        full, airloads = (a - b for a, b in zip(part, mean, strict=True))
        np.subtract(full, left_out * airloads, out=right[:, place * size : (place + 1) * size])
    moved = solution(mean[0] - left_out * mean[1], right)
    np.abs(moved, out=moved)
    in_share, *in_place = (moved[:, place : place + size] for place in range(0, moved.shape[1], size))
    farthest = functools.reduce(np.maximum, in_place)
    return np.asarray(in_share + _REACH * farthest)


def _radius(matrix: Array, enough: float) -> Array:
    """Return a bound (...) of the spectral radius of matrices (k, k, ...) without negative entries.

    The bound is that of Collatz and Wielandt, which steps of power iteration make sharper until all bounds are enough.
    """
    positive, diagonal = matrix.copy(), np.arange(len(matrix))
    positive[diagonal, diagonal] += _FLOOR
    weight = np.add.reduce(positive, axis=1)
    for steps in _POWER_STEPS:
        for _ in range(steps):
            before, weight = weight, np.add.reduce(positive * weight, axis=1)
        bound = np.asarray((weight / before).max(axis=0, initial=0.0))
        if (bound <= enough).all():
            break
    return bound
