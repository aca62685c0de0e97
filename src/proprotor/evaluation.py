"""Calling generated functions by the names of their quantities."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any


@cache
def keywords(function: Callable[..., Any]) -> tuple[str, ...]:
    """Names of the quantities a generated function takes."""
    parameters = inspect.signature(function).parameters.values()
    return tuple(p.name for p in parameters if p.kind is inspect.Parameter.KEYWORD_ONLY)


@cache
def _optional(function: Callable[..., Any]) -> frozenset[str]:
    """Names of the quantities that a generated function can do without."""
    parameters = inspect.signature(function).parameters.values()
    return frozenset(p.name for p in parameters if p.default is not inspect.Parameter.empty)


def evaluate(function: Callable[..., Any], quantities: Mapping[str, Any], *matrices: Any) -> Any:
    """Result of a generated function whose keyword arguments are looked up by name.

    A quantity has one name throughout the derivation, so the names are the interface.

    Raises
    ------
    KeyError
        When a quantity the function needs is not there.
    """
    optional = _optional(function)
    names = (name for name in keywords(function) if name in quantities or name not in optional)
    try:
        given = {name: quantities[name] for name in names}
    except KeyError as missing:
        told = f"{function.__module__}.{function.__name__} takes {missing}, which nothing gives; a field of Rotor does"
        raise KeyError(told) from None
    return function(*matrices, **given)
