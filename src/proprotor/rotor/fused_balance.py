"""Balance of one blade at many points by the fused functions: loads of the sections, their work, and the slopes.

The functions hold a straight lift line with the Prandtl-Glauert factor. Stations are the first axis of all arrays and
points the last, so that the points of a block lie side by side in the cache.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from types import ModuleType
from typing import Any, NamedTuple, cast

import numpy as np

from proprotor.compiled import plans as compiled_plans
from proprotor.rotor.airfoil import Airfoil
from proprotor.rotor.fused import Layout, pool_of, values_of
from proprotor.rotor.generated import evaluate
from proprotor.rotor.kept import kept
from proprotor.rotor.quadrature import POWERS, RadialQuadrature
from proprotor.rotor.section_loads import LOAD_MOMENTS, BladeSections, mark_doubts
from proprotor.typing import Array

_Quantities = Mapping[str, Any]

# A product of matrices has the same bits in each column if the number of columns is a multiple of this: no kernel of
# BLAS then has columns left over, which it would add up in another order.
_COLUMNS = 16
_OF_SEGMENTS = ("ut_0", "ut_1", "up_0", "up_1", "ur_0", "spin")
PITCH_TWICE = [0, 1, 2, 2]  # the collective moves the blade as the elastic pitch does


_NO_LOADS = dict.fromkeys(LOAD_MOMENTS, 0.0)
# Fields of the airfoil, and their names in the plan `section_loads`.
OF_AIRFOIL = {
    "lift_slope": "lift_slope",
    "zero_lift_angle": "zero_lift_angle",
    "drag": "drag_coefficient",
    "moment": "moment_coefficient",
}


class Room:
    """Memory for the loads at the stations, the same for every block: to get new memory takes longer than the loads."""

    def __init__(self) -> None:
        self._numbers = np.empty(0)

    def array(self, shape: tuple[int, ...], kind: np.dtype[Any]) -> Array:
        """Return an array whose numbers stay until the next call."""
        size = int(np.prod(shape))
        if self._numbers.size < size or self._numbers.dtype != kind:
            self._numbers = np.empty(size, dtype=kind)
        return self._numbers[:size].reshape(shape)


class _Balanced(NamedTuple):
    """Balance of a blade at n points.

    residual, slopes : array (n, 5), (n, 5, 4)
        Without airloads; columns as the unknowns of the trim.
    work, work_slopes : array (n, 5), (n, 5, 4)
        Virtual work of the airloads, and minus its change with the unknowns.
    moments : array (loads, powers of r, segments, n)
        Radial moments of the section loads.
    """

    residual: Array
    slopes: Array
    work: Array
    work_slopes: Array
    moments: Array


def serves_sections(sections: BladeSections) -> bool:
    """Return whether the fused functions hold the airfoil of these sections."""
    return type(sections.airfoil) is Airfoil


@cache
def loads_of(plans: ModuleType) -> tuple[str, ...]:
    """Return the names of the loads of `section_loads`; its last two results say if the loads are in doubt."""
    return tuple(plans.SECTION_LOADS[:-2])


@cache
def moments_of(plans: ModuleType) -> tuple[str, ...]:
    """Return the names of the radial moments of these loads."""
    return tuple(f"{load}_{power}" for load in loads_of(plans) for power in range(POWERS))


def balanced(
    plans: ModuleType,
    sections: BladeSections,
    quantities: _Quantities,
    compressibility: bool,
    room: Room,
    doubts: dict[str, Array] | None = None,
    compiled: bool = False,
) -> _Balanced:
    """Return the balance of a blade at trim states.

    Parameters
    ----------
    plans : module
        The fused functions, see `proprotor.rotor.fused.plans_of`.
    sections : BladeSections
    quantities : mapping
        Numbers or arrays (n,) of the blade at trim by name.
    compressibility : bool
    room : Room
    doubts : dict, optional
        Filled with the reasons to doubt the airfoil's coefficients outboard, masks (n,) by reason.
    """
    points = len(quantities["coning"])
    if compiled and sections.quadrature.counts.ndim == 1:
        return _compiled(plans, sections, quantities, compressibility, doubts)
    blade = dict(quantities) | {name: side[:, None] for name, side in sections.sides.items()}
    line = evaluate(plans.line, blade, np.cos, np.sin)
    air = _air(sections, blade | dict(zip(plans.LINE, line, strict=True)), compressibility)
    moments = _load_moments(plans, sections, air, quantities["radius"], room, points, doubts)
    shape = moments.shape[2:]
    structure = _matrices(plans, "balance", evaluate(plans.balance, quantities, np.cos, np.sin), shape[1:])
    of_loads = evaluate(plans.work, blade, line, moments.reshape(-1, *shape))
    work = _matrices(plans, "work", of_loads, shape)
    residual, virtual = structure["residual"][..., 0], work["work"][..., 0]
    return _Balanced(residual, structure["slopes"], virtual, work["work_slopes"], moments)


def compiled_blades(
    sections: BladeSections, quantities: _Quantities, compressibility: bool, **closing: Any
) -> compiled_plans.Blades:
    """Return blades at many points for the compiled plans, with what closes their trim, see `compiled_plans.Blades`."""
    met = quantities if compressibility else dict(quantities) | {"speed_of_sound": math.inf}
    of_points = {"tip": quantities["radius"], **closing}
    return compiled_plans.Blades(met, sections.sides, _stations_of(sections), of_points)


@kept
def _stations_of(sections: BladeSections) -> compiled_plans.Stations:
    quadrature, airfoil, along = sections.quadrature, vars(sections.airfoil), sections.along
    own = {"radius": quadrature.stations, "chord": along.chord, "twist": along.twist, "bent": along.bent}
    own |= {"square_ratio": along.square, "cube_ratio": along.cube}
    own |= {name: airfoil[name] for name in OF_AIRFOIL}
    return compiled_plans.Stations.of([0, *(one.stop for one in quadrature.slices)], own, quadrature.weights)


def _compiled(
    plans: ModuleType,
    sections: BladeSections,
    quantities: _Quantities,
    compressibility: bool,
    doubts: dict[str, Array] | None,
) -> _Balanced:
    """Return the balance by the compiled plans."""
    points = len(quantities["coning"])
    blades = compiled_blades(sections, quantities, compressibility)
    found = compiled_plans.balance_of_blade(plans, points, blades, doubts is not None)
    if doubts is not None and found.doubts is not None:
        angle, mach = found.doubts
        mark_doubts(doubts, sections, quantities["radius"], (angle, mach), slice(0, points), points)
    parts = {"balance": found.structure, "work": found.work}
    structure, work = (_at_places(plans, name, results) for name, results in parts.items())
    residual, virtual = structure["residual"][..., 0], work["work"][..., 0]
    return _Balanced(residual, structure["slopes"], virtual, work["work_slopes"], found.moments)


def _at_places(plans: ModuleType, plan: str, results: Array) -> dict[str, Array]:
    """Return the matrices (n, rows, columns) of a plan from its results (n, results)."""
    layout = _layouts(plans)[plan]
    whole = np.empty((len(results), 1 + results.shape[1] + len(layout.opposite)))
    whole[:, 0], whole[:, 1 : 1 + results.shape[1]] = 0.0, results
    np.negative(results[:, np.array(layout.opposite, dtype=int) - 1], out=whole[:, 1 + results.shape[1] :])
    return {name: np.take(whole, places, axis=1) for name, places in layout.places.items()}


def segments_of(plans: ModuleType, moments: Array, sections: BladeSections) -> dict[str, Any]:
    """Return sides of the hinges (segments,) and radial moments (n, segments) by name and power of r."""
    named = zip(moments_of(plans), moments.reshape(-1, *moments.shape[2:]).swapaxes(1, 2), strict=True)
    return _NO_LOADS | sections.sides | dict(named)


@cache
def _layouts(plans: ModuleType) -> dict[str, Layout]:
    work = Layout.of(plans.WORK)
    work.places["work_slopes"] = work.places["work_slopes"][:, PITCH_TWICE]
    return {"work": work, "balance": Layout.of(plans.BALANCE)}


def _matrices(
    plans: ModuleType, plan: str, results: tuple[Any, ...], shape: tuple[int, ...]
) -> dict[str, Array]:
    """Return the matrices (n, rows, columns) of a plan from results of a shape (n,), or (segments, n) to be summed."""
    layout = _layouts(plans)[plan]
    kind = np.result_type(float, *results)
    pool = np.empty((len(results), *shape), dtype=kind)
    for place, result in enumerate(results):
        pool[place] = result
    total = pool if len(shape) == 1 else np.add.reduce(pool, axis=1)
    whole = pool_of(values_of(tuple(total), layout), shape[-1:], kind)
    return {name: np.take(whole, places, axis=1) for name, places in layout.places.items()}


# Loads along the blade


def _air(sections: BladeSections, blade: _Quantities, compressibility: bool) -> dict[str, Any]:
    """Return what the sections meet, by name: arrays (segments, n) and (n,), or numbers that all points share."""
    names = (*_OF_SEGMENTS, "density", "section_damping", "pitch", "speed_of_sound")
    found = {name: blade[name] for name in names}
    return found if compressibility else found | {"speed_of_sound": np.inf}


def _load_moments(
    plans: ModuleType,
    sections: BladeSections,
    air: _Quantities,
    radius: Any,
    room: Room,
    points: int,
    doubts: dict[str, Array] | None,
) -> Array:
    """Return the radial moments (loads, powers, segments, n) of the section loads, a block of points at a time."""
    numbers = (*air.values(), *vars(sections.airfoil).values())
    kind = np.result_type(float, *(np.asarray(value).dtype for value in numbers))
    count = len(loads_of(plans))
    shape = count, POWERS, len(sections.quadrature.beyond_lag_hinge), points
    moments = np.empty(shape, dtype=kind)
    for rows, here in sections.blocks(points):
        n = len(range(points)[rows]) if isinstance(rows, slice) else len(rows)
        shared = here.quadrature.counts.ndim == 1
        width = _full_width(n) if shared else n
        met = {name: _columns(value, rows, width) for name, value in air.items()}
        loads = _loads_at_stations(plans, here, met, width, room, kind)
        if doubts is not None:
            of_stations = loads[-2, :, :n].T, loads[-1, :, :n].T
            own = radius[rows] if np.ndim(radius) and len(radius) > 1 else radius
            mark_doubts(doubts, here, own, of_stations, rows, points)
        of_loads = loads[:count]
        found = _by_product(here, of_loads) if shared else _point_by_point(here, of_loads)
        moments[..., rows] = found[..., :n]
    return moments


def _full_width(count: int) -> int:
    """Return the number of columns of a product that has room for a number of columns."""
    return -(-count // _COLUMNS) * _COLUMNS


def _columns(value: Any, rows: Array | slice, width: int) -> Any:
    """Return a quantity (..., n) at some points, with copies of the first of them up to a width."""
    if np.ndim(value) == 0 or value.shape[-1] == 1:
        return value
    some = value[..., rows]
    return _widened(some, width)


def _widened(some: Array, width: int) -> Array:
    """Return an array (..., count) with copies of its first column up to a width."""
    count = some.shape[-1]
    if count == width:
        return some
    wide = np.empty((*some.shape[:-1], width), dtype=some.dtype)
    wide[..., :count], wide[..., count:] = some, some[..., :1]
    return wide


def _loads_at_stations(
    plans: ModuleType,
    sections: BladeSections,
    air: dict[str, Any],
    width: int,
    room: Room,
    kind: np.dtype[Any],
) -> Array:
    """Return the results (results, stations, width) of the plan `section_loads`."""
    r = _stations_first(sections.quadrature.stations, width)
    airfoil = vars(cast(Airfoil, sections.airfoil))
    given = air | {name: _of_stations(airfoil[field], width) for field, name in OF_AIRFOIL.items()}
    shape = len(r), width
    slices = sections.quadrature.slices
    for name, motion in (("tangential_velocity", "ut"), ("axial_velocity", "up")):
        given[name] = _along(air[f"{motion}_0"], slices, shape, kind, air[f"{motion}_1"], r)
    for name, motion in (("radial_velocity", "ur_0"), ("section_spin", "spin")):
        given[name] = _along(air[motion], slices, shape, kind)
    along = sections.along.each(lambda part: _stations_first(part, width))
    given["section_pitch"] = air["pitch"] + along.twist
    given |= {"chord": along.chord, "square_ratio": along.square, "cube_ratio": along.cube}
    if sections.beside_axis:
        turned = along.center * np.cos(given["section_pitch"]), along.center * np.sin(given["section_pitch"])
        given["center_along"], given["center_below"] = turned
    loads = room.array((len(plans.SECTION_LOADS), *shape), kind)
    evaluate(plans.section_loads, given, loads)
    return loads


def _stations_first(value: Array, width: int) -> Array:
    """Return a quantity (stations,) or (n, stations) as an array (stations, 1) or (stations, width)."""
    return value[:, None] if value.ndim == 1 else _widened(np.ascontiguousarray(value.T), width)


def _of_stations(value: Any, width: int) -> Any:
    """Return a number of an airfoil, or an array (1 or n, 1 or stations) of it, with the stations as the first axis."""
    if np.ndim(value) == 0:
        return value
    return value.T if len(value) == 1 else _widened(np.ascontiguousarray(value.T), width)


def _along(
    at_axis: Array,
    slices: list[slice],
    shape: tuple[int, int],
    kind: np.dtype[Any],
    per_radius: Array | None = None,
    r: Array | None = None,
) -> Array:
    """Return a quantity (stations, width) that is linear in r along each segment, or constant."""
    found = np.empty(shape, dtype=kind)
    for segment, own in enumerate(slices):
        if per_radius is None or r is None:
            found[own] = at_axis[segment]
        else:
            np.multiply(per_radius[segment], r[own], out=found[own])
            found[own] += at_axis[segment]
    return found


def _weights(quadrature: RadialQuadrature) -> tuple[Array, list[int]]:
    """Return weights (..., powers of the segments with stations, stations), and which segments have stations.

    A blade among others may have segments without stations, which it would not have alone. They have no rows: then the
    product has the size, and so the order of sums, that it has for the blade alone.
    """
    weights, slices = quadrature.weights, quadrature.slices
    filled = [segment for segment, own in enumerate(slices) if own.start < own.stop]
    *leading, stations, _ = weights.shape
    whole = np.zeros((*leading, POWERS, len(filled), stations), dtype=weights.dtype)
    for place, segment in enumerate(filled):
        whole[..., place, slices[segment]] = weights[..., slices[segment], :].swapaxes(-1, -2)
    return whole.reshape(*leading, -1, stations), filled


def _of_all_segments(found: Array, filled: list[int], segments: int) -> Array:
    """Return moments (loads, powers, segments, n) from those (loads, powers of the filled segments, n)."""
    own = found.reshape(len(found), POWERS, len(filled), -1)
    if len(filled) == segments:
        return own
    whole = np.zeros((len(found), POWERS, segments, own.shape[-1]), dtype=own.dtype)
    whole[:, :, filled] = own
    return whole


def _by_product(sections: BladeSections, loads: Array) -> Array:
    """Return the moments (loads, powers, segments, width) by a product with the weights that all points share."""
    weights, filled = _weights(sections.quadrature)
    return _of_all_segments(weights @ loads, filled, len(sections.quadrature.slices))


def _point_by_point(sections: BladeSections, loads: Array) -> Array:
    """Return the moments (loads, powers, segments, n) by a product with the weights of each point.

    The product has the order of sums of `_by_product`, so that a point has the same bits by either way.
    """
    weights, filled = _weights(sections.quadrature)
    wide = np.zeros((len(weights), weights.shape[-1], _full_width(len(loads))), dtype=loads.dtype)
    wide[..., : len(loads)] = loads.T
    found = np.moveaxis((weights @ wide)[..., : len(loads)], 0, -1).swapaxes(0, 1)
    return _of_all_segments(found, filled, len(sections.quadrature.slices))
