"""Lowest modes of a structure, and the structure as a support on all its coordinates or on its lowest modes.

Matrices of many designs are reduced at once, and small imaginary parts, as a complex step makes them, are carried along
to first order.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, check_finite
from proprotor.support.normal_modes import TRANSLATION, NormalModes
from proprotor.typing import Array, Numbers

_MASSLESS = 1e-12  # of the largest 1/ω²: a motion without mass has no mode
_RIGID = 1e-9  # of the largest ω²: a motion without strain
_NONE = 1e-200  # N/m or N m/rad, whose inverse times a mass would overflow
_CLOSE = 1e-6  # of 1/ω² or ω²: modes so near to one another are modes of one frequency
_TIE = 1e-6  # of the largest entry of a shape
_DENSE = 1500  # coordinates up to which all modes are found at once, as those of a batch always are
_MOST_KEPT = 400  # coordinates of a support, all of which enter the eigenvalue problem of the rotor


class StructuralModes(NamedTuple):
    """Undamped modes: frequency (..., k) in rad/s, rising, and shapes (..., n, k) with ΦᵀMΦ = 1.

    The largest entry of a shape, in coordinates that are scaled to equal stiffness, is positive.
    """

    frequency: Array
    shapes: Array


class ModalSupport(NamedTuple):
    """A support, shapes (..., n, k) of its coordinates in coordinates of the structure, and the structure's modes."""

    support: NormalModes
    shapes: Array
    modes: StructuralModes


class Arrangement(NamedTuple):
    """An order of modes: the place (..., k) of each mode among the modes of its design, names, and warnings (...)."""

    places: Array
    names: Sequence[str]
    warning: Array | None = None


def on_modes(
    names: Sequence[str],
    mass: Any,
    stiffness: Any,
    hub: Array,
    *,
    damping: Any = None,
    count: int | None = None,
    damping_ratio: ArrayLike | Callable[[Array], ArrayLike] = 0.0,
    rotor_mass: Numbers = 0.0,
    at_hub: Array | None = None,
    includes_rotor: bool | str = False,
    shaft: str = "held",
    arrange: Callable[[Array], Arrangement] | None = None,
) -> ModalSupport:
    """Return a structure as a support, on all its coordinates or on its lowest modes.

    Leading axes are many designs at once. Numbers may be complex, for derivatives by a complex step: `lowest_modes`.

    Parameters
    ----------
    names : sequence of str
        Names of the n coordinates.
    mass, stiffness, damping : array (..., n, n) or sparse array (n, n)
    hub : array (..., 6, n)
    count : int, optional
        How many of the lowest modes to keep; every coordinate by default.
    damping_ratio : float, array (..., j) or callable
        Structural damping to add, as a fraction of critical: one value for each of the lowest modes, of which the last
        holds for all modes above, or a function that returns the values for shapes (..., n, k).
    rotor_mass : float or array (...)
        Mass at the hub while modes are computed and damped, kg. This mass does not stay in the support, because the
        rotor model brings it. Modes without the rotor would bend too little near the hub, and six such modes would not
        be enough.
    at_hub : array (..., 6, 6), optional
        The same on the motions of the hub, for a rotor with more than a mass: kg, kg m and kg m².
    includes_rotor, shaft : bool or str, str
        How the mass includes the rotor already, as for `proprotor.support.normal_modes.NormalModes`.
    arrange : callable, optional
        Function that returns the order and the names of the modes with shapes (..., n, k); by default the order of the
        frequencies, and mode_1 and so on.

    Raises
    ------
    InputError
        When there are fewer modes than asked for, when coordinates without mass are kept, or too many coordinates.
    """
    if count is None and len(names) > _MOST_KEPT:
        raise InputError("modes", None, f"must be given with more than {_MOST_KEPT} coordinates")
    check_finite("rotor_mass", rotor_mass, "not negative")
    loaded = _with_mass_at_hub(mass, hub, rotor_mass)
    if at_hub is not None:
        loaded = loaded + hub.T @ at_hub @ hub
    found = lowest_modes(loaded, stiffness, count)
    if count is None and found.frequency.shape[-1] < len(names):
        raise InputError("modes", None, "must be given: there are coordinates without mass")
    found, ratio = _with_ratios(
        found, damping_ratio(found.shapes) if callable(damping_ratio) else damping_ratio
    )
    if count is None:
        shapes, warning = np.eye(len(names)), None
        forces = _dense(loaded) @ found.shapes
        structural = forces @ _modal_damping(found, ratio, stiffness) @ np.swapaxes(forces, -1, -2)
    else:
        places, names, warning = arrange(found.shapes) if arrange else _by_frequency(found)
        found = StructuralModes(*(_taken(part, places) for part in found))
        shapes, structural = found.shapes, _modal_damping(found, _taken(ratio, places), stiffness)
    parts = {"mass": mass, "stiffness": stiffness, "damping": damping}
    reduced: dict[str, Any] = {
        name: symmetric(np.swapaxes(shapes, -1, -2) @ (part @ shapes))
        for name, part in parts.items()
        if part is not None
    }
    reduced["damping"] = reduced.get("damping", 0.0) + symmetric(structural)
    support = NormalModes(
        names=names,
        **reduced,
        hub=hub @ shapes,
        includes_rotor=includes_rotor,
        shaft=shaft,
        shapes=shapes if shapes.ndim > 2 else None,
        warning=warning,
    )
    return ModalSupport(support, shapes, found)


def _with_ratios(modes: StructuralModes, damping_ratio: ArrayLike) -> tuple[StructuralModes, Array]:
    """Return modes and a damping ratio for each, both with the leading axes of both."""
    ratio, frequency = np.broadcast_arrays(
        per_mode(damping_ratio, modes.frequency.shape[-1]), modes.frequency
    )
    shapes = np.broadcast_to(modes.shapes, (*ratio.shape[:-1], *modes.shapes.shape[-2:]))
    return StructuralModes(frequency, shapes), ratio


def _by_frequency(modes: StructuralModes) -> Arrangement:
    """Return the order of the frequencies."""
    count = modes.frequency.shape[-1]
    return Arrangement(np.arange(count), [f"mode_{k}" for k in range(1, count + 1)])


def _taken(part: Array, places: Array) -> Array:
    """Return the numbers of modes, along the last axis, in another order (..., k)."""
    if places.ndim == 1:
        return part[..., places]
    if part.ndim > places.ndim:
        places = places[..., None, :]
    return np.take_along_axis(part, np.broadcast_to(places, part.shape), axis=-1)


def _modal_damping(modes: StructuralModes, ratio: Array, stiffness: Any) -> Array:
    """Return the damping (..., k, k) on modes with damping ratios (..., k).

    Modes of one frequency are coupled by a complex step: between these modes the change of 2ζ√K is 2ζ K' / (ω₁ + ω₂).
    """
    frequency = modes.frequency
    damping: Array = (2 * ratio * frequency)[..., None] * np.eye(frequency.shape[-1])
    if np.isrealobj(frequency):
        return damping
    real = np.real(frequency)
    first, second = real[..., :, None], real[..., None, :]
    change = np.imag(np.swapaxes(modes.shapes, -1, -2) @ (stiffness @ modes.shapes))
    coupled = _close(first**2, second**2) & ~np.eye(real.shape[-1], dtype=bool) & (first > 0)
    both = np.real(ratio[..., :, None] + ratio[..., None, :])
    return damping + 1j * np.where(coupled, both * change / np.where(coupled, first + second, 1.0), 0.0)


def lowest_modes(mass: Any, stiffness: Any, count: int | None = None) -> StructuralModes:
    """Return the lowest modes of K φ = ω² M φ.

    Imaginary parts of the matrices are small changes of the matrices, as a complex step makes them, and the imaginary
    parts of frequencies and shapes are the first-order changes that follow. Modes of one frequency, with 1/ω² equal to
    a part in a million, have no shapes that change smoothly in every direction: such shapes change as a group
    with ΦᵀMΦ = 1, and what couples the modes is left in ΦᵀKΦ.

    Parameters
    ----------
    mass, stiffness : array (..., n, n) or sparse array (n, n)
        Symmetric, without negative directions; at least one of the two must be positive definite.
    count : int, optional
        How many modes; by default all that carry mass, in every design of a batch.

    Raises
    ------
    InputError
        When both are singular or one is negative in some direction, or there are fewer modes than asked for.
    """
    one = mass.ndim == stiffness.ndim == 2 and np.isrealobj(mass) and np.isrealobj(stiffness)
    if one and count is not None and mass.shape[-1] > max(_DENSE, 3 * count):
        return _lowest_of_many(mass, stiffness, count)
    return _of_few(_dense(mass), _dense(stiffness), count)


def per_mode(damping_ratio: ArrayLike, count: int) -> Array:
    """Return one damping ratio (..., count) for each mode; the last given value is repeated.

    Raises
    ------
    InputError
        When a ratio is negative, 1 or more, or not finite.
    """
    given = np.atleast_1d(np.asarray(damping_ratio))
    if not given.shape[-1] or not (np.isfinite(given) & (np.real(given) >= 0) & (np.real(given) < 1)).all():
        raise InputError("damping_ratio", damping_ratio, "must be at least 0 and below 1 for each mode")
    return given[..., np.minimum(np.arange(count), given.shape[-1] - 1)]


class _Basis(NamedTuple):
    """All solutions of A v = ν B v with VᵀBV = 1, those of the lowest modes first; `carrying` have mass.

    A structure that is held has A = M, B = K and ν = 1/ω²: the lowest modes are then the most accurate, and motions
    without mass have ν = 0. A structure that is free to move has A = K, B = M and ν = ω².
    """

    held: bool
    values: Array
    vectors: Array
    carrying: int

    def square(self, count: int) -> Array:
        """Return ω² (..., count)."""
        return 1 / self.values[..., :count] if self.held else self.values[..., :count]

    def shapes(self, count: int) -> Array:
        """Return shapes (..., n, count) with ΦᵀMΦ = 1."""
        shapes = self.vectors[..., :count]
        return shapes / np.sqrt(self.values[..., None, :count]) if self.held else shapes


def _of_few(mass: Array, stiffness: Array, count: int | None) -> StructuralModes:
    """Return the lowest modes of dense matrices, from all their modes."""
    mass, stiffness = np.broadcast_arrays(mass, stiffness)
    if not np.real(mass).any(axis=(-2, -1)).all():
        raise InputError("mass", None, "must not be zero")
    diagonal = np.real(np.diagonal(stiffness, axis1=-2, axis2=-1))
    scale = 1 / np.sqrt(np.where(diagonal > _NONE, diagonal, 1.0))
    mass, stiffness = (matrix * (scale[..., :, None] * scale[..., None, :]) for matrix in (mass, stiffness))
    basis = _held_basis(np.real(mass), np.real(stiffness)) or _free_basis(np.real(mass), np.real(stiffness))
    count = basis.carrying if count is None else count
    if not 1 <= count <= basis.carrying:
        rule = f"must be from 1 to {basis.carrying}, the number of modes that carry mass"
        raise InputError("modes", count, rule)
    square, shapes = basis.square(count), basis.shapes(count)
    sign = _signs(shapes)
    if np.iscomplexobj(mass) or np.iscomplexobj(stiffness):
        changes = _changes(basis, square, shapes, np.imag(mass), np.imag(stiffness))
        square, shapes = (part + 1j * change for part, change in zip((square, shapes), changes, strict=True))
    return StructuralModes(np.sqrt(square), scale[..., :, None] * shapes * sign[..., None, :])


def _held_basis(mass: Array, stiffness: Array) -> _Basis | None:
    """Return the solutions of M φ = (1/ω²) K φ, or None for a structure that is free to move."""
    try:
        factor = np.linalg.cholesky(stiffness)
    except np.linalg.LinAlgError:
        return None
    compliance, vectors = _standard(mass, factor)
    compliance, vectors = compliance[..., ::-1], vectors[..., ::-1]
    least = _MASSLESS * np.abs(compliance).max(axis=-1, keepdims=True)
    if (compliance < -least).any():
        raise InputError("mass", None, "must not be negative in any direction")
    return _Basis(True, compliance, vectors, int((compliance > least).sum(axis=-1).min()))


def _free_basis(mass: Array, stiffness: Array) -> _Basis:
    """Return the solutions of K φ = ω² M φ of a structure that is free to move; rigid motions have ω² = 0."""
    try:
        factor = np.linalg.cholesky(mass)
    except np.linalg.LinAlgError:
        rule = "must hold the structure, or else the mass must be positive definite"
        raise InputError("stiffness", None, rule) from None
    square, vectors = _standard(stiffness, factor)
    rigid = _RIGID * square[..., -1:]
    if (square < -rigid).any():
        raise InputError("stiffness", None, "must not be negative in any direction")
    return _Basis(False, np.where(square < rigid, 0.0, square), vectors, square.shape[-1])


def _standard(matrix: Array, factor: Array) -> tuple[Array, Array]:
    """Return the solutions, rising, of A v = ν B v with B = L Lᵀ of the factor L, and VᵀBV = 1."""
    half = np.swapaxes(np.linalg.solve(factor, matrix), -1, -2)
    values, vectors = np.linalg.eigh(symmetric(np.linalg.solve(factor, half)))
    return values, np.linalg.solve(np.swapaxes(factor, -1, -2), vectors)


def _signs(shapes: Array) -> Array:
    """Return the sign (..., k) of the largest entry of each shape, the first of several that are equally large."""
    size = np.abs(shapes)
    largest = (size >= (1 - _TIE) * size.max(axis=-2, keepdims=True)).argmax(axis=-2)
    sign: Array = np.sign(np.take_along_axis(shapes, largest[..., None, :], axis=-2)[..., 0, :])
    return sign


def _changes(
    basis: _Basis, square: Array, shapes: Array, mass: Array, stiffness: Array
) -> tuple[Array, Array]:
    """Return the first-order changes of ω² (..., k) and of shapes with changes of mass and stiffness (..., n, n).

    From (A - ν B) φ' = -(A' - ν B' - ν' B) φ, written on all solutions; ΦᵀMΦ stays 1.
    """
    turned, of_mass, of_stiffness = np.swapaxes(basis.vectors, -1, -2), mass @ shapes, stiffness @ shapes
    own, others = basis.values[..., None, : square.shape[-1]], basis.values[..., :, None]
    first, second = (of_mass, of_stiffness) if basis.held else (of_stiffness, of_mass)
    close = _close(own, others)
    apart = turned @ (first - own * second) / np.where(close, 1.0, own - others)
    together = turned @ of_mass / (-2 * np.where(close & basis.held, others, 1.0))
    change = basis.vectors @ np.where(close, together, apart)
    moved = (shapes * (of_stiffness - square[..., None, :] * of_mass)).sum(axis=-2)
    return np.where(square > 0, moved, 0.0), change


def _close(one: Array, other: Array) -> Array:
    """Return whether two values belong to one frequency."""
    close: Array = np.abs(one - other) <= _CLOSE * np.maximum(np.abs(one), np.abs(other))
    return close


def _lowest_of_many(mass: Any, stiffness: Any, count: int) -> StructuralModes:
    """Return the lowest modes of one pair of large real matrices by shifted inverse iteration."""
    from scipy.sparse import csc_array  # here, because scipy is slow to import
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


def _with_mass_at_hub(mass: Any, hub: Array, rotor_mass: Numbers) -> Any:
    """Return the mass with a point mass at the hub."""
    if not np.any(rotor_mass):
        return mass
    moving: Any = hub[..., TRANSLATION, :]
    if not hasattr(mass, "toarray"):
        return mass + np.asarray(rotor_mass)[..., None, None] * (np.swapaxes(moving, -1, -2) @ moving)
    from scipy.sparse import csc_array

    moving = csc_array(moving)
    return csc_array(mass) + rotor_mass * (moving.T @ moving)


def symmetric(matrix: Array) -> Array:
    """Return the symmetric part of matrices (..., n, n): products leave rounding errors."""
    return (matrix + np.swapaxes(matrix, -1, -2)) / 2


def _dense(matrix: Any) -> Array:
    """Return a matrix as a dense array."""
    return matrix.toarray() if hasattr(matrix, "toarray") else np.asarray(matrix)
