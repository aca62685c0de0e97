"""Interpolate a table smoothly and without overshoot, its end values held beyond the ends, with exact derivatives."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.typing import Array


def smooth_table(at: ArrayLike, values: ArrayLike, abscissa: Array) -> Array:
    """Return a table at an abscissa; an imaginary part is followed to first order, for a complex step.

    Parameters
    ----------
    at, values : array (k,)
        Rising abscissae, and the values there.
    abscissa : array (...)
    """
    real = np.asarray(np.real(abscissa))
    interpolant, held = _interpolation(at, values, real)
    found = np.asarray(interpolant(held))
    if not np.iscomplexobj(abscissa):
        return found
    return np.asarray(found + 1j * _slope(interpolant, held, real) * np.imag(abscissa))


def _slope(interpolant: Any, held: Array, abscissa: Array) -> Array:
    """Return the derivative of the interpolant at a real abscissa (...); zero beyond the ends of the table."""
    outside = (abscissa < held) | (abscissa > held)
    return np.asarray(np.where(outside, 0.0, interpolant.derivative()(held)))


def _interpolation(at: ArrayLike, values: ArrayLike, abscissa: Array) -> tuple[Any, Array]:
    """Return the interpolant of a table, and an abscissa with values beyond the table moved to its ends."""
    from scipy.interpolate import PchipInterpolator  # here, because it takes long to import

    places = np.asarray(at, dtype=float)
    return PchipInterpolator(places, np.asarray(values, dtype=float)), np.clip(
        abscissa, places[0], places[-1]
    )
