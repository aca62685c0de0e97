"""Quasi-steady airloads of the wing itself, by strip theory: damping and stiffness that grow with the airspeed.

A strip of width dy flies along K at V. Its downwash is taken at a point behind the elastic axis, three quarters of
the chord for a thin airfoil, and its lift acts at the aerodynamic centre:

    w = V α - ẋ_d            dL = ½ ρ V cos Λ  a c w dy            Q = ∫ δx_a dL

with x up, α the nose-up turn about J, and Λ the sweep: a is the lift slope of sections across the elastic axis.
Left out are steady lift, drag, induced velocity, apparent mass and the lag of unsteady flow.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError
from proprotor.support.beam_wing import BeamStructure
from proprotor.support.normal_modes import HUB_AXES, NormalModes
from proprotor.typing import Array

_UP, _PITCH = HUB_AXES.index("x"), HUB_AXES.index("alpha_y")
_STRIPS = 64
_PER_ELEMENT = 4  # Gauss points; products of two cubics are integrated exactly


class Strips(NamedTuple):
    """How the elastic axis moves: widths (..., k) along J in m, rise and pitch (..., k, n) per unit of each coordinate.

    rise is along I at the elastic axis; pitch is nose up, about J.
    """

    width: Array
    rise: Array
    pitch: Array


@dataclass(frozen=True, kw_only=True)
class WingAerodynamics:
    """What the strips have in common; numbers, or arrays (...) of many designs.

    Parameters
    ----------
    lift_slope : float
        a of a section across the elastic axis, per rad.
    chord : float
        c, streamwise, m.
    sweep : float
        Λ, rad.
    elastic_axis, aerodynamic_centre, downwash_point : float
        In chords behind the leading edge.

    Raises
    ------
    InputError
        When a value is not finite, or slope or chord not above zero.
    """

    lift_slope: float
    chord: float
    elastic_axis: float
    sweep: float = 0.0
    aerodynamic_centre: float = 0.25
    downwash_point: float = 0.75

    def __post_init__(self) -> None:
        for entry in fields(self):
            value = np.asarray(getattr(self, entry.name))
            if not np.isfinite(value).all():
                raise InputError(entry.name, getattr(self, entry.name), "must be finite")
            if entry.name in ("lift_slope", "chord") and (value.real <= 0).any():
                raise InputError(entry.name, getattr(self, entry.name), "must be above zero")

    def matrices(self, strips: Strips) -> tuple[Array, Array]:
        """What the airloads add to C per ρV, and to K per ρV²; both (..., n, n)."""
        own = {entry.name: np.asarray(getattr(self, entry.name))[..., None, None] for entry in fields(self)}
        loaded = strips.rise + (own["elastic_axis"] - own["aerodynamic_centre"]) * own["chord"] * strips.pitch
        washed = strips.rise + (own["elastic_axis"] - own["downwash_point"]) * own["chord"] * strips.pitch
        lift = own["lift_slope"] * own["chord"] * np.cos(own["sweep"]) / 2 * strips.width[..., None]
        forces = np.swapaxes(lift * loaded, -1, -2)
        return forces @ washed, -forces @ strips.pitch


@dataclass(frozen=True, eq=False)
class LoadedModes(NormalModes):
    """Coordinates of a support in an airstream: damping and stiffness need not be symmetric."""

    symmetric = ("mass",)


@dataclass(frozen=True, eq=False)
class WingInAirstream(NormalModes):
    """A support with what an airstream adds to it; its own matrices are those in still air.

    Parameters
    ----------
    airload_damping, airload_stiffness : array (..., n, n)
        Added to C per ρV and to K per ρV², as `WingAerodynamics.matrices` gives them.
    """

    airload_damping: ArrayLike = field(kw_only=True)
    airload_stiffness: ArrayLike = field(kw_only=True)

    def at(self, airspeed: ArrayLike, density: ArrayLike) -> NormalModes:
        """The support at airspeeds (m/s) and densities (kg/m³), arrays that broadcast: matrices (..., n, n)."""
        speed, density = np.asarray(airspeed)[..., None, None], np.asarray(density)[..., None, None]
        return LoadedModes(
            names=self.names,
            mass=self.mass,
            damping=self.damping + density * speed * np.asarray(self.airload_damping),
            stiffness=self.stiffness + density * speed**2 * np.asarray(self.airload_stiffness),
            hub=self.hub,
            includes_rotor=self.includes_rotor,
            shaft=self.shaft,
            shapes=self.shapes,
            warning=self.warning,
        )


def in_airstream(support: NormalModes, strips: Strips, aerodynamics: WingAerodynamics) -> WingInAirstream:
    """A support with the airloads of its wing.

    Raises
    ------
    InputError
        When the strips have another number of coordinates.
    """
    if strips.rise.shape[-1] != len(support.names):
        raise InputError(
            "strips", strips.rise.shape[-1], f"must move with the {len(support.names)} coordinates"
        )
    damping, stiffness = aerodynamics.matrices(strips)
    own = {entry.name: getattr(support, entry.name) for entry in fields(NormalModes)}
    return WingInAirstream(**own, airload_damping=damping, airload_stiffness=stiffness)


def beam_strips(structure: BeamStructure, shapes: ArrayLike) -> Strips:
    """Strips of a beam wing that move as its elements do.

    Parameters
    ----------
    structure : BeamStructure
    shapes : array (n, k)
        The support's coordinates in those of the structure, as `proprotor.support.beam_wing.on_coordinates` gives them.
    """
    from pystran.geometry import herm_basis, herm_basis_xi  # here, because it brings matplotlib along

    points, weights = np.polynomial.legendre.leggauss(_PER_ELEMENT)
    nodes = structure.nodes @ np.asarray(shapes)
    widths, rises, pitches = [], [], []
    for start, end, left, right in zip(
        structure.positions[:-1], structure.positions[1:], nodes[:-1], nodes[1:], strict=True
    ):
        axis = end - start
        length = np.linalg.norm(axis)
        along = axis / length
        across = np.eye(3) - np.outer(along, along)
        # ∂u/∂s = φ × axis at the ends; rotation vectors give the slopes of the cubic.
        slopes = [np.cross(node[3:].T, along).T for node in (left, right)]
        for point, weight in zip(points, weights, strict=True):
            # pystran's second and fourth function belong to a rotation that lowers the beam: minus the slope.
            cubic, rate = herm_basis(point), herm_basis_xi(point) * 2 / length
            ends = (left[:3], -slopes[0] * length / 2, right[:3], -slopes[1] * length / 2)
            bent = across @ sum(factor * part for factor, part in zip(cubic, ends, strict=True))
            slope = across @ sum(factor * part for factor, part in zip(rate, ends, strict=True))
            share = (1 + point) / 2
            twist = np.outer(along, along) @ ((1 - share) * left[3:] + share * right[3:])
            stretch = np.outer(along, along) @ ((1 - share) * left[:3] + share * right[:3])
            turn = twist + np.cross(along, slope.T).T
            widths.append(weight / 2 * axis[1])
            rises.append((bent + stretch)[0])
            pitches.append(turn[1])
    return Strips(np.array(widths), np.array(rises), np.array(pitches))


def cantilever_strips(support: NormalModes, span: float, mast_length: float) -> Strips:
    """Strips of a wing known by its motion at the hub alone, in an assumed shape.

    Between mount and tip the wing is taken to bend as a cantilever loaded at its tip, (3η² - η³)/2, and to twist
    linearly, η, with η from 0 to 1 along the span. The tip is the point `mast_length` behind the hub.

    Parameters
    ----------
    support : NormalModes
    span, mast_length : float or array (...)
        m.
    """
    length, mast = np.asarray(span), np.asarray(mast_length)
    if not (np.isfinite(length).all() and (length.real > 0).all()):
        raise InputError("span", length, "must be above zero")
    if not np.isfinite(mast).all():
        raise InputError("mast_length", mast, "must be finite")
    points, weights = np.polynomial.legendre.leggauss(_STRIPS)
    eta = ((1 + points) / 2)[:, None]
    pitch = support.hub[..., _PITCH, :][..., None, :]
    rise = support.hub[..., _UP, :][..., None, :] - mast[..., None, None] * pitch
    return Strips(weights / 2 * length[..., None], (3 * eta**2 - eta**3) / 2 * rise, eta * pitch)
