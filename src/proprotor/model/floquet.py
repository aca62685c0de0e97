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
"""Change of a damping ratio from which results are doubtful: half a per cent of critical damping."""

_STEP = 0.1  # of the integration, times the largest root
_DAMPED = 0.1  # of critical damping
_DOUBT = "averaging over azimuth moves the damping of a root by {:.0f}% of critical, by the Floquet exponents"


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


def exponents(model: LinearModel, roots: Array, passage: Array) -> Array:
    """Return the Floquet exponent nearest to each root (..., roots) of the average, rad/s; NaN where a root is NaN.

    Parameters
    ----------
    model : LinearModel
        Batch (..., azimuths) at equal steps of one Nth of a turn.
    roots : array (..., roots)
        rad/s.
    passage : array (...)
        Blade passage frequency NΩ, rad/s.
    """
    around = state_matrix(_real(model))
    found = np.full(roots.shape, complex(np.nan, np.nan))
    periods = 2 * np.pi / np.broadcast_to(np.real(passage), roots.shape[:-1])
    for point in np.ndindex(roots.shape[:-1]):
        known = np.isfinite(roots[point])
        if known.any() and np.isfinite(around[point]).all():
            period = float(periods[point])
            carried = transition(around[point], period)
            found[point][known] = _nearest(roots[point][known], carried, period)
    return found


def roots_of_average(mean: LinearModel) -> Array:
    """Return the roots (..., states) of an averaged model, rad/s, in no order; NaN at failed points."""
    matrices = state_matrix(_real(mean))
    found = np.full(matrices.shape[:-1], complex(np.nan, np.nan))
    good = np.isfinite(matrices).all(axis=(-2, -1))
    found[good] = np.linalg.eigvals(matrices[good])
    return found


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


def change_by_average(roots: Array, found: Array) -> Array:
    """Return the largest change of a damping ratio by the average (...); NaN at failed points.

    Roots with more than a tenth of critical damping are left out: no instability is near them.
    """
    before, after = (-np.real(part) / np.where(part == 0, np.inf, np.abs(part)) for part in (roots, found))
    near = np.isfinite(found) & (np.minimum(before, after) < _DAMPED) & (np.imag(roots) != 0)
    change = np.where(near, np.abs(after - before), 0.0).max(axis=-1)
    return np.asarray(np.where(np.isnan(roots).all(axis=-1), np.nan, change))


def with_doubts(model: LinearModel, change: Array) -> LinearModel:
    """Return an averaged model with a warning at each point (...) whose roots the average changes too much."""
    warning = model.trim.warning.copy()
    for point in np.argwhere(change > LIMIT):
        place = tuple(point)
        warning[place] = "; ".join(
            filter(None, (warning[place], _DOUBT.format(np.ceil(100 * change[place]))))
        )
    return replace(model, trim=replace(model.trim, warning=warning))


def checked(model: LinearModel, passage: Array) -> LinearModel:
    """Return a model with azimuths averaged over azimuth, with a warning where the average is doubtful."""
    mean = averaged(model)
    roots = roots_of_average(mean)
    return with_doubts(mean, change_by_average(roots, exponents(model, roots, passage)))
