"""Mass beside the pitch axis: what it adds to inertia and steady loads of one blade in rotating axes.

The centre of the mass of a section lies x(r) aft of the pitch axis, and goes up and down as the section turns:

    p = point of the blade's line + x [cos(Theta + tau) i' - sin(Theta + tau) n]      tau: twist from 0.75 R

Virtual work and acceleration are those of `derive.inertia`, and here are the terms that have x. Outboard of the lag
hinge both arms of the line are straight in r, so that the mass enters through integrals of x cos(tau), x sin(tau) and
their products with the lag arm and with each other. Nearer to the hub the mass is on the axis.

These are no first-order terms that could be dropped: without x there are none, and the published equations have no x.
"""

from __future__ import annotations

import functools

import sympy as sp
from sympy.polys.rings import PolyElement

from derive import kinematics as kin
from derive import symbols as s
from derive.expansion import MovingPoint
from derive.inertia import ARMS, BladeInertia, integrate_mass
from derive.polynomials import WHOLE_BLADE_ANGLES, PolynomialRing, name_trigonometry, sin_lag

# Integrals of the mass outboard of the lag hinge; x_c = x cos(tau) and x_s = x sin(tau).
_KNOWN = {
    "moment": (r"S_{x%s}", "kg m", "mass times %s"),
    "lag": (r"I_{x%s\zeta}", "kg m^2", "mass times %s and lag arm"),
}
_WAVES = {"cosine": ("c", "x cos(twist)"), "sine": ("s", "x sin(twist)")}
OFFSET_MOMENTS = {
    (wave, kind): s.quantity(
        f"offset_{wave}_{'moment' if kind == 'moment' else 'lag_inertia'}",
        latex % of_latex,
        unit,
        f"{meaning % told}, x the offset of the mass aft of the pitch axis",
    )
    for kind, (latex, unit, meaning) in _KNOWN.items()
    for wave, (of_latex, told) in _WAVES.items()
}
OFFSET_SQUARES = {
    "cosine": s.quantity("offset_cosine_inertia", "I_{xcc}", "kg m^2", "mass times x² cos²(twist)"),
    "both": s.quantity("offset_product_inertia", "I_{xcs}", "kg m^2", "mass times x² cos(twist) sin(twist)"),
    "sine": s.quantity("offset_sine_inertia", "I_{xss}", "kg m^2", "mass times x² sin²(twist)"),
}
DATA = (*OFFSET_MOMENTS.values(), *OFFSET_SQUARES.values())

# Place of the mass at trim, beside the point of the line.
along_arm = s.quantity(
    "along_arm", r"x\cos\theta", "m", "trim position of the mass from the pitch axis along i'"
)
below_arm = s.quantity(
    "below_arm", r"x\sin\theta", "m", "trim position of the mass from the pitch axis against n"
)
_OFFSETS = (along_arm, below_arm)
_NAMES = {along_arm: ("along", "a"), below_arm: ("below", "b")}
_ARM_NAMES = {
    kin.radial_arm: ("radial", "j"),
    kin.axial_arm: ("axial", "k"),
    kin.flap_arm: ("flap", "b"),
    kin.lag_arm: ("lag", r"\zeta"),
}
FIRST = {
    offset: s.quantity(
        f"{name}_offset_moment", f"S_{{x{latex}}}", "kg m", f"mass times {s.QUANTITIES[offset].meaning}"
    )
    for offset, (name, latex) in _NAMES.items()
}
PRODUCTS = {
    (offset, arm): s.quantity(
        f"{name}_offset_{of_arm}_inertia",
        f"I_{{x{latex},{arm_latex}}}",
        "kg m^2",
        f"mass times {s.QUANTITIES[offset].meaning} and {of_arm} arm",
    )
    for offset, (name, latex) in _NAMES.items()
    for arm, (of_arm, arm_latex) in _ARM_NAMES.items()
}
SQUARES = {
    (along_arm, along_arm): s.quantity(
        "along_offset_inertia", "I_{xaa}", "kg m^2", "mass times along arm squared"
    ),
    (along_arm, below_arm): s.quantity(
        "along_below_offset_inertia", "I_{xab}", "kg m^2", "mass times along and below arm"
    ),
    (below_arm, below_arm): s.quantity(
        "below_offset_inertia", "I_{xbb}", "kg m^2", "mass times below arm squared"
    ),
}
INTEGRALS = {(offset,): symbol for offset, symbol in FIRST.items()} | PRODUCTS | SQUARES


def trim_integrals() -> dict[sp.Symbol, sp.Expr]:
    """Integrals of the mass beside the pitch axis over the arms of the deflected and turned blade."""
    cosine, sine = sp.cos(s.pitch), sp.sin(s.pitch)
    turned = {along_arm: (cosine, -sine), below_arm: (sine, cosine)}
    found: dict[sp.Symbol, sp.Expr] = {}
    for offset, waves in turned.items():
        shares = dict(zip(_WAVES, waves, strict=True))
        for kind, symbol in (("moment", FIRST[offset]), ("lag", PRODUCTS[offset, kin.lag_arm])):
            found[symbol] = sum(share * OFFSET_MOMENTS[wave, kind] for wave, share in shares.items())
    for offset in _OFFSETS:
        for arm, line in _outboard_line().items():
            first, by_lag = line.coeff(kin.lag_arm, 0), line.coeff(kin.lag_arm, 1)
            value = first * FIRST[offset] + by_lag * PRODUCTS[offset, kin.lag_arm]
            found[PRODUCTS[offset, arm]] = value
    square = dict(zip(("cosine", "both", "sine"), OFFSET_SQUARES.values(), strict=True))
    for (one, other), symbol in SQUARES.items():
        (a, b), (c, d) = turned[one], turned[other]
        found[symbol] = a * c * square["cosine"] + (a * d + b * c) * square["both"] + b * d * square["sine"]
    return found


def _outboard_line() -> dict[sp.Symbol, sp.Expr]:
    """The arms of the deflected blade outboard of the lag hinge, linear in the lag arm."""
    between = s.lag_hinge_offset - s.flap_hinge_offset
    outboard = {kin.outboard_arm: kin.lag_arm + between, kin.inboard_arm: s.flap_hinge_offset}
    flap_arm = sp.expand(kin.deflected_flap_arm().subs(outboard))
    arms = {kin.flap_arm: flap_arm} | {
        arm: kin.trim_arms()[arm].subs({kin.inboard_arm: s.flap_hinge_offset, kin.flap_arm: flap_arm})
        for arm in (kin.radial_arm, kin.axial_arm)
    }
    return {arm: sp.expand(name_trigonometry(line, WHOLE_BLADE_ANGLES)) for arm, line in arms.items()}


def _beside_line() -> sp.Matrix:
    """From the blade's line to the mass, in the yoke, to second order about trim."""
    _, to_yoke = kin.pitch_angles()
    turn = to_yoke - s.pitch
    along = along_arm * (1 - turn**2 / 2) - below_arm * turn
    below = below_arm * (1 - turn**2 / 2) + along_arm * turn
    outboard = dict.fromkeys((kin.beyond_flap_hinge, kin.beyond_lag_hinge), 1)
    axes = kin.blade_axes().subs(outboard)
    axes = name_trigonometry(kin.at_trim(axes) + kin.change(axes), WHOLE_BLADE_ANGLES)
    return along * axes[:, 0] - below * axes[:, 1]


@functools.cache
def mass_motion() -> MovingPoint:
    """A point mass beside the blade's line, by the arms of both."""
    trig = [symbol for pair in WHOLE_BLADE_ANGLES.values() for symbol in pair]
    ring = PolynomialRing(
        [*trig, *ARMS, *_OFFSETS, *s.LINKAGES],
        "`ARMS` of derive/inertia.py or `_OFFSETS` of derive/offset_mass.py",
    )
    line = name_trigonometry(kin.deflected_line(), WHOLE_BLADE_ANGLES)
    line = line.subs(kin.chordwise_arm, kin.lag_arm * sin_lag)
    return MovingPoint(ring, line + _beside_line())


class OffsetInertia(BladeInertia):
    """The forms that are made of the motion of a mass beside the line, their terms with the offset alone."""

    def __init__(self) -> None:
        super().__init__()
        self.motion = mass_motion()

    def _integral(self, product: PolyElement) -> sp.Expr:
        ring = self.motion.ring
        places = [ring.generators.index(offset) for offset in _OFFSETS]
        beside = {m: c for m, c in product.terms() if any(m[place] for place in places)}
        return integrate_mass(ring.shortest(ring.ring.from_dict(beside)), INTEGRALS)


@functools.cache
def _forms() -> OffsetInertia:
    return OffsetInertia()


def mass(i: str, j: str) -> sp.Expr:
    """Mass matrix of one blade in rotating axes, of mass beside the pitch axis."""
    return _forms().mass(i, j)


def gyroscopic(i: str, j: str) -> sp.Expr:
    """Gyroscopic (Coriolis) matrix of one blade in rotating axes, of mass beside the pitch axis."""
    return _forms().gyroscopic(i, j)


def centrifugal_stiffness(i: str, j: str) -> sp.Expr:
    """Centrifugal stiffness of one blade in rotating axes, of mass beside the pitch axis."""
    return _forms().centrifugal(i, j)


def steady(row: str) -> sp.Expr:
    """Steady loads of one blade in the balances, of mass beside the pitch axis."""
    return _forms().steady(row)


def couplings() -> dict[sp.Symbol, sp.Expr]:
    """What mass beside the pitch axis adds to pitch-flap and pitch-lag coupling of the control system's flexibility.

    As `derive.pitch.couplings`: the change of the centrifugal pitch moment with flap and lag, without linkages.
    """
    no_linkage = dict.fromkeys(s.HINGE_LINKAGES, 0)
    return {
        symbol: sp.factor_terms(centrifugal_stiffness("pitch", name).subs(no_linkage)) / s.control_stiffness
        for symbol, name in ((s.pitch_flap_coupling, "flap"), (s.pitch_lag_coupling, "lag"))
    }


def steady_slope(row: str, unknown: str) -> sp.Expr:
    """Change of these steady loads with coning, lag, elastic pitch and collective."""
    return centrifugal_stiffness(row, "pitch" if unknown == "collective" else unknown)
