"""Read distributions along the blade from a CSV file: one row a station, a unit in the head of each column.

::

    r [ft], twist [deg], chord [inch], mass_per_length [slug/ft]
    0.0,    34.4,        17.0,         0.90
    12.5,   -5.8,        13.5,         0.15

The column of the stations is ``r_over_R``, without a unit, or ``r`` with a unit. Commas, semicolons or tabs separate
the columns; numbers have a decimal point. Empty lines and lines that begin with ``#`` are ignored. Cells contain
numbers only: no formula is evaluated.
"""

from __future__ import annotations

import csv
import math
import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from proprotor.deck.reading import ANY, Bound
from proprotor.errors import InputError, printable, unknown_name
from proprotor.files.text import read_text
from proprotor.units import factor_to_si

_Line = tuple[int, list[str]]  # the number of a line in the file, and its cells

_STATIONS = ("r_over_R", "r")

_LARGEST = 1_000_000  # bytes
MOST_STATIONS = 10_000
_HEAD = re.compile(r"\s*([^\[\]]*?)\s*(?:\[([^\[\]]*)\])?\s*")
_NUMBER = re.compile(r"\s*[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?\s*")
_DELIMITERS = ",;\t"
_ROUNDING = 1e-9  # relative to the radius: a tip at 150 inch equals one at 12.5 ft


class _Distribution(NamedTuple):
    """A column of a file, along the blade.

    r_over_R : stations (n,), increasing; values : (n,) in SI
    """

    r_over_R: tuple[float, ...]
    values: tuple[float, ...]


class _Head(NamedTuple):
    """The head of a column: its place from 0, its text, name and unit."""

    place: int
    text: str
    name: str
    unit: str


class _Fault(Exception):
    """A rule that the file breaks."""


def read_stations(
    path: str | os.PathLike[str],
    column: str,
    unit: str,
    *,
    radius: float | None = None,
    bound: Bound = ANY,
) -> _Distribution:
    """Return one column of a file of blade stations.

    Parameters
    ----------
    path : str or path
    column : str
        Name of the column, without its unit.
    unit : str
        SI unit of the returned values; ``""`` for plain numbers.
    radius : float, optional
        m; needed where the stations are ``r``.
    bound : Bound
        A condition on each SI value, with its rule for a message.

    Raises
    ------
    InputError
        When the file cannot be read or is malformed: one line with the file, the line and column in it and the rule.
    """
    try:
        heads, rows = _table(read_text(Path(path), "file", Path(path).name, _LARGEST))
        stations, values = _stations_head(heads), _head(heads, column)
        to_si, scale = _factor(values, unit), _scale(stations, radius)
        return _distribution(rows, stations, scale, values, to_si, bound)
    except _Fault as fault:
        raise InputError("file", Path(path).name, str(fault)) from None


def _table(text: str) -> tuple[list[_Head], Iterator[_Line]]:
    """Return the heads of the columns, and the lines of cells below with their line numbers."""
    lines = [
        (number, line)
        for number, line in enumerate(re.split("\r\n|\r|\n", text), start=1)
        if line.strip(f" {_DELIMITERS}") and not line.lstrip().startswith("#")
    ]
    if not lines:
        raise _Fault("is empty; its first line must name the columns")
    number, first = lines[0]
    delimiter = max(_DELIMITERS, key=first.count)
    heads = [_as_head(number, place, text) for place, text in enumerate(_cells(number, first, delimiter))]
    names = [head.name for head in heads]
    for head in heads:
        if names.index(head.name) != head.place:
            raise _Fault(f'line {number}, column {head.place + 1}: "{head.name}" is named twice')
    return heads, _rows(lines[1:], delimiter, len(heads))


def _rows(lines: list[tuple[int, str]], delimiter: str, columns: int) -> Iterator[_Line]:
    """Yield the cells of each line with its line number."""
    for number, line in lines:
        cells = _cells(number, line, delimiter)
        if len(cells) > columns:  # a decimal comma makes two cells of a number
            raise _Fault(f"line {number}: has {len(cells)} cells for {columns} columns")
        yield number, cells


def _cells(number: int, line: str, delimiter: str) -> list[str]:
    """Return the cells of a line, without the empty cells that spreadsheets leave at its end."""
    try:
        (cells,) = csv.reader([line], delimiter=delimiter, strict=True, skipinitialspace=True)
    except (csv.Error, ValueError):
        raise _Fault(f"line {number}: has a quotation mark that is not closed") from None
    while cells and not cells[-1].strip():
        del cells[-1]
    return cells


def _as_head(number: int, place: int, text: str) -> _Head:
    """Return the head of a column from its text, name and unit."""
    match = _HEAD.fullmatch(text)
    if match is None or not match[1]:
        raise _Fault(f'line {number}, column {place + 1}: must be a name and a unit, such as "twist [deg]"')
    return _Head(place, text.strip(), match[1], (match[2] or "").strip())


def _head(heads: list[_Head], column: str) -> _Head:
    """Return the head of a column by name."""
    for head in heads:
        if head.name == column:
            return head
    raise _Fault(unknown_name(column, [head.name for head in heads], "column"))


def _stations_head(heads: list[_Head]) -> _Head:
    """Return the head of the column of stations."""
    found = [head for head in heads if head.name in _STATIONS]
    if len(found) != 1:
        fault = "has no column of stations" if not found else "has two columns of stations"
        raise _Fault(f'{fault}; give "r_over_R", or "r" with a unit')
    return found[0]


def _factor(head: _Head, unit: str) -> float:
    """Return the size of a column's unit in the SI unit."""
    try:
        return factor_to_si(head.text, head.unit, unit)
    except InputError as error:
        raise _Fault(f"column {head.place + 1} ({head.text}): {error.rule}") from None


def _scale(head: _Head, radius: float | None) -> float:
    """Return r/R of one unit of the stations."""
    if head.name == "r_over_R":
        return _factor(head, "")
    if radius is None:
        raise _Fault(f"column {head.place + 1} ({head.text}): needs the radius; give r_over_R")
    return _factor(head, "m") / radius


def _distribution(
    rows: Iterator[_Line], stations: _Head, scale: float, values: _Head, to_si: float, bound: Bound
) -> _Distribution:
    """Return the stations and values of all lines; refuse a station or value that breaks a rule."""
    r_over_R: list[float] = []
    found: list[float] = []
    for number, cells in rows:
        r = _on_the_blade(number, stations, _number(number, cells, stations) * scale)
        if r_over_R and r <= r_over_R[-1]:
            raise _at(number, stations, "must increase from line to line")
        value = _number(number, cells, values) * to_si
        if not math.isfinite(value):
            raise _at(number, values, "must be finite")
        if not bound.holds(value):
            raise _at(number, values, bound.rule)
        r_over_R.append(r)
        found.append(value)
        if len(found) > MOST_STATIONS:
            raise _Fault(f"line {number}: must have at most {MOST_STATIONS} stations")
    if len(found) < 2:
        raise _Fault("must have two stations or more")
    return _Distribution(tuple(r_over_R), tuple(found))


def _on_the_blade(number: int, head: _Head, r: float) -> float:
    """Return r/R, with rounding at root and tip removed."""
    if not -_ROUNDING <= r <= 1 + _ROUNDING:
        raise _at(number, head, f"is {r:.6g} R; must lie between 0 (centre of rotation) and R (tip)")
    return min(max(r, 0.0), 1.0)


def _number(number: int, cells: list[str], head: _Head) -> float:
    """Return the number in a column of a line."""
    if len(cells) <= head.place:
        raise _at(number, head, "has no such cell")
    text = cells[head.place]
    if not text.strip():
        raise _at(number, head, "is empty")
    if not _NUMBER.fullmatch(text):
        raise _at(number, head, f'"{printable(text.strip())[:30]}" is no number')
    return float(text)


def _at(number: int, head: _Head, rule: str) -> _Fault:
    """Return the fault at a line and column of the file."""
    return _Fault(f"line {number}, column {head.place + 1} ({head.text}): {rule}")
