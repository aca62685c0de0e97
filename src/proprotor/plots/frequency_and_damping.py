"""Frequency and damping of a sweep over airspeed, or over one input."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.model.stamp import density_of
from proprotor.plots import small_print
from proprotor.plots.canvas import (
    Limits,
    along,
    axes_or_new,
    name_unstable,
    note,
    say_origin,
    two_axes,
    write_title,
)
from proprotor.plots.end_labels import label_lines
from proprotor.plots.line_of_sweep import Positions, positions
from proprotor.plots.mode_lines import (
    draw_modes,
    earlier_sweeps,
    mark_boundaries,
    unstable_lines,
    write_headline_of_sweeps,
)
from proprotor.plots.onsets import boundaries_of, fixed_airspeed, told_by
from proprotor.plots.points import draw_points, frequency_quantity, quantity_of
from proprotor.plots.style import RING, UNSTABLE, in_style
from proprotor.tables.points import DAMPING, Points, Quantity
from proprotor.tables.sweep_summary import damped_frequency, damping_percent, leaps
from proprotor.typing import Array, Axes, Dataset, Figure

_DAMPING = (-5.0, 20.0)  # usual ends of the axis of damping, percent of critical
_PER_REV = (0.0, 5.0)  # usual ends of the axis of frequency
_FILLED = 0.45  # of the usual axis: where all lines are lower, half the axis shows them larger
_PERCENT = Quantity(DAMPING, "", 0.01)


@in_style
def plot_frequency(
    sweep: Dataset,
    ax: Axes | None = None,
    *,
    rotor_speed: ArrayLike | None = None,
    unit: str | None = None,
    limits: tuple[float, float] | None = None,
    points: Points | None = None,
    name: str = "",
) -> Axes:
    """Draw the frequency |Im s| of each mode along a sweep, with a circle at each boundary.

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
        Ends of the frequency axis, in its unit; by default 0 to 5 per revolution, or to half of that where all lines
        are lower. A note beneath the axes names the
        modes of which no point lies within.
    points : Points, optional
        Of `proprotor.tables.points.read_points`, drawn beside the lines: columns airspeed, or the input, and frequency.
    name : str
        What the labels call this sweep, if the axes hold several; by default the case or the options, if these differ.

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
    _draw_frequency(ax, sweep, line, _Asked(rotor_speed, limits, points, name))
    write_headline_of_sweeps(ax)
    say_origin(ax, sweep.attrs, along(sweep, line))
    return ax


def _draw_frequency(ax: Axes, sweep: Dataset, line: Positions, of: _Asked) -> None:
    per = 2 * np.pi if of.rotor_speed is None else np.asarray(of.rotor_speed)[..., None]
    values = damped_frequency(sweep) / per
    usual = (0, None) if of.rotor_speed is None else _PER_REV
    _draw(ax, sweep, values, line, usual, of, frequency_quantity(line, of.rotor_speed), "frequency")
    found = boundaries_of(sweep, values)
    ax.plot([one.place / line.factor for one in found], [one.value for one in found], "o", **RING)
    ax.set_ylabel(f"Frequency |Im s| ({'Hz' if of.rotor_speed is None else 'per rev'})")


@in_style
def plot_damping(
    sweep: Dataset,
    ax: Axes | None = None,
    *,
    unit: str | None = None,
    limits: tuple[float, float] | None = None,
    points: Points | None = None,
    name: str = "",
) -> Axes:
    """Draw the damping ratio -Re s/|s| of each mode along a sweep, in percent of critical.

    Damping is negative where a mode is unstable. Circles are boundaries, interpolated between points of the sweep; the
    names beside the axes tell where their modes are unstable.

    Parameters
    ----------
    sweep : xarray.Dataset
        Result of `Case.sweep`, along airspeeds or one input.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default. Labels stand to its right.
    unit : str, optional
        Unit of the axis of airspeed, "ktas" by default, or of the input.
    limits : (float, float), optional
        Ends of the damping axis, in percent; by default -5 to 20, or to 10 where all lines are lower. A note beneath
        the axes names the modes of which no point lies within.
    points : Points, optional
        Of `proprotor.tables.points.read_points`, drawn beside the lines: columns airspeed, or the input, and damping.
    name : str
        What the labels call this sweep, if the axes hold several; by default the case or the options, if these differ.

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
    _draw_damping(ax, sweep, line, _Asked(None, limits, points, name))
    write_headline_of_sweeps(ax)
    say_origin(ax, sweep.attrs, along(sweep, line))
    return ax


def _draw_damping(ax: Axes, sweep: Dataset, line: Positions, of: _Asked) -> None:
    _draw(ax, sweep, damping_percent(sweep), line, _DAMPING, of, _PERCENT, "damping")
    _mark_instability(ax, sweep, line)
    ax.set_ylabel("Damping −Re s/|s| (% of critical)")


@in_style
def plot_sweep(
    sweep: Dataset,
    *,
    rotor_speed: ArrayLike | None = None,
    unit: str | None = None,
    damping_limits: tuple[float, float] | None = None,
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
    damping_limits : (float, float), optional
        Ends of the damping axis, percent of critical.
    title, footer : str
        Texts above and below the plots. The footer is the place for reservations about the numbers.
    points : Points, optional
        Of `proprotor.tables.points.read_points`: columns airspeed, or the input, and frequency, damping or both.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure, (above, below) = two_axes((8, 9))
    line = positions(sweep, unit)
    if points is not None:
        points.check(_across(sweep, line), [frequency_quantity(line, rotor_speed), _PERCENT])
    write_title(figure, title, told_by(sweep, line, rotor_speed).headline)
    _draw_frequency(above, sweep, line, _Asked(rotor_speed, None, points, needed=False))
    _draw_damping(below, sweep, line, _Asked(None, damping_limits, points, needed=False))
    above.set_xlabel("")
    onsets = [one.place for one in boundaries_of(sweep, damping_percent(sweep)) if one.onset]
    for ax in (above, below) if onsets else ():
        ax.axvline(min(onsets) / line.factor, color="0.35", linewidth=0.9, linestyle=":", zorder=1)
    note(below, "Broad lines: modes of the support, and modes that become unstable")
    if leaps(sweep).any():
        note(below, "Where a line is broken its motion passes to another root")
    small_print.add(below, footer)
    say_origin(below, sweep.attrs, along(sweep, line))
    return figure


class _Asked(NamedTuple):
    """What a user asked of one plot; `needed`: points without a column of its quantity are refused."""

    rotor_speed: ArrayLike | None
    limits: Limits | None = None
    points: Points | None = None
    name: str = ""
    needed: bool = True


def _across(sweep: Dataset, line: Positions) -> Quantity:
    """Return the quantity of the axis across."""
    return quantity_of(line, str(sweep[line.name].attrs.get("units", "")), density_of(sweep.attrs))


def _draw(
    ax: Axes,
    sweep: Dataset,
    values: Array,
    line: Positions,
    usual: tuple[float, float | None],
    of: _Asked,
    up: Quantity,
    quantity: str,
) -> None:
    """Draw values (points, modes) of the modes, points of a file, and the names of the lines.

    The axis has the limits that were asked for, or the usual ones.
    """
    lines = draw_modes(ax, sweep, values, line, of.name, of.rotor_speed)
    ax.margins(x=0)
    ax.set_ylim(*(of.limits or (usual[0], _top(ax, usual[1]))))
    draw_points(ax, of.points, _across(sweep, line), up, needed=of.needed)
    label_lines(ax, lines, quantity, more=unstable_lines(ax))
    if fixed := fixed_airspeed(sweep):
        note(ax, f"Everything{fixed.removeprefix(',')}")


def _top(ax: Axes, usual: float | None) -> float | None:
    """Return the upper end of an axis: the usual one, or half of it where all lines of modes are lower than that."""
    lines = (line for one in earlier_sweeps(ax) for line in one.lines.values())
    highest = max((float(np.nanmax(line.get_ydata(), initial=-np.inf)) for line in lines), default=np.inf)
    return usual / 2 if usual and highest < _FILLED * usual else usual


def _mark_instability(ax: Axes, sweep: Dataset, line: Positions) -> None:
    """Shade negative damping and draw a circle at each boundary."""
    ax.axhspan(min(ax.get_ylim()[0], 0), 0, color=UNSTABLE, linewidth=0, zorder=0.5)
    ax.axhline(0, color="black", linewidth=0.8)
    found = boundaries_of(sweep, damping_percent(sweep))
    mark_boundaries(ax, [one.place / line.factor for one in found], [0.0] * len(found))
    if not any(text.get_text() == "unstable" for text in ax.texts):
        name_unstable(ax)
