"""Half an aircraft: a free fuselage, the wing from the plane of symmetry to the tip, and the pylon.

The wing is a chain of beam elements: a straight box along J from the plane of symmetry to the side of the fuselage,
then the wing with its sweep and dihedral to the pylon. At its side the fuselage holds the displacements of the chain,
and each of the three rotations rigidly, with a spring, or not at all. The datum is the point of the elastic axis in the
plane of symmetry, as high and as far forward as at the fuselage side; all axes are those of the right rotor.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, Literal, NamedTuple

import numpy as np

from proprotor.errors import InputError, check_finite
from proprotor.support.beam_wing import (
    BeamStructure,
    Pylon,
    Wing,
    pylon_coordinates,
    rigid_motion,
    stiffness_on,
    wing_elements,
)
from proprotor.support.modal_reduction import symmetric
from proprotor.support.normal_modes import HUB_AXES, TRANSLATION
from proprotor.typing import Array

JOINT = ("held", "free")
_Joint = float | Literal["held", "free"]
_SLOPES = {
    "chord_slope": "alpha_x",
    "twist": "alpha_y",
    "bending_slope": "alpha_z",
}  # in the order of the axes
_X, _Y, _Z, _ALPHA_X, _ALPHA_Y, _ALPHA_Z = range(6)
_PER_NODE = len(HUB_AXES)


@dataclass(frozen=True, kw_only=True)
class Fuselage:
    """A rigid fuselage with its tail, or a whole aircraft as one rigid body.

    Parameters
    ----------
    mass : float
        kg.
    roll_inertia, pitch_inertia, yaw_inertia : float
        Inertias about the axes K, J and I through the centre of mass, kg m².
    product_of_inertia : float
        Integral of forward distance times upward distance from the centre of mass, kg m².
    centre_forward, centre_up : float
        Distances of the centre of mass ahead of and above the elastic axis of the wing at the fuselage side, m.

    Raises
    ------
    InputError
        When a value is not finite, the mass not above zero, or an inertia negative.
    """

    mass: float
    roll_inertia: float
    pitch_inertia: float
    yaw_inertia: float
    product_of_inertia: float = 0.0
    centre_forward: float = 0.0
    centre_up: float = 0.0

    def __post_init__(self) -> None:
        for entry in fields(self):
            check_finite(entry.name, getattr(self, entry.name), _SIGNS.get(entry.name, ""))
        if self.product_of_inertia**2 > self.roll_inertia * self.yaw_inertia:
            rule = "must not exceed the square root of roll_inertia times yaw_inertia"
            raise InputError("product_of_inertia", self.product_of_inertia, rule)

    @property
    def mass_at_datum(self) -> Array:
        """Mass (6, 6) on the motion of the datum, kg, kg m and kg m²."""
        body = np.diag([self.mass] * 3 + [self.yaw_inertia, self.pitch_inertia, self.roll_inertia])
        body[_ALPHA_X, _ALPHA_Z] = body[_ALPHA_Z, _ALPHA_X] = -self.product_of_inertia
        motion = rigid_motion(np.array([self.centre_up, 0.0, self.centre_forward]))
        return motion.T @ body @ motion

    def without(self, rest: Array) -> Fuselage:
        """Return what is left of the body without other bodies.

        Parameters
        ----------
        rest : array (6, 6)
            Mass of the other bodies on the motion of the datum, SI; symmetric about the plane of I and K.

        Raises
        ------
        InputError
            When mass or inertia left would be negative, with the value given and what the others have.
        """
        left = self.mass_at_datum - rest
        _check_left("mass", self.mass, left[_X, _X])
        centre = centre_of_mass(left)
        about = rigid_motion(-centre)
        body = about.T @ left @ about
        places = {"roll_inertia": _ALPHA_Z, "pitch_inertia": _ALPHA_Y, "yaw_inertia": _ALPHA_X}
        for name, place in places.items():
            _check_left(name, getattr(self, name), body[place, place])
        return Fuselage(
            mass=left[_X, _X],
            **{name: body[place, place] for name, place in places.items()},
            product_of_inertia=-body[_ALPHA_X, _ALPHA_Z],
            centre_forward=centre[_Z],
            centre_up=centre[_X],
        )


_SIGNS = {"mass": "above zero"} | {f"{axis}_inertia": "not negative" for axis in ("roll", "pitch", "yaw")}


@dataclass(frozen=True, kw_only=True)
class CarryThrough:
    """The box that carries the wing through the fuselage, and what the fuselage holds at its side.

    Parameters
    ----------
    half_width : float
        Distance from the plane of symmetry to the fuselage side, where the wing begins, m.
    beam_stiffness, chord_stiffness, torsion_stiffness, axial_stiffness : float, optional
        EI, GJ (N m²) and EA (N) of the box; those of the wing root by default.
    mass_per_length, torsional_inertia_per_length : float, optional
        kg/m and kg m²/m of the box; those of the wing root by default.
    bending_slope, chord_slope, twist : "held", "free" or float
        Rotations of the wing against the fuselage at its side, about K, I and J: held rigidly, free, or held by a
        spring, N m/rad at each side.
    elements : int
        Number of elements, all of equal length.

    Raises
    ------
    InputError
        When the width is not above zero, a spring is not above zero, or a word is unknown.
    """

    half_width: float
    beam_stiffness: float | None = None
    chord_stiffness: float | None = None
    torsion_stiffness: float | None = None
    axial_stiffness: float | None = None
    mass_per_length: float | None = None
    torsional_inertia_per_length: float | None = None
    bending_slope: _Joint = "free"
    chord_slope: _Joint = "free"
    twist: _Joint = "held"
    elements: int = 2

    def __post_init__(self) -> None:
        check_finite("half_width", self.half_width, "above zero")
        for name in _SLOPES:
            given = getattr(self, name)
            if isinstance(given, str) and given not in JOINT:
                raise InputError(name, given, 'must be "held", "free" or a stiffness')
            if not isinstance(given, str):
                check_finite(name, given, "above zero")

    def box(self, wing: Wing) -> Wing:
        """Return the box as a straight wing along J, with the properties of the wing's root where none are given."""
        own: dict[str, Any] = {
            entry.name: getattr(self, entry.name) for entry in fields(self) if hasattr(wing, entry.name)
        }
        for name, value in own.items():
            if value is None:
                own[name] = _at_root(getattr(wing, name))
        return Wing(span=self.half_width, **own)


class WingSide(NamedTuple):
    """One side of the aircraft without the fuselage: box, wing and pylon, in the axes of the rotor on this side."""

    carry_through: CarryThrough
    wing: Wing
    pylon: Pylon


class HalfAircraft(NamedTuple):
    """Matrices of one side: of structure, nacelle and hub hardware, without the fuselage.

    structure : BeamStructure
        On the n coordinates of deformation relative to the fuselage, of which the first six move the node in the plane
        of symmetry. Its positions start from the datum.
    mass : array (6 + n, 6 + n)
        On the six motions of the fuselage's datum and the n coordinates, SI.
    hub : array (6, 6 + n)
        Motion of the hub for each of these.
    """

    structure: BeamStructure
    mass: Array
    hub: Array

    def loaded(self, rotor_mass: float) -> Array:
        """Return the mass (6 + n, 6 + n) with a point mass at the hub, kg."""
        moved = self.hub[TRANSLATION]
        return self.mass + rotor_mass * moved.T @ moved

    def rigid_mass(self, rotor_mass: float) -> Array:
        """Return the mass (6, 6) of both sides of a symmetric aircraft on the motion of the datum, as one body."""
        of_both: Array = 2 * np.where(_SAME_SYMMETRY, self.loaded(rotor_mass)[:6, :6], 0.0)
        return of_both


# Motions along x and z and about y are symmetric, the others antisymmetric: both sides cancel what couples the two.
SYMMETRIC_AXES, ANTISYMMETRIC_AXES = (_X, _Z, _ALPHA_Y), (_Y, _ALPHA_Z, _ALPHA_X)
_IS_SYMMETRIC = np.isin(np.arange(6), SYMMETRIC_AXES)
_SAME_SYMMETRY = _IS_SYMMETRIC[:, None] == _IS_SYMMETRIC


def half_aircraft(side: WingSide) -> HalfAircraft:
    """Return the finite-element matrices of one side of an aircraft, without fuselage and rotor."""
    elements, parts, positions = _chain(side)
    structure = _held_by_fuselage(side, elements, parts, positions)
    relative = structure.nodes.reshape(-1, len(structure.names))
    carried = rigid_motion(positions).reshape(-1, 6)
    hub_position = positions[-1] + side.pylon.hub
    nodes = np.concatenate([carried, relative], axis=-1)
    hub = np.concatenate([rigid_motion(hub_position), structure.hub], axis=-1)
    mass = nodes.T @ elements @ nodes + hub.T @ side.pylon.mass_at_hub @ hub
    return HalfAircraft(structure, symmetric(mass), hub)


def centre_of_mass(mass: Array) -> Array:
    """Return the centre (3,) of a body, in the plane of I and K, from its mass (6, 6) on the motion of the origin."""
    up, forward = -mass[_Z, _ALPHA_Y], mass[_X, _ALPHA_Y]
    return np.array([up, 0.0, forward]) / mass[_X, _X]


def _chain(side: WingSide) -> tuple[Array, dict[str, Array], Array]:
    """Return mass and stiffness parts on the motions of all nodes of box and wing, and the positions of the nodes."""
    box = side.carry_through.box(side.wing)
    inner, outer = wing_elements(box), wing_elements(side.wing)
    positions = np.concatenate([inner[2][:-1], box.tip + outer[2]])
    start = _PER_NODE * box.elements

    def joined(first: Array, second: Array) -> Array:
        whole = np.zeros((start + len(second), start + len(second)))
        whole[: len(first), : len(first)] += first
        whole[start:, start:] += second
        return whole

    parts = {name: joined(part, outer[1][name]) for name, part in inner[1].items()}
    return joined(inner[0], outer[0]), parts, positions


def _held_by_fuselage(
    side: WingSide, elements: Array, parts: dict[str, Array], positions: Array
) -> BeamStructure:
    """Return one side on the coordinates that a fuselage at rest leaves free."""
    of_wing, hub, wing_names = pylon_coordinates(side.wing, side.pylon)
    joints = {axis: getattr(side.carry_through, name) for name, axis in _SLOPES.items()}
    turns = [axis for axis, joint in joints.items() if joint != "held"]
    inner = _PER_NODE * side.carry_through.elements
    names = [f"box_{node}_{axis}" for node in range(side.carry_through.elements) for axis in HUB_AXES] + [
        f"side_{axis}" for axis in turns
    ]
    own = len(names)
    nodes = np.zeros((len(positions), _PER_NODE, own + len(wing_names)))
    nodes[: side.carry_through.elements, :, :inner] = np.eye(inner).reshape(-1, _PER_NODE, inner)
    for place, axis in enumerate(turns, start=inner):
        nodes[side.carry_through.elements, HUB_AXES.index(axis), place] = 1.0
    nodes[side.carry_through.elements + 1 :, :, own:] = of_wing[1:]
    hub = np.concatenate([np.zeros((_PER_NODE, own)), hub], axis=-1)
    motion = nodes.reshape(-1, nodes.shape[-1])
    names += wing_names
    stiffness = stiffness_on(motion, parts, names, side.pylon)
    kinds = {"alpha_x": "chord", "alpha_y": "torsion", "alpha_z": "beam"}
    for axis in turns:
        if joints[axis] != "free":
            place = names.index(f"side_{axis}")
            stiffness[kinds[axis]][place, place] += joints[axis]
    mass = symmetric(motion.T @ elements @ motion + hub.T @ side.pylon.mass_at_hub @ hub)
    return BeamStructure(tuple(names), mass, stiffness, hub, nodes, positions)


def _at_root(profile: Any) -> float:
    """Return the value of a property along the wing at its root."""
    return float(profile[1][0] if isinstance(profile, tuple) else profile)


def _check_left(name: str, whole: float, left: float) -> None:
    """Refuse a mass or an inertia of the whole aircraft that its wing, nacelles and rotors exceed."""
    if left <= 0:
        rule = f"must be more than wing, nacelles and rotors have, which leave {left:.4g} for the fuselage"
        raise InputError(name, whole, rule)
