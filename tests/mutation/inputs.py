"""What goes into the generated functions, from sums over point masses and derivatives of energies."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from proprotor_equations.fused.plain import ABSENT

from tests.mutation import one_blade
from tests.mutation.one_blade import Point
from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import hinge_spring_energy

Quantities = dict[str, NDArray]
PLAIN, GENERAL, OFFSET = "plain", "general", "offset"  # fused modules
SEEDS = (0, 1, 2)  # rotors of three, four and five blades


@functools.cache
def points(kind: str = OFFSET) -> tuple[Point, ...]:
    """Rotors at a steady state, of the kind that a fused module serves.

    Those of `GENERAL` have nothing beside the pitch axis, plain ones have no linkages and couplings of pitch either.
    """
    found = map(Point.random, SEEDS)
    if kind != OFFSET:
        found = map(one_blade.all_on_axis, found)
    if kind == PLAIN:
        found = (
            replace(one_blade.without_linkages(p), pitch_flap_coupling=0.0, pitch_lag_coupling=0.0)
            for p in found
        )
    return tuple(found)


def stacked(pools: Iterable[Mapping[str, Any]]) -> Quantities:
    """Quantities of all points, the first axis, by name."""
    pools = list(pools)
    return {name: np.array([pool[name] for pool in pools]) for name in pools[0]}


@functools.cache
def blade_quantities(kind: str = OFFSET) -> Quantities:
    """Of the whole blade, (points,); what plain rotors have not is the plain number zero."""
    parts = (one_blade.quantities, one_blade.beside_line, trim_integrals, spring_constants)
    pools = ({name: value for part in parts for name, value in part(p).items()} for p in points(kind))
    absent = dict.fromkeys(ABSENT, 0.0) if kind == PLAIN else {}
    return stacked(pools) | absent | {"beside_axis": kind == OFFSET}


@functools.cache
def published_quantities() -> Quantities:
    """The same with mass integrals to first order."""
    return blade_quantities() | stacked(first_order_integrals(p) for p in points())


def trim_integrals(point: Point) -> dict[str, float]:
    """Sums over the point masses at trim, by the names of the derivation."""
    rotor, (r, outboard, lag_arm) = point.rotor, one_blade.arms(point)
    root, cone, lag = rotor.precone, rotor.precone + point.state["coning"], point.state["lag"]
    inboard, flap_arm = r - outboard, outboard - lag_arm * (1 - np.cos(lag))
    radial, axial = (f(root) * inboard + f(cone) * flap_arm for f in (np.cos, np.sin))
    angles = {"precone": root, "cone": cone, "lag": lag}
    waves = {f"{f.__name__}_{name}": f(angle) for name, angle in angles.items() for f in (np.cos, np.sin)}
    return waves | _arm_integrals(rotor.mass, inboard, flap_arm, lag_arm, radial, axial)


def first_order_integrals(point: Point) -> dict[str, float]:
    """The same to first order in the cone, without trim lag: a flat blade's arms, and a rise of angle times length."""
    rotor, (r, outboard, lag_arm) = point.rotor, one_blade.arms(point)
    root, cone = rotor.precone, rotor.precone + point.state["coning"]
    rise = root * (r - outboard) + cone * outboard
    waves = {"cos_precone": 1.0, "cos_cone": 1.0, "cos_lag": 1.0}
    waves |= {"sin_precone": root, "sin_cone": cone, "sin_lag": 0.0}
    integrals = _arm_integrals(rotor.mass, r - outboard, outboard, lag_arm, r, rise)
    return waves | integrals | {"axial_inertia": 0.0}  # of second order


def _arm_integrals(
    mass: NDArray, inboard: NDArray, flap_arm: NDArray, lag_arm: NDArray, radial: NDArray, axial: NDArray
) -> dict[str, float]:
    return {
        "inboard_moment": mass @ inboard,
        "flap_moment": mass @ flap_arm,
        "inboard_inertia": mass @ inboard**2,
        "inboard_flap_inertia": mass @ (inboard * flap_arm),
        "inboard_lag_inertia": mass @ (inboard * lag_arm),
        "deflected_flap_inertia": mass @ flap_arm**2,
        "deflected_flap_lag_inertia": mass @ (flap_arm * lag_arm),
        "radial_moment": mass @ radial,
        "axial_moment": mass @ axial,
        "radial_inertia": mass @ radial**2,
        "radial_axial_inertia": mass @ (radial * axial),
        "axial_inertia": mass @ axial**2,
        "radial_flap_inertia": mass @ (radial * flap_arm),
        "axial_flap_inertia": mass @ (axial * flap_arm),
        "radial_lag_inertia": mass @ (radial * lag_arm),
        "axial_lag_inertia": mass @ (axial * lag_arm),
    }


def spring_energy(point: Point, flap: complex, lag: complex) -> Motion:
    """Energy of the hinge springs, and its first and second derivative with the turn of the springs."""
    turn = one_blade.quantities(point)["structural_pitch"]
    return hinge_spring_energy(point.rotor, Motion(flap), Motion(lag), Motion(turn, 1.0))


def spring_constants(point: Point) -> dict[str, float]:
    """K of U = ½ K_ββ β² + K_βζ β ζ + ½ K_ζζ ζ², and its derivatives with pitch."""
    of_flap, of_lag, of_both = (spring_energy(point, *bent) for bent in ((1.0, 0.0), (0.0, 1.0), (1.0, 1.0)))
    constants = {"flap_flap": 2 * of_flap, "lag_lag": 2 * of_lag, "flap_lag": of_both - of_flap - of_lag}
    parts = {"stiffness": "value", "stiffness_slope": "rate", "stiffness_curvature": "acceleration"}
    return {
        f"{pair}_{kind}": float(getattr(energy, part))
        for pair, energy in constants.items()
        for kind, part in parts.items()
    }


@functools.cache
def natural_sizes() -> list[NDArray]:
    """Ω^k √(M_ii M_jj), k = 0, 1, 2, (points, 12, 12): what inertia at 1/rev would put into an entry of M, C and K."""
    mass = np.array([one_blade.mass_matrices(p)[0] + one_blade.pitch_matrices(p)[0] for p in points()])
    root = np.sqrt(np.diagonal(mass, axis1=-2, axis2=-1))
    omega = blade_quantities()["rotor_speed"][:, None, None]
    return [omega**order * root[:, :, None] * root[:, None, :] for order in range(3)]
