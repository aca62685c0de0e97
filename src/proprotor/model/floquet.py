"""What averaging over azimuth leaves out: the roots of the periodic equations beside those of their average.

The periodic equations ẋ = A(ψ) x carry a state over one Nth of a turn by the transition matrix, whose eigenvalues μ
have the exponents log(μ)/T. An exponent is known but for multiples of the blade passage frequency; that nearest to a
root of the average is taken.
"""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np

from proprotor.model.first_order import state_matrix
from proprotor.model.linear_model import LinearModel
from proprotor.rotor.trim import Trim
from proprotor.typing import Array

LIMIT = 0.005
"""Change of a root, as a share of its size, from which results are doubtful: half a per cent of critical damping."""

_STEP = 0.1  # of the integration, times the largest root
_SMALLEST = 0.05  # of the rotor speed: roots below count as of this size
DOUBT = "averaging over azimuth moves a root by {:.0%} of its size, by the Floquet exponents"


def averaged(model: LinearModel) -> LinearModel:
    """Return a model with azimuths on the last axis of its batch averaged over azimuth.

    Parameters
    ----------
    model : LinearModel
        Batch (..., azimuths).
    """
    axes = model.M.ndim - 2
    matrices: dict[str, Any] = {name: matrix.mean(axis=axes - 1) for name, matrix in model.matrices.items()}
    trim = Trim(**{entry.name: getattr(model.trim, entry.name)[..., 0] for entry in fields(Trim)})
    of_batch = {"hub": 2, "left_hub": 2, "shapes": 2, "mass_at_rest": 2}
    parts: dict[str, Any] = {}
    for name, own in of_batch.items():
        value = getattr(model, name)
        if value is not None and value.ndim == axes + own:
            parts[name] = value[..., 0, :, :]
    for name in ("rotor", "left"):
        if (rotor := getattr(model, name)) is not None:
            parts[name] = averaged(rotor)
    return replace(model, **matrices, **parts, trim=trim, airspeed=model.airspeed[..., 0])


def exponents(model: LinearModel, passage: Array) -> tuple[Array, Array]:
    """Return the roots (..., states) of the average, and beside each the Floquet exponent nearest to it, rad/s.

    Parameters
    ----------
    model : LinearModel
        Batch (..., azimuths) at equal steps of one Nth of a turn.
    passage : array (...)
        Blade passage frequency NΩ, rad/s.
    """
    mean = np.real(state_matrix(averaged(_real(model))))
    around = np.real(state_matrix(_real(model)))
    shape, states = mean.shape[:-2], mean.shape[-1]
    roots = np.full((*shape, states), complex(np.nan, np.nan))
    found = roots.copy()
    periods = 2 * np.pi / np.broadcast_to(np.real(passage), shape)
    for point in np.ndindex(shape):
        if np.isfinite(mean[point]).all() and np.isfinite(around[point]).all():
            roots[point] = np.linalg.eigvals(mean[point])
            found[point] = _nearest(roots[point], transition(around[point], periods[point]), periods[point])
    return roots, found


def _real(model: LinearModel) -> LinearModel:
    """Return the model without the small imaginary parts of derivatives."""
    if not np.iscomplexobj(model.M):
        return model
    matrices: dict[str, Any] = {name: np.real(matrix) for name, matrix in model.matrices.items()}
    return replace(model, **matrices)


def transition(around: Array, period: float) -> Array:
    """Return the matrix (states, states) that carries a state over one period.

    Parameters
    ----------
    around : array (steps, states, states)
        A of ẋ = A x at equal steps of the period, 1/s.
    period : float
        s.
    """
    largest = np.abs(np.linalg.eigvals(around)).max()
    steps = 1 << max(5, int(np.ceil(np.log2(largest * period / _STEP))))
    h = period / steps
    nodes = _interpolated(around, 2 * steps)
    first, middle, last = nodes[0::2], nodes[1::2], np.roll(nodes, -2, axis=0)[0::2]
    unit = np.eye(around.shape[-1])
    k1 = first
    k2 = middle @ (unit + h / 2 * k1)
    k3 = middle @ (unit + h / 2 * k2)
    k4 = last @ (unit + h * k3)
    step = unit + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)  # Runge-Kutta, fourth order
    while len(step) > 1:
        step = step[1::2] @ step[0::2]
    return np.asarray(step[0])


def _interpolated(around: Array, count: int) -> Array:
    """Return a periodic array at more steps of its period, by its harmonics."""
    given = len(around)
    harmonics = np.fft.rfft(around, axis=0)
    if given % 2 == 0:
        harmonics[-1] /= 2  # half at the harmonic, half at its mirror image
    return np.fft.irfft(harmonics, n=count, axis=0) * (count / given)


def _nearest(roots: Array, carried: Array, period: float) -> Array:
    """Return the exponent nearest to each root, of the eigenvalues of a transition matrix."""
    multipliers = np.linalg.eigvals(carried)
    change = np.log(multipliers[None, :] / np.exp(roots * period)[:, None]) / period
    return np.asarray(roots + change[np.arange(len(roots)), np.abs(change).argmin(axis=1)])


def change_by_average(roots: Array, found: Array, rotor_speed: Array) -> Array:
    """Return the largest change of a root by the average (...), as a share of its size; NaN at failed points."""
    size = np.maximum(np.abs(roots), _SMALLEST * np.real(rotor_speed)[..., None])
    return np.asarray((np.abs(found - roots) / size).max(axis=-1))


def with_doubts(model: LinearModel, change: Array) -> LinearModel:
    """Return an averaged model with a warning at each point (...) whose roots the average changes too much."""
    warning = model.trim.warning.copy()
    for point in np.argwhere(change > LIMIT):
        place = tuple(point)
        warning[place] = "; ".join(filter(None, (warning[place], DOUBT.format(change[place]))))
    return replace(model, trim=replace(model.trim, warning=warning))


def checked(model: LinearModel, passage: Array, n_blades: int) -> LinearModel:
    """Return a model with azimuths averaged over azimuth, with a warning where the average is doubtful."""
    mean = averaged(model)
    roots, found = exponents(model, passage)
    return with_doubts(mean, change_by_average(roots, found, np.broadcast_to(passage, roots.shape[:-1]) / n_blades))
