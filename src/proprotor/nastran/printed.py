"""Real modes at a grid point from the print file (.f06), whose numbers have seven digits.

Eigenvectors are printed with DISPLACEMENT(PRINT) = ALL. Those of buckling come without cycles. A page break may stand
anywhere among the grid points of a mode, and the heading is then printed again.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

import numpy as np

from proprotor.nastran.bulk_data import real
from proprotor.nastran.found import EigenvalueTable, FileFault, Found

_EIGENVALUES = "R E A L   E I G E N V A L U E S"
_EIGENVECTOR = re.compile(r"CYCLES =\s*\S+\s+R E A L   E I G E N V E C T O R   N O \.\s*(\d+)")
_COMPLEX = "C O M P L E X   E I G E N V E C T O R"
_EIGENVALUE = re.compile(r"\s*EIGENVALUE =\s*(\S+)\s*$")
_SUBCASE = re.compile(r"^0.*\bSUBCASE (\d+)")
_ROW = re.compile(r"\s+(\d+)\s+G((?:\s+\S+){6})\s*$")
_TABLE_ROW = re.compile(r"\s+(\d+)\s+\d+((?:\s+\S+){5})\s*$")
_NEW_PAGE = "1"  # in the first column
_ONE_SUBCASE = 1  # the number of a subcase that is not printed


def read_printed(lines: Iterable[str], grid: int) -> Found:
    """Return the real modes of a file at a grid point.

    Raises
    ------
    FileFault
        When a number cannot be read.
    """
    found = Found()
    subcase, eigenvalue, mode = _ONE_SUBCASE, np.nan, 0
    rows = iter(lines)
    for line in rows:
        if line.startswith(_NEW_PAGE):
            subcase, mode = _ONE_SUBCASE, 0
        elif given := _SUBCASE.match(line):
            subcase = int(given[1])
        elif given := _EIGENVALUE.match(line):
            eigenvalue, mode = _numbers(given[1])[0], 0
        elif _EIGENVALUES in line:
            found.tables += _table(rows)
        elif _COMPLEX in line:
            found.has_complex = True
        elif given := _EIGENVECTOR.search(line):
            mode = int(given[1])
            found.add((subcase, "", ""), mode, eigenvalue, None, in_pieces=True)
        elif mode and (given := _ROW.match(line)) and int(given[1]) == grid:
            motion = np.array(_numbers(given[2]))
            found.add((subcase, "", ""), mode, eigenvalue, motion, in_pieces=True)
    return found


def _table(rows: Iterator[str]) -> list[EigenvalueTable]:
    """Return the table of eigenvalues that begins here, its headings passed over; none if it has no row."""
    found: list[list[float]] = []
    for line in rows:
        if given := _TABLE_ROW.match(line):
            found.append([int(given[1]), *_numbers(given[2])])
        elif found:
            break
    if not found:
        return []
    values = np.array(found)
    return [EigenvalueTable(0, values[:, 0].astype(int), values[:, 1], values[:, 4])]


def _numbers(text: str) -> list[float]:
    """Return the numbers of a line."""
    try:
        return [real(word) for word in text.split()]
    except ValueError:
        raise FileFault(f"is damaged: {text.strip()} must be numbers") from None
