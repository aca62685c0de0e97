"""Closed forms of the lift-slope airloads of the published set: constant chord, no compressibility (NASA TN D-7677).

With u_T = Omega r and u_P = V every section derivative that is proportional to the lift slope is, but for 1/U, a
polynomial in r. So the radial moments are combinations of I_m = int x^m / sqrt(lambda² + x²) dx, with x = r/R and
lambda = V/(Omega R).
"""

from __future__ import annotations

import functools

import sympy as sp

from derive import section
from derive import symbols as s
from derive.airloads import MOMENTS, POWERS

inflow_ratio = s.quantity("inflow_ratio", r"\lambda", "", "airspeed over tip speed, V/(Omega R)")
inner_edge = s.quantity("inner_edge", "x_0", "", "inner end of the segment over the radius")
outer_edge = s.quantity("outer_edge", "x_1", "", "outer end of the segment over the radius")
radius = s.quantity("radius", "R", "m", "rotor radius")
lift_slope = s.quantity("lift_slope", r"c_{l\alpha}", "/rad", "lift slope")
inner_speed = s.quantity("inner_speed", "s_0", "", "section speed over tip speed at the inner edge")
outer_speed = s.quantity("outer_speed", "s_1", "", "section speed over tip speed at the outer edge")
speed_difference = s.quantity("speed_difference", "s_1-s_0", "", "their difference, without cancellation")
logarithm = s.quantity("logarithm", "I_0", "", "asinh(x_1/lambda) - asinh(x_0/lambda), without cancellation")

HIGHEST = 4
INTEGRALS = [
    s.quantity(
        f"speed_integral_{m}", f"I_{m}", "", f"integral of x^{m} over the section speed, in tip speeds"
    )
    for m in range(HIGHEST + 1)
]

_x = sp.Symbol("x", nonnegative=True)
_lambda = sp.Symbol("lambda", positive=True)


def ends() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Speeds at the edges and the two differences that would lose digits as they stand."""
    inner, outer = (sp.sqrt(inflow_ratio**2 + edge**2) for edge in (inner_edge, outer_edge))
    squares = (outer_edge - inner_edge) * (outer_edge + inner_edge)
    # sinh of a difference of two inverse sines, multiplied out; it holds for lambda = 0 as well.
    sine = squares / (outer_edge * inner_speed + inner_edge * outer_speed)
    return [
        (inner_speed, inner),
        (outer_speed, outer),
        (speed_difference, squares / (outer_speed + inner_speed)),
        (logarithm, sp.asinh(sine)),
    ]


@functools.cache
def antiderivative(m: int) -> tuple[sp.Expr, sp.Expr]:
    """Antiderivative of x^m / sqrt(lambda² + x²) as (factor of the root, factor of asinh(x/lambda))."""
    root, inverse = sp.sqrt(_lambda**2 + _x**2), sp.asinh(_x / _lambda)
    found = sp.integrate(_x**m / root, _x).subs(_lambda * sp.sqrt(1 + _x**2 / _lambda**2), root)
    of_inverse = sp.simplify(sp.expand(found).coeff(inverse))
    of_root = sp.expand(sp.simplify((found - of_inverse * inverse) / root))
    rest = sp.simplify(sp.diff(of_root * root + of_inverse * inverse, _x) - _x**m / root)
    if rest != 0:
        raise ArithmeticError(f"antiderivative of power {m} does not check")
    return of_root, of_inverse


def integrals() -> list[tuple[sp.Symbol, sp.Expr]]:
    """I_0 to I_4 over a segment."""
    steps = []
    for m, symbol in enumerate(INTEGRALS):
        of_root, of_inverse = antiderivative(m)
        steps.append((symbol, _between(of_root) + _named(of_inverse) * logarithm))
    return steps


def _named(expression: sp.Expr) -> sp.Expr:
    return expression.subs(_lambda, inflow_ratio)


def _between(of_root: sp.Expr) -> sp.Expr:
    """p(x) s(x) between the edges: p(x_1) (s_1 - s_0) + (p(x_1) - p(x_0)) s_0, the second difference factored."""
    at_outer, at_inner = (_named(of_root.subs(_x, edge)) for edge in (outer_edge, inner_edge))
    return at_outer * speed_difference + sp.factor(at_outer - at_inner) * inner_speed


def load_moments() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Radial moments of the section derivatives proportional to the lift slope, over one segment, in closed form."""
    return [*ends(), *integrals(), *moments()]


def moments() -> list[tuple[sp.Symbol, sp.Expr]]:
    """Radial moments of the section derivatives that the lift slope alone makes."""
    tip_speed = s.rotor_speed * radius
    published = {
        section.tangential_velocity: tip_speed * _x,
        section.axial_velocity: tip_speed * inflow_ratio,
        section.radial_velocity: 0,
        section.section_damping: 0,
        section.turn_incidence: 0,
        section.pressure_chord: s.density * s.chord / 2,
    }
    alone = {symbol: 0 for key, symbol in section.COEFFICIENT.items() if key != ("lift", "alpha")}
    alone[section.COEFFICIENT["lift", "alpha"]] = lift_slope
    speed = sp.Symbol("speed", positive=True)  # over tip speed
    steps = []
    for (load, argument), symbol in section.SECTION_LOADS.items():
        derivative = section.in_airfoil_coefficients(section.load_derivatives()[symbol])
        derivative = derivative.subs(alone).subs(published)
        derivative = sp.expand(derivative.subs(section.section_speed, tip_speed * speed))
        for power in POWERS:
            moment = MOMENTS[load + argument, power]
            integrand = sp.expand(derivative * (radius * _x) ** power * radius * speed)
            # Even powers of the speed are polynomials in x.
            integrand = sp.expand(sp.expand(integrand).subs(speed**2, inflow_ratio**2 + _x**2))
            if integrand == 0 or sp.degree(integrand, _x) > HIGHEST:
                continue
            value = sum(integrand.coeff(_x, m) * INTEGRALS[m] for m in range(HIGHEST + 1))
            steps.append((moment, sp.factor_terms(value)))
    return steps
