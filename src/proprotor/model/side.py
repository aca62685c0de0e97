"""The left side of an aircraft where it differs from the right side: another rotor, operation or drive train."""

from __future__ import annotations

from dataclasses import dataclass

from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.rotor.drive_train import DriveTrain
from proprotor.rotor.operation import Operation
from proprotor.rotor.rotor import Rotor


@dataclass(frozen=True, eq=False)
class Side:
    """The whole left side of an aircraft, in the mirrored axes of the left rotor.

    What differs in the structure, such as a downstop that has failed, is part of the airframe:
    `proprotor.support.airframe`. An interconnect shaft belongs to both sides and must be the same on both.

    Parameters
    ----------
    rotor : Rotor
    operation : Operation
        With the rotor speed and density of the right side; the trim may be another one.
    frequencies : BladeFrequencies, optional
        As in `proprotor.model.configuration.Configuration`.
    drive_train : DriveTrain, optional
    """

    rotor: Rotor
    operation: Operation
    frequencies: BladeFrequencies | None = None
    drive_train: DriveTrain | None = None
