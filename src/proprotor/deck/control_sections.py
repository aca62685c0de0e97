"""The section [control] of a deck: control loops that every model of the case has closed.

A table ``[[control.loops]]`` for each loop has the arguments of `proprotor.control.control_loop.ControlLoop`; a law is
numerator and denominator, or state_space, a table with A, B, C and D.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, model_validator

from proprotor.deck import fields
from proprotor.deck.fields import Section, needed, optional
from proprotor.errors import InputError

_Names = Annotated[list[fields.Text], Field(min_length=1)]


class ControlLoopSection(Section):
    """A control loop: sensors, law, gain, delay and actuator, and the inputs that it moves."""

    name: fields.Name = needed("Name of the loop in all results.")
    sensors: _Names = needed(
        'Displacements, rates and accelerations: "beam", "x acceleration", "gimbal_1c rate", "azimuth rate"; of two '
        'rotors "symmetric x acceleration".'
    )
    inputs: _Names = needed(
        '"collective", "cyclic_1c", "cyclic_1s"; "flaperon" of a wing with one; of two rotors "symmetric collective".'
    )
    weights: fields.Numbers = optional(
        "Weight of each sensor in the one signal of the law, their weighted sum. Each sensor is a signal if left out."
    )
    numerator: fields.Numbers = optional("Coefficients of powers of s of the law, the highest first.")
    denominator: fields.Numbers = optional("Coefficients of powers of s of the law, the highest first.")
    state_space: dict[str, Any] | None = optional(
        "The law as matrices A, B, C and D, lists of rows: from the signals to a command for each input."
    )
    gain: fields.Number = optional(
        "Input in rad per unit of the law's command, in SI units of the sensors; 1 if left out."
    )
    scheduled_at: fields.Airspeeds = optional("Rising true airspeeds at which scheduled_gains holds.")
    scheduled_gains: fields.Numbers = optional(
        "Factor on the gain at each airspeed; smooth between, held beyond."
    )
    actuator_bandwidth: fields.PositiveFrequency = optional(
        "Corner frequency of the actuators; no lag if left out."
    )
    actuator_damping: fields.Positive = optional(
        "Damping ratio of actuators of second order; of first order if left out."
    )
    delay: fields.Time = optional("Delay of the commands; none if left out.")
    delay_order: fields.Size = optional(
        "Order of the Padé approximation of the delay in eigenvalues; 3 if left out."
    )

    @model_validator(mode="after")
    def _one_law(self) -> ControlLoopSection:
        pair = ("numerator", "denominator")
        given = [name for name in pair if getattr(self, name) is not None]
        if self.state_space is not None and given:
            raise InputError(given[0], None, "must not be given with state_space")
        if len(given) == 1:
            missing = next(name for name in pair if name not in given)
            raise InputError(missing, None, f"is missing: {given[0]} is given")
        return self


class ControlSection(Section):
    """Control loops that are closed in every result of the case."""

    loops: Annotated[list[ControlLoopSection], Field(min_length=1)] = needed(
        "Control loops, a `[[control.loops]]` each."
    )
