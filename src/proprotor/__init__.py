"""Whirl-flutter stability of gimballed tiltrotors, with equations derived from first principles."""

from proprotor.airfoil import Airfoil
from proprotor.airfoil_table import AirfoilTable
from proprotor.case import Case, list_cases, load_case
from proprotor.drive_train import DriveTrain
from proprotor.errors import InputError
from proprotor.frequencies import BladeFrequencies
from proprotor.model import LinearModel, rotor_model
from proprotor.operation import Operation
from proprotor.rotor import Rotor
from proprotor.support import NormalModes

__all__ = [
    "Airfoil",
    "AirfoilTable",
    "BladeFrequencies",
    "Case",
    "DriveTrain",
    "InputError",
    "LinearModel",
    "NormalModes",
    "Operation",
    "Rotor",
    "list_cases",
    "load_case",
    "rotor_model",
]
