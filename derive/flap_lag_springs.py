"""Flap-lag springs: hub springs and blade springs in series, turned against each other by pitch (Eqs. 18-31).

    U = 1/2 {beta, zeta} K_eff(Theta_y + delta_s) {beta, zeta}^T

K_eff^-1 is the sum of the hub's flexibility, fixed, and the blade's, turned with the pitch. The paper's Delta is the
determinant of that sum, made a number by K_beta K_zeta, so K_eff Delta is a polynomial in the sine and cosine.
"""

from __future__ import annotations

import functools

import sympy as sp

from derive import kinematics as kin
from derive import symbols as s
from derive.coordinates import COORDINATE
from derive.inertia import BladeInertia, trim_integrals
from derive.published import CONSISTENT

FLAP_LAG = ("flap", "lag")

# Effective stiffness and its first and second derivative with structural pitch, at trim.
_KINDS = (("", "", ""), ("_slope", "'", " per rad of pitch"), ("_curvature", "''", " per rad² of pitch"))
STIFFNESS = {
    (a, b, order): s.quantity(
        f"{a}_{b}_stiffness{suffix}",
        rf"K_{{{greek}}}{prime}",
        "N m/rad",
        f"effective {a}-{b} stiffness{meaning}",
    )
    for order, (suffix, prime, meaning) in enumerate(_KINDS)
    for a, b, greek in (
        ("flap", "flap", r"\beta\beta"),
        ("flap", "lag", r"\beta\zeta"),
        ("lag", "lag", r"\zeta\zeta"),
    )
}
outboard_stiffness_difference = s.quantity(
    "outboard_stiffness_difference",
    r"R_\beta K_\zeta-R_\zeta K_\beta",
    "N m/rad",
    "what pitch moves from lag to flap",
)
series_softening = s.quantity(
    "series_softening", r"\Delta_s", "", "what sin² of structural pitch adds to Delta"
)
series_determinant = s.quantity(
    "series_determinant", r"\Delta", "", "determinant of the springs in series, Eq. 22"
)
series_determinant_slope = s.quantity("series_determinant_slope", r"\Delta'", "", "its derivative with pitch")
series_determinant_curvature = s.quantity(
    "series_determinant_curvature", r"\Delta''", "", "its second derivative"
)


def flexibility(angle: sp.Expr) -> sp.Matrix:
    """Flexibility of the hub springs and of the blade springs turned by `angle`, in series (Eq. 24).

    Positive pitch is a rotation about +j, which carries the blade's lag axis (-k sense) and flap axis along: flatwise
    bending of a pitched blade is partly towards -i, that is lead.
    """
    hub = sp.diag(
        (1 - s.flap_outboard_fraction) / s.flap_stiffness, (1 - s.lag_outboard_fraction) / s.lag_stiffness
    )
    blade = sp.diag(s.flap_outboard_fraction / s.flap_stiffness, s.lag_outboard_fraction / s.lag_stiffness)
    turn = blade_axes(angle)
    return hub + turn * blade * turn.T


def blade_axes(angle: sp.Expr) -> sp.Matrix:
    """Columns: displacement (beta along k, zeta along i) of unit flatwise and edgewise bending at pitch `angle`."""
    rotation_about_span = sp.Matrix(
        [[sp.cos(angle), 0, sp.sin(angle)], [0, 1, 0], [-sp.sin(angle), 0, sp.cos(angle)]]
    )
    flatwise, edgewise = rotation_about_span * kin.K_AXIS, rotation_about_span * kin.I_AXIS
    return sp.Matrix.hstack(
        *(sp.Matrix([axis.dot(kin.K_AXIS), axis.dot(kin.I_AXIS)]) for axis in (flatwise, edgewise))
    )


@functools.cache
def series_springs() -> tuple[dict[tuple[str, str], sp.Expr], sp.Expr]:
    """K_eff Delta by entry, and Delta, as functions of the structural pitch (Eqs. 21 and 22)."""
    total = flexibility(s.structural_pitch)
    scale = s.flap_stiffness * s.lag_stiffness
    numerators = {
        ("flap", "flap"): total[1, 1] * scale,
        ("flap", "lag"): -total[0, 1] * scale,
        ("lag", "lag"): total[0, 0] * scale,
    }
    return {pair: _in_sine(n) for pair, n in numerators.items()}, _in_sine(total.det() * scale)


def _in_sine(expression: sp.Expr) -> sp.Expr:
    """Squares of the cosine written with the sine, like terms collected."""
    sine, cosine = sp.symbols("sine cosine")
    angle = s.structural_pitch
    polynomial = sp.expand(expression.subs({sp.sin(angle): sine, sp.cos(angle): cosine}))
    reduced = sp.rem(polynomial, sine**2 + cosine**2 - 1, cosine)
    return sp.collect(sp.expand(reduced), (sine, cosine)).subs({sine: sp.sin(angle), cosine: sp.cos(angle)})


@functools.cache
def groups() -> dict[sp.Symbol, sp.Expr]:
    """The two groups of constants that pitch brings into play, named."""
    numerators, determinant = series_springs()
    sine_squared = sp.sin(s.structural_pitch) ** 2
    return {
        outboard_stiffness_difference: numerators["flap", "flap"].coeff(sine_squared),
        series_softening: _by_ratio(determinant.coeff(sine_squared)),
    }


def _by_ratio(expression: sp.Expr) -> sp.Expr:
    """Coefficients of the stiffness ratios factored, so that R (1 - R) = 0 removes a ratio that has no bound."""
    ratio = sp.Symbol("ratio")
    polynomial = sp.expand(sp.expand(expression).subs(s.lag_stiffness, ratio * s.flap_stiffness))
    in_ratio = sum(sp.factor(polynomial.coeff(ratio, power)) * ratio**power for power in (-1, 0, 1))
    return in_ratio.subs(ratio, s.lag_stiffness / s.flap_stiffness)


def _grouped(expression: sp.Expr) -> sp.Expr:
    """The same with the groups' names in place of their constants."""
    outboard_lag = s.flap_outboard_fraction * s.lag_stiffness
    difference = outboard_stiffness_difference - groups()[outboard_stiffness_difference] + outboard_lag
    return sp.expand(sp.expand(expression).subs(outboard_lag, difference))


def effective_stiffness() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Hub and blade springs in series, and their derivatives with structural pitch.

    K_eff and its derivatives follow from differentiating K Delta = numerator.
    """
    numerators, determinant = series_springs()
    angle = s.structural_pitch
    determinants = (series_determinant, series_determinant_slope, series_determinant_curvature)
    steps = [(name, value) for name, value in groups().items()]
    softened = determinant.subs(sp.sin(angle), 0) + series_softening * sp.sin(angle) ** 2
    steps += [(symbol, sp.diff(softened, angle, order)) for order, symbol in enumerate(determinants)]
    stiffness, divisor = sp.Function("stiffness")(angle), sp.Function("divisor")(angle)
    for order in range(3):
        for (a, b), numerator in numerators.items():
            balance = sp.diff(stiffness * divisor, angle, order) - sp.diff(_grouped(numerator), angle, order)
            unknown = sp.Derivative(stiffness, (angle, order)) if order else stiffness
            solved = sp.solve(balance, unknown)[0]
            for lower in range(order, -1, -1):
                solved = solved.subs(sp.diff(stiffness, angle, lower), STIFFNESS[a, b, lower])
                solved = solved.subs(sp.diff(divisor, angle, lower), determinants[lower])
            steps.append((STIFFNESS[a, b, order], sp.factor_terms(solved)))
    return steps


@functools.cache
def spring_energy(dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    """U of the flap and lag springs, K_eff a function of the pitch relative to the yoke."""
    deflection = {"flap": kin.FLAP_ANGLE, "lag": kin.LAG_ANGLE}
    _, to_yoke = kin.pitch_angles(dropped)
    return (
        sum(
            _stiffness_function(a, b, to_yoke - s.pitch) * deflection[a] * deflection[b]
            for a in FLAP_LAG
            for b in FLAP_LAG
        )
        / 2
    )


def _stiffness_function(a: str, b: str, pitch_change: sp.Expr) -> sp.Expr:
    """Effective stiffness to second order in the change of pitch from trim."""
    pair = (a, b) if (a, b, 0) in STIFFNESS else (b, a)
    return sum(STIFFNESS[(*pair, order)] * pitch_change**order / sp.factorial(order) for order in range(3))


@functools.cache
def _spring_moment(i: str, dropped: frozenset[str]) -> sp.Expr:
    """Gradient of the spring energy, not yet taken at trim."""
    return sp.diff(spring_energy(dropped), kin.q[i])


def stiffness(i: str, j: str, dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    """Stiffness of one blade's flap and lag springs, which turn with its pitch.

    The second derivative of the spring energy at trim.
    """
    if (
        "springs_follow_pitch" in dropped
        and not (i in FLAP_LAG and j in FLAP_LAG)
        and (i != "pitch" or COORDINATE[j].angle == "gimbal")
    ):
        return sp.Integer(0)
    if "spring_curvature" in dropped and i == j == "pitch":
        return sp.Integer(0)
    moment = sp.expand(kin.at_trim(sp.diff(_spring_moment(i, dropped), kin.q[j])))
    if "springs_follow_pitch" in dropped:
        moment = moment.subs(dict.fromkeys(s.HINGE_LINKAGES, 0))
    return sp.factor_terms(moment)


def steady(i: str) -> sp.Expr:
    """Gradient of the spring energy at trim."""
    return sp.factor_terms(sp.expand(kin.at_trim(_spring_moment(i, CONSISTENT))))


cyclic_flap_stiffness_excess = s.quantity(
    "cyclic_flap_stiffness_excess",
    r"\Delta K_{\beta c}",
    "N m/rad",
    "flap stiffness of cyclic above collective motion",
)


def stiffness_of_frequencies() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Diagonal stiffness of given rotating frequencies, and what cyclic flapping has above collective.

    The frequencies are those of the uncoupled blade at zero cone.
    """
    blade = BladeInertia()
    flat = dict.fromkeys((s.precone, s.coning, s.lag), 0)
    integrals = {symbol: sp.sympify(value).subs(flat) for symbol, value in trim_integrals().items()}

    def at_zero_cone(expression: sp.Expr) -> sp.Expr:
        for _ in range(4):
            expression = expression.subs(integrals)
        return sp.factor_terms(sp.expand(expression))

    def needed(coordinate: str, frequency: sp.Symbol) -> sp.Expr:
        total = frequency**2 * blade.mass(coordinate, coordinate) - blade.centrifugal(coordinate, coordinate)
        return at_zero_cone(total)

    collective = needed("flap", s.rotating_flap_frequency)
    cyclic = needed("flap", s.cyclic_flap_frequency)
    return [
        (STIFFNESS["flap", "flap", 0], collective),
        (STIFFNESS["lag", "lag", 0], needed("lag", s.rotating_lag_frequency)),
        (cyclic_flap_stiffness_excess, sp.factor_terms(sp.expand(cyclic - collective))),
    ]
