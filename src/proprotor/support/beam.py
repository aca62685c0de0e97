"""A chain of beam elements through given nodes, on the six motions of every node along and about I, J, K.

`proprotor_equations.beam` has the element: Euler-Bernoulli bending in two planes, torsion, extension, and the mass that
is consistent with these shapes. Every number may be complex or an array of many designs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike
from proprotor_equations import beam as element

from proprotor.errors import InputError, check_finite
from proprotor.rotor.element_chain import assembled
from proprotor.rotor.generated import evaluate
from proprotor.support.normal_modes import HUB_AXES, ROTATION, TRANSLATION
from proprotor.typing import Array, Numbers

_UP = np.array([1.0, 0.0, 0.0])
PER_NODE = len(HUB_AXES)
_PARTS = ("beam", "chord", "torsion", "axial")
_ALONG_UP = 1e-6  # sine of the angle between an element and the direction that is up in its sections


@dataclass(frozen=True, kw_only=True)
class BeamProperties:
    """Properties of a beam: numbers, or arrays (..., k + 1) with a value for each node; linear along each element.

    In a section "up" is the direction across the elastic axis that is nearest to I, and forward is across both. Linear
    along an element are the stiffnesses, the mass per length, its first and second moments about the elastic axis (mass
    times offset, and times products of two offsets), and the torsional inertia.

    Parameters
    ----------
    beam_stiffness, chord_stiffness : float or array
        EI of bending up and down, and of bending fore and aft, N m².
    torsion_stiffness : float or array
        GJ, N m².
    axial_stiffness : float or array
        EA, N.
    mass_per_length : float or array
        kg/m.
    torsional_inertia_per_length : float or array
        kg m²/m about the centre of mass of the section.
    mass_up, mass_forward : float or array
        Distances of the centre of mass of the section above and ahead of the elastic axis, m.

    Raises
    ------
    InputError
        When a value is not finite, a stiffness not above zero, or a mass or inertia negative.
    """

    beam_stiffness: Numbers
    chord_stiffness: Numbers
    torsion_stiffness: Numbers
    axial_stiffness: Numbers
    mass_per_length: Numbers
    torsional_inertia_per_length: Numbers
    mass_up: Numbers = 0.0
    mass_forward: Numbers = 0.0

    def __post_init__(self) -> None:
        for entry in fields(self):
            check_finite(entry.name, getattr(self, entry.name), sign_of(entry.name))

    def at_nodes(self, count: int) -> dict[str, Array]:
        """Return stiffnesses and moments of the mass at each node (..., count), by the names of the element."""
        given = {entry.name: np.asarray(getattr(self, entry.name)) for entry in fields(self)}
        for name, value in given.items():
            if value.ndim and value.shape[-1] not in (1, count):
                raise InputError(
                    name, f"array of shape {value.shape}", f"must have a value for each of {count} nodes"
                )
        mass, up, forward = given["mass_per_length"], given.pop("mass_up"), given.pop("mass_forward")
        about_centre = given.pop("torsional_inertia_per_length")
        given |= {
            "first_moment_up": mass * up,
            "first_moment_forward": mass * forward,
            "second_moment_up": mass * up**2,
            "product_of_inertia": mass * up * forward,
            "second_moment_forward": mass * forward**2,
            "twist_inertia": about_centre + mass * (up**2 + forward**2),
        }
        return {name: np.broadcast_to(value, (*value.shape[:-1], count)) for name, value in given.items()}


def sign_of(name: str) -> str:
    """Return what a property of a beam must be, as for `check_finite`."""
    if name.endswith("stiffness"):
        return "above zero"
    return "not negative" if name.endswith("per_length") else ""


def beam_chain(
    positions: ArrayLike, properties: BeamProperties, *, elastic_axis: ArrayLike = 0.0, up: ArrayLike = _UP
) -> tuple[Array, dict[str, Array]]:
    """Return mass and stiffness of beam elements from each node to the next.

    Parameters
    ----------
    positions : array (..., k + 1, 3)
        Nodes, the points whose motions are the coordinates, along I, J, K in m.
    properties : BeamProperties
    elastic_axis : array (..., k + 1, 3)
        Vectors from each node to the elastic axis there, m; the elastic axis is held to its nodes by rigid arms.
    up : array (3,) or (..., k, 3)
        Direction that is up in the sections; only its part across the element counts.

    Returns
    -------
    mass : array (..., 6k + 6, 6k + 6)
        On the six motions of the first node, of the second, and so on: displacements (m) along I, J, K and rotations
        (rad) about I, J, K.
    stiffness_parts : dict of str to array (..., 6k + 6, 6k + 6)
        Parts of the stiffness: beam, chord, torsion and axial.

    Raises
    ------
    InputError
        When two nodes are one point, or an element runs along `up`.
    """
    positions = np.asarray(positions)
    arms = np.broadcast_to(elastic_axis, np.broadcast_shapes(np.shape(elastic_axis), positions.shape))
    length, axes = _element_axes(np.diff(positions + arms, axis=-2), np.asarray(up))
    motion = _motion_of_ends(axes, arms)
    given = {"element_length": length} | _at_both_ends(properties.at_nodes(positions.shape[-2]))

    def whole(function: Callable[..., Array]) -> Array:
        return assembled(np.swapaxes(motion, -1, -2) @ evaluate(function, given) @ motion)

    return whole(element.mass), {part: whole(getattr(element, f"{part}_stiffness")) for part in _PARTS}


def section_motions(positions: Array, places: Array) -> Array:
    """Return the motions (..., k, p, 6, 12) of sections of a chain of elements, along and about I, J, K.

    Parameters
    ----------
    positions : array (..., k + 1, 3)
        Nodes on the elastic axis, m.
    places : array (p,)
        Places of the sections in each element, from 0 to 1.

    Returns
    -------
    array (..., k, p, 6, 12)
        Per motion of the inner and the outer node of the element.
    """
    length, axes = _element_axes(np.diff(positions, axis=-2), _UP)
    own = element.motion(element_length=length[..., None], element_position=places)
    ends = _motion_of_ends(axes, np.zeros(positions.shape))[..., None, :, :]
    back = np.swapaxes(ends[..., :PER_NODE, :PER_NODE], -1, -2)
    motion: Array = back @ own @ ends
    return motion


def rigid_motion(offset: ArrayLike) -> Array:
    """Return the motion (..., 6, 6) of a point of a rigid body per motion of a reference point.

    `offset` (..., 3) is the vector from the reference point to the point, m.
    """
    offset = np.asarray(offset)
    motion = np.zeros((*offset.shape[:-1], PER_NODE, PER_NODE), dtype=np.result_type(offset, float))
    motion[...] = np.eye(PER_NODE)
    motion[..., TRANSLATION, ROTATION] = np.swapaxes(np.cross(np.eye(3), offset[..., None, :]), -1, -2)
    return motion


def _element_axes(along: Array, up: Array) -> tuple[Array, Array]:
    """Return lengths (..., k) and axes (..., k, 3, 3) of elements: rows up, along, forward, in components I, J, K."""
    length = np.sqrt((along**2).sum(axis=-1))
    if not (np.real(length) > 0).all():
        raise InputError("positions", None, "must differ from each node to the next")
    along = along / length[..., None]
    across = up - (up * along).sum(axis=-1)[..., None] * along
    size = np.sqrt((across**2).sum(axis=-1))
    if not (np.real(size) > _ALONG_UP * np.sqrt((np.real(up) ** 2).sum(axis=-1))).all():
        raise InputError("up", np.real(up).tolist(), "must not point along an element")
    across = across / size[..., None]
    return length, np.stack(np.broadcast_arrays(across, along, np.cross(across, along)), axis=-2)


def _motion_of_ends(axes: Array, arms: Array) -> Array:
    """Return the motion (..., k, 12, 12) of both ends of each element in its own axes per motion of its two nodes."""
    turned = np.zeros((*axes.shape[:-2], PER_NODE, PER_NODE), dtype=axes.dtype)
    turned[..., TRANSLATION, TRANSLATION] = turned[..., ROTATION, ROTATION] = axes
    carried = rigid_motion(arms)
    ends = [turned @ carried[..., :-1, :, :], turned @ carried[..., 1:, :, :]]
    motion = np.zeros((*ends[0].shape[:-2], 2 * PER_NODE, 2 * PER_NODE), dtype=ends[0].dtype)
    motion[..., :PER_NODE, :PER_NODE], motion[..., PER_NODE:, PER_NODE:] = ends
    return motion


def _at_both_ends(at_nodes: Mapping[str, Array]) -> dict[str, Array]:
    """Return values (..., k) of properties (..., k + 1) at the inner and at the outer ends of the elements."""
    inner = {f"inner_{name}": values[..., :-1] for name, values in at_nodes.items()}
    return inner | {f"outer_{name}": values[..., 1:] for name, values in at_nodes.items()}
