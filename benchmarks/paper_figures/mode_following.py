"""The modes of the support followed over airspeed, for many designs at once."""

from __future__ import annotations

import numpy as np
from proprotor_equations import FIXED_COORDINATES

from proprotor.errors import InputError
from proprotor.model.linear_model import LinearModel
from proprotor.stability.modes import Eigensystem, eigensystem, participation
from proprotor.typing import Array


def support_names(model: LinearModel) -> tuple[str, ...]:
    """Coordinates of a model that are not the rotor's."""
    return tuple(name for name in model.dofs if name not in FIXED_COORDINATES)


def support_share(model: LinearModel, system: Eigensystem) -> Array:
    """Participation (..., support coordinates, states) of the support in each mode, 0 to 1."""
    return participation(model, system)[..., [model.dofs.index(name) for name in support_names(model)], :]


def follow_support_modes(model: LinearModel, system: Eigensystem | None = None) -> Array:
    """Eigenvalues (designs, airspeeds, modes) of the support's modes, NaN at failed points.

    In the lower half of the airspeeds a mode of the support is the one in which its coordinate takes most part: where a
    mode of the rotor meets it, the name passes from one branch to the other. In the upper half, where the rotor takes
    over modes that flutter, each is followed by the likeness of left and right vectors of neighbouring airspeeds.

    Parameters
    ----------
    model : LinearModel
        A batch (designs, airspeeds), airspeeds rising along the second axis; modes in the order of `support_names`.
    system : Eigensystem, optional
        Of the model, if it is known already.

    Raises
    ------
    InputError
        When the batch has another number of axes.
    """
    if model.airspeed.ndim != 2:
        raise InputError(
            "airspeed", f"array of shape {model.airspeed.shape}", "must be a batch of designs by airspeeds"
        )
    system = eigensystem(model) if system is None else system
    shares = support_share(model, system)
    good = np.asarray(np.isfinite(system.values).any(axis=-1))
    middle = good.shape[1] // 2
    followed = np.full((*good.shape, shares.shape[-2]), np.nan, dtype=complex)
    places = np.zeros((len(good), shares.shape[-2]), dtype=int)
    latest = np.full(len(good), -1)  # the last good airspeed of each design
    for point in range(good.shape[1]):
        here = np.flatnonzero(good[:, point])
        known = here[latest[here] >= 0] if point > middle else here[:0]
        places[known] = _next_places(system, known, latest[known], point, places[known])
        for design in np.setdiff1d(here, known):
            places[design] = _largest_shares(system.values[design, point], shares[design, point])
        followed[here, point] = np.take_along_axis(system.values[here, point], places[here], axis=-1)
        latest[here] = point
    return followed


def _largest_shares(values: Array, shares: Array) -> Array:
    """The oscillating modes in which the coordinates of the support take most part, one each."""
    from scipy.optimize import linear_sum_assignment  # here, because it takes long to import

    upper = np.flatnonzero(values.imag > 0)
    chosen: Array = upper[linear_sum_assignment(-shares[:, upper])[1]]
    return chosen


def _next_places(system: Eigensystem, designs: Array, before: Array, point: int, places: Array) -> Array:
    """Where the modes at `places` of the points `before` have gone."""
    left = np.take_along_axis(system.left[designs, before], places[:, :, None], axis=1)
    right = np.take_along_axis(system.right[designs, before], places[:, None, :], axis=2)
    forward = np.abs(left @ system.right[designs, point])
    backward = np.abs(system.left[designs, point] @ right)
    values = system.values[designs, before]
    apart = np.take_along_axis(values, places, axis=1)[:, :, None] - system.values[designs, point][:, None, :]
    scale = np.nanmax(np.abs(values), axis=1)[:, None, None]
    cost = np.abs(apart) / scale - np.sqrt(forward * np.swapaxes(backward, 1, 2))
    cost = np.where(np.isnan(cost), np.inf, cost)  # what a point does not have no mode becomes
    found: Array = cost.argmin(axis=2)
    for row in np.flatnonzero([len(set(one)) < len(one) for one in found.tolist()]):
        found[row] = _one_to_one(cost[row])
    return found


def _one_to_one(cost: Array) -> Array:
    from scipy.optimize import linear_sum_assignment

    places: Array = linear_sum_assignment(cost)[1]
    return places
