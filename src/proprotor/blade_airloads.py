"""Section loads along the blade, gathered into the radial moments the generated airload functions take."""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray
from proprotor_equations import airloads, lift_slope, section

from proprotor.airfoil import Airfoil, SectionCoefficients
from proprotor.evaluation import evaluate
from proprotor.quadrature import POWERS
from proprotor.rotor import Rotor

Quantities = Mapping[str, Any]
# Inflow ratio that stands for no airspeed: its square vanishes against the logarithm of a blade without cutout.
_STILL = 1e-150


def along_segments(quantities: Quantities) -> dict[str, Any]:
    """The same quantities with a last axis for the segments of the blade."""
    return {name: np.asarray(value)[..., None] for name, value in quantities.items()}


def segment_quantities(
    rotor: Rotor, quantities: Quantities, equations: ModuleType = airloads
) -> dict[str, Any]:
    """Quantities of each segment at trim: what holds for the whole blade, and the segment's geometry.

    `equations` is the generated airload module, here and below.
    """
    quadrature = rotor.quadrature
    pool = along_segments(quantities)
    pool |= {
        "beyond_flap_hinge": quadrature.beyond_flap_hinge,
        "beyond_lag_hinge": quadrature.beyond_lag_hinge,
    }
    return pool | evaluate(equations.segment_geometry, pool)._asdict()


def _velocities(rotor: Rotor, segments: Quantities, equations: ModuleType) -> dict[str, NDArray]:
    """Trim velocity of the air and rotation of the sections at the stations."""
    quadrature = rotor.quadrature
    line = evaluate(equations.trim_velocity, segments)[..., 0]
    names = ("tangential_velocity", "axial_velocity", "radial_velocity")
    air = {
        name: quadrature.at_stations(line[..., place])
        + quadrature.at_stations(line[..., place + 3]) * quadrature.stations
        for place, name in enumerate(names)
    }
    return air | {"section_spin": quadrature.at_stations(line[..., 6])}


def air_at_stations(rotor: Rotor, segments: Quantities, equations: ModuleType = airloads) -> dict[str, Any]:
    """Air, pitch, angle of attack and Mach number at the stations, by name, (..., stations)."""
    stations = {name: segments[name] for name in ("density", "speed_of_sound", "section_damping")}
    stations |= _velocities(rotor, segments, equations)
    stations |= {"chord": rotor.station_chord, "section_pitch": segments["pitch"] + rotor.station_twist}
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
    rotor: Rotor,
    segments: Quantities,
    *,
    compressibility: bool,
    lift_slope_only: bool = False,
    equations: ModuleType = airloads,
) -> dict[str, NDArray]:
    """Radial moments of the section loads and their derivatives, by name and power of r, (..., segments).

    Parameters
    ----------
    rotor : Rotor
    segments : mapping
        `segment_quantities` at trim.
    compressibility : bool
        Prandtl-Glauert factor on lift and moment, unless the airfoil holds compressibility already.
    lift_slope_only : bool
        Keep the terms proportional to the lift slope and no others.
    """
    stations = air_at_stations(rotor, segments, equations)
    coefficients = rotor.airfoil.coefficients(stations["angle_of_attack"], stations["mach"])
    if compressibility and not rotor.airfoil.contains_compressibility:
        coefficients = _compressible(coefficients, stations["mach"])
    if lift_slope_only:
        coefficients = _lift_slope_alone(coefficients)
    loads = evaluate(section.loads, stations | coefficients._asdict())
    shape = np.broadcast_shapes(*(np.shape(load) for load in loads), rotor.quadrature.stations.shape)
    table = np.stack([np.broadcast_to(load, shape) for load in loads], axis=-2)
    moments = rotor.quadrature.moments(table)
    return {
        f"{name}_{power}": moments[..., place, :, power]
        for place, name in enumerate(loads._fields)
        for power in range(moments.shape[-1])
    }


def has_closed_form(rotor: Rotor) -> bool:
    """Whether the lift-slope airloads of the published set can be had without quadrature."""
    return (
        isinstance(rotor.airfoil, Airfoil)
        and not isinstance(rotor.chord, tuple)
        and not callable(rotor.chord)
    )


def closed_form_moments(rotor: Rotor, segments: Quantities) -> dict[str, NDArray]:
    """Radial moments as `load_moments`, lift slope alone, without compressibility and with u_T = Ωr and u_P = V."""
    edges = rotor.quadrature.edges / np.asarray(rotor.radius)[..., None, None]
    inflow_ratio = segments["airspeed"] / (segments["rotor_speed"] * segments["radius"])
    given = {
        "chord": np.asarray(rotor.chord)[..., None],
        "lift_slope": np.asarray(rotor.airfoil.lift_slope)[..., None],
        "inflow_ratio": np.maximum(inflow_ratio, _STILL),
        "inner_edge": edges[..., 0],
        "outer_edge": edges[..., 1],
    }
    moments = dict.fromkeys(
        (f"{load}_{power}" for load in section.Loads._fields for power in range(POWERS)), 0.0
    )
    return moments | evaluate(lift_slope.load_moments, dict(segments) | given)._asdict()
