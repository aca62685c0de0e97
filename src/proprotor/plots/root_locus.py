"""Root locus: the roots of a sweep in the plane of growth and frequency, along airspeeds or one input."""

from __future__ import annotations

from typing import Any

import numpy as np

from proprotor.plots.canvas import Limits, along, axes_or_new, grid, note, points_per_pixel, say_origin
from proprotor.plots.end_labels import label_lines
from proprotor.plots.line_of_sweep import Positions, positions, with_gaps, written
from proprotor.plots.mode_lines import (
    earlier_sweeps,
    mark_boundaries,
    modes_drawn,
    named,
    styles_beside,
    unstable_lines,
    write_headline_of_sweeps,
)
from proprotor.plots.onsets import boundaries_of, told_by
from proprotor.plots.points import draw_points
from proprotor.plots.style import LABEL_SIZE, SMALL_SIZE, UNSTABLE, in_style, white_box
from proprotor.tables.points import FREQUENCY, GROWTH, Points, Quantity
from proprotor.tables.sweep_summary import broad_modes, growth_rate, leaps
from proprotor.typing import Array, Axes, Dataset, Line2D

_RATIOS = (0.01, 0.02, 0.05, 0.10, 0.20, 0.50)
_SMALLEST, _LARGEST = 3.5, 8.0  # size of the markers, points
_APART = 14.0  # points: the first and the last number of a line would overlap if they were nearer
_MARKS = 8  # markers of a line, at most
_WORD = 40.0  # points: the length of a word
_ROOM = 22.0  # points: a ray whose end is nearer to that of the ray before has no number


@in_style
def plot_root_locus(
    sweep: Dataset,
    ax: Axes | None = None,
    *,
    rotor_speed: float | None = None,
    unit: str | None = None,
    marks: float | None = None,
    growth_limits: tuple[float, float] | None = None,
    frequency_limits: tuple[float, float] | None = None,
    points: Points | None = None,
    name: str = "",
) -> Axes:
    """Draw how the roots s move in the upper half of their plane: Re s across, |Im s| up.

    Markers stand at round values of the airspeed or input, and grow with the value. Circles are boundaries.
    Rays are lines of equal damping ratio.

    Parameters
    ----------
    sweep : xarray.Dataset
        Result of `Case.sweep`, along airspeeds or one input.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default. Labels stand to its right.
    rotor_speed : float, optional
        rad/s. With a rotor speed both axes are per revolution, without it in rad/s.
    unit : str, optional
        Unit of the airspeed, "ktas" by default, or of the input.
    marks : float, optional
        Distance of the markers, in this unit.
    growth_limits, frequency_limits : (float, float), optional
        Ends of both axes, in their units; by default the axes hold the modes of the support and the modes that become
        unstable.
    points : Points, optional
        Of `proprotor.tables.points.read_points`: columns growth and frequency.
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
    ax = axes_or_new(ax, size=(8, 7), labels_beside=True)
    told = told_by(sweep, line, rotor_speed)
    sweep = sweep.isel(mode=modes_drawn(ax, sweep))
    per = 1.0 if rotor_speed is None else float(rotor_speed)
    real, imaginary = growth_rate(sweep) / per, np.abs(sweep.eigenvalue.values.imag) / per
    imaginary = np.where(np.isnan(real), np.nan, imaginary)
    _set_limits(ax, sweep, real, imaginary, growth_limits, frequency_limits)
    at = _round_values(line, marks)
    lines = named(ax, sweep, _draw(ax, sweep, real, imaginary, line, at), name, told)
    up = Quantity(FREQUENCY, "rad/s", per, {} if rotor_speed is None else {"per rev": per})
    growth = Quantity(GROWTH, "1/s", per, up.special)
    draw_points(ax, points, growth, up)
    _draw_rays(ax)
    ax.axvspan(0, max(ax.get_xlim()[1], 0), color=UNSTABLE, linewidth=0, zorder=0.5)
    ax.axvline(0, color="black", linewidth=0.8)
    _name_unstable(ax)
    shown_in = "per rev" if rotor_speed is not None else "rad/s"
    ax.set(xlabel=f"Growth Re s ({shown_in})", ylabel=f"Frequency |Im s| ({shown_in})")
    grid(ax)
    if len(at) > 1:
        ends = f"from {at[0]:g} to {at[-1]:g} {written(line.unit)}"
        note(ax, f"Markers every {at[1] - at[0]:g}, growing {ends}")
    crossings = [one.value for one in boundaries_of(sweep, imaginary)]
    mark_boundaries(ax, [0.0] * len(crossings), crossings)
    label_lines(ax, lines, "growth or frequency", tie=False, more=unstable_lines(ax))
    write_headline_of_sweeps(ax)
    say_origin(ax, sweep.attrs, along(sweep, line))
    return ax


def _name_unstable(ax: Axes) -> None:
    """Write "unstable" into the strip of growth, upright where the strip is narrow."""
    right = ax.get_xlim()[1]
    if right <= 0 or any(text.get_text() == "unstable" for text in ax.texts):
        return
    narrow = right * ax.bbox.width / np.ptp(ax.get_xlim()) * points_per_pixel(ax) < _WORD
    style: dict[str, Any] = {"rotation": 90 if narrow else 0, "transform": ax.get_xaxis_transform()}
    ax.text(right / 2, 0.015, "unstable", fontsize=LABEL_SIZE, color="0.3", ha="center", **style)


def _set_limits(
    ax: Axes, sweep: Dataset, real: Array, imaginary: Array, growth: Limits | None, frequency: Limits | None
) -> None:
    """Set limits that hold the broad modes, or all modes if none is broad."""
    broad = broad_modes(sweep)
    chosen = [place for place, mode in enumerate(sweep.mode.values.tolist()) if mode in broad]
    columns = chosen or list(range(len(sweep.mode)))
    low, high = _range(real[:, columns])
    ax.set_xlim(*(growth or (low - 0.08 * (high - low), max(high, 0) + 0.08 * (high - low))))
    ax.set_ylim(*(frequency or (0, 1.1 * _range(imaginary[:, columns])[1])))


def _range(values: Array) -> tuple[float, float]:
    """Return the ends of values and zero, or -1 and 1 if no value differs from zero."""
    finite = values[np.isfinite(values)]
    low, high = finite.min(initial=0.0), finite.max(initial=0.0)
    return (float(low), float(high)) if high > low else (-1.0, 1.0)


def _round_values(line: Positions, step: float | None) -> Array:
    """Return the round values within a line, a step apart or at most `_MARKS`, in the unit of the axis."""
    from matplotlib.ticker import MaxNLocator

    low, high = float(line.values.min()), float(line.values.max())
    if step is None:
        values = np.asarray(MaxNLocator(_MARKS, steps=[1, 2, 5, 10]).tick_values(low, high))
    else:
        values = step * np.arange(np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9) + 1)
    slack = 1e-9 * (high - low)
    return values[(values >= low - slack) & (values <= high + slack)]


def _draw(
    ax: Axes, sweep: Dataset, real: Array, imaginary: Array, line: Positions, at: Array
) -> dict[str, Line2D]:
    """Draw a line for each mode with markers at round values; return the lines."""
    lines: dict[str, Line2D] = {}
    earlier = earlier_sweeps(ax)
    sizes = np.linspace(_LARGEST, _SMALLEST, len(at))[::-1] ** 2  # a single marker is large
    broad, gaps = broad_modes(sweep), leaps(sweep)
    for place, (mode, style) in enumerate(styles_beside(earlier, sweep)):
        plain = style._replace(marker="")._asdict()
        where, across, up = with_gaps(gaps[:, place], line.values, real[:, place], imaginary[:, place])
        (lines[mode],) = ax.plot(across, up, label=mode, markersize=4, **plain)
        # Linear between the points of the sweep; NaN beside failed points and gaps.
        order = np.argsort(where)
        x, y = (np.interp(at, where[order], part[order]) for part in (across, up))
        more: dict[str, Any] = {"color": style.color, "zorder": 3, "linewidths": 0.6, "edgecolors": "white"}
        more |= {"color": "white", "edgecolors": style.color, "linewidths": 1.0} if earlier else {}
        ax.scatter(x, y, s=sizes, **more)
        if mode in broad:
            _write_ends(ax, x, y, at)
    return lines


def _write_ends(ax: Axes, x: Array, y: Array, at: Array) -> None:
    """Write the first and the last round value beside their markers, or only the last if both markers are near."""
    seen = np.flatnonzero(np.isfinite(x))
    if not len(seen):
        return
    first, last = int(seen[0]), int(seen[-1])
    ends = ax.transData.transform(np.column_stack([x[[first, last]], y[[first, last]]]))
    far = np.hypot(*(ends[1] - ends[0])) * points_per_pixel(ax) > _APART
    for place in (first, last) if far else (last,):
        style: dict[str, Any] = {
            "fontsize": SMALL_SIZE,
            "color": "0.25",
            "textcoords": "offset points",
            "zorder": 4,
        }
        where = (float(x[place]), float(y[place]))
        ax.annotate(f"{at[place]:g}", where, xytext=(5, 4), annotation_clip=True, **style)


def _draw_rays(ax: Axes) -> None:
    """Draw lines of equal damping ratio, each with its number at the edge of the axes."""
    left, top = ax.get_xlim()[0], ax.get_ylim()[1]
    if left >= 0:
        return
    last: Array | None = None
    for ratio in reversed(_RATIOS):
        slope = -ratio / np.sqrt(1 - ratio**2)  # Re s over |Im s|
        length = min(top, left / slope)
        ax.plot([0, slope * length], [0, length], color="0.6", linewidth=0.6, dashes=(6, 3), zorder=1)
        end = ax.transData.transform((slope * length, length)) * points_per_pixel(ax)
        if last is not None and np.hypot(*(end - last)) < _ROOM:
            continue
        last = end
        style: dict[str, Any] = {"fontsize": SMALL_SIZE, "color": "0.45", "textcoords": "offset points"}
        place: dict[str, Any] = {"xytext": (0, -3), "va": "top", "ha": "center"}
        if length < top:
            place = {"xytext": (3, 0), "va": "center"}
        ax.annotate(f"{100 * ratio:g} %", (slope * length, length), bbox=white_box(0.5), **place, **style)
