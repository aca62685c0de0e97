"""Mass, stiffness and damping of a reduced structure, as EXTSEOUT writes them, from DMIG or OUTPUT4."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
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
_GRID = range(1, 7)


class ReducedStructure(NamedTuple):
    """Mass, stiffness and damping (n, n), damping perhaps None; n names of coordinates; what was left out, or ""."""

    mass: Array
    stiffness: Array
    damping: Array | None
    names: tuple[str, ...]
    left_out: str


def reduced_from_dmig(lines: Iterable[str]) -> ReducedStructure:
    """Return the reduced structure whose matrices are entries DMIG.

    Raises
    ------
    FileFault
        When the mass or the stiffness is missing, or not one matrix only.
    """
    return _structure(read_dmig(lines))


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
    return _structure(NamedMatrices(square, names))


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


def _structure(found: NamedMatrices) -> ReducedStructure:
    """Return mass, stiffness and damping among matrices, by their names."""
    parts = {part: _one(found.matrices, part, initial) for part, initial in _INITIALS.items()}
    mass, stiffness = parts["mass"], parts["stiffness"]
    if mass is None or stiffness is None:
        known = ", ".join(found.matrices) or "no real square matrix"
        raise FileFault(f"must have a mass MAA or MAAX and a stiffness KAA or KAAX: it has {known}")
    used = [name for name in found.matrices if name.startswith(_STRUCTURAL) and found.matrices[name].any()]
    return ReducedStructure(mass, stiffness, parts["damping"], found.names, ", ".join(used))


def _one(matrices: Mapping[str, Array], part: str, initial: str) -> Array | None:
    """Return the matrix of a part, that of the reduced structure before others; None without one."""
    names = [name for name in matrices if name.startswith(initial) and not name.startswith(_STRUCTURAL)]
    names = [name for name in names if name[1:] in _REDUCED] or names
    if len(names) > 1:
        raise FileFault(f"has several matrices that could be its {part}: {', '.join(names)}")
    return matrices[names[0]] if names else None
