"""Entries of bulk data: fields of 8 characters, of 16 with a star after the name, or between commas.

Continuation lines begin with a blank, a star, a plus sign or a comma. A number may lack the E of its exponent (1.5-3),
or have a D in its place.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator

_FIRST, _LAST = 8, 72  # columns of the fields, after the name
_SMALL, _LARGE = 8, 16
_CONTINUES = " *+,"
_EXPONENT = re.compile(r"(?<=[0-9.])[dD]?(?=[+-])|[dD]")


def entries(lines: Iterable[str], names: Collection[str]) -> Iterator[tuple[str, list[str]]]:
    """Yield name and fields of the entries with some names, continuation lines included.

    A field that is left out is an empty text. The list has as many fields for each line as the line has room for:
    four of 16 characters, or eight of 8.

    Parameters
    ----------
    lines : iterable of str
    names : collection of str
        In capitals.
    """
    name, fields = "", []
    for line in lines:
        line = line.rstrip()
        if not line or line.startswith("$"):
            continue
        if line[0] in _CONTINUES:
            if name:
                fields += _fields(line)
            continue
        if name:
            yield name, fields
        found = re.split(r"[\s,*]", line, maxsplit=1)[0].upper()
        name, fields = (found, _fields(line)) if found in names else ("", [])
    if name:
        yield name, fields


def real(text: str) -> float:
    """Return a real number as Nastran writes it.

    Raises
    ------
    ValueError
        When the text is no number.
    """
    return float(_EXPONENT.sub("e", text.strip()))


def _fields(line: str) -> list[str]:
    """Return the fields of a line, as many as the line has room for."""
    large = "*" in line[:_FIRST]
    count = 4 if large else 8
    if "," in line:
        fields = [part.strip() for part in line.split(",")][1 : count + 1]
        return fields + [""] * (count - len(fields))
    width = _LARGE if large else _SMALL
    return [line[start : start + width].strip() for start in range(_FIRST, _LAST, width)]
