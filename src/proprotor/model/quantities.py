"""The numbers of a rotor, its operation and the options of a model, by the names of the derivation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np
from proprotor_equations import offset_mass, pitch

from proprotor.model.batches import joint_shape
from proprotor.rotor.airfoil import Airfoil
from proprotor.rotor.airfoil_regions import AirfoilRegions
from proprotor.rotor.generated import evaluate
from proprotor.rotor.kept import kept
from proprotor.rotor.operation import Operation
from proprotor.rotor.options import Options
from proprotor.rotor.rotor import Rotor
from proprotor.rotor.trim import has_offset_mass
from proprotor.typing import Array

COUPLINGS = ("pitch_flap_coupling", "pitch_lag_coupling")
_AIR = ("rotor_speed", "density", "speed_of_sound")
_ALONG_THE_BLADE = ("airfoil", "chord", "twist", "aerodynamic_center")
_NO_NUMBERS = ("offset_mass", "propeller_inertia")  # of which others are made
_HINGE_INERTIAS = ("flap_hub_inertia", "lag_hub_inertia", "flap_lag_inertia")
_SOFTEST_SPRING = 1e-100  # relative to the other spring: a free hinge, without a division by zero in series


def batch_shape(rotor: Rotor, operation: Operation, airspeed: Array, options: Options) -> tuple[int, ...]:
    """Return the shape of all arrays among the inputs, broadcast together."""
    inputs = [airspeed, *(getattr(operation, name) for name in _AIR)]
    inputs += [] if isinstance(operation.trim, str) else list(operation.trim.values())
    inputs += [] if options.drive_train is None else list(vars(options.drive_train).values())
    inputs += [options.shaft_angle, options.load_factor]
    return joint_shape(shape_of(rotor), *(np.shape(value) for value in inputs if _may_vary(value)))


@kept
def shape_of(rotor: Rotor) -> tuple[int, ...]:
    """Return the shape of all arrays among the numbers of a rotor, broadcast together; () for a single design."""
    inputs = [
        getattr(rotor, entry.name) for entry in fields(rotor) if entry.name not in ("airfoil", "offset_mass")
    ]
    inputs += [] if rotor.offset_mass is None else list(vars(rotor.offset_mass).values())
    leading = [np.empty(np.shape(value[0])[:-1]) for value in inputs if isinstance(value, tuple)]
    inputs = [value for value in inputs if not isinstance(value, tuple) and not callable(value)] + leading
    if isinstance(rotor.airfoil, Airfoil):
        inputs += vars(rotor.airfoil).values()
    if isinstance(rotor.airfoil, AirfoilRegions):
        inputs += rotor.airfoil.numbers()
    return joint_shape((), *(np.shape(value) for value in inputs if _may_vary(value)))


def _may_vary(value: Any) -> bool:
    """Return whether a value may be an array, before NumPy is asked, which takes longer than the answer is worth."""
    return not isinstance(value, float | int)


def flat(value: Any, shape: tuple[int, ...]) -> Any:
    """Return an array spread over a batch and flattened, (points,); a plain number as it is."""
    return np.broadcast_to(value, shape).reshape(-1) if _may_vary(value) and np.ndim(value) else value


def model_quantities(
    rotor: Rotor, operation: Operation, options: Options, airspeed: Array, shape: tuple[int, ...]
) -> dict[str, Any]:
    """Return the quantities of rotor, operation, options and airspeed: numbers, or arrays flattened over the batch.

    The options give couplings, drive train and section damping.
    """
    given = _numbers_of(rotor) | {name: getattr(operation, name) for name in _AIR}
    given["airspeed"] = airspeed
    given |= {name: value for name in COUPLINGS if (value := getattr(options, name)) is not None}
    given |= {} if options.drive_train is None else options.drive_train.at_rotor
    given["section_damping"] = float(bool(options.section_damping))
    return {name: flat(value, shape) for name, value in given.items()} if shape else given


@kept
def _numbers_of(rotor: Rotor) -> dict[str, Any]:
    """Return the rotor's own numbers; no spring is so soft that two springs in series would divide by zero."""
    given = of_rotor(rotor)
    softest = _SOFTEST_SPRING * np.maximum(np.maximum(rotor.flap_stiffness, rotor.lag_stiffness), 1.0)
    given |= {name: np.maximum(given[name], softest) for name in ("flap_stiffness", "lag_stiffness")}
    return given | {"propeller_moment": rotor.propeller_share, "beside_axis": rotor.is_beside_axis}


def of_rotor(rotor: Rotor) -> dict[str, Any]:
    """Return the rotor's own numbers, without the properties that are distributed along the blade."""
    apart = (*_ALONG_THE_BLADE, *_NO_NUMBERS)
    names = [entry.name for entry in fields(rotor) if entry.name not in apart]
    given = {name: getattr(rotor, name) for name in (*names, *_HINGE_INERTIAS)}
    cyclic = given.pop("cyclic_control_stiffness")
    excess = 0.0 if cyclic is None else cyclic - rotor.control_stiffness
    if rotor.offset_mass is not None:
        given |= vars(rotor.offset_mass)
        given["pitch_inertia"] = rotor.pitch_inertia - rotor.offset_mass.inertia  # what is left is lumped
    return given | {"cyclic_control_stiffness_excess": excess}


def couplings(options: Options, quantities: Mapping[str, Any]) -> dict[str, Any]:
    """Return the pitch-flap and pitch-lag couplings of the airloads' pitch: as given, else in closed form.

    Both are zero unless pitch="coupling".
    """
    if options.pitch != "coupling":
        return dict.fromkeys(COUPLINGS, 0.0)
    closed_form: dict[str, Any] = closed_couplings(quantities)
    return closed_form | {name: quantities[name] for name in COUPLINGS if name in quantities}


def closed_couplings(quantities: Mapping[str, Any]) -> dict[str, Any]:
    """Return K_Pβ and K_Pζ by name: of the springs, and of mass beside the pitch axis."""
    found: dict[str, Any] = evaluate(pitch.couplings, quantities)._asdict()
    if not has_offset_mass(quantities):
        return found
    beside = evaluate(offset_mass.couplings, quantities)._asdict()
    return {name: value + beside[name] for name, value in found.items()}
