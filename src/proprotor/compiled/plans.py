"""The plans of the derivation for many points by the compiled functions: a blade's balance, and a rotor's matrices."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from proprotor.compiled.columns import Column, address, column
from proprotor.compiled.library import library
from proprotor.typing import Array

_POWERS = 3
_ALONG = (
    "radius",
    "chord",
    "twist",
    "square_ratio",
    "cube_ratio",
    "lift_slope",
    "zero_lift_angle",
    "drag",
    "moment",
)


@cache
def _blade_of(plans: ModuleType) -> type[ctypes.Structure]:
    """Return the type of a blade at many points, see points.h, with the quantities of some plans."""
    fields = (
        ("segments", ctypes.c_ssize_t),
        ("ends", ctypes.c_void_p),
        ("quantities", Column * len(plans.QUANTITIES)),
        *((name, Column) for name in _ALONG),
        ("weights", Column * _POWERS),
    )
    return type("Blade", (ctypes.Structure,), {"_fields_": fields})


class _Layout(ctypes.Structure):
    """Places of the results of a plan in a matrix, see points.h."""

    _fields_ = (("rows", ctypes.c_ssize_t), ("columns", ctypes.c_ssize_t), ("places", ctypes.c_void_p))


class _Search(ctypes.Structure):
    """What is free in a trim and how it is searched, see trim.h."""

    _fields_ = (
        ("count", ctypes.c_ssize_t),
        ("unknowns", ctypes.c_void_p),
        ("rows", ctypes.c_void_p),
        *((name, ctypes.c_int32) for name in ("target", "diagonal", "unloaded", "most", "ends_near")),
        ("load", Column),
        ("structural_offset", Column),
        *((name, _Layout) for name in ("residual", "slopes", "work", "work_slopes", "precone")),
    )


class _Found(ctypes.Structure):
    """Results of a search, see trim.h."""

    _fields_ = tuple(
        (name, ctypes.c_void_p)
        for name in ("state", "before", "first", "last", "work", "moments", "doubts", "iterations", "active")
    )


class _Layouts(ctypes.Structure):
    """All layouts of a rotor, see points.h."""

    _fields_ = (
        ("in_vacuum", _Layout * 4),
        ("of_airloads", _Layout * 3),
        ("segment", _Layout * 4),
    )


class Balanced(NamedTuple):
    """Balance of a blade at n points.

    structure : array (n, results)
        Different results of the plan `balance`.
    work : array (n, results)
        Different results of the plan `work`, summed over the segments.
    moments : array (loads, powers of r, segments, n)
        Radial moments of the section loads.
    doubts : array (2, n, stations) or None
        Angle of attack and Mach number of the stations.
    """

    structure: Array
    work: Array
    moments: Array
    doubts: Array | None


@dataclass(frozen=True)
class Blades:
    """Blades at many points, as `balance_of_blade` and `search_trim` take them.

    quantities : mapping
        Numbers or arrays (n,) by name.
    sides : mapping
        Quantities of the segments, (segments,).
    ends : sequence of int
        The first station of each segment, and one behind the last.
    along : mapping
        Numbers, or arrays (stations,) or (n, stations), of radius, chord, twist, the ratios of chords, and the numbers
        of the airfoil.
    weights : array (stations, 3) or (n, stations, 3)
    """

    quantities: Mapping[str, Any]
    sides: Mapping[str, Array]
    ends: Sequence[int]
    along: Mapping[str, Any]
    weights: Array

    def structure(self, plans: ModuleType) -> tuple[Any, list[Array]]:
        """Return the blades for the library, and the arrays that it points at."""
        blade, kept = _blade(plans, self.quantities, self.sides)
        places = np.array(self.ends, dtype=np.intp)
        kept.append(places)
        blade.ends, blade.segments = places.ctypes.data, len(self.ends) - 1
        for name in _ALONG:
            setattr(blade, name, column(self.along[name], kept))
        for power in range(_POWERS):
            blade.weights[power] = column(self.weights[..., power], kept)
        return blade, kept


@dataclass(frozen=True)
class Search:
    """A search for trims: the free unknowns, the rows that close them, and how it begins and ends.

    unknowns, rows : sequence of int
    target : int
        The row with a load, array (n,) or number.
    structural_offset : array (n,) or number
    diagonal : bool
        Whether springs have no flap-lag stiffness.
    unloaded : bool
        Whether the first step begins without precone.
    ends_near : bool
        Whether points arrive where the next step would be negligible, rather than where a step is.
    most : int
        Number of steps at most.
    """

    unknowns: Sequence[int]
    rows: Sequence[int]
    target: int
    load: Any
    structural_offset: Any
    diagonal: bool
    unloaded: bool
    ends_near: bool
    most: int


class Searched(NamedTuple):
    """Results of a search at n points; those that are NaN belong to points that were not searched.

    A search that ends near the trim has `arrived`, `first` and `last` alone; the rest is None.

    arrived : array (n,)
    before : array (4, n)
        State before the last step.
    first, last : array (2, n, k, k)
        Slopes at the first and the last step: with all of the airloads, and the part of the airloads.
    work : array (n, 5)
        Virtual work of the airloads after the last step.
    moments, doubts
        As in `Balanced`, before the last step.
    """

    arrived: Array
    first: Array
    last: Array
    before: Any = None
    work: Any = None
    moments: Any = None
    doubts: Any = None


def search_trim(
    plans: ModuleType, blades: Blades, search: Search, state: Array, iterations: Array, wanted: Array
) -> Searched:
    """Move states (4, n) of the wanted points (n,) to their trims, and count the steps of each point (n,)."""
    points, k = state.shape[-1], len(search.unknowns)
    blade, kept = blades.structure(plans)
    unknowns, rows = (np.array(places, dtype=np.int32) for places in (search.unknowns, search.rows))
    given = _Search(k, unknowns.ctypes.data, rows.ctypes.data, search.target)
    for name in ("diagonal", "unloaded", "most", "ends_near"):
        setattr(given, name, int(getattr(search, name)))
    for name in ("load", "structural_offset"):
        value = np.asarray(getattr(search, name), dtype=float)
        setattr(given, name, column(value[..., None] if value.ndim else value, kept))
    for name, table in _layouts_of_trim(plans).items():
        setattr(given, name, table)
    arrived = wanted.copy()
    found = Searched(arrived, *np.full((2, 2, points, k, k), np.nan))
    if not search.ends_near:
        found = found._replace(
            before=np.full((4, points), np.nan),
            work=np.full((points, 5), np.nan),
            moments=np.full((len(plans.SECTION_LOADS) - 2, _POWERS, len(blades.ends) - 1, points), np.nan),
            doubts=np.full((2, points, blades.ends[-1]), np.nan),
        )
    parts = found._asdict()
    del parts["arrived"]
    places = {name: array.ctypes.data for name, array in parts.items() if array is not None}
    results = _Found(
        state=state.ctypes.data, iterations=iterations.ctypes.data, active=arrived.ctypes.data, **places
    )
    _function(plans, "search_trim")(
        ctypes.c_ssize_t(points), ctypes.byref(blade), ctypes.byref(given), ctypes.byref(results)
    )
    return found


def balance_of_blade(
    plans: ModuleType,
    points: int,
    blades: Blades,
    doubts: bool,
) -> Balanced:
    """Return the balance of a blade at trim states.

    Parameters
    ----------
    plans : module
        The fused functions of the rotor.
    points : int
    blades : Blades
    doubts : bool
        Whether to return angles of attack and Mach numbers.
    """
    blade, kept = blades.structure(plans)
    structure = np.empty((points, len(_results(plans.BALANCE))))
    work = np.empty((points, len(_results(plans.WORK))))
    moments = np.empty((len(plans.SECTION_LOADS) - 2, _POWERS, len(blades.ends) - 1, points))
    found = np.empty((2, points, blades.ends[-1])) if doubts else None
    _function(plans, "balance_of_blade")(
        ctypes.c_ssize_t(points),
        ctypes.byref(blade),
        *map(address, (structure, work, moments)),
        None if found is None else address(found),
    )
    del kept
    return Balanced(structure, work, moments, found)


def matrices_of_rotor(
    plans: ModuleType,
    points: int,
    quantities: Mapping[str, Any],
    segments: Mapping[str, Any] | None,
    shapes: Mapping[str, tuple[int, int]],
) -> dict[str, Array]:
    """Return M, C, K and B (n, rows, columns) of a rotor from its quantities and those of its segments in the air."""
    blade, kept = _blade(plans, quantities, segments or {})
    blade.segments = 0 if segments is None else len(segments["beyond_flap_hinge"])
    found = {name: np.empty((points, *shape)) for name, shape in shapes.items()}
    addresses = (ctypes.c_void_p * len(found))(*(matrix.ctypes.data for matrix in found.values()))
    _function(plans, "matrices_of_rotor")(
        ctypes.c_ssize_t(points), ctypes.byref(blade), ctypes.byref(_layouts(plans)), ctypes.byref(addresses)
    )
    del kept
    return found


def _function(plans: ModuleType, name: str) -> Any:
    """Return a function of the library for some plans."""
    return getattr(library(), f"{plans.__name__.rpartition('.')[2]}_{name}")


def _blade(
    plans: ModuleType, quantities: Mapping[str, Any], segments: Mapping[str, Any]
) -> tuple[Any, list[Array]]:
    """Return a blade with its quantities, and the arrays that it points at."""
    blade, kept = _blade_of(plans)(), list[Array]()
    for place, name in enumerate(plans.QUANTITIES):
        if name in segments:
            value = np.asarray(segments[name], dtype=float)
            blade.quantities[place] = column(value, kept)
        elif name in quantities:
            value = np.asarray(quantities[name], dtype=float)
            blade.quantities[place] = column(value[..., None] if value.ndim else value, kept)
    return blade, kept


@cache
def _layouts(plans: ModuleType) -> _Layouts:
    rotor, airloads, segment = plans.IN_VACUUM, plans.OF_AIRLOADS, plans.SEGMENT
    found = _Layouts()
    for of, tables in (("in_vacuum", rotor), ("of_airloads", airloads), ("segment", segment)):
        for place, table in enumerate(tables.values()):
            getattr(found, of)[place] = _layout(table)
    return found


@cache
def _layouts_of_trim(plans: ModuleType) -> dict[str, _Layout]:
    tables = {
        "residual": plans.BALANCE,
        "slopes": plans.BALANCE,
        "work": plans.WORK,
        "work_slopes": plans.WORK,
    }
    found = {name: _layout(table[name]) for name, table in tables.items()}
    (precone,) = plans.PRECONE_LOAD.values()
    return found | {"precone": _layout(precone)}


_TABLES: list[Array] = []  # stay in memory with the layouts


def _layout(table: Sequence[Sequence[int]]) -> _Layout:
    places = np.array(table, dtype=np.int32)
    _TABLES.append(places)
    return _Layout(*places.shape, places.ctypes.data)


def _results(table: Mapping[str, Sequence[Sequence[int]]]) -> range:
    """Return the numbers of the different results of a plan."""
    return range(max(abs(number) for rows in table.values() for row in rows for number in row))
