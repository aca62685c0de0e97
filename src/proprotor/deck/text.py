"""The text of a deck, which is somebody else's: printable, and its prose on one line."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from proprotor.errors import InputError, unprintable

Place = tuple[str | int, ...]


def plain_text(tables: dict[str, Any], told: Callable[[Place, Any], str]) -> dict[str, Any]:
    """The tables of a deck with line ends and tabs of its prose as spaces.

    Parameters
    ----------
    tables : dict
    told : callable
        The name of a field in a message, from its place and the tables.

    Raises
    ------
    InputError
        For text with control characters, which would move the cursor of a terminal, and with what turns the
        direction of text round: a line for each.
    """
    plain: dict[str, Any] = _on_one_line(tables, ())
    problems = [
        InputError(told(_of_number(place), tables), text, f"must be printable text, without {code}")
        for place, text in _texts(plain, ())
        if (code := unprintable(text))
    ]
    if problems:
        first, *others = problems
        raise InputError(first.field, first.value, first.rule, others)
    return plain


def _of_number(place: Place) -> Place:
    """The place of a number that is written as a table, for that of the text within the table."""
    return place[:-1] if place[-1:] == ("value",) else place


def _on_one_line(entry: Any, place: Place) -> Any:
    if isinstance(entry, dict):
        return {name: _on_one_line(inner, (*place, name)) for name, inner in entry.items()}
    if isinstance(entry, list):
        return [_on_one_line(inner, (*place, number)) for number, inner in enumerate(entry)]
    return " ".join(entry.split()) if isinstance(entry, str) and _is_prose(place) else entry


def _is_prose(place: Place) -> bool:
    return place[-1] == "source" or (
        place[0] == "case" and place[1:2] in (("description",), ("calibration",), ("warnings",))
    )


def _texts(entry: Any, place: Place) -> Iterator[tuple[Place, str]]:
    """Every text of a deck with its place; names of fields are those that a deck has, or refused elsewhere."""
    if isinstance(entry, dict):
        for name, inner in entry.items():
            yield from _texts(inner, (*place, name))
    elif isinstance(entry, list):
        for number, inner in enumerate(entry):
            yield from _texts(inner, (*place, number))
    elif isinstance(entry, str):
        yield place, entry
