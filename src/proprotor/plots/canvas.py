"""The axes of a plot, and what is told beneath them: lines that are not drawn, the origin of the numbers, doubts."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from proprotor.case import Case
from proprotor.model import stamp
from proprotor.model.doubts import MARK, doubts_along, footnotes
from proprotor.model.provenance import reservations
from proprotor.plots import small_print
from proprotor.plots.line_of_sweep import Positions, written
from proprotor.plots.style import LABEL_SIZE, TITLE_SIZE, UNSTABLE, white_box
from proprotor.typing import Axes, Dataset, Figure

Limits = tuple[float, float]  # ends of an axis
_HEADLINE = 80  # letters of a line above axes
_RIGHT = 0.75  # right edge of the axes as a share of the width, if labels stand beside the axes


def axes_or_new(ax: Axes | None, *, size: tuple[float, float] = (8, 5), labels_beside: bool = False) -> Axes:
    """Return the given axes, or the axes of a new figure whose size is in inches.

    With `labels_beside` the new axes leave room for labels to their right; otherwise the margins fit the texts.
    """
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt  # here, because matplotlib takes long to import

    figure, ax = plt.subplots(figsize=size, layout=None if labels_beside else "constrained")
    if labels_beside:
        figure.subplots_adjust(left=0.09, right=_RIGHT, bottom=0.55 / size[1], top=1 - 0.4 / size[1])
    small_print.own(figure)
    return ax


def two_axes(size: tuple[float, float]) -> tuple[Figure, tuple[Axes, Axes]]:
    """Return a new figure, its size in inches, with two axes above each other that leave room for labels beside."""
    import matplotlib.pyplot as plt

    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=size)
    figure.subplots_adjust(left=0.09, right=_RIGHT, top=1 - 0.2 / size[1], bottom=0.5 / size[1], hspace=0.1)
    small_print.own(figure)
    return figure, (above, below)


def write_headline(ax: Axes, text: str) -> None:
    """Write the one thing that a plot shows above axes of a figure that this room made, where a title may replace it.

    A title that the user has set stays.
    """
    title = ax.title
    if not small_print.is_own(ax.get_figure(root=True)) or title.get_text() not in ("", title.get_label()):
        return
    lines = "\n".join(textwrap.wrap(text, _HEADLINE))
    style: dict[str, Any] = {"fontsize": LABEL_SIZE + 1, "fontweight": "bold", "parse_math": False}
    ax.set_title(lines, loc="center", **style)
    title.set_label(lines)


def write_title(figure: Figure, title: str, second: str = "") -> None:
    """Write a title above the axes of a figure of `two_axes`, and a second line in smaller letters."""
    height = figure.get_size_inches()[1]
    room = 0.2 + (0.22 if title else 0) + (0.2 if second else 0)  # inches
    figure.subplots_adjust(top=1 - room / height)
    left: dict[str, Any] = {"x": 0.09, "ha": "left", "va": "top", "parse_math": False}
    if title:
        figure.suptitle(title, y=1 - 0.1 / height, fontsize=TITLE_SIZE, **left)
    if second:
        y = 1 - (0.34 if title else 0.1) / height
        figure.text(left.pop("x"), y, second, fontsize=LABEL_SIZE + 1, fontweight="bold", **left)


def grid(ax: Axes) -> None:
    """Draw a faint grid behind everything."""
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)


def name_unstable(ax: Axes) -> None:
    """Name the shaded ground below zero damping; lines that pass behind the word leave it readable."""
    ground = white_box(1.0) | {"facecolor": UNSTABLE}
    place: dict[str, Any] = {"xycoords": "axes fraction", "xytext": (4, 4), "textcoords": "offset points"}
    ax.annotate("unstable", (0, 0), fontsize=LABEL_SIZE, color="0.3", bbox=ground, zorder=3, **place)


def points_per_pixel(ax: Axes) -> float:
    """Return the size of a pixel of the figure in points, 1/72 inch."""
    figure = ax.get_figure(root=True)
    return 72 / (figure.dpi if figure else 72)


def note(ax: Axes, text: str) -> None:
    """Add a sentence on the drawing to the small print beneath the axes."""
    small_print.add(ax, f"{text[:1].upper()}{text[1:].removesuffix('.')}.")


def _origin_of(attributes: Mapping[Any, Any], doubts: Iterable[str]) -> str:
    """Return the case of the numbers, its options, and a sentence for each doubt about the numbers."""
    return " ".join((stamp.line(attributes), *(f"{MARK} {doubt}" for doubt in doubts))).strip()


def say_origin(ax: Axes, attributes: Mapping[Any, Any], doubts: Iterable[str] = ()) -> None:
    """Write the case, the options and the doubts of the numbers in small print beneath the axes."""
    small_print.add(ax, _origin_of(attributes, doubts))


def along(results: Dataset, line: Positions) -> Iterator[str]:
    """Yield a sentence for each doubt along the line of a sweep, in the unit of its axis."""
    if "warning" in results:
        found = doubts_along(results[line.name].values, results.warning.values)
        yield from footnotes(found, written(line.unit), line.factor)


def rests_on(ax: Axes, case: Case, *more: str) -> Axes:
    """Write beneath a plot how far the numbers of a case can be trusted: doubtful inputs and calibration.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        Axes of the figure. The figure grows by the lines of the note; the plots keep their size.
    case : Case
        The note counts the doubtful inputs of the case and says how the case was calibrated.
    *more : str
        Further sentences, which stand before the others.

    Returns
    -------
    matplotlib.axes.Axes
        The given axes.
    """
    if (figure := ax.get_figure(root=True)) is not None:
        small_print.own(figure)
    small_print.add(ax, *more, first=True)
    small_print.add(ax, *reservations(case))
    return ax
