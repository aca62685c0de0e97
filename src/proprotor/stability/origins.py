"""The matrices of a case by physical origin, with the trim held.

The matrices are sums: of inertia, springs and loads of a blade, carried into the fixed frame by a linear map, and of
the matrices of the support. Airloads are linear in the coefficients of the sections, which are taken one at a time.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from proprotor_equations import BLADE_COORDINATES, FIXED_COORDINATES, drive_train, multiblade, pitch
from proprotor_equations import rotor as whole_rotor

from proprotor.errors import InputError
from proprotor.model.closed_loop import taken_apart
from proprotor.model.configuration import Configuration
from proprotor.model.inflow import with_inflow
from proprotor.model.lift_lag import lagging_blade, with_lift_lag
from proprotor.model.linear_model import INPUTS, SWASHPLATE, LinearModel
from proprotor.model.mass_at_rest import mass_at_rest
from proprotor.model.mast import with_mast
from proprotor.model.mount import mount
from proprotor.model.options_of_result import check_options
from proprotor.model.pair import rotors_on, shares
from proprotor.model.quantities import COUPLINGS, couplings, model_quantities
from proprotor.model.rotor_model import airload_moments, in_closed_form
from proprotor.model.rotor_share import without_rotors
from proprotor.model.stamp import of_model
from proprotor.model.wing_lift_lag import with_wing_lag
from proprotor.rotor.airfoil import SectionCoefficients, SectionModel
from proprotor.rotor.generated import evaluate
from proprotor.rotor.motions import INFLOW, MAST_TWIST, lag_coordinates, wing_lag_names
from proprotor.rotor.operation import Operation
from proprotor.rotor.options import Options, parse_options
from proprotor.rotor.rotor import Rotor
from proprotor.rotor.section_loads import BladeSections, compressible, segment_quantities
from proprotor.rotor.trim import UNKNOWNS, Trim, with_trim
from proprotor.support.airframe import Airframe
from proprotor.support.normal_modes import NormalModes
from proprotor.typing import Array

_COUPLING_ORIGINS = {
    "pitch_flap_coupling": "pitch-flap coupling K_Pβ",
    "pitch_lag_coupling": "pitch-lag coupling K_Pζ",
}
_RESTRAINTS = {
    "gimbal damper": "gimbal_damping",
    "control system": "control_stiffness",
    "gimbal spring": "gimbal_stiffness",
    "propeller moment": "propeller_moment",
}
_COEFFICIENTS = {
    "lift slope": ("lift_coefficient_alpha",),
    "lift": ("lift_coefficient", "lift_coefficient_mach"),
    "drag": ("drag_coefficient", "drag_coefficient_alpha", "drag_coefficient_mach"),
    "section moment": ("moment_coefficient", "moment_coefficient_alpha", "moment_coefficient_mach"),
}


class _Part(NamedTuple):
    """M, C, K (..., n, n) of one origin, on the coordinates of the model."""

    M: Array
    C: Array
    K: Array


@dataclass(frozen=True, eq=False)
class _SomeCoefficients:
    """An airfoil with some of its coefficients, the others zero, and the Prandtl-Glauert factor where asked for."""

    airfoil: SectionModel
    kept: tuple[str, ...]
    compressible: bool
    contains_compressibility: bool = True

    def coefficients(self, alpha: Array, mach: Array) -> SectionCoefficients:
        """Return the kept coefficients, and zero for the others."""
        found = self.airfoil.coefficients(alpha, mach)
        if self.compressible and not self.airfoil.contains_compressibility:
            found = compressible(found, mach)
        dropped = dict.fromkeys(set(SectionCoefficients._fields) - set(self.kept), 0.0)
        return found._replace(**dropped)


def model_parts(case: Configuration, model: LinearModel, **options: Any) -> dict[str, _Part]:
    """Return M, C and K of a case by origin; their sum is the model.

    Parameters
    ----------
    case : Case
        Of one design.
    model : LinearModel
        Of this case; its trim is held.
    **options
        Options of the model, see `proprotor.rotor.options.Options`; they need not be repeated where the model has them.

    Returns
    -------
    dict of str to M, C and K
        Origins that contribute nothing are left out.

    Raises
    ------
    InputError
        With reactionless=True, and for other options than the model's.
    """
    if model.origin is None:
        choice = parse_options(case.model_options(options))
    else:
        check_options(of_model(model), case, options)
        choice = model.origin.options
    if choice.reactionless:
        raise InputError("reactionless", True, "is not taken apart: leave it out")
    if choice.is_tilted:
        name = "load_factor" if np.all(np.equal(choice.shaft_angle, 0)) else "shaft_angle"
        rule = "is not taken apart: the airloads of a periodic trim have no parts of their own"
        raise InputError(name, getattr(choice, name), rule)
    if not case.loops:
        return _open_parts(case, model, choice)
    dofs, loops = taken_apart(model, case.loops)
    places = [model.dofs.index(name) for name in dofs]
    opened = {
        name: _wide(part, places, model)
        for name, part in _open_parts(case, model.submodel(dofs), choice).items()
    }
    return opened | {"control loops": _Part(*loops)}


def _wide(part: _Part, places: list[int], model: LinearModel) -> _Part:
    """Return a part on some coordinates of a model as a part on all of them."""
    found = [np.zeros(model.M.shape) for _ in part]
    for whole, matrix in zip(found, part, strict=True):
        whole[..., np.array(places)[:, None], places] = matrix
    return _Part(*found)


def _open_parts(case: Configuration, model: LinearModel, choice: Options) -> dict[str, _Part]:
    """Return the parts of a model without control loops."""
    lift = None
    if choice.wing_lags:
        lift = case.support.wing_circulation(model.airspeed, case.operation.density)
    if lift is None:
        return _parts(case, model, choice)
    late = wing_lag_names(lift.symmetry)
    at_once = model.submodel(tuple(name for name in model.dofs if name not in late))
    parts, n = _parts(case, at_once, choice), len(model.dofs)
    found = {name: _Part(*(_padded(matrix, n) for matrix in part)) for name, part in parts.items()}
    nothing: dict[str, Any] = dict.fromkeys("MCK", np.zeros_like(at_once.M))
    added = with_wing_lag(replace(at_once, **nothing), lift)
    return found | {"lag of the wing's lift": _Part(added.M, added.C, added.K)}


def _parts(case: Configuration, model: LinearModel, choice: Options) -> dict[str, _Part]:
    """Return M, C and K of a case by origin, with the lift of the wing at once."""
    rotors = [_Rotor(case.rotor, case.operation, choice, model.trim)]
    if case.left is not None and (left := model.left) is not None and left.origin is not None:
        rotors += [_Rotor(case.left.rotor, case.left.operation, left.origin.options, left.trim)]
    shape = model.M.shape[:-2]
    by_rotor = [_rotor_parts(rotor, model, shape) for rotor in rotors]
    support = case.support.at(model.airspeed, case.operation.density)
    nothing = np.zeros_like(support.mass)
    carrier = replace(support, mass=nothing, damping=nothing, stiffness=nothing, includes_rotor=False)
    names = dict.fromkeys(name for parts in by_rotor for name in parts)
    none = _Part(*[np.zeros((len(FIXED_COORDINATES),) * 2)] * 3)
    found = {}
    for name in names:
        alone = [
            _alone(name, parts.get(name, none), rotor.choice, model, shape)
            for parts, rotor in zip(by_rotor, rotors, strict=True)
        ]
        found[name] = _mounted(alone, carrier, model)
    found |= _interconnect(_alone("", none, choice, model, shape), carrier, model, choice)
    found |= _support_parts(case, support, model, shape)
    return {name: part for name, part in found.items() if any(np.any(matrix) for matrix in part)}


class _Rotor(NamedTuple):
    """A rotor of a case with its operation, the options in force and its trim."""

    rotor: Rotor
    operation: Operation
    choice: Options
    trim: Trim


def _rotor_parts(own: _Rotor, model: LinearModel, shape: tuple[int, ...]) -> dict[str, _Part]:
    """Return M, C and K of a rotor alone by origin (points, 18, 18)."""
    quantities = _quantities(own, model, shape)
    blade = _structure(quantities, own.choice) | dict(
        _airloads(BladeSections.of(own.rotor, shape), quantities, own.choice)
    )
    found = {name: _in_fixed_frame(part, quantities) for name, part in blade.items()}
    if own.choice.has_inflow and own.choice.airloads != "none":
        found["inflow"] = _inflow(BladeSections.of(own.rotor, shape), quantities, own, shape)
    if own.choice.blades_lag:
        found["lag of lift"] = _lag_of_lift(BladeSections.of(own.rotor, shape), quantities, own.choice, shape)
    return found | _other_parts(quantities, own.choice)


def _quantities(own: _Rotor, model: LinearModel, shape: tuple[int, ...]) -> dict[str, Any]:
    """Return all quantities at the trim of a rotor, arrays flattened over the batch."""
    through = model.airspeed + np.broadcast_to(own.trim.inflow, shape)
    given = model_quantities(own.rotor, own.operation, own.choice, through, shape)
    state = {name: np.broadcast_to(getattr(own.trim, name), shape).reshape(-1) for name in UNKNOWNS}
    trimmed = with_trim(given, own.choice, state)
    return trimmed | couplings(own.choice, trimmed)


def _structure(quantities: dict[str, Any], choice: Options) -> dict[str, _Part]:
    """Return inertia, springs and dampers of one blade (points, 12, 12)."""
    equations = choice.equation_set
    quantities = quantities | evaluate(equations.inertia.trim_integrals, quantities)._asdict()
    zero = np.zeros((12, 12))
    mass = evaluate(equations.inertia.mass, quantities) + evaluate(equations.pitch.mass, quantities)
    parts = {
        "inertia": _Part(mass, zero, zero),
        "gyroscopic": _Part(zero, evaluate(equations.inertia.gyroscopic, quantities), zero),
        "centrifugal": _Part(zero, zero, evaluate(equations.inertia.centrifugal_stiffness, quantities)),
        "dampers": _Part(zero, evaluate(pitch.damping, quantities), zero),
    }
    for origin, name in _RESTRAINTS.items():
        others = dict.fromkeys(set(_RESTRAINTS.values()) - {name}, 0.0)
        parts[origin] = _Part(zero, zero, evaluate(equations.pitch.stiffness, quantities | others))
    springs = evaluate(equations.flap_lag_springs.stiffness, quantities)
    return parts | {
        origin: _Part(zero, zero, np.where(mask, springs, 0)) for origin, mask in _spring_entries().items()
    }


def _spring_entries() -> dict[str, Array]:
    """Return which entries (12, 12) of the flap-lag springs belong to which origin.

    The springs turn with the pitch relative to the yoke, which consists of pitch, gimbal flap and gimbal roll: entries
    of these three with flap and lag cause pitch-flap and pitch-lag coupling.
    """
    flap, lag = BLADE_COORDINATES.index("flap"), BLADE_COORDINATES.index("lag")
    index = np.arange(len(BLADE_COORDINATES))
    has_flap = (index[:, None] == flap) | (index == flap)
    has_lag = (index[:, None] == lag) | (index == lag)
    alone = index[:, None] == index
    return {
        "flap spring": has_flap & alone,
        "lag spring": has_lag & alone,
        "flap-lag coupling of the springs": has_flap & has_lag,
        "pitch-flap coupling of the springs": has_flap & ~has_lag & ~alone,
        "pitch-lag coupling of the springs": has_lag & ~has_flap & ~alone,
        "pitch stiffness of the springs": ~has_flap & ~has_lag,
    }


def _airloads(
    sections: BladeSections, quantities: dict[str, Any], choice: Options
) -> Iterator[tuple[str, _Part]]:
    """Yield airloads of one blade (points, 12, 12) by coefficient, and by coupling of the blade's pitch."""
    if choice.airloads == "none":
        return
    zero, uncoupled = np.zeros((12, 12)), quantities | dict.fromkeys(COUPLINGS, 0.0)
    kinds = {"lift slope": _COEFFICIENTS["lift slope"]} if choice.airloads == "lift-slope" else _COEFFICIENTS
    for origin, kept in kinds.items():
        loads = _moments(sections, quantities, choice, kept, section_damping=False)
        yield f"airloads: {origin}", _Part(zero, *_loads(uncoupled, choice, loads))
    every = tuple(name for kept in kinds.values() for name in kept)
    whole = _moments(sections, quantities, choice, every, section_damping=False)
    alone = _loads(uncoupled, choice, whole)
    if choice.section_damping:
        whole = _moments(sections, quantities, choice, every, section_damping=True)
        undamped, alone = alone, _loads(uncoupled, choice, whole)
        yield "section pitch damping", _Part(zero, *(alone - undamped))
    for name, origin in _COUPLING_ORIGINS.items():
        if np.any(quantities[name]):
            coupled = _loads(uncoupled | {name: quantities[name]}, choice, whole)
            yield origin, _Part(zero, *(coupled - alone))


def _inflow(
    sections: BladeSections, quantities: dict[str, Any], own: _Rotor, shape: tuple[int, ...]
) -> _Part:
    """Return what induced velocity adds, on the rotor's coordinates and its own: its tilt with the hub, and states."""
    size, points = len(FIXED_COORDINATES), int(np.prod(shape, dtype=int))
    every = tuple(name for kept in _COEFFICIENTS.values() for name in kept)
    kept = _COEFFICIENTS["lift slope"] if own.choice.airloads == "lift-slope" else every
    damps = bool(own.choice.section_damping)
    segments = _moments(sections, quantities, own.choice, kept, section_damping=damps)
    given = {**segments, **quantities, "equations": own.choice.equation_set}
    gusts = evaluate(multiblade.gust_loads, quantities, evaluate(whole_rotor.blade_airloads, given).gusts)
    rotor = {name: np.zeros((points, size, len(INPUTS) if name == "B" else size)) for name in "MCKB"}
    rotor["B"][..., len(SWASHPLATE) :] = gusts
    induced = np.broadcast_to(own.trim.inflow, shape).reshape(-1)
    found = with_inflow(rotor, segments, quantities, induced, own.choice)
    return _Part(*(found[name] for name in "MCK"))


def _lag_of_lift(
    sections: BladeSections, quantities: dict[str, Any], choice: Options, shape: tuple[int, ...]
) -> _Part:
    """Return what the lag of lift adds, on the rotor's coordinates and its own."""
    own, points = len(FIXED_COORDINATES), int(np.prod(shape, dtype=int))
    nothing = {name: np.zeros((points, own, len(INPUTS) if name == "B" else own)) for name in "MCKB"}
    found = with_lift_lag(nothing, lagging_blade(sections, quantities, points, choice), quantities)
    return _Part(*(found[name] for name in "MCK"))


def _moments(
    sections: BladeSections,
    quantities: dict[str, Any],
    choice: Options,
    kept: tuple[str, ...],
    section_damping: bool,
) -> dict[str, Any]:
    """Return radial moments of the section loads by some of the coefficients, and the quantities of segments."""
    given = quantities | {"section_damping": float(section_damping)}
    segments = segment_quantities(sections, given, choice.equation_set.airloads)
    if not in_closed_form(sections, choice):
        some = _SomeCoefficients(sections.airfoil, kept, choice.compressibility)
        sections = replace(sections, airfoil=some)
    return segments | airload_moments(sections, segments, choice)


def _loads(quantities: dict[str, Any], choice: Options, segments: Mapping[str, Any]) -> Array:
    """Return airload damping and stiffness of one blade (2, points, 12, 12)."""
    given = {**segments, **quantities, "equations": choice.equation_set}
    damping, stiffness, _ = evaluate(whole_rotor.blade_airloads, given)
    return np.stack([damping, stiffness])


def _in_fixed_frame(part: _Part, quantities: Mapping[str, Any]) -> _Part:
    """Return a part of one blade as a part of the rotor (points, 18, 18)."""
    return _Part(
        evaluate(multiblade.mass, quantities, part.M),
        evaluate(multiblade.damping, quantities, part.M, part.C),
        evaluate(multiblade.stiffness, quantities, part.M, part.C, part.K),
    )


def _other_parts(quantities: Mapping[str, Any], choice: Options) -> dict[str, _Part]:
    """Return the parts that are added in the fixed frame (18, 18)."""
    zero, parts = np.zeros((len(FIXED_COORDINATES),) * 2), {}
    if choice.drive_train is not None:
        kinds = (drive_train.mass, drive_train.damping, drive_train.stiffness)
        parts["drive train"] = _Part(*(evaluate(kind, quantities) for kind in kinds))
    if "cyclic_flap_stiffness_excess" in quantities:
        parts["cyclic flap restraint"] = _Part(zero, zero, evaluate(multiblade.cyclic_restraint, quantities))
    return parts


def _alone(
    name: str, part: _Part, choice: Options, model: LinearModel, shape: tuple[int, ...]
) -> LinearModel:
    """Return a part of a rotor as a rotor alone, with the twist of its mast; the drive train with its engine."""
    lagging = lag_coordinates() if choice.blades_lag else ()
    inflow = INFLOW if choice.inflow_is_dynamic else ()
    dofs = (*FIXED_COORDINATES, *(coordinate.name for coordinate in (*inflow, *lagging)))
    n, points = len(dofs), int(np.prod(shape, dtype=int))
    matrices: dict[str, Any] = {
        kind: np.broadcast_to(_padded(matrix, n), (points, n, n)).reshape(*shape, n, n)
        for kind, matrix in zip("MCK", part, strict=True)
    }
    alone = LinearModel(**matrices, dofs=dofs, trim=model.trim, airspeed=model.airspeed)
    train = choice.drive_train
    if train is None or train.mast_stiffness is None:
        return alone
    if name == "drive train":
        return with_mast(alone, train)
    padded: dict[str, Any] = {kind: _padded(matrix, n + 1) for kind, matrix in matrices.items()}
    return replace(alone, **padded, dofs=(*dofs, MAST_TWIST))


def _padded(matrix: Array, n: int) -> Array:
    """Return a matrix with zeros for further coordinates, (..., n, n)."""
    more = (0, n - matrix.shape[-1])
    return np.pad(matrix, [(0, 0)] * (matrix.ndim - 2) + [more, more])


def _mounted(
    rotors: list[LinearModel], carrier: NormalModes, model: LinearModel, interconnect: ArrayLike = 0.0
) -> _Part:
    """Return a part of one rotor, or of two, on the coordinates of the model."""
    if isinstance(carrier, Airframe):
        left = rotors[1] if len(rotors) > 1 else None
        whole = rotors_on(rotors[0], carrier, left, interconnect)
    else:
        whole = mount(rotors[0], carrier)
    whole = whole.submodel(model.dofs)
    return _Part(whole.M, whole.C, whole.K)


def _interconnect(
    nothing: LinearModel, carrier: NormalModes, model: LinearModel, choice: Options
) -> dict[str, _Part]:
    """Return the part of the interconnect shaft, if the drive train has one."""
    train = choice.drive_train
    if train is None or not np.any(train.interconnect_stiffness):
        return {}
    return {"interconnect shaft": _mounted([nothing], carrier, model, train.interconnect_stiffness)}


def _support_parts(
    case: Configuration, support: NormalModes, model: LinearModel, shape: tuple[int, ...]
) -> dict[str, _Part]:
    """Return the parts of the support; its mass is taken without the rotor's."""
    n, modes = len(model.dofs), len(support.names)

    def whole(matrix: Array) -> Array:
        filled = np.zeros((*shape, n, n))
        filled[..., :modes, :modes] = matrix
        return filled

    at_rest = mass_at_rest(case.rotor)
    rotors: list[tuple[Array, Array | None]] = [(support.hub, at_rest)]
    if isinstance(support, Airframe):
        rotors = shares(support, at_rest, None if case.left is None else mass_at_rest(case.left.rotor))
    mass, _ = without_rotors(support, rotors)
    zero, own = np.zeros((*shape, n, n)), case.support
    air = _Part(
        whole(mass * 0 + support.mass - own.mass),
        whole(support.damping - own.damping),
        whole(support.stiffness - own.stiffness),
    )
    return {
        "support inertia": _Part(whole(mass) - air.M, zero, zero),
        "support damping": _Part(zero, whole(own.damping), zero),
        "support stiffness": _Part(zero, zero, whole(own.stiffness)),
        "wing airloads": air,
    }
