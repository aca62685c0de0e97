"""Eqs. 14-17: perturbations of the air's velocity and of the pitch, and the coordinates of the fixed frame."""

import sympy as sp

from derive import symbols as s
from derive.audit.printed.notation import TIME, PrintedEquation, e
from derive.multiblade import psi

r, speed = s.radial_station, s.airspeed
sine, cosine = sp.sin(psi), sp.cos(psi)
_, x1, _ = TIME["x"]
_, y1, _ = TIME["y"]
_, z1, _ = TIME["z"]
(ax, ax1, _), (ay, ay1, _), (_, az1, _) = (TIME[name] for name in ("alpha_x", "alpha_y", "alpha_z"))
beta, beta1, _ = TIME["flap"]
zeta, zeta1, _ = TIME["lag"]
beta_G, beta_G1, _ = TIME["gimbal_flap"]
ORDER_OF_EQ_17: tuple[str, ...] = ("x", "y", "z", "alpha_x", "alpha_y", "alpha_z")
ORDER_OF_EQ_17 += tuple(f"{angle}_{wave}" for angle in ("flap", "lag", "pitch") for wave in ("0", "1c", "1s"))
ORDER_OF_EQ_17 += ("azimuth", "gimbal_1c", "gimbal_1s")

EQUATIONS = (
    PrintedEquation(
        14,
        5,
        "perturbation of the tangential velocity",
        {
            "δu_T": r * (az1 + TIME["azimuth"][1])
            - (r - e) * zeta1
            - (x1 - speed * ay) * sine
            + (y1 + speed * ax) * cosine
        },
        unit="m/s",
        readings=("one hinge offset",),
    ),
    PrintedEquation(
        15,
        5,
        "perturbation of the axial velocity",
        {"δu_P": r * beta_G1 + (r - e) * beta1 + z1 + r * (ax1 * sine - ay1 * cosine)},
        unit="m/s",
        readings=("one hinge offset",),
    ),
    PrintedEquation(
        16,
        5,
        "perturbation of the pitch",
        {
            "δθ": TIME["pitch"][0]
            - s.pitch_gimbal_coupling * beta_G
            - s.pitch_flap_coupling * beta
            - s.pitch_lag_coupling * zeta
        },
    ),
    PrintedEquation(
        17,
        5,
        "coordinates of rotor and hub in the fixed frame",
        {f"{place + 1}": TIME[name][0] for place, name in enumerate(ORDER_OF_EQ_17)},
        unit={f"{place + 1}": "m" if place < 3 else "" for place in range(len(ORDER_OF_EQ_17))},
    ),
)
