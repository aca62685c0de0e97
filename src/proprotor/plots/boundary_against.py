"""Boundaries over an input: the airspeed at which each mode becomes unstable over altitude, rotor speed or another."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import cycle
from typing import Any

import numpy as np

from proprotor.model.doubts import doubts_along, footnotes
from proprotor.plots.canvas import axes_or_new, grid, note, points_per_pixel, say_origin
from proprotor.plots.end_labels import label_lines
from proprotor.plots.line_of_sweep import Positions, axis_of, written
from proprotor.plots.points import draw_points
from proprotor.plots.style import COLOURS, GREY, LABEL_SIZE, in_style
from proprotor.tables.boundary_table import FIRST, input_of
from proprotor.tables.points import Points, Quantity
from proprotor.typing import Array, Axes, Dataset, Line2D
from proprotor.units import KEAS, KNOT, SEA_LEVEL_DENSITY, airspeed_unit, speed_factor

_MARKERS = "s^DvP<>h"
_ENDS = ", stable again"
_ROOM = 0.06  # of the axis, below and above what is drawn
_MARGIN = 0.015  # of the axis, left and right of what is drawn
_LETTER = 0.55  # mean width of a letter, of its size


@in_style
def plot_boundary_against(
    found: Dataset,
    ax: Axes | None = None,
    *,
    unit: str | None = None,
    speed_unit: str = "ktas",
    points: Points | None = None,
    limits: tuple[float, float] | None = None,
) -> Axes:
    """Draw the airspeed of each boundary over an input.

    Broad lines are boundaries at which a mode becomes unstable, thin dashed ones those at which it is stable again.
    Above the grey line nothing is known: the search ended there, or airspeeds could not be analysed.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `Case.boundary_against`.
    ax : matplotlib.axes.Axes, optional
        Where to draw; a new figure by default. Labels stand to its right.
    unit : str, optional
        Unit of the input; the usual one by default.
    speed_unit : str
        "ktas", "keas" or another unit of speed, which then is a true airspeed.
    points : Points, optional
        Of `proprotor.tables.points.read_points`, with a column of the input and a column ``airspeed``.
    limits : (float, float), optional
        Ends of the axis of airspeed, in its unit; by default the axis holds all boundaries and points.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes, or the new ones.

    Raises
    ------
    InputError
        If a unit does not fit, and for points without the columns.
    """
    path = input_of(found)
    line = axis_of(path, found[path].values, str(found[path].attrs.get("units", "")), unit)
    up = _airspeed_of(found, speed_unit)
    ax = axes_or_new(ax, labels_beside=True)
    factor = np.asarray(up.factor(found[path].values) if callable(up.factor) else up.factor)
    speeds = found.airspeed.values / factor.reshape(-1, 1)
    lines = _draw(ax, found, line, speeds)
    top = found.searched.sel(end="high").values / factor
    ax.plot(line.values, top, color=GREY, linewidth=1.2, linestyle=":", zorder=1.5)
    room = _MARGIN * (line.values[-1] - line.values[0])  # for whole markers at the ends
    if room:
        ax.set_xlim(line.values[0] - room, line.values[-1] + room)
    _set_limits(ax, speeds, top, limits)
    ax.set_xlabel(line.label)
    shown = airspeed_unit(speed_unit)
    ax.set_ylabel(f"Airspeed of the boundary, {shown}" + (", true" if shown == speed_unit else ""))
    grid(ax)
    if (top <= ax.get_ylim()[1]).any():
        note(ax, "Dotted: highest airspeed that was analysed" + ("" if lines else "; no boundary below"))
    across = Quantity(path, str(found[path].attrs.get("units", "")), line.factor)
    draw_points(ax, points, across, up)
    _name(ax, lines, found, line)
    say_origin(ax, found.attrs, _doubts(found, line))
    return ax


def _airspeed_of(found: Dataset, unit: str) -> Quantity:
    """Return the axis of airspeed; an equivalent airspeed has the density of each value of the input."""
    path = input_of(found)
    values, density = found[path].values, found.density.values

    def equivalent(x: Array) -> Array:
        return np.asarray(KNOT * np.sqrt(SEA_LEVEL_DENSITY / np.interp(x, values, density)))

    special = {"keas": equivalent} if (density > 0).all() else {}
    if airspeed_unit(unit) == KEAS:
        speed_factor(unit, density, field="unit")  # refuses a vacuum
        return Quantity("airspeed", "m/s", equivalent, special)
    return Quantity("airspeed", "m/s", float(speed_factor(unit, field="unit")), special)


def _draw(ax: Axes, found: Dataset, line: Positions, speeds: Array) -> list[Line2D]:
    """Draw a line for each branch, in one colour for all branches of a mode; return the lines."""
    lines: list[Line2D] = []
    modes = list(dict.fromkeys(_mode_of(label) for label in found.branch.values.tolist()))
    markers = dict(zip(modes, cycle(_MARKERS), strict=False))
    every = max(1, len(line.values) // 8)
    for place, label in enumerate(found.branch.values.tolist()):
        mode, onset = _mode_of(label), bool(found.onset.values[place])
        style: dict[str, Any] = {"color": COLOURS[modes.index(mode) % len(COLOURS)], "label": label}
        style |= {"linestyle": "-", "linewidth": 2.2} if onset else {"linestyle": "--", "linewidth": 1.0}
        marks: dict[str, Any] = {"marker": markers[mode] if onset else "", "markersize": 5}
        alone = np.isfinite(speeds[:, place]).sum() == 1
        marks |= {"markevery": 1 if alone else (place % every, every)}
        lines += ax.plot(line.values, speeds[:, place], **style, **marks)
    return lines


def _mode_of(label: str) -> str:
    """Return the mode in the label of a branch."""
    return label.partition(_ENDS)[0].partition(" (")[0]


def _name(ax: Axes, lines: list[Line2D], found: Dataset, line: Positions) -> None:
    """Write the names of lines: beside the axes where a line reaches their edge, at its last point elsewhere."""
    last = line.values[-1]
    at_edge = []
    for drawn, onset, modes in zip(lines, found.onset.values, found["mode"].values.T, strict=True):
        x, y = np.asarray(drawn.get_xydata()).T
        known = np.flatnonzero(np.isfinite(y))
        starts = known[np.concatenate([[True], modes[known][1:] != modes[known][:-1]])]
        if drawn.get_label() == FIRST:
            for place in starts:
                _write(ax, drawn, int(place), str(modes[place]))
        elif x[known[-1]] == last and onset:
            at_edge.append(drawn)
        else:
            _write(ax, drawn, int(known[-1]), str(drawn.get_label()))
    label_lines(ax, at_edge, "airspeed")


def _write(ax: Axes, drawn: Line2D, place: int, text: str) -> None:
    """Write a text beside a point of a line, in its colour: above a line with markers, below one without."""
    x, y = np.asarray(drawn.get_xydata()).T
    box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.8}
    style: dict[str, Any] = {"color": drawn.get_color(), "fontsize": LABEL_SIZE, "bbox": box, "zorder": 4}
    near = y[max(0, place - 1) : place + 2]
    falls = bool(np.nanmax(near) > near[-1]) if np.isfinite(near[-1]) else bool(near[0] > y[place])
    above = drawn.get_marker() not in ("", "None")
    left, right = np.array(ax.get_xlim()) @ [[0.85, 0.15], [0.15, 0.85]]
    rightwards = x[place] < left or (falls == above and x[place] < right)
    width = (_LETTER * LABEL_SIZE * len(text) + 4) / points_per_pixel(ax) / ax.bbox.width
    at_left = float(ax.transLimits.transform((x[place], y[place]))[0])
    if not rightwards and at_left < width < 1 - at_left:
        rightwards = True
    offset: dict[str, Any] = {"xytext": (4 if rightwards else -4, 5 if above else -5)}
    offset |= {"ha": "left" if rightwards else "right", "va": "bottom" if above else "top"}
    at = (float(x[place]), float(y[place]))
    ax.annotate(text, at, textcoords="offset points", annotation_clip=True, **offset, **style)


def _set_limits(ax: Axes, speeds: Array, top: Array, limits: tuple[float, float] | None) -> None:
    """Set the limits of the axis of airspeed: as given, or around boundaries and the ends of searches without any."""
    if limits is not None:
        ax.set_ylim(*limits)
        return
    known = speeds[np.isfinite(speeds)]
    ends = top[np.isfinite(top) & (~np.isfinite(speeds).any(axis=1) | (top <= known.max(initial=0.0)))]
    known = np.concatenate([known, ends])
    if known.size:
        low, high = float(known.min()), float(known.max())
        room = max(_ROOM * (high - low), 0.02 * high)
        ax.set_ylim(max(0.0, low - room), high + room)


def _doubts(found: Dataset, line: Positions) -> Iterator[str]:
    """Yield a sentence for each doubt about boundaries, along the input."""
    rows, places = np.nonzero(found.warning.values != "")
    if len(rows):
        values = found[line.name].values[rows]
        yield from footnotes(
            doubts_along(values, found.warning.values[rows, places]), written(line.unit), line.factor
        )
