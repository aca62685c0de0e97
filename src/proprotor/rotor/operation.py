"""Operation of a rotor: its speed, the air, and the target of its trim."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from proprotor.errors import InputError, check_finite, check_known, unknown_name

_TRIM_TARGETS = ("collective", "thrust_coefficient", "power_coefficient")


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
        A windmilling rotor finds the collective at which its torque vanishes. {"collective": rad} gives the collective;
        {"thrust_coefficient": C_T} and {"power_coefficient": C_P} find the collective, with C_T = T/(ρπR²(ΩR)²) and
        C_P = P/(ρπR²(ΩR)³), power put into the rotor positive.

    Raises
    ------
    InputError
        When a value is not finite or out of range, or the trim is unknown.
    """

    rotor_speed: float
    density: float
    speed_of_sound: float
    trim: str | Mapping[str, float] = "windmill"

    def __post_init__(self) -> None:
        for name in ("rotor_speed", "density", "speed_of_sound"):
            check_finite(name, getattr(self, name), "not negative" if name == "density" else "above zero")
        self._check_trim()

    def _check_trim(self) -> None:
        """Refuse a trim that is neither "windmill" nor one target with a finite value."""
        if self.windmilling:
            return
        if isinstance(self.trim, str):
            raise InputError("trim", self.trim, unknown_name(self.trim, ("windmill", *_TRIM_TARGETS), "trim"))
        if not isinstance(self.trim, Mapping) or len(self.trim) != 1:
            rule = 'must be "windmill" or one target such as {"collective": 0.6}'
            raise InputError("trim", self.trim, rule)
        (name, value), *_ = self.trim.items()
        check_known("trim", name, _TRIM_TARGETS, "trim")
        check_finite(f"trim.{name}", value)
        object.__setattr__(self, "trim", dict(self.trim))  # a copy, which nobody else writes to

    @property
    def windmilling(self) -> bool:
        """Whether the trim finds the collective at which the torque vanishes."""
        return self.trim == "windmill"
