"""The sections [envelope] and [variants.NAME] of a deck: speeds to be free of flutter, and the deck's conditions."""

from __future__ import annotations

from typing import Any, Literal

from pydantic import model_validator

from proprotor.deck import fields
from proprotor.deck.fields import Section, needed, optional
from proprotor.errors import InputError

FAILURE = "failure"


class EnvelopeSection(Section):
    """Speeds and altitudes in which the aircraft must be free of flutter, and what varies within."""

    dive_speed: fields.EquivalentSpeed = needed("Design dive speed V_D, an equivalent airspeed.")
    dive_mach: fields.Positive = optional("Design dive Mach number M_D, which limits V_D at altitude.")
    altitudes: fields.Altitudes = needed(
        "Pressure altitudes, rising, -610 m to 32 km; that at which V_D meets M_D is added."
    )
    speed_factor: fields.Positive = optional(
        "Factor on V_D and M_D up to which normal conditions must be free of flutter; 1.15 if left out "
        "(CS and 14 CFR 25.629(b)(1)), 1.2 for 14 CFR 23.629(c). Limited to Mach 1 where M_D is below 1."
    )
    failure_speed_factor: fields.Positive = optional(
        "The same of failures; 1 if left out (CS and 14 CFR 25.629(b)(2)(i))."
    )
    damping_ratio: fields.DampingRatio = optional(
        "Damping ratio that every mode must have up to V_D and M_D in normal conditions, g/2 of a structural damping "
        "g; 0 if left out."
    )
    temperature_offset: fields.TemperatureDifference = optional(
        "Air temperature above the standard temperature; that of [operation], or none, if left out."
    )
    rotor_speeds: fields.RotorSpeeds = optional("Rotor speeds, rising; that of [operation] if left out.")
    powers: fields.Powers = optional(
        "Shaft powers into each rotor, rising, 0 for a windmilling one; the trim of [operation] if left out."
    )


class VariantSection(Section):
    """A condition of the deck, [variants.NAME]: the fields in which it differs from the deck."""

    condition: Literal["normal", "failure"] = optional(
        "Whether the condition is normal, as another fuel load, or a failure, as a lost spring. In the envelope every "
        "failure is joined with every normal condition.",
        FAILURE,
    )
    rotor: dict[str, Any] | None = optional("Fields of [rotor].")
    operation: dict[str, Any] | None = optional("Fields of [operation].")
    drive_train: dict[str, Any] | None = optional("Fields of [drive_train].")
    support: dict[str, Any] | None = optional("Fields of [support].")
    left: dict[str, Any] | None = optional("Fields of [left].")

    @model_validator(mode="after")
    def _differs(self) -> VariantSection:
        if not self.model_fields_set - {"condition"}:
            raise InputError("", None, "must have a field in which the condition differs from the deck")
        return self
