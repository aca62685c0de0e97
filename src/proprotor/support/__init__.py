"""Support: the structure that carries a rotor, as coordinates with mass, damping, stiffness and motion at the hub.

In: a beam wing, a whole aircraft, or modes or matrices of any finite-element code. Out: `NormalModes`, on which `model`
mounts rotors.
This room imports `errors`, `typing`, `needs`, `files`, `nastran` and, for the names of coordinates, `rotor`.

    normal_modes       coordinates of a support; two-axis pivot; rigid support
    airframe           coordinates of an airframe that carries two rotors
    modal_reduction    lowest modes of a structure, and the structure on these modes
    beam               a chain of beam elements
    beam_wing          a cantilever wing of beam elements with a pylon
    stiffness_factors  factors on the stiffnesses of such a wing, fitted to frequencies
    aircraft_structure half an aircraft: free fuselage, box, wing and pylon
    free_airframe      rigid motions and elastic modes of a free aircraft
    aircraft_airloads  airloads of a free aircraft: wing strips and tails
    wing_aerodynamics  airloads of the wing itself, by strips
    wing_circulation   lift of the wing apart from all else, so that it may come late
    nastran            modes or a reduced structure from a Nastran run
    universal_modes    modes from a universal file
    universal_file     datasets of such a file
    matrix_files       matrices of any finite-element code
    matlab_file        such matrices in a file of MATLAB
    matlab_level5      variables of such a file
    matrix_market      files of such matrices in the Matrix Market format

All public names of the modules `aircraft_airloads`, `aircraft_structure`, `beam`, `beam_wing`, `free_airframe`,
`matlab_file`, `matrix_files`, `nastran`, `stiffness_factors`, `universal_modes` and
`wing_aerodynamics` belong to the face.
"""

from proprotor.support.airframe import SYMMETRIES, Airframe
from proprotor.support.modal_reduction import StructuralModes, lowest_modes
from proprotor.support.normal_modes import (
    CARRIES,
    HUB_AXES,
    INCLUDES_ROTOR,
    ROTATION,
    SHAFT,
    TRANSLATION,
    NormalModes,
    hub_components,
    rigid_support,
    two_axis_pivot,
)
from proprotor.support.wing_circulation import WingCirculation

__all__ = [
    "CARRIES",
    "HUB_AXES",
    "INCLUDES_ROTOR",
    "ROTATION",
    "SHAFT",
    "SYMMETRIES",
    "TRANSLATION",
    "Airframe",
    "NormalModes",
    "StructuralModes",
    "WingCirculation",
    "aircraft_airloads",
    "aircraft_structure",
    "beam",
    "beam_wing",
    "free_airframe",
    "hub_components",
    "lowest_modes",
    "matlab_file",
    "matrix_files",
    "nastran",
    "rigid_support",
    "stiffness_factors",
    "two_axis_pivot",
    "universal_modes",
    "wing_aerodynamics",
]
