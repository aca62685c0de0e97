"""Lag of lift: circulation of a section, its moments on a straight segment, and its change and work on a blade."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.mutation import one_blade
from tests.mutation.airload_checks import BEYOND_FLAP, BEYOND_LAG
from tests.mutation.comparison import Check, call, matrix_check, values_check
from tests.mutation.inputs import Quantities, blade_quantities, points, stacked
from tests.mutation.one_blade import Point
from tests.mutation.section_checks import at_axis, beside_axis, quantities_of, some_air
from tests.mutation.sections import (
    DERIVATIVES,
    POLYNOMIAL,
    STEP,
    Air,
    about_axis,
    at_center,
    inflow,
    turn_incidence,
)
from tests.mutation.transform import ONE_BLADE, seen_from_blade
from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import DOFS, blades, clock
from tests.oracles.virtual_work import assembled

_CHANGES, _FORCES = ("ut", "up", "theta", "spin"), ("fx", "fn")
_ROW = DOFS.index("flap_0")  # stands for the circulation: the sum over the blades does not turn it
_ARRAYS = ("rate_motion", "displacement_motion", "gust_motion", "virtual_motion")
_PRODUCTS = ("change_by_rates", "change_by_displacements", "change_by_gusts", "work")


def checks() -> Iterator[Check]:
    yield from _section()
    yield from _segment()
    yield from _blade()


# Sections


def _circulation(air: Air) -> Any:
    """U c_l."""
    air = at_center(air)
    speed, _, alpha = inflow(air)
    lift, _, _ = POLYNOMIAL.coefficients(alpha + turn_incidence(air), speed / air.speed_of_sound)
    return speed * lift


def _of_sections(air: Air) -> dict[str, NDArray]:
    """Weighed changes of the circulation by complex steps, and the force of the circulation, by name."""
    speed, angle, _ = inflow(at_center(air))
    weight = speed * air.chord / 2
    found = {"circulation_weight": weight, "circulation_decay": speed**2}
    for name in _CHANGES:
        moved = replace(air, **{DERIVATIVES[name]: getattr(air, DERIVATIVES[name]) + 1j * STEP})
        found[f"circulation_{name}"] = weight * np.imag(_circulation(moved)) / STEP
    force = air.density * weight
    loads = {"fx": force * np.sin(angle), "fn": force * np.cos(angle), "m": 0.0 * force}
    return found | {f"{name}_circulation": load for name, load in about_axis(air, loads).items()}


def _section() -> Iterator[Check]:
    air = some_air()
    told = "circulation of a section, by complex steps"
    expected = _of_sections(air)
    del expected["m_circulation"]  # about an axis through the aerodynamic centre there is none
    yield values_check(("lift_lag", "change_of_circulation"), told, quantities_of(air), expected)
    air = beside_axis()
    sees, speed = ("lift_lag", "change_beside_axis"), inflow(air)[0]
    expected = _of_sections(air)
    sizes = expected | {"circulation_spin": speed * air.chord**2, "circulation_theta": speed**2 * air.chord}
    yield values_check(sees, told, at_axis(air), expected, sizes)


def _segment() -> Iterator[Check]:
    """Moments as numbers of their own, each at its place."""
    rng = np.random.default_rng(18)
    names = [f"circulation_{name}_0" for name in _CHANGES] + ["circulation_ut_1", "circulation_up_1"]
    names += [f"{load}_circulation_{power}" for load in _FORCES for power in (0, 1)] + ["m_circulation_0"]
    given = dict(zip(names, rng.uniform(1, 2, len(names)), strict=True))
    change = np.zeros((1, 8))
    change[0, [0, 1, 3, 4, 6, 7]] = [
        given[f"circulation_{name}"] for name in ("ut_0", "up_0", "ut_1", "up_1", "spin_0", "theta_0")
    ]
    load = np.zeros((7, 1))
    load[[0, 1, 3, 4], 0] = [given[f"{of}_circulation_{power}"] for power in (0, 1) for of in _FORCES]
    load[6, 0] = given["m_circulation_0"]
    told = "places of the moments on a straight segment"
    yield matrix_check(("lift_lag", "change"), told, given, change, 1.0)
    yield matrix_check(("lift_lag", "load"), told, given, load, 1.0)


# A blade


def _shape(r: NDArray) -> NDArray:
    """A shape function like any other."""
    return 1 + 0.3 * r - 0.1 * r**2


def _moments(point: Point) -> dict[str, NDArray]:
    """Radial moments (segments,) by name."""
    r, weight, segment = one_blade.stations(point)
    inside = (segment == np.arange(3)[:, None]) * weight * _shape(r)
    loads = _of_sections(one_blade.trim_air(point))
    return {f"{name}_{power}": inside @ (r**power * load) for name, load in loads.items() for power in (0, 1)}


def _rows(point: Point, rotor: Any, q: Motion, time: float, drift: Any = 0.0) -> NDArray:
    """Circulation of the blade in the shape function, in the place of the flap row."""
    r, weight, _ = one_blade.stations(point)
    motion = blades(rotor, r, q, clock(rotor, time))
    speed, _, _ = inflow(at_center(one_blade.trim_air(point)))
    of_sections = _circulation(one_blade.air_at(point, r, motion, drift))
    whole = (of_sections * weight * _shape(r) * speed * one_blade.trim_air(point).chord / 2).sum((-2, -1))
    rows = np.zeros((*np.shape(whole), len(DOFS)), dtype=complex)
    rows[..., _ROW] = whole
    return rows


def _changes(point: Point) -> dict[str, NDArray]:
    """Change of the circulation (1, n) by rates, displacements and gusts, in rotating axes."""
    _, C, K = one_blade.blade_matrices(functools.partial(_rows, point), point)
    place = [_blade_row()]
    gusts = []
    for axis in ((0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)):  # i, j, k at no azimuth
        rows = _rows(point, point.rotor, Motion(point.trim), 0.0, 1j * STEP * np.array(axis))
        gusts.append(rows[_ROW].imag / STEP)
    return {
        "change_by_rates": C[place],
        "change_by_displacements": K[place],
        "change_by_gusts": np.array([gusts]),
    }


def _blade_row() -> int:
    """The row of a blade's flap in rotating axes."""
    return int(np.abs(seen_from_blade(ONE_BLADE, 0.0)[0][:, ONE_BLADE.index("flap_0")]).argmax())


def _work(point: Point) -> NDArray:
    """Virtual work (12, 1) of the force that circulation makes, in rotating axes."""
    r, weight, _ = one_blade.stations(point)
    motion = blades(point.rotor, r, Motion(point.trim), clock(point.rotor, 0.0))
    loads = _of_sections(one_blade.trim_air(point))
    force = loads["fx_circulation"][..., None] * motion.chordwise.value
    force = force + loads["fn_circulation"][..., None] * motion.normal.value
    turning = np.broadcast_to(loads["m_circulation"] * weight * _shape(r), force.shape[:-1])
    rows = assembled(
        point.rotor, r, Motion(point.trim), 0.0, motion, force * (weight * _shape(r))[:, None], turning
    )
    back = np.linalg.inv(seen_from_blade(ONE_BLADE, 0.0)[0])
    return (back.T @ rows[[DOFS.index(name) for name in ONE_BLADE]].real)[:, None]


@functools.cache
def _quantities() -> Quantities:
    """Of the segments, (points, segments); the geometry is that of the other airloads."""
    whole = {name: np.asarray(value)[..., None] for name, value in blade_quantities().items()}
    whole |= {"beyond_flap_hinge": BEYOND_FLAP[None], "beyond_lag_hinge": BEYOND_LAG[None]}
    whole |= stacked(map(_moments, points()))
    return whole | call(("airloads", "segment_geometry"), whole)._asdict()


def _product(name: str) -> dict[str, NDArray]:
    quantities = _quantities()
    arrays = {array: call(("airloads", array), quantities) for array in _ARRAYS}
    arrays |= {array: call(("lift_lag", array), quantities) for array in ("change", "load")}
    return {name: call(("lift_lag", name), arrays)}


def _blade() -> Iterator[Check]:
    flown = points()
    expected = stacked(_changes(p) | {"work": _work(p)} for p in flown)
    told = "circulation along the nonlinear rotor, by complex steps"
    for name in _PRODUCTS:
        size = np.abs(expected[name]).max(axis=(-2, -1), keepdims=True)
        yield Check(
            ("lift_lag", name),
            told,
            functools.partial(_product, name),
            {name: expected[name]},
            {name: 10 * size},
        )
