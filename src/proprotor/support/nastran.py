"""A support from a Nastran normal-modes run: eigenvectors at the hub and generalised masses from an .op2 file.

pyNastran reads the file; the extra `nastran` installs it.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, unknown_name
from proprotor.needs import need
from proprotor.support.modal_reduction import per_mode
from proprotor.support.normal_modes import TRANSLATION, NormalModes, signed_names
from proprotor.typing import Array

_COMPONENTS = ("T1", "T2", "T3", "R1", "R2", "R3")
# The hub axes (I up, J outboard, K forward) in Nastran's usual aircraft axes: X aft, Y to the right, Z up.
AIRCRAFT_AXES = {"x": "T3", "y": "T2", "z": "-T1", "alpha_x": "R3", "alpha_y": "R2", "alpha_z": "-R1"}
_LARGEST = 2_000_000_000  # bytes


def nastran_modes(
    file: str | os.PathLike[str],
    grid: int,
    *,
    includes_rotor: bool | str,
    shaft: str = "held",
    carries: str = "one rotor",
    damping_ratio: ArrayLike = 0.0,
    modes: int | None = None,
    subcase: int | None = None,
    hub: Mapping[str, str] | None = None,
    length_unit: float = 1.0,
    mass_unit: float = 1.0,
    names: Sequence[str] | None = None,
) -> NormalModes:
    """Return the real modes of a Nastran run as a support.

    Parameters
    ----------
    file : str or path
        An .op2 file with eigenvectors (OUGV1, DISPLACEMENT(PLOT) = ALL or a set with the grid) and the eigenvalue
        table LAMA.
    grid : int
        The grid point at the hub; its motion is read in the output coordinate system of this grid point.
    includes_rotor, shaft : bool or str, str
        How the run had the rotor on, as for `proprotor.support.normal_modes.NormalModes`: "mass only" for a point mass
        at the hub's grid point (CONM2 without inertias), "rigid" with the rotor's inertias, "gimballed" with a gimbal
        between rotor and hub.
    carries : "one rotor" or "two rotors"
        What the structure of the run carries: one rotor, as half an aircraft with conditions of symmetry does, or two,
        as a whole aircraft does, of which one half goes with one rotor. Keep modes of one symmetry then.
    damping_ratio : float or array
        Fraction of critical damping of the lowest modes, the last value for all modes above.
    modes : int, optional
        How many of the lowest modes to keep; by default all.
    subcase : int, optional
        Number of the subcase, needed when the file has several.
    hub : mapping of str to str, optional
        For each of x, y, z, alpha_x, alpha_y, alpha_z one of T1 … R3, with "-" before a component that points the other
        way; `AIRCRAFT_AXES` by default.
    length_unit, mass_unit : float
        m and kg per unit of the run, such as 0.0254 and 175.1268 for inches and lbf s²/in.
    names : sequence of str, optional
        Names of the modes; by default mode_1 and so on.

    Raises
    ------
    InputError
        When pyNastran is not installed, the file is missing or damaged, or has no such grid, subcase or tables.
    """
    results = _read(Path(file))
    vectors = _one_subcase(results.eigenvectors, subcase, file)
    motion = _motion_of(grid, vectors)
    table = _table(results.eigenvalues, vectors, file)
    available = len(vectors.modes)
    count = available if modes is None else modes
    if not 1 <= count <= available:
        raise InputError("modes", modes, f"must be from 1 to {available}, the modes of the file")
    rows = [list(table.mode).index(mode) for mode in vectors.modes[:count]]
    frequency = np.asarray(table.radians, dtype=float)[rows]
    generalized_mass = np.asarray(table.generalized_mass, dtype=float)[rows]
    motion = _turned(motion[:, :count], hub)
    if not (np.isfinite(motion).all() and np.isfinite(generalized_mass).all() and min(generalized_mass) > 0):
        raise InputError("file", str(file), "must hold finite eigenvectors and generalised masses above zero")
    # The coordinate of a mode is a number without unit: a translation counts lengths in the run's unit.
    motion[TRANSLATION] *= length_unit
    return NormalModes.from_frequencies(
        names=tuple(names) if names else [f"mode_{place}" for place in range(1, count + 1)],
        generalized_mass=generalized_mass * mass_unit * length_unit**2,
        frequency=frequency,
        damping_ratio=per_mode(damping_ratio, count),
        hub=motion,
        includes_rotor=includes_rotor,
        shaft=shaft,
        carries=carries,
    )


def _read(path: Path) -> Any:
    """Return the results in an .op2 file as pyNastran holds them."""
    if not path.is_file():
        raise InputError("file", str(path), "no such file")
    if path.stat().st_size > _LARGEST:
        raise InputError("file", str(path), f"must not be larger than {_LARGEST // 10**9} GB")
    with warnings.catch_warnings():  # pyNastran uses names that NumPy has deprecated
        warnings.simplefilter("ignore")
        with _names_of_older_numpy():
            need("pyNastran.op2.op2", "file", "Nastran's results", "nastran")
            from pyNastran.op2.op2 import OP2

            results = OP2(debug=False, log=_Silent())
            try:
                with redirect_stdout(StringIO()):
                    results.read_op2(str(path), build_dataframe=False)
            except Exception as error:  # a reader of damaged binary files can raise anything
                rule = f"is damaged, or no .op2 file with results ({type(error).__name__})"
                raise InputError("file", str(path), rule) from None
    return results


class _Silent:
    """A log that drops all messages of a reader."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return lambda *args, **kwargs: None


@contextmanager
def _names_of_older_numpy() -> Iterator[None]:
    """Give NumPy its function in1d, which NumPy 2.4 dropped, while pyNastran 1.3 is running."""
    dropped = "in1d"
    if hasattr(np, dropped):
        yield
        return
    setattr(np, dropped, lambda tested, among, **options: np.isin(np.ravel(tested), among, **options))
    try:
        yield
    finally:
        delattr(np, dropped)


def _one_subcase(eigenvectors: Mapping[Any, Any], subcase: int | None, path: Any) -> Any:
    """Return the real eigenvectors of one subcase."""
    if not eigenvectors:
        raise InputError("file", str(path), "has no real eigenvectors: ask Nastran for DISPLACEMENT(PLOT)")
    real = {key: vectors for key, vectors in eigenvectors.items() if hasattr(vectors, "eigns")}
    if not real:
        rule = "has complex eigenvectors alone: ask Nastran for real ones (SOL 103)"
        raise InputError("file", str(path), rule)
    numbers = {getattr(vectors, "isubcase", key): vectors for key, vectors in real.items()}
    listed = ", ".join(map(str, numbers))
    if subcase is None and len(numbers) > 1:
        raise InputError("subcase", None, f"must be given: the file has {listed}")
    if subcase is not None and subcase not in numbers:
        raise InputError("subcase", subcase, f"is not in the file, which has {listed}")
    return numbers[next(iter(numbers)) if subcase is None else subcase]


def _motion_of(grid: int, vectors: Any) -> Array:
    """Return the motion (6, modes) of a grid point, rows T1 … R3."""
    places = np.flatnonzero(np.asarray(vectors.node_gridtype)[:, 0] == grid)
    if not len(places):
        raise InputError("grid", grid, "has no eigenvectors in the file: the hub's grid point is missing")
    return np.asarray(vectors.data[:, places[0], :], dtype=float).T


def _table(tables: Mapping[Any, Any], vectors: Any, path: Any) -> Any:
    """Return the eigenvalue table that belongs to the eigenvectors, which is the table with the same eigenvalues."""
    for table in tables.values():
        known = dict(zip(table.mode, table.eigenvalues, strict=True))
        given = zip(vectors.modes, vectors.eigns, strict=True)
        if all(np.isclose(known.get(mode, np.nan), value, rtol=1e-4, atol=1e-3) for mode, value in given):
            return table
    raise InputError("file", str(path), "has no eigenvalue table (LAMA) for its eigenvectors")


def _turned(motion: Array, hub: Mapping[str, str] | None) -> Array:
    """Return the rows x … αz from the rows T1 … R3."""
    hub = AIRCRAFT_AXES if hub is None else hub
    rows = []
    for axis, name, sign in signed_names(hub, "motions"):
        if name not in _COMPONENTS:
            raise InputError(f"hub.{axis}", hub[axis], unknown_name(name, _COMPONENTS, "component"))
        rows.append(sign * motion[_COMPONENTS.index(name)])
    return np.array(rows)
