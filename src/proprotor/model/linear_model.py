"""Linear equations of motion of a rotor, or of a rotor on a support, at one or many airspeeds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike
from proprotor_equations import (
    BLADE_COORDINATES,
    FIXED_COORDINATES,
    FIXED_GUSTS,
    airloads,
    drive_train,
    inertia,
    multiblade,
    pitch,
)

from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.doubts import reasons_for_doubt
from proprotor.model.stamp import Origin
from proprotor.needs import check_memory
from proprotor.rotor.airfoil import Airfoil
from proprotor.rotor.drive_train import DriveTrain
from proprotor.rotor.generated import EquationSet, evaluate
from proprotor.rotor.motions import HUB, ROTOR_SPEED, reactionless_coordinates
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
from proprotor.rotor.trim import UNKNOWNS, Target, Trim, trim_target
from proprotor.rotor.trim_solver import Settled, solve_trim
from proprotor.typing import Array
from proprotor.units import in_metres_per_second

if TYPE_CHECKING:
    import xarray

    from proprotor.model.state_space import StateSpace


SWASHPLATE = ("collective", "cyclic_1c", "cyclic_1s")
INPUTS = (*SWASHPLATE, *FIXED_GUSTS)


MASS_AT_REST = (*HUB, "gimbal_1c", "gimbal_1s")  # coordinates of a rotor at rest with locked blades
COUPLINGS = ("pitch_flap_coupling", "pitch_lag_coupling")
_BYTES_PER_POINT, _BYTES_PER_ENTRY = 10_000.0, 80.0  # while a rotor is trimmed and its matrices are made
_SOFTEST_SPRING = 1e-100  # of the other spring: a free hinge, without a division by zero in series


@dataclass(frozen=True, eq=False, repr=False)
class LinearModel:
    """M q̈ + C q̇ + K q = B u about trim, batched over leading axes.

    Attributes
    ----------
    M, C, K : array (..., n, n)
        SI units; rows are virtual work per coordinate, hub rows inertial-axes resultants. NaN at failed points.
    dofs : tuple of str
        Names of the n coordinates.
    trim : Trim
        Arrays of the batch's shape, with the reason of every failed point.
    airspeed : array (...)
        m/s.
    B : array (..., n, 6), optional
        Loads per unit of the inputs `INPUTS`: swashplate collective and cyclics in rad, gusts along I, J, K in m/s.
    hub : array (6, n), optional
        Hub motion in the coordinates; None for a model whose first six coordinates are the hub's own.
    rotor : LinearModel, optional
        The rotor alone of a rotor on a support, from which the hub loads follow.
    mass_at_rest : array (..., 6, 6) or (..., 8, 8), optional
        Of a rotor alone: its mass matrix at rest with locked blades on the hub's coordinates and, where it has a
        gimbal, that gimbal's (`MASS_AT_REST`), whatever the options. A support whose masses include the rotor needs it.
    shapes : array (..., m, k), optional
        Of the first k coordinates, those of a support that other designs have in other shapes: see
        `proprotor.support.normal_modes.NormalModes`.
    origin : Origin, optional
        The options in force, and the case where it is one's: see `proprotor.model.stamp`.
    """

    M: Array
    C: Array
    K: Array
    dofs: tuple[str, ...]
    trim: Trim
    airspeed: Array
    B: Array | None = None
    hub: Array | None = None
    rotor: LinearModel | None = None
    mass_at_rest: Array | None = None
    shapes: Array | None = None
    origin: Origin | None = None

    def __repr__(self) -> str:
        """Return the coordinates, the shape of the batch and what failed in the batch, in a few lines."""
        converged = np.asarray(self.trim.converged)
        shape = f"batch of shape {converged.shape}" if converged.ndim else "one point"
        lines = [
            f"LinearModel: {len(self.dofs)} coordinates, {shape}, {range_of(self.airspeed)} m/s",
            f"  {', '.join(self.dofs)}",
        ]
        lines += [f"  {line}" for line in stamp.told_if_unusual(stamp.of_model(self))]
        reasons = Counter(str(reason) for reason in np.ravel(self.trim.reason) if reason)
        lines += [
            f"  {count} of {converged.size} failed: {reason}" for reason, count in reasons.most_common(5)
        ]
        doubts = reasons_for_doubt(np.ravel(self.trim.warning).tolist())
        lines += [f"  {len(at)} of {converged.size} doubtful: {text}" for text, at in doubts.items()]
        return "\n".join(lines)

    @property
    def shaft_holds_azimuth(self) -> Array:
        """Points (...) where a shaft to a constant-speed end makes the azimuth a displacement (rad), no mere rate."""
        if ROTOR_SPEED not in self.dofs:
            return np.zeros(self.K.shape[:-2], dtype=bool)
        place = self.dofs.index(ROTOR_SPEED)
        return np.asarray(np.nan_to_num(np.real(self.K[..., place, place])) > 0)

    def modes(self) -> xarray.Dataset:
        """Eigenvalues and mode shapes, see `proprotor.stability.modes.modes`.

        Returns
        -------
        xarray.Dataset
            eigenvalue (..., mode), rad/s, and more.

        Raises
        ------
        InputError
            When the mass matrix has no inverse, as that of a rotor alone may not.
        """
        from proprotor.stability.modes import modes

        return modes(self)

    def to_state_space(self) -> StateSpace:
        """A, B, C, D with named states, inputs and outputs, see `proprotor.model.state_space.state_space`.

        Returns
        -------
        StateSpace

        Raises
        ------
        InputError
            When the model has no inputs, as one from elsewhere may.
        """
        from proprotor.model.state_space import state_space

        return state_space(self)

    def submodel(self, dofs: tuple[str, ...]) -> LinearModel:
        """The model with other coordinates held at zero.

        Parameters
        ----------
        dofs : tuple of str
            Names of those that stay, in the order wanted.

        Returns
        -------
        LinearModel
        """
        places = [self.dofs.index(name) for name in dofs]
        parts = {name: getattr(self, name)[..., places, :][..., places] for name in "MCK"}
        inputs = None if self.B is None else self.B[..., places, :]
        hub = None if self.hub is None else self.hub[:, places]
        whole = self.shapes is not None and places[: self.shapes.shape[-1]] == [*range(self.shapes.shape[-1])]
        shapes = self.shapes if whole else None
        return replace(self, dofs=tuple(dofs), B=inputs, hub=hub, shapes=shapes, **parts)


def rotor_quantities(
    rotor: Rotor, operation: Operation, airspeed: Array, points: tuple[int, ...]
) -> dict[str, Any]:
    """Numbers, or arrays flattened over the batch, of rotor, operation and airspeed by the names of the derivation."""
    given = {entry.name: getattr(rotor, entry.name) for entry in fields(rotor)}
    given = {name: value for name, value in given.items() if name not in ("airfoil", "chord", "twist")}
    given |= {
        name: getattr(rotor, name) for name in ("flap_hub_inertia", "lag_hub_inertia", "flap_lag_inertia")
    }
    given |= {name: getattr(operation, name) for name in ("rotor_speed", "density", "speed_of_sound")}
    given["propeller_moment"] = float(rotor.propeller_moment)
    softest = _SOFTEST_SPRING * np.maximum(np.maximum(rotor.flap_stiffness, rotor.lag_stiffness), 1.0)
    given |= {name: np.maximum(given[name], softest) for name in ("flap_stiffness", "lag_stiffness")}
    given["airspeed"] = airspeed
    return {name: np.broadcast_to(v, points).reshape(-1) if np.ndim(v) else v for name, v in given.items()}


def model_quantities(
    rotor: Rotor, operation: Operation, options: Options, airspeed: Array, points: tuple[int, ...]
) -> dict[str, Any]:
    """`rotor_quantities`, and the numbers that the options give: couplings and the damping of sections."""
    given = {name: getattr(options, name) for name in COUPLINGS}
    given |= {} if options.drive_train is None else vars(options.drive_train)
    given = {
        name: np.broadcast_to(value, points).reshape(-1) if np.ndim(value) else value
        for name, value in given.items()
        if value is not None
    }
    damping = {"section_damping": float(bool(options.section_damping))}
    return rotor_quantities(rotor, operation, airspeed, points) | given | damping


def batch_shape(
    rotor: Rotor, operation: Operation, airspeed: Array, drive_train: DriveTrain | None = None
) -> tuple[int, ...]:
    """Shape of all arrays among the inputs, broadcast together."""
    inputs = [getattr(rotor, entry.name) for entry in fields(rotor) if entry.name != "airfoil"]
    leading = [np.empty(np.shape(value[0])[:-1]) for value in inputs if isinstance(value, tuple)]
    inputs = [value for value in inputs if not isinstance(value, tuple) and not callable(value)] + leading
    if isinstance(rotor.airfoil, Airfoil):
        inputs += [getattr(rotor.airfoil, entry.name) for entry in fields(rotor.airfoil)]
    inputs += [getattr(operation, name) for name in ("rotor_speed", "density", "speed_of_sound")]
    inputs += [] if isinstance(operation.trim, str) else list(operation.trim.values())
    inputs += [] if drive_train is None else list(vars(drive_train).values())
    return np.broadcast_shapes(np.shape(airspeed), *(np.shape(value) for value in inputs))


def rotor_model(rotor: Rotor, operation: Operation, airspeed: ArrayLike, **options: Any) -> LinearModel:
    """The rotor alone on its six hub coordinates, in the order of Eq. 17 of AIAA-2002-1604.

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
    trim = settled.trim
    if choice.reactionless and np.ndim(rotor.n_blades):
        raise InputError("n_blades", rotor.n_blades, "must be one number with reactionless=True")
    extra = reactionless_coordinates(int(np.max(rotor.n_blades))) if choice.reactionless else ()
    matrices = _matrices(sections, choice, settled, extra)
    coordinates = (*FIXED_COORDINATES, *extra)
    dofs = _free_coordinates(choice, coordinates)
    parts: dict[str, Any] = {
        name: matrix.reshape(*shape, *matrix.shape[-2:]) for name, matrix in matrices.items()
    }
    shaped = Trim(**{e.name: getattr(trim, e.name).reshape(shape) for e in fields(trim)})
    model = LinearModel(
        **parts,
        dofs=coordinates,
        trim=shaped,
        airspeed=np.broadcast_to(speed, shape),
        mass_at_rest=mass_at_rest(rotor),
        origin=Origin(choice),
    )
    return model if dofs == coordinates else model.submodel(dofs)


def _check_memory(rotor: Rotor, options: Options, points: int) -> None:
    """Refuse a batch, or blades whose motions are all kept, that do not fit into memory."""
    own = len(FIXED_COORDINATES)
    count = own + 3 * (float(np.max(rotor.n_blades)) - 3) * options.reactionless
    if count > own:
        check_memory("n_blades", rotor.n_blades, _BYTES_PER_ENTRY * count**2, "the matrices")
    size = points * (_BYTES_PER_POINT + _BYTES_PER_ENTRY * count**2)
    check_memory("airspeed", f"{points} points", size, "their matrices", "take fewer points at once")


def _flat(target: Target, shape: tuple[int, ...]) -> Target:
    """The target with arrays flattened over the batch."""
    flat: dict[str, Any] = {
        name: np.broadcast_to(value, shape).reshape(-1) if np.ndim(value) else value
        for name, value in (("collective", target.collective), ("load", target.load))
    }
    return replace(target, **flat)


def _check_pitch(rotor: Rotor, options: Options) -> None:
    if options.pitch_is_free and np.any(np.asarray(rotor.pitch_inertia) <= 0):
        raise InputError("pitch_inertia", rotor.pitch_inertia, 'must be above zero with pitch="dynamic"')
    if options.pitch == "coupling" and np.any(np.asarray(rotor.control_stiffness) <= 0):
        raise InputError(
            "control_stiffness", rotor.control_stiffness, 'must be above zero with pitch="coupling"'
        )


def _free_coordinates(options: Options, coordinates: tuple[str, ...]) -> tuple[str, ...]:
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
    """M, C, K (points, n, n) and B (points, n, 6) in the fixed frame, reactionless last; NaN without trim."""
    points, n, rows = len(settled.trim.converged), len(FIXED_COORDINATES) + len(extra), settled.rows
    found: dict[str, Array] = {}
    if len(rows):
        pool = settled.quantities | couplings(options, settled.quantities)
        *blade, gusts = _blade_matrices(sections.take(rows), pool, settled.segments, options)
        inputs = [_swashplate(pool, options, blade), evaluate(multiblade.gust_loads, pool, gusts)]
        found = _fixed_frame(pool, options, blade, extra)
        found["B"] = np.zeros((len(rows), n, len(INPUTS)), dtype=gusts.dtype)
        found["B"][:, : len(FIXED_COORDINATES)] = np.concatenate(inputs, axis=-1)
    return {
        name: _at_all_points(found.get(name), points, rows, (n, columns))
        for name, columns in (dict.fromkeys("MCK", n) | {"B": len(INPUTS)}).items()
    }


def _at_all_points(matrix: Array | None, points: int, rows: Array, shape: tuple[int, int]) -> Array:
    """A matrix of the rows that have one at all points, NaN at the others."""
    if matrix is not None and matrix.shape[0] == points == len(rows):
        return matrix
    whole = np.full((points, *shape), np.nan, dtype=float if matrix is None else matrix.dtype)
    if matrix is not None:
        whole[rows] = matrix
    return whole


def _blade_matrices(
    sections: BladeSections, pool: Mapping[str, Any], at_trim: Mapping[str, Any], options: Options
) -> tuple[Array, ...]:
    """Mass, damping and stiffness (points, 12, 12) of one blade in rotating axes, and its gusts (points, 12, 3)."""
    mass, damping, stiffness = _structure(pool, options.equation_set)
    points = np.shape(pool["pitch"])
    damping, stiffness = (
        np.broadcast_to(matrix, (*points, *matrix.shape[-2:])) for matrix in (damping, stiffness)
    )
    gusts = np.zeros((*stiffness.shape[:-1], 3), dtype=stiffness.dtype)
    if options.airloads != "none":
        air_damping, air_stiffness, gusts = _airloads(sections, pool, at_trim, options)
        damping, stiffness = damping + air_damping, stiffness + air_stiffness
        gusts = np.broadcast_to(gusts, (*stiffness.shape[:-1], 3))  # the same at all points, it may be one
    return mass, damping, stiffness, gusts


def _swashplate(pool: Mapping[str, Any], options: Options, blade: list[Array]) -> Array:
    """Loads (points, 18, 3) on the rotor per unit of swashplate collective and cyclics, held in the fixed frame.

    With the pitch equations kept, the pitch coordinates are then the whole perturbation of blade pitch, and the
    swashplate pulls at them through control system and pitch damper. Without them the blades follow at once. Rates of
    the swashplate are left out.
    """
    place = BLADE_COORDINATES.index("pitch")
    if options.pitch_is_free:
        mass, damping, stiffness = (np.zeros_like(matrix) for matrix in blade)
        damping[..., place, place], stiffness[..., place, place] = (
            pool["pitch_damping"],
            pool["control_stiffness"],
        )
        sign = 1.0
    else:
        (mass, damping, stiffness), sign = blade, -1.0
    columns = [FIXED_COORDINATES.index(name) for name in ("pitch_0", "pitch_1c", "pitch_1s")]
    loads: Array = sign * evaluate(multiblade.stiffness, pool, mass, damping, stiffness)[..., columns]
    return loads


_KINDS = {"M": "mass", "C": "damping", "K": "stiffness"}


def _fixed_frame(
    pool: Mapping[str, Any], options: Options, blade: list[Array], extra: tuple[str, ...]
) -> dict[str, Array]:
    """M, C, K of the rotor from those of one blade."""
    matrices = {}
    for count, (name, kind) in enumerate(_KINDS.items(), start=1):
        matrix = evaluate(getattr(multiblade, kind), pool, *blade[:count])
        if options.drive_train is not None:
            matrix = matrix + evaluate(getattr(drive_train, kind), pool)
        matrices[name] = matrix
    if "cyclic_flap_stiffness_excess" in pool:
        matrices["K"] = matrices["K"] + evaluate(multiblade.cyclic_restraint, pool)
    return {name: _with_reactionless(pool, blade, extra, name, matrix) for name, matrix in matrices.items()}


def _with_reactionless(
    pool: Mapping[str, Any], blade: list[Array], extra: tuple[str, ...], name: str, matrix: Array
) -> Array:
    """The matrix with the blocks of the reactionless coordinates, which couple with nothing else."""
    if not extra:
        return matrix
    count, kind = list(_KINDS).index(name) + 1, _KINDS[name]
    whole = np.zeros((*matrix.shape[:-2], *[len(FIXED_COORDINATES) + len(extra)] * 2))
    start = len(FIXED_COORDINATES)
    whole[..., :start, :start] = matrix
    while start < whole.shape[-1]:
        first = extra[start - len(FIXED_COORDINATES)]
        if first.endswith("_d"):
            block = evaluate(getattr(multiblade, f"differential_{kind}"), pool, *blade[:count])
        else:
            harmonic = {"harmonic": int(first.split("_")[1][:-1])}
            block = evaluate(
                getattr(multiblade, f"reactionless_{kind}"), dict(pool) | harmonic, *blade[:count]
            )
        end = start + block.shape[-1]
        whole[..., start:end, start:end] = block
        start = end
    return whole


def couplings(options: Options, pool: Mapping[str, Any]) -> dict[str, Any]:
    """Pitch-flap and pitch-lag coupling of the airloads' pitch; a given value stands in place of the closed form."""
    if options.pitch != "coupling":
        return dict.fromkeys(COUPLINGS, 0.0)
    closed_form: dict[str, Any] = evaluate(pitch.couplings, pool)._asdict()
    return closed_form | {name: pool[name] for name in COUPLINGS if name in pool}


def _structure(pool: Mapping[str, Any], equations: EquationSet) -> tuple[Array, Array, Array]:
    """Inertia, springs and dampers of one blade."""
    pool = dict(pool) | evaluate(equations.inertia.trim_integrals, pool)._asdict()
    mass = evaluate(equations.inertia.mass, pool) + evaluate(equations.pitch.mass, pool)
    damping = evaluate(equations.inertia.gyroscopic, pool) + evaluate(pitch.damping, pool)
    stiffness = evaluate(equations.inertia.centrifugal_stiffness, pool) + evaluate(
        equations.pitch.stiffness, pool
    )
    return mass, damping, stiffness + evaluate(equations.flap_lag_springs.stiffness, pool)


def _airloads(
    sections: BladeSections, pool: Mapping[str, Any], at_trim: Mapping[str, Any], options: Options
) -> tuple[Array, Array, Array]:
    """Airload damping and stiffness of one blade, and what gusts load it with."""
    equations = options.equation_set.airloads
    if equations is airloads and options.airloads == "full":
        segments = dict(at_trim) | {name: np.asarray(pool[name])[..., None] for name in COUPLINGS}
    else:
        segments = segment_quantities(sections, pool, equations)
        segments |= _moments(sections, segments, options)
    return airload_matrices(segments, equations)


def airload_matrices(segments: Mapping[str, Any], equations: ModuleType) -> tuple[Array, Array, Array]:
    """Airload damping, stiffness (points, 12, 12) and gust loads (points, 12, 3) of one blade from its segments.

    Parameters
    ----------
    segments : mapping
        Quantities of each segment, with the couplings of its pitch and the radial moments of its loads.
    equations : module
        Generated airloads, of the consistent or a reduced set.
    """
    motions = ("virtual_motion", "rate_motion", "displacement_motion", "geometric_stiffness", "gust_motion")
    pool = dict(segments) | {name: evaluate(getattr(equations, name), segments) for name in motions}
    pool["load_derivatives"] = evaluate(airloads.load_derivatives, pool)
    products = (airloads.damping, airloads.stiffness, airloads.gust_loads)
    damping, stiffness, gusts = (evaluate(product, pool) for product in products)
    return damping, stiffness, gusts


def _moments(sections: BladeSections, segments: Mapping[str, Any], options: Options) -> dict[str, Array]:
    """Radial moments of the section loads: in closed form where there is one, else by quadrature."""
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
    """Whether the radial moments of the perturbation airloads need no quadrature."""
    simple = options.equations == "published" and not (options.compressibility or options.section_damping)
    return options.airloads == "lift-slope" and simple and has_closed_form(sections)


def mass_at_rest(rotor: Rotor) -> Array:
    """Return the mass matrix of the undeflected rotor with locked blades, which no option of an analysis changes.

    Parameters
    ----------
    rotor : Rotor

    Returns
    -------
    array (..., 8, 8)
        On the coordinates `MASS_AT_REST`, in kg, kg m and kg m².
    """
    names = [e.name for e in fields(rotor) if e.name not in ("airfoil", "chord", "twist")]
    names += ["flap_hub_inertia", "lag_hub_inertia", "flap_lag_inertia"]
    pool = {name: getattr(rotor, name) for name in names} | dict.fromkeys(UNKNOWNS, 0.0)
    pool |= evaluate(inertia.trim_integrals, pool)._asdict()
    blade = evaluate(inertia.mass, pool) + evaluate(pitch.mass, pool)
    places = np.array([FIXED_COORDINATES.index(name) for name in MASS_AT_REST])
    mass: Array = evaluate(multiblade.mass, pool, blade)[..., places[:, None], places]
    return mass


def range_of(values: np.ndarray) -> str:
    low, high = float(np.min(values.real)), float(np.max(values.real))
    return f"{low:.6g}" if low == high else f"{low:.6g} to {high:.6g}"
