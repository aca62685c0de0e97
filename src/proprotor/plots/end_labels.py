"""Names of lines beside the axes, each joined to the end of its line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from proprotor.plots import small_print
from proprotor.plots.canvas import note, points_per_pixel
from proprotor.plots.style import GREY, LABEL_SIZE
from proprotor.typing import Array, Axes, Line2D

_LINE_SPACING = 1.3
_BROAD = 1.5  # points: thinner lines have their names in grey
_NEAR = 0.02  # of the width of the axes: a line that ends so near their edge is joined to its name
_START, _RIGHTMOST = (
    1.095,
    0.99,
)  # where names start, in widths of the axes; where they end, in widths of the figure
_LEAST = 0.3  # of the width of a figure: axes do not become narrower for the sake of names
_labels: WeakKeyDictionary[Axes, list[Any]] = WeakKeyDictionary()  # what stands beside axes


def label_lines(
    ax: Axes,
    lines: Sequence[Line2D],
    quantity: str,
    *,
    tie: bool = True,
    more: Mapping[Line2D, str] | None = None,
) -> None:
    """Write the name of each line to the right of the axes, in place of names that stand there already.

    Call this function when the limits of the axes are set, with all lines that are to have names. The names of thin
    lines are grey. An arrow follows the name of a line whose end lies beyond the axes. With `tie` a thin line joins
    each name to its line, if the line ends at the right edge of the axes: nothing is drawn where nothing is known.
    Without `tie` names only stand in the order of the ends. Small print names the lines of which no point lies within
    the axis of the `quantity`. What `more` has of a line is written after its name.
    """
    for old in _labels.pop(ax, []):
        old.remove()
    ends = {line: _end(ax, line) for line in lines if _is_seen(ax, line)}
    spacing = _LINE_SPACING * LABEL_SIZE / points_per_pixel(ax) / ax.bbox.height
    heights = _spread(np.array([np.clip(y, 0, 1) for _, y, _ in ends.values()]), spacing)
    written = _labels.setdefault(ax, [])
    for (line, (x, y, whole)), height in zip(ends.items(), heights, strict=True):
        joined = tie and whole and x > 1 - _NEAR
        written += _write(ax, line, (x, y) if joined else None, height)
        beyond = " ↑" if y > 1 else " ↓" if y < 0 else ""
        style: dict[str, Any] = {} if line.get_linewidth() >= _BROAD else {"color": GREY}
        style |= {"fontsize": LABEL_SIZE, "va": "center", "parse_math": False, "clip_on": False}
        name = ", ".join(filter(None, (str(line.get_label()), (more or {}).get(line)))) + beyond
        written.append(ax.text(_START, height, name, transform=ax.transAxes, **style))
    _make_room(ax, [artist for artist in written if hasattr(artist, "get_text")])
    outside = [str(line.get_label()) for line in lines if line not in ends]
    if outside:
        note(ax, f"Beyond the axis of {quantity}: {', '.join(outside)}")


def _write(ax: Axes, line: Line2D, end: tuple[float, float] | None, height: float) -> list[Any]:
    """Draw a sample of a line at a height, joined to the end of the line if one is given; return what was drawn."""
    beside: dict[str, Any] = {"transform": ax.transAxes, "clip_on": False}
    (sample,) = ax.plot([1.03, 1.0575, 1.085], [height] * 3, markevery=[1], **beside)
    sample.update_from(line)
    sample.set(label="_sample", clip_path=None, **beside)
    if end is None:
        return [sample]
    edge = np.clip(end[1], 0, 1)
    start = end[0] if end[1] == edge else 1
    style = beside | {"color": line.get_color(), "linewidth": 0.6}
    return [sample, *ax.plot([start, 1, 1.03], [edge, edge, height], **style)]


def _make_room(ax: Axes, names: Sequence[Any]) -> None:
    """Make the axes of a figure that this room made so narrow that all names stand within the figure."""
    figure = ax.get_figure(root=True)
    if figure is None or not small_print.is_own(figure) or figure.get_layout_engine() is not None:
        return
    width = max((name.get_window_extent().width for name in names), default=0.0) / figure.bbox.width
    left = figure.subplotpars.left
    right = left + (_RIGHTMOST - width - left) / _START
    if left + _LEAST < right < figure.subplotpars.right:
        figure.subplots_adjust(right=right)


def _is_seen(ax: Axes, line: Line2D) -> bool:
    """Return whether a point of a line lies within the axes."""
    points = _in_axes(ax, line)
    return bool(((points >= 0) & (points <= 1)).all(axis=0).any())


def _in_axes(ax: Axes, line: Line2D) -> Array:
    """Return the points of a line (2, points) in fractions of the axes, without the last digits, which are rounding."""
    return np.round(ax.transLimits.transform(np.asarray(line.get_xydata(), dtype=float)).T, 9)


def _end(ax: Axes, line: Line2D) -> tuple[float, float, bool]:
    """Return the last point of a line in fractions of the axes, and whether no unknown point comes after it."""
    x, y = _in_axes(ax, line)
    last = np.flatnonzero(np.isfinite(y))[-1]
    return x[last], y[last], bool(last == len(y) - 1)


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
