"""Steady state of the rotor: coning, lag, elastic pitch and, unless it is given, the collective."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from proprotor_equations import airloads, flap_lag_springs, inertia
from proprotor_equations import trim as equations

from proprotor.airfoil import Warns
from proprotor.blade_airloads import BladeSections, air_at_stations, load_moments, segment_quantities
from proprotor.evaluation import evaluate
from proprotor.operation import Operation
from proprotor.options import Options
from proprotor.rotor import Rotor

UNKNOWNS = ("coning", "lag", "elastic_pitch", "collective")
_BALANCES = 4  # rows of a blade's balance; the thrust is the fifth
_TORQUE, _THRUST = 3, 4
_LARGEST_STEP = 0.3  # rad; Newton starts far from a blade that has coned and lagged
_ITERATIONS = 40
_FARTHEST = np.radians(
    60
)  # of the collective from the direction of the air: a blade turned farther is another branch
_CONVERGED = 1e-9  # rad, the last step; convergence is quadratic, so the state is better than that by far
_INDUCED_SHARE = 0.05  # of the airspeed: above it the neglected induced velocity turns the inflow by degrees
_OUTBOARD = 0.5  # of the radius: where angle of attack and Mach number matter to the loads


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
    warning : array of str
        What makes a converged point doubtful, empty where nothing does.
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
    warning: NDArray
    iterations: NDArray

    @property
    def pitch(self) -> NDArray:
        """Pitch of the blade at 0.75 R, rad."""
        return self.collective + self.elastic_pitch

    def broadcast(self, shape: tuple[int, ...]) -> Trim:
        """The same at every point of a batch with more axes."""
        return Trim(**{e.name: np.broadcast_to(getattr(self, e.name), shape) for e in fields(self)})


@dataclass(frozen=True)
class Target:
    """What closes the trim: a given collective, or the row of a balance and the load on one blade that meets it."""

    collective: Any = None
    row: int = _TORQUE
    load: Any = 0.0
    windmilling: bool = False

    @property
    def finds_collective(self) -> bool:
        return self.collective is None


def trim_target(rotor: Rotor, operation: Operation) -> Target:
    """Target of an operation; coefficients are C_T = T/(ρπR²(ΩR)²) and C_P = QΩ/(ρπR²(ΩR)³), power put in positive."""
    if operation.windmilling:
        return Target(windmilling=True)
    (name, value), *_ = operation.trim.items()
    if name == "collective":
        return Target(collective=value)
    tip_speed = np.asarray(operation.rotor_speed) * rotor.radius
    force = np.asarray(value) * operation.density * np.pi * np.asarray(rotor.radius) ** 2 * tip_speed**2
    if name == "thrust_coefficient":
        return Target(row=_THRUST, load=force / rotor.n_blades)
    return Target(row=_TORQUE, load=-force * rotor.radius / rotor.n_blades)


def take(quantities: Mapping[str, Any], rows: NDArray) -> dict[str, Any]:
    """Quantities at some of the points; scalars hold for all."""
    return {name: value[rows] if np.ndim(value) else value for name, value in quantities.items()}


def with_trim(quantities: Mapping[str, Any], options: Options, state: Mapping[str, Any]) -> dict[str, Any]:
    """All quantities of the whole blade at a trim state."""
    pool = dict(quantities) | dict(state)
    pool["pitch"] = state["collective"] + state["elastic_pitch"]
    pool["structural_pitch"] = pool["pitch"] + quantities["structural_pitch_offset"]
    pool |= evaluate(inertia.trim_integrals, pool)._asdict()
    return pool | _springs(options, pool)


def _springs(options: Options, pool: Mapping[str, Any]) -> dict[str, Any]:
    """Effective flap and lag stiffness and its change with pitch, as the structure option has it."""
    if options.structure == "tabulated":
        none = dict.fromkeys(flap_lag_springs.EffectiveStiffness._fields, 0.0)
        rotating = options.frequencies.rotating(pool["collective"], pool["airspeed"], pool["rotor_speed"])
        return none | evaluate(flap_lag_springs.stiffness_of_frequencies, dict(pool) | rotating)._asdict()
    springs = evaluate(flap_lag_springs.effective_stiffness, pool)._asdict()
    if options.structure == "diagonal":
        springs |= {name: 0.0 for name in springs if name.startswith("flap_lag_")}
    return springs


def _balance(
    sections: BladeSections, pool: Mapping[str, Any], compressibility: bool, target: Target
) -> tuple[NDArray, NDArray, NDArray]:
    """Residual (n, 5) of balances and thrust, its Jacobian (n, 5, 4), and the steady airloads (n, 5)."""
    segments = segment_quantities(sections, pool)
    segments |= load_moments(sections, segments, compressibility=compressibility)
    motion = {
        "virtual_motion": evaluate(equations.virtual_motion, segments),
        "displacement_motion": evaluate(equations.displacement_motion, segments),
        "geometric_stiffness": evaluate(equations.geometric_stiffness, segments),
        "load_derivatives": evaluate(airloads.load_derivatives, segments),
        "steady_loads": evaluate(airloads.steady_loads, segments),
    }
    work = evaluate(airloads.steady_work, motion)[..., 0]
    residual = evaluate(equations.residual, pool)[..., 0] - work
    residual[..., target.row] += target.load
    return residual, evaluate(equations.jacobian, pool) + evaluate(airloads.stiffness, motion), work


def _start(quantities: Mapping[str, Any], collective: Any, points: int) -> dict[str, NDArray]:
    """First guess: an undeflected blade whose section at 0.75 R meets the air at no angle."""
    at_rest = {name: np.zeros(points) for name in UNKNOWNS}
    speeds = (quantities["airspeed"], 0.75 * np.asarray(quantities["rotor_speed"]) * quantities["radius"])
    guess = np.arctan2(*map(np.real, speeds))
    at_rest["collective"] = at_rest["collective"] + (guess if collective is None else collective)
    return at_rest


def _free_unknowns(options: Options, finds_collective: bool) -> list[int]:
    """Places of the unknowns that are solved for; the others stay where they are."""
    free = {
        "coning": "flap" not in options.locked,
        "lag": "lag" not in options.locked,
        "elastic_pitch": options.pitch_is_free,
        "collective": finds_collective,
    }
    return [place for place, name in enumerate(UNKNOWNS) if free[name]]


def solve_trim(
    sections: BladeSections, quantities: Mapping[str, Any], options: Options, target: Target, points: int
) -> Trim:
    """Newton's method on all points at once; each point stops when it has converged.

    Parameters
    ----------
    sections : BladeSections
    quantities : mapping
        Numbers or arrays (points,) of rotor, operation and airspeed by name.
    options : Options
    target : Target
        What closes the trim.
    points : int
        Number of points.
    """
    if _is_complex(sections, quantities, target):
        return _complex_trim(sections, quantities, options, target, points)
    free = _free_unknowns(options, target.finds_collective)
    state = _start(quantities, target.collective, points)
    prandtl_glauert = options.compressibility and not sections.airfoil.contains_compressibility
    reason = _before_trim(quantities, prandtl_glauert, target, points)
    iterations = np.zeros(points, dtype=int)
    active = np.flatnonzero(reason == "")
    with np.errstate(all="ignore"):
        for _ in range(_ITERATIONS if free else 0):
            if not len(active):
                break
            step = _newton_step(sections, quantities, state, options, target, active, free)
            for place, name in enumerate(UNKNOWNS):
                state[name][active] -= step[:, place]
            iterations[active] += 1
            lost = ~np.isfinite(step).all(axis=1)
            reason[active[lost]] = _failure(target)
            active = active[~lost & (np.abs(step).max(axis=1) > _CONVERGED)]
        reason[active] = _failure(target) if free else ""
        return _result(sections, quantities, options, target, state, reason, iterations)


def _is_complex(sections: BladeSections, quantities: Mapping[str, Any], target: Target) -> bool:
    return sections.is_complex or any(
        np.iscomplexobj(value) for value in (*quantities.values(), target.collective, target.load)
    )


def _complex_trim(
    sections: BladeSections, quantities: Mapping[str, Any], options: Options, target: Target, points: int
) -> Trim:
    """Trim of inputs with small imaginary parts, for derivatives by a complex step.

    The real trim, and from there one Newton step: exact to first order in the imaginary parts, which are of no other
    use.
    """
    real = {name: np.real(value) for name, value in quantities.items()}
    real_target = replace(
        target,
        collective=None if target.collective is None else np.real(target.collective),
        load=np.real(target.load),
    )
    trim = solve_trim(sections.real, real, options, real_target, points)
    state = {name: getattr(trim, name).astype(complex) for name in UNKNOWNS}
    if target.collective is not None:
        state["collective"] = state["collective"] + 1j * np.imag(target.collective)
    free = _free_unknowns(options, target.finds_collective)
    good = np.flatnonzero(trim.converged)
    if free and len(good):
        step = _newton_step(sections, quantities, state, options, target, good, free)
        for place, name in enumerate(UNKNOWNS):
            state[name][good] -= step[:, place]
    return _result(sections, quantities, options, target, state, trim.reason.copy(), trim.iterations)


def _newton_step(sections, quantities, state, options, target, rows, free) -> NDArray:
    pool = with_trim(take(quantities, rows), options, {name: value[rows] for name, value in state.items()})
    here = replace(target, load=np.broadcast_to(target.load, state["coning"].shape)[rows])
    residual, jacobian, _ = _balance(sections.take(rows), pool, options.compressibility, here)
    balances = [target.row if place == _BALANCES - 1 else place for place in free]
    step = np.zeros((len(rows), len(UNKNOWNS)), dtype=np.result_type(residual, jacobian))
    square = jacobian[:, balances][:, :, free]
    try:
        step[:, free] = np.linalg.solve(square, residual[:, balances, None])[..., 0]
    except np.linalg.LinAlgError:  # at one point: its step is undefined, the others' are not
        good = np.isfinite(square).all(axis=(1, 2)) & (np.abs(np.linalg.det(square)) > 0)
        step[:, free] = np.nan
        step[np.ix_(good, free)] = np.linalg.solve(square[good], residual[good][:, balances, None])[..., 0]
    return step if np.iscomplexobj(step) else np.clip(step, -_LARGEST_STEP, _LARGEST_STEP)


def _before_trim(
    quantities: Mapping[str, Any], prandtl_glauert: bool, target: Target, points: int
) -> NDArray:
    """Reasons that are known before any iteration."""
    reason = np.full(points, "", dtype=object)
    airspeed = np.broadcast_to(quantities["airspeed"], (points,))
    reason[~np.isfinite(airspeed)] = "airspeed is not a finite number"
    reason[airspeed < 0] = "airspeed is negative: the model is for axial flight along +K"
    if target.finds_collective:
        vacuum = np.broadcast_to(quantities["density"], (points,)) == 0
        reason[vacuum & (reason == "")] = "no trim by airloads in a vacuum: give a collective"
    if prandtl_glauert:
        tip_speed = np.asarray(quantities["rotor_speed"]) * quantities["radius"]
        mach = np.broadcast_to(np.hypot(tip_speed, airspeed) / quantities["speed_of_sound"], (points,))
        for place in np.flatnonzero((reason == "") & (mach >= 1)):
            reason[place] = f"tip Mach number {mach[place]:.3f}: Prandtl-Glauert needs it below 1"
    return reason


def _failure(target: Target) -> str:
    if not target.finds_collective:
        return "no trim found: Newton did not converge"
    if target.row == _THRUST:
        return "no trim with this thrust coefficient found: Newton did not converge"
    name = "windmilling trim" if target.windmilling else "trim with this power coefficient"
    return (
        f"no {name} found: the torque has no such value near zero angle of attack, or Newton did not converge"
    )


def _result(sections, quantities, options, target, state, reason, iterations) -> Trim:
    if target.finds_collective:
        turned = np.abs(np.real(state["collective"] - _start(quantities, None, len(reason))["collective"]))
        reason[(reason == "") & ~(turned < _FARTHEST)] = _failure(target)
    for name in ("coning", "lag", "elastic_pitch"):
        reason[(reason == "") & ~(np.abs(state[name]) < np.pi / 2)] = (
            f"trim {name.replace('_', ' ')} beyond 90 deg"
        )
    good = np.flatnonzero(reason == "")
    kind = np.result_type(float, *state.values())
    values = {name: np.full(len(reason), np.nan, dtype=kind) for name in (*UNKNOWNS, "thrust", "torque")}
    warning = np.full(len(reason), "", dtype=object)
    for name in UNKNOWNS:
        values[name][good] = state[name][good]
    if len(good):
        pool = with_trim(take(quantities, good), options, {name: state[name][good] for name in UNKNOWNS})
        _, _, work = _balance(sections.take(good), pool, options.compressibility, Target())
        loads = work * np.asarray(pool["n_blades"])[..., None]
        values["torque"][good], values["thrust"][good] = loads[:, _TORQUE], loads[:, _THRUST]
        warning[good] = _warnings(sections.take(good), pool, loads[:, _THRUST], len(good))
    return Trim(**values, converged=reason == "", reason=reason, warning=warning, iterations=iterations)


def _warnings(sections: BladeSections, pool: Mapping[str, Any], thrust: NDArray, points: int) -> list[str]:
    """What makes each point doubtful: neglected induced velocity, and sections outside what the airfoil knows."""
    sections, thrust = sections.real, np.real(thrust)
    pool = {name: np.real(value) for name, value in pool.items()}
    notes: list[list[str]] = [[] for _ in range(points)]
    disk = 2 * pool["density"] * np.pi * np.square(pool["radius"]) * np.square(pool["airspeed"])
    airspeed = np.broadcast_to(pool["airspeed"], (points,))
    share = np.broadcast_to(np.abs(thrust) / np.where(disk > 0, disk, np.inf), (points,))
    for place in np.flatnonzero(share > _INDUCED_SHARE):
        notes[place].append(f"induced velocity, neglected, would be {share[place]:.0%} of the airspeed")
    for place in np.flatnonzero(
        (airspeed == 0) & (np.abs(thrust) > 0) & (np.broadcast_to(pool["density"], (points,)) > 0)
    ):
        notes[place].append("without airspeed the neglected induced velocity is all the inflow")
    if isinstance(sections.airfoil, Warns):
        air = air_at_stations(sections, segment_quantities(sections, pool))
        shape = (points, sections.quadrature.stations.shape[-1])
        outboard = sections.quadrature.stations >= _OUTBOARD * np.asarray(pool["radius"])[..., None]
        for text, mask in sections.airfoil.warnings(air["angle_of_attack"], air["mach"]).items():
            for place in np.flatnonzero((np.broadcast_to(mask, shape) & outboard).any(axis=1)):
                notes[place].append(f"{text} outboard of {_OUTBOARD:g} R")
    return ["; ".join(lines) for lines in notes]
