"""Several rotors on one support, such as the two of an aircraft that turn opposite ways."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.linear_model import LinearModel
from proprotor.model.mount import refused_where
from proprotor.model.rotor_share import without_rotors
from proprotor.rotor.motions import HUB, check_distinct
from proprotor.support.normal_modes import NormalModes
from proprotor.typing import Array

# A mirror across the plane of I and K turns y around, and of the rotations (axial vectors) the other two.
MIRROR = np.diag([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])


class MountedRotor(NamedTuple):
    """A rotor and the place it has on a support.

    model : LinearModel
        The rotor alone on its six hub coordinates.
    hub : array (6, n)
        Motion of its hub per coordinate of the support, in the support's I, J, K.
    mirrored : bool
        Whether it is the model's mirror image: on the left side, turning the other way.
    """

    model: LinearModel
    hub: ArrayLike
    mirrored: bool = False


Placed = tuple[
    MountedRotor, Array, slice
]  # with the motion of its hub, and the places of its own coordinates


def mount_rotors(rotors: Mapping[str, MountedRotor], support: NormalModes) -> LinearModel:
    """The coupled model of a support and its rotors.

    Coordinates of a rotor are named after it, "right gimbal_1c". The own coordinates of a mirrored rotor are mirrored
    with it: in the same motion of both, the aircraft stays symmetric. Azimuths are displacements here, each with a
    root at zero; rotor_speed="constant" leaves them out. The trim is that of the first rotor.

    Parameters
    ----------
    rotors : mapping of str to MountedRotor
        By name, all at the same points.
    support : NormalModes
        Its own `hub` is not used: each rotor has one.

    Returns
    -------
    LinearModel
        With the coordinates of the support first, SI.

    Raises
    ------
    InputError
        Without a rotor, for a model that does not begin with the hub coordinates, a hub of another shape, a mass at
        rest that is needed and missing, or a support that has no mass without the rotors.
    """
    if not rotors:
        raise InputError("rotors", None, "must be one or more")
    names = list(support.names)
    n = len(names)
    placed: dict[str, Placed] = {}
    for name, rotor in rotors.items():
        hub = _hub_of(name, rotor, n)
        own = rotor.model.dofs[len(HUB) :]
        placed[name] = (rotor, hub, slice(len(names), len(names) + len(own)))
        names += [f"{name} {dof}" for dof in own]
    if len(set(names)) < len(names):
        raise InputError(
            "support.names", ", ".join(support.names), "must differ from the rotors' coordinates"
        )
    check_distinct("support.names", tuple(names))
    shape = np.broadcast_shapes(
        *(rotor.model.M.shape[:-2] for rotor in rotors.values()), support.mass.shape[:-2]
    )
    mass, refusal = without_rotors(
        support, [(hub, rotor.model.mass_at_rest) for rotor, hub, _ in placed.values()]
    )
    shape = np.broadcast_shapes(shape, mass.shape[:-2])
    matrices: dict[str, Any] = {}
    for kind, of_support in (
        ("M", mass),
        ("C", support.damping),
        ("K", support.stiffness),
    ):
        whole = np.zeros((*shape, len(names), len(names)))
        whole[..., :n, :n] = of_support
        for rotor, hub, places in placed.values():
            to_rotor = np.zeros((len(rotor.model.dofs), len(names)))
            to_rotor[: len(HUB), :n] = hub
            to_rotor[len(HUB) :, places] = np.eye(places.stop - places.start)
            whole += to_rotor.T @ getattr(rotor.model, kind) @ to_rotor
        matrices[kind] = whole
    (first, hub, _), *_ = placed.values()
    motion = np.pad(hub, ((0, 0), (0, len(names) - n)))
    told = {stamp.of_model(rotor.model).get("options") for rotor in rotors.values()}
    # Of rotors with different options there is no one stamp.
    origin = first.model.origin if len(told) == 1 else None
    coupled = replace(
        first.model,
        **matrices,
        B=None,
        dofs=tuple(names),
        hub=motion,
        rotor=None,
        mass_at_rest=None,
        shapes=None,
        origin=origin,
    )
    return refused_where(refusal, coupled, support)


def _hub_of(name: str, rotor: MountedRotor, n: int) -> Array:
    """Hub motion in the axes of the rotor's own model."""
    if rotor.model.dofs[: len(HUB)] != HUB:
        raise InputError(
            f"rotors[{name}].model", ", ".join(rotor.model.dofs), f"must begin with {', '.join(HUB)}"
        )
    hub = np.asarray(rotor.hub, dtype=float)
    if hub.shape != (len(HUB), n) or not np.isfinite(hub).all():
        raise InputError(
            f"rotors[{name}].hub", f"array of shape {hub.shape}", f"must be finite, {(len(HUB), n)}"
        )
    return MIRROR @ hub if rotor.mirrored else hub
