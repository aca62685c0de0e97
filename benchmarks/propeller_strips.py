"""Neutral whirl of a propeller on a two-axis pivot, by strips whose lift comes late: nothing of the package.

A blade without steady load meets the air along its chord everywhere. With the section at radius r along j, turning
towards t, n across the air on it, the section moving with ẋ + α̇ × r j and turned by α,

    w = -(ẋ + α̇ × r j)·n - V K·(α × n)        dF = ½ ρ U c a C(k) w n dr

and C acts at the frequencies ω - Ω and ω + Ω at which a blade feels a motion across the shaft of frequency ω. Pitch
raises the hub along I and turns it about J, yaw moves it along J and turns it about -I, by the distance l from the
pivot.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq
from scipy.special import hankel2

_AZIMUTHS = 4  # enough for the harmonics -1 and 1, of motions across the shaft
_STRIPS = 60

Lag = Callable[[NDArray], NDArray]


class Propeller(NamedTuple):
    """Sizes in SI; inertia is that of pitch and of yaw about the pivot, the propeller included."""

    n_blades: int
    radius: float
    root_cutout: float
    chord: float
    lift_slope: float
    rotor_speed: float
    polar_inertia: float
    inertia: float
    distance: float
    airspeed: float
    density: float


def theodorsen(k: ArrayLike) -> NDArray:
    """C(k) of a change with exp(+iωt), k of either sign."""
    size = np.abs(k)
    second, first = hankel2(1, size), hankel2(0, size)
    value = second / (second + 1j * first)
    return np.where(k < 0, np.conj(value), value)


def jones(k: ArrayLike) -> NDArray:
    """Jones' approximation of C(k)."""
    return 1 - sum(a * 1j * k / (1j * k + b) for a, b in ((0.165, 0.0455), (0.335, 0.300)))


def at_once(k: ArrayLike) -> NDArray:
    """1: lift that is not late."""
    return np.ones(np.shape(k), dtype=complex)


def airloads(propeller: Propeller, omega: float, lag: Lag, *, slow_hub: bool = False) -> NDArray:
    """Generalised loads (2, 2) on pitch and yaw that move with exp(iωt), on the left of their equations.

    With `slow_hub` the lag is that of one change a turn, whatever ω is: a blade feels a hub that hardly moves at Ω.
    """
    p = propeller
    node, weight = np.polynomial.legendre.leggauss(_STRIPS)
    half = (p.radius - p.root_cutout) / 2
    r, weight = p.root_cutout + half * (1 + node), half * weight
    speed = np.hypot(p.airspeed, p.rotor_speed * r)
    sine, cosine = p.airspeed / speed, p.rotor_speed * r / speed
    axis = np.array([0.0, 0.0, 1.0])
    hub = np.array([[p.distance, 0.0], [0.0, p.distance], [0.0, 0.0]])  # displacement by pitch and yaw
    turn = np.array([[0.0, -1.0], [1.0, 0.0], [0.0, 0.0]])
    rates, displacements, works = (np.zeros((_AZIMUTHS, _STRIPS, 2)) for _ in range(3))
    for place, psi in enumerate(2 * np.pi * np.arange(_AZIMUTHS) / _AZIMUTHS):
        radial = np.array([np.cos(psi), np.sin(psi), 0.0])
        n = cosine[:, None] * axis - sine[:, None] * np.cross(axis, radial)
        for column in range(2):
            moved = hub[:, column] + np.cross(turn[:, column], r[:, None] * radial)
            rates[place, :, column] = -np.sum(moved * n, axis=-1)
            displacements[place, :, column] = -p.airspeed * np.cross(turn[:, column], n) @ axis
            works[place, :, column] = np.sum(moved * n, axis=-1)
    rates, displacements, works = (
        np.fft.fft(part, axis=0) / _AZIMUTHS for part in (rates, displacements, works)
    )
    total = np.zeros((2, 2), dtype=complex)
    for harmonic in (-1, 1):
        felt = harmonic * p.rotor_speed + (0.0 if slow_hub else omega)
        late = lag(felt * p.chord / (2 * speed))
        lift = p.n_blades * p.density * speed * p.chord * p.lift_slope / 2 * weight * late
        change = 1j * omega * rates[harmonic] + displacements[harmonic]
        total -= (works[-harmonic] * lift[:, None]).T @ change
    return total


def neutral_damping(
    propeller: Propeller, stiffness: ArrayLike, near: float, lag: Lag, *, slow_hub: bool = False
) -> float:
    """Structural damping g at which backward whirl, near a frequency in rad/s, neither grows nor decays.

    The shaft's angular momentum h K, turned by (-yaw, pitch), works h yaw˙ on pitch and -h pitch˙ on yaw.
    """
    p, springs = propeller, np.diag(stiffness)

    def dampings(omega: float) -> NDArray:
        inertia = -(omega**2) * p.inertia * np.eye(2)
        gyroscopic = 1j * omega * p.polar_inertia * p.rotor_speed * np.array([[0.0, 1.0], [-1.0, 0.0]])
        whole = inertia + gyroscopic + springs + airloads(p, omega, lag, slow_hub=slow_hub)
        found = np.linalg.eigvals(1j * np.linalg.solve(springs, whole))
        return found[np.argsort(found.real)][-1]

    omega = brentq(lambda one: dampings(one).imag, 0.85 * near, 1.15 * near, xtol=1e-12)
    return float(dampings(omega).real)
