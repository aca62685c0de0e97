"""Matrices of a structure in a file of MATLAB (.mat up to version 7), as variables or as the fields of a struct.

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

import numpy as np

from proprotor.errors import InputError
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
        A .mat file of version 4 to 7.
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
    """Return the variables of a file, a struct as a dictionary."""
    from scipy.io import loadmat  # here, because it takes long to import

    with path.open("rb") as stream:
        head = stream.read(_HEAD + len(_HDF5))
    if head.startswith(_HDF5) or head[_HEAD:] == _HDF5:
        rule = "is of version 7.3: save it with save(name, ..., '-v7')"
        raise InputError("file", str(path), rule)
    content: dict[str, Any] = loadmat(path, simplify_cells=True)
    return content


def _structures(content: Mapping[str, Any], place: str, depth: int) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield place and arrays of each struct that has mass and stiffness."""
    by_name = {name.lower(): entry for name, entry in content.items() if not name.startswith("__")}
    arrays = {
        name: by_name[own]
        for name, known in _NAMES.items()
        for own in known
        if own in by_name and not isinstance(by_name[own], dict)
    }
    if {"mass", "stiffness"} <= arrays.keys():
        yield (
            place,
            {name: entry if name == "dofs" else _matrix(name, entry) for name, entry in arrays.items()},
        )
    for name, entry in content.items():
        if isinstance(entry, dict) and depth < _DEEPEST:
            yield from _structures(entry, f"{place}.{name}".strip("."), depth + 1)


def _matrix(name: str, entry: Any) -> Any:
    """Return a matrix; one number, or the motion Φ of one mode, has both axes again, which SciPy takes off."""
    if hasattr(entry, "tocsc"):
        return entry
    array = np.asarray(entry)
    if array.ndim == 1 and name == "hub":
        return array[:, None]
    return array.reshape(1, 1) if array.ndim == 0 else array


def _texts(path: Path, entry: Any) -> list[str]:
    """Return the names of coordinates."""
    names = np.atleast_1d(entry).ravel()
    if not all(isinstance(name, str) for name in names):
        raise InputError("file", str(path), "must have names of coordinates as text in dofs")
    return [str(name).strip() for name in names]
