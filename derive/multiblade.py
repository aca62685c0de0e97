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
        blade |= {
            f"{prefix}_i": vector.dot(I_AZIMUTH),
            f"{prefix}_j": vector.dot(J_AZIMUTH),
            f"{prefix}_k": vector[2],
        }
    blade |= {"gimbal_flap": tilt.dot(I_AZIMUTH), "gimbal_roll": tilt.dot(J_AZIMUTH)}
    for angle in ("flap", "lag", "pitch"):
        blade[angle] = (
            fixed[f"{angle}_0"] + fixed[f"{angle}_1c"] * sp.cos(psi) + fixed[f"{angle}_1s"] * sp.sin(psi)
        )
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


@functools.cache
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


# Gusts: what reaches one blade, and what is given in the fixed frame.
BLADE_GUSTS = ("gust_i", "gust_j", "gust_k")
FIXED_GUSTS = ("gust_x", "gust_y", "gust_z")
GUSTS = sp.IndexedBase("gusts")
GUST_INDEX = {name: sp.Symbol(f"BLADE_{name.upper()}") for name in BLADE_GUSTS}


@functools.cache
def blade_gusts() -> sp.Matrix:
    """One blade's gusts (3 rows) in those of the fixed frame (3 columns)."""
    gust = sp.Matrix(sp.symbols("gust_x gust_y gust_z"))
    return sp.Matrix([gust.dot(I_AZIMUTH), gust.dot(J_AZIMUTH), gust[2]]).jacobian(list(gust))


def gust_loads(row: int, column: int) -> sp.Expr:
    """Loads of N blades on a row per unit of a gust."""
    names = list(GUST_INDEX.values())
    indices = [BLADE_INDEX[name] for name in kin.COORDINATES]
    products = (
        GUSTS[indices[i], names[j]] * azimuth_mean(left * blade_gusts()[j, column])
        for i, left in _columns(0)[row].items()
        for j in range(len(BLADE_GUSTS))
    )
    return s.n_blades * sum(products, sp.Integer(0))


# Motions of the blades in which nothing reaches the hub: harmonics 2 and above below N/2 come in pairs, and for even N
# neighbouring blades may move against each other.
REACTIONLESS_PAIR = ("flap_nc", "flap_ns", "lag_nc", "lag_ns", "pitch_nc", "pitch_ns")
DIFFERENTIAL = ("flap_d", "lag_d", "pitch_d")
harmonic = s.quantity("harmonic", "n", "", "harmonic of the azimuth, 2 to below half the number of blades")


def _angle_and_motion(name: str) -> tuple[str, sp.Expr]:
    """Blade angle of a reactionless coordinate, and its share in a blade at azimuth psi / n."""
    angle, kind = name.split("_")
    return angle, {"nc": sp.cos(psi), "ns": sp.sin(psi), "d": sp.Integer(1)}[kind]


def _reactionless(base: sp.IndexedBase, row: str, column: str, order: int) -> sp.Expr:
    """Mean of the product of two motions with a blade matrix entry; d/dpsi brings the harmonic down."""
    (row_angle, left), (column_angle, right) = _angle_and_motion(row), _angle_and_motion(column)
    derivative = harmonic**order * sp.diff(right, psi, order) if order else right
    return base[BLADE_INDEX[row_angle], BLADE_INDEX[column_angle]] * azimuth_mean(left * derivative)


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


def cyclic_restraint(row: int, column: int, stiffness_excess: sp.Symbol) -> sp.Expr:
    """Stiffness that only the cyclic flapping of the blades feels."""
    cyclic = [FIXED_COORDINATES.index(name) for name in ("flap_1c", "flap_1s")]
    if row not in cyclic or column not in cyclic:
        return sp.Integer(0)
    flap = kin.COORDINATES.index("flap")
    shares = [_columns(0)[place][flap] for place in (row, column)]
    return s.n_blades * stiffness_excess * azimuth_mean(shares[0] * shares[1])
