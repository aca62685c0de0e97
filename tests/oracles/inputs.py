"""What gusts and the swashplate load the nonlinear rotor with, per unit: columns of B in M q̈ + C q̇ + K q = B u.

A gust carries the air past the sections. The swashplate adds an angle to the pitch Θs of each blade, constant in
fixed axes: it moves no faster than the rotor turns it.
"""

from dataclasses import replace

import numpy as np

from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import PITCH, blades, clock, linearised, rows_in_vacuum
from tests.oracles.virtual_work import assembled, lift_slope_loads, quadrature, section_loads

_STEP = 1e-30
_GUSTS = 1j * _STEP * np.eye(3)  # along I, J and K


def gust_columns(air, rotor, trim, time):
    """Loads (18, 3) per unit of the velocity of the air along I, J, K, the rotor at its trim."""
    return _gust_columns(air, rotor, trim, time, lambda station, motion: section_loads(air, station, motion))


def lift_slope_gust_columns(air, rotor, trim, time):
    """The same with only the terms proportional to c_lα."""
    station, _ = quadrature(air, rotor)
    steady = blades(rotor, station, Motion(trim), clock(rotor, time))
    return _gust_columns(
        air, rotor, trim, time, lambda station, motion: lift_slope_loads(air, station, motion, steady)
    )


def _gust_columns(air, rotor, trim, time, loads):
    station, weight = quadrature(air, rotor)
    q = Motion(np.broadcast_to(trim, (3, len(trim))))
    motion = blades(rotor, station, q, clock(rotor, time))
    drifting = Motion(np.zeros((3, 1, 1, 3)), _GUSTS[:, None, None, :])
    force, moment = loads(station, replace(motion, position=motion.position - drifting))
    rows = assembled(rotor, station, q, time, motion, force * weight[:, None], moment * weight)
    return rows.imag.T / _STEP


def swashplate_columns(rotor, trim, time, airloads):
    """Loads (18, 3) per unit of collective and cyclics that the blades follow at once; `airloads` as `airload_rows`.

    Elastic pitch does the same to Θs; what else it does, it does to the control system.
    """
    follower = replace(rotor, control_stiffness=0.0, pitch_damping=0.0)

    def rows(q, instant):
        return rows_in_vacuum(follower, q, instant) + airloads(follower, q, instant)

    return -_pitch_columns(rows, trim, time)


def control_columns(rotor, trim, time):
    """Loads (18, 3) per unit of collective and cyclics that pull at the pitch of the blades with K_θ and C_θ.

    With θ the pitch perturbation and u the swashplate's, the spring holds ½ K_θ (θ − u)²; a held cyclic turns the blade
    once a revolution against the damper.
    """
    free = replace(rotor, control_stiffness=0.0, pitch_damping=0.0)
    held, loose = (
        _pitch_columns(lambda q, instant, r=r: rows_in_vacuum(r, q, instant), trim, time)
        for r in (rotor, free)
    )
    return held - loose


def _pitch_columns(rows, trim, time):
    _, _, K = linearised(rows, trim, time)
    return K[:, PITCH : PITCH + 3]
