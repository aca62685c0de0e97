"""Mount several rotors on one support, such as the two rotors of an aircraft that turn opposite ways."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.linear_model import LinearModel
from proprotor.model.mount import check_hub, refused_where
from proprotor.model.rotor_share import without_rotors
from proprotor.rotor.motions import HUB, check_distinct
from proprotor.support.normal_modes import NormalModes
from proprotor.typing import Array

# A mirror across the plane of I and K reverses y and, because rotations are axial vectors, the rotations about x and z.
_MIRROR = np.diag([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])


class MountedRotor(NamedTuple):
    """A rotor and its place on a support.

    model : LinearModel
        The rotor alone on its six hub coordinates.
    hub : array (6, n)
        Hub motion per unit of each coordinate of the support, along and about the support's I, J, K.
    mirrored : bool
        Whether the rotor is the model's mirror image: on the left side, turning the other way.
    """

    model: LinearModel
    hub: ArrayLike
    mirrored: bool = False


def mount_rotors(rotors: Mapping[str, MountedRotor], support: NormalModes) -> LinearModel:
    """Return the coupled model of a support and its rotors.

    Coordinates of a rotor have its name in front, "right gimbal_1c". The coordinates of a mirrored rotor are mirrored
    too: when both rotors move alike, the aircraft stays symmetric. Azimuths are displacements in this model, each with
    a root at zero; rotor_speed="constant" leaves them out. The trim is that of the first rotor.

    Parameters
    ----------
    rotors : mapping of str to MountedRotor
        The rotors by name, all at the same points.
    support : NormalModes
        The support; its `hub` is not used, because each rotor has a hub of its own.

    Returns
    -------
    LinearModel
        With the coordinates of the support first, SI.

    Raises
    ------
    InputError
        Without any rotor, for a model that does not begin with the hub coordinates, a hub of another shape, a mass at
        rest that is needed and missing, or a support that has no mass without the rotors.
    """
    if not rotors:
        raise InputError("rotors", None, "must be one or more")
    n = len(support.names)
    hubs = {name: _hub_of(name, rotor, n) for name, rotor in rotors.items()}
    own = {name: [f"{name} {dof}" for dof in rotor.model.dofs[len(HUB) :]] for name, rotor in rotors.items()}
    names = [*support.names, *(dof for dofs in own.values() for dof in dofs)]
    if len(set(names)) < len(names):
        rule = "must differ from the rotors' coordinates"
        raise InputError("support.names", ", ".join(support.names), rule)
    check_distinct("support.names", tuple(names))
    models = {name: rotor.model for name, rotor in rotors.items()}
    mass, refusal = without_rotors(
        support, [(hubs[name], model.mass_at_rest) for name, model in models.items()]
    )
    masses = (support.mass, mass, *(model.M for model in models.values()))
    shape = np.broadcast_shapes(*(matrix.shape[:-2] for matrix in masses))
    matrices: dict[str, Any] = {}
    for kind, of_support in {"M": mass, "C": support.damping, "K": support.stiffness}.items():
        whole = np.zeros((*shape, len(names), len(names)))
        whole[..., :n, :n] = of_support
        for name, model in models.items():
            to_rotor = _to_rotor(hubs[name], [names.index(dof) for dof in own[name]], len(names))
            whole += to_rotor.T @ getattr(model, kind) @ to_rotor
        matrices[kind] = whole
    first, *others = models.values()
    options = stamp.of_model(first).get("options")
    coupled = replace(
        first,
        **matrices,
        B=None,
        dofs=tuple(names),
        hub=np.pad(next(iter(hubs.values())), ((0, 0), (0, len(names) - n))),
        rotor=None,
        mass_at_rest=None,
        shapes=None,
        rates=tuple(f"{name} {rate}" for name, model in models.items() for rate in model.rates),
        apart=tuple(
            tuple(f"{name} {dof}" for dof in group) for name, model in models.items() for group in model.apart
        ),
        # Rotors with different options have no common stamp.
        origin=first.origin if all(stamp.of_model(o).get("options") == options for o in others) else None,
    )
    return refused_where(refusal, coupled, support)


def _to_rotor(hub: Array, own: list[int], count: int) -> Array:
    """Return the coordinates of a rotor alone per unit of each coordinate of the whole, (6 + len(own), count)."""
    rows = np.zeros((len(HUB) + len(own), count))
    rows[: len(HUB), : hub.shape[-1]] = hub
    rows[len(HUB) :, own] = np.eye(len(own))
    return rows


def _hub_of(name: str, rotor: MountedRotor, n: int) -> Array:
    """Return the hub motion in the axes of the rotor's own model."""
    check_hub(f"rotors[{name}].model", rotor.model)
    hub = np.asarray(rotor.hub, dtype=float)
    if hub.shape != (len(HUB), n) or not np.isfinite(hub).all():
        raise InputError(
            f"rotors[{name}].hub", f"array of shape {hub.shape}", f"must be finite, {(len(HUB), n)}"
        )
    return _MIRROR @ hub if rotor.mirrored else hub
