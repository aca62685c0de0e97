"""Points of a CSV file on a plot: a marker for each point, with its error bars, and a legend of the labels."""

from __future__ import annotations

import textwrap
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.plots.line_of_sweep import Positions
from proprotor.plots.style import LABEL_SIZE
from proprotor.tables.points import FREQUENCY, Column, Points, Quantity
from proprotor.typing import Array, Axes
from proprotor.units import KEAS, speed_factor

_MARKERS = "D^sovP*X"
_FILLS = ("white", "#FFD166", "#9AD1D4", "0.75")  # on white, on grey and in print all differ from the lines
_WIDTH = 44  # characters of a line of the legend


def draw_points(
    ax: Axes, points: Points | None, across: Quantity, up: Quantity, *, needed: bool = True
) -> bool:
    """Draw points of a file on axes, and return whether the file has any for these axes.

    Call this function when the limits of the axes are set; points beyond the limits widen the axes.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
    points : Points, optional
        Of `proprotor.tables.points.read_points`; nothing is drawn without.
    across, up : Quantity
        What the axes show, and in which unit.
    needed : bool
        Whether a file without columns for both axes is refused, and not passed over.

    Raises
    ------
    InputError
        For a file without columns for the axes, and a unit that is not of the quantity of its axis.
    """
    if points is None:
        return False
    if needed:
        points.check(across, [up])
    columns = points.on_axes(across, up)
    if columns is None:
        return False
    x, y = columns
    there = np.isfinite(x.values) & np.isfinite(y.values)
    series = []
    for place, label in enumerate(dict.fromkeys(points.label.tolist())):  # one marker in all plots of a file
        own = there & (points.label == label)
        if not own.any():
            continue
        sources = list(dict.fromkeys(filter(None, points.source[own].tolist())))
        text = textwrap.fill(f"{label}, {'; '.join(sources)}" if sources else label, _WIDTH)
        series.append(_draw_series(ax, x, y, own, place, text))
    ax.set_xlim(*_widened(ax.get_xlim(), x, there))
    ax.set_ylim(*_widened(ax.get_ylim(), y, there))
    if series:
        _write_legend(ax, series)
    return bool(series)


def quantity_of(line: Positions, si_unit: str, density: float | None = None) -> Quantity:
    """Return the quantity of an axis of airspeeds or of an input, as a column of points may have it.

    With a density of the air, kg/m³, points may have equivalent airspeeds.
    """
    special = {"keas": float(speed_factor(KEAS, density))} if density and si_unit == "m/s" else {}
    return Quantity(line.name, si_unit, line.factor, special)


def frequency_quantity(line: Positions, rotor_speed: ArrayLike | None) -> Quantity:
    """Return the quantity of an axis of frequency, per revolution with a rotor speed (rad/s), in Hz without.

    A rotor speed may differ from position to position of the line (points,).
    """
    if rotor_speed is None:
        return Quantity(FREQUENCY, "rad/s", 2 * np.pi)
    order = np.argsort(line.values)
    across, omega = line.values[order] * line.factor, np.broadcast_to(rotor_speed, line.values.shape)[order]

    def per_rev(x: Array) -> Array:
        return np.asarray(np.interp(x, across, omega))

    return Quantity(FREQUENCY, "rad/s", per_rev, {"per rev": per_rev})


def _draw_series(ax: Axes, x: Column, y: Column, own: Array, place: int, label: str) -> Any:
    """Draw the points of one label, and return what the legend shows."""
    bars: dict[str, Any] = {
        name: _lengths(column, own) for name, column in (("xerr", x), ("yerr", y)) if _has_bars(column, own)
    }
    fill = _FILLS[place // len(_MARKERS) % len(_FILLS)]
    marker: dict[str, Any] = {
        "marker": _MARKERS[place % len(_MARKERS)],
        "markersize": 6.5,
        "markeredgewidth": 1.3,
    }
    style: dict[str, Any] = {"linestyle": "none", "color": "black", "markerfacecolor": fill, "zorder": 6}
    ends: dict[str, Any] = {"elinewidth": 1.1, "capsize": 3.0}
    return ax.errorbar(x.values[own], y.values[own], label=label, **bars, **marker, **style, **ends)


def _write_legend(ax: Axes, series: list[Any]) -> None:
    """Write the labels as they are: a dollar sign is no mathematics, an underscore in front hides nothing."""
    labels = [container.get_label() for container in series]
    legend = ax.legend(series, labels, fontsize=LABEL_SIZE, loc="best", framealpha=0.9)
    for text in legend.get_texts():
        text.set_parse_math(False)
    legend.set_zorder(8)


def _has_bars(column: Column, own: Array) -> bool:
    return bool((column.high[own] > column.low[own]).any())


def _lengths(column: Column, own: Array) -> Array:
    """Return how far the error bars of some points reach down and up (2, points)."""
    return np.stack([column.values[own] - column.low[own], column.high[own] - column.values[own]])


def _widened(limits: tuple[float, float], column: Column, there: Array) -> tuple[float, float]:
    """Return limits of an axis that hold all points, with room for whole markers."""
    room = 0.03 * abs(limits[1] - limits[0])
    low, high = column.low[there] - room, column.high[there] + room
    return min([limits[0], *low.tolist()]), max([limits[1], *high.tolist()])
