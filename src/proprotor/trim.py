"""Steady state of the rotor: coning, lag, elastic pitch and, for a windmilling rotor, the collective."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from proprotor_equations import airloads, flap_lag_springs, inertia
from proprotor_equations import trim as equations

from proprotor.blade_airloads import load_moments, segment_quantities
from proprotor.evaluation import evaluate
from proprotor.options import Options
from proprotor.rotor import Rotor

UNKNOWNS = ("coning", "lag", "elastic_pitch", "collective")
_LARGEST_STEP = 0.3  # rad; Newton starts far from a blade that has coned and lagged
_ITERATIONS = 40
_CONVERGED = 1e-9  # rad, the last step; convergence is quadratic, so the state is better than that by far


@dataclass(frozen=True, eq=False)
class Trim:
    """Trim states, all arrays of the batch's shape; NaN at points that failed.

    Attributes
    ----------
    collective, coning, lag, elastic_pitch : array
        rad; the pitch at 0.75 R is collective and elastic pitch together.
    thrust : array
        Of the airloads on the whole rotor along +K, N.
    torque : array
        Of the airloads on the whole rotor, positive where it speeds the rotor up, N m.
    converged : array of bool
    reason : array of str
        Why a point failed, empty where it did not.
    iterations : array of int
        Newton steps taken.
    """

    collective: NDArray
    coning: NDArray
    lag: NDArray
    elastic_pitch: NDArray
    thrust: NDArray
    torque: NDArray
    converged: NDArray
    reason: NDArray
    iterations: NDArray

    @property
    def pitch(self) -> NDArray:
        """Pitch of the blade at 0.75 R, rad."""
        return self.collective + self.elastic_pitch


def take(quantities: Mapping[str, Any], rows: NDArray) -> dict[str, Any]:
    """Quantities at some of the points; scalars hold for all."""
    return {name: value[rows] if np.ndim(value) else value for name, value in quantities.items()}


def with_trim(rotor: Rotor, quantities: Mapping[str, Any], state: Mapping[str, Any]) -> dict[str, Any]:
    """All quantities of the whole blade at a trim state."""
    pool = dict(quantities) | dict(state)
    pool["pitch"] = state["collective"] + state["elastic_pitch"]
    pool["structural_pitch"] = pool["pitch"] + rotor.structural_pitch_offset
    pool |= evaluate(inertia.trim_integrals, pool)._asdict()
    return pool | evaluate(flap_lag_springs.effective_stiffness, pool)._asdict()


def _balance(rotor: Rotor, pool: Mapping[str, Any], compressibility: bool) -> tuple[NDArray, NDArray, NDArray]:
    """Residual (n, 4), its Jacobian (n, 4, 4) and the steady airloads (n, 5): the balances' rows and the thrust."""
    segments = segment_quantities(rotor, pool)
    segments |= load_moments(rotor, segments, compressibility=compressibility)
    motion = {
        "virtual_motion": evaluate(equations.virtual_motion, segments),
        "displacement_motion": evaluate(equations.displacement_motion, segments),
        "geometric_stiffness": evaluate(equations.geometric_stiffness, segments),
        "load_derivatives": evaluate(airloads.load_derivatives, segments),
        "steady_loads": evaluate(airloads.steady_loads, segments),
    }
    work = evaluate(airloads.steady_work, motion)[..., 0]
    motion["virtual_motion"] = motion["virtual_motion"][..., : len(UNKNOWNS)]
    residual = evaluate(equations.residual, pool)[..., 0] - work[..., : len(UNKNOWNS)]
    return residual, evaluate(equations.jacobian, pool) + evaluate(airloads.stiffness, motion), work


def _start(rotor: Rotor, quantities: Mapping[str, Any], collective: Any, points: int) -> dict[str, NDArray]:
    """First guess: an undeflected blade whose section at 0.75 R meets the air at no angle."""
    at_rest = {name: np.zeros(points) for name in UNKNOWNS}
    guess = np.arctan2(quantities["airspeed"], 0.75 * quantities["rotor_speed"] * rotor.radius)
    at_rest["collective"] = at_rest["collective"] + (guess if collective is None else collective)
    return at_rest


def free_unknowns(options: Options, windmilling: bool) -> list[int]:
    """Places of the unknowns that are solved for; the others stay where they are."""
    free = {
        "coning": "flap" not in options.locked,
        "lag": "lag" not in options.locked,
        "elastic_pitch": options.pitch_is_free,
        "collective": windmilling,
    }
    return [place for place, name in enumerate(UNKNOWNS) if free[name]]


def solve_trim(rotor: Rotor, quantities: Mapping[str, Any], options: Options, collective: Any, points: int) -> Trim:
    """Newton's method on all points at once; each point stops when it has converged.

    Parameters
    ----------
    rotor : Rotor
    quantities : mapping
        Numbers or arrays (points,) of rotor, operation and airspeed by name.
    options : Options
    collective : float or array, or None
        Given collective in rad; None for a windmilling rotor.
    points : int
        Number of points.
    """
    free = free_unknowns(options, collective is None)
    state = _start(rotor, quantities, collective, points)
    reason = _before_trim(rotor, quantities, options, points)
    iterations = np.zeros(points, dtype=int)
    active = np.flatnonzero(reason == "")
    if collective is None and np.all(np.asarray(quantities["density"]) == 0):
        reason[active] = "no windmilling trim in a vacuum: give a collective"
        active = active[:0]
    with np.errstate(all="ignore"):
        for _ in range(_ITERATIONS if free else 0):
            if not len(active):
                break
            step = _newton_step(rotor, quantities, state, options, active, free)
            for place, name in enumerate(UNKNOWNS):
                state[name][active] -= step[:, place]
            iterations[active] += 1
            lost = ~np.isfinite(step).all(axis=1)
            reason[active[lost]] = _failure(collective is None)
            active = active[~lost & (np.abs(step).max(axis=1) > _CONVERGED)]
        reason[active] = _failure(collective is None) if free else ""
    return _result(rotor, quantities, options, state, reason, iterations)


def _newton_step(rotor, quantities, state, options, rows, free) -> NDArray:
    pool = with_trim(rotor, take(quantities, rows), {name: value[rows] for name, value in state.items()})
    residual, jacobian, _ = _balance(rotor, pool, options.compressibility)
    step = np.zeros((len(rows), len(UNKNOWNS)))
    try:
        step[:, free] = np.linalg.solve(jacobian[:, free][:, :, free], residual[:, free, None])[..., 0]
    except np.linalg.LinAlgError:
        step[:, free] = (np.linalg.pinv(jacobian[:, free][:, :, free]) @ residual[:, free, None])[..., 0]
    return np.clip(step, -_LARGEST_STEP, _LARGEST_STEP)


def _before_trim(rotor: Rotor, quantities: Mapping[str, Any], options: Options, points: int) -> NDArray:
    """Reasons that are known before any iteration."""
    reason = np.full(points, "", dtype=object)
    airspeed = np.broadcast_to(quantities["airspeed"], (points,))
    reason[~np.isfinite(airspeed)] = "airspeed is not a finite number"
    reason[airspeed < 0] = "airspeed is negative: the model is for axial flight along +K"
    if options.compressibility:
        tip = np.hypot(np.asarray(quantities["rotor_speed"]) * rotor.radius, airspeed)
        mach = tip / np.asarray(quantities["speed_of_sound"])
        for place in np.flatnonzero((reason == "") & (mach >= 1)):
            reason[place] = f"tip Mach number {mach[place]:.3f}: Prandtl-Glauert needs it below 1"
    return reason


def _failure(windmilling: bool) -> str:
    if windmilling:
        return "no windmilling trim found: the torque has no zero near zero angle of attack, or Newton did not converge"
    return "no trim found: Newton did not converge"


def _result(rotor, quantities, options, state, reason, iterations) -> Trim:
    for name in ("coning", "lag", "elastic_pitch"):
        reason[(reason == "") & ~(np.abs(state[name]) < np.pi / 2)] = f"trim {name.replace('_', ' ')} beyond 90 deg"
    good = np.flatnonzero(reason == "")
    values = {name: np.full(len(reason), np.nan) for name in (*UNKNOWNS, "thrust", "torque")}
    for name in UNKNOWNS:
        values[name][good] = state[name][good]
    if len(good):
        rows = take(quantities, good)
        pool = with_trim(rotor, rows, {name: state[name][good] for name in UNKNOWNS})
        _, _, work = _balance(rotor, pool, options.compressibility)
        values["torque"][good], values["thrust"][good] = (np.asarray(rotor.n_blades) * work[:, place] for place in (3, 4))
    return Trim(**values, converged=reason == "", reason=reason, iterations=iterations)
