"""The generated equations of the rotor without airloads, called as plain functions: this project's side."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from numpy.typing import NDArray
from proprotor_equations import flap_lag_springs, inertia, multiblade, pitch

from proprotor.rotor.generated import evaluate

Matrices = tuple[NDArray, NDArray, NDArray]  # M, C, K

NO_LINKAGES = {
    "kinematic_pitch_flap_coupling": 0.0,
    "kinematic_pitch_lag_coupling": 0.0,
}  # as the other methods

# What is called for M, C and K, in this order; also what size and operations are counted over.
BLADE_FUNCTIONS: tuple[Callable, ...] = (
    inertia.dependent_inertias,
    inertia.trim_integrals,
    flap_lag_springs.effective_stiffness,
    inertia.mass,
    pitch.mass,
    inertia.gyroscopic,
    pitch.damping,
    inertia.centrifugal_stiffness,
    pitch.stiffness,
    flap_lag_springs.stiffness,
)
ROTOR_FUNCTIONS: tuple[Callable, ...] = (multiblade.mass, multiblade.damping, multiblade.stiffness)


def blade_matrices(quantities: Mapping[str, Any]) -> Matrices:
    """M, C, K (..., 12, 12) of one blade in rotating axes."""
    pool = NO_LINKAGES | dict(quantities)
    for values in BLADE_FUNCTIONS[:3]:
        pool |= evaluate(values, pool)._asdict()
    mass = evaluate(inertia.mass, pool) + evaluate(pitch.mass, pool)
    damping = evaluate(inertia.gyroscopic, pool) + evaluate(pitch.damping, pool)
    stiffness = evaluate(inertia.centrifugal_stiffness, pool) + evaluate(pitch.stiffness, pool)
    return mass, damping, stiffness + evaluate(flap_lag_springs.stiffness, pool)


def rotor_matrices(quantities: Mapping[str, Any]) -> Matrices:
    """M, C, K (..., 18, 18) of the rotor in the fixed frame."""
    return over_blades(quantities, blade_matrices(quantities))


def over_blades(quantities: Mapping[str, Any], blade: Matrices) -> Matrices:
    """Matrices of the rotor (..., 18, 18) from those of one blade (..., 12, 12)."""
    return tuple(
        evaluate(function, quantities, *blade[:count])
        for count, function in enumerate(ROTOR_FUNCTIONS, start=1)
    )
