"""Entry by entry: what a generated function gives beside what it ought to be."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.mutation.mutants import generated_modules

Names = tuple[str, str]  # module and function

# An entry is held to a part of itself, so that a small entry beside large ones counts as much as they do. Both sides
# are exact to rounding, some 1e-15 of the terms that are summed; where those cancel, rounding is a part of their size.
RELATIVE = 1e-10
ROUNDING = 1e-13


@dataclass(frozen=True)
class Check:
    """Arrays by name that a generated function gives, beside what they ought to be.

    sees is (module, function) of the function; told, where the expectation comes from; actual gives arrays by name;
    expected has them as they ought to be, and natural the size of the terms they are made of.
    """

    sees: Names
    told: str
    actual: Callable[[], Mapping[str, Any]]
    expected: Mapping[str, Any]
    natural: Mapping[str, Any]

    def excess(self) -> float:
        """Largest difference of an entry over what is allowed: not above 1 where all agree, infinite for no number."""
        try:
            with np.errstate(all="ignore"):
                return max(self._of(name, value) for name, value in self.actual().items())
        except (ArithmeticError, AttributeError, ValueError, TypeError):
            return np.inf

    def _of(self, name: str, value: Any) -> float:
        expected = np.asarray(self.expected[name])
        difference = np.abs(np.broadcast_to(value, expected.shape) - expected)
        allowed = RELATIVE * np.abs(expected) + ROUNDING * np.abs(self.natural[name])
        over = np.where(difference == 0, 0.0, difference / allowed)
        return float(np.where(np.isnan(over), np.inf, over).max())


def values_check(
    sees: Names,
    told: str,
    quantities: Mapping[str, Any],
    expected: Mapping[str, Any],
    natural: Mapping[str, Any] | None = None,
    *blade: NDArray,
) -> Check:
    """A check of a function of named values; without other sizes each is its own.

    `blade` has the matrices of a blade, if the function takes any.
    """

    def actual() -> dict[str, Any]:
        values = call(sees, quantities, *blade)._asdict()
        return {name: values[name] for name in expected}

    return Check(sees, told, actual, expected, expected if natural is None else natural)


def matrix_check(
    sees: Names, told: str, quantities: Mapping[str, Any], expected: NDArray, natural: Any, *blade: NDArray
) -> Check:
    """A check of a function that makes a matrix, of those of a `blade` if it takes any."""
    name = sees[1]
    return Check(
        sees, told, lambda: {name: call(sees, quantities, *blade)}, {name: expected}, {name: natural}
    )


def call(names: Names, quantities: Mapping[str, Any], *matrices: NDArray) -> Any:
    """Result of the function that stands in the module now, its arguments by the names of their quantities.

    Arguments that no quantity has are left to their defaults.
    """
    given = {name: quantities[name] for name in _arguments(names) if name in quantities}
    return getattr(generated_modules()[names[0]], names[1])(*matrices, **given)


@functools.cache
def _arguments(names: Names) -> Iterable[str]:
    """A mutant has the arguments of the original."""
    code = getattr(generated_modules()[names[0]], names[1]).__code__
    return code.co_varnames[code.co_argcount : code.co_argcount + code.co_kwonlyargcount]
