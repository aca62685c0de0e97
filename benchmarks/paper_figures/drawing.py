"""Draw figures that can be read in print and without colour vision, in the style sheet of the product's plots."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from functools import partial
from typing import IO, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.transforms import ScaledTranslation

from benchmarks import pictures
from benchmarks.paper_figures.content import Content, Curve, Mark
from proprotor.plots.canvas import name_unstable
from proprotor.plots.line_of_sweep import Positions
from proprotor.plots.mode_lines import mark_failed
from proprotor.plots.style import COLOURS, LABEL_SIZE, UNSTABLE, in_style, white_box
from proprotor.units import KNOT

_BAND, _PUBLISHED = COLOURS[6], "0.45"
_ASSUMED = "rests on assumed inputs"
_WIDTH, _AXES, _LINE = (
    7.2,
    4.3,
    0.19,
)  # inches: of a figure, of title, axes and labels, of a line of the legend
_LEGEND_COLUMNS = 96  # characters
_LEGEND_BELOW = 34.0  # points from the axes down to the legend


@in_style
def draw(content: Content) -> Figure:
    """Return the figure: axes, a legend below them, and the notes in small print; `save` writes the figure."""
    figure, (ax,) = pictures.panels(1, _WIDTH, _AXES + _LINE * _legend_lines(content))
    _dress(ax, content)
    _draw_content(ax, content)
    handles, names = ax.get_legend_handles_labels()
    below = ax.transAxes + ScaledTranslation(0, -_LEGEND_BELOW / 72, figure.dpi_scale_trans)
    ax.legend(
        handles, [textwrap.fill(name, _LEGEND_COLUMNS) for name in names], loc="upper left", frameon=False,
        bbox_to_anchor=(0.0, 0.0), bbox_transform=below, handlelength=4, borderaxespad=0, labelspacing=0.35,
    )  # fmt: skip
    pictures.tell(ax, *content.notes)
    return figure


def save(content: Content, file: IO[bytes], dpi: int = 150) -> None:
    """Draw a figure into a PNG file; the same figure gives the same bytes."""
    pictures.save(partial(draw, content), file, dpi)


def _legend_lines(content: Content) -> int:
    labels = [curve.label or curve.name for curve in content.curves]
    labels += [content.band.label] if content.band else []
    labels += [mark.label for mark in content.marks] + [point[2] for point in content.points]
    return sum(len(textwrap.wrap(label, _LEGEND_COLUMNS)) for label in labels)


def _dress(ax: Axes, content: Content) -> None:
    ax.set_title(f"Fig. {content.number}  {content.title}", pad=20 if content.assumed else None, fontsize=10)
    ax.set_xlim(*content.x_limits)
    ax.set_ylim(*content.y_limits)
    ax.set_xlabel("Airspeed, KTAS")
    ax.set_ylabel(content.quantity + ("" if content.unit == "1" else f" ({content.unit})"))
    if content.y_limits[0] < 0:
        ax.axhline(0, color="black", linewidth=0.8)
    if content.is_damping:
        ax.axhspan(content.y_limits[0], 0, color=UNSTABLE, linewidth=0, zorder=0.5)
        name_unstable(ax)
    if content.assumed:
        _say_assumed(ax)


def _say_assumed(ax: Axes) -> None:
    """Say above the axes, below the title, that some inputs were assumed."""
    place: dict[str, Any] = {"xycoords": "axes fraction", "textcoords": "offset points", "va": "bottom"}
    ax.annotate(_ASSUMED, (0, 1), xytext=(0, 5), fontstyle="italic", fontsize=LABEL_SIZE + 1, **place)


def _draw_content(ax: Axes, content: Content) -> None:
    for place, curve in enumerate(content.curves):
        pictures.draw_case(ax, curve.airspeed, curve.values, place, curve.label or curve.name)
    _mark_boundaries(ax, content.curves)
    for x, y, label in content.points:
        if np.isfinite(x):
            ax.plot([x], [y], "o", color="white", markeredgecolor="black", zorder=4, label=label)
    for mark in content.marks:
        _mark(ax, mark)
        middle = (min(mark.airspeeds) + max(mark.airspeeds)) / 2
        above: dict[str, Any] = {"transform": ax.get_xaxis_transform(), "ha": "center", "va": "top"}
        ax.text(middle, 0.975, "published", fontsize=LABEL_SIZE, bbox=white_box(1.5), zorder=3, **above)
    if band := content.band:
        ax.fill_between(
            band.airspeed, band.low, band.high, color=_BAND, alpha=0.3, linewidth=0, label=band.label
        )
        ax.plot(band.airspeed, band.median, color=_BAND, linewidth=1.1)
    first = content.curves[0]
    line = Positions("airspeed", first.airspeed, "ktas", KNOT, ax.get_xlabel())
    mark_failed(ax, line, np.isnan(first.values), first=True)


def _mark_boundaries(ax: Axes, curves: Sequence[Curve]) -> None:
    """Draw a circle where the damping of a curve falls through zero."""
    found = [curve.boundary for curve in curves if np.isfinite(curve.boundary)]
    if found:
        ax.plot(found, [0.0] * len(found), "o", color="white", markeredgecolor="black", zorder=5)
        pictures.tell(ax, "Circles: boundaries.")


def _mark(ax: Axes, mark: Mark) -> None:
    low, high = min(mark.airspeeds), max(mark.airspeeds)
    label = textwrap.fill(mark.label, _LEGEND_COLUMNS)
    ax.axvspan(low, high, facecolor="0.85", edgecolor=_PUBLISHED, hatch="\\\\\\\\", linewidth=0, label=label,
               zorder=0.8)  # fmt: skip
    for speed in mark.airspeeds:
        ax.axvline(speed, color=_PUBLISHED, linewidth=0.7, zorder=0.8)


@in_style
def intervals(
    rows: Sequence[tuple[str, float, float, float, float]], mark: Mark, label: str, notes: Sequence[str] = ()
) -> Figure:
    """Return a figure of intervals above one another: name, nominal, 5, 50 and 95 % of each, and published values."""
    figure, (ax,) = pictures.panels(1, _WIDTH, 1.9 + 0.45 * len(rows))
    _mark(ax, mark)
    for place, (_, nominal, low, median, high) in enumerate(rows):
        told = [None] * 3 if place else ["5 to 95 % of the sample", "median", "nominal"]
        ax.barh(place, high - low, 0.3, low, color=_BAND, alpha=0.6, label=told[0])
        ax.plot([median], [place], "|", color=COLOURS[1], markersize=13, markeredgewidth=2, label=told[1])
        ax.plot([nominal], [place], "o", color="black", markersize=6, label=told[2])
        above: dict[str, Any] = {"textcoords": "offset points", "ha": "center", "fontsize": LABEL_SIZE}
        ax.annotate(f"{nominal:.0f}", (nominal, place), (0, 7), **above)
    ax.set_yticks(range(len(rows)), [row[0] for row in rows])
    ax.set_ylim(len(rows) - 0.6, -0.9)
    ax.set_xlabel(label)
    ax.grid(visible=False, axis="y")
    below = ax.transAxes + ScaledTranslation(0, -_LEGEND_BELOW / 72, figure.dpi_scale_trans)
    ax.legend(loc="upper right", frameon=False, bbox_to_anchor=(1.0, 0.0), bbox_transform=below, ncols=1)
    _say_assumed(ax)
    pictures.tell(ax, *notes)
    return figure
