"""Stability: from the equations of motion of a case to modes, their names, and the boundaries of stability.

In come linear models (`proprotor.model`), or a case that linearises itself at airspeeds and other inputs. Out go
datasets of modes, maps and derivatives, and records of boundaries. The room may import what lies above it: the ground,
`rotor`, `support`, `model` and `deck`.

Modes of one point, or of a batch of points
    modes                   eigenvalues and vectors, the dataset of a model's modes
    real_modes              modes in real numbers, one of each pair; how alike the modes of two points are
    participation           how much each motion takes part in a mode
    root_error              roots as exact as the matrices allow, and their error: what "neutral" means
    mode_names              what moves in a mode, and how it whirls
    named_modes             modes of a case at one airspeed, by name
    frequency_response      response of loads and motions to gusts and swashplate

Modes along a line of points
    parameter_lines         lines of airspeeds or of another input, and the approach from the anchor
    matching, assignment    which mode at one point is which at the next; the assignment with the largest sum
    following               branches: roots followed along a line, steps divided where needed
    branches                labels of branches
    names_and_steps         names of the modes of many lines, and the steps along each
    sweep                   the dataset of a line: modes by name, with the branch of each

Boundaries: where damping passes a level
    points                  points of many lines solved at once, with the growth of each root and its derivative
    steps, screening        steps between points, by vectors or by eigenvalues alone
    parting, root_pairs     where a step is parted; two roots that meet within a step
    cubic                   cubics over a step
    crossings, brackets     the search for steps with crossings; each crossing found by Newton's method
    boundary, boundaries    records of boundaries; the search along a line of a case
    kinds                   divergence, instability of the rigid body, flutter
    floquet                 Floquet exponents about a periodic trim
    flutter                 the flutter point: the lowest onset
    in_notebook             boundaries as HTML, for notebooks
    flutter_messages        records and sentences for people
    map, boundary_lines     the plane of two inputs; its boundary by mode
    boundary_against        boundaries against one input, such as altitude or rotor speed

What a mode comes from and depends on
    eigenvalue_derivatives  change of eigenvalues with the matrices
    sensitivity             derivatives of eigenvalues, damping and flutter speed by inputs
    origins, attribution    matrices by physical origin; what drives and damps a mode
"""

from proprotor.stability import flutter_messages
from proprotor.stability.attribution import attribution
from proprotor.stability.boundaries import boundaries, find_crossings, scan_speeds
from proprotor.stability.boundary import Boundary, Crossings, Failed, instability
from proprotor.stability.boundary_against import boundary_against
from proprotor.stability.boundary_lines import BoundaryLine, boundary_lines
from proprotor.stability.brackets import Brackets, Crossing
from proprotor.stability.branches import BranchLabels, NamedStates, branch_labels, by_branch, named_at
from proprotor.stability.crossings import Search
from proprotor.stability.eigenvalue_derivatives import eigenvalue_change, with_changes
from proprotor.stability.floquet import floquet
from proprotor.stability.flutter import FlutterPoint, boundary_of, flutter_point
from proprotor.stability.following import Branches, follow
from proprotor.stability.frequency_response import frequency_response
from proprotor.stability.kinds import FLUTTER, flies_free, kinds
from proprotor.stability.map import stability_map
from proprotor.stability.matching import NOT_TOLD, Modes, Spectrum, match_modes
from proprotor.stability.mode_names import DOUBTFUL, moving
from proprotor.stability.modes import (
    at_columns,
    coordinate_motion,
    decomposition,
    eigenvalues,
    few_spectra,
    modes,
)
from proprotor.stability.names_and_steps import Steps, Walk, joined, names_and_steps
from proprotor.stability.parameter_lines import ANCHORS, ParameterLine, tip_speed
from proprotor.stability.participation import coordinate_shares
from proprotor.stability.root_error import error_near_zero
from proprotor.stability.sensitivity import at_boundary, damping_rate, sensitivity
from proprotor.stability.sweep import mode_columns, sweep, sweep_case

__all__ = [
    "ANCHORS",
    "DOUBTFUL",
    "FLUTTER",
    "NOT_TOLD",
    "Boundary",
    "BoundaryLine",
    "Brackets",
    "BranchLabels",
    "Branches",
    "Crossing",
    "Crossings",
    "Failed",
    "FlutterPoint",
    "Modes",
    "NamedStates",
    "ParameterLine",
    "Search",
    "Spectrum",
    "Steps",
    "Walk",
    "at_boundary",
    "at_columns",
    "attribution",
    "boundaries",
    "boundary_against",
    "boundary_lines",
    "boundary_of",
    "branch_labels",
    "by_branch",
    "coordinate_motion",
    "coordinate_shares",
    "damping_rate",
    "decomposition",
    "eigenvalue_change",
    "eigenvalues",
    "error_near_zero",
    "few_spectra",
    "find_crossings",
    "flies_free",
    "floquet",
    "flutter_messages",
    "flutter_point",
    "follow",
    "frequency_response",
    "instability",
    "joined",
    "kinds",
    "match_modes",
    "mode_columns",
    "modes",
    "moving",
    "named_at",
    "names_and_steps",
    "scan_speeds",
    "sensitivity",
    "stability_map",
    "sweep",
    "sweep_case",
    "tip_speed",
    "with_changes",
]
