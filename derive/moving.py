"""One blade about a trim that moves: shaft and air at an angle, blade and gimbal swinging once a turn (Eqs. 1-13).

A rotor that meets the air at an angle, or that an aircraft turns as it pulls up, has a periodic trim. With D for the
rate of a vector in inertial axes along this trim, which rotating axes of speed w see as D p = p' + w x p, the work of
the inertia forces, row i, is the integral of m W_i . D D p, and about the trim

    M_ij = int m W_i . p,j      C_ij = 2 int m W_i . D p,j      K_ij = int m [ W_i . D D p,j + W_i,j . D D p ]

because a small change of p is p,j q_j, whose second rate is p,j q_j'' + 2 D p,j q_j' + D D p,j q_j. Where a blade is
steady in axes that turn at Omega k, D is Omega k x, and this is `derive.inertia`. The rates of p and p,j follow from
their values around the turn, so what is derived here is geometry at one instant: where points are, how axes stand,
how both change with the coordinates, and what steady forces do on displacements of second order. The same goes for
the airloads, with v = D p + V the velocity of a section.

The tilt of the yoke is finite: the rotation by it and its changes with it stand by name.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping

import sympy as sp
from sympy.polys.rings import PolyElement

from derive import airloads, flap_lag_springs, inertia, pitch
from derive import kinematics as kin
from derive import symbols as s
from derive.coordinates import MOTION, SECTION_AXES
from derive.expansion import Along, Expansion, Vector, cross, dot
from derive.polynomials import (
    SEGMENT_ANGLES,
    WHOLE_BLADE_ANGLES,
    PolynomialRing,
    name_trigonometry,
    temporaries,
)

AXES = "ijk"
VALUE = "value"  # the column of what is at trim, beside those of the changes
ARMS = {"inboard": kin.inboard_arm, "outboard": kin.outboard_arm, "lag": kin.lag_arm}
SPRUNG = ("flap", "lag", "pitch")  # what the springs of a blade depend on

gimbal_flap = s.quantity(
    "trim_gimbal_flap", r"\bar\beta_G", "rad", "trim tilt of the yoke as the blade's flap"
)
gimbal_roll = s.quantity(
    "trim_gimbal_roll", r"\bar\gamma", "rad", "trim tilt of the yoke as the blade's roll"
)
cyclic = s.quantity("trim_cyclic", r"\bar\theta_c", "rad", "trim pitch of the tilted swashplate at the blade")
cyclic_slope = s.quantity(
    "trim_cyclic_slope", r"\bar\theta_c'", "", "trim pitch of the tilted swashplate a quarter turn later"
)


tilt_squared = s.quantity("tilt_squared", r"g\cdot g", "", "square of the yoke's trim tilt")


def _of_tilt(name: str, latex: str, meaning: str) -> tuple[sp.Symbol, ...]:
    """Return the symbols of a function of the squared tilt and of two derivatives."""
    orders = (("", "", ""), ("_slope", "'", ", derivative"), ("_curvature", "''", ", second derivative"))
    return tuple(
        s.quantity(f"tilt_{name}{suffix}", latex + prime, "", f"{meaning}{told}")
        for suffix, prime, told in orders
    )


tilt_sine = _of_tilt("sine", "a", "sine of the yoke's tilt over the tilt, by its square")
tilt_versine = _of_tilt("versine", "b", "1 less the cosine of the yoke's tilt over its square, by its square")
# The rotation of the yoke at its trim tilt and its derivatives with the tilt, by components.
_TURNS: dict[Along, tuple[str, str, str]] = {
    (): ("yoke", "R", "rotation of the yoke"),
    ("gimbal_flap",): ("yoke_flap", r"R_{,\beta}", "its change with gimbal flap"),
    ("gimbal_roll",): ("yoke_roll", r"R_{,\gamma}", "its change with gimbal roll"),
    ("gimbal_flap", "gimbal_flap"): (
        "yoke_flap_flap",
        r"R_{,\beta\beta}",
        "its second change with gimbal flap",
    ),
    ("gimbal_flap", "gimbal_roll"): ("yoke_flap_roll", r"R_{,\beta\gamma}", "its change with both"),
    ("gimbal_roll", "gimbal_roll"): (
        "yoke_roll_roll",
        r"R_{,\gamma\gamma}",
        "its second change with gimbal roll",
    ),
}
TURN = {
    (along, row, column): s.quantity(
        f"{name}_{row}{column}",
        f"{latex}{{}}_{{{row}{column}}}",
        "",
        f"{meaning}, row {row} and column {column}",
    )
    for along, (name, latex, meaning) in _TURNS.items()
    for row in AXES
    for column in AXES
}
_TERMS = 10  # of the power series of sine and versine: exact to rounding for tilts of up to a radian

FORCE = {
    (arm, axis): s.quantity(
        f"{arm}_force_{axis}",
        f"F_{{{arm},{axis}}}",
        "N m",
        f"steady forces times the {arm} arm, along {axis}",
    )
    for arm in ARMS
    for axis in AXES
}
POINT_VELOCITY = {
    (power, axis): s.quantity(
        f"point_velocity_{axis}_{power}",
        f"v_{{{axis},{power}}}",
        "1/s" if power else "m/s",
        f"velocity of the segment's line along {axis}, " + ("per unit radius" if power else "at r = 0"),
    )
    for power in (0, 1)
    for axis in AXES
}
CHORDWISE = {
    axis: s.quantity(f"chordwise_{axis}", f"i'_{axis}", "", f"axis i' of the sections at trim, along {axis}")
    for axis in AXES
}
trim_spin = s.quantity(
    "trim_spin", r"\bar\omega_d", "rad/s", "rotation of the section about d along the trim"
)
shaft_pitch_moment = s.quantity(
    "shaft_pitch_moment", r"\bar M_s", "N m", "moment of pitch inertia on the pitch relative to the shaft"
)
yoke_pitch_moment = s.quantity(
    "yoke_pitch_moment",
    r"\bar M_y",
    "N m",
    "moment of springs and propeller moment on the pitch relative to the yoke",
)


@functools.cache
def tilt_of_yoke() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Rotation of the yoke by its trim tilt, and its first and second changes with the tilt.

    exp([g]x) = 1 + a [g]x + b [g]x [g]x, with a and b power series of g . g.
    """
    square = sp.Symbol("square", real=True)
    tilt = sp.Matrix([gimbal_flap, gimbal_roll, 0])
    of = {"gimbal_flap": gimbal_flap, "gimbal_roll": gimbal_roll}
    steps = [(tilt_squared, tilt.dot(tilt))]
    functions = []
    for symbols, first in ((tilt_sine, 1), (tilt_versine, 2)):
        series = sum((-square) ** n / sp.factorial(2 * n + first) for n in range(_TERMS))
        for order, symbol in enumerate(symbols):
            steps.append(
                (symbol, sp.horner(sp.diff(series, square, order), square).subs(square, tilt_squared))
            )
        change = tilt.dot(tilt) - square
        functions.append(sum(symbol * change**n / sp.factorial(n) for n, symbol in enumerate(symbols)))
    spin = kin.cross_matrix(tilt)
    rotation = sp.eye(3) + functions[0] * spin + functions[1] * spin * spin
    for along in _TURNS:
        changed = sp.diff(rotation, *(of[name] for name in along)) if along else rotation
        changed = changed.subs(square, tilt.dot(tilt))
        steps += [
            (TURN[along, row, column], sp.factor_terms(sp.expand(changed[i, j])))
            for i, row in enumerate(AXES)
            for j, column in enumerate(AXES)
        ]
    return steps


def _yoke(row: str, ring: PolynomialRing) -> Expansion:
    """Return a row of the yoke's rotation about its trim tilt."""
    parts = {along: ring.vector(TURN[along, row, column] for column in AXES) for along in _TURNS}
    return Expansion(ring, parts | {along[::-1]: vector for along, vector in parts.items()})


def _seen(along_i: sp.Expr, along_j: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return a vector of the disk as the blade sees it, whose azimuth may change."""
    seen = kin.rotation(-kin.q["azimuth"] * kin.K_AXIS) * sp.Matrix([along_i, along_j, 0])
    return seen[0], seen[1]


def pitch_angles() -> dict[str, sp.Expr]:
    """Blade pitch relative to the shaft and to the yoke, about a tilted yoke and a tilted swashplate."""
    flap, roll = _seen(gimbal_flap + kin.q["gimbal_flap"], gimbal_roll + kin.q["gimbal_roll"])
    by_swashplate, _ = _seen(cyclic, cyclic_slope)
    of_hinges = (
        s.kinematic_pitch_flap_coupling * kin.q["flap"] + s.kinematic_pitch_lag_coupling * kin.q["lag"]
    )
    to_shaft = s.pitch + kin.q["pitch"] + by_swashplate - s.pitch_gimbal_coupling * flap - of_hinges
    return {"shaft": to_shaft, "yoke": to_shaft - roll}


class MovingBlade:
    """Points and axes of a blade about its trim, in rotating axes, to second order in the perturbations."""

    def __init__(self) -> None:
        trig = {symbol for pair in WHOLE_BLADE_ANGLES.values() for symbol in pair}
        steps = (kin.beyond_flap_hinge, kin.beyond_lag_hinge)
        turns = (
            gimbal_flap,
            gimbal_roll,
            s.pitch,
            cyclic,
            cyclic_slope,
            s.pitch_gimbal_coupling,
            *s.HINGE_LINKAGES,
        )
        given = (*FORCE.values(), *POINT_VELOCITY.values(), *CHORDWISE.values())
        self.ring = PolynomialRing(
            [*trig, *steps, *TURN.values(), *turns, *given],
            "the generators of `MovingBlade` in derive/moving.py",
        )
        self.zero = self.ring.ring.zero
        self.pitch = {to: Expansion.of(self.ring, sp.Matrix([angle])) for to, angle in pitch_angles().items()}
        self.points = {arm: self._turned(line) for arm, line in self._lines().items()}
        self.axes = {axis: self._turned(direction) for axis, direction in self._directions().items()}

    @staticmethod
    def _lines() -> dict[str, sp.Matrix]:
        """Return the directions of a blade's line by arm, in the yoke."""
        outboard = kin.flapped(s.precone + kin.FLAP_ANGLE)
        lines = {
            "inboard": kin.flapped(s.precone),
            "outboard": outboard,
            "lag": kin.lagged(outboard, kin.LAG_ANGLE) - outboard,
        }
        return {arm: _to_second_order(line, WHOLE_BLADE_ANGLES) for arm, line in lines.items()}

    @staticmethod
    def _directions() -> dict[str, sp.Matrix]:
        """Return the axes of the sections of a segment, in the yoke."""
        axes = kin.blade_axes()
        flap, lag = kin.beyond_flap_hinge, kin.beyond_lag_hinge
        found = {}
        for place, axis in enumerate(SECTION_AXES):
            whole = kin.at_trim(axes[:, place]) + kin.change(axes[:, place])
            whole = whole.expand().subs({s.coning: flap * s.coning, s.lag: lag * s.lag})
            found[axis] = name_trigonometry(whole.subs({flap**2: flap, lag**2: lag}), SEGMENT_ANGLES)
        return found

    def _turned(self, vector: sp.Matrix) -> Expansion:
        """Return a vector of the yoke in rotating axes: turned by azimuth, yoke and hub."""
        in_yoke = Expansion.of(self.ring, vector).turned(
            self._rows(kin.rotation(kin.q["azimuth"] * kin.K_AXIS))
        )
        return in_yoke.turned([_yoke(row, self.ring) for row in AXES]).turned(self._rows(kin.HUB_TURN))

    def _rows(self, turn: sp.Matrix) -> list[Expansion]:
        return [Expansion.of(self.ring, turn[place, :].expand()) for place in range(3)]

    def work_of(self, arm: str, row: str, *along: str) -> Vector:
        """Return the virtual displacement of a row per unit of an arm, or its derivative.

        Rows of hub rotation are moments about fixed axes, as in `derive.expansion`.
        """
        if row in kin.HUB_ROTATION:
            return cross(self._fixed_axis(row), self.points[arm].along(*along))
        return self.points[arm].along(row, *along)

    def rotation(self, row: str, *along: str) -> PolyElement:
        """Return the virtual rotation of a section about d, or its derivative: n,i . i' and the change of pitch.

        The derivative has i' as it is at trim; n,i . i',j is left to whoever has both as numbers.
        """
        if row in kin.HUB_ROTATION:
            turned = dot(self._fixed_axis(row), self.axes["d"].along(*along))
        else:
            turned = dot(
                self._across(self.axes["n"].along(row, *along)), self.ring.vector(CHORDWISE.values())
            )
        return turned + self.pitch["yoke"].along(row, *along)[0]

    def _across(self, change: Vector) -> Vector:
        """Return a change of n, or nothing of one along n itself, across which i' stands."""
        parts = cross(change, self.axes["n"].along())
        return change if any(self.ring.reduced(part) for part in parts) else [self.zero] * 3

    def _fixed_axis(self, row: str) -> Vector:
        return self.ring.vector((kin.I_AXIS, kin.J_AXIS, kin.K_AXIS)[kin.HUB_ROTATION.index(row)])

    def expression(self, polynomial: PolyElement) -> sp.Expr:
        return self.ring.reduced(polynomial).as_expr()


def _to_second_order(vector: sp.Matrix, angles: Mapping[sp.Expr, tuple[sp.Symbol, sp.Symbol]]) -> sp.Matrix:
    return name_trigonometry((kin.at_trim(vector) + kin.change(vector)).expand(), angles)


@functools.cache
def moving_blade() -> MovingBlade:
    return MovingBlade()


def _along(column: str) -> tuple[str, ...]:
    return () if column == VALUE else (column,)


POINT_ROWS = tuple(f"{arm}_{axis}" for arm in ARMS for axis in AXES)
AXIS_ROWS = tuple(f"{axis}_{component}" for axis in SECTION_AXES for component in AXES)
PITCH_ROWS = ("shaft", "yoke")
COLUMNS = (*kin.COORDINATES, VALUE)


def blade_angles() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Sines and cosines of precone, cone and lag of the whole blade."""
    return temporaries(WHOLE_BLADE_ANGLES)


def section_angles() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Sines and cosines of precone, cone and lag of the sections of a segment."""
    return temporaries(SEGMENT_ANGLES)


def points(row: str, column: str) -> sp.Expr:
    """Position per unit of each arm in rotating axes, and its change with each coordinate."""
    arm, axis = row.split("_")
    blade = moving_blade()
    return blade.expression(blade.points[arm].along(*_along(column))[AXES.index(axis)])


def axes(row: str, column: str) -> sp.Expr:
    """Axes i', n and d of the sections of a segment in rotating axes, and their change with each coordinate."""
    axis, component = row.split("_")
    blade = moving_blade()
    return blade.expression(blade.axes[axis].along(*_along(column))[AXES.index(component)])


def pitch_of_blade(row: str, column: str) -> sp.Expr:
    """Pitch relative to shaft and yoke, and its change with each coordinate."""
    blade = moving_blade()
    return blade.expression(blade.pitch[row].along(*_along(column))[0])


def trim_velocity(motion: str, _: str = "trim") -> sp.Expr:
    """Velocity of the air at r = 0 and per unit radius along a segment's axes, and the sections' rotation."""
    of = MOTION[motion]
    if not of.axis:
        return trim_spin
    blade = moving_blade()
    velocity = blade.ring.vector(POINT_VELOCITY[of.power, axis] for axis in AXES)
    return airloads.SENSE[of.axis] * blade.expression(dot(blade.axes[of.axis].along(), velocity))


def force_stiffness(row: str, column: str) -> sp.Expr:
    """Work of steady forces on the displacements of second order."""
    blade = moving_blade()
    total = blade.zero
    for arm in ARMS:
        force = blade.ring.vector(FORCE[arm, axis] for axis in AXES)
        total += dot(blade.work_of(arm, row, column), force)
    return blade.expression(total)


def moment_stiffness(row: str, column: str) -> sp.Expr:
    """Work of a segment's steady moment on the rotations of second order, by the changes of n alone."""
    blade = moving_blade()
    return airloads.MOMENTS["m", 0] * blade.expression(blade.rotation(row, column))


def pitch_stiffness(row: str, column: str) -> sp.Expr:
    """Work of steady pitch moments on the pitch of second order, by the azimuth of tilted yoke and swashplate."""
    blade = moving_blade()
    moments = {"shaft": shaft_pitch_moment, "yoke": yoke_pitch_moment}
    return sum(
        moment * blade.expression(blade.pitch[to].along(row, column)[0]) for to, moment in moments.items()
    )


def rotation_of_section(_: str, row: str) -> sp.Expr:
    """Virtual rotation of a segment's sections about d, by each row."""
    blade = moving_blade()
    return blade.expression(blade.rotation(row))


ARM_NAMES = ("inboard_arm", "outboard_arm", "lag_arm", "hub_arm")  # of the points, and 1 for the hub itself
_OF_ARM = dict(zip(ARM_NAMES, (kin.inboard_arm, kin.outboard_arm, kin.lag_arm, sp.Integer(1)), strict=True))
LINE_ROWS = ("at_center", "per_radius")


def arm_inertia(row: str, column: str) -> sp.Expr:
    """Integrals over the undeflected blade of the mass times two of its arms, of which the hub's is 1."""
    return inertia.integrate_mass(_OF_ARM[row] * _OF_ARM[column], inertia.MASS_INTEGRALS)


def arms_of_segment(row: str, arm: str) -> sp.Expr:
    """Arms of a segment's points, at r = 0 and per unit radius."""
    whole = airloads.on_segment(_OF_ARM[arm])
    return sp.expand(whole).coeff(s.radial_station, LINE_ROWS.index(row))


# Springs know the blade by flap, lag and pitch relative to the yoke alone; its coordinates reach them through these.
_ON_ITS_OWN = dict.fromkeys((*s.HINGE_LINKAGES, s.control_stiffness), 0)


def spring_moment(row: str) -> sp.Expr:
    """Moments of hinge springs and propeller moment by flap, lag and pitch relative to the yoke."""
    if row not in SPRUNG:
        return sp.Integer(0)
    return (flap_lag_springs.steady(row) + pitch.steady(row)).subs(_ON_ITS_OWN)


def spring_stiffness(row: str, column: str) -> sp.Expr:
    """Stiffness of hinge springs and propeller moment by flap, lag and pitch relative to the yoke."""
    if row not in SPRUNG or column not in SPRUNG:
        return sp.Integer(0)
    found = flap_lag_springs.stiffness(row, column) + pitch.stiffness(row, column)
    return found.subs(_ON_ITS_OWN)
