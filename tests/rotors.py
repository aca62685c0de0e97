"""Random rotors that could be built, in flight conditions they could meet, on supports that could carry them.

The blade's mass is any non-negative distribution, so its integrals belong together; springs are sized by the frequency
they give the blade, so that a rotor is above 1/rev on purpose.
"""

from dataclasses import dataclass, replace

import numpy as np
from hypothesis import strategies as st

import proprotor as pp

SPEED_OF_SOUND = 340.3
HUB = ("x", "y", "z", "alpha_x", "alpha_y", "alpha_z")
DAMPERS = ("flap_damping", "lag_damping", "pitch_damping", "gimbal_damping")


@dataclass(frozen=True)
class Flight:
    """A rotor, how it is run, and how fast it flies."""

    rotor: pp.Rotor
    operation: pp.Operation
    airspeed: float

    @property
    def rotor_speed(self):
        return self.operation.rotor_speed

    def model(self, **options):
        rotor = self.rotor_for(options)
        return pp.rotor_model(rotor, self.operation, self.airspeed, **options)

    def on(self, support, **options):
        rotor = self.rotor_for(options)
        return pp.Case("random", rotor, self.operation, support).linearize(self.airspeed, **options)

    def rotor_for(self, options):
        """The rotor with one stiffness of its control system where couplings stand for the pitch of all harmonics."""
        if options.get("pitch") == "coupling":
            return replace(self.rotor, cyclic_control_stiffness=None)
        return self.rotor

    def with_rotor(self, **fields):
        return replace(self, rotor=replace(self.rotor, **fields))

    def without_dampers(self):
        return self.with_rotor(**dict.fromkeys(DAMPERS, 0.0))


def between(low, high):
    """A number in a range, in steps of a thousandth of it: as likely here as there, and neither tiny nor simple."""
    return st.integers(0, 1000).map(lambda step: low + (high - low) * step / 1000)


def zero_or(numbers):
    return st.just(0.0) | numbers


@st.composite
def mass_distributions(draw, radius):
    """(r, mass per length) from the centre to the tip: bare stretches allowed, but not a bare tip."""
    inner = draw(st.lists(st.integers(5, 95), min_size=1, max_size=4, unique=True))
    mass = draw(st.lists(zero_or(between(1.0, 15.0)), min_size=len(inner) + 1, max_size=len(inner) + 1))
    return radius * np.array([0, *sorted(inner), 100]) / 100, np.array([*mass, draw(between(1.0, 10.0))])


def twists(radius):
    """Linear, or a table from the centre to the tip."""
    table = st.tuples(between(0.3, 0.8), between(0.0, 0.2), between(-0.25, 0.0))
    return between(-0.9, -0.3) | table.map(
        lambda twist: (radius * np.array([0.0, 0.6, 1.0]), np.array(twist))
    )


def chords(radius):
    """Constant, or a table from the centre to the tip."""
    table = st.tuples(between(0.06, 0.12), between(0.05, 0.1), between(0.04, 0.08))
    tapered = table.map(lambda share: (radius * np.array([0.0, 0.4, 1.0]), radius * np.array(share)))
    return between(0.05, 0.12).map(lambda share: share * radius) | tapered


airfoils = st.builds(
    pp.Airfoil,
    lift_slope=between(4.5, 6.5),
    zero_lift_angle=between(-0.05, 0.01),
    drag=between(0.004, 0.02),
    moment=between(-0.03, 0.01),
)


def places_on_the_chord(radius):
    """Aft of the pitch axis, m: on it, at a place, or by a table from the centre to the tip."""
    place = between(-0.01, 0.015)
    table = st.tuples(place, place, place)
    tables = table.map(lambda share: (radius * np.array([0.0, 0.5, 1.0]), radius * np.array(share)))
    return st.just(0.0) | place.map(lambda share: share * radius) | tables


def hinge_offsets(radius, hinges):
    """(e_β, e_ζ): coincident or apart, on the centre of rotation or off it."""
    flap, gap = between(0.01, 0.12), zero_or(between(0.005, 0.1))
    flap = {"anywhere": zero_or(flap), "off centre": flap, "at centre": st.just(0.0)}[hinges]
    gap = st.just(0.0) if hinges == "at centre" else gap
    return st.tuples(flap, gap).map(lambda share: (radius * share[0], radius * sum(share)))


@st.composite
def limp_rotors(draw, radius, hinges):
    """Rotors without springs to speak of."""
    flap_hinge, lag_hinge = draw(hinge_offsets(radius, hinges))
    fraction = st.sampled_from([0.0, 1.0]) | between(0.0, 1.0)
    station, mass = draw(mass_distributions(radius))
    return pp.Rotor.from_mass_distribution(
        station,
        mass,
        mass_offset=draw(places_on_the_chord(radius)),
        pitch_inertia=1e3 * mass.max() * radius**3,  # until the springs are there
        aerodynamic_center=draw(places_on_the_chord(radius)),
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
        kinematic_pitch_flap_coupling=draw(zero_or(between(-0.4, 0.4))),
        kinematic_pitch_lag_coupling=draw(zero_or(between(-0.3, 0.3))),
        structural_pitch_offset=draw(zero_or(between(-0.5, 0.5))),
        propeller_moment=draw(st.booleans()),
        chord=draw(chords(radius)),
        twist=draw(twists(radius)),
        airfoil=draw(airfoils),
    )


@st.composite
def rotors(draw, rotor_speed, radius, *, hinges="anywhere", stiff=False):
    """Rotors of a given size, sprung for a given speed; `stiff` ones have each blade motion above 1/rev."""
    limp = draw(limp_rotors(radius, hinges))
    inertia = limp.blade_inertia
    pitch_inertia = limp.offset_mass.inertia + inertia * draw(between(2e-4, 2e-2))
    spring_per_rev = between(1.2, 1.6) if stiff else between(0.4, 1.6)
    lag_per_rev = between(1.3, 2.5) if stiff else between(0.4, 2.5)
    gimbal_share = between(0.01, 0.3) if stiff else zero_or(between(0.01, 0.3))
    control = pitch_inertia * (rotor_speed * draw(between(3.0, 6.0))) ** 2
    of_tilt = draw(st.none() | between(0.5, 2.0))
    return replace(
        limp,
        flap_stiffness=limp.flap_inertia * (rotor_speed * draw(spring_per_rev)) ** 2,
        lag_stiffness=limp.lag_inertia * (rotor_speed * draw(lag_per_rev)) ** 2,
        control_stiffness=control,
        cyclic_control_stiffness=None if of_tilt is None else of_tilt * control,
        pitch_inertia=pitch_inertia,
        propeller_inertia=draw(st.none() | between(0.8, 1.0).map(lambda share: share * pitch_inertia)),
        gimbal_stiffness=inertia * rotor_speed**2 * draw(gimbal_share),
        **{name: inertia * rotor_speed * draw(zero_or(between(1e-3, 1e-2))) for name in DAMPERS},
    )


@st.composite
def flights(draw, **kind):
    """Rotors in cruise, windmilling or at a given collective; `kind` as for `rotors`."""
    radius, tip_speed = draw(between(1.0, 6.0)), draw(between(140.0, 210.0))
    airspeed = tip_speed * draw(between(0.25, 0.75))
    aligned = np.arctan2(airspeed, 0.75 * tip_speed)
    given = between(-0.03, 0.06).map(lambda more: {"collective": aligned + more})
    operation = pp.Operation(
        rotor_speed=tip_speed / radius,
        density=draw(between(0.6, 1.3)),
        speed_of_sound=SPEED_OF_SOUND,
        trim=draw(st.just("windmill") | given),
    )
    return Flight(draw(rotors(operation.rotor_speed, radius, **kind)), operation, airspeed)


def random_support(flight, seed):
    """Six coordinates at the hub with a mass and a stiffness to match the rotor, coupled at random, undamped."""
    rng = np.random.default_rng(seed)
    rotor = flight.rotor
    scale = rotor.n_blades * np.array([rotor.blade_mass] * 3 + [rotor.blade_inertia] * 3)

    def coupled(low, high):
        factor = rng.uniform(-1, 1, (6, 6))
        matrix = (factor @ factor.T / 6 + np.eye(6)) * rng.uniform(low, high)
        return matrix * np.sqrt(np.outer(scale, scale))

    return pp.NormalModes(
        names=HUB,
        mass=coupled(0.3, 3.0),
        damping=np.zeros((6, 6)),
        stiffness=coupled(0.01, 1.0) * flight.rotor_speed**2,
        hub=np.eye(6),
        includes_rotor=False,
    )


seeds = st.integers(0, 2**31)
