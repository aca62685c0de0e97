"""The axes of a plot, and the notes around them: lines that are not drawn above, the origin of the numbers beneath."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from proprotor.case import Case
from proprotor.errors import printable
from proprotor.model import stamp
from proprotor.model.doubts import MARK, doubts_along, footnotes
from proprotor.model.provenance import reservations
from proprotor.plots.line_of_sweep import Positions, written
from proprotor.plots.style import GREY, LABEL_SIZE
from proprotor.typing import Axes, Dataset, Figure

Limits = tuple[float, float]  # ends of an axis
RIGHT = 0.75  # right edge of the axes as a share of the width, if labels stand beside the axes
_NOTE_SIZE = 7  # points
_INCHES = _NOTE_SIZE * 1.25 / 72  # between lines of the note
_LETTERS_PER_INCH = 16.0
_SMALL_SIZE = 5.5  # points
_BELOW = 36.0  # points: from the axes down to the small print, past the label of the axes
_SMALL_LETTERS_PER_INCH = 26.0


def axes_or_new(ax: Axes | None, *, size: tuple[float, float] = (8, 5), labels_beside: bool = False) -> Axes:
    """Return the given axes, or the axes of a new figure whose size is in inches.

    With `labels_beside` the new axes leave room for labels to their right; otherwise the margins fit the texts.
    """
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt  # here, because matplotlib takes long to import

    if not labels_beside:
        return plt.subplots(figsize=size, layout="constrained")[1]
    figure, ax = plt.subplots(figsize=size)
    figure.subplots_adjust(left=0.09, right=RIGHT, bottom=0.7 / size[1], top=1 - 0.6 / size[1])
    return ax


def grid(ax: Axes) -> None:
    """Draw a faint grid behind everything."""
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)


def points_per_pixel(ax: Axes) -> float:
    """Return the size of a pixel of the figure in points, 1/72 inch."""
    figure = ax.get_figure(root=True)
    return 72 / (figure.dpi if figure else 72)


def note(ax: Axes, text: str) -> None:
    """Add a note in small print above the axes, on the left, below earlier notes."""
    notes = "\n".join(filter(None, (ax.get_title(loc="left"), textwrap.fill(text, 110))))
    ax.set_title(notes, loc="left", fontsize=LABEL_SIZE, color="0.3", parse_math=False)


def origin_of(attributes: Mapping[Any, Any], doubts: Iterable[str]) -> str:
    """Return the case of the numbers, its options, and a sentence for each doubt about the numbers."""
    return " ".join((stamp.line(attributes), *(f"{MARK} {doubt}" for doubt in doubts))).strip()


def say_origin(ax: Axes, attributes: Mapping[Any, Any], doubts: Iterable[str] = ()) -> None:
    """Write `origin_of` the numbers in small print beneath the axes."""
    text = origin_of(attributes, doubts)
    figure = ax.get_figure(root=True)
    if not text or figure is None:
        return
    inches = ax.get_position().width * figure.get_size_inches()[0]
    lines = textwrap.wrap(printable(text), max(40, int(_SMALL_LETTERS_PER_INCH * inches)))
    style: dict[str, Any] = {"fontsize": _SMALL_SIZE, "color": "0.5", "va": "top", "parse_math": False}
    place: dict[str, Any] = {"xycoords": "axes fraction", "textcoords": "offset points"}
    ax.annotate("\n".join(lines), (0, 0), xytext=(0, -_BELOW), annotation_clip=False, **place, **style)


def along(results: Dataset, line: Positions) -> Iterator[str]:
    """Yield a sentence for each doubt along the line of a sweep, in the unit of its axis."""
    if "warning" in results:
        found = doubts_along(results[line.name].values, results.warning.values)
        yield from footnotes(found, written(line.unit), line.factor)


def rests_on(ax: Axes, case: Case, *more: str) -> Axes:
    """Write beneath a figure how far the numbers of a case can be trusted: doubtful inputs and calibration.

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
    add_footer(ax.get_figure(root=True), " ".join((*more, *reservations(case))))
    return ax


def add_footer(figure: Figure | None, text: str) -> None:
    """Add a note at the bottom of a figure, which grows by the lines of the note."""
    if figure is None or not text:
        return
    width, height = figure.get_size_inches()
    lines = textwrap.wrap(text, max(20, int(_LETTERS_PER_INCH * (width - 0.4))))
    share = ((len(lines) + 1) * _INCHES) / (height + (len(lines) + 1) * _INCHES)
    figure.set_size_inches(width, height / (1 - share))
    engine: Any = figure.get_layout_engine()
    if engine is None:
        kept = figure.subplotpars
        bottom, top = (share + (1 - share) * part for part in (kept.bottom, kept.top))
        figure.subplots_adjust(bottom=bottom, top=top)
    else:
        engine.set(rect=(0, share, 1, 1 - share))
    style: dict[str, Any] = {"fontsize": _NOTE_SIZE, "va": "bottom", "color": GREY, "parse_math": False}
    figure.text(0.2 / width, 0.5 * _INCHES * (1 - share) / height, "\n".join(lines), **style)
