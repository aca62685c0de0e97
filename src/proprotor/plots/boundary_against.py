"""Boundaries over an input: the airspeed at which each mode becomes unstable over altitude, rotor speed or another."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from proprotor.model.doubts import doubts_along, footnotes, marked
from proprotor.plots.canvas import axes_or_new, grid, note, points_per_pixel, say_origin, write_headline
from proprotor.plots.end_labels import label_lines
from proprotor.plots.line_of_sweep import Positions, axis_of, written
from proprotor.plots.points import draw_points
from proprotor.plots.style import (
    GREY,
    LABEL_SIZE,
    TITLE_SIZE,
    UNSTABLE,
    halo,
    in_style,
    styles_of_modes,
)
from proprotor.stability.kinds import RIGID_BODY
from proprotor.tables.boundary_table import FIRST, input_of
from proprotor.tables.points import Points, Quantity
from proprotor.typing import Array, Axes, Dataset, Line2D
from proprotor.units import KEAS, KNOT, SEA_LEVEL_DENSITY, airspeed_unit, speed_factor

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

    Broad lines are boundaries at which a mode becomes unstable, thin ones those at which it is stable again; hollow
    markers are doubtful. Where a mode is unstable the ground is shaded. Above the dotted line nothing is known: the
    search ended there, or airspeeds could not be analysed.

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
    _shade(ax, found, line, speeds, top)
    ax.set_xlabel(line.label)
    shown = airspeed_unit(speed_unit)
    ax.set_ylabel(f"Airspeed of the boundary, {shown}" + (", true" if shown == speed_unit else ""))
    grid(ax)
    if not found.onset.values.all():
        note(ax, "Thin lines: stable again above")
    if (found.warning.values != "").any():
        note(ax, "Hollow markers: doubtful")
    if (top <= ax.get_ylim()[1]).any():
        note(ax, "Dotted: highest airspeed that was analysed" + ("" if lines else "; no boundary below"))
    across = Quantity(path, str(found[path].attrs.get("units", "")), line.factor)
    draw_points(ax, points, across, up)
    _name(ax, lines, found)
    write_headline(ax, _lowest(found, line, speeds, shown))
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
    """Draw a line for each branch, all branches of a mode as the mode looks in sweeps; return the lines."""
    lines: list[Line2D] = []
    styles = styles_of_modes(map(_mode_of, found.branch.values.tolist()))
    every = max(1, len(line.values) // 8)
    for place, label in enumerate(found.branch.values.tolist()):
        style: dict[str, Any] = styles[_mode_of(label)]._asdict() | {"label": label, "markersize": 5}
        if not found.onset.values[place]:
            style |= {"linewidth": 1.0, "marker": ""}
        alone = np.isfinite(speeds[:, place]).sum() == 1
        first, step = (0, 1) if alone else (place % every, every)
        lines += ax.plot(line.values, speeds[:, place], markevery=(first, step), **style)
        doubtful = np.isfinite(speeds[:, place]) & (found.warning.values[:, place] != "")
        doubtful &= np.arange(len(line.values)) % step == first
        hollow = {"color": style["color"], "marker": style["marker"] or "o", "markerfacecolor": "white"}
        ax.plot(line.values[doubtful], speeds[doubtful, place], linestyle="", markersize=5, **hollow)
    return lines


def _shade(ax: Axes, found: Dataset, line: Positions, speeds: Array, top: Array) -> None:
    """Shade the airspeeds at which a mode is unstable: from its onset to its end, or as far as was analysed."""
    modes = np.array([_mode_of(label) for label in found.branch.values.tolist()])
    onsets = _onsets(found, speeds)
    for place in np.flatnonzero(np.isfinite(onsets).any(axis=0)):
        own = np.where(np.isfinite(onsets[:, place]), onsets[:, place], np.nan)
        ends = speeds[:, (modes == modes[place]) & ~found.onset.values]
        later = np.where(ends > own[:, None], ends, np.inf)
        upper = np.fmin(later.min(axis=1, initial=np.inf), top)
        ax.fill_between(line.values, own, upper, color=UNSTABLE, linewidth=0, zorder=0.5)
    if (found.kind.values == RIGID_BODY).any():
        note(ax, "Where the flight of the aircraft alone is unstable nothing is shaded")
    lowest = onsets.min(axis=1, initial=np.inf)
    if (known := np.isfinite(lowest)).any():
        low, high = ax.get_ylim()
        highest = np.fmin(high, np.nan_to_num(top, nan=np.inf))
        _name_side(ax, line, np.where(known, highest - lowest, -np.inf), "unstable", highest)
        _name_side(ax, line, np.where(known, lowest - low, -np.inf), "stable", np.full(len(top), low))


def _onsets(found: Dataset, speeds: Array) -> Array:
    """Return the airspeeds (values, branches) at which flutter begins, or what else but the flight of a free aircraft.

    Where there is none the airspeed is infinite.
    """
    counted = found.onset.values & (found.kind.values != RIGID_BODY) & np.isfinite(speeds)
    return np.where(counted, speeds, np.inf)


def _name_side(ax: Axes, line: Positions, room: Array, name: str, edge: Array) -> None:
    """Write the name of a side of the lowest boundary at the edge of this side, where the side has most room."""
    place = int(room.argmax())
    across, up = ax.transLimits.transform((line.values[place], edge[place]))
    is_above = up > 0
    style: dict[str, Any] = {"ha": "left" if across < 0.2 else "right" if across > 0.8 else "center"}
    style |= {"va": "top" if is_above else "bottom", "xytext": (0, -6 if is_above else 6)}
    style |= {"style": "italic", "color": "0.3", "fontsize": TITLE_SIZE, "path_effects": halo(), "zorder": 4}
    at = (float(np.clip(across, 0.02, 0.98)), float(up))
    ax.annotate(name, at, xycoords="axes fraction", textcoords="offset points", **style)


def _lowest(found: Dataset, line: Positions, speeds: Array, unit: str) -> str:
    """Return which boundary is the lowest of all values of the input, and where."""
    onsets = _onsets(found, speeds)
    if not np.isfinite(onsets).any():
        return "no mode becomes unstable in the search"
    row, place = np.unravel_index(int(onsets.argmin()), onsets.shape)
    mode, label = str(found["mode"].values[row, place]), str(found.branch.values[place])
    name = mode if label in (FIRST, mode) else f"{label} (here {mode})"
    speed = marked(f"{speeds[row, place]:.0f}", found.warning.values[row, place])
    value = f"{line.values[row]:.4g} {written(line.unit)}".rstrip()
    return f"lowest boundary: {name} at {speed} {unit} and {value}"


def _mode_of(label: str) -> str:
    """Return the mode in the label of a branch."""
    return label.partition(_ENDS)[0].partition(" (")[0]


def _name(ax: Axes, lines: list[Line2D], found: Dataset) -> None:
    """Write the names of lines beside the axes; along the line of the first instability, which mode it is."""
    for drawn, modes in zip(lines, found["mode"].values.T, strict=True):
        if drawn.get_label() == FIRST:
            known = np.flatnonzero(np.isfinite(np.asarray(drawn.get_ydata(), dtype=float)))
            for place in known[np.concatenate([[True], modes[known][1:] != modes[known][:-1]])]:
                _write(ax, drawn, int(place), str(modes[place]))
    label_lines(ax, [one for one in lines if one.get_label() != FIRST], "airspeed")


def _write(ax: Axes, drawn: Line2D, place: int, text: str) -> None:
    """Write a text above a point of a line, in its colour, to the side where the line does not rise."""
    x, y = np.asarray(drawn.get_xydata()).T
    style: dict[str, Any] = {"color": drawn.get_color(), "fontsize": LABEL_SIZE, "path_effects": halo()}
    near = y[max(0, place - 1) : place + 2]
    falls = bool(np.nanmax(near) > near[-1]) if np.isfinite(near[-1]) else bool(near[0] > y[place])
    left, right = np.array(ax.get_xlim()) @ [[0.85, 0.15], [0.15, 0.85]]
    rightwards = x[place] < left or (falls and x[place] < right)
    width = (_LETTER * LABEL_SIZE * len(text) + 4) / points_per_pixel(ax) / ax.bbox.width
    at_left = float(ax.transLimits.transform((x[place], y[place]))[0])
    if not rightwards and at_left < width < 1 - at_left:
        rightwards = True
    offset: dict[str, Any] = {"xytext": (4 if rightwards else -4, 5), "ha": "left" if rightwards else "right"}
    at = (float(x[place]), float(y[place]))
    ax.annotate(text, at, textcoords="offset points", annotation_clip=True, zorder=4, **offset, **style)


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
