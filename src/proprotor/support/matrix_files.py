"""A support from the matrices of any finite-element code: Matrix Market files or one .npz file.

Coordinates are named, and six coordinates are the hub's: x, y, z in the length unit of the matrices, αx, αy, αz in rad,
along the rotor's axes (I up, J outboard, K forward along the shaft). A finite-element axis that points the other
way has a minus sign before its name. Matrices on modal coordinates come with Φ instead, the motion of the hub per unit
of each coordinate.
"""

from __future__ import annotations

import os
import sys
import warnings
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, unknown_name
from proprotor.files.text import check_file, read_text
from proprotor.support.matrix_market import MatrixMarketError, read_matrix
from proprotor.support.modal_reduction import on_modes
from proprotor.support.normal_modes import (
    HUB_AXES,
    TRANSLATION,
    NormalModes,
    share_of_one_rotor,
    signed_names,
)
from proprotor.typing import Array

_LARGEST = 500_000_000  # bytes of a file, unpacked
LARGEST_UNIT = 1e12  # m or kg
_LARGEST_ENTRY = 1e100  # beyond this value products overflow
_SYMMETRY = 1e-6  # files may have few digits
_KEYS = ("mass", "stiffness", "damping", "dofs", "hub")


def read_npz(
    file: str | os.PathLike[str], hub: Mapping[str, str] | None = None, **options: Any
) -> NormalModes:
    """Return a support from a NumPy file with the arrays mass, stiffness, dofs (n names) and, optionally, damping.

    Matrices on modal coordinates have the array hub too, the motion Φ (6, n) of the hub per unit of each coordinate.
    The array dofs may then be left out, and the coordinates are mode_1 and so on.

    Parameters
    ----------
    file : str or path
    hub : mapping of str to str, optional
        For each of x, y, z, alpha_x, alpha_y, alpha_z the name of the hub's coordinate, with "-" before a coordinate
        that points the other way; by default hub_x … hub_alpha_z. Not for modal coordinates.
    **options
        As for `support_from_matrices`.

    Raises
    ------
    InputError
        When the file is missing, damaged, too large or contains Python objects, or when the matrices do not make a
        support.
    """
    with readable("file", file) as path, zipfile.ZipFile(path) as archive:
        if sum(entry.file_size for entry in archive.infolist()) > _LARGEST:
            raise InputError("file", str(path), f"must not hold more than {_LARGEST // 10**6} MB")
    with readable("file", file) as path, np.load(path, allow_pickle=False) as archive:
        for name in archive.files:
            if name not in _KEYS:
                raise InputError("file", str(path), unknown_name(name, _KEYS, "array"))
        arrays = {name: archive[name] for name in archive.files}
    modal = "hub" in arrays
    if modal and hub is not None:
        raise InputError(
            "hub", None, "must not be given with a file that has the motion of the hub, its array hub"
        )
    for name in ("mass", "stiffness") if modal else ("mass", "stiffness", "dofs"):
        if name not in arrays:
            raise InputError("file", str(path), f"has no array {name}")
    names = _texts(path, np.atleast_1d(arrays.pop("dofs"))) if "dofs" in arrays else None
    return support_from_matrices(**{"hub": hub} | arrays, dofs=names, **options)


def read_matrix_market(
    mass: str | os.PathLike[str],
    stiffness: str | os.PathLike[str],
    damping: str | os.PathLike[str] | None = None,
    *,
    dofs: str | os.PathLike[str],
    hub: Mapping[str, str] | None = None,
    hub_motion: str | os.PathLike[str] | None = None,
    **options: Any,
) -> NormalModes:
    """Return a support from Matrix Market files and a text file with the name of each coordinate on a line.

    Parameters
    ----------
    mass, stiffness, damping, dofs : str or path
    hub_motion : str or path, optional
        The motion Φ (6, n) of the hub, for matrices on modal coordinates.
    hub, **options
        As for `read_npz`.

    Raises
    ------
    InputError
        When a file is missing, damaged or too large, or the matrices do not make a support.
    """
    if hub_motion is not None and hub is not None:
        raise InputError("hub", None, "must not be given with hub_motion, which has the motion of the hub")
    given = {"mass": mass, "stiffness": stiffness, "damping": damping}
    matrices = {name: _matrix_market(name, path) for name, path in given.items() if path is not None}
    names = read_text(Path(dofs), "dofs", str(dofs), _LARGEST).split()
    motion = hub if hub_motion is None else _dense(_matrix_market("hub_motion", hub_motion))
    return support_from_matrices(**matrices, dofs=names, hub=motion, **options)


def support_from_matrices(
    mass: Any,
    stiffness: Any,
    damping: Any = None,
    *,
    dofs: Sequence[str] | None = None,
    hub: Mapping[str, str] | ArrayLike | None = None,
    includes_rotor: bool | str = False,
    shaft: str = "held",
    carries: str | None = None,
    modes: int | None = None,
    damping_ratio: ArrayLike = 0.0,
    rotor_mass: float = 0.0,
    length_unit: float = 1.0,
    mass_unit: float = 1.0,
) -> NormalModes:
    """Return a support from matrices, dense or sparse.

    Parameters
    ----------
    mass, stiffness, damping : array or sparse array, shape (n, n)
        Matrices of the whole structure, with the rotor or without.
    dofs : sequence of str, optional
        Names of the n coordinates; modal coordinates are mode_1 and so on without names.
    hub : mapping of str to str or array (6, n), optional
        Names of the hub's coordinates as for `read_npz`, or the motion Φ of the hub per unit of each modal coordinate.
    includes_rotor, shaft : bool or str, str
        How the mass includes the rotor, as for `proprotor.support.normal_modes.NormalModes`.
    carries : "one rotor" or "two rotors"
        What the structure of modal coordinates carries; needed with Φ, and only with Φ. See
        `proprotor.support.normal_modes.share_of_one_rotor`.
    modes : int, optional
        How many of the lowest modes to keep, named mode_1 and so on; by default all coordinates.
    damping_ratio : float or array
        Fraction of critical damping of the lowest modes, the last value for all modes above; added to the damping
        matrix.
    rotor_mass : float
        Mass at the hub while modes are computed, kg, as for `proprotor.support.beam_wing.beam_wing`.
    length_unit, mass_unit : float
        m and kg per unit of the file. A force is mass times length/s²: 0.0254 and 175.1268 are for inches and
        lbf s²/in.

    Raises
    ------
    InputError
        When sizes differ, an entry is not finite, a matrix is not symmetric, a coordinate of the hub is missing, a
        rotor's mass is given although the mass includes the rotor, or `carries` is missing or has no meaning.
    """
    if includes_rotor and np.any(rotor_mass):
        raise InputError("rotor_mass", rotor_mass, "must not be given where the mass includes the rotor")
    share, names = _share(hub, carries), _names(dofs, (*np.shape(mass), 1)[0] if _is_motion(hub) else None)
    given = {"mass": mass, "stiffness": stiffness, "damping": damping}
    matrices = {name: _checked(name, part, len(names)) for name, part in given.items() if part is not None}
    for name, unit in (("length_unit", length_unit), ("mass_unit", mass_unit)):
        if not 1 / LARGEST_UNIT <= unit <= LARGEST_UNIT:
            rule = f"must be above zero, from {1 / LARGEST_UNIT:g} to {LARGEST_UNIT:g}"
            raise InputError(name, unit, rule)
    # A translation counts lengths in the file's unit, a rotation radians: all entries then have the unit of energy.
    motion = _motion(names, hub)
    motion[TRANSLATION] *= length_unit
    matrices = {name: matrix * (share * mass_unit * length_unit**2) for name, matrix in matrices.items()}
    return on_modes(
        names,
        hub=motion,
        count=modes,
        damping_ratio=damping_ratio,
        rotor_mass=rotor_mass,
        includes_rotor=includes_rotor,
        shaft=shaft,
        **matrices,
    ).support


def _texts(path: Path, dofs: Array) -> list[str]:
    """Return the names in an array, or refuse an array with numbers that are no characters."""
    if dofs.dtype.kind == "U":
        numbers = np.frombuffer(dofs.tobytes(), dtype=np.dtype("u4").newbyteorder(dofs.dtype.byteorder))
        if (numbers > sys.maxunicode).any():
            raise InputError("file", str(path), "is damaged: dofs has numbers that are no characters")
    return [str(name) for name in dofs]


def _is_motion(hub: Any) -> bool:
    """Return whether the hub is given by its motion Φ, on modal coordinates, rather than by names of coordinates."""
    return hub is not None and not isinstance(hub, Mapping)


def _share(hub: Any, carries: str | None) -> float:
    """Return the share of the matrices that goes with one rotor; `carries` must be given with Φ, and only with Φ."""
    if not _is_motion(hub):
        if carries is not None:
            raise InputError(
                "carries", carries, "must be given with the motion of the hub on modal coordinates only"
            )
        return 1.0
    if carries is None:
        rule = (
            'is missing: modal coordinates need "one rotor", for a semispan or half an aircraft, or "two rotors", for '
            "a whole aircraft in modes of one symmetry, of whose masses one half goes with one rotor"
        )
        raise InputError("carries", None, rule)
    return share_of_one_rotor(carries)


def _names(dofs: Sequence[str] | None, modal: int | None) -> tuple[str, ...]:
    """Return the names of the coordinates, or refuse a name that two coordinates have."""
    if dofs is None:
        if modal is None:
            raise InputError("dofs", None, "is missing: coordinates need names, unless they are modal")
        return tuple(f"mode_{place}" for place in range(1, modal + 1))
    names = tuple(dofs)
    if len(set(names)) < len(names):
        repeated = next(name for place, name in enumerate(names) if name in names[:place])
        raise InputError("dofs", repeated, "must not name two coordinates")
    return names


def _motion(names: Sequence[str], hub: Mapping[str, str] | ArrayLike | None) -> Array:
    """Return Φ (6, n), as given or from the names of the hub's coordinates."""
    if hub is None or isinstance(hub, Mapping):
        return _hub_motion(names, hub)
    return _checked_motion(hub, len(names))


def _hub_motion(names: Sequence[str], hub: Mapping[str, str] | None) -> Array:
    """Return Φ (6, n), with the sign of the coordinate that is the motion of the hub along each axis."""
    hub = {axis: f"hub_{axis}" for axis in HUB_AXES} if hub is None else hub
    motion = np.zeros((len(HUB_AXES), len(names)))
    for row, (axis, name, sign) in zip(motion, signed_names(hub, "coordinates"), strict=True):
        if name not in names:
            raise InputError(f"hub.{axis}", hub[axis], "is none of the coordinates of the matrices")
        if motion[:, names.index(name)].any():
            raise InputError(f"hub.{axis}", hub[axis], "must not be named for two axes")
        row[names.index(name)] = sign
    return motion


def _checked_motion(hub: Any, n: int) -> Array:
    """Return Φ (6, n), or refuse numbers that are no motion of the hub."""
    values = np.asarray(hub)
    if values.dtype.kind not in "fiu":
        raise InputError("hub", f"numbers of type {values.dtype}", "must be real numbers")
    if values.shape != (len(HUB_AXES), n):
        size = " x ".join(map(str, values.shape))
        raise InputError(
            "hub", size, f"must be 6 x {n}: x, y, z, alpha_x, alpha_y, alpha_z for each coordinate"
        )
    if not (np.abs(values) <= _LARGEST_ENTRY).all():
        raise InputError("hub", None, f"must be finite, without an entry above {_LARGEST_ENTRY:g}")
    if not values.any():
        raise InputError("hub", None, "must not be zero: no coordinate moves the hub")
    return values.astype(float)


def _dense(matrix: Any) -> Array:
    """Return the matrix of a file as an array."""
    return np.asarray(matrix.toarray() if hasattr(matrix, "toarray") else matrix)


def _checked(name: str, matrix: Any, n: int) -> Any:
    """Return the matrix as float, or refuse a matrix that does not belong to a structure with n coordinates."""
    sparse = hasattr(matrix, "tocsc")
    values = matrix.data if sparse else np.asarray(matrix)
    if values.dtype.kind not in "fiu":
        raise InputError(name, f"numbers of type {values.dtype}", "must be real numbers")
    if matrix.shape != (n, n):
        size = " x ".join(map(str, matrix.shape))
        raise InputError(name, size, f"must be {n} x {n}, one row and column for each of the dofs")
    if not np.isfinite(values).all():
        raise InputError(name, None, "must be finite: it has an entry that is infinite or not a number")
    with np.errstate(over="ignore"):  # numbers may be wider than a float
        matrix = matrix.tocsc().astype(float) if sparse else values.astype(float)
    if not (np.abs(matrix.data if sparse else matrix) <= _LARGEST_ENTRY).all():
        raise InputError(name, None, f"must not have an entry above {_LARGEST_ENTRY:g}")
    _check_symmetry(name, matrix)
    return (matrix + matrix.T) / 2


def _check_symmetry(name: str, matrix: Any) -> None:
    """Refuse a matrix whose entries differ from their opposites by more than rounding, in the scale of the diagonal."""
    from scipy.sparse import diags_array

    diagonal = np.sqrt(np.abs(matrix.diagonal()))
    largest = float(np.sqrt(abs(matrix).max()))
    scale = diags_array(1 / np.maximum(diagonal, 1e-6 * largest)) if largest else diags_array(diagonal)
    difference = scale @ (matrix - matrix.T) @ scale
    if abs(difference).max() > _SYMMETRY:
        rule = f"must be symmetric: {(abs(difference) > _SYMMETRY).sum() // 2} entries differ from their opposite"
        raise InputError(name, None, rule)


def _matrix_market(field: str, path: str | os.PathLike[str]) -> Any:
    """Return the matrix of a Matrix Market file."""
    with readable(field, path) as found:
        return read_matrix(found)


@contextmanager
def readable(field: str, file: str | os.PathLike[str]) -> Iterator[Path]:
    """Yield the path of a file that is not too large, and turn any error of its reader into an `InputError`."""
    path = Path(file)
    check_file(field, path)
    try:
        if path.stat().st_size > _LARGEST:
            raise InputError(field, str(path), f"must not be larger than {_LARGEST // 10**6} MB")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an old file is read in spite of its warnings
            yield path
    except InputError:
        raise
    except OSError as error:
        raise InputError(field, str(path), f"cannot be read ({error.strerror or error})") from None
    except MatrixMarketError as error:
        raise InputError(field, str(path), str(error)) from None
    except Exception as error:  # a third-party reader may raise anything: the file is wrong
        reason = "holds Python objects" if "pickle" in str(error) else "is damaged, or another kind of file"
        raise InputError(field, str(path), reason) from None
