"""Frequency and damping of a sweep over airspeed, or over one input."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.model import stamp
from proprotor.model.doubts import MARK
from proprotor.plots.canvas import RIGHT, add_footer, along, axes_or_new, grid, say_origin
from proprotor.plots.end_labels import label_ends, name_those_outside
from proprotor.plots.line_of_sweep import Positions, positions, with_gaps
from proprotor.plots.style import LABEL_SIZE, UNSTABLE, along_airspeed, mode_styles
from proprotor.tables.sweep_summary import damped_frequency, damping_percent, leaps, unstable_ranges
from proprotor.typing import Array

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D


def plot_frequency(
    sweep: xarray.Dataset,
    ax: Axes | None = None,
    *,
    rotor_speed: ArrayLike | None = None,
    unit: str | None = None,
    limits: tuple[float, float] | None = None,
) -> Axes:
    """Draw the frequency |Im s| of each mode.

    Parameters
    ----------
    sweep : xarray.Dataset
        Of `Case.sweep`, along airspeeds or one input.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default. Labels stand to its right.
    rotor_speed : float or array (points,), optional
        rad/s. Frequencies are then per revolution, and in Hz without it.
    unit : str, optional
        Unit of the axis of airspeed, "kt" by default, or of the input.
    limits : (float, float), optional
        Of the frequency axis; 0 to 5 per revolution by default. Modes that leave it are named above the axes.

    Returns
    -------
    matplotlib.axes.Axes
        The one given, or the new one.

    Raises
    ------
    InputError
        When the unit is not one of speed, or of the input.
    """
    line = positions(sweep, unit)
    ax = axes_or_new(ax, labels_beside=True)
    _draw_frequency(ax, sweep, line, rotor_speed, limits)
    say_origin(ax, sweep.attrs, along(sweep, line))
    return ax


def _draw_frequency(
    ax: Axes,
    sweep: xarray.Dataset,
    line: Positions,
    rotor_speed: ArrayLike | None,
    limits: tuple[float, float] | None = None,
) -> None:
    per = 2 * np.pi if rotor_speed is None else np.asarray(rotor_speed)[..., None]
    lines = _draw_modes(ax, sweep, damped_frequency(sweep) / per, line)
    ax.set_ylim(*(limits or (0, None if rotor_speed is None else 5)))
    ax.set_ylabel(f"Frequency |Im s| ({'Hz' if rotor_speed is None else 'per rev'})")
    label_ends(ax, lines)
    name_those_outside(ax, lines, _where(line))


def plot_damping(
    sweep: xarray.Dataset,
    ax: Axes | None = None,
    *,
    unit: str | None = None,
    limits: tuple[float, float] = (-5, 20),
) -> Axes:
    """Draw the damping ratio -Re s/|s| of each mode in percent of critical, negative where it is unstable.

    Parameters
    ----------
    sweep : xarray.Dataset
        Of `Case.sweep`, along airspeeds or one input.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default. Labels stand to its right.
    unit : str, optional
        Unit of the axis of airspeed, "kt" by default, or of the input.
    limits : (float, float)
        Of the damping axis, in percent; modes that leave it are named above the axes.

    Returns
    -------
    matplotlib.axes.Axes
        The one given, or the new one.

    Raises
    ------
    InputError
        When the unit is not one of speed, or of the input.
    """
    line = positions(sweep, unit)
    ax = axes_or_new(ax, labels_beside=True)
    _draw_damping(ax, sweep, line, limits)
    say_origin(ax, sweep.attrs, along(sweep, line))
    return ax


def _draw_damping(ax: Axes, sweep: xarray.Dataset, line: Positions, limits: tuple[float, float]) -> None:
    lines = _draw_modes(ax, sweep, damping_percent(sweep), line)
    ax.set_ylim(*limits)
    _mark_instability(ax, sweep, line)
    ax.set_ylabel("Damping −Re s/|s| (% of critical)")
    label_ends(ax, lines)
    name_those_outside(ax, lines, _where(line))


def plot_sweep(
    sweep: xarray.Dataset,
    *,
    rotor_speed: ArrayLike | None = None,
    unit: str | None = None,
    damping_limits: tuple[float, float] = (-5, 20),
    title: str = "",
    footer: str = "",
) -> Figure:
    """Draw frequency above damping in a figure of their own.

    Parameters
    ----------
    sweep : xarray.Dataset
        Of `Case.sweep`.
    rotor_speed : float or array (points,), optional
        rad/s, as for `plot_frequency`.
    unit : str, optional
        In which airspeeds are shown, as for `plot_frequency`.
    damping_limits : (float, float)
        As for `plot_damping`, percent of critical.
    title, footer : str
        Above and below; the footer is the place for what the numbers rest on.

    Returns
    -------
    matplotlib.figure.Figure
    """
    import matplotlib.pyplot as plt

    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(8, 9))
    figure.subplots_adjust(left=0.09, right=RIGHT, top=0.94, bottom=0.06, hspace=0.14)
    line = positions(sweep, unit)
    told = f"Broad lines: modes of the support, and modes that become unstable. {_gaps_told(sweep)}".strip()
    origin = (stamp.line(sweep.attrs), *(f"{MARK} {doubt}" for doubt in along(sweep, line)))
    add_footer(figure, " ".join(filter(None, (told, footer, *origin))))
    _draw_frequency(above, sweep, line, rotor_speed)
    _draw_damping(below, sweep, line, damping_limits)
    above.set_xlabel("")
    figure.suptitle(title, x=0.09, ha="left", fontsize=11, parse_math=False)
    return figure


def _draw_modes(ax: Axes, sweep: xarray.Dataset, values: Array, line: Positions) -> list[Line2D]:
    spacing, gaps = max(1, len(line.values) // 7), leaps(sweep)
    lines: list[Line2D] = []
    for place, (mode, style) in enumerate(zip(sweep.mode.values.tolist(), mode_styles(sweep), strict=True)):
        more: dict[str, Any] = {"markevery": (3 * place % spacing, spacing), "markersize": 5}
        x, y = with_gaps(gaps[:, place], line.values, values[:, place])
        lines += ax.plot(x, y, label=mode, **more, **style._asdict())
    mark_failed(ax, line.values[sweep.reason.values != ""], line.label)
    ax.margins(x=0)
    grid(ax)
    return lines


def mark_failed(ax: Axes, failed: Array, label: str) -> None:
    """Crosses on the axis at points that could not be analysed, which its label then says."""
    on_the_axis: dict[str, Any] = {"transform": ax.get_xaxis_transform(), "clip_on": False}
    ax.plot(failed, np.zeros(len(failed)), "x", color="0.4", **on_the_axis)
    ax.set_xlabel(label + (", x where it could not be analysed" if len(failed) else ""))


def _mark_instability(ax: Axes, sweep: xarray.Dataset, line: Positions) -> None:
    """Shade negative damping, and put a circle where a mode becomes, or ceases to be, unstable."""
    ax.axhspan(min(ax.get_ylim()[0], 0), 0, color=UNSTABLE, linewidth=0, zorder=0.5)
    ax.axhline(0, color="black", linewidth=0.8)
    places: list[float] = []
    for found in unstable_ranges(along_airspeed(sweep)):
        places += [] if found.open_start else [found.start]
        places += [] if found.open_stop else [found.stop]
    style: dict[str, Any] = {"markerfacecolor": "white", "markeredgecolor": "black", "zorder": 3}
    ax.plot(np.array(places) / line.factor, np.zeros(len(places)), "o", **style)
    told = "unstable" + ("; circles: boundaries, interpolated" if places else "")
    ax.text(0.01, 0.015, told, transform=ax.transAxes, fontsize=LABEL_SIZE, color="0.3")


def _gaps_told(sweep: xarray.Dataset) -> str:
    return "Where a line is broken its motion passes to another root. " if leaps(sweep).any() else ""


def _where(line: Positions) -> str:
    return "at some airspeeds or all" if line.name == "airspeed" else "at some points or all"
