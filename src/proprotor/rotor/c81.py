"""C81 airfoil files: card images of seven columns for each number.

Line 1 has a title (columns 1-30) and six counts of two digits: Mach numbers and angles of lift, of drag and of moment.
Each of the three tables is a line of Mach numbers, whose first seven columns are blank, and a line for each angle of
attack in degrees. A line has nine values; more values follow on lines that begin with seven blanks.

The package has a reader of its own. The reader on the package index, c81utils 1.1.0, splits lines at blanks: it refuses
files whose numbers fill their columns (``-180.00-0.2800``) or that have more than 18 Mach numbers, and accepts wrong
files without a message: a column too many, NaN, overflow. Its errors name no line.
"""

from __future__ import annotations

import math
import os
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from proprotor.errors import InputError, printable
from proprotor.files.text import read_text
from proprotor.rotor.coefficient_surface import broken_rules
from proprotor.typing import Array

# In the order of the file, with the least allowed value of each coefficient.
COEFFICIENTS = {"lift": -np.inf, "drag": 0.0, "moment": -np.inf}

_LARGEST = 1_000_000  # bytes; three tables of 99 angles at 99 Mach numbers take a quarter of this
_WIDTH, _TO_A_LINE = 7, 9
_COUNTS = slice(30, 42)
_NUMBER = re.compile(r" *[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)? *")

Table = tuple[Array, Array, Array]  # angles in rad (n,), Mach numbers (m,), values (n, m)


def read_c81(path: str | os.PathLike[str]) -> tuple[str, dict[str, Table]]:
    """Return the title of a C81 file and its tables of lift, drag and moment.

    Raises
    ------
    InputError
        When the file cannot be read or is not C81: one line with the file, the number of the wrong line and the rule.
    """
    try:
        text = read_text(Path(path), "table", os.fspath(path), _LARGEST, encoding="latin-1")  # any title
        return _read(_Lines(re.split("\r\n|\r|\n", text.rstrip())))
    except _Fault as fault:
        raise InputError("table", os.fspath(path), str(fault)) from None


class _Fault(Exception):
    """A rule that the file breaks."""


@dataclass
class _Lines:
    """The lines of a file, read one after another."""

    lines: list[str]
    number: int = 0

    def take(self, what: str) -> str:
        """Return the next line of the file; `what` says in the message what a missing line must have."""
        if self.number == len(self.lines):
            raise self.fault(f"is missing; it must have {what}", self.number + 1)
        self.number += 1
        return self.lines[self.number - 1]

    def fault(self, rule: str, number: int | None = None) -> _Fault:
        """Return the error of a line, by default the line read last."""
        return _Fault(f"line {number or self.number}: {rule}")


def _read(lines: _Lines) -> tuple[str, dict[str, Table]]:
    """Return the title and the tables in the lines of a file."""
    header = lines.take("a title and six counts")
    counts = _counts(lines, header[_COUNTS])
    tables = {}
    for (name, least), columns, rows in zip(COEFFICIENTS.items(), counts[::2], counts[1::2], strict=True):
        tables[name] = _table(lines, name, columns, rows, least)
    if lines.number < len(lines.lines):
        rule = "must not be there: the counts of line 1 end the moment table before it"
        raise lines.fault(rule, lines.number + 1)
    return printable(header[: _COUNTS.start]).strip(), tables


def _counts(lines: _Lines, written: str) -> list[int]:
    """Return the counts of Mach numbers and angles in line 1, for lift, drag and moment."""
    if not re.fullmatch("([ 0-9][0-9]){6}", written):
        raise lines.fault("must have six counts of two digits in columns 31 to 42")
    counts = [int(written[i : i + 2]) for i in range(0, len(written), 2)]
    if min(counts[::2]) < 1 or min(counts[1::2]) < 2:
        raise lines.fault("must announce one Mach number and two angles of attack or more for each table")
    return counts


def _table(lines: _Lines, name: str, columns: int, rows: int, least: float) -> Table:
    """Return one table: its Mach numbers, and a row for each angle of attack."""
    numbers, records = [], []
    for row in range(rows + 1):
        first = f"the Mach numbers of {name}" if row == 0 else f"row {row} of {rows} of the {name} table"
        numbers.append(lines.number + 1)
        records.append(_record(lines, first, columns, has_angle=row > 0))
    mach, body = np.array(records[0]), np.array(records[1:])
    alpha, values = np.deg2rad(body[:, 0]), body[:, 1:]
    for row, rule in broken_rules(alpha, mach, values, least):
        raise lines.fault(f"{rule} ({name})", numbers[row])
    return alpha, mach, values


def _record(lines: _Lines, what: str, columns: int, has_angle: bool) -> list[float]:
    """Return one row of a table, its angle first if the row has one, from as many lines as the row takes."""
    line = lines.take(what)
    values = [_number(lines, line, 0)] if has_angle else []
    for start in range(0, columns, _TO_A_LINE):
        if start:
            line = lines.take(f"more of {what}")
        if (start or not has_angle) and line[:_WIDTH].strip(" "):
            raise lines.fault(f"must have blanks in columns 1 to {_WIDTH}, before values of {what}")
        here = min(columns - start, _TO_A_LINE)
        values += [_number(lines, line, place) for place in range(1, here + 1)]
        if line[(here + 1) * _WIDTH : (_TO_A_LINE + 1) * _WIDTH].strip(" "):
            raise lines.fault(f"must have no more than the {columns} values that line 1 announces")
    return values


def _number(lines: _Lines, line: str, place: int) -> float:
    """Return the number in one field of seven columns."""
    start = place * _WIDTH
    written = line[start : start + _WIDTH]
    value = float(written) if _NUMBER.fullmatch(written) else math.nan
    if not math.isfinite(value):
        found = repr(written.strip(" ")) if written.strip(" ") else "blanks"
        raise lines.fault(f"must have a number in columns {start + 1} to {start + _WIDTH}, not {found}")
    return value
