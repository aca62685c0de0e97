"""Newton's method for the trim of all points at once; each point stops when it has converged.

The search has two stages:

1. Newton comes near the trim. `trim_bound` shows whether this trim is connected with the undeflected blade; if the
   bound does not show it, `trim_path` leads the point along its path. Blades with many stations do so on a few.
2. Newton on all stations: a point whose first step is too small to matter takes this step and is done. The loads of
   that step serve the equations of motion as well.

Points whose path is lost in the first stage are followed on all stations.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from proprotor.compiled.plans import Searched
from proprotor.rotor import trim_compiled
from proprotor.rotor.fused_balance import segments_of
from proprotor.rotor.in_flight import find_in_flight, rotors_of, serves_in_flight
from proprotor.rotor.options import Options
from proprotor.rotor.section_loads import BladeSections, mark_doubts
from proprotor.rotor.trim import THRUST, TORQUE, UNKNOWNS, Target, Trim, has_offset_mass, take
from proprotor.rotor.trim_balance import (
    Balance,
    Linear,
    Slopes,
    State,
    copy_state,
    is_complex,
    is_last,
    newton_step,
)
from proprotor.rotor.trim_bound import at_end, near_each_other
from proprotor.rotor.trim_of_one import Found, trim_of_one
from proprotor.rotor.trim_path import Path, follow
from proprotor.rotor.trim_reasons import LOST, before_trim, beyond_reach, not_found, path_ended, warnings
from proprotor.rotor.trim_start import first_guess, held
from proprotor.typing import Array

_ITERATIONS = 40
_NEAR = 1e-3  # rad, the last step on a few stations; the next would be below the error of these stations
_SIDES = ("beyond_flap_hinge", "beyond_lag_hinge")  # of all points alike
_ALMOST = 1e-10  # rad, of the step that would follow: the slopes are those of the trim


class _Loads(NamedTuple):
    """Loads of a step at n points.

    work : virtual work (n, 5) after the step.
    before : balance before the step.
    segments : quantities of each segment before the step, with the radial moments of the section loads.
    doubts : masks (n,) of the airfoil by reason.
    """

    work: Array
    before: Linear
    segments: dict[str, Any]
    doubts: dict[str, Array]

    @classmethod
    def of(cls, here: Linear, step: Array, doubts: dict[str, Array]) -> _Loads:
        """Return the loads of a step from the balance before it."""
        work = here.work + (here.work_slopes @ step[..., None])[..., 0]
        return cls(work, here, here.along(), doubts)

    @classmethod
    def compiled(cls, balance: Balance, before: State, rows: Array, found: Searched) -> _Loads:
        """Return the loads of the last step of some points by the compiled functions."""
        quantities, sections = balance.at(before, rows), balance.sections_at(rows)
        along = functools.partial(segments_of, balance.plans, found.moments[..., rows], sections)
        none = np.zeros((len(rows), 0))
        here = Linear(none, Slopes(*found.last).of(rows), found.work[rows], none, quantities, along)
        doubts: dict[str, Array] = {}
        air = (found.doubts[0, rows], found.doubts[1, rows])
        mark_doubts(doubts, sections, quantities["radius"], air, slice(0, len(rows)), len(rows))
        return cls(here.work, here, here.along(), doubts)

    def put(self, places: Array, others: _Loads, inputs: Mapping[str, Any]) -> None:
        """Set the loads of some of the points to those of a later step; inputs are the same before each step."""
        self.work[places] = others.work
        for name in ("residual", "work", "work_slopes"):
            getattr(self.before, name)[places] = getattr(others.before, name)
        self.before.slopes.put(places, others.before.slopes)
        found = {name: value for name, value in others.before.quantities.items() if name not in inputs}
        for mine, values in ((self.before.quantities, found), (self.segments, others.segments)):
            for name, value in values.items():
                own = mine[name]
                if np.ndim(own) and len(own) == len(self.work) and name not in _SIDES:
                    own[places] = value
        for text in {**self.doubts, **others.doubts}:
            mask = self.doubts.setdefault(text, np.zeros(len(self.work), dtype=bool))
            mask[places] = others.doubts.get(text, False)


@dataclass(frozen=True, eq=False)
class Settled:
    """A trim with the quantities and the loads along the blade at its converged points.

    trim : of all points.
    rows : places (n,) of the converged points.
    quantities : quantities of the whole blade at these points.
    segments : quantities of each segment at these points, with the radial moments of the section loads.
    """

    trim: Trim
    rows: Array
    quantities: dict[str, Any]
    segments: dict[str, Any]


def solve_trim(
    sections: BladeSections,
    few: BladeSections,
    quantities: Mapping[str, Any],
    options: Options,
    target: Target,
    points: int,
    one: bool = False,
) -> Settled:
    """Return the trim of all points.

    Parameters
    ----------
    sections, few : BladeSections
        All stations of the blade, and a few stations on which the search begins; the same object if all are few.
    quantities : mapping
        Numbers or arrays (points,) of rotor, operation and airspeed by name. Complex numbers have small imaginary
        parts, for derivatives by a complex step: the trim is exact to first order in these parts.
    options : Options
    target : Target
        The condition that closes the trim.
    points : int
        Number of points.
    one : bool
        Compute the only point with plain numbers where this is possible.
    """
    balance = balance_of(sections, quantities, options, target, points)
    numbers = (*quantities.values(), target.collective, target.load)
    with np.errstate(all="ignore"):
        if sections.is_complex or any(map(is_complex, numbers)):
            return _complex_trim(balance, few, points)
        if one and balance.free and balance.fused and few is sections and not has_offset_mass(quantities):
            found = trim_of_one(balance)
            if found is not None:
                return _settled(balance, found)
        search = _Search.of(balance, points)
        if balance.free:
            search.come_near(balance if few is sections else replace(balance, sections=few))
            search.finish()
        return _settle(balance, search.state, search.before, search.reason, search.iterations, search.last)


def settle_trim(
    sections: BladeSections,
    quantities: Mapping[str, Any],
    options: Options,
    target: Target,
    begun: tuple[State, State, Array],
) -> Settled:
    """Return the trim of points whose unknowns are known, and what is to be said of it, see `solve_trim`.

    Parameters
    ----------
    begun : (State, State, array (points,))
        The unknowns at the trim and before the last step, and the number of steps.
    """
    state, before, iterations = begun
    points = len(iterations)
    balance = balance_of(sections, quantities, options, target, points)
    with np.errstate(all="ignore"):
        return _settle(balance, state, before, np.full(points, "", dtype=object), iterations)


def balance_of(
    sections: BladeSections, quantities: Mapping[str, Any], options: Options, target: Target, points: int
) -> Balance:
    """Return the balance of a blade at all points, see `solve_trim`."""
    free = _free_unknowns(options, target.finds_collective)
    return Balance(sections, quantities, options, target, free, points)


@dataclass(eq=False)
class _Search:
    """State of the search for the trims, arrays of all points.

    start, state, before : unknowns at the start of the search, now, and before the last step.
    followed : which points have a path; the others trim to what Newton finds from the undeflected blade at all loads.
    ends : slopes at the end of the path, NaN until they are known.
    last : loads of the last step, if all points had one step in common.
    """

    balance: Balance
    start: State
    state: State
    before: State
    followed: Array
    ends: Slopes
    reason: Array
    iterations: Array
    last: _Loads | None = None

    @classmethod
    def of(cls, balance: Balance, points: int) -> _Search:
        """Return a search at its start."""
        start, state, before = (first_guess(balance, points) for _ in range(3))
        ends = Slopes.unknown(points, len(balance.free))
        reason, iterations = before_trim(balance, points), np.zeros(points, dtype=int)
        return cls(balance, start, state, before, held(balance, points), ends, reason, iterations)

    @property
    def rows(self) -> Array:
        """Points that have not failed."""
        return np.flatnonzero(self.reason == "")

    def come_near(self, few: Balance) -> None:
        """Run Newton with all loads at once, and follow the path of points that may have missed it."""
        rows = self.rows
        near, first, last = (
            self._compiled_near(few, rows) if trim_compiled.serves(few) else self._near(few, rows)
        )
        arrived = np.flatnonzero(near)
        copy_state(self.start, rows[~near[rows]], onto=self.state)
        known = ~self.followed[arrived]
        known |= at_end(few, first.of(arrived), last.of(arrived), self.start, self.state, arrived)
        self.ends.put(arrived[known], last.of(arrived[known]))
        near[arrived] = known
        lost = rows[self.followed[rows] & ~near[rows]]
        if len(lost):
            self._follow(few, lost)

    def _near(self, few: Balance, rows: Array) -> tuple[Array, Slopes, Slopes]:
        """Return which points came near a trim, and the slopes of all points at the first and the last step."""
        k = len(few.free)
        first, last = (Slopes.unknown(len(self.reason), k) for _ in range(2))
        active, near = rows, np.zeros(len(self.reason), dtype=bool)
        before = np.full(len(self.reason), np.inf)
        for count in range(_ITERATIONS // 2):
            if not len(active):
                break
            step, here = _newton(few, self.state, active) if count else _first_step(few, self.state, active)
            last.put(active, here.slopes)
            if count == 0:
                first.put(active, here.slopes)
            few.take_step(self.state, active, step)
            self.iterations[active] += 1
            size = np.abs(step).max(axis=1)
            arrived = size <= _NEAR
            if few is self.balance:
                arrived &= is_last(size, before[active]) | (_next(size, before[active]) <= _ALMOST)
            before[active] = size
            near[active] = arrived
            active = active[~arrived & ~np.isnan(size)]
        return near, first, last

    def _compiled_near(self, few: Balance, rows: Array) -> tuple[Array, Slopes, Slopes]:
        """Return the same by the compiled functions."""
        found = trim_compiled.searched(
            few, self.state, rows, self.iterations, _ITERATIONS // 2, come_near=True
        )
        return found.arrived, Slopes(*found.first), Slopes(*found.last)

    def _follow(self, balance: Balance, rows: Array) -> Path:
        """Lead points along their path; points whose path ends before all of the loads go back to their start."""
        copy_state(self.start, rows, onto=self.state)
        path = follow(balance, self.state, rows, self.iterations)
        arrived = np.flatnonzero(path.arrived)
        self.ends.put(rows, Slopes.unknown(len(rows), len(balance.free)))
        self.ends.put(rows[arrived], path.slopes.of(arrived))
        copy_state(self.start, rows[~path.arrived], onto=self.state)
        return path

    def finish(self) -> None:
        """Run full Newton; points that leave the end of their path begin again, on all stations."""
        near = np.isfinite(self.ends.full).all(axis=(1, 2))
        done = self._newton_steps(np.flatnonzero((self.reason == "") & (near | ~self.followed)))
        self.reason[(self.reason == "") & ~self.followed & ~done] = not_found(self.balance.target)
        again = np.flatnonzero((self.reason == "") & self.followed & ~done)
        if not len(again):
            return
        path = self._follow(self.balance, again)
        self.reason[again] = path_ended(path)
        arrived = again[path.arrived]
        done = self._newton_steps(arrived)
        self.last = None  # the loads are of some points alone
        self.reason[arrived[~done[arrived]]] = LOST

    def _newton_steps(self, rows: Array) -> Array:
        """Run full Newton and return which points converged; points with a path must converge near its end."""
        steps = self._compiled_steps if trim_compiled.serves(self.balance) else self._steps
        done, found, loads = steps(rows)
        near = near_each_other(self.balance, found.of(rows), self.ends.of(rows))
        done[rows] &= ~self.followed[rows] | near
        self.last = loads if done[rows].all() else None
        return done

    def _steps(self, rows: Array) -> tuple[Array, Slopes, _Loads | None]:
        """Return which points converged, the slopes of all points at the last step, and its loads."""
        active, done = rows, np.zeros(len(self.reason), dtype=bool)
        size_before = np.full(len(self.reason), np.inf)
        found = Slopes.unknown(len(self.reason), len(self.balance.free))
        loads = None
        for count in range(_ITERATIONS):
            if not len(active):
                break
            doubts: dict[str, Array] = {}
            copy_state(self.state, active, onto=self.before)
            step, here = _newton(self.balance, self.state, active, doubts)
            found.put(active, here.slopes)
            if count == 0:
                loads = _Loads.of(here, step, doubts)
            elif loads is not None and self.balance.fused:
                places = np.searchsorted(rows, active)
                loads.put(places, _Loads.of(here, step, doubts), self.balance.quantities)
            else:
                loads = None  # to put loads together would take longer than to compute the loads once more
            size = np.abs(step).max(axis=1)
            small = is_last(size, size_before[active])
            size_before[active] = size
            self.balance.take_step(self.state, active, step)
            self.iterations[active] += 1
            done[active] = small
            active = active[~small & ~np.isnan(size)]
        return done, found, loads

    def _compiled_steps(self, rows: Array) -> tuple[Array, Slopes, _Loads | None]:
        """Return the same by the compiled functions."""
        balance = self.balance
        found = trim_compiled.searched(
            balance, self.state, rows, self.iterations, _ITERATIONS, come_near=False
        )
        for name, values in zip(UNKNOWNS, found.before, strict=True):
            self.before[name][rows] = values[rows]
        done, slopes = found.arrived, Slopes(*found.last)
        return done, slopes, _Loads.compiled(balance, self.before, rows, found) if len(rows) else None


def _newton(
    balance: Balance, state: State, rows: Array, doubts: dict[str, Array] | None = None
) -> tuple[Array, Linear]:
    """Return Newton's step (n, k) at all of the loads, and the balance before the step."""
    here = balance.near(state, rows, doubts=doubts)
    return newton_step(here.slopes.full, here.residual), here


def _next(size: Array, before: Array) -> Array:
    """Return the size (n,) of the step that will follow a step, by the quadratic convergence of Newton's method.

    The slopes change by about themselves per radian, or faster if the last two steps say so.
    """
    return np.asarray(size**2 * np.maximum(1.0, size / before**2))


def _first_step(balance: Balance, state: State, rows: Array) -> tuple[Array, Linear]:
    """Return Newton's step (n, k) from the undeflected blade to all of the loads, and the balance where it starts."""
    here = balance.near(state, rows, share=0.0)
    return newton_step(here.slopes.full, here.residual + balance.precone_load(rows)), here


def _settle(
    balance: Balance,
    state: State,
    before: State,
    reason: Array,
    iterations: Array,
    last: _Loads | None = None,
) -> Settled:
    """Return the trim and the loads of the last step, computed again if some of the points dropped out since then."""
    kept = beyond_reach(balance, state, reason)
    rows = np.flatnonzero(kept == "")
    if len(rows) and (last is None or (kept != reason).any()):
        doubts: dict[str, Array] = {}
        step, here = _newton(balance, before, rows, doubts)
        last = _Loads.of(here, step, doubts)
    kind = np.result_type(float, *state.values())
    values = {name: np.full(len(kept), np.nan, dtype=kind) for name in (*UNKNOWNS, "thrust", "torque")}
    warning = np.full(len(kept), "", dtype=object)
    none = np.where(kept == "", 0.0, np.nan)
    trim = Trim(
        **values,
        converged=kept == "",
        reason=kept,
        warning=warning,
        iterations=iterations,
        inflow=none,
    )
    if last is None or not len(rows):
        return Settled(trim, rows, {}, {})
    here, quantities = last.before, last.before.quantities
    copy_state(state, rows, onto=values)
    loads = last.work * np.asarray(quantities["n_blades"])[..., None]
    trim.torque[rows], trim.thrust[rows] = loads[:, TORQUE], loads[:, THRUST]
    warning[rows] = warnings(balance, here, loads[:, THRUST], last.doubts)
    return Settled(trim, rows, quantities, last.segments)


def _settled(balance: Balance, found: Found) -> Settled:
    """Return a trim by plain numbers as the trim of a batch of one."""
    here, blades = found.here, found.here.quantities["n_blades"]
    thrust, torque = (here.virtual_work_after(found.step, balance.free, row) for row in (THRUST, TORQUE))
    values = {name: np.array([value]) for name, value in found.state.items()}
    trim = Trim(
        **values,
        thrust=np.array([blades * thrust]),
        torque=np.array([blades * torque]),
        converged=np.array([True]),
        reason=np.array([""], dtype=object),
        warning=np.array([""], dtype=object),
        iterations=np.array([found.iterations]),
        inflow=np.zeros(1),
    )
    return Settled(trim, np.zeros(1, dtype=int), here.quantities, here.segments(balance.sections.sides))


def _complex_trim(balance: Balance, few: BladeSections, points: int) -> Settled:
    """Return the trim of the real parts after one more Newton step: exact to first order in the imaginary parts."""
    target = balance.target
    collective = None if target.collective is None else np.real(target.collective)
    real_target = replace(target, collective=collective, load=np.real(target.load))
    real = {name: np.real(value) for name, value in balance.quantities.items()}
    sections = balance.sections.real
    few = sections if few is balance.sections else few.real
    trim = _real_trim(balance_of(sections, real, balance.options, real_target, points), few)
    state = {name: getattr(trim, name).astype(complex) for name in UNKNOWNS}
    if target.collective is not None:
        state["collective"] = state["collective"] + 1j * np.imag(target.collective)
    rows = np.flatnonzero(trim.converged)
    if balance.free and len(rows):
        step, _ = _newton(balance, state, rows)
        balance.take_step(state, rows, step)
    return _settle(balance, state, state, trim.reason, trim.iterations)


def _real_trim(balance: Balance, few: BladeSections) -> Trim:
    """Return the trim of all points of real quantities, in one compiled call as far as this is served."""
    sections, options, points = balance.sections, balance.options, balance.points
    if not serves_in_flight(balance, few):
        return solve_trim(sections, few, balance.quantities, options, balance.target, points).trim
    found = find_in_flight(rotors_of(balance), points)
    found.trim.converged[:] = found.trimmed  # their doubts are found after the complex step
    left = np.flatnonzero(~found.trimmed)
    if len(left):
        target = {"collective": balance.target.collective, "load": balance.target.load}
        own = solve_trim(
            sections := sections.take(left),
            sections,
            take(balance.quantities, left),
            options,
            replace(balance.target, **take(target, left)),
            len(left),
        )
        for name, values in vars(own.trim).items():
            getattr(found.trim, name)[left] = values
    return found.trim


def _free_unknowns(options: Options, finds_collective: bool) -> list[int]:
    """Return the places of the unknowns that are solved for; the other unknowns keep their values."""
    free = {
        "coning": "flap" not in options.locked,
        "lag": "lag" not in options.locked,
        "elastic_pitch": options.pitch_is_free,
        "collective": finds_collective,
    }
    return [place for place, name in enumerate(UNKNOWNS) if free[name]]
