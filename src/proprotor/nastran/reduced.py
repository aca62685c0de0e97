"""Mass, stiffness and damping of a reduced structure, as EXTSEOUT writes them, from DMIG or OUTPUT4."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from proprotor.nastran.bulk_data import entries
from proprotor.nastran.dmig import NamedMatrices, coordinate_name, read_dmig
from proprotor.nastran.found import FileFault
from proprotor.nastran.op4 import read_op4
from proprotor.nastran.text_files import lines_of
from proprotor.typing import Array

_INITIALS = {"mass": "M", "stiffness": "K", "damping": "B"}
_STRUCTURAL = "K4"  # structural damping of the elements, which is no stiffness
_REDUCED = ("AA", "AAX", "XX")  # endings of the matrices of a reduced structure, which go before others
_SYSTEM = 5  # place of the output coordinate system among the fields of GRID


class ReducedStructure(NamedTuple):
    """Matrices (n, n) of a structure.

    Attributes
    ----------
    mass, stiffness, damping : array (n, n)
        The damping may be None.
    names : tuple of str
        Names of the coordinates.
    left_out : str
        Names of matrices that are left out.
    output_systems : mapping of int to int
        Output coordinate system of each grid point that the bulk data beside the matrices have.
    """

    mass: Array
    stiffness: Array
    damping: Array | None
    names: tuple[str, ...]
    left_out: str
    output_systems: Mapping[int, int]


def reduced_from_dmig(path: Path) -> ReducedStructure:
    """Return the reduced structure whose matrices are entries DMIG of a file.

    Raises
    ------
    FileFault
        When the mass or the stiffness is missing, or not one matrix only.
    """
    return _structure(read_dmig(lines_of(path)), path)


def reduced_from_op4(path: Path, entries_file: Path) -> ReducedStructure:
    """Return the reduced structure whose matrices are in a file of OUTPUT4.

    Parameters
    ----------
    path : Path
    entries_file : Path
        The file of bulk data (.pch or .asm) that EXTSEOUT wrote beside the matrices. Its entry EXTRN names the
        coordinates in the order of the rows, since a run that takes the matrices in has no other word of this order.

    Raises
    ------
    FileFault
        When a file cannot be read, or the sizes differ.
    """
    names = tuple(_external_coordinates(lines_of(entries_file)))
    if not names:
        raise FileFault(f"needs the names of its rows, and {entries_file.name} has no entry EXTRN")
    n = len(names)
    square = {name: matrix for name, matrix in read_op4(path).items() if matrix.shape == (n, n)}
    return _structure(NamedMatrices(square, names), entries_file)


def _external_coordinates(lines: Iterable[str]) -> list[str]:
    """Return the names of the coordinates that entries EXTRN list: points, each with its components or 0."""
    names = []
    for _, fields in entries(lines, ["EXTRN"]):
        given = [field for field in fields if field]
        try:
            for point, components in zip(given[::2], given[1::2], strict=True):
                names += [coordinate_name(int(point), int(component)) for component in components]
        except ValueError:
            raise FileFault("is damaged: its entry EXTRN must have pairs of points and components") from None
    return names


def _output_systems(lines: Iterable[str]) -> dict[int, int]:
    """Return the output coordinate system of each grid point that entries GRID have."""
    found = {}
    for _, fields in entries(lines, ["GRID"]):
        with suppress(ValueError, IndexError):  # an entry that is not needed
            found[int(fields[0])] = int(fields[_SYSTEM] or 0)
    return found


def _structure(found: NamedMatrices, bulk_data: Path) -> ReducedStructure:
    """Return mass, stiffness and damping among matrices, by their names."""
    parts = {part: _one(found.matrices, part, initial) for part, initial in _INITIALS.items()}
    mass, stiffness = parts["mass"], parts["stiffness"]
    if mass is None or stiffness is None:
        known = ", ".join(found.matrices) or "no real square matrix"
        raise FileFault(f"must have a mass MAA or MAAX and a stiffness KAA or KAAX: it has {known}")
    used = [name for name in found.matrices if name.startswith(_STRUCTURAL) and found.matrices[name].any()]
    systems = _output_systems(lines_of(bulk_data))
    return ReducedStructure(mass, stiffness, parts["damping"], found.names, ", ".join(used), systems)


def _one(matrices: Mapping[str, Array], part: str, initial: str) -> Array | None:
    """Return the matrix of a part, that of the reduced structure before others; None without one."""
    names = [name for name in matrices if name.startswith(initial) and not name.startswith(_STRUCTURAL)]
    names = [name for name in names if name[1:] in _REDUCED] or names
    if len(names) > 1:
        raise FileFault(f"has several matrices that could be its {part}: {', '.join(names)}")
    return matrices[names[0]] if names else None
