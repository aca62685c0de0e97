"""The numbers of a deck by path, such as ``rotor.precone`` or ``support.modes[beam].frequency``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from proprotor.datum import PER_REV, Datum
from proprotor.deck.left import left_paths

if TYPE_CHECKING:
    from proprotor.deck.fields import Section
    from proprotor.deck.sections import Deck


LEFT = "left."  # before the path of a number that differs on the left side


def numbers_of(deck: Deck) -> dict[str, Datum]:
    """Return every number of a deck by path, frequencies per revolution in rad/s.

    A number that differs on the left side of an aircraft has the path ``left.rotor.control_stiffness``.
    """
    found = {path: _per_second(number, deck.operation.rotor_speed.si) for path, number in _numbers(deck)}
    if deck.left is None or deck.left_side is None:
        return found
    differ = left_paths(deck.left.model_dump(exclude_none=True))
    return found | {
        LEFT + path: number for path, number in numbers_of(deck.left_side).items() if path in differ
    }


def left_numbers(left_side: Deck, numbers: Mapping[str, Datum]) -> dict[str, Datum]:
    """Return the numbers of the left side of an aircraft by path: its own, and the numbers that both sides share."""
    return {
        path: numbers.get(LEFT + path, numbers.get(path, own)) for path, own in numbers_of(left_side).items()
    }


def own_numbers(numbers: Mapping[str, Datum], section: str) -> dict[str, Datum]:
    """Return the numbers of a section by field, without the numbers of sections inside."""
    places = {path: path.rpartition(".") for path in numbers}
    return {name: numbers[path] for path, (outer, _, name) in places.items() if outer == section}


def _numbers(section: Section, path: str = "") -> Iterator[tuple[str, Datum]]:
    """Yield every number of a section and of the sections inside, with its path."""
    for name in type(section).model_fields:
        entry, here = getattr(section, name), f"{path}.{name}" if path else name
        if isinstance(entry, Datum):
            yield here, entry
        elif isinstance(entry, list | tuple):
            for one in entry:
                if hasattr(type(one), "model_fields"):
                    yield from _numbers(one, f"{here}[{one.name}]")
        elif hasattr(type(entry), "model_fields"):
            yield from _numbers(entry, here)


def _per_second(number: Datum, rotor_speed: float) -> Datum:
    """Return a frequency in rad/s, with the rotor speed Ω of its file: n per revolution are n Ω."""
    if number.form != "frequency":
        return number
    own = rotor_speed if number.rotor_speed is None else number.rotor_speed
    si = number.si * own if number.unit == PER_REV else number.si
    return replace(number, si=si, unit="rad/s", rotor_speed=own)
