"""A cantilever wing of beam finite elements, with a rigid pylon at the tip and the hub ahead of the pylon.

pystran makes the elements (Euler-Bernoulli bending in two planes, free torsion, extension; consistent mass with
torsional inertia). The elastic axis is straight, from the mount at the origin to the pylon, and all axes are the
rotor's: I up, J outboard, K forward along the shaft. The pylon is rigid; it may turn about J against a spring at
the wing tip, the downstop.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, check_finite, unknown_name
from proprotor.support.modal_reduction import ModalSupport, on_modes, symmetric
from proprotor.support.normal_modes import HUB_AXES, ROTATION, TRANSLATION, NormalModes
from proprotor.typing import Array

_UP, _OUTBOARD, _ = np.eye(3)
_PYLON_PITCH, _PYLON_YAW = "pylon_pitch", "pylon_yaw"
_SpanwiseProfile = float | tuple[ArrayLike, ArrayLike]
_MOST_ELEMENTS = 200
_PER_NODE = len(HUB_AXES)


@dataclass(frozen=True, kw_only=True)
class Wing:
    """A straight cantilever along its elastic axis.

    A property along the wing is one number or (stations, values), stations from 0 at the mount to 1 at the
    pylon, linear between them.

    Parameters
    ----------
    span : float
        Distance from the mount to the pylon along J, m.
    beam_stiffness, chord_stiffness : number or profile
        EI of bending up and down, and of bending fore and aft, N m².
    torsion_stiffness : number or profile
        GJ, N m².
    axial_stiffness : number or profile
        EA, N.
    mass_per_length : number or profile
        kg/m along the elastic axis; the centre of mass lies on this axis.
    torsional_inertia_per_length : number or profile
        kg m²/m about the elastic axis.
    sweep, dihedral : float
        Angles of the elastic axis, rad, positive back and up.
    elements : int
        Number of elements, all of equal length.

    Raises
    ------
    InputError
        When a value is not finite or out of range, or a profile does not reach from 0 to 1.
    """

    span: float
    beam_stiffness: _SpanwiseProfile
    chord_stiffness: _SpanwiseProfile
    torsion_stiffness: _SpanwiseProfile
    axial_stiffness: _SpanwiseProfile
    mass_per_length: _SpanwiseProfile
    torsional_inertia_per_length: _SpanwiseProfile
    sweep: float = 0.0
    dihedral: float = 0.0
    elements: int = 8

    def __post_init__(self) -> None:
        _check("span", self.span, "above zero")
        for name in ("sweep", "dihedral"):
            _check(name, getattr(self, name))
            if abs(getattr(self, name)) >= np.pi / 2:
                raise InputError(name, getattr(self, name), "must lie between -90 and 90 degrees")
        for name in _PROFILES:
            sign = "above zero" if name.endswith("stiffness") else "not negative"
            _check_profile(name, getattr(self, name), sign)
        if not isinstance(self.elements, int) or not 1 <= self.elements <= _MOST_ELEMENTS:
            raise InputError("elements", self.elements, f"must be a whole number from 1 to {_MOST_ELEMENTS}")

    @property
    def tip(self) -> Array:
        """Point where the elastic axis meets the pylon, m (3,)."""
        return self.span * np.array([np.tan(self.dihedral), 1.0, -np.tan(self.sweep)])


_PROFILES = tuple(e.name for e in fields(Wing) if e.name.endswith(("_stiffness", "_per_length")))


@dataclass(frozen=True, kw_only=True)
class Pylon:
    """A rigid nacelle at the wing tip, and the mass of the hub that no rotor model contains.

    Parameters
    ----------
    nacelle_mass : float
        kg, without the rotor.
    nacelle_pitch_inertia, nacelle_yaw_inertia, nacelle_roll_inertia : float
        Inertias about the axes J, I and K through the nacelle's centre of mass, kg m².
    mast_length, mast_height, mast_outboard : float
        Distances from the elastic axis at the tip to the hub along K, I and J, m.
    nacelle_forward, nacelle_up, nacelle_outboard : float
        Distances from the elastic axis at the tip to the nacelle's centre of mass along K, I and J, m.
    hub_mass : float
        Mass at the hub that belongs to the rotor but not to its blades, kg.
    pitch_stiffness, yaw_stiffness : float or None
        Stiffness of the downstop about J, and of the spindle about I, N m/rad; with None the pylon does not turn
        against the wing tip about this axis.

    Raises
    ------
    InputError
        When a value is not finite, a mass or inertia negative, or a spring not above zero.
    """

    nacelle_mass: float
    nacelle_pitch_inertia: float
    nacelle_yaw_inertia: float
    nacelle_roll_inertia: float
    mast_length: float
    mast_height: float = 0.0
    mast_outboard: float = 0.0
    nacelle_forward: float = 0.0
    nacelle_up: float = 0.0
    nacelle_outboard: float = 0.0
    hub_mass: float = 0.0
    pitch_stiffness: float | None = None
    yaw_stiffness: float | None = None

    def __post_init__(self) -> None:
        given = {entry.name: getattr(self, entry.name) for entry in fields(self)}
        springs = {name: given.pop(name) for name in ("pitch_stiffness", "yaw_stiffness")}
        for name, value in given.items():
            _check(name, value, "not negative" if name.endswith(("mass", "inertia")) else "")
        for name, value in springs.items():
            if value is not None:
                _check(name, value, "above zero")

    @property
    def hub(self) -> Array:
        """Vector from the elastic axis at the tip to the hub, m (3,) along I, J, K."""
        return np.array([self.mast_height, self.mast_outboard, self.mast_length])

    @property
    def nacelle(self) -> Array:
        """Vector from the elastic axis at the tip to the nacelle's centre of mass, m (3,)."""
        return np.array([self.nacelle_up, self.nacelle_outboard, self.nacelle_forward])

    @property
    def mass_at_hub(self) -> Array:
        """Mass of nacelle and hub hardware (6, 6) on the motion of the hub, SI."""
        inertia = (self.nacelle_yaw_inertia, self.nacelle_pitch_inertia, self.nacelle_roll_inertia)
        nacelle = np.diag([self.nacelle_mass] * 3 + list(inertia))
        motion = rigid_motion(self.nacelle - self.hub)
        return motion.T @ nacelle @ motion + self.hub_mass * np.diag([1.0] * 3 + [0.0] * 3)


class BeamStructure(NamedTuple):
    """Mass and stiffness of wing and pylon on the motions of the nodes between mount and tip, then of the hub.

    names : tuple of str
        Names of the n coordinates: six for each node, six of the hub (m and rad), and with a spring the pitch of the
        pylon against the wing tip, nose up, and the yaw about I.
    mass : array (n, n)
    stiffness_parts : mapping of str to array (n, n)
        Parts of the stiffness: beam, chord, torsion (with the downstop), axial, and with a spindle pylon yaw.
    hub : array (6, n)
        Motion of the hub for each coordinate.
    nodes : array (elements + 1, 6, n)
        Motion of each node of the elastic axis for each coordinate, the mount first.
    positions : array (elements + 1, 3)
        Positions of the nodes, m.
    """

    names: tuple[str, ...]
    mass: Array
    stiffness_parts: dict[str, Array]
    hub: Array
    nodes: Array
    positions: Array

    @property
    def stiffness(self) -> Array:
        """The whole stiffness (n, n)."""
        return sum(self.stiffness_parts.values(), start=np.zeros(()))


def beam_structure(wing: Wing, pylon: Pylon) -> BeamStructure:
    """Return the finite-element matrices of wing and pylon, without the rotor."""
    mass, parts, positions = wing_elements(wing)
    nodes, hub, names = pylon_coordinates(wing, pylon)
    motion = nodes.reshape(-1, len(names))
    return BeamStructure(
        names=names,
        mass=symmetric(motion.T @ mass @ motion + hub.T @ pylon.mass_at_hub @ hub),
        stiffness_parts=stiffness_on(motion, parts, names, pylon),
        hub=hub,
        nodes=nodes,
        positions=positions,
    )


def stiffness_on(
    motion: Array, parts: Mapping[str, Array], names: Sequence[str], pylon: Pylon
) -> dict[str, Array]:
    """Return the parts of the stiffness on the named coordinates, with the springs of the pylon.

    Parameters
    ----------
    motion : array (m, n)
        Motion of the nodes for each coordinate.
    parts : mapping of str to array (m, m)
        Parts of the stiffness on the motion of the nodes.
    names : sequence of str
        Names of the n coordinates, among these the pitch and the yaw of a pylon on springs.
    pylon : Pylon
    """
    found = {name: symmetric(motion.T @ part @ motion) for name, part in parts.items()}
    if pylon.pitch_stiffness is not None:
        place = names.index(_PYLON_PITCH)
        found["torsion"][place, place] += pylon.pitch_stiffness
    if pylon.yaw_stiffness is not None:
        place = names.index(_PYLON_YAW)
        found["pylon yaw"] = np.zeros_like(found["beam"])
        found["pylon yaw"][place, place] = pylon.yaw_stiffness
    return found


def beam_wing(
    wing: Wing,
    pylon: Pylon,
    *,
    modes: int | None = None,
    damping_ratio: ArrayLike | Mapping[str, float] = 0.0,
    rotor_mass: float = 0.0,
) -> NormalModes:
    """Return the wing as a support.

    Parameters
    ----------
    wing, pylon : Wing, Pylon
    modes : int, optional
        How many of the lowest modes to keep; by default all coordinates of the finite elements. A mode is called beam,
        chord, torsion or axial after the stiffness with most of the mode's strain energy, from the second mode of a
        kind on with a number.
    damping_ratio : float, array (j,) or mapping
        Structural damping as a fraction of critical: of the lowest modes, the last value for all modes above, or of all
        beam, chord, torsion and axial modes by these names. A loss factor g (hysteretic damping) is equivalent to g/2
        at the frequency of each mode.
    rotor_mass : float
        Mass at the hub while modes are computed and damped, kg. This mass does not stay in the matrices, because the
        rotor model brings it.

    Returns
    -------
    NormalModes

    Raises
    ------
    InputError
        When there are fewer modes than asked for, or when all coordinates are kept and some have no mass.
    """
    structure = beam_structure(wing, pylon)
    return on_coordinates(structure, modes, damping_ratio, rotor_mass).support


def on_coordinates(
    structure: BeamStructure,
    count: int | None,
    damping_ratio: ArrayLike | Mapping[str, float],
    rotor_mass: float,
) -> ModalSupport:
    """Return the structure as a support on all coordinates or on its `count` lowest modes; see `beam_wing`."""
    given: ArrayLike | Callable[[Array], ArrayLike]
    if isinstance(damping_ratio, Mapping):
        _check_kinds(damping_ratio, structure)
        given = partial(_ratios_by_kind, structure, damping_ratio)
    else:
        given = damping_ratio
    return on_modes(
        structure.names,
        structure.mass,
        structure.stiffness,
        structure.hub,
        count=count,
        damping_ratio=given,
        rotor_mass=rotor_mass,
        name_modes=partial(_names_by_energy, structure),
    )


def _check_kinds(damping_ratio: Mapping[str, float], structure: BeamStructure) -> None:
    """Refuse damping ratios that are not given for each kind of mode."""
    for kind in structure.stiffness_parts:
        if kind not in damping_ratio:
            raise InputError(f"damping_ratio[{kind}]", None, "is missing")
    for kind in damping_ratio:
        if kind not in structure.stiffness_parts:
            rule = unknown_name(kind, tuple(structure.stiffness_parts), "kind of mode")
            raise InputError("damping_ratio", kind, rule)


def kinds_by_energy(stiffness_parts: Mapping[str, Array], shapes: Array) -> list[str]:
    """Return for each mode the part of the stiffness that has most of the strain energy."""
    energy = [np.einsum("ij,ij->j", shapes, part @ shapes) for part in stiffness_parts.values()]
    kinds = list(stiffness_parts)
    return [kinds[place] for place in np.argmax(energy, axis=0)]


def _ratios_by_kind(structure: BeamStructure, ratios: Mapping[str, float], shapes: Array) -> list[float]:
    """Return the damping ratio of each mode from the ratio of its kind."""
    return [ratios[kind] for kind in kinds_by_energy(structure.stiffness_parts, shapes)]


def _names_by_energy(structure: BeamStructure, shapes: Array) -> list[str]:
    """Return the names of modes by their kind, from the second mode of a kind on with a number."""
    return numbered(kinds_by_energy(structure.stiffness_parts, shapes))


def numbered(kinds: Sequence[str]) -> list[str]:
    """Return the kinds of modes, from the second mode of a kind on with a number."""
    counts = [kinds[: place + 1].count(kind) for place, kind in enumerate(kinds)]
    return [kind if count == 1 else f"{kind}_{count}" for kind, count in zip(kinds, counts, strict=True)]


def wing_elements(wing: Wing) -> tuple[Array, dict[str, Array], Array]:
    """Return mass and stiffness parts on the motions of all nodes, with the mount, and the positions of the nodes."""
    from pystran import beam, model, section  # here, because it brings matplotlib along

    stations = np.linspace(0, 1, wing.elements + 1)
    positions = stations[:, None] * wing.tip
    frame = model.create(3)
    for node, position in enumerate(positions):
        model.add_joint(frame, node, position, dof=_PER_NODE * node + np.arange(_PER_NODE))
    given = {name: _means(getattr(wing, name), stations) for name in _PROFILES}
    size = _PER_NODE * len(stations)
    mass = np.zeros((size, size))
    parts = {name: np.zeros((size, size)) for name in ("beam", "chord", "torsion", "axial")}
    for place in range(wing.elements):
        ends = frame["joints"][place], frame["joints"][place + 1]
        own = {name: values[place] for name, values in given.items()}
        for name, properties in _stiffness_sections(own).items():
            member = {"section": section.beam_3d_section(name, xz_vector=_UP, **properties)}
            beam.assemble_stiffness(parts[name], member, *ends)
        inertia = {"A": own["mass_per_length"], "Ix": own["torsional_inertia_per_length"]}
        whole = section.beam_3d_section("mass", rho=1.0, xz_vector=_UP, **inertia)
        beam.assemble_mass(mass, {"section": whole}, *ends)
    return mass, parts, positions


def _stiffness_sections(own: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """Return the properties of pystran's sections for each part of the stiffness: one stiffness each, unit modulus.

    In pystran x is along the beam, z up and y forward.
    """
    return {
        "beam": {"E": 1.0, "Iy": own["beam_stiffness"]},
        "chord": {"E": 1.0, "Iz": own["chord_stiffness"]},
        "torsion": {"G": 1.0, "J": own["torsion_stiffness"]},
        "axial": {"E": 1.0, "A": own["axial_stiffness"]},
    }


def pylon_coordinates(wing: Wing, pylon: Pylon) -> tuple[Array, Array, tuple[str, ...]]:
    """Return the motion of the nodes and of the hub for each coordinate, and the names of the coordinates."""
    inner = _PER_NODE * (wing.elements - 1)
    axes = {_PYLON_PITCH: (pylon.pitch_stiffness, _OUTBOARD), _PYLON_YAW: (pylon.yaw_stiffness, _UP)}
    turns = {name: axis for name, (stiffness, axis) in axes.items() if stiffness is not None}
    names = [f"wing_{node}_{axis}" for node in range(1, wing.elements) for axis in HUB_AXES]
    names += [*(f"hub_{axis}" for axis in HUB_AXES), *turns]
    nodes = np.zeros((wing.elements + 1, _PER_NODE, len(names)))
    nodes[1:-1, :, :inner] = np.eye(inner).reshape(wing.elements - 1, _PER_NODE, inner)
    hub = np.zeros((_PER_NODE, len(names)))
    hub[:, inner : inner + _PER_NODE] = np.eye(_PER_NODE)
    nodes[-1] = rigid_motion(-pylon.hub) @ hub
    for name, axis in turns.items():  # the wing tip turns by the rotation of the hub less these turns
        nodes[-1, ROTATION, names.index(name)] = -axis
    return nodes, hub, tuple(names)


def rigid_motion(offset: ArrayLike) -> Array:
    """Return the motion (..., 6, 6) of a point of a rigid body per motion of a reference point.

    `offset` (..., 3) is the vector from the reference point to the point, m.
    """
    offset = np.asarray(offset)
    motion = np.zeros((*offset.shape[:-1], _PER_NODE, _PER_NODE), dtype=np.result_type(offset, float))
    motion[...] = np.eye(_PER_NODE)
    motion[..., TRANSLATION, ROTATION] = np.swapaxes(np.cross(np.eye(3), offset[..., None, :]), -1, -2)
    return motion


def _means(profile: _SpanwiseProfile, stations: Array) -> Array:
    """Return the mean of a profile over each element."""
    if not isinstance(profile, tuple):
        return np.full(len(stations) - 1, float(profile))
    given, values = (np.asarray(part, dtype=float) for part in profile)
    corners = np.union1d(given, stations)
    heights = np.interp(corners, given, values)
    areas = np.concatenate([[0.0], np.cumsum(np.diff(corners) * (heights[1:] + heights[:-1]) / 2)])
    means: Array = np.diff(np.interp(stations, corners, areas)) / np.diff(stations)
    return means


def _check(name: str, value: Any, sign: str = "") -> None:
    """Refuse a value that is no finite real number or has the wrong sign; signs as for `check_finite`."""
    if not (np.isscalar(value) and np.isreal(value) and np.isfinite(value)):
        raise InputError(name, value, "must be a finite number")
    check_finite(name, value, sign)


def _check_profile(name: str, profile: _SpanwiseProfile, sign: str) -> None:
    """Refuse a profile that does not reach from 0 to 1, is not finite, or has values of the wrong sign."""
    if not isinstance(profile, tuple):
        _check(name, profile)
        values = np.array([profile])
    else:
        stations, values = (np.asarray(part, dtype=float) for part in profile)
        if stations.ndim != 1 or stations.shape != values.shape or not np.isfinite([stations, values]).all():
            raise InputError(name, "a profile", "must have one finite value for each station")
        if stations[0] != 0 or stations[-1] != 1 or (np.diff(stations) <= 0).any():
            raise InputError(name, stations.tolist(), "must have stations that rise from 0 to 1")
    check_finite(name, values.min(), sign)
