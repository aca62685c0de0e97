"""Plots that specialists expect: each takes a dataset and, if wanted, axes, and returns the axes.

`plot_sweep`, two plots in a figure of their own, returns the figure. `rests_on` writes beneath a plot what its numbers
rest on. `proprotor.plots.animation` moves a mode.
"""

from proprotor.plots.attribution import plot_attribution
from proprotor.plots.campbell import plot_campbell
from proprotor.plots.canvas import rests_on
from proprotor.plots.frequency_and_damping import plot_damping, plot_frequency, plot_sweep
from proprotor.plots.mode_shape import plot_mode_shape
from proprotor.plots.participation import plot_participation
from proprotor.plots.root_locus import plot_root_locus
from proprotor.plots.stability_map import plot_stability_map
from proprotor.plots.study_results import plot_distribution, plot_sobol
from proprotor.plots.tornado import plot_sensitivity

__all__ = [
    "plot_attribution",
    "plot_campbell",
    "plot_damping",
    "plot_distribution",
    "plot_frequency",
    "plot_mode_shape",
    "plot_participation",
    "plot_root_locus",
    "plot_sensitivity",
    "plot_sobol",
    "plot_stability_map",
    "plot_sweep",
    "rests_on",
]
