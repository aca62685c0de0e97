"""Lay out a table within the width of a terminal: what is a number stays whole, and words wrap between words.

A table that fits stands as it is. Else its headings wrap, then its last column, if that is text. Where too little room
is left for a last column of long text, what is too long stands beneath its row, over the whole width. Then other
columns of text wrap, and where that does not suffice, long names, such as a field of a deck, break after a dot, an
underscore or a bracket.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

_GAP = 2  # spaces between two columns
_INDENT = 4  # of text that stands beneath a row
_BREAK = re.compile(r"(?<=[._\]])(?=[^\W\d])")  # between the parts of a long name; a number has none


class _Laid(NamedTuple):
    """The lines of a table: those of the headings, and those of the rows."""

    head: list[str]
    body: list[str]


class _Widths(NamedTuple):
    """The width of each column, whether long cells of the last one stand beneath, and whether long names break."""

    of_columns: list[int]
    beneath: bool = False
    broken: bool = False


def laid_out(
    columns: Sequence[str], rows: Iterable[Sequence[str]], text: Sequence[str], width: int, narrowest: int
) -> _Laid:
    """Return the lines of a table, no longer than `width` unless a number or a part of a name needs more.

    Parameters
    ----------
    columns : sequence of str
        Headings.
    rows : iterable of sequence of str
        A cell for each column.
    text : sequence of str
        Columns of words, which are set to the left and may wrap; numbers are set to the right.
    width : int
        Characters of a line.
    narrowest : int
        Characters that a last column of long text must have, or it stands beneath its rows.
    """
    table = [tuple(columns), *map(tuple, rows)]
    words = [name in text for name in columns]
    found = _widths(table, words, width, narrowest)
    head, *body = (_row(cells, words, found, width, upward=not place) for place, cells in enumerate(table))
    return _Laid(head, [line for lines in body for line in lines])


def _widths(table: list[tuple[str, ...]], words: list[bool], width: int, narrowest: int) -> _Widths:
    """Return the first widths, in the order of the docstring of this module, by which the table fits."""
    whole = [max(map(len, cells)) for cells in zip(*table, strict=True)]
    if _total(whole) <= width:
        return _Widths(whole)
    longest = _longest(table, words, str.split)
    heads = [max([_of_word(cells[0], str.split), *map(len, cells[1:])]) for cells in zip(*table, strict=True)]
    wrapped = _shrunk(whole, heads, width)
    if _total(wrapped) <= width:
        return _Widths(wrapped)
    room = width - _total(heads[:-1]) - _GAP
    if words[-1] and room >= min(heads[-1], max(narrowest, longest[-1])):
        return _Widths([*heads[:-1], min(room, heads[-1])])
    beneath = words[-1] and heads[-1] > narrowest
    wide = heads[:-1] if beneath else heads
    wrapped = _shrunk(wide, longest, width)
    if _total(wrapped) <= width:
        return _Widths(wrapped, beneath)
    parts = _longest(table, words, _parts)
    return _Widths(_shrunk(wide, parts, width), beneath, broken=True)


def _total(widths: Sequence[int]) -> int:
    return sum(widths) + _GAP * (len(widths) - 1)


def _longest(table: list[tuple[str, ...]], words: list[bool], split: Callable[[str], list[str]]) -> list[int]:
    """Return the least width of each column: of text the longest word, of numbers the longest number."""
    return [
        max(_of_word(cell, split if word or not place else _whole) for place, cell in enumerate(cells))
        for cells, word in zip(zip(*table, strict=True), words, strict=True)
    ]


def _of_word(cell: str, split: Callable[[str], list[str]]) -> int:
    return max(map(len, split(cell)), default=0)


def _whole(cell: str) -> list[str]:
    return [cell]


def _parts(cell: str) -> list[str]:
    """Return the parts of the words of a cell between which long names may break."""
    return [part for word in cell.split() for part in _BREAK.split(word)]


def _shrunk(widths: list[int], least: list[int], width: int) -> list[int]:
    """Return widths from which the widest columns gave up characters, until the table fits or none has any left."""
    found = list(widths)
    while _total(found) > width:
        spare = [(wide, place) for place, wide in enumerate(found) if wide > least[place]]
        if not spare:
            break
        found[max(spare)[1]] -= 1
    return found


def _row(cells: tuple[str, ...], words: list[bool], found: _Widths, width: int, *, upward: bool) -> list[str]:
    """Return the lines of a row; cells of fewer lines than others stand at the top, headings at the bottom."""
    count = len(found.of_columns)
    columns = [
        _wrapped(cell, wide, broken=found.broken)
        for cell, wide in zip(cells[:count], found.of_columns, strict=True)
    ]
    height = max(map(len, columns))
    filled = [
        [""] * (height - len(lines)) + lines if upward else lines + [""] * (height - len(lines))
        for lines in columns
    ]
    settled = (
        [line.ljust(wide) if word else line.rjust(wide) for line in lines]
        for lines, wide, word in zip(filled, found.of_columns, words[:count], strict=True)
    )
    lines = [(" " * _GAP).join(line) for line in zip(*settled, strict=True)]
    below: list[str] = []
    if found.beneath:
        place = -1 if upward else 0
        if _total(found.of_columns) + _GAP + len(cells[-1]) <= width:
            lines[place] += f"{'':{_GAP}}{cells[-1]}"
        else:
            below = _wrapped(cells[-1], max(1, width - _INDENT), broken=found.broken)
    return [line.rstrip() for line in lines] + [f"{'':{_INDENT}}{line}" for line in below if line]


def _wrapped(cell: str, width: int, *, broken: bool) -> list[str]:
    """Return the lines of a cell; a number stays beside its percent sign."""
    if len(cell) <= width:
        return [cell]
    text = cell.replace(" %", "\N{NO-BREAK SPACE}%")
    lines = textwrap.wrap(text, width, break_long_words=False, break_on_hyphens=False) or [""]
    if broken:
        lines = [part for line in lines for part in _name_wrapped(line, width)]
    return [line.replace("\N{NO-BREAK SPACE}", " ") for line in lines]


def _name_wrapped(line: str, width: int) -> list[str]:
    """Return the lines of a name that is too long for one line, as many of its parts on each as fit."""
    found = [""]
    for part in _BREAK.split(line):
        if found[-1] and len(found[-1]) + len(part) > width:
            found.append("")
        found[-1] += part
    return found
