"""Points of a CSV file on a plot: a marker for each point, with its error bars, and a legend of the labels."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import Any

import numpy as np

from proprotor.plots.style import LABEL_SIZE
from proprotor.tables.points import Column, Points, Quantity
from proprotor.typing import Array, Axes

_MARKERS = "oDs^vP*X"
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
    for place, label in enumerate(dict.fromkeys(points.label[there].tolist())):
        own = there & (points.label == label)
        sources = list(dict.fromkeys(filter(None, points.source[own].tolist())))
        text = textwrap.fill(f"{label}, {'; '.join(sources)}" if sources else label, _WIDTH)
        series.append(_draw_series(ax, x, y, own, place, text))
    _widen(ax, [(x, there), (y, there)])
    if series:
        ax.legend(handles=series, fontsize=LABEL_SIZE, loc="best", framealpha=0.9).set_zorder(8)
    return bool(series)


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


def _has_bars(column: Column, own: Array) -> bool:
    return bool((column.high[own] > column.low[own]).any())


def _lengths(column: Column, own: Array) -> Array:
    """Return how far the error bars of some points reach down and up (2, points)."""
    return np.stack([column.values[own] - column.low[own], column.high[own] - column.values[own]])


def _widen(ax: Axes, columns: Sequence[tuple[Column, Array]]) -> None:
    """Widen the limits of the axes so that they hold all points, with a little room."""
    for (column, there), limits, put in zip(
        columns, (ax.get_xlim(), ax.get_ylim()), (ax.set_xlim, ax.set_ylim), strict=True
    ):
        low, high = column.low[there], column.high[there]
        room = 0.03 * abs(limits[1] - limits[0])
        least = min([limits[0], *(low[low < limits[0]] - room).tolist()])
        most = max([limits[1], *(high[high > limits[1]] + room).tolist()])
        put(least, most)
