"""Eqs. 18-31: flap and lag springs inboard and outboard of the pitch bearing."""

import sympy as sp

from derive import symbols as s
from derive.audit.printed import notation as n
from derive.audit.printed.notation import TIME, PrintedEquation
from derive.flap_lag_springs import STIFFNESS, series_determinant

K_beta, K_zeta = s.flap_stiffness, s.lag_stiffness
R_beta, R_zeta = s.flap_outboard_fraction, s.lag_outboard_fraction
K_bb, K_bz, K_zz = (STIFFNESS[pair] for pair in (("flap", "flap", 0), ("flap", "lag", 0), ("lag", "lag", 0)))
Delta = series_determinant
beta, zeta = TIME["flap"][0], TIME["lag"][0]
sine, cosine = sp.sin(s.structural_pitch), sp.cos(s.structural_pitch)

stiffness = sp.Matrix([[K_bb, K_bz], [K_bz, K_zz]])
# The hub's springs are orthogonal in flap and lag, the blade's in its own axes.
inner = sp.diag(n.flexibility_in["bb"], n.flexibility_in["zz"])
outer = sp.Matrix(2, 2, [n.flexibility_out[pair] for pair in ("bb", "bz", "bz", "zz")])
deflection, moments = sp.Matrix([beta, zeta]), sp.Matrix([n.M_beta, n.M_zeta])
difference = R_beta * K_zeta - R_zeta * K_beta
flap_group = (R_zeta - K_zeta / K_beta * R_beta) * (R_beta - 1)
lag_group = (R_beta - K_beta / K_zeta * R_zeta) * (R_zeta - 1)
LOST = "subscripts β and ζ"


def _pair(vector: sp.Matrix, *names: str) -> dict[str, sp.Expr]:
    return dict(zip(names, vector.expand(), strict=True))


def _entries(matrix: sp.Matrix) -> dict[str, sp.Expr]:
    return {"ββ": matrix[0, 0], "βζ": matrix[0, 1], "ζζ": matrix[1, 1]}


EQUATIONS = (
    PrintedEquation(
        18,
        6,
        "flap and lag spring, hub and blade in series",
        {
            "K_β": n.K_beta_H * n.K_beta_B / (n.K_beta_H + n.K_beta_B),
            "K_ζ": n.K_zeta_H * n.K_zeta_B / (n.K_zeta_H + n.K_zeta_B),
        },
        unit="N m/rad",
    ),
    PrintedEquation(
        19,
        6,
        "share of the flexibility outboard of the pitch bearing",
        {"R_β": K_beta / n.K_beta_B, "R_ζ": K_zeta / n.K_zeta_B},
    ),
    PrintedEquation(20, 7, "elastic moments", _pair(stiffness * deflection, "M_β", "M_ζ"), unit="N m"),
    PrintedEquation(
        21,
        7,
        "effective stiffness",
        {
            "K_ββ": (K_beta + difference * sine**2) / Delta,
            "K_ζζ": (K_zeta - difference * sine**2) / Delta,
            "K_βζ": -difference * cosine * sine / Delta,
        },
        unit="N m/rad",
        restored=LOST,
    ),
    PrintedEquation(
        22,
        7,
        "determinant of the springs in series",
        {
            "Δ": 1
            + (2 * R_beta * R_zeta - R_beta - R_zeta) * sine**2
            + (R_beta * (1 - R_beta) * K_zeta / K_beta + R_zeta * (1 - R_zeta) * K_beta / K_zeta) * sine**2
        },
        restored=LOST,
    ),
    PrintedEquation(
        23,
        8,
        "flap frequency of a uniform helicopter blade",
        {"ν_β²": 1 + sp.Rational(3, 2) * n.mean_offset + K_beta / (s.flap_inertia * s.rotor_speed**2)},
        doubt="ē is read as e/(R - e)",
    ),
    PrintedEquation(24, 9, "flexibilities in series", _entries(inner + outer), unit="rad/N m"),
    PrintedEquation(
        25,
        9,
        "deflection inboard and outboard",
        _pair(sp.Matrix([n.beta_in + n.beta_out, n.zeta_in + n.zeta_out]), "β", "ζ"),
    ),
    PrintedEquation(26, 9, "deflection under moments", _pair((inner + outer) * moments, "β", "ζ")),
    PrintedEquation(27, 9, "deflection by itself", _pair((inner + outer) * stiffness * deflection, "β", "ζ")),
    PrintedEquation(
        28,
        9,
        "deflection inboard",
        _pair(inner * stiffness * deflection, "β_in", "ζ_in")
        | _pair(sp.Matrix([[n.A, n.B], [n.C, n.D]]) * deflection, "β_in by A, B", "ζ_in by C, D"),
    ),
    PrintedEquation(
        29,
        9,
        "deflection outboard",
        _pair(outer * stiffness * deflection, "β_out", "ζ_out")
        | _pair(sp.Matrix([[n.W, n.X], [n.Y, n.Z]]) * deflection, "β_out by W, X", "ζ_out by Y, Z"),
    ),
    PrintedEquation(
        30,
        9,
        "shares of the deflection inboard",
        {
            "A": (1 - R_beta + flap_group * sine**2) / Delta,
            "B": -flap_group * sine * cosine / Delta,
            "C": lag_group * sine * cosine / Delta,
            "D": (1 - R_zeta + lag_group * sine**2) / Delta,
        },
        restored=LOST,
    ),
    PrintedEquation(
        31,
        9,
        "shares of the deflection outboard",
        {
            "W": (R_beta + lag_group * sine**2) / Delta,
            "X": flap_group * sine * cosine / Delta,
            "Y": -lag_group * sine * cosine / Delta,
            "Z": (R_zeta + flap_group * sine**2) / Delta,
        },
        restored=LOST,
    ),
)
