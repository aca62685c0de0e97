"""Kinds of Nastran's files, by their content: names of files differ from program to program."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from itertools import islice
from pathlib import Path

import numpy as np

from proprotor.nastran.found import FileFault, Found
from proprotor.nastran.hdf5 import read_hdf5
from proprotor.nastran.op2 import read_op2
from proprotor.nastran.printed import read_printed
from proprotor.nastran.punch import read_punch
from proprotor.nastran.text_files import lines_of

DMIG, OP4 = "DMIG", "OUTPUT4"
_HDF5, _OP2, _PUNCH, _PRINTED = "HDF5", "OUTPUT2", "punch", "print"
_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_FIRST_RECORDS = {4: _OP2, 8: _OP2, 24: OP4, 48: OP4}  # by the bytes of the first Fortran record
_BEGINNINGS = {"DMIG": DMIG, "$TITLE": _PUNCH, "$SUBTITLE": _PUNCH, "$EIGENVECTOR": _PUNCH}
_HEADINGS = ("R E A L   E I G E N V", "C O M P L E X   E I G E N V")  # of values or vectors
_LINES = 20_000_000


def kind_of(path: Path) -> str:
    """Return the kind of a file.

    Raises
    ------
    FileFault
        When the file is of no kind that has modes or matrices.
    OSError
        When the file cannot be read.
    """
    with path.open("rb") as file:
        first = file.read(len(_SIGNATURE))
    if first == _SIGNATURE:
        return _HDF5
    for order in "<>":
        length = int(np.frombuffer(first[:4].ljust(4), f"{order}i4")[0])
        if kind := _FIRST_RECORDS.get(length):
            return kind
    if kind := next(_kinds(path), ""):
        return kind
    rule = (
        "has no modes: it is no .op2, .h5, .pch, .op4 or .f06 file of Nastran with eigenvectors or matrices"
    )
    raise FileFault(rule)


def read_modes(path: Path, kind: str, grid: int) -> Found:
    """Return the real modes of a file of a kind at a grid point.

    Raises
    ------
    FileFault
        When the file is damaged or cut off.
    OSError
        When the file cannot be read.
    InputError
        When a package is missing.
    """
    if kind in (_HDF5, _OP2):
        return (read_hdf5 if kind == _HDF5 else read_op2)(path, grid)
    return (read_punch if kind == _PUNCH else read_printed)(lines_of(path), grid)


def _kinds(path: Path) -> Iterator[str]:
    """Yield the kinds that lines of a text show."""
    for place, line in enumerate(islice(lines_of(path), _LINES)):
        if place == 0 and _begins_matrix(line):
            yield OP4
        for beginning, kind in _BEGINNINGS.items():
            if line.startswith(beginning):
                yield kind
        if any(heading in line for heading in _HEADINGS):
            yield _PRINTED


def _begins_matrix(line: str) -> bool:
    """Return whether a line begins with four whole numbers in columns of eight, as a matrix of OUTPUT4 does."""
    with suppress(ValueError):
        return all(int(line[start : start + 8]) for start in (0, 8, 16, 24))
    return False
