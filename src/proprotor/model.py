"""Linear equations of motion of a rotor, or of a rotor on a support, at one or many airspeeds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from proprotor_equations import FIXED_COORDINATES, airloads, inertia, multiblade, pitch

from proprotor.blade_airloads import load_moments, segment_quantities
from proprotor.equation_set import EquationSet
from proprotor.errors import InputError
from proprotor.evaluation import evaluate
from proprotor.operation import Operation
from proprotor.options import Options, parse_options
from proprotor.rotor import Rotor
from proprotor.speed import in_metres_per_second
from proprotor.trim import UNKNOWNS, Trim, solve_trim, take, with_trim

if TYPE_CHECKING:
    import xarray

HUB = FIXED_COORDINATES[:6]
ROTOR_SPEED = "azimuth"  # enters as a rate: nothing holds the rotor's azimuth
_SOFTEST_SPRING = 1e-12  # of the other spring: a free hinge, without a division by zero in series


@dataclass(frozen=True, eq=False)
class LinearModel:
    """M q̈ + C q̇ + K q = 0 about trim, batched over leading axes.

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
    """

    M: NDArray
    C: NDArray
    K: NDArray
    dofs: tuple[str, ...]
    trim: Trim
    airspeed: NDArray

    def modes(self) -> xarray.Dataset:
        """Eigenvalues and mode shapes, see `proprotor.modes.modes`."""
        from proprotor.modes import modes

        return modes(self)

    def submodel(self, dofs: tuple[str, ...]) -> LinearModel:
        """The model with other coordinates held at zero."""
        places = [self.dofs.index(name) for name in dofs]
        parts = {name: getattr(self, name)[..., places, :][..., places] for name in "MCK"}
        return replace(self, dofs=tuple(dofs), **parts)


def rotor_quantities(rotor: Rotor, operation: Operation, airspeed: NDArray, points: tuple[int, ...]) -> dict[str, Any]:
    """Numbers, or arrays flattened over the batch, of rotor, operation and airspeed by the names of the derivation."""
    given = {entry.name: getattr(rotor, entry.name) for entry in fields(rotor)}
    given = {name: value for name, value in given.items() if name not in ("airfoil", "chord", "twist")}
    given |= {name: getattr(rotor, name) for name in ("flap_hub_inertia", "lag_hub_inertia", "flap_lag_inertia")}
    given |= {name: getattr(operation, name) for name in ("rotor_speed", "density", "speed_of_sound")}
    given["propeller_moment"] = float(rotor.propeller_moment)
    softest = _SOFTEST_SPRING * np.maximum(np.maximum(rotor.flap_stiffness, rotor.lag_stiffness), 1.0)
    given |= {name: np.maximum(given[name], softest) for name in ("flap_stiffness", "lag_stiffness")}
    given["airspeed"] = airspeed
    return {name: np.broadcast_to(v, points).reshape(-1) if np.ndim(v) else v for name, v in given.items()}


def batch_shape(rotor: Rotor, operation: Operation, airspeed: NDArray) -> tuple[int, ...]:
    """Shape of all arrays among the inputs, broadcast together."""
    inputs = [getattr(rotor, e.name) for e in fields(rotor) if e.name not in ("airfoil", "chord", "twist")]
    inputs += [getattr(operation, name) for name in ("rotor_speed", "density", "speed_of_sound")]
    return np.broadcast_shapes(np.shape(airspeed), *(np.shape(value) for value in inputs))


def rotor_model(rotor: Rotor, operation: Operation, airspeed: ArrayLike, **options: Any) -> LinearModel:
    """The rotor alone on its six hub coordinates, in the order of Eq. 17 of AIAA-2002-1604.

    Parameters
    ----------
    rotor : Rotor
    operation : Operation
    airspeed : float, array (...) in m/s, or pint quantity
    **options
        See `proprotor.options.Options`.

    Returns
    -------
    LinearModel
        n = 18 with everything free.

    Raises
    ------
    InputError
        For an unknown option, or a rotor that the options do not allow.
    """
    choice = parse_options(options)
    _check_pitch(rotor, choice)
    speed = in_metres_per_second(airspeed)
    shape = batch_shape(rotor, operation, speed)
    quantities = rotor_quantities(rotor, operation, speed, shape)
    points = int(np.prod(shape, dtype=int))
    collective = None if operation.windmilling else operation.trim["collective"]
    trim = solve_trim(rotor, quantities, choice, collective, points)
    matrices = _matrices(rotor, quantities, choice, trim, points)
    dofs = _free_coordinates(choice)
    places = [FIXED_COORDINATES.index(name) for name in dofs]
    parts = {
        name: matrix[:, places][:, :, places].reshape(*shape, len(dofs), len(dofs)) for name, matrix in matrices.items()
    }
    shaped = Trim(**{e.name: getattr(trim, e.name).reshape(shape) for e in fields(trim)})
    return LinearModel(**parts, dofs=dofs, trim=shaped, airspeed=np.broadcast_to(speed, shape))


def _check_pitch(rotor: Rotor, options: Options) -> None:
    if options.pitch_is_free and np.any(np.asarray(rotor.pitch_inertia) <= 0):
        raise InputError("pitch_inertia", rotor.pitch_inertia, 'must be above zero with pitch="dynamic"')
    if options.pitch == "coupling" and np.any(np.asarray(rotor.control_stiffness) <= 0):
        raise InputError("control_stiffness", rotor.control_stiffness, 'must be above zero with pitch="coupling"')


def _free_coordinates(options: Options) -> tuple[str, ...]:
    removed = {name for name in options.locked}
    if not options.pitch_is_free:
        removed.add("pitch")
    if options.rotor_speed == "constant":
        removed.add(ROTOR_SPEED)
    return tuple(name for name in FIXED_COORDINATES if name.rpartition("_")[0] not in removed and name not in removed)


def _matrices(rotor: Rotor, quantities: Mapping[str, Any], options: Options, trim: Trim, points: int) -> dict:
    """M, C, K (points, 18, 18) in the fixed frame, NaN where trim failed."""
    matrices = {name: np.full((points, len(FIXED_COORDINATES), len(FIXED_COORDINATES)), np.nan) for name in "MCK"}
    good = np.flatnonzero(trim.converged)
    if len(good):
        state = {name: getattr(trim, name)[good] for name in UNKNOWNS}
        pool = with_trim(rotor, take(quantities, good), state)
        pool |= _couplings(options, pool)
        mass, damping, stiffness = _structure(pool, options.equation_set)
        if options.airloads != "none":
            air_damping, air_stiffness = _airloads(rotor, pool, options)
            damping, stiffness = damping + air_damping, stiffness + air_stiffness
        matrices["M"][good] = evaluate(multiblade.mass, pool, mass)
        matrices["C"][good] = evaluate(multiblade.damping, pool, mass, damping)
        matrices["K"][good] = evaluate(multiblade.stiffness, pool, mass, damping, stiffness)
    return matrices


def _couplings(options: Options, pool: Mapping[str, Any]) -> dict[str, Any]:
    if options.pitch == "coupling":
        return evaluate(pitch.couplings, pool)._asdict()
    return {"pitch_flap_coupling": 0.0, "pitch_lag_coupling": 0.0}


def _structure(pool: Mapping[str, Any], equations: EquationSet) -> tuple[NDArray, NDArray, NDArray]:
    """Inertia, springs and dampers of one blade."""
    pool = dict(pool) | evaluate(equations.inertia.trim_integrals, pool)._asdict()
    mass = evaluate(equations.inertia.mass, pool) + evaluate(equations.pitch.mass, pool)
    damping = evaluate(equations.inertia.gyroscopic, pool) + evaluate(pitch.damping, pool)
    stiffness = evaluate(equations.inertia.centrifugal_stiffness, pool) + evaluate(equations.pitch.stiffness, pool)
    return mass, damping, stiffness + evaluate(equations.flap_lag_springs.stiffness, pool)


def _airloads(rotor: Rotor, pool: Mapping[str, Any], options: Options) -> tuple[NDArray, NDArray]:
    """Airload damping and stiffness of one blade."""
    motion = options.equation_set.airloads
    segments = segment_quantities(rotor, pool, motion)
    segments |= load_moments(
        rotor,
        segments,
        compressibility=options.compressibility,
        lift_slope_only=options.airloads == "lift-slope",
        equations=motion,
    )
    for name in ("virtual_motion", "rate_motion", "displacement_motion", "geometric_stiffness"):
        segments[name] = evaluate(getattr(motion, name), segments)
    segments["load_derivatives"] = evaluate(airloads.load_derivatives, segments)
    return evaluate(airloads.damping, segments), evaluate(airloads.stiffness, segments)


def rigid_hub_mass(rotor: Rotor) -> NDArray:
    """Mass matrix (6, 6) of the undeflected rotor on its hub coordinates, everything else locked."""
    still = {name: 0.0 for name in UNKNOWNS}
    names = [e.name for e in fields(rotor) if e.name not in ("airfoil", "chord", "twist")]
    pool = {name: getattr(rotor, name) for name in (*names, "flap_hub_inertia", "lag_hub_inertia", "flap_lag_inertia")}
    pool |= still
    pool |= evaluate(inertia.trim_integrals, pool)._asdict()
    return evaluate(multiblade.mass, pool, evaluate(inertia.mass, pool))[..., :6, :6]
