"""C of a plan: the same lines as in Python, for numbers in the lanes of a vector register.

All plans read their quantities from one array, in which each quantity has the place that `places` gives it, and groups
of numbers from arrays of their own. Plans of named values put these back among the quantities, for the plans that
follow.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

import sympy as sp

from derive.fused import FusedFunction, Group
from derive.plan import PlanPrinter
from derive.symbols import QUANTITIES

_OF_C = {"sqrt": "root", "cos": "cosine", "sin": "sine", "arctan": "arc_tangent"}


class CPrinter(PlanPrinter):
    """Every number is printed as one with a point, so that C does not divide whole numbers."""

    def _print_Integer(self, expr: sp.Integer) -> str:
        return f"{int(expr)}.0"

    def _print_Rational(self, expr: sp.Rational) -> str:
        return f"{int(expr.p)}.0/{int(expr.q)}.0"


def places(functions: Iterable[FusedFunction]) -> list[dict[str, str]]:
    """Return the quantities that any of the plans reads or names, in the order of their declaration."""
    used = {symbol.name for function in functions for symbol in function.arguments}
    used |= {name for function in functions if _is_named(function) for name in function.plan.results}
    return [
        {"name": symbol.name, "unit": quantity.unit or "-", "meaning": quantity.meaning}
        for symbol, quantity in QUANTITIES.items()
        if symbol.name in used
    ]


def described(function: FusedFunction) -> dict[str, Any]:
    """Return everything that the template needs of a plan, printed as C."""
    used = set().union(*(value.free_symbols for _, value in function.plan.lines))
    return {
        "name": function.name,
        "summary": function.summary,
        "operations": function.plan.operations,
        "groups": [
            {"name": g.name, "meaning": g.meaning, "count": len(g.members), "members": _numbered(g, used)}
            for g in function.groups
        ],
        "arguments": [symbol.name for symbol in function.arguments],
        "variables": list(dict.fromkeys(name for name, _ in function.plan.lines)),
        "lines": [{"name": name, "code": _code(value)} for name, value in function.plan.lines],
        "named": _is_named(function),
        "results": function.plan.results,
    }


def _numbered(group: Group, used: set[sp.Symbol]) -> dict[str, int]:
    """Return the place of each member of a group that a plan uses."""
    names = {symbol.name for symbol in used}
    return {name: place for place, name in enumerate(group.members) if name in names}


def _is_named(function: FusedFunction) -> bool:
    """Return whether all results of a plan are quantities."""
    declared = {symbol.name for symbol in QUANTITIES}
    return not function.into and not function.plan.layouts and declared.issuperset(function.plan.results)


def _code(value: sp.Expr) -> str:
    """Return the code of an expression; a number by itself fills all lanes."""
    code = re.sub(
        r"\b(?:np\.)?(sqrt|cos|sin|arctan)\(", lambda found: f"{_OF_C[found[1]]}(", CPrinter().doprint(value)
    )
    return f"all({code})" if value.is_number else code
