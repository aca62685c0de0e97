"""Where every point of a blade is, and where it may virtually go (Eqs. 1-10).

One blade, in axes i, j, k that rotate at the constant speed rotor_speed: i chordwise towards the trailing edge, j
radial, k along the shaft. Hub motion and gimbal tilt are resolved along these axes too, so the blade does not know
its azimuth; `derive.multiblade` turns the components into the fixed frame and sums over the blades.

    p = hub + R_h R_y { (r - rho_beta) d1 + rho_beta d2 + rho_zeta [(cos zeta - 1) d2 + sin zeta i] }

Along the blade only the arms r - rho_beta, rho_beta and rho_zeta vary. The mass and the airloads need p and its first
and second derivatives at trim (`derive.expansion`); in the arms of the deflected blade these are short.
"""

from __future__ import annotations

import functools

import sympy as sp

from derive import symbols as s
from derive.coordinates import BLADE, names

COORDINATES = names(BLADE)
HUB_TRANSLATION = names(c for c in BLADE if c.angle == "hub")
HUB_ROTATION = names(c for c in BLADE if c.angle == "turn")


class _Perturbations(dict[str, sp.Symbol]):
    """Symbols by the names of coordinates; tells what to do about a name that is none."""

    def __missing__(self, name: str) -> sp.Symbol:
        raise s.MissingError(
            f"{name} is no coordinate of the blade: add it to `BLADE` of derive/coordinates.py"
        )


# Perturbations from trim; trim coning and lag are the values of flap and lag about which they are taken.
q = _Perturbations((name, sp.Symbol(f"q_{name}", real=True)) for name in COORDINATES)

I_AXIS = sp.Matrix([1, 0, 0])
J_AXIS = sp.Matrix([0, 1, 0])
K_AXIS = sp.Matrix([0, 0, 1])

# 1 outboard of a hinge, 0 inboard of it: a section inboard of a hinge does not feel it.
beyond_flap_hinge = s.quantity(
    "beyond_flap_hinge", r"h_\beta", "", "1 on a segment outboard of the flap hinge, else 0"
)
beyond_lag_hinge = s.quantity(
    "beyond_lag_hinge", r"h_\zeta", "", "1 on a segment outboard of the lag hinge, else 0"
)


def cross_matrix(vector: sp.Matrix) -> sp.Matrix:
    """[v]x, so that [v]x w = v x w."""
    a, b, c = vector
    return sp.Matrix([[0, -c, b], [c, 0, -a], [-b, a, 0]])


def rotation(vector: sp.Matrix) -> sp.Matrix:
    """exp([v]x) to second order, which holds its first and second derivatives at zero exactly."""
    spin = cross_matrix(vector)
    return sp.eye(3) + spin + spin * spin / 2


HUB = sp.Matrix([q[name] for name in HUB_TRANSLATION])
HUB_TURN = rotation(sp.Matrix([q[name] for name in HUB_ROTATION]))
GIMBAL_TILT = rotation(q["gimbal_flap"] * I_AXIS + q["gimbal_roll"] * J_AXIS)
# The blades spin in the tilted yoke. Rotation of speed +Omega about +K carries the blade towards -i.
BLADE_TO_ROTATING = HUB_TURN * GIMBAL_TILT * rotation(q["azimuth"] * K_AXIS)


def flapped(angle: sp.Expr) -> sp.Matrix:
    """Unit vector along a blade that is raised by `angle` towards k."""
    return sp.cos(angle) * J_AXIS + sp.sin(angle) * K_AXIS


def lagged(direction: sp.Matrix, angle: sp.Expr) -> sp.Matrix:
    """Unit vector along a blade part that has lagged by `angle` towards i out of `direction`."""
    return sp.cos(angle) * direction + sp.sin(angle) * I_AXIS


FLAP_ANGLE = s.coning + q["flap"]
LAG_ANGLE = s.lag + q["lag"]


# Arms of the undeflected blade.
inboard_arm = s.quantity(
    "inboard_arm", r"r-\rho_\beta", "m", "length inboard of the flap hinge, at most its offset"
)
outboard_arm = s.quantity("outboard_arm", r"\rho_\beta", "m", "distance outboard of the flap hinge")
lag_arm = s.quantity("lag_arm", r"\rho_\zeta", "m", "distance outboard of the lag hinge")

# Arms of the blade at trim: a point's position, and its distance from the flap hinge along the flapped blade.
chordwise_arm = s.quantity("chordwise_arm", "p_i", "m", "trim position towards the trailing edge")
radial_arm = s.quantity("radial_arm", "p_j", "m", "trim position outboard")
axial_arm = s.quantity("axial_arm", "p_k", "m", "trim position along the shaft")
flap_arm = s.quantity(
    "flap_arm", r"\rho_\beta-(1-\cos\bar\zeta_0)\rho_\zeta", "m", "arm of the flap displacement"
)


def blade_line() -> sp.Matrix:
    """Position of a point in the yoke, blade deflected by finite flap and lag angles."""
    outboard = flapped(s.precone + FLAP_ANGLE)
    swing = lagged(outboard, LAG_ANGLE) - outboard
    return inboard_arm * flapped(s.precone) + outboard_arm * outboard + lag_arm * swing


def deflected_line() -> sp.Matrix:
    """`blade_line` to second order about trim, in the arms of the deflected blade."""
    at_trim_by_arm = {outboard_arm: flap_arm + (1 - sp.cos(s.lag)) * lag_arm}
    expansion = sp.Matrix([chordwise_arm, radial_arm, axial_arm]) + change(blade_line())
    return expansion.subs(at_trim_by_arm).expand()


def change(vector: sp.Matrix) -> sp.Matrix:
    """What flap and lag from trim make of a vector, to second order."""
    total = sp.zeros(*vector.shape)
    for a in ("flap", "lag"):
        total += q[a] * at_trim(sp.diff(vector, q[a]))
        for b in ("flap", "lag"):
            total += q[a] * q[b] * at_trim(sp.diff(vector, q[a], q[b])) / 2
    return total


def trim_arms() -> dict[sp.Symbol, sp.Expr]:
    """The trim position in the arms of the deflected blade."""
    line = at_trim(blade_line()).subs(outboard_arm, flap_arm + (1 - sp.cos(s.lag)) * lag_arm)
    return dict(zip((chordwise_arm, radial_arm, axial_arm), line.expand(), strict=True))


@functools.cache
def deflected_flap_arm() -> sp.Expr:
    """The flap arm of the deflected blade in the arms of the undeflected one: lag brings the tip inboard."""
    normal = at_trim(sp.diff(blade_line(), q["flap"]))
    return sp.simplify(normal.dot(sp.diff(flapped(s.precone + s.coning), s.coning)))


def blade_axes() -> sp.Matrix:
    """Columns i', n, d of a section in the yoke: chordwise, normal, along the blade."""
    cone = s.precone + beyond_flap_hinge * FLAP_ANGLE
    lag_angle = beyond_lag_hinge * LAG_ANGLE
    outward = flapped(cone)
    normal = -sp.sin(cone) * J_AXIS + sp.cos(cone) * K_AXIS
    chordwise = sp.cos(lag_angle) * I_AXIS - sp.sin(lag_angle) * outward
    return sp.Matrix.hstack(chordwise, normal, lagged(outward, lag_angle))


def gimbal_flap_and_roll() -> tuple[sp.Expr, sp.Expr]:
    """Tilt of the yoke seen from the blade: flap angle beta_G (Eq. 1) and roll gamma about its own radius."""
    tilt = q["gimbal_flap"] * I_AXIS + q["gimbal_roll"] * J_AXIS
    seen = rotation(-q["azimuth"] * K_AXIS) * tilt
    return seen[0], seen[1]


def pitch_angles(dropped: frozenset[str] = frozenset()) -> tuple[sp.Expr, sp.Expr]:
    """Blade pitch relative to the shaft (Theta_s) and to the yoke (Theta_y); the swashplate follows the shaft.

    Linkages turn the blade as the gimbal tilts and as the blade moves on its own hinges. The trim pitch has what the
    trim coning and lag turn it by.
    """
    gimbal_flap, gimbal_roll = gimbal_flap_and_roll()
    of_hinges = s.kinematic_pitch_flap_coupling * q["flap"] + s.kinematic_pitch_lag_coupling * q["lag"]
    to_shaft = s.pitch + q["pitch"] - s.pitch_gimbal_coupling * gimbal_flap - of_hinges
    if "yoke_roll" in dropped:
        return tuple([to_shaft.subs(q["gimbal_roll"], 0)] * 2)
    return to_shaft, to_shaft - gimbal_roll


def at_trim(expression: sp.Basic) -> sp.Basic:
    """The value with every perturbation at zero."""
    return expression.xreplace(dict.fromkeys(q.values(), sp.Integer(0)))
