"""Where plots are drawn: axes of their own when none are given, and the note beneath that says what they rest on."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from proprotor.errors import printable
from proprotor.model import stamp
from proprotor.model.doubts import MARK, doubts_along, footnotes
from proprotor.plots.line_of_sweep import Positions, written
from proprotor.plots.style import GREY, LABEL_SIZE

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from proprotor.case import Case

RIGHT = 0.75  # of the width, where labels stand beside the axes
_NOTE_SIZE = 7  # points
_INCHES = _NOTE_SIZE * 1.25 / 72  # between lines of the note
_LETTERS_PER_INCH = 16.0
_SMALL, _BELOW = 5.5, 36.0  # points: of the small print, and below the axes, under the label of theirs
_SMALL_LETTERS_PER_INCH = 26.0


def axes_or_new(ax: Axes | None, *, size: tuple[float, float] = (8, 5), labels_beside: bool = False) -> Axes:
    """The axes given, or those of a new figure of that size in inches.

    With `labels_beside` room is left to the right of the new ones; else margins follow what is drawn.
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
    """A faint grid behind everything."""
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)


def signed(value: float) -> str:
    """A change as it stands beside its bar: two digits, and its sign."""
    told = f"{value:+.0f}" if abs(value) >= 10 else f"{value:+.2g}"
    return told.replace("-", "−")


def points_per_pixel(ax: Axes) -> float:
    """Size of a pixel of the figure in points, 1/72 inch."""
    figure = ax.get_figure(root=True)
    return 72 / (figure.dpi if figure else 72)


def note(ax: Axes, text: str) -> None:
    """A line in small print above the axes, on the left, after what stands there already."""
    before = ax.get_title(loc="left")
    told = textwrap.fill(text, 110)
    style: dict[str, Any] = {"fontsize": LABEL_SIZE, "color": "0.3", "parse_math": False}
    ax.set_title("\n".join(filter(None, (before, told))), loc="left", **style)


def say_origin(ax: Axes, attributes: Mapping[Any, Any], doubts: Iterable[str] = ()) -> None:
    """Write in small print beneath some axes the case and the options of what is drawn, and what is doubtful in it."""
    text = " ".join((stamp.line(attributes), *(f"{MARK} {doubt}" for doubt in doubts))).strip()
    figure = ax.get_figure(root=True)
    if not text or figure is None:
        return
    inches = ax.get_position().width * figure.get_size_inches()[0]
    lines = textwrap.wrap(printable(text), max(40, int(_SMALL_LETTERS_PER_INCH * inches)))
    style: dict[str, Any] = {"fontsize": _SMALL, "color": "0.5", "va": "top", "parse_math": False}
    place: dict[str, Any] = {"xycoords": "axes fraction", "textcoords": "offset points"}
    ax.annotate("\n".join(lines), (0, 0), xytext=(0, -_BELOW), annotation_clip=False, **place, **style)


def along(results: xarray.Dataset, line: Positions) -> Iterator[str]:
    """Sentences on the doubts along the line of a sweep, in the unit of its axis."""
    if "warning" in results:
        found = doubts_along(results[line.name].values, results.warning.values)
        yield from footnotes(found, written(line.unit), line.factor)


def rests_on(ax: Axes, case: Case, *more: str) -> Axes:
    """Write beneath the figure of some axes what the numbers of a case rest on.

    Parameters
    ----------
    ax : matplotlib.axes.Axes
        The figure grows by the lines of the note; what is drawn keeps its size.
    case : Case
        Its doubtful inputs are counted, and its calibration is told.
    *more : str
        Further sentences, ahead of those.

    Returns
    -------
    matplotlib.axes.Axes
        The same.
    """
    from proprotor.model.provenance import reservations

    add_footer(ax.get_figure(root=True), " ".join((*more, *reservations(case))))
    return ax


def add_footer(figure: Figure | None, text: str) -> None:
    """A note below all that a figure has, which grows by its lines."""
    if figure is None or not text:
        return
    width, height = figure.get_size_inches()
    lines = textwrap.wrap(text, max(20, int(_LETTERS_PER_INCH * (width - 0.4))))
    share = ((len(lines) + 1) * _INCHES) / (height + (len(lines) + 1) * _INCHES)
    engine: Any = figure.get_layout_engine()
    if engine is None:
        kept = figure.subplotpars
        bottom, top = (share + (1 - share) * part for part in (kept.bottom, kept.top))
        figure.set_size_inches(width, height / (1 - share))
        figure.subplots_adjust(bottom=bottom, top=top)
    else:
        figure.set_size_inches(width, height / (1 - share))
        engine.set(rect=(0, share, 1, 1 - share))
    style: dict[str, Any] = {"fontsize": _NOTE_SIZE, "va": "bottom", "color": GREY, "parse_math": False}
    figure.text(0.2 / width, 0.5 * _INCHES * (1 - share) / height, "\n".join(lines), **style)
