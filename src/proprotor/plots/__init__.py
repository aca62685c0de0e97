"""Plots that specialists expect: each takes a dataset and, optionally, axes, and returns the axes.

In come results of analyses; out come Matplotlib axes. This room computes nothing but the needs of a picture: limits,
round numbers, and the motion of points in a mode.

    frequency_and_damping campbell root_locus participation mode_shape    a sweep, or one of its modes
    attribution tornado stability_map boundary_against study_results      what moves a mode or a boundary
    envelope            onsets of an envelope over equivalent airspeed and altitude
    gust_spectra time_response modal_comparison    responses, and measured modes beside a model
    margins             margins of control loops over airspeed
    blade_frequencies   a hinged blade beside an elastic one: frequencies over collective and rotor speed
    points              points of a CSV file, with error bars, on plots
    mode_motion         how wing, mast and blades move in a mode, as points in space
    animation           a mode in motion, as a GIF, a page or a film

    accessor            the accessor ``.proprotor`` of datasets: their pictures, tables and files
    canvas              the axes, and the notes beneath them: `rests_on` writes the reservations about a case
    small_print         the block beneath a plot: notes, case and options, doubts
    mode_lines          the lines of the modes of one or several sweeps
    onsets              boundaries along a sweep, which plots mark
    end_labels          names of lines beside the axes
    bars                what plots of bars have in common
    style               the style sheet: sizes, colours, dashes and markers
    line_of_sweep       positions along a sweep in the usual unit
    input_names         short names of inputs
    headless            drawing for a file, without a window

`plot_sweep`, two plots in a figure of their own, returns the figure. This room may import the rooms above it, from
`errors` to `tables`. Matplotlib takes long to import: functions import it when they draw.
"""

from proprotor.plots.attribution import plot_attribution
from proprotor.plots.blade_frequencies import plot_blade_frequencies
from proprotor.plots.boundary_against import plot_boundary_against
from proprotor.plots.campbell import plot_campbell
from proprotor.plots.canvas import rests_on
from proprotor.plots.envelope import plot_envelope
from proprotor.plots.frequency_and_damping import plot_damping, plot_frequency, plot_sweep
from proprotor.plots.gust_spectra import plot_gust_spectra
from proprotor.plots.margins import plot_margins
from proprotor.plots.modal_comparison import plot_mac
from proprotor.plots.mode_shape import plot_mode_shape
from proprotor.plots.participation import plot_participation
from proprotor.plots.root_locus import plot_root_locus
from proprotor.plots.stability_map import plot_stability_map
from proprotor.plots.study_results import plot_distribution, plot_sobol
from proprotor.plots.time_response import plot_time_response
from proprotor.plots.tornado import plot_sensitivity

__all__ = [
    "accessor",
    "animation",
    "headless",
    "input_names",
    "line_of_sweep",
    "mode_motion",
    "plot_attribution",
    "plot_blade_frequencies",
    "plot_boundary_against",
    "plot_campbell",
    "plot_damping",
    "plot_distribution",
    "plot_envelope",
    "plot_frequency",
    "plot_gust_spectra",
    "plot_mac",
    "plot_margins",
    "plot_mode_shape",
    "plot_participation",
    "plot_root_locus",
    "plot_sensitivity",
    "plot_sobol",
    "plot_stability_map",
    "plot_sweep",
    "plot_time_response",
    "rests_on",
    "style",
]
