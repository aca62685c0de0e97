"""The functions of the catalogue as fused functions take them: for all rotors, or for rotors that lack something.

A plain rotor has nothing of `OPTIONAL` of derive/rotor.py: no linkages, no drive train, nothing beside its pitch axes.
Most other rotors have at least nothing beside the axes, none of `OFFSETS`. In the functions of such rotors these
quantities are zero from the start, so that a plan has no operation for them.
"""

from __future__ import annotations

import dataclasses
import functools
from dataclasses import dataclass

import sympy as sp

from derive.equations import consistent_functions
from derive.function import Function
from derive.plan import Place, Steps
from derive.rotor import OFFSETS, OPTIONAL


@dataclass(frozen=True)
class Catalogue:
    """Functions of the catalogue with some quantities at zero."""

    absent: frozenset[sp.Symbol] = frozenset()

    @functools.cache  # noqa: B019  # a few records in all
    def function(self, module: str, name: str) -> Function:
        """Return a function by its module and name."""
        return self.of(next(function for function in consistent_functions(module) if function.name == name))

    def entries(self, module: str, name: str) -> dict[Place, sp.Expr]:
        """Return the entries of a function that are not zero."""
        return entries_of(self.function(module, name))

    def of(self, function: Function) -> Function:
        """Return a function without what is absent."""
        zero = dict.fromkeys(self.absent, sp.Integer(0))
        values = {place: entry.value.xreplace(zero) for place, entry in function.entries.items()}
        kept = {
            place: dataclasses.replace(entry, value=values[place])
            for place, entry in function.entries.items()
            if values[place] != 0
        }
        return dataclasses.replace(function, entries=kept, steps=self.steps(function.steps))

    def steps(self, steps: Steps) -> list[tuple[sp.Symbol, sp.Expr]]:
        """Return named values without what is absent."""
        zero = dict.fromkeys(self.absent, sp.Integer(0))
        return [(symbol, sp.sympify(value).xreplace(zero)) for symbol, value in steps]


ALL_ROTORS, ON_AXIS, PLAIN_ROTORS = Catalogue(), Catalogue(OFFSETS), Catalogue(OPTIONAL)


def entries_of(function: Function) -> dict[Place, sp.Expr]:
    """Return the entries of a function by their places."""
    return {place: entry.value for place, entry in function.entries.items()}
