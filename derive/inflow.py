"""Dynamic inflow in axial flight: induced velocity that follows the loads of the rotor late, as air has mass.

The induced velocity runs through the disk against the thrust, along the hub's axis k, and tilts with the hub. At a
point p of the disk, seen from the hub, it is

    nu = nu_0 + (nu_1c x + nu_1s y) / R        x = p . I, y = p . J

A section meets it as if the section itself moved along k with nu. What makes it are the loads along k, weighed with the
same three functions of the disk, which are the thrust and the moments of these loads over R:

    8/3 rho R³ nu_0' + 2 rho pi R² (V + 2 lambda) nu_0 + 2 rho pi R² lambda v = T
    16/45 rho R³ nu_1' + 1/2 rho pi R² (V + lambda) nu_1 = M / R

nu are changes from trim, primes their rates. lambda is the steady induced velocity, by momentum
T = 2 rho pi R² lambda (V + lambda), of which the first equation has the derivatives: with lambda, and with the speed v
of the hub against the air along k. The masses are those of air around an impermeable disk that is pushed or turned
(H. Lamb, Hydrodynamics, art. 108), which P. J. Carpenter and B. Fridovich (NACA TN 3044, 1953) took for a rotor, and
both equations are those of D. M. Pitt and D. A. Peters, Vertica 5 (1981), in axial flow.
"""

from __future__ import annotations

import sympy as sp
from sympy.polys.rings import PolyElement

from derive import kinematics as kin
from derive import symbols as s
from derive.airloads import MOMENTS, POWERS, SENSE, SegmentKinematics, power_of_radius, segment_kinematics
from derive.coordinates import LOAD, MOTION, SECTION_AXES
from derive.expansion import dot
from derive.lift_slope import radius

induced_velocity = s.quantity(
    "induced_velocity", r"\lambda", "m/s", "steady induced velocity against the thrust"
)
axial_flow = s.quantity(
    "axial_flow", r"V+\lambda", "m/s", "steady velocity of the air through the disk: airspeed and induced"
)
MOMENTUM = {
    name: s.quantity(name, latex, unit, meaning)
    for name, latex, unit, meaning in (
        ("momentum_thrust", "T", "N", "thrust of the rotor by momentum"),
        ("uniform_apparent_mass", "m_0", "kg", "mass of air that the uniform inflow accelerates"),
        ("harmonic_apparent_mass", "m_1", "kg", "mass of air that a harmonic of the inflow accelerates"),
        ("uniform_mass_flow", r"\dot m_0", "N s/m", "thrust per uniform inflow"),
        ("harmonic_mass_flow", r"\dot m_1", "N s/m", "moment over radius per harmonic of the inflow"),
        ("thrust_by_speed", "T_{,V}", "N s/m", "thrust per airspeed at the same induced velocity"),
    )
}


def momentum() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Thrust by momentum and its derivatives, and what the harmonics of the inflow take, in axial flow."""
    area = sp.pi * radius**2
    thrust = 2 * s.density * area * induced_velocity * (s.airspeed + induced_velocity)
    values = {
        "momentum_thrust": thrust,
        "uniform_apparent_mass": sp.Rational(8, 3) * s.density * radius**3,
        "harmonic_apparent_mass": sp.Rational(16, 45) * s.density * radius**3,
        "uniform_mass_flow": sp.diff(thrust, induced_velocity),
        "harmonic_mass_flow": s.density * area * (s.airspeed + induced_velocity) / 2,
        "thrust_by_speed": sp.diff(thrust, s.airspeed),
    }
    return [
        (MOMENTUM[name], sp.factor_terms(sp.expand(value.subs(s.airspeed, axial_flow - induced_velocity))))
        for name, value in values.items()
    ]


class _Field:
    """The part of the inflow that a blade sees: a function of the disk, as a displacement of sections along k."""

    def __init__(self, kinematics: SegmentKinematics, part: str):
        self.kinematics, self.part = kinematics, part

    def value(self, *along: str) -> PolyElement:
        """Value of the function times the radius (the uniform one as it is), and its derivative as a section moves."""
        outward, aside, one = 1, 0, self.kinematics.ring(1)
        place = self.kinematics.point.about_hub.along(*along)
        if self.part == "inflow_uniform":
            return self.kinematics.zero if along else one
        return place[outward] if self.part == "inflow_outward" else -place[aside]

    def displacement(self, axis: str, *along: str) -> PolyElement:
        """Displacement along a section axis; k and the disk turn with the hub, so that hub motion changes nothing."""
        if along and along[0] in (*kin.HUB_TRANSLATION, *kin.HUB_ROTATION):
            return self.kinematics.zero
        k = self.kinematics.ring.vector(kin.K_AXIS)
        total = dot(self.kinematics.axes[axis].along(), k) * self.value(*along)
        if along:
            total += dot(self.kinematics.axes[axis].along(*along), k) * self.value()
        return total

    def per_radius(self, polynomial: PolyElement, power: int) -> sp.Expr:
        """Coefficient of a power of r, of the function itself."""
        found = power_of_radius(self.kinematics, polynomial, power)
        return found if self.part == "inflow_uniform" else found / radius


def virtual_motion(load: str, part: str) -> sp.Expr:
    """W of the inflow: displacement of a segment along k by each function of the disk, in section axes."""
    of = LOAD[load]
    if not of.axis:
        return sp.Integer(0)
    field = _Field(segment_kinematics(), part)
    return field.per_radius(field.displacement(of.axis), of.power)


def motion(motion: str, part: str) -> sp.Expr:
    """U of the inflow: velocity of the air along a segment, as if the segment moved along k with the inflow."""
    of = MOTION[motion]
    if not of.axis:
        return sp.Integer(0)
    field = _Field(segment_kinematics(), part)
    return SENSE[of.axis] * field.per_radius(field.displacement(of.axis), of.power)


def geometric_stiffness(part: str, name: str) -> sp.Expr:
    """G of the inflow: change of the steady loads that make the inflow, as their directions and places move."""
    field = _Field(segment_kinematics(), part)
    changes = {axis: field.displacement(axis, name) for axis in SECTION_AXES}
    return sum(
        (
            MOMENTS[f"f{axis}", power] * field.per_radius(change, power)
            for axis, change in changes.items()
            for power in POWERS
        ),
        sp.Integer(0),
    )
