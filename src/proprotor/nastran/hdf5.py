"""Real modes at a grid point from an HDF5 file of MSC Nastran (.h5, by MDLPRM,HDF5 or HDF5OUT).

The tables are in the group NASTRAN/RESULT: eigenvectors in NODAL/EIGENVECTOR, in the output coordinate system of each
grid point; eigenvalues and generalised masses in SUMMARY/EIGENVALUE; subcase, approach and mode of each in DOMAINS.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from proprotor.nastran.found import EigenvalueTable, FileFault, Found
from proprotor.needs import need

_RESULTS, _POINTS = "NASTRAN/RESULT", "NASTRAN/INPUT/NODE/GRID"
_MOTION = ("X", "Y", "Z", "RX", "RY", "RZ")
_APART = ("SE", "AFPM", "TRMC", "DESIGN_CYCLE", "MODULE")  # what tells sets of one subcase apart
_REAL_MODES = 2  # approach code


def read_hdf5(path: Path, grid: int) -> Found:
    """Return the real modes of a file at a grid point.

    Raises
    ------
    FileFault
        When the file is damaged, or has no results of MSC Nastran.
    InputError
        When h5py is not installed.
    """
    need("h5py", "file", "HDF5 files of Nastran", "nastran")
    import h5py  # here, because it is an optional package

    try:
        with h5py.File(path, "r") as file:
            if _RESULTS not in file:
                raise FileFault(f"has no results of MSC Nastran: there is no group {_RESULTS}")
            found = _read(file[_RESULTS], grid)
            if _POINTS in file:
                rows = file[_POINTS][...]
                found.output_system = next(iter(rows["CD"][rows["ID"] == grid].tolist()), 0)
            return found
    except FileFault:
        raise
    except (OSError, RuntimeError, LookupError, ValueError, TypeError, AttributeError) as error:  # if damaged
        raise FileFault(f"is damaged, or has other tables than MSC Nastran writes ({error})") from None


def _read(results: Any, grid: int) -> Found:
    """Return what the group of results holds."""
    found = Found(has_complex="NODAL/EIGENVECTOR_CPLX" in results)
    if "NODAL/EIGENVECTOR" in results:
        domains = {int(row["ID"]): row for row in results["DOMAINS"][...]}
        _add_vectors(found, results["NODAL/EIGENVECTOR"], domains, grid)
    if "SUMMARY/EIGENVALUE" in results:
        rows = results["SUMMARY/EIGENVALUE"][...]
        starts = np.flatnonzero(np.diff(rows["MODE"]) <= 0) + 1  # numbers begin anew with each table
        for part in np.split(rows, starts):
            numbers, values, masses = (part[name] for name in ("MODE", "EIGEN", "MASS"))
            found.tables.append(EigenvalueTable(0, numbers, values.astype(float), masses.astype(float)))
    return found


def _add_vectors(found: Found, vectors: Any, domains: dict[int, Any], grid: int) -> None:
    """Add the eigenvectors of normal modes; those of buckling have another approach."""
    point, of_row = vectors.fields("ID")[...], vectors.fields("DOMAIN_ID")[...]
    at_grid = {int(of_row[place]): place for place in np.flatnonzero(point == grid)}
    for domain in dict.fromkeys(of_row.tolist()):
        row = domains[domain]
        if row["ANALYSIS"] != _REAL_MODES:
            continue
        motion = None
        if domain in at_grid:
            values = vectors[at_grid[domain]]
            motion = np.array([values[name] for name in _MOTION], dtype=float)
        label = " ".join(f"{name} {row[name]}" for name in _APART if name in row.dtype.names)
        key = (int(row["SUBCASE"]), "EIGENVECTOR", label)
        found.add(key, int(row["MODE"]), float(row["TIME_FREQ_EIGR"]), motion)
