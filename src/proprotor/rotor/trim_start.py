"""The start of the search for a trim: first guess, and the undeflected blade at which the path to the trim begins.

Without loads, at λ = 0, a blade has no coning and no lag. Its collective is the root of the rigid blade's torque or
thrust that is nearest the direction of the air, and its elastic pitch is what the propeller moment makes of the control
system.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from proprotor.rotor.trim import UNKNOWNS
from proprotor.rotor.trim_balance import Balance, State
from proprotor.typing import Array

# Largest angle of the collective from the direction of the air: a blade turned farther is on another branch.
FARTHEST = np.radians(60)
_SEARCH = np.radians(1)  # step of the search for the rigid blade's root
_REFINEMENTS = 60
_SHARP = 1e-12  # rad, of the rigid blade's root
NO_SPRING = 1e-90  # of the other spring, or N m/rad


def first_guess(balance: Balance, points: int) -> State:
    """Return an undeflected blade whose section at 0.75 R meets the air at no angle."""
    state = {name: np.zeros(points) for name in UNKNOWNS}
    given = balance.target.collective
    state["collective"] = state["collective"] + (balance.air_direction(points) if given is None else given)
    return state


def held(balance: Balance, points: int) -> Array:
    """Return at which points (points,) something holds the unloaded blade, so that it can begin a path.

    Without airloads nothing holds a lag hinge at the centre that has no spring.
    """
    quantities, options = balance.quantities, balance.options
    if "lag" in options.locked or options.frequencies is not None:
        return np.ones(points, dtype=bool)
    return np.broadcast_to(~is_limp(quantities), (points,))


def is_limp(quantities: Mapping[str, Any]) -> Any:
    """Return whether a lag hinge at the centre has no spring."""
    names = ("lag_hinge_offset", "lag_first_moment", "lag_stiffness", "flap_stiffness")
    offset, mass, lag, flap = (np.real(quantities[name]) for name in names)
    return (lag <= NO_SPRING * np.maximum(flap, 1)) & (offset * mass == 0)


def undeflect(balance: Balance, state: State, rows: Array) -> Array:
    """Set the state to the undeflected blade, and return whether the rigid blade (n,) has the torque or thrust."""
    for name in ("coning", "lag", "elastic_pitch"):
        state[name][rows] = 0.0
    found = np.ones(len(rows), dtype=bool)
    if balance.target.finds_collective:
        state["collective"][rows], found = _rigid_pitch(balance, state, rows)
    if balance.options.pitch_is_free:
        _balance_control(balance, state, rows)
    return found & np.isfinite(state["elastic_pitch"][rows])


def _balance_control(balance: Balance, state: State, rows: Array) -> None:
    """Let the propeller moment deflect the control system: at the rigid blade's pitch, or at a given collective.

    At a given collective several pitches can balance. The blade takes the pitch between the collective and the nearest
    flat pitch. Newton's steps from the flat pitch all go the same way, because over this quarter of a turn the
    propeller moment is concave.
    """
    names = ("control_stiffness", "pitch_inertia", "propeller_moment", "rotor_speed")
    stiffness, inertia, acts, speed = (
        np.broadcast_to(np.real(balance.quantities[name]), len(state["collective"]))[rows] for name in names
    )
    moment = acts * inertia * speed**2
    given = state["collective"][rows]
    if balance.target.finds_collective:
        elastic = np.where(moment > 0, -moment * np.sin(2 * given) / (2 * stiffness), 0.0)
        state["collective"][rows] = given - elastic
    else:
        pitch = np.pi * np.round(given / np.pi)
        for _ in range(_REFINEMENTS):
            left = stiffness * (pitch - given) + moment * np.sin(2 * pitch) / 2
            pitch = pitch - left / (stiffness + moment * np.cos(2 * pitch))
        elastic = pitch - given
    state["elastic_pitch"][rows] = elastic


def _rigid_pitch(balance: Balance, state: State, rows: Array) -> tuple[Array, Array]:
    """Return the pitch (n,) that gives the undeflected blade its torque or thrust, and which points have such a pitch.

    Of several pitches the nearest to the direction of the air is taken: the search moves away from this direction on
    both sides at once.
    """
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
            values = before[at], value[crossed]  # copies, like the ends: the search changes them
            root = _root_between(balance, state, rows[at], air[at], ends, values)
            nearest[at] = np.where(np.abs(root) < np.abs(nearest[at]), root, nearest[at])
            edge[side] = before.copy()
            edge[side][looking] = value
        looking = looking[np.isinf(nearest[looking])]
    return air + nearest, np.isfinite(nearest)


def _closing(balance: Balance, state: State, rows: Array, pitch: Array) -> Array:
    """Return the residual (n,) of the row that closes the trim, at a pitch of the undeflected blade."""
    state["collective"][rows] = pitch
    return balance.left(state, rows, share=0.0)[:, -1] if len(rows) else np.zeros(0)


def _root_between(
    balance: Balance,
    state: State,
    rows: Array,
    air: Array,
    ends: tuple[Array, Array],
    values: tuple[Array, Array],
) -> Array:
    """Return the root (n,) of the closing row between two angles from the air, by the Illinois method.

    The values at the two angles have different signs.
    """
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
