"""Coordinates of a free aircraft: the motions of the aircraft as one body, and free elastic modes.

A mode is a deformation ψ relative to the fuselage together with the motion of the fuselage that leaves the aircraft's
momentum and moment of momentum at rest, r = -M_rr⁻¹ M_re ψ. ψ are the modes of K_ee and M_ee - M_er M_rr⁻¹ M_re, where
K_ee, of a wing on a held fuselage, is positive: no zero is ever looked for among rounding errors.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from proprotor.errors import InputError, list_choices
from proprotor.support.aircraft_structure import (
    ANTISYMMETRIC_AXES,
    SYMMETRIC_AXES,
    Fuselage,
    HalfAircraft,
    WingSide,
    centre_of_mass,
    half_aircraft,
    side_by_side,
)
from proprotor.support.airframe import SYMMETRIES, Airframe
from proprotor.support.beam import rigid_motion
from proprotor.support.beam_wing import arranged, ratios_by_kind
from proprotor.support.modal_reduction import ModalSupport, on_modes, per_mode, symmetric
from proprotor.typing import Array, Numbers

_CHOICES = ("both", *SYMMETRIES)
KINDS = ("beam", "chord", "torsion", "axial", "pylon yaw")
_AXES = {"symmetric": SYMMETRIC_AXES, "antisymmetric": ANTISYMMETRIC_AXES}
_RIGID_BODY = {"symmetric": ("heave", "surge", "pitch"), "antisymmetric": ("sway", "roll", "yaw")}
_RATES = ("heave", "surge", "sway", "roll")


class FreeAirframe(NamedTuple):
    """A free airframe, and the motion of its parts for each of the n coordinates.

    airframe : Airframe
        Without airloads.
    frequency : array (..., k)
        Of the elastic modes with the rotors' mass, rad/s, in the order of their names.
    right_shapes, left_shapes : array (..., 6 + m, n)
        Motion of the fuselage's datum and the coordinates of deformation of each side, in the axes of its own rotor.
    right, left : HalfAircraft
    """

    airframe: Airframe
    frequency: Array
    right_shapes: Array
    left_shapes: Array
    right: HalfAircraft
    left: HalfAircraft


def free_airframe(
    fuselage: Fuselage,
    right: WingSide,
    left: WingSide | None = None,
    *,
    modes: int = 6,
    symmetry: str = "both",
    damping_ratio: Numbers | Mapping[str, Numbers] = 0.0,
    rotor_mass: Numbers = 0.0,
    names: Sequence[str] = (),
) -> FreeAirframe:
    """Return a free aircraft, one design or many, as an airframe for two mirrored rotors.

    Many designs have the names of the first one, as those of `proprotor.support.beam_wing.beam_wing` have. Complex
    numbers give the derivatives of all matrices as imaginary parts.

    Parameters
    ----------
    fuselage : Fuselage
    right, left : WingSide
        Each in the axes of its own rotor. Without `left` the aircraft is symmetric, and its coordinates are symmetric
        or antisymmetric; with `left` all elastic modes are those of the whole structure.
    modes : int
        Number of the lowest elastic modes of each symmetry, twice as many with `left`. A mode is called after the
        stiffness with most of its strain energy, "symmetric beam", from the second mode of a kind on with a number.
    symmetry : "both", "symmetric" or "antisymmetric"
        Which coordinates to return.
    damping_ratio : float, array (...) or mapping
        Structural damping of the elastic modes as a fraction of critical: one value, or one for each of beam, chord,
        torsion, axial and pylon yaw.
    rotor_mass : float or array (...)
        Mass at each hub while modes are computed and damped, kg; this mass does not stay in the matrices.
    names : sequence of str
        Names of the coordinates in the order wanted for every design, by default the order of the first design.

    Returns
    -------
    FreeAirframe

    Raises
    ------
    InputError
        When there are fewer modes than asked for, when the wing could turn freely on the fuselage, for one symmetry of
        an unsymmetric aircraft, and for a damping ratio that is missing or out of range.
    """
    if symmetry not in _CHOICES:
        raise InputError("symmetry", symmetry, f"must be {list_choices(_CHOICES)}")
    if left is not None and symmetry != "both":
        raise InputError("symmetry", symmetry, 'must be "both" for an aircraft whose left side differs')
    sides = right, left or right
    if symmetry != "antisymmetric" and all(side.carry_through.turns_freely("twist") for side in sides):
        rule = "must be held or a stiffness: nothing else keeps the wing from turning on the fuselage"
        raise InputError("carry_through.twist", "free", rule)
    half = half_aircraft(right)
    other = half if left is None else half_aircraft(left)
    model = partial(_on_columns, fuselage.mass_at_datum, _by_kind(damping_ratio), rotor_mass, tuple(names))
    if left is not None:
        return model(_of_the_whole(half, other), 2 * modes)
    wanted = SYMMETRIES if symmetry == "both" else (symmetry,)
    return _beside([model(_of_one_symmetry(half, one), modes) for one in wanted])


class _Columns(NamedTuple):
    """Motion of both sides for each of m coordinates, of which the first move the aircraft as one body.

    right, left : HalfAircraft
    to_right, to_left : array (6 + n, m)
        Coordinates of each side, in the axes of its own rotor, per unit of each of the m coordinates, in every design.
    symmetries : tuple of str
        Symmetries of the rigid motions.
    mode_symmetry : str
        Of all elastic modes.
    """

    right: HalfAircraft
    left: HalfAircraft
    to_right: Array
    to_left: Array
    symmetries: tuple[str, ...]
    mode_symmetry: str

    def half(self, of_right: Array, of_left: Array) -> Array:
        """Return half the sum of a matrix of each side on the m coordinates."""
        right = self.to_right.T @ of_right @ self.to_right
        return symmetric(right + self.to_left.T @ of_left @ self.to_left) / 2

    def stiffness_parts(self) -> dict[str, Array]:
        """Return the parts of half the stiffness on the coordinates of deformation."""
        sides = self.right, self.left
        kinds = dict.fromkeys(kind for side in sides for kind in side.structure.stiffness_parts)
        rigid = 3 * len(self.symmetries)
        parts = {kind: self.half(*(_padded(side, kind) for side in sides)) for kind in kinds}
        return {kind: part[..., rigid:, rigid:] for kind, part in parts.items()}


def _padded(side: HalfAircraft, kind: str) -> Array:
    """Return a part of the stiffness of one side (..., 6 + n, 6 + n), zero for a kind that this side has not."""
    part = side.structure.stiffness_parts.get(kind, np.zeros((len(side.structure.names),) * 2))
    return _bordered(part, 6)


def _bordered(matrix: Array, count: int) -> Array:
    """Return matrices (..., count + n, count + n) with zeros before each row and each column."""
    return np.pad(matrix, [(0, 0)] * (matrix.ndim - 2) + [(count, 0)] * 2)


def _of_one_symmetry(half: HalfAircraft, symmetry: str) -> _Columns:
    """Return the coordinates of a symmetric aircraft that one symmetry leaves free."""
    axes, count = list(_AXES[symmetry]), half.mass.shape[-1]
    columns = np.eye(count)[:, axes + [6 + axis for axis in sorted(axes)] + list(range(12, count))]
    sign = 1 if symmetry == "symmetric" else -1
    return _Columns(half, half, columns, sign * columns, (symmetry,), symmetry)


def _of_the_whole(right: HalfAircraft, left: HalfAircraft) -> _Columns:
    """Return the coordinates of an aircraft with two different sides: what both share first, then each side's own."""
    shared = [*SYMMETRIC_AXES, *ANTISYMMETRIC_AXES, *range(6, 12)]
    own = [side.mass.shape[-1] - 12 for side in (right, left)]
    to_right, to_left = (np.zeros((12 + count, 12 + sum(own))) for count in own)
    to_right[shared, np.arange(12)], to_left[shared, np.arange(12)] = 1.0, _MIRROR[shared]
    to_right[12:, 12 : 12 + own[0]], to_left[12:, 12 + own[0] :] = np.eye(own[0]), np.eye(own[1])
    return _Columns(right, left, to_right, to_left, SYMMETRIES, "")


# The left side sees an antisymmetric motion of the plane of symmetry with the opposite sign.
_MIRROR = np.tile(np.where(np.isin(np.arange(6), SYMMETRIC_AXES), 1.0, -1.0), 2)


def _on_columns(
    body: Array,
    ratios: Mapping[str, Numbers],
    rotor_mass: Numbers,
    names: tuple[str, ...],
    columns: _Columns,
    count: int,
) -> FreeAirframe:
    """Return the rigid motions and the lowest elastic modes of some coordinates.

    Parameters
    ----------
    body : array (..., 6, 6)
        Mass of the fuselage on the motion of the datum.
    ratios : mapping of str to float
    rotor_mass : float
    names : tuple of str
    columns : _Columns
    count : int
    """
    right, left, rigid = columns.right, columns.left, 3 * len(columns.symmetries)
    of_fuselage = columns.to_right[:6]
    own = of_fuselage.T @ body @ of_fuselage / 2
    loaded = own + columns.half(right.loaded(rotor_mass), left.loaded(rotor_mass))
    follow = _exact(_follow, loaded[..., :rigid, :])
    reduced = symmetric(loaded[..., rigid:, rigid:] + loaded[..., rigid:, :rigid] @ follow)
    prefix = f"{columns.mode_symmetry} ".lstrip()
    rigid_names = _motions(columns.symmetries)
    wanted = [name for name in names if name.startswith(prefix) and name not in rigid_names]
    found = _elastic(
        columns.stiffness_parts(), reduced, count, ratios, tuple(name.removeprefix(prefix) for name in wanted)
    )
    bodies = body + (right.rigid_mass(rotor_mass) + left.rigid_mass(rotor_mass)) / 2
    about_centre = rigid_motion(-centre_of_mass(bodies))  # the datum moves with the centre of mass
    moved = of_fuselage[:, :rigid].T @ about_centre @ of_fuselage[:, :rigid]
    still = [(0, 0)] * (moved.ndim - 2) + [(0, reduced.shape[-1]), (0, 0)]  # rigid motions deform nothing
    shapes = side_by_side(
        np.pad(moved, still), np.concatenate([follow @ found.shapes, found.shapes], axis=-2)
    )
    mass = np.swapaxes(shapes, -1, -2) @ (own + columns.half(right.mass, left.mass)) @ shapes
    sides = columns.to_right @ shapes, columns.to_left @ shapes
    airframe = Airframe(
        names=(*rigid_names, *(f"{prefix}{name}" for name in found.support.names)),
        mass=symmetric(mass),
        damping=_bordered(found.support.damping, rigid),
        stiffness=_bordered(found.support.stiffness, rigid),
        hub=right.hub @ sides[0],
        left_hub=left.hub @ sides[1],
        includes_rotor=False,
        rigid_body=rigid_names,
        rates=_motions(columns.symmetries, _RATES),
        symmetry=(*np.repeat(columns.symmetries, 3).tolist(), *(columns.mode_symmetry,) * count),
        shapes=sides[0] if shapes.ndim > 2 else None,
        warning=found.support.warning,
    )
    return FreeAirframe(airframe, found.modes.frequency, *sides, right, left)


def _elastic(
    parts: Mapping[str, Array],
    mass: Array,
    count: int,
    ratios: Mapping[str, Numbers],
    names: tuple[str, ...],
) -> ModalSupport:
    """Return the lowest modes of the deformation, whose mass (..., m, m) includes what the fuselage does meanwhile."""
    size = mass.shape[-1]
    return on_modes(
        [str(place) for place in range(size)],
        mass,
        sum(parts.values(), start=np.zeros(())),
        np.zeros((6, size)),
        count=count,
        damping_ratio=partial(ratios_by_kind, parts, ratios),
        arrange=partial(arranged, parts, names),
    )


def _follow(rows: Array) -> Array:
    """Return the rigid motion (..., r, m) that follows a deformation; rows (..., r, r + m) of the mass."""
    rigid = rows.shape[-2]
    return -np.linalg.solve(rows[..., :rigid], rows[..., rigid:])


def _exact(function: Callable[[Array], Array], given: Array) -> Array:
    """Return a function of an array; imaginary parts leave the real part as it is without them, to the last digit."""
    found = function(given)
    return found if np.isrealobj(found) else function(np.real(given)) + 1j * np.imag(found)


def _motions(symmetries: Sequence[str], among: Sequence[str] | None = None) -> tuple[str, ...]:
    """Return the names of the rigid motions of some symmetries, of all or of some motions."""
    found = [(symmetry, motion) for symmetry in symmetries for motion in _RIGID_BODY[symmetry]]
    return tuple(f"{symmetry} {motion}" for symmetry, motion in found if among is None or motion in among)


def _beside(parts: Sequence[FreeAirframe]) -> FreeAirframe:
    """Return coordinates that do not couple side by side: the symmetric ones, then the antisymmetric ones."""
    if len(parts) == 1:
        return parts[0]
    frames = [part.airframe for part in parts]
    matrices: dict[str, Any] = {
        name: _block_diagonal([getattr(frame, name) for frame in frames])
        for name in ("mass", "damping", "stiffness")
    }
    words: dict[str, Any] = {
        name: tuple(word for frame in frames for word in getattr(frame, name))
        for name in ("names", "symmetry", "rigid_body", "rates")
    }

    def along(arrays: Iterable[Array]) -> Array:
        return np.concatenate(list(arrays), axis=-1)

    right, left = along(part.right_shapes for part in parts), along(part.left_shapes for part in parts)
    airframe = Airframe(
        **matrices,
        **words,
        hub=along(frame.hub for frame in frames),
        left_hub=along(frame.left_hub for frame in frames),
        includes_rotor=False,
        shapes=right if right.ndim > 2 else None,
        warning=_warnings([frame.warning for frame in frames]),
    )
    frequency = along(part.frequency for part in parts)
    return FreeAirframe(airframe, frequency, right, left, parts[0].right, parts[0].left)


def _warnings(each: Sequence[Array | None]) -> Array | None:
    """Return the warnings (...) of the designs in all parts."""
    given = [warning for warning in each if warning is not None]
    if not given:
        return None
    together = zip(*(warning.ravel() for warning in given), strict=True)
    texts = ["; ".join(filter(None, of_design)) for of_design in together]
    return np.array(texts, dtype=object).reshape(given[0].shape)


def _block_diagonal(blocks: Sequence[Array]) -> Array:
    """Return matrices of square blocks (..., n, n) on their diagonal, zero elsewhere."""
    size = sum(block.shape[-1] for block in blocks)
    whole = np.zeros((*blocks[0].shape[:-2], size, size), dtype=np.result_type(*blocks))
    start = 0
    for block in blocks:
        own = slice(start, start + block.shape[-1])
        whole[..., own, own], start = block, own.stop
    return whole


def _by_kind(damping_ratio: Numbers | Mapping[str, Numbers]) -> Mapping[str, Numbers]:
    """Return the damping ratio of each kind of mode; refuse a missing kind and a value out of range."""
    given = damping_ratio if isinstance(damping_ratio, Mapping) else dict.fromkeys(KINDS, damping_ratio)
    for kind in KINDS:
        if kind not in given:
            raise InputError(f"damping_ratio[{kind}]", None, "is missing")
        per_mode(given[kind], 1)
    return given
