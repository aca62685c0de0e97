"""Mount a rotor, or a model in its place, on a support: the support's coordinates replace the hub coordinates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from proprotor.compiled.motion import MOST_ROWS, Support, on_support
from proprotor.errors import InputError
from proprotor.model.batches import at_rows, few_at_once, joint_shape
from proprotor.model.linear_model import LinearModel
from proprotor.model.massless import with_reasons
from proprotor.model.rotor_share import refuse, without_rotors
from proprotor.rotor.kept import kept
from proprotor.rotor.motions import HUB, check_distinct
from proprotor.rotor.trim import Trim
from proprotor.support.normal_modes import NormalModes
from proprotor.typing import Array


def mount(rotor_alone: LinearModel, support: NormalModes) -> LinearModel:
    """Return the coupled model on the coordinates of the support and of the rotor without its hub.

    Hub motion is Φ p, so by virtual work the rotor's matrices become Tᵀ (...) T, to which the support's matrices are
    added. If the support's generalised masses include the rotor, the rotor's share is taken off first:
    `proprotor.model.rotor_share`.

    Parameters
    ----------
    rotor_alone : LinearModel
        Six hub coordinates, then any others: `rotor_model`, `rigid_propeller`, or M, C and K from elsewhere, with
        `mass_at_rest` if the support's masses include the rotor.
    support : NormalModes

    Returns
    -------
    LinearModel
        With the coordinates of the support first, SI. A point whose mass matrix has no inverse has matrices, but no
        modes, and the reason in `trim`; a point whose support has no mass without the rotor has NaN matrices too.

    Raises
    ------
    InputError
        When the model does not begin with the hub coordinates, a coordinate of the support has the name of a coordinate
        of the rotor, the mass at rest is needed and missing, a single support has no mass without the rotor, or the
        support is an aircraft with both halves of its motion, which has two rotors.
    """
    check_hub("dofs", rotor_alone)
    at_rest = () if rotor_alone.mass_at_rest is None else rotor_alone.mass_at_rest
    matrices = (support.mass, support.damping, support.stiffness, support.hub)
    joint = _joint(support, rotor_alone.dofs[len(HUB) :], at_rest, *matrices)
    loads = () if support.loads is None else support.loads.shape[:-2]
    shape = joint_shape(rotor_alone.M.shape[:-2], joint.shape, loads)
    rotor_alone = broadcast(rotor_alone, shape)
    found, certain = _on_support(rotor_alone, joint)
    if rotor_alone.B is not None and support.loads is not None:
        found["B"] = _with_inputs(found["B"], support.loads)
    coupled = replace(
        rotor_alone,
        **found,
        dofs=joint.dofs,
        hub=joint.hub,
        rotor=rotor_alone,
        mass_at_rest=None,
        shapes=at_points(support.shapes, shape, 2),
        trim=with_warning(rotor_alone.trim, at_points(support.warning, shape, 0)),
        inputs=(*rotor_alone.inputs, *(support.inputs if rotor_alone.B is not None else ())),
    )
    if certain is not None and certain.all():
        coupled.note_mass()
    return refused_where(joint.refusal, with_reasons(coupled), support)


class _Joint(NamedTuple):
    """What a rotor on its support has at all airspeeds.

    shape : of the batch of supports.
    dofs : names of the coordinates of the support and of the rotor without its hub.
    to_support : motion of the hub with the support's coordinates.
    hub : the same with all coordinates.
    additions : the support's own matrices by name, without the mass of its rotor.
    refusal : see `without_rotors`.
    compiled : the support as the compiled functions take it; empty until they do.
    """

    shape: tuple[int, ...]
    dofs: tuple[str, ...]
    to_support: Array
    hub: Array
    additions: dict[str, Array]
    refusal: Array | None
    compiled: list[Support]


@kept
def _joint(
    support: NormalModes, own: tuple[str, ...], mass_at_rest: Array | tuple[()], *matrices: Array
) -> _Joint:
    """Return what a rotor with some coordinates of its own has in common on a support.

    Parameters
    ----------
    support : NormalModes
    own : tuple of str
        Coordinates of the rotor without its hub.
    mass_at_rest : array, or an empty tuple
        Of the rotor; nothing where it is not known.
    *matrices : arrays
        Of the support, which may not be written to where the result is kept.
    """
    if len(set(getattr(support, "symmetry", ()))) > 1:
        rule = (
            "has two rotors, see proprotor.model.pair.mount_pair; one rotor goes with one half of the motion"
        )
        raise InputError("support", "an aircraft", rule)
    _check_names(support.names, own)
    at_rest = None if isinstance(mass_at_rest, tuple) else mass_at_rest
    mass, refusal = without_rotors(support, [(support.hub, at_rest)])
    additions = {"M": mass, "C": support.damping, "K": support.stiffness}
    still = np.zeros((*support.hub.shape[:-1], len(own)))
    hub = np.concatenate([support.hub, still], axis=-1)
    shape = joint_shape(*(matrix.shape[:-2] for matrix in (support.hub, *additions.values())))
    return _Joint(shape, (*support.names, *own), support.hub, hub, additions, refusal, [])


def _with_inputs(columns: Array, loads: Array) -> Array:
    """Return the columns (..., n, inputs) of a rotor's inputs and of its support's, which load the support alone."""
    shape, more = columns.shape[:-2], columns.shape[-2] - loads.shape[-2]
    own = np.pad(loads, [(0, 0)] * (loads.ndim - 2) + [(0, more), (0, 0)])
    return np.concatenate([columns, np.broadcast_to(own, (*shape, *own.shape[-2:]))], axis=-1)


def check_hub(field: str, model: LinearModel) -> None:
    """Refuse a model of a rotor alone that does not begin with the hub coordinates."""
    if model.dofs[: len(HUB)] != HUB:
        raise InputError(field, ", ".join(model.dofs), f"must begin with {', '.join(HUB)}")


def refused_where(refusal: Array | None, model: LinearModel, support: NormalModes) -> LinearModel:
    """Return the model with NaN and the reason at each point whose support has no mass without its rotors.

    Raises
    ------
    InputError
        When one refusal holds for all points.
    """
    refuse(refusal, support)
    if refusal is None or not (refused := refusal != "").any():
        return model
    field = str(InputError("support.includes_rotor", support.includes_rotor, ""))
    return failed_where(np.where(refused, field + refusal, ""), model)


def failed_where(reasons: Array | None, model: LinearModel) -> LinearModel:
    """Return the model with NaN and the reason at each point that has one; reasons (...) broadcast with the points."""
    if reasons is None:
        return model
    reasons = np.broadcast_to(reasons, model.M.shape[:-2])
    if not (refused := reasons != "").any():
        return model
    reason = np.where(refused, reasons, model.trim.reason)
    trim = replace(model.trim, reason=reason, converged=model.trim.converged & ~refused)
    matrices: dict[str, Any] = {
        name: np.where(refused[..., None, None], np.nan, matrix) for name, matrix in model.matrices.items()
    }
    return replace(model, **matrices, trim=trim)


def at_points(values: Array | None, shape: tuple[int, ...], own: int) -> Array | None:
    """Return an array of many designs, whose last `own` axes are not axes of the batch, at each point of a batch."""
    if values is None:
        return None
    return np.broadcast_to(values, (*shape, *values.shape[values.ndim - own :]))


def with_warning(trim: Trim, warning: Array | None) -> Trim:
    """Return the trim with the warnings of the support appended to its own."""
    if warning is None:
        return trim
    pairs = zip(trim.warning.ravel(), warning.ravel(), strict=True)
    joined = np.array(["; ".join(filter(None, texts)) for texts in pairs], dtype=object)
    return replace(trim, warning=joined.reshape(trim.warning.shape))


def _on_support(rotor: LinearModel, joint: _Joint) -> tuple[dict[str, Any], Array | None]:
    """Return Tᵀ (...) T of M, C, K plus the support's, and Tᵀ B; T = diag(Φ, 1) leaves the rotor's own block.

    The second result says at which points (...) every motion has mass for certain, as far as this is known.
    """
    if rotor.is_compiled and _are_served(rotor, joint):
        return _compiled(rotor, joint)
    hub = joint.to_support
    found = {name: _of_one(getattr(rotor, name), hub, addition) for name, addition in joint.additions.items()}
    if rotor.B is not None:
        at_hub = np.swapaxes(hub, -1, -2) @ rotor.B[..., : len(HUB), :]
        found["B"] = np.concatenate([at_hub, rotor.B[..., len(HUB) :, :]], axis=-2)
    return found, None


def _of_one(matrix: Array, hub: Array, addition: Array) -> Array:
    """Return Tᵀ (...) T plus the support's matrix."""
    modes, hubs, shape = hub.shape[-1], len(HUB), matrix.shape[:-2]
    n = modes + matrix.shape[-1] - hubs
    kind = np.result_type(matrix, hub, addition)
    whole = np.empty((*shape, n, n), dtype=kind)
    for rows in few_at_once(shape):
        own, motion, added = (at_rows(part, rows, shape) for part in (matrix, hub, addition))
        found, columns = whole[rows], np.empty((*own.shape[:-1], n), dtype=kind)
        np.matmul(own[..., :hubs], motion, out=columns[..., :modes])
        columns[..., modes:] = own[..., hubs:]
        np.matmul(np.swapaxes(motion, -1, -2), columns[..., :hubs, :], out=found[..., :modes, :])
        found[..., :modes, :modes] += added
        found[..., modes:, :] = columns[..., hubs:, :]
    return whole


def _are_served(rotor: LinearModel, joint: _Joint) -> bool:
    """Return whether compiled functions put such matrices on a support: real ones with few rows."""
    numbers = (*rotor.matrices.values(), joint.to_support, *joint.additions.values())
    return len(joint.dofs) <= MOST_ROWS and all(part.dtype.kind == "f" for part in numbers)


def _compiled(rotor: LinearModel, joint: _Joint) -> tuple[dict[str, Array], Array]:
    """Return the same as `_on_support` by compiled functions."""
    shape, matrices = rotor.M.shape[:-2], rotor.matrices
    alike = joint.shape == ()
    if alike and not joint.compiled:
        joint.compiled.append(Support(joint.to_support, tuple(joint.additions.values())))
    support = joint.compiled[0] if alike else _supports(joint, shape)
    flat = [matrix.reshape(-1, *matrix.shape[-2:]) for matrix in matrices.values()]
    found, certain = on_support(flat, support)
    named = zip(matrices, found, strict=True)
    return {name: matrix.reshape(*shape, *matrix.shape[-2:]) for name, matrix in named}, certain


def _supports(joint: _Joint, shape: tuple[int, ...]) -> Support:
    """Return supports that differ from point to point of a batch."""
    at_hub, *own = (
        part
        if part.ndim == 2
        else np.broadcast_to(part, (*shape, *part.shape[-2:])).reshape(-1, *part.shape[-2:])
        for part in (joint.to_support, *joint.additions.values())
    )
    return Support(at_hub, own)


def _check_names(support: Sequence[str], own: tuple[str, ...]) -> None:
    """Refuse a coordinate of the support whose name, or the name of its mode, is also one of the rotor's."""
    if clashes := [name for name in support if name in own]:
        rule = f"must not be a name of the rotor's own coordinates, {', '.join(own)}"
        raise InputError("support.names", ", ".join(clashes), rule)
    check_distinct("support.names", (*support, *own))


def broadcast(model: LinearModel, shape: tuple[int, ...]) -> LinearModel:
    """Return the model at every point of a batch that has more axes, the axes of the supports."""
    if model.M.shape[:-2] == shape:
        return model
    matrices: dict[str, Any] = {name: at_points(matrix, shape, 2) for name, matrix in model.matrices.items()}
    airspeed = np.broadcast_to(model.airspeed, shape)
    return replace(model, **matrices, trim=model.trim.broadcast(shape), airspeed=airspeed)
