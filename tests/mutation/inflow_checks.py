"""Inflow: momentum of the air through the disk, and what a blade has to do with the induced velocity."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.mutation import one_blade
from tests.mutation.airload_checks import arrays_of_blade, quantities_of_segments
from tests.mutation.comparison import Check, call, values_check
from tests.mutation.inputs import natural_sizes, points, stacked
from tests.mutation.one_blade import STEP, Point
from tests.mutation.sections import section_loads
from tests.mutation.transform import ONE_BLADE, seen_from_blade
from tests.oracles.induced_flow import hub_axes
from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import DOFS, HUB_MOMENT, blades, clock

_ROW = DOFS.index("flap_0")  # stands for what makes the inflow: the sum over the blades does not turn it
_FUNCTIONS = range(3)  # of the disk: one, outward and aside
_TOLD = "forces along the hub's axis on the nonlinear rotor, by complex steps"


def checks() -> Iterator[Check]:
    yield _momentum()
    yield from _blade()


def _momentum() -> Check:
    """Thrust of a stream tube and its derivatives by complex steps, and the masses of air around a disk."""
    density, radius, airspeed, induced = (
        np.array([1.1, 0.7]),
        np.array([3.8, 2.0]),
        90.0,
        np.array([4.0, -3.0]),
    )
    area = np.pi * radius**2

    def thrust(speed: Any, inflow: Any) -> Any:
        return 2 * density * area * (speed + inflow) * inflow

    expected = {
        "momentum_thrust": thrust(airspeed, induced),
        "uniform_mass_flow": thrust(airspeed, induced + 1j * STEP).imag / STEP,
        "thrust_by_speed": thrust(airspeed + 1j * STEP, induced).imag / STEP,
        "harmonic_mass_flow": density * area * (airspeed + induced) / 2,
        "uniform_apparent_mass": 8 / (3 * np.pi) * density * area * radius,
        "harmonic_apparent_mass": 16 / (45 * np.pi) * density * area * radius,
    }
    given = {
        "density": density,
        "radius": radius,
        "axial_flow": airspeed + induced,
        "induced_velocity": induced,
    }
    return values_check(("inflow", "momentum"), "a stream tube, and air around a disk", given, expected)


def _functions(point: Point, motion: Any, turn: Any, azimuth: float) -> list[NDArray]:
    """One, and the places of the sections over the radius, outward and aside in the undisturbed rotating axes."""
    x, y, _ = np.moveaxis(motion.arm.value @ hub_axes(turn)[..., None, :, :], -1, 0)
    cosine, sine = np.cos(azimuth), np.sin(azimuth)
    radius = point.air.radius
    return [np.ones_like(x), (x * cosine + y * sine) / radius, (y * cosine - x * sine) / radius]


def _rows(point: Point, function: int, rotor: Any, q: Motion, time: float, drift: Any = 0.0) -> NDArray:
    """Loads of the blade along the hub's axis that make the inflow, with their sign on the left, in the flap row."""
    r, weight, _ = one_blade.stations(point)
    motion = blades(rotor, r, q, clock(rotor, time))
    loads = section_loads(point.airfoil, one_blade.air_at(point, r, motion, drift))
    turn = np.asarray(q.value[..., HUB_MOMENT])
    axis = hub_axes(turn)[..., None, None, :, 2]
    along = sum(
        loads[name] * (direction.value * axis).sum(-1)
        for name, direction in (("fx", motion.chordwise), ("fn", motion.normal), ("fd", motion.spanwise))
    )
    weighed = along * weight * _functions(point, motion, turn, rotor.rotor_speed * time)[function]
    whole = weighed.sum((-2, -1))
    rows = np.zeros((*np.shape(whole), len(DOFS)), dtype=complex)
    rows[..., _ROW] = -whole
    return rows


def _made(point: Point) -> dict[str, NDArray]:
    """What makes the inflow (3, n), by rates, displacements, gusts and the inflow itself, in rotating axes."""
    seen = seen_from_blade(ONE_BLADE, 0.0)[0]
    place = int(np.abs(seen[:, ONE_BLADE.index("flap_0")]).argmax())
    still, found = Motion(point.trim), {name: [] for name in ("rates", "displacements", "gusts", "inflow")}
    for function in _FUNCTIONS:
        _, C, K = one_blade.blade_matrices(functools.partial(_rows, point, function), point)
        found["rates"].append(C[place])
        found["displacements"].append(K[place])
        for name, drifts in (("gusts", _axes()), ("inflow", -_fields(point))):
            moved = [_rows(point, function, point.rotor, still, 0.0, 1j * STEP * drift) for drift in drifts]
            found[name].append([rows[_ROW].imag / STEP for rows in moved])
    found = {name: np.array(rows) for name, rows in found.items()}
    return {**found, "gusts": -found["gusts"]}  # on the right


def _axes() -> NDArray:
    """i, j, k at no azimuth."""
    return np.array([(0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)])


def _fields(point: Point) -> NDArray:
    """The functions of the disk along k at the stations in trim, (3, 1, stations, 3)."""
    r, _, _ = one_blade.stations(point)
    motion = blades(point.rotor, r, Motion(point.trim), clock(point.rotor, 0.0))
    found = np.real(_functions(point, motion, np.zeros(3), 0.0))
    return found[..., None] * np.array([0.0, 0.0, 1.0])


def _loads(point: Point) -> NDArray:
    """Loads (12, 3) on the blade by the inflow, on the left, in rotating axes."""
    places = [DOFS.index(name) for name in ONE_BLADE]
    columns = [
        one_blade.airload_rows(point, point.rotor, Motion(point.trim), 0.0, -1j * STEP * field)[places].imag
        / STEP
        for field in _fields(point)
    ]
    return np.linalg.inv(seen_from_blade(ONE_BLADE, 0.0)[0]).T @ np.array(columns).T


def _products(*wanted: str) -> dict[str, NDArray]:
    """The same by the generated functions."""
    quantities, arrays = quantities_of_segments(), arrays_of_blade()
    through = {"rate_motion": call(("inflow", "motion"), quantities)}
    made = {
        "virtual_motion": call(("inflow", "virtual_motion"), quantities),
        "geometric_stiffness": call(("inflow", "geometric_stiffness"), quantities),
    }
    of = {
        "loads": ("damping", arrays | through),
        "rates": ("damping", arrays | made),
        "displacements": ("stiffness", arrays | made),
        "gusts": ("gust_loads", arrays | made),
        "inflow": ("damping", arrays | made | through),
    }
    return {name: call(("airloads", of[name][0]), of[name][1]) for name in wanted}


def _blade() -> Iterator[Check]:
    expected = stacked(_made(p) | {"loads": _loads(p)} for p in points())
    _, damping, stiffness = natural_sizes()  # a function of the disk is a displacement along k
    axial = slice(2, 3)
    natural = {
        "loads": damping[..., :, axial] * np.ones(3),
        "rates": damping[..., axial, :] * np.ones((3, 1)),
        "displacements": stiffness[..., axial, :] * np.ones((3, 1)),
        "gusts": damping[..., axial, axial] * np.ones((3, 3)),
        "inflow": damping[..., axial, axial] * np.ones((3, 3)),
    }
    seen = {
        "motion": ("loads", "inflow"),
        "virtual_motion": ("rates", "gusts", "displacements"),
        "geometric_stiffness": ("displacements",),
    }
    for function, wanted in seen.items():
        yield Check(
            ("inflow", function),
            _TOLD,
            functools.partial(_products, *wanted),
            {name: expected[name] for name in wanted},
            {name: natural[name] for name in wanted},
        )
