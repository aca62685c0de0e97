"""The nonlinear rotor in a wind at an angle, its hub turning steadily: positions in a frame that turns with the hub.

The reference frame coincides with the inertial one at the instant in question. Coordinates of the hub are relative to
the frame: a displacement x and a small rotation a of the frame's hub are, seen from inertial axes,

    x' = w x x + x'       x'' = w x (w x x) + 2 w x x' + x''

and for the rotation, whose vector is composed with the turn so far, w t, by the Baker-Campbell-Hausdorff series

    a' = w x a / 2 + a'       a'' = w x (w x a) / 6 + w x a' + a''

The axial part of the wind is the airspeed of the oracle; the rest is a velocity of the hub.
"""

from dataclasses import dataclass

import numpy as np

from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import (
    FLAP,
    GIMBAL_C,
    HUB_FORCE,
    HUB_MOMENT,
    LAG,
    PITCH,
    UNIT,
    rows_in_vacuum,
)
from tests.oracles.virtual_work import airload_rows

GRAVITY = 9.80665
STEP = 1e-30


@dataclass(frozen=True)
class TiltedFlight:
    """Velocity of the hub beside the airspeed along K, and the turn of its frame; I is up, K forward."""

    beside: np.ndarray
    velocity: np.ndarray
    turn: np.ndarray

    @classmethod
    def of(cls, airspeed, shaft_angle, load_factor):
        """A shaft above the direction of flight, in a pull-up of so many g."""
        velocity = airspeed * np.array([-np.sin(shaft_angle), 0.0, np.cos(shaft_angle)])
        beside = velocity * [1.0, 1.0, 0.0]
        return cls(beside, velocity, np.array([0.0, GRAVITY * (load_factor - 1) / airspeed, 0.0]))

    def seen(self, q):
        """Coordinates of a frame that turns with the hub, as the oracle's own."""
        value, rate, acceleration = (
            np.array(part, dtype=complex) for part in (q.value, q.rate, q.acceleration)
        )
        value, rate, acceleration = np.broadcast_arrays(value, rate, acceleration)
        rate, acceleration = rate.copy(), acceleration.copy()
        w = self.turn
        x, xdot = value[..., HUB_FORCE], q.rate[..., HUB_FORCE]
        rate[..., HUB_FORCE] += np.cross(w, x) + self.beside
        acceleration[..., HUB_FORCE] += np.cross(w, np.cross(w, x)) + 2 * np.cross(w, xdot)
        acceleration[..., HUB_FORCE] += np.cross(w, self.velocity)
        a, adot = value[..., HUB_MOMENT], q.rate[..., HUB_MOMENT]
        rate[..., HUB_MOMENT] += w + np.cross(w, a) / 2
        acceleration[..., HUB_MOMENT] += np.cross(w, np.cross(w, a)) / 6 + np.cross(w, adot)
        return Motion(value, rate, acceleration)

    def rows(self, air, rotor, q, time, order=14):
        """Left-hand side of the equations of motion."""
        seen = self.seen(q)
        return rows_in_vacuum(rotor, seen, time) + airload_rows(air, rotor, seen, time, order)

    def linearised(self, air, rotor, trim, time):
        """M, C, K about coordinates that move, by a complex step."""
        moved = 1j * STEP * UNIT
        changes = (
            Motion(trim.value, trim.rate, trim.acceleration + moved),
            Motion(trim.value, trim.rate + moved, trim.acceleration),
            Motion(trim.value + moved, trim.rate, trim.acceleration),
        )
        return tuple(np.imag(self.rows(air, rotor, change, time)).T / STEP for change in changes)


def harmonics_of(samples):
    """Complex harmonics of values at equal steps of azimuth along the first axis, from 0 up."""
    found = np.fft.rfft(np.asarray(samples, dtype=float), axis=0) / len(samples)
    found[1:] *= 2
    return found[: len(samples) // 2]


def at(harmonics, azimuth, order):
    """A derivative with azimuth of the sum of harmonics."""
    n = np.arange(len(harmonics)).reshape(-1, *(1,) * (harmonics.ndim - 1))
    return np.real(((1j * n) ** order * harmonics * np.exp(1j * n * azimuth)).sum(axis=0))


def coordinates_of(rotor, angles, tilt, time):
    """Coordinates of three blades whose angles, and a gimbal whose tilt, are given at steps of azimuth of a blade.

    Any three angles are those of a multiblade transform.
    """
    assert rotor.n_blades == 3
    parts, omega = [], rotor.rotor_speed
    psi = omega * time + 2 * np.pi / 3 * np.arange(3)
    blade, gimbal = harmonics_of(angles), harmonics_of(tilt)
    waves = np.array([np.ones(3) / 3, 2 / 3 * np.cos(psi), 2 / 3 * np.sin(psi)])
    slopes = np.array([0 * psi, -2 / 3 * np.sin(psi), 2 / 3 * np.cos(psi)])
    curvatures = np.array([0 * psi, -2 / 3 * np.cos(psi), -2 / 3 * np.sin(psi)])
    by_order = [np.array([at(blade, one, order) for one in psi]) for order in range(3)]
    of_blades = [
        waves @ by_order[0],
        waves @ by_order[1] + slopes @ by_order[0],
        waves @ by_order[2] + 2 * slopes @ by_order[1] + curvatures @ by_order[0],
    ]
    for order in range(3):
        q = np.zeros(18)
        for place, first in enumerate((FLAP, LAG, PITCH)):
            q[first : first + 3] = of_blades[order][:, place]
        q[GIMBAL_C : GIMBAL_C + 2] = at(gimbal, omega * time, order)
        parts.append(q * omega**order)
    return Motion(*parts)
