"""Trim: the steady flap, lag and pitch balance of a blade and its torque, and their Jacobian.

Unknowns are coning, lag, elastic pitch and, for a windmilling rotor, the collective that makes the torque vanish. The
Jacobian is made of the same entries as the blade's stiffness matrix: elastic pitch and collective add up to the
section's pitch, and only the control system tells them apart.

The path from the undeflected blade to the trim multiplies precone and the airloads by one number from 0 to 1;
centrifugal stiffness and springs stay whole. Its direction takes the load of precone on the undeflected blade.
"""

from __future__ import annotations

import sympy as sp

from derive import airloads, flap_lag_springs, pitch
from derive import symbols as s
from derive.inertia import BladeInertia, trim_integrals

BALANCES = ("flap", "lag", "pitch", "azimuth")
UNKNOWNS = ("flap", "lag", "pitch", "collective")
HINGED = ("flap", "lag", "pitch")  # balances of the blade, which the path loads
# Rows whose steady airloads are wanted: the balances and the thrust.
STEADY_ROWS = (*BALANCES, "hub_k")


def residual(row: str) -> sp.Expr:
    """Steady balance of one blade without airloads: flap, lag, pitch moment, torque and thrust."""
    return BladeInertia().steady(row) + flap_lag_springs.steady(row) + pitch.steady(row)


def precone_load(row: str) -> sp.Expr:
    """Steady centrifugal load of precone on the undeflected blade: flap, lag and pitch moment."""
    undeflected = dict.fromkeys((s.coning, s.lag), 0)
    integrals = {symbol: sp.sympify(value).subs(undeflected) for symbol, value in trim_integrals().items()}
    load = BladeInertia().steady(row)
    while load.free_symbols & integrals.keys():  # an integral at trim is made of those before it
        load = sp.expand(load.subs(integrals))
    return sp.factor_terms(sp.simplify(load))


def blade_coordinate(unknown: str) -> str:
    """The blade coordinate an unknown changes."""
    return "pitch" if unknown == "collective" else unknown


def jacobian(row: str, unknown: str) -> sp.Expr:
    """Derivative of the residual with coning, lag, elastic pitch and collective, without airloads.

    The collective does not load the control system.
    """
    name = blade_coordinate(unknown)
    control_system = pitch.stiffness(row, name)
    if unknown == "collective":
        control_system = control_system.subs(s.control_stiffness, 0)
    return BladeInertia().centrifugal(row, name) + flap_lag_springs.stiffness(row, name) + control_system


# Couplings act on perturbations from trim alone.
_NO_COUPLING = {s.pitch_flap_coupling: 0, s.pitch_lag_coupling: 0}


def displacement_motion(motion: str, unknown: str) -> sp.Expr:
    """U for the unknowns: velocity of the air along a segment, and pitch."""
    return airloads.displacement_motion(motion, blade_coordinate(unknown)).subs(_NO_COUPLING)


def geometric_stiffness(row: str, unknown: str) -> sp.Expr:
    """G for the unknowns: change of the steady airloads' virtual work, of one segment."""
    return airloads.geometric_stiffness(row, blade_coordinate(unknown)).subs(_NO_COUPLING)
