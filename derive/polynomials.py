"""Canonical form of expressions: polynomials in named sines, cosines, hinge steps and everything else.

Sums of products are far quicker in SymPy's sparse polynomial rings than as expressions, and a canonical form makes
the emitted text independent of the order in which terms were found.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import sympy as sp
from sympy.external.gmpy import MPQ
from sympy.polys.rings import PolyElement, PolyRing

from derive import symbols as s
from derive.kinematics import beyond_flap_hinge, beyond_lag_hinge

cos_precone = s.quantity("cos_precone", r"\cos\beta_P", "", "cosine of the precone")
sin_precone = s.quantity("sin_precone", r"\sin\beta_P", "", "sine of the precone")
cos_cone = s.quantity("cos_cone", r"\cos(\beta_P+\bar\beta_0)", "", "cosine of the trim cone")
sin_cone = s.quantity("sin_cone", r"\sin(\beta_P+\bar\beta_0)", "", "sine of the trim cone")
cos_lag = s.quantity("cos_lag", r"\cos\bar\zeta_0", "", "cosine of the trim lag")
sin_lag = s.quantity("sin_lag", r"\sin\bar\zeta_0", "", "sine of the trim lag")

Monomial = tuple[int, ...]  # the power of each generator
Terms = Iterable[tuple[Monomial, MPQ]]
Angles = Mapping[sp.Expr, tuple[sp.Symbol, sp.Symbol]]  # cosine and sine of each

SINE_AND_COSINE = ((sin_precone, cos_precone), (sin_cone, cos_cone), (sin_lag, cos_lag))

# Angles whose sine and cosine are named. On a segment the angle counts only outboard of its hinge.
WHOLE_BLADE_ANGLES = {
    s.precone: (cos_precone, sin_precone),
    s.precone + s.coning: (cos_cone, sin_cone),
    s.lag: (cos_lag, sin_lag),
}
SEGMENT_ANGLES = {
    s.precone: (cos_precone, sin_precone),
    s.precone + beyond_flap_hinge * s.coning: (cos_cone, sin_cone),
    beyond_lag_hinge * s.lag: (cos_lag, sin_lag),
}


def name_trigonometry(expression: sp.Basic, angles: Angles) -> sp.Basic:
    """Replace the sine and cosine of each known angle by their symbols."""
    replacements: dict[sp.Expr, sp.Symbol] = {}
    for angle, (cosine, sine) in angles.items():
        replacements |= {sp.cos(angle): cosine, sp.sin(angle): sine}
    return expression.xreplace(replacements)


def temporaries(angles: Angles) -> list[tuple[sp.Symbol, sp.Expr]]:
    """The named sines and cosines as assignments."""
    pairs = []
    for angle, (cosine, sine) in angles.items():
        pairs += [(cosine, sp.cos(angle)), (sine, sp.sin(angle))]
    return pairs


class PolynomialRing:
    """Polynomials over the rationals in a fixed, sorted set of symbols.

    `listed` says where the symbols are listed, for whoever uses another one.
    """

    def __init__(self, generators: Iterable[sp.Symbol], listed: str):
        self.listed = listed
        self.generators = sorted(generators, key=lambda symbol: symbol.name)
        self.ring = PolyRing(self.generators, sp.QQ, sp.polys.orderings.lex)

    def __call__(self, expression: sp.Expr | int) -> PolyElement:
        expanded = sp.sympify(expression).expand()
        for symbol in sorted(expanded.free_symbols - set(self.generators), key=str):
            remedy = f"add it to {self.listed}" if symbol in s.QUANTITIES else s.how_to_declare(symbol)
            raise s.MissingError(f"no polynomial here knows the symbol {symbol}: {remedy}")
        return self.ring.from_expr(expanded)

    def vector(self, components: Iterable[sp.Expr]) -> list[PolyElement]:
        return [self(component) for component in components]

    def reduced(self, polynomial: PolyElement, eliminate: str = "sine") -> PolyElement:
        """Use sin² + cos² = 1 to eliminate squares, and that hinge steps are 0 or 1 and the lag hinge lies outboard."""
        index = {symbol: place for place, symbol in enumerate(self.generators)}
        steps = [index[h] for h in (beyond_flap_hinge, beyond_lag_hinge) if h in index]
        for place in steps:
            polynomial = self._idempotent(polynomial, place)
        if len(steps) == 2:
            polynomial = self._absorbed(polynomial, *steps)
        for sine, cosine in SINE_AND_COSINE:
            if sine in index and cosine in index:
                squared, kept = (sine, cosine) if eliminate == "sine" else (cosine, sine)
                polynomial = self._without_square(polynomial, index[squared], index[kept])
        return polynomial

    def _collect(self, terms: Terms) -> PolyElement:
        result: dict[Monomial, MPQ] = {}
        for monomial, coefficient in terms:
            result[monomial] = result.get(monomial, 0) + coefficient
        return self.ring.from_dict({monomial: c for monomial, c in result.items() if c})

    def _idempotent(self, polynomial: PolyElement, place: int) -> PolyElement:
        return self._collect(
            (_with_power(monomial, place, min(monomial[place], 1)), c) for monomial, c in polynomial.terms()
        )

    def _absorbed(self, polynomial: PolyElement, flap_place: int, lag_place: int) -> PolyElement:
        """Outboard of the lag hinge is outboard of the flap hinge: h_beta h_zeta = h_zeta."""
        return self._collect(
            (_with_power(monomial, flap_place, 0) if monomial[lag_place] else monomial, c)
            for monomial, c in polynomial.terms()
        )

    def _without_square(self, polynomial: PolyElement, squared: int, kept: int) -> PolyElement:
        while any(monomial[squared] > 1 for monomial in polynomial.monoms()):
            terms = []
            for monomial, c in polynomial.terms():
                if monomial[squared] < 2:
                    terms.append((monomial, c))
                    continue
                lower = _with_power(monomial, squared, monomial[squared] - 2)
                terms += [(lower, c), (_with_power(lower, kept, lower[kept] + 2), -c)]
            polynomial = self._collect(terms)
        return polynomial

    def shortest(self, polynomial: PolyElement) -> sp.Expr:
        """The reduced form with the fewer terms, as an expression."""
        candidates = [self.reduced(polynomial, eliminate) for eliminate in ("sine", "cosine")]
        return min(candidates, key=len).as_expr()


def _with_power(monomial: Monomial, place: int, power: int) -> Monomial:
    return (*monomial[:place], power, *monomial[place + 1 :])
