"""Give the frequencies per revolution of a deck the rotor speed of the file in which they are written."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from proprotor.deck.reading import read_quantity
from proprotor.deck.written import PerRevolution
from proprotor.errors import InputError


def per_revolution_of(speed: Mapping[str, Any], tables: dict[str, Any]) -> dict[str, Any]:
    """Return tables whose frequencies per revolution have the rotor speed of other tables, unless they have one.

    Without a readable rotor speed the tables stay as they are: `proprotor.deck.validation` reports the error.
    """
    rotor_speed = _rotor_speed(speed)
    if rotor_speed is None:
        return tables

    def with_speed(entry: Any) -> Any:
        if isinstance(entry, str) and entry.endswith("/rev") and not isinstance(entry, PerRevolution):
            return PerRevolution.of(entry, rotor_speed)
        return entry

    whole: dict[str, Any] = _every(tables, with_speed)
    return whole


def as_one_file(tables: dict[str, Any]) -> dict[str, Any]:
    """Return tables as one file can hold them: frequencies per revolution of another rotor speed in rad/s."""
    rotor_speed = _rotor_speed(tables)

    def in_this_file(entry: Any) -> Any:
        other = isinstance(entry, PerRevolution) and entry.rotor_speed != rotor_speed
        return entry.per_second if other else entry

    whole: dict[str, Any] = _every(tables, in_this_file)
    return whole


def _every(entry: Any, changed: Callable[[Any], Any]) -> Any:
    """Return nested tables and lists with each value changed."""
    if isinstance(entry, dict):
        return {name: _every(value, changed) for name, value in entry.items()}
    if isinstance(entry, list):
        return [_every(value, changed) for value in entry]
    return changed(entry)


def _rotor_speed(tables: Mapping[str, Any]) -> float | None:
    """Return the rotor speed of a deck in rad/s, None without a readable one."""
    try:
        return float(read_quantity(tables["operation"]["rotor_speed"], "rad/s").si)
    except (InputError, KeyError, TypeError):
        return None
