"""Whirl-flutter stability of gimballed tiltrotors, with equations derived from first principles."""

from proprotor import sampling
from proprotor.airfoil import Airfoil
from proprotor.airfoil_table import AirfoilTable
from proprotor.assembly import mount
from proprotor.case import Case, list_cases, load_case
from proprotor.design import design_inputs
from proprotor.drive_train import DriveTrain
from proprotor.errors import InputError
from proprotor.frequencies import BladeFrequencies
from proprotor.model import LinearModel, rotor_model
from proprotor.operation import Operation
from proprotor.results_file import load_results, save_results
from proprotor.rigid_propeller import WhirlDerivatives, rigid_propeller
from proprotor.rotor import Rotor
from proprotor.structural_damping import neutral_damping
from proprotor.study import study
from proprotor.support import NormalModes, two_axis_pivot
from proprotor.uncertainty import distribution, share_below, sobol_indices

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
    "WhirlDerivatives",
    "design_inputs",
    "distribution",
    "list_cases",
    "load_case",
    "load_results",
    "mount",
    "neutral_damping",
    "rigid_propeller",
    "rotor_model",
    "sampling",
    "save_results",
    "share_below",
    "sobol_indices",
    "study",
    "two_axis_pivot",
]
