"""The intermediate form: a function to be generated, its entries with their equation, unit and dimension.

Nothing is printed here and nothing is derived here. `derive.equations` lists the functions, `derive.emit` turns them
into NumPy modules; the audit and the notebooks read the same records.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field

import sympy as sp

from derive import multiblade
from derive.coordinates import COORDINATE
from derive.symbols import NUMBER, QUANTITIES, Dimension, MissingError, how_to_declare

FORCE: Dimension = (1, 1, -2)
MOMENT: Dimension = (1, 2, -2)
LENGTH: Dimension = (0, 1, 0)

Names = Collection[str]
# Of the entry of a row and a column, by their names.
ValueOf = Callable[[str, str], sp.Expr]
DimensionOf = Callable[[str, str], Dimension]


class DimensionError(ValueError):
    """A term whose dimension is not that of its entry."""


@dataclass(frozen=True)
class Entry:
    """One entry of a matrix or one value: the expression, where it comes from, and its dimension."""

    value: sp.Expr
    equation: str
    dimension: Dimension


@dataclass(frozen=True)
class Function:
    """A function to generate: temporaries, then named values, the entries of a matrix, or a matrix product.

    `blade_matrices` are whole-matrix arguments whose entries the expressions index; a `product` is summed over the
    blade's segments. A `signature` is that of the consistent function a published one stands in for. `row_prefix`
    tells rows from columns where both have a name at different places.
    """

    module: str
    name: str
    summary: str
    origin: str
    steps: list[tuple[sp.Symbol, sp.Expr]] = field(default_factory=list)
    values: tuple[sp.Symbol, ...] = ()
    rows: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()
    entries: dict[tuple[str, str], Entry] = field(default_factory=dict)
    blade_matrices: tuple[str, ...] = ()
    product: sp.MatrixExpr | None = None
    signature: tuple[sp.Symbol, ...] | None = None
    row_prefix: str = ""

    @property
    def arguments(self) -> list[sp.Symbol]:
        """Keyword arguments: those the expressions need, or a wider signature they share with another set."""
        return list(self.signature) if self.signature is not None else self.needed

    @property
    def needed(self) -> list[sp.Symbol]:
        """Free symbols in the order of their declaration; one that is no declared quantity is refused."""
        if self.product is not None:
            return sorted(self.product.atoms(sp.MatrixSymbol), key=lambda matrix: matrix.name)
        known = {symbol for symbol, _ in self.steps}
        expressions = [value for _, value in self.steps] + [entry.value for entry in self.entries.values()]
        free = set().union(*(expression.free_symbols for expression in expressions)) if expressions else set()
        free = {symbol for symbol in free if not isinstance(symbol, sp.Indexed)} - _INDEX_SYMBOLS
        free -= known
        for symbol in sorted(free - set(QUANTITIES), key=str):
            raise undeclared(symbol, f"{self.module}.{self.name}")
        return [symbol for symbol in QUANTITIES if symbol in free]

    def check_dimensions(self) -> None:
        """Raise DimensionError unless every step and entry has its symbol's or its entry's dimension."""
        for symbol, value in self.steps:
            where = f"{self.module}.{self.name}: {symbol}"
            _require(value, _quantity_dimension(symbol, where), where)
        for place, entry in self.entries.items():
            _require(entry.value, entry.dimension, f"{self.module}.{self.name}: {place}")


def undeclared(symbol: sp.Symbol, where: str) -> MissingError:
    """Return the error for a symbol that is no quantity: what it is and where it belongs."""
    if any(symbol.name == f"q_{name}" for name in COORDINATE):
        remedy = "it is a coordinate's perturbation: take the expression at trim, `at_trim` of derive/kinematics.py"
    else:
        remedy = how_to_declare(symbol)
    return MissingError(f"{where} uses the symbol {symbol}, which is no argument: {remedy}")


def _quantity_dimension(symbol: sp.Symbol, where: str) -> Dimension:
    if symbol not in QUANTITIES:
        raise undeclared(symbol, where or "an expression")
    return QUANTITIES[symbol].dimension


# Dimensions


def _require(expression: sp.Expr, dimension: Dimension, where: str) -> None:
    found = dimension_of(expression, where)
    if expression != 0 and found != dimension:
        raise DimensionError(f"{where} has dimension {found}, not {dimension}: {expression}")


def dimension_of(expression: sp.Expr, where: str = "") -> Dimension:
    """Dimension of an expression; all terms of a sum must agree and functions take numbers."""
    if expression.is_number:
        return NUMBER
    if isinstance(expression, sp.Indexed):
        return _blade_entry_dimension(expression)
    if expression.is_Symbol:
        return _quantity_dimension(expression, where)
    if expression.is_Add:
        dimensions = {dimension_of(term, where) for term in expression.args}
        if len(dimensions) != 1:
            raise DimensionError(f"{where}: terms of different dimension in {expression}")
        return dimensions.pop()
    if expression.is_Mul:
        return plus(*(dimension_of(argument, where) for argument in expression.args))
    if expression.is_Pow:
        exponent = expression.exp
        return tuple(d * exponent for d in dimension_of(expression.base, where))
    for argument in expression.args:
        _require(argument, NUMBER, where)
    return NUMBER


def plus(*dimensions: Dimension, minus: Dimension = NUMBER) -> Dimension:
    """Dimension of a product, over another one."""
    return tuple(sum(parts) - m for *parts, m in zip(*dimensions, minus, strict=True))


def coordinate_dimension(name: str) -> Dimension:
    """Dimension of a coordinate or an input."""
    if name not in COORDINATE:
        raise MissingError(
            f"{name} is no coordinate: declare it in a list of derive/coordinates.py, with its unit"
        )
    return COORDINATE[name].dimension


def row_dimension(name: str) -> Dimension:
    """Virtual work per unit of the row's coordinate."""
    return plus(MOMENT, minus=coordinate_dimension(name))


def force_per(order: int) -> DimensionOf:
    """Of a matrix that takes a derivative of the coordinates, of some order in time, to forces."""

    def dimension(row: str, column: str) -> Dimension:
        return plus(row_dimension(row), per_time(order), minus=coordinate_dimension(column))

    return dimension


def per_time(order: int) -> Dimension:
    return (0, 0, order)


# Names that stand for whole matrices and places in them, not for quantities.
_INDEX_SYMBOLS = {*multiblade.BLADE_INDEX.values(), *multiblade.GUST_INDEX.values()}
_INDEX_SYMBOLS |= {
    base.label for base in (multiblade.MASS, multiblade.DAMPING, multiblade.STIFFNESS, multiblade.GUSTS)
}
_TIME_ORDER = {multiblade.MASS: 2, multiblade.DAMPING: 1, multiblade.STIFFNESS: 0, multiblade.GUSTS: 0}
_NAME_OF_INDEX = {
    symbol: name
    for indices in (multiblade.BLADE_INDEX, multiblade.GUST_INDEX)
    for name, symbol in indices.items()
}


def _blade_entry_dimension(entry: sp.Indexed) -> Dimension:
    """Dimension of an entry of a blade's mass, damping or stiffness matrix, or of its gust loads."""
    row, column = (_NAME_OF_INDEX[index] for index in entry.indices)
    return force_per(_TIME_ORDER[entry.base])(row, column)


# Entries


def entries(
    rows: Names, columns: Names, value: ValueOf, dimension: DimensionOf, equation: Mapping[str, str] | str
) -> dict[tuple[str, str], Entry]:
    """Entries of a matrix that are not zero, each with the equation of its row."""
    found = {}
    for row in rows:
        for column in columns:
            expression = value(row, column)
            if expression != 0:
                found[row, column] = Entry(expression, _equation(equation, row), dimension(row, column))
    return found


def _equation(equations: Mapping[str, str] | str, row: str) -> str:
    if isinstance(equations, str):
        return equations
    if row not in equations:
        raise MissingError(
            f"no equation is told for the row {row}: add it to `ROW_EQUATION` of derive/kinds.py"
        )
    return equations[row]
