"""Tables that users give as CSV: one line names the columns, each with its unit, and lines of cells follow.

::

    r [ft], twist [deg], chord [inch]

Commas, semicolons or tabs separate the columns, and Excel's line ``sep=;`` may say which; a unit stands in brackets or
parentheses, where a dash stands for no unit. Numbers have a decimal point, or, between semicolons or tabs, all of them
a decimal comma. Empty lines and lines that begin with ``#`` are ignored.
Cells contain numbers or words only: no formula is evaluated.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator
from typing import NamedTuple

from proprotor.errors import InputError, printable, unknown_name
from proprotor.units import factor_to_si

Line = tuple[int, list[str]]  # the number of a line in the file, and its cells

_HEAD = re.compile(r"\s*([^\[\]]*?)\s*(?:\[([^\[\]]*)\])?\s*")
_IN_PARENTHESES = re.compile(r"\s*([^()\[\]]*?)\s*\(([^\[\]]*)\)\s*")
_NUMBER = re.compile(r"\s*[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?\s*")
_DELIMITERS = ",;\t"
_SEPARATOR = re.compile(rf"sep=([{_DELIMITERS}])[{_DELIMITERS}]*\s*", re.IGNORECASE)
_DASHES = ("-", "–", "—")  # in place of a unit
_WITH_COMMA = re.compile(r"(?<![^;\t\s+-])\d+,\d+(?![^;\t\seE])")
_WITH_POINT = re.compile(r"\d\.\d")


class Head(NamedTuple):
    """The head of a column: its place from 0, its text, name and unit."""

    place: int
    text: str
    name: str
    unit: str


class Fault(Exception):
    """A rule that the file breaks."""


def table_of(text: str) -> tuple[list[Head], Iterator[Line]]:
    """Return the heads of the columns, and the lines of cells below with their line numbers."""
    lines = [
        (number, line)
        for number, line in enumerate(re.split("\r\n|\r|\n", text), start=1)
        if line.strip(f" {_DELIMITERS}") and not line.lstrip().startswith("#")
    ]
    told = _SEPARATOR.fullmatch(lines[0][1]) if lines else None
    if told:
        del lines[0]
    if not lines:
        raise Fault("is empty; its first line must name the columns")
    number, first = lines[0]
    _check_no_title(lines)
    delimiter = told[1] if told else max(_DELIMITERS, key=first.count)
    heads = [_as_head(number, place, text) for place, text in enumerate(_cells(number, first, delimiter))]
    names = [head.name for head in heads]
    for head in heads:
        if names.index(head.name) != head.place:
            raise Fault(f'line {number}, column {head.place + 1}: "{head.name}" is named twice')
    return heads, _rows(_with_points(lines[1:], delimiter), delimiter, len(heads))


def _check_no_title(lines: list[tuple[int, str]]) -> None:
    """Refuse a line of one cell above the line that names the columns, such as the title of a sheet."""
    several = [any(one in line.strip(f" {_DELIMITERS}") for one in _DELIMITERS) for _, line in lines[:2]]
    if several == [False, True]:
        raise Fault(f'line {lines[0][0]}: must name the columns; a title is a line that begins with "#"')


def _with_points(lines: list[tuple[int, str]], delimiter: str) -> list[tuple[int, str]]:
    """Return the lines with decimal points in place of decimal commas; refuse lines that have both."""
    if delimiter == ",":
        return lines
    commas = [number for number, line in lines if _WITH_COMMA.search(line)]
    points = [number for number, line in lines if _WITH_POINT.search(line)]
    if commas and points:
        raise Fault(
            f"has decimal commas (line {commas[0]}) and decimal points (line {points[0]}); use one of them"
        )
    if not commas:
        return lines
    return [
        (number, _WITH_COMMA.sub(lambda found: found[0].replace(",", "."), line)) for number, line in lines
    ]


def _rows(lines: list[tuple[int, str]], delimiter: str, columns: int) -> Iterator[Line]:
    """Yield the cells of each line with its line number."""
    for number, line in lines:
        cells = _cells(number, line, delimiter)
        if len(cells) > columns:  # a decimal comma makes two cells of a number
            raise Fault(f"line {number}: has {len(cells)} cells for {columns} columns")
        yield number, cells


def _cells(number: int, line: str, delimiter: str) -> list[str]:
    """Return the cells of a line, without the empty cells that spreadsheets leave at its end."""
    try:
        (cells,) = csv.reader([line], delimiter=delimiter, strict=True, skipinitialspace=True)
    except (csv.Error, ValueError):
        raise Fault(f"line {number}: has a quotation mark that is not closed") from None
    while cells and not cells[-1].strip():
        del cells[-1]
    return cells


def _as_head(number: int, place: int, text: str) -> Head:
    """Return the head of a column from its text, name and unit."""
    match = _IN_PARENTHESES.fullmatch(text) or _HEAD.fullmatch(text)
    if match is None or not match[1]:
        raise Fault(f'line {number}, column {place + 1}: must be a name and a unit, such as "twist [deg]"')
    unit = (match[2] or "").strip()
    return Head(place, text.strip(), match[1], "" if unit in _DASHES else unit)


def head_of(heads: list[Head], column: str) -> Head:
    """Return the head of a column by name."""
    for head in heads:
        if head.name == column:
            return head
    raise Fault(unknown_name(column, [head.name for head in heads], "column"))


def factor_of(head: Head, unit: str) -> float:
    """Return the size of a column's unit in the SI unit."""
    try:
        return factor_to_si(head.text, head.unit, unit)
    except InputError as error:
        where = "" if head.unit else f'; write "{head.name} [unit]"'
        raise Fault(f"column {head.place + 1} ({head.text}): {error.rule}{where}") from None


def number_in(number: int, cells: list[str], head: Head) -> float:
    """Return the number in a column of a line."""
    if len(cells) <= head.place:
        raise fault_at(number, head, "has no such cell")
    text = cells[head.place]
    if not text.strip():
        raise fault_at(number, head, "is empty")
    if not _NUMBER.fullmatch(text):
        raise fault_at(number, head, f'"{printable(text.strip())[:30]}" is no number')
    if not math.isfinite(found := float(text)):
        raise fault_at(number, head, "must be finite")
    return found


def check_order(number: int, head: Head, place: float, before: float) -> None:
    """Refuse a station that is not outboard of the station of the line before."""
    if place == before:
        rule = "is the station of the line before; set the two sides of a step a little apart"
        raise fault_at(number, head, rule)
    if place < before:
        raise fault_at(number, head, "must increase from line to line")


def fault_at(number: int, head: Head, rule: str) -> Fault:
    """Return the fault at a line and column of the file."""
    return Fault(f"line {number}, column {head.place + 1} ({head.text}): {rule}")
