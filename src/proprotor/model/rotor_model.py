"""Assemble the linear model of a rotor alone on its six hub coordinates from the generated functions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from math import prod
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from proprotor_equations import FIXED_COORDINATES, airloads, multiblade
from proprotor_equations import rotor as whole_rotor
from proprotor_equations.coordinates import FIXED, Coordinate

from proprotor.compiled.in_flight import Rotors
from proprotor.errors import InputError
from proprotor.model.batches import joint_shape
from proprotor.model.inflow import with_inflow
from proprotor.model.lift_lag import LaggingBlade, lagging_blade, reactionless_with_lift_lag, with_lift_lag
from proprotor.model.linear_model import INPUTS, SWASHPLATE, LinearModel
from proprotor.model.mass_at_rest import mass_at_rest
from proprotor.model.mast import with_mast
from proprotor.model.quantities import batch_shape, couplings, flat, model_quantities, shape_of
from proprotor.model.stamp import Origin
from proprotor.needs import check_memory
from proprotor.rotor import fused
from proprotor.rotor.generated import evaluate
from proprotor.rotor.in_flight import InFlight, find_in_flight, rotors_of, serves_in_flight
from proprotor.rotor.kept import kept
from proprotor.rotor.momentum import with_induced
from proprotor.rotor.motions import (
    INFLOW,
    LAGS_PER_BLADE,
    LIFT,
    MAST_TWIST,
    ROTOR_SPEED,
    lag_coordinates,
    reactionless_groups,
    reactionless_harmonics,
    with_lag,
)
from proprotor.rotor.operation import Operation
from proprotor.rotor.options import Options, parse_options
from proprotor.rotor.rotor import Rotor
from proprotor.rotor.section_loads import (
    LOAD_MOMENTS,
    BladeSections,
    closed_form_moments,
    has_closed_form,
    load_moments,
    segment_quantities,
)
from proprotor.rotor.trim import UNKNOWNS, Target, Trim, take, trim_target
from proprotor.rotor.trim_solver import Settled, balance_of, settle_trim, solve_trim
from proprotor.typing import Array
from proprotor.units import in_metres_per_second

if TYPE_CHECKING:
    from proprotor.model.configuration import Configuration
    from proprotor.rotor.moving_blade import Motion

_PITCH = [place for place, coordinate in enumerate(FIXED) if coordinate.angle == "pitch"]
_KINDS = {"M": "mass", "C": "damping", "K": "stiffness"}
_BYTES_PER_POINT, _BYTES_PER_ENTRY = 10_000.0, 80.0  # while a rotor is trimmed and its matrices are made


def rotor_model(rotor: Rotor, operation: Operation, airspeed: ArrayLike, **options: Any) -> LinearModel:
    """Return the rotor alone on its six hub coordinates, in the order of Eq. 17 of AIAA-2002-1604.

    Parameters
    ----------
    rotor : Rotor
    operation : Operation
    airspeed : float, array (...) in m/s, text such as "250 ktas" or "200 keas", pint quantity or xarray.DataArray
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    LinearModel
        n = 18 with everything free.

    Raises
    ------
    InputError
        For an unknown option, a rotor that the options do not allow, or too many points for the memory.
    """
    return model_of(rotor, operation, airspeed, options)


def model_of(
    rotor: Rotor,
    operation: Operation,
    airspeed: Any,
    options: Mapping[str, Any],
    case: Configuration | None = None,
    around: bool = False,
) -> LinearModel:
    """Return the rotor alone as `rotor_model` does, with the case to which the rotor belongs, if there is one.

    With `around` the model of a rotor with a periodic trim has a last axis of the batch for azimuths, and no averages.
    """
    choice = parse_options(options)
    design = _design(rotor, operation, choice)
    speed = in_metres_per_second(airspeed, operation.density)
    shape = joint_shape(design.shape, speed.shape)
    points = prod(shape)
    _check_memory(rotor, choice, points)
    asked = _asked(rotor, operation, choice, design, speed, shape)
    if choice.is_tilted:
        settled = asked.trimmed(one=shape == ())
        tilted = _Tilted(rotor, choice, asked.target, speed, shape, around)
        made = _about_periodic_trim(tilted, asked.sections, settled)
    else:
        found, trim = asked.in_flight(_rotors(rotor, operation, design, asked), design, one=shape == ())
        made = _Made(found, trim, speed, shape)
    matrices: dict[str, Any] = {
        name: matrix.reshape(*made.shape, *matrix.shape[-2:]) for name, matrix in made.matrices.items()
    }
    model = LinearModel(
        **matrices,
        dofs=design.dofs,
        trim=Trim(**{name: value.reshape(made.shape) for name, value in vars(made.trim).items()}),
        airspeed=np.broadcast_to(made.airspeed, made.shape)
        if made.airspeed.shape != made.shape
        else made.airspeed,
        mass_at_rest=mass_at_rest(rotor),
        origin=Origin(choice, case),
        rates=design.rates,
        apart=design.apart,
        swing=made.swing,
    )
    if choice.drive_train is not None and choice.drive_train.mast_stiffness is not None:
        model = with_mast(model, choice.drive_train)
    return model if design.free == model.dofs else model.submodel(design.free)


class _Design(NamedTuple):
    """What the models of a rotor have in common at all airspeeds.

    shape : of the batch of designs.
    dofs, free : names of the coordinates of the equations, and of those that the options leave free.
    rates, apart : as of `LinearModel`.
    reactionless : number of blades whose reactionless motions are kept, or None.
    quantities : of a single design but for the airspeed, by the names of the derivation; nothing for many designs.
    target : what closes the trim.
    """

    shape: tuple[int, ...]
    dofs: tuple[str, ...]
    free: tuple[str, ...]
    rates: tuple[str, ...]
    apart: tuple[tuple[str, ...], ...]
    reactionless: int | None
    quantities: dict[str, Any]
    target: Target


@kept
def _design(rotor: Rotor, operation: Operation, options: Options) -> _Design:
    """Return what does not depend on the airspeed."""
    _check_pitch(rotor, options)
    still = np.zeros(())
    shape = batch_shape(rotor, operation, still, options)
    reactionless = _reactionless(rotor, options)
    apart = reactionless_groups(reactionless) if reactionless else []
    lagging: tuple[Coordinate, ...] = ()
    if options.blades_lag:
        lagging, apart = lag_coordinates(), [with_lag(group) for group in apart]
    inflow = INFLOW if options.inflow_is_dynamic else ()
    coordinates = (*FIXED, *inflow, *lagging, *(coordinate for group in apart for coordinate in group))
    train = options.drive_train
    twists = train is not None and train.mast_stiffness is not None
    mast = (Coordinate(MAST_TWIST, MAST_TWIST, 0, "", "rad"),) if twists else ()
    return _Design(
        shape,
        tuple(coordinate.name for coordinate in coordinates),
        _free_coordinates(options, (*coordinates, *mast)),
        tuple(coordinate.name for coordinate in coordinates if coordinate.angle in (LIFT, "inflow")),
        tuple(tuple(coordinate.name for coordinate in group) for group in apart),
        reactionless,
        {} if shape else model_quantities(rotor, operation, options, still, ()),
        trim_target(rotor, operation),
    )


def _asked(
    rotor: Rotor,
    operation: Operation,
    options: Options,
    design: _Design,
    speed: Array,
    shape: tuple[int, ...],
) -> _Asked:
    """Return the blades of a rotor at airspeeds, all flattened over the batch."""
    sections, few = _sections(rotor, shape)
    if design.shape:
        quantities = model_quantities(rotor, operation, options, speed, shape)
    else:
        quantities = {**design.quantities, "airspeed": flat(speed, shape) if shape else speed}
    target = design.target
    if shape and not target.windmilling:
        target = replace(target, collective=flat(target.collective, shape), load=flat(target.load, shape))
    return _Asked(sections, few, quantities, options, target, prod(shape))


def _rotors(rotor: Rotor, operation: Operation, design: _Design, asked: _Asked) -> Rotors | None:
    """Return the rotors for the compiled call that finds trim and matrices; None where it does not serve them."""
    if asked.options.backend != "compiled":
        return None
    if design.shape:
        return _served(asked)
    takes_derivative = asked.quantities["airspeed"].dtype.kind == "c"
    return None if takes_derivative else _own_rotors(rotor, operation, asked.options)


@kept
def _own_rotors(rotor: Rotor, operation: Operation, options: Options) -> Rotors | None:
    """Return the same of a single design, at any airspeed."""
    design = _design(rotor, operation, options)
    return _served(_asked(rotor, operation, options, design, np.zeros(()), ()))


def _served(asked: _Asked) -> Rotors | None:
    """Return the same of blades that are asked for."""
    sections, few, quantities, options, target, points = asked
    balance = balance_of(sections, quantities, options, target, points)
    return rotors_of(balance) if serves_in_flight(balance, few) else None


class _Asked(NamedTuple):
    """Blades whose trim and matrices are asked for, see `solve_trim`."""

    sections: BladeSections
    few: BladeSections
    quantities: dict[str, Any]
    options: Options
    target: Target
    points: int

    def trimmed(self, one: bool) -> Settled:
        """Return the trim of all points, with the induced velocity that the options ask for.

        `one` says that there is one point, not an array of one.
        """
        return with_induced(*self) if self.options.has_inflow else solve_trim(*self, one=one)

    def settled(self, found: InFlight, rows: Array) -> Settled:
        """Return the trim of all points, which one call has found at its own points `rows`."""
        state = {name: getattr(found.trim, name)[rows] for name in UNKNOWNS}
        begun = state, take(found.before, rows), found.trim.iterations[rows]
        return settle_trim(self.sections, self.quantities, self.options, self.target, begun)

    def at(self, rows: Array) -> _Asked:
        """Return some of the points."""
        sections, target = self.sections.take(rows), self.target
        few = sections if self.few is self.sections else self.few.take(rows)
        own = take({"collective": target.collective, "load": target.load}, rows)
        return _Asked(
            sections, few, take(self.quantities, rows), self.options, replace(target, **own), len(rows)
        )

    def in_flight(self, rotors: Rotors | None, design: _Design, one: bool) -> tuple[dict[str, Array], Trim]:
        """Return M, C, K and B of all points, see `_matrices`, and their trim: in one call as far as this is served."""
        options, points = self.options, self.points
        if rotors is None:
            settled = self.trimmed(one)
            return _matrices(self.sections, options, settled, design, one), settled.trim
        own_speeds = None if design.shape else self.quantities["airspeed"].reshape(-1)
        found = find_in_flight(rotors, points, own_speeds)
        if not options.pitch_is_free:
            found.matrices["B"] = _without_pitch_equations(found.matrices["K"], found.matrices["B"])
        for has_trim in (True, False):
            rows = np.flatnonzero(~found.served & (found.trimmed == has_trim))
            if not len(rows):
                continue
            own = self.at(rows) if points > len(rows) else self
            settled = own.settled(found, rows) if has_trim else own.trimmed(one)
            matrices = _matrices(own.sections, options, settled, design, one)
            for name, matrix in matrices.items():
                found.matrices[name][rows] = matrix
            for name, values in vars(settled.trim).items():
                getattr(found.trim, name)[rows] = values
        return found.matrices, found.trim


class _Made(NamedTuple):
    """M, C, K and B of all points with trim, airspeed and shape of the batch, and the swing of a periodic trim."""

    matrices: dict[str, Array]
    trim: Trim
    airspeed: Array
    shape: tuple[int, ...]
    swing: Motion | None = None


class _Tilted(NamedTuple):
    """A rotor at an angle or in a pull-up: see `model_of`."""

    rotor: Rotor
    options: Options
    target: Target
    airspeed: Array
    shape: tuple[int, ...]
    around: bool


def _about_periodic_trim(asked: _Tilted, sections: BladeSections, settled: Settled) -> _Made:
    """Return the matrices of a rotor about its periodic trim, averaged or with a last axis of the batch for azimuth."""
    # Here, because most uses need none of it.
    from proprotor.model.tilted_rotor import number_of_blades, tilted_rotor

    options, shape, speed = asked.options, asked.shape, asked.airspeed
    given = {"airspeed": speed, "shaft_angle": options.shaft_angle, "load_factor": options.load_factor}
    flight = {name: np.broadcast_to(value, shape).reshape(-1) for name, value in given.items()}
    n_blades = number_of_blades(asked.rotor)
    tilted = tilted_rotor(sections, settled, options, asked.target, flight, n_blades)
    trim, points = tilted.trim, len(settled.trim.reason)
    found = dict(tilted.matrices if asked.around else tilted.mean())
    if not options.pitch_is_free:
        found["B"] = _without_pitch_equations(found["K"], found["B"])
    whole = {
        name: np.full((points, *matrix.shape[1:]), np.nan, dtype=matrix.dtype)
        for name, matrix in found.items()
    }
    for name, matrix in found.items():
        whole[name][tilted.rows] = matrix
    if asked.around:
        steps = whole["M"].shape[1]
        trim = Trim(**{name: value[:, None] for name, value in vars(trim).items()}).broadcast((points, steps))
        speed, shape = speed[..., None], (*shape, steps)
    return _Made(whole, trim, speed, shape, tilted.motion.reshaped(asked.shape))


def _sections(rotor: Rotor, shape: tuple[int, ...]) -> tuple[BladeSections, BladeSections]:
    """Return the sections at all stations of a blade and at a few; one object where all stations are few."""
    return _sections_at(rotor, shape) if shape_of(rotor) else _own_sections(rotor)


@kept
def _own_sections(rotor: Rotor) -> tuple[BladeSections, BladeSections]:
    """Return the sections of a single design, which all points of a batch share."""
    return _sections_at(rotor, ())


def _sections_at(rotor: Rotor, shape: tuple[int, ...]) -> tuple[BladeSections, BladeSections]:
    sections = BladeSections.of(rotor, shape)
    return sections, sections if rotor.has_effective_sections else BladeSections.of(rotor, shape, few=True)


def _check_pitch(rotor: Rotor, options: Options) -> None:
    """Refuse a rotor whose pitch inertia or control stiffness is zero where the options need it."""
    needed = {"pitch_inertia": options.pitch_is_free, "control_stiffness": options.pitch == "coupling"}
    for name in _absent(rotor):
        if needed[name]:
            rule = f'must be above zero with pitch="{options.pitch}"'
            raise InputError(name, getattr(rotor, name), rule)

    if options.pitch == "coupling" and rotor.cyclic_control_stiffness is not None:
        rule = 'must be left out with pitch="coupling", whose couplings are those of control_stiffness'
        raise InputError("cyclic_control_stiffness", rotor.cyclic_control_stiffness, rule)


@kept
def _absent(rotor: Rotor) -> list[str]:
    """Return which of pitch inertia and control stiffness a rotor, or one of many designs, lacks."""
    return [
        name
        for name in ("pitch_inertia", "control_stiffness")
        if np.any(np.asarray(getattr(rotor, name)) <= 0)
    ]


def _check_memory(rotor: Rotor, options: Options, points: int) -> None:
    """Refuse a batch, or blades whose motions are all kept, that do not fit into memory."""
    count, blades = float(len(FIXED_COORDINATES)), 3.0
    if options.reactionless:
        blades = float(np.max(rotor.n_blades))
        count += 3 * (blades - 3)
    if options.blades_lag:
        count += LAGS_PER_BLADE * blades
    if options.inflow_is_dynamic:
        count += len(INFLOW)
    if options.reactionless:
        check_memory("n_blades", rotor.n_blades, _BYTES_PER_ENTRY * count**2, "the matrices")
    size = points * (_BYTES_PER_POINT + _BYTES_PER_ENTRY * count**2)
    check_memory("airspeed", f"{points} points", size, "their matrices", "take fewer points at once")


def _reactionless(rotor: Rotor, options: Options) -> int | None:
    """Return the number of blades whose reactionless motions the options keep; None if the options keep none."""
    if not options.reactionless:
        return None
    if np.ndim(rotor.n_blades):
        raise InputError("n_blades", rotor.n_blades, "must be one number with reactionless=True")
    return int(rotor.n_blades)


def _free_coordinates(options: Options, coordinates: tuple[Coordinate, ...]) -> tuple[str, ...]:
    """Return the names of the coordinates that the options neither lock nor hold."""
    held = {"pitch": not options.pitch_is_free, ROTOR_SPEED: options.rotor_speed == "constant"}
    removed = {*options.locked, *(angle for angle, is_held in held.items() if is_held)}
    return tuple(coordinate.name for coordinate in coordinates if coordinate.angle not in removed)


def _matrices(
    sections: BladeSections, options: Options, settled: Settled, design: _Design, one: bool
) -> dict[str, Array]:
    """Return M, C, K (points, n, n) and B (points, n, 6) in the fixed frame; points without a trim are NaN.

    `one` says that there is one point, by plain numbers and not an array of one.
    """
    reactionless, n = design.reactionless, len(design.dofs)
    points, rows = len(settled.trim.converged), settled.rows
    found: dict[str, Array] = {}
    if len(rows):
        quantities = settled.quantities | couplings(options, settled.quantities)
        segments = _segments(sections, rows, quantities, settled.segments, options)
        served = fused.serves(options.equation_set)
        if reactionless is not None or not served:
            given = segments | quantities | {"equations": options.equation_set}
            blade = evaluate(whole_rotor.blade_matrices, given)
        if served:
            in_air = None if options.airloads == "none" else segments
            compiled = (
                options.backend == "compiled"
                and not one
                and not any(map(np.iscomplexobj, quantities.values()))
            )
            found = fused.rotor_matrices(quantities, in_air, len(rows), one, compiled)
        else:
            found = evaluate(whole_rotor.fixed_frame, given, *blade)._asdict()
        if options.has_inflow:
            found = with_inflow(found, segments, quantities, settled.trim.inflow[rows], options)
        late = None
        if options.blades_lag:
            late = lagging_blade(sections.take(rows), quantities, len(rows), options)
            found = with_lift_lag(found, late, quantities)
        if not options.pitch_is_free:
            found["B"] = _without_pitch_equations(found["K"], found["B"])
        if reactionless is not None:
            found = _with_reactionless(found, _reactionless_blocks(given, blade, reactionless, late), n)
    return {
        name: _at_all_points(found.get(name), points, rows, (n, columns))
        for name, columns in (dict.fromkeys("MCK", n) | {"B": len(INPUTS)}).items()
    }


def _without_pitch_equations(stiffness: Array, inputs: Array) -> Array:
    """Return the loads (..., 18, 6) per unit of the inputs where the blades follow the swashplate at once."""
    followed = -stiffness[..., _PITCH]
    gusts = inputs[..., len(SWASHPLATE) :]
    gusts = np.broadcast_to(gusts, (*followed.shape[:-1], gusts.shape[-1]))
    return np.concatenate([followed, gusts], axis=-1)


def _at_all_points(matrix: Array | None, points: int, rows: Array, shape: tuple[int, int]) -> Array:
    """Return a matrix of some rows spread to all points, NaN at the others."""
    if matrix is not None and matrix.ndim == 3 and matrix.shape[0] == points == len(rows):
        return matrix
    whole = np.full((points, *shape), np.nan, dtype=float if matrix is None else matrix.dtype)
    if matrix is not None:
        whole[rows] = matrix
    return whole


def _reactionless_blocks(
    given: Mapping[str, Any], blade: tuple[Array, ...], n_blades: int, late: LaggingBlade | None
) -> Iterator[dict[str, Array]]:
    """Yield M, C, K of each of the `reactionless_groups`, with the lag of lift where the blade has one."""
    groups = [("reactionless", {"harmonic": n}) for n in reactionless_harmonics(n_blades)]
    groups += [("differential", {})] * (n_blades % 2 == 0)
    for prefix, more in groups:
        quantities = {**given, **more}
        block = {
            name: evaluate(getattr(multiblade, f"{prefix}_{kind}"), quantities, *blade[:count])
            for count, (name, kind) in enumerate(_KINDS.items(), start=1)
        }
        yield block if late is None else reactionless_with_lift_lag(block, late, quantities)


def _with_reactionless(
    found: Mapping[str, Array], blocks: Iterable[dict[str, Array]], n: int
) -> dict[str, Array]:
    """Return matrices with blocks of reactionless coordinates, which couple with no others and have no inputs."""
    start = found["M"].shape[-1]
    none, more = (0, 0), (0, n - start)
    whole = {
        name: np.pad(matrix, [none] * (matrix.ndim - 2) + [more, more if name in _KINDS else none])
        for name, matrix in found.items()
    }
    for block in blocks:
        end = start + block["M"].shape[-1]
        for name, matrix in block.items():
            whole[name][..., start:end, start:end] = matrix
        start = end
    return whole


def _segments(
    sections: BladeSections,
    rows: Array,
    quantities: Mapping[str, Any],
    at_trim: Mapping[str, Any],
    options: Options,
) -> dict[str, Any]:
    """Return on which side of the hinges each segment is, and the radial moments of each segment's loads."""
    if options.airloads == "none":
        return dict.fromkeys(LOAD_MOMENTS, 0.0) | sections.sides
    equations = options.equation_set.airloads
    if equations is airloads and options.airloads == "full":
        return dict(at_trim)
    sections = sections.take(rows)
    segments = segment_quantities(sections, quantities, equations)
    return segments | airload_moments(sections, segments, options)


def airload_moments(
    sections: BladeSections, segments: Mapping[str, Any], options: Options
) -> dict[str, Array]:
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
