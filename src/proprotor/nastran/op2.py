"""Real modes at a grid point from a binary file of results (.op2).

Eigenvectors stand in the data blocks OUG… and OPHIG, in the output coordinate system of each grid point, and in BOUG…
and BOPHIG in the basic one; eigenvalues and generalised masses in LAMA. What a record is, its own codes tell rather
than the name of its block: an approach code (2 for real modes), a table code (7 for eigenvectors) and the number of
words of a row. Of the geometry (GEOM1) the entries GRID alone are looked at, for the output coordinate system of the
grid point; stresses, forces and matrices are passed over unread, so that nothing in them can spoil the modes.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from proprotor.nastran.data_blocks import Record, records
from proprotor.nastran.found import EigenvalueTable, FileFault, Found
from proprotor.typing import Array

_EIGENVECTORS = re.compile(r"B?(OUG|OPHIG|OUXY)[A-Z0-9]*")
_EIGENVALUES = re.compile(r"LAMA[A-Z0-9]*")
_GEOMETRY = ("GEOM1", "GEOM1S")
_GRID, _GRID_WIDE = (4501, 45, 1), (4501, 45, 1120001)  # first words of a record of entries GRID
_SYSTEM = -3  # place of the output coordinate system among the words of an entry
_HEADING = 146  # words of the record before each record of results
_APPROACH, _TABLE, _SUBCASE, _NUMBER, _EIGENVALUE, _ROW = 0, 1, 3, 4, 5, 9  # words of a heading
_SUBTITLE, _END = 82, 146  # words of subtitle and label
_REAL_MODES, _COMPLEX_MODES = 2, 9  # approach codes
_VECTORS = 7  # table code
_SORT2 = 2  # bit of the thousands of a table code: rows are modes, not grid points
_REAL_ROW, _EIGENVALUE_ROW = 8, 7  # words


def read_op2(path: Path, grid: int) -> Found:
    """Return the real modes of a file at a grid point.

    Raises
    ------
    FileFault
        When the file is no .op2 file, is cut off or damaged.
    OSError
        When the file cannot be read.
    """
    found = Found()
    heading = None
    with path.open("rb") as file:
        for record in records(file, path.stat().st_size, _is_wanted):
            if record.name in _GEOMETRY:
                found.output_system = _output_system(record, grid) or found.output_system
            elif record.words == _HEADING and heading is None:
                heading = record
            elif heading is not None:
                _add(found, heading, record, grid)
                heading = None
    return found


def _is_wanted(name: str) -> bool:
    """Return whether a block can hold eigenvectors, eigenvalues or grid points."""
    return name in _GEOMETRY or bool(_EIGENVECTORS.fullmatch(name) or _EIGENVALUES.fullmatch(name))


def _output_system(record: Record, grid: int) -> int:
    """Return the output coordinate system of the grid point; 0 without the grid point in this record.

    An entry has eight words, or eleven of 4 bytes with coordinates of double precision.
    """
    words = record.integers()
    key = tuple(words[:3].tolist())
    width = 11 if key == _GRID_WIDE and record.width == 4 else 8
    if key not in (_GRID, _GRID_WIDE) or (len(words) - 3) % width:
        return 0
    points = words[3:].reshape(-1, width)
    return next(iter(points[points[:, 0] == grid, _SYSTEM].tolist()), 0)


def _add(found: Found, heading: Record, record: Record, grid: int) -> None:
    """Add a record to what was found, if it holds eigenvectors or eigenvalues."""
    codes = heading.integers(0, 10)
    approach, (sort, table), row = codes[_APPROACH] // 10, divmod(int(codes[_TABLE]), 1000), codes[_ROW]
    if table == _VECTORS and approach == _COMPLEX_MODES:
        found.has_complex = True
    elif table == _VECTORS and approach == _REAL_MODES and row == _REAL_ROW:
        (_add_by_grid if sort & _SORT2 else _add_mode)(found, heading, record, grid)
    elif _EIGENVALUES.fullmatch(heading.name) and row == _EIGENVALUE_ROW:
        numbers, values = _rows(record, _EIGENVALUE_ROW)
        found.tables.append(EigenvalueTable(int(codes[_SUBCASE]), numbers[:, 0], values[:, 2], values[:, 5]))


def _add_mode(found: Found, heading: Record, record: Record, grid: int) -> None:
    """Add one eigenvector, whose rows are grid points."""
    points, values = _rows(record, _REAL_ROW)
    places = np.flatnonzero(points[:, 0] // 10 == grid)
    motion = values[places[0], 2:] if len(places) else None
    number, eigenvalue = int(heading.integers()[_NUMBER]), float(heading.reals()[_EIGENVALUE])
    found.add(_key(heading), number, eigenvalue, motion)


def _add_by_grid(found: Found, heading: Record, record: Record, grid: int) -> None:
    """Add the motion of one grid point in all modes, which are the rows."""
    numbers, values = _rows(record, _REAL_ROW)
    motions: list[Array | None] = [None] * len(numbers)
    if heading.integers()[_NUMBER] // 10 == grid:
        motions = list(values[:, 2:])
    for number, motion in zip(numbers[:, 0], motions, strict=True):
        found.add(_key(heading), int(number), np.nan, motion)


def _key(heading: Record) -> tuple[int, str, str]:
    """Return subcase, table, and subtitle with label."""
    return int(heading.integers()[_SUBCASE]), heading.name, heading.text(_SUBTITLE, _END)


def _rows(record: Record, width: int) -> tuple[Array, Array]:
    """Return the rows of a record as whole numbers and as real numbers."""
    if record.words % width:
        raise FileFault(f"is damaged: in the table {record.name} a record has no whole number of rows")
    return record.integers().reshape(-1, width), record.reals().reshape(-1, width).astype(float)
