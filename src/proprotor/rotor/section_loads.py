"""Section loads along the blade, and their radial moments, which the generated airload functions take."""

from __future__ import annotations

import functools
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import Any, cast

import numpy as np
from proprotor_equations import airloads, lift_slope, section

from proprotor.rotor.airfoil import Airfoil, SectionCoefficients, SectionModel, Warns, has_points
from proprotor.rotor.effective_sections import EffectiveSections
from proprotor.rotor.generated import evaluate, keywords
from proprotor.rotor.quadrature import POWERS, RadialQuadrature, flatten_points
from proprotor.rotor.rotor import Rotor
from proprotor.typing import Array

_Quantities = Mapping[str, Any]
# Numbers in an array of section loads, points times stations: a core's cache holds a dozen such arrays.
_BLOCK = 12000
OUTBOARD = 0.5  # of the radius: from here to the tip angle of attack and Mach number matter to the loads
LOAD_MOMENTS = tuple(
    f"{load}_{power}"
    for load in (*section.Forces._fields, *section.PitchingMoment._fields)
    for power in range(POWERS)
)
_VELOCITIES = {  # rows of `trim_velocity`: value at r = 0, and change with r
    "tangential_velocity": (airloads.UT_0, airloads.UT_1),
    "axial_velocity": (airloads.UP_0, airloads.UP_1),
    "radial_velocity": (airloads.UR_0, airloads.UR_1),
}
# Smallest inflow ratio used in place of zero airspeed, so that the logarithms of a blade without cutout stay finite.
_STILL = 1e-150


@dataclass(frozen=True, eq=False)
class BladeSections:
    """Stations of the blade with chord, twist and airfoil, one set for all points or a set for each point.

    Attributes
    ----------
    quadrature : RadialQuadrature
    along : EffectiveSections
        Chord and twist, arrays (stations,) or (points, stations).
    airfoil : SectionModel
    """

    quadrature: RadialQuadrature
    along: EffectiveSections
    airfoil: SectionModel

    @classmethod
    def of(cls, rotor: Rotor, shape: tuple[int, ...], few: bool = False) -> BladeSections:
        """Return the sections of a rotor at all stations or at a few, with the axes of many designs flattened."""
        quadrature, along = rotor.few_sections if few else (rotor.quadrature, rotor.sections)
        airfoil = rotor.airfoil_at(quadrature.stations, shape)
        flat = along.each(lambda part: flatten_points(part, shape, 1))
        return cls(quadrature.flattened(shape), flat, airfoil)

    @functools.cached_property
    def is_complex(self) -> bool:
        """Whether any number is complex, for derivatives by a complex step."""
        if has_points(self.airfoil) and self.airfoil.is_complex:
            return True
        return any(map(np.iscomplexobj, (self.quadrature.stations, *self.along)))

    @property
    def real(self) -> BladeSections:
        """The same sections without imaginary parts."""
        airfoil = self.airfoil.real if has_points(self.airfoil) else self.airfoil
        return BladeSections(self.quadrature.real, self.along.each(np.real), airfoil)

    @property
    def tapers(self) -> bool:
        """Whether powers of the chord have effective values of their own."""
        return bool(self.along.square.shape[-1] > 1)

    @functools.cached_property
    def beside_axis(self) -> bool:
        """Whether the aerodynamic centre lies beside the pitch axis anywhere."""
        return bool(np.any(self.along.center))

    @property
    def sides(self) -> dict[str, Array]:
        """On which side of the hinges each segment is, by the names of the derivation."""
        return {name: getattr(self.quadrature, name) for name in ("beyond_flap_hinge", "beyond_lag_hinge")}

    def take(self, rows: Array | slice) -> BladeSections:
        """Return the sections at some of the points."""
        quadrature = self.quadrature.take(rows)
        own = slice(quadrature.stations.shape[-1])
        along = self.along.each(lambda part: part[rows][:, own] if part.ndim > 1 else part)
        airfoil = self.airfoil.take(rows, own) if has_points(self.airfoil) else self.airfoil
        return BladeSections(quadrature, along, airfoil)

    def blocks(self, points: int) -> Iterator[tuple[Array | slice, BladeSections]]:
        """Return groups of points with their sections: points whose stations are alike, few enough for the cache."""
        most = max(1, _BLOCK // max(1, self.quadrature.stations.shape[-1]))
        rows: Iterable[Array | slice]
        if self.quadrature.counts.ndim == 1:
            if points <= most:
                yield slice(0, points), self
                return
            rows = (slice(start, start + most) for start in range(0, points, most))
        else:
            alike = self.quadrature.alike()
            rows = (group[start : start + most] for group in alike for start in range(0, len(group), most))
        yield from ((some, self.take(some)) for some in rows)


def segment_quantities(
    sections: BladeSections, quantities: _Quantities, equations: ModuleType = airloads
) -> dict[str, Any]:
    """Return the quantities of each segment at trim: all quantities of the blade, and the geometry of the segment.

    `equations` is the generated airload module, here and below.
    """
    segments = {name: np.asarray(value)[..., None] for name, value in quantities.items()}
    segments |= sections.sides
    return {**segments, **evaluate(equations.segment_geometry, segments)._asdict()}


def _air(
    sections: BladeSections, segments: _Quantities, equations: ModuleType, spins: bool
) -> dict[str, Any]:
    """Return air, pitch, angle of attack and Mach number at the stations, by name, (..., stations)."""
    line = evaluate(equations.trim_velocity, segments)[..., airloads.TRIM]
    along_lines = sections.quadrature.along_lines
    stations = {name: segments[name] for name in ("density", "speed_of_sound", "section_damping")}
    for name, (at_axis, per_radius) in _VELOCITIES.items():
        stations[name] = along_lines(line[..., at_axis], line[..., per_radius])
    beside = sections.beside_axis
    stations["section_spin"] = along_lines(line[..., airloads.SPIN]) if spins or beside else 0.0
    stations |= {"chord": sections.along.chord, "section_pitch": segments["pitch"] + sections.along.twist}
    if sections.tapers:  # the lift of the turn has the chord squared
        stations["section_damping"] = segments["section_damping"] * sections.along.square
    if beside:
        stations["aerodynamic_center"] = sections.along.center
        return {
            **stations,
            **_in_front_and_behind(stations, evaluate(section.air_beside_axis, stations)._asdict()),
        }
    return {
        **stations,
        **_in_front_and_behind(stations, evaluate(section.air_at_section, stations)._asdict()),
    }


def _in_front_and_behind(stations: _Quantities, air: dict[str, Any]) -> dict[str, Any]:
    """Return the air at sections with angles of attack of the right quadrant.

    Near the root of a rotor that flies at an angle, air may come from behind the trailing edge, past axial flow: there
    the inflow angle is beyond a right angle, and its arctangent is half a turn off.
    """
    from_behind = np.real(stations["tangential_velocity"]) < 0
    if from_behind.any():
        half_turn = np.where(from_behind, np.copysign(np.pi, np.real(stations["axial_velocity"])), 0.0)
        air |= {name: air[name] - half_turn for name in ("angle_of_attack", "lift_incidence")}
    return air


def compressible(coefficients: SectionCoefficients, mach: Array) -> SectionCoefficients:
    """Return the coefficients with the Prandtl-Glauert factor on lift and moment and on their derivatives."""
    factor, slope = section.prandtl_glauert(mach=mach)
    scaled: dict[str, Any] = {}
    for load in ("lift", "moment"):
        names = [f"{load}_coefficient{derivative}" for derivative in ("", "_alpha", "_mach")]
        value, alpha, by_mach = (getattr(coefficients, name) for name in names)
        if _any(value, alpha, by_mach):
            with_mach = slope * value + (factor * by_mach if _any(by_mach) else 0.0)
            scaled |= zip(names, (factor * value, factor * alpha, with_mach), strict=True)
    return coefficients._replace(**scaled)


def _any(*numbers: Any) -> bool:
    """Return whether any number is not zero."""
    return any(number != 0 if isinstance(number, float) else np.any(number) for number in numbers)


def load_moments(
    sections: BladeSections,
    segments: _Quantities,
    *,
    compressibility: bool,
    lift_slope_only: bool = False,
    steady_only: bool = False,
    equations: ModuleType = airloads,
    doubts: dict[str, Array] | None = None,
) -> dict[str, Any]:
    """Return the radial moments of the section loads and their derivatives by name and power of r, (points, segments).

    Points are taken a block at a time, so that the loads at all stations stay in the cache.

    Parameters
    ----------
    sections : BladeSections
    segments : mapping
        `segment_quantities` at trim, (segments,) or (points, segments).
    compressibility : bool
        Put the Prandtl-Glauert factor on lift and moment, unless the airfoil contains compressibility already.
    lift_slope_only : bool
        Keep the terms proportional to the lift slope and no others; of the sections' damping this is the lift.
    steady_only : bool
        Compute the loads without their derivatives, which are then left out or zero.
    doubts : dict, optional
        Filled with the reasons to doubt the airfoil's coefficients outboard, masks (points,) by reason.
    """
    (points,) = np.broadcast_shapes((1,), *(np.shape(value)[:-1] for value in segments.values()))
    shape = (points, len(sections.quadrature.beyond_lag_hinge), POWERS)
    numbers = (sections.quadrature.stations, *sections.along, *segments.values())
    kind = np.result_type(float, *(np.asarray(number).dtype for number in numbers))
    moments: defaultdict[str, Array] = defaultdict(lambda: np.zeros(shape, dtype=kind))
    needed = {name: segments[name] for name in quantities_of_air(equations)}
    for rows, here in sections.blocks(points):
        block = at_rows_of_points(needed, rows)
        air, coefficients, spins = aerodynamics(here, block, compressibility, equations)
        if doubts is not None:
            of_stations = air["lift_incidence"], air["mach"]
            mark_doubts(doubts, here, block["radius"], of_stations, rows, points)
        if lift_slope_only:
            coefficients = SectionCoefficients(lift_coefficient_alpha=coefficients.lift_coefficient_alpha)
        for name, load in _loads(here, air, coefficients, spins and not lift_slope_only, steady_only).items():
            if np.ndim(load):
                moments[name][rows] = here.quadrature.moments(load)
    found = {
        f"{name}_{power}": moment[..., power] for name, moment in moments.items() for power in range(POWERS)
    }
    return dict.fromkeys(LOAD_MOMENTS, 0.0) | found


def at_rows_of_points(quantities: _Quantities, rows: Array | slice) -> dict[str, Any]:
    """Return quantities of the segments, (segments,) or (points, segments), at some of the points."""
    return {
        name: value[rows] if np.ndim(value) > 1 and len(value) > 1 else value
        for name, value in quantities.items()
    }


@functools.cache
def quantities_of_air(equations: ModuleType = airloads) -> tuple[str, ...]:
    """Return the names of the quantities of a segment that the section loads need."""
    others = ("density", "speed_of_sound", "section_damping", "pitch", "radius")
    return tuple(dict.fromkeys((*keywords(equations.trim_velocity), *others)))


def aerodynamics(
    sections: BladeSections, segments: _Quantities, compressibility: bool, equations: ModuleType = airloads
) -> tuple[dict[str, Any], SectionCoefficients, bool]:
    """Return air and coefficients at the stations, and whether the rotation of the sections is damped.

    Lift follows the angle of attack at 3/4 chord, drag and moment follow the angle at the quarter chord.
    """
    spins = _any(segments["section_damping"])
    air = _air(sections, segments, equations, spins)
    coefficients = sections.airfoil.coefficients(air["angle_of_attack"], air["mach"])
    if spins:
        turned = sections.airfoil.coefficients(air["lift_incidence"], air["mach"])._asdict()
        lift = {name: value for name, value in turned.items() if name.startswith("lift")}
        coefficients = coefficients._replace(**lift)
    if compressibility and not sections.airfoil.contains_compressibility:
        coefficients = compressible(coefficients, air["mach"])
    return air, coefficients, spins


def _loads(
    sections: BladeSections,
    air: _Quantities,
    coefficients: SectionCoefficients,
    damps: bool,
    steady_only: bool,
) -> dict[str, Any]:
    """Return loads and derivatives at the stations by name; loads that vanish are a plain number or left out.

    `damps` says whether the sections' rotation makes a moment, which no coefficient contains.
    """
    given = dict(air) | coefficients._asdict()
    forces = section.steady_forces if steady_only else section.forces
    loads: dict[str, Any] = evaluate(forces, given)._asdict()
    pitching = {name: value for name, value in coefficients._asdict().items() if name.startswith("moment")}
    if damps or _any(*pitching.values()):
        if sections.tapers:  # the moment has the chord squared, its damping the chord cubed
            given |= {name: value * sections.along.square for name, value in pitching.items() if _any(value)}
            given["section_damping"] = given["section_damping"] / sections.along.square * sections.along.cube
        loads |= evaluate(section.pitching_moment, given)._asdict()
    return _about_axis(loads, air) if sections.beside_axis else loads


def _about_axis(loads: _Quantities, air: _Quantities) -> dict[str, Any]:
    """Return loads and derivatives about the pitch axis from those of the aerodynamic centre."""
    at_center = {f"{name}_at_center": load for name, load in loads.items()}
    none = {name: 0.0 for name in keywords(section.about_axis) if name.endswith("_at_center")}
    found: dict[str, Any] = evaluate(section.about_axis, {**none, **air, **at_center})._asdict()
    return found


def mark_doubts(
    doubts: dict[str, Array],
    sections: BladeSections,
    radius: Any,
    air: tuple[Array, Array],
    rows: Array | slice,
    points: int,
) -> None:
    """Mark the points (points,) at which outboard stations are beyond the range of the airfoil.

    Incidence and Mach number `air` are of the stations of some rows, (rows, stations).
    """
    if not isinstance(sections.airfoil, Warns):
        return
    incidence, mach = air
    outboard = np.real(sections.quadrature.stations) >= OUTBOARD * np.ravel(np.real(radius))[:, None]
    first = int(np.argmax(outboard.any(axis=0)))  # stations follow each other outward
    incidence = incidence + sections.along.bent
    airfoil: SectionModel = sections.airfoil
    if has_points(airfoil):
        airfoil = airfoil.take(slice(None), slice(first, None))
    found = cast(Warns, airfoil).warnings(incidence[..., first:], mach[..., first:])
    for text, mask in found.items():
        if mask.any():
            marks = doubts.setdefault(f"{text} outboard of {OUTBOARD:g} R", np.zeros(points, dtype=bool))
            marks[rows] = (mask & outboard[..., first:]).any(axis=-1)


def has_closed_form(sections: BladeSections) -> bool:
    """Return whether the lift-slope airloads of the published set can be computed without quadrature."""
    airfoil = sections.airfoil
    if sections.beside_axis:
        return False
    alike = isinstance(airfoil, Airfoil) and np.shape(airfoil.lift_slope)[-1:] in ((), (1,))
    return alike and sections.along.chord.shape[-1] == 1


def closed_form_moments(sections: BladeSections, segments: _Quantities) -> dict[str, Any]:
    """Return radial moments like `load_moments`: lift slope alone, incompressible, with u_T = Ωr and u_P = V."""
    edges = sections.quadrature.edges / np.asarray(segments["radius"])[..., None]
    inflow_ratio = segments["airspeed"] / (segments["rotor_speed"] * segments["radius"])
    given = {
        "chord": sections.along.chord,
        "lift_slope": cast(Airfoil, sections.airfoil).lift_slope,  # by `has_closed_form`
        "inflow_ratio": np.maximum(inflow_ratio, _STILL),
        "inner_edge": edges[..., 0],
        "outer_edge": edges[..., 1],
    }
    moments = evaluate(lift_slope.load_moments, dict(segments) | given)._asdict()
    return {**dict.fromkeys(LOAD_MOMENTS, 0.0), **moments}
