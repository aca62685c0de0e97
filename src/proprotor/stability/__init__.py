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
    transfer                transfer of inputs to outputs at a frequency; their names and units
    frequency_response      response of loads and motions to gusts and swashplate
    loop_transfer           the transfer function of a control loop, cut at its actuator
    margin_search           gain, phase, delay and disk margin of a transfer function
    margins                 margins of the control loops of a case along airspeeds
    margin_ranges           the airspeeds over which loops keep the margins that are needed

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
    boundary_search         boundaries along many lines of airspeeds at once, a line for each design
    boundary_against        boundaries against one input, such as altitude or rotor speed
    envelope_speeds         V_D and M_D at altitude, and the speeds up to which there must be no flutter
    envelope_dataset        the dataset of an envelope, its limits and its worst case
    envelope                onsets and damping of all conditions of a deck against these speeds

What a mode comes from and depends on
    eigenvalue_derivatives  change of eigenvalues with the matrices
    sensitivity             derivatives of eigenvalues, damping and flutter speed by inputs
    growth_constraint       one number for optimisers, at or below zero where all roots are damped enough
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
from proprotor.stability.envelope import envelope
from proprotor.stability.envelope_dataset import MET, NOT_KNOWN, NOT_MET, with_worst
from proprotor.stability.floquet import floquet
from proprotor.stability.flutter import FlutterPoint, boundary_of, flutter_point
from proprotor.stability.following import Branches, follow
from proprotor.stability.frequency_response import frequency_response
from proprotor.stability.growth_constraint import SHARPNESS, growth_constraint
from proprotor.stability.kinds import FLUTTER, flies_free, kinds
from proprotor.stability.map import largest_growth, stability_map
from proprotor.stability.margin_ranges import Kept, Needed, decibels, kept_ranges
from proprotor.stability.margins import margins
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
from proprotor.stability.named_modes import named_modes
from proprotor.stability.names_and_steps import Steps, Walk, joined, names_and_steps
from proprotor.stability.parameter_lines import AIRSPEED, ANCHORS, ParameterLine, models_at, tip_speed
from proprotor.stability.participation import coordinate_shares
from proprotor.stability.root_error import error_near_zero
from proprotor.stability.sensitivity import at_boundary, damping_rate, eigenvalue_rates, sensitivity
from proprotor.stability.sweep import mode_columns, sweep, sweep_case
from proprotor.stability.transfer import (
    System,
    decays_everywhere,
    frequencies_in_si,
    places_of,
    system_at,
    transfer,
    unit_of_input,
    unit_of_output,
)

__all__ = [
    "AIRSPEED",
    "ANCHORS",
    "DOUBTFUL",
    "FLUTTER",
    "MET",
    "NOT_KNOWN",
    "NOT_MET",
    "NOT_TOLD",
    "SHARPNESS",
    "Boundary",
    "BoundaryLine",
    "Brackets",
    "BranchLabels",
    "Branches",
    "Crossing",
    "Crossings",
    "Failed",
    "FlutterPoint",
    "Kept",
    "Modes",
    "NamedStates",
    "Needed",
    "ParameterLine",
    "Search",
    "Spectrum",
    "Steps",
    "System",
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
    "decays_everywhere",
    "decibels",
    "decomposition",
    "eigenvalue_change",
    "eigenvalue_rates",
    "eigenvalues",
    "envelope",
    "error_near_zero",
    "few_spectra",
    "find_crossings",
    "flies_free",
    "floquet",
    "flutter_messages",
    "flutter_point",
    "follow",
    "frequencies_in_si",
    "frequency_response",
    "growth_constraint",
    "instability",
    "joined",
    "kept_ranges",
    "kinds",
    "largest_growth",
    "margins",
    "match_modes",
    "mode_columns",
    "models_at",
    "modes",
    "moving",
    "named_at",
    "named_modes",
    "names_and_steps",
    "places_of",
    "scan_speeds",
    "sensitivity",
    "stability_map",
    "sweep",
    "sweep_case",
    "system_at",
    "tip_speed",
    "transfer",
    "unit_of_input",
    "unit_of_output",
    "with_changes",
    "with_worst",
]
