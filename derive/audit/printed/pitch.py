"""Eqs. 32-37: the pitch equation and the pitch-flap and pitch-lag couplings."""

from derive import symbols as s
from derive.audit.printed import notation as n
from derive.audit.printed.notation import TIME, PrintedEquation
from derive.audit.printed.springs import K_bb, K_bz, K_zz, beta, zeta

r = s.radial_station
theta, _, theta_ddot = TIME["pitch"]
beta_G, psi_s = TIME["gimbal_flap"][0], TIME["azimuth"][0]
mixed = n.Z * K_bb - (n.X - n.Y) * K_bz - n.W * K_zz
LOST = "signs and subscripts"

EQUATIONS = (
    PrintedEquation(
        32,
        10,
        "pitch equation",
        {
            "integrand": (n.F_z - n.F_r * (n.beta_in + s.precone + beta_G)) * (r - n.e) * n.zeta_out
            - (n.F_x - n.F_r * (n.zeta_in - psi_s)) * (r - n.e) * n.beta_out
            + n.section_inertia * theta_ddot
            + n.dM_theta_aero,
            "control system": s.control_stiffness * theta,
        },
        unit={"integrand": "N", "control system": "N m"},
        restored=LOST,
        readings=("one hinge offset", "airload moment nose down"),
        doubt="the positive sense of dM_θ,aero is not given",
    ),
    PrintedEquation(
        33,
        10,
        "pitch moment of the elastic moments",
        {"M_θ": -n.M_beta_elas * n.zeta_out + n.M_zeta_elas * n.beta_out},
        unit="N m",
        restored=LOST,
    ),
    PrintedEquation(
        34,
        10,
        "pitch moment of the deflection",
        {
            "M_θ": -(K_bb * beta + K_bz * zeta) * (n.Y * beta + n.Z * zeta)
            + (K_bz * beta + K_zz * zeta) * (n.W * beta + n.X * zeta)
        },
        unit="N m",
        restored=LOST,
    ),
    PrintedEquation(
        35, 10, "pitch deflection of the control system", {"Δθ": -n.dM_theta / s.control_stiffness}
    ),
    PrintedEquation(
        36,
        10,
        "pitch-flap coupling",
        {
            "K_Pβ": (2 * (n.Y * K_bb - n.W * K_bz) * s.coning + mixed * s.lag) / s.control_stiffness,
        },
        restored=LOST,
    ),
    PrintedEquation(
        37,
        10,
        "pitch-lag coupling",
        {
            "K_Pζ": (mixed * s.coning + 2 * (n.Z * K_bz - n.X * K_zz) * s.lag) / s.control_stiffness,
        },
        restored=LOST,
    ),
)
