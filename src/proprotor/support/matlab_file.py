"""Matrices of a structure in a file of MATLAB (.mat, versions 5 to 7), as variables or as the fields of a struct.

    M, K and perhaps C     or mass, stiffness, damping
    Phi (6 x n)            or hub: the motion of the hub, for modal coordinates
    dofs                   or names: names of coordinates, a cell array or rows of text

Names may have capitals or not. The matrices may be sparse. They stand together: at the top of the file, or in one
struct, which may be a field of others. A file may have any other variables.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from proprotor.errors import InputError
from proprotor.support.matlab_level5 import MatlabFault, variables_of
from proprotor.support.matrix_files import readable, support_from_matrices
from proprotor.support.normal_modes import NormalModes

_NAMES = {
    "mass": ("m", "mass"),
    "stiffness": ("k", "stiffness"),
    "damping": ("c", "d", "damping"),
    "hub": ("phi", "hub", "hub_motion"),
    "dofs": ("dofs", "names"),
}
_DEEPEST = 8  # structs within structs
_HDF5 = b"\x89HDF"
_HEAD = 512  # bytes before the HDF5 file within a file of version 7.3


def read_matlab(
    file: str | os.PathLike[str], hub: Mapping[str, str] | None = None, **options: Any
) -> NormalModes:
    """Return a support from a file of MATLAB with mass, stiffness and perhaps damping.

    Parameters
    ----------
    file : str or path
        A .mat file of version 5 to 7.
    hub : mapping of str to str, optional
        Names of the hub's coordinates, as for `proprotor.support.matrix_files.read_npz`.
    **options
        As for `proprotor.support.matrix_files.support_from_matrices`.

    Raises
    ------
    InputError
        When the file is missing, damaged, of version 7.3 or too large, or has no matrices, or those of several
        structures, or the matrices do not make a support.
    """
    with readable("file", file) as path:
        content = _content(path)
        found = list(_structures(content, "", 0))
    if not found:
        rule = (
            "has no mass and stiffness: name them M and K, or mass and stiffness, at the top or in one struct"
        )
        raise InputError("file", str(path), rule)
    if len(found) > 1:
        places = ", ".join(place or "the top of the file" for place, _ in found)
        raise InputError("file", str(path), f"has mass and stiffness in several places: {places}; keep one")
    arrays = found[0][1]
    if "hub" in arrays and hub is not None:
        rule = "must not be given with a file that has the motion of the hub, its Phi"
        raise InputError("hub", None, rule)
    names = _texts(path, arrays.pop("dofs")) if "dofs" in arrays else None
    return support_from_matrices(**{"hub": hub} | arrays, dofs=names, **options)


def _content(path: Path) -> dict[str, Any]:
    """Return the variables of a file."""
    content = path.read_bytes()
    if content.startswith(_HDF5) or content[_HEAD : _HEAD + len(_HDF5)] == _HDF5:
        rule = "is of version 7.3: save it with save(name, ..., '-v7')"
        raise InputError("file", str(path), rule)
    try:
        return variables_of(content)
    except MatlabFault as fault:
        raise InputError("file", str(path), str(fault)) from None


def _structures(content: Mapping[str, Any], place: str, depth: int) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield place and arrays of each struct that has mass and stiffness."""
    by_name = {name.lower(): entry for name, entry in content.items() if not name.startswith("__")}
    arrays = {
        name: by_name[own]
        for name, known in _NAMES.items()
        for own in known
        if own in by_name and by_name[own] is not None and not isinstance(by_name[own], dict)
    }
    if {"mass", "stiffness"} <= arrays.keys():
        yield place, arrays
    for name, entry in content.items():
        if isinstance(entry, dict) and depth < _DEEPEST:
            yield from _structures(entry, f"{place}.{name}".strip("."), depth + 1)


def _texts(path: Path, entry: Any) -> list[str]:
    """Return the names of coordinates: rows of text, or a cell array of texts."""
    rows = (
        [name for row in entry for name in (row if isinstance(row, list) else [row])]
        if isinstance(entry, list)
        else []
    )
    if not rows or not all(isinstance(name, str) for name in rows):
        raise InputError("file", str(path), "must have names of coordinates as text in dofs")
    return [name.strip() for name in rows]
