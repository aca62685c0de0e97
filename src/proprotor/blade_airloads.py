"""Section loads along the blade, gathered into the radial moments the generated airload functions take."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray
from proprotor_equations import airloads, lift_slope, section

from proprotor.airfoil import Airfoil, SectionCoefficients, SectionModel
from proprotor.evaluation import evaluate
from proprotor.quadrature import POWERS, RadialQuadrature, flatten_points
from proprotor.rotor import Rotor

Quantities = Mapping[str, Any]
_BLOCK = 64  # points; with some 200 stations an array of loads is then about 100 kB
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
    chord: NDArray
    twist: NDArray
    airfoil: SectionModel

    @classmethod
    def of(cls, rotor: Rotor, shape: tuple[int, ...]) -> BladeSections:
        """Sections of a rotor, those of many designs flattened over the batch."""
        chord, twist = (flatten_points(part, shape, 1) for part in (rotor.station_chord, rotor.station_twist))
        airfoil = rotor.airfoil.flattened(shape) if isinstance(rotor.airfoil, Airfoil) else rotor.airfoil
        return cls(rotor.quadrature.flattened(shape), chord, twist, airfoil)

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

    def take(self, rows: NDArray | slice) -> BladeSections:
        """Sections at some of the points."""
        chord, twist = (part[rows] if part.ndim > 1 else part for part in (self.chord, self.twist))
        airfoil = self.airfoil.take(rows) if isinstance(self.airfoil, Airfoil) else self.airfoil
        return BladeSections(self.quadrature.take(rows), chord, twist, airfoil)


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
    return pool | evaluate(equations.segment_geometry, pool)._asdict()


def _velocities(
    quadrature: RadialQuadrature, segments: Quantities, equations: ModuleType
) -> dict[str, NDArray]:
    """Trim velocity of the air and rotation of the sections at the stations."""
    line = evaluate(equations.trim_velocity, segments)[..., 0]
    names = ("tangential_velocity", "axial_velocity", "radial_velocity")
    air = {
        name: quadrature.at_stations(line[..., place])
        + quadrature.at_stations(line[..., place + 3]) * quadrature.stations
        for place, name in enumerate(names)
    }
    return air | {"section_spin": quadrature.at_stations(line[..., 6])}


def air_at_stations(
    sections: BladeSections, segments: Quantities, equations: ModuleType = airloads
) -> dict[str, Any]:
    """Air, pitch, angle of attack and Mach number at the stations, by name, (..., stations)."""
    stations = {name: segments[name] for name in ("density", "speed_of_sound", "section_damping")}
    stations |= _velocities(sections.quadrature, segments, equations)
    stations |= {"chord": sections.chord, "section_pitch": segments["pitch"] + sections.twist}
    return stations | evaluate(section.air_at_section, stations)._asdict()


def _compressible(coefficients: SectionCoefficients, mach: NDArray) -> SectionCoefficients:
    """Prandtl-Glauert on lift and moment, and on their derivatives."""
    factor, slope = section.prandtl_glauert(mach=mach)
    scaled = {}
    for name in ("lift", "moment"):
        value, alpha, by_mach = (
            getattr(coefficients, f"{name}_coefficient{d}") for d in ("", "_alpha", "_mach")
        )
        scaled |= {f"{name}_coefficient": factor * value, f"{name}_coefficient_alpha": factor * alpha}
        scaled |= {f"{name}_coefficient_mach": factor * by_mach + slope * value}
    return coefficients._replace(**scaled)


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
    equations: ModuleType = airloads,
) -> dict[str, NDArray]:
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
        Keep the terms proportional to the lift slope and no others.
    """
    points = max(np.shape(value)[0] if np.ndim(value) > 1 else 1 for value in segments.values())
    shape = (points, len(sections.quadrature.beyond_lag_hinge), POWERS)
    kind = np.result_type(
        float, sections.quadrature.stations, sections.chord, sections.twist, *segments.values()
    )
    moments = {name: np.zeros(shape, dtype=kind) for name in section.Loads._fields}
    for start in range(0, points, _BLOCK):
        rows = slice(start, start + _BLOCK)
        block = {
            name: value[rows] if np.ndim(value) > 1 and len(value) > 1 else value
            for name, value in segments.items()
        }
        here = sections.take(rows)
        for name, load in _section_loads(here, block, compressibility, lift_slope_only, equations).items():
            if np.ndim(load):
                full = np.broadcast_to(load, (len(moments[name][rows]), load.shape[-1]))
                moments[name][rows] = _block_moments(here.quadrature, full)
    return {
        f"{name}_{power}": moment[..., power] for name, moment in moments.items() for power in range(POWERS)
    }


def _block_moments(quadrature: RadialQuadrature, load: NDArray) -> NDArray:
    """Radial moments of a block of points, filled up so that a point's sums do not depend on how many it comes with."""
    rows = len(load)
    if quadrature.segment.ndim > 1 or rows == _BLOCK:
        return quadrature.moments(load)
    full = np.zeros((_BLOCK, load.shape[-1]), dtype=load.dtype)
    full[:rows] = load
    return quadrature.moments(full)[:rows]


def _section_loads(
    sections: BladeSections,
    segments: Quantities,
    compressibility: bool,
    lift_slope_only: bool,
    equations: ModuleType,
) -> dict[str, Any]:
    """Loads and derivatives at the stations, by name; a plain number where there are none."""
    stations = air_at_stations(sections, segments, equations)
    coefficients = sections.airfoil.coefficients(stations["angle_of_attack"], stations["mach"])
    if compressibility and not sections.airfoil.contains_compressibility:
        coefficients = _compressible(coefficients, stations["mach"])
    if lift_slope_only:
        coefficients = _lift_slope_alone(coefficients)
    return evaluate(section.loads, stations | coefficients._asdict())._asdict()


def has_closed_form(sections: BladeSections) -> bool:
    """Whether the lift-slope airloads of the published set can be had without quadrature."""
    return isinstance(sections.airfoil, Airfoil) and sections.chord.shape[-1] == 1


def closed_form_moments(sections: BladeSections, segments: Quantities) -> dict[str, NDArray]:
    """Radial moments as `load_moments`, lift slope alone, without compressibility and with u_T = Ωr and u_P = V."""
    edges = sections.quadrature.edges / np.asarray(segments["radius"])[..., None]
    inflow_ratio = segments["airspeed"] / (segments["rotor_speed"] * segments["radius"])
    given = {
        "chord": sections.chord,
        "lift_slope": sections.airfoil.lift_slope,
        "inflow_ratio": np.maximum(inflow_ratio, _STILL),
        "inner_edge": edges[..., 0],
        "outer_edge": edges[..., 1],
    }
    moments = dict.fromkeys(
        (f"{load}_{power}" for load in section.Loads._fields for power in range(POWERS)), 0.0
    )
    return moments | evaluate(lift_slope.load_moments, dict(segments) | given)._asdict()
