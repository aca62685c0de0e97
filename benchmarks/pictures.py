"""Pictures of the pages that no plot of the product draws: in its style sheet, with its small print, small files.

A module draws into the axes of `panels` and hands a function that does so to `write` or `save`, which call it under
the style sheet. Nothing else in benchmarks/ makes a figure or saves one; `tests/project/test_pictures.py` looks.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import IO, Any

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

import proprotor as pp
from proprotor.files.output import write_whole
from proprotor.model import stamp
from proprotor.model.provenance import reservations
from proprotor.plots import small_print
from proprotor.plots.canvas import grid
from proprotor.plots.style import in_style, line_style

FOLDER = Path(__file__).resolve().parents[1] / "docs" / "figures"
DPI = 110
_COLOURS = 256  # of a file: the eye does not tell them from all
_MARKED = 8  # markers along a line


def panels(columns: int, width: float, height: float, **shared: Any) -> tuple[Figure, list[Axes]]:
    """Return a figure, its size in inches, that grows by its small print, and its axes side by side."""
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    small_print.own(figure)
    axes = list(figure.subplots(1, columns, squeeze=False, **shared)[0])
    for ax in axes:
        grid(ax)
    return figure, axes


def drawing(columns: int, width: float, height: float) -> tuple[Figure, list[Axes]]:
    """Return a figure for drawings in place of plots: the axes are not seen, and equal lengths look equal."""
    figure, axes = panels(columns, width, height)
    for ax in axes:
        ax.set_aspect("equal")
        ax.axis("off")
    return figure, axes


def draw_case(ax: Axes, x: Any, y: Any, place: int, label: str, **style: Any) -> None:
    """Draw the line of the first, second and so on case: colour, dashes and markers of its own, the first broader."""
    every = max(1, len(x) // _MARKED)
    marked: dict[str, Any] = {"markevery": (place * every // 3 % every, every), "markersize": 5}
    own = line_style(place) | {"linewidth": 2.2 if place == 0 else 1.6} | marked
    ax.plot(x, y, label=label, **(own | style))


def tell(ax: Axes, *sentences: str) -> None:
    """Add sentences to the small print."""
    small_print.add(ax, *sentences)


def tell_case(ax: Axes, case: pp.Case, *sentences: str, **options: Any) -> None:
    """Add sentences to the small print, then the case, the options of its analysis, and how far to trust its inputs."""
    small_print.add(ax, *sentences, stamp.line(stamp.of_case(case, options)), *reservations(case))


def png(figure: Figure, dpi: float = DPI) -> bytes:
    """Return a figure as PNG of few colours; the same figure gives the same bytes."""
    drawn = io.BytesIO()
    figure.savefig(drawn, format="png", dpi=dpi, metadata={"Software": None})
    return in_few_colours(drawn)


def in_few_colours(drawn: Path | IO[bytes]) -> bytes:
    """Return a picture as PNG of few colours."""
    small = io.BytesIO()
    with Image.open(drawn) as picture:
        flat = picture.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE)
    flat.save(small, format="png", optimize=True)
    return small.getvalue()


def save(draw: Callable[[], Any], file: IO[bytes], dpi: float = DPI) -> None:
    """Draw under the style sheet and write PNG into a file; `draw` returns a figure or axes."""
    file.write(png(in_style(draw)().get_figure(root=True), dpi))


def write(draw: Callable[[], Any], name: str, dpi: float = DPI) -> None:
    """Draw a picture of a page under the style sheet and write it into docs/figures."""
    write_whole(FOLDER / name, partial(save, draw, dpi=dpi))
