"""Independent columns of a matrix of a segment, and every column as a combination of these.

A gimbal tilt is a turn of the hub with another pitch, the azimuth is a turn, a gust is the motion of the hub seen from
the air, and a hub that is displaced or turned in a steady wind meets the air as if it moved. So few columns have to be
multiplied. The combinations are found by linear algebra, and hold for all segments of a blade alike.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp
from sympy.polys.matrices import DomainMatrix

from derive import symbols as s
from derive.function import Function
from derive.plan import Matrix, Place

Combination = dict[str, sp.Expr]  # independent columns, and how much of each makes a column
Column = Mapping[str, sp.Expr]  # entries by row

# What a column may be multiplied by in a combination; all are numbers of the whole blade.
FACTORS = (sp.Integer(1), s.rotor_speed, s.airspeed, s.pitch_gimbal_coupling)


@dataclass
class Columns:
    """Independent columns by name."""

    rows: tuple[str, ...]
    independent: dict[str, Column] = field(default_factory=dict)

    def combinations(self, function: Function, prefix: str = "") -> dict[str, Combination]:
        """Return the columns of a function in independent ones; new ones are added under their name with a prefix."""
        found = {}
        # A column of one row, such as the pitch, comes first: others are made of it.
        for name, column in sorted(_columns(function).items(), key=lambda pair: len(pair[1]) > 1):
            combination = self._combination(column)
            if combination is None:
                combination = {prefix + name: sp.Integer(1)}
                self.independent[prefix + name] = column
            found[name] = combination
        return found

    @property
    def matrix(self) -> Matrix:
        """The independent columns side by side; rows of zeros are left out."""
        entries: dict[Place, sp.Expr] = {
            (row, name): value for name, column in self.independent.items() for row, value in column.items()
        }
        rows = tuple(row for row in self.rows if any(place[0] == row for place in entries))
        return Matrix(rows, tuple(self.independent), entries)

    def _combination(self, column: Column) -> Combination | None:
        """Return a column in those that are known; None if it is none of their combinations."""
        terms = [(name, factor) for name in self.independent for factor in FACTORS]
        given = [_coefficients(self.independent[name], factor) for name, factor in terms]
        shares = _solution(given, _coefficients(column, sp.Integer(1)))
        if shares is None:
            return None
        found: Combination = {}
        for (name, factor), share in zip(terms, shares, strict=True):
            if share:
                found[name] = found.get(name, sp.Integer(0)) + share * factor
        return found


def _columns(function: Function) -> dict[str, Column]:
    """Return the columns of a function that are not zero."""
    found: dict[str, dict[str, sp.Expr]] = {}
    for name in function.columns:
        for row in function.rows:
            if (row, name) in function.entries:
                found.setdefault(name, {})[row] = function.entries[row, name].value
    return dict(found)


def _coefficients(column: Column, factor: sp.Expr) -> dict[tuple[str, sp.Expr], sp.Rational]:
    """Return the numbers in front of the monomials of each row."""
    return {
        (row, monomial): number
        for row, value in column.items()
        for monomial, number in sp.expand(factor * value).as_coefficients_dict().items()
    }


def _solution(
    columns: Sequence[Mapping[tuple[str, sp.Expr], sp.Rational]],
    right: Mapping[tuple[str, sp.Expr], sp.Rational],
) -> list[sp.Rational] | None:
    """Return the numbers that make the right side of columns; None if no numbers do."""
    keys = list(dict.fromkeys(key for side in (*columns, right) for key in side))
    rows = [[side.get(key, sp.Integer(0)) for side in (*columns, right)] for key in keys]
    reduced, pivots = DomainMatrix.from_list_sympy(len(rows), len(rows[0]), rows).to_field().rref()
    if len(columns) in pivots:
        return None
    last = [reduced[place, len(columns)].element for place in range(len(pivots))]
    found = dict(zip(pivots, map(sp.sympify, map(str, last)), strict=True))
    return [found.get(place, sp.Integer(0)) for place in range(len(columns))]
