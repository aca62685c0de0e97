"""Induced velocity of the nonlinear rotor: a field over the disk that every section meets, and what makes the field.

The field runs against the hub's axis, which the hub turns, and depends on where a section is, seen from the hub. What
makes it are the section forces along that axis. Nothing is expanded: all derivatives are complex steps.
"""

from dataclasses import replace

import numpy as np

from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import DOFS, HUB_FORCE, HUB_MOMENT, UNIT, blades, clock
from tests.oracles.virtual_work import assembled, quadrature, section_loads

STEP = 1e-30
INFLOW = ("inflow_0", "inflow_1c", "inflow_1s")
STILL = np.zeros(3)


def hub_axes(turn):
    """Columns I, J, K (..., 3, 3) turned with the hub, to second order in the turn: all that derivatives see."""
    x, y, z = np.moveaxis(turn, -1, 0)
    none = 0 * x
    cross = np.stack([none, -z, y, z, none, -x, -y, x, none], axis=-1).reshape(*np.shape(x), 3, 3)
    return np.eye(3) + cross + cross @ cross / 2


def sections(air, rotor, q, time, field, steady, wind, order=14):
    """Forces (blade, station, 3) with their weights, moments, motion, and the place of the sections on the disk."""
    station, weight = quadrature(air, rotor, order)
    motion = blades(rotor, station, q, clock(rotor, time))
    axes = hub_axes(q.value[HUB_MOMENT])
    x, y, _ = np.moveaxis(motion.arm.value @ axes, -1, 0)
    induced = steady + field[0] + (field[1] * x + field[2] * y) / air.radius
    velocity = motion.position.rate + induced[..., None] * axes[:, 2] - wind
    motion = replace(motion, position=Motion(motion.position.value, velocity, motion.position.acceleration))
    force, moment = section_loads(air, station, motion)
    return station, force * weight[:, None], moment * weight, motion, (x, y, axes[:, 2])


def rows(air, rotor, q, time, field=STILL, steady=0.0, wind=STILL):
    """What airloads add to the left of the rotor's equations, and the loads that make the inflow with their sign."""
    station, force, moment, motion, (x, y, axis) = sections(air, rotor, q, time, field, steady, wind)
    along = force @ axis
    made = [along.sum(), (along * x).sum() / air.radius, (along * y).sum() / air.radius]
    of_rotor = assembled(rotor, station, q, time, motion, force, moment)
    speed = (np.array([0.0, 0.0, air.airspeed]) + q.rate[HUB_FORCE] - wind) @ axis
    return -np.concatenate([of_rotor, np.array(made) - by_momentum(air, field, steady, speed)])


def by_momentum(air, field, steady, speed):
    """Thrust, and moments over the radius, that the air takes for an inflow which stays as it is."""
    area, whole = np.pi * air.radius**2, steady + field[0]
    mean = air.airspeed + steady
    return np.array(
        [2 * air.density * area * whole * (speed + whole), *(air.density * area / 2 * mean * field[1:])]
    )


def apparent_masses(air):
    """Air around a disk that is pushed (8/3 rho R³) and one that is turned (16/45 rho R⁵), over R² of the latter."""
    return air.density * air.radius**3 * np.array([8 / 3, 16 / 45, 16 / 45])


def linearised(air, rotor, trim, steady, time=0.0):
    """C and K (21, 21) of airloads and momentum on the left, and loads (21, 3) of gusts along I, J, K on the right."""
    n = len(DOFS) + len(INFLOW)
    C, K, B = np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, 3))

    def derivative(q, **more):
        return rows(air, rotor, q, time, steady=steady, **more).imag / STEP

    for place, unit in enumerate(1j * STEP * UNIT):
        C[:, place] = derivative(Motion(trim, unit))
        K[:, place] = derivative(Motion(trim + unit))
    for place, unit in enumerate(1j * STEP * np.eye(3)):
        C[:, len(DOFS) + place] = derivative(Motion(trim), field=unit)
        B[:, place] = -derivative(Motion(trim), wind=unit)
    return C, K, B


def thrust(air, rotor, trim, steady):
    """Thrust of the rotor with a uniform induced velocity."""
    made = rows(air, rotor, Motion(trim + 0j), 0.0, steady=steady)
    momentum = by_momentum(air, STILL, steady, air.airspeed)[0]
    return float((momentum - made[len(DOFS)]).real)
