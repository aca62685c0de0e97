"""Engine and shaft on the rotor's azimuth."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from proprotor.errors import InputError, check_number


@dataclass(frozen=True, kw_only=True)
class DriveTrain:
    """Inertia, damping and shaft stiffness to an end that turns at constant speed, all referred to the rotor's speed.

    Any of them may be an array that broadcasts with the airspeeds, for many designs at once.

    Parameters
    ----------
    drive_inertia : float
        What turns with the rotor besides the blades, kg m².
    drive_damping : float
        Torque per change of rotor speed, N m s/rad.
    shaft_stiffness : float
        Torque per azimuth, N m/rad; 0 leaves the rotor free to find its speed.

    Raises
    ------
    InputError
        When a value is negative or not finite.
    """

    drive_inertia: float = 0.0
    drive_damping: float = 0.0
    shaft_stiffness: float = 0.0

    def __post_init__(self) -> None:
        for entry in fields(self):
            value = getattr(self, entry.name)
            check_number(entry.name, value)
            if not np.all(np.isfinite(value)):
                raise InputError(entry.name, value, "must be finite")
            if np.any(np.real(value) < 0):
                raise InputError(entry.name, value, "must not be negative")
