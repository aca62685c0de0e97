"""The tables of one airfoil in the lines of a C81 file, in each layout that programs write.

Columns
    Card images: seven columns for each number, nine numbers on a line; more numbers follow on lines that begin with
    seven blanks.
Wide columns
    Seven columns for each number, and all numbers of a row on one line.
Free
    Numbers separated by blanks, tabs or commas, as MBDyn writes below ``# FREE FORMAT`` and as DUST reads; the numbers
    of a row may go on in further lines.

Only the first line of MBDyn's files tells the layout, so all layouts are tried. A file that two layouts read as
different numbers is refused.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from proprotor.rotor.coefficient_surface import broken_rules
from proprotor.typing import Array

# In the order of the file, with the least allowed value of each coefficient.
COEFFICIENTS = {"lift": -np.inf, "drag": 0.0, "moment": -np.inf}

WIDTH, TO_A_LINE = 7, 9
_COMMENT = ("#", "!")
_NUMBER = re.compile(r" *[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eEdD][-+]?[0-9]+)? *")

Table = tuple[Array, Array, Array]  # angles in rad (n,), Mach numbers (m,), values (n, m)
_Row = Callable[["Lines", str, int, bool], list[float]]  # a row of so many values, with an angle or without


class Fault(Exception):
    """A rule that a line of the file breaks."""


@dataclass
class Lines:
    """The lines of a file, read one after another; comments are passed over."""

    lines: list[str]
    number: int = 0
    rows: int = 0  # rows of tables that were read whole
    header: str = "line 1"  # which announces how many numbers follow

    def peek(self) -> str | None:
        """Return the next line that is no comment, which stays the next; None at the end of the file."""
        while self.number < len(self.lines) and self.lines[self.number].lstrip().startswith(_COMMENT):
            self.number += 1
        return self.lines[self.number] if self.number < len(self.lines) else None

    def take(self, what: str) -> str:
        """Return the next line of the file; `what` says in the message what a missing line must have."""
        line = self.peek()
        if line is None:
            raise self.fault(f"is missing; it must have {what}", len(self.lines) + 1)
        self.number += 1
        return line

    def fault(self, rule: str, number: int | None = None) -> Fault:
        """Return the error of a line, by default the line read last."""
        return Fault(f"line {number or self.number}: {rule}")


def read_tables(lines: Lines, counts: list[int], *, free: bool) -> dict[str, Table]:
    """Return the tables of lift, drag and moment whose lines come next.

    Parameters
    ----------
    lines : Lines
    counts : list of int
        Mach numbers and angles of lift, drag and moment.
    free : bool
        Whether the file says that its layout is free.

    Raises
    ------
    Fault
        Of the first layout in which the Mach numbers of lift could be read, or else of the first layout.
    """
    start, found, faults = lines.number, [], []
    for layout in (_free,) if free else (_columns, _wide_columns, _free):
        lines.number, lines.rows = start, 0
        try:
            found.append((_tables(lines, counts, layout), lines.number))
        except Fault as fault:
            faults.append((lines.rows > 0, fault))
    if not found:
        raise max(faults, key=lambda pair: pair[0])[1]
    (tables, end), *others = found
    if any(other != end or not _same(tables, further) for further, other in others):
        rule = "reads as other numbers in columns than separated by blanks; without columns begin with # FREE FORMAT"
        raise lines.fault(rule, start + 1)
    lines.number = end
    return tables


def number_in(written: str) -> float:
    """Return the number that a text has, perhaps with a Fortran exponent D; NaN for another text."""
    if not _NUMBER.fullmatch(written):
        return math.nan
    return float(written.lower().replace("d", "e")) + 0.0  # a negative zero becomes zero


def _tables(lines: Lines, counts: list[int], row: _Row) -> dict[str, Table]:
    """Return the tables of an airfoil in one layout."""
    pairs = zip(COEFFICIENTS.items(), counts[::2], counts[1::2], strict=True)
    return {name: _table(lines, name, columns, rows, least, row) for (name, least), columns, rows in pairs}


def _table(lines: Lines, name: str, columns: int, rows: int, least: float, read_row: _Row) -> Table:
    """Return one table: its Mach numbers, and a row for each angle of attack."""
    numbers, records = [], []
    for row in range(rows + 1):
        first = f"the Mach numbers of {name}" if row == 0 else f"row {row} of {rows} of the {name} table"
        lines.peek()
        numbers.append(lines.number + 1)
        records.append(read_row(lines, first, columns, row > 0))
        lines.rows += 1
    mach, body = np.array(records[0]), np.array(records[1:])
    alpha, values = np.deg2rad(body[:, 0]), body[:, 1:]
    for row, rule in broken_rules(alpha, mach, values, least):
        raise lines.fault(f"{rule} ({name})", numbers[row])
    return alpha, mach, values


def _same(one: dict[str, Table], other: dict[str, Table]) -> bool:
    """Return whether the tables of two layouts have the same numbers."""
    return all(
        np.array_equal(first, second)
        for name in COEFFICIENTS
        for first, second in zip(one[name], other[name], strict=True)
    )


# Rows ---------------------------------------------------------------------------------------------


def _columns(lines: Lines, what: str, count: int, has_angle: bool, to_a_line: int = TO_A_LINE) -> list[float]:
    """Return one row in columns, its angle first if the row has one, from as many lines as the row takes."""
    line = lines.take(what)
    values = [_in_columns(lines, line, 0)] if has_angle else []
    for start in range(0, count, to_a_line):
        if start:
            line = lines.take(f"more of {what}")
        if (start or not has_angle) and line[:WIDTH].strip(" "):
            raise lines.fault(f"must have blanks in columns 1 to {WIDTH}, before values of {what}")
        here = min(count - start, to_a_line)
        values += [_in_columns(lines, line, place) for place in range(1, here + 1)]
        if line[(here + 1) * WIDTH : (to_a_line + 1) * WIDTH].strip(" "):
            raise lines.fault(f"must have no more than the {count} values that {lines.header} announces")
    return values


def _in_columns(lines: Lines, line: str, place: int) -> float:
    """Return the number in one field of seven columns."""
    start = place * WIDTH
    written = line[start : start + WIDTH]
    value = number_in(written)
    if not math.isfinite(value):
        found = repr(written.strip(" ")) if written.strip(" ") else "blanks"
        raise lines.fault(f"must have a number in columns {start + 1} to {start + WIDTH}, not {found}")
    return value


def _free(lines: Lines, what: str, count: int, has_angle: bool) -> list[float]:
    """Return one row of separated numbers, its angle first if the row has one, from as many lines as the row takes."""
    values: list[float] = []
    while len(values) < count + has_angle:
        line = lines.take(f"more of {what}" if values else what)
        for word in words_in(line):
            value = number_in(word)
            if not math.isfinite(value):
                raise lines.fault(f"must have numbers of {what}, not {word!r}")
            values.append(value)
    if len(values) > count + has_angle:
        end = "an angle and " * has_angle + f"the {count} values that {lines.header} announces"
        raise lines.fault(f"must have no more than {end}, for {what}")
    return values


def words_in(line: str) -> list[str]:
    """Return the words of a line, separated by commas, blanks or tabs, without a remark at its end."""
    plain = re.split(f"[{''.join(_COMMENT)}]", line)[0].strip().strip(",")
    return [word for cell in plain.split(",") for word in cell.split() or [""]] if plain.strip() else []


_wide_columns = partial(_columns, to_a_line=99)  # the largest count of two digits
