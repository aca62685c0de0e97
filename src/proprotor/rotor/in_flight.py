"""Trim and matrices of rotors without any reservation, in one call of the compiled functions.

A point has reservations if it has no trim at the end of the path from the undeflected blade, or if anything makes the
trim doubtful. Such a point takes `trim_solver`, which finds out what there is to say of its trim, or why it has none.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from proprotor.compiled.in_flight import Limits, Rotors
from proprotor.rotor.airfoil import LINEAR_ALPHA, LINEAR_MACH
from proprotor.rotor.fused import serves, shapes_of
from proprotor.rotor.section_loads import BladeSections
from proprotor.rotor.trim import UNKNOWNS, Trim
from proprotor.rotor.trim_balance import Balance
from proprotor.rotor.trim_compiled import blades_of, stage
from proprotor.rotor.trim_compiled import serves as serves_search
from proprotor.rotor.trim_reasons import INDUCED_SHARE, LARGEST_ANGLE
from proprotor.rotor.trim_start import FARTHEST, NO_SPRING
from proprotor.typing import Array

_MOST = 20  # steps of each stage; a point that takes more takes `trim_solver`


class InFlight(NamedTuple):
    """Rotors at n points: trim, and M, C, K and B (n, rows, columns), which hold at the points `served` (n,).

    The points `trimmed` (n,), which are more, have at least the unknowns of the trim, now and before the last step.
    """

    served: Array
    trim: Trim
    matrices: dict[str, Array]
    trimmed: Array
    before: dict[str, Array]


def serves_in_flight(balance: Balance, few: BladeSections) -> bool:
    """Return whether one call serves these rotors: all airloads of the consistent equations, dynamic or rigid pitch."""
    options = balance.options
    usual = serves(options.equation_set) and options.airloads == "full" and options.pitch != "coupling"
    apart = options.reactionless or options.blades_lag or options.is_tilted or options.has_inflow
    return bool(usual and not apart and balance.free and few is balance.sections and serves_search(balance))


def rotors_of(balance: Balance) -> Rotors:
    """Return the rotors of a balance as the call takes them: those of many designs, or of one at any airspeed."""
    plans, finds_collective = balance.plans, balance.target.finds_collective
    limits = Limits(
        angle=LARGEST_ANGLE,
        from_air=FARTHEST,
        induced=INDUCED_SHARE,
        incidence=LINEAR_ALPHA,
        mach=LINEAR_MACH,
        no_spring=NO_SPRING,
        finds_collective=finds_collective,
        lag_is_free="lag" not in balance.options.locked,
        sprung=tuple(balance.sprung.tolist()),
    )
    stages = stage(balance, _MOST, come_near=True), stage(balance, _MOST, come_near=False)
    return Rotors(plans, blades_of(balance), stages, limits, shapes_of(plans))


def find_in_flight(rotors: Rotors, points: int, airspeed: Array | None = None) -> InFlight:
    """Return trim and matrices of points that have no reservations, and the trims of others as far as there are any.

    Parameters
    ----------
    rotors : Rotors
        See `rotors_of`.
    points : int
    airspeed : array (points,), optional
        m/s, for rotors of one design.
    """
    found = rotors.in_flight(points, airspeed)
    none = np.full(points, "", dtype=object)
    state, before = (dict(zip(UNKNOWNS, part, strict=True)) for part in (found.state, found.before))
    trim = Trim(
        **state,
        thrust=found.thrust,
        torque=found.torque,
        converged=found.served.copy(),
        reason=none,
        warning=none.copy(),
        iterations=found.iterations,
        inflow=np.zeros(points),
    )
    return InFlight(found.served, trim, found.matrices, found.trimmed, before)
