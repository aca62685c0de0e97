"""Roots as exact as the matrices of a model allow, and the bound on their error: the definition of "neutral".

LAPACK finds the eigenvalues of a state matrix to rounding of its largest entries, so that a stiff spring or a hinge
near the centre spoils other roots. In (λ²M + λC + K)x = 0 such a spring multiplies the small motion that it allows: the
root that follows from the computed vectors there,

    λ - yᴴ(λ²M + λC + K)x / yᴴ(2λM + C)x,

has an error of second order in the error of the vectors. The remaining error is rounding of the entries of the
matrices, a few times ε |yᴴ|(|λ|²|M| + |λ||C| + |K|)|x| / |yᴴ(2λM + C)x|: the backward error, times the condition of the
root.

A root whose distance from a level is within its error is neutral there: neither beyond the level nor crossing it. Two
roots that fall into one, as the roots of a motion without spring and damper, have an error without bound by that
formula, but in fact one of the square root of rounding: no larger error is reported.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from proprotor.model.first_order import StateBlocks, blocks, held_coordinates, some_points
from proprotor.model.linear_model import LinearModel
from proprotor.stability.eigenvalue_derivatives import real_times, second_order_left
from proprotor.stability.matching import Modes, Spectrum, size_of
from proprotor.stability.modes import decomposition, eigenvalues
from proprotor.typing import Array

_EPSILON = float(np.finfo(float).eps)
_ROUNDINGS = 4.0  # of an entry of M, C or K
_OF_CORRECTION = 1e-3  # its own error, for vectors that are right to three digits
_DOUBLE = _EPSILON**0.5  # of the largest root: what rounding parts two roots by that are one
_NEAR = 1e-6  # of the largest root: farther from a level no error reaches


class _Refined(NamedTuple):
    """Roots (..., modes), and the bound on the error of each root, rad/s."""

    values: Array
    error: Array


def growth(values: Array, level: float = 0.0) -> Array:
    """Return G = Re λ + ζ0 |λ|, 1/s: positive where the damping ratio is below the level."""
    return values.real + level * np.abs(values) if level else values.real


def growth_error(error: Array, level: float = 0.0) -> Array:
    """Return the error of G from the error of the root."""
    return error * (1 + abs(level)) if level else error


def refined(model: LinearModel, modes: Modes) -> _Refined:
    """Return roots refined by their vectors, with their errors; NaN at failed points.

    Parameters
    ----------
    model : LinearModel
        Points (...,).
    modes : Modes
        All modes of every point, each pair side by side.
    """
    values, right, _ = modes
    n, held = len(model.dofs), held_coordinates(model, right.shape[-2])
    left = second_order_left(model, modes.left)
    with np.errstate(all="ignore"):
        displacement = right[..., : len(held), :]
        rates = right[..., -n:, :].copy()
        rates[..., held, :] = values[..., None, :] * displacement
        motion = np.concatenate([values[..., None, :] * rates, rates, displacement], axis=-2)
        matrices = np.concatenate([model.M.real, model.C.real, model.K.real[..., held]], axis=-1)
        correction = -_products(left, real_times(matrices, motion))
        rounding = _ROUNDINGS * _EPSILON * _products(size_of(left), np.abs(matrices) @ size_of(motion))
        apart = _nearest(values, blocks(model, held) if values.shape[-1] == right.shape[-2] else ())
        share = size_of(correction) / apart
        better = share < 0.5
        error = rounding + size_of(correction) * (_OF_CORRECTION + np.where(better, share, 1.0))
        error = np.where(np.isnan(values), np.nan, np.fmin(error, _DOUBLE * _largest(values)))
    return _Refined(np.where(better, values + correction, values), error)


def refined_near(model: LinearModel, modes: Modes, level: float = 0.0) -> _Refined:
    """Return roots of points (k,) that work, refined where one is near a level; elsewhere unchanged, with no error.

    Modes are all modes of the points. No error reaches farther than a millionth of the largest root.
    """
    values, error = modes.values.copy(), np.zeros(modes.values.shape)
    near = _any_near(growth(values, level), values)
    if near.any():
        some = Modes(*(part[near] for part in modes))
        values[near], error[near] = refined(some_points(model, near), some)
    return _Refined(values, error)


def errors_of(model: LinearModel, spectrum: Spectrum) -> Array:
    """Return the bound on the error (..., states) of eigenvalues as LAPACK finds them, rad/s; NaN at failed points."""
    works = spectrum.works
    error = np.full(spectrum.values.shape, np.nan)
    if works.any():
        modes = spectrum.at(works).all_modes
        found = refined(some_points(model, works), modes)
        error[works] = found.error + size_of(found.values - modes.values)
    return error


def roots(model: LinearModel, level: float = 0.0) -> _Refined:
    """Return eigenvalues (..., states) and their errors; refined by vectors at points where a root is near the level.

    Farther from the level the error does not matter, and is returned as zero. NaN at failed points.
    """
    values = eigenvalues(model)
    error = np.where(np.isnan(values), np.nan, 0.0)
    near = _any_near(growth(values, level), values)
    if near.any():
        part = some_points(model, near)
        values[near], error[near] = refined(part, decomposition(part, held_coordinates(model)).all_modes)
    return _Refined(values, error)


def error_near_zero(model: LinearModel, values: Array) -> Array:
    """Return errors of known eigenvalues (..., states) where one of a point is near the imaginary axis; else zero."""
    error = np.zeros(values.shape)
    near = _any_near(values.real, values)
    if near.any():
        part = some_points(model, near)
        spectrum = decomposition(part, held_coordinates(model, values.shape[-1]))
        error[near] = np.take_along_axis(errors_of(part, spectrum), spectrum.nearest(values[near]), -1)
    return error


def _any_near(distance: Array, values: Array) -> Array:
    """Return at which points (...) a root is so near to a level that its error may reach the level."""
    return np.asarray((np.abs(distance) <= _NEAR * _largest(values)).any(axis=-1))


def _largest(values: Array) -> Array:
    """Return the size of the largest root of each point (..., 1)."""
    return np.asarray(np.fmax.reduce(size_of(values), axis=-1, keepdims=True))


def _products(rows: Array, columns: Array) -> Array:
    """Multiply each row (..., modes, n) by its own column (..., n, modes)."""
    return np.asarray((rows * np.swapaxes(columns, -1, -2)).sum(axis=-1))


def _nearest(values: Array, apart_from: StateBlocks) -> Array:
    """Return the distance of each root to the nearest other root of its point and of its block, if blocks are given."""
    if len(apart_from) > 1:
        return np.concatenate([_nearest(values[..., columns], ()) for _, columns in apart_from], axis=-1)
    apart = size_of(values[..., :, None] - values[..., None, :])
    states = np.arange(values.shape[-1])
    apart[..., states, states] = np.inf
    return np.asarray(np.fmin.reduce(apart, axis=-1))
