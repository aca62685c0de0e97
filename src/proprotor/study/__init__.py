"""Studies of many designs.

In come a case and a plan of how its inputs vary; out come datasets over the designs and airspeeds, and the summaries of
such a dataset: distributions, shares of the variance, the damping of modes.

==================  ====================================================================================
study               `study`: from a case and a plan to a dataset, on all cores or a cluster
sampling            plans: grids, lists, Latin hypercubes, Sobol and Saltelli samples
input_ranges        what an input may be: values, or a distribution of values, read into SI
designs             a plan, and the designs that it gives with the numbers of a deck
request             the request that a study answers: its arguments, read and checked
description         what a study was asked, as plain data in the attributes of its results
study_file          files of studies: `save_study`, and the arguments of a study to repeat
division            how many points a batch has, so that all batches at work fit into memory
variables           the quantities of a study, their variables, and empty arrays for these
backend             what computes a study: NumPy or compiled functions, the same from the first batch to the last
batch               the analysis of one batch, with a reason for each design or point that fails
roots               eigenvalues of a batch, mode shapes, the least stable mode
followed_modes      modes of a batch, followed along the airspeeds of each design
censoring           what is known of flutter speeds beyond the airspeeds of a study: limits
flutter_speeds      the flutter speed of each design of a batch
workers             who analyses the batches: this process, other processes or a cluster
worker              what a worker process does
checkpoint          finished batches in a folder, from which a study that was killed goes on
progress            the progress bar
uncertainty         percentiles and Sobol indices of a result over a sample
box                 a box of inputs, each between two limits
box_search          the search of a box: designs in batches, then descents along derivatives
robust_boundary     the worst flutter speed of a box of inputs
damping             damping of a mode of the support along the airspeeds
==================  ====================================================================================

May import the engine, `deck`, `stability` and `case`.
"""

from proprotor.study import sampling
from proprotor.study.damping import mode_damping
from proprotor.study.designs import AIRSPEED
from proprotor.study.robust_boundary import robust_boundary
from proprotor.study.study import study
from proprotor.study.study_file import is_study_file, read_study, repeated, save_study
from proprotor.study.uncertainty import distribution, share_below, sobol_indices
from proprotor.study.variables import DEFAULT_QUANTITIES, STABLE, UNSTABLE

__all__ = [
    "AIRSPEED",
    "DEFAULT_QUANTITIES",
    "STABLE",
    "UNSTABLE",
    "distribution",
    "is_study_file",
    "mode_damping",
    "read_study",
    "repeated",
    "robust_boundary",
    "sampling",
    "save_study",
    "share_below",
    "sobol_indices",
    "study",
]
