"""Steady state of the rotor: the unknowns, what closes the trim, and the quantities that follow from a trim state."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from proprotor_equations import flap_lag_springs, offset_mass
from proprotor_equations import trim as equations

from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.rotor.fused import effective_stiffness, trim_integrals
from proprotor.rotor.generated import evaluate
from proprotor.rotor.operation import Operation
from proprotor.rotor.options import Options
from proprotor.rotor.rotor import Rotor
from proprotor.typing import Array

# In the order of the columns of `equations.jacobian`.
UNKNOWNS = ("coning", "lag", "elastic_pitch", "collective")
TORQUE, THRUST = equations.AZIMUTH, equations.HUB_K  # rows of a blade's balance
FLAP_LAG = tuple(f"flap_lag_stiffness{derivative}" for derivative in ("", "_slope", "_curvature"))


@dataclass(frozen=True, eq=False)
class Trim:
    """Trim states, all arrays of the batch's shape; NaN at points that failed.

    Attributes
    ----------
    collective, coning, lag, elastic_pitch : array
        rad; the pitch at 0.75 R is the sum of collective and elastic pitch.
    thrust : array
        Force of the airloads on the whole rotor along +K, N.
    torque : array
        Moment of the airloads on the whole rotor, positive if it speeds the rotor up, N m.
    converged : array of bool
        Whether a trim was found; the model has modes at these points alone.
    reason : array of str
        Why a point failed; empty at a converged point.
    warning : array of str
        Why the trim of a converged point is doubtful; empty if it is not.
    iterations : array of int
        Number of steps taken.
    inflow : array
        Induced velocity by momentum theory, against the thrust, m/s; zero without the option `inflow`.
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
    inflow: Array

    @property
    def pitch(self) -> Array:
        """Pitch at 0.75 R by swashplate and control system, without what the linkages of the hinges add, rad."""
        return self.collective + self.elastic_pitch

    def broadcast(self, shape: tuple[int, ...]) -> Trim:
        """Return the trim repeated at every point of a batch with more axes.

        Parameters
        ----------
        shape : tuple of int
            Shape of the batch.

        Returns
        -------
        Trim
        """
        return Trim(**{e.name: np.broadcast_to(getattr(self, e.name), shape) for e in fields(self)})


@dataclass(frozen=True)
class Target:
    """The condition that closes the trim: a given collective, or a balance row with the load on one blade.

    Attributes
    ----------
    collective : float, array or None
        rad; None if the trim has to find the collective.
    row : int
        Row of the balance that closes the collective: `TORQUE` or `THRUST`.
    load : float or array
        Load that this row must have on one blade, N m or N.
    windmilling : bool
        Whether the rotor windmills, for messages.
    """

    collective: Any = None
    row: int = TORQUE
    load: Any = 0.0
    windmilling: bool = False

    @property
    def finds_collective(self) -> bool:
        """Whether the collective is an unknown of the trim."""
        return self.collective is None


def trim_target(rotor: Rotor, operation: Operation) -> Target:
    """Return the target of an operation, by C_T = T/(ρπR²(ΩR)²) and C_P = QΩ/(ρπR²(ΩR)³), power put in positive."""
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
    """Return quantities at some of the points; scalars hold at all points."""
    return {name: value[rows] if np.ndim(value) else value for name, value in quantities.items()}


def blade_pitch(quantities: Mapping[str, Any], state: Mapping[str, Any]) -> Any:
    """Return the pitch at 0.75 R, rad: of swashplate and control system, and of the linkages of the blade's hinges."""
    by_flap = quantities["kinematic_pitch_flap_coupling"] * state["coning"]
    by_lag = quantities["kinematic_pitch_lag_coupling"] * state["lag"]
    return state["collective"] + state["elastic_pitch"] - by_flap - by_lag


def has_offset_mass(quantities: Mapping[str, Any]) -> bool:
    """Return whether these are the quantities of a blade with mass beside its pitch axis."""
    return "offset_cosine_moment" in quantities


def with_trim(quantities: Mapping[str, Any], options: Options, state: Mapping[str, Any]) -> dict[str, Any]:
    """Return all quantities of the whole blade at a trim state: pitch, trim integrals and springs are added."""
    found = dict(quantities) | dict(state)
    found["pitch"] = blade_pitch(quantities, state)
    found["structural_pitch"] = found["pitch"] + quantities["structural_pitch_offset"]
    found |= trim_integrals(found)
    if has_offset_mass(found):
        found |= evaluate(offset_mass.trim_integrals, found)._asdict()
    return found | springs(options, found)


def springs(options: Options, quantities: dict[str, Any]) -> dict[str, Any]:
    """Return effective flap and lag stiffness and its change with pitch, as the option `structure` has it."""
    if options.frequencies is not None:
        return _springs_of_frequencies(options.frequencies, quantities)
    found = effective_stiffness(quantities)
    return found | dict.fromkeys(FLAP_LAG, 0.0) if options.structure == "diagonal" else found


def _springs_of_frequencies(frequencies: BladeFrequencies, quantities: dict[str, Any]) -> dict[str, Any]:
    """Return the stiffness that makes the frequencies at their own rotor speed, whatever the rotor speed is now."""
    stated = quantities | frequencies.rotating(quantities["collective"], quantities["airspeed"])
    springs: dict[str, Any] = evaluate(flap_lag_springs.stiffness_of_frequencies, stated)._asdict()
    if frequencies.pitch_coupling == "none":
        return dict.fromkeys(flap_lag_springs.EffectiveStiffness._fields, 0.0) | springs
    turned = _turned_from_collective(quantities)
    return turned | {name: stiffness + turned.get(name, 0.0) for name, stiffness in springs.items()}


def _turned_from_collective(quantities: dict[str, Any]) -> dict[str, Any]:
    """Return what elastic pitch and linkages add to the stiffness of the rotor's own springs, with its derivatives."""
    turned = effective_stiffness(quantities)
    rigid = quantities["collective"] + quantities["structural_pitch_offset"]
    before = effective_stiffness(quantities | {"structural_pitch": rigid})
    return turned | {name: turned[name] - before[name] for name in turned if name.endswith("_stiffness")}
