"""Frequency and damping of a sweep over airspeed, drawn to be read in print and without colour vision."""

from __future__ import annotations

import textwrap
from itertools import cycle
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import isotonic_regression

from proprotor.sweep_summary import damped_frequency, damping_percent, support_coordinates, unstable_ranges
from proprotor.units import factor_to_si

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

# Okabe and Ito's colours, which colour-blind readers tell apart, less the yellow, too pale on white.
_COLOURS = ("#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
_DASHES = ("-", "--", ":")
_MARKERS = "s^DvP<>"  # for broad lines, which colour alone would not tell apart on a grey print
_LABEL_SIZE = 8  # points
_LINE_SPACING = 1.3


class _Style(NamedTuple):
    color: str
    linestyle: str
    linewidth: float
    marker: str


def plot_frequency(
    sweep: xarray.Dataset,
    ax: Axes | None = None,
    *,
    rotor_speed: ArrayLike | None = None,
    unit: str = "kt",
    limits: tuple[float, float] | None = None,
) -> Axes:
    """Draw the frequency |Im s| of each mode.

    Parameters
    ----------
    sweep : xarray.Dataset
        Of `Case.sweep`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default. Labels stand to its right.
    rotor_speed : float or array (airspeed,), optional
        rad/s. Frequencies are then per revolution, and in Hz without it.
    unit : str
        Unit of the airspeed axis.
    limits : (float, float), optional
        Of the frequency axis; 0 to 5 per revolution by default. Modes that leave it are named above the axes.

    Returns
    -------
    matplotlib.axes.Axes
        The one given, or the new one.

    Raises
    ------
    InputError
        When the unit is not one of speed.
    """
    ax = _axes(ax)
    per = 2 * np.pi if rotor_speed is None else np.asarray(rotor_speed)[..., None]
    lines = _draw_modes(ax, sweep, damped_frequency(sweep) / per, unit)
    ax.set_ylim(*(limits or (0, None if rotor_speed is None else 5)))
    ax.set_ylabel(f"Frequency |Im s| ({'Hz' if rotor_speed is None else 'per rev'})")
    _label(ax, lines)
    _name_those_outside(ax, lines)
    return ax


def plot_damping(
    sweep: xarray.Dataset, ax: Axes | None = None, *, unit: str = "kt", limits: tuple[float, float] = (-5, 20)
) -> Axes:
    """Draw the damping ratio -Re s/|s| of each mode in percent of critical, negative where it is unstable.

    Parameters
    ----------
    sweep : xarray.Dataset
        Of `Case.sweep`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default. Labels stand to its right.
    unit : str
        Unit of the airspeed axis.
    limits : (float, float)
        Of the damping axis, in percent; modes that leave it are named above the axes.

    Returns
    -------
    matplotlib.axes.Axes
        The one given, or the new one.

    Raises
    ------
    InputError
        When the unit is not one of speed.
    """
    ax = _axes(ax)
    lines = _draw_modes(ax, sweep, damping_percent(sweep), unit)
    ax.set_ylim(*limits)
    _mark_instability(ax, sweep, unit)
    ax.set_ylabel("Damping −Re s/|s| (% of critical)")
    _label(ax, lines)
    _name_those_outside(ax, lines)
    return ax


def plot_sweep(
    sweep: xarray.Dataset,
    *,
    rotor_speed: ArrayLike | None = None,
    unit: str = "kt",
    damping_limits: tuple[float, float] = (-5, 20),
    title: str = "",
    footer: str = "",
) -> Figure:
    """Draw frequency above damping in a figure of their own.

    Parameters
    ----------
    sweep, rotor_speed, unit, damping_limits
        As for `plot_frequency` and `plot_damping`.
    title, footer : str
        Above and below; the footer is the place for what the numbers rest on.

    Returns
    -------
    matplotlib.figure.Figure
    """
    import matplotlib.pyplot as plt

    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(8, 9.5))
    footer = f"Broad lines: modes of the support, and modes that become unstable. {footer}"
    footer_lines = textwrap.wrap(footer, 130)
    bottom = 0.075 + 0.012 * len(footer_lines)
    figure.subplots_adjust(left=0.09, right=0.75, top=0.94, bottom=bottom, hspace=0.14)
    plot_frequency(sweep, above, rotor_speed=rotor_speed, unit=unit)
    plot_damping(sweep, below, unit=unit, limits=damping_limits)
    above.set_xlabel("")
    figure.suptitle(title, x=0.09, ha="left", fontsize=11)
    figure.text(0.09, 0.01, "\n".join(footer_lines), fontsize=7, va="bottom", color="0.3")
    return figure


def _axes(ax: Axes | None) -> Axes:
    import matplotlib.pyplot as plt  # here, because matplotlib takes long to import

    if ax is None:
        _, ax = plt.subplots(figsize=(8, 5))
        ax.figure.subplots_adjust(left=0.09, right=0.75)
    return ax


def _draw_modes(ax: Axes, sweep: xarray.Dataset, values: NDArray, unit: str) -> list[Line2D]:
    airspeed = sweep.airspeed.values / factor_to_si(unit, unit, "m/s")
    spacing = max(1, len(airspeed) // 7)
    lines = []
    for place, (mode, style) in enumerate(zip(sweep.mode.values.tolist(), _styles(sweep), strict=True)):
        line = {"label": mode, "markevery": (3 * place % spacing, spacing), "markersize": 5}
        lines += ax.plot(airspeed, values[:, place], **line, **style._asdict())
    failed = airspeed[sweep.reason.values != ""]
    on_the_axis = {"transform": ax.get_xaxis_transform(), "clip_on": False}
    ax.plot(failed, np.zeros(len(failed)), "x", color="0.4", **on_the_axis)
    ax.margins(x=0)
    ax.set_xlabel(f"Airspeed ({unit})" + (", x where it could not be analysed" if len(failed) else ""))
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    return lines


def _styles(sweep: xarray.Dataset) -> list[_Style]:
    """One style for each mode: the support's modes and unstable ones in broad lines."""
    broad = {*support_coordinates(sweep), *(found.mode for found in unstable_ranges(sweep))}
    markers = cycle(_MARKERS)
    single = "o" if len(sweep.airspeed) == 1 else ""
    return [
        _Style(
            color=_COLOURS[place % len(_COLOURS)],
            linestyle=_DASHES[place // len(_COLOURS) % len(_DASHES)],
            linewidth=2.4 if mode in broad else 1.2,
            marker=next(markers) if mode in broad else single,
        )
        for place, mode in enumerate(sweep.mode.values.tolist())
    ]


def _label(ax: Axes, lines: list[Line2D]) -> None:
    """The name of each line to the right of the axes, tied to its end; an arrow where that lies beyond."""
    ends = {line: _end(ax, line) for line in lines if _is_seen(ax, line)}
    spacing = _LINE_SPACING * _LABEL_SIZE * ax.figure.dpi / 72 / ax.bbox.height
    heights = _spread(np.array([np.clip(y, 0, 1) for _, y in ends.values()]), spacing)
    beside = {"transform": ax.transAxes, "clip_on": False}
    for (line, (x, y)), height in zip(ends.items(), heights, strict=True):
        edge = np.clip(y, 0, 1)
        start = x if y == edge else 1
        ax.plot([start, 1, 1.03], [edge, edge, height], color=line.get_color(), linewidth=0.6, **beside)
        sample = {name: getattr(line, f"get_{name}")() for name in (*_Style._fields, "markersize")}
        ax.plot([1.03, 1.0575, 1.085], [height] * 3, markevery=[1], **sample, **beside)
        beyond = " ↑" if y > 1 else " ↓" if y < 0 else ""
        ax.text(1.095, height, f"{line.get_label()}{beyond}", fontsize=_LABEL_SIZE, va="center", **beside)


def _is_seen(ax: Axes, line: Line2D) -> bool:
    low, high = ax.get_ylim()
    return bool(np.any((line.get_ydata() >= low) & (line.get_ydata() <= high)))


def _end(ax: Axes, line: Line2D) -> tuple[float, float]:
    """The last point of a line in fractions of the axes."""
    x, y = ax.transLimits.transform(line.get_xydata()).T
    last = np.flatnonzero(np.isfinite(y))[-1]
    return x[last], y[last]


def _spread(heights: NDArray, spacing: float) -> NDArray:
    """Heights within 0 to 1, `spacing` apart or more, in the order of the given ones and near them."""
    if not len(heights):
        return heights
    order = np.argsort(heights, kind="stable")
    steps = spacing * np.arange(len(heights))
    # y_i+1 - y_i >= spacing is an increasing y_i - i spacing: the nearest one is isotonic regression
    spread = np.empty_like(heights)
    spread[order] = np.clip(isotonic_regression(heights[order] - steps).x, 0, max(0, 1 - steps[-1])) + steps
    return spread


def _mark_instability(ax: Axes, sweep: xarray.Dataset, unit: str) -> None:
    """Shade negative damping, and put a circle where a mode becomes, or ceases to be, unstable."""
    ax.axhspan(min(ax.get_ylim()[0], 0), 0, color="#D55E00", alpha=0.12, linewidth=0)
    ax.axhline(0, color="black", linewidth=0.8)
    speeds = []
    for found in unstable_ranges(sweep):
        speeds += [] if found.open_start else [found.start]
        speeds += [] if found.open_stop else [found.stop]
    style = {"markerfacecolor": "white", "markeredgecolor": "black", "zorder": 3}
    ax.plot(np.array(speeds) / factor_to_si(unit, unit, "m/s"), np.zeros(len(speeds)), "o", **style)
    told = "unstable" + ("; circles: boundaries, interpolated" if speeds else "")
    ax.text(0.01, 0.015, told, transform=ax.transAxes, fontsize=_LABEL_SIZE, color="0.3")


def _name_those_outside(ax: Axes, lines: list[Line2D]) -> None:
    low, high = ax.get_ylim()
    outside = [line for line in lines if np.any((line.get_ydata() < low) | (line.get_ydata() > high))]
    if outside:
        names = ", ".join(str(line.get_label()) for line in outside)
        told = textwrap.fill(f"Beyond this axis, at some airspeeds or all: {names}", 110)
        ax.set_title(told, fontsize=_LABEL_SIZE, loc="left", color="0.3")
