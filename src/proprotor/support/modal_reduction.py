"""Lowest modes of a structure, and the structure as a support on all its coordinates or on its lowest modes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError
from proprotor.support.normal_modes import TRANSLATION, NormalModes
from proprotor.typing import Array

_MASSLESS = 1e-12  # of the largest 1/ω²: a motion without mass has no mode
_RIGID = 1e-9  # of the largest ω²: a motion without strain
_NONE = 1e-200  # N/m or N m/rad, whose inverse times a mass would overflow
_DENSE = 1500  # coordinates up to which all modes are found at once
_MOST_KEPT = 400  # coordinates of a support, all of which enter the eigenvalue problem of the rotor


class StructuralModes(NamedTuple):
    """Undamped modes: frequency (k,) in rad/s, rising, and shapes (n, k) with ΦᵀMΦ = 1."""

    frequency: Array
    shapes: Array


class ModalSupport(NamedTuple):
    """A support, the shapes (n, k) of its coordinates in coordinates of the structure, and the structure's modes."""

    support: NormalModes
    shapes: Array
    modes: StructuralModes


def on_modes(
    names: Sequence[str],
    mass: Any,
    stiffness: Any,
    hub: Array,
    *,
    damping: Any = None,
    count: int | None = None,
    damping_ratio: ArrayLike | Callable[[Array], ArrayLike] = 0.0,
    rotor_mass: float = 0.0,
    includes_rotor: bool | str = False,
    shaft: str = "held",
    name_modes: Callable[[Array], Sequence[str]] | None = None,
) -> ModalSupport:
    """Return a structure as a support, on all its coordinates or on its lowest modes.

    Parameters
    ----------
    names : sequence of str
        Names of the n coordinates.
    mass, stiffness, damping : array or sparse array, shape (n, n)
    hub : array (6, n)
    count : int, optional
        How many of the lowest modes to keep; every coordinate by default.
    damping_ratio : float, array (j,) or callable
        Structural damping to add, as a fraction of critical: one value for each of the lowest modes, of which the last
        holds for all modes above, or a function that returns the values for shapes (n, k).
    rotor_mass : float
        Mass at the hub while modes are computed and damped, kg. This mass does not stay in the support, because the
        rotor model brings it. Modes without the rotor would bend too little near the hub, and six such modes would not
        be enough.
    includes_rotor, shaft : bool or str, str
        How the mass includes the rotor already, as for `proprotor.support.normal_modes.NormalModes`.
    name_modes : callable, optional
        Function that returns the names of shapes (n, k); by default mode_1 and so on.

    Raises
    ------
    InputError
        When there are fewer modes than asked for, when coordinates without mass are kept, or too many coordinates.
    """
    if count is None and len(names) > _MOST_KEPT:
        raise InputError("modes", None, f"must be given with more than {_MOST_KEPT} coordinates")
    if not np.isfinite(rotor_mass) or rotor_mass < 0:
        raise InputError("rotor_mass", rotor_mass, "must be finite and not negative")
    loaded = _with_mass_at_hub(mass, hub, rotor_mass)
    found = lowest_modes(loaded, stiffness, count)
    if count is None and len(found.frequency) < len(names):
        raise InputError("modes", None, "must be given: there are coordinates without mass")
    given = damping_ratio(found.shapes) if callable(damping_ratio) else damping_ratio
    ratio = per_mode(given, len(found.frequency))
    if count is None:
        shapes = np.eye(len(names))
        forces = _dense(loaded) @ found.shapes
        structural = (forces * (2 * ratio * found.frequency)) @ forces.T  # M Φ (2ζω) Φᵀ M
    else:
        shapes = found.shapes
        structural = np.diag(2 * ratio * found.frequency)
        names = name_modes(shapes) if name_modes else [f"mode_{k}" for k in range(1, count + 1)]
    parts = {"mass": mass, "stiffness": stiffness, "damping": damping}
    reduced = {
        name: symmetric(shapes.T @ (part @ shapes)) for name, part in parts.items() if part is not None
    }
    reduced["damping"] = reduced.get("damping", 0.0) + symmetric(structural)
    support = NormalModes(
        names=names, **reduced, hub=hub @ shapes, includes_rotor=includes_rotor, shaft=shaft
    )
    return ModalSupport(support, shapes, found)


def lowest_modes(mass: Any, stiffness: Any, count: int | None = None) -> StructuralModes:
    """Return the lowest modes of K φ = ω² M φ.

    Parameters
    ----------
    mass, stiffness : array or sparse array, shape (n, n)
        Symmetric, without negative directions; at least one of the two must be positive definite.
    count : int, optional
        How many modes; by default all that carry mass.

    Raises
    ------
    InputError
        When both are singular or one is negative in some direction, or there are fewer modes than asked for.
    """
    if count is not None and mass.shape[0] > max(_DENSE, 3 * count):
        return _lowest_of_many(mass, stiffness, count)
    return _of_few(_dense(mass), _dense(stiffness), count)


def per_mode(damping_ratio: ArrayLike, count: int) -> Array:
    """Return one damping ratio for each of `count` modes; the last given value is repeated.

    Raises
    ------
    InputError
        When a ratio is negative, 1 or more, or not finite.
    """
    given = np.atleast_1d(np.asarray(damping_ratio, dtype=float))
    if given.ndim != 1 or not len(given) or not (np.isfinite(given) & (given >= 0) & (given < 1)).all():
        raise InputError("damping_ratio", damping_ratio, "must be at least 0 and below 1 for each mode")
    return given[np.minimum(np.arange(count), len(given) - 1)]


def _of_few(mass: Array, stiffness: Array, count: int | None) -> StructuralModes:
    """Return the lowest modes of dense matrices, from all their modes."""
    if not mass.any():
        raise InputError("mass", None, "must not be zero")
    diagonal = np.diagonal(stiffness)
    scale = 1 / np.sqrt(np.where(diagonal > _NONE, diagonal, 1.0))
    mass, stiffness = (matrix * np.outer(scale, scale) for matrix in (mass, stiffness))
    square, shapes = _held_modes(mass, stiffness) or _free_modes(mass, stiffness)
    count = len(square) if count is None else count
    if not 1 <= count <= len(square):
        rule = f"must be from 1 to {len(square)}, the number of modes that carry mass"
        raise InputError("modes", count, rule)
    return StructuralModes(np.sqrt(square[:count]), (scale[:, None] * shapes)[:, :count])


def _held_modes(mass: Array, stiffness: Array) -> tuple[Array, Array] | None:
    """Return ω² and shapes of the modes that carry mass, or None for a structure that is free to move.

    M φ = (1/ω²) K φ is solved: the lowest modes are then the most accurate, and massless motions give zeros.
    """
    from scipy.linalg import LinAlgError, eigh  # here, because scipy is slow to import

    try:
        compliance, shapes = eigh(mass, stiffness)
    except LinAlgError:
        return None
    least = _MASSLESS * np.abs(compliance).max()
    if compliance.min() < -least:
        raise InputError("mass", None, "must not be negative in any direction")
    order = np.argsort(-compliance)
    order = order[compliance[order] > least]
    return 1 / compliance[order], shapes[:, order] / np.sqrt(compliance[order])


def _free_modes(mass: Array, stiffness: Array) -> tuple[Array, Array]:
    """Return ω² and shapes of all modes of a structure that is free to move; rigid motions have ω² = 0."""
    from scipy.linalg import LinAlgError, eigh

    try:
        square, shapes = eigh(stiffness, mass)
    except LinAlgError:
        rule = "must hold the structure, or else the mass must be positive definite"
        raise InputError("stiffness", None, rule) from None
    if square[0] < -_RIGID * square[-1]:
        raise InputError("stiffness", None, "must not be negative in any direction")
    return np.where(square < _RIGID * square[-1], 0.0, square), shapes


def _lowest_of_many(mass: Any, stiffness: Any, count: int) -> StructuralModes:
    """Return the lowest modes of large matrices by shifted inverse iteration."""
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import ArpackError, eigsh

    start = np.random.default_rng(0).standard_normal(mass.shape[0])  # fixed: each call finds the same modes
    try:
        square, shapes = eigsh(csc_array(stiffness), k=count, M=csc_array(mass), sigma=0.0, v0=start)
    except (ArpackError, RuntimeError):  # a factor that is exactly singular
        raise InputError("stiffness", None, "must hold the structure") from None
    order = np.argsort(square)
    square, shapes = square[order], shapes[:, order]
    generalized = np.einsum("ij,ij->j", shapes, mass @ shapes)
    if not (square > 0).all() or not (generalized > 0).all():
        raise InputError("stiffness", None, "must hold the structure, with no negative direction")
    return StructuralModes(np.sqrt(square), shapes / np.sqrt(generalized))


def _with_mass_at_hub(mass: Any, hub: Array, rotor_mass: float) -> Any:
    """Return the mass with a point mass at the hub."""
    if rotor_mass == 0:
        return mass
    moving: Any = hub[TRANSLATION]
    if not hasattr(mass, "toarray"):
        return mass + rotor_mass * moving.T @ moving
    from scipy.sparse import csc_array

    moving = csc_array(moving)
    return csc_array(mass) + rotor_mass * (moving.T @ moving)


def symmetric(matrix: Array) -> Array:
    """Return the symmetric part of a matrix: products leave rounding errors."""
    return (matrix + matrix.T) / 2


def _dense(matrix: Any) -> Array:
    """Return a matrix as a dense array."""
    return matrix.toarray() if hasattr(matrix, "toarray") else np.asarray(matrix, dtype=float)
