"""Mount two mirrored rotors that turn opposite ways on an airframe, in symmetric and antisymmetric coordinates.

A coordinate q of the right rotor is q_s + q_a, and that of the left rotor, in its mirrored axes, q_s - q_a. With T_s
and T_a the coordinates of a rotor alone per unit of symmetric and antisymmetric ones, the virtual work of both rotors,
halved like all matrices of an airframe, is

    T_sᵀ S T_s + T_aᵀ S T_a + T_sᵀ D T_a + T_aᵀ D T_s,    S = (M_r + M_l)/2,    D = (M_r - M_l)/2

for M, and alike for C, K and B. Equal rotors have D = 0: the two halves do not couple, and each is the problem of one
rotor on the coordinates of its half.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError
from proprotor.model.linear_model import INPUTS, LinearModel
from proprotor.model.massless import with_reasons
from proprotor.model.mount import at_points, broadcast, check_hub, failed_where, refused_where, with_warning
from proprotor.model.rotor_share import without_rotors
from proprotor.rotor.kept import kept
from proprotor.rotor.motions import HALVES, HUB, MAST_TWIST, ROTOR_SPEED, check_distinct, half_of, in_half
from proprotor.rotor.trim import Trim
from proprotor.support.airframe import Airframe
from proprotor.typing import Array

_MATRICES = ("M", "C", "K")
_STILL = 1e-9  # stiffness along a rate, relative to the largest stiffness: rounding
_ONE_SHAFT = (
    "drive_train.shaft_stiffness: a shaft holds the azimuth of one side alone, so that the other side has no "
    "coordinate of its own for its rate; give an interconnect_stiffness, or a shaft on both sides or on none"
)


class _Half(NamedTuple):
    """One half of the motion of a model of two rotors.

    half : "symmetric" or "antisymmetric"; to_rotor (..., 6 + own, n) : coordinates of a rotor alone per unit of each
    coordinate of the model, as far as they belong to this half.
    """

    half: str
    to_rotor: Array


class _Side(NamedTuple):
    """What M, C, K and B of two rotors have in common, and the half of their difference, if they differ."""

    mean: dict[str, Array]
    difference: dict[str, Array]


def mount_pair(
    right: LinearModel,
    airframe: Airframe,
    left: LinearModel | None = None,
    interconnect_stiffness: ArrayLike = 0.0,
) -> LinearModel:
    """Return the model of half an airframe with the halves of two rotors, on coordinates of both halves of the motion.

    Parameters
    ----------
    right : LinearModel
        The right rotor alone: six hub coordinates, then its own.
    airframe : Airframe
        With coordinates of one symmetry, for one half of the motion alone, or of both.
    left : LinearModel, optional
        The left rotor alone, in its mirrored axes; the mirror image of the right one by default.
    interconnect_stiffness : float or array (...)
        Torque per difference of the azimuths of both sides, N m/rad.

    Returns
    -------
    LinearModel
        With the coordinates of the airframe first, then those of the rotors, "symmetric gimbal_1c" and so on. The trim
        is that of the right rotor, with the reasons and warnings of both. `halves_couple` says whether the halves are
        one problem.

    Raises
    ------
    InputError
        For rotors with different coordinates, a name that is taken, a left rotor of its own with coordinates of one
        symmetry, a rate along which there is stiffness, or an airframe without mass of its own.
    """
    _check(right, airframe, left)
    check_distinct("support.names", _names(airframe, right))
    at_rest = None if left is None else left.mass_at_rest
    mass, refusal = without_rotors(airframe, shares(airframe, right.mass_at_rest, at_rest))
    additions = {"M": mass, "C": airframe.damping, "K": airframe.stiffness}
    rotors = rotors_on(right, airframe, left, interconnect_stiffness, additions)
    right, left = rotors.rotor or right, rotors.left
    trim = right.trim if left is None else _trim(right, left, interconnect_stiffness)
    coupled = replace(
        rotors,
        trim=with_warning(trim, at_points(airframe.warning, trim.converged.shape, 0)),
        halves_couple=left is not None or _couples(airframe, additions),
    )
    _check_rates(coupled)
    coupled = failed_where(airframe.refusal, with_reasons(failed_where(coupled.trim.reason, coupled)))
    return refused_where(refusal, coupled, airframe)


def rotors_on(
    right: LinearModel,
    airframe: Airframe,
    left: LinearModel | None = None,
    interconnect_stiffness: ArrayLike = 0.0,
    additions: Mapping[str, Array] | None = None,
) -> LinearModel:
    """Return two rotors on the coordinates of an airframe, with matrices of the airframe to add, none by default.

    Parameters
    ----------
    right, airframe, left, interconnect_stiffness
        As for `mount_pair`; nothing is checked.
    additions : mapping of str to array (..., n, n), optional
        Matrices of half an airframe to be added to M, C and K.
    """
    names, added = _names(airframe, right), dict(additions or {})
    both = [right] if left is None else [right, left]
    parts = [airframe.hub, *added.values(), *(model.M for model in both)]
    shape = np.broadcast_shapes(np.shape(interconnect_stiffness), *(part.shape[:-2] for part in parts))
    right, left = broadcast(right, shape), None if left is None else broadcast(left, shape)
    hubs: dict[str, Any] = {
        side: _padded(getattr(airframe, side), len(names)) for side in ("hub", "left_hub")
    }
    halves, own = _halves_in(airframe), right.dofs[len(HUB) :]
    motions = _halves(halves, hubs["hub"], hubs["left_hub"], names, own)
    rotors = _mean_and_difference(right, left)
    matrices: dict[str, Any] = {kind: _on_airframe(kind, rotors, motions) for kind in _MATRICES}
    matrices["K"] = matrices["K"] + _interconnect(names, interconnect_stiffness)
    for kind, matrix in added.items():
        matrices[kind] = matrices[kind] + _in_corner(matrix, len(names))
    if right.B is not None:
        matrices["B"] = _inputs(rotors, motions)
    return replace(
        right,
        **matrices,
        **hubs,
        dofs=names,
        rotor=right,
        left=left,
        mass_at_rest=None,
        shapes=_shapes_by_half(airframe, at_points(airframe.shapes, shape, 2)),
        rates=(*airframe.rates, *(in_half(half, name) for half in halves for name in right.rates)),
        rigid_body=airframe.rigid_body,
        symmetry=(*airframe.symmetry, *(half for half in halves for _ in own)),
        inputs=tuple(in_half(half, name) for half in halves for name in INPUTS),
        apart=_apart(right.apart, halves, together=left is not None),
    )


def _halves_in(airframe: Airframe) -> list[str]:
    """Return the halves of the motion that an airframe has coordinates of."""
    return [half for half in HALVES if half in airframe.symmetry or "" in airframe.symmetry]


def _names(airframe: Airframe, rotor: LinearModel) -> tuple[str, ...]:
    """Return the names of the coordinates of an airframe with two rotors."""
    own = rotor.dofs[len(HUB) :]
    return (*airframe.names, *(in_half(half, name) for half in _halves_in(airframe) for name in own))


def _apart(
    groups: tuple[tuple[str, ...], ...], halves: list[str], together: bool
) -> tuple[tuple[str, ...], ...]:
    """Return groups of coordinates of a rotor in the halves of the motion, which couple where the rotors differ."""
    parts = [halves] if together else [[half] for half in halves]
    return tuple(
        tuple(in_half(half, name) for half in part for name in group) for part in parts for group in groups
    )


def halves_of(model: LinearModel) -> list[_Half]:
    """Return the halves of the motion of a model of two rotors."""
    assert model.rotor is not None and model.hub is not None and model.left_hub is not None
    halves = list(dict.fromkeys(half_of(name)[0] for name in model.inputs))
    return _halves(halves, model.hub, model.left_hub, model.dofs, model.rotor.dofs[len(HUB) :])


def hub_rows(model: LinearModel, name: str) -> dict[str, Array]:
    """Return the hub rows of one of M, C and K of the rotors (..., 6, n), by half of the motion.

    The mean of the loads of both hubs, each in the axes of its rotor, is their symmetric part, and half their
    difference the antisymmetric part.
    """
    assert model.rotor is not None
    rotors, motions = _mean_and_difference(model.rotor, model.left), halves_of(model)
    found = {}
    for one in motions:
        parts = [(rotors.mean if other is one else rotors.difference, other.to_rotor) for other in motions]
        loads = sum(part[name][..., : len(HUB), :] @ to_rotor for part, to_rotor in parts if part)
        found[one.half] = np.asarray(loads)
    return found


def hub_inputs(model: LinearModel) -> dict[str, Array]:
    """Return the hub rows of the inputs of the rotors (..., 6, inputs), by half of the motion."""
    assert model.rotor is not None
    rotors, motions = _mean_and_difference(model.rotor, model.left), halves_of(model)
    return {
        one.half: np.concatenate(
            [
                (rotors.mean if other is one else rotors.difference or _nothing(rotors))["B"][
                    ..., : len(HUB), :
                ]
                for other in motions
            ],
            axis=-1,
        )
        for one in motions
    }


# Matrices -------------------------------------------------------------------------------------------------------------


def _mean_and_difference(right: LinearModel, left: LinearModel | None) -> _Side:
    """Return M, C, K and B of two rotors as mean and half of the difference."""
    if left is None:
        return _Side(right.matrices, {})
    pairs = {name: (matrix, left.matrices[name]) for name, matrix in right.matrices.items()}
    return _Side(
        {name: (one + other) / 2 for name, (one, other) in pairs.items()},
        {name: (one - other) / 2 for name, (one, other) in pairs.items()},
    )


def _nothing(rotors: _Side) -> dict[str, Array]:
    return {name: np.zeros_like(matrix) for name, matrix in rotors.mean.items()}


def _halves(
    halves: list[str], hub: Array, left_hub: Array, names: tuple[str, ...], own: tuple[str, ...]
) -> list[_Half]:
    """Return the coordinates of a rotor alone in each half of the motion, per unit of each coordinate."""
    found = []
    for half in halves:
        sign = 1.0 if half == HALVES[0] else -1.0
        rows = np.zeros((len(own), len(names)))
        for row, name in enumerate(own):
            if in_half(half, name) in names:  # a coordinate that a submodel leaves out stays at zero
                rows[row, names.index(in_half(half, name))] = 1
        at_hub = (hub + sign * left_hub) / 2
        rows = np.broadcast_to(rows, (*at_hub.shape[:-2], *rows.shape))
        found.append(_Half(half, np.concatenate([at_hub, rows], axis=-2)))
    return found


def _on_airframe(kind: str, rotors: _Side, motions: list[_Half]) -> Array:
    """Return one of M, C and K of the rotors on the coordinates of the model."""
    whole = sum(np.swapaxes(one.to_rotor, -1, -2) @ rotors.mean[kind] @ one.to_rotor for one in motions)
    if rotors.difference:
        one, other = (half.to_rotor for half in motions)
        across = np.swapaxes(one, -1, -2) @ rotors.difference[kind] @ other
        back = np.swapaxes(other, -1, -2) @ rotors.difference[kind] @ one
        whole = whole + across + back
    return np.asarray(whole)


def _inputs(rotors: _Side, motions: list[_Half]) -> Array:
    """Return the loads per unit of the inputs of each half of the motion in turn."""
    columns = []
    for of_input in motions:
        loads = sum(
            np.swapaxes(one.to_rotor, -1, -2) @ part["B"]
            for one in motions
            if (part := rotors.mean if one is of_input else rotors.difference)
        )
        columns.append(np.asarray(loads))
    return np.concatenate(columns, axis=-1)


def _interconnect(names: tuple[str, ...], stiffness: ArrayLike) -> Array:
    """Return the stiffness (..., n, n) of half the interconnect shaft, whose energy is k (ψ_r - ψ_l)²/2 = 2k ψ_a²."""
    strain = np.zeros(len(names))
    for name in (ROTOR_SPEED, MAST_TWIST):
        if (place := in_half(HALVES[1], name)) in names:
            strain[names.index(place)] = 1
    return 2 * np.asarray(stiffness)[..., None, None] * np.outer(strain, strain)


def _in_corner(matrix: Array, count: int) -> Array:
    """Return a matrix of the airframe with zeros for the coordinates of the rotors."""
    more = (0, count - matrix.shape[-1])
    return np.pad(matrix, [(0, 0)] * (matrix.ndim - 2) + [more, more])


def _padded(hub: Array, count: int) -> Array:
    """Return the motion of a hub with zeros for the coordinates of the rotors."""
    return np.pad(hub, [(0, 0)] * (hub.ndim - 1) + [(0, count - hub.shape[-1])])


def _shapes_by_half(airframe: Airframe, shapes: Array | None) -> Array | None:
    """Return shapes of the right side as symmetric and antisymmetric shapes, so that no two halves look alike."""
    if shapes is None:
        return None
    own = [np.array([of in (half, "") for of in airframe.symmetry]) for half in HALVES]
    return np.concatenate([shapes * kept for kept in own], axis=-2)


def _couples(airframe: Airframe, additions: dict[str, Array]) -> bool:
    """Return whether the airframe itself couples symmetric with antisymmetric coordinates."""
    of = np.array(airframe.symmetry)
    across = of[:, None] != of
    return "" in airframe.symmetry or any(np.any(matrix[..., across]) for matrix in additions.values())


def shares(
    airframe: Airframe, right: Array | None, left: Array | None = None
) -> list[tuple[Array, Array | None]]:
    """Return the hub motions and masses at rest of two rotors, whose shares half of an airframe may include.

    The left rotor is alike by default.
    """
    hubs = _hubs(airframe.hub, airframe.left_hub, "alike" if left is None else "different")
    return list(zip(hubs, (right, right if left is None else left), strict=True))


@kept
def _hubs(hub: Array, left_hub: Array, sides: str) -> tuple[Array, Array]:
    """Return the hub motions of half an airframe: of both halves of the motion, or of both of its different sides."""
    if sides == "alike":
        hubs = (hub + left_hub) / 2, (hub - left_hub) / 2
    else:
        hubs = np.sqrt(0.5) * hub, np.sqrt(0.5) * left_hub
    for motion in hubs:
        motion.flags.writeable = False
    return hubs


# Trim -----------------------------------------------------------------------------------------------------------------


def _trim(right: LinearModel, left: LinearModel, interconnect: ArrayLike) -> Trim:
    """Return the trim of the right rotor, with the reasons and warnings of both."""
    trim = right.trim
    reason = _first_text(trim.reason, left.trim.reason, "left rotor: ")
    reason = np.where((reason == "") & _one_shaft(right, left, interconnect), _ONE_SHAFT, reason)
    warning = _both_texts(trim.warning, left.trim.warning, "left rotor: ")
    return replace(trim, reason=reason, warning=warning, converged=np.asarray(reason == ""))


def _first_text(own: Array, other: Array, before: str) -> Array:
    """Return texts of the right rotor; where there is none, those of the left rotor with words before them."""
    return np.where(own != "", own, np.where(other != "", before + other.astype(object), ""))


def _both_texts(own: Array, other: Array, before: str) -> Array:
    """Return texts of both rotors, those of the left one with words before them unless the right one has them too."""
    more = np.where((other == "") | (other == own), "", before + other.astype(object))
    between = np.where((own != "") & (more != ""), "; ", "")
    return np.asarray(own.astype(object) + between.astype(object) + more, dtype=object)


def _one_shaft(right: LinearModel, left: LinearModel, interconnect: ArrayLike) -> Array:
    """Return the points at which a shaft holds the azimuth of one side alone, and no interconnect that of the other."""
    alone = right.shaft_holds_azimuth != left.shaft_holds_azimuth
    return np.asarray(alone & ~(np.real(interconnect) > 0))


# Checks ---------------------------------------------------------------------------------------------------------------


def _check(right: LinearModel, airframe: Airframe, left: LinearModel | None) -> None:
    """Refuse rotors that do not belong on the airframe."""
    check_hub("dofs", right)
    if left is None:
        return
    if left.dofs != right.dofs:
        own = {"left": set(left.dofs) - set(right.dofs), "right": set(right.dofs) - set(left.dofs)}
        alone = [
            f"the {side} one alone has {', '.join(sorted(names))}" for side, names in own.items() if names
        ]
        rule = "must have the coordinates of the right rotor in the same order"
        raise InputError("left", None, "; ".join([rule, *alone]))
    if not {*airframe.symmetry} >= {*HALVES} and "" not in airframe.symmetry:
        rule = "must hold symmetric and antisymmetric coordinates where the left side differs: both halves couple"
        raise InputError("support.symmetry", ", ".join(dict.fromkeys(airframe.symmetry)), rule)


def _check_rates(model: LinearModel) -> None:
    """Refuse a rate along which there is stiffness: its displacement would have to be a state."""
    places = [model.dofs.index(name) for name in model.rates]
    stiffness = np.nan_to_num(np.abs(model.K))
    wrong = (stiffness[..., places] > _STILL * stiffness.max(axis=(-2, -1), keepdims=True)).any(axis=-2)
    for name, found in zip(model.rates, np.moveaxis(wrong, -1, 0), strict=True):
        if found.any():
            raise InputError("support.rates", name, "must be coordinates along which nothing has stiffness")
