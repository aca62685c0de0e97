"""Airfoils in C81 files, in the dialects of the programs that write them.

An airfoil is a line with its title and six counts, the Mach numbers and angles of lift, of drag and of moment, and
three tables: a row of Mach numbers, and a row for each angle of attack in degrees. `proprotor.rotor.c81_layouts` has
the layouts of rows. What stands around the tables depends on the program:

Counts
    Two digits each in columns 31 to 42, after the title; or six whole numbers at the end of the line.
Several airfoils
    One after another, perhaps with lines END between them.
DUST, OpenCOPTER
    Three lines of numbers, the first of which begins with the number of tables; then before each table a comment, and a
    line with the Reynolds number of the table and a Mach number.
MBDyn
    A first line ``# FREE FORMAT``, after which numbers are separated and need no columns.
Comments
    Lines that begin with # or !.

The package has a reader of its own. The reader on the package index, c81utils 1.1.0, splits lines at blanks: it refuses
files whose numbers fill their columns (``-180.00-0.2800``) or that have more than 18 Mach numbers, and accepts wrong
files without a message: a column too many, NaN, overflow. Its errors name no line.
"""

from __future__ import annotations

import math
import os
import re
from pathlib import Path
from typing import NamedTuple

from proprotor.errors import InputError, printable, unknown_name
from proprotor.files.text import read_text
from proprotor.rotor.c81_layouts import Fault, Lines, Table, number_in, read_tables, words_in

_LARGEST = 1_000_000  # bytes; three tables of 99 angles at 99 Mach numbers take a quarter of this
_TITLE, _LONGEST_HEADER = 30, 200  # columns
_PAIRS = "([ 0-9][0-9]){6}"
_AFTER_TITLE = re.compile(rf"(?P<title>.*[^\s0-9.,+-].*?)(?P<counts>([\s,]+[0-9]{{1,2}}){{6}}|\s{_PAIRS})\s*")
_FREE_FORMAT = "# FREE FORMAT"
_SAME = 1e-3  # relative to a Reynolds number: files have few digits


class _C81Airfoil(NamedTuple):
    """An airfoil of a file: its title, its Reynolds number if the file has one, and tables of lift, drag and moment."""

    title: str
    reynolds: float | None
    tables: dict[str, Table]


def read_c81(
    path: str | os.PathLike[str], table_name: str | None = None, table_reynolds: float | None = None
) -> _C81Airfoil:
    """Return the airfoil of a C81 file: the first one, or that of a title or a Reynolds number.

    Parameters
    ----------
    path : str or path
    table_name : str, optional
        Title of the airfoil, in capitals or not.
    table_reynolds : float, optional
        Reynolds number of the table, dimensionless; needed where the file has tables of one airfoil at several.

    Raises
    ------
    InputError
        When the file cannot be read or is not C81: one line with the file, the number of the wrong line and the rule.
        When the file has no such table, or several among which a Reynolds number must choose.
    """
    try:
        text = read_text(Path(path), "table", os.fspath(path), _LARGEST, encoding="latin-1")  # any title
        airfoils = airfoils_in(text)
    except Fault as fault:
        raise InputError("table", os.fspath(path), str(fault)) from None
    named = airfoils if table_name is None else _of_name(airfoils, table_name)
    return _of_reynolds(named, table_reynolds)


def airfoils_in(text: str) -> list[_C81Airfoil]:
    """Return all airfoils in the text of a file.

    Raises
    ------
    Fault
        With the number of the wrong line and its rule.
    """
    lines = Lines(re.split("\r\n|\r|\n", text.rstrip()))
    free = lines.lines[0].upper().startswith(_FREE_FORMAT)
    announced = _preamble(lines)
    found = [_airfoil(lines, announced > 0, free)]
    while _more_follows(lines):
        found.append(_airfoil(lines, announced > 0, free))
    if announced and announced != len(found):
        raise lines.fault(f"ends the file with {len(found)} tables, and its first line announces {announced}")
    return found


def _preamble(lines: Lines) -> int:
    """Pass over the three lines of numbers with which files of DUST begin; return how many tables follow, 0 without."""
    first = lines.peek()
    if first is None or _header(first) or not (numbers := _numbers(first)):
        return 0
    if not numbers[0].is_integer() or numbers[0] < 1:
        raise lines.fault("must begin with the number of tables, as files of DUST do", lines.number + 1)
    for _ in range(3):
        if not _numbers(lines.take("numbers, as files of DUST have before their tables")):
            raise lines.fault("must have numbers, as files of DUST have in their first three lines")
    return int(numbers[0])


def _more_follows(lines: Lines) -> bool:
    """Pass over blank lines and lines END; return whether another airfoil follows."""
    while (line := lines.peek()) is not None and (not line.strip() or line.split()[0].upper() == "END"):
        lines.number += 1
    return line is not None


def _airfoil(lines: Lines, of_dust: bool, free: bool) -> _C81Airfoil:
    """Return the airfoil whose lines come next."""
    reynolds = _reynolds(lines) if of_dust else None
    before = lines.header if lines.number else ""
    line = lines.take("a title and six counts")
    header = _header(line)
    if header is None:
        rule = "must have six counts of two digits in columns 31 to 42"
        if before and not of_dust:
            rule = f"must not be there: the counts of {before} end the moment table before it"
        raise lines.fault(rule)
    title, counts = header
    if min(counts[::2]) < 1 or min(counts[1::2]) < 2:
        raise lines.fault("must announce one Mach number and two angles of attack or more for each table")
    lines.header = f"line {lines.number}"
    return _C81Airfoil(title, reynolds, read_tables(lines, counts, free=free))


def _reynolds(lines: Lines) -> float:
    """Return the Reynolds number in the two lines before a table of DUST, a comment and numbers."""
    line = lines.take("a comment, as files of DUST have before each table")
    after = lines.peek()
    if not _numbers(line) or after is None or not _header(after):  # else the comment was passed over already
        line = lines.take("the Reynolds number of the table")
    numbers = _numbers(line)
    if not numbers or not numbers[0] > 0:
        raise lines.fault("must have a Reynolds number above zero and a Mach number, as files of DUST have")
    return numbers[0]


def _header(line: str) -> tuple[str, list[int]] | None:
    """Return the title and the counts of a line, if it has them in their columns or at its end."""
    title, counts = line[:_TITLE], line[_TITLE : _TITLE + 12]
    if re.fullmatch(_PAIRS, counts):
        return printable(title).strip(), _pairs(counts)
    match = _AFTER_TITLE.fullmatch(line) if len(line) <= _LONGEST_HEADER else None
    if match is None:
        return None
    title, counts = printable(match["title"]).strip(" ,\"'"), match["counts"]
    separated = words_in(counts)
    return title, [int(word) for word in separated] if len(separated) == 6 else _pairs(counts[1:])


def _pairs(written: str) -> list[int]:
    """Return counts of two digits each."""
    return [int(written[i : i + 2]) for i in range(0, 12, 2)]


def _numbers(line: str) -> list[float]:
    """Return the numbers of a line; none if the line has anything else."""
    found = [number_in(word) for word in words_in(line)]
    return found if all(map(math.isfinite, found)) else []


# Choosing -----------------------------------------------------------------------------------------


def _of_name(airfoils: list[_C81Airfoil], name: str) -> list[_C81Airfoil]:
    """Return the airfoils of a title."""
    found = [airfoil for airfoil in airfoils if airfoil.title.casefold() == name.strip().casefold()]
    if not found:
        titles = dict.fromkeys(airfoil.title for airfoil in airfoils)
        raise InputError("table_name", name, unknown_name(name, list(titles), "table of the file"))
    return found


def _of_reynolds(airfoils: list[_C81Airfoil], wanted: float | None) -> _C81Airfoil:
    """Return the first airfoil, or that of a Reynolds number, which must be given where the file has several."""
    known = [airfoil.reynolds for airfoil in airfoils if airfoil.reynolds is not None]
    if wanted is None:
        if len(known) > 1:
            rule = f"must be given: the file, in the dialect of DUST, has tables at {_listed(known)}"
            raise InputError("table_reynolds", None, rule)
        return airfoils[0]
    if not known:
        raise InputError("table_reynolds", wanted, "must not be given: the file has no Reynolds numbers")
    for airfoil in airfoils:
        if airfoil.reynolds is not None and math.isclose(airfoil.reynolds, wanted, rel_tol=_SAME):
            return airfoil
    raise InputError("table_reynolds", wanted, f"must be one of the file's: {_listed(known)}")


def _listed(numbers: list[float]) -> str:
    """Return Reynolds numbers as a message lists them."""
    return ", ".join(f"{number:.10g}" for number in numbers)
