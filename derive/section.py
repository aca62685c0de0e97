"""Loads of a blade section and their derivatives with the air's velocity and the pitch (quasi-steady strip theory).

    L = 1/2 rho c U² c_l, D = 1/2 rho c U² c_d, moment 1/2 rho c² U² c_m, with U² = u_T² + u_P²,
    alpha = pitch - atan(u_P / u_T) and Mach = U / a_s; radial drag 1/2 rho c U c_d u_R against d.

The air is taken by its speed and its inflow angle: in these the loads have few derivatives, from which those with u_T
and u_P follow by the turn from polar to rectangular components.

A section that turns about d at omega_d meets air that is curved like its own path: thin-airfoil theory's quasi-steady
damping. Its 3/4 chord, where the incidence makes the lift, moves at c omega_d / 2 to the quarter chord; and about the
quarter chord it has the moment - pi/8 rho c³ U omega_d, which circulation does not bring:

    c_l = c_l(alpha + c omega_d / (2 U), Mach)        moment 1/2 rho c² U² (c_m - pi/4 c omega_d / U)

Drag and c_m keep the angle of attack of the quarter chord, and lift stays normal to the air there. omega_d is the whole
turn of the section in space: a coned blade has Omega sin(cone) of it in steady flight.
"""

from __future__ import annotations

import functools
from collections.abc import Callable

import sympy as sp

from derive import airloads
from derive import symbols as s
from derive.airloads import ARGUMENTS, LOADS
from derive.coordinates import LOAD, MOTION

tangential_velocity = s.quantity("tangential_velocity", "u_T", "m/s", "velocity of the air along i'")
axial_velocity = s.quantity("axial_velocity", "u_P", "m/s", "velocity of the section along n")
radial_velocity = s.quantity("radial_velocity", "u_R", "m/s", "velocity of the section along d")
section_spin = s.quantity("section_spin", r"\omega_d", "rad/s", "rotation of the section about d, nose up")
section_damping = s.quantity(
    "section_damping", r"\pi_d", "", "1 with quasi-steady pitch damping of the section, else 0"
)
section_pitch = s.quantity("section_pitch", r"\theta", "rad", "pitch of the section: trim pitch and twist")
section_speed = s.quantity("section_speed", "U", "m/s", "speed of the air in the section's plane")
inflow_angle = s.quantity("inflow_angle", r"\phi", "rad", "angle of the air's velocity to i'")
inflow_cosine = s.quantity("inflow_cosine", r"\cos\phi", "", "cosine of the inflow angle, u_T/U")
inflow_sine = s.quantity("inflow_sine", r"\sin\phi", "", "sine of the inflow angle, u_P/U")
angle_of_attack = s.quantity("angle_of_attack", r"\alpha", "rad", "angle of attack")
turn_incidence = s.quantity(
    "turn_incidence", r"\alpha_\omega", "rad", "angle of attack at 3/4 chord less that at the quarter chord"
)
lift_incidence = s.quantity(
    "lift_incidence", r"\alpha_l", "rad", "angle of attack at 3/4 chord, which makes the lift"
)
mach = s.quantity("mach", "M", "", "Mach number of the section")
pressure_chord = s.quantity("pressure_chord", r"\rho c/2", "kg/m^2", "half the density times the chord")
pressure_speed = s.quantity(
    "pressure_speed", r"\rho c U/2", "kg/(m s)", "half the density times chord and section speed"
)

COEFFICIENTS = ("lift", "drag", "moment")
_LATEX = {"lift": "c_l", "drag": "c_d", "moment": "c_m", "chordwise": "c_x", "normal": "c_n"}
_BY = (
    ("", "", "", ""),
    ("alpha", "_alpha", r"{}_\alpha", ", derivative with angle of attack"),
    ("mach", "_mach", "{}_M", ", derivative with Mach number"),
)


def _coefficients(names: tuple[str, ...]) -> dict[tuple[str, str], sp.Symbol]:
    return {
        (name, by): s.quantity(
            f"{name}_coefficient{suffix}",
            f"{_LATEX[name]}{latex}",
            "/rad" if by == "alpha" else "",
            f"{name} coefficient{meaning}",
        )
        for name in names
        for by, suffix, latex, meaning in _BY
    }


COEFFICIENT = _coefficients(COEFFICIENTS)
# Lift and drag, turned by the inflow angle: along i' and along n.
FORCE_COEFFICIENT = _coefficients(("chordwise", "normal"))
_TURN = {
    "lift": {"chordwise": inflow_sine, "normal": inflow_cosine},
    "drag": {"chordwise": inflow_cosine, "normal": -inflow_sine},
}


def _unit(load: str, per: str) -> str:
    """Unit of a section load, or of its derivative with a velocity or a rotation."""
    lengths = (load != "m") + (per == " s/m")
    numerator = "N s" if per else "N"
    return numerator + {0: "", 1: "/m", 2: "/m^2"}[lengths]


SECTION_LOADS = {
    (load, argument): s.quantity(
        load + argument,
        f"{latex}{{}}_{{,{by}}}" if by else latex,
        _unit(load, per),
        f"{meaning} per unit span{by_meaning}",
    )
    for load, (latex, _, meaning) in LOADS.items()
    for argument, (by, per, by_meaning) in ARGUMENTS.items()
}
# Derivatives along the air's velocity, and across it: with the inflow angle, over the speed.
POLAR_LOADS = {
    (load, argument): s.quantity(
        f"{load}_{argument}", f"{latex}{{}}_{{,{by}}}", _unit(load, " s/m"), f"{meaning} per unit span{told}"
    )
    for load, (latex, _, meaning) in LOADS.items()
    for argument, by, told in (
        ("speed", "U", " per speed"),
        ("inflow", r"\phi", " per inflow angle, over the speed"),
    )
}
FORCES = ("fx", "fn", "fd")


def speed() -> sp.Expr:
    return sp.sqrt(tangential_velocity**2 + axial_velocity**2)


def incidence_of_turn() -> sp.Expr:
    """What the turn of a section adds at 3/4 chord to the angle of attack of the quarter chord."""
    return section_damping * s.chord * section_spin / (2 * section_speed)


def coefficient(name: str) -> sp.Expr:
    """A coefficient as it depends on the air, in polar components, and the pitch; for lift the turn is held."""
    return sp.Function(name)(section_speed, inflow_angle, section_pitch)


@functools.cache
def loads() -> dict[str, sp.Expr]:
    """f_x, f_n, f_d and m in speed, inflow angle, radial velocity, pitch and rotation."""
    lift, drag, moment = (coefficient(name) for name in COEFFICIENTS)
    cosine, sine = sp.cos(inflow_angle), sp.sin(inflow_angle)
    spin_moment = sp.pi / 2 * section_speed * incidence_of_turn()
    return {
        "fx": pressure_chord * section_speed**2 * (lift * sine + drag * cosine),
        "fn": pressure_chord * section_speed**2 * (lift * cosine - drag * sine),
        "fd": -pressure_chord * section_speed * drag * radial_velocity,
        "m": pressure_chord * s.chord * section_speed * (section_speed * moment - spin_moment),
    }


_DIRECT = {"_ur": radial_velocity, "_theta": section_pitch, "_spin": section_spin}


@functools.cache
def load_derivatives() -> dict[sp.Symbol, sp.Expr]:
    """Each load and each derivative: those with speed and inflow angle, and from them those with u_T and u_P."""
    steps = {}
    for load, expression in loads().items():
        steps[SECTION_LOADS[load, ""]] = named(expression)
        along, across = POLAR_LOADS[load, "speed"], POLAR_LOADS[load, "inflow"]
        steps[along] = derivative(expression, section_speed)
        steps[across] = named(sp.diff(expression, inflow_angle) / section_speed)
        steps[SECTION_LOADS[load, "_ut"]] = along * inflow_cosine - across * inflow_sine
        steps[SECTION_LOADS[load, "_up"]] = along * inflow_sine + across * inflow_cosine
        for argument, variable in _DIRECT.items():
            steps[SECTION_LOADS[load, argument]] = derivative(expression, variable)
    return steps


def derivative(expression: sp.Expr, variable: sp.Symbol) -> sp.Expr:
    """Derivative of a load by speed, radial velocity, pitch or rotation: its own, and by the incidence of the turn."""
    by_turn = sp.diff(expression, coefficient("lift")) * sp.diff(incidence_of_turn(), variable)
    by_turn = by_turn.subs(section_spin, 2 * section_speed * turn_incidence / (section_damping * s.chord))
    return named(sp.diff(expression, variable)) + named(by_turn) * COEFFICIENT["lift", "alpha"]


def load_derivative(load: str, motion: str) -> sp.Expr:
    """L: generalised loads of a segment per unit of its motions, from radial moments of the section's derivatives.

    An entry is a radial moment, or zero where no section has such a derivative.
    """
    of_section = SECTION_LOADS[LOAD[load].section_load, f"_{MOTION[motion].argument}"]
    return sp.Integer(0) if about_axis()[of_section] == 0 else airloads.load_derivative(load, motion)


def force_coefficients() -> dict[sp.Symbol, sp.Expr]:
    """Lift and drag coefficient and their derivatives, turned by the inflow angle."""
    return {
        symbol: sum(_TURN[name][direction] * COEFFICIENT[name, by] for name in ("lift", "drag"))
        for (direction, by), symbol in FORCE_COEFFICIENT.items()
    }


def steps_of(wanted: tuple[str, ...]) -> list[tuple[sp.Symbol, sp.Expr]]:
    """Steps to some of the loads and their derivatives, f_x, f_n, f_d or m."""
    names = {symbol for (load, _), symbol in (SECTION_LOADS | POLAR_LOADS).items() if load in wanted}
    found = [(symbol, value) for symbol, value in load_derivatives().items() if symbol in names]
    groups = force_coefficients().items() if "fx" in wanted else ()
    return [
        (pressure_chord, s.density * s.chord / 2),
        (pressure_speed, pressure_chord * section_speed),
        *groups,
        *found,
    ]


def forces() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Forces of a section per unit span and derivatives with the air's velocity and the pitch."""
    return steps_of(FORCES)


def pitching_moment() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Pitching moment of a section per unit span and derivatives with the air's velocity and the pitch."""
    return steps_of(("m",))


def steady_forces() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Forces of a section per unit span, without derivatives."""
    wanted = {SECTION_LOADS[load, ""] for load in FORCES}
    groups = {FORCE_COEFFICIENT[direction, ""] for direction in ("chordwise", "normal")}
    kept = wanted | groups | {pressure_chord, pressure_speed}
    return [(symbol, value) for symbol, value in steps_of(FORCES) if symbol in kept]


def in_airfoil_coefficients(expression: sp.Expr) -> sp.Expr:
    """A load or derivative written out in u_T, u_P, the speed and the airfoil's coefficients."""
    polar = {symbol: load_derivatives()[symbol] for symbol in POLAR_LOADS.values()}
    for names in (polar, force_coefficients(), _INFLOW, {pressure_speed: pressure_chord * section_speed}):
        expression = expression.subs(names)
    return expression


_INFLOW = {inflow_cosine: tangential_velocity / section_speed, inflow_sine: axial_velocity / section_speed}


def named(expression: sp.Expr) -> sp.Expr:
    """Coefficients and their derivatives by name, lift and drag as force coefficients."""
    names = {}
    for name in COEFFICIENTS:
        function = coefficient(name)
        # c = c(pitch - inflow angle, U / a_s): the chain rule, with 1 / a_s = M / U
        names[sp.diff(function, section_pitch)] = COEFFICIENT[name, "alpha"]
        names[sp.diff(function, inflow_angle)] = -COEFFICIENT[name, "alpha"]
        names[sp.diff(function, section_speed)] = COEFFICIENT[name, "mach"] * mach / section_speed
    expression = expression.subs(names)
    expression = expression.subs({coefficient(name): COEFFICIENT[name, ""] for name in COEFFICIENTS})
    expression = expression.subs({sp.cos(inflow_angle): inflow_cosine, sp.sin(inflow_angle): inflow_sine})
    if expression.has(inflow_cosine):
        expression = _in_force_coefficients(expression)
    expression = sp.expand(expression).subs(pressure_chord, pressure_speed / section_speed)
    return sp.factor_terms(sp.expand(expression))


def _in_force_coefficients(expression: sp.Expr) -> sp.Expr:
    """Lift and drag put back from the force coefficients, so that sines and cosines drop out."""
    lift_and_drag = {
        COEFFICIENT[name, by]: sum(
            _TURN[name][direction] * FORCE_COEFFICIENT[direction, by] for direction in _TURN[name]
        )
        for name in _TURN
        for by, *_ in _BY
    }
    expression = sp.expand(expression.subs(lift_and_drag))
    return sp.expand(expression.subs(inflow_cosine**2, 1 - inflow_sine**2))


def air_at_section() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Speed and direction of the air, angle of attack and Mach number of a section.

    u_T > 0 wherever the rotor turns forward.
    """
    return [
        (section_speed, speed()),
        *_INFLOW.items(),
        (angle_of_attack, section_pitch - sp.atan(axial_velocity / tangential_velocity)),
        (turn_incidence, incidence_of_turn()),
        (lift_incidence, angle_of_attack + turn_incidence),
        (mach, section_speed / s.speed_of_sound),
    ]


# An aerodynamic centre beside the pitch axis. Velocities, rotation and moment of a section are those of the axis.
aerodynamic_center = s.quantity(
    "aerodynamic_center", "x_a", "m", "aerodynamic centre of the section aft of the pitch axis"
)
center_along = s.quantity(
    "center_along", r"x_a\cos\theta", "m", "aerodynamic centre from the pitch axis along i'"
)
center_below = s.quantity(
    "center_below", r"x_a\sin\theta", "m", "aerodynamic centre from the pitch axis against n"
)
tangential_at_center = s.quantity(
    "tangential_at_center", "u_{T,a}", "m/s", "velocity of the air along i' at the aerodynamic centre"
)
axial_at_center = s.quantity(
    "axial_at_center", "u_{P,a}", "m/s", "velocity of the aerodynamic centre along n"
)
AT_CENTER = {
    symbol: s.quantity(
        f"{symbol.name}_at_center",
        f"{s.QUANTITIES[symbol].latex}{{}}_{{|a}}",
        s.QUANTITIES[symbol].unit,
        f"{s.QUANTITIES[symbol].meaning}, of the aerodynamic centre",
    )
    for symbol in SECTION_LOADS.values()
}


def center() -> tuple[sp.Expr, sp.Expr]:
    """Place of the aerodynamic centre along i' and against n: a section that is nose up has its rear below the axis."""
    return aerodynamic_center * sp.cos(section_pitch), aerodynamic_center * sp.sin(section_pitch)


def velocities_at_center() -> dict[sp.Symbol, sp.Expr]:
    """u_T and u_P of the aerodynamic centre, which a rotation of the section moves ahead and down."""
    along, below = center()
    return {
        tangential_velocity: tangential_velocity + below * section_spin,
        axial_velocity: axial_velocity - along * section_spin,
    }


def air_beside_axis() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Place of the aerodynamic centre beside the pitch axis, and the air that it meets, as `air_at_section`."""
    named_center = dict(zip(center(), (center_along, center_below), strict=True))
    velocities = velocities_at_center()
    at_center = {tangential_velocity: tangential_at_center, axial_velocity: axial_at_center}
    return [
        *((symbol, place) for place, symbol in named_center.items()),
        *((at_center[symbol], value.subs(named_center)) for symbol, value in velocities.items()),
        *((symbol, value.xreplace(at_center)) for symbol, value in air_at_section()),
    ]


@functools.cache
def about_axis() -> dict[sp.Symbol, sp.Expr]:
    """Loads of a section about its pitch axis, and derivatives, by those of an aerodynamic centre beside the axis.

    The radial drag, which is small, acts on the axis and by the velocity of the axis.
    """
    found = {SECTION_LOADS[load, ""]: _at_center(load) for load in LOADS}
    for name in _ARGUMENTS:
        for load in LOADS:
            of_center = functools.partial(_derivative_at_center, load)
            found[SECTION_LOADS[load, f"_{name}"]] = along_argument(name, of_center)
    for force, arm in zip(("fn", "fx"), center(), strict=True):
        found[SECTION_LOADS["m", ""]] -= arm * found[SECTION_LOADS[force, ""]]
        for name, symbol in _ARGUMENTS.items():
            derivative = arm * found[SECTION_LOADS[force, f"_{name}"]] + sp.diff(arm, symbol) * _at_center(
                force
            )
            found[SECTION_LOADS["m", f"_{name}"]] -= derivative
    return {symbol: sp.expand(_with_places(value)) for symbol, value in found.items()}


def along_argument(name: str, at_center: Callable[[str], sp.Expr]) -> sp.Expr:
    """Derivative with an argument of the axis of what has the derivatives `at_center` with those of the centre."""
    moved = ((other, velocities_at_center().get(symbol, symbol)) for other, symbol in _ARGUMENTS.items())
    total = sum(sp.diff(value, _ARGUMENTS[name]) * at_center(other) for other, value in moved)
    return _with_places(total)


def _with_places(expression: sp.Expr) -> sp.Expr:
    """Name the place of the aerodynamic centre."""
    names = {aerodynamic_center * wave(section_pitch): place for wave, place in _PLACES.items()}
    return sp.expand(expression).subs(names)


_ARGUMENTS = {
    "ut": tangential_velocity,
    "up": axial_velocity,
    "ur": radial_velocity,
    "theta": section_pitch,
    "spin": section_spin,
}
_PLACES = {sp.cos: center_along, sp.sin: center_below}


def _derivative_at_center(load: str, argument: str) -> sp.Expr:
    return _at_center(load, f"_{argument}")


def _at_center(load: str, argument: str = "") -> sp.Expr:
    """A load or derivative at the centre; zero where the section has none."""
    symbol = SECTION_LOADS[load, argument]
    return sp.Integer(0) if load_derivatives()[symbol] == 0 else AT_CENTER[symbol]


prandtl_glauert_factor = s.quantity("prandtl_glauert_factor", "g", "", "Prandtl-Glauert factor")
prandtl_glauert_slope = s.quantity("prandtl_glauert_slope", "g'", "", "its derivative with Mach number")


def prandtl_glauert() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Prandtl-Glauert factor and its derivative with Mach number; Mach below 1."""
    factor = 1 / sp.sqrt(1 - mach**2)
    named = sp.Symbol("named", positive=True)
    slope = sp.diff(factor, mach).subs(1 - mach**2, named**-2).subs(named, prandtl_glauert_factor)
    return [(prandtl_glauert_factor, factor), (prandtl_glauert_slope, slope)]
