"""Tools for the chain of a notebook, a cell that its reader may change: motions over time, and first orders.

A chain goes from a position through derivatives to an integral in a dozen lines of SymPy, and `display.chain` compares
what it finds with the derivation. It has symbols, axes and rotations in common with the derivation, but differentiates
with time, which the derivation never does.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import sympy as sp

from derive import kinematics as kin
from derive import multiblade
from derive import symbols as s
from derive.audit.counterparts import in_fixed_coordinates, motion, time_derivative
from derive.audit.printed.notation import AZIMUTH, TIME

_MOTIONS = [symbol for motion in TIME.values() for symbol in motion]
MULTIBLADE_ANGLE = {name: TIME[name][0] for name in ("flap_0", "flap_1c", "flap_1s")}
_CONE = [s.precone, s.coning]


def linear(expression: sp.Expr, symbols: Iterable[sp.Symbol]) -> sp.Expr:
    """Return the value at zero of some symbols, and the terms of first order in them."""
    symbols = [symbol for symbol in symbols if symbol in expression.free_symbols]
    zero = dict.fromkeys(symbols, sp.Integer(0))
    changes = (symbol * sp.diff(expression, symbol).xreplace(zero) for symbol in symbols)
    return sp.Add(expression.xreplace(zero), *changes)


def moving(vector: sp.Matrix) -> sp.Matrix:
    """Return a vector to first order in the blade's motions, hub and gimbal moving in the fixed frame."""
    return vector.applyfunc(lambda part: in_fixed_coordinates(linear(part, kin.q.values())))


def rate(vector: sp.Matrix) -> sp.Matrix:
    """Differentiate the components of a vector of moving coordinates with time; its axes are taken to be at rest."""
    return vector.applyfunc(time_derivative)


def first_order(expression: sp.Expr) -> sp.Expr:
    """Return the terms of at most first order in the motions and in the cone, without trim lag."""
    return sp.expand(linear(linear(expression.subs(s.lag, 0), _MOTIONS), _CONE))


def perturbation(expression: sp.Expr) -> sp.Expr:
    """Return the terms of first order in the motions, as `first_order` does."""
    found = first_order(expression)
    return found - found.xreplace(dict.fromkeys(_MOTIONS, sp.Integer(0)))


def by_azimuth(expression: sp.Expr) -> sp.Expr:
    """Replace derivatives with time by the rotor speed and derivatives with azimuth."""
    return expression.subs(
        {
            motion: s.rotor_speed**order * AZIMUTH[name][order]
            for name in TIME
            for order, motion in enumerate(TIME[name])
        }
    )


def times_motion(coefficient: Callable[[str], sp.Expr]) -> sp.Expr:
    """Return the sum of a coefficient of each of the blade's coordinates times its motion; no linkage of the hinges."""
    total = sp.Add(*(coefficient(name) * motion(name)[0] for name in kin.COORDINATES))
    return total.subs(dict.fromkeys(s.HINGE_LINKAGES, 0))


def rotor_rows(
    names: Iterable[str], mass: sp.Expr, damping: sp.Expr, stiffness: sp.Expr
) -> dict[str, sp.Expr]:
    """Return the derivation's rows of a rotor in the fixed frame whose blades flap and do nothing else."""
    names, flap = list(names), (multiblade.BLADE_INDEX["flap"],) * 2
    of_blade = {
        multiblade.MASS[flap]: mass,
        multiblade.DAMPING[flap]: damping,
        multiblade.STIFFNESS[flap]: stiffness,
    }
    matrices = (multiblade.stiffness, multiblade.damping, multiblade.mass)
    return {
        row: sp.Add(
            *(
                entry(row, column) * TIME[column][order]
                for column in names
                for order, entry in enumerate(matrices)
            )
        ).subs(of_blade)
        for row in names
    }
