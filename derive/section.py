"""Loads of a blade section and their derivatives with the air's velocity and the pitch (quasi-steady strip theory).

    L = 1/2 rho c U² c_l, D = 1/2 rho c U² c_d, moment 1/2 rho c² U² c_m, with U² = u_T² + u_P²,
    alpha = pitch - atan(u_P / u_T) and Mach = U / a_s; radial drag 1/2 rho c U c_d u_R against d.

A section that turns about d may be given thin-airfoil theory's quasi-steady damping about the quarter chord,
- pi/8 rho c³ U omega_d, the part of the moment that circulation does not bring.
"""

from __future__ import annotations

import functools

import sympy as sp

from derive import symbols as s
from derive.airloads import ARGUMENTS, LOADS

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
angle_of_attack = s.quantity("angle_of_attack", r"\alpha", "rad", "angle of attack")
mach = s.quantity("mach", "M", "", "Mach number of the section")
pressure_chord = s.quantity("pressure_chord", r"\rho c/2", "kg/m^2", "half the density times the chord")

COEFFICIENTS = ("lift", "drag", "moment")
_LATEX = {"lift": "c_l", "drag": "c_d", "moment": "c_m"}
COEFFICIENT = {
    (name, by): s.quantity(
        f"{name}_coefficient{suffix}", f"{_LATEX[name]}{latex}", per, f"{name} coefficient{meaning}"
    )
    for name in COEFFICIENTS
    for by, suffix, latex, per, meaning in (
        ("", "", "", "", ""),
        ("alpha", "_alpha", r"{}_\alpha", "/rad", ", derivative with angle of attack"),
        ("mach", "_mach", "{}_M", "", ", derivative with Mach number"),
    )
}

VELOCITY = {
    "_ut": tangential_velocity,
    "_up": axial_velocity,
    "_ur": radial_velocity,
    "_theta": section_pitch,
}
VELOCITY["_spin"] = section_spin

# Derivatives of the coefficients with the velocities, through angle of attack and Mach number.
COEFFICIENT_BY_VELOCITY = {
    (name, velocity): s.quantity(
        f"{name}_coefficient{velocity}",
        f"{_LATEX[name]}{{}}_{{,u}}",
        "s/m",
        f"{name} coefficient, derivative with a velocity",
    )
    for name in COEFFICIENTS
    for velocity in ("_ut", "_up")
}
chordwise_coefficient = s.quantity(
    "chordwise_coefficient", "c_x U", "m/s", "section speed times force coefficient along i'"
)
normal_coefficient = s.quantity(
    "normal_coefficient", "c_n U", "m/s", "section speed times force coefficient along n"
)


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


def speed() -> sp.Expr:
    return sp.sqrt(tangential_velocity**2 + axial_velocity**2)


def inflow() -> sp.Expr:
    """Inflow angle; u_T is positive wherever the rotor turns forward."""
    return sp.atan(axial_velocity / tangential_velocity)


def _coefficient(name: str) -> sp.Expr:
    """A coefficient as it depends on the air and the pitch."""
    return sp.Function(name)(tangential_velocity, axial_velocity, section_pitch)


@functools.cache
def loads() -> dict[str, sp.Expr]:
    """f_x, f_n, f_d and m in the velocities and the pitch."""
    lift, drag, moment = (_coefficient(name) for name in COEFFICIENTS)
    # sin phi = u_P / U and cos phi = u_T / U
    spin_moment = section_damping * sp.pi / 4 * s.chord * section_spin
    return {
        "fx": pressure_chord * speed() * (lift * axial_velocity + drag * tangential_velocity),
        "fn": pressure_chord * speed() * (lift * tangential_velocity - drag * axial_velocity),
        "fd": -pressure_chord * speed() * drag * radial_velocity,
        "m": pressure_chord * s.chord * speed() * (speed() * moment - spin_moment),
    }


@functools.cache
def coefficients_by_velocity() -> dict[sp.Symbol, sp.Expr]:
    """Chain rule through angle of attack and Mach number."""
    angle, mach_number = section_pitch - inflow(), speed() / s.speed_of_sound
    return {
        symbol: _speed_named(
            COEFFICIENT[name, "alpha"] * sp.diff(angle, VELOCITY[velocity])
            + COEFFICIENT[name, "mach"] * sp.diff(mach_number, VELOCITY[velocity])
        )
        for (name, velocity), symbol in COEFFICIENT_BY_VELOCITY.items()
    }


@functools.cache
def force_coefficients() -> dict[sp.Symbol, sp.Expr]:
    """The sums of lift and drag that every derivative of the forces holds."""
    lift, drag = COEFFICIENT["lift", ""], COEFFICIENT["drag", ""]
    return {
        chordwise_coefficient: lift * axial_velocity + drag * tangential_velocity,
        normal_coefficient: lift * tangential_velocity - drag * axial_velocity,
    }


@functools.cache
def load_derivatives() -> dict[sp.Symbol, sp.Expr]:
    """Each load and each derivative, in the section's speed, velocities and airfoil coefficients."""
    return {
        symbol: _named(loads()[load] if not argument else sp.diff(loads()[load], VELOCITY[argument]))
        for (load, argument), symbol in SECTION_LOADS.items()
    }


def in_airfoil_coefficients(expression: sp.Expr) -> sp.Expr:
    """The named groups and chain-rule derivatives written out."""
    return expression.subs(force_coefficients()).subs(coefficients_by_velocity())


def _named(expression: sp.Expr) -> sp.Expr:
    """Coefficients, their derivatives, groups and speed by name."""
    names = {}
    for name in COEFFICIENTS:
        function = _coefficient(name)
        names[sp.diff(function, section_pitch)] = COEFFICIENT[name, "alpha"]
        names |= {sp.diff(function, VELOCITY[v]): COEFFICIENT_BY_VELOCITY[name, v] for v in ("_ut", "_up")}
    expression = expression.subs(names).subs(
        {_coefficient(name): COEFFICIENT[name, ""] for name in COEFFICIENTS}
    )
    for symbol, group in force_coefficients().items():
        expression = expression.subs(group, symbol)
    return sp.factor_terms(_speed_named(expression))


def _speed_named(expression: sp.Expr) -> sp.Expr:
    expression = expression.subs(speed(), section_speed)
    expression = expression.subs(tangential_velocity**2 + axial_velocity**2, section_speed**2)
    ratio = section_speed**2 / tangential_velocity**2
    return expression.subs(1 + axial_velocity**2 / tangential_velocity**2, ratio)


def air_at_section() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Speed, inflow angle, angle of attack and Mach number."""
    return [
        (section_speed, speed()),
        (inflow_angle, inflow()),
        (angle_of_attack, section_pitch - inflow_angle),
        (mach, section_speed / s.speed_of_sound),
    ]


prandtl_glauert_factor = s.quantity("prandtl_glauert_factor", "g", "", "Prandtl-Glauert factor")
prandtl_glauert_slope = s.quantity("prandtl_glauert_slope", "g'", "", "its derivative with Mach number")


def prandtl_glauert() -> list[tuple[sp.Symbol, sp.Expr]]:
    """1/sqrt(1 - M²), and its derivative in terms of itself."""
    factor = 1 / sp.sqrt(1 - mach**2)
    named = sp.Symbol("named", positive=True)
    slope = sp.diff(factor, mach).subs(1 - mach**2, named**-2).subs(named, prandtl_glauert_factor)
    return [(prandtl_glauert_factor, factor), (prandtl_glauert_slope, slope)]
