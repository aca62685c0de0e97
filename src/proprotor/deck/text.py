"""Check the text of a deck, which may come from anyone: printable, with prose on one line."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from proprotor.errors import InputError, unprintable

_Place = tuple[str | int, ...]


def plain_text(tables: dict[str, Any], name_of: Callable[[_Place, Any], str]) -> dict[str, Any]:
    """Return the tables of a deck with spaces in place of the line ends and tabs of its prose.

    Parameters
    ----------
    tables : dict
    name_of : callable
        Returns the name of a field for a message from its place and the tables.

    Raises
    ------
    InputError
        For text with control characters, which would move the cursor of a terminal, or with characters that reverse
        the direction of text: one line for each field.
    """
    plain: dict[str, Any] = _on_one_line(tables, ())
    problems = [
        InputError(name_of(_of_number(place), tables), text, f"must be printable text, without {code}")
        for place, text in _texts(plain, ())
        if (code := unprintable(text))
    ]
    if problems:
        first, *others = problems
        raise InputError(first.field, first.value, first.rule, others)
    return plain


def _of_number(place: _Place) -> _Place:
    """Return the place of a number that is written as a table, from the place of the text in the table."""
    return place[:-1] if place[-1:] == ("value",) else place


def _on_one_line(entry: Any, place: _Place) -> Any:
    """Return an entry with its prose on one line."""
    if isinstance(entry, dict):
        return {name: _on_one_line(inner, (*place, name)) for name, inner in entry.items()}
    if isinstance(entry, list):
        return [_on_one_line(inner, (*place, number)) for number, inner in enumerate(entry)]
    return " ".join(entry.split()) if isinstance(entry, str) and _is_prose(place) else entry


def _is_prose(place: _Place) -> bool:
    return place[-1] == "source" or (
        place[0] == "case" and place[1:2] in (("description",), ("calibration",), ("warnings",))
    )


def _texts(entry: Any, place: _Place) -> Iterator[tuple[_Place, str]]:
    """Yield every text of a deck with its place; names of fields are checked by the sections."""
    if isinstance(entry, dict):
        for name, inner in entry.items():
            yield from _texts(inner, (*place, name))
    elif isinstance(entry, list):
        for number, inner in enumerate(entry):
            yield from _texts(inner, (*place, number))
    elif isinstance(entry, str):
        yield place, entry
