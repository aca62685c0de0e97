"""Random rotors around a full-scale tiltrotor (the XV-15 of AIAA-2002-1604), every parameter at work.

Each is built twice: for the package of mass integrals, and for the oracle of the point masses behind them.
"""

from dataclasses import dataclass, fields

import numpy as np

import proprotor as pp
from tests.oracles.nonlinear_rotor import NonlinearRotor, trim_coordinates
from tests.oracles.virtual_work import Aerodynamics

SPEED_OF_SOUND = 340.3
DENSITY = 1.1
NO_OFFSETS = {"mass_offset": 0.0, "aerodynamic_center": 0.0, "propeller_inertia": None}
NO_LINKAGES = dict.fromkeys(("kinematic_pitch_flap_coupling", "kinematic_pitch_lag_coupling"), 0.0)


@dataclass(frozen=True)
class Pair:
    """The same rotor twice."""

    package: pp.Rotor
    fields: dict  # of the rotor, as given to the package
    station: np.ndarray
    mass: np.ndarray
    offset: np.ndarray  # of the masses, aft of the pitch axis
    rotor_speed: float

    def oracle(self, trim):
        """The nonlinear rotor at the collective of a trim, and its steady coordinates."""
        names = {field.name for field in fields(NonlinearRotor)} & set(self.fields)
        rotor = NonlinearRotor(
            **{name: self.fields[name] for name in names},
            station=self.station,
            mass=self.mass,
            mass_offset=self.offset,
            mass_twist=self.twist_at(self.station),
            rotor_speed=self.rotor_speed,
            collective=float(trim.collective),
        )
        return rotor, trim_coordinates(float(trim.coning), float(trim.lag), float(trim.elastic_pitch))

    @property
    def twist(self):
        """A table (radius, value) from three quarters of the radius."""
        return twist_from_reference(self.fields["twist"], self.fields["radius"])

    def twist_at(self, station):
        return np.interp(station, *self.twist)

    def air(self, airspeed, density, compressibility=True, section_damping=True):
        airfoil, radius = self.fields["airfoil"], self.fields["radius"]
        regions = isinstance(airfoil, pp.AirfoilRegions)
        return Aerodynamics(
            airspeed=airspeed,
            density=density,
            speed_of_sound=SPEED_OF_SOUND,
            radius=radius,
            root_cutout=self.fields["root_cutout"],
            chord=tabulated(self.fields["chord"], radius),
            twist=self.twist,
            aerodynamic_center=tabulated(self.fields["aerodynamic_center"], radius),
            **(of_regions(airfoil, radius) if regions else vars(airfoil)),
            compressibility=compressibility,
            section_damping=section_damping,
        )


def tabulated(given, radius, linear=False):
    """A table (radius, value): as given, or of a number, constant or growing linearly from the centre."""
    if isinstance(given, tuple):
        return given
    return np.array([0.0, radius]), given * np.array([0.0 if linear else 1.0, 1.0])


def twist_from_reference(given, radius):
    """The twist as a table (radius, value) that is zero at three quarters of the radius."""
    station, twist = tabulated(given, radius, linear=True)
    return station, twist - np.interp(0.75 * radius, station, twist)


def offset_mass(station, mass, offset, twist, lag_hinge_offset):
    """The integrals of masses beside the axis, of those beyond the lag hinge."""
    lag_arm = np.maximum(station - lag_hinge_offset, 0.0)
    x = np.where(lag_arm > 0, offset, 0.0)
    cosine, sine = x * np.cos(twist), x * np.sin(twist)
    return pp.OffsetMass(
        offset_cosine_moment=mass @ cosine,
        offset_sine_moment=mass @ sine,
        offset_cosine_lag_inertia=mass @ (cosine * lag_arm),
        offset_sine_lag_inertia=mass @ (sine * lag_arm),
        offset_cosine_inertia=mass @ cosine**2,
        offset_product_inertia=mass @ (cosine * sine),
        offset_sine_inertia=mass @ sine**2,
    )


def of_regions(airfoils, radius):
    """The coefficients of airfoils from root to tip, and the radii between which one passes into the next."""
    names = [field.name for field in fields(pp.Airfoil)]
    found = {name: tuple(getattr(airfoil, name) for airfoil in airfoils.airfoils) for name in names}
    widths = np.broadcast_to(airfoils.blend, np.shape(airfoils.region_ends))
    pairs = zip(airfoils.region_ends, widths, strict=True)
    return found | {"joints": tuple((radius * (r - w / 2), radius * (r + w / 2)) for r, w in pairs)}


def mass_integrals(station, mass, flap_hinge_offset, lag_hinge_offset):
    """The seven the package asks for."""
    flap_arm = np.maximum(station - flap_hinge_offset, 0.0)
    lag_arm = np.maximum(station - lag_hinge_offset, 0.0)
    return {
        "blade_mass": mass.sum(),
        "blade_first_moment": mass @ station,
        "blade_inertia": mass @ station**2,
        "flap_first_moment": mass @ flap_arm,
        "flap_inertia": mass @ flap_arm**2,
        "lag_first_moment": mass @ lag_arm,
        "lag_inertia": mass @ lag_arm**2,
    }


def random_rotor(seed, n_blades=None, tables=False, **changes):
    """A rotor with hinges outboard of the cutout and no parameter at zero."""
    rng = np.random.default_rng(seed)
    radius = 3.81
    flap_hinge_offset, gap = rng.uniform(0.3, 0.5), rng.uniform(0.0, 0.3)
    station = np.sort(rng.uniform(0.03, 0.98, 7)) * radius
    mass = rng.uniform(4.0, 12.0, 7)
    given = {
        "n_blades": n_blades or int(rng.integers(3, 6)),
        "radius": radius,
        "flap_hinge_offset": flap_hinge_offset,
        "lag_hinge_offset": flap_hinge_offset + gap,
        "precone": rng.uniform(0.02, 0.08),
        "flap_stiffness": rng.uniform(2e5, 5e5),
        "lag_stiffness": rng.uniform(8e5, 1.5e6),
        "flap_outboard_fraction": rng.uniform(0.1, 0.9),
        "lag_outboard_fraction": rng.uniform(0.1, 0.9),
        "gimbal_stiffness": rng.uniform(1e4, 4e4),
        "pitch_gimbal_coupling": rng.uniform(-0.4, -0.1),
        "pitch_inertia": rng.uniform(1.0, 2.0),
        "control_stiffness": rng.uniform(3e4, 6e4),
        "flap_damping": rng.uniform(100.0, 400.0),
        "lag_damping": rng.uniform(100.0, 400.0),
        "pitch_damping": rng.uniform(2.0, 9.0),
        "gimbal_damping": rng.uniform(50.0, 200.0),
        "structural_pitch_offset": rng.uniform(-0.3, 0.3),
        "propeller_moment": True,
        "chord": rng.uniform(0.3, 0.4),
        "twist": rng.uniform(-0.8, -0.5),
        "root_cutout": rng.uniform(0.15, 0.25),
        "airfoil": pp.Airfoil(
            lift_slope=rng.uniform(5.5, 6.2),
            zero_lift_angle=rng.uniform(-0.04, -0.01),
            drag=rng.uniform(0.006, 0.02),
            moment=rng.uniform(-0.03, -0.01),
        ),
    }
    if tables:
        given["chord"] = (np.array([0.0, 0.35, 1.0]) * radius, np.array([0.45, 0.4, 0.25]))
        given["twist"] = (np.array([0.0, 0.25, 0.6, 1.0]) * radius, np.array([0.7, 0.3, 0.1, -0.1]))
    # Drawn from numbers of their own, so that the others are what they were.
    linkages = np.random.default_rng([seed, 3])
    given["kinematic_pitch_flap_coupling"] = linkages.uniform(0.1, 0.5)
    given["kinematic_pitch_lag_coupling"] = linkages.uniform(-0.4, -0.1)
    beside = np.random.default_rng([seed, 4])
    given["mass_offset"] = beside.uniform(-0.03, 0.06, len(mass))  # of the masses, aft of the pitch axis
    given["aerodynamic_center"] = beside.uniform(0.01, 0.03)
    given["propeller_inertia"] = beside.uniform(0.7, 0.95) * given["pitch_inertia"]
    if tables:
        given["aerodynamic_center"] = (np.array([0.0, 0.5, 1.0]) * radius, np.array([-0.02, 0.03, 0.01]))
    given |= changes
    offset = given.pop("mass_offset") + 0 * mass
    given |= mass_integrals(station, mass, given["flap_hinge_offset"], given["lag_hinge_offset"])
    if offset.any():
        twist = np.interp(station, *twist_from_reference(given["twist"], radius))
        given["offset_mass"] = offset_mass(station, mass, offset, twist, given["lag_hinge_offset"])
    rotor_speed = rng.uniform(40.0, 55.0)
    return Pair(pp.Rotor(**given), given, station, mass, offset, rotor_speed)


class RotorInAir:
    """A rotor in the air, in the package and in the oracle."""

    def __init__(self, seed, airspeed, trim, compressibility=True, section_damping=True, **rotor):
        self.pair = random_rotor(seed, **rotor)
        self.airspeed = airspeed
        self.switches = {"compressibility": compressibility, "section_damping": section_damping}
        self.operation = pp.Operation(
            rotor_speed=self.pair.rotor_speed, density=DENSITY, speed_of_sound=SPEED_OF_SOUND, trim=trim
        )
        self.air = self.pair.air(airspeed, DENSITY, **self.switches)

    def model(self, airspeed=None, **options):
        speed = self.airspeed if airspeed is None else airspeed
        model = pp.rotor_model(self.pair.package, self.operation, speed, **self.switches, **options)
        assert np.all(model.trim.converged), model.trim.reason
        return model
