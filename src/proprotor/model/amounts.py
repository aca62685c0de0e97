"""What the inputs of a case amount to: the numbers by which a reader who knows rotors sees a slip of a unit.

Frequencies, couplings and masses come from the generated functions, at the trim that the model itself takes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from proprotor_equations import BLADE_COORDINATES, inertia, multiblade, pitch
from proprotor_equations import FIXED_COORDINATES as DOFS
from proprotor_equations import flap_lag_springs as springs

from proprotor.errors import InputError
from proprotor.model.amount_rules import doubt_of
from proprotor.model.batches import joint_shape
from proprotor.model.configuration import Configuration
from proprotor.model.mass_at_rest import mass_at_rest
from proprotor.model.pair import shares
from proprotor.model.quantities import closed_couplings, model_quantities, shape_of
from proprotor.model.rotor_model import rotor_model
from proprotor.model.rotor_share import rotor_share, undamped_modes, without_rotors
from proprotor.rotor.generated import evaluate
from proprotor.rotor.options import parse_options
from proprotor.rotor.rotor import MASS_INTEGRALS, Rotor
from proprotor.rotor.trim import UNKNOWNS, with_trim
from proprotor.support.airframe import Airframe
from proprotor.typing import Array

_LOWEST = 6  # modes of a support that a rule is about; those above are of a mesh, however high
_PITCHES = np.radians([10.0, 20.0, 30.0, 40.0, 50.0])  # directions of the air at 0.75 R
_FLAT = (*UNKNOWNS, "precone")  # zero for frequencies of an undeflected blade at zero cone
_BESIDE_THE_GIMBAL = ("pitch_gimbal_coupling", "pitch_inertia", "gimbal_damping")
_GIMBAL = [DOFS.index(name) for name in ("gimbal_1c", "gimbal_1s")]
_FLAP, _LAG = map(BLADE_COORDINATES.index, ("flap", "lag"))
_RULED = ("flap frequency", "lag frequency", "K_Pβ", "K_Pζ", "K_Pβ", "K_Pζ")
_PAIR = ("pitch_flap_coupling", "pitch_lag_coupling")
_FOUND = ("flap_frequency", "lag_frequency", *_PAIR, *(f"cyclic_{name}" for name in _PAIR))
_SLOW = 1e-3  # Mach number at which a table of an airfoil gives the slope of the Lock number
_MASS_UNITS = {"mass": "kg", "first_moment": "kg m", "inertia": "kg m²"}


@dataclass(frozen=True)
class Amount:
    """A number that follows from the inputs.

    Attributes
    ----------
    name : str
    value : float
    unit : str
        "" for a number without dimension.
    formula : str
        How the number follows from inputs.
    doubt : str
        Why the number is doubtful; "" if it is not.
    """

    name: str
    value: float
    unit: str
    formula: str
    doubt: str = ""


@dataclass(frozen=True)
class BladeAtTrim:
    """A blade at the trim of one airspeed: angles in rad, airspeed in m/s, frequencies per revolution.

    The frequencies are those of the uncoupled undeflected blade at zero cone, with the springs of this collective. The
    couplings K_Pβ = -∂θ/∂β and K_Pζ = -∂θ/∂ζ are NaN for a rotor without control stiffness: those of the collective
    harmonic, and of the cyclic one, which differ where the swashplate tilts on a stiffness of its own.
    """

    airspeed: float
    collective: float
    coning: float
    lag: float
    elastic_pitch: float
    flap_frequency: float
    lag_frequency: float
    pitch_flap_coupling: float
    pitch_lag_coupling: float
    cyclic_pitch_flap_coupling: float
    cyclic_pitch_lag_coupling: float
    doubt: str = ""


@dataclass(frozen=True)
class SupportMode:
    """A mode of the support without damping: its frequency in Hz alone and with the mass of its rotors at rest."""

    name: str
    alone: float
    with_rotor: float
    doubt: str = ""


def amounts(case: Configuration) -> tuple[Amount, ...]:
    """Return what the inputs of a case amount to.

    Parameters
    ----------
    case : Configuration
        A single design.

    Returns
    -------
    tuple of Amount

    Raises
    ------
    InputError
        For a case with arrays of designs.
    """
    _check_single(case)
    named = (*_blade(case), *_masses(case), *_gimbal(case))
    return tuple(
        Amount(name, float(value), unit, formula, doubt_of(name, _ruled(case, name, float(value))))
        for name, value, unit, formula in named
    )


def blade_at_trims(case: Configuration, airspeeds: Array | None = None) -> tuple[BladeAtTrim, ...]:
    """Return the blade at the trim of some airspeeds; failed trims are left out.

    Parameters
    ----------
    case : Configuration
        A single design.
    airspeeds : array (airspeeds,), optional
        m/s; by default those at which the air meets 0.75 R at 10 to 50 deg, so that collective grows.
    """
    _check_single(case)
    rotor, omega = case.rotor, case.operation.rotor_speed
    speeds = 0.75 * omega * rotor.radius * np.tan(_PITCHES) if airspeeds is None else airspeeds
    held = rotor.pitch_inertia > 0 and rotor.control_stiffness > 0
    choice = case.model_options({"pitch": "dynamic" if held else "rigid"})
    options = parse_options(choice)
    trim = rotor_model(rotor, case.operation, speeds, **choice).trim
    found = []
    for place in np.flatnonzero(trim.converged):
        speed = np.asarray(speeds[place])
        state = {name: getattr(trim, name)[place] for name in UNKNOWNS}
        quantities = model_quantities(rotor, case.operation, options, speed, ())
        flap, lag = _frequencies(quantities, options, state)
        coupled = with_trim(quantities, options, state)
        numbers = [float(number) for number in (flap, lag, *_couplings_by_harmonic(rotor, coupled))]
        doubts = dict.fromkeys(doubt_of(name, value) for name, value in zip(_RULED, numbers, strict=True))
        angles = {name: float(state[name]) for name in ("collective", "coning", "lag", "elastic_pitch")}
        given: dict[str, Any] = angles | dict(zip(_FOUND, numbers, strict=True))
        found.append(BladeAtTrim(airspeed=float(speed), doubt="; ".join(filter(None, doubts)), **given))
    return tuple(found)


def _couplings_by_harmonic(rotor: Rotor, quantities: Mapping[str, Any]) -> tuple[float, ...]:
    """Return K_Pβ and K_Pζ where all blades turn alike, then where the swashplate tilts; NaN without a stiffness."""
    cyclic = rotor.cyclic_control_stiffness
    found: list[float] = []
    for stiffness in (rotor.control_stiffness, rotor.control_stiffness if cyclic is None else cyclic):
        pair = (np.nan, np.nan)
        if stiffness > 0:
            pair = tuple(closed_couplings({**quantities, "control_stiffness": stiffness}).values())
        found += pair
    return tuple(found)


def support_modes(case: Configuration) -> tuple[SupportMode, ...]:
    """Return the modes of the support without damping and without air, alone and with its rotors at rest.

    The rotors hang on their gimbals with shafts held; both lists have rising frequencies.

    Parameters
    ----------
    case : Configuration
        A single design.
    """
    _check_single(case)
    support, at_rest = case.support, mass_at_rest(case.rotor)
    rotors: list[tuple[Array, Any]] = [(support.hub, at_rest)]
    if isinstance(support, Airframe):
        rotors = shares(support, at_rest, None if case.left is None else mass_at_rest(case.left.rotor))
    alone, _ = without_rotors(support, rotors)
    whole = alone + sum(hub.T @ rotor_share(mass, "gimballed") @ hub for hub, mass in rotors)
    if not support.names:
        return ()
    own, _, shapes = undamped_modes(alone, support.stiffness)
    carrying, _, _ = undamped_modes(whole, support.stiffness)
    names = np.array(support.names)[np.abs(shapes).argmax(axis=0)]
    omega = float(case.operation.rotor_speed)
    return tuple(
        SupportMode(
            str(name),
            f / (2 * np.pi),
            g / (2 * np.pi),
            doubt_of("mode of the support", g / omega) if g and place < _LOWEST else "",
        )
        for place, (name, f, g) in enumerate(zip(names, np.sqrt(own), np.sqrt(carrying), strict=True))
    )


def _check_single(case: Configuration) -> None:
    """Refuse a case that is many designs at once."""
    sizes = (np.shape(getattr(case.operation, name)) for name in ("rotor_speed", "density", "speed_of_sound"))
    if joint_shape(shape_of(case.rotor), *sizes) or case.support.mass.ndim > 2:
        raise InputError("case", case.name, "must be a single design")


def _ruled(case: Configuration, name: str, value: float) -> float:
    """Return the value that the rule of an amount is about: lengths of the blade relative to the radius."""
    if name in ("mean chord", "centre of mass", "radius of gyration"):
        return value / float(case.rotor.radius)
    if name == "density" and value == 0:
        return np.nan  # a vacuum is meant
    if name == "Lock number" and value == 0:
        return np.nan
    return float(np.degrees(value)) if name == "precone" else value


def _blade(case: Configuration) -> Iterator[tuple[str, Any, str, str]]:
    """Yield the amounts of blade and air."""
    rotor, operation = case.rotor, case.operation
    r, weights = rotor.quadrature.stations, rotor.quadrature.weights[..., 0]
    chord = np.broadcast_to(rotor.sections.chord, r.shape)
    still = np.zeros((1, r.shape[-1]))
    coefficients = rotor.airfoil_at(r, ()).coefficients(still, still + _SLOW)
    slope = np.broadcast_to(coefficients.lift_coefficient_alpha, still.shape)[0]
    mean = np.sum(weights * chord) / np.sum(weights)
    lift = np.sum(weights * slope * chord * r**3) / np.sum(weights * r**3)
    yield "precone", rotor.precone, "rad", ""
    yield "mean chord", mean, "m", "c = ∫ c dr / ∫ dr from the root cutout to the tip"
    yield "solidity", rotor.n_blades * mean / (np.pi * rotor.radius), "", "σ = N c / (π R)"
    yield (
        "Lock number",
        operation.density * lift * rotor.radius**4 / rotor.blade_inertia,
        "",
        (
            "γ = ρ c_lα c R⁴ / I_b, with c_lα c = ∫ c_lα c r³ dr / ∫ r³ dr and c_lα at zero incidence and low speed"
        ),
    )
    yield "density", operation.density, "kg/m³", ""
    yield "speed of sound", operation.speed_of_sound, "m/s", ""
    tip_speed = operation.rotor_speed * rotor.radius
    yield "tip Mach number", tip_speed / operation.speed_of_sound, "", "Ω R / a_s, without airspeed"


def _masses(case: Configuration) -> Iterator[tuple[str, Any, str, str]]:
    """Yield the mass integrals and what they say together."""
    rotor = case.rotor
    for name in MASS_INTEGRALS:
        kind = name.partition("_")[2]
        yield name.replace("_", " "), getattr(rotor, name), _MASS_UNITS[kind], ""
    yield "I_βα", rotor.flap_hub_inertia, "kg m²", "I_β + e_β S_β"
    yield "I_ζα", rotor.lag_hub_inertia, "kg m²", "I_ζ + e_ζ S_ζ"
    yield "I_βζ", rotor.flap_lag_inertia, "kg m²", "I_ζ + (e_ζ - e_β) S_ζ"
    yield "centre of mass", rotor.blade_first_moment / rotor.blade_mass, "m", "S_b / m_b"
    yield "radius of gyration", np.sqrt(rotor.blade_inertia / rotor.blade_mass), "m", "√(I_b / m_b)"
    gram, arms = rotor.gram_matrix, "1, r, ρ_β, ρ_ζ"
    if rotor.offset_mass is not None:
        arms = "1, r, ρ_β, ρ_ζ, x cos τ, x sin τ"
        yield "∫ m x", rotor.offset_mass.offset_cosine_moment, "kg m", "outboard of the lag hinge, x cos τ"
        yield (
            "∫ m x ρ_ζ",
            rotor.offset_mass.offset_cosine_lag_inertia,
            "kg m²",
            "outboard of the lag hinge, x cos τ",
        )
        yield (
            "∫ m x²",
            rotor.offset_mass.inertia,
            "kg m²",
            "the part of the pitch inertia that comes from the offset",
        )
    diagonal = np.diagonal(gram)
    size = np.sqrt(np.where(diagonal > 0, diagonal, 1.0))
    yield (
        "smallest eigenvalue of the Gram matrix",
        np.linalg.eigvalsh(gram / np.outer(size, size))[0],
        "",
        f"of the arms {arms} scaled to a unit diagonal; below zero no blade has these integrals",
    )


def _gimbal(case: Configuration) -> Iterator[tuple[str, Any, str, str]]:
    """Yield the gimbal's frequency in rotating axes: rigid blades at zero cone, no pitch inertia, a vacuum."""
    options = parse_options(case.model_options({}))
    quantities = model_quantities(case.rotor, case.operation, options, np.asarray(0.0), ())
    flat = quantities | dict.fromkeys((*_FLAT, *_BESIDE_THE_GIMBAL), 0.0)
    flat = with_trim(flat, options, dict.fromkeys(UNKNOWNS, 0.0))
    blade = _blade_matrices(flat)
    mass, gyroscopic, stiffness = (
        np.real(evaluate(getattr(multiblade, kind), flat, *blade[: count + 1]))[np.ix_(_GIMBAL, _GIMBAL)]
        for count, kind in enumerate(("mass", "damping", "stiffness"))
    )
    companion = np.block(
        [
            [np.zeros((2, 2)), np.eye(2)],
            [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, gyroscopic)],
        ]
    )
    both = np.abs(np.linalg.eigvals(companion).imag)
    # In fixed axes the two motions turn one revolution faster and one slower than in rotating axes.
    yield (
        "gimbal frequency",
        both.sum() / 4 / case.operation.rotor_speed,
        "/rev",
        ("√(1 + K_G / (N/2 I_b Ω²)) at zero cone, blades locked"),
    )


def _frequencies(quantities: Mapping[str, Any], options: Any, state: Mapping[str, Any]) -> list[float]:
    """Return the uncoupled flap and lag frequency per revolution of the flat blade, with springs of a collective."""
    flat = {**quantities, "precone": 0.0}
    given = with_trim(flat, options, {**state, "coning": 0.0, "lag": 0.0})
    mass, _, stiffness = _blade_matrices(given)
    omega = given["rotor_speed"]
    return [float(np.sqrt(stiffness[n, n] / mass[n, n]) / omega) for n in (_FLAP, _LAG)]


def _blade_matrices(quantities: Mapping[str, Any]) -> tuple[Array, Array, Array]:
    """Return M, C and K of one blade in a vacuum and in rotating axes."""
    return (
        evaluate(inertia.mass, quantities) + evaluate(pitch.mass, quantities),
        evaluate(inertia.gyroscopic, quantities) + evaluate(pitch.damping, quantities),
        evaluate(inertia.centrifugal_stiffness, quantities)
        + evaluate(springs.stiffness, quantities)
        + evaluate(pitch.stiffness, quantities),
    )
