"""Lift-slope airloads are the full ones of a rotor without lift, drag or moment in trim: there is none to be turned.

To 1e-9 of the largest entry of each block.
"""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from tests.oracles.comparison import assert_matrices_match
from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import blades, clock
from tests.oracles.random_rotors import NO_LINKAGES, NO_OFFSETS, SPEED_OF_SOUND, random_rotor
from tests.oracles.virtual_work import section_flow

ZERO_LIFT = -0.03
AIRSPEED, DENSITY = 95.0, 1.1


def operation(pair, density, trim):
    return pp.Operation(
        rotor_speed=pair.rotor_speed, density=density, speed_of_sound=SPEED_OF_SOUND, trim=trim
    )


class Feathered:
    """A rotor bent by its precone and springs alone, each section turned into the flow it meets in trim."""

    def __init__(self, seed, **options):
        airfoil = pp.Airfoil(lift_slope=5.8, zero_lift_angle=ZERO_LIFT)
        self.pair = random_rotor(seed, airfoil=airfoil, **NO_LINKAGES, **NO_OFFSETS)
        self.options = {
            "compressibility": False,
            "section_damping": False,
        } | options  # its moment has no slope in it
        self.collective = 0.8
        for _ in range(12):  # the inflow depends on the deflection, and that on the collective, a little
            self.deflected = self.in_vacuum()
            aligned = self.inflow(0.75 * self.pair.fields["radius"]) + ZERO_LIFT
            self.collective = float(aligned - self.deflected.trim.elastic_pitch)

    def in_vacuum(self):
        collective = {"collective": self.collective}
        return pp.rotor_model(
            self.pair.package, operation(self.pair, 0.0, collective), AIRSPEED, **self.options
        )

    def inflow(self, r):
        """Inflow angle at radii r of the deflected blade, by the nonlinear rotor."""
        rotor, trim = self.pair.oracle(self.deflected.trim)
        r = np.asarray(r)
        motion = blades(rotor, r.ravel(), Motion(trim), clock(rotor, 0.0))
        return section_flow(self.pair.air(AIRSPEED, DENSITY), r.ravel(), motion).inflow[0].reshape(r.shape)

    def model(self, airloads, trim):
        rotor = replace(self.pair.package, twist=self.inflow)
        return pp.rotor_model(
            rotor, operation(self.pair, DENSITY, trim), AIRSPEED, airloads=airloads, **self.options
        )


ROTORS = {
    "windmilling": (1, "windmill", {}),
    "at a collective": (2, "collective", {}),
    "rigid pitch": (3, "windmill", {"pitch": "rigid"}),
    "couplings": (
        4,
        "windmill",
        {"pitch": "coupling", "pitch_flap_coupling": 0.3, "pitch_lag_coupling": -0.4},
    ),
    "locked lag": (5, "windmill", {"locked": ("lag",)}),
}


@pytest.mark.parametrize("name", ROTORS)
def test_lift_slope_airloads_are_the_full_ones_without_trim_lift(name):
    seed, given, options = ROTORS[name]
    feathered = Feathered(seed, **options)
    trim = {"collective": feathered.collective} if given == "collective" else given
    full, lift_slope = (feathered.model(airloads, trim) for airloads in ("full", "lift-slope"))
    bare = feathered.model("none", trim)
    assert np.isclose(full.trim.collective, feathered.collective, rtol=0, atol=1e-11)
    assert np.isclose(full.trim.coning, feathered.deflected.trim.coning, rtol=0, atol=1e-11)
    assert abs(full.trim.coning) + abs(full.trim.lag) > 1e-3, "the blade must bend for this to test anything"
    airloads = [[getattr(m, name) - getattr(bare, name) for name in "MCK"] for m in (lift_slope, full)]
    speed = feathered.pair.rotor_speed
    assert_matrices_match(*airloads, bare.M, speed, full.dofs, relative=1e-9, rounding=1e-13)
    assert np.abs(full.B - lift_slope.B).max() <= 1e-9 * np.abs(full.B).max()


def test_trim_lift_makes_the_difference():
    """The same rotor at a collective that lifts."""
    feathered = Feathered(0)
    trim = {"collective": feathered.collective + 0.05}
    full, lift_slope = (feathered.model(airloads, trim) for airloads in ("full", "lift-slope"))
    assert np.abs(full.C - lift_slope.C).max() > 1e-3 * np.abs(full.C).max()
