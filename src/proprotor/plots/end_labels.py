"""Names of lines beside the axes, each joined to the end of its line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from proprotor.plots.canvas import note, points_per_pixel
from proprotor.plots.style import LABEL_SIZE, ModeStyle
from proprotor.typing import Array, Axes, Line2D

_LINE_SPACING = 1.3


def label_lines(ax: Axes, lines: Sequence[Line2D], where: str, *, tie: bool = True) -> None:
    """Write the name of each line to the right of the axes, and the names of lines that leave the axes above them.

    Call this function when the limits of the axes are set. Lines of which no point lies within the axes have no label
    beside the axes; an arrow follows the name of a line whose end lies beyond. With `tie` a thin line joins each label
    to the end of its line; without `tie` the labels only stand in the order of the ends. The note above the axes says
    `where` lines leave the axes.
    """
    ends = {line: _end(ax, line) for line in lines if _is_seen(ax, line)}
    spacing = _LINE_SPACING * LABEL_SIZE / points_per_pixel(ax) / ax.bbox.height
    heights = _spread(np.array([np.clip(y, 0, 1) for _, y in ends.values()]), spacing)
    beside: dict[str, Any] = {"transform": ax.transAxes, "clip_on": False}
    for (line, (x, y)), height in zip(ends.items(), heights, strict=True):
        if tie:
            edge = np.clip(y, 0, 1)
            start = x if y == edge else 1
            ax.plot([start, 1, 1.03], [edge, edge, height], color=line.get_color(), linewidth=0.6, **beside)
        sample = {name: getattr(line, f"get_{name}")() for name in (*ModeStyle._fields, "markersize")}
        ax.plot([1.03, 1.0575, 1.085], [height] * 3, markevery=[1], **sample, **beside)
        beyond = " ↑" if y > 1 else " ↓" if y < 0 else ""
        ax.text(1.095, height, f"{line.get_label()}{beyond}", fontsize=LABEL_SIZE, va="center", **beside)
    outside = [str(line.get_label()) for line in lines if _leaves(ax, line)]
    if outside:
        note(ax, f"Beyond this axis, {where}: {', '.join(outside)}")


def _is_seen(ax: Axes, line: Line2D) -> bool:
    """Return whether a point of a line lies within the axes."""
    points = _in_axes(ax, line)
    return bool(((points >= 0) & (points <= 1)).all(axis=0).any())


def _leaves(ax: Axes, line: Line2D) -> bool:
    """Return whether a point of a line lies beyond the axes."""
    points = _in_axes(ax, line)
    return bool(((points < 0) | (points > 1)).any())


def _in_axes(ax: Axes, line: Line2D) -> Array:
    """Return the points of a line (2, points) in fractions of the axes, without the last digits, which are rounding."""
    return np.round(ax.transLimits.transform(np.asarray(line.get_xydata(), dtype=float)).T, 9)


def _end(ax: Axes, line: Line2D) -> tuple[float, float]:
    """Return the last point of a line in fractions of the axes."""
    x, y = _in_axes(ax, line)
    last = np.flatnonzero(np.isfinite(y))[-1]
    return x[last], y[last]


def _spread(heights: Array, spacing: float) -> Array:
    """Return heights within 0 to 1 that are near the given heights, in the same order, and at least `spacing` apart."""
    if not len(heights):
        return heights
    from scipy.optimize import isotonic_regression  # here, because scipy.optimize takes long to import

    order = np.argsort(heights, kind="stable")
    steps = spacing * np.arange(len(heights))
    # y_i+1 - y_i >= spacing means that y_i - i spacing increases: isotonic regression gives the nearest such heights.
    found = np.empty_like(heights)
    found[order] = np.clip(isotonic_regression(heights[order] - steps).x, 0, max(0, 1 - steps[-1])) + steps
    return found
