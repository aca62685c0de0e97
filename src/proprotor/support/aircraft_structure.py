"""Half an aircraft: a free fuselage, the wing from the plane of symmetry to the tip, and the pylon.

The wing is a chain of beam elements: a straight box along J from the plane of symmetry to the side of the fuselage,
then the wing with its sweep and dihedral to the pylon. At its side the fuselage holds the displacements of the chain,
and each of the three rotations rigidly, with a spring, or not at all. The datum is the point of the elastic axis in the
plane of symmetry, as high and as far forward as at the fuselage side; all axes are those of the right rotor.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from typing import Any, Literal, NamedTuple

import numpy as np

from proprotor.errors import InputError, check_finite
from proprotor.support.beam import PER_NODE, BeamProperties, beam_chain, rigid_motion
from proprotor.support.beam_wing import (
    BeamStructure,
    Pylon,
    Wing,
    along_axes,
    check_elements,
    diagonal_matrix,
    on_motions,
    pylon_coordinates,
    real_part,
    selected,
    stepped,
)
from proprotor.support.modal_reduction import symmetric
from proprotor.support.normal_modes import HUB_AXES, TRANSLATION
from proprotor.typing import Array, Numbers

JOINT = ("held", "free")
_Joint = Numbers | Literal["held", "free"]
_SLOPES = {"chord_slope": "alpha_x", "twist": "alpha_y", "bending_slope": "alpha_z"}
_KINDS = {
    "alpha_x": "chord",
    "alpha_y": "torsion",
    "alpha_z": "beam",
}  # of the stiffness of a joint about each axis
_X, _Y, _Z, _ALPHA_X, _ALPHA_Y, _ALPHA_Z = range(6)


@dataclass(frozen=True, kw_only=True)
class Fuselage:
    """A rigid fuselage with its tail, or a whole aircraft as one rigid body; numbers, or arrays (...) of designs.

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

    mass: Numbers
    roll_inertia: Numbers
    pitch_inertia: Numbers
    yaw_inertia: Numbers
    product_of_inertia: Numbers = 0.0
    centre_forward: Numbers = 0.0
    centre_up: Numbers = 0.0

    def __post_init__(self) -> None:
        for entry in fields(self):
            check_finite(entry.name, getattr(self, entry.name), _SIGNS.get(entry.name, ""))
        if np.any(_too_large_product(vars(self))):
            rule = "must not exceed the square root of roll_inertia times yaw_inertia"
            raise InputError("product_of_inertia", self.product_of_inertia, rule)

    @property
    def mass_at_datum(self) -> Array:
        """Mass (..., 6, 6) on the motion of the datum, kg, kg m and kg m²."""
        inertias = self.yaw_inertia, self.pitch_inertia, self.roll_inertia
        product = np.asarray(self.product_of_inertia)[..., None, None] * _PRODUCT
        motion = rigid_motion(along_axes(self.centre_up, 0.0, self.centre_forward))
        return _turned(motion, diagonal_matrix(*[self.mass] * 3, *inertias) - product)

    def without(self, rest: Array) -> Fuselage:
        """Return what is left of the body without other bodies.

        Parameters
        ----------
        rest : array (..., 6, 6)
            Mass of the other bodies on the motion of the datum, SI; symmetric about the plane of I and K.

        Raises
        ------
        InputError
            When mass or inertia left would not be above zero, with the value given and what is left: `lacking`.
        """
        for error in self.lacking(rest).flat:
            if error is not None:
                raise error
        return Fuselage(**_numbers_of(self.mass_at_datum - rest))

    def lacking(self, rest: Array) -> Array:
        """Return for each design the error of what the body has too little of without other bodies, or None.

        Parameters
        ----------
        rest : array (..., 6, 6)
            As for `without`.

        Returns
        -------
        array (...) of InputError or None
        """
        left = self.mass_at_datum - rest
        errors = np.full(left.shape[:-2], None, dtype=object)
        # Without mass a body has no centre that an inertia could be about.
        enough = np.real(left[..., _X, _X]) > 0
        found = _numbers_of(np.where(enough[..., None, None], left, np.eye(6))) | {"mass": left[..., _X, _X]}
        for name, place, rule in _shortages({name: np.real(value) for name, value in found.items()}):
            given = np.broadcast_to(np.real(getattr(self, name)), errors.shape)[place]
            errors[place] = InputError(name, float(given), rule)
        return errors


_INERTIAS = {"roll_inertia": _ALPHA_Z, "pitch_inertia": _ALPHA_Y, "yaw_inertia": _ALPHA_X}
_PRODUCT = np.zeros((6, 6))
_PRODUCT[[_ALPHA_X, _ALPHA_Z], [_ALPHA_Z, _ALPHA_X]] = 1.0
_SIGNS = {"mass": "above zero"} | dict.fromkeys(_INERTIAS, "not negative")
_UNITS = dict.fromkeys(_INERTIAS, "kg m²") | {"mass": "kg"}
_LEFT = "must be more than wing, nacelles and rotors have, which leave {:.4g} {} for the fuselage"
_LEFT_PRODUCT = (
    "must leave the fuselage without wing, nacelles and rotors at most the square root of its roll_inertia "
    "times yaw_inertia"
)


def _shortages(left: Mapping[str, Array]) -> Iterator[tuple[str, tuple[int, ...], str]]:
    """Yield what is too little in numbers (...) that are left for a fuselage: name, place and rule; the worst last."""
    for place in map(tuple, np.argwhere(_too_large_product(left))):
        yield "product_of_inertia", place, _LEFT_PRODUCT
    for name, unit in _UNITS.items():
        for place in map(tuple, np.argwhere(left[name] <= 0)):
            yield name, place, _LEFT.format(left[name][place], unit)


def _too_large_product(numbers: Mapping[str, Any]) -> Array:
    """Return whether a product of inertia (...) is more than mass anywhere could have with these inertias."""
    names = "product_of_inertia", "roll_inertia", "yaw_inertia"
    product, roll, yaw = (np.real(numbers[name]) for name in names)
    return np.asarray(product**2 > roll * yaw)


def _numbers_of(body: Array) -> dict[str, Array]:
    """Return the numbers (...) of a fuselage by name from its mass (..., 6, 6) on the motion of the datum."""
    centre = centre_of_mass(body)
    about_centre = _turned(rigid_motion(-centre), body)
    inertias = {name: about_centre[..., place, place] for name, place in _INERTIAS.items()}
    return inertias | {
        "mass": body[..., _X, _X],
        "product_of_inertia": -about_centre[..., _ALPHA_X, _ALPHA_Z],
        "centre_forward": centre[..., _Z],
        "centre_up": centre[..., _X],
    }


@dataclass(frozen=True, kw_only=True)
class CarryThrough:
    """The box that carries the wing through the fuselage, and what the fuselage holds at its side; numbers or arrays.

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
        When the width or a spring is not above zero, a word is unknown, or there are too many elements.
    """

    half_width: Numbers
    beam_stiffness: Numbers | None = None
    chord_stiffness: Numbers | None = None
    torsion_stiffness: Numbers | None = None
    axial_stiffness: Numbers | None = None
    mass_per_length: Numbers | None = None
    torsional_inertia_per_length: Numbers | None = None
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
        check_elements(self.elements)

    def turns_freely(self, name: str) -> bool:
        """Return whether nothing holds one of the rotations."""
        joint = getattr(self, name)
        return isinstance(joint, str) and joint == "free"

    @property
    def nodes(self) -> Array:
        """Nodes from the datum to the fuselage side, m (..., elements + 1, 3)."""
        stations = np.linspace(0, 1, self.elements + 1)[:, None]
        return stations * along_axes(0.0, self.half_width, 0.0)[..., None, :]

    def properties(self, wing: Wing) -> BeamProperties:
        """Return the properties of the box, those of the wing's root where none are given."""
        root = {entry.name: getattr(wing.properties, entry.name)[..., :1] for entry in fields(BeamProperties)}
        given = {name: getattr(self, name, None) for name in root}
        own = {name: np.asarray(value)[..., None] for name, value in given.items() if value is not None}
        return BeamProperties(**(root | own))


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
    mass : array (..., 6 + n, 6 + n)
        On the six motions of the fuselage's datum and the n coordinates, SI.
    hub : array (..., 6, 6 + n)
        Motion of the hub for each of these.
    """

    structure: BeamStructure
    mass: Array
    hub: Array

    def loaded(self, rotor_mass: Numbers) -> Array:
        """Return the mass (..., 6 + n, 6 + n) with a point mass at the hub, kg."""
        moved = self.hub[..., TRANSLATION, :]
        point = np.asarray(rotor_mass)[..., None, None] * (np.swapaxes(moved, -1, -2) @ moved)
        return np.asarray(self.mass + point)

    def rigid_mass(self, rotor_mass: Numbers) -> Array:
        """Return the mass (..., 6, 6) of both sides of a symmetric aircraft on the motion of the datum, as one body."""
        of_both: Array = 2 * np.where(_SAME_SYMMETRY, self.loaded(rotor_mass)[..., :6, :6], 0.0)
        return of_both


# Motions along x and z and about y are symmetric, the others antisymmetric: both sides cancel what couples the two.
SYMMETRIC_AXES, ANTISYMMETRIC_AXES = (_X, _Z, _ALPHA_Y), (_Y, _ALPHA_Z, _ALPHA_X)
_IS_SYMMETRIC = np.isin(np.arange(6), SYMMETRIC_AXES)
_SAME_SYMMETRY = _IS_SYMMETRIC[:, None] == _IS_SYMMETRIC


def half_aircraft(side: WingSide) -> HalfAircraft:
    """Return the finite-element matrices of one side of an aircraft, without fuselage and rotor.

    Complex numbers leave the real parts of all matrices as they are without them, to the last digit.
    """
    half = _half(side)
    if np.isrealobj(half.mass) and np.isrealobj(half.structure.stiffness):
        return half
    real = _half(WingSide(real_part(side.carry_through), real_part(side.wing), real_part(side.pylon)))
    return HalfAircraft(
        stepped(real.structure, half.structure), real.mass + 1j * np.imag(half.mass), half.hub
    )


def _half(side: WingSide) -> HalfAircraft:
    """Return the finite-element matrices of one side of an aircraft."""
    elements = mass, _, positions = _chain(side)
    structure = _held_by_fuselage(side, elements)
    turning = structure.nodes.reshape(*structure.nodes.shape[:-3], -1, len(structure.names))
    turned = rigid_motion(positions)
    turned = turned.reshape(*turned.shape[:-3], -1, 6)
    nodes = side_by_side(turned, turning)
    hub = side_by_side(rigid_motion(positions[..., -1, :] + side.pylon.hub), structure.hub)
    return HalfAircraft(structure, symmetric(_turned(nodes, mass) + _turned(hub, side.pylon.mass)), hub)


def centre_of_mass(mass: Array) -> Array:
    """Return the centre (..., 3) of a body in the plane of I and K; its mass (..., 6, 6) is on the origin's motion."""
    up, forward = -mass[..., _Z, _ALPHA_Y], mass[..., _X, _ALPHA_Y]
    return along_axes(up, 0.0, forward) / mass[..., _X, _X, None]


def _chain(side: WingSide) -> tuple[Array, dict[str, Array], Array]:
    """Return mass and stiffness parts on the motions of all nodes of box and wing, and the positions of the nodes."""
    box, wing = side.carry_through, side.wing
    positions = _joined_positions(box.nodes, wing.nodes)
    inner = beam_chain(box.nodes, box.properties(wing))
    outer = beam_chain(wing.nodes, wing.properties)
    start = PER_NODE * box.elements

    def joined(first: Array, second: Array) -> Array:
        size = start + second.shape[-1]
        leading = np.broadcast_shapes(first.shape[:-2], second.shape[:-2])
        whole = np.zeros((*leading, size, size), dtype=np.result_type(first, second))
        whole[..., : first.shape[-1], : first.shape[-1]] += first
        whole[..., start:, start:] += second
        return whole

    parts = {name: joined(part, outer[1][name]) for name, part in inner[1].items()}
    return joined(inner[0], outer[0]), parts, positions


def _joined_positions(box: Array, wing: Array) -> Array:
    """Return the nodes (..., k, 3) of the box, then of the wing behind its end."""
    wing = box[..., -1:, :] + wing
    leading = np.broadcast_shapes(box.shape[:-2], wing.shape[:-2])
    parts = (np.broadcast_to(part, (*leading, *part.shape[-2:])) for part in (box[..., :-1, :], wing))
    return np.concatenate(list(parts), axis=-2)


def _held_by_fuselage(side: WingSide, elements: tuple[Array, dict[str, Array], Array]) -> BeamStructure:
    """Return one side on the coordinates that a fuselage at rest leaves free."""
    of_wing, hub, wing_names = pylon_coordinates(side.wing, side.pylon)
    count = side.carry_through.elements
    joints = {axis: getattr(side.carry_through, name) for name, axis in _SLOPES.items()}
    turns = [axis for axis, joint in joints.items() if not isinstance(joint, str) or joint == "free"]
    names = [f"box_{node}_{axis}" for node in range(count) for axis in HUB_AXES]
    inner = len(names)
    names += [f"side_{axis}" for axis in turns]
    own = len(names)
    shape = (*of_wing.shape[:-3], count + of_wing.shape[-3], PER_NODE, own + len(wing_names))
    nodes = np.zeros(shape, dtype=of_wing.dtype)
    nodes[..., :count, :, :inner] = np.eye(inner).reshape(count, PER_NODE, inner)
    for place, axis in enumerate(turns, start=inner):
        nodes[..., count, HUB_AXES.index(axis), place] = 1.0
    nodes[..., count + 1 :, :, own:] = of_wing[..., 1:, :, :]
    moved = np.concatenate([np.zeros((PER_NODE, own)), hub], axis=-1)
    structure = on_motions(nodes, moved, (*names, *wing_names), elements, side.pylon)
    for axis in turns:
        if not isinstance(joints[axis], str):
            spring = np.asarray(joints[axis])[..., None, None] * selected(structure.names, f"side_{axis}")
            structure.stiffness_parts[_KINDS[axis]] = structure.stiffness_parts[_KINDS[axis]] + spring
    return structure


def _turned(motion: Array, matrix: Array) -> Array:
    """Return a matrix (..., m, m) on the coordinates of motions (..., m, n)."""
    turned: Array = np.swapaxes(motion, -1, -2) @ matrix @ motion
    return turned


def side_by_side(first: Array, second: Array) -> Array:
    """Return matrices (..., m, n) side by side."""
    leading = np.broadcast_shapes(first.shape[:-2], second.shape[:-2])
    parts = [np.broadcast_to(part, (*leading, *part.shape[-2:])) for part in (first, second)]
    return np.concatenate(parts, axis=-1)
