"""A cantilever wing of beam finite elements, with a rigid pylon at the tip and the hub ahead of the pylon.

The elements of `proprotor.support.beam` are derived like the equations of the rotor: Euler-Bernoulli bending in two
planes, free torsion, extension, and the consistent mass, whose centre may lie beside the elastic axis. The elastic axis
is straight, from the mount at the origin to the pylon, and all axes are the rotor's: I up, J outboard, K forward along
the shaft. The pylon is rigid; it may turn about J against a spring at the wing tip, the downstop.

Every number may be an array (...) of designs, or complex for derivatives by a complex step.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, check_finite, unknown_name
from proprotor.support.beam import PER_NODE, BeamProperties, beam_chain, rigid_motion, sign_of
from proprotor.support.modal_reduction import Arrangement, ModalSupport, on_modes, symmetric
from proprotor.support.normal_modes import HUB_AXES, ROTATION, NormalModes
from proprotor.typing import Array, Numbers

_UP, _OUTBOARD, _ = np.eye(3)
_TURNS = {"pylon_pitch": ("pitch_stiffness", _OUTBOARD), "pylon_yaw": ("yaw_stiffness", _UP)}
_SpanwiseProfile = Numbers | tuple[ArrayLike, ArrayLike]
_MOST_ELEMENTS = 200


@dataclass(frozen=True, kw_only=True)
class Wing:
    """A straight cantilever along its elastic axis.

    A property along the wing is one number or (stations, values): stations from 0 at the mount to 1 at the pylon, and
    values (..., stations), linear between them. The elements have the values at their nodes and are linear between the
    nodes (`proprotor.support.beam.BeamProperties`), so that a kink between two nodes is cut off.

    Parameters
    ----------
    span : float or array (...)
        Distance from the mount to the pylon along J, m.
    beam_stiffness, chord_stiffness : number or profile
        EI of bending up and down, and of bending fore and aft, N m².
    torsion_stiffness : number or profile
        GJ, N m².
    axial_stiffness : number or profile
        EA, N.
    mass_per_length : number or profile
        kg/m along the elastic axis.
    torsional_inertia_per_length : number or profile
        kg m²/m about the centre of mass of the section.
    mass_up, mass_forward : number or profile
        Distances of the centre of mass of the section above and ahead of the elastic axis, m.
    sweep, dihedral : float or array (...)
        Angles of the elastic axis, rad, positive back and up.
    elements : int
        Number of elements, all of equal length.

    Raises
    ------
    InputError
        When a value is not finite or out of range, or a profile does not reach from 0 to 1.
    """

    span: Numbers
    beam_stiffness: _SpanwiseProfile
    chord_stiffness: _SpanwiseProfile
    torsion_stiffness: _SpanwiseProfile
    axial_stiffness: _SpanwiseProfile
    mass_per_length: _SpanwiseProfile
    torsional_inertia_per_length: _SpanwiseProfile
    mass_up: _SpanwiseProfile = 0.0
    mass_forward: _SpanwiseProfile = 0.0
    sweep: Numbers = 0.0
    dihedral: Numbers = 0.0
    elements: int = 8

    def __post_init__(self) -> None:
        check_finite("span", self.span, "above zero")
        for name in ("sweep", "dihedral"):
            angle = getattr(self, name)
            check_finite(name, angle)
            if (np.abs(np.real(angle)) >= np.pi / 2).any():
                raise InputError(name, angle, "must lie between -90 and 90 degrees")
        for name in _PROFILES:
            _check_profile(name, getattr(self, name))
        check_elements(self.elements)

    @property
    def tip(self) -> Array:
        """Point where the elastic axis meets the pylon, m (..., 3)."""
        span = np.asarray(self.span)
        return along_axes(span * np.tan(self.dihedral), span, -span * np.tan(self.sweep))

    @property
    def nodes(self) -> Array:
        """Nodes of the elements from the mount to the pylon, m (..., elements + 1, 3)."""
        return self._stations[:, None] * self.tip[..., None, :]

    @property
    def properties(self) -> BeamProperties:
        """Properties at the nodes."""
        profiles = {name: _at(self._stations, getattr(self, name)) for name in _PROFILES}
        return BeamProperties(**profiles)

    @property
    def _stations(self) -> Array:
        return np.linspace(0, 1, self.elements + 1)


_PROFILES = tuple(entry.name for entry in fields(BeamProperties))


def check_elements(count: object) -> None:
    """Refuse a number of finite elements that is no whole number, or whose matrices would fill the memory."""
    if not isinstance(count, int) or not 1 <= count <= _MOST_ELEMENTS:
        raise InputError("elements", count, f"must be a whole number from 1 to {_MOST_ELEMENTS}")


@dataclass(frozen=True, kw_only=True)
class Pylon:
    """A rigid nacelle at the wing tip, and the mass of the hub that no rotor model contains; numbers or arrays (...).

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

    nacelle_mass: Numbers
    nacelle_pitch_inertia: Numbers
    nacelle_yaw_inertia: Numbers
    nacelle_roll_inertia: Numbers
    mast_length: Numbers
    mast_height: Numbers = 0.0
    mast_outboard: Numbers = 0.0
    nacelle_forward: Numbers = 0.0
    nacelle_up: Numbers = 0.0
    nacelle_outboard: Numbers = 0.0
    hub_mass: Numbers = 0.0
    pitch_stiffness: Numbers | None = None
    yaw_stiffness: Numbers | None = None

    def __post_init__(self) -> None:
        given = {entry.name: getattr(self, entry.name) for entry in fields(self)}
        springs = {name: given.pop(name) for name, _ in _TURNS.values()}
        for name, value in given.items():
            check_finite(name, value, "not negative" if name.endswith(("mass", "inertia")) else "")
        for name, value in springs.items():
            if value is not None:
                check_finite(name, value, "above zero")

    @property
    def hub(self) -> Array:
        """Vector from the elastic axis at the tip to the hub, m (..., 3) along I, J, K."""
        return along_axes(self.mast_height, self.mast_outboard, self.mast_length)

    @property
    def nacelle(self) -> Array:
        """Vector from the elastic axis at the tip to the nacelle's centre of mass, m (..., 3)."""
        return along_axes(self.nacelle_up, self.nacelle_outboard, self.nacelle_forward)

    @property
    def mass(self) -> Array:
        """Mass of nacelle and hub hardware on the motion of the hub, kg, kg m and kg m² (..., 6, 6)."""
        turning = (self.nacelle_yaw_inertia, self.nacelle_pitch_inertia, self.nacelle_roll_inertia)
        nacelle = diagonal_matrix(*[self.nacelle_mass] * 3, *turning)
        motion = rigid_motion(self.nacelle - self.hub)
        return np.swapaxes(motion, -1, -2) @ nacelle @ motion + diagonal_matrix(
            *[self.hub_mass] * 3, *[0.0] * 3
        )


_Given = TypeVar("_Given")


class BeamStructure(NamedTuple):
    """Mass and stiffness of wing and pylon on the motions of the nodes between mount and tip, then of the hub.

    names : tuple of str
        Names of the n coordinates: six for each node, six of the hub (m and rad), and with a spring the pitch of the
        pylon against the wing tip, nose up, and the yaw about I.
    mass : array (..., n, n)
    stiffness_parts : mapping of str to array (..., n, n)
        Parts of the stiffness: beam, chord, torsion (with the downstop), axial, and with a spindle pylon yaw.
    hub : array (6, n)
        Motion of the hub for each coordinate.
    nodes : array (..., elements + 1, 6, n)
        Motion of each node of the elastic axis for each coordinate, the mount first.
    positions : array (..., elements + 1, 3)
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
        """The whole stiffness (..., n, n)."""
        return sum(self.stiffness_parts.values(), start=np.zeros(()))


def beam_structure(wing: Wing, pylon: Pylon) -> BeamStructure:
    """Return the finite-element matrices of wing and pylon, without the rotor.

    Complex numbers leave the real parts of mass and stiffness as they are without them, to the last digit, so that
    modes of equal frequency have the same shapes.
    """
    structure = _structure(wing, pylon)
    if np.isrealobj(structure.mass) and np.isrealobj(structure.stiffness):
        return structure
    return stepped(_structure(real_part(wing), real_part(pylon)), structure)


def _structure(wing: Wing, pylon: Pylon) -> BeamStructure:
    """Return the finite-element matrices of wing and pylon."""
    elements = wing_elements(wing)
    return on_motions(*pylon_coordinates(wing, pylon), elements, pylon)


def on_motions(
    nodes: Array,
    hub: Array,
    names: tuple[str, ...],
    elements: tuple[Array, dict[str, Array], Array],
    pylon: Pylon,
) -> BeamStructure:
    """Return the matrices of beam elements and a pylon on named coordinates.

    Parameters
    ----------
    nodes : array (..., k, 6, n)
        Motion of each node for each coordinate.
    hub : array (6, n)
        Motion of the hub for each coordinate.
    names : tuple of str
        Names of the n coordinates, among these the turns of a pylon on springs.
    elements : tuple of (array, dict of str to array, array)
        Mass and parts of the stiffness on the motions of all nodes, and the positions of the nodes.
    pylon : Pylon
    """
    mass, parts, positions = elements
    motion = nodes.reshape(*nodes.shape[:-3], -1, len(names))
    turned = np.swapaxes(motion, -1, -2)
    parts = {name: symmetric(turned @ part @ motion) for name, part in parts.items()}
    for name, (spring, _) in _TURNS.items():
        if name in names:
            kind = "torsion" if name == "pylon_pitch" else "pylon yaw"
            stiffness = np.asarray(getattr(pylon, spring))[..., None, None] * selected(names, name)
            parts[kind] = parts.get(kind, 0.0) + stiffness
    mass = symmetric(turned @ mass @ motion + hub.T @ pylon.mass @ hub)
    return BeamStructure(names, mass, parts, hub, nodes, positions)


def selected(names: Sequence[str], name: str) -> Array:
    """Return the matrix (n, n) with a one on the diagonal at one of the names."""
    return np.diag([float(one == name) for one in names])


def real_part(given: _Given) -> _Given:
    """Return a record of a wing, a pylon or a box with the real parts of its numbers."""
    numbers = {entry.name: getattr(given, entry.name) for entry in fields(given)}  # type: ignore[arg-type]
    steps: dict[str, Any] = {
        name: (value[0], np.real(value[1])) if isinstance(value, tuple) else np.real(value)
        for name, value in numbers.items()
        if np.iscomplexobj(value[1] if isinstance(value, tuple) else value)
    }
    return replace(given, **steps)  # type: ignore[type-var]


def stepped(real: BeamStructure, moved: BeamStructure) -> BeamStructure:
    """Return a structure with complex numbers whose real parts are those of another one, to the last digit."""
    parts = {name: _stepped(real.stiffness_parts[name], part) for name, part in moved.stiffness_parts.items()}
    return moved._replace(mass=_stepped(real.mass, moved.mass), stiffness_parts=parts)


def _stepped(real: Array, moved: Array) -> Array:
    """Return an array with the imaginary part of another one."""
    return real + 1j * np.imag(moved)


def beam_wing(
    wing: Wing,
    pylon: Pylon,
    *,
    modes: int | None = None,
    damping_ratio: ArrayLike | Mapping[str, Numbers] = 0.0,
    rotor_mass: Numbers = 0.0,
) -> NormalModes:
    """Return the wing as a support, one design or many.

    Many designs have the names of the first one. A design with other modes has a mode of another name in each free
    place, and a warning. Complex numbers give the derivatives of all matrices as imaginary parts; see
    `proprotor.support.modal_reduction.lowest_modes` for modes of equal frequency.

    Parameters
    ----------
    wing, pylon : Wing, Pylon
    modes : int, optional
        How many of the lowest modes to keep; by default all coordinates of the finite elements. A mode is called beam,
        chord, torsion or axial after the stiffness with most of the mode's strain energy, from the second mode of a
        kind on with a number.
    damping_ratio : float, array (..., j) or mapping
        Structural damping as a fraction of critical: of the lowest modes, the last value for all modes above, or of all
        beam, chord, torsion and axial modes by these names. A loss factor g (hysteretic damping) is equivalent to g/2
        at the frequency of each mode.
    rotor_mass : float or array (...)
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
    damping_ratio: ArrayLike | Mapping[str, Numbers],
    rotor_mass: Numbers,
    names: Sequence[str] = (),
    at_hub: Array | None = None,
) -> ModalSupport:
    """Return the structure as a support on all coordinates or on its `count` lowest modes; see `beam_wing`.

    `names` is the order of the modes of every design, by default the order of the first design; `at_hub` (..., 6, 6) is
    a mass like `rotor_mass` on all motions of the hub.
    """
    given: ArrayLike | Callable[[Array], ArrayLike]
    if isinstance(damping_ratio, Mapping):
        _check_kinds(damping_ratio, structure)
        given = partial(ratios_by_kind, structure.stiffness_parts, damping_ratio)
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
        at_hub=at_hub,
        arrange=partial(arranged, structure.stiffness_parts, tuple(names)),
    )


def _check_kinds(damping_ratio: Mapping[str, Numbers], structure: BeamStructure) -> None:
    """Refuse damping ratios that are not given for each kind of mode."""
    for kind in structure.stiffness_parts:
        if kind not in damping_ratio:
            raise InputError(f"damping_ratio[{kind}]", None, "is missing")
    for kind in damping_ratio:
        if kind not in structure.stiffness_parts:
            rule = unknown_name(kind, tuple(structure.stiffness_parts), "kind of mode")
            raise InputError("damping_ratio", kind, rule)


def _kinds(stiffness_parts: Mapping[str, Array], shapes: Array) -> Array:
    """Return for each mode (..., k) the place of the part of the stiffness with most of the mode's strain energy."""
    shapes = np.real(shapes)
    parts = (np.real(part) for part in stiffness_parts.values())
    places: Array = np.argmax([(shapes * (part @ shapes)).sum(axis=-2) for part in parts], axis=0)
    return places


def ratios_by_kind(
    stiffness_parts: Mapping[str, Array], ratios: Mapping[str, Numbers], shapes: Array
) -> Array:
    """Return the damping ratio (..., k) of each mode from the ratio (...) of its kind."""
    kinds = _kinds(stiffness_parts, shapes)
    by_kind = np.stack(np.broadcast_arrays(*(ratios[kind] for kind in stiffness_parts)), axis=-1)
    return np.take_along_axis(
        np.broadcast_to(by_kind, (*kinds.shape[:-1], by_kind.shape[-1])), kinds, axis=-1
    )


def arranged(stiffness_parts: Mapping[str, Array], names: tuple[str, ...], shapes: Array) -> Arrangement:
    """Return the order of modes in which each design has them under the same names as far as it has such modes.

    A mode is named by its kind, from the second mode of a kind on with a number. Designs with the same kinds in the
    same order are arranged at once.
    """
    kinds = _kinds(stiffness_parts, shapes)
    sequences, which = np.unique(kinds.reshape(-1, kinds.shape[-1]), axis=0, return_inverse=True)
    own = [_numbered([tuple(stiffness_parts)[kind] for kind in sequence]) for sequence in sequences]
    which = which.reshape(kinds.shape[:-1])
    wanted = names or own[which.flat[0]]
    places = np.array([_places(one, wanted) for one in own])[which]
    warnings = np.array([_named_otherwise(one, wanted) for one in own], dtype=object)
    return Arrangement(places, wanted, warnings[which] if which.ndim else None)


def _numbered(kinds: Sequence[str]) -> tuple[str, ...]:
    """Return names of modes by their kinds."""
    counts = [kinds[: place + 1].count(kind) for place, kind in enumerate(kinds)]
    return tuple(kind if count == 1 else f"{kind}_{count}" for kind, count in zip(kinds, counts, strict=True))


def _places(own: Sequence[str], names: Sequence[str]) -> list[int]:
    """Return the places of names among the own names of a design; other names fill the free places."""
    others = iter([place for place, name in enumerate(own) if name not in names])
    return [own.index(name) if name in own else next(others) for name in names]


def _named_otherwise(own: Sequence[str], names: Sequence[str]) -> str:
    """Return a warning for a design whose modes have other names than the modes of the case's own design, or ""."""
    others = [name for name in own if name not in names]
    missing = [name for name in names if name not in own]
    renamed = [f"{name} is named {place}" for name, place in zip(others, missing, strict=True)]
    return f"the wing has other modes than in the case's own design: {', '.join(renamed)}" if renamed else ""


def wing_elements(wing: Wing) -> tuple[Array, dict[str, Array], Array]:
    """Return mass and stiffness parts on the motions of all nodes, with the mount, and the positions of the nodes."""
    mass, parts = beam_chain(wing.nodes, wing.properties)
    return mass, parts, wing.nodes


def pylon_coordinates(wing: Wing, pylon: Pylon) -> tuple[Array, Array, tuple[str, ...]]:
    """Return the motion of the nodes and of the hub for each coordinate, and the names of the coordinates."""
    inner = PER_NODE * (wing.elements - 1)
    turns = {name: axis for name, (spring, axis) in _TURNS.items() if getattr(pylon, spring) is not None}
    names = [f"wing_{node}_{axis}" for node in range(1, wing.elements) for axis in HUB_AXES]
    names += [*(f"hub_{axis}" for axis in HUB_AXES), *turns]
    hub = np.zeros((PER_NODE, len(names)))
    hub[:, inner : inner + PER_NODE] = np.eye(PER_NODE)
    tip = rigid_motion(-pylon.hub) @ hub
    for name, axis in turns.items():  # the wing tip turns by the rotation of the hub less these turns
        tip[..., ROTATION, names.index(name)] = -axis
    nodes = np.zeros((*tip.shape[:-2], wing.elements + 1, *tip.shape[-2:]), dtype=tip.dtype)
    nodes[..., 1:-1, :, :inner] = np.eye(inner).reshape(wing.elements - 1, PER_NODE, inner)
    nodes[..., -1, :, :] = tip
    return nodes, hub, tuple(names)


def along_axes(*components: Numbers) -> Array:
    """Return vectors (..., 3) from their components."""
    return np.stack(np.broadcast_arrays(*components), axis=-1)


def diagonal_matrix(*values: Numbers) -> Array:
    """Return diagonal matrices (..., n, n) of n values (...)."""
    return along_axes(*values)[..., None] * np.eye(len(values))


def _at(nodes: Array, profile: _SpanwiseProfile) -> Array:
    """Return a property at nodes from 0 to 1: (..., nodes), or (..., 1) for one number."""
    if not isinstance(profile, tuple):
        return np.asarray(profile)[..., None]
    stations, values = profile
    shares = [
        np.interp(nodes, np.asarray(stations, dtype=float), own) for own in np.eye(len(np.asarray(stations)))
    ]
    return np.asarray(values) @ np.array(shares)


def _check_profile(name: str, profile: _SpanwiseProfile) -> None:
    """Refuse a profile that does not reach from 0 to 1, is not finite, or has values of the wrong sign."""
    if not isinstance(profile, tuple):
        return check_finite(name, profile, sign_of(name))
    stations, values = np.asarray(profile[0], dtype=float), np.asarray(profile[1])
    if stations.ndim != 1 or stations.shape != values.shape[-1:] or not np.isfinite(stations).all():
        raise InputError(name, "a profile", "must have one finite value for each station")
    if stations[0] != 0 or stations[-1] != 1 or (np.diff(stations) <= 0).any():
        raise InputError(name, stations.tolist(), "must have stations that rise from 0 to 1")
    return check_finite(name, values, sign_of(name))
