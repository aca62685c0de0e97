"""What the derivation has where the paper prints an equation: one function per equation, nothing typed in as a result.

A counterpart gives each part of its equation as an expression, from the derivation without the terms in `dropped`, to
the paper's own order: first order in the cone, no trim lag in the blade's position. `meaning` says what a symbol that
only the print has stands for in the derivation; both sides are then compared in the derivation's symbols.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable
from typing import Any, TypeVar

import sympy as sp

from derive import airloads, flap_lag_springs, inertia, multiblade, pitch
from derive import kinematics as kin
from derive import symbols as s
from derive.audit.printed import notation as n
from derive.audit.printed.kinematics import VECTORS
from derive.audit.printed.notation import AZIMUTH, FIXED_NAMES, TIME
from derive.expansion import spin
from derive.polynomials import SEGMENT_ANGLES, WHOLE_BLADE_ANGLES, temporaries
from derive.published import CONSISTENT

Parts = dict[str, sp.Expr]
Derivation = TypeVar("Derivation", bound=Callable[..., Parts])
PAPER_ORDER = frozenset({"finite_trim_angles", "trim_lag"})
ARMS = {
    kin.inboard_arm: s.flap_hinge_offset,
    kin.outboard_arm: s.radial_station - s.flap_hinge_offset,
    kin.lag_arm: s.radial_station - s.lag_hinge_offset,
}
_small = sp.Symbol("small")
_HELD = (sp.Integer(0),) * 3  # a coordinate that the paper does not have does not move in the audit

COUNTERPARTS: dict[int | str, Callable[[frozenset[str]], Parts]] = {}


def counterpart(*numbers: int | str) -> Callable[[Derivation], Derivation]:
    """Register the function that derives these equations; with several, it takes the number first."""

    def register(function: Derivation) -> Derivation:
        for number in numbers:
            COUNTERPARTS[number] = functools.partial(function, number) if len(numbers) > 1 else function
        return function

    return register


def truncated(expression: sp.Expr, order: int, **orders: dict[sp.Symbol, int]) -> sp.Expr:
    """Terms of at most `order` when the symbols of `orders["of"]` are small to the power given there."""
    scaled = sp.sympify(expression).subs(
        {symbol: _small**power * symbol for symbol, power in orders["of"].items()}
    )
    total, derivative = sp.Integer(0), scaled
    for power in range(order + 1):
        total += derivative.subs(_small, 0) / sp.factorial(power)
        derivative = sp.diff(derivative, _small)
    return sp.expand(total)


def first_order_in_cone(expression: sp.Expr) -> sp.Expr:
    return truncated(expression, 1, of={s.precone: 1, s.coning: 1})


# Motions


def time_derivative(expression: sp.Expr) -> sp.Expr:
    """d/dt of an expression in the fixed frame's coordinates and the azimuth."""
    total = s.rotor_speed * sp.diff(expression, multiblade.psi)
    return total + sum(
        sp.diff(expression, q[order]) * q[order + 1] for q in TIME.values() for order in range(2)
    )


@functools.cache
def motion(name: str, by_azimuth: bool = False) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """A coordinate of one blade and its first two derivatives; hub and gimbal in the fixed frame's coordinates."""
    symbols, speed = (AZIMUTH, 1) if by_azimuth else (TIME, s.rotor_speed)
    if name in ("flap", "lag", "pitch", "azimuth"):
        return symbols[name]
    columns = multiblade.blade_coordinates()[kin.COORDINATES.index(name), :]
    derivatives = [sp.Integer(0)] * 3
    for t, fixed in zip(columns, multiblade.FIXED_COORDINATES, strict=True):
        t1, t2 = (speed**order * sp.diff(t, multiblade.psi, order) for order in (1, 2))
        q0, q1, q2 = symbols.get(fixed, _HELD)
        derivatives[0] += t * q0
        derivatives[1] += t * q1 + t1 * q0
        derivatives[2] += t * q2 + 2 * t1 * q1 + t2 * q0
    return tuple(derivatives)


def gimbal_flap(by_azimuth: bool = False) -> dict[sp.Symbol, sp.Expr]:
    """beta_G of the print and its derivatives in the coordinates of the fixed frame."""
    symbols = AZIMUTH if by_azimuth else TIME
    return dict(zip(symbols["gimbal_flap"], motion("gimbal_flap", by_azimuth), strict=True))


def in_fixed_coordinates(expression: sp.Expr) -> sp.Expr:
    """Perturbations of one blade by the motions of the fixed frame."""
    return expression.subs({kin.q[name]: motion(name)[0] for name in kin.COORDINATES})


@counterpart(1)
def gimbal_flap_angle(dropped: frozenset[str]) -> Parts:
    return {"β_G": motion("gimbal_flap")[0]}


def _blade_in_hub_axes() -> sp.Matrix:
    """Position relative to the hub, the deflection counted from the undeflected blade."""
    line = kin.blade_line().subs({s.coning: 0, s.lag: 0})
    return (kin.GIMBAL_TILT * kin.rotation(kin.q["azimuth"] * kin.K_AXIS) * line).subs(ARMS)


_ANGLES = {kin.q[name]: 1 for name in ("flap", "lag", "azimuth", "gimbal_flap", "gimbal_roll")} | {
    s.precone: 1
}


@counterpart(2)
def position(dropped: frozenset[str]) -> Parts:
    vector = [truncated(component, 1, of=_ANGLES) for component in _blade_in_hub_axes()]
    return dict(zip("ijk", map(in_fixed_coordinates, vector), strict=True))


def _inertia(dropped: frozenset[str]) -> inertia.BladeInertia:
    """The blade without some terms; the vectors themselves are those of the whole derivation."""
    return inertia.BladeInertia(dropped | PAPER_ORDER)


def _in_arms(component: Any) -> sp.Expr:
    """A component of a ring vector in r, the hinge offsets and the trim angles, to first order in the cone."""
    expression = (
        component.as_expr().subs(_trim_arms()).subs(dict(temporaries(WHOLE_BLADE_ANGLES))).subs(s.lag, 0)
    )
    return first_order_in_cone(expression.subs(ARMS))


@functools.cache
def _trim_arms() -> dict[sp.Symbol, sp.Expr]:
    flap_arm = {kin.flap_arm: kin.deflected_flap_arm()}
    return flap_arm | {arm: value.subs(flap_arm) for arm, value in kin.trim_arms().items()}


@functools.cache
def _acceleration_terms(name: str, dropped: frozenset[str]) -> tuple[sp.Matrix, ...]:
    """What a coordinate's displacement, rate and acceleration contribute to the acceleration in rotating axes."""
    blade, omega = _inertia(dropped), s.rotor_speed
    kinds = (("centrifugal", 2, omega**2), ("gyroscopic", 1, 2 * omega), ("mass", 0, 1))
    return tuple(
        factor * sp.Matrix([_in_arms(part) for part in blade.acceleration(kind, name, spins)])
        for kind, spins, factor in kinds
    )


@functools.cache
def _steady_acceleration() -> sp.Matrix:
    steady = spin(spin(inertia.blade_motion().position.along()))
    return s.rotor_speed**2 * sp.Matrix([_in_arms(part) for part in steady])


def _acceleration(coordinates: Iterable[str], dropped: frozenset[str]) -> sp.Matrix:
    total = _steady_acceleration()
    for name in coordinates:
        terms = _acceleration_terms(name, dropped)
        total += sum((term * q for term, q in zip(terms, motion(name), strict=True)), sp.zeros(3, 1))
    return total


_OF_BLADE = ("flap", "lag", "azimuth", "gimbal_flap", "gimbal_roll")


@counterpart(3)
def acceleration_relative_to_hub(dropped: frozenset[str]) -> Parts:
    return dict(zip("ijk", _acceleration(_OF_BLADE, dropped), strict=True))


def _hub_vector(names: tuple[str, ...]) -> sp.Matrix:
    """Displacement or rotation of the hub in the fixed frame, from its components along the blade's axes."""
    axes = (multiblade.I_AZIMUTH, multiblade.J_AZIMUTH, kin.K_AXIS)
    vectors = (motion(name)[0] * axis for name, axis in zip(names, axes, strict=True))
    return sum(vectors, sp.zeros(3, 1)).applyfunc(sp.trigsimp)


def _turning(order: int) -> sp.Matrix:
    """Angular velocity (1) or acceleration (2) of the hub at no rotation, from its rotation matrix."""
    turned = kin.rotation(_hub_vector(kin.HUB_ROTATION))
    for _ in range(order):
        turned = turned.applyfunc(time_derivative)
    turned = turned.subs({TIME[name][0]: 0 for name in ("alpha_x", "alpha_y", "alpha_z")})
    skew = (turned - turned.T) / 2
    return sp.Matrix([skew[2, 1], skew[0, 2], skew[1, 0]]).expand()


_HUB_MOTION = {
    4: lambda: _hub_vector(kin.HUB_TRANSLATION).applyfunc(time_derivative).applyfunc(time_derivative),
    5: lambda: _turning(1),
    6: lambda: _turning(2),
}


@counterpart(4, 5, 6)
def hub_motion(number: int, dropped: frozenset[str]) -> Parts:
    return dict(zip("IJK", _HUB_MOTION[number](), strict=True))


@counterpart(7, 8, 9)
def hub_motion_along_the_blade(number: int, dropped: frozenset[str]) -> Parts:
    """The same by the transformation that `derive.multiblade` sums over the blades with."""
    names, order = {7: (kin.HUB_TRANSLATION, 2), 8: (kin.HUB_ROTATION, 1), 9: (kin.HUB_ROTATION, 2)}[number]
    transformation = multiblade.blade_coordinates()
    fixed = sp.Matrix([TIME.get(name, _HELD)[order] for name in multiblade.FIXED_COORDINATES])
    rows = (transformation[kin.COORDINATES.index(name), :] for name in names)
    return dict(zip("ijk", ((row * fixed)[0] for row in rows), strict=True))


@counterpart(10)
def acceleration_on_moving_hub(dropped: frozenset[str]) -> Parts:
    """Second derivative of hub + R_h r, at the moment the hub is not turned."""
    t, v = sp.Symbol("t"), VECTORS
    turn = v["omega_h"] * t + v["alpha_h"] * t**2 / 2
    moving = v["r_bh"] + v["v_bh"] * t + v["a_bh"] * t**2 / 2
    point = v["a_h"] * t**2 / 2 + kin.rotation(turn) * moving
    return dict(zip("123", sp.diff(point, t, 2).subs(t, 0), strict=True))


@counterpart(11)
def acceleration(dropped: frozenset[str]) -> Parts:
    """Along the axes of the turned hub, as the paper has them."""
    total = _acceleration((*kin.HUB_TRANSLATION, *kin.HUB_ROTATION, *_OF_BLADE), dropped)
    turn = sp.Matrix([motion(name)[0] for name in kin.HUB_ROTATION])
    return dict(zip("ijk", total - turn.cross(_steady_acceleration()), strict=True))


# Flap


def airload_sign() -> int:
    """Sign of the airloads' virtual work on the left of the equations of motion."""
    coefficient, _ = airloads.products()["damping"].as_coeff_mmul()
    return int(coefficient)


@counterpart(12)
def flap_moments(dropped: frozenset[str]) -> Parts:
    """Virtual work per unit of flap; accelerations are perturbations but for the centrifugal a_j."""
    arm = sp.diff(_blade_in_hub_axes(), kin.q["flap"])
    work = n.m * arm.dot(sp.Matrix([n.a_i, n.a_j, n.a_k]))
    integrand = truncated(work, 1, of=_ANGLES | {n.a_i: 1, n.a_k: 1})
    spring = flap_lag_springs.stiffness("flap", "flap") / flap_lag_springs.STIFFNESS["flap", "flap", 0]
    moments = spring * n.M_beta_elas + airload_sign() * n.M_beta_aero
    return {"integrand": in_fixed_coordinates(integrand), "moments": moments}


@functools.cache
def _trim_integrals() -> dict[sp.Symbol, sp.Expr]:
    return inertia.trim_integrals(PAPER_ORDER)


def _in_mass_data(expression: sp.Expr) -> sp.Expr:
    """Trim integrals in the blade's mass data."""
    for _ in range(4):
        expression = expression.subs(_trim_integrals())
    return first_order_in_cone(expression)


@counterpart(13)
def flap_equation(dropped: frozenset[str]) -> Parts:
    blade, omega = _inertia(dropped), s.rotor_speed
    row = sp.Integer(0)
    for name in kin.COORDINATES:
        spring = flap_lag_springs.stiffness("flap", name, dropped)
        zeroth, first, second = motion(name, by_azimuth=True)
        row += _in_mass_data(blade.mass("flap", name)) * second
        row += _in_mass_data(blade.gyroscopic("flap", name) / omega) * first
        row += (_in_mass_data(blade.centrifugal("flap", name)) + spring) / omega**2 * zeroth
    scale = s.blade_inertia * omega**2
    return {
        "inertia and springs": sp.expand(row / s.blade_inertia),
        "airloads": -airload_sign() * n.M_beta_aero / scale,
    }


def frequency_squared(name: str) -> sp.Expr:
    """Uncoupled rotating frequency of flap or lag per rotor speed, at zero cone."""
    blade, flat = _inertia(CONSISTENT), {s.precone: 0, s.coning: 0}
    mass, centrifugal = (_in_mass_data(of(name, name)).subs(flat) for of in (blade.mass, blade.centrifugal))
    spring = flap_lag_springs.STIFFNESS[name, name, 0]
    return sp.expand((centrifugal + spring) / (mass * s.rotor_speed**2))


@counterpart("ν_β", "ν_ζ")
def nomenclature_frequency(number: str, dropped: frozenset[str]) -> Parts:
    name = {"ν_β": "flap", "ν_ζ": "lag"}[number]
    return {f"{number}²": sp.expand(frequency_squared(name).subs(inertia.dependent_inertias()))}


# Airloads


@functools.cache
def _segment_geometry() -> dict[sp.Symbol, sp.Expr]:
    return dict(airloads.segment_geometry())


def _on_outer_segment(expression: sp.Expr) -> sp.Expr:
    """Outboard of both hinges, to first order in the cone."""
    expression = sp.sympify(expression).subs(_segment_geometry()).subs(dict(temporaries(SEGMENT_ANGLES)))
    expression = expression.subs({kin.beyond_flap_hinge: 1, kin.beyond_lag_hinge: 1, s.lag: 0})
    return first_order_in_cone(expression)


def _air_perturbation(velocity: str, dropped: frozenset[str]) -> sp.Expr:
    total = sp.Integer(0)
    for power in (0, 1):
        for name in kin.COORDINATES:
            displacement, rate, _ = motion(name)
            by_rate = airloads.rate_motion(f"{velocity}_{power}", name, dropped)
            by_displacement = airloads.displacement_motion(f"{velocity}_{power}", name, dropped)
            total += s.radial_station**power * (
                _on_outer_segment(by_rate) * rate + _on_outer_segment(by_displacement) * displacement
            )
    return sp.expand(total)


@counterpart(14)
def tangential_velocity(dropped: frozenset[str]) -> Parts:
    return {"δu_T": _air_perturbation("ut", dropped)}


@counterpart(15)
def axial_velocity(dropped: frozenset[str]) -> Parts:
    return {"δu_P": _air_perturbation("up", dropped)}


@counterpart(16)
def pitch_of_airloads(dropped: frozenset[str]) -> Parts:
    changes = (
        airloads.displacement_motion("theta", name, dropped) * motion(name)[0] for name in kin.COORDINATES
    )
    return {"δθ": sum(changes, sp.Integer(0))}


@counterpart(17)
def coordinates(dropped: frozenset[str]) -> Parts:
    known = (name for name in multiblade.FIXED_COORDINATES if name in FIXED_NAMES)
    return {f"{place + 1}": TIME[name][0] for place, name in enumerate(known)}


# Springs

_sine, _cosine = sp.sin(s.structural_pitch), sp.cos(s.structural_pitch)
_STIFFNESS = sp.Matrix(
    2,
    2,
    lambda i, j: flap_lag_springs.STIFFNESS["lag" if min(i, j) else "flap", "lag" if i or j else "flap", 0],
)
_DEFLECTION = sp.Matrix([TIME["flap"][0], TIME["lag"][0]])
_MOMENTS = sp.Matrix([n.M_beta, n.M_zeta])


@functools.cache
def _flexibilities() -> tuple[sp.Matrix, sp.Matrix]:
    """Flexibility inboard and outboard of the pitch bearing, which alone turns with the pitch."""
    total = flap_lag_springs.flexibility(s.structural_pitch)
    inner = total.subs({_sine: 0, _cosine: 0})
    return inner, (total - inner).applyfunc(sp.expand)


@functools.cache
def _series() -> dict[sp.Symbol, sp.Expr]:
    """The derivation's springs and shares in the four springs of the paper, from equal flexibilities."""
    inner, outer = _flexibilities()
    found: dict[sp.Symbol, sp.Expr] = {}
    for place, (spring, share, hub, blade) in enumerate(
        (
            (s.flap_stiffness, s.flap_outboard_fraction, n.K_beta_H, n.K_beta_B),
            (s.lag_stiffness, s.lag_outboard_fraction, n.K_zeta_H, n.K_zeta_B),
        )
    ):
        turned = outer[place, place].coeff(_cosine**2)
        balance = [inner[place, place] - 1 / hub, turned - 1 / blade]
        (solution,) = sp.solve(balance, [spring, share], dict=True)
        found |= {symbol: sp.factor(value) for symbol, value in solution.items()}
    return found


@functools.cache
def _flexibilities_of_springs() -> tuple[sp.Matrix, sp.Matrix]:
    """Flexibility inboard and outboard in the paper's four springs."""
    inner, outer = _flexibilities()
    hub = inner.applyfunc(lambda entry: sp.factor(entry.subs(_series())))
    blade = outer.applyfunc(lambda entry: sp.Add(*(sp.factor(term.subs(_series())) for term in entry.args)))
    return hub, blade


@counterpart(18)
def series_stiffness(dropped: frozenset[str]) -> Parts:
    return {"K_β": _series()[s.flap_stiffness], "K_ζ": _series()[s.lag_stiffness]}


@counterpart(19)
def outboard_shares(dropped: frozenset[str]) -> Parts:
    return {"R_β": _series()[s.flap_outboard_fraction], "R_ζ": _series()[s.lag_outboard_fraction]}


@counterpart(20)
def elastic_moments(dropped: frozenset[str]) -> Parts:
    """Gradient of the spring energy at trim pitch, the deflection counted from the unloaded springs."""
    energy = flap_lag_springs.spring_energy().subs({s.coning: 0, s.lag: 0})
    pitch_held = {kin.q[name]: 0 for name in kin.COORDINATES if name not in ("flap", "lag")}
    angles = {kin.q[name]: TIME[name][0] for name in ("flap", "lag")}
    moments = (sp.diff(energy, kin.q[name]).subs(pitch_held).subs(angles) for name in ("flap", "lag"))
    return dict(zip(("M_β", "M_ζ"), moments, strict=True))


@counterpart(21)
def effective_stiffness(dropped: frozenset[str]) -> Parts:
    numerators, _ = flap_lag_springs.series_springs()
    names = {"K_ββ": ("flap", "flap"), "K_ζζ": ("lag", "lag"), "K_βζ": ("flap", "lag")}
    return {
        name: sp.expand(numerators[pair] / flap_lag_springs.series_determinant)
        for name, pair in names.items()
    }


@counterpart(22)
def series_determinant(dropped: frozenset[str]) -> Parts:
    return {"Δ": flap_lag_springs.series_springs()[1]}


@counterpart(23)
def uniform_blade(dropped: frozenset[str]) -> Parts:
    """The frequency with the integrals of a uniform blade of length R - e, whose spring is K_beta alone."""
    length, mass, arm = sp.symbols("length mass arm", positive=True)
    moment, second = (sp.integrate(mass * arm**power, (arm, 0, length)) for power in (1, 2))
    centrifugal = frequency_squared("flap").subs(inertia.dependent_inertias()).subs(s.rotor_speed, sp.oo)
    offset = {
        s.flap_first_moment: moment,
        s.flap_inertia: second,
        s.flap_hinge_offset: n.mean_offset * length,
    }
    spring = frequency_squared("flap").coeff(flap_lag_springs.STIFFNESS["flap", "flap", 0])
    return {"ν_β²": sp.expand(centrifugal.subs(offset)) + spring * s.flap_stiffness}


def _by_name(vector: sp.Matrix, *names: str) -> Parts:
    return dict(zip(names, vector.expand(), strict=True))


@counterpart(24)
def flexibility_in_series(dropped: frozenset[str]) -> Parts:
    inner, outer = _flexibilities_of_springs()
    total = inner + outer
    return {"ββ": total[0, 0], "βζ": total[0, 1], "ζζ": total[1, 1]}


@counterpart(25, 26)
def deflection_under_moments(number: int, dropped: frozenset[str]) -> Parts:
    inner, outer = _flexibilities_of_springs()
    return _by_name((inner + outer) * _MOMENTS, "β", "ζ")


@counterpart(27)
def deflection_by_itself(dropped: frozenset[str]) -> Parts:
    inner, outer = _flexibilities_of_springs()
    return _by_name((inner + outer) * _STIFFNESS * _DEFLECTION, "β", "ζ")


@counterpart(28)
def deflection_inboard(dropped: frozenset[str]) -> Parts:
    deflection = _flexibilities_of_springs()[0] * _STIFFNESS * _DEFLECTION
    return _by_name(deflection, "β_in", "ζ_in") | _by_name(deflection, "β_in by A, B", "ζ_in by C, D")


@counterpart(29)
def deflection_outboard(dropped: frozenset[str]) -> Parts:
    deflection = _flexibilities_of_springs()[1] * _STIFFNESS * _DEFLECTION
    return _by_name(deflection, "β_out", "ζ_out") | _by_name(deflection, "β_out by W, X", "ζ_out by Y, Z")


@counterpart(30, 31)
def shares_of_deflection(number: int, dropped: frozenset[str]) -> Parts:
    numerators, _ = flap_lag_springs.series_springs()
    pairs = (("flap", "flap"), ("flap", "lag"), ("lag", "lag"))
    flap, mixed, lag = (numerators[pair] for pair in pairs)
    flexibility = _flexibilities()[number - 30]
    shares = flexibility * sp.Matrix([[flap, mixed], [mixed, lag]]) / flap_lag_springs.series_determinant
    return _by_name(shares, *("ABCD" if number == 30 else "WXYZ"))


# Pitch


def _offset_from_feather_axis() -> tuple[sp.Matrix, sp.Matrix]:
    """Direction of the feather axis, and the section's offset from it, to second order in the angles."""
    whole = {kin.q["flap"]: n.beta_in + n.beta_out, kin.q["lag"]: n.zeta_in + n.zeta_out}
    inboard = {kin.q["flap"]: n.beta_in, kin.q["lag"]: n.zeta_in}
    blade = _blade_in_hub_axes()
    axis = kin.lagged(kin.flapped(s.precone + n.beta_in), n.zeta_in)
    axis = kin.GIMBAL_TILT * kin.rotation(kin.q["azimuth"] * kin.K_AXIS) * axis
    return axis, blade.subs(whole) - blade.subs(inboard)


@functools.cache
def _work_about_feather_axis() -> sp.Expr:
    """Work of the section's forces per unit turn, to second order in the angles."""
    small = _ANGLES | {angle: 1 for angle in (n.beta_in, n.beta_out, n.zeta_in, n.zeta_out)}
    vectors = _offset_from_feather_axis()
    axis, offset = (vector.applyfunc(lambda part: truncated(part, 2, of=small)) for vector in vectors)
    force = sp.Matrix([n.F_x, n.F_r, n.F_z])
    # F_r belongs to second order in the angles; the others are perturbations themselves.
    work = truncated(axis.cross(offset).dot(force), 2, of=small | {n.F_x: 1, n.F_z: 1})
    return in_fixed_coordinates(work)


@counterpart(32)
def pitch_equation(dropped: frozenset[str]) -> Parts:
    """Virtual work of a turn of the outboard blade about the feather axis; what resists stands with a plus."""
    turn = sp.diff(kin.pitch_angles()[0], kin.q["pitch"])
    integrand = -_work_about_feather_axis() + airload_sign() * turn * n.dM_theta_aero
    control = sp.Integer(0)
    for name in kin.COORDINATES:
        displacement, _, second = motion(name)
        stiffness = sp.expand(pitch.stiffness("pitch", name, dropped))
        of_control = stiffness.coeff(s.control_stiffness) * s.control_stiffness
        control += of_control * displacement
        integrand += pitch.mass("pitch", name, dropped) * second + (stiffness - of_control) * displacement
    return {
        "integrand": sp.expand(integrand).subs(s.pitch_inertia, n.section_inertia),
        "control system": control,
    }


@functools.cache
def _pitch_moment() -> sp.Matrix:
    """Matrix Q of -dU/dtheta = M^T Q M, M the elastic moments: half the change of the flexibility with pitch."""
    _, outer = _flexibilities_of_springs()
    return sp.diff(outer, s.structural_pitch) / 2


@counterpart(33)
def pitch_moment_of_moments(dropped: frozenset[str]) -> Parts:
    return {"M_θ": sp.expand((_MOMENTS.T * _pitch_moment() * _MOMENTS)[0])}


@counterpart(34)
def pitch_moment_of_deflection(dropped: frozenset[str]) -> Parts:
    moments = _STIFFNESS * _DEFLECTION
    return {"M_θ": sp.expand((moments.T * _pitch_moment() * moments)[0])}


@counterpart(35)
def pitch_deflection(dropped: frozenset[str]) -> Parts:
    """The control system alone resists a moment that does work on the pitch."""
    stiffness = pitch.stiffness("pitch", "pitch", frozenset({"propeller_moment"}))
    return {"Δθ": n.dM_theta / stiffness}


@counterpart(36, 37)
def coupling(number: int, dropped: frozenset[str]) -> Parts:
    """`pitch.couplings`, with the change of K_eff with pitch by that of the flexibility."""
    change = -_STIFFNESS * (2 * _pitch_moment()) * _STIFFNESS
    places = {("flap", "flap"): (0, 0), ("flap", "lag"): (0, 1), ("lag", "lag"): (1, 1)}
    slopes = {flap_lag_springs.STIFFNESS[(*pair, 1)]: change[place] for pair, place in places.items()}
    name, symbol = {36: ("K_Pβ", s.pitch_flap_coupling), 37: ("K_Pζ", s.pitch_lag_coupling)}[number]
    return {name: sp.expand(sp.expand(pitch.couplings()[symbol]).subs(slopes))}


# What symbols that only the print has stand for


@functools.cache
def meaning(number: int | str) -> dict[sp.Symbol, sp.Expr]:
    """Replacements that bring a printed equation into the derivation's symbols."""
    return _MEANINGS.get(number, dict)()


def _flexibility_names() -> dict[sp.Symbol, sp.Expr]:
    inner, outer = _flexibilities_of_springs()
    return {
        symbol: matrix["bz".index(pair[0]), "bz".index(pair[1])]
        for symbols, matrix in ((n.flexibility_in, inner), (n.flexibility_out, outer))
        for pair, symbol in symbols.items()
    }


def _deflection_names(moments: sp.Matrix) -> dict[sp.Symbol, sp.Expr]:
    inner, outer = _flexibilities_of_springs()
    names = (n.beta_in, n.zeta_in, n.beta_out, n.zeta_out)
    return dict(zip(names, [*(inner * moments), *(outer * moments)], strict=True))


def _share_names() -> dict[sp.Symbol, sp.Expr]:
    inner, outer = _flexibilities_of_springs()
    names = (n.A, n.B, n.C, n.D, n.W, n.X, n.Y, n.Z)
    return dict(zip(names, [*(inner * _STIFFNESS), *(outer * _STIFFNESS)], strict=True))


def _pitch_moment_names() -> dict[sp.Symbol, sp.Expr]:
    names = {n.M_beta_elas: n.M_beta, n.M_zeta_elas: n.M_zeta}
    return names | _deflection_names(_MOMENTS)


_MEANINGS: dict[int | str, Callable[[], dict[sp.Symbol, sp.Expr]]] = {
    **dict.fromkeys((1, 2, 3, 11, 12, 14, 15, 16, 32), gimbal_flap),
    13: lambda: gimbal_flap(True) | {sp.Symbol("nu_beta_squared", real=True): frequency_squared("flap")},
    19: lambda: {symbol: _series()[symbol] for symbol in (s.flap_stiffness, s.lag_stiffness)},
    **dict.fromkeys((24, 26, 27), _flexibility_names),
    25: lambda: _deflection_names(_MOMENTS),
    **dict.fromkeys((28, 29), lambda: _flexibility_names() | _share_names()),
    33: _pitch_moment_names,
    **dict.fromkeys((34, 36, 37), _share_names),
}
