"""Eqs. 1-11: position and acceleration of a point of the blade, motion of the hub."""

import sympy as sp

from derive import symbols as s
from derive.audit.printed.notation import TIME, PrintedEquation, e, printed
from derive.multiblade import psi

r, omega = s.radial_station, s.rotor_speed
sine, cosine = sp.sin(psi), sp.cos(psi)
cone = s.precone + s.coning

beta, beta_dot, beta_ddot = TIME["flap"]
zeta, zeta_dot, zeta_ddot = TIME["lag"]
psi_s, psi_s_dot, psi_s_ddot = TIME["azimuth"]
beta_G, _, beta_G_ddot = TIME["gimbal_flap"]
DISPLACEMENT = ("x", "y", "z")
ROTATION = ("alpha_x", "alpha_y", "alpha_z")

# Vectors of Eq. 10 by their components along three fixed axes.
VECTORS = {
    name: sp.Matrix([printed(f"{name}_{axis}", unit) for axis in "123"])
    for name, unit in (
        ("a_h", "m/s^2"),
        ("a_bh", "m/s^2"),
        ("v_bh", "m/s"),
        ("r_bh", "m"),
        ("omega_h", "rad/s"),
        ("alpha_h", "rad/s^2"),
    )
}

in_plane_of_hub = (r - e) * (zeta_ddot - omega**2 * zeta) - r * (psi_s_ddot - omega**2 * psi_s)
in_plane_of_hub += 2 * omega * (r - e) * cone * beta_dot


def _fixed(names: tuple[str, ...], order: int) -> dict[str, sp.Expr]:
    return dict(zip("IJK", (TIME[name][order] for name in names), strict=True))


def _rotating(names: tuple[str, ...], order: int) -> dict[str, sp.Expr]:
    a, b, c = (TIME[name][order] for name in names)
    return {"i": a * sine - b * cosine, "j": a * cosine + b * sine, "k": c}


def _acceleration() -> dict[str, sp.Expr]:
    v = VECTORS
    total = v["a_h"] + v["a_bh"] + 2 * v["omega_h"].cross(v["v_bh"])
    total += v["omega_h"].cross(v["omega_h"].cross(v["r_bh"])) + v["alpha_h"].cross(v["r_bh"])
    return dict(zip("123", total, strict=True))


(_, _, x2), (_, _, y2), (_, _, z2) = (TIME[name] for name in DISPLACEMENT)
(_, ax1, ax2), (_, ay1, ay2), (_, az1, az2) = (TIME[name] for name in ROTATION)
ONE_HINGE = ("one hinge offset",)

EQUATIONS = (
    PrintedEquation(
        1,
        3,
        "gimbal flap angle of a blade",
        {"β_G": TIME["gimbal_1c"][0] * cosine + TIME["gimbal_1s"][0] * sine},
    ),
    PrintedEquation(
        2,
        3,
        "position in the rotating frame",
        {"i": (r - e) * zeta - r * psi_s, "j": r, "k": (r - e) * beta + r * (beta_G + s.precone)},
        unit="m",
        readings=ONE_HINGE,
        doubt="first order in all angles; β is the whole elastic flap angle here, a perturbation from Eq. 3 on",
    ),
    PrintedEquation(
        3,
        3,
        "acceleration relative to the hub",
        {
            "i": in_plane_of_hub,
            "j": 2 * omega * (r - e) * zeta_dot - 2 * omega * r * psi_s_dot - omega**2 * r,
            "k": (r - e) * beta_ddot + r * beta_G_ddot,
        },
        unit="m/s^2",
        readings=ONE_HINGE,
        doubt="the text has lost every Ω; dimension and Eq. 13 give them back",
    ),
    PrintedEquation(4, 3, "acceleration of the hub, fixed frame", _fixed(DISPLACEMENT, 2), unit="m/s^2"),
    PrintedEquation(5, 3, "angular velocity of the hub, fixed frame", _fixed(ROTATION, 1), unit="rad/s"),
    PrintedEquation(
        6, 3, "angular acceleration of the hub, fixed frame", _fixed(ROTATION, 2), unit="rad/s^2"
    ),
    PrintedEquation(
        7, 3, "acceleration of the hub, rotating frame", _rotating(DISPLACEMENT, 2), unit="m/s^2"
    ),
    PrintedEquation(
        8, 3, "angular velocity of the hub, rotating frame", _rotating(ROTATION, 1), unit="rad/s"
    ),
    PrintedEquation(
        9, 3, "angular acceleration of the hub, rotating frame", _rotating(ROTATION, 2), unit="rad/s^2"
    ),
    PrintedEquation(10, 3, "acceleration of a point on a moving hub", _acceleration(), unit="m/s^2"),
    PrintedEquation(
        11,
        4,
        "acceleration of a point of the blade",
        {
            "i": x2 * sine - y2 * cosine - r * az2 + in_plane_of_hub,
            "j": x2 * cosine
            + y2 * sine
            - omega**2 * r
            - 2 * omega * r * az1
            - 2 * omega * r * psi_s_dot
            + 2 * omega * (r - e) * zeta_dot,
            "k": (r * ax2 + 2 * omega * r * ay1) * sine
            - (r * ay2 - 2 * omega * r * ax1) * cosine
            + z2
            + r * beta_G_ddot
            + (r - e) * beta_ddot,
        },
        unit="m/s^2",
        readings=ONE_HINGE,
        doubt="the text shows a superfluous 'cos' after α̈x and α̈y, read as a typesetting accident; "
        "the higher-order terms left out are not listed",
    ),
)
