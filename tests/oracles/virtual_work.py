"""Airloads of the nonlinear rotor by virtual work: quasi-steady blade elements in axial flight.

Section by section the flow is resolved in axes turned with the hub, the yoke and the blade. Blade rows are
the virtual work of the section forces and moments; hub rows are their resultants about the displaced hub in
inertial axes. All of it changes sign: the equations of motion have the airloads on their left-hand side.
"""

from dataclasses import dataclass

import numpy as np

from tests.oracles.motion import Motion, scaled
from tests.oracles.nonlinear_rotor import (
    DOFS,
    GENERALISED,
    HUB_FORCE,
    HUB_MOMENT,
    NonlinearRotor,
    beside_axis,
    blades,
    clock,
    virtual_displacements,
)


@dataclass(frozen=True)
class Aerodynamics:
    """The air, and what it acts on. `chord` and `twist` are tables (radius, value), linear in between.

    With `joints`, radii (inner, outer) between which one airfoil passes into the next, a coefficient may be a tuple.
    """

    airspeed: float
    density: float
    speed_of_sound: float
    radius: float
    root_cutout: float
    chord: tuple
    twist: tuple
    lift_slope: float
    zero_lift_angle: float
    drag: float
    moment: float
    compressibility: bool = True
    section_damping: bool = True
    joints: tuple = ()
    aerodynamic_center: tuple = ((0.0, 1.0), (0.0, 0.0))  # aft of the pitch axis, a table like the chord

    def center(self, station):
        """How far aft of the pitch axis the aerodynamic centre lies, and the twist of its chord."""
        return np.interp(station, *self.aerodynamic_center), np.interp(station, *self.twist)

    def along(self, station, value_of):
        """The sum over all regions of `value_of` a region's number, times the region's share at the stations."""
        if not self.joints:
            return value_of(0)
        passed = [
            np.ones_like(station),
            *(rise(station, *joint) for joint in self.joints),
            np.zeros_like(station),
        ]
        return sum((passed[k] - passed[k + 1]) * value_of(k) for k in range(len(passed) - 1))

    def of(self, name, region):
        """A coefficient of a region: the same everywhere, or one of a list from root to tip."""
        value = getattr(self, name)
        return value[region] if isinstance(value, tuple) else value


def rise(station, inner, outer):
    """From 0 to 1 on a straight line, or at once where both radii are one."""
    return np.where(
        station < inner, 0.0, np.where(station >= outer, 1.0, (station - inner) / (outer - inner or 1.0))
    )


def quadrature(air: Aerodynamics, rotor: NonlinearRotor, order=14):
    """Gauss–Legendre stations and weights on panels split wherever the integrand has a corner.

    Fourteen points integrate the smooth panels to rounding; the nearest singularities (V/Ω off the real axis,
    and sonic speed) are about a panel length away.
    """
    tables = (air.chord[0], air.twist[0], air.aerodynamic_center[0])
    corners = {rotor.flap_hinge_offset, rotor.lag_hinge_offset}.union(*tables, *air.joints)
    edges = [air.root_cutout, *sorted(c for c in corners if air.root_cutout < c < air.radius), air.radius]
    node, weight = np.polynomial.legendre.leggauss(order)
    middle, half = (np.add(edges[1:], edges[:-1]) / 2)[:, None], (np.diff(edges) / 2)[:, None]
    return (middle + half * node).ravel(), (half * weight).ravel()


@dataclass(frozen=True)
class Flow:
    """The flow a section meets: speed U and inflow angle φ across the span, at its quarter chord.

    u_R, along the span, is that of the pitch axis, where the radial drag acts. The section's rotation about the span
    moves its 3/4 chord, half a chord aft, down through the air: the incidence there makes the lift.
    """

    speed: np.ndarray
    inflow: np.ndarray
    radial: np.ndarray
    angle_of_attack: np.ndarray
    rotation: np.ndarray
    lift_incidence: np.ndarray
    prandtl_glauert: np.ndarray | float


def to_center(air, station, motion):
    """From the pitch axis to the aerodynamic centre of every section."""
    return beside_axis(motion, *air.center(station))


def about_axis(air, station, motion, force):
    """Nose-up moment about the pitch axis of forces at the aerodynamic centre."""
    moment = np.cross(to_center(air, station, motion).value, force)
    return (moment * motion.spanwise.value).sum(-1)


def section_flow(air, station, motion):
    """φ is written arctan(u_P/u_T), half a turn on where the flow comes from behind: atan2, and analytic."""
    axis = motion.position.rate + air.airspeed * np.array([0.0, 0.0, 1.0])
    velocity = axis + to_center(air, station, motion).rate
    u_T = -(velocity * motion.chordwise.value).sum(-1)
    u_P = (velocity * motion.normal.value).sum(-1)
    u_R = (axis * motion.spanwise.value).sum(-1)
    assert ((u_T.real > 0) | (u_P.real > 0)).all(), "reversed flow"
    speed, inflow = np.sqrt(u_T**2 + u_P**2), np.arctan(u_P / u_T) + np.pi * (u_T.real < 0)
    mach = speed / air.speed_of_sound
    angle_of_attack = motion.pitch.value + np.interp(station, *air.twist) - inflow
    rotation = air.section_damping * nose_up_rotation(motion)
    return Flow(
        speed=speed,
        inflow=inflow,
        radial=u_R,
        angle_of_attack=angle_of_attack,
        rotation=rotation,
        lift_incidence=angle_of_attack + rotation * np.interp(station, *air.chord) / 2 / speed,
        prandtl_glauert=1 / np.sqrt(1 - mach**2) if air.compressibility else 1.0,
    )


def section_loads(air, station, motion):
    """Force and nose-up moment per length on every section, from its own velocity and pitch."""
    flow, chord = section_flow(air, station, motion), np.interp(station, *air.chord)
    pressure_chord = 0.5 * air.density * chord * flow.speed**2
    lift_coefficient = flow.prandtl_glauert * air.along(
        station, lambda k: air.of("lift_slope", k) * (flow.lift_incidence - air.of("zero_lift_angle", k))
    )
    drag_coefficient, moment_coefficient = (
        air.along(station, lambda k, name=name: air.of(name, k)) for name in ("drag", "moment")
    )
    lift, drag = pressure_chord * lift_coefficient, pressure_chord * drag_coefficient
    radial_drag = 0.5 * air.density * chord * flow.speed * drag_coefficient * flow.radial
    at_center = scaled(
        lift * np.sin(flow.inflow) + drag * np.cos(flow.inflow), motion.chordwise.value
    ) + scaled(lift * np.cos(flow.inflow) - drag * np.sin(flow.inflow), motion.normal.value)
    resistance = np.pi / 8 * air.density * chord**3 * flow.speed * flow.rotation
    moment = pressure_chord * chord * moment_coefficient * flow.prandtl_glauert - resistance
    force = at_center - scaled(radial_drag, motion.spanwise.value)
    return force, moment + about_axis(air, station, motion, at_center)


def lift_slope_loads(air, station, motion, trim):
    """What a change of angle of attack alone does: c_lα in the flow and the axes of `trim`, nothing else."""
    flow, chord = section_flow(air, station, trim), np.interp(station, *air.chord)
    change = section_flow(air, station, motion).lift_incidence - flow.lift_incidence
    lift_slope = air.along(station, lambda k: air.of("lift_slope", k))
    lift = 0.5 * air.density * chord * flow.speed**2 * lift_slope * flow.prandtl_glauert * change
    chordwise, normal = motion.chordwise.value, motion.normal.value
    force = scaled(lift * np.sin(flow.inflow), chordwise) + scaled(lift * np.cos(flow.inflow), normal)
    return force, about_axis(air, station, trim, force)


def nose_up_rotation(motion):
    """The part about d of the rate of the section axes, and the pitch rate of the section in them; virtual or real."""
    axes_about_span = (motion.normal.rate * motion.chordwise.value).sum(-1)
    return axes_about_span + motion.pitch.rate


def airload_rows(air, rotor, q, time, order=14):
    """What the airloads add to the left-hand side of the equations of motion."""
    station, weight = quadrature(air, rotor, order)
    motion = blades(rotor, station, q, clock(rotor, time))
    force, moment = section_loads(air, station, motion)
    return -assembled(rotor, station, q, time, motion, force * weight[:, None], moment * weight)


def lift_slope_rows(air, rotor, trim, q, time):
    """The same with only the terms proportional to c_lα: they vanish at the trim and turn no load."""
    station, weight = quadrature(air, rotor)
    shaft = clock(rotor, time)
    motion, steady = (blades(rotor, station, state, shaft) for state in (q, Motion(trim)))
    force, moment = lift_slope_loads(air, station, motion, steady)
    return -assembled(rotor, station, q, time, motion, force * weight[:, None], moment * weight)


def assembled(rotor, station, q, time, motion, force, moment):
    """Resultants on the hub, virtual work on the rest, of forces and nose-up moments at the stations."""
    rows = np.zeros((*force.shape[:-3], len(DOFS)), dtype=complex)
    rows[..., HUB_FORCE] = force.sum((-3, -2))
    about_hub = np.cross(motion.arm.value, force) + moment[..., None] * motion.spanwise.value
    rows[..., HUB_MOMENT] = about_hub.sum((-3, -2))
    virtual = virtual_displacements(rotor, station, q.value, time)
    work = (force[..., None, :, :, :] * virtual.position.rate).sum((-3, -2, -1))
    pitching_work = (moment[..., None, :, :] * nose_up_rotation(virtual)).sum((-2, -1))
    rows[..., GENERALISED] = work + pitching_work
    return rows
