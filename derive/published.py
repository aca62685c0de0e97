"""What the paper leaves out: the named terms whose absence turns the consistent equations into the published ones.

The published set is Eqs. 2, 3, 11 and 14-16 of AIAA-2002-1604 with u_T = Omega r and u_P = V. It is derived by the same
code as the consistent set, with these terms dropped; each can also be dropped alone, to see what it does.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class DroppedTerm:
    """A term of the consistent equations that the paper does not have."""

    term: str
    equation: str
    reason: str
    option: str = ""
    """The option of the model that drops the term and brings it back; without one the derivation leaves it out."""


DROPPED_TERMS = {
    "finite_trim_angles": DroppedTerm(
        "sines and cosines of precone, coning and lag beyond first order, and products of two trim angles",
        "Eqs. 2, 3, 11",
        "higher order, as the paper says of Eq. 11",
    ),
    "trim_lag": DroppedTerm(
        "the trim lag in the blade's position; the springs keep it",
        "Eqs. 2, 3, 11",
        "neglected, as the paper says of Eqs. 36 and 37",
    ),
    "hub_turn_of_raised_blade": DroppedTerm(
        "in-plane acceleration of the coned blade when the hub tilts: (alpha'' x k) (r beta_P + (r - e) beta_0)",
        "Eq. 11, components i and j",
        "absent; first order in the cone",
    ),
    "gimbal_coriolis": DroppedTerm(
        "in-plane acceleration of the coned blade tilting with the gimbal: 2 Omega (r beta_P + (r - e) beta_0) beta_G'",
        "Eqs. 3 and 11, components i and j",
        "absent, although the same term of the blade's own flapping is there",
    ),
    "yoke_roll": DroppedTerm(
        "roll gamma of the rigid yoke about the blade's radius: in-plane swing of the coned blade, part of the pitch",
        "Eqs. 2, 3, 11, 14-16",
        "absent: Eq. 2 has the gimbal as a flap angle",
    ),
    "radial_flap_acceleration": DroppedTerm(
        "radial acceleration of the coned blade when it flaps: -(r - e)(beta_P + beta_0)(beta'' - Omega^2 beta)",
        "Eq. 11, component j",
        "absent; first order in the cone, and the mirror of a term that Eq. 13 keeps",
    ),
    "gimbal_pitch_inertia": DroppedTerm(
        "pitch inertia that the swashplate moves when the gimbal tilts: I_theta K_PG",
        "Eq. 32 and the gimbal equations",
        "absent: the pitch inertia acts on the elastic pitch alone",
    ),
    "propeller_moment": DroppedTerm(
        "propeller moment I_theta Omega^2 sin Theta cos Theta and its change with pitch",
        "Eq. 32",
        "absent",
    ),
    "springs_follow_pitch": DroppedTerm(
        "change of the flap and lag spring moments with the perturbation of pitch, and its reaction on the gimbal",
        "Eqs. 13, 20 and the gimbal equations",
        "absent: Eq. 20 has the springs at the trim collective",
    ),
    "spring_curvature": DroppedTerm(
        "change of the spring's pitch moment with pitch itself",
        "Eqs. 34-35",
        "absent: Eq. 35 divides by the control stiffness alone",
    ),
    "cone_in_airloads": DroppedTerm(
        "precone, coning and trim lag in the air's velocities, the section's axes and the virtual work of the airloads",
        "Eqs. 14-15",
        "the paper has u_T = Omega r and u_P = V",
    ),
    "steady_airloads_on_moving_blade": DroppedTerm(
        "steady airloads whose arms and directions change with the blade's motion",
        "Eqs. 12 and 32, and the hub loads",
        "absent: the airloads are coefficients times perturbation velocities",
    ),
    "section_pitch_damping": DroppedTerm(
        "damping of a turning section: lift by its incidence at 3/4 chord, and the moment -pi/8 rho c^3 U omega",
        "Eqs. 14-16 and 32",
        "absent: the airloads have the pitch of a section and not the rate of its turn",
        option="section_damping",
    ),
}

PUBLISHED = frozenset(DROPPED_TERMS)
CONSISTENT: frozenset[str] = frozenset()


def check_names(dropped: frozenset[str]) -> None:
    """Raise ValueError for a term that is not in the list."""
    unknown = sorted(dropped - PUBLISHED)
    if unknown:
        raise ValueError(f"no such term: {', '.join(unknown)}; known: {', '.join(DROPPED_TERMS)}")
