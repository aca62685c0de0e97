"""Quasi-steady airloads of one blade by virtual work, linearised about trim (Eqs. 14-16, and what they leave out).

At a section the air comes with u_T along i', u_P against n and u_R against d. The section forces f = (f_x, f_n, f_d)
and the moment m depend on them and on the pitch; row i of the virtual work is the integral of f . w_i + m t_i, with w_i
the row's virtual displacement in section axes and t_i its rotation about d.

A blade is straight on each segment between its hinges, so w_i = w0 + w1 r and u = u0 + u1 r there. With the motions
(w0, w1, t) and (u0, u1, pitch, rotation about d) a segment's airloads are seven generalised loads that depend on eight
motions through radial moments of the section's derivatives only:

    C = - sum W^T L U_rate        K = - sum W^T L U_displacement - G        (sum over the segments)

G holds the steady loads times the change of w and t.
"""

from __future__ import annotations

import functools
from collections.abc import Callable

import sympy as sp
from sympy.polys.rings import PolyElement

from derive import kinematics as kin
from derive import symbols as s
from derive.coordinates import (
    BLADE_GUSTS,
    COORDINATE,
    LOAD,
    MOTION,
    SECTION_AXES,
    SEGMENT_LOADS,
    SEGMENT_MOTIONS,
)
from derive.expansion import Along, Expansion, MovingPoint, Vector, add, dot, spin
from derive.polynomials import (
    SEGMENT_ANGLES,
    SINE_AND_COSINE,
    PolynomialRing,
    name_trigonometry,
    temporaries,
)
from derive.published import CONSISTENT

# u_T, u_P, u_R are these multiples of the section's own velocity along i', n, d.
SENSE = {"x": -1, "n": 1, "d": 1}

# Geometry of a segment at trim: the line p = anchor + r d, and its flap arm, whose slope is h_beta cos(lag).
anchor = [
    s.quantity(f"anchor_{axis}", f"a_{axis}", "m", f"where the segment's line meets r = 0, along {axis}")
    for axis in "ijk"
]
flap_arm_at_center = s.quantity("flap_arm_at_center", "b_0", "m", "flap arm of the segment's line at r = 0")

# Section loads per unit span, their moments with powers of r, and their derivatives.
LOADS = {
    "fx": ("f_x", "N/m", "force along i'"),
    "fn": ("f_n", "N/m", "force along n"),
    "fd": ("f_d", "N/m", "force along d"),
    "m": ("m", "N", "moment about d, nose up"),
}
ARGUMENTS = {
    "": ("", "", ""),
    "_ut": ("u_T", " s/m", " per u_T"),
    "_up": ("u_P", " s/m", " per u_P"),
    "_ur": ("u_R", " s/m", " per u_R"),
    "_theta": (r"\theta", "", " per rad of pitch"),
    "_spin": (r"\omega_d", " s", " per rad/s of rotation about d"),
}
POWERS = range(3)


def _moment_unit(unit: str, per: str, power: int) -> str:
    lengths = power + 1
    numerator, _, denominator = unit.partition("/")
    per_speed = per == " s/m"
    lengths -= (denominator == "m") + per_speed
    speed = " s" if per else ""
    length = f" m^{lengths}" if lengths > 0 else ("/m" if lengths < 0 else "")
    return f"{numerator}{speed}{length}"


MOMENTS = {
    (load + argument, power): s.quantity(
        f"{load}{argument}_{power}",
        rf"\int r^{power} {latex}{{}}_{{,{by}}}" if by else rf"\int r^{power} {latex}",
        _moment_unit(unit, per, power),
        f"integral of r^{power} times the {meaning}{by_meaning}",
    )
    for load, (latex, unit, meaning) in LOADS.items()
    for argument, (by, per, by_meaning) in ARGUMENTS.items()
    for power in POWERS
}


def elastic_coupling() -> sp.Expr:
    """What Eq. 16 adds to the pitch of the airloads when the pitch equation is left out."""
    return -s.pitch_flap_coupling * kin.q["flap"] - s.pitch_lag_coupling * kin.q["lag"]


def on_segment(expression: sp.Expr) -> sp.Expr:
    """The arms as they are on a segment that lies on one side of each hinge; trim angles count only beyond theirs."""
    flap, lag = kin.beyond_flap_hinge, kin.beyond_lag_hinge
    outboard = flap * (s.radial_station - s.flap_hinge_offset)
    arms = {
        kin.outboard_arm: outboard,
        kin.inboard_arm: s.radial_station - outboard,
        kin.lag_arm: lag * (s.radial_station - s.lag_hinge_offset),
    }
    return expression.subs(arms).subs({s.coning: flap * s.coning, s.lag: lag * s.lag})


class SegmentKinematics:
    """A straight segment: its line and axes, and how both move with the blade's coordinates.

    All is polynomial in the perturbations, to second order, and linear in r: derivatives are taken in the ring.
    """

    def __init__(self, dropped: frozenset[str]):
        self.dropped = dropped
        trig = [symbol for pair in SEGMENT_ANGLES.values() for symbol in pair]
        steps = [kin.beyond_flap_hinge, kin.beyond_lag_hinge]
        geometry = [*anchor, flap_arm_at_center, s.flap_hinge_offset, s.lag_hinge_offset, s.radial_station]
        operation = [s.rotor_speed, s.airspeed, s.pitch, s.pitch_gimbal_coupling]
        operation += [*s.HINGE_LINKAGES, s.pitch_flap_coupling, s.pitch_lag_coupling]
        self.ring = PolynomialRing(
            [*trig, *steps, *geometry, *operation],
            "`geometry` or `operation` of `SegmentKinematics` in derive/airloads.py",
        )
        self.point = MovingPoint(self.ring, self._named(self._line()))
        axes = self._named(kin.at_trim(kin.blade_axes()) + kin.change(kin.blade_axes()))
        self.axes = {
            axis: Expansion.of(self.ring, axes[:, place]).turned(self.point.turn)
            for place, axis in enumerate(SECTION_AXES)
        }
        _, to_yoke = kin.pitch_angles(dropped)
        self.pitch_to_yoke = Expansion.of(self.ring, sp.Matrix([to_yoke]))
        self.pitch_in_air = Expansion.of(self.ring, sp.Matrix([to_yoke + elastic_coupling()]))
        self.zero = self.ring.ring.zero

    @staticmethod
    def _line() -> sp.Matrix:
        """The deflected line on the segment: its arms are linear in r."""
        r, flap, lag = s.radial_station, kin.beyond_flap_hinge, kin.beyond_lag_hinge
        outward = kin.at_trim(kin.blade_axes()[:, SECTION_AXES.index("d")])
        arms = (kin.chordwise_arm, kin.radial_arm, kin.axial_arm)
        line = {arm: a + r * d for arm, a, d in zip(arms, anchor, outward, strict=True)}
        line |= {kin.flap_arm: flap * (flap_arm_at_center + r * sp.cos(lag * s.lag))}
        return kin.deflected_line().subs(line | {kin.lag_arm: lag * (r - s.lag_hinge_offset)})

    @staticmethod
    def _named(expression: sp.Matrix) -> sp.Matrix:
        """Sines and cosines by name; a trim angle counts only beyond its hinge."""
        flap, lag = kin.beyond_flap_hinge, kin.beyond_lag_hinge
        on_segment = expression.expand().subs({s.coning: flap * s.coning, s.lag: lag * s.lag})
        on_segment = on_segment.subs({flap**2: flap, lag**2: lag})
        return name_trigonometry(on_segment, SEGMENT_ANGLES)

    def virtual_rotation(self, row: str, *along: str) -> Vector:
        """Rotation of the section as a vector, and its derivative; rotation by pitch not included."""
        if row in kin.HUB_ROTATION:
            return [self.zero] * 3 if along else self.point.fixed_axis(row)
        # E,i E^T is skew; its derivative is E,ij E^T + E,i E,j^T.
        parts: list[tuple[Along, Along]] = [((row, *along), ())] + ([((row,), along)] if along else [])
        total = [[self.zero] * 3 for _ in range(3)]
        for turned, still in parts:
            for axis in self.axes.values():
                left, right = axis.along(*turned), axis.along(*still)
                total = [[total[i][j] + left[i] * right[j] for j in range(3)] for i in range(3)]
        return [total[2][1], total[0][2], total[1][0]]

    def air_velocity(self, *along: str) -> Vector:
        """Inertial velocity of a point at rest in the rotating axes, and its derivative."""
        rate = self.ring(s.rotor_speed)
        spun = [rate * component for component in spin(self.point.position.along(*along))]
        return spun if along else add(spun, self.ring.vector(s.airspeed * kin.K_AXIS))

    def velocity(self, axis: str, *along: str) -> PolyElement:
        """Velocity of the air along a section axis; along a coordinate the point moves and the axis turns."""
        total = dot(self.axes[axis].along(), self.air_velocity(*along))
        if along:
            total += dot(self.axes[axis].along(*along), self.air_velocity())
        return SENSE[axis] * total

    def rate_velocity(self, axis: str, name: str) -> PolyElement:
        """Velocity of the air along a section axis per rate of a coordinate."""
        return SENSE[axis] * dot(self.axes[axis].along(), self.point.position.along(name))

    def spin(self, *along: str) -> PolyElement:
        """Rotation of the section about d at rest in the rotating axes, and its derivative."""
        return self.ring(s.rotor_speed) * self.axes["d"].along(*along)[2]

    def pitch_change(self, *along: str) -> PolyElement:
        """Change of the section's pitch in the airloads, where a coupling may stand for the pitch equation."""
        return self.pitch_in_air.along(*along)[0]

    def work_displacement(self, axis: str, row: str, *along: str) -> PolyElement:
        """Virtual displacement of a row along a section axis, and its derivative."""
        total = dot(self.axes[axis].along(), self.point.virtual_displacement(row, *along))
        if along:
            total += dot(self.axes[axis].along(*along), self.point.virtual_displacement(row))
        return total

    def work_rotation(self, row: str, *along: str) -> PolyElement:
        """Rotation of the section about d: with hub, yoke and hinges, and by pitch; and its derivative."""
        total = dot(self.axes["d"].along(), self.virtual_rotation(row, *along))
        if along:
            total += dot(self.axes["d"].along(*along), self.virtual_rotation(row))
        return total + self.pitch_to_yoke.along(row, *along)[0]


@functools.cache
def segment_kinematics(dropped: frozenset[str] = CONSISTENT) -> SegmentKinematics:
    return SegmentKinematics(dropped)


def power_of_radius(kinematics: SegmentKinematics, polynomial: PolyElement, power: int) -> sp.Expr:
    """Coefficient of r^power, reduced."""
    ring = kinematics.ring
    place = ring.generators.index(s.radial_station)
    terms = {
        (*monomial[:place], 0, *monomial[place + 1 :]): coefficient
        for monomial, coefficient in ring.reduced(polynomial).terms()
        if monomial[place] == power
    }
    expression = ring.shortest(ring.ring.from_dict(terms))
    if "cone_in_airloads" in kinematics.dropped:
        expression = expression.subs(_STRAIGHT_BLADE)
    return sp.factor_terms(expression)


# A blade along j: no cone and no lag at trim.
_STRAIGHT_BLADE = dict.fromkeys(anchor, 0) | {sine: 0 for sine, _ in SINE_AND_COSINE}
_STRAIGHT_BLADE |= {cosine: 1 for _, cosine in SINE_AND_COSINE}


def _is_dropped(dropped: frozenset[str], *coordinates: str) -> bool:
    return "yoke_roll" in dropped and "gimbal_roll" in coordinates


def virtual_motion(load: str, row: str, dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    """W: displacement at r = 0 and per unit radius along i', n, d, and rotation about d, of a segment for each row."""
    if _is_dropped(dropped, row):
        return sp.Integer(0)
    kinematics = segment_kinematics(dropped)
    of = LOAD[load]
    work = kinematics.work_displacement(of.axis, row) if of.axis else kinematics.work_rotation(row)
    return power_of_radius(kinematics, work, of.power)


def _motion(
    kinematics: SegmentKinematics, velocity: Callable[..., PolyElement], motion: str, *along: str
) -> sp.Expr:
    return power_of_radius(kinematics, velocity(MOTION[motion].axis, *along), MOTION[motion].power)


def rate_motion(motion: str, name: str, dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    """U for rates: velocity of the air along a segment for the rate of each coordinate."""
    if motion == "theta" or _is_dropped(dropped, name):
        return sp.Integer(0)
    kinematics = segment_kinematics(dropped)
    if motion == "spin":
        return power_of_radius(kinematics, kinematics.work_rotation(name), 0)
    return _motion(kinematics, kinematics.rate_velocity, motion, name)


def displacement_motion(motion: str, name: str, dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    """U for displacements: velocity of the air along a segment, and pitch, for each coordinate."""
    if _is_dropped(dropped, name):
        return sp.Integer(0)
    kinematics = segment_kinematics(dropped)
    if motion == "theta":
        return power_of_radius(kinematics, kinematics.pitch_change(name), 0)
    if motion == "spin":
        return power_of_radius(kinematics, kinematics.spin(name), 0)
    return _motion(kinematics, kinematics.velocity, motion, name)


def gust_motion(motion: str, gust: str, dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    """U for gusts: velocity of the air along a segment for air that moves along the rotating axes."""
    axis = MOTION[motion].axis
    if not axis or MOTION[motion].power:
        return sp.Integer(0)
    kinematics = segment_kinematics(dropped)
    component = kinematics.axes[axis].along()[BLADE_GUSTS.index(COORDINATE[gust])]
    return power_of_radius(kinematics, -SENSE[axis] * component, 0)


def trim_velocity(motion: str, _: str = "trim", dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    """Trim velocity of the air at r = 0 and per unit radius, along a segment, and the sections' rotation."""
    kinematics = segment_kinematics(dropped)
    if motion == "spin":
        return power_of_radius(kinematics, kinematics.spin(), 0)
    return _motion(kinematics, kinematics.velocity, motion)


def geometric_stiffness(row: str, name: str, dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    """G: change of the steady airloads' virtual work with each coordinate, of one segment."""
    if "steady_airloads_on_moving_blade" in dropped or _is_dropped(dropped, row, name):
        return sp.Integer(0)
    kinematics = segment_kinematics(dropped)
    changes = {f"f{axis}": kinematics.work_displacement(axis, row, name) for axis in SECTION_AXES}
    changes["m"] = kinematics.work_rotation(row, name)
    return sum(
        (
            MOMENTS[load, p] * power_of_radius(kinematics, change, p)
            for load, change in changes.items()
            for p in POWERS
        ),
        sp.Integer(0),
    )


def load_derivative(load: str, motion: str) -> sp.Expr:
    """Moment of a section's derivative: a load at power a meets a velocity at power b in the moment a + b."""
    of, by = LOAD[load], MOTION[motion]
    return MOMENTS[f"{of.section_load}_{by.argument}", of.power + by.power]


def steady_load(load: str, _: str = "trim") -> sp.Expr:
    """Steady generalised loads of a segment."""
    return MOMENTS[LOAD[load].section_load, LOAD[load].power]


def products() -> dict[str, sp.MatrixExpr]:
    """What each segment adds to a blade's airload damping and stiffness, gust loads and steady virtual work."""
    loads, motions, coordinates = len(SEGMENT_LOADS), len(SEGMENT_MOTIONS), len(kin.COORDINATES)
    virtual = sp.MatrixSymbol("virtual_motion", loads, coordinates)
    derivatives = sp.MatrixSymbol("load_derivatives", loads, motions)
    rate = sp.MatrixSymbol("rate_motion", motions, coordinates)
    displacement = sp.MatrixSymbol("displacement_motion", motions, coordinates)
    gust = sp.MatrixSymbol("gust_motion", motions, len(BLADE_GUSTS))
    geometric = sp.MatrixSymbol("geometric_stiffness", coordinates, coordinates)
    steady = sp.MatrixSymbol("steady_loads", loads, 1)
    # The virtual work of the airloads stands on the right of the equations of motion, so it leaves with a minus.
    return {
        "damping": -virtual.T * derivatives * rate,
        "stiffness": -virtual.T * derivatives * displacement - geometric,
        "gust_loads": virtual.T * derivatives * gust,
        "steady_work": virtual.T * steady,
    }


def segment_geometry(dropped: frozenset[str] = CONSISTENT) -> list[tuple[sp.Symbol, sp.Expr]]:
    """Trim geometry of a straight segment between hinges: sines and cosines, its line and its flap arm."""
    steps = temporaries(SEGMENT_ANGLES) + _line_and_arm()
    if "cone_in_airloads" in dropped:
        return [
            (symbol, sp.sympify(_STRAIGHT_BLADE.get(symbol, value)).subs(_STRAIGHT_BLADE))
            for symbol, value in steps
        ]
    return steps


def _line_and_arm() -> list[tuple[sp.Symbol, sp.Expr]]:
    flap, lag = kin.beyond_flap_hinge, kin.beyond_lag_hinge
    r = s.radial_station
    ring = PolynomialRing(
        [symbol for pair in SEGMENT_ANGLES.values() for symbol in pair]
        + [flap, lag, r, s.flap_hinge_offset, s.lag_hinge_offset],
        "`_line_and_arm` of derive/airloads.py",
    )

    def linear(expression: sp.Expr) -> list[sp.Expr]:
        polynomial = ring.reduced(ring(name_trigonometry(on_segment(expression), SEGMENT_ANGLES)))
        return [sp.factor_terms(polynomial.as_expr().expand().coeff(r, power)) for power in (0, 1)]

    steps = [
        (symbol, linear(component)[0])
        for symbol, component in zip(anchor, kin.at_trim(kin.blade_line()), strict=True)
    ]
    return [*steps, (flap_arm_at_center, linear(kin.deflected_flap_arm())[0])]
