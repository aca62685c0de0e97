"""Generated equations: the modules that make up a model, and calls of their functions by the names of quantities."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from types import ModuleType
from typing import Any

import proprotor_equations as consistent
from proprotor_equations import published


@dataclass(frozen=True)
class EquationSet:
    """The generated modules that change when terms of the derivation are dropped, for the option ``equations``.

    The functions that all sets share are imported from `proprotor_equations` where they are used.

    Parameters
    ----------
    inertia, flap_lag_springs, pitch, airloads : module
        Each module has the functions and arguments of the module of the same name in `proprotor_equations.published`.
        A user's own set has the user's modules in some of the four places.
    """

    inertia: ModuleType
    flap_lag_springs: ModuleType
    pitch: ModuleType
    airloads: ModuleType


EQUATION_SETS = {
    name: EquationSet(package.inertia, package.flap_lag_springs, package.pitch, package.airloads)
    for name, package in {"consistent": consistent, "published": published}.items()
}


@cache
def keywords(function: Callable[..., Any]) -> Mapping[str, bool]:
    """Return the names of the quantities that a generated function takes, each with whether it may be left out."""
    parameters = inspect.signature(function).parameters.values()
    return {p.name: p.default is not p.empty for p in parameters if p.kind is p.KEYWORD_ONLY}


@cache
def _names(function: Callable[..., Any]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the names of the quantities that a generated function needs, and of those that may be left out."""
    found = keywords(function).items()
    return tuple(name for name, optional in found if not optional), tuple(
        name for name, optional in found if optional
    )


def evaluate(function: Callable[..., Any], quantities: Mapping[str, Any], *matrices: Any) -> Any:
    """Return the result of a generated function, whose keyword arguments are looked up among quantities by name.

    A quantity has one name throughout the derivation, so the names are the interface.

    Raises
    ------
    KeyError
        When a quantity that the function needs is missing.
    """
    needed, optional = _names(function)
    try:
        given = {name: quantities[name] for name in needed}
    except KeyError as missing:
        name = f"{function.__module__}.{function.__name__}"
        raise KeyError(f"{name} takes {missing}, which nothing gives; a field of Rotor does") from None
    if optional:
        given |= {name: quantities[name] for name in optional if name in quantities}
    return function(*matrices, **given)
