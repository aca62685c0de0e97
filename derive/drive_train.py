"""Engine and shaft on the rotor's azimuth, mounted on the hub's support.

What turns with the rotor has the spin of azimuth and hub together; shaft and damping feel the azimuth relative to the
support. The engine's own angular momentum about other axes is left out: its sense and gearing are not part of
the model.
"""

from __future__ import annotations

import functools

import sympy as sp

from derive import symbols as s
from derive.multiblade import FIXED_COORDINATES

_q = {name: sp.Symbol(f"fixed_{name}") for name in FIXED_COORDINATES}


@functools.cache
def energies() -> dict[str, sp.Expr]:
    """Kinetic energy, dissipation and potential in rates (mass, damping) or displacements (stiffness) by name."""
    spin = _q["azimuth"] + _q["alpha_z"]
    return {
        "mass": s.drive_inertia * spin**2 / 2,
        "damping": s.drive_damping * _q["azimuth"] ** 2 / 2,
        "stiffness": s.shaft_stiffness * _q["azimuth"] ** 2 / 2,
    }


def mass(row: str, column: str) -> sp.Expr:
    """Mass that engine and shaft add to the rotor in the fixed frame."""
    return _second_derivative("mass", row, column)


def damping(row: str, column: str) -> sp.Expr:
    """Damping that engine and shaft add to the rotor in the fixed frame."""
    return _second_derivative("damping", row, column)


def stiffness(row: str, column: str) -> sp.Expr:
    """Stiffness that engine and shaft add to the rotor in the fixed frame."""
    return _second_derivative("stiffness", row, column)


def _second_derivative(kind: str, row: str, column: str) -> sp.Expr:
    return sp.diff(energies()[kind], _q[row], _q[column])
