"""Check the text of a deck, which may come from anyone: printable, with prose on one line."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from proprotor.deck.tables import Place, each_value
from proprotor.errors import InputError, unprintable


def plain_text(tables: dict[str, Any], name_of: Callable[[Place, Any], str]) -> dict[str, Any]:
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
    problems = []

    def on_one_line(entry: Any, place: Place) -> Any:
        if not isinstance(entry, str):
            return entry
        text = " ".join(entry.split()) if _is_prose(place) else entry
        if code := unprintable(text):
            rule = f"must be printable text, without {code}"
            problems.append(InputError(name_of(_of_number(place), tables), text, rule))
        return text

    plain: dict[str, Any] = each_value(tables, on_one_line)
    if problems:
        first, *others = problems
        raise InputError(first.field, first.value, first.rule, others)
    return plain


def _of_number(place: Place) -> Place:
    """Return the place of a number that is written as a table, from the place of the text in the table."""
    return place[:-1] if place[-1:] == ("value",) else place


def _is_prose(place: Place) -> bool:
    return place[-1] == "source" or (
        place[0] == "case" and place[1:2] in (("description",), ("calibration",), ("warnings",))
    )
