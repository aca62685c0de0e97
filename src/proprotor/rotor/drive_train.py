"""Drive train: inertia, damping and stiffness of engine and shafts, which act on the rotor's azimuth."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from proprotor.errors import InputError, check_finite

_MAST = "mast_stiffness"


@dataclass(frozen=True, kw_only=True)
class DriveTrain:
    """Inertia, damping and stiffness of engine, gearbox and shafts, all referred to the rotor's speed.

    The mast stands between the rotor with what is fixed to the rotor, `drive_inertia` and `drive_damping`, and the
    gearbox with the engine. The shaft to an end of constant speed and the interconnect shaft start at the gearbox.
    Each value may be an array that broadcasts with the airspeeds, for many designs at once.

    Parameters
    ----------
    drive_inertia : float
        Inertia of the parts that turn with the rotor, without the blades, kg m².
    drive_damping : float
        Torque per change of rotor speed, N m s/rad.
    shaft_stiffness : float
        Torque per azimuth, N m/rad, to an end that turns at constant speed; 0 leaves the rotor free to find its speed.
    mast_stiffness : float, optional
        Torque per twist of the mast, N m/rad; None for a rigid mast. With a mast that twists, the twist is the
        coordinate "mast twist": azimuth of the gearbox less that of the rotor.
    engine_inertia : float
        Inertia of gearbox and engine, kg m²; above zero with a mast that twists.
    engine_damping : float
        Torque per change of the speed of gearbox and engine, N m s/rad.
    interconnect_stiffness : float
        Of an aircraft with two rotors: torque of the interconnect shaft per difference of the azimuths of both
        gearboxes, N m/rad. The shaft is strained by antisymmetric motion alone.

    Raises
    ------
    InputError
        When a value is negative or not finite, or a mast that twists has no inertia at its end.
    """

    drive_inertia: float = 0.0
    drive_damping: float = 0.0
    shaft_stiffness: float = 0.0
    mast_stiffness: float | None = None
    engine_inertia: float = 0.0
    engine_damping: float = 0.0
    interconnect_stiffness: float = 0.0

    def __post_init__(self) -> None:
        for entry in fields(self):
            value = getattr(self, entry.name)
            if entry.name == _MAST and value is None:
                continue
            check_finite(entry.name, value, "above zero" if entry.name == _MAST else "not negative")
        if self.mast_stiffness is not None and np.any(np.real(self.engine_inertia) <= 0):
            raise InputError("engine_inertia", self.engine_inertia, f"must be above zero with a {_MAST}")

    @property
    def at_rotor(self) -> dict[str, Any]:
        """Inertia, damping and shaft stiffness on the rotor's own azimuth; a rigid mast adds those of the engine."""
        if self.mast_stiffness is not None:
            return {
                "drive_inertia": self.drive_inertia,
                "drive_damping": self.drive_damping,
                "shaft_stiffness": 0.0,
            }
        return {
            "drive_inertia": self.drive_inertia + self.engine_inertia,
            "drive_damping": self.drive_damping + self.engine_damping,
            "shaft_stiffness": self.shaft_stiffness,
        }

    @property
    def at_engine(self) -> dict[str, Any]:
        """Inertia, damping and shaft stiffness on the azimuth of the gearbox, by the same names."""
        return {
            "drive_inertia": self.engine_inertia,
            "drive_damping": self.engine_damping,
            "shaft_stiffness": self.shaft_stiffness,
        }
