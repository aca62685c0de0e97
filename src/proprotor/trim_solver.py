"""Newton's method for the trim of all points at once; each point stops when it has converged.

Three stages, from cheap to exact. On a few stations Newton comes near the trim. From there steps with those slopes but
the residual of all stations come closer, at the cost of the steady loads alone. Last, Newton with everything: where its
first step is too small to matter it is taken and the point is done; its loads serve the equations of motion as well.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from proprotor_equations import airloads
from proprotor_equations import trim as equations

from proprotor.arrays import Array
from proprotor.blade_airloads import BladeSections, load_moments, segment_quantities
from proprotor.evaluation import evaluate
from proprotor.options import Options
from proprotor.trim import THRUST, TORQUE, UNKNOWNS, Target, Trim, take, with_trim

_LARGEST_STEP = 0.3  # rad; Newton starts far from a blade that has coned and lagged
_ITERATIONS = 40
# Of the collective from the direction of the air: a blade turned farther is another branch.
_FARTHEST = np.radians(60)
# rad, the last step: what the loads are off by. Convergence is quadratic, so the trim itself is exact to rounding.
_CONVERGED = 1e-13
# rad, a step that is no smaller than half of the one before: rounding has the last word, as where a spring is a hundred
# million times as stiff as what holds the blade otherwise.
_STALLED = 1e-9
_NEAR = 1e-3  # rad, the last step on a few stations; the next would be below their own error
_CLOSE_STEPS = 6
_ROUNDING = 1e-15  # rad, of the step that would follow
_INDUCED_SHARE = 0.05  # of the airspeed: above it the neglected induced velocity turns the inflow by degrees

State = dict[str, Array]
Found = tuple[
    Array, dict[str, Any], dict[str, Any], dict[str, Array]
]  # work, pool, segments and doubts of a step


@dataclass(frozen=True, eq=False)
class Settled:
    """A trim, and of its converged points the quantities and the loads along the blade.

    trim of all points; rows (n,) that converged; pool, quantities of the whole blade there; segments, those of each
    segment with the radial moments of the section loads.
    """

    trim: Trim
    rows: Array
    pool: dict[str, Any]
    segments: dict[str, Any]


@dataclass(frozen=True, eq=False)
class _Balance:
    """Balance of one blade at many points: inputs, and the unknowns that are free."""

    sections: BladeSections
    quantities: Mapping[str, Any]
    options: Options
    target: Target
    free: list[int]

    def pool(self, state: State, rows: Array) -> dict[str, Any]:
        """Quantities of the whole blade at a state."""
        there = {name: value[rows] for name, value in state.items()}
        return with_trim(take(self.quantities, rows), self.options, there)

    def loads(self, pool: Mapping[str, Any], rows: Array, **wanted: Any) -> dict[str, Any]:
        """Quantities of each segment and the radial moments of its loads."""
        sections = self.sections.take(rows)
        segments = segment_quantities(sections, pool)
        return segments | load_moments(
            sections, segments, compressibility=self.options.compressibility, **wanted
        )

    def residual(
        self, pool: Mapping[str, Any], segments: Mapping[str, Any], rows: Array
    ) -> tuple[Array, Array]:
        """Residual (n, 5) of balances and thrust, and the steady airloads in it."""
        motion = {
            "virtual_motion": evaluate(equations.virtual_motion, segments),
            "steady_loads": evaluate(airloads.steady_loads, segments),
        }
        work = evaluate(airloads.steady_work, motion)[..., 0]
        residual = evaluate(equations.residual, pool)[..., 0] - work
        load = np.asarray(self.target.load)
        residual[..., self.target.row] += load[rows] if load.ndim else load
        return residual, work

    def slopes(self, pool: Mapping[str, Any], segments: Mapping[str, Any]) -> tuple[Array, Array]:
        """Change (n, 5, k) of the balances with the free unknowns, and the airloads' part in it."""
        motion = {
            name: evaluate(getattr(equations, name), segments)
            for name in ("virtual_motion", "displacement_motion", "geometric_stiffness")
        }
        motion["load_derivatives"] = evaluate(airloads.load_derivatives, segments)
        of_airloads = evaluate(airloads.stiffness, motion)
        whole = evaluate(equations.jacobian, pool) + of_airloads
        return whole[..., self.free], of_airloads[..., self.free]

    @property
    def balances(self) -> list[int]:
        """Rows that close the free unknowns, in their order."""
        return [self.target.row if place == len(UNKNOWNS) - 1 else place for place in self.free]

    def newton(
        self, state: State, rows: Array, doubts: dict[str, Array] | None = None
    ) -> tuple[Array, Array, Array, dict[str, Any], dict[str, Any]]:
        """Newton's step (n, k), slopes (n, k, k), airloads (n, 5) after the step, quantities and segments before it."""
        pool = self.pool(state, rows)
        segments = self.loads(pool, rows, doubts=doubts)
        residual, work = self.residual(pool, segments, rows)
        slopes, of_airloads = self.slopes(pool, segments)
        slopes = slopes[:, self.balances]
        step = _step(slopes, residual[:, self.balances])
        return step, slopes, work + (of_airloads @ step[..., None])[..., 0], pool, segments


def solve_trim(
    sections: BladeSections,
    coarse: BladeSections,
    quantities: Mapping[str, Any],
    options: Options,
    target: Target,
    points: int,
) -> Settled:
    """Trim of all points.

    Parameters
    ----------
    sections, coarse : BladeSections
        All stations of the blade, and a few.
    quantities : mapping
        Numbers or arrays (points,) of rotor, operation and airspeed by name. Complex ones have small imaginary parts,
        for derivatives by a complex step: the trim is exact to first order in them.
    options : Options
    target : Target
        What closes the trim.
    points : int
        Number of points.
    """
    free = _free_unknowns(options, target.finds_collective)
    balance = _Balance(sections, quantities, options, target, free)
    with np.errstate(all="ignore"):
        if sections.is_complex or any(map(np.iscomplexobj, (*quantities.values(), *_numbers(target)))):
            return _complex_trim(balance, coarse, points)
        state, start = _start(balance, points), _start(balance, points)
        reason = _before_trim(balance, points)
        iterations = np.zeros(points, dtype=int)
        rows = np.flatnonzero(reason == "")
        if not free:
            return _settle(balance, state, state, reason, iterations)
        near, slopes = _come_near(replace(balance, sections=coarse), state, start, rows, iterations)
        _come_close(balance, state, start, near, slopes, iterations)
        before, last = _newton_steps(balance, state, rows, reason, iterations)
        return _settle(balance, state, before, reason, iterations, last)


def _come_near(
    balance: _Balance, state: State, start: State, rows: Array, iterations: Array
) -> tuple[Array, Array]:
    """Newton on few stations: the rows that came near their trim, and the slopes (rows, k, k) there."""
    k = len(balance.free)
    slopes = np.full((len(iterations), k, k), np.nan)
    active, near = rows, [np.empty(0, dtype=int)]
    for _ in range(_ITERATIONS // 2):
        if not len(active):
            break
        step, slopes[active], *_ = balance.newton(state, active)
        _take_step(balance, state, active, step)
        iterations[active] += 1
        finite, size = np.isfinite(step).all(axis=1), np.abs(step).max(axis=1)
        near.append(active[finite & (size <= _NEAR)])
        active = active[finite & (size > _NEAR)]
    arrived = np.sort(np.concatenate(near))
    _reset(state, start, np.setdiff1d(rows, arrived))
    return arrived, slopes[arrived]


def _come_close(
    balance: _Balance, state: State, start: State, rows: Array, slopes: Array, iterations: Array
) -> None:
    """Steps on the residual of all stations until by their rate the next would be lost in rounding.

    The slopes are those of few stations, and learn from each step what it showed (Broyden's rank-one update).
    """
    active, before = np.arange(len(rows)), np.full(slopes.shape[:2], np.nan)
    for count in range(_CLOSE_STEPS):
        if not len(active):
            break
        here = rows[active]
        pool = balance.pool(state, here)
        residual, _ = balance.residual(pool, balance.loads(pool, here, steady_only=True), here)
        left = residual[:, balance.balances]
        if count:
            last = before[active]
            slopes[active] -= left[:, :, None] * (last / np.sum(last**2, axis=1)[:, None])[:, None, :]
        step = _step(slopes[active], left)
        _take_step(balance, state, here, step)
        iterations[here] += 1
        size, last_size = np.abs(step).max(axis=1), np.abs(before[active]).max(axis=1)
        lost = ~np.isfinite(step).all(axis=1)
        _reset(state, start, here[lost])
        before[active] = step
        active = active[~lost & (np.fmin(size, size**2 / last_size) > _ROUNDING)]


def _newton_steps(
    balance: _Balance, state: State, rows: Array, reason: Array, iterations: Array
) -> tuple[State, Found | None]:
    """Newton with everything; the state before each point's last step, and if all made one step what came with it."""
    active, before = rows, {name: value.copy() for name, value in state.items()}
    size_before = np.full(len(iterations), np.inf)
    last: Found | None = None
    for count in range(_ITERATIONS):
        if not len(active):
            break
        doubts: dict[str, Array] = {}
        _reset(before, state, active)
        step, _, work, pool, segments = balance.newton(state, active, doubts)
        finite, size = np.isfinite(step).all(axis=1), np.abs(step).max(axis=1)
        stalled = (size <= _STALLED) & (size >= size_before[active] / 2)
        done = finite & ((size <= _CONVERGED) | stalled)
        size_before[active] = size
        if count == 0 and done.all():
            last = work, pool, segments, doubts
        _take_step(balance, state, active, step)
        iterations[active] += 1
        reason[active[~finite]] = _failure(balance.target)
        active = active[finite & ~done]
    reason[active] = _failure(balance.target)
    return before, last


def _settle(
    balance: _Balance,
    state: State,
    before: State,
    reason: Array,
    iterations: Array,
    last: Found | None = None,
) -> Settled:
    """The trim, with loads at the points that have one: those of the last step, made again where points dropped out."""
    beyond = _beyond_reach(balance, state, reason)
    rows = np.flatnonzero(reason == "")
    if not len(rows):
        last = np.zeros((0, THRUST + 1)), {"n_blades": 1}, {}, {}
    elif beyond.any() or last is None:
        told: dict[str, Array] = {}
        last = (*balance.newton(before, rows, told)[2:], told)
    work, pool, segments, doubts = last
    kind = np.result_type(float, *state.values())
    values = {name: np.full(len(reason), np.nan, dtype=kind) for name in (*UNKNOWNS, "thrust", "torque")}
    for name in UNKNOWNS:
        values[name][rows] = state[name][rows]
    loads = work * np.asarray(pool["n_blades"])[..., None]
    values["torque"][rows], values["thrust"][rows] = loads[:, TORQUE], loads[:, THRUST]
    warning = np.full(len(reason), "", dtype=object)
    if len(rows):
        warning[rows] = _warnings(pool, loads[:, THRUST], doubts, len(rows))
    trim = Trim(**values, converged=reason == "", reason=reason, warning=warning, iterations=iterations)
    return Settled(trim, rows, pool, segments)


def _complex_trim(balance: _Balance, coarse: BladeSections, points: int) -> Settled:
    """The trim of the real parts, and from there one Newton step: exact to first order in the imaginary parts."""
    target = balance.target
    real_target = replace(
        target,
        collective=None if target.collective is None else np.real(target.collective),
        load=np.real(target.load),
    )
    real = {name: np.real(value) for name, value in balance.quantities.items()}
    trim = solve_trim(balance.sections.real, coarse.real, real, balance.options, real_target, points).trim
    state = {name: getattr(trim, name).astype(complex) for name in UNKNOWNS}
    if target.collective is not None:
        state["collective"] = state["collective"] + 1j * np.imag(target.collective)
    rows = np.flatnonzero(trim.converged)
    if balance.free and len(rows):
        step, *_ = balance.newton(state, rows)
        _take_step(balance, state, rows, step)
    return _settle(balance, state, state, trim.reason.copy(), trim.iterations)


def _numbers(target: Target) -> tuple[Any, Any]:
    return target.collective, target.load


def _start(balance: _Balance, points: int) -> State:
    """First guess: an undeflected blade whose section at 0.75 R meets the air at no angle."""
    state = {name: np.zeros(points) for name in UNKNOWNS}
    given = balance.target.collective
    state["collective"] = state["collective"] + (_air_direction(balance) if given is None else given)
    return state


def _air_direction(balance: _Balance) -> Array:
    """Direction of the air at 0.75 R, rad."""
    airspeed, rotor_speed, radius = (
        np.real(balance.quantities[name]) for name in ("airspeed", "rotor_speed", "radius")
    )
    direction: Array = np.arctan2(airspeed, 0.75 * rotor_speed * radius)
    return direction


def _free_unknowns(options: Options, finds_collective: bool) -> list[int]:
    """Places of the unknowns that are solved for; the others stay where they are."""
    free = {
        "coning": "flap" not in options.locked,
        "lag": "lag" not in options.locked,
        "elastic_pitch": options.pitch_is_free,
        "collective": finds_collective,
    }
    return [place for place, name in enumerate(UNKNOWNS) if free[name]]


def _step(slopes: Array, residual: Array) -> Array:
    """Step (n, k) to take off the unknowns; NaN where the slopes have no inverse."""
    try:
        step = np.linalg.solve(slopes, residual[..., None])[..., 0]
    except np.linalg.LinAlgError:  # at one point: its step is undefined, the others' are not
        good = np.isfinite(slopes).all(axis=(1, 2)) & (np.abs(np.linalg.det(slopes)) > 0)
        step = np.full(residual.shape, np.nan, dtype=residual.dtype)
        step[good] = np.linalg.solve(slopes[good], residual[good][..., None])[..., 0]
    return step if np.iscomplexobj(step) else np.clip(step, -_LARGEST_STEP, _LARGEST_STEP)


def _take_step(balance: _Balance, state: State, rows: Array, step: Array) -> None:
    for column, place in enumerate(balance.free):
        state[UNKNOWNS[place]][rows] -= step[:, column]


def _reset(state: State, start: State, rows: Array) -> None:
    for name in UNKNOWNS:
        state[name][rows] = start[name][rows]


def _before_trim(balance: _Balance, points: int) -> Array:
    """Reasons that are known before any iteration."""
    quantities, options = balance.quantities, balance.options
    reason = np.full(points, "", dtype=object)
    airspeed = np.broadcast_to(quantities["airspeed"], (points,))
    reason[~np.isfinite(airspeed)] = "airspeed is not a finite number"
    reason[airspeed < 0] = "airspeed is negative: the model is for axial flight along +K"
    if balance.target.finds_collective:
        vacuum = np.broadcast_to(quantities["density"], (points,)) == 0
        reason[vacuum & (reason == "")] = "no trim by airloads in a vacuum: give a collective"
    if options.compressibility and not balance.sections.airfoil.contains_compressibility:
        tip_speed = np.asarray(quantities["rotor_speed"]) * quantities["radius"]
        mach = np.broadcast_to(np.hypot(tip_speed, airspeed) / quantities["speed_of_sound"], (points,))
        for place in np.flatnonzero((reason == "") & (mach >= 1)):
            reason[place] = f"tip Mach number {mach[place]:.3f}: Prandtl-Glauert needs it below 1"
    return reason


def _failure(target: Target) -> str:
    if not target.finds_collective:
        return "no trim found: Newton did not converge"
    if target.row == THRUST:
        return "no trim with this thrust coefficient found: Newton did not converge"
    name = "windmilling trim" if target.windmilling else "trim with this power coefficient"
    return (
        f"no {name} found: the torque has no such value near zero angle of attack, or Newton did not converge"
    )


def _beyond_reach(balance: _Balance, state: State, reason: Array) -> Array:
    """Give the points whose trim is on another branch, or beyond what angles mean, their reason; which they are."""
    before = reason == ""
    if balance.target.finds_collective:
        turned = np.abs(np.real(state["collective"]) - _air_direction(balance))
        reason[(reason == "") & ~(turned < _FARTHEST)] = _failure(balance.target)
    for name in ("coning", "lag", "elastic_pitch"):
        reason[(reason == "") & ~(np.abs(state[name]) < np.pi / 2)] = (
            f"trim {name.replace('_', ' ')} beyond 90 deg"
        )
    dropped: Array = before & (reason != "")
    return dropped


def _warnings(pool: Mapping[str, Any], thrust: Array, doubts: Mapping[str, Array], points: int) -> Array:
    """What makes each point doubtful: neglected induced velocity, and sections outside what the airfoil knows."""
    airspeed, density, radius = (np.real(pool[name]) for name in ("airspeed", "density", "radius"))
    thrust = np.abs(np.real(thrust))
    disk = 2 * density * np.pi * radius**2 * airspeed**2
    share = np.broadcast_to(thrust / np.where(disk > 0, disk, np.inf), (points,))
    still = np.broadcast_to((airspeed == 0) & (density > 0), (points,)) & (thrust > 0)
    doubtful = np.logical_or.reduce([share > _INDUCED_SHARE, still, *doubts.values()])
    warnings = np.full(points, "", dtype=object)
    for place in np.flatnonzero(doubtful):
        notes = []
        if share[place] > _INDUCED_SHARE:
            notes.append(f"induced velocity, neglected, would be {share[place]:.0%} of the airspeed")
        if still[place]:
            notes.append("without airspeed the neglected induced velocity is all the inflow")
        notes += [text for text, mask in doubts.items() if mask[place]]
        warnings[place] = "; ".join(notes)
    return warnings
