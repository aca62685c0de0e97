"""Assemble the linear model of a rotor alone on its six hub coordinates from the generated functions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, replace
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from proprotor_equations import BLADE_COORDINATES, FIXED_COORDINATES, airloads, drive_train, multiblade, pitch

from proprotor.errors import InputError
from proprotor.model.linear_model import INPUTS, LinearModel
from proprotor.model.mass_at_rest import mass_at_rest
from proprotor.model.quantities import COUPLINGS, batch_shape, couplings, flat, model_quantities
from proprotor.model.stamp import Origin
from proprotor.needs import check_memory
from proprotor.rotor.generated import EquationSet, evaluate
from proprotor.rotor.motions import ROTOR_SPEED, reactionless_coordinates
from proprotor.rotor.operation import Operation
from proprotor.rotor.options import Options, parse_options
from proprotor.rotor.rotor import Rotor
from proprotor.rotor.section_loads import (
    BladeSections,
    closed_form_moments,
    has_closed_form,
    load_moments,
    segment_quantities,
)
from proprotor.rotor.trim import Target, Trim, trim_target
from proprotor.rotor.trim_solver import Settled, solve_trim
from proprotor.typing import Array
from proprotor.units import in_metres_per_second

_KINDS = {"M": "mass", "C": "damping", "K": "stiffness"}
_BYTES_PER_POINT, _BYTES_PER_ENTRY = 10_000.0, 80.0  # while a rotor is trimmed and its matrices are made


def rotor_model(rotor: Rotor, operation: Operation, airspeed: ArrayLike, **options: Any) -> LinearModel:
    """Return the rotor alone on its six hub coordinates, in the order of Eq. 17 of AIAA-2002-1604.

    Parameters
    ----------
    rotor : Rotor
    operation : Operation
    airspeed : float, array (...) in m/s, text such as "250 kt", pint quantity or xarray.DataArray
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    LinearModel
        n = 18 with everything free.

    Raises
    ------
    InputError
        For an unknown option, a rotor that the options do not allow, or more points than there is memory for.
    """
    choice = parse_options(options)
    _check_pitch(rotor, choice)
    speed = in_metres_per_second(airspeed)
    shape = batch_shape(rotor, operation, speed, choice.drive_train)
    points = int(np.prod(shape, dtype=int))
    _check_memory(rotor, choice, points)
    quantities = model_quantities(rotor, operation, choice, speed, shape)
    sections, coarse = (BladeSections.of(rotor, shape, coarse) for coarse in (False, True))
    target = _flat(trim_target(rotor, operation), shape)
    settled = solve_trim(sections, coarse, quantities, choice, target, points)
    extra = _reactionless(rotor, choice)
    matrices: dict[str, Any] = {
        name: matrix.reshape(*shape, *matrix.shape[-2:])
        for name, matrix in _matrices(sections, choice, settled, extra).items()
    }
    coordinates = (*FIXED_COORDINATES, *extra)
    model = LinearModel(
        **matrices,
        dofs=coordinates,
        trim=Trim(**{e.name: getattr(settled.trim, e.name).reshape(shape) for e in fields(Trim)}),
        airspeed=np.broadcast_to(speed, shape),
        mass_at_rest=mass_at_rest(rotor),
        origin=Origin(choice),
    )
    free = _free_coordinates(choice, coordinates)
    return model if free == coordinates else model.submodel(free)


def _check_pitch(rotor: Rotor, options: Options) -> None:
    """Refuse a rotor whose pitch inertia or control stiffness is zero where the options need it."""
    if options.pitch_is_free and np.any(np.asarray(rotor.pitch_inertia) <= 0):
        raise InputError("pitch_inertia", rotor.pitch_inertia, 'must be above zero with pitch="dynamic"')
    if options.pitch == "coupling" and np.any(np.asarray(rotor.control_stiffness) <= 0):
        rule = 'must be above zero with pitch="coupling"'
        raise InputError("control_stiffness", rotor.control_stiffness, rule)


def _check_memory(rotor: Rotor, options: Options, points: int) -> None:
    """Refuse a batch, or blades whose motions are all kept, that do not fit into memory."""
    own = len(FIXED_COORDINATES)
    count = own + 3 * (float(np.max(rotor.n_blades)) - 3) * options.reactionless
    if count > own:
        check_memory("n_blades", rotor.n_blades, _BYTES_PER_ENTRY * count**2, "the matrices")
    size = points * (_BYTES_PER_POINT + _BYTES_PER_ENTRY * count**2)
    check_memory("airspeed", f"{points} points", size, "their matrices", "take fewer points at once")


def _flat(target: Target, shape: tuple[int, ...]) -> Target:
    """Return the target with its arrays flattened over the batch."""
    return replace(target, collective=flat(target.collective, shape), load=flat(target.load, shape))


def _reactionless(rotor: Rotor, options: Options) -> tuple[str, ...]:
    """Return the names of the reactionless coordinates that the options keep."""
    if not options.reactionless:
        return ()
    if np.ndim(rotor.n_blades):
        raise InputError("n_blades", rotor.n_blades, "must be one number with reactionless=True")
    return reactionless_coordinates(int(rotor.n_blades))


def _free_coordinates(options: Options, coordinates: tuple[str, ...]) -> tuple[str, ...]:
    """Return the coordinates that the options neither lock nor hold."""
    removed = set(options.locked)
    if not options.pitch_is_free:
        removed.add("pitch")
    if options.rotor_speed == "constant":
        removed.add(ROTOR_SPEED)
    return tuple(
        name for name in coordinates if name.rpartition("_")[0] not in removed and name not in removed
    )


def _matrices(
    sections: BladeSections, options: Options, settled: Settled, extra: tuple[str, ...]
) -> dict[str, Array]:
    """Return M, C, K (points, n, n) and B (points, n, 6) in the fixed frame, reactionless coordinates last.

    Points without a trim are NaN.
    """
    points, n, rows = len(settled.trim.converged), len(FIXED_COORDINATES) + len(extra), settled.rows
    found: dict[str, Array] = {}
    if len(rows):
        quantities = settled.quantities | couplings(options, settled.quantities)
        *blade, gusts = _blade_matrices(sections.take(rows), quantities, settled.segments, options)
        inputs = [_swashplate(quantities, options, blade), evaluate(multiblade.gust_loads, quantities, gusts)]
        found = _fixed_frame(quantities, options, blade, extra)
        found["B"] = np.zeros((len(rows), n, len(INPUTS)), dtype=gusts.dtype)
        found["B"][:, : len(FIXED_COORDINATES)] = np.concatenate(inputs, axis=-1)
    return {
        name: _at_all_points(found.get(name), points, rows, (n, columns))
        for name, columns in (dict.fromkeys("MCK", n) | {"B": len(INPUTS)}).items()
    }


def _at_all_points(matrix: Array | None, points: int, rows: Array, shape: tuple[int, int]) -> Array:
    """Return a matrix of some rows spread to all points, NaN at the others."""
    if matrix is not None and matrix.shape[0] == points == len(rows):
        return matrix
    whole = np.full((points, *shape), np.nan, dtype=float if matrix is None else matrix.dtype)
    if matrix is not None:
        whole[rows] = matrix
    return whole


def _blade_matrices(
    sections: BladeSections, quantities: Mapping[str, Any], at_trim: Mapping[str, Any], options: Options
) -> tuple[Array, ...]:
    """Return mass, damping, stiffness (points, 12, 12) and gust loads (points, 12, 3) of one blade, rotating axes."""
    mass, damping, stiffness = _structure(quantities, options.equation_set)
    points = np.shape(quantities["pitch"])
    damping, stiffness = (
        np.broadcast_to(matrix, (*points, *matrix.shape[-2:])) for matrix in (damping, stiffness)
    )
    gusts = np.zeros((*stiffness.shape[:-1], 3), dtype=stiffness.dtype)
    if options.airloads != "none":
        air_damping, air_stiffness, gusts = _airloads(sections, quantities, at_trim, options)
        damping, stiffness = damping + air_damping, stiffness + air_stiffness
        # One row where the gust loads are the same at all points.
        gusts = np.broadcast_to(gusts, (*stiffness.shape[:-1], 3))
    return mass, damping, stiffness, gusts


def _swashplate(quantities: Mapping[str, Any], options: Options, blade: list[Array]) -> Array:
    """Return the loads (points, 18, 3) on the rotor per unit of swashplate collective and cyclics, in the fixed frame.

    With the pitch equations kept, the pitch coordinates are the whole perturbation of blade pitch, and the swashplate
    acts on them through control system and pitch damper. Without the pitch equations the blades follow the swashplate
    at once. Rates of the swashplate are left out.
    """
    place = BLADE_COORDINATES.index("pitch")
    if options.pitch_is_free:
        mass, damping, stiffness = (np.zeros_like(matrix) for matrix in blade)
        damping[..., place, place] = quantities["pitch_damping"]
        stiffness[..., place, place] = quantities["control_stiffness"]
        sign = 1.0
    else:
        (mass, damping, stiffness), sign = blade, -1.0
    columns = [FIXED_COORDINATES.index(name) for name in ("pitch_0", "pitch_1c", "pitch_1s")]
    loads: Array = sign * evaluate(multiblade.stiffness, quantities, mass, damping, stiffness)[..., columns]
    return loads


def _fixed_frame(
    quantities: Mapping[str, Any], options: Options, blade: list[Array], extra: tuple[str, ...]
) -> dict[str, Array]:
    """Return M, C, K of the rotor from the matrices of one blade."""
    matrices = {}
    for count, (name, kind) in enumerate(_KINDS.items(), start=1):
        matrix = evaluate(getattr(multiblade, kind), quantities, *blade[:count])
        if options.drive_train is not None:
            matrix = matrix + evaluate(getattr(drive_train, kind), quantities)
        matrices[name] = matrix
    if "cyclic_flap_stiffness_excess" in quantities:
        matrices["K"] = matrices["K"] + evaluate(multiblade.cyclic_restraint, quantities)
    return {
        name: _with_reactionless(quantities, blade, extra, name, matrix) for name, matrix in matrices.items()
    }


def _with_reactionless(
    quantities: Mapping[str, Any], blade: list[Array], extra: tuple[str, ...], name: str, matrix: Array
) -> Array:
    """Return the matrix with the blocks of the reactionless coordinates, which couple with no others, appended."""
    if not extra:
        return matrix
    kind, needed = _KINDS[name], blade[: list(_KINDS).index(name) + 1]
    whole = np.zeros((*matrix.shape[:-2], *[len(FIXED_COORDINATES) + len(extra)] * 2))
    start = len(FIXED_COORDINATES)
    whole[..., :start, :start] = matrix
    while start < whole.shape[-1]:
        first = extra[start - len(FIXED_COORDINATES)]
        if first.endswith("_d"):
            block = evaluate(getattr(multiblade, f"differential_{kind}"), quantities, *needed)
        else:
            of_harmonic = dict(quantities) | {"harmonic": int(first.split("_")[1][:-1])}
            block = evaluate(getattr(multiblade, f"reactionless_{kind}"), of_harmonic, *needed)
        end = start + block.shape[-1]
        whole[..., start:end, start:end] = block
        start = end
    return whole


def _structure(quantities: Mapping[str, Any], equations: EquationSet) -> tuple[Array, Array, Array]:
    """Return mass, damping and stiffness of one blade from inertia, dampers and springs."""
    quantities = dict(quantities) | evaluate(equations.inertia.trim_integrals, quantities)._asdict()
    mass = evaluate(equations.inertia.mass, quantities) + evaluate(equations.pitch.mass, quantities)
    damping = evaluate(equations.inertia.gyroscopic, quantities) + evaluate(pitch.damping, quantities)
    stiffness = evaluate(equations.inertia.centrifugal_stiffness, quantities)
    stiffness = stiffness + evaluate(equations.pitch.stiffness, quantities)
    return mass, damping, stiffness + evaluate(equations.flap_lag_springs.stiffness, quantities)


def _airloads(
    sections: BladeSections, quantities: Mapping[str, Any], at_trim: Mapping[str, Any], options: Options
) -> tuple[Array, Array, Array]:
    """Return airload damping, airload stiffness and gust loads of one blade."""
    equations = options.equation_set.airloads
    if equations is airloads and options.airloads == "full":
        segments = dict(at_trim) | {name: np.asarray(quantities[name])[..., None] for name in COUPLINGS}
    else:
        segments = segment_quantities(sections, quantities, equations)
        segments |= _moments(sections, segments, options)
    return airload_matrices(segments, equations)


def airload_matrices(segments: Mapping[str, Any], equations: ModuleType) -> tuple[Array, Array, Array]:
    """Return airload damping, stiffness (points, 12, 12) and gust loads (points, 12, 3) of one blade.

    Parameters
    ----------
    segments : mapping
        Quantities of each segment, with the couplings of its pitch and the radial moments of its loads, SI.
    equations : module
        Generated airloads, of the consistent or a reduced set.
    """
    motions = ("virtual_motion", "rate_motion", "displacement_motion", "geometric_stiffness", "gust_motion")
    quantities = dict(segments) | {name: evaluate(getattr(equations, name), segments) for name in motions}
    quantities["load_derivatives"] = evaluate(airloads.load_derivatives, quantities)
    products = (airloads.damping, airloads.stiffness, airloads.gust_loads)
    damping, stiffness, gusts = (evaluate(product, quantities) for product in products)
    return damping, stiffness, gusts


def _moments(sections: BladeSections, segments: Mapping[str, Any], options: Options) -> dict[str, Array]:
    """Return the radial moments of the section loads, in closed form if possible, else by quadrature."""
    if in_closed_form(sections, options):
        return closed_form_moments(sections, segments)
    return load_moments(
        sections,
        segments,
        compressibility=options.compressibility,
        lift_slope_only=options.airloads == "lift-slope",
        equations=options.equation_set.airloads,
    )


def in_closed_form(sections: BladeSections, options: Options) -> bool:
    """Return whether the radial moments of the perturbation airloads need no quadrature."""
    simple = options.equations == "published" and not (options.compressibility or options.section_damping)
    return options.airloads == "lift-slope" and simple and has_closed_form(sections)
