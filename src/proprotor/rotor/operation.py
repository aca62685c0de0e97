"""How the rotor is run: speed, air, and what it is trimmed to."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from proprotor.errors import InputError, check_number, unknown_name

TRIM_TARGETS = ("collective", "thrust_coefficient", "power_coefficient")


@dataclass(frozen=True, kw_only=True)
class Operation:
    """Rotor speed, air and trim.

    Parameters
    ----------
    rotor_speed : float
        Ω, rad/s, above zero.
    density : float
        kg/m³, not negative; 0 is a vacuum.
    speed_of_sound : float
        m/s, above zero.
    trim : "windmill" or a mapping with one target
        A windmilling rotor finds the collective at which its torque vanishes. {"collective": rad} gives it;
        {"thrust_coefficient": C_T} and {"power_coefficient": C_P} find it, with C_T = T/(ρπR²(ΩR)²) and
        C_P = P/(ρπR²(ΩR)³), power put into the rotor positive.

    Raises
    ------
    InputError
        When a value is not finite or out of its range, or the trim is unknown.
    """

    rotor_speed: float
    density: float
    speed_of_sound: float
    trim: str | Mapping[str, float] = "windmill"

    def __post_init__(self) -> None:
        for name in ("rotor_speed", "density", "speed_of_sound"):
            check_number(name, getattr(self, name))
            value = np.real(getattr(self, name))
            if not np.all(np.isfinite(value)):
                raise InputError(name, getattr(self, name), "must be finite")
            if np.any(value < 0) or (name != "density" and np.any(value == 0)):
                rule = "must not be negative" if name == "density" else "must be above zero"
                raise InputError(name, getattr(self, name), rule)
        if isinstance(self.trim, str):
            if self.trim != "windmill":
                raise InputError(
                    "trim", self.trim, unknown_name(self.trim, ("windmill", *TRIM_TARGETS), "trim")
                )
        elif not isinstance(self.trim, Mapping) or len(self.trim) != 1:
            raise InputError(
                "trim", self.trim, 'must be "windmill" or one target such as {"collective": 0.6}'
            )
        else:
            (name, value), *_ = self.trim.items()
            if name not in TRIM_TARGETS:
                raise InputError("trim", name, unknown_name(name, TRIM_TARGETS, "trim"))
            if not np.all(np.isfinite(np.real(value))):
                raise InputError(f"trim.{name}", value, "must be finite")

    @property
    def windmilling(self) -> bool:
        """Whether the collective follows from zero torque."""
        return self.trim == "windmill"
