"""Matrices through `sympy.lambdify`: those of the derivation, from the blade's numbers to M, C and K in one function.

Every entry that is not zero is one returned value, since an array of numbers and arrays is none; they are then put in
place. So the function takes batches, as the generated ones do.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive import equations, multiblade, symbols
from derive import kinematics as kin

BLADE_MODULES = ("inertia", "flap_lag_springs", "pitch")
_BLADE_PARTS = {
    "mass": (("inertia", "mass"), ("pitch", "mass")),
    "damping": (("inertia", "gyroscopic"), ("pitch", "damping")),
    "stiffness": (
        ("inertia", "centrifugal_stiffness"),
        ("pitch", "stiffness"),
        ("flap_lag_springs", "stiffness"),
    ),
}


class Lambdified:
    """Square matrices of SymPy expressions as one function of quantities by name.

    Attributes
    ----------
    function : callable
        What `lambdify` made.
    names : list of str
        Its arguments.
    """

    def __init__(self, matrices: Sequence[sp.Matrix], cse: bool):
        self.size = matrices[0].rows
        self.places = [
            (k, i, j)
            for k, matrix in enumerate(matrices)
            for i in range(self.size)
            for j in range(self.size)
            if matrix[i, j] != 0
        ]
        entries = [matrices[k][i, j] for k, i, j in self.places]
        given = sorted(set().union(*(entry.free_symbols for entry in entries)), key=lambda s: s.name)
        self.names = [symbol.name for symbol in given]
        self.function: Callable = sp.lambdify(given, entries, modules="numpy", cse=cse)

    def __call__(self, quantities: Mapping[str, Any]) -> tuple[NDArray, NDArray, NDArray]:
        """M, C, K (..., n, n)."""
        given = [quantities[name] for name in self.names]
        values = self.function(*given)
        shape = np.broadcast_shapes(*(np.shape(number) for number in given))
        filled = np.zeros((3, *shape, self.size, self.size))
        for (k, i, j), value in zip(self.places, values, strict=True):
            filled[k, ..., i, j] = value
        return tuple(filled)


def blade_expressions() -> dict[str, sp.Matrix]:
    """Mass, damping and stiffness of one blade in the blade's own numbers, no temporaries and no linkages left."""
    functions = {(m, f.name): f for m in BLADE_MODULES for f in equations.consistent_functions(m)}
    steps = [
        *functions["inertia", "dependent_inertias"].steps,
        *functions["inertia", "trim_integrals"].steps,
        *functions["flap_lag_springs", "effective_stiffness"].steps,
    ]
    resolved: dict[sp.Symbol, sp.Expr] = dict.fromkeys(symbols.HINGE_LINKAGES, sp.Integer(0))
    for symbol, value in steps:
        resolved[symbol] = sp.sympify(value).xreplace(resolved)
    return {
        kind: sp.Matrix(
            len(kin.COORDINATES),
            len(kin.COORDINATES),
            lambda i, j, parts=parts: sum(
                functions[part].entries[row_and_column(i, j)].value.xreplace(resolved)
                for part in parts
                if row_and_column(i, j) in functions[part].entries
            ),
        )
        for kind, parts in _BLADE_PARTS.items()
    }


def row_and_column(i: int, j: int) -> tuple[str, str]:
    return kin.COORDINATES[i], kin.COORDINATES[j]


def rotor_expressions() -> list[sp.Matrix]:
    """M, C and K of the rotor in the fixed frame in the blade's own numbers."""
    blade = blade_expressions()
    entries = {}
    for base, kind in (
        (multiblade.MASS, "mass"),
        (multiblade.DAMPING, "damping"),
        (multiblade.STIFFNESS, "stiffness"),
    ):
        indices = [multiblade.BLADE_INDEX[name] for name in kin.COORDINATES]
        entries |= {
            base[row, column]: blade[kind][i, j]
            for i, row in enumerate(indices)
            for j, column in enumerate(indices)
        }
    names = multiblade.FIXED_COORDINATES
    n = len(names)
    parts = (multiblade.mass, multiblade.damping, multiblade.stiffness)
    return [
        sp.Matrix(n, n, lambda i, j, part=part: part(names[i], names[j]).xreplace(entries)) for part in parts
    ]
