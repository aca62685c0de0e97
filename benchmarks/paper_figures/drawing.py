"""Draw figures that can be read in print and without colour vision."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from benchmarks.paper_figures.content import Content, Mark

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Okabe and Ito's colours without yellow, each with a dash pattern.
_STYLES: tuple[dict[str, Any], ...] = (
    {"color": "#000000", "linestyle": "-", "linewidth": 2.2},
    {"color": "#D55E00", "linestyle": "--", "linewidth": 1.8},
    {"color": "#0072B2", "linestyle": "-.", "linewidth": 1.8},
    {"color": "#009E73", "linestyle": (0, (1, 1.2)), "linewidth": 2.2},
    {"color": "#CC79A7", "linestyle": (0, (7, 2, 1, 2, 1, 2)), "linewidth": 1.8},
)
_BAND, _PUBLISHED, _GREY = "#56B4E9", "#E69F00", "0.35"
_WIDTH, _LEFT, _RIGHT, _TOP, _AXES = 7.2, 0.75, 0.2, 0.42, 3.6  # inches
_LINE, _NOTE_LINE = 0.19, 0.125  # inches a line of legend and of notes takes
_LEGEND_COLUMNS, _NOTE_COLUMNS = 92, 128  # characters


def draw(content: Content) -> Figure:
    """Return the figure: axes, a legend below the axes, and below the legend the notes.

    Returns
    -------
    matplotlib.figure.Figure
        Not registered with pyplot; `save` writes the figure.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg  # here: slow to import
    from matplotlib.figure import Figure

    notes = [line for note in content.notes for line in textwrap.wrap(note, _NOTE_COLUMNS)]
    labels = _legend_lines(content)
    below = 0.62 + _LINE * labels + _NOTE_LINE * len(notes) + 0.12
    height = _TOP + _AXES + below
    figure = Figure(figsize=(_WIDTH, height))
    FigureCanvasAgg(figure)
    ax = figure.add_axes((_LEFT / _WIDTH, below / height, (_WIDTH - _LEFT - _RIGHT) / _WIDTH, _AXES / height))
    _dress(ax, content)
    _draw_content(ax, content)
    handles, names = ax.get_legend_handles_labels()
    names = [textwrap.fill(name, _LEGEND_COLUMNS) for name in names]
    place = (0.0, -0.52 / _AXES)
    ax.legend(
        handles, names, loc="upper left", bbox_to_anchor=place, frameon=False, fontsize=8, handlelength=3.4,
        borderaxespad=0, labelspacing=0.35,
    )  # fmt: skip
    figure.text(_LEFT / _WIDTH, 0.08 / height, "\n".join(notes), fontsize=6.5, color=_GREY, va="bottom")
    return figure


def save(content: Content, file: IO[bytes], dpi: int = 150) -> None:
    """Draw a figure into a PNG file; the same figure gives the same bytes."""
    draw(content).savefig(file, format="png", dpi=dpi, metadata={"Software": None})


def _legend_lines(content: Content) -> int:
    labels = [curve.label or curve.name for curve in content.curves]
    labels += [content.band.label] if content.band else []
    labels += [mark.label for mark in content.marks] + [point[2] for point in content.points]
    return sum(len(textwrap.wrap(label, _LEGEND_COLUMNS)) for label in labels)


def _dress(ax: Axes, content: Content) -> None:
    ax.set_title(f"Fig. {content.number}  {content.title}", loc="left", fontsize=10)
    ax.set_xlim(*content.x_limits)
    ax.set_ylim(*content.y_limits)
    ax.set_xlabel("Velocity (kt)", labelpad=2)
    ax.set_ylabel(content.quantity + ("" if content.unit == "1" else f" ({content.unit})"))
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    if content.y_limits[0] < 0:
        ax.axhline(0, color="black", linewidth=0.8)
    if content.assumed:
        place: dict[str, Any] = {
            "x": 1.0,
            "y": -0.42 / _AXES,
            "transform": ax.transAxes,
            "ha": "right",
            "va": "center",
        }
        frame = {"facecolor": "white", "edgecolor": "0.6", "pad": 2.5}
        ax.text(s="rests on assumed inputs", **place, fontsize=9, fontstyle="italic", bbox=frame)


def _draw_content(ax: Axes, content: Content) -> None:
    for curve, style in zip(content.curves, _STYLES, strict=False):
        ax.plot(curve.airspeed, curve.values, label=curve.label or curve.name, **style)
    for x, y, label in content.points:
        if np.isfinite(x):
            ax.plot([x], [y], "o", color="white", markeredgecolor="black", zorder=4, label=label)
    for mark in content.marks:
        _mark(ax, mark)
    if band := content.band:
        ax.fill_between(
            band.airspeed, band.low, band.high, color=_BAND, alpha=0.3, linewidth=0, label=band.label
        )
        ax.plot(band.airspeed, band.median, color=_BAND, linewidth=1.1)


def _mark(ax: Axes, mark: Mark) -> None:
    low, high = min(mark.airspeeds), max(mark.airspeeds)
    ax.axvspan(
        low, high, color=_PUBLISHED, alpha=0.28, linewidth=0, label=textwrap.fill(mark.label, _LEGEND_COLUMNS)
    )
    for speed in mark.airspeeds:
        ax.axvline(speed, color=_PUBLISHED, linewidth=0.7)


def draw_intervals(
    rows: Sequence[tuple[str, float, float, float, float]],
    mark: Mark,
    label: str,
    file: IO[bytes],
    dpi: int = 150,
) -> None:
    """Draw intervals side by side into a PNG file: name, nominal, 5, 50 and 95 % of each, and published values."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    height = 1.3 + 0.42 * len(rows)
    figure = Figure(figsize=(_WIDTH, height), layout="constrained")
    FigureCanvasAgg(figure)
    ax = figure.add_subplot()
    _mark(ax, mark)
    for place, (_, nominal, low, median, high) in enumerate(rows):
        first = place == 0
        ax.plot([low, high], [place] * 2, color=_BAND, linewidth=9, solid_capstyle="butt", alpha=0.6,
                label="5 to 95 % of the sample" if first else None)  # fmt: skip
        ax.plot([median], [place], "|", color="#0072B2", markersize=13, markeredgewidth=2,
                label="median" if first else None)  # fmt: skip
        ax.plot([nominal], [place], "o", color="black", markersize=6, label="nominal" if first else None)
        ax.annotate(
            f"{nominal:.0f}", (nominal, place), (0, 9), textcoords="offset points", ha="center", fontsize=8
        )
    ax.set_yticks(range(len(rows)), [row[0] for row in rows], fontsize=8)
    ax.set_ylim(len(rows) - 0.4, -0.9)
    ax.set_xlabel(label)
    ax.grid(axis="x", color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    figure.legend(*ax.get_legend_handles_labels(), loc="outside lower left", fontsize=8, frameon=False)
    ax.set_title("rests on assumed inputs", loc="right", fontsize=9, fontstyle="italic")
    figure.savefig(file, format="png", dpi=dpi, metadata={"Software": None})
