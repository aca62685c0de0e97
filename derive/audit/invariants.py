"""What the printed equations must obey whoever derives them: none of these checks uses the derivation.

Each yields findings: the equation, the invariant, whether the print obeys it, and the evidence.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp

from derive import symbols as s
from derive.audit import printed
from derive.audit.printed import PrintedEquation
from derive.audit.printed import notation as n
from derive.audit.printed.notation import AZIMUTH, TIME
from derive.flap_lag_springs import STIFFNESS, series_determinant
from derive.multiblade import psi
from derive.symbols import QUANTITIES, Dimension

SKEWNESS = "gyroscopic skewness"
DIMENSION = "dimension"
MIRROR = "mirror image"
ENERGY = "energy"
DEFINITENESS = "positive definiteness"
SERIES = "deflections in series add up"
RIGID_TILT = "hub and gimbal tilted against each other leave every mass where it was"

Equations = dict[int | str, PrintedEquation]
Sample = dict[sp.Symbol, float]


@dataclass(frozen=True)
class Finding:
    """One invariant on one equation."""

    number: int | str
    invariant: str
    holds: bool
    evidence: str


def findings(equations: Equations | None = None) -> list[Finding]:
    """All invariants on all equations as printed, or on other ones in their place."""
    equations = {**printed.EQUATIONS, **printed.NOMENCLATURE} if equations is None else equations
    checks = (dimensions, mirror_image, skewness, rigid_tilt, series, definiteness, energy)
    return [finding for check in checks for finding in check(equations)]


# Dimension


def dimension_of(expression: sp.Expr) -> Dimension:
    """Dimension of a product, power or function; the terms of a sum must agree."""
    if expression.is_number:
        return (0, 0, 0)
    if expression.is_Symbol:
        return n.DIMENSIONS[expression] if expression in n.DIMENSIONS else QUANTITIES[expression].dimension
    if expression.is_Mul:
        length, mass, time = map(sum, zip(*(dimension_of(part) for part in expression.args), strict=True))
        return length, mass, time
    if expression.is_Pow:
        length, mass, time = (int(d * expression.exp) for d in dimension_of(expression.base))
        return length, mass, time
    dimensions = {dimension_of(argument) for argument in expression.args}
    if len(dimensions) != 1:
        raise ValueError(f"terms of different dimension in {expression}")
    return dimensions.pop()


def addends(expression: sp.Expr) -> tuple[sp.Expr, ...]:
    terms: tuple[sp.Expr, ...] = sp.Add.make_args(sp.expand(expression))
    return terms


def dimensions(equations: Equations) -> Iterator[Finding]:
    for number, equation in equations.items():
        wrong = [
            str(term)
            for part, expression in equation.parts.items()
            for term in addends(expression)
            if dimension_of(term) != equation.dimension(part)
        ]
        yield Finding(number, DIMENSION, not wrong, "; ".join(wrong))


# Mirror image: Omega -> -Omega with everything reflected in the plane of I and K

_ODD_MOTIONS: tuple[str, ...] = (
    "y",
    "alpha_x",
    "alpha_z",
    "lag",
    "lag_0",
    "lag_1c",
    "flap_1s",
    "azimuth",
    "gimbal_1s",
)
_ODD_MOTIONS += ("pitch", "pitch_0", "pitch_1c")
_ODD = {s.rotor_speed, s.structural_pitch, s.lag, s.pitch_gimbal_coupling, s.pitch_flap_coupling}
_ODD |= {STIFFNESS["flap", "lag", 0], n.M_zeta, n.M_zeta_elas, n.zeta_in, n.zeta_out, n.B, n.C, n.X, n.Y}
_ODD |= {n.F_x, n.a_i, n.dM_theta, n.dM_theta_aero, n.flexibility_out["bz"], psi}
_ODD |= {symbol for motions in (TIME, AZIMUTH) for name in _ODD_MOTIONS for symbol in motions[name]}
# Derivatives with azimuth are odd where those with time are even.
_ODD ^= {motion[1] for motion in AZIMUTH.values()}
# Axes are any three in Eq. 10.
_NO_MIRROR = (10,)


def _parity(term: sp.Expr) -> int:
    mirrored = term.subs({symbol: -symbol for symbol in term.free_symbols & _ODD}, simultaneous=True)
    return 1 if sp.expand(mirrored - term) == 0 else -1


def mirror_image(equations: Equations) -> Iterator[Finding]:
    """All terms of a part keep their sign, or all change it."""
    for number, equation in equations.items():
        if number in _NO_MIRROR:
            continue
        mixed = [
            part
            for part, expression in equation.parts.items()
            if len({_parity(term) for term in addends(expression)}) > 1
        ]
        yield Finding(number, MIRROR, not mixed, ", ".join(mixed))


# Inertia


def _inertia_of(acceleration: sp.Expr) -> sp.Expr:
    """Integral of m (r - e) times a term that is a multiple of r - e."""
    r = s.radial_station
    quotient, rest = sp.div(sp.Poly(sp.expand(acceleration), r), sp.Poly(r - n.e, r))
    if not rest.is_zero or quotient.degree() > 0:
        raise ValueError(f"no multiple of r - e: {acceleration}")
    return quotient.as_expr() * s.flap_inertia


def skewness(equations: Equations) -> Iterator[Finding]:
    """Inertia forces do no work on a motion and its exchange: flap by lag is minus lag by flap.

    The lag row is that of the printed acceleration along i, the flap row is Eq. 13, and again Eq. 12 with the printed
    acceleration along j.
    """
    omega, cone = s.rotor_speed, s.precone + s.coning
    along_i, along_j = (equations[11].parts[axis] for axis in "ij")
    flap_rate, lag_rate = TIME["flap"][1], TIME["lag"][1]
    lag_row = _inertia_of(sp.expand(along_i).coeff(flap_rate))
    whole = sp.expand(equations[13].parts["inertia and springs"]).coeff(AZIMUTH["lag"][1])
    flap_row = sp.expand(whole * s.blade_inertia * omega)
    rest = sp.factor(flap_row + lag_row)
    yield Finding(
        13, SKEWNESS, rest == 0, f"flap by lag {sp.factor(flap_row)}, lag by flap {sp.factor(lag_row)}"
    )
    arm = sp.expand(equations[12].parts["integrand"]).coeff(n.a_j).coeff(s.precone) / (
        n.m * (s.radial_station - n.e)
    )
    from_12 = sp.simplify(arm) * cone * _inertia_of(sp.expand(along_j).coeff(lag_rate))
    rest = sp.factor(from_12 + lag_row)
    yield Finding(12, SKEWNESS, rest == 0, f"flap by lag from Eqs. 11 and 12 {sp.factor(from_12)}")


def _tilted_back(vector: list[sp.Expr]) -> list[sp.Expr]:
    """The hub tilted by alpha_x and alpha_y with the gimbal tilted back; everything else at rest."""
    alpha_x, alpha_y = TIME["alpha_x"], TIME["alpha_y"]
    back = dict(zip(TIME["gimbal_flap"], _gimbal_flap_against(alpha_x, alpha_y), strict=True))
    moving = {*back, *alpha_x, *alpha_y}
    rest = {q: 0 for motion in TIME.values() for q in motion if q not in moving}
    return [sp.expand(component.subs(back).subs(rest)) for component in vector]


def _gimbal_flap_against(alpha_x: Sequence[sp.Expr], alpha_y: Sequence[sp.Expr]) -> list[sp.Expr]:
    """beta_G of beta_GC = alpha_y and beta_GS = -alpha_x, with its derivatives in time."""
    gc, gs = alpha_y, [-a for a in alpha_x]
    omega, cosine, sine = s.rotor_speed, sp.cos(psi), sp.sin(psi)
    return [
        gc[0] * cosine + gs[0] * sine,
        gc[1] * cosine + gs[1] * sine + omega * (gs[0] * cosine - gc[0] * sine),
        gc[2] * cosine
        + gs[2] * sine
        + 2 * omega * (gs[1] * cosine - gc[1] * sine)
        - omega**2 * (gc[0] * cosine + gs[0] * sine),
    ]


def rigid_tilt_rest(equation: PrintedEquation, added: sp.Expr | None = None) -> list[sp.Expr]:
    """What is left of an acceleration along the turned hub's axes when nothing moves; with a term added to a_i."""
    along = [equation.parts["i"] + (added or 0), equation.parts["j"], equation.parts["k"]]
    alpha_x, alpha_y = TIME["alpha_x"][0], TIME["alpha_y"][0]
    # The centrifugal acceleration does not turn with the hub, its components do.
    seen = s.rotor_speed**2 * s.radial_station * (alpha_x * sp.sin(psi) - alpha_y * sp.cos(psi))
    along[1] += s.rotor_speed**2 * s.radial_station
    along[2] -= seen
    return _tilted_back(along)


def coriolis_of_gimbal() -> sp.Expr:
    """The gimbal's share in the Coriolis term that Eqs. 3 and 11 print for blade flapping."""
    return 2 * s.rotor_speed * s.radial_station * (s.precone + s.coning) * TIME["gimbal_flap"][1]


def rigid_tilt(equations: Equations) -> Iterator[Finding]:
    rest = rigid_tilt_rest(equations[11])
    yield Finding(11, RIGID_TILT, not any(rest), f"left over: {rest}" if any(rest) else "")


# Springs, by numbers: random springs, shares and pitch


def _samples(count: int = 6) -> list[Sample]:
    random = np.random.default_rng(20020422)
    names = (s.flap_stiffness, s.lag_stiffness, s.control_stiffness)
    samples = []
    for _ in range(count):
        sample = {name: random.uniform(1, 5) for name in names}
        shares = (s.flap_outboard_fraction, s.lag_outboard_fraction)
        sample |= {share: random.uniform(0.1, 0.9) for share in shares}
        angles = (TIME["flap"][0], TIME["lag"][0], s.coning, s.lag)
        samples.append(sample | {angle: random.uniform(-0.3, 0.3) for angle in angles})
    return samples


def _springs(equations: Equations) -> dict[sp.Symbol, sp.Expr]:
    """Delta, K_eff and the shares of the deflection, all as printed, in the pitch alone."""
    determinant = {series_determinant: equations[22].parts["Δ"]}
    names = {"K_ββ": ("flap", "flap", 0), "K_βζ": ("flap", "lag", 0), "K_ζζ": ("lag", "lag", 0)}
    found = {STIFFNESS[key]: equations[21].parts[name].subs(determinant) for name, key in names.items()}
    for number, letters in ((30, "ABCD"), (31, "WXYZ")):
        for letter in letters:
            found[sp.Symbol(letter, real=True)] = equations[number].parts[letter].subs(determinant)
    return determinant | found


_PITCH = 0.7


@functools.cache
def _compiled(expression: sp.Expr, symbols: tuple[sp.Symbol, ...]) -> Callable[..., float]:
    compiled: Callable[..., float] = sp.lambdify(symbols, expression, "math")
    return compiled


def _number(expression: sp.Expr, sample: Sample, pitch: float = _PITCH) -> float:
    values = {**sample, s.structural_pitch: pitch}
    return float(_compiled(expression, tuple(values))(*values.values()))


def _worst(expression: sp.Expr, sample_set: Iterable[Sample]) -> float:
    return max(abs(_number(expression, sample)) for sample in sample_set)


def series(equations: Equations) -> Iterator[Finding]:
    """Inboard and outboard shares add up to the deflection, and each is the flexibility times K_eff."""
    springs, samples = _springs(equations), _samples()
    one, zero = sp.Integer(1), sp.Integer(0)
    for number, wanted in ((30, "AWBXCYDZ"), (31, "AWBXCYDZ")):
        rests = [
            springs[sp.Symbol(a, real=True)] + springs[sp.Symbol(b, real=True)] - total
            for (a, b), total in zip(
                zip(wanted[::2], wanted[1::2], strict=True), (one, zero, zero, one), strict=True
            )
        ]
        worst = max(_worst(rest, samples) for rest in rests)
        yield Finding(number, SERIES, worst < 1e-12, f"off by {worst:.1e}")
    hub_flap = (1 - s.flap_outboard_fraction) / s.flap_stiffness
    hub_lag = (1 - s.lag_outboard_fraction) / s.lag_stiffness
    rests = [
        springs[n.A] - hub_flap * springs[STIFFNESS["flap", "flap", 0]],
        springs[n.B] - hub_flap * springs[STIFFNESS["flap", "lag", 0]],
        springs[n.C] - hub_lag * springs[STIFFNESS["flap", "lag", 0]],
        springs[n.D] - hub_lag * springs[STIFFNESS["lag", "lag", 0]],
    ]
    worst = max(_worst(rest, samples) for rest in rests)
    yield Finding(28, SERIES, worst < 1e-12, f"off by {worst:.1e}")


def definiteness(equations: Equations) -> Iterator[Finding]:
    """K_eff is positive definite with the determinant K_beta K_zeta / Delta of two springs in series."""
    springs = _springs(equations)
    flap, mixed, lag = (
        STIFFNESS[key] for key in (("flap", "flap", 0), ("flap", "lag", 0), ("lag", "lag", 0))
    )
    determinant = springs[flap] * springs[lag] - springs[mixed] ** 2
    ratio = determinant * springs[series_determinant] / (s.flap_stiffness * s.lag_stiffness)
    samples = _samples()
    worst = _worst(ratio - 1, samples)
    positive = all(_number(springs[name], sample) > 0 for name in (flap, lag) for sample in samples)
    for number in (21, 22):
        evidence = f"det K_eff Δ/(K_β K_ζ) off 1 by {worst:.1e}"
        yield Finding(number, DEFINITENESS, worst < 1e-12 and positive, evidence)


def energy(equations: Equations) -> Iterator[Finding]:
    """The pitch moment is the gradient of the spring energy, and what it deflects takes up its work."""
    springs, samples = _springs(equations), _samples()
    flap, lag = TIME["flap"][0], TIME["lag"][0]
    k = {key: springs[STIFFNESS[(*key, 0)]] for key in (("flap", "flap"), ("flap", "lag"), ("lag", "lag"))}
    stored = (k["flap", "flap"] * flap**2 + 2 * k["flap", "lag"] * flap * lag + k["lag", "lag"] * lag**2) / 2
    moment = equations[34].parts["M_θ"]
    worst = _worst(moment.subs(springs) + sp.diff(stored, s.structural_pitch), samples)
    yield Finding(34, ENERGY, worst < 1e-12, f"off the gradient of the spring energy by {worst:.1e}")
    work = sp.expand(equations[35].parts["Δθ"] * n.dM_theta)
    positive = work.subs({n.dM_theta: 1, s.control_stiffness: 1}) > 0
    yield Finding(35, ENERGY, bool(positive), f"work of the moment on its deflection {work}")
    at_trim = {flap: s.coning, lag: s.lag}
    for number, name, along in ((36, "K_Pβ", flap), (37, "K_Pζ", lag)):
        needed = -sp.diff(moment, along).subs(at_trim) / s.control_stiffness  # the spring takes up work
        worst = _worst((equations[number].parts[name] - needed).subs(springs), samples)
        yield Finding(number, ENERGY, worst < 1e-12, f"off the moment's gradient by {worst:.1e}")
    exchange = sp.diff(equations[36].parts["K_Pβ"], s.lag) - sp.diff(equations[37].parts["K_Pζ"], s.coning)
    rest = sp.expand(exchange)
    yield Finding(37, "reciprocity", rest == 0, f"∂K_Pβ/∂ζ̄0 - ∂K_Pζ/∂β̄0 = {rest}")
