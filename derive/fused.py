"""The whole rotor as plans of operations, from the same functions of the catalogue as the readable modules.

Nothing is derived here. `in_vacuum` is the rotor without airloads. Airloads have three parts: `segment` makes the
arrays of a segment, a product of these arrays summed over the segments gives the work of the airloads, and
`of_airloads` makes what is added to C, K and B of this work.

The product takes the independent columns of W and U alone, as `derive.columns` finds them; `of_airloads` combines them.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import cast

import sympy as sp

from derive import kinematics as kin
from derive import multiblade
from derive.columns import Columns, Combination
from derive.coordinates import SEGMENT_LOADS, SEGMENT_MOTIONS, names
from derive.plain import Catalogue, entries_of
from derive.plan import Matrix, Place, Plan, Results, Steps, plan
from derive.rotor import Assembly, Call, Code
from derive.symbols import QUANTITIES

Blade = dict[str, dict[Place, sp.Expr]]  # entries of the matrices of one blade by name

_BASES = {
    base.label.name: base
    for base in (multiblade.MASS, multiblade.DAMPING, multiblade.STIFFNESS, multiblade.GUSTS)
}
_INDEX = multiblade.BLADE_INDEX | multiblade.GUST_INDEX
_SIDE = {"_beside(swashplate, gust)": ("swashplate", "gust")}


@dataclass(frozen=True)
class Group:
    """Numbers that a fused function takes together, in their order."""

    name: str
    meaning: str
    members: tuple[str, ...]


@dataclass(frozen=True)
class FusedFunction:
    """A plan with its name, summary and arguments, groups of numbers first.

    With `into` the function is one of arrays, and puts its results into an array that it takes; otherwise it is one of
    arrays or plain numbers, and returns them.
    """

    name: str
    summary: str
    plan: Plan
    arguments: list[sp.Symbol]
    groups: tuple[Group, ...] = ()
    into: bool = False

    @property
    def called(self) -> tuple[str, ...]:
        """Functions of one number that the plan takes."""
        return ("cos", "sin") if any(value.has(sp.cos, sp.sin) for _, value in self.plan.lines) else ()


# W, U and G


@functools.cache
def _virtual(rotors: Catalogue) -> tuple[Matrix, dict[str, Combination]]:
    """W of the independent rows of the work, and every row in these."""
    columns = Columns(names(SEGMENT_LOADS))
    found = columns.combinations(rotors.function("airloads", "virtual_motion"))
    return columns.matrix, found


@functools.cache
def _motions(rotors: Catalogue) -> tuple[Matrix, dict[str, dict[str, Combination]]]:
    """U of the independent motions, and the columns of every function of motions in these."""
    columns = Columns(names(SEGMENT_MOTIONS))
    prefixes = {"rate_motion": "rate_", "gust_motion": "gust_", "displacement_motion": "change_"}
    found = {
        name: columns.combinations(rotors.function("airloads", name), prefix)
        for name, prefix in prefixes.items()
    }
    return columns.matrix, found


@functools.cache
def _geometric(rotors: Catalogue) -> tuple[Matrix, dict[Place, sp.Expr]]:
    """G of a segment: its different entries as a column, and each entry as one of these with its sign."""
    function = rotors.function("airloads", "geometric_stiffness")
    results = Results()
    layout = results.layout("geometric", Matrix(function.rows, function.columns, entries_of(function)))
    different = list(results.named)
    entries = {
        (row, column): sp.sign(number) * sp.Symbol(different[abs(number) - 1], real=True)
        for row, numbers in zip(function.rows, layout, strict=True)
        for column, number in zip(function.columns, numbers, strict=True)
        if number
    }
    column = {(name, "segment"): value for name, value in results.named.items()}
    return Matrix(tuple(different), ("segment",), column), entries


# The blade


def _work(row: str, column: str) -> sp.Symbol:
    """Work of the airloads on an independent row per unit of an independent motion, W^T L U of all segments."""
    return sp.Symbol(f"{row}_{column}", real=True)


def _air(rotors: Catalogue, term: Code) -> dict[Place, sp.Expr]:
    """Entries of one of the blade's airload matrices, a product of the arrays of the segments."""
    name = term.removeprefix("air.")
    product = rotors.function("airloads", {"gusts": "gust_loads"}.get(name, name)).product
    parts = []
    for part in sp.MatAdd.make_args(product):
        factor, matrices = part.as_coeff_matrices()
        last = matrices[-1].name
        entries = _geometric(rotors)[1] if last == "geometric_stiffness" else _work_entries(rotors, last)
        parts.append({place: factor * value for place, value in entries.items()})
    return sum_of(parts)


def _work_entries(rotors: Catalogue, motion: str) -> dict[Place, sp.Expr]:
    rows, columns = _virtual(rotors)[1], _motions(rotors)[1][motion]
    return {
        (row, column): sum(
            (
                left * right * _work(name, other)
                for name, left in rows[row].items()
                for other, right in columns[column].items()
            ),
            sp.Integer(0),
        )
        for row in rows
        for column in columns
    }


def _blade(rotors: Catalogue) -> tuple[list[tuple[sp.Symbol, sp.Expr]], Blade, Blade]:
    """Return named values, and the entries of one blade's matrices without airloads and of airloads alone.

    `rotor.blade_matrices` adds the same functions.
    """
    steps: list[tuple[sp.Symbol, sp.Expr]] = []
    blade, air = {}, {}
    for line in cast(Assembly, rotors.function("rotor", "blade_matrices")).lines:
        functions = [rotors.of(term.function) for term in line.terms if isinstance(term, Call)]
        plain = [function for function in functions if not isinstance(function, Assembly)]
        steps += [step for function in plain for step in function.steps]
        blade[line.result] = sum_of(entries_of(function) for function in plain)
        air[line.result] = sum_of(_air(rotors, term) for term in line.terms if isinstance(term, Code))
    return steps, blade, air


def sum_of(parts: Iterable[Mapping[Place, sp.Expr]]) -> dict[Place, sp.Expr]:
    """Add matrices entry by entry."""
    total: dict[Place, sp.Expr] = {}
    for part in parts:
        for place, value in part.items():
            total[place] = total.get(place, sp.Integer(0)) + value
    return total


# The rotor


def _fixed_frame(rotors: Catalogue, blade: Blade, of_blades: bool = False) -> dict[str, Matrix]:
    """Sum over the blades as `rotor.fixed_frame` does, or with `of_blades` without engine, shaft and swashplate."""
    entries = {
        base[_INDEX[row], _INDEX[column]]: blade[name].get((row, column), sp.Integer(0))
        for name, base in _BASES.items()
        for row in kin.COORDINATES
        for column in (multiblade.GUST_INDEX if name == "gusts" else kin.COORDINATES)
    }
    matrices: dict[str, Matrix] = {}
    assembly = cast(Assembly, rotors.function("rotor", "fixed_frame"))
    for line in assembly.lines:
        first = line.terms[0]
        if isinstance(first, Code):
            left, right = (matrices[name] for name in _SIDE[first])
            both = {**left.entries, **right.entries}
            matrices[line.result] = Matrix(left.rows, left.columns + right.columns, both)
            continue
        functions = [rotors.of(term.function) for term in line.terms if isinstance(term, Call)]
        total = sum_of(
            entries_of(function) for function in functions if function.blade_matrices or not of_blades
        )
        total = {place: value.xreplace(entries) for place, value in total.items()}
        matrices[line.result] = Matrix(first.function.rows, first.function.columns, total)
    return {name: matrices[name] for name in assembly.results}


def in_vacuum(rotors: Catalogue) -> FusedFunction:
    """M, C, K and B of a whole rotor without airloads."""
    steps, blade, _ = _blade(rotors)
    return _fused("in_vacuum", steps, _fixed_frame(rotors, blade), in_vacuum)


@functools.cache
def of_airloads(rotors: Catalogue) -> FusedFunction:
    """What airloads add to C, K and B of a whole rotor, from the work of the airloads."""
    _, _, air = _blade(rotors)
    matrices = {
        name: matrix for name, matrix in _fixed_frame(rotors, air, of_blades=True).items() if name != "M"
    }
    made = _fused("of_airloads", [], matrices, of_airloads)
    used = {symbol.name for _, value in made.plan.lines for symbol in value.free_symbols}
    work = tuple(
        _work(row, column).name
        for row in _virtual(rotors)[0].columns
        for column in _motions(rotors)[0].columns
    )
    geometric = tuple(name for name in _geometric(rotors)[0].rows if name in used)
    groups = (
        Group("work", "the work of the airloads, W^T L U summed over the segments, row by row", work),
        Group("geometric", "the results for G, summed over the segments", geometric),
    )
    return dataclasses.replace(made, groups=groups)


def segment(rotors: Catalogue) -> FusedFunction:
    """Arrays of one segment: W, L and U of the independent motions, and what the rotor needs of G as a column."""
    virtual, motion, geometric = _virtual(rotors)[0], _motions(rotors)[0], _geometric(rotors)[0]
    derivatives = rotors.entries("airloads", "load_derivatives")
    _, needed = of_airloads(rotors).groups  # the rest of G vanishes in the sum over the blades
    entries = {place: value for place, value in geometric.entries.items() if place[0] in needed.members}
    matrices = {
        "virtual_motion": virtual,
        "load_derivatives": Matrix(virtual.rows, motion.rows, derivatives),
        "motion": motion,
        "geometric_stiffness": Matrix(needed.members, geometric.columns, entries),
    }
    return _fused("segment", rotors.function("airloads", "segment_geometry").steps, matrices, segment)


def named_values(rotors: Catalogue, module: str, name: str) -> FusedFunction:
    """Plan the named values of a function."""
    function = rotors.function(module, name)
    made = plan(function.steps, {}, [symbol.name for symbol in function.values])
    return FusedFunction(name, function.summary, made, arguments(made, function.steps))


def _fused(
    name: str,
    steps: Steps,
    matrices: Mapping[str, Matrix],
    of: object,
) -> FusedFunction:
    made = plan(steps, matrices)
    summary = (of.__doc__ or "").partition("\n")[0]
    return FusedFunction(name, summary, made, arguments(made, steps))


def arguments(made: Plan, steps: Steps) -> list[sp.Symbol]:
    """Return the quantities that a plan needs, in the order of their declaration."""
    needed = set().union(*(value.free_symbols for _, value in made.lines)) - {symbol for symbol, _ in steps}
    return [symbol for symbol in QUANTITIES if symbol in needed]


def functions_of_rotor(rotors: Catalogue) -> list[FusedFunction]:
    """Return all fused functions of the rotor."""
    return [
        named_values(rotors, "flap_lag_springs", "effective_stiffness"),
        in_vacuum(rotors),
        segment(rotors),
        of_airloads(rotors),
    ]
