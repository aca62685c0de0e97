"""Direct matrix input: entries DMIG of bulk data, read as matrices with named coordinates, and written.

EXTSEOUT(DMIGPCH) punches the reduced matrices of an external superelement this way. A coordinate has the name 1101.T1
for a component of a grid point, and 5001 for a scalar point.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from typing import NamedTuple

import numpy as np

from proprotor.nastran.bulk_data import entries, real
from proprotor.nastran.found import COMPONENTS, FileFault
from proprotor.typing import Array

SYMMETRIC, SQUARE = 6, 1  # forms of a matrix
_REAL = (1, 2)  # types: single and double precision
_SCALAR = 0  # component of a scalar or an extra point
_DOUBLE = 2
_PASSED_OVER = 0  # in place of a form
_HEADING = "0"
_LARGE = 16  # characters of a field
_LARGEST = 5_000  # coordinates

Coordinate = tuple[int, int]  # point, and component 1 … 6, or 0 of a scalar point


class NamedMatrices(NamedTuple):
    """Matrices (n, n) by name, and the n names of their common coordinates."""

    matrices: dict[str, Array]
    names: tuple[str, ...]


def coordinate_name(point: int, component: int) -> str:
    """Return the name of a component of a grid point (1 … 6), or of a scalar point (0).

    Raises
    ------
    FileFault
        For another component.
    """
    if not _SCALAR <= component <= len(COMPONENTS):
        raise FileFault(f"is damaged: point {point} has no component {component}")
    return f"{point}.{COMPONENTS[component - 1]}" if component else str(point)


def read_dmig(lines: Iterable[str]) -> NamedMatrices:
    """Return the real square matrices of the entries DMIG among lines of bulk data; others are passed over.

    Raises
    ------
    FileFault
        When an entry cannot be read, or a matrix has no heading.
    """
    forms: dict[str, int] = {}
    terms: dict[str, dict[tuple[Coordinate, Coordinate], float]] = {}
    for _, fields in entries(lines, ["DMIG"]):
        name = fields[0].upper()
        try:
            if fields[1] == _HEADING:
                forms[name] = _form(fields)
            elif forms[name] != _PASSED_OVER:
                terms.setdefault(name, {}).update(_column(fields))
        except KeyError:
            raise FileFault(f"is damaged: the matrix {name} has no heading") from None
        except (ValueError, IndexError):
            raise FileFault(f"is damaged: an entry of the matrix {name} cannot be read") from None
    return _assembled(forms, terms)


def write_dmig(name: str, matrix: Array, coordinates: Sequence[Coordinate]) -> Iterator[str]:
    """Yield the lines of a real square matrix, in double precision with the digits that a field of 16 takes.

    Parameters
    ----------
    name : str
        At most eight characters.
    matrix : array (n, n)
    coordinates : sequence of (int, int)
        Point and component of each of the n coordinates.
    """
    yield f"{'DMIG':8}{name:8}{_HEADING:>8}{SQUARE:8d}{_DOUBLE:8d}{_DOUBLE:8d}"
    for column, (point, component) in enumerate(coordinates):
        rows = np.flatnonzero(matrix[:, column]).tolist()
        if rows:
            yield f"{'DMIG*':8}{name:16}{point:16d}{component:16d}"
        for row in rows:
            yield f"{'*':8}{coordinates[row][0]:16d}{coordinates[row][1]:16d}{_field(matrix[row, column])}"


def _field(value: float) -> str:
    """Return a number in 16 characters with as many digits as fit; below 1 without the zero before the point."""
    exponent = int(f"{value:E}".partition("E")[2])
    exponent += exponent < 0
    mantissa = Decimal(value).scaleb(-exponent)
    for digits in range(_LARGE, 0, -1):
        text = f"{mantissa:.{digits}f}D{exponent}".replace("0.", ".", 1 if abs(mantissa) < 1 else 0)
        if len(text) <= _LARGE:
            return f"{text:>{_LARGE}}"
    raise ValueError(value)


def _form(fields: Sequence[str]) -> int:
    """Return the form of a matrix from its heading; 0 for a matrix that is complex or not square."""
    form, kind = int(fields[2]), int(fields[3])
    return form if kind in _REAL and form in (SYMMETRIC, SQUARE) else _PASSED_OVER


def _column(fields: Sequence[str]) -> Iterator[tuple[tuple[Coordinate, Coordinate], float]]:
    """Yield the terms of a column: row and column, and the value."""
    column = (int(fields[1]), int(fields[2] or _SCALAR))
    for start in range(4, len(fields), 4):
        point, component, value = fields[start : start + 3]
        if point:
            yield ((int(point), int(component or _SCALAR)), column), real(value)


def _assembled(
    forms: Mapping[str, int], terms: Mapping[str, Mapping[tuple[Coordinate, Coordinate], float]]
) -> NamedMatrices:
    """Return all matrices on all coordinates, in the order of their points."""
    coordinates = sorted({one for given in terms.values() for place in given for one in place})
    if len(coordinates) > _LARGEST:
        raise FileFault(
            f"is too large: its matrices have {len(coordinates)} coordinates, and {_LARGEST} may be"
        )
    place_of = {one: place for place, one in enumerate(coordinates)}
    matrices = {}
    for name, given in terms.items():
        matrix = np.zeros((len(coordinates), len(coordinates)))
        for (row, column), value in given.items():
            matrix[place_of[row], place_of[column]] = value
            if forms[name] == SYMMETRIC:
                matrix[place_of[column], place_of[row]] = value
        matrices[name] = matrix
    return NamedMatrices(matrices, tuple(coordinate_name(*one) for one in coordinates))
