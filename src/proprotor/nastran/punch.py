"""Real modes at a grid point from a punch file (.pch), written for DISPLACEMENT(PUNCH) = ALL.

Lines that begin with $ name what follows: the kind of result, its form, the subcase, the eigenvalue and the mode. A
grid point takes two lines: number, type and T1 to T3, then R1 to R3 after -CONT-. The columns from 73 on number the
lines. The file has no generalised masses.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

import numpy as np

from proprotor.nastran.bulk_data import real
from proprotor.nastran.found import FileFault, Found
from proprotor.typing import Array

_LAST = 72  # columns that are not the number of the line
_VALUES = ((18, 36), (36, 54), (54, 72))
_MODE = re.compile(r"\$EIGENVALUE =\s*(\S+)\s+MODE =\s*(\d+)")
_SUBCASE = re.compile(r"\$SUBCASE ID =\s*(\d+)")
_ONE_POINT = "$POINT ID ="  # above the motion of one point in all modes
_FORMS = ("$REAL OUTPUT", "$REAL-IMAGINARY OUTPUT", "$MAGNITUDE-PHASE OUTPUT")


def read_punch(lines: Iterable[str], grid: int) -> Found:
    """Return the real modes of a file at a grid point.

    Raises
    ------
    FileFault
        When a line cannot be read, or the eigenvectors are sorted by grid points.
    """
    found = Found()
    title: list[str] = []
    reading, key, mode = False, (0, "", ""), (0, np.nan)
    rows = iter(lines)
    for line in (row[:_LAST].rstrip() for row in rows):
        if line.startswith("$TITLE"):
            title, reading = [], False
        elif line.startswith(("$SUBTITLE", "$LABEL")):
            title.append(line.partition("=")[2].strip())
        elif line.startswith(_FORMS[1:]) and title and title[-1] == "$EIGENVECTOR":
            found.has_complex = True
        elif line.startswith(_FORMS[0]):
            reading = bool(title) and title[-1] == "$EIGENVECTOR"
        elif subcase := _SUBCASE.match(line):
            key = (int(subcase[1]), "", " ".join(title[:-1]))
        elif line.startswith(_ONE_POINT) and reading:
            raise FileFault("has its eigenvectors sorted by grid points: ask Nastran for SORT1")
        elif (given := _MODE.match(line)) and reading:
            mode = (int(given[2]), _number(given[1]))
            found.add(key, *mode, None)
        elif line.startswith("$"):
            title.append(line)
        elif reading and line[:10].strip() == str(grid) and line[10:18].strip() == "G":
            motion = np.append(_three(line), _three(next(rows, "")))
            found.add(key, *mode, motion, in_pieces=True)
    return found


def _three(line: str) -> Array:
    """Return the three numbers of a line."""
    return np.array([_number(line[start:end]) for start, end in _VALUES])


def _number(text: str) -> float:
    """Return a number of the file."""
    try:
        return real(text)
    except ValueError:
        raise FileFault(f"is damaged: {text.strip() or 'a blank'} stands where a number must be") from None
