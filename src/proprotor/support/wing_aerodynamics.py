"""Quasi-steady airloads of the wing itself, by strip theory: damping and stiffness that grow with the airspeed.

A strip of width dy flies along K at V. The downwash of the strip is taken at a point behind the elastic axis, three
quarters of the chord for a thin airfoil, and the lift acts at the aerodynamic centre:

    w = V α - ẋ_d            dL = ½ ρ V cos Λ  a c w dy            Q = ∫ δx_a dL

with x up, α the nose-up rotation about J, Λ the sweep, and a the lift slope of sections across the elastic axis.
Left out are steady lift, drag, induced velocity and apparent mass. The lift may lag: see
`proprotor.support.wing_circulation`.

A flaperon of E chords that turns by δ, trailing edge down, adds by thin-airfoil theory (Glauert, The Elements of
Aerofoil and Airscrew Theory) at the aerodynamic centre

    dL = ½ ρ V² cos Λ  a c τ δ dy        dM = ½ ρ V² cos Λ  c² c_mδ δ dy
    τ = (π - θ + sin θ)/π                c_mδ = -½ sin θ (1 - cos θ),    cos θ = 2 E - 1

Its rate and its inertia are left out, and its loads come at once where other lift lags.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, check_finite
from proprotor.support.beam import section_motions
from proprotor.support.beam_wing import BeamStructure
from proprotor.support.normal_modes import HUB_AXES, NormalModes, in_air
from proprotor.support.wing_circulation import WingLift, span_functions
from proprotor.typing import Array

_UP, _OUTBOARD, _PITCH = (HUB_AXES.index(axis) for axis in ("x", "y", "alpha_y"))
FLAPERON = "flaperon"  # the input, rad, trailing edge down
_STRIPS = 64
_PER_ELEMENT = 4  # Gauss points; products of two cubics are integrated exactly


class Strips(NamedTuple):
    """Motion of the elastic axis: widths (..., k) along J in m, rise and pitch (..., k, n) per unit of each coordinate.

    rise is the displacement along I of the elastic axis; pitch is the rotation about J, nose up.
    """

    width: Array
    rise: Array
    pitch: Array


@dataclass(frozen=True, kw_only=True)
class WingAerodynamics:
    """Lift slope and geometry of all strips; numbers, or arrays (...) of many designs.

    Parameters
    ----------
    lift_slope : float
        Lift slope a of a section across the elastic axis, 1/rad.
    chord : float
        Streamwise chord c, m.
    sweep : float
        Sweep Λ, rad.
    elastic_axis, aerodynamic_centre, downwash_point : float
        Positions in chords behind the leading edge.
    flap_chord : float, optional
        Chord of the flaperon over the chord of the wing, 0 to 1; without one there is no flaperon.
    flap_inboard, flap_outboard : float
        Ends of the flaperon in parts of the span, 0 to 1.

    Raises
    ------
    InputError
        When a value is not finite, lift slope or chord is not above zero, or the flaperon does not lie on the wing.
    """

    lift_slope: float
    chord: float
    elastic_axis: float
    sweep: float = 0.0
    aerodynamic_centre: float = 0.25
    downwash_point: float = 0.75
    flap_chord: float | None = None
    flap_inboard: float = 0.0
    flap_outboard: float = 1.0

    def __post_init__(self) -> None:
        for entry in fields(self):
            sign = "above zero" if entry.name in ("lift_slope", "chord") else ""
            if entry.name != "flap_chord" or self.flap_chord is not None:
                check_finite(entry.name, getattr(self, entry.name), sign)
        if self.flap_chord is not None and np.any(
            (np.real(self.flap_chord) <= 0) | (np.real(self.flap_chord) > 1)
        ):
            raise InputError("flap_chord", self.flap_chord, "must be above 0, and at most the whole chord, 1")
        for name, low, high in (
            ("flap_inboard", 0.0, self.flap_outboard),
            ("flap_outboard", self.flap_inboard, 1.0),
        ):
            if np.any(
                (np.real(getattr(self, name)) < np.real(low)) | (np.real(getattr(self, name)) > np.real(high))
            ):
                rule = "must lie on the wing, 0 to 1 of its span, inboard before outboard"
                raise InputError(name, getattr(self, name), rule)

    def matrices(self, strips: Strips) -> tuple[Array, Array]:
        """Return the parts of the airloads in C per ρV and in K per ρV²; both (..., n, n)."""
        forces = self._forces(strips)
        return forces @ self._behind(strips, "downwash_point"), -forces @ strips.pitch

    def lift(self, strips: Strips) -> WingLift:
        """Return the lift by functions of the span, of which a part may come late."""
        functions = span_functions(strips.width)
        weighed = np.swapaxes(functions, -1, -2) * strips.width[..., None, :]
        gathered = np.linalg.solve(weighed @ functions, weighed)
        by_rates = -gathered @ self._behind(strips, "downwash_point")
        single = ("",) * functions.shape[-1]
        return WingLift(
            self._forces(strips) @ functions,
            by_rates,
            gathered @ strips.pitch,
            self.chord,
            single,
            *self.matrices(strips),
        )

    def _forces(self, strips: Strips) -> Array:
        """Return the work of the lift of each strip per ρV and downwash, (..., n, k)."""
        own = {
            name: np.asarray(getattr(self, name))[..., None, None]
            for name in ("lift_slope", "chord", "sweep")
        }
        lift = own["lift_slope"] * own["chord"] * np.cos(own["sweep"]) / 2 * strips.width[..., None]
        return np.swapaxes(lift * self._behind(strips, "aerodynamic_centre"), -1, -2)

    def _behind(self, strips: Strips, point: str) -> Array:
        """Return how far a point of the chord rises, (..., k, n)."""
        ahead, chord = (
            np.asarray(self.elastic_axis) - np.asarray(getattr(self, point)),
            np.asarray(self.chord),
        )
        found: Array = strips.rise + (ahead * chord)[..., None, None] * strips.pitch
        return found

    def flap_loads(self, strips: Strips) -> Array:
        """Return the generalised forces of the flaperon per rad and per ρV², (..., n, 1)."""
        assert self.flap_chord is not None  # checked by the caller
        own = self._arrays()
        effectiveness, moment = flap_derivatives(np.asarray(self.flap_chord)[..., None, None])
        area = (
            strips.width[..., None] * _covered(strips.width, self.flap_inboard, self.flap_outboard)[..., None]
        )
        pressure = own["chord"] * np.cos(own["sweep"]) / 2 * area
        arm = (own["elastic_axis"] - own["aerodynamic_centre"]) * own["chord"]
        lift = pressure * own["lift_slope"] * effectiveness
        loads = lift * (strips.rise + arm * strips.pitch) + pressure * own["chord"] * moment * strips.pitch
        return np.asarray(loads.sum(axis=-2)[..., None])

    def _arrays(self) -> dict[str, Array]:
        """Return the numbers as arrays (..., 1, 1) by name, without those of the flaperon."""
        names = (entry.name for entry in fields(self) if not entry.name.startswith("flap"))
        return {name: np.asarray(getattr(self, name))[..., None, None] for name in names}


def flap_derivatives(chord: Array) -> tuple[Array, Array]:
    """Return the effectiveness τ and the moment about the quarter chord, 1/rad, of flaps of a share of the chord."""
    theta = np.arccos(2 * np.asarray(chord) - 1 + 0j if np.iscomplexobj(chord) else 2 * np.asarray(chord) - 1)
    return (np.pi - theta + np.sin(theta)) / np.pi, -np.sin(theta) * (1 - np.cos(theta)) / 2


def _covered(width: Array, inboard: ArrayLike, outboard: ArrayLike) -> Array:
    """Return the share of each strip (..., k) that lies between two places, in parts of the span."""
    ends = np.cumsum(width, axis=-1)
    span = ends[..., -1:]
    first, last = (np.asarray(place)[..., None] * span for place in (inboard, outboard))
    start = ends - width
    low = np.where(np.real(first) > np.real(start), first, start)
    high = np.where(np.real(last) < np.real(ends), last, ends)
    return np.asarray(np.where(np.real(high) > np.real(low), high - low, 0.0) / width)


@dataclass(frozen=True, eq=False)
class _LoadedModes(NormalModes):
    """Coordinates of a support in an airstream, whose damping and stiffness need not be symmetric."""

    symmetric = ("mass",)


@dataclass(frozen=True, eq=False)
class WingInAirstream(NormalModes):
    """A support with the airloads of its wing; its matrices hold in still air, and `at` gives the others.

    Parameters
    ----------
    airload_damping, airload_stiffness : array (..., n, n)
        Parts of the airloads in C per ρV and in K per ρV², from `WingAerodynamics.matrices`.
    airload_inputs : array (..., n, inputs), optional
        Generalised forces per unit of each input and per ρV², from `WingAerodynamics.flap_loads`.
    wing : WingLift, optional
        The part of the airloads that is lift, which may lag.
    """

    airload_damping: ArrayLike = field(kw_only=True)
    airload_stiffness: ArrayLike = field(kw_only=True)
    airload_inputs: ArrayLike | None = field(kw_only=True, default=None)
    wing: WingLift | None = field(kw_only=True, default=None)  # type: ignore[misc]

    def at(self, airspeed: ArrayLike, density: ArrayLike) -> NormalModes:
        """Return the support, with matrices (..., n, n), at airspeeds (m/s) and densities (kg/m³) that broadcast."""
        speed, density = np.asarray(airspeed)[..., None, None], np.asarray(density)[..., None, None]
        damping = self.damping + density * speed * np.asarray(self.airload_damping)
        stiffness = self.stiffness + density * speed**2 * np.asarray(self.airload_stiffness)
        loads = None if self.airload_inputs is None else density * speed**2 * np.asarray(self.airload_inputs)
        return in_air(self, _LoadedModes, damping, stiffness, loads=loads)


def in_airstream(support: NormalModes, strips: Strips, aerodynamics: WingAerodynamics) -> WingInAirstream:
    """Return a support with the airloads of its wing.

    Raises
    ------
    InputError
        When the strips have another number of coordinates than the support.
    """
    if strips.rise.shape[-1] != len(support.names):
        rule = f"must move with the {len(support.names)} coordinates"
        raise InputError("strips", strips.rise.shape[-1], rule)
    damping, stiffness = aerodynamics.matrices(strips)
    own = {entry.name: getattr(support, entry.name) for entry in fields(NormalModes)}
    airloads: dict[str, Any] = {"airload_damping": damping, "airload_stiffness": stiffness}
    airloads["wing"] = aerodynamics.lift(strips)
    if aerodynamics.flap_chord is not None:
        own["inputs"], airloads["airload_inputs"] = (FLAPERON,), aerodynamics.flap_loads(strips)
    return WingInAirstream(**own, **airloads)


def beam_strips(structure: BeamStructure, shapes: ArrayLike) -> Strips:
    """Return strips of a beam wing that move with its elements.

    Parameters
    ----------
    structure : BeamStructure
    shapes : array (..., n, k)
        The support's coordinates in coordinates of the structure, from `proprotor.support.beam_wing.on_coordinates`.
    """
    points, weights = np.polynomial.legendre.leggauss(_PER_ELEMENT)
    nodes = structure.nodes @ np.asarray(shapes)[..., None, :, :]
    ends = np.concatenate([nodes[..., :-1, :, :], nodes[..., 1:, :, :]], axis=-2)
    motion = section_motions(structure.positions, (1 + points) / 2) @ ends[..., None, :, :]
    motion = motion.reshape(*motion.shape[:-4], -1, *motion.shape[-2:])
    width = np.diff(structure.positions[..., _OUTBOARD], axis=-1)[..., None] * weights / 2
    width = width.reshape(*width.shape[:-2], -1)
    return Strips(width, motion[..., _UP, :], motion[..., _PITCH, :])


def strip_positions(positions: Array) -> Array:
    """Return the positions (..., k, 3) of the strips of `beam_strips` on the elastic axis through nodes (..., m, 3)."""
    points, _ = np.polynomial.legendre.leggauss(_PER_ELEMENT)
    share = ((1 + points) / 2)[:, None]
    found: Array = positions[..., :-1, None, :] + share * np.diff(positions, axis=-2)[..., None, :]
    return found.reshape(*found.shape[:-3], -1, 3)


def cantilever_strips(support: NormalModes, span: float, mast_length: float) -> Strips:
    """Return strips, in an assumed shape, of a wing whose motion is known at the hub alone.

    Between mount and tip the wing is assumed to bend as a cantilever loaded at its tip, (3η² - η³)/2, and to twist
    linearly, η, with η from 0 to 1 along the span. The tip is the point `mast_length` behind the hub.

    Parameters
    ----------
    support : NormalModes
    span, mast_length : float or array (...)
        m.
    """
    check_finite("span", span, "above zero")
    check_finite("mast_length", mast_length)
    length, mast = np.asarray(span), np.asarray(mast_length)
    points, weights = np.polynomial.legendre.leggauss(_STRIPS)
    eta = ((1 + points) / 2)[:, None]
    pitch = support.hub[..., _PITCH, :][..., None, :]
    rise = support.hub[..., _UP, :][..., None, :] - mast[..., None, None] * pitch
    return Strips(weights / 2 * length[..., None], (3 * eta**2 - eta**3) / 2 * rise, eta * pitch)
