"""The whole rotor as plans of operations, from the same functions of the catalogue as the readable modules.

Nothing is derived here. `in_vacuum` is the rotor without airloads. With airloads there are three parts: `segment` makes
the arrays of a segment, a product of these arrays summed over the segments gives the work of the airloads, and
`in_air` makes the rotor with this work.

The columns of W and U are not independent: a gimbal tilt is a turn of the hub with another pitch, the azimuth is a turn,
and a gust is the hub's motion seen from the air. Only independent columns are multiplied, and `in_air` combines them.
"""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import cast

import sympy as sp

from derive import airloads, multiblade
from derive import kinematics as kin
from derive.coordinates import SEGMENT_LOADS, SEGMENT_MOTIONS, names
from derive.equations import consistent_functions
from derive.function import Function
from derive.plan import Entries, Matrix, Place, Plan, Results, Steps, plan
from derive.rotor import Assembly, Call, Code
from derive.symbols import QUANTITIES

Combination = dict[str, sp.Expr]  # independent columns, and how much of each makes a column
Blade = dict[str, dict[Place, sp.Expr]]  # entries of the matrices of one blade by name

_BASES = {
    base.label.name: base
    for base in (multiblade.MASS, multiblade.DAMPING, multiblade.STIFFNESS, multiblade.GUSTS)
}
_INDEX = multiblade.BLADE_INDEX | multiblade.GUST_INDEX
_SIDE = {"_beside(swashplate, gust)": ("swashplate", "gust")}
# Motions whose rates or sizes U takes; the product of the readable functions names each.
_MOTIONS = ("rate_motion", "displacement_motion", "gust_motion")


@dataclass(frozen=True)
class Group:
    """Numbers that a fused function takes together, in their order."""

    name: str
    meaning: str
    members: tuple[str, ...]


@dataclass(frozen=True)
class FusedFunction:
    """A plan with its name, summary and arguments, groups of numbers first."""

    name: str
    summary: str
    plan: Plan
    arguments: list[sp.Symbol]
    groups: tuple[Group, ...] = ()


def _function(module: str, name: str) -> Function:
    return next(function for function in consistent_functions(module) if function.name == name)


def _values(function: Function) -> dict[Place, sp.Expr]:
    return {place: entry.value for place, entry in function.entries.items()}


# Arrays of a segment


@dataclass(frozen=True)
class Columns:
    """Columns of W or U: the independent ones with their entries, and every column as a combination of these."""

    entries: dict[Place, sp.Expr]
    independent: tuple[str, ...]
    combinations: dict[str, Combination]


def _columns(function: Function, known: Columns | None = None) -> Columns:
    """Find independent columns, among those of `known` if there are any."""
    values = _values(function)
    own = [column for column in function.columns if any(place[1] == column for place in values)]
    found = dict(known.entries) if known else {}
    independent = list(known.independent) if known else []
    combinations = {}
    # A column that is one row, such as the pitch, is told first: others are made of it.
    for column in sorted(own, key=lambda name: _height(values, name) > 1):
        this = {row: value for (row, other), value in values.items() if other == column}
        combination = _combination(this, found, independent)
        if combination is None:
            combination = {column: sp.Integer(1)}
            independent.append(column)
            found |= {(row, column): value for row, value in this.items()}
        combinations[column] = combination
    return Columns(found, tuple(independent), combinations)


def _height(values: Entries, column: str) -> int:
    return sum(place[1] == column for place in values)


def _combination(
    column: Mapping[str, sp.Expr], entries: Entries, independent: Iterable[str]
) -> Combination | None:
    """Return the column as plus or minus another, with a multiple of one that has a single row, 1; None otherwise."""
    single = {
        next(row for row, other in entries if other == name): name
        for name in independent
        if _height(entries, name) == 1
    }
    for name in independent:
        other = {row: value for (row, by), value in entries.items() if by == name}
        for sign in (1, -1):
            rows = column.keys() | other.keys()
            rest = {row: sp.expand(column.get(row, 0) - sign * other.get(row, 0)) for row in rows}
            rest = {row: value for row, value in rest.items() if value != 0}
            if not rest:
                return {name: sp.Integer(sign)}
            (row, value), *more = rest.items()
            if not more and row in single and single[row] != name and _of_the_blade(value):
                return {name: sp.Integer(sign), single[row]: value / entries[row, single[row]]}
    return None


def _of_the_blade(value: sp.Expr) -> bool:
    """Say whether a value is the same on all segments of a blade."""
    geometry = {symbol for symbol, _ in airloads.segment_geometry()}
    return not value.free_symbols & (geometry | {kin.beyond_flap_hinge, kin.beyond_lag_hinge})


@functools.cache
def _virtual() -> Columns:
    return _columns(_function("airloads", "virtual_motion"))


@functools.cache
def _motions() -> dict[str, tuple[str, Columns]]:
    """Columns of U by the names of the functions, each with a prefix that its independent columns have in the product."""
    rate = _columns(_function("airloads", "rate_motion"))
    gust = _columns(_function("airloads", "gust_motion"), rate)
    displacement = _columns(_function("airloads", "displacement_motion"))
    if gust.independent != rate.independent:
        raise ValueError("gusts move the air along a segment as no motion of the blade does")
    return {
        "rate_motion": ("rate", rate),
        "gust_motion": ("rate", gust),
        "displacement_motion": ("change", displacement),
    }


@functools.cache
def _moving() -> Matrix:
    """U of the independent motions, rates beside displacements."""
    _, rate = _motions()["rate_motion"]
    _, change = _motions()["displacement_motion"]
    entries = {(row, f"rate_{column}"): value for (row, column), value in rate.entries.items()}
    entries |= {(row, f"change_{column}"): value for (row, column), value in change.entries.items()}
    columns = [f"rate_{name}" for name in rate.independent] + [
        f"change_{name}" for name in change.independent
    ]
    return Matrix(names(SEGMENT_MOTIONS), tuple(columns), entries)


@functools.cache
def _geometric() -> tuple[Matrix, dict[Place, sp.Expr]]:
    """G of a segment: its different entries as a column, and each entry as one of these with its sign."""
    function = _function("airloads", "geometric_stiffness")
    results = Results()
    layout = results.layout("geometric", Matrix(function.rows, function.columns, _values(function)))
    different = list(results.named)
    entries = {
        (row, column): sp.sign(number) * sp.Symbol(different[abs(number) - 1], real=True)
        for row, numbers in zip(function.rows, layout, strict=True)
        for column, number in zip(function.columns, numbers, strict=True)
        if number
    }
    column = {(name, "segment"): value for name, value in results.named.items()}
    return Matrix(tuple(different), ("segment",), column), entries


def segment() -> FusedFunction:
    """Arrays of one segment: W, L and U of the independent motions, and G."""
    loads = names(SEGMENT_LOADS)
    geometry = _function("airloads", "segment_geometry").steps
    matrices = {
        "virtual_motion": Matrix(loads, _virtual().independent, _virtual().entries),
        "load_derivatives": Matrix(
            loads, names(SEGMENT_MOTIONS), _values(_function("airloads", "load_derivatives"))
        ),
        "motion": _moving(),
    }
    return _fused("segment", geometry, matrices | {"geometric_stiffness": _geometric()[0]}, segment)


# The blade


def _work(row: str, column: str) -> sp.Symbol:
    """Work of the airloads on an independent row per unit of an independent motion, W^T L U of all segments."""
    return sp.Symbol(f"{row}_{column}", real=True)


def _air(product: sp.MatrixExpr) -> dict[Place, sp.Expr]:
    """Entries of a product of the arrays of the segments."""
    found: dict[Place, sp.Expr] = {}
    for term in sp.MatAdd.make_args(product):
        factor, matrices = term.as_coeff_matrices()
        last = matrices[-1].name
        entries = _geometric()[1] if last == "geometric_stiffness" else _work_entries(last)
        for place, value in entries.items():
            found[place] = found.get(place, sp.Integer(0)) + factor * value
    return found


def _work_entries(motion: str) -> dict[Place, sp.Expr]:
    prefix, columns = _motions()[motion]
    return {
        (row, column): sum(
            (
                left * right * _work(name, f"{prefix}_{other}")
                for name, left in _virtual().combinations[row].items()
                for other, right in columns.combinations[column].items()
            ),
            sp.Integer(0),
        )
        for row in _virtual().combinations
        for column in columns.combinations
    }


def _blade(airloads_too: bool) -> tuple[list[tuple[sp.Symbol, sp.Expr]], Blade]:
    """Return the named values and the entries of one blade's matrices, as `rotor.blade_matrices` puts them together."""
    steps: list[tuple[sp.Symbol, sp.Expr]] = []
    blade: Blade = {}
    for line in cast(Assembly, _function("rotor", "blade_matrices")).lines:
        entries: dict[Place, sp.Expr] = {}
        for term in line.terms:
            if isinstance(term, Call) and isinstance(term.function, Assembly):
                continue
            if isinstance(term, Call):
                steps += term.function.steps
                more = _values(term.function)
            else:
                more = _named_air(term, steps) if airloads_too else {}
            for place, value in more.items():
                entries[place] = entries.get(place, sp.Integer(0)) + value
        blade[line.result] = entries
    return steps, blade


def _named_air(term: Code, steps: list[tuple[sp.Symbol, sp.Expr]]) -> dict[Place, sp.Expr]:
    """Return the airloads' entries of one of the blade's matrices; one that is a sum becomes a step with a name."""
    name = term.removeprefix("air.")
    product = _function("airloads", {"gusts": "gust_loads"}.get(name, name)).product
    found = {}
    for (row, column), value in _air(cast(sp.MatrixExpr, product)).items():
        if value.is_Add:
            symbol = sp.Symbol(f"air_{name}_{row}_{column}", real=True)
            steps.append((symbol, value))
            value = symbol
        found[row, column] = value
    return found


# The rotor


def _fixed_frame(blade: Blade) -> dict[str, Matrix]:
    """Sum over the blades as `rotor.fixed_frame` does."""
    entries = {
        base[_INDEX[row], _INDEX[column]]: blade[name].get((row, column), sp.Integer(0))
        for name, base in _BASES.items()
        for row in kin.COORDINATES
        for column in (multiblade.GUST_INDEX if name == "gusts" else kin.COORDINATES)
    }
    matrices: dict[str, Matrix] = {}
    assembly = cast(Assembly, _function("rotor", "fixed_frame"))
    for line in assembly.lines:
        first = line.terms[0]
        if isinstance(first, Code):
            left, right = (matrices[name] for name in _SIDE[first])
            both = {**left.entries, **right.entries}
            matrices[line.result] = Matrix(left.rows, left.columns + right.columns, both)
            continue
        total: dict[Place, sp.Expr] = {}
        for term in line.terms:
            for place, value in _values(cast(Call, term).function).items():
                total[place] = total.get(place, sp.Integer(0)) + value.xreplace(entries)
        matrices[line.result] = Matrix(first.function.rows, first.function.columns, total)
    return {name: matrices[name] for name in assembly.results}


def in_vacuum() -> FusedFunction:
    """M, C, K and B of a whole rotor without airloads."""
    steps, blade = _blade(airloads_too=False)
    return _fused("in_vacuum", steps, _fixed_frame(blade), in_vacuum)


def in_air() -> FusedFunction:
    """M, C, K and B of a whole rotor with the work of its airloads."""
    steps, blade = _blade(airloads_too=True)
    work = tuple(_work(row, column).name for row in _virtual().independent for column in _moving().columns)
    groups = (
        Group("work", "work of the airloads, W^T L U summed over the segments, row by row", work),
        Group("geometric", "results for G, summed over the segments", _geometric()[0].rows),
    )
    return _fused("in_air", steps, _fixed_frame(blade), in_air, groups)


def named_values(module: str, name: str) -> FusedFunction:
    """Plan the named values of a function."""
    function = _function(module, name)
    made = plan(function.steps, {}, [symbol.name for symbol in function.values])
    return FusedFunction(name, function.summary, made, _arguments(made, function.steps))


def _fused(
    name: str,
    steps: Steps,
    matrices: Mapping[str, Matrix],
    of: object,
    groups: tuple[Group, ...] = (),
) -> FusedFunction:
    made = plan(steps, matrices)
    summary = (of.__doc__ or "").partition("\n")[0]
    return FusedFunction(name, summary, made, _arguments(made, steps), groups)


def _arguments(made: Plan, steps: Steps) -> list[sp.Symbol]:
    """Return the quantities that a plan needs, in the order of their declaration."""
    needed = set().union(*(value.free_symbols for _, value in made.lines)) - {symbol for symbol, _ in steps}
    return [symbol for symbol in QUANTITIES if symbol in needed]


def fused_functions() -> list[FusedFunction]:
    """Return all fused functions of the rotor."""
    return [
        named_values("flap_lag_springs", "effective_stiffness"),
        in_vacuum(),
        segment(),
        in_air(),
    ]
