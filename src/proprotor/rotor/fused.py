"""Matrices of a whole rotor by the fused functions, for batches and for one point.

A fused function is one plan of operations with two renderings. Arrays of a batch go through the plan in blocks of
points, so that all temporaries stay in the cache. Plain numbers of one point go through the same lines of the plan as
Python floats, or as complex numbers for derivatives by a complex step.

A trim has matrices of the same bits in every batch, and as one point: Python and NumPy add and multiply alike, and
both renderings take the sines of NumPy. Complex numbers agree to rounding.

There are plans for plain rotors, without linkages and drive train, plans for rotors with them, and plans for rotors
with masses or aerodynamic centres beside the pitch axis. `plans_of` takes those for plain rotors where each quantity
that a plain rotor has not is the plain number zero. An array goes with the plans for other rotors, whatever it holds:
so a design has the same bits in every batch that varies the same quantities. The bits of a design whose linkage is zero
in an array differ by rounding from those of the rotor without a linkage.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from types import ModuleType
from typing import Any

import numpy as np
from proprotor_equations.fused import plain

from proprotor.compiled import plans as compiled_plans
from proprotor.rotor.generated import EQUATION_SETS, EquationSet, evaluate, keywords
from proprotor.rotor.section_loads import LOAD_MOMENTS
from proprotor.typing import Array

_BLOCK = 1024  # points
_APART = 8  # places in memory
Quantities = Mapping[str, Any]
Matrices = dict[str, Array]


def serves(equations: EquationSet) -> bool:
    """Return whether the fused functions hold these equations."""
    return equations == EQUATION_SETS["consistent"]


def plans_of(quantities: Quantities) -> ModuleType:
    """Return the fused functions for a rotor with these quantities: those for plain rotors, or for others."""
    if quantities.get("beside_axis"):
        return _offset()
    for name in plain.ABSENT:
        value = quantities.get(name, 0.0)
        if not (isinstance(value, float | int) and value == 0):
            return _general()
    return _PLAIN


def have_c(plans: ModuleType) -> bool:
    """Return whether there are the same plans in C: those for rotors with something beside the pitch axis have none."""
    return hasattr(plans, "QUANTITIES")


_PLAIN: ModuleType = plain


def _general() -> ModuleType:
    """Return the fused functions for rotors with linkages and the like, imported here because few rotors need them."""
    from proprotor_equations.fused import general

    found: ModuleType = general
    return found


def _offset() -> ModuleType:
    """Return the fused functions for rotors with something beside the pitch axis, imported here as the general ones."""
    from proprotor_equations.fused import offset

    found: ModuleType = offset
    return found


@cache
def of_segments(plans: ModuleType) -> tuple[str, ...]:
    """Return the names of the quantities of a segment that the plans take."""
    known = keywords(plans.segment)
    return tuple(name for name in ("beyond_flap_hinge", "beyond_lag_hinge", *LOAD_MOMENTS) if name in known)


def effective_stiffness(quantities: Quantities) -> dict[str, Any]:
    """Return the springs of hub and blade in series and their derivatives with structural pitch, by name."""
    plans = plans_of(quantities)
    names = keywords(plans.effective_stiffness)
    numbers = all(isinstance(quantities[name], float) for name in names)
    waves = (_cos, _sin) if numbers else (np.cos, np.sin)
    results = evaluate(plans.effective_stiffness, quantities, *waves)
    return dict(zip(plans.EFFECTIVE_STIFFNESS, results, strict=True))


def trim_integrals(quantities: Quantities) -> dict[str, Any]:
    """Return the mass integrals of the deflected blade and the waves of its angles, by name."""
    plans = plans_of(quantities)
    results = evaluate(plans.trim_integrals, quantities, np.cos, np.sin)
    return dict(zip(plans.TRIM_INTEGRALS, results, strict=True))


def rotor_matrices(
    quantities: Quantities,
    segments: Quantities | None,
    points: int,
    one: bool = False,
    compiled: bool = False,
) -> Matrices:
    """Return M, C, K (points, 18, 18) and B (points, 18, 6) of a rotor.

    Parameters
    ----------
    quantities : mapping
        Quantities of the blade by name, numbers or arrays (points,).
    segments : mapping, optional
        Quantities of each segment, numbers or arrays with a last axis of segments. A rotor without airloads has none.
    points : int
        Number of points.
    one : bool
        Compute the only point with plain numbers.
    """
    plans = plans_of(quantities)
    blade = {name: quantities[name] for name in _names(plans, segments is not None) if name in quantities}
    along = None if segments is None else {name: segments[name] for name in of_segments(plans)}
    if compiled and have_c(plans):
        return compiled_plans.matrices_of_rotor(plans, points, blade, along, shapes_of(plans))
    return _one_point(plans, blade, along) if one else _batch(plans, blade, along, points)


def mass_at_trim(quantities: Quantities, places: Sequence[int]) -> Array:
    """Return rows and columns of M (..., k, k) of a rotor without engine: the mass matrix of some coordinates.

    Parameters
    ----------
    quantities : mapping
        Numbers or arrays (...) of the rotor and its trim, with the integrals that follow from it. What M does not
        depend on, such as springs, may be missing.
    places : sequence of int
        Places of the coordinates.
    """
    plans = plans_of(quantities)
    given = dict.fromkeys(_names(plans, False), 0.0) | dict(quantities)
    layout = _layout(plans, "in_vacuum")
    values = values_of(evaluate(plans.in_vacuum, given, np.cos, np.sin), layout)
    wanted = layout.places["M"][np.ix_(places, places)]
    different, order = np.unique(wanted, return_inverse=True)
    return np.stack(np.broadcast_arrays(*(values[place] for place in different)), axis=-1)[
        ..., order.reshape(wanted.shape)
    ]


@cache
def shapes_of(plans: ModuleType) -> Mapping[str, tuple[int, int]]:
    """Return rows and columns of M, C, K and B."""
    return {name: places.shape for name, places in _layout(plans, "in_vacuum").places.items()}


@cache
def _names(plans: ModuleType, in_air: bool) -> tuple[str, ...]:
    """Return the names of the quantities that the fused functions take."""
    functions = (plans.in_vacuum, plans.of_airloads, plans.segment) if in_air else (plans.in_vacuum,)
    return tuple(dict.fromkeys(name for function in functions for name in keywords(function)))


@dataclass(frozen=True, eq=False)
class Layout:
    """Where the results of a plan stand in its matrices.

    opposite : places of the results whose negative is needed as well, counted from 1.
    places : by the name of a matrix, the place of each entry among zero, the results, and the negatives.
    """

    opposite: list[int]
    places: dict[str, Array]

    @cached_property
    def at_once(self) -> tuple[Array, list[tuple[str, slice, tuple[int, ...]]]]:
        """The places of all entries, and which of them are those of each matrix, with its shape."""
        ends = np.cumsum([0, *(places.size for places in self.places.values())]).tolist()
        parts = [
            (name, slice(start, end), places.shape)
            for (name, places), start, end in zip(self.places.items(), ends, ends[1:], strict=False)
        ]
        return np.concatenate([places.ravel() for places in self.places.values()]), parts

    @classmethod
    def of(cls, table: Mapping[str, Sequence[Sequence[int]]]) -> Layout:
        """Return the layout of a table, in which n is the n-th result, -n its negative and 0 is zero."""
        signed = {name: np.array(rows) for name, rows in table.items()}
        every = np.concatenate([rows.ravel() for rows in signed.values()])
        opposite = np.unique(-every[every < 0])
        behind = 1 + np.abs(every).max() + np.arange(len(opposite))
        places = {}
        for name, rows in signed.items():
            places[name] = rows.copy()
            negative = rows < 0
            places[name][negative] = behind[np.searchsorted(opposite, -rows[negative])]
        return cls(opposite.tolist(), places)


@cache
def _layout(plans: ModuleType, name: str) -> Layout:
    """Return the layout of the results of a plan."""
    return Layout.of(getattr(plans, name.upper()))


# Batches


def _batch(plans: ModuleType, quantities: Quantities, segments: Quantities | None, points: int) -> Matrices:
    """Return the matrices of many points, a block of points at a time."""
    numbers = (*quantities.values(), *(segments or {}).values())
    kind = np.result_type(float, *(np.asarray(number).dtype for number in numbers))
    layout = _layout(plans, "in_vacuum") if segments is None else _sums(plans)
    found = _empty(layout, points, kind)
    for start in range(0, points, _BLOCK):
        rows = slice(start, min(start + _BLOCK, points))
        count = rows.stop - start
        here = {name: _of_rows(value, rows) for name, value in quantities.items()}
        values = values_of(evaluate(plans.in_vacuum, here, np.cos, np.sin), _layout(plans, "in_vacuum"))
        if segments is not None:
            along = {name: _segments_first(value, rows) for name, value in segments.items()}
            values = _with_airloads(plans, values, _of_airloads(plans, here, along, count, kind))
        pool = pool_of(values, (count,), kind)
        for name, places in layout.places.items():
            np.take(pool, places, axis=1, out=found[name][rows], mode="clip")
    return found


def _empty(layout: Layout, points: int, kind: np.dtype[Any]) -> Matrices:
    """Return matrices for the entries of a layout, in one piece of memory."""
    sizes = [points * places.size for places in layout.places.values()]
    parts = np.split(np.empty(sum(sizes), dtype=kind), np.cumsum(sizes)[:-1])
    return {
        name: part.reshape(points, *places.shape)
        for part, (name, places) in zip(parts, layout.places.items(), strict=True)
    }


@cache
def _pairs(plans: ModuleType) -> tuple[list[list[int]], dict[str, Array]]:
    """Return the different pairs of results that add up to entries, and which pair stands at each entry.

    A pair has a place among the values of the rotor without airloads, and a place among those of the airloads.
    """
    places = [_layout(plans, name).places for name in ("in_vacuum", "of_airloads")]
    pairs = {
        name: np.stack([own, places[1].get(name, np.zeros_like(own))], axis=-1)
        for name, own in places[0].items()
    }
    every = np.concatenate([pair.reshape(-1, 2) for pair in pairs.values()])
    found, order = np.unique(every, axis=0, return_inverse=True)
    parts = np.split(order.ravel(), np.cumsum([pair.size // 2 for pair in pairs.values()])[:-1])
    shaped = {name: part.reshape(pairs[name].shape[:-1]) for name, part in zip(pairs, parts, strict=True)}
    return found.tolist(), shaped


@cache
def _sums(plans: ModuleType) -> Layout:
    """Return the layout of the sums of the pairs."""
    return Layout([], _pairs(plans)[1])


def _with_airloads(plans: ModuleType, values: Sequence[Any], results: Sequence[Any]) -> list[Any]:
    """Return the sum of each pair of values without airloads and of airloads."""
    added = values_of(results, _layout(plans, "of_airloads"))
    return [values[one] + added[other] if other else values[one] for one, other in _pairs(plans)[0]]


def _of_rows(value: Any, rows: slice) -> Any:
    """Return a quantity at some points; what is one number for all points stays one."""
    return value[rows] if np.ndim(value) and len(value) > 1 else value


def _segments_first(value: Any, rows: slice) -> Any:
    """Return a quantity of the segments at some points as an array (segments, points), or (segments, 1)."""
    if np.ndim(value) == 0:
        return value
    some = value[rows] if np.ndim(value) > 1 and len(value) > 1 else np.atleast_2d(value)
    return np.ascontiguousarray(some.T)


def _of_airloads(
    plans: ModuleType, quantities: Quantities, segments: Quantities, points: int, kind: np.dtype[Any]
) -> tuple[Any, ...]:
    """Return the results of the plan `of_airloads`."""
    layout = _layout(plans, "segment")
    count = len(segments["beyond_flap_hinge"])
    results = evaluate(plans.segment, {**quantities, **segments}, np.cos, np.sin)
    pool = pool_of(values_of(results, layout), (count, points), kind)
    arrays = {name: np.take(pool, places, axis=2) for name, places in layout.places.items()}
    work = _work(arrays).reshape(points, -1)
    geometric = arrays["geometric_stiffness"].sum(axis=1).reshape(points, -1)
    groups = (np.ascontiguousarray(part.T) for part in (work, geometric))
    found: tuple[Any, ...] = evaluate(plans.of_airloads, quantities, *groups)
    return found


def _work(arrays: Mapping[str, Array]) -> Array:
    """Return W^T L U of segments (..., segments, rows, columns), summed over the segments."""
    virtual, derivatives, motion = (arrays[name] for name in ("virtual_motion", "load_derivatives", "motion"))
    loads = derivatives @ motion
    together = (*virtual.shape[:-3], virtual.shape[-3] * virtual.shape[-2], -1)
    return np.asarray(np.swapaxes(virtual.reshape(together), -1, -2) @ loads.reshape(together))


def values_of(results: Sequence[Any], layout: Layout) -> list[Any]:
    """Return zero, the results and their negatives as a layout counts them."""
    return [0.0, *results, *(-results[place - 1] for place in layout.opposite)]


def pool_of(values: Sequence[Any], shape: tuple[int, ...], kind: np.dtype[Any]) -> Array:
    """Return values as one array, with the axes of the shape in reverse and a last axis of values.

    Between two values stay a few places: a power of two from one to the next would put all into one place of the cache.
    """
    pool = np.empty((len(values), *shape[:-1], shape[-1] + _APART), dtype=kind)[..., : shape[-1]]
    for place, value in enumerate(values):
        pool[place] = value
    return np.ascontiguousarray(pool.T)


# One point


def _one_point(plans: ModuleType, quantities: Quantities, segments: Quantities | None) -> Matrices:
    """Return the matrices of one point by plain numbers, with an axis of one point."""
    blade = {name: plain_number(value) for name, value in quantities.items()}
    layout = _layout(plans, "in_vacuum")
    values = values_of(evaluate(plans.in_vacuum, blade, _cos, _sin), layout)
    if segments is None:
        return _matrices([values], layout)
    of_segments = _layout(plans, "segment")
    rows = [
        values_of(evaluate(plans.segment, {**blade, **here}, _cos, _sin), of_segments)
        for here in _one_by_one(segments)
    ]
    arrays = _matrices(rows, of_segments)
    geometric = np.add.reduce(arrays["geometric_stiffness"], axis=0).ravel().tolist()
    results = evaluate(plans.of_airloads, blade, _work(arrays).ravel().tolist(), geometric)
    return _matrices([_with_airloads(plans, values, results)], _sums(plans))


def _cos(angle: complex) -> Any:
    """Return NumPy's cosine as a plain number."""
    return np.cos(angle).item()


def _sin(angle: complex) -> Any:
    """Return NumPy's sine as a plain number."""
    return np.sin(angle).item()


def plain_number(value: Any) -> Any:
    """Return an array of one number, or a number of NumPy, as a plain number."""
    if type(value) is float:  # as most are: to ask about arrays takes longer
        return value
    return value.item() if isinstance(value, np.ndarray | np.generic) else value


def _one_by_one(segments: Quantities) -> list[dict[str, Any]]:
    """Return the quantities of each segment as plain numbers."""
    count = np.size(segments["beyond_flap_hinge"])
    lists = [
        value.ravel().tolist()
        if isinstance(value, np.ndarray) and value.ndim
        else [plain_number(value)] * count
        for value in segments.values()
    ]
    return [dict(zip(segments, numbers, strict=True)) for numbers in zip(*lists, strict=True)]


def _matrices(rows: Sequence[Sequence[Any]], layout: Layout) -> Matrices:
    """Return the matrices (rows, ...) of some rows of values as the layout counts them."""
    every, parts = layout.at_once
    entries, count = np.array(rows).take(every, axis=1), len(rows)
    return {name: entries[:, part].reshape(count, *shape) for name, part, shape in parts}
