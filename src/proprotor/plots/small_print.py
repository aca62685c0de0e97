"""Small print beneath a plot: notes on the drawing, the case and options of its numbers, and doubts, in one block.

Nothing of it stands above the axes, where a title may. A figure that this room made grows by the lines of the block;
beside axes that were given the block stands below their label.
"""

from __future__ import annotations

import textwrap
from typing import Any

from proprotor.errors import printable
from proprotor.model.doubts import MARK
from proprotor.plots.style import GREY, SMALL_SIZE
from proprotor.typing import Axes, Figure

_BLOCK = "small-print"  # gid of the text
_OWN = "proprotor"  # gid of a figure that this room made
_INCHES = SMALL_SIZE * 1.25 / 72  # between lines
_LETTERS_PER_INCH = 16.0
_BELOW = 36.0  # points: from given axes down to the block, past the label of the axes
_MOST = 0.7  # of the height of a figure: if margins took more, the axes would be too low
_EDGE = 0.2  # inches: from the edges of a figure to the block
_STYLE: dict[str, Any] = {"fontsize": SMALL_SIZE, "color": GREY, "parse_math": False, "gid": _BLOCK}


def own(figure: Figure) -> None:
    """Mark a figure as made by this room, so that it may grow."""
    figure.set_gid(_OWN)


def is_own(figure: Figure | None) -> bool:
    """Return whether this room made a figure."""
    return figure is not None and figure.get_gid() == _OWN


def add(ax: Axes, *sentences: str, first: bool = False) -> None:
    """Add sentences that the block of the axes does not have yet, after those that it has or before them."""
    figure = ax.get_figure(root=True)
    new = printable(" ".join(sentence for sentence in sentences if sentence and sentence not in read(ax)))
    if figure is None or not new:
        return
    _write(ax, figure, " ".join(filter(None, (new, read(ax)) if first else (read(ax), new))))


def rewrite(ax: Axes, text: str) -> None:
    """Write another text in place of the block of the axes."""
    if (figure := ax.get_figure(root=True)) is not None and text != read(ax):
        _write(ax, figure, " ".join(text.split()))


def read(ax: Axes) -> str:
    """Return the small print of axes, of a figure that this room made that of the whole figure; empty without any."""
    figure = ax.get_figure(root=True)
    texts = figure.texts if figure is not None and is_own(figure) else ax.texts
    return next((str(text.get_label()) for text in texts if text.get_gid() == _BLOCK), "")


def _write(ax: Axes, figure: Figure, text: str) -> None:
    """Write the whole text of the block of the axes."""
    if is_own(figure):
        _write_at_bottom(figure, text)
    else:
        _write_below(ax, figure, text)


def _lines(text: str, letters: int) -> list[str]:
    """Return the lines of a text; the mark of a doubt stays with the first word of the doubt."""
    return textwrap.wrap(text.replace(f"{MARK} ", f"{MARK}\N{NO-BREAK SPACE}"), letters)


def _write_below(ax: Axes, figure: Figure, text: str) -> None:
    """Write the block below given axes, as broad as these are."""
    for old in [old for old in ax.texts if old.get_gid() == _BLOCK]:
        old.remove()
    inches = ax.get_position().width * figure.get_size_inches()[0]
    lines = _lines(text, max(30, int(_LETTERS_PER_INCH * inches)))
    place: dict[str, Any] = {"xycoords": "axes fraction", "textcoords": "offset points", "va": "top"}
    block = ax.annotate(
        "\n".join(lines), (0, 0), xytext=(0, -_BELOW), annotation_clip=False, **place, **_STYLE
    )
    block.set_label(text)
    _make_room(ax, figure, _BELOW / 72 + (len(lines) + 0.5) * _INCHES)


def _make_room(ax: Axes, figure: Figure, inches: float) -> None:
    """Leave some inches below given axes, where neither the caller nor a layout of the figure has left them."""
    spec, kept = ax.get_subplotspec(), figure.subplotpars
    if spec is None or figure.get_layout_engine() is not None:
        return
    share, rows = inches / figure.get_size_inches()[1], spec.get_gridspec().nrows
    bottom = max(kept.bottom, share)
    if rows * share + bottom + 1 - kept.top > _MOST:
        return
    figure.subplots_adjust(bottom=bottom)
    if rows > 1:  # hspace is in heights of the axes
        figure.subplots_adjust(
            hspace=max(kept.hspace, share * rows / (kept.top - bottom - share * (rows - 1)))
        )


def _write_at_bottom(figure: Figure, text: str) -> None:
    """Write the block at the bottom of a figure, which grows by its lines; the plots keep their size."""
    width, whole = figure.get_size_inches()
    before = 0.0
    for old in [old for old in figure.texts if old.get_gid() == _BLOCK]:
        before = (old.get_text().count("\n") + 2) * _INCHES
        old.remove()
    lines = _lines(text, max(20, int(_LETTERS_PER_INCH * (width - 2 * _EDGE))))
    added = (len(lines) + 1) * _INCHES
    height = whole - before + added
    figure.set_size_inches(width, height)
    engine: Any = figure.get_layout_engine()
    if engine is None:
        kept = figure.subplotpars
        bottom, above = kept.bottom * whole - before + added, (1 - kept.top) * whole
        figure.subplots_adjust(bottom=bottom / height, top=1 - above / height)
    else:
        engine.set(rect=(0, added / height, 1, 1 - added / height))
    place: dict[str, Any] = {"va": "bottom"}
    block = figure.text(_EDGE / width, 0.5 * _INCHES / height, "\n".join(lines), **place, **_STYLE)
    block.set_label(text)
