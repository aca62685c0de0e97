"""The names that `import proprotor as pp` offers; the package imports this module where a name is first used.

Datasets get the accessor ``.proprotor`` (`proprotor.plots.accessor`) once xarray is imported, by whomever: xarray takes
longer to import than many an analysis. The accessor itself is imported where a dataset is first asked for it.
"""

import sys
from importlib import import_module, util
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

from proprotor.calibration.calibrate import calibrate
from proprotor.calibration.calibrated_deck import calibrated_deck
from proprotor.calibration.modal_comparison import compare_modes
from proprotor.case import Case, list_cases, load_case
from proprotor.control.control_law import ControlLaw
from proprotor.control.control_loop import ControlLoop
from proprotor.deck.vary import design_inputs
from proprotor.errors import InputError
from proprotor.exchange.dmig import save_dmig
from proprotor.exchange.matlab import save_matlab
from proprotor.exchange.netcdf import load_results, save_results
from proprotor.explore.notebook import explore
from proprotor.model.linear_model import LinearModel
from proprotor.model.mount import mount
from proprotor.model.rigid_propeller import WhirlDerivatives, rigid_propeller
from proprotor.model.rotor_model import rotor_model
from proprotor.model.several_rotors import mount_rotors
from proprotor.model.structural_damping import neutral_damping
from proprotor.records.identify import identify
from proprotor.records.record import Record, read_record
from proprotor.responses.design_gusts import design_gust, design_turbulence
from proprotor.responses.discrete_gust import discrete_gust
from proprotor.responses.gust_response import gust_response
from proprotor.responses.time_response import time_response
from proprotor.responses.turbulence import Turbulence
from proprotor.rotor.airfoil import Airfoil
from proprotor.rotor.airfoil_regions import AirfoilRegions
from proprotor.rotor.airfoil_table import AirfoilTable
from proprotor.rotor.atmosphere import standard_air
from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.rotor.blade_stations import BladeStations
from proprotor.rotor.c81_writer import write_c81
from proprotor.rotor.drive_train import DriveTrain
from proprotor.rotor.generated import EquationSet
from proprotor.rotor.offset_mass import OffsetMass
from proprotor.rotor.operation import Operation
from proprotor.rotor.rotor import Rotor
from proprotor.stability.branches import by_branch
from proprotor.stability.envelope import envelope
from proprotor.stability.frequency_response import frequency_response
from proprotor.stability.growth_constraint import growth_constraint
from proprotor.study import sampling
from proprotor.study.robust_boundary import robust_boundary
from proprotor.study.study import study
from proprotor.study.study_file import save_study
from proprotor.study.uncertainty import distribution, share_below, sobol_indices
from proprotor.support.beam_wing import Pylon, Wing, beam_wing
from proprotor.support.normal_modes import NormalModes, rigid_support, two_axis_pivot
from proprotor.tables.points import read_points

__all__ = [
    "Airfoil",
    "AirfoilRegions",
    "AirfoilTable",
    "BladeFrequencies",
    "BladeStations",
    "Case",
    "ControlLaw",
    "ControlLoop",
    "DriveTrain",
    "EquationSet",
    "InputError",
    "LinearModel",
    "NormalModes",
    "OffsetMass",
    "Operation",
    "Pylon",
    "Record",
    "Rotor",
    "Turbulence",
    "WhirlDerivatives",
    "Wing",
    "beam_wing",
    "by_branch",
    "calibrate",
    "calibrated_deck",
    "compare_modes",
    "design_gust",
    "design_inputs",
    "design_turbulence",
    "discrete_gust",
    "distribution",
    "envelope",
    "explore",
    "frequency_response",
    "growth_constraint",
    "gust_response",
    "identify",
    "list_cases",
    "load_case",
    "load_results",
    "mount",
    "mount_rotors",
    "neutral_damping",
    "read_points",
    "read_record",
    "rigid_propeller",
    "rigid_support",
    "robust_boundary",
    "rotor_model",
    "sampling",
    "save_dmig",
    "save_matlab",
    "save_results",
    "save_study",
    "share_below",
    "sobol_indices",
    "standard_air",
    "study",
    "time_response",
    "two_axis_pivot",
    "write_c81",
]


def _results(dataset: Any) -> Any:
    """Return the accessor of a dataset; the room `plots` is imported here, so that no study imports what only shows."""
    return import_module("proprotor.plots.accessor").Results(dataset)


def _register_accessor() -> None:
    """Give every `xarray.Dataset` the accessor."""
    xarray = sys.modules["xarray"]
    if not hasattr(xarray.Dataset, "proprotor"):
        xarray.register_dataset_accessor("proprotor")(_results)


class _AtImportOfXarray(MetaPathFinder):
    """Registers the accessor at the end of the import of xarray, and finds no module itself."""

    asked = False

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        if name != "xarray" or self.asked:
            return None
        self.asked = True  # whoever finds xarray comes after this finder
        spec = util.find_spec(name)
        if spec is not None and spec.loader is not None:
            execute = spec.loader.exec_module

            def execute_and_register(module: ModuleType) -> None:
                execute(module)
                _register_accessor()

            spec.loader.exec_module = execute_and_register  # type: ignore[method-assign]
        return spec


if "xarray" in sys.modules:
    _register_accessor()
else:
    sys.meta_path.insert(0, _AtImportOfXarray())
