"""From one blade in rotating axes to N blades in the fixed frame, for any N of at least 3 (Eqs. 7-9 and 17).

A blade's coordinates are q_blade = T(psi_m) q with q in the order of Eq. 17: hub motion and gimbal tilt are resolved
along the blade's axes, blade angles are multiblade sums. The rows of N blades are the sum of T^T (...), so

    M = sum T^T M_b T      C = sum T^T (2 Omega M_b T' + C_b T)      K = sum T^T (Omega² M_b T'' + Omega C_b T' + K_b T)

with ' = d/dpsi. The sum over N blades of a trigonometric polynomial whose harmonics are below N is N times its mean;
no other sum is needed, and `azimuth_mean` refuses a harmonic above 2.
"""

from __future__ import annotations

import functools

import sympy as sp

from derive import kinematics as kin
from derive import pitch
from derive import symbols as s
from derive.coordinates import (
    BLADE_ANGLES,
    BLADE_GUSTS,
    COORDINATE,
    FIXED,
    FIXED_GUSTS,
    SWASHPLATE,
    Coordinate,
    names,
)
from derive.flap_lag_springs import cyclic_flap_stiffness_excess
from derive.symbols import MissingError

FIXED_COORDINATES = names(FIXED)

psi = s.quantity("psi", r"\psi", "rad", "azimuth of the blade")
harmonic = s.quantity("harmonic", "n", "", "harmonic of the azimuth, 2 to below half the number of blades")

# Matrices of one blade, and the names of places in them.
MASS, DAMPING, STIFFNESS = sp.IndexedBase("mass"), sp.IndexedBase("damping"), sp.IndexedBase("stiffness")
GUSTS = sp.IndexedBase("gusts")
BLADE_INDEX = {name: sp.Symbol(f"BLADE_{name.upper()}") for name in kin.COORDINATES}
GUST_INDEX = {gust.name: sp.Symbol(f"BLADE_{gust.name.upper()}") for gust in BLADE_GUSTS}

I_AZIMUTH = sp.Matrix([sp.sin(psi), -sp.cos(psi), 0])  # i and j in I, J, K
J_AZIMUTH = sp.Matrix([sp.cos(psi), sp.sin(psi), 0])

_CYCLIC_EXCESS = {"flap": cyclic_flap_stiffness_excess, "pitch": pitch.cyclic_control_stiffness_excess}

Column = dict[str, sp.Expr]  # what the blade's coordinates have of one coordinate of the fixed frame


def wave(coordinate: Coordinate) -> sp.Expr:
    """Return the share of a multiblade coordinate in its angle of the blade at psi.

    A harmonic above 1 is counted in psi: the blade is then at azimuth psi / n.
    """
    return {"": sp.Integer(1), "c": sp.cos(psi), "s": sp.sin(psi)}[coordinate.part]


@functools.cache
def blade_coordinates() -> sp.Matrix:
    """T: one blade's coordinates (12 rows) in those of the fixed frame (18 columns)."""
    fixed = {name: sp.Symbol(f"fixed_{name}") for name in FIXED_COORDINATES}
    displacement = sp.Matrix([fixed["x"], fixed["y"], fixed["z"]])
    turn = sp.Matrix([fixed["alpha_x"], fixed["alpha_y"], fixed["alpha_z"]])
    tilt = sp.Matrix([fixed["gimbal_1s"], -fixed["gimbal_1c"], 0])  # g = beta_GS I - beta_GC J
    blade = {"azimuth": fixed["azimuth"]}
    for prefix, vector in (("hub", displacement), ("turn", turn)):
        blade |= {
            f"{prefix}_i": vector.dot(I_AZIMUTH),
            f"{prefix}_j": vector.dot(J_AZIMUTH),
            f"{prefix}_k": vector[2],
        }
    blade |= {"gimbal_flap": tilt.dot(I_AZIMUTH), "gimbal_roll": tilt.dot(J_AZIMUTH)}
    for angle in BLADE_ANGLES:
        blade[angle] = sum(fixed[c.name] * wave(c) for c in FIXED if c.angle == angle)
    missing = [name for name in kin.COORDINATES if name not in blade]
    if missing:
        raise MissingError(
            f"no coordinate of the fixed frame moves {', '.join(missing)} of the blade: add it to `FIXED` of "
            "derive/coordinates.py and to `blade_coordinates` of derive/multiblade.py"
        )
    return sp.Matrix([blade[name] for name in kin.COORDINATES]).jacobian(list(fixed.values()))


def transform(row: str, column: str) -> sp.Expr:
    """T: coordinates of the blade at azimuth psi per unit of the rotor's in the fixed frame."""
    return _columns(0)[column].get(row, sp.Integer(0))


def azimuth_mean(expression: sp.Expr) -> sp.Expr:
    """Mean over psi of a trigonometric polynomial with harmonics of at most 2."""
    cosine, sine = sp.symbols("cosine sine")
    polynomial = sp.Poly(sp.expand(expression).subs({sp.cos(psi): cosine, sp.sin(psi): sine}), cosine, sine)
    if polynomial.total_degree() > 2:
        raise ValueError(f"harmonic above 2 in {expression}")
    half = sp.Rational(1, 2)
    means = {(0, 0): 1, (2, 0): half, (0, 2): half}
    return sum(coefficient * means.get(powers, 0) for powers, coefficient in polynomial.terms())


@functools.cache
def _columns(order: int) -> dict[str, Column]:
    """Nonzero entries of each column of the given derivative of T."""
    transformation = sp.diff(blade_coordinates(), psi, order) if order else blade_coordinates()
    return {
        fixed: {
            blade: transformation[i, j]
            for i, blade in enumerate(kin.COORDINATES)
            if transformation[i, j] != 0
        }
        for j, fixed in enumerate(FIXED_COORDINATES)
    }


def _projected(base: sp.IndexedBase, row: str, column: str, order: int) -> sp.Expr:
    """Mean of T^T (blade matrix) d^order T / dpsi^order, one entry."""
    products = (
        base[BLADE_INDEX[i], BLADE_INDEX[j]] * azimuth_mean(left * right)
        for i, left in _columns(0)[row].items()
        for j, right in _columns(order)[column].items()
    )
    return sum(products, sp.Integer(0))


def mass(row: str, column: str) -> sp.Expr:
    """Mass matrix of the rotor in the fixed frame."""
    return s.n_blades * _projected(MASS, row, column, 0)


def damping(row: str, column: str) -> sp.Expr:
    """Damping and gyroscopic matrix of the rotor in the fixed frame."""
    return s.n_blades * (
        2 * s.rotor_speed * _projected(MASS, row, column, 1) + _projected(DAMPING, row, column, 0)
    )


def stiffness(row: str, column: str) -> sp.Expr:
    """Stiffness matrix of the rotor in the fixed frame."""
    return s.n_blades * (
        s.rotor_speed**2 * _projected(MASS, row, column, 2)
        + s.rotor_speed * _projected(DAMPING, row, column, 1)
        + _projected(STIFFNESS, row, column, 0)
    )


# Inputs


@functools.cache
def blade_gusts() -> sp.Matrix:
    """One blade's gusts (3 rows) in those of the fixed frame (3 columns)."""
    gust = sp.Matrix([sp.Symbol(gust.name) for gust in FIXED_GUSTS])
    return sp.Matrix([gust.dot(I_AZIMUTH), gust.dot(J_AZIMUTH), gust[2]]).jacobian(list(gust))


def gust_loads(row: str, column: str) -> sp.Expr:
    """Loads on the rotor's coordinates per unit of gusts, on the right of the equations of motion."""
    place = names(FIXED_GUSTS).index(column)
    products = (
        GUSTS[BLADE_INDEX[i], index] * azimuth_mean(left * blade_gusts()[j, place])
        for i, left in _columns(0)[row].items()
        for j, index in enumerate(GUST_INDEX.values())
    )
    return s.n_blades * sum(products, sp.Integer(0))


def swashplate_loads(row: str, column: str) -> sp.Expr:
    """Loads on the rotor's coordinates per unit of swashplate motion, on the right of the equations of motion.

    Each blade's control system and pitch damper pull at its pitch towards the swashplate's, which is held in the fixed
    frame; rates of the swashplate are left out.
    """
    motion = next(motion for motion in SWASHPLATE if motion.name == column)
    asked = wave(motion)
    products = (
        _control_stiffness(i, motion) * azimuth_mean(left * asked)
        + s.rotor_speed * pitch.damping(i, "pitch") * azimuth_mean(left * sp.diff(asked, psi))
        for i, left in _columns(0)[row].items()
    )
    return s.n_blades * sum(products, sp.Integer(0))


def _control_stiffness(i: str, motion: Coordinate) -> sp.Expr:
    excess = pitch.cyclic_swashplate_stiffness(i) if motion.harmonic else sp.Integer(0)
    return pitch.swashplate_stiffness(i) + excess


# Motions of the blades in which nothing reaches the hub


def _reactionless(base: sp.IndexedBase, row: str, column: str, order: int) -> sp.Expr:
    """Mean of the product of two motions with a blade matrix entry; d/dpsi brings the harmonic down."""
    left, right = COORDINATE[row], COORDINATE[column]
    motion = wave(right)
    derivative = harmonic**order * sp.diff(motion, psi, order) if order else motion
    return base[BLADE_INDEX[left.angle], BLADE_INDEX[right.angle]] * azimuth_mean(wave(left) * derivative)


def reactionless(kind: str, row: str, column: str) -> sp.Expr:
    """Entry of the mass, damping or stiffness of reactionless motions, of all blades."""
    omega = s.rotor_speed
    if kind == "mass":
        return s.n_blades * _reactionless(MASS, row, column, 0)
    if kind == "damping":
        inertia = 2 * omega * _reactionless(MASS, row, column, 1)
        return s.n_blades * (inertia + _reactionless(DAMPING, row, column, 0))
    inertia = omega**2 * _reactionless(MASS, row, column, 2) + omega * _reactionless(DAMPING, row, column, 1)
    return s.n_blades * (inertia + _reactionless(STIFFNESS, row, column, 0))


def cyclic_restraint(row: str, column: str) -> sp.Expr:
    """Stiffness that only cyclic motions feel: of flap frequencies and of the control system, given apart."""
    angle = COORDINATE[row].angle
    if angle not in _CYCLIC_EXCESS or COORDINATE[column].angle != angle:
        return sp.Integer(0)
    if not (COORDINATE[row].harmonic and COORDINATE[column].harmonic):
        return sp.Integer(0)
    left, right = (_columns(0)[name][angle] for name in (row, column))
    return s.n_blades * _CYCLIC_EXCESS[angle] * azimuth_mean(left * right)
