"""Matrix Market files: a heading, a line of sizes, and the entries.

The package has a reader of its own. SciPy's reader (`scipy.io.mmread` of 1.17) ends the process without a message at an
array file that calls itself symmetric and is not square, and reads a truncated file with zeros for the missing entries.
"""

from __future__ import annotations

import io
import warnings
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from proprotor.files.text import open_text
from proprotor.typing import Array

# Rows or columns, by layout: without zeros, and with all entries.
_LARGEST = {"coordinate": 50_000, "array": 5_000}
_FIELDS = ("real", "double", "integer")
_OTHER_FIELDS = ("complex", "pattern")
_SYMMETRIES = ("general", "symmetric", "skew-symmetric", "hermitian")
_LONGEST_LINE = 1024  # characters, as the format has it


class MatrixMarketError(ValueError):
    """Fault of a file, as the end of a sentence."""


class _Heading(NamedTuple):
    """Layout, symmetry and sizes of a matrix."""

    layout: str
    symmetry: str
    rows: int
    columns: int
    entries: int  # the number of lines that follow


def read_matrix(path: Path) -> Any:
    """Return the matrix of a file with real or whole numbers.

    Returns
    -------
    array or scipy.sparse.coo_array, shape (rows, columns)
        Sparse if the file leaves out zeros. Where the file gives an entry twice, the entry is the sum of both numbers.

    Raises
    ------
    MatrixMarketError
        When the file is no Matrix Market file, is damaged or too large, or has other than real numbers.
    OSError
        When the file cannot be read.
    """
    with open_text(path, encoding="latin-1") as file:  # comments may have any encoding
        heading = _heading(file)
        found = _numbers(file.read(), heading)
    if heading.layout == "array":
        return _full(found[:, 0], heading)
    return _sparse(found, heading)


def _heading(file: io.TextIOBase) -> _Heading:
    """Return heading and sizes, and leave the file at the first entry."""
    words = file.readline(_LONGEST_LINE).lower().split()
    if len(words) != 5 or words[:2] != ["%%matrixmarket", "matrix"]:
        raise MatrixMarketError("is damaged, or another kind of file: it has no heading of Matrix Market")
    layout, field, symmetry = words[2:]
    if field in _OTHER_FIELDS:
        raise MatrixMarketError(f"must hold real numbers, not {field}")
    if layout not in _LARGEST or field not in _FIELDS or symmetry not in _SYMMETRIES:
        raise MatrixMarketError("is damaged: its heading has unknown words")
    rows, columns, *entries = _sizes(file, 3 if layout == "coordinate" else 2)
    if max(rows, columns) > _LARGEST[layout]:
        raise MatrixMarketError(f"is too large: {rows} x {columns}")
    if rows != columns and symmetry != "general":
        raise MatrixMarketError(f"is damaged: it cannot be {symmetry} with {rows} x {columns} entries")
    return _Heading(layout, symmetry, rows, columns, *(entries or [_given(symmetry, rows, columns)]))


def _sizes(file: io.TextIOBase, count: int) -> list[int]:
    """Return the whole numbers of the first line that is neither comment nor blank."""
    lines = iter(file.readline, "")
    words = next((line.split() for line in lines if line.strip() and not line.startswith("%")), [])
    if len(words) == count and all(word.isascii() and word.isdigit() and len(word) < 16 for word in words):
        return [int(word) for word in words]
    raise MatrixMarketError(f"is damaged: it must have {count} whole numbers after its heading, its sizes")


def _given(symmetry: str, rows: int, columns: int) -> int:
    """Return how many numbers an array file gives."""
    if symmetry == "general":
        return rows * columns
    return rows * (rows - 1) // 2 if symmetry == "skew-symmetric" else rows * (rows + 1) // 2


def _numbers(body: str, heading: _Heading) -> Array:
    """Return the numbers of each line, (entries, 1) or (entries, 3)."""
    columns = 3 if heading.layout == "coordinate" else 1
    if "D" in body or "d" in body:  # exponents as Fortran writes them
        body = body.replace("D", "E").replace("d", "e")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # NumPy warns of a file without entries
        try:
            found = np.loadtxt(io.StringIO(body), comments="%", ndmin=2)
        except (ValueError, OverflowError):
            raise MatrixMarketError("is damaged: it has a line that is not its entries' numbers") from None
    found = found if found.size else np.empty((0, columns))
    if found.shape != (heading.entries, columns):
        rule = f"is damaged: it must have {heading.entries} lines of {columns} numbers after its sizes"
        raise MatrixMarketError(f"{rule}, not {found.shape[0]} of {found.shape[1]}")
    return found


def _full(numbers: Array, heading: _Heading) -> Array:
    """Return the matrix of an array file: columns one after another, below the diagonal alone if the rest follows."""
    n, m = heading.rows, heading.columns
    if heading.symmetry == "general":
        return numbers.reshape((m, n)).T
    matrix = np.zeros((n, n))
    columns, rows = np.triu_indices(n, k=_strict(heading))
    matrix[rows, columns] = numbers
    matrix[columns, rows] = _sign(heading) * numbers
    return matrix


def _sparse(found: Array, heading: _Heading) -> Any:
    """Return the matrix of a coordinate file, with the entries that follow from symmetry."""
    from scipy.sparse import coo_array

    places, numbers = found[:, :2], found[:, 2]
    sizes = (heading.rows, heading.columns)
    if ((places < 1) | (places > sizes) | (places % 1 != 0)).any() or np.isnan(places).any():
        raise MatrixMarketError(f"is damaged: it has an entry outside {sizes[0]} x {sizes[1]}")
    rows, columns = places.astype(np.int64).T - 1
    if heading.symmetry != "general":
        side = rows - columns
        both_sides = (side > 0).any() and (side < 0).any()
        if both_sides or (_strict(heading) and (side == 0).any()):
            where = "both sides" if both_sides else "the diagonal"
            rule = f"is damaged: it has entries on {where}, although it is {heading.symmetry}"
            raise MatrixMarketError(rule)
        other = side != 0
        rows, columns = np.append(rows, columns[other]), np.append(columns, rows[other])
        numbers = np.append(numbers, _sign(heading) * numbers[other])
    return coo_array((numbers, (rows, columns)), shape=sizes)


def _strict(heading: _Heading) -> int:
    """Return 1 for a matrix whose diagonal is zero and left out, else 0."""
    return int(heading.symmetry == "skew-symmetric")


def _sign(heading: _Heading) -> float:
    """Return the factor between an entry and its opposite."""
    return -1.0 if heading.symmetry == "skew-symmetric" else 1.0
