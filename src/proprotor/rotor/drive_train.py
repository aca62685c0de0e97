"""Drive train: inertia, damping and shaft stiffness of engine and shaft, which act on the rotor's azimuth."""

from __future__ import annotations

from dataclasses import dataclass, fields

from proprotor.errors import check_finite


@dataclass(frozen=True, kw_only=True)
class DriveTrain:
    """Inertia, damping and shaft stiffness to an end that turns at constant speed, all referred to the rotor's speed.

    Each value may be an array that broadcasts with the airspeeds, for many designs at once.

    Parameters
    ----------
    drive_inertia : float
        Inertia of the parts that turn with the rotor, without the blades, kg m².
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
            check_finite(entry.name, getattr(self, entry.name), "not negative")
