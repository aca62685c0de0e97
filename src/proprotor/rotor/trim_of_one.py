"""The trim of one point by plain numbers: the search of `trim_solver` without arrays of one.

The search serves a point without any reservation. At a point that has no trim, a doubt or a path to follow it returns
nothing, and the search for batches finds out what there is to say.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from proprotor.rotor.balance_of_one import BalanceOfOne, Here, Numbers, Rows, solve, sums_of_minors
from proprotor.rotor.section_loads import mark_doubts
from proprotor.rotor.trim import THRUST, UNKNOWNS
from proprotor.rotor.trim_balance import LARGEST_STEP, Balance, Slopes, is_last
from proprotor.rotor.trim_bound import at_end
from proprotor.rotor.trim_reasons import INDUCED_SHARE, LARGEST_ANGLE
from proprotor.rotor.trim_start import FARTHEST, first_guess, held
from proprotor.typing import Array

_MOST = 12  # steps of a point without reservation
_ANGLES = ("coning", "lag", "elastic_pitch")


class Found(NamedTuple):
    """A trim without reservation: the state, the balance before the last step, and the number of steps."""

    state: Numbers
    here: Here
    step: list[float]
    iterations: int


def trim_of_one(balance: Balance) -> Found | None:
    """Return the trim of the only point; None for a point that takes the search for batches."""
    if not _may_begin(balance):
        return None
    one = BalanceOfOne.of(balance)
    start = {name: float(value[0]) for name, value in first_guess(balance, 1).items()}
    state, size = dict(start), math.inf
    passed: list[Here] = []
    for count in range(1, _MOST):
        here = one.at(state, None if passed else 0.0)
        passed.append(here)
        residual = here.residual if count > 1 else _of_undeflected(one, here)
        step = solve(here.full, residual)
        if step is None:
            return None
        step = [min(max(part, -LARGEST_STEP), LARGEST_STEP) for part in step]
        before, size = size, max(map(abs, step))
        state = dict(state)
        for place, part in zip(balance.free, step, strict=True):
            state[UNKNOWNS[place]] -= part
        if count > 1 and is_last(size, before):
            found = Found(state, here, step, count)
            connected = _is_end_of_path(balance, passed, start, state)
            return found if connected and _is_without_doubt(one, found) else None
    return None


def _may_begin(balance: Balance) -> bool:
    """Return whether nothing keeps the point from a trim, as far as the inputs tell."""
    if not held(balance, 1).all():
        return False
    quantities, options = balance.quantities, balance.options
    speed, density, rotor_speed, radius, sound = (
        float(np.ravel(quantities[name])[0])
        for name in ("airspeed", "density", "rotor_speed", "radius", "speed_of_sound")
    )
    has_air = density > 0 or not balance.target.finds_collective
    slow = not options.compressibility or math.hypot(rotor_speed * radius, speed) < sound
    return 0 <= speed < math.inf and has_air and slow


def _of_undeflected(one: BalanceOfOne, here: Here) -> list[float]:
    """Return the residual of the first step, which has precone in the load of the undeflected blade alone."""
    loads = one.balance.precone_load(np.zeros(1, dtype=int))[0].tolist()
    return [left + load for left, load in zip(here.residual, loads, strict=True)]


def _is_end_of_path(balance: Balance, passed: list[Here], start: Numbers, state: Numbers) -> bool:
    """Return whether the bound shows that the trim is connected with the undeflected blade."""
    first, last = (Slopes(np.array([here.full]), np.array([here.airloads])) for here in (passed[0], passed[-1]))
    ends = ({name: np.array([value]) for name, value in end.items()} for end in (start, state))
    return bool(at_end(balance, first, last, *ends, np.zeros(1, dtype=int)).all())


def _is_without_doubt(one: BalanceOfOne, found: Found) -> bool:
    """Return whether nothing makes the trim doubtful: as `trim_reasons` has it, and a little stricter."""
    state, here, quantities = found.state, found.here, found.here.quantities
    if any(abs(state[name]) > LARGEST_ANGLE for name in _ANGLES):
        return False
    air = math.atan2(quantities["airspeed"], 0.75 * quantities["rotor_speed"] * quantities["radius"])
    if one.balance.target.finds_collective and not abs(state["collective"] - air) < FARTHEST:
        return False
    disk = 2 * quantities["density"] * math.pi * quantities["radius"] ** 2 * quantities["airspeed"] ** 2
    if abs(here.work[THRUST] * quantities["n_blades"]) > INDUCED_SHARE * disk / 2:
        return False
    doubts: dict[str, Array] = {}
    alpha, mach = here.loads[-2:]
    mark_doubts(doubts, one.balance.sections, quantities["radius"], (alpha[None], mach[None]), slice(1), 1)
    return not doubts and not _may_diverge(here.full, one.balance.hinged.tolist())


def _may_diverge(slopes: Rows, hinged: list[bool]) -> bool:
    """Return whether a sum of principal minors of the blade's stiffness is not positive."""
    places = [place for place, is_hinged in enumerate(hinged) if is_hinged]
    matrix = [[slopes[i][j] for j in places] for i in places]
    return any(not total > 0 for total in sums_of_minors(matrix))
