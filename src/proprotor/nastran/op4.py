"""Real matrices from a file of OUTPUT4 (.op4), as text or binary, with all entries or without zeros.

A matrix is a heading (columns, rows, form, type, name) and its columns. A column with all entries begins at a row; a
column without zeros has row 0 and strings of entries, each after one word with length and row, or two (BIGMAT, rows
negative in the heading). A column past the last one ends the matrix.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np

from proprotor.nastran.bulk_data import real
from proprotor.nastran.found import FileFault
from proprotor.typing import Array

_KINDS = {1: "f4", 2: "f8"}  # of entries, by type: real of single and of double precision, none if complex
_LARGEST = 5_000  # rows or columns of a matrix that is kept
_ROWS = 2**16  # a word with the length and the row of a string is length * _ROWS + row
_HEADING_BYTES = {24: 4, 48: 8}  # bytes of a heading, and of its words
_TEXT_HEADING = re.compile(r"([ \d]{8})([ \d-]{8})([ \d]{8})([ \d]{8})(.{8})\S*\d[ED]\d+\.\d+")
_ENTRY = re.compile(r"[+-]?\d*\.\d*(?:[EeDd][+-]?\d+|[+-]\d{3})?")  # entries may touch one another


class _Heading(NamedTuple):
    """What the heading of a matrix tells; the type of its entries as NumPy has it is empty for one passed over."""

    columns: int
    rows: int
    bigmat: bool
    kind: str
    name: str


def read_op4(path: Path) -> dict[str, Array]:
    """Return the real matrices of a file by name; complex and very large ones are passed over.

    Raises
    ------
    FileFault
        When the file is damaged or cut off.
    OSError
        When the file cannot be read.
    """
    with path.open("rb") as file:
        first = file.read(4)
        file.seek(0)
        for order in "<>":
            if int(np.frombuffer(first.ljust(4), f"{order}i4")[0]) in _HEADING_BYTES:
                return dict(_binary(file, order))
        return dict(_text(file))


def _binary(file: BinaryIO, order: str) -> Iterator[tuple[str, Array]]:
    """Yield the matrices of a binary file, a chain of Fortran records."""
    while (content := _record(file, order)) is not None:
        width = _HEADING_BYTES.get(len(content))
        if width is None:
            raise FileFault("is damaged, or no file of OUTPUT4: a matrix has no heading")
        numbers = np.frombuffer(content[: 4 * width], f"{order}i{width}").tolist()
        letters = np.frombuffer(content[4 * width :], np.uint8).reshape(2, width)[:, :4].tobytes()
        heading = _heading(letters.decode("latin-1"), *numbers)
        matrix = _binary_matrix(file, order, width, heading)
        if heading.kind:
            yield heading.name, matrix


def _binary_matrix(file: BinaryIO, order: str, width: int, heading: _Heading) -> Array:
    """Return the matrix whose columns follow."""
    matrix = _zeros(heading)
    kind = f"{order}{'f8' if heading.kind == 'f8' else f'f{width}'}"
    while (content := _record(file, order)) is not None:
        if len(content) < 3 * width or len(content) % width:
            raise FileFault(f"is damaged: a column of the matrix {heading.name} has no place")
        column, row, _ = np.frombuffer(content[: 3 * width], f"{order}i{width}").tolist()
        if column > heading.columns:
            return matrix
        if not heading.kind:
            continue
        words = content[3 * width :]
        strings = [(row, words)] if row else _strings(words, order, width, heading.bigmat)
        for first, entries in strings:
            if len(entries) % np.dtype(kind).itemsize:
                raise FileFault(f"is damaged: the matrix {heading.name} has part of an entry")
            _put(matrix, column, first, np.frombuffer(entries, kind))
    raise FileFault(f"ends early, in the matrix {heading.name}: the run or a copy of the file was cut off")


def _strings(words: bytes, order: str, width: int, bigmat: bool) -> Iterator[tuple[int, bytes]]:
    """Yield first row and entries of each string of a column without zeros."""
    at = 0
    count = 2 if bigmat else 1
    while at + count * width <= len(words):
        given = np.frombuffer(words[at : at + count * width], f"{order}i{width}").tolist()
        length, row = _length_and_row(given)
        at += count * width
        yield row, words[at : at + length * width]
        at += max(length, 0) * width


def _length_and_row(given: list[int]) -> tuple[int, int]:
    """Return the words and the first row of a string, from two words or from one that holds both."""
    length, row = given if len(given) == 2 else divmod(given[0], _ROWS)
    return length - 1, row


def _record(file: BinaryIO, order: str) -> bytes | None:
    """Return the next Fortran record, or None at the end of the file."""
    before = file.read(4)
    if not before:
        return None
    length = int(np.frombuffer(before.ljust(4), f"{order}i4")[0])
    content = file.read(max(length, 0))
    if len(content) != length or file.read(4) != before:
        raise FileFault("is damaged or cut off: the lengths around a record differ")
    return content


def _text(file: BinaryIO) -> Iterator[tuple[str, Array]]:
    """Yield the matrices of a text. Lines of entries have decimal points, lines of places have none."""
    heading, matrix, column, row = None, np.zeros((0, 0)), 0, 0
    for line in (row.decode("latin-1").rstrip() for row in file):
        if heading is None:
            if given := _TEXT_HEADING.match(line):
                heading = _heading(given[5], *map(int, given.groups()[:4]))
                matrix = _zeros(heading)
        elif "." in line and not heading.kind:
            continue
        elif "." in line:
            entries = _entries(line)
            _put(matrix, column, row, np.array(entries))
            row += len(entries)
        elif len(places := _places(line)) == 3:
            column, row, _ = places
            if column > heading.columns:
                if heading.kind:
                    yield heading.name, matrix
                heading = None
        elif places:
            _, row = _length_and_row(places)
    if heading is not None:
        raise FileFault(
            f"ends early, in the matrix {heading.name}: the run or a copy of the file was cut off"
        )


def _places(line: str) -> list[int]:
    """Return the whole numbers of a line."""
    try:
        return [int(word) for word in line.split()]
    except ValueError:
        raise FileFault(f"is damaged: {line.strip()} must be whole numbers") from None


def _entries(line: str) -> list[float]:
    """Return the entries of a line."""
    try:
        return [real(text) for text in _ENTRY.findall(line)]
    except ValueError:
        raise FileFault(f"is damaged: {line.strip()} must be numbers") from None


def _heading(name: str, columns: int, rows: int, _form: int, kind: int) -> _Heading:
    """Return what a heading tells, without a type for a matrix that is passed over."""
    if columns < 1 or not rows:
        raise FileFault(f"is damaged: its matrix {name.strip()} has {abs(rows)} x {columns} entries")
    is_kept = max(columns, abs(rows)) <= _LARGEST
    return _Heading(columns, abs(rows), rows < 0, _KINDS.get(kind, "") if is_kept else "", name.strip())


def _zeros(heading: _Heading) -> Array:
    """Return the matrix without its entries; empty for one that is passed over."""
    return np.zeros((heading.rows, heading.columns) if heading.kind else (0, 0))


def _put(matrix: Array, column: int, row: int, entries: Array) -> None:
    """Put entries into a column from a row on, which counts from 1."""
    if not (1 <= column <= matrix.shape[1] and 1 <= row <= len(matrix) + 1 - len(entries)):
        raise FileFault(f"is damaged: it has entries outside {matrix.shape[0]} x {matrix.shape[1]}")
    matrix[row - 1 : row - 1 + len(entries), column - 1] = entries
