"""A support from a Nastran run: real modes at the hub's grid point, or the matrices of a reduced structure."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, check_finite
from proprotor.files.text import check_file
from proprotor.nastran.found import COMPONENTS, FileFault, Found
from proprotor.nastran.kinds_of_file import DMIG, OP4, kind_of, read_modes
from proprotor.nastran.reduced import ReducedStructure, reduced_from_dmig, reduced_from_op4
from proprotor.nastran.selection import chosen_set, is_in_output_system, rows_of, table_of
from proprotor.support.matrix_files import support_from_matrices
from proprotor.support.modal_reduction import per_mode
from proprotor.support.normal_modes import TRANSLATION, NormalModes, hub_components, motion_of_hub
from proprotor.typing import Array

# The hub axes (I up, J outboard, K forward) in Nastran's usual aircraft axes: X aft, Y to the right, Z up.
AIRCRAFT_AXES = {"x": "T3", "y": "T2", "z": "-T1", "alpha_x": "R3", "alpha_y": "R2", "alpha_z": "-R1"}
_UNSTABLE = 1.0  # rad²/s², below whose opposite an eigenvalue is no rounding error of a rigid motion
_Result = TypeVar("_Result")


class _Modes(NamedTuple):
    """Modes of a run: numbers (k), ω in rad/s (k), generalised mass (k), motion T1 … R3 (6, k) and its system."""

    numbers: Sequence[int]
    frequency: Array
    generalized_mass: Array
    motion: Array
    system: int


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
    generalized_mass: ArrayLike | None = None,
    coordinates: str | os.PathLike[str] | None = None,
    hub: Mapping[str, str] | None = None,
    length_unit: float = 1.0,
    mass_unit: float = 1.0,
    names: Sequence[str] | None = None,
) -> NormalModes:
    """Return the real modes, or the reduced structure, of a Nastran run as a support.

    Parameters
    ----------
    file : str or path
        Real eigenvectors: .op2, .h5 (MSC Nastran), .pch or, with seven digits, .f06. Matrices of an external
        superelement (EXTSEOUT): .pch with entries DMIG, or .op4. The content tells the kind.
    grid : int
        The grid point at the hub. Its motion is read in its output coordinate system, except from tables BOUG… and
        BOPHIG of an .op2 file without others, which are in the basic one. If the file says that this system is not
        the basic one, and `hub` is not given, the support has a warning.
    includes_rotor, shaft : bool or str, str
        How the run had the rotor on, as for `proprotor.support.normal_modes.NormalModes`: "mass only" for a point mass
        at the hub's grid point (CONM2 without inertias), "rigid" with the rotor's inertias, "gimballed" with a gimbal
        between rotor and hub.
    carries : "one rotor" or "two rotors"
        What the structure of the run carries: one rotor, as half an aircraft with conditions of symmetry does, or two,
        as a whole aircraft does, of which one half goes with one rotor. Keep modes of one symmetry then. Matrices carry
        one rotor.
    damping_ratio : float or array
        Fraction of critical damping of the lowest modes, the last value for all modes above.
    modes : int, optional
        How many of the lowest modes to keep; by default all.
    subcase : int, optional
        Number of the subcase, needed when the file has several.
    generalized_mass : float or array, optional
        Generalised masses in units of the run, the last value for all modes above, for a file without the table of
        eigenvalues (LAMA): 1 for eigenvectors normalised to the mass, as EIGRL does it.
    coordinates : str or path, optional
        For an .op4 file: the file of bulk data that EXTSEOUT wrote beside it (.pch or .asm), whose entry EXTRN names
        the coordinates of the matrices.
    hub : mapping of str to str, optional
        For each of x, y, z, alpha_x, alpha_y, alpha_z one of T1 … R3, with "-" before a component that points the other
        way; `AIRCRAFT_AXES` by default.
    length_unit, mass_unit : float
        m and kg per unit of the run, such as 0.0254 and 175.1268 for inches and lbf s²/in.
    names : sequence of str, optional
        Names of the modes; by default mode_1 and so on, by the numbers that the run gave. Coordinates of matrices are
        1101.T1 and so on, unless the lowest modes are kept.

    Returns
    -------
    NormalModes
        SI.

    Raises
    ------
    InputError
        When the file is missing, cut off, damaged or of another kind, or has no such grid point, subcase or tables, and
        for input that does not go with this kind of file.
    """
    check_finite("length_unit", length_unit, "above zero")
    check_finite("mass_unit", mass_unit, "above zero")
    path = Path(file)
    kind = _unless_faulty(path, kind_of)
    how: dict[str, Any] = {"includes_rotor": includes_rotor, "shaft": shaft}
    if kind in (DMIG, OP4):
        _refuse_beside_matrices(subcase=subcase, generalized_mass=generalized_mass)
        if carries != "one rotor":
            raise InputError("carries", carries, "must be one rotor with matrices")
        how |= {"modes": modes, "damping_ratio": damping_ratio}
        how |= {"length_unit": length_unit, "mass_unit": mass_unit}
        return _of_matrices(_reduced(path, kind, coordinates), grid, hub, names, **how)
    if coordinates is not None:
        raise InputError("coordinates", str(coordinates), "must be given with an .op4 file only")
    read = _unless_faulty(path, read_modes, kind, grid)
    found = _kept(_modes(read, grid, file, subcase, generalized_mass), modes, file)
    motion = motion_of_hub(found.motion, AIRCRAFT_AXES if hub is None else hub, COMPONENTS)
    # The coordinate of a mode is a number without unit: a translation counts lengths in the run's unit.
    motion[TRANSLATION] *= length_unit
    support = NormalModes.from_frequencies(
        names=tuple(names) if names else [f"mode_{number}" for number in found.numbers],
        generalized_mass=found.generalized_mass * mass_unit * length_unit**2,
        frequency=found.frequency,
        damping_ratio=per_mode(damping_ratio, len(found.numbers)),
        hub=motion,
        carries=carries,
        **how,
    )
    return _with_doubts(support, _doubt_of_axes(grid, found.system, hub))


def _doubt_of_axes(grid: int, system: int, hub: Mapping[str, str] | None) -> str:
    """Return a doubt of axes that nobody named, where the grid point has its own output coordinate system."""
    if hub is not None or not system:
        return ""
    return (
        f"grid point {grid} has the output coordinate system {system}, and hub does not say which of its axes are the "
        "rotor's: aircraft axes are taken"
    )


def _with_doubts(support: NormalModes, *doubts: str) -> NormalModes:
    """Return the support with the doubts that are not empty."""
    text = "; ".join(filter(None, doubts))
    return replace(support, warning=np.array(text, dtype=object)) if text else support


def _refuse_beside_matrices(**given: Any) -> None:
    """Refuse input that is about modes."""
    for field, value in given.items():
        if value is not None:
            raise InputError(field, value, "must not be given with matrices, which have no modes")


def _unless_faulty(path: Path, read: Callable[..., _Result], *arguments: Any) -> _Result:
    """Return what is read from a file, and turn its faults into errors about the input."""
    check_file("file", path)
    try:
        return read(path, *arguments)
    except FileFault as fault:
        raise InputError("file", str(path), str(fault)) from None
    except OSError as error:
        raise InputError("file", str(path), f"cannot be read ({error.strerror or error})") from None


def _modes(
    found: Found, grid: int, file: Any, subcase: int | None, generalized_mass: ArrayLike | None
) -> _Modes:
    """Return the modes of one subcase, with generalised masses of the file or as given."""
    chosen = chosen_set(found, grid, subcase, str(file))
    system = found.output_system if is_in_output_system(chosen) else 0
    table = table_of(chosen, found.tables)
    if table is None:
        if generalized_mass is None:
            rule = (
                "has no eigenvalue table (LAMA) for its eigenvectors, so that their generalised masses are not known: "
                "give generalized_mass = 1 if the eigenvectors are normalised to the mass (EIGRL, NORM = MASS), or run "
                "Nastran with PARAM,POSTEXT,YES"
            )
            raise InputError("file", str(file), rule)
        if np.isnan(chosen.eigenvalues).any():
            rule = "has no frequencies for its eigenvectors: ask Nastran for SORT1, or PARAM,POSTEXT,YES"
            raise InputError("file", str(file), rule)
        masses = _repeated(generalized_mass, len(chosen.numbers))
        return _Modes(chosen.numbers, _frequency(chosen.eigenvalues, file), masses, chosen.motion, system)
    if generalized_mass is not None:
        rule = "must not be given: the file has a table of generalised masses (LAMA)"
        raise InputError("generalized_mass", generalized_mass, rule)
    rows = rows_of(chosen, table)
    masses = np.asarray(table.generalized_mass, dtype=float)[rows]
    return _Modes(chosen.numbers, _frequency(table.eigenvalues[rows], file), masses, chosen.motion, system)


def _frequency(eigenvalues: ArrayLike, file: Any) -> Array:
    """Return ω in rad/s; a rigid motion may have an eigenvalue just below zero."""
    square = np.asarray(eigenvalues, dtype=float)
    if (square < -_UNSTABLE).any():
        place = int(np.argmin(square)) + 1
        rule = f"must have modes of a stable structure: eigenvalue {place} is {square.min():g}"
        raise InputError("file", str(file), rule)
    frequency: Array = np.sqrt(np.maximum(square, 0.0))
    return frequency


def _repeated(values: ArrayLike, count: int) -> Array:
    """Return one generalised mass for each mode; the last given value is repeated."""
    given = np.atleast_1d(np.asarray(values, dtype=float))
    if not given.size or not (np.isfinite(given) & (given > 0)).all():
        raise InputError("generalized_mass", values, "must be above zero for each mode")
    return given[np.minimum(np.arange(count), len(given) - 1)]


def _kept(found: _Modes, modes: int | None, file: Any) -> _Modes:
    """Return the lowest modes, or refuse modes that are no numbers of a structure."""
    available = len(found.numbers)
    count = available if modes is None else modes
    if not 1 <= count <= available:
        raise InputError("modes", modes, f"must be from 1 to {available}, the modes of the file")
    order = np.argsort(found.frequency, kind="stable")[:count]
    kept = _Modes(
        [found.numbers[place] for place in order],
        found.frequency[order],
        found.generalized_mass[order],
        found.motion[:, order],
        found.system,
    )
    finite = all(np.isfinite(part).all() for part in kept[1:4])
    if not (finite and min(kept.generalized_mass) > 0):
        raise InputError("file", str(file), "must hold finite eigenvectors and generalised masses above zero")
    return kept


def _reduced(path: Path, kind: str, coordinates: str | os.PathLike[str] | None) -> ReducedStructure:
    """Return the reduced structure in a file of matrices."""
    if kind == DMIG:
        if coordinates is not None:
            raise InputError("coordinates", str(coordinates), "must be given with an .op4 file only")
        return _unless_faulty(path, reduced_from_dmig)
    if coordinates is None:
        rule = "is missing: an .op4 file needs the file of bulk data that EXTSEOUT wrote beside it (.pch or .asm)"
        raise InputError("coordinates", None, rule)
    beside = Path(coordinates)
    check_file("coordinates", beside)
    return _unless_faulty(path, reduced_from_op4, beside)


def _of_matrices(
    structure: ReducedStructure,
    grid: int,
    hub: Mapping[str, str] | None,
    names: Sequence[str] | None,
    **options: Any,
) -> NormalModes:
    """Return a reduced structure as a support; structural damping of its elements is left out, and said so."""
    signs = {1.0: "", -1.0: "-"}
    at_hub = {
        axis: f"{signs[sign]}{grid}.{name}"
        for name, sign, axis in hub_components(AIRCRAFT_AXES if hub is None else hub, COMPONENTS)
    }
    if missing := [name for name in at_hub.values() if name.lstrip("-") not in structure.names]:
        rule = f"has no coordinate {missing[0].lstrip('-')} in the matrices: the hub's grid point must be kept (ASET)"
        raise InputError("grid", grid, rule)
    support = support_from_matrices(
        structure.mass, structure.stiffness, structure.damping, dofs=structure.names, hub=at_hub, **options
    )
    if names:
        support = replace(support, names=tuple(names))
    left_out = structure.left_out and (
        f"structural damping of the elements ({structure.left_out}) is left out: give damping_ratio"
    )
    return _with_doubts(support, left_out, _doubt_of_axes(grid, structure.output_systems.get(grid, 0), hub))
