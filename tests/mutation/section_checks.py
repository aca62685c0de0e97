"""Loads of a section, their radial moments on a straight segment, and the closed forms of the lift slope."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray
from proprotor_equations.fused import offset, plain

from tests.mutation.comparison import Check, call, matrix_check, values_check
from tests.mutation.sections import (
    POLYNOMIAL,
    STEP,
    Air,
    StraightAirfoil,
    at_center,
    coefficients_of,
    inflow,
    section_derivatives,
    turn_incidence,
)

_COUNT = 12


def checks() -> Iterator[Check]:
    yield from _sections()
    yield from _segment_loads()
    yield _lift_slope()
    yield _loads_by_plan("plain", plain, some_air())
    yield _loads_by_plan("offset", offset, beside_axis())
    yield from _beside_axis()


def some_air() -> Air:
    rng = np.random.default_rng(5)
    return Air(
        tangential=rng.uniform(60, 180, _COUNT),
        axial=rng.uniform(40, 120, _COUNT),
        radial=rng.uniform(-40, 40, _COUNT),
        pitch=rng.uniform(0.2, 1.2, _COUNT),
        spin=rng.uniform(-15, 15, _COUNT),
        chord=rng.uniform(0.3, 0.5, _COUNT),
        density=rng.uniform(0.6, 1.3, _COUNT),
        speed_of_sound=rng.uniform(300, 340, _COUNT),
    )


def quantities_of(air: Air) -> dict[str, NDArray]:
    """By the names of the derivation."""
    speed, angle, alpha = inflow(air)
    return coefficients_of(POLYNOMIAL, air) | {
        "tangential_velocity": air.tangential,
        "axial_velocity": air.axial,
        "radial_velocity": air.radial,
        "section_pitch": air.pitch,
        "section_spin": air.spin,
        "section_damping": np.ones(_COUNT),
        "chord": air.chord,
        "density": air.density,
        "speed_of_sound": air.speed_of_sound,
        "section_speed": speed,
        "inflow_cosine": np.cos(angle),
        "inflow_sine": np.sin(angle),
        "angle_of_attack": alpha,
        "turn_incidence": turn_incidence(air),
        "lift_incidence": alpha + turn_incidence(air),
        "mach": speed / air.speed_of_sound,
    }


def _sections() -> Iterator[Check]:
    air = some_air()
    quantities, loads = quantities_of(air), section_derivatives(POLYNOMIAL, air)
    names = ("section_speed", "inflow_cosine", "inflow_sine", "angle_of_attack", "mach")
    names += ("turn_incidence", "lift_incidence")
    expected = {name: quantities[name] for name in names}
    yield values_check(
        ("section", "air_at_section"), "speed and angle of two velocities", quantities, expected
    )
    factor = 1 / np.sqrt(1 - (quantities["mach"] + 1j * STEP) ** 2)
    expected = {"prandtl_glauert_factor": factor.real, "prandtl_glauert_slope": factor.imag / STEP}
    yield values_check(("section", "prandtl_glauert"), "the rule, by a complex step", quantities, expected)
    told = "lift, drag and moment of a section, by complex steps"
    for function, wanted in {
        "forces": [name for name in loads if name.startswith("f")],
        "pitching_moment": [name for name in loads if name.startswith("m")],
        "steady_forces": ["fx", "fn", "fd"],
    }.items():
        expected = {name: loads[name] for name in wanted}
        yield values_check(("section", function), told, quantities, expected, _sizes(air, wanted))


def beside_axis() -> Air:
    """Sections whose aerodynamic centres lie ahead of the axis and behind it."""
    return replace(some_air(), center=np.random.default_rng(9).uniform(-0.2, 0.2, _COUNT))


def at_axis(air: Air) -> dict[str, NDArray]:
    """Quantities of sections by the names of the derivation, with what the aerodynamic centre meets."""
    below, along = (air.center * wave(air.pitch) for wave in (np.sin, np.cos))
    named = {"tangential_velocity": air.tangential, "axial_velocity": air.axial}
    of_center = {"aerodynamic_center": air.center, "center_along": along, "center_below": below}
    met = at_center(air)
    velocities = {"tangential_at_center": met.tangential, "axial_at_center": met.axial}
    return quantities_of(met) | named | of_center | velocities


def _beside_axis() -> Iterator[Check]:
    """Aerodynamic centres beside the pitch axis."""
    air = beside_axis()
    quantities, told = (
        at_axis(air),
        "velocities and forces of a point of a section that turns, by complex steps",
    )
    names = ("center_along", "center_below", "tangential_at_center", "axial_at_center", "section_speed")
    names += ("inflow_cosine", "inflow_sine", "angle_of_attack", "turn_incidence", "lift_incidence", "mach")
    expected = {name: quantities[name] for name in names}
    yield values_check(("section", "air_beside_axis"), told, quantities, expected)
    own = section_derivatives(POLYNOMIAL, at_center(air))
    given = quantities | {f"{name}_at_center": load for name, load in own.items()}
    expected = section_derivatives(POLYNOMIAL, air)
    yield values_check(("section", "about_axis"), told, given, expected, _sizes(air, expected))


def _sizes(air: Air, names: Iterable[str]) -> dict[str, NDArray]:
    """Of loads and derivatives where coefficients, angles and speeds relative to the section's are of order one."""
    speed, _, _ = inflow(air)
    force = 0.5 * air.density * air.chord * speed**2
    per = dict.fromkeys(("ut", "up", "ur"), 1 / speed) | {"spin": air.chord / speed}
    return {name: force * per.get(name.partition("_")[2], 1.0) for name in names}


def _loads_by_plan(kind: str, plans: ModuleType, air: Air) -> Check:
    """Loads of a section with a straight lift line, and powers of the chord with values of their own."""
    airfoil, powers = StraightAirfoil(), (1.07, 1.21)
    found = section_derivatives(airfoil, air, powers=powers)
    expected = {name: load for name, load in found.items() if name in plans.SECTION_LOADS}
    size = _sizes(air, expected) | dict.fromkeys(("lift_incidence", "mach"), 1.0)
    met = at_center(air)
    speed, _, alpha = inflow(met)
    expected |= {
        "lift_incidence": alpha + powers[0] * turn_incidence(met),
        "mach": speed / air.speed_of_sound,
    }
    quantities = at_axis(air) | {
        "lift_slope": airfoil.lift_slope,
        "zero_lift_angle": airfoil.zero_lift_angle,
        "drag_coefficient": airfoil.drag,
        "moment_coefficient": airfoil.moment,
        "square_ratio": powers[0],
        "cube_ratio": powers[1],
    }

    def actual() -> dict[str, NDArray]:
        into = np.empty((len(plans.SECTION_LOADS), _COUNT))
        call((f"fused.{kind}", "section_loads"), quantities, into)
        return dict(zip(plans.SECTION_LOADS, into, strict=True))

    told = "lift, drag and moment of a section, by complex steps"
    return Check((f"fused.{kind}", "section_loads"), told, actual, expected, size)


def _segment_loads() -> Iterator[Check]:
    """The work of a load on a displacement as r^a, per velocity that grows as r^b, is its moment of order a + b."""
    rng = np.random.default_rng(6)
    r, weight = rng.uniform(0.5, 3.5, _COUNT), rng.uniform(0.1, 0.3, _COUNT)
    forces, velocities = ("fx", "fn", "fd"), ("ut", "up", "ur")
    absent = {"fx_ur", "fn_ur", "m_ur"}  # no section load depends on these
    names = [f"{load}_{motion}" for load in (*forces, "m") for motion in (*velocities, "theta", "spin")]
    along: dict[str, Any] = {n: 0 * r if n in absent else rng.uniform(1, 2, _COUNT) for n in names}
    along |= {load: rng.uniform(1, 2, _COUNT) for load in (*forces, "m")}

    def moment(name: str, power: int) -> float:
        return weight @ (r**power * along[name])

    moments = {f"{name}_{power}": moment(name, power) for name in along for power in range(3)}
    rows = [*((load, power) for power in (0, 1) for load in forces), ("m", 0)]
    columns = [*((name, power) for power in (0, 1) for name in velocities), ("spin", 0), ("theta", 0)]
    told = "sums over a straight segment"
    derivatives = np.array([[moment(f"{load}_{u}", a + b) for u, b in columns] for load, a in rows])
    yield matrix_check(("airloads", "load_derivatives"), told, moments, derivatives, 1.0)
    steady = np.array([[moment(load, a)] for load, a in rows])
    yield matrix_check(("airloads", "steady_loads"), told, moments, steady, 1.0)


def _lift_slope() -> Check:
    """Radial moments of a lift that grows with the angle of attack, u_T = Ωr and u_P = V."""
    rng = np.random.default_rng(7)
    ranges = {
        "rotor_speed": (40, 55),
        "density": (0.6, 1.3),
        "chord": (0.3, 0.5),
        "radius": (3, 5),
        "lift_slope": (5, 6),
        "inflow_ratio": (0.3, 0.9),
        "inner_edge": (0.1, 0.3),
        "outer_edge": (0.7, 1.0),
    }
    given = {name: rng.uniform(*limits, _COUNT) for name, limits in ranges.items()}
    column = {name: values[:, None] for name, values in given.items()}
    nodes, weights = np.polynomial.legendre.leggauss(60)
    half = (column["outer_edge"] - column["inner_edge"]) / 2
    r = column["radius"] * (column["inner_edge"] + half * (1 + nodes))
    dr = column["radius"] * half * weights
    u_t, u_p = column["rotor_speed"] * r, column["inflow_ratio"] * column["rotor_speed"] * column["radius"]
    u = np.hypot(u_t, u_p)
    lift = (
        column["density"] * column["chord"] * column["lift_slope"] / 2
    )  # L = lift U² α, α = θ − atan(u_P/u_T)
    by_alpha = {"fx": lift * u * u_p, "fn": lift * u * u_t}
    alpha = {"ut": u_p / u**2, "up": -u_t / u**2, "theta": 1.0}
    expected = {
        f"{load}_{name}_{power}": (by_alpha[load] * alpha[name] * r**power * dr).sum(-1)
        for load in by_alpha
        for name in alpha
        for power in range(3)
        if (load, name, power) != ("fn", "theta", 2)  # nothing takes it
    }
    return values_check(("lift_slope", "load_moments"), "quadrature", given, expected)
