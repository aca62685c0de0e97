"""Whirl-flutter stability of gimballed tiltrotors, with equations derived from first principles."""

from proprotor import sampling
from proprotor.airfoil import Airfoil
from proprotor.airfoil_table import AirfoilTable
from proprotor.assembly import mount
from proprotor.atmosphere import standard_air
from proprotor.beam_wing import Pylon, Wing, beam_wing
from proprotor.branches import by_branch
from proprotor.case import Case, list_cases, load_case
from proprotor.design import design_inputs
from proprotor.drive_train import DriveTrain
from proprotor.equation_set import EquationSet
from proprotor.errors import InputError
from proprotor.frequencies import BladeFrequencies
from proprotor.frequency_response import frequency_response
from proprotor.matlab_file import save_matlab
from proprotor.model import LinearModel, rotor_model
from proprotor.operation import Operation
from proprotor.results_file import load_results, save_results
from proprotor.rigid_propeller import WhirlDerivatives, rigid_propeller
from proprotor.rotor import Rotor
from proprotor.several_rotors import mount_rotors
from proprotor.structural_damping import neutral_damping
from proprotor.study import study
from proprotor.support import NormalModes, rigid_support, two_axis_pivot
from proprotor.uncertainty import distribution, share_below, sobol_indices

__all__ = [
    "Airfoil",
    "AirfoilTable",
    "BladeFrequencies",
    "Case",
    "DriveTrain",
    "EquationSet",
    "InputError",
    "LinearModel",
    "NormalModes",
    "Operation",
    "Pylon",
    "Rotor",
    "WhirlDerivatives",
    "Wing",
    "beam_wing",
    "by_branch",
    "design_inputs",
    "distribution",
    "frequency_response",
    "list_cases",
    "load_case",
    "load_results",
    "mount",
    "mount_rotors",
    "neutral_damping",
    "rigid_propeller",
    "rigid_support",
    "rotor_model",
    "sampling",
    "save_matlab",
    "save_results",
    "share_below",
    "sobol_indices",
    "standard_air",
    "study",
    "two_axis_pivot",
]
