"""Linear equations of motion of a rotor, or of a rotor on a support, at one or many airspeeds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike
from proprotor_equations import (
    FIXED_COORDINATES,
    FIXED_GUSTS,
    airloads,
    inertia,
    multiblade,
    pitch,
)
from proprotor_equations import coordinates as known
from proprotor_equations import rotor as whole_rotor
from proprotor_equations.coordinates import Coordinate

from proprotor.airfoil import Airfoil
from proprotor.arrays import Array
from proprotor.blade_airloads import (
    LOAD_MOMENTS,
    BladeSections,
    closed_form_moments,
    has_closed_form,
    load_moments,
    segment_quantities,
)
from proprotor.drive_train import DriveTrain
from proprotor.errors import InputError
from proprotor.evaluation import evaluate
from proprotor.needs import check_memory
from proprotor.operation import Operation
from proprotor.options import Options, parse_options
from proprotor.rotor import Rotor
from proprotor.speed import in_metres_per_second
from proprotor.stamp import Origin
from proprotor.trim import UNKNOWNS, Target, Trim, trim_target
from proprotor.trim_solver import Settled, solve_trim

if TYPE_CHECKING:
    import xarray

    from proprotor.state_space import StateSpace

HUB = tuple(coordinate.name for coordinate in known.FIXED if coordinate.angle in ("hub", "turn"))
SWASHPLATE = tuple(motion.name for motion in known.SWASHPLATE)
INPUTS = (*SWASHPLATE, *FIXED_GUSTS)
ROTOR_SPEED = "azimuth"  # enters as a rate: nothing holds the rotor's azimuth
MASS_AT_REST = (*HUB, "gimbal_1c", "gimbal_1s")  # coordinates of a rotor at rest with locked blades
COUPLINGS = ("pitch_flap_coupling", "pitch_lag_coupling")
_PITCH = [place for place, coordinate in enumerate(known.FIXED) if coordinate.angle == "pitch"]
_KINDS = {"M": "mass", "C": "damping", "K": "stiffness"}
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
        `proprotor.support.NormalModes`.
    origin : Origin, optional
        The options in force, and the case where it is one's: see `proprotor.stamp`.
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
        from proprotor.summary import of_model

        return of_model(self)

    @property
    def shaft_holds_azimuth(self) -> Array:
        """Points (...) where a shaft to a constant-speed end makes the azimuth a displacement (rad), no mere rate."""
        if ROTOR_SPEED not in self.dofs:
            return np.zeros(self.K.shape[:-2], dtype=bool)
        place = self.dofs.index(ROTOR_SPEED)
        return np.asarray(np.nan_to_num(np.real(self.K[..., place, place])) > 0)

    def modes(self) -> xarray.Dataset:
        """Eigenvalues and mode shapes, see `proprotor.modes.modes`.

        Returns
        -------
        xarray.Dataset
            eigenvalue (..., mode), rad/s, and more.

        Raises
        ------
        InputError
            When the mass matrix has no inverse, as that of a rotor alone may not.
        """
        from proprotor.modes import modes

        return modes(self)

    def to_state_space(self) -> StateSpace:
        """A, B, C, D with named states, inputs and outputs, see `proprotor.state_space.state_space`.

        Returns
        -------
        StateSpace

        Raises
        ------
        InputError
            When the model has no inputs, as one from elsewhere may.
        """
        from proprotor.state_space import state_space

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
        See `proprotor.options.Options`.

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
    reactionless = int(np.max(rotor.n_blades)) if choice.reactionless else None
    matrices = _matrices(sections, choice, settled, reactionless)
    coordinates = (*known.FIXED, *_reactionless(reactionless))
    names = tuple(coordinate.name for coordinate in coordinates)
    dofs = _free_coordinates(choice, coordinates)
    parts: dict[str, Any] = {
        name: matrix.reshape(*shape, *matrix.shape[-2:]) for name, matrix in matrices.items()
    }
    shaped = Trim(**{e.name: getattr(trim, e.name).reshape(shape) for e in fields(trim)})
    model = LinearModel(
        **parts,
        dofs=names,
        trim=shaped,
        airspeed=np.broadcast_to(speed, shape),
        mass_at_rest=mass_at_rest(rotor),
        origin=Origin(choice),
    )
    return model if dofs == names else model.submodel(dofs)


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


def reactionless_coordinates(n_blades: int) -> tuple[str, ...]:
    """Blade motions beyond Eq. 17: harmonics 2 to below N/2, and for even N neighbours against each other."""
    return tuple(coordinate.name for coordinate in _reactionless(n_blades))


def _reactionless(n_blades: int | None) -> list[Coordinate]:
    if n_blades is None:
        return []
    pairs = [
        c._replace(name=f"{c.angle}_{n}{c.part}", harmonic=n)
        for n in _harmonics(n_blades)
        for c in known.REACTIONLESS_PAIR
    ]
    return pairs + list(known.DIFFERENTIAL) * (n_blades % 2 == 0)


def _harmonics(n_blades: int) -> range:
    """Harmonics of reactionless pairs, 2 to below N/2."""
    return range(2, (n_blades + 1) // 2)


def _check_pitch(rotor: Rotor, options: Options) -> None:
    if options.pitch_is_free and np.any(np.asarray(rotor.pitch_inertia) <= 0):
        raise InputError("pitch_inertia", rotor.pitch_inertia, 'must be above zero with pitch="dynamic"')
    if options.pitch == "coupling" and np.any(np.asarray(rotor.control_stiffness) <= 0):
        raise InputError(
            "control_stiffness", rotor.control_stiffness, 'must be above zero with pitch="coupling"'
        )


def _free_coordinates(options: Options, coordinates: tuple[Coordinate, ...]) -> tuple[str, ...]:
    removed = set(options.locked)
    if not options.pitch_is_free:
        removed.add("pitch")
    if options.rotor_speed == "constant":
        removed.add(ROTOR_SPEED)
    return tuple(coordinate.name for coordinate in coordinates if coordinate.angle not in removed)


def _matrices(
    sections: BladeSections, options: Options, settled: Settled, reactionless: int | None
) -> dict[str, Array]:
    """M, C, K (points, n, n) and B (points, n, 6) in the fixed frame; NaN without trim.

    `reactionless` is the number of blades whose reactionless motions follow the coordinates of Eq. 17, or None.
    """
    points, rows = len(settled.trim.converged), settled.rows
    n = len(FIXED_COORDINATES) + len(_reactionless(reactionless))
    found: dict[str, Array] = {}
    if len(rows):
        pool = settled.pool | couplings(options, settled.pool)
        given = _segments(sections.take(rows), pool, settled.segments, options) | pool
        given["equations"] = options.equation_set
        blade = evaluate(whole_rotor.blade_matrices, given)
        found = evaluate(whole_rotor.fixed_frame, given, *blade)._asdict()
        if not options.pitch_is_free:
            found["B"] = _without_pitch_equations(found["K"], found["B"])
        if reactionless is not None:
            found = _with_reactionless(found, list(_reactionless_blocks(given, blade, reactionless)), n)
    return {
        name: _at_all_points(found.get(name), points, rows, (n, columns))
        for name, columns in (dict.fromkeys("MCK", n) | {"B": len(INPUTS)}).items()
    }


def _without_pitch_equations(stiffness: Array, inputs: Array) -> Array:
    """Loads per unit of the inputs where the blades follow the swashplate at once."""
    followed = -stiffness[..., _PITCH]
    gusts = inputs[..., len(SWASHPLATE) :]
    return np.concatenate(
        [followed, np.broadcast_to(gusts, (*followed.shape[:-1], gusts.shape[-1]))], axis=-1
    )


def _at_all_points(matrix: Array | None, points: int, rows: Array, shape: tuple[int, int]) -> Array:
    """A matrix of the rows that have one at all points, NaN at the others."""
    if matrix is not None and matrix.ndim == 3 and matrix.shape[0] == points == len(rows):
        return matrix
    whole = np.full((points, *shape), np.nan, dtype=float if matrix is None else matrix.dtype)
    if matrix is not None:
        whole[rows] = matrix
    return whole


def _reactionless_blocks(
    given: Mapping[str, Any], blade: tuple[Array, ...], n_blades: int
) -> Iterator[dict[str, Array]]:
    """M, C, K of each group of `reactionless_coordinates`, in their order; the groups do not couple."""
    groups = [("reactionless", {"harmonic": n}) for n in _harmonics(n_blades)]
    groups += [("differential", {})] * (n_blades % 2 == 0)
    for prefix, more in groups:
        yield {
            name: evaluate(getattr(multiblade, f"{prefix}_{kind}"), {**given, **more}, *blade[:count])
            for count, (name, kind) in enumerate(_KINDS.items(), start=1)
        }


def _with_reactionless(
    found: Mapping[str, Array], blocks: list[dict[str, Array]], n: int
) -> dict[str, Array]:
    """The matrices with blocks of reactionless coordinates, which couple with nothing else and have no inputs."""
    whole = {
        name: _filled(matrix, n, n if name in _KINDS else matrix.shape[-1]) for name, matrix in found.items()
    }
    start = len(FIXED_COORDINATES)
    for block in blocks:
        end = start + block["M"].shape[-1]
        for name, matrix in block.items():
            whole[name][..., start:end, start:end] = matrix
        start = end
    return whole


def _filled(matrix: Array, rows: int, columns: int) -> Array:
    """The matrix with zeros below and beside it."""
    missing = [(0, 0)] * (matrix.ndim - 2) + [(0, rows - matrix.shape[-2]), (0, columns - matrix.shape[-1])]
    return np.pad(matrix, missing)


def couplings(options: Options, pool: Mapping[str, Any]) -> dict[str, Any]:
    """Pitch-flap and pitch-lag coupling of the airloads' pitch; a given value stands in place of the closed form."""
    if options.pitch != "coupling":
        return dict.fromkeys(COUPLINGS, 0.0)
    closed_form: dict[str, Any] = evaluate(pitch.couplings, pool)._asdict()
    return closed_form | {name: pool[name] for name in COUPLINGS if name in pool}


def _segments(
    sections: BladeSections, pool: Mapping[str, Any], at_trim: Mapping[str, Any], options: Options
) -> dict[str, Any]:
    """What the blade's segments have: on which side of the hinges they are, and the radial moments of their loads."""
    if options.airloads == "none":
        hinges = ("beyond_flap_hinge", "beyond_lag_hinge")
        return dict.fromkeys(LOAD_MOMENTS, 0.0) | {
            name: getattr(sections.quadrature, name) for name in hinges
        }
    equations = options.equation_set.airloads
    if equations is airloads and options.airloads == "full":
        return dict(at_trim)
    segments = segment_quantities(sections, pool, equations)
    return segments | _moments(sections, segments, options)


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
