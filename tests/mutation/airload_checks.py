"""Segments of a blade in the air: geometry, motions, and the airloads that follow, on a blade and in trim."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from types import ModuleType

import numpy as np
from numpy.typing import NDArray
from proprotor_equations.fused import general, offset, plain

from proprotor.rotor.fused_balance import moments_of
from tests.mutation import one_blade, paper_blade
from tests.mutation.comparison import Check, call, matrix_check, values_check
from tests.mutation.inputs import (
    GENERAL,
    OFFSET,
    PLAIN,
    Quantities,
    blade_quantities,
    natural_sizes,
    points,
    stacked,
)
from tests.mutation.one_blade import Point
from tests.mutation.sections import StraightAirfoil, section_derivatives
from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import blades, clock, inertia_rows

BEYOND_FLAP, BEYOND_LAG = np.array([0.0, 1.0, 1.0]), np.array([0.0, 0.0, 1.0])  # the three segments
_MOTIONS = ("virtual_motion", "rate_motion", "displacement_motion", "geometric_stiffness", "gust_motion")
_PRODUCTS = ("damping", "stiffness", "gust_loads")
_OF_MOTION = {"rate_motion": ("damping",), "gust_motion": ("gust_loads",), "virtual_motion": _PRODUCTS}
_TRIM_MOTIONS = ("virtual_motion", "displacement_motion", "geometric_stiffness")


def checks() -> Iterator[Check]:
    for published in (False, True):
        yield from _segments(published)
        yield from _blade(published)
    yield from _balance()
    yield from _trim()
    yield _line_by_plan()
    for kind, plans in ((OFFSET, offset), (GENERAL, general), (PLAIN, plain)):
        yield from _balance_by_plan(kind, plans)


def _flown(published: bool) -> list[Point]:
    """The published airloads are those of a flat blade."""
    return [paper_blade.flat(p) if published else p for p in points()]


# Segments


def _on_lines(point: Point, of_stations: Callable[[NDArray], NDArray]) -> tuple[NDArray, NDArray]:
    """Values (segments, n) at r = 0, and their growth with r, of what is linear along each segment."""
    hinges = [point.rotor.flap_hinge_offset, point.rotor.lag_hinge_offset]
    inner, outer = np.array([0.0, *hinges]), np.array([*hinges, point.air.radius])
    first, second = 0.8 * inner + 0.2 * outer, 0.1 * inner + 0.9 * outer
    a, b = of_stations(first), of_stations(second)
    growth = (b - a) / (second - first)[:, None]
    return a - growth * first[:, None], growth


def _geometry(point: Point) -> dict[str, NDArray]:
    """Of the segments, (segments,), by the names of the derivation."""
    rotor, lag = point.rotor, point.state["lag"]

    def line(r: NDArray) -> NDArray:
        arm = blades(rotor, r, Motion(point.trim), clock(rotor, 0.0)).arm.value[0].real
        outboard, lag_arm = (
            np.maximum(r - hinge, 0) for hinge in (rotor.flap_hinge_offset, rotor.lag_hinge_offset)
        )
        return np.column_stack([arm, outboard - lag_arm * (1 - np.cos(lag))])

    (x, y, z, flap_arm), _ = np.transpose(_on_lines(point, line), (0, 2, 1))
    angles = {
        "precone": np.full(3, rotor.precone),
        "cone": rotor.precone + BEYOND_FLAP * point.state["coning"],
        "lag": BEYOND_LAG * lag,
    }
    waves = {f"{f.__name__}_{name}": f(angle) for name, angle in angles.items() for f in (np.cos, np.sin)}
    anchor = {"anchor_i": -y, "anchor_j": x, "anchor_k": z}  # at no azimuth i is −J and j is I
    return waves | anchor | {"flap_arm_at_center": flap_arm}


def _velocity(point: Point) -> NDArray:
    """u_T, u_P, u_R at r = 0 and per unit radius, and the rotation about the span, (segments, 7)."""

    def at(r: NDArray) -> NDArray:
        air = one_blade.air_at(point, r, blades(point.rotor, r, Motion(point.trim), clock(point.rotor, 0.0)))
        numbers = (air.tangential, air.axial, air.radial, air.spin)
        return np.array([np.broadcast_to(number.real, (1, len(r)))[0] for number in numbers]).T

    center, growth = _on_lines(point, at)
    return np.column_stack([center[:, :3], growth[:, :3], center[:, 3]])


def moments(point: Point) -> dict[str, NDArray]:
    """Radial moments of the section loads in trim, (segments,), by the names of the derivation."""
    r, weight, segment = one_blade.stations(point)
    inside = (segment == np.arange(3)[:, None]) * weight
    loads = section_derivatives(point.airfoil, one_blade.trim_air(point))
    return {
        f"{name}_{power}": inside @ (r**power * load) for name, load in loads.items() for power in range(3)
    }


@functools.cache
def _quantities(published: bool, kind: str = OFFSET) -> Quantities:
    """Of the segments, (points, segments)."""
    whole = {name: np.asarray(value)[..., None] for name, value in blade_quantities(kind).items()}
    whole |= {"beyond_flap_hinge": BEYOND_FLAP[None], "beyond_lag_hinge": BEYOND_LAG[None]}
    flown = _flown(published) if kind == OFFSET else points(kind)
    return whole | stacked(_geometry(p) | moments(p) for p in flown)


def _module(published: bool) -> str:
    return "published.airloads" if published else "airloads"


def _segments(published: bool) -> Iterator[Check]:
    quantities, flown = _quantities(published), _flown(published)
    expected = stacked(map(_geometry, flown))
    told = f"positions of the nonlinear rotor{', flat' * published}"
    natural = dict.fromkeys(expected, 1.0)  # m and rad
    yield values_check((_module(published), "segment_geometry"), told, quantities, expected, natural)
    velocity = np.array([_velocity(p) for p in flown])[..., None]
    size = (quantities["airspeed"] + quantities["rotor_speed"])[..., None, None]
    told = f"velocities of the nonlinear rotor{', flat' * published}"
    yield matrix_check((_module(published), "trim_velocity"), told, quantities, velocity, size)


# Airloads of a blade


def quantities_of_segments() -> Quantities:
    """Of the segments, (points, segments), with all first-order terms."""
    return _quantities(published=False)


def arrays_of_blade() -> Quantities:
    """W, U, G and L of the segments as generated, with all first-order terms."""
    return _arrays(published=False)


@functools.cache
def _arrays(published: bool) -> Quantities:
    """W, U, G and L of the segments as generated, one of which a check makes again."""
    quantities = _quantities(published)
    arrays = {name: call((_module(published), name), quantities) for name in _MOTIONS}
    return arrays | {"load_derivatives": call(("airloads", "load_derivatives"), quantities)}


def _products(published: bool, function: str, products: Iterable[str]) -> Quantities:
    arrays = dict(_arrays(published))
    if function in _MOTIONS:
        arrays[function] = call((_module(published), function), _quantities(published))
    return {name: call(("airloads", name), arrays) for name in products}


def _blade(published: bool) -> Iterator[Check]:
    """W, U and G by what they make: airload damping and stiffness, and gust loads, of a blade."""
    blade, flown = (paper_blade if published else one_blade), _flown(published)
    _, C, K = map(np.array, zip(*map(blade.air_matrices, flown), strict=True))
    _, size_C, size_K = natural_sizes()
    expected = dict(zip(_PRODUCTS, (C, K, np.array([blade.gust_columns(p) for p in flown])), strict=True))
    natural = dict(
        zip(_PRODUCTS, (size_C, size_K, size_C[..., :3]), strict=True)
    )  # a gust is a hub's velocity
    told = (
        f"virtual work of the airloads on the nonlinear rotor{', flat and where it is in trim' * published}"
    )
    functions = {name: _OF_MOTION.get(name, ("stiffness",)) for name in _MOTIONS}
    functions |= {} if published else {name: (name,) for name in _PRODUCTS}
    for function, products in functions.items():
        yield Check(
            (_module(published), function),
            told,
            functools.partial(_products, published, function, products),
            {name: expected[name] for name in products},
            {name: natural[name] for name in products},
        )


# The trim


def _balance() -> Iterator[Check]:
    """Of springs and centrifugal force, and its change with coning, lag, elastic pitch and collective."""
    quantities = blade_quantities()
    pairs = [_in_vacuum(p) for p in points()]
    rows, slopes = map(np.array, zip(*pairs, strict=True))
    told = "steady balance of the nonlinear rotor in vacuum, its masses on the pitch axis"
    yield matrix_check(("trim", "residual"), told, quantities, rows[..., None], _moment_size())
    yield matrix_check(("trim", "jacobian"), told, quantities, slopes, _moment_size())
    beside = [_beside_axis(p) for p in points()]
    rows, slopes = map(np.array, zip(*beside, strict=True))
    told = "steady inertia forces of the nonlinear rotor, with and without its offsets"
    yield matrix_check(("trim", "offset_residual"), told, quantities, rows[..., None], _moment_size())
    yield matrix_check(("trim", "offset_jacobian"), told, quantities, slopes, _moment_size())
    loads = np.array([_undeflected_inertia(p) for p in points()])
    told = "steady inertia forces on the undeflected blade of the nonlinear rotor"
    yield matrix_check(("trim", "precone_load"), told, quantities, loads[..., None], _moment_size())


def _in_vacuum(point: Point) -> tuple[NDArray, NDArray]:
    """Steady loads and slopes of springs, lumped pitch inertia and masses on the pitch axis."""
    return one_blade.steady_rows(one_blade.vacuum_rows, replace(point, rotor=one_blade.lumped(point.rotor)))


def _beside_axis(point: Point) -> tuple[NDArray, NDArray]:
    """What the place of the masses beside the axis adds to steady inertia forces and their slopes."""
    beside, on_axis = (
        one_blade.steady_rows(inertia_rows, replace(point, rotor=change(point.rotor)))
        for change in (one_blade.without_lumped, one_blade.on_axis)
    )
    return beside[0] - on_axis[0], beside[1] - on_axis[1]


def _undeflected_inertia(point: Point) -> NDArray:
    """Flap, lag and pitch moment (3,) of the steady inertia forces without coning, lag and elastic pitch."""
    flat = replace(point, trim=np.zeros_like(point.trim), rotor=one_blade.on_axis(point.rotor))
    rows, _ = one_blade.steady_rows(inertia_rows, flat)
    return rows[:3]


def _moment_size() -> NDArray:
    quantities = blade_quantities()
    return (quantities["flap_inertia"] * quantities["rotor_speed"] ** 2)[:, None, None]


@functools.cache
def _trim_arrays() -> Quantities:
    quantities = _quantities(published=False)
    arrays = {name: call(("trim", name), quantities) for name in _TRIM_MOTIONS}
    return arrays | {
        name: call(("airloads", name), quantities) for name in ("load_derivatives", "steady_loads")
    }


def _trim_products(function: str, products: Iterable[str]) -> Quantities:
    arrays = dict(_trim_arrays())
    if function in _TRIM_MOTIONS:
        arrays[function] = call(("trim", function), _quantities(published=False))
    return {name: call(("airloads", name), arrays) for name in products}


def _trim() -> Iterator[Check]:
    """W, U and G of the balance by the steady work of the airloads and its change with the unknowns."""
    # Pitch that follows flap and lag belongs to the perturbation, not to the trim.
    still = [replace(p, pitch_flap_coupling=0.0, pitch_lag_coupling=0.0) for p in points()]
    pairs = [one_blade.steady_rows(functools.partial(one_blade.airload_rows, p), p) for p in still]
    rows, slopes = map(np.array, zip(*pairs, strict=True))
    expected = {"steady_work": -rows[..., None], "stiffness": slopes}
    functions = {("trim", name): ("stiffness",) for name in _TRIM_MOTIONS}
    functions |= {("trim", "virtual_motion"): tuple(expected), ("airloads", "steady_work"): ("steady_work",)}
    for sees, products in functions.items():
        yield Check(
            sees,
            "steady balance of the nonlinear rotor in the air",
            functools.partial(_trim_products, sees[1], products),
            {name: expected[name] for name in products},
            dict.fromkeys(products, _moment_size()),
        )


# The same by the plans


def _line_by_plan() -> Check:
    """Geometry of the segments and the air along them."""
    quantities = _quantities(published=False)
    geometry = stacked(map(_geometry, _flown(published=False)))
    rows = ("ut_0", "up_0", "ur_0", "ut_1", "up_1", "ur_1", "spin")
    velocity = np.moveaxis(np.array([_velocity(p) for p in points()]), -1, 0)
    known = geometry | dict(zip(rows, velocity, strict=True))
    expected = {name: known[name] for name in plain.LINE}
    speed = quantities["airspeed"] + quantities["rotor_speed"]
    size = {name: speed if name in rows else 1.0 for name in expected}

    def actual() -> dict[str, NDArray]:
        found = call(("fused.plain", "line"), quantities, np.cos, np.sin)
        return dict(zip(plain.LINE, found, strict=True))

    return Check(("fused.plain", "line"), "positions of the nonlinear rotor", actual, expected, size)


def _filled(layouts: dict[str, list[list[int]]], results: tuple[NDArray, ...]) -> dict[str, NDArray]:
    """The matrices of a plan: n stands for the n-th result, -n for its negative, 0 for zero."""

    def entry(number: int) -> NDArray:
        result = results[abs(number) - 1] if number else 0.0
        return np.sign(number) * np.broadcast_to(result, len(points()))

    return {
        name: np.moveaxis(np.array([[entry(n) for n in row] for row in rows]), -1, 0)
        for name, rows in layouts.items()
    }


def _balance_by_plan(kind: str, plans: ModuleType) -> Iterator[Check]:
    """Balance without airloads, work of the airloads, and the change of both with the unknowns."""
    module, flown = f"fused.{kind}", points(kind)
    quantities, along = blade_quantities(kind), _quantities(published=False, kind=kind)
    # Pitch that follows flap and lag belongs to the perturbation, not to the trim.
    still = [
        replace(p, pitch_flap_coupling=0.0, pitch_lag_coupling=0.0, airfoil=StraightAirfoil()) for p in flown
    ]
    along = along | stacked(map(moments, still))
    line, loads = ([along.get(name, np.nan) for name in names] for names in (plans.LINE, moments_of(plans)))

    def balance() -> dict[str, NDArray]:
        return _filled(plans.BALANCE, call((module, "balance"), quantities, np.cos, np.sin))

    def work() -> dict[str, NDArray]:
        found = call((module, "work"), along, line, loads)
        return _filled(plans.WORK, tuple(np.sum(part, axis=-1) for part in found))

    in_air = [one_blade.steady_rows(functools.partial(one_blade.airload_rows, p), p) for p in still]
    in_vacuum = [one_blade.steady_rows(one_blade.vacuum_rows, p) for p in flown]
    for name, pairs, actual in (("balance", in_vacuum, balance), ("work", in_air, work)):
        rows, slopes = map(np.array, zip(*pairs, strict=True))
        named = ("residual", "slopes") if name == "balance" else ("work", "work_slopes")
        numbers = (rows, slopes) if name == "balance" else (-rows, slopes[..., :3])
        expected = dict(zip(named, (numbers[0][..., None], numbers[1]), strict=True))
        told = f"steady balance of the nonlinear rotor, {kind}"
        yield Check((module, name), told, actual, expected, dict.fromkeys(named, _moment_size()))
    if kind == PLAIN:
        yield _precone_by_plan()


def _precone_by_plan() -> Check:
    loads = np.array([_undeflected_inertia(p) for p in points()])[..., None]

    def actual() -> dict[str, NDArray]:
        found = call(("fused.plain", "precone_load"), blade_quantities(), np.cos, np.sin)
        return _filled(plain.PRECONE_LOAD, found)

    told = "steady inertia forces on the undeflected blade of the nonlinear rotor"
    size = {"precone_load": _moment_size()}
    return Check(("fused.plain", "precone_load"), told, actual, {"precone_load": loads}, size)
