"""Cubics through values and slopes at both ends of a step, many at once."""

from __future__ import annotations

import numpy as np

from proprotor.typing import Array


def hermite(t: Array, ends: Array) -> Array:
    """Return the cubic at t with `ends` (4, ...): value at 0, value at 1, slope at 0 and slope at 1 per unit of t."""
    value0, value1, slope0, slope1 = ends
    rise = value1 - value0
    a, b = slope0 - rise, rise - slope1
    return np.asarray(value0 + t * (rise + (1 - t) * (a + t * (b - a))))


def hermite_slope(t: Array, ends: Array) -> Array:
    """Return the slope of the cubic per unit of t."""
    value0, value1, slope0, slope1 = ends
    rise = value1 - value0
    slope: Array = slope0 + t * (6 * rise - 4 * slope0 - 2 * slope1 + 3 * t * (slope0 + slope1 - 2 * rise))
    return slope


def bend(ends: Array) -> Array:
    """Return how far cubics, by their ends (4, ...), may leave the straight line between the ends."""
    rise = ends[1] - ends[0]
    return np.asarray(np.maximum(np.abs(ends[2] - rise), np.abs(ends[3] - rise)) / 4)


def band(t: Array) -> Array:
    """Return how the error of a cubic is spread over the step: 0 at both ends, 1 in the middle."""
    return np.asarray(16 * t**2 * (1 - t) ** 2)


def hermite_extrema(ends: Array) -> Array:
    """Return where cubics (4, m) have extrema within (0, 1): (m, 2), NaN for an extremum that does not exist."""
    value0, value1, slope0, slope1 = ends
    rise = value1 - value0
    c3, c2, c1 = slope0 + slope1 - 2 * rise, 3 * rise - 2 * slope0 - slope1, slope0
    with np.errstate(all="ignore"):
        root = np.sqrt(c2**2 - 3 * c3 * c1)
        q = -(c2 + np.where(c2 < 0, -root, root))
        found = np.stack([q / (3 * c3), c1 / q], axis=-1)
    return np.where((found > 0) & (found < 1), found, np.nan)


def hermite_root(ends: Array) -> Array:
    """Return a root in (0, 1) of cubics (4, m) with values of opposite sign at the ends, by bisection."""
    low, high = np.zeros(ends.shape[1]), np.ones(ends.shape[1])
    rising = ends[1] > ends[0]
    for _ in range(52):
        middle = (low + high) / 2
        above = (hermite(middle, ends) > 0) == rising
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return (low + high) / 2
