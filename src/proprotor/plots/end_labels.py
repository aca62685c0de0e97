"""Names of lines beside the axes, each tied to the end of its line."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.plots.canvas import note, points_per_pixel
from proprotor.plots.style import LABEL_SIZE, ModeStyle
from proprotor.typing import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

_LINE_SPACING = 1.3


def label_ends(ax: Axes, lines: Sequence[Line2D], *, tie: bool = True) -> None:
    """The name of each line to the right of the axes, tied to its end; an arrow where that lies beyond.

    Call it when the limits of the axes are set. Lines that are nowhere within them have no label. Without `tie` the
    labels stand in the order of the ends, and nothing is drawn from one to the other within the axes.
    """
    ends = {line: _end(ax, line) for line in lines if is_seen(ax, line)}
    spacing = _LINE_SPACING * LABEL_SIZE / points_per_pixel(ax) / ax.bbox.height
    heights = spread(np.array([np.clip(y, 0, 1) for _, y in ends.values()]), spacing)
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


def name_those_outside(ax: Axes, lines: Sequence[Line2D], where: str = "at some airspeeds or all") -> None:
    """A note above the axes that names the lines which leave them."""
    outside = [str(line.get_label()) for line in lines if _leaves(ax, line)]
    if outside:
        note(ax, f"Beyond this axis, {where}: {', '.join(outside)}")


def is_seen(ax: Axes, line: Line2D) -> bool:
    """Whether a point of a line lies within the axes."""
    x, y = _in_axes(ax, line)
    return bool(np.any((x >= 0) & (x <= 1) & (y >= 0) & (y <= 1)))


def _leaves(ax: Axes, line: Line2D) -> bool:
    x, y = _in_axes(ax, line)
    return bool(np.any((x < 0) | (x > 1) | (y < 0) | (y > 1)))


def _in_axes(ax: Axes, line: Line2D) -> Array:
    """Points of a line (2, points) in fractions of the axes, with a hair of rounding taken off."""
    return np.round(ax.transLimits.transform(np.asarray(line.get_xydata(), dtype=float)).T, 9)


def _end(ax: Axes, line: Line2D) -> tuple[float, float]:
    """The last point of a line in fractions of the axes."""
    x, y = _in_axes(ax, line)
    last = np.flatnonzero(np.isfinite(y))[-1]
    return x[last], y[last]


def spread(heights: Array, spacing: float) -> Array:
    """Heights within 0 to 1, `spacing` apart or more, in the order of the given ones and near them."""
    if not len(heights):
        return heights
    from scipy.optimize import isotonic_regression  # here, because it takes long to import

    order = np.argsort(heights, kind="stable")
    steps = spacing * np.arange(len(heights))
    # y_i+1 - y_i >= spacing is an increasing y_i - i spacing: the nearest one is isotonic regression
    found = np.empty_like(heights)
    found[order] = np.clip(isotonic_regression(heights[order] - steps).x, 0, max(0, 1 - steps[-1])) + steps
    return found
