"""Newton's method for the trim of all points at once; each point stops when it has converged.

Three stages, from cheap to exact. On a few stations Newton comes near the trim, and `trim_path` tells whether that is
the one connected with the undeflected blade, or follows the path to it. From there steps with those slopes but the
residual of all stations come closer, at the cost of the steady loads alone. Last, Newton with everything: where its
first step is too small to matter it is taken and the point is done; its loads serve the equations of motion as well.
Points whose path is lost on few stations are followed on all of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from proprotor.rotor.options import Options
from proprotor.rotor.section_loads import BladeSections
from proprotor.rotor.trim import THRUST, TORQUE, UNKNOWNS, Target, Trim
from proprotor.rotor.trim_balance import Balance, Linear, Slopes, State, copy_state, newton_step, solve
from proprotor.rotor.trim_path import FARTHEST, Followed, at_end, follow, near_each_other
from proprotor.typing import Array

_ITERATIONS = 40
# rad, the last step: what the loads are off by. Convergence is quadratic, so the trim itself is exact to rounding.
_CONVERGED = 1e-13
# rad, a step that is no smaller than half of the one before: rounding has the last word, as where a spring is a hundred
# million times as stiff as what holds the blade otherwise.
_STALLED = 1e-9
_NEAR = 1e-3  # rad, the last step on a few stations; the next would be below their own error
_CLOSE_STEPS = 6
_ROUNDING = 1e-15  # rad, of the step that would follow
_INDUCED_SHARE = 0.05  # of the airspeed: above it the neglected induced velocity turns the inflow by degrees
_NO_SPRING = 1e-90  # of the other spring, or N m/rad
_LARGEST_ANGLE = np.radians(20)  # of a blade that rigid hinges stand for
_QUADRATURE = 1e-10  # error of the loads and their slopes, in themselves

Found = tuple[Array, Linear, dict[str, Array]]  # work after a step, balance before it, doubts of the airfoil


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
    balance = Balance(sections, quantities, options, target, free)
    with np.errstate(all="ignore"):
        if sections.is_complex or any(map(np.iscomplexobj, (*quantities.values(), *_numbers(target)))):
            return _complex_trim(balance, coarse, points)
        search = _Search.of(balance, points)
        if free:
            search.come_near(replace(balance, sections=coarse))
            search.come_close()
            search.finish()
        return _settle(balance, search.state, search.before, search.reason, search.iterations, search.last)


@dataclass(eq=False)
class _Search:
    """Where the search for the trims stands, arrays of all points.

    start, state, before : unknowns where it began, where it is, and before the last step.
    followed : which points have a path; others trim to what Newton finds from the undeflected blade at all loads.
    ends : slopes at the end of the path, NaN where it is not yet known.
    last : what came with the last step, where all points had one step in common.
    """

    balance: Balance
    start: State
    state: State
    before: State
    followed: Array
    ends: Slopes
    reason: Array
    iterations: Array
    last: Found | None = None

    @classmethod
    def of(cls, balance: Balance, points: int) -> _Search:
        """Nothing found yet."""
        k = len(balance.free)
        start, state, before = (_start(balance, points) for _ in range(3))
        followed = ~_unheld(balance, points)
        ends = Slopes.unknown(points, k)
        reason, iterations = _before_trim(balance, points), np.zeros(points, dtype=int)
        return cls(balance, start, state, before, followed, ends, reason, iterations)

    @property
    def rows(self) -> Array:
        """Points that have not failed."""
        return np.flatnonzero(self.reason == "")

    @property
    def near(self) -> Array:
        """Of these, the points that have come to the end of their path on few stations."""
        known = np.isfinite(self.ends.full).all(axis=(1, 2))
        return np.flatnonzero((self.reason == "") & known)

    def come_near(self, few: Balance) -> None:
        """Newton on few stations, all loads at once; points whose trim may be another one are led along the path."""
        rows, k = self.rows, len(few.free)
        first, last = (Slopes.unknown(len(self.reason), k) for _ in range(2))
        active, near = rows, [np.empty(0, dtype=int)]
        for count in range(_ITERATIONS // 2):
            if not len(active):
                break
            step, here = _newton(few, self.state, active) if count else _first_step(few, self.state, active)
            last.put(active, here.slopes)
            if count == 0:
                first.put(active, here.slopes)
            few.take_step(self.state, active, step)
            self.iterations[active] += 1
            finite, size = np.isfinite(step).all(axis=1), np.abs(step).max(axis=1)
            near.append(active[finite & (size <= _NEAR)])
            active = active[finite & (size > _NEAR)]
        arrived = np.sort(np.concatenate(near))
        copy_state(self.start, np.setdiff1d(rows, arrived), onto=self.state)
        known = ~self.followed[arrived]
        known |= at_end(few, first.of(arrived), last.of(arrived), self.start, self.state, arrived)
        self.ends.put(arrived[known], last.of(arrived[known]))
        self._follow(few, np.setdiff1d(rows[self.followed[rows]], arrived[known]))

    def _follow(self, balance: Balance, rows: Array) -> Followed:
        """Lead points along their path; where it ends before all of the loads, they are at their start again."""
        copy_state(self.start, rows, onto=self.state)
        found = follow(balance, self.state, rows, self.iterations)
        arrived = np.flatnonzero(found.arrived)
        self.ends.put(rows, Slopes.unknown(len(rows), len(balance.free)))
        self.ends.put(rows[arrived], found.slopes.of(arrived))
        copy_state(self.start, rows[~found.arrived], onto=self.state)
        return found

    def come_close(self) -> None:
        """Steps on the residual of all stations until by their rate the next would be lost in rounding.

        The slopes are those of few stations, and learn from each step what it showed (Broyden's rank-one update).
        """
        rows = self.near
        slopes = self.ends.full[rows]
        active, before = np.arange(len(rows)), np.full(slopes.shape[:2], np.nan)
        for count in range(_CLOSE_STEPS):
            if not len(active):
                break
            here = rows[active]
            left = self.balance.left(self.state, here)
            if count:
                last = before[active]
                slopes[active] -= left[:, :, None] * (last / np.sum(last**2, axis=1)[:, None])[:, None, :]
            step = newton_step(slopes[active], left)
            self.balance.take_step(self.state, here, step)
            self.iterations[here] += 1
            size, last_size = np.abs(step).max(axis=1), np.abs(before[active]).max(axis=1)
            lost = ~np.isfinite(step).all(axis=1)
            copy_state(self.start, here[lost], onto=self.state)
            before[active] = step
            active = active[~lost & (np.fmin(size, size**2 / last_size) > _ROUNDING)]

    def finish(self) -> None:
        """Newton with everything; points that it leads away from their path's end begin again, on all stations."""
        begun = self.near
        own = np.setdiff1d(self.rows[~self.followed[self.rows]], begun)  # without a path, and not come near
        done = self._newton_steps(np.union1d(begun, own))
        self.reason[self.rows[~self.followed[self.rows] & ~done[self.rows]]] = _failure(self.balance.target)
        again = np.flatnonzero((self.reason == "") & self.followed & ~done)
        if not len(again):
            return
        found = self._follow(self.balance, again)
        self.reason[again] = _ended(found, self.balance.target)
        arrived = again[found.arrived]
        done = self._newton_steps(arrived)
        self.last = None  # of some points alone
        self.reason[arrived[~done[arrived]]] = (
            "the trim at the end of the path from the undeflected blade was lost: Newton did not stay near it"
        )

    def _newton_steps(self, rows: Array) -> Array:
        """Newton with everything; which points converged, and those that have a path near its end."""
        active, done = rows, np.zeros(len(self.reason), dtype=bool)
        size_before = np.full(len(self.reason), np.inf)
        found = Slopes.unknown(len(self.reason), len(self.balance.free))
        for count in range(_ITERATIONS):
            if not len(active):
                break
            doubts: dict[str, Array] = {}
            copy_state(self.state, active, onto=self.before)
            step, here = _newton(self.balance, self.state, active, doubts)
            found.put(active, here.slopes)
            finite, size = np.isfinite(step).all(axis=1), np.abs(step).max(axis=1)
            stalled = (size <= _STALLED) & (size >= size_before[active] / 2)
            small = finite & ((size <= _CONVERGED) | stalled)
            size_before[active] = size
            if count == 0 and small.all():
                self.last = _after(here, step), here, doubts
            self.balance.take_step(self.state, active, step)
            self.iterations[active] += 1
            done[active] = small
            active = active[finite & ~small]
        near = near_each_other(self.balance.sprung, found.of(rows), self.ends.of(rows))
        done[rows] &= ~self.followed[rows] | near
        return done


def _newton(
    balance: Balance, state: State, rows: Array, doubts: dict[str, Array] | None = None
) -> tuple[Array, Linear]:
    """Newton's step (n, k) at all of the loads, and the balance before it."""
    here = balance.near(state, rows, doubts=doubts)
    return newton_step(here.slopes.full, here.residual), here


def _first_step(balance: Balance, state: State, rows: Array) -> tuple[Array, Linear]:
    """Newton's step (n, k) from the undeflected blade to all of the loads, and the balance where the path begins."""
    here = balance.near(state, rows, share=0.0)
    return newton_step(here.slopes.full, here.residual + balance.precone_load(rows)), here


def _after(here: Linear, step: Array) -> Array:
    """Virtual work (n, 5) of the airloads after a step."""
    work: Array = here.work + (here.work_slopes @ step[..., None])[..., 0]
    return work


def _ended(found: Followed, target: Target) -> Array:
    """Why the path of each point (n,) ended before all of the loads; empty where it did not."""
    reason = np.full(len(found.share), "", dtype=object)
    for place in np.flatnonzero(~found.arrived):
        at = f"at {np.floor(1000 * found.share[place]) / 10:.1f} % of airloads and precone's load"
        told = f"turns back {at}: no trim belongs to it" if found.turned[place] else f"was lost {at}"
        reason[place] = (
            f"the path from the undeflected blade {told}" if found.rigid[place] else _failure(target)
        )
    return reason


def _settle(
    balance: Balance, state: State, before: State, reason: Array, iterations: Array, last: Found | None = None
) -> Settled:
    """The trim, with loads at the points that have one: those of the last step, made again where points dropped out."""
    beyond = _beyond_reach(balance, state, reason)
    rows = np.flatnonzero(reason == "")
    kind = np.result_type(float, *state.values())
    values = {name: np.full(len(reason), np.nan, dtype=kind) for name in (*UNKNOWNS, "thrust", "torque")}
    warning = np.full(len(reason), "", dtype=object)
    pool: dict[str, Any] = {}
    segments: dict[str, Any] = {}
    if len(rows):
        if beyond.any() or last is None:
            told: dict[str, Array] = {}
            step, again = _newton(balance, before, rows, told)
            last = _after(again, step), again, told
        work, here, doubts = last
        pool, segments = here.pool, here.segments
        for name in UNKNOWNS:
            values[name][rows] = state[name][rows]
        loads = work * np.asarray(pool["n_blades"])[..., None]
        values["torque"][rows], values["thrust"][rows] = loads[:, TORQUE], loads[:, THRUST]
        warning[rows] = _warnings(balance, here, loads[:, THRUST], doubts)
    trim = Trim(**values, converged=reason == "", reason=reason, warning=warning, iterations=iterations)
    return Settled(trim, rows, pool, segments)


def _complex_trim(balance: Balance, coarse: BladeSections, points: int) -> Settled:
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
        step, _ = _newton(balance, state, rows)
        balance.take_step(state, rows, step)
    return _settle(balance, state, state, trim.reason.copy(), trim.iterations)


def _numbers(target: Target) -> tuple[Any, Any]:
    return target.collective, target.load


def _start(balance: Balance, points: int) -> State:
    """First guess: an undeflected blade whose section at 0.75 R meets the air at no angle."""
    state = {name: np.zeros(points) for name in UNKNOWNS}
    given = balance.target.collective
    state["collective"] = state["collective"] + (balance.air_direction(points) if given is None else given)
    return state


def _free_unknowns(options: Options, finds_collective: bool) -> list[int]:
    """Places of the unknowns that are solved for; the others stay where they are."""
    free = {
        "coning": "flap" not in options.locked,
        "lag": "lag" not in options.locked,
        "elastic_pitch": options.pitch_is_free,
        "collective": finds_collective,
    }
    return [place for place, name in enumerate(UNKNOWNS) if free[name]]


def _unheld(balance: Balance, points: int) -> Array:
    """Which points (points,) have a lag hinge at the centre without a spring: without airloads nothing holds it."""
    quantities, options = balance.quantities, balance.options
    if "lag" in options.locked or options.frequencies is not None:
        return np.zeros(points, dtype=bool)
    arm = np.real(quantities["lag_hinge_offset"]) * np.real(quantities["lag_first_moment"])
    limp = np.real(quantities["lag_stiffness"]) <= _NO_SPRING * np.maximum(
        np.real(quantities["flap_stiffness"]), 1
    )
    return np.broadcast_to(limp & (arm == 0), (points,))


def _before_trim(balance: Balance, points: int) -> Array:
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


def _beyond_reach(balance: Balance, state: State, reason: Array) -> Array:
    """Give the points whose trim is on another branch, or beyond what angles mean, their reason; which they are."""
    before = reason == ""
    if balance.target.finds_collective:
        turned = np.abs(np.real(state["collective"]) - balance.air_direction(len(reason)))
        reason[(reason == "") & ~(turned < FARTHEST)] = _failure(balance.target)
    for name in ("coning", "lag", "elastic_pitch"):
        reason[(reason == "") & ~(np.abs(state[name]) < np.pi / 2)] = (
            f"trim {name.replace('_', ' ')} beyond 90 deg"
        )
    dropped: Array = before & (reason != "")
    return dropped


def _warnings(balance: Balance, here: Linear, thrust: Array, doubts: Mapping[str, Array]) -> Array:
    """What makes each point (n,) doubtful.

    Neglected induced velocity, blades that diverge or are deflected far, sections outside what the airfoil knows.
    """
    points = len(thrust)
    airspeed, density, radius = (np.real(here.pool[name]) for name in ("airspeed", "density", "radius"))
    thrust = np.abs(np.real(thrust))
    disk = 2 * density * np.pi * radius**2 * airspeed**2
    share = np.broadcast_to(thrust / np.where(disk > 0, disk, np.inf), (points,))
    still = np.broadcast_to((airspeed == 0) & (density > 0), (points,)) & (thrust > 0)
    blades = _doubtful_blades(balance, here)
    doubtful = np.logical_or.reduce([share > _INDUCED_SHARE, still, *blades.values(), *doubts.values()])
    warnings = np.full(points, "", dtype=object)
    for place in np.flatnonzero(doubtful):
        notes = []
        if share[place] > _INDUCED_SHARE:
            notes.append(f"induced velocity, neglected, would be {share[place]:.0%} of the airspeed")
        if still[place]:
            notes.append("without airspeed the neglected induced velocity is all the inflow")
        notes += [text for masks in (blades, doubts) for text, mask in masks.items() if mask[place]]
        warnings[place] = "; ".join(notes)
    return warnings


def _doubtful_blades(balance: Balance, here: Linear) -> dict[str, Array]:
    """Where blades diverge or are deflected farther than rigid hinges are a model for, masks (n,) by reason."""
    hinged = np.flatnonzero(balance.hinged)
    stiffness = np.real(here.slopes.full)[:, hinged][:, :, hinged]
    told = "the rotor diverges: its blades' stiffness with airloads has a negative real eigenvalue"
    found = {told: _diverges(stiffness)}
    for name in ("coning", "lag", "elastic_pitch"):
        angle = np.broadcast_to(np.abs(np.real(here.pool[name])), len(stiffness))
        limit = f"{np.degrees(_LARGEST_ANGLE):.0f} deg"
        text = f"{name.replace('_', ' ')} beyond {limit}, where rigid hinges are no model"
        found[text] = angle > _LARGEST_ANGLE
    return found


def _diverges(stiffness: Array) -> Array:
    """Which matrices (n, k, k) have a real eigenvalue below zero by more than its error.

    Where the sums of its principal minors are all positive a matrix (k up to 3) has none; those of the others are
    computed. The error is that of the entries, each known to the quadrature's error in itself, times the condition of
    the eigenvalue.
    """
    k = stiffness.shape[-1]
    found = np.zeros(len(stiffness), dtype=bool)
    trace = np.trace(stiffness, axis1=1, axis2=2)
    minors = (trace**2 - (stiffness * stiffness.swapaxes(1, 2)).sum(axis=(1, 2))) / 2
    sums = [trace, minors, np.linalg.det(stiffness)][:k]  # the last of k is the determinant
    suspect = np.flatnonzero(~np.logical_and.reduce([part > 0 for part in sums]))
    if not k or not len(suspect):
        return found
    matrix = stiffness[suspect]
    values, right = np.linalg.eig(matrix)
    left = solve(right, np.broadcast_to(np.eye(k), right.shape))
    error = _QUADRATURE * np.einsum("nij,njk,nki->ni", np.abs(left), np.abs(matrix), np.abs(right))
    real = np.abs(values.imag) <= error
    found[suspect] = (real & (values.real < -error)).any(axis=-1)
    return found
