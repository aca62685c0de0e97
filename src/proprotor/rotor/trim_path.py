"""The path from the undeflected blade to the trim, which says which of several equilibria is meant.

A share λ from 0 to 1 multiplies precone, and in the rows of flap, lag and pitch the airloads. Springs, centrifugal
stiffness and propeller moment stay whole, and so does the row that closes the collective (torque or thrust), which
starts from the rigid blade's root nearest the direction of the air (`trim_start`).

Most trims need no path, because a bound shows that they are the end of their path (`trim_bound`). The other points are
followed here in steps of λ, with Newton's method at each step, and each step as long as the same bound allows. Where a
path turns back, the inverse of the slopes grows without limit and the steps shrink to nothing.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from proprotor.rotor.elimination import solve
from proprotor.rotor.trim_balance import Balance, Slopes, State, copy_state, newton_step
from proprotor.rotor.trim_bound import CONTRACTION, contraction
from proprotor.rotor.trim_start import undeflect
from proprotor.typing import Array

_FIRST_STEP, _SHORTEST_STEP = 0.25, 1e-6  # of λ
_CAUTION = 0.8  # share of the largest allowed radius for which a step is made
# rad per unit of λ: where the steps end and angles change faster than this, the path turns back.
_TURNING = 10.0
_STEPS = 400
_CORRECTIONS = 8
_ARRIVED = 1e-7  # rad, the last correction


@dataclass(eq=False)
class Path:
    """The paths of some points, and how far each point has come.

    balance, state, rows, iterations : the balance, the state of all points that the path moves, the n points that are
        followed, and the number of steps of all points.
    rigid (n,) : whether the rigid blade has a root to start from.
    share (n,) : λ reached, 1 at the trim.
    turned (n,) : whether the path turns back at this λ.
    slopes : slopes at this λ.
    tangent (n, k), step (n,) : change of the free unknowns with λ, and the next step in λ.
    """

    balance: Balance
    state: State
    rows: Array
    iterations: Array
    rigid: Array
    share: Array
    turned: Array
    slopes: Slopes
    tangent: Array
    step: Array

    @property
    def arrived(self) -> Array:
        """Which points (n,) have come to all of the loads."""
        return np.asarray(self.rigid & (self.share == 1))

    def begin(self) -> Array:
        """Correct the undeflected blade at no loads, and return the points that have a path."""
        active = np.flatnonzero(self.rigid)
        share = self.share[active]
        begun, *found = self._correct(self.state, self.rows[active], share)
        self._accept(active[begun], share[begun], *(part[begun] for part in found))
        return active[begun]

    def advance(self, active: Array) -> Array:
        """Try a step in λ at the active points, and return the points that are still on the way."""
        here, share = self.rows[active], self.share[active]
        to = np.minimum(1.0, share + self.step[active])
        trial = {name: value.copy() for name, value in self.state.items()}
        self.balance.take_step(trial, here, (share - to)[:, None] * self.tangent[active])
        good, *found = self._correct(trial, here, to)
        ends = self.slopes.of(active), Slopes(*found[:2])
        radius = contraction(self.balance.sprung, *ends, share, to, enough=0.0)
        good &= radius <= CONTRACTION
        copy_state(trial, here[good], onto=self.state)
        self._accept(active[good], to[good], *(part[good] for part in found))
        return self._with_next_step(active, good, radius)

    def _accept(self, gained: Array, share: Array, full: Array, airloads: Array, loads: Array) -> None:
        """Set λ, slopes and tangent of points that came farther."""
        self.share[gained] = share
        self.slopes.put(gained, Slopes(full, airloads))
        self.tangent[gained] = -solve(Slopes(full, airloads).at(share), loads[..., None])[..., 0]

    def _with_next_step(self, active: Array, good: Array, radius: Array) -> Array:
        """Set the next step by the bound, and return the points with a way to go and a step to take."""
        longer = np.clip(_CAUTION * CONTRACTION / radius, 0.25, 2.0)
        self.step[active] *= np.where(good | (radius > CONTRACTION), longer, 0.5)
        ended = self.step[active] < _SHORTEST_STEP
        self.turned[active] = ended & (np.abs(self.tangent[active]).max(axis=-1) > _TURNING)
        return active[(self.share[active] < 1) & ~ended]

    def _correct(self, state: State, rows: Array, share: Array) -> tuple[Array, Array, Array, Array]:
        """Run Newton at a share of the loads.

        Return which points (n,) arrived, their slopes, full and of the airloads, and the loads that λ multiplies.
        """
        balance, n, k = self.balance, len(rows), len(self.balance.free)
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
            self.iterations[here] += 1
            size = np.abs(step).max(axis=1)
            arrived[going] = size <= _ARRIVED
            going = going[size > _ARRIVED]
        return arrived, full, airloads, loads


def follow(balance: Balance, state: State, rows: Array, iterations: Array) -> Path:
    """Follow the path of each point from the undeflected blade, and leave the state where the path led."""
    n, k = len(rows), len(balance.free)
    path = Path(
        *(balance, state, rows, iterations),
        rigid=undeflect(balance, state, rows),
        share=np.zeros(n),
        turned=np.zeros(n, dtype=bool),
        slopes=Slopes.unknown(n, k),
        tangent=np.zeros((n, k)),
        step=np.full(n, _FIRST_STEP),
    )
    active = path.begin()
    for _ in range(_STEPS):
        if not len(active):
            break
        active = path.advance(active)
    return path
