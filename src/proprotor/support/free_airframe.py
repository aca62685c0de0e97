"""Coordinates of a free aircraft: the motions of the aircraft as one body, and free elastic modes.

A mode is a deformation ψ relative to the fuselage together with the motion of the fuselage that leaves the aircraft's
momentum and moment of momentum at rest, r = -M_rr⁻¹ M_re ψ. ψ are the modes of K_ee and M_ee - M_er M_rr⁻¹ M_re, where
K_ee, of a wing on a held fuselage, is positive: no zero is ever looked for among rounding errors.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
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
)
from proprotor.support.airframe import SYMMETRIES, Airframe
from proprotor.support.beam_wing import kinds_by_energy, numbered, rigid_motion
from proprotor.support.modal_reduction import lowest_modes, per_mode, symmetric
from proprotor.typing import Array

_CHOICES = ("both", *SYMMETRIES)
KINDS = ("beam", "chord", "torsion", "axial", "pylon yaw")
_AXES = {"symmetric": SYMMETRIC_AXES, "antisymmetric": ANTISYMMETRIC_AXES}
_RIGID_BODY = {"symmetric": ("heave", "surge", "pitch"), "antisymmetric": ("sway", "roll", "yaw")}
_RATES = ("heave", "surge", "sway", "roll")


class FreeAirframe(NamedTuple):
    """A free airframe, and the motion of its parts for each of the n coordinates.

    airframe : Airframe
        Without airloads.
    frequency : array
        Of the elastic modes with the rotors' mass, rad/s, in the order of their names.
    right_shapes, left_shapes : array (6 + m, n)
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
    damping_ratio: float | Mapping[str, float] = 0.0,
    rotor_mass: float = 0.0,
) -> FreeAirframe:
    """Return a free aircraft as an airframe for two mirrored rotors.

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
    damping_ratio : float or mapping
        Structural damping of the elastic modes as a fraction of critical: one value, or one for each of beam, chord,
        torsion, axial and pylon yaw.
    rotor_mass : float
        Mass at each hub while modes are computed and damped, kg; this mass does not stay in the matrices.

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
    for side in (right, left or right):
        if symmetry != "antisymmetric" and side.carry_through.twist == "free":
            rule = "must be held or a stiffness: nothing else keeps the wing from turning on the fuselage"
            raise InputError("twist", "free", rule)
    half = half_aircraft(right)
    other = half if left is None else half_aircraft(left)
    body, ratios = fuselage.mass_at_datum, _by_kind(damping_ratio)
    if left is not None:
        return _on_columns(_of_the_whole(half, other), body, 2 * modes, ratios, rotor_mass)
    wanted = SYMMETRIES if symmetry == "both" else (symmetry,)
    return _beside(
        [_on_columns(_of_one_symmetry(half, one), body, modes, ratios, rotor_mass) for one in wanted]
    )


class _Columns(NamedTuple):
    """Motion of both sides for each of m coordinates, of which the first move the aircraft as one body.

    right, left : HalfAircraft
    to_right, to_left : array (6 + n, m)
        Coordinates of each side, in the axes of its own rotor, per unit of each of the m coordinates.
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
        return {kind: self.half(*(_padded(side, kind) for side in sides))[rigid:, rigid:] for kind in kinds}


def _padded(side: HalfAircraft, kind: str) -> Array:
    """Return a part of the stiffness of one side (6 + n, 6 + n), zero for rigid motions and for a kind without any."""
    whole = np.zeros_like(side.mass)
    whole[6:, 6:] = side.structure.stiffness_parts.get(kind, 0.0)
    return whole


def _of_one_symmetry(half: HalfAircraft, symmetry: str) -> _Columns:
    """Return the coordinates of a symmetric aircraft that one symmetry leaves free."""
    axes, count = list(_AXES[symmetry]), len(half.mass)
    columns = np.eye(count)[:, axes + [6 + axis for axis in sorted(axes)] + list(range(12, count))]
    sign = 1 if symmetry == "symmetric" else -1
    return _Columns(half, half, columns, sign * columns, (symmetry,), symmetry)


def _of_the_whole(right: HalfAircraft, left: HalfAircraft) -> _Columns:
    """Return the coordinates of an aircraft with two different sides: what both share first, then each side's own."""
    shared = [*SYMMETRIC_AXES, *ANTISYMMETRIC_AXES, *range(6, 12)]
    own = [len(side.mass) - 12 for side in (right, left)]
    to_right, to_left = (np.zeros((len(side.mass), 12 + sum(own))) for side in (right, left))
    to_right[shared, np.arange(12)], to_left[shared, np.arange(12)] = 1.0, _MIRROR[shared]
    to_right[12:, 12 : 12 + own[0]], to_left[12:, 12 + own[0] :] = np.eye(own[0]), np.eye(own[1])
    return _Columns(right, left, to_right, to_left, SYMMETRIES, "")


# The left side sees an antisymmetric motion of the plane of symmetry with the opposite sign.
_MIRROR = np.tile(np.where(np.isin(np.arange(6), SYMMETRIC_AXES), 1.0, -1.0), 2)


def _on_columns(
    columns: _Columns, body: Array, count: int, ratios: Mapping[str, float], rotor_mass: float
) -> FreeAirframe:
    """Return the rigid motions and the lowest elastic modes of some coordinates.

    Parameters
    ----------
    columns : _Columns
    body : array (6, 6)
        Mass of the fuselage on the motion of the datum.
    count : int
    ratios : mapping of str to float
    rotor_mass : float
    """
    right, left, rigid = columns.right, columns.left, 3 * len(columns.symmetries)
    of_fuselage = columns.to_right[:6]
    own = of_fuselage.T @ body @ of_fuselage / 2
    loaded = own + columns.half(right.loaded(rotor_mass), left.loaded(rotor_mass))
    parts = columns.stiffness_parts()
    follow = -np.linalg.solve(loaded[:rigid, :rigid], loaded[:rigid, rigid:])
    reduced = symmetric(loaded[rigid:, rigid:] + loaded[rigid:, :rigid] @ follow)
    frequency, modes = lowest_modes(reduced, sum(parts.values()), count)
    bodies = body + (right.rigid_mass(rotor_mass) + left.rigid_mass(rotor_mass)) / 2
    about_centre = rigid_motion(-centre_of_mass(bodies))  # the datum moves with the centre of mass
    shapes = np.zeros((len(loaded), rigid + count))
    shapes[:rigid, :rigid] = of_fuselage[:, :rigid].T @ about_centre @ of_fuselage[:, :rigid]
    shapes[:, rigid:] = np.concatenate([follow @ modes, modes])
    kinds = kinds_by_energy(parts, modes)
    ratio = np.array([ratios[kind] for kind in kinds])
    mass = shapes.T @ (own + columns.half(right.mass, left.mass)) @ shapes
    still = np.zeros(rigid)
    sides = columns.to_right @ shapes, columns.to_left @ shapes
    airframe = Airframe(
        names=(
            *_motions(columns.symmetries),
            *(f"{columns.mode_symmetry} {kind}".strip() for kind in numbered(kinds)),
        ),
        mass=symmetric(mass),
        damping=np.diag(np.concatenate([still, 2 * ratio * frequency])),
        stiffness=np.diag(np.concatenate([still, frequency**2])),
        hub=right.hub @ sides[0],
        left_hub=left.hub @ sides[1],
        includes_rotor=False,
        rigid_body=_motions(columns.symmetries),
        rates=_motions(columns.symmetries, _RATES),
        symmetry=tuple(np.repeat(columns.symmetries, 3)) + (columns.mode_symmetry,) * count,
    )
    return FreeAirframe(airframe, frequency, *sides, right, left)


def _motions(symmetries: Sequence[str], among: Sequence[str] | None = None) -> tuple[str, ...]:
    """Return the names of the rigid motions of some symmetries, of all or of some motions."""
    found = [(symmetry, motion) for symmetry in symmetries for motion in _RIGID_BODY[symmetry]]
    return tuple(f"{symmetry} {motion}" for symmetry, motion in found if among is None or motion in among)


def _beside(parts: Sequence[FreeAirframe]) -> FreeAirframe:
    """Return coordinates that do not couple side by side: the symmetric ones, then the antisymmetric ones."""
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

    hub, left_hub = along(frame.hub for frame in frames), along(frame.left_hub for frame in frames)
    return FreeAirframe(
        Airframe(**matrices, **words, hub=hub, left_hub=left_hub, includes_rotor=False),
        along(part.frequency for part in parts),
        along(part.right_shapes for part in parts),
        along(part.left_shapes for part in parts),
        parts[0].right,
        parts[0].left,
    )


def _block_diagonal(blocks: Sequence[Array]) -> Array:
    """Return a matrix of square blocks on its diagonal, zero elsewhere."""
    whole = np.zeros((sum(len(block) for block in blocks),) * 2)
    start = 0
    for block in blocks:
        own = slice(start, start + len(block))
        whole[own, own], start = block, own.stop
    return whole


def _by_kind(damping_ratio: float | Mapping[str, float]) -> Mapping[str, float]:
    """Return the damping ratio of each kind of mode; refuse a missing kind and a value out of range."""
    given = damping_ratio if isinstance(damping_ratio, Mapping) else dict.fromkeys(KINDS, damping_ratio)
    for kind in KINDS:
        if kind not in given:
            raise InputError(f"damping_ratio[{kind}]", None, "is missing")
        per_mode(given[kind], 1)
    return given
