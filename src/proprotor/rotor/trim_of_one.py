"""The trim of one point by plain numbers: the search of `trim_solver` without arrays of one.

The search serves a point without any reservation. At a point that has no trim, a doubt or a path to follow it returns
nothing, and the search for batches finds out what there is to say.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from proprotor.rotor.balance_of_one import BalanceOfOne, Here, Numbers, Rows, solve, sums_of_minors
from proprotor.rotor.elimination import by_lapack
from proprotor.rotor.fused import plain_number
from proprotor.rotor.trim import THRUST, UNKNOWNS
from proprotor.rotor.trim_balance import LARGEST_STEP, Balance, Slopes, is_last
from proprotor.rotor.trim_bound import at_end, leads_to_end
from proprotor.rotor.trim_reasons import INDUCED_SHARE, LARGEST_ANGLE
from proprotor.rotor.trim_start import FARTHEST, is_limp

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
    one = BalanceOfOne.of(balance)
    if not _may_begin(one):
        return None
    start = _start(one)
    state, size = dict(start), math.inf
    passed: list[Here] = []
    while len(passed) < _MOST:
        here = one.at(state) if passed else _undeflected(one, state)
        passed.append(here)
        step = solve(here.full, here.residual)
        if step is None:
            return None
        step = [min(max(part, -LARGEST_STEP), LARGEST_STEP) for part in step]
        before, size = size, max(map(abs, step))
        state = dict(state)
        for place, part in zip(one.free, step, strict=True):
            state[UNKNOWNS[place]] -= part
        if len(passed) > 1 and is_last(size, before):
            found = Found(state, here, step, len(passed))
            connected = _is_end_of_path(balance, passed, start, state)
            return found if connected and _is_without_doubt(one, found) else None
    return None


def _may_begin(one: BalanceOfOne) -> bool:
    """Return whether nothing keeps the point from a trim, as far as the inputs tell."""
    quantities, options = one.quantities, one.balance.options
    if "lag" not in options.locked and is_limp(quantities):
        return False
    speed, tip_speed = quantities["airspeed"], quantities["rotor_speed"] * quantities["radius"]
    has_air = quantities["density"] > 0 or not one.balance.target.finds_collective
    slow = not options.compressibility or math.hypot(tip_speed, speed) < quantities["speed_of_sound"]
    return bool(0 <= speed < math.inf and has_air and slow)


def _start(one: BalanceOfOne) -> Numbers:
    """Return the undeflected blade at its collective, or at the direction of the air at 0.75 R."""
    given = one.balance.target.collective
    collective = _direction(one.quantities) if given is None else plain_number(given)
    return dict.fromkeys(UNKNOWNS, 0.0) | {"collective": collective}


def _direction(quantities: Numbers) -> float:
    return math.atan2(quantities["airspeed"], 0.75 * quantities["rotor_speed"] * quantities["radius"])


def _undeflected(one: BalanceOfOne, state: Numbers) -> Here:
    """Return the balance at the start, which has precone in the load of the undeflected blade alone."""
    here = one.at(state, precone=0.0)
    residual = [left + load for left, load in zip(here.residual, one.precone_load(), strict=True)]
    return here._replace(residual=residual)


def _is_end_of_path(balance: Balance, passed: list[Here], start: Numbers, state: Numbers) -> bool:
    """Return whether the bound shows that the trim is connected with the undeflected blade."""
    ends = np.array([(here.full, here.airloads) for here in (passed[0], passed[-1])])
    if leads_to_end(ends):
        return True
    first, last = (Slopes(*slopes[:, None]) for slopes in ends)
    before, after = ({name: np.array([value]) for name, value in end.items()} for end in (start, state))
    rows = np.zeros(1, dtype=int)
    return bool(at_end(balance, first, last, before, after, rows, solution=by_lapack).all())


def _is_without_doubt(one: BalanceOfOne, found: Found) -> bool:
    """Return whether nothing makes the trim doubtful: as `trim_reasons` has it, and a little stricter."""
    state, here, quantities = found.state, found.here, found.here.quantities
    if any(abs(state[name]) > LARGEST_ANGLE for name in _ANGLES):
        return False
    turned = abs(state["collective"] - _direction(quantities))
    if one.balance.target.finds_collective and not turned < FARTHEST:
        return False
    disk = 2 * quantities["density"] * math.pi * quantities["radius"] ** 2 * quantities["airspeed"] ** 2
    if abs(here.virtual_work(THRUST) * quantities["n_blades"]) > INDUCED_SHARE * disk / 2:
        return False
    doubtful = one.stations.are_in_doubt(here.loads, quantities["radius"])
    return not (doubtful or _may_diverge(here.full, one.hinged))


def _may_diverge(slopes: Rows, hinged: list[bool]) -> bool:
    """Return whether a sum of principal minors of the blade's stiffness is not positive."""
    places = [place for place, is_hinged in enumerate(hinged) if is_hinged]
    matrix = [[slopes[i][j] for j in places] for i in places]
    return any(not total > 0 for total in sums_of_minors(matrix))
