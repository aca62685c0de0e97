"""Add the lag of a wing's lift to a coupled model: downwash that takes effect late.

With w = W_r q̇ + W_d q for the downwash in functions of the span, two states of different speed, i = 1 and 2, follow it
as circulation does along a blade (`proprotor.model.lift_lag`), and the loads lack A_i L (w - x_i) of their quasi-steady
value:

    ẋ_i + b_i (2V/c) x_i = b_i (2V/c) w

x is the rate of a coordinate without stiffness, in m/s. In every steady state x_i = w, whatever the functions are.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from proprotor.model.lift_lag import JONES
from proprotor.model.linear_model import LinearModel
from proprotor.rotor.motions import check_distinct, wing_lag_names
from proprotor.support import WingCirculation
from proprotor.typing import Array


def with_wing_lag(model: LinearModel, lift: WingCirculation) -> LinearModel:
    """Return a model on a support whose wing's lift lags.

    Parameters
    ----------
    model : LinearModel
        The coordinates of the support are the first; the lift of its wing is quasi-steady.
    lift : WingCirculation
        Of the same points, on the coordinates of the support.

    Returns
    -------
    LinearModel
        With `proprotor.rotor.motions.wing_lag_names` behind the other coordinates.
    """
    names = wing_lag_names(lift.symmetry)
    check_distinct("support.names", (*model.dofs, *names))
    n, (own, count) = len(model.dofs), lift.work.shape[-2:]
    matrices: dict[str, Any] = {name: _padded(getattr(model, name), len(names), lift) for name in "MCK"}
    support, late = slice(own), sum(share for share, _ in JONES.values())
    matrices["C"][..., support, support] += late * lift.work @ lift.by_rates
    matrices["K"][..., support, support] += late * lift.work @ lift.by_displacements
    for place, (share, rate) in enumerate(JONES.values()):
        start = n + place * count
        states, decay = slice(start, start + count), (rate * lift.way)[..., None, None]
        matrices["M"][..., states, states] = np.eye(count)
        matrices["C"][..., states, states] = decay * np.eye(count)
        matrices["C"][..., support, states] = -share * lift.work
        matrices["C"][..., states, support] = -decay * lift.by_rates
        matrices["K"][..., states, support] = -decay * lift.by_displacements
    for matrix in matrices.values():
        matrix[~np.broadcast_to(model.finite, matrix.shape[:-2])] = np.nan
    return replace(
        model,
        **matrices,
        **_motions(model, len(names)),
        dofs=(*model.dofs, *names),
        rates=(*model.rates, *names),
        symmetry=(*model.symmetry, *lift.symmetry * len(JONES)) if model.symmetry else (),
    )


def _padded(matrix: Array, more: int, lift: WingCirculation) -> Array:
    """Return a matrix with zeros for more coordinates, at points and of a kind of number that the lift has too."""
    shape = np.broadcast_shapes(matrix.shape[:-2], lift.work.shape[:-2], lift.way.shape)
    n = matrix.shape[-1]
    whole = np.zeros((*shape, n + more, n + more), dtype=np.result_type(matrix, *lift[:4]))
    whole[..., :n, :n] = matrix
    return whole


def _motions(model: LinearModel, more: int) -> dict[str, Any]:
    """Return the motions of the hubs and the inputs of a model with more coordinates, which have none of either."""
    found: dict[str, Any] = {
        name: None if motion is None else np.pad(motion, [(0, 0)] * (motion.ndim - 1) + [(0, more)])
        for name, motion in (("hub", model.hub), ("left_hub", model.left_hub))
    }
    if model.B is not None:
        found["B"] = np.pad(model.B, [(0, 0)] * (model.B.ndim - 2) + [(0, more), (0, 0)])
    return found
