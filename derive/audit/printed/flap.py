"""Eqs. 12 and 13: the flap equation of one blade, and the flap and lag frequencies of the nomenclature."""

import sympy as sp

from derive import flap_lag_springs
from derive import symbols as s
from derive.audit.printed.notation import (
    AZIMUTH,
    TIME,
    M_beta_aero,
    M_beta_elas,
    PrintedEquation,
    a_j,
    a_k,
    e,
    m,
    printed,
)
from derive.multiblade import psi

r, omega = s.radial_station, s.rotor_speed
sine, cosine = sp.sin(psi), sp.cos(psi)
cone = s.precone + s.coning
S_beta, I_beta, I_beta_alpha = (
    value / s.blade_inertia for value in (s.flap_first_moment, s.flap_inertia, s.flap_hub_inertia)
)
nu_beta_squared = printed("nu_beta_squared")
radius = printed("R", "m")
K_beta_zeta = flap_lag_springs.STIFFNESS["flap", "lag", 0]

(_, _, x2), (_, _, y2), (_, _, z2) = (AZIMUTH[name] for name in ("x", "y", "z"))
(_, ax1, ax2), (_, ay1, ay2), (_, az1, _) = (AZIMUTH[name] for name in ("alpha_x", "alpha_y", "alpha_z"))
beta, _, beta2 = AZIMUTH["flap"]
zeta, zeta1, _ = AZIMUTH["lag"]
beta_G, _, beta_G2 = AZIMUTH["gimbal_flap"]
psi_s1 = AZIMUTH["azimuth"][1]

EQUATIONS = (
    PrintedEquation(
        12,
        4,
        "moments about the flap hinge",
        {
            "integrand": m * a_k * (r - e)
            - m * a_j * (r - e) * (TIME["flap"][0] + s.precone + TIME["gimbal_flap"][0]),
            "moments": M_beta_elas - M_beta_aero,
        },
        unit={"integrand": "N", "moments": "N m"},
        readings=("one hinge offset",),
    ),
    PrintedEquation(
        13,
        4,
        "flap equation of one blade, divided by I_b Ω²",
        {
            "inertia and springs": (I_beta_alpha * (ax2 + 2 * ay1) - S_beta * cone * y2) * sine
            - (I_beta_alpha * (ay2 - 2 * ax1) + S_beta * cone * x2) * cosine
            + S_beta * z2
            + I_beta_alpha * (beta_G2 + beta_G)
            + I_beta * (beta2 + nu_beta_squared * beta)
            + 2 * I_beta_alpha * cone * (az1 + psi_s1)
            + 2 * I_beta * cone * zeta1
            + K_beta_zeta * zeta / (s.blade_inertia * omega**2),
            "airloads": M_beta_aero / (s.blade_inertia * omega**2),
        },
        readings=("one hinge offset",),
        doubt="ν_β² as in Eq. 23, that is 1 + e S_β/I_β + K_ββ/(I_β Ω²); the nomenclature's has the wrong dimension",
    ),
)

NOMENCLATURE = (
    PrintedEquation(
        "ν_β",
        2,
        "rotating flap frequency, nomenclature",
        {
            "ν_β²": 1
            + s.flap_first_moment / s.flap_inertia * e / (radius - e)
            + flap_lag_springs.STIFFNESS["flap", "flap", 0] / (s.flap_inertia * omega**2)
        },
        readings=("one hinge offset",),
        doubt="S_β may be meant as a number there",
    ),
    PrintedEquation(
        "ν_ζ",
        2,
        "rotating lag frequency, nomenclature",
        {
            "ν_ζ²": s.lag_first_moment / s.lag_inertia * e / (radius - e)
            + flap_lag_springs.STIFFNESS["lag", "lag", 0] / (s.lag_inertia * omega**2)
        },
        readings=("one hinge offset",),
        doubt="S_ζ may be meant as a number there",
    ),
)
