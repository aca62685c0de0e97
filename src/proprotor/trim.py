"""Steady state of the rotor: what it is, what closes it, and the quantities that follow from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from proprotor_equations import flap_lag_springs, inertia
from proprotor_equations import trim as balances

from proprotor.arrays import Array
from proprotor.evaluation import evaluate
from proprotor.operation import Operation
from proprotor.options import Options
from proprotor.rotor import Rotor

UNKNOWNS = ("coning", "lag", "elastic_pitch", "collective")
TORQUE, THRUST = balances.AZIMUTH, balances.HUB_K  # rows of a blade's balance
_FLAP_LAG = ("flap_lag_stiffness", "flap_lag_stiffness_slope", "flap_lag_stiffness_curvature")


@dataclass(frozen=True, eq=False)
class Trim:
    """Trim states, all arrays of the batch's shape; NaN at points that failed.

    Attributes
    ----------
    collective, coning, lag, elastic_pitch : array
        rad; the pitch at 0.75 R is collective and elastic pitch together.
    thrust : array
        Of the airloads on the whole rotor along +K, N.
    torque : array
        Of the airloads on the whole rotor, positive where it speeds the rotor up, N m.
    converged : array of bool
        Whether a trim was found, and the model has modes there.
    reason : array of str
        Why a point failed, empty where it did not.
    warning : array of str
        What makes a converged point doubtful, empty where nothing does.
    iterations : array of int
        Steps taken.
    """

    collective: Array
    coning: Array
    lag: Array
    elastic_pitch: Array
    thrust: Array
    torque: Array
    converged: Array
    reason: Array
    warning: Array
    iterations: Array

    @property
    def pitch(self) -> Array:
        """Pitch of the blade at 0.75 R, rad."""
        return self.collective + self.elastic_pitch

    def broadcast(self, shape: tuple[int, ...]) -> Trim:
        """The same at every point of a batch with more axes.

        Parameters
        ----------
        shape : tuple of int
            Of the batch.

        Returns
        -------
        Trim
        """
        return Trim(**{e.name: np.broadcast_to(getattr(self, e.name), shape) for e in fields(self)})


@dataclass(frozen=True)
class Target:
    """What closes the trim: a given collective, or the row of a balance and the load on one blade that meets it."""

    collective: Any = None
    row: int = TORQUE
    load: Any = 0.0
    windmilling: bool = False

    @property
    def finds_collective(self) -> bool:
        return self.collective is None


def trim_target(rotor: Rotor, operation: Operation) -> Target:
    """Target of an operation; coefficients are C_T = T/(ρπR²(ΩR)²) and C_P = QΩ/(ρπR²(ΩR)³), power put in positive."""
    if isinstance(operation.trim, str):
        return Target(windmilling=True)
    (name, value), *_ = operation.trim.items()
    if name == "collective":
        return Target(collective=value)
    tip_speed = np.asarray(operation.rotor_speed) * rotor.radius
    force = np.asarray(value) * operation.density * np.pi * np.asarray(rotor.radius) ** 2 * tip_speed**2
    if name == "thrust_coefficient":
        return Target(row=THRUST, load=force / rotor.n_blades)
    return Target(row=TORQUE, load=-force * rotor.radius / rotor.n_blades)


def take(quantities: Mapping[str, Any], rows: Array) -> dict[str, Any]:
    """Quantities at some of the points; scalars hold for all."""
    return {name: value[rows] if np.ndim(value) else value for name, value in quantities.items()}


def with_trim(quantities: Mapping[str, Any], options: Options, state: Mapping[str, Any]) -> dict[str, Any]:
    """All quantities of the whole blade at a trim state."""
    pool = dict(quantities) | dict(state)
    pool["pitch"] = state["collective"] + state["elastic_pitch"]
    pool["structural_pitch"] = pool["pitch"] + quantities["structural_pitch_offset"]
    pool |= evaluate(inertia.trim_integrals, pool)._asdict()
    return pool | _springs(options, pool)


def _springs(options: Options, pool: Mapping[str, Any]) -> dict[str, Any]:
    """Effective flap and lag stiffness and its change with pitch, as the structure option has it."""
    if options.frequencies is not None:  # structure="tabulated"
        none = dict.fromkeys(flap_lag_springs.EffectiveStiffness._fields, 0.0)
        rotating = options.frequencies.rotating(pool["collective"], pool["airspeed"], pool["rotor_speed"])
        given: dict[str, Any] = evaluate(
            flap_lag_springs.stiffness_of_frequencies, dict(pool) | rotating
        )._asdict()
        return none | given
    springs: dict[str, Any] = evaluate(flap_lag_springs.effective_stiffness, pool)._asdict()
    if options.structure == "diagonal":
        springs |= dict.fromkeys(_FLAP_LAG, 0.0)
    return springs
