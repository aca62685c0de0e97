"""A rotor on a support: hub coordinates replaced by the support's own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from proprotor.model import HUB, LinearModel, rigid_hub_mass
from proprotor.rotor import Rotor
from proprotor.support import NormalModes


def mount(rotor: Rotor, rotor_alone: LinearModel, support: NormalModes) -> LinearModel:
    """The coupled model on the coordinates of the support and of the rotor without its hub.

    Hub motion is Φ p, so by virtual work the rotor's matrices become Tᵀ (...) T, with the support's own added.
    Where the support's generalised masses include the rotor, its rigid-body share Φᵀ M_hub Φ is taken off first.

    Parameters
    ----------
    rotor : Rotor
    rotor_alone : LinearModel
        From `rotor_model`, with its six hub coordinates.
    support : NormalModes
    """
    own = rotor_alone.dofs[len(HUB) :]
    transformation = _transformation(support, len(own))
    support_mass = support.mass - support.hub.T @ rigid_hub_mass(rotor) @ support.hub * support.includes_rotor
    additions = {"M": support_mass, "C": support.damping, "K": support.stiffness}
    modes = len(support.names)
    matrices = {}
    for name, addition in additions.items():
        matrix = transformation.T @ getattr(rotor_alone, name) @ transformation
        matrix[..., :modes, :modes] += addition
        matrices[name] = matrix
    return replace(rotor_alone, **matrices, dofs=(*support.names, *own))


def _transformation(support: NormalModes, own: int) -> NDArray:
    """T: hub and rotor coordinates from support and rotor coordinates."""
    modes = len(support.names)
    transformation = np.zeros((len(HUB) + own, modes + own))
    transformation[: len(HUB), :modes] = support.hub
    transformation[len(HUB) :, modes:] = np.eye(own)
    return transformation
