"""Random rotors that could be built, in flight conditions they could meet.

The blade's mass is any non-negative distribution, so its integrals belong together; springs are sized by the frequency
they give the blade, so that a rotor is above or below 1/rev on purpose.
"""

from dataclasses import dataclass, replace

import numpy as np
from hypothesis import strategies as st

import proprotor as pp

SPEED_OF_SOUND = 340.3
DAMPERS = ("flap_damping", "lag_damping", "pitch_damping", "gimbal_damping")


@dataclass(frozen=True)
class Flight:
    """A rotor, how it is run, and how fast it flies."""

    rotor: pp.Rotor
    operation: pp.Operation
    airspeed: float

    def model(self, **options):
        return pp.rotor_model(self.rotor, self.operation, self.airspeed, **options)

    def changed(self, **rotor_fields):
        return replace(self, rotor=replace(self.rotor, **rotor_fields))

    def without_dampers(self):
        return self.changed(**dict.fromkeys(DAMPERS, 0.0))


def between(low, high):
    """A number in a range: `low`, and the end points, are drawn more often than by chance."""
    return st.floats(low, high).map(lambda value: round(value, 4))


def zero_or(strategy):
    return st.just(0.0) | strategy


@st.composite
def mass_distributions(draw, radius):
    """(r, mass per length) from the centre to the tip; bare stretches allowed, but not at the tip."""
    inner = draw(st.lists(between(0.05, 0.95), min_size=1, max_size=4, unique_by=lambda share: round(share, 2)))
    mass = draw(st.lists(zero_or(between(1.0, 15.0)), min_size=len(inner) + 1, max_size=len(inner) + 1))
    return radius * np.array([0.0, *sorted(inner), 1.0]), np.array([*mass, draw(between(1.0, 10.0))])


def twists(radius):
    """Linear, or a table from the centre to the tip."""
    root, mid, tip = between(0.3, 0.8), between(0.0, 0.2), between(-0.25, 0.0)
    table = st.tuples(root, mid, tip).map(lambda twist: (radius * np.array([0.0, 0.6, 1.0]), np.array(twist)))
    return between(-0.9, -0.3) | table


def chords(radius):
    """Constant, or a table from the centre to the tip."""
    table = st.tuples(between(0.06, 0.12), between(0.04, 0.08)).map(
        lambda share: (radius * np.array([0.0, 0.5, 1.0]), radius * np.array([share[0], share[0], share[1]]))
    )
    return between(0.05, 0.12).map(lambda share: share * radius) | table


airfoils = st.builds(
    pp.Airfoil,
    lift_slope=between(4.5, 6.5),
    zero_lift_angle=between(-0.05, 0.01),
    drag=between(0.004, 0.02),
    moment=between(-0.03, 0.01),
)


@st.composite
def rotors(draw, rotor_speed, radius, hinges_off_centre=False, stiff=None):
    """Rotors at a given speed and size.

    `stiff` asks for blade springs that put flap and lag above 1/rev; else lag may be soft in-plane.
    """
    off_centre = between(0.01, 0.12)
    flap_hinge = radius * draw(off_centre if hinges_off_centre else zero_or(off_centre))
    lag_hinge = flap_hinge + radius * draw(zero_or(between(0.005, 0.1)))
    fraction = st.sampled_from([0.0, 1.0]) | between(0.0, 1.0)
    station, mass = draw(mass_distributions(radius))
    limp = pp.Rotor.from_mass_distribution(
        station,
        mass,
        n_blades=draw(st.integers(3, 6)),
        radius=radius,
        root_cutout=radius * draw(between(0.05, 0.3)),
        flap_hinge_offset=flap_hinge,
        lag_hinge_offset=lag_hinge,
        precone=draw(zero_or(between(-0.02, 0.08))),
        flap_stiffness=1.0,
        lag_stiffness=1.0,
        flap_outboard_fraction=draw(fraction),
        lag_outboard_fraction=draw(fraction),
        pitch_gimbal_coupling=draw(zero_or(between(-0.6, 0.6))),
        structural_pitch_offset=draw(zero_or(between(-0.5, 0.5))),
        propeller_moment=draw(st.booleans()),
        chord=draw(chords(radius)),
        twist=draw(twists(radius)),
        airfoil=draw(airfoils),
    )
    centrifugal = limp.blade_inertia * rotor_speed**2
    pitch_inertia = limp.blade_inertia * draw(between(2e-4, 2e-2))
    lag_per_rev = between(1.3, 2.5) if stiff else between(0.3, 2.5)
    return replace(
        limp,
        flap_stiffness=limp.flap_inertia * rotor_speed**2 * draw(between(0.8 if stiff else 0.1, 2.0)),
        lag_stiffness=limp.lag_inertia * rotor_speed**2 * draw(lag_per_rev) ** 2,
        gimbal_stiffness=centrifugal * draw(zero_or(between(0.01, 0.3))),
        pitch_inertia=pitch_inertia,
        control_stiffness=pitch_inertia * rotor_speed**2 * draw(between(3.0, 6.0)) ** 2,
        **{name: centrifugal / rotor_speed * draw(zero_or(between(1e-3, 1e-2))) for name in DAMPERS},
    )


@st.composite
def flights(draw, **rotor_choices):
    """Rotors in cruise, windmilling or at a given collective."""
    radius = draw(between(1.0, 6.0))
    tip_speed = draw(between(140.0, 210.0))
    airspeed = tip_speed * draw(between(0.25, 0.75))
    aligned = np.arctan2(airspeed, 0.75 * tip_speed)
    trim = draw(st.just("windmill") | between(-0.03, 0.06).map(lambda extra: {"collective": aligned + extra}))
    operation = pp.Operation(
        rotor_speed=tip_speed / radius,
        density=draw(between(0.6, 1.3)),
        speed_of_sound=SPEED_OF_SOUND,
        trim=trim,
    )
    return Flight(draw(rotors(operation.rotor_speed, radius, **rotor_choices)), operation, airspeed)
