"""Eigenvalues of the points of a batch, the shapes of the modes, and the least stable mode."""

from __future__ import annotations

import numpy as np

from proprotor.compiled import shapes
from proprotor.model.first_order import held_coordinates
from proprotor.model.linear_model import LinearModel
from proprotor.stability.matching import Spectrum
from proprotor.stability.modes import coordinate_motion
from proprotor.stability.root_error import error_near_zero
from proprotor.typing import Array

_BLOCK = 64  # points whose vectors stay in the cache


def by_frequency(values: Array) -> Array:
    """Return the order (..., states) by |Im s|, the root above the real axis first; NaN last."""
    return np.lexsort((values.real, values.imag < 0, np.abs(values.imag)), axis=-1)


def ordered(values: Array) -> Array:
    """Return eigenvalues (..., states) by frequency, NaN last and at failed points."""
    return np.take_along_axis(values, by_frequency(values), -1)


def vectors(model: LinearModel, spectrum: Spectrum) -> Array:
    """Return the motion of the coordinates (..., n, states) by frequency, the largest component of a mode 1."""
    values, right = spectrum.values, spectrum.right
    n, states = len(model.dofs), values.shape[-1]
    held = held_coordinates(model, states)
    flat, columns = values.reshape(-1, states), right.reshape(-1, states, states)
    if model.is_compiled:
        motions = shapes.coordinate_motions(n, held, flat, columns, by_frequency(flat))
        return motions.reshape(*values.shape[:-1], n, states)
    found = np.empty((len(flat), n, states), dtype=complex)
    for start in range(0, len(flat), _BLOCK):
        rows = slice(start, start + _BLOCK)
        motions = coordinate_motion(held, n, flat[rows], columns[rows])
        if (missing := np.isnan(flat[rows])).any():
            motions = np.where(missing[:, None, :], np.nan, motions)
        _make_largest_one(motions)
        found[rows] = np.take_along_axis(motions, by_frequency(flat[rows])[:, None, :], -1)
    return found.reshape(*values.shape[:-1], n, states)


def _make_largest_one(shapes: Array) -> None:
    """Divide columns (..., n, states) by their largest component, which is then exactly 1."""
    size = shapes.real**2 + shapes.imag**2
    largest = size.argmax(axis=-2)[..., None, :]
    if np.isnan(
        np.take_along_axis(size, largest, -2)
    ).any():  # where a column has NaN, that is its largest component
        largest = np.nan_to_num(size).argmax(axis=-2)[..., None, :]
    with np.errstate(all="ignore"):
        shapes *= 1 / np.take_along_axis(shapes, largest, -2)
    one = np.take_along_axis(shapes, largest, -2)
    np.put_along_axis(shapes, largest, np.where(np.isnan(one), np.nan, 1), -2)


def least_stable(model: LinearModel, values: Array) -> dict[str, Array]:
    """Return the largest growth of each point, and the damping and frequency of the mode damped least.

    Parameters
    ----------
    model : LinearModel
        Points (...).
    values : array (..., states)
        All eigenvalues, rad/s.

    Notes
    -----
    A root at zero within its error does not count, and the growth of a neutral root is zero.
    """
    error = error_near_zero(model, values)
    size = np.abs(values)
    counts = size > error
    with np.errstate(all="ignore"):
        ratio = np.where(counts, -values.real / size, np.inf)
    place = ratio.argmin(axis=-1)[..., None]
    failed = np.isnan(values).all(axis=-1)
    growth = np.where(counts, np.where(np.abs(values.real) <= error, 0.0, values.real), -np.inf).max(axis=-1)
    return {
        "growth_rate": np.where(failed, np.nan, growth),
        "damping_ratio": np.where(failed, np.nan, np.take_along_axis(ratio, place, -1)[..., 0]),
        "frequency": np.where(failed, np.nan, np.abs(np.take_along_axis(values.imag, place, -1)[..., 0])),
    }
