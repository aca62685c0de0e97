"""The plans of the derivation for many points by the compiled functions: a blade's balance, and a rotor's matrices."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from proprotor.compiled.columns import address, place_of, start_of
from proprotor.compiled.library import library
from proprotor.typing import Array

POWERS = 3
_ALONG = (
    *("radius", "chord", "twist", "bent", "square_ratio", "cube_ratio"),
    *("lift_slope", "zero_lift_angle", "drag", "moment"),
)
OF_POINTS = ("tip", "load", "collective", "structural_offset")
_FIRST_STATIONS, FIRST_POINTS = (
    2,
    2 + 3 * (len(_ALONG) + POWERS),
)  # words of the record of blades, see points.h


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
class Stations:
    """Stations of blades in memory: the first of each segment and one behind the last, a column for each quantity."""

    ends: Array
    columns: Array
    kept: list[Array]

    @classmethod
    def of(cls, ends: Sequence[int], along: Mapping[str, Any], weights: Array) -> Stations:
        """Return stations.

        Parameters
        ----------
        ends : sequence of int
        along : mapping
            Numbers, or arrays (stations,) or (n, stations), of radius, chord, twist, what an effective twist leaves
            out, the ratios of chords, and the numbers of the airfoil.
        weights : array (stations, 3) or (n, stations, 3)
        """
        kept = [np.asarray(along[name], dtype=float) for name in _ALONG]
        kept += [np.asarray(weights[..., power], dtype=float) for power in range(POWERS)]
        columns = np.array([place_of(array) for array in kept], dtype=np.intp)
        return cls(np.array(ends, dtype=np.intp), columns, kept)


@dataclass(frozen=True)
class Blades:
    """Blades at many points, as `balance_of_blade` and `search_trim` take them.

    quantities : mapping
        Numbers or arrays (n,) by name.
    sides : mapping
        Quantities of the segments, (segments,).
    stations : Stations
    of_points : mapping
        Numbers or arrays (n,): radius of the tip, and for a search the load of the row that closes the trim, a given
        collective, and the offset of the structural pitch.
    """

    quantities: Mapping[str, Any]
    sides: Mapping[str, Array]
    stations: Stations
    of_points: Mapping[str, Any]

    def record(self, plans: ModuleType) -> tuple[Array, list[Array]]:
        """Return the blades as the library takes them, see points.h, and the arrays that the record points at."""
        names = (*OF_POINTS, *plans.QUANTITIES)
        columns, kept = _columns(names, {**self.quantities, **self.of_points}, self.sides)
        record = np.empty(FIRST_POINTS + columns.size, dtype=np.intp)
        record[0], record[1] = len(self.stations.ends) - 1, start_of(self.stations.ends)
        record[_FIRST_STATIONS:FIRST_POINTS] = self.stations.columns.ravel()
        record[FIRST_POINTS:] = columns.ravel()
        return record, kept


def _columns(
    names: Sequence[str], quantities: Mapping[str, Any], segments: Mapping[str, Any]
) -> tuple[Array, list[Array]]:
    """Return columns (names, 3) of quantities, numbers or arrays (n,), and of segments, and what they point at.

    Numbers stand side by side in an array of their own. A quantity that is missing is zero.
    """
    numbers, arrays = [0.0] * len(names), dict[int, Array]()
    for place, name in enumerate(names):
        value = segments[name] if name in segments else quantities.get(name, 0.0)
        if type(value) is float:  # as most are: to ask about arrays takes longer
            numbers[place] = value
        elif np.ndim(value):
            array = np.asarray(value, dtype=float)
            arrays[place] = array if name in segments else array[..., None]
        else:
            numbers[place] = float(value)
    memory = np.array(numbers)
    columns = _side_by_side(len(names)).copy()
    columns[:, 0] += start_of(memory)
    for place, array in arrays.items():
        columns[place] = place_of(array)
    return columns, [memory, *arrays.values()]


@cache
def _side_by_side(count: int) -> Array:
    """Return columns (count, 3) of numbers that all points share, from the place of the first of them on."""
    columns = np.zeros((count, 3), dtype=np.intp)
    columns[:, 0] = np.dtype(float).itemsize * np.arange(count)
    return columns


@dataclass(frozen=True)
class Search:
    """A search for trims: the free unknowns, the rows that close them, and how it begins and ends.

    unknowns, rows : tuple of int
    target : int
        The row with a load.
    diagonal : bool
        Whether springs have no flap-lag stiffness.
    unloaded : bool
        Whether the first step begins without precone.
    ends_near : bool
        Whether points arrive where the next step would be negligible, rather than where a step is.
    most : int
        Number of steps at most.
    """

    unknowns: tuple[int, ...]
    rows: tuple[int, ...]
    target: int
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
    record, kept = blades.record(plans)
    segments, stations = len(blades.stations.ends) - 1, int(blades.stations.ends[-1])
    arrived = wanted.copy()
    found = Searched(arrived, *np.full((2, 2, points, k, k), np.nan))
    if not search.ends_near:
        found = found._replace(
            before=np.full((4, points), np.nan),
            work=np.full((points, 5), np.nan),
            moments=np.full((len(plans.SECTION_LOADS) - 2, POWERS, segments, points), np.nan),
            doubts=np.full((2, points, stations), np.nan),
        )
    parts = found._asdict()
    del parts["arrived"]
    places = {name: start_of(array) for name, array in parts.items() if array is not None}
    results = _Found(
        state=start_of(state), iterations=start_of(iterations), active=start_of(arrived), **places
    )
    function_of(plans, "search_trim")(
        ctypes.c_ssize_t(points),
        address(record),
        ctypes.byref(search_of(plans, search)),
        ctypes.byref(results),
    )
    del kept
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
    record, kept = blades.record(plans)
    structure = np.empty((points, len(_results(plans.BALANCE))))
    work = np.empty((points, len(_results(plans.WORK))))
    moments = np.empty((len(plans.SECTION_LOADS) - 2, POWERS, len(blades.stations.ends) - 1, points))
    found = np.empty((2, points, int(blades.stations.ends[-1]))) if doubts else None
    function_of(plans, "balance_of_blade")(
        ctypes.c_ssize_t(points),
        *map(address, (record, structure, work, moments)),
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
    columns, kept = _columns(plans.QUANTITIES, quantities, segments or {})
    record = np.zeros(FIRST_POINTS + 3 * len(OF_POINTS) + columns.size, dtype=np.intp)
    record[0] = 0 if segments is None else len(segments["beyond_flap_hinge"])
    record[-columns.size :] = columns.ravel()
    found = {name: np.empty((points, *shape)) for name, shape in shapes.items()}
    addresses = (ctypes.c_void_p * len(found))(*map(start_of, found.values()))
    function_of(plans, "matrices_of_rotor")(
        ctypes.c_ssize_t(points), address(record), ctypes.byref(layouts_of(plans)), ctypes.byref(addresses)
    )
    del kept
    return found


def function_of(plans: ModuleType, name: str) -> Any:
    """Return a function of the library for some plans."""
    return getattr(library(), f"{plans.__name__.rpartition('.')[2]}_{name}")


@cache
def search_of(plans: ModuleType, search: Search) -> _Search:
    """Return a search as the library takes it."""
    unknowns, rows = (np.array(places, dtype=np.int32) for places in (search.unknowns, search.rows))
    _TABLES.extend((unknowns, rows))
    found = _Search(len(search.unknowns), start_of(unknowns), start_of(rows), search.target)
    for name in ("diagonal", "unloaded", "most", "ends_near"):
        setattr(found, name, int(getattr(search, name)))
    for name, table in _layouts_of_trim(plans).items():
        setattr(found, name, table)
    return found


@cache
def layouts_of(plans: ModuleType) -> _Layouts:
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
    return _Layout(*places.shape, start_of(places))


def _results(table: Mapping[str, Sequence[Sequence[int]]]) -> range:
    """Return the numbers of the different results of a plan."""
    return range(max(abs(number) for rows in table.values() for row in rows for number in row))
