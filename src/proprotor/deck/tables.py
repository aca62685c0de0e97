"""Walk the nested tables and lists of a deck."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

Place = tuple[str | int, ...]


def each_value(entry: Any, change: Callable[[Any, Place], Any], place: Place = ()) -> Any:
    """Return nested tables and lists with each value replaced by `change` of the value and its place."""
    if isinstance(entry, dict):
        return {name: each_value(inner, change, (*place, name)) for name, inner in entry.items()}
    if isinstance(entry, list):
        return [each_value(inner, change, (*place, number)) for number, inner in enumerate(entry)]
    return change(entry, place)
