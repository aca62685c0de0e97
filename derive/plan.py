"""A plan of operations: many expressions in few operations, in the order in which they need few registers.

A fused function is a plan printed line by line. All its results are expanded, so that terms cancel across the
functions that a result came from, one pass looks for common subexpressions, and each result is computed as soon as
what it needs is there. A temporary takes the register of one that is no longer needed. Results that are equal or
opposite are computed once; a layout tells which result, with which sign, stands where in a matrix.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp
from sympy.printing.str import StrPrinter

Place = tuple[str, str]  # row and column of an entry
Steps = Sequence[tuple[sp.Symbol, sp.Expr]]
Entries = Mapping[Place, sp.Expr]


@dataclass(frozen=True)
class Matrix:
    """A matrix that a plan fills: the names of its rows and columns, and the entries that are not zero."""

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    entries: Entries


@dataclass(frozen=True)
class Plan:
    """Lines of names and expressions in their order, the results, and the layout of each matrix.

    A layout has a whole number for each entry: 0 for zero, n for the n-th result from 1 on, -n for its negative.
    """

    lines: list[tuple[str, sp.Expr]]
    results: list[str]
    layouts: dict[str, list[list[int]]]

    @property
    def operations(self) -> int:
        """Arithmetic operations per point."""
        return int(sum(sp.count_ops(value) for _, value in self.lines))


def plan(
    steps: Steps, matrices: Mapping[str, Matrix], values: Sequence[str] = (), short_lived: bool = False
) -> Plan:
    """Plan the matrices from their entries; steps are named values that entries and later steps may use.

    The steps that `values` names are results as well, before those of the matrices. With `short_lived` the other steps
    take registers like temporaries, so that they fill no memory after their last use.
    """
    kept, same = without_other_names(steps, values)
    results = Results()
    layouts = {name: results.layout(name, matrix, same) for name, matrix in matrices.items()}
    named = [(symbol.name, value) for symbol, value in kept]
    outcomes = list(results.named.items())
    shared, reduced = sp.cse([value for _, value in named + outcomes], symbols=_temporaries())
    lines = dict(zip([name for name, _ in named + outcomes], reduced, strict=True))
    made = _with_plain_powers({symbol.name: value for symbol, value in shared} | lines)
    wanted = [*values, *results.named]
    names = set(wanted) if short_lived else {name for name, _ in named + outcomes}
    return Plan(_with_registers(list(_in_order(made, wanted)), made, names), wanted, layouts)


def without_other_names(
    steps: Steps, wanted: Sequence[str] = ()
) -> tuple[list[tuple[sp.Symbol, sp.Expr]], dict[sp.Symbol, sp.Expr]]:
    """Return the steps without those that are zero or another name of an earlier step, and what these are.

    The steps that `wanted` names stay.
    """
    same: dict[sp.Symbol, sp.Expr] = {}
    kept = []
    for symbol, value in steps:
        value = sp.sympify(value).xreplace(same)
        if (value == 0 or value.is_Symbol) and symbol.name not in wanted:
            same[symbol] = value
        else:
            kept.append((symbol, value))
    return kept, same


class Results:
    """Different results, named after the first place that each has in a matrix."""

    def __init__(self) -> None:
        self.named: dict[str, sp.Expr] = {}
        self._numbers: dict[sp.Expr, int] = {}  # by what each result is when expanded

    def layout(
        self, name: str, matrix: Matrix, same: Mapping[sp.Symbol, sp.Expr] | None = None
    ) -> list[list[int]]:
        """Lay a matrix out, and add what is neither equal nor opposite to an earlier result.

        `same` has what symbols of the entries are.
        """
        numbers = {
            (row, column): self._number(name, (row, column), value.xreplace(same or {}))
            for (row, column), value in matrix.entries.items()
            if row in matrix.rows and column in matrix.columns
        }
        return [[numbers.get((row, column), 0) for column in matrix.columns] for row in matrix.rows]

    def _number(self, name: str, place: Place, value: sp.Expr) -> int:
        expanded = sp.expand(value.xreplace(_squares(value)))
        if expanded == 0 or _vanishes(expanded):
            return 0
        opposite = sp.expand(-expanded)
        if opposite in self._numbers:
            return -self._numbers[opposite]
        if expanded not in self._numbers:
            self.named["_".join((name, *place))] = sp.factor_terms(expanded)
            self._numbers[expanded] = len(self.named)
        return self._numbers[expanded]


def _vanishes(expanded: sp.Expr) -> bool:
    """Return whether a sum is zero because the squares of a sine and its cosine, by their names, add up to one."""
    sines = {
        cosine: sp.Symbol(f"sin_{cosine.name.removeprefix('cos_')}", real=True)
        for cosine in expanded.free_symbols
        if cosine.name.startswith("cos_")
    }
    powers = {
        power: power.base ** (power.exp % 2) * (1 - sines[power.base] ** 2) ** (power.exp // 2)
        for power in expanded.atoms(sp.Pow)
        if power.base in sines and power.exp.is_Integer and power.exp > 1
    }
    return bool(powers) and sp.expand(expanded.xreplace(powers)) == 0


def _squares(value: sp.Expr) -> dict[sp.Expr, sp.Expr]:
    """Return squares of sines and cosines by the cosine of the double angle, so that fewer waves are needed."""
    found = {}
    for square in value.atoms(sp.Pow):
        if square.exp == 2 and isinstance(square.base, sp.sin | sp.cos):
            sign = 1 if isinstance(square.base, sp.cos) else -1
            found[square] = (1 + sign * sp.cos(2 * square.base.args[0])) / 2
    return found


def _temporaries() -> Iterator[sp.Symbol]:
    return (sp.Symbol(f"temporary_{count}") for count in itertools.count())


def _with_plain_powers(made: Mapping[str, sp.Expr]) -> dict[str, sp.Expr]:
    """Give the base of each whole power a line of its own, so that the power can be a product."""
    bases: dict[sp.Expr, sp.Symbol] = {}
    found = {}
    for name, value in made.items():
        powers = {
            power: bases.setdefault(power.base, sp.Symbol(f"base_{len(bases)}")) ** power.exp
            for power in sorted(value.atoms(sp.Pow), key=sp.default_sort_key)
            if power.exp.is_Integer and power.exp > 1 and not power.base.is_Symbol
        }
        found[name] = value.xreplace(powers)
    return {symbol.name: base for base, symbol in bases.items()} | found


def _in_order(made: Mapping[str, sp.Expr], wanted: Sequence[str]) -> Iterator[str]:
    """Yield names so that each comes after what it needs and as late as its first use allows."""
    done: set[str] = set()

    def visit(name: str) -> Iterator[str]:
        if name in done or name not in made:
            return
        done.add(name)
        for needed in sorted(symbol.name for symbol in made[name].free_symbols):
            yield from visit(needed)
        yield name

    for name in wanted:
        yield from visit(name)


def _with_registers(
    order: Sequence[str], made: Mapping[str, sp.Expr], names: set[str]
) -> list[tuple[str, sp.Expr]]:
    """Give each temporary a register; a register is free again after the last use of its temporary."""
    last = {symbol.name: place for place, name in enumerate(order) for symbol in made[name].free_symbols}
    free: list[int] = []
    registers: dict[str, sp.Symbol] = {}
    count = itertools.count()
    lines = []
    for place, name in enumerate(order):
        symbols = made[name].free_symbols
        value = made[name].xreplace({symbol: registers.get(symbol.name, symbol) for symbol in symbols})
        for needed in sorted({symbol.name for symbol in symbols} & registers.keys()):
            if last[needed] == place:
                free.append(int(registers[needed].name[1:]))
        if name not in names:
            register = free.pop() if free else next(count)
            registers[name] = sp.Symbol(f"r{register}")
        lines.append((registers[name].name if name not in names else name, value))
    return lines


class PlanPrinter(StrPrinter):  # type: ignore[misc]  # SymPy has no types
    """Python code for numbers as for arrays: a small whole power is a product."""

    def _print_Add(self, expr: sp.Add, order: str | None = None) -> str:
        """A sum begins with a term without a minus, which would be an operation of its own."""
        terms = self._as_ordered_terms(expr, order=order)
        first = next((term for term in terms if not term.could_extract_minus_sign()), terms[0])
        rest = (self._print(term) for term in terms if term is not first)
        parts = (f"- {term[1:]}" if term.startswith("-") else f"+ {term}" for term in rest)
        return " ".join([self._print(first), *parts])

    def _print_Pow(self, expr: sp.Pow, rational: bool = False) -> str:
        base, exponent = expr.as_base_exp()
        if base.is_Symbol and exponent in (2, 3):
            return "*".join([self._print(base)] * int(exponent))
        if abs(exponent) == sp.Rational(1, 2):
            return f"{'1/' if exponent.is_negative else ''}np.sqrt({self._print(base)})"
        if exponent != -1:
            raise ValueError(f"cannot print {expr} in a plan")
        printed: str = super()._print_Pow(expr, rational=rational)
        return printed

    def _print_Pi(self, expr: sp.Expr) -> str:
        return repr(math.pi)

    def _print_atan(self, expr: sp.atan) -> str:
        return f"np.arctan({self._print(expr.args[0])})"


def print_line(value: sp.Expr) -> str:
    """Return the expression as code."""
    code: str = PlanPrinter().doprint(value)
    return code
