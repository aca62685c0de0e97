"""The published flap equation against Eq. 13 of AIAA-2002-1604, symbol by symbol."""

import pytest
import sympy as sp

from derive import flap_lag_springs, inertia, multiblade
from derive import kinematics as kin
from derive import symbols as s
from derive.published import PUBLISHED

HUB = ("x", "y", "z", "alpha_x", "alpha_y", "alpha_z")
ORDERS = {name: sp.symbols(f"{name} {name}_dot {name}_ddot") for name in multiblade.FIXED_COORDINATES}
BLADE_ANGLES = {name: sp.symbols(f"{name}_m {name}_m_dot {name}_m_ddot") for name in ("flap", "lag")}
GIMBAL = sp.symbols("beta_G beta_G_dot beta_G_ddot")


def derived_flap_equation() -> sp.Expr:
    """Flap row of one blade over I_b Omega², derivatives with respect to azimuth, hub motion in the fixed frame."""
    blade = inertia.BladeInertia(PUBLISHED)
    row = sp.Integer(0)
    transformation = multiblade.blade_coordinates()
    for place, name in enumerate(kin.COORDINATES):
        mass, gyroscopic = blade.mass("flap", name), blade.gyroscopic("flap", name) / s.rotor_speed
        stiffness = blade.centrifugal("flap", name) + flap_lag_springs.stiffness("flap", name, PUBLISHED)
        stiffness = sp.expand(stiffness / s.rotor_speed**2)
        zeroth, first, second = motion(name, transformation[place, :])
        row += mass * second + gyroscopic * first + stiffness * zeroth
    return in_mass_data(row) / s.blade_inertia


def motion(name: str, columns: sp.Matrix) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """A blade coordinate and its first two derivatives with azimuth."""
    if name in BLADE_ANGLES:
        return BLADE_ANGLES[name]
    if name == "gimbal_flap":
        return GIMBAL
    if name in ("gimbal_roll", "pitch"):
        return (sp.Integer(0),) * 3
    derivatives = [sp.Integer(0)] * 3
    for place, fixed in enumerate(multiblade.FIXED_COORDINATES):
        t = columns[place]
        t1, t2 = sp.diff(t, multiblade.psi), sp.diff(t, multiblade.psi, 2)
        q0, q1, q2 = ORDERS[fixed]
        derivatives[0] += t * q0
        derivatives[1] += t * q1 + t1 * q0
        derivatives[2] += t * q2 + 2 * t1 * q1 + t2 * q0
    return tuple(derivatives)


def in_mass_data(expression: sp.Expr) -> sp.Expr:
    """Trim integrals and sines in the blade's own data, to first order in the cone."""
    definitions = inertia.trim_integrals(PUBLISHED)
    for _ in range(4):
        expression = expression.subs(definitions)
    small = sp.Symbol("small")
    scaled = sp.expand(expression.subs({angle: small * angle for angle in (s.precone, s.coning)}))
    return sum(scaled.coeff(small, order) for order in (0, 1))


def printed_flap_equation() -> sp.Expr:
    """Eq. 13 as printed, left-hand side; one hinge offset e, here that of the flap hinge."""
    sine, cosine = sp.sin(multiblade.psi), sp.cos(multiblade.psi)
    first_moment, inertia_, coupling = (
        value / s.blade_inertia for value in (s.flap_first_moment, s.flap_inertia, s.flap_hub_inertia)
    )
    cone = s.precone + s.coning
    beta, _, beta2 = BLADE_ANGLES["flap"]
    zeta, zeta1, _ = BLADE_ANGLES["lag"]
    spring = flap_lag_springs.STIFFNESS["flap", "flap", 0]
    nu_squared = 1 + s.flap_hinge_offset * s.flap_first_moment / s.flap_inertia
    nu_squared += spring / (s.flap_inertia * s.rotor_speed**2)
    ax1, ay1, az1 = (ORDERS[f"alpha_{axis}"][1] for axis in "xyz")
    ax2, ay2 = (ORDERS[f"alpha_{axis}"][2] for axis in "xy")
    x2, y2, z2 = (ORDERS[axis][2] for axis in "xyz")
    cross_spring = flap_lag_springs.STIFFNESS["flap", "lag", 0] / (s.blade_inertia * s.rotor_speed**2)
    return (
        (coupling * (ax2 + 2 * ay1) - first_moment * cone * y2) * sine
        - (coupling * (ay2 - 2 * ax1) + first_moment * cone * x2) * cosine
        + first_moment * z2
        + coupling * (GIMBAL[2] + GIMBAL[0])
        + inertia_ * (beta2 + nu_squared * beta)
        + 2 * coupling * cone * (az1 + ORDERS["azimuth"][1])
        + 2 * inertia_ * cone * zeta1
        + cross_spring * zeta
    )


@pytest.fixture(scope="module")
def difference() -> sp.Expr:
    coupling = s.flap_inertia + s.flap_hinge_offset * s.flap_first_moment
    return sp.expand((derived_flap_equation() - printed_flap_equation()).subs(s.flap_hub_inertia, coupling))


def test_eq_13_is_reproduced_but_for_the_coriolis_term_of_lag(difference):
    """The print has + 2 I_beta (beta_P + beta_0) zeta'; Eqs. 11 and 12 give a minus, and two hinges I_beta_zeta."""
    cone, zeta_rate = s.precone + s.coning, BLADE_ANGLES["lag"][1]
    conflict = -2 * (s.flap_lag_inertia + s.flap_inertia) * cone * zeta_rate / s.blade_inertia
    assert sp.expand(difference - conflict) == 0


def test_the_derived_sign_of_the_coriolis_term_is_the_one_that_does_no_work():
    """Gyroscopic matrix skew: flap by lag is minus lag by flap."""
    blade = inertia.BladeInertia(PUBLISHED)
    assert sp.expand(blade.gyroscopic("flap", "lag") + blade.gyroscopic("lag", "flap")) == 0
