"""Lag of lift in the frequency domain, section by section, on the nonlinear rotor: no states and no shape functions.

Circulation of each section, c/2 times U c_l, comes late by Jones' function of the section's own reduced frequency. In
the fixed frame a motion exp(st) reaches a blade with the harmonics s + ihΩ, and so do the loads that it brings back.
"""

import numpy as np

from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import HUB_FORCE, UNIT, blades, clock
from tests.oracles.virtual_work import about_axis, assembled, quadrature, section_flow

STEP = 1e-30
AZIMUTHS = 4  # enough for the harmonics -1, 0 and 1
SHARES, RATES = (0.165, 0.335), (0.0455, 0.300)  # NACA Report 681, in half chords


def jones(reduced):
    """C(s c/2U) by Jones: what is left of a lift that changes with exp(st); `reduced` is s c/2U."""
    return 1 - sum(share * reduced / (reduced + rate) for share, rate in zip(SHARES, RATES, strict=True))


def change_of_circulation(air, station, motion):
    """U c_l of every section."""
    flow = section_flow(air, station, motion)
    return flow.speed * air.lift_slope * flow.prandtl_glauert * (flow.lift_incidence - air.zero_lift_angle)


def what_lag_adds(air, rotor, trim, s, order=14):
    """What the lag of lift adds to s² M + s C + K on the left, and to the loads of gusts along I, J, K on the right."""
    station, weight = quadrature(air, rotor, order)
    chord = np.interp(station, *air.chord)
    works, rates, displacements = [], [], []
    for azimuth in 2 * np.pi * np.arange(AZIMUTHS) / AZIMUTHS:
        time = azimuth / rotor.rotor_speed
        shaft = clock(rotor, time)
        steady = blades(rotor, station, Motion(trim), shaft)
        flow = section_flow(air, station, steady)
        angle, force = flow.inflow[0].real, 0.5 * air.density * chord * flow.speed[0].real * weight
        direction = np.sin(angle)[:, None] * steady.chordwise.value[0].real
        direction = direction + np.cos(angle)[:, None] * steady.normal.value[0].real
        loads = np.zeros((len(station), rotor.n_blades, len(station), 3))
        every = np.arange(len(station))
        loads[every, 0, every] = force[:, None] * direction  # of the first blade, a section at a time
        turning = about_axis(air, station, steady, loads).real
        works.append(assembled(rotor, station, Motion(trim), time, steady, loads, turning).real)
        for found, moved in (
            (rates, Motion(trim, 1j * STEP * UNIT)),
            (displacements, Motion(trim + 1j * STEP * UNIT)),
        ):
            changed = change_of_circulation(air, station, blades(rotor, station, moved, shaft))
            found.append(np.imag(changed[:, 0]).T / STEP)
    speed = flow.speed[0].real
    works, rates, displacements = (
        np.fft.fft(part, axis=0) / AZIMUTHS for part in map(np.array, (works, rates, displacements))
    )
    added, gusts = 0.0, 0.0
    for harmonic in (-1, 0, 1):
        late = 1 - jones((s + 1j * harmonic * rotor.rotor_speed) * chord / (2 * speed))
        held = rotor.n_blades * (works[-harmonic].T * late)
        added = added + held @ (s * rates[harmonic] + displacements[harmonic])
        gusts = gusts + held @ rates[harmonic][:, HUB_FORCE]
    return added, gusts
