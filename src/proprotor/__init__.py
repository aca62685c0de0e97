"""Whirl-flutter stability of gimballed tiltrotors, with equations derived from first principles.

`import proprotor as pp` offers the names in ``__all__``. Data flow down this list of rooms, and a room imports the rooms
above it only; docs/architecture.md says more, and the docstring of each room is its map.

    errors typing needs units datum files   the ground: messages, types, packages and memory, SI, numbers, files
    rotor       a rotor trimmed in its air: section loads, operation, options, the trim
    support     the structure that carries a rotor: normal modes, beam wing, files of other programs
    model       M, C, K, B of a rotor, of a support, and of both; the stamp that every result has
    deck        text to configuration and back
    stability   modes, their names, sweeps, flutter boundaries, sensitivities, stability maps
    case        a configuration with the analyses as methods
    study       many designs: sampling, workers, uncertainty
    exchange    other programs: netCDF, MATLAB, OpenMDAO
    tables plots     numbers and pictures of a result
    report explore   pages: a report of a case, a page with sliders
    commands    the command line
"""

from proprotor.case import Case, list_cases, load_case
from proprotor.deck.vary import design_inputs
from proprotor.errors import InputError
from proprotor.exchange.matlab import save_matlab
from proprotor.exchange.netcdf import load_results, save_results
from proprotor.model.linear_model import LinearModel
from proprotor.model.mount import mount
from proprotor.model.rigid_propeller import WhirlDerivatives, rigid_propeller
from proprotor.model.rotor_model import rotor_model
from proprotor.model.several_rotors import mount_rotors
from proprotor.model.structural_damping import neutral_damping
from proprotor.rotor.airfoil import Airfoil
from proprotor.rotor.airfoil_table import AirfoilTable
from proprotor.rotor.atmosphere import standard_air
from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.rotor.drive_train import DriveTrain
from proprotor.rotor.generated import EquationSet
from proprotor.rotor.operation import Operation
from proprotor.rotor.rotor import Rotor
from proprotor.stability.branches import by_branch
from proprotor.stability.frequency_response import frequency_response
from proprotor.study import sampling
from proprotor.study.study import study
from proprotor.study.uncertainty import distribution, share_below, sobol_indices
from proprotor.support.beam_wing import Pylon, Wing, beam_wing
from proprotor.support.normal_modes import NormalModes, rigid_support, two_axis_pivot

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
