"""Inertia of one blade in rotating axes: M, C and K of the inertia forces, and their steady part (Eqs. 2-13).

The virtual work of the inertia forces, row i, is the integral of m W_i . a with W_i the row's virtual displacement and
a = p'' + 2 Omega k x p' + Omega² k x (k x p) in rotating axes. Linearised about trim, with commas for derivatives,

    M_ij = int m W_i . p,j        C_ij = 2 Omega int m W_i . (k x p,j)
    K_ij = Omega² int m [ W_i . (k x (k x p,j)) + W_i,j . (k x (k x p)) ]

Every vector is linear in the arms of the deflected blade, so the mass enters through integrals of products of two arms.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping

import sympy as sp
from sympy.polys.rings import PolyElement

from derive import kinematics as kin
from derive import symbols as s
from derive.expansion import MovingPoint, Vector, dot, spin
from derive.polynomials import (
    SINE_AND_COSINE,
    WHOLE_BLADE_ANGLES,
    PolynomialRing,
    cos_lag,
    name_trigonometry,
    sin_cone,
    sin_lag,
    sin_precone,
    temporaries,
)
from derive.published import CONSISTENT

Integrals = Mapping[tuple[sp.Symbol, ...], sp.Expr]  # over the blade, of the mass times a product of arms

ARMS = (kin.radial_arm, kin.axial_arm, kin.flap_arm, kin.lag_arm)

# Integrals of m times one or two arms of the blade at trim.
radial_moment = s.quantity("radial_moment", "S_j", "kg m", "mass times radial arm")
axial_moment = s.quantity("axial_moment", "S_k", "kg m", "mass times axial arm")
flap_moment = s.quantity("flap_moment", r"S_b", "kg m", "mass times flap arm")
radial_inertia = s.quantity("radial_inertia", "I_{jj}", "kg m^2", "mass times radial arm squared")
axial_inertia = s.quantity("axial_inertia", "I_{kk}", "kg m^2", "mass times axial arm squared")
radial_axial_inertia = s.quantity(
    "radial_axial_inertia", "I_{jk}", "kg m^2", "mass times radial and axial arm"
)
radial_flap_inertia = s.quantity("radial_flap_inertia", "I_{jb}", "kg m^2", "mass times radial and flap arm")
axial_flap_inertia = s.quantity("axial_flap_inertia", "I_{kb}", "kg m^2", "mass times axial and flap arm")
radial_lag_inertia = s.quantity(
    "radial_lag_inertia", r"I_{j\zeta}", "kg m^2", "mass times radial and lag arm"
)
axial_lag_inertia = s.quantity("axial_lag_inertia", r"I_{k\zeta}", "kg m^2", "mass times axial and lag arm")
deflected_flap_inertia = s.quantity(
    "deflected_flap_inertia", "I_{bb}", "kg m^2", "mass times flap arm squared"
)
deflected_flap_lag_inertia = s.quantity(
    "deflected_flap_lag_inertia", r"I_{b\zeta}", "kg m^2", "mass times flap and lag arm"
)

TRIM_INTEGRALS = {
    (): s.blade_mass,
    (kin.radial_arm,): radial_moment,
    (kin.axial_arm,): axial_moment,
    (kin.flap_arm,): flap_moment,
    (kin.lag_arm,): s.lag_first_moment,
    (kin.radial_arm, kin.radial_arm): radial_inertia,
    (kin.radial_arm, kin.axial_arm): radial_axial_inertia,
    (kin.axial_arm, kin.axial_arm): axial_inertia,
    (kin.radial_arm, kin.flap_arm): radial_flap_inertia,
    (kin.axial_arm, kin.flap_arm): axial_flap_inertia,
    (kin.flap_arm, kin.flap_arm): deflected_flap_inertia,
    (kin.radial_arm, kin.lag_arm): radial_lag_inertia,
    (kin.axial_arm, kin.lag_arm): axial_lag_inertia,
    (kin.flap_arm, kin.lag_arm): deflected_flap_lag_inertia,
    (kin.lag_arm, kin.lag_arm): s.lag_inertia,
}

# Integrals over the arms of the deflected blade, between the mass data and the integrals at trim.
inboard_moment = s.quantity("inboard_moment", "S_a", "kg m", "mass times inboard arm")
inboard_inertia = s.quantity("inboard_inertia", "I_{aa}", "kg m^2", "mass times inboard arm squared")
inboard_flap_inertia = s.quantity(
    "inboard_flap_inertia", "I_{ab}", "kg m^2", "mass times inboard and flap arm"
)
inboard_lag_inertia = s.quantity(
    "inboard_lag_inertia", r"I_{a\zeta}", "kg m^2", "mass times inboard and lag arm"
)

DEFLECTED_INTEGRALS = {
    (): s.blade_mass,
    (kin.inboard_arm,): inboard_moment,
    (kin.flap_arm,): flap_moment,
    (kin.lag_arm,): s.lag_first_moment,
    (kin.inboard_arm, kin.inboard_arm): inboard_inertia,
    (kin.inboard_arm, kin.flap_arm): inboard_flap_inertia,
    (kin.inboard_arm, kin.lag_arm): inboard_lag_inertia,
    (kin.flap_arm, kin.flap_arm): deflected_flap_inertia,
    (kin.flap_arm, kin.lag_arm): deflected_flap_lag_inertia,
    (kin.lag_arm, kin.lag_arm): s.lag_inertia,
}

# Integrals over the arms of the undeflected blade: the blade's mass data.
MASS_INTEGRALS = {
    (): s.blade_mass,
    (kin.inboard_arm,): s.blade_first_moment - s.flap_first_moment,
    (kin.outboard_arm,): s.flap_first_moment,
    (kin.lag_arm,): s.lag_first_moment,
    (kin.inboard_arm, kin.inboard_arm): s.blade_inertia - 2 * s.flap_hub_inertia + s.flap_inertia,
    (kin.inboard_arm, kin.outboard_arm): s.flap_hub_inertia - s.flap_inertia,
    (kin.inboard_arm, kin.lag_arm): s.lag_hub_inertia - s.flap_lag_inertia,
    (kin.outboard_arm, kin.outboard_arm): s.flap_inertia,
    (kin.outboard_arm, kin.lag_arm): s.flap_lag_inertia,
    (kin.lag_arm, kin.lag_arm): s.lag_inertia,
}


def integrate_mass(integrand: sp.Expr, integrals: Integrals) -> sp.Expr:
    """Integral over the blade of m times a polynomial of at most second degree in the arms of `integrals`."""
    arms = sorted({arm for product in integrals for arm in product}, key=lambda arm: arm.name)
    by_powers = {tuple(product.count(arm) for arm in arms): value for product, value in integrals.items()}
    terms = sp.Poly(integrand, *arms).terms() if integrand != 0 else []
    for powers, _ in terms:
        if powers not in by_powers:
            product = sp.prod(arm**power for arm, power in zip(arms, powers, strict=True))
            raise s.MissingError(
                f"no integral of the mass times {product}: declare it as a quantity and add it to `TRIM_INTEGRALS`, and"
                " to the integrals that it is made of, in derive/inertia.py"
            )
    return sum((coefficient * by_powers[powers] for powers, coefficient in terms), sp.Integer(0))


def trim_integrals(dropped: frozenset[str] = CONSISTENT) -> dict[sp.Symbol, sp.Expr]:
    """Sines and cosines of the trim angles, and the mass integrals over the arms of the deflected blade."""
    to_deflected = _redefine(DEFLECTED_INTEGRALS, MASS_INTEGRALS, {kin.flap_arm: kin.deflected_flap_arm()})
    integrals = to_deflected | _redefine(TRIM_INTEGRALS, DEFLECTED_INTEGRALS, kin.trim_arms())
    angles = dict(temporaries(WHOLE_BLADE_ANGLES))
    if "finite_trim_angles" in dropped:
        integrals = {symbol: first_order(value) for symbol, value in integrals.items()}
        angles = {
            symbol: sp.series(angle, _argument(angle), n=2).removeO() for symbol, angle in angles.items()
        }
    if "trim_lag" in dropped:
        angles |= {cos_lag: sp.Integer(1), sin_lag: sp.Integer(0)}
    return angles | integrals


def _argument(function: sp.Expr) -> sp.Expr:
    return function.args[0]


# Integrals that are of first or second order in the trim angles: they hold axial arms.
_ORDER = {
    **dict.fromkeys((sin_precone, sin_cone, sin_lag), 1),
    **dict.fromkeys((axial_moment, radial_axial_inertia, axial_flap_inertia, axial_lag_inertia), 1),
    axial_inertia: 2,
}


def first_order(expression: sp.Expr) -> sp.Expr:
    """The terms of at most first order in the trim angles, cosines being 1."""
    small = sp.Symbol("small")
    scaled = expression.subs({symbol: small**order * symbol for symbol, order in _ORDER.items()})
    scaled = sp.expand(scaled.subs({cosine: 1 for _, cosine in SINE_AND_COSINE}))
    return sum(scaled.coeff(small, order) for order in (0, 1))


def _redefine(
    integrals: Integrals, known: Integrals, arms: Mapping[sp.Symbol, sp.Expr]
) -> dict[sp.Symbol, sp.Expr]:
    """Integrals of products of arms, in the known integrals of the arms they are made of."""
    definitions = {}
    for product, symbol in integrals.items():
        integrand = sp.expand(sp.prod(arms.get(arm, arm) for arm in product))
        integral = name_trigonometry(integrate_mass(integrand, known), WHOLE_BLADE_ANGLES)
        if integral != symbol:
            definitions[symbol] = integral
    return definitions


def dependent_inertias() -> dict[sp.Symbol, sp.Expr]:
    """Three mass integrals that follow from the others and the hinge offsets.

    Outboard of the flap hinge r = rho_beta + e_beta; outboard of the lag hinge rho_beta = rho_zeta + e_zeta - e_beta.
    """
    radius = {s.flap_hub_inertia: kin.outboard_arm + s.flap_hinge_offset}
    radius |= {s.lag_hub_inertia: kin.lag_arm + s.lag_hinge_offset}
    radius |= {s.flap_lag_inertia: kin.lag_arm + s.lag_hinge_offset - s.flap_hinge_offset}
    hinge_arm = {
        s.flap_hub_inertia: kin.outboard_arm,
        s.lag_hub_inertia: kin.lag_arm,
        s.flap_lag_inertia: kin.lag_arm,
    }
    return {
        symbol: integrate_mass(sp.expand(radius[symbol] * hinge_arm[symbol]), MASS_INTEGRALS)
        for symbol in radius
    }


# Components (i, j, k) of a coordinate's acceleration that a dropped term takes away, by matrix.
_EVERY_MATRIX = ("mass", "gyroscopic", "centrifugal")
_DROPPED_ACCELERATIONS = {
    "hub_turn_of_raised_blade": (_EVERY_MATRIX, ("turn_i", "turn_j"), (0, 1)),
    "gimbal_coriolis": (_EVERY_MATRIX, ("gimbal_flap",), (0, 1)),
    "yoke_roll": (_EVERY_MATRIX, ("gimbal_roll",), (0, 1, 2)),
    "radial_flap_acceleration": (("mass", "centrifugal"), ("flap",), (1,)),
}


@functools.cache
def blade_motion() -> MovingPoint:
    """A point mass of the whole blade, by its arms."""
    trig = [symbol for pair in WHOLE_BLADE_ANGLES.values() for symbol in pair]
    ring = PolynomialRing([*trig, *ARMS], "`ARMS` and the integrals of derive/inertia.py")
    line = name_trigonometry(kin.deflected_line(), WHOLE_BLADE_ANGLES)
    return MovingPoint(ring, line.subs(kin.chordwise_arm, kin.lag_arm * sin_lag))


class BladeInertia:
    """The forms that are made of a blade's motion, without dropped terms."""

    def __init__(self, dropped: frozenset[str] = CONSISTENT):
        self.dropped = dropped
        self.motion = blade_motion()

    def _integral(self, product: PolyElement) -> sp.Expr:
        integral = integrate_mass(self.motion.ring.shortest(product), TRIM_INTEGRALS)
        if "trim_lag" in self.dropped:
            integral = integral.subs({sin_lag: 0, cos_lag: 1})
        return first_order(integral) if "finite_trim_angles" in self.dropped else integral

    def acceleration(self, matrix: str, column: str, spins: int) -> Vector:
        """The motion along a coordinate, k x it or k x (k x it), without the components of dropped terms."""
        acceleration = self.motion.position.along(column)
        for _ in range(spins):
            acceleration = spin(acceleration)
        gone = {
            component
            for term, (matrices, columns, components) in _DROPPED_ACCELERATIONS.items()
            if term in self.dropped and matrix in matrices and column in columns
            for component in components
        }
        return [0 * part if place in gone else part for place, part in enumerate(acceleration)]

    def _is_dropped(self, *coordinates: str) -> bool:
        return "yoke_roll" in self.dropped and "gimbal_roll" in coordinates

    def mass(self, i: str, j: str) -> sp.Expr:
        if self._is_dropped(i):
            return sp.Integer(0)
        return self._integral(dot(self.motion.virtual_displacement(i), self.acceleration("mass", j, 0)))

    def gyroscopic(self, i: str, j: str) -> sp.Expr:
        if self._is_dropped(i):
            return sp.Integer(0)
        coriolis = self.acceleration("gyroscopic", j, 1)
        return 2 * s.rotor_speed * self._integral(dot(self.motion.virtual_displacement(i), coriolis))

    def centrifugal(self, i: str, j: str) -> sp.Expr:
        if self._is_dropped(i, j):
            return sp.Integer(0)
        moved = dot(self.motion.virtual_displacement(i), self.acceleration("centrifugal", j, 2))
        turned = dot(self.motion.virtual_displacement(i, j), self._steady_acceleration)
        return s.rotor_speed**2 * self._integral(moved + turned)

    def steady(self, i: str) -> sp.Expr:
        """Virtual work of the steady inertia forces, row i."""
        work = dot(self.motion.virtual_displacement(i), self._steady_acceleration)
        return s.rotor_speed**2 * self._integral(work)

    @property
    def _steady_acceleration(self) -> Vector:
        return spin(spin(self.motion.position.along()))


def mass(i: str, j: str, dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    """Mass matrix of one blade in rotating axes."""
    return BladeInertia(dropped).mass(i, j)


def gyroscopic(i: str, j: str, dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    """Gyroscopic (Coriolis) matrix of one blade in rotating axes."""
    return BladeInertia(dropped).gyroscopic(i, j)


def centrifugal_stiffness(i: str, j: str, dropped: frozenset[str] = CONSISTENT) -> sp.Expr:
    """Centrifugal stiffness of one blade in rotating axes."""
    return BladeInertia(dropped).centrifugal(i, j)
