"""Section loads along the blade, gathered into the radial moments the generated airload functions take."""

from __future__ import annotations

import functools
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, fields
from types import ModuleType
from typing import Any, cast

import numpy as np
from proprotor_equations import airloads, lift_slope, section

from proprotor.airfoil import Airfoil, SectionCoefficients, SectionModel, Warns
from proprotor.arrays import Array
from proprotor.evaluation import evaluate, keywords
from proprotor.quadrature import POWERS, RadialQuadrature, flatten_points
from proprotor.rotor import Rotor

Quantities = Mapping[str, Any]
# Numbers in an array of section loads, points times stations: some dozen such arrays stay in a core's cache.
_BLOCK = 12000
_OUTBOARD = 0.5  # of the radius: where angle of attack and Mach number matter to the loads
# Names of all radial moments.
LOAD_MOMENTS = tuple(
    f"{load}_{power}"
    for load in (*section.Forces._fields, *section.PitchingMoment._fields)
    for power in range(POWERS)
)
# Places of a velocity at r = 0 and per unit radius among those of a segment.
_VELOCITIES = {
    "tangential_velocity": (airloads.UT_0, airloads.UT_1),
    "axial_velocity": (airloads.UP_0, airloads.UP_1),
    "radial_velocity": (airloads.UR_0, airloads.UR_1),
}
# Inflow ratio that stands for no airspeed: its square vanishes against the logarithm of a blade without cutout.
_STILL = 1e-150


@dataclass(frozen=True, eq=False)
class BladeSections:
    """What the airloads need of the blade's stations, for all points or for each of them.

    Attributes
    ----------
    quadrature : RadialQuadrature
    chord, twist : array (stations,) or (points, stations); a constant chord has one station
    airfoil : SectionModel
    """

    quadrature: RadialQuadrature
    chord: Array
    twist: Array
    airfoil: SectionModel

    @classmethod
    def of(cls, rotor: Rotor, shape: tuple[int, ...], coarse: bool = False) -> BladeSections:
        """Sections of a rotor, at all its stations or a coarse few; those of many designs flattened over the batch."""
        quadrature = rotor.coarse_quadrature if coarse else rotor.quadrature
        profiles = (rotor.station_chord, rotor.station_twist)
        if coarse:
            profiles = (rotor.chord_at(quadrature.stations), rotor.twist_at(quadrature.stations))
        chord, twist = (flatten_points(part, shape, 1) for part in profiles)
        airfoil = rotor.airfoil.flattened(shape) if isinstance(rotor.airfoil, Airfoil) else rotor.airfoil
        return cls(quadrature.flattened(shape), chord, twist, airfoil)

    @property
    def is_complex(self) -> bool:
        """Whether any number is complex, for derivatives by a complex step."""
        numbers = [self.quadrature.stations, self.chord, self.twist]
        if isinstance(self.airfoil, Airfoil):
            numbers += [getattr(self.airfoil, entry.name) for entry in fields(self.airfoil)]
        return any(map(np.iscomplexobj, numbers))

    @property
    def real(self) -> BladeSections:
        """The same without imaginary parts."""
        if not self.is_complex:
            return self
        airfoil = self.airfoil
        if isinstance(airfoil, Airfoil):
            airfoil = Airfoil(**{e.name: np.real(getattr(airfoil, e.name)) for e in fields(airfoil)})
        return BladeSections(self.quadrature.real, np.real(self.chord), np.real(self.twist), airfoil)

    def take(self, rows: Array | slice) -> BladeSections:
        """Sections at some of the points."""
        quadrature = self.quadrature.take(rows)
        own = slice(quadrature.stations.shape[-1])
        chord, twist = (part[rows][:, own] if part.ndim > 1 else part for part in (self.chord, self.twist))
        airfoil = self.airfoil.take(rows) if isinstance(self.airfoil, Airfoil) else self.airfoil
        return BladeSections(quadrature, chord, twist, airfoil)

    def blocks(self, points: int) -> Iterator[tuple[Array | slice, BladeSections]]:
        """Points whose stations are alike, few enough at a time for the cache, and their sections."""
        most = max(1, _BLOCK // self.quadrature.stations.shape[-1])
        rows: Iterable[Array | slice]
        if self.quadrature.counts.ndim == 1:
            rows = (slice(start, start + most) for start in range(0, points, most))
        else:
            alike = self.quadrature.alike()
            rows = (group[start : start + most] for group in alike for start in range(0, len(group), most))
        return ((some, self.take(some)) for some in rows)


def along_segments(quantities: Quantities) -> dict[str, Any]:
    """The same quantities with a last axis for the segments of the blade."""
    return {name: np.asarray(value)[..., None] for name, value in quantities.items()}


def segment_quantities(
    sections: BladeSections, quantities: Quantities, equations: ModuleType = airloads
) -> dict[str, Any]:
    """Quantities of each segment at trim: what holds for the whole blade, and the segment's geometry.

    `equations` is the generated airload module, here and below.
    """
    quadrature = sections.quadrature
    pool = along_segments(quantities)
    pool |= {
        "beyond_flap_hinge": quadrature.beyond_flap_hinge,
        "beyond_lag_hinge": quadrature.beyond_lag_hinge,
    }
    geometry: dict[str, Any] = evaluate(equations.segment_geometry, pool)._asdict()
    return pool | geometry


def _air(sections: BladeSections, segments: Quantities, equations: ModuleType, spins: bool) -> dict[str, Any]:
    """Air, pitch, angle of attack and Mach number at the stations, by name, (..., stations)."""
    line = evaluate(equations.trim_velocity, segments)[..., 0]
    along_lines = sections.quadrature.along_lines
    stations = {name: segments[name] for name in ("density", "speed_of_sound", "section_damping")}
    for name, (at_axis, per_radius) in _VELOCITIES.items():
        stations[name] = along_lines(line[..., at_axis], line[..., per_radius])
    stations["section_spin"] = along_lines(line[..., airloads.SPIN]) if spins else 0.0
    stations |= {"chord": sections.chord, "section_pitch": segments["pitch"] + sections.twist}
    air: dict[str, Any] = evaluate(section.air_at_section, stations)._asdict()
    return stations | air


def compressible(coefficients: SectionCoefficients, mach: Array) -> SectionCoefficients:
    """Prandtl-Glauert on lift and moment, and on their derivatives."""
    factor, slope = section.prandtl_glauert(mach=mach)
    scaled: dict[str, Any] = {}
    for name in ("lift", "moment"):
        value, alpha, by_mach = (
            getattr(coefficients, f"{name}_coefficient{d}") for d in ("", "_alpha", "_mach")
        )
        if not _any(value, alpha, by_mach):
            continue
        scaled |= {f"{name}_coefficient": factor * value, f"{name}_coefficient_alpha": factor * alpha}
        scaled[f"{name}_coefficient_mach"] = slope * value + (factor * by_mach if _any(by_mach) else 0.0)
    return coefficients._replace(**scaled)


def _any(*numbers: Any) -> bool:
    """Whether any number is not zero."""
    return any(number != 0 if isinstance(number, float) else np.any(number) for number in numbers)


def _lift_slope_alone(coefficients: SectionCoefficients) -> SectionCoefficients:
    kept = coefficients.lift_coefficient_alpha
    return SectionCoefficients(*([0.0] * len(SectionCoefficients._fields)))._replace(
        lift_coefficient_alpha=kept
    )


def load_moments(
    sections: BladeSections,
    segments: Quantities,
    *,
    compressibility: bool,
    lift_slope_only: bool = False,
    steady_only: bool = False,
    equations: ModuleType = airloads,
    doubts: dict[str, Array] | None = None,
) -> dict[str, Any]:
    """Radial moments of the section loads and their derivatives, by name and power of r, (points, segments).

    Points are taken a block at a time, so that the loads at all stations stay in the cache.

    Parameters
    ----------
    sections : BladeSections
    segments : mapping
        `segment_quantities` at trim, (segments,) or (points, segments).
    compressibility : bool
        Prandtl-Glauert factor on lift and moment, unless the airfoil holds compressibility already.
    lift_slope_only : bool
        Keep the terms proportional to the lift slope and no others: of the sections' damping, its lift.
    steady_only : bool
        The loads without their derivatives, which are left out or zero.
    doubts : dict, optional
        Filled with the reasons to mistrust the airfoil's coefficients outboard, masks (points,) by reason.
    """
    points = max(np.shape(value)[0] if np.ndim(value) > 1 else 1 for value in segments.values())
    shape = (points, len(sections.quadrature.beyond_lag_hinge), POWERS)
    numbers = (sections.quadrature.stations, sections.chord, sections.twist, *segments.values())
    kind = np.result_type(float, *(np.asarray(number).dtype for number in numbers))
    moments: defaultdict[str, Array] = defaultdict(lambda: np.zeros(shape, dtype=kind))
    needed = {name: segments[name] for name in _needed(equations)}
    for rows, here in sections.blocks(points):
        block = {
            name: value[rows] if np.ndim(value) > 1 and len(value) > 1 else value
            for name, value in needed.items()
        }
        air, coefficients, spins = _aerodynamics(here, block, compressibility, equations)
        if doubts is not None:
            _doubt(doubts, here, block, air, rows, points)
        if lift_slope_only:
            coefficients = _lift_slope_alone(coefficients)
        for name, load in _loads(air, coefficients, spins and not lift_slope_only, steady_only).items():
            if np.ndim(load):
                moments[name][rows] = here.quadrature.moments(load)
    found = {
        f"{name}_{power}": moment[..., power] for name, moment in moments.items() for power in range(POWERS)
    }
    return dict.fromkeys(LOAD_MOMENTS, 0.0) | found


@functools.cache
def _needed(equations: ModuleType) -> tuple[str, ...]:
    """Names of what the section loads need of a segment."""
    others = ("density", "speed_of_sound", "section_damping", "pitch", "radius")
    return tuple(dict.fromkeys((*keywords(equations.trim_velocity), *others)))


def _aerodynamics(
    sections: BladeSections, segments: Quantities, compressibility: bool, equations: ModuleType
) -> tuple[dict[str, Any], SectionCoefficients, bool]:
    """Air at the stations, the airfoil's coefficients there, and whether the sections' rotation is damped.

    Lift has the angle of attack at 3/4 chord, drag and moment that at the quarter chord.
    """
    spins = _any(segments["section_damping"])
    air = _air(sections, segments, equations, spins)
    coefficients = sections.airfoil.coefficients(air["angle_of_attack"], air["mach"])
    if spins:
        coefficients = _with_lift_of(
            coefficients, sections.airfoil.coefficients(air["lift_incidence"], air["mach"])
        )
    if compressibility and not sections.airfoil.contains_compressibility:
        coefficients = compressible(coefficients, air["mach"])
    return air, coefficients, spins


def _with_lift_of(coefficients: SectionCoefficients, turned: SectionCoefficients) -> SectionCoefficients:
    lift = {name: value for name, value in turned._asdict().items() if name.startswith("lift")}
    return coefficients._replace(**lift)


def _loads(
    air: Quantities, coefficients: SectionCoefficients, damps: bool, steady_only: bool
) -> dict[str, Any]:
    """Loads and derivatives at the stations, by name; a plain number, or nothing, where there are none.

    `damps` says whether there is the moment of the sections' rotation, which no coefficient brings.
    """
    pool = dict(air) | coefficients._asdict()
    loads: dict[str, Any] = evaluate(section.steady_forces if steady_only else section.forces, pool)._asdict()
    pitching = [value for name, value in coefficients._asdict().items() if name.startswith("moment")]
    if damps or _any(*pitching):
        loads |= evaluate(section.pitching_moment, pool)._asdict()
    return loads


def _doubt(
    doubts: dict[str, Array],
    sections: BladeSections,
    segments: Quantities,
    air: Quantities,
    rows: Array | slice,
    points: int,
) -> None:
    """Mark the points at which outboard stations are beyond what the airfoil knows."""
    if not isinstance(sections.airfoil, Warns):
        return
    radius = np.ravel(np.real(segments["radius"]))[:, None]
    outboard = np.real(sections.quadrature.stations) >= _OUTBOARD * radius
    first = int(np.argmax(outboard.any(axis=0)))  # stations follow each other outward
    found = sections.airfoil.warnings(*(air[name][..., first:] for name in ("lift_incidence", "mach")))
    for text, mask in found.items():
        if mask.any():
            told = doubts.setdefault(f"{text} outboard of {_OUTBOARD:g} R", np.zeros(points, dtype=bool))
            told[rows] = (mask & outboard[..., first:]).any(axis=-1)


def has_closed_form(sections: BladeSections) -> bool:
    """Whether the lift-slope airloads of the published set can be had without quadrature."""
    return isinstance(sections.airfoil, Airfoil) and sections.chord.shape[-1] == 1


def closed_form_moments(sections: BladeSections, segments: Quantities) -> dict[str, Any]:
    """Radial moments as `load_moments`, lift slope alone, without compressibility and with u_T = Ωr and u_P = V."""
    edges = sections.quadrature.edges / np.asarray(segments["radius"])[..., None]
    inflow_ratio = segments["airspeed"] / (segments["rotor_speed"] * segments["radius"])
    given = {
        "chord": sections.chord,
        "lift_slope": cast(Airfoil, sections.airfoil).lift_slope,  # has_closed_form has seen to it
        "inflow_ratio": np.maximum(inflow_ratio, _STILL),
        "inner_edge": edges[..., 0],
        "outer_edge": edges[..., 1],
    }
    moments: dict[str, Any] = evaluate(lift_slope.load_moments, dict(segments) | given)._asdict()
    return dict.fromkeys(LOAD_MOMENTS, 0.0) | moments
