"""Frequency and damping of a sweep over airspeed, or over one input."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.model.stamp import density_of
from proprotor.plots.canvas import RIGHT, Limits, add_footer, along, axes_or_new, origin_of, say_origin
from proprotor.plots.end_labels import label_lines
from proprotor.plots.line_of_sweep import Positions, positions
from proprotor.plots.mode_lines import draw_modes
from proprotor.plots.points import draw_points, frequency_quantity, quantity_of
from proprotor.plots.style import LABEL_SIZE, UNSTABLE
from proprotor.tables.points import DAMPING, Points, Quantity
from proprotor.tables.sweep_summary import damped_frequency, damping_percent, leaps, unstable_ranges
from proprotor.typing import Array, Axes, Dataset, Figure

_TITLE, _NOTE = 0.42, 0.16  # inches above the axes: for a title, and for each line of a note


def plot_frequency(
    sweep: Dataset,
    ax: Axes | None = None,
    *,
    rotor_speed: ArrayLike | None = None,
    unit: str | None = None,
    limits: tuple[float, float] | None = None,
    points: Points | None = None,
) -> Axes:
    """Draw the frequency |Im s| of each mode along a sweep.

    Parameters
    ----------
    sweep : xarray.Dataset
        Result of `Case.sweep`, along airspeeds or one input.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default. Labels stand to its right.
    rotor_speed : float or array (points,), optional
        rad/s. With a rotor speed frequencies are per revolution, without it in Hz.
    unit : str, optional
        Unit of the axis of airspeed, "ktas" by default, or of the input.
    limits : (float, float), optional
        Ends of the frequency axis, in its unit; 0 to 5 per revolution by default. A note above the axes names the modes
        that leave the axis.
    points : Points, optional
        Of `proprotor.tables.points.read_points`, drawn beside the lines: columns airspeed, or the input, and frequency.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones.

    Raises
    ------
    InputError
        If the unit does not fit the airspeed or the input, and for points without the columns.
    """
    line = positions(sweep, unit)
    ax = axes_or_new(ax, labels_beside=True)
    _draw_frequency(ax, sweep, line, rotor_speed, limits, points)
    say_origin(ax, sweep.attrs, along(sweep, line))
    return ax


def _draw_frequency(
    ax: Axes,
    sweep: Dataset,
    line: Positions,
    rotor_speed: ArrayLike | None,
    limits: Limits | None = None,
    points: Points | None = None,
    needed: bool = True,
) -> None:
    measured = _Measured(points, frequency_quantity(line, rotor_speed), needed)
    per = 2 * np.pi if rotor_speed is None else np.asarray(rotor_speed)[..., None]
    _draw(
        ax,
        sweep,
        damped_frequency(sweep) / per,
        line,
        limits or (0, None if rotor_speed is None else 5),
        measured,
    )
    ax.set_ylabel(f"Frequency |Im s| ({'Hz' if rotor_speed is None else 'per rev'})")


def plot_damping(
    sweep: Dataset,
    ax: Axes | None = None,
    *,
    unit: str | None = None,
    limits: tuple[float, float] = (-5, 20),
    points: Points | None = None,
) -> Axes:
    """Draw the damping ratio -Re s/|s| of each mode along a sweep, in percent of critical.

    Damping is negative where a mode is unstable.

    Parameters
    ----------
    sweep : xarray.Dataset
        Result of `Case.sweep`, along airspeeds or one input.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default. Labels stand to its right.
    unit : str, optional
        Unit of the axis of airspeed, "ktas" by default, or of the input.
    limits : (float, float)
        Ends of the damping axis, in percent. A note above the axes names the modes that leave the axis.
    points : Points, optional
        Of `proprotor.tables.points.read_points`, drawn beside the lines: columns airspeed, or the input, and damping.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones.

    Raises
    ------
    InputError
        If the unit does not fit the airspeed or the input, and for points without the columns.
    """
    line = positions(sweep, unit)
    ax = axes_or_new(ax, labels_beside=True)
    _draw_damping(ax, sweep, line, limits, points)
    say_origin(ax, sweep.attrs, along(sweep, line))
    return ax


def _draw_damping(
    ax: Axes,
    sweep: Dataset,
    line: Positions,
    limits: Limits,
    points: Points | None = None,
    needed: bool = True,
) -> None:
    measured = _Measured(points, Quantity(DAMPING, "", 0.01), needed)
    _draw(ax, sweep, damping_percent(sweep), line, limits, measured)
    _mark_instability(ax, sweep, line)
    ax.set_ylabel("Damping −Re s/|s| (% of critical)")


def plot_sweep(
    sweep: Dataset,
    *,
    rotor_speed: ArrayLike | None = None,
    unit: str | None = None,
    damping_limits: tuple[float, float] = (-5, 20),
    title: str = "",
    footer: str = "",
    points: Points | None = None,
) -> Figure:
    """Draw the frequency and, below, the damping of each mode along a sweep, in a new figure.

    Parameters
    ----------
    sweep : xarray.Dataset
        Result of `Case.sweep`, along airspeeds or one input.
    rotor_speed : float or array (points,), optional
        rad/s, as for `plot_frequency`.
    unit : str, optional
        Unit of the axis across, as for `plot_frequency`.
    damping_limits : (float, float)
        Ends of the damping axis, percent of critical.
    title, footer : str
        Texts above and below the plots. The footer is the place for reservations about the numbers.
    points : Points, optional
        Of `proprotor.tables.points.read_points`: columns airspeed, or the input, and frequency, damping or both.

    Returns
    -------
    matplotlib.figure.Figure
    """
    import matplotlib.pyplot as plt

    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(8, 9))
    figure.subplots_adjust(left=0.09, right=RIGHT, top=0.94, bottom=0.06, hspace=0.14)
    line = positions(sweep, unit)
    broad = "Broad lines: modes of the support, and modes that become unstable."
    broken = "Where a line is broken its motion passes to another root." if leaps(sweep).any() else ""
    origin = origin_of(sweep.attrs, along(sweep, line))
    add_footer(figure, " ".join(filter(None, (broad, broken, footer, origin))))
    if points is not None:
        points.check(
            _across(sweep, line), [frequency_quantity(line, rotor_speed), Quantity(DAMPING, "", 0.01)]
        )
    _draw_frequency(above, sweep, line, rotor_speed, None, points, needed=False)
    _draw_damping(below, sweep, line, damping_limits, points, needed=False)
    above.set_xlabel("")
    height, notes = figure.get_size_inches()[1], above.get_title(loc="left")
    lines = notes.count("\n") + 1 if notes else 0
    figure.subplots_adjust(top=min(figure.subplotpars.top, 1 - (_TITLE + _NOTE * lines) / height))
    figure.suptitle(title, x=0.09, y=1 - 0.15 / height, ha="left", va="top", fontsize=11, parse_math=False)
    return figure


class _Measured(NamedTuple):
    """Points of a file, the quantity of the axis up, and whether points without a column of it are refused."""

    points: Points | None
    up: Quantity
    needed: bool


def _across(sweep: Dataset, line: Positions) -> Quantity:
    """Return the quantity of the axis across."""
    return quantity_of(line, str(sweep[line.name].attrs.get("units", "")), density_of(sweep.attrs))


def _draw(
    ax: Axes,
    sweep: Dataset,
    values: Array,
    line: Positions,
    limits: tuple[float, float | None],
    measured: _Measured,
) -> None:
    """Draw values (points, modes) of the modes within limits, points of a file, and the names of the lines."""
    lines = draw_modes(ax, sweep, values, line)
    ax.margins(x=0)
    ax.set_ylim(*limits)
    draw_points(ax, measured.points, _across(sweep, line), measured.up, needed=measured.needed)
    label_lines(ax, lines, f"at some {'airspeeds' if line.name == 'airspeed' else 'points'} or all")


def _mark_instability(ax: Axes, sweep: Dataset, line: Positions) -> None:
    """Shade negative damping, and draw a circle at each point where a mode becomes unstable or stable again."""
    ax.axhspan(min(ax.get_ylim()[0], 0), 0, color=UNSTABLE, linewidth=0, zorder=0.5)
    ax.axhline(0, color="black", linewidth=0.8)
    places: list[float] = []
    if line.name != "airspeed":  # `unstable_ranges` reads the line of a sweep under this name
        sweep = sweep.drop_vars("airspeed").rename({line.name: "airspeed"})
    for found in unstable_ranges(sweep):
        places += [] if found.open_start else [found.start]
        places += [] if found.open_stop else [found.stop]
    style: dict[str, Any] = {"markerfacecolor": "white", "markeredgecolor": "black", "zorder": 3}
    ax.plot(np.array(places) / line.factor, np.zeros(len(places)), "o", **style)
    text = "unstable" + ("; circles: boundaries, interpolated" if places else "")
    ax.text(0.01, 0.015, text, transform=ax.transAxes, fontsize=LABEL_SIZE, color="0.3")
