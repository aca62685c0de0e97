"""The path from the undeflected blade to the trim, which says which of several equilibria is meant.

A share λ from 0 to 1 multiplies precone, and in the rows of flap, lag and pitch the airloads. Springs, centrifugal
stiffness and propeller moment stay whole, and so does the row that closes the collective (torque or thrust), which
starts from the rigid blade's root nearest the direction of the air.

Most trims need no path, for a bound tells that they are its end. With J_λ(x) the slopes at a share λ, P the inverse of
their mean over a step in λ and x, and N the largest |P J_λ(x) - 1| in the step entry by entry, Newton's iteration with
P contracts for every λ of the step where N has a spectral radius below one: then each λ has one equilibrium within
reach, and these are one curve without a turn. The share of the airloads makes J linear in λ, so that the step's ends
hold the extremes. Where the blade is, its precone included, J is known at both ends; it is taken to change twice as
much within reach of the path as between them, and the radius may be one half at most.

The other points are followed in steps of λ, each of a length that the same bound allows. Where a path turns back, P
grows without limit and the steps shrink to nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from proprotor.rotor.airfoil import Airfoil
from proprotor.rotor.trim import UNKNOWNS
from proprotor.rotor.trim_balance import Balance, Slopes, State, copy_state, newton_step, solve
from proprotor.typing import Array

# Of the collective from the direction of the air: a blade turned farther is another branch.
FARTHEST = np.radians(60)
_CONTRACTION = 0.5  # largest spectral radius of N
_REACH = 2.0  # change of slopes within reach of the path, in that between the ends of a step
_WINDOWS = (1, 4, 16)  # parts of the whole path in λ, each with a P of its own, in which the bound may hold
_POWER_STEPS, _FLOOR = 8, 1e-9
_FIRST_STEP, _SHORTEST_STEP = 0.25, 1e-6  # of λ
_CAUTION = 0.8  # of the largest radius, which a step is made for
_TURNING = (
    10.0  # rad per unit of λ: where the steps end and angles change faster than this, the path turns back
)
_STEPS = 400
_CORRECTIONS = 8
_ARRIVED = 1e-7  # rad, the last correction
_SEARCH = np.radians(1)  # between the angles among which the rigid blade's root is looked for
_REFINEMENTS = 60
_SHARP = 1e-12  # rad, of the rigid blade's root


def contraction(
    sprung: Array,
    before: Slopes,
    after: Slopes,
    share: Array,
    to: Array,
    *,
    windows: int = 1,
    between: Slopes | None = None,
    enough: float = _CONTRACTION,
) -> Array:
    """Spectral radius (n,) of N in a step: up to one half the path leads from one equilibrium to the other, unturned.

    Parameters
    ----------
    sprung : array (k,)
        Which rows are flap and lag.
    before, after : Slopes
        At the two equilibria.
    share, to : array (n,)
        λ of the two.
    windows : int
        Parts of the step in λ in which the bound has to hold, each with a P of its own.
    between : Slopes, optional
        Half-way, for section models whose slopes may do there what they don't at the ends.
    enough : float
        Radius above which angles are tried where moments do not serve.
    """

    def radius(rows: Array, *slopes: Slopes) -> Array:
        n, half = len(rows), (to - share)[rows] / (2 * windows)
        middles = share[rows] + (2 * np.arange(windows)[:, None] + 1) * half
        again = np.tile(np.arange(n), windows)  # all windows at once
        moved = _moved(half[again], middles.ravel(), *(part.of(again) for part in slopes))
        largest: Array = _radius(moved).reshape(windows, n).max(axis=0)
        return largest

    slopes = (before, after) if between is None else (before, after, between)
    return _by_moments_or_angles(sprung, radius, *slopes, enough=enough)


def near_each_other(sprung: Array, found: Slopes, expected: Slopes) -> Array:
    """Whether the slopes at all of the loads are so near those expected that one equilibrium has both."""

    def radius(_: Array, found: Slopes, expected: Slopes) -> Array:
        return _radius(np.abs(solve(expected.full, found.full - expected.full)))

    near: Array = _by_moments_or_angles(sprung, radius, found, expected) <= _CONTRACTION
    return near


def _by_moments_or_angles(
    sprung: Array, radius: Callable[..., Array], *slopes: Slopes, enough: float = _CONTRACTION
) -> Array:
    """The smaller spectral radius (n,) of those by moments and, where that is not small enough, by angles."""
    rows = np.arange(len(slopes[0].full))
    found = radius(rows, *(part.by_moments(sprung) for part in slopes))
    rows = np.flatnonzero(~(found <= enough))
    if len(rows):
        found[rows] = np.fmin(found[rows], radius(rows, *(part.of(rows) for part in slopes)))
    return found


def _moved(half: Array, middle: Array, before: Slopes, after: Slopes, *between: Slopes) -> Array:
    """N (n, k, k) of a window in λ about its middle, and half as long as it is."""
    mean = Slopes(*((a + b) / 2 for a, b in zip(before, after, strict=True)))
    change = Slopes(*((b - a) / 2 for a, b in zip(before, after, strict=True)))
    aside = (Slopes(*(a - b for a, b in zip(part, mean, strict=True))) for part in between)
    parts = [half[:, None, None] * mean.airloads, *(part.at(middle) for part in (change, *aside))]
    moved = np.abs(solve(mean.at(middle), np.concatenate(parts, axis=-1)))
    in_share, *in_place = np.split(moved, len(parts), axis=-1)
    largest: Array = in_share + _REACH * np.maximum.reduce(in_place)
    return largest


def _radius(matrix: Array) -> Array:
    """Bound (n,) of the spectral radius of matrices (n, k, k) without negative entries (Collatz and Wielandt)."""
    weight = np.ones((*matrix.shape[:2], 1))
    for _ in range(_POWER_STEPS):
        weight = matrix @ weight + _FLOOR * weight
    bound: Array = (matrix @ weight / weight)[..., 0].max(axis=1, initial=0.0)
    return bound


def at_end(balance: Balance, before: Slopes, after: Slopes, start: State, state: State, rows: Array) -> Array:
    """Whether the bound tells that points (n,) with these slopes at the start and here are at the path's end."""
    smooth = isinstance(balance.sections.airfoil, Airfoil)
    between = None if smooth else balance.near(_half_way(start, state), rows, share=0.5).slopes
    found = np.zeros(len(rows), dtype=bool)
    left = np.arange(len(rows))
    for windows in _WINDOWS:
        ends = np.zeros(len(left)), np.ones(len(left))
        middle = None if between is None else between.of(left)
        radius = contraction(
            balance.sprung, before.of(left), after.of(left), *ends, windows=windows, between=middle
        )
        found[left] = radius <= _CONTRACTION
        left = left[~found[left]]
        if not len(left):
            break
    return found


def _half_way(start: State, state: State) -> State:
    return {name: (start[name] + state[name]) / 2 for name in UNKNOWNS}


@dataclass(frozen=True, eq=False)
class Followed:
    """Where the path of each point led.

    rigid (n,): whether the rigid blade has a root to start from; share (n,): λ reached, 1 at the trim; turned (n,):
    whether the path turns back there; slopes there.
    """

    rigid: Array
    share: Array
    turned: Array
    slopes: Slopes

    @property
    def arrived(self) -> Array:
        """Which points (n,) have come to all of the loads."""
        arrived: Array = self.rigid & (self.share == 1)
        return arrived


def follow(balance: Balance, state: State, rows: Array, iterations: Array) -> Followed:
    """Follow the path of each point from the undeflected blade, and leave its state where that led."""
    n, k = len(rows), len(balance.free)
    rigid = undeflected(balance, state, rows)
    followed = Followed(rigid, np.zeros(n), np.zeros(n, dtype=bool), Slopes.unknown(n, k))
    tangent, step = np.zeros((n, k)), np.full(n, _FIRST_STEP)
    active = np.flatnonzero(rigid)
    begun, *there = _correct(balance, state, rows[active], followed.share[active], iterations)
    _accept(followed, tangent, active[begun], *(part[begun] for part in there))
    active = active[begun]
    for _ in range(_STEPS):
        if not len(active):
            break
        here, share = rows[active], followed.share[active]
        to = np.minimum(1.0, share + step[active])
        trial = {name: value.copy() for name, value in state.items()}
        balance.take_step(trial, here, (share - to)[:, None] * tangent[active])
        good, *there = _correct(balance, trial, here, to, iterations)
        ends = followed.slopes.of(active), Slopes(*there[:2])
        radius = contraction(balance.sprung, *ends, share, to, enough=0.0)
        good &= radius <= _CONTRACTION
        gained = active[good]
        copy_state(trial, rows[gained], onto=state)
        followed.share[gained] = to[good]
        _accept(followed, tangent, gained, *(part[good] for part in there))
        longer = np.clip(_CAUTION * _CONTRACTION / radius, 0.25, 2.0)
        step[active] *= np.where(good | (radius > _CONTRACTION), longer, 0.5)
        ended = step[active] < _SHORTEST_STEP
        followed.turned[active] = ended & (np.abs(tangent[active]).max(axis=-1) > _TURNING)
        active = active[(followed.share[active] < 1) & ~ended]
    return followed


def _accept(
    followed: Followed, tangent: Array, gained: Array, full: Array, airloads: Array, loads: Array
) -> None:
    """Note slopes and tangent of points that came farther."""
    followed.slopes.put(gained, Slopes(full, airloads))
    here = followed.slopes.of(gained).at(followed.share[gained])
    tangent[gained] = -solve(here, loads[..., None])[..., 0]


def _correct(
    balance: Balance, state: State, rows: Array, share: Array, iterations: Array
) -> tuple[Array, Array, Array, Array]:
    """Newton at a share of the loads: which points (n,) arrived, their slopes, full and of airloads, and loads."""
    n, k = len(rows), len(balance.free)
    arrived, going = np.zeros(n, dtype=bool), np.arange(n)
    full, airloads, loads = np.zeros((n, k, k)), np.zeros((n, k, k)), np.zeros((n, k))
    for _ in range(_CORRECTIONS):
        if not len(going):
            break
        here, part = rows[going], share[going]
        linear = balance.near(state, here, share=part)
        full[going], airloads[going] = linear.slopes
        loads[going] = balance.precone_load(here) - linear.work[:, balance.rows] * balance.hinged
        step = newton_step(linear.slopes.at(part), balance.relieved(linear, part))
        balance.take_step(state, here, step)
        iterations[here] += 1
        size = np.abs(step).max(axis=1)
        arrived[going] = size <= _ARRIVED
        going = going[size > _ARRIVED]
    return arrived, full, airloads, loads


# The undeflected blade ----------------------------------------------------------------------------


def undeflected(balance: Balance, state: State, rows: Array) -> Array:
    """Set the state to that without loads: no coning, no lag; whether the rigid blade (n,) has its torque or thrust.

    The control system alone is deflected, by the propeller moment.
    """
    for name in ("coning", "lag", "elastic_pitch"):
        state[name][rows] = 0.0
    found = np.ones(len(rows), dtype=bool)
    if balance.target.finds_collective:
        pitch, found = _rigid_pitch(balance, state, rows)
        state["collective"][rows] = pitch
    if balance.options.pitch_is_free:
        _balance_control(balance, state, rows)
    return found & np.isfinite(state["elastic_pitch"][rows])


def _balance_control(balance: Balance, state: State, rows: Array) -> None:
    """Let the propeller moment deflect the control system: at the rigid blade's pitch, or at a given collective.

    Of several pitches at a given collective the blade takes that between it and the nearest flat pitch, where Newton's
    steps from the flat pitch all go the same way: over this quarter of a turn the propeller moment is concave.
    """
    names = ("control_stiffness", "pitch_inertia", "propeller_moment", "rotor_speed")
    stiffness, inertia, acts, speed = (
        np.broadcast_to(np.real(balance.quantities[name]), len(state["collective"]))[rows] for name in names
    )
    moment = acts * inertia * speed**2
    given = state["collective"][rows]
    pitch = given
    if not balance.target.finds_collective:
        pitch = np.pi * np.round(given / np.pi)
        for _ in range(_REFINEMENTS):
            left = stiffness * (pitch - given) + moment * np.sin(2 * pitch) / 2
            pitch = pitch - left / (stiffness + moment * np.cos(2 * pitch))
    elastic = np.where(moment > 0, -moment * np.sin(2 * pitch) / (2 * stiffness), 0.0)
    if balance.target.finds_collective:
        state["collective"][rows] = pitch - elastic
    else:
        elastic = pitch - given
    state["elastic_pitch"][rows] = elastic


def _rigid_pitch(balance: Balance, state: State, rows: Array) -> tuple[Array, Array]:
    """Pitch (n,) of the undeflected blade with the torque or thrust asked for, nearest the air; where there is one."""
    air = balance.air_direction(len(state["collective"]))[rows]
    nearest = np.full(len(rows), np.inf)  # from the direction of the air
    looking = np.arange(len(rows))
    edge = dict.fromkeys((1, -1), _closing(balance, state, rows, air))
    for count in range(1, 1 + round(FARTHEST / _SEARCH)):
        if not len(looking):
            break
        for side, before in edge.items():
            near, far = side * (count - 1) * _SEARCH, side * count * _SEARCH
            value = _closing(balance, state, rows[looking], air[looking] + far)
            crossed = np.sign(before[looking]) * np.sign(value) <= 0
            at = looking[crossed]
            ends = np.full(len(at), near), np.full(len(at), far)
            values = before[at], value[crossed]  # copies, as the ends: the search moves them
            root = _root_between(balance, state, rows[at], air[at], ends, values)
            nearest[at] = np.where(np.abs(root) < np.abs(nearest[at]), root, nearest[at])
            edge[side] = before.copy()
            edge[side][looking] = value
        looking = looking[np.isinf(nearest[looking])]
    return air + nearest, np.isfinite(nearest)


def _closing(balance: Balance, state: State, rows: Array, pitch: Array) -> Array:
    """Residual (n,) of the row that closes the trim, at a pitch of the undeflected blade."""
    state["collective"][rows] = pitch
    left: Array = balance.left(state, rows, share=0.0)[:, -1] if len(rows) else np.zeros(0)
    return left


def _root_between(
    balance: Balance,
    state: State,
    rows: Array,
    air: Array,
    ends: tuple[Array, Array],
    values: tuple[Array, Array],
) -> Array:
    """Root (n,) of the closing row between two angles from the air's with values of different sign (Illinois)."""
    (a, b), (at_a, at_b) = ends, values
    going = np.arange(len(rows))
    for _ in range(_REFINEMENTS):
        if not len(going):
            break
        rise = at_b[going] - at_a[going]
        part = np.where(rise == 0, 0.0, at_b[going] / np.where(rise == 0, 1.0, rise))
        c = b[going] - part * (b[going] - a[going])
        at_c = _closing(balance, state, rows[going], air[going] + c)
        crossed = np.sign(at_c) * np.sign(at_b[going]) < 0
        a[going] = np.where(crossed, b[going], a[going])
        at_a[going] = np.where(crossed, at_b[going], at_a[going] / 2)
        moved, b[going], at_b[going] = np.abs(c - b[going]), c, at_c
        going = going[moved > _SHARP]
    return b
