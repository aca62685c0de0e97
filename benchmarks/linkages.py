"""Signs of the linkages that turn a blade as it moves, in a drawing, and their effect on the XV-15 in knots.

python -m benchmarks.linkages           # prints the table and writes the drawing
python -m benchmarks.linkages --page    # and writes the table into docs/theory/linkages.md
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks import pictures
from benchmarks.page_table import markdown, page_is_wanted, write_table
from proprotor.plots.style import COLOURS, LABEL_SIZE, TITLE_SIZE
from proprotor.typing import Array, Figure
from proprotor.units import KNOT

DECKS = ("xv15", "xv15-aircraft")
SCAN = "200:420:20kt"
CHANGES = {
    "as it is": {},
    "flap δ3 = 15 deg": {"rotor.kinematic_pitch_flap_coupling": "15 deg"},
    "flap δ3 = -15 deg": {"rotor.kinematic_pitch_flap_coupling": "-15 deg"},
    "lag K_P4 = 0.1": {"rotor.kinematic_pitch_lag_coupling": "0.1"},
    "lag K_P4 = -0.1": {"rotor.kinematic_pitch_lag_coupling": "-0.1"},
}
CYCLIC = {"cyclic control system half as stiff": 0.5, "cyclic control system twice as stiff": 2.0}


class Panel(NamedTuple):
    """A drawing of a section: its title, how far it moves aft and up, and its pitch nose up in degrees."""

    title: str
    aft: float
    up: float
    pitch: float


PANELS = (
    Panel("flap or gimbal, δ3 > 0:\nup is nose down", 0.0, 0.8, -18.0),
    Panel("flap or gimbal, δ3 < 0:\nup is nose up (XV-15, -15 deg)", 0.0, 0.8, 18.0),
    Panel("lag, K_P4 > 0:\naft is nose down", 0.8, 0.0, -18.0),
)


def section(pitch: float) -> Array:
    """Return the outline (2, n) of a section about its quarter chord, leading edge to the left, nose up by degrees."""
    x = 0.5 * (1 - np.cos(np.linspace(0, np.pi, 40)))
    half = 0.6 * (0.2969 * np.sqrt(x) - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
    outline = np.array([np.r_[x, x[::-1]] - 0.25, np.r_[half, -half[::-1]]])
    angle = -np.radians(pitch)  # the leading edge is on the left, so nose up turns clockwise
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]]) @ outline


def draw(axes: Any, panel: Panel) -> None:
    """Draw a section where it was in grey, and where linkage and hinge bring it in black."""
    for at, pitch, colour in (((0.0, 0.0), 0.0, "0.75"), ((panel.aft, panel.up), panel.pitch, "black")):
        x, y = section(pitch)
        axes.fill(x + at[0], y + at[1], facecolor="none" if colour == "black" else "0.9", edgecolor=colour)
    axes.annotate("", (panel.aft, panel.up), (0, 0), arrowprops={"arrowstyle": "->", "color": COLOURS[1]})
    draw_rotation(axes, -0.25, -0.42)
    axes.set(title=panel.title, xlim=(-0.9, 1.7), ylim=(-0.6, 1.2))
    axes.title.set(fontsize=TITLE_SIZE - 2, ha="left")


def draw_rotation(axes: Any, x: float, y: float) -> None:
    """Draw which way the blade turns: to the left of a place, with the word to its right."""
    axes.annotate("", (x - 0.5, y), (x, y), arrowprops={"arrowstyle": "->"})
    axes.text(x + 0.04, y, "rotation", fontsize=LABEL_SIZE, va="center")


def draw_panels() -> Figure:
    """Draw all panels, blades seen from the tip, thrust upwards."""
    figure, row = pictures.drawing(len(PANELS), 9, 2.9)
    for axes, panel in zip(row, PANELS, strict=True):
        draw(axes, panel)
    pictures.tell(
        row[0], "Seen from the tip; grey: before the blade moves. Angles are drawn larger than they are."
    )
    return figure


def changes(deck: str) -> Iterator[tuple[str, dict[str, str]]]:
    """Yield each change with the fields that it sets in a deck."""
    yield from CHANGES.items()
    stiffness = float(pp.load_case(deck).rotor.control_stiffness)
    for name, times in CYCLIC.items():
        yield name, {"rotor.cyclic_control_stiffness": f"{times * stiffness!r} N*m/rad"}


def speeds() -> dict[str, list[str]]:
    """Return the flutter speed and its mode for each change, a text for each deck."""
    cells: dict[str, list[str]] = {}
    for deck in DECKS:
        for name, fields in changes(deck):
            point = pp.load_case(deck, fields).flutter_point(SCAN)
            cells.setdefault(name, []).append(f"{point.speed / KNOT:.1f} {point.mode}")
    return cells


def main() -> None:
    page = page_is_wanted(__doc__)
    found = speeds()
    table = Table("change", *(f"{deck}, KTAS" for deck in DECKS))
    for name, cells in found.items():
        table.add_row(name, *cells)
    Console(width=120, highlight=False).print(table)
    pictures.write(draw_panels, "linkages.png")
    if page:
        rows = [(name, *cells) for name, cells in found.items()]
        lines = markdown(["change", *(f"`{deck}`" for deck in DECKS)], rows)
        write_table("theory/linkages.md", "python -m benchmarks.linkages --page", lines)


if __name__ == "__main__":
    main()
