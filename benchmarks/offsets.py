"""Centre of gravity and aerodynamic centre beside the pitch axis: a drawing of the signs, and the XV-15 in knots.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.offsets           # prints the table and writes the drawing
    OPENBLAS_NUM_THREADS=1 python -m benchmarks.offsets --page    # and writes the table into docs/theory/offsets.md

The quarter chord is that of the published stations, aft of the elastic axis, which stands for the pitch axis. Where
the centre of gravity lies is not published: it is assumed on the axis, on the quarter chord, or a little beside it.
"""

from __future__ import annotations

import csv
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks import pictures
from benchmarks.linkages import draw_rotation, section
from benchmarks.page_table import markdown, page_is_wanted, write_table
from proprotor.deck.file import read_tables
from proprotor.plots.style import COLOURS
from proprotor.typing import Figure
from proprotor.units import KNOT

DATA = Path(__file__).resolve().parent / "data" / "xv15_quarter_chord.csv"
DECKS = ("xv15-mass-distribution", "xv15-wing", "xv15-aircraft")
SCAN = "150:480:20kt"
CHORD = 14.0  # in
# Quarter chord as published or on the axis, and the centre of gravity: on the axis, or aft of the quarter chord by a
# share of the chord.
CHANGES: dict[str, tuple[bool, float | None]] = {
    "both on the axis": (False, None),
    "quarter chord as published, c.g. on the axis": (True, None),
    "c.g. on the published quarter chord": (True, 0.0),
    "c.g. 1 % of the chord aft of it": (True, 0.01),
    "c.g. 2 % of the chord aft of it": (True, 0.02),
    "c.g. 2 % of the chord ahead of it": (True, -0.02),
}


def stations() -> Iterator[tuple[float, float]]:
    """Yield r/R and the quarter chord aft of the elastic axis, in."""
    with DATA.open(encoding="utf-8") as file:
        rows = [row for row in csv.reader(line for line in file if not line.startswith("#"))][1:]
    for r, place in rows:
        yield float(r), float(place)


def deck(name: str, published: bool, aft: float | None) -> str:
    """Return the text of a deck with the places on the chord, and with the mass by stations, which they need."""
    r, quarter = np.transpose(list(stations()))
    lines = [f'base = "{name}"', "[case]", 'name = "offsets"', "[rotor]"]

    def distribution(field: str, values: Any, unit: str, told: str) -> str:
        numbers = [", ".join(f"{value:.6g}" for value in part) for part in (r, values)]
        return f'{field} = {{ r_over_R = [{numbers[0]}], value = [{numbers[1]}], unit = "{unit}", {told} }}'

    mass = read_tables("xv15-mass-distribution")["rotor"]["mass_distribution"]["value"]
    told = 'status = "published", source = "NASA/TP-2004-212262, App. A"'
    lines.append(distribution("mass_distribution", mass, "slug/ft", told))
    if published:
        lines.append(distribution("aerodynamic_center", quarter, "in", told))
    if aft is not None:
        assumed = 'status = "assumed", source = "from the quarter chord; not published"'
        lines.append(distribution("mass_offset", quarter + aft * CHORD, "in", assumed))
    return "\n".join(lines)


def draw() -> Figure:
    """Draw a section seen from the tip, leading edge to the left, with both centres aft of its axis."""
    figure, (axes,) = pictures.drawing(1, 6.5, 2.6)
    x, y = section(-0.0)
    axes.fill(x, y, facecolor="0.95", edgecolor="0.4")
    axes.plot([0], [0], "k+", markersize=12)
    axes.annotate("pitch axis", (0, 0), (-0.12, 0.32), arrowprops={"arrowstyle": "-", "lw": 0.6}, fontsize=9)
    for place, height, colour, told in (
        (0.1, -0.38, COLOURS[1], "aerodynamic_center > 0"),
        (0.22, -0.24, COLOURS[2], "mass_offset > 0"),
    ):
        axes.plot([place], [0], "o", color=colour)
        axes.plot([0, 0, place, place], [0, height, height, 0], lw=0.6, color=colour)
        axes.annotate("", (place, height), (0, height), arrowprops={"arrowstyle": "->", "color": colour})
        axes.text(place + 0.03, height, told, color=colour, va="center", fontsize=9)
    draw_rotation(axes, -0.3, 0.15)
    axes.set(xlim=(-0.85, 0.95), ylim=(-0.5, 0.42))
    pictures.tell(axes, "Seen from the tip. Both places are positive aft of the pitch axis.")
    return figure


def rows() -> Iterator[tuple[str, ...]]:
    """Yield each change with the flutter speed and its mode for each deck."""
    with tempfile.TemporaryDirectory() as folder:
        for name, change in CHANGES.items():
            cells = []
            for base in DECKS:
                path = Path(folder) / "offsets.toml"
                path.write_text(deck(base, *change), encoding="utf-8")
                point = pp.load_case(path).flutter_point(SCAN)
                cells.append("none" if point is None else f"{point.speed / KNOT:.1f} {point.mode}")
            yield (name, *cells)


def main() -> None:
    page = page_is_wanted(__doc__)
    found = list(rows())
    table = Table("places on the chord", *(f"{name}, KTAS" for name in DECKS))
    for row in found:
        table.add_row(*row)
    Console(width=140, highlight=False).print(table)
    pictures.write(draw, "offsets.png")
    if page:
        lines = markdown(["places on the chord", *(f"`{name}`" for name in DECKS)], found)
        write_table("theory/offsets.md", "python -m benchmarks.offsets --page", lines)


if __name__ == "__main__":
    main()
