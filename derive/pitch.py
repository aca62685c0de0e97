"""Blade pitch: lumped inertia, control system, propeller moment, dampers, gimbal restraint, and the closed-form
couplings.

Pitch inertia is lumped on purpose: it acts on the pitch relative to the shaft alone, and the propeller moment uses the
steady rotor speed. Both couplings of Eqs. 36 and 37 are the gradient of the spring energy's pitch moment.
"""

from __future__ import annotations

import functools

import sympy as sp

from derive import flap_lag_springs
from derive import kinematics as kin
from derive import symbols as s
from derive.published import CONSISTENT

cyclic_control_stiffness_excess = s.quantity(
    "cyclic_control_stiffness_excess",
    r"\Delta K_{\theta c}",
    "N m/rad",
    "control system stiffness of cyclic above collective motion",
)
RATES = {name: sp.Symbol(f"rate_{name}", real=True) for name in kin.COORDINATES}


def rate(expression: sp.Expr) -> sp.Expr:
    """Time derivative of an angle that depends on the coordinates alone."""
    return sum(sp.diff(expression, kin.q[name]) * RATES[name] for name in kin.COORDINATES)


@functools.cache
def kinetic_energy(dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    to_shaft, _ = kin.pitch_angles(dropped)
    if "gimbal_pitch_inertia" in dropped:
        to_shaft = to_shaft.subs(dict.fromkeys(s.LINKAGES, 0))
    return s.pitch_inertia * rate(to_shaft) ** 2 / 2


def control_energy() -> sp.Expr:
    """Energy of the control system's flexibility."""
    return s.control_stiffness * (s.elastic_pitch + kin.q["pitch"]) ** 2 / 2


def propeller_energy(dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    """Potential of the propeller moment, which turns a blade's chord into the disk plane."""
    if "propeller_moment" in dropped:
        return sp.Integer(0)
    _, to_yoke = kin.pitch_angles(dropped)
    return s.propeller_moment * s.pitch_inertia * s.rotor_speed**2 * sp.sin(to_yoke) ** 2 / 2


def gimbal_tilt_rate() -> sp.Matrix:
    """Rate of the tilt in the fixed frame, resolved in rotating axes."""
    tilt = kin.q["gimbal_flap"] * kin.I_AXIS + kin.q["gimbal_roll"] * kin.J_AXIS
    seen = RATES["gimbal_flap"] * kin.I_AXIS + RATES["gimbal_roll"] * kin.J_AXIS
    return seen + s.rotor_speed * kin.K_AXIS.cross(tilt)


def gimbal_energy() -> sp.Expr:
    """One blade's share of the hub spring."""
    return s.gimbal_stiffness / s.n_blades * (kin.q["gimbal_flap"] ** 2 + kin.q["gimbal_roll"] ** 2) / 2


@functools.cache
def dissipation() -> sp.Expr:
    """Rayleigh function of the blade's dampers and of its share of the gimbal damper, which does not rotate."""
    dampers = {"flap": s.flap_damping, "lag": s.lag_damping, "pitch": s.pitch_damping}
    blade = sum(constant * RATES[name] ** 2 for name, constant in dampers.items())
    tilt_rate = gimbal_tilt_rate()
    return (blade + s.gimbal_damping / s.n_blades * tilt_rate.dot(tilt_rate)) / 2


def at_rest(expression: sp.Expr) -> sp.Expr:
    return kin.at_trim(expression).subs(dict.fromkeys(RATES.values(), 0))


def mass(i: str, j: str, dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    """Pitch inertia of one blade, lumped."""
    return at_rest(sp.diff(kinetic_energy(dropped), RATES[i], RATES[j]))


def damping(i: str, j: str) -> sp.Expr:
    """Dampers of one blade and its share of the gimbal's."""
    return at_rest(sp.diff(dissipation(), RATES[i], RATES[j]))


@functools.cache
def potential(dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    return control_energy() + propeller_energy(dropped) + gimbal_energy()


def stiffness(i: str, j: str, dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    """Control system, propeller moment, and one blade's share of the gimbal spring and damper.

    The second derivative of the potentials, and what the non-rotating damper feels of a tilt that rotates.
    """
    energy = at_rest(sp.diff(potential(dropped), kin.q[i], kin.q[j]))
    return sp.factor_terms(energy) + at_rest(sp.diff(dissipation(), RATES[i], kin.q[j]))


def swashplate_stiffness(i: str) -> sp.Expr:
    """Load on row i per unit of swashplate motion, from which the control system's flexibility is counted."""
    return at_rest(sp.diff(control_energy(), kin.q[i], kin.q["pitch"]))


def cyclic_swashplate_stiffness(i: str) -> sp.Expr:
    """The same per unit of cyclic motion, above that of collective motion."""
    return cyclic_control_stiffness_excess if i == "pitch" else sp.Integer(0)


def steady(i: str) -> sp.Expr:
    return at_rest(sp.diff(potential(), kin.q[i]))


@functools.cache
def couplings() -> dict[sp.Symbol, sp.Expr]:
    """Pitch-flap and pitch-lag coupling of the control system's flexibility.

    K_Pbeta = -d theta/d beta and K_Pzeta = -d theta/d zeta of K_theta theta + dU/d theta = 0 (Eqs. 35-37). U is the
    spring energy; the control system alone resists the moment, so linkages of the hinges only add to the couplings.
    """
    no_linkage = dict.fromkeys(s.HINGE_LINKAGES, 0)
    return {
        symbol: sp.factor_terms(flap_lag_springs.stiffness("pitch", name).subs(no_linkage))
        / s.control_stiffness
        for symbol, name in ((s.pitch_flap_coupling, "flap"), (s.pitch_lag_coupling, "lag"))
    }
