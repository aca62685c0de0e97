"""A rotor, or what stands in its place, on a support: hub coordinates replaced by the support's own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from proprotor.errors import InputError
from proprotor.model import HUB, LinearModel
from proprotor.support import NormalModes


def mount(rotor_alone: LinearModel, support: NormalModes, rigid_mass: ArrayLike | None = None) -> LinearModel:
    """The coupled model on the coordinates of the support and of the rotor without its hub.

    Hub motion is Φ p, so by virtual work the rotor's matrices become Tᵀ (...) T, with the support's own
    added. Where the support's generalised masses include the rotor, its rigid-body share Φᵀ M_hub Φ is
    taken off first.

    Parameters
    ----------
    rotor_alone : LinearModel
        Six hub coordinates, then any others: `rotor_model`, `rigid_propeller`, or M, C and K from elsewhere.
    support : NormalModes
    rigid_mass : array_like, shape (..., 6, 6)
        M_hub, such as `rigid_hub_mass(rotor)`; only asked for where the support's masses include the rotor.

    Raises
    ------
    InputError
        When the model does not begin with the hub coordinates, or a rigid mass is asked for and not given.
    """
    if rotor_alone.dofs[: len(HUB)] != HUB:
        raise InputError("dofs", ", ".join(rotor_alone.dofs), f"must begin with {', '.join(HUB)}")
    own = rotor_alone.dofs[len(HUB) :]
    additions = {"M": _mass_without_rotor(support, rigid_mass), "C": support.damping, "K": support.stiffness}
    shape = np.broadcast_shapes(
        rotor_alone.M.shape[:-2],
        support.hub.shape[:-2],
        *(matrix.shape[:-2] for matrix in additions.values()),
    )
    rotor_alone = _broadcast(rotor_alone, shape)
    transformation = _transformation(support, len(own))
    virtual = np.swapaxes(transformation, -1, -2)
    modes = len(support.names)
    matrices = {}
    for name, addition in additions.items():
        matrix = virtual @ getattr(rotor_alone, name) @ transformation
        matrix = matrix.astype(np.result_type(matrix, addition), copy=False)
        matrix[..., :modes, :modes] += addition
        matrices[name] = matrix
    return replace(
        rotor_alone,
        **matrices,
        B=None if rotor_alone.B is None else virtual @ rotor_alone.B,
        dofs=(*support.names, *own),
        hub=transformation[..., : len(HUB), :],
        rotor=rotor_alone,
    )


def _broadcast(model: LinearModel, shape: tuple[int, ...]) -> LinearModel:
    """The model at every point of a batch that has more axes, those of the supports."""
    if model.M.shape[:-2] == shape:
        return model
    matrices = {name: getattr(model, name) for name in ("M", "C", "K", "B")}
    matrices = {
        name: None if matrix is None else np.broadcast_to(matrix, (*shape, *matrix.shape[-2:]))
        for name, matrix in matrices.items()
    }
    return replace(
        model, **matrices, trim=model.trim.broadcast(shape), airspeed=np.broadcast_to(model.airspeed, shape)
    )


def _mass_without_rotor(support: NormalModes, rigid_mass: ArrayLike | None) -> NDArray:
    if not support.includes_rotor:
        return support.mass
    if rigid_mass is None:
        raise InputError("rigid_mass", None, "must be given: the support's masses include the rotor")
    return support.mass - np.swapaxes(support.hub, -1, -2) @ np.asarray(rigid_mass) @ support.hub


def _transformation(support: NormalModes, own: int) -> NDArray:
    """T: hub and rotor coordinates from support and rotor coordinates."""
    modes = len(support.names)
    shape = (*support.hub.shape[:-2], len(HUB) + own, modes + own)
    transformation = np.zeros(shape, dtype=support.hub.dtype)
    transformation[..., : len(HUB), :modes] = support.hub
    transformation[..., len(HUB) :, modes:] = np.eye(own)
    return transformation
