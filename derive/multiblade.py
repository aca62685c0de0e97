"""From one blade in rotating axes to N blades in the fixed frame, for any N of at least 3 (Eqs. 7-9 and 17).

A blade's coordinates are q_blade = T(psi_m) q with q in the order of Eq. 17: hub motion and gimbal tilt are resolved
along the blade's axes, blade angles are multiblade sums. The rows of N blades are the sum of T^T (...), so

    M = sum T^T M_b T      C = sum T^T (2 Omega M_b T' + C_b T)      K = sum T^T (Omega² M_b T'' + Omega C_b T' + K_b T)

with ' = d/dpsi. The sum over N blades of a trigonometric polynomial whose harmonics are below N is N times its mean;
`derive.equations` calls for nothing else, and `azimuth_mean` refuses a harmonic above 2.
"""

from __future__ import annotations

import functools

import sympy as sp

from derive import kinematics as kin
from derive import symbols as s

FIXED_COORDINATES = (
    "x",
    "y",
    "z",
    "alpha_x",
    "alpha_y",
    "alpha_z",
    "flap_0",
    "flap_1c",
    "flap_1s",
    "lag_0",
    "lag_1c",
    "lag_1s",
    "pitch_0",
    "pitch_1c",
    "pitch_1s",
    "azimuth",
    "gimbal_1c",
    "gimbal_1s",
)

psi = sp.Symbol("psi", real=True)
MASS, DAMPING, STIFFNESS = sp.IndexedBase("mass"), sp.IndexedBase("damping"), sp.IndexedBase("stiffness")
BLADE_INDEX = {name: sp.Symbol(f"BLADE_{name.upper()}") for name in kin.COORDINATES}

I_AZIMUTH = sp.Matrix([sp.sin(psi), -sp.cos(psi), 0])  # i and j in I, J, K
J_AZIMUTH = sp.Matrix([sp.cos(psi), sp.sin(psi), 0])


@functools.cache
def blade_coordinates() -> sp.Matrix:
    """T: one blade's coordinates (12 rows) in those of the fixed frame (18 columns)."""
    fixed = {name: sp.Symbol(f"fixed_{name}") for name in FIXED_COORDINATES}
    displacement = sp.Matrix([fixed["x"], fixed["y"], fixed["z"]])
    turn = sp.Matrix([fixed["alpha_x"], fixed["alpha_y"], fixed["alpha_z"]])
    tilt = sp.Matrix([fixed["gimbal_1s"], -fixed["gimbal_1c"], 0])  # g = beta_GS I - beta_GC J
    blade = {"azimuth": fixed["azimuth"]}
    for prefix, vector in (("hub", displacement), ("turn", turn)):
        blade |= {f"{prefix}_i": vector.dot(I_AZIMUTH), f"{prefix}_j": vector.dot(J_AZIMUTH), f"{prefix}_k": vector[2]}
    blade |= {"gimbal_flap": tilt.dot(I_AZIMUTH), "gimbal_roll": tilt.dot(J_AZIMUTH)}
    for angle in ("flap", "lag", "pitch"):
        blade[angle] = fixed[f"{angle}_0"] + fixed[f"{angle}_1c"] * sp.cos(psi) + fixed[f"{angle}_1s"] * sp.sin(psi)
    return sp.Matrix([blade[name] for name in kin.COORDINATES]).jacobian(list(fixed.values()))


def azimuth_mean(expression: sp.Expr) -> sp.Expr:
    """Mean over psi of a trigonometric polynomial with harmonics of at most 2."""
    cosine, sine = sp.symbols("cosine sine")
    polynomial = sp.Poly(sp.expand(expression).subs({sp.cos(psi): cosine, sp.sin(psi): sine}), cosine, sine)
    if polynomial.total_degree() > 2:
        raise ValueError(f"harmonic above 2 in {expression}")
    half = sp.Rational(1, 2)
    means = {(0, 0): 1, (2, 0): half, (0, 2): half}
    return sum(coefficient * means.get(powers, 0) for powers, coefficient in polynomial.terms())


def _blade_matrix(base: sp.IndexedBase) -> dict[tuple[int, int], sp.Expr]:
    indices = [BLADE_INDEX[name] for name in kin.COORDINATES]
    return {(i, j): base[indices[i], indices[j]] for i in range(len(indices)) for j in range(len(indices))}


def _projected(base: sp.IndexedBase, row: int, column: int, order: int) -> sp.Expr:
    """Mean of T^T (blade matrix) d^order T / dpsi^order, one entry."""
    matrix, rows, columns = _blade_matrix(base), _columns(0), _columns(order)
    products = (
        matrix[i, j] * azimuth_mean(left * right)
        for i, left in rows[row].items()
        for j, right in columns[column].items()
    )
    return sum(products, sp.Integer(0))


@functools.cache
def _columns(order: int) -> list[dict[int, sp.Expr]]:
    """Nonzero entries of each column of the given derivative of T."""
    transformation = sp.diff(blade_coordinates(), psi, order) if order else blade_coordinates()
    return [
        {i: transformation[i, j] for i in range(len(kin.COORDINATES)) if transformation[i, j] != 0}
        for j in range(len(FIXED_COORDINATES))
    ]


def mass(row: int, column: int) -> sp.Expr:
    return s.n_blades * _projected(MASS, row, column, 0)


def damping(row: int, column: int) -> sp.Expr:
    return s.n_blades * (
        2 * s.rotor_speed * _projected(MASS, row, column, 1) + _projected(DAMPING, row, column, 0)
    )


def stiffness(row: int, column: int) -> sp.Expr:
    return s.n_blades * (
        s.rotor_speed**2 * _projected(MASS, row, column, 2)
        + s.rotor_speed * _projected(DAMPING, row, column, 1)
        + _projected(STIFFNESS, row, column, 0)
    )
