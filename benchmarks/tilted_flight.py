"""Flutter of the XV-15 against shaft angle and load factor, and what averaging over azimuth changes of it.

    python -m benchmarks.tilted_flight           # prints the tables and writes the figure
    python -m benchmarks.tilted_flight --page    # and writes the tables into docs/theory/tilted-flight.md

Boundaries are those of the average; beside each, the change of the damping of its mode by the Floquet exponents.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks import pictures
from benchmarks.page_table import markdown, page_is_wanted, write_table
from proprotor.typing import Array, Figure
from proprotor.units import KNOT

SCAN = "280:400:20kt"
ANGLES = (0.0, 2.0, 4.0, 6.0, 8.0, 10.0)  # deg
LOADS = (-1.0, 0.0, 1.0, 2.0, 2.5)
COLUMNS = ("flutter, KTAS", "mode", "change of its damping ratio", "largest change of any")
LABELS = {"none": "no cyclic pitch: the gimbal tilts", "level": "cyclic pitch keeps the gimbal level"}


class Boundary(NamedTuple):
    """A flutter speed, m/s, its mode, and there the change of that mode's damping ratio by the Floquet exponent."""

    speed: float
    mode: str
    change: float
    worst: float


def boundary(case: pp.Case, **options: Any) -> Boundary:
    """Return the flutter point of a case by the average, beside the Floquet exponent of its mode."""
    point = case.flutter_point(SCAN, **options)
    if not ("shaft_angle" in options or "load_factor" in options):
        return Boundary(point.speed, point.mode, 0.0, 0.0)
    found = case.floquet(point.speed, **options)
    mode = list(found.name.values).index(point.mode)
    roots = found.eigenvalue.values[mode], found.exponent.values[mode]
    before, after = (-root.real / abs(root) for root in roots)
    return Boundary(point.speed, point.mode, after - before, float(found.damping_change))


def against_angle(case: pp.Case, cyclic: str) -> list[Boundary]:
    """Return the boundaries at all shaft angles."""
    return [
        boundary(case, **({"shaft_angle": np.radians(angle), "cyclic": cyclic} if angle else {}))
        for angle in ANGLES
    ]


def against_load(case: pp.Case) -> list[Boundary]:
    """Return the boundaries at all load factors, of the turn of the hub alone."""
    return [boundary(case, **({"load_factor": load} if load != 1 else {})) for load in LOADS]


def rows(at: tuple[float, ...], found: list[Boundary]) -> Iterator[tuple[str, ...]]:
    """Yield boundaries as the cells of a table."""
    for value, one in zip(at, found, strict=True):
        yield (f"{value:g}", f"{one.speed / KNOT:.1f}", one.mode, f"{one.change:+.5f}", f"{one.worst:.4f}")


def table(title: str, name: str, at: tuple[float, ...], found: list[Boundary]) -> Table:
    """Return boundaries as a table."""
    whole = Table(title=title)
    for heading in (name, *COLUMNS):
        whole.add_column(heading, justify="left" if heading == "mode" else "right")
    for row in rows(at, found):
        whole.add_row(*row)
    return whole


def write_page(angles: dict[str, list[Boundary]], loads: list[Boundary]) -> None:
    """Put the tables into their page: without and with cyclic pitch, and the turn of the hub."""
    named = {"gimbal tilts": ("shaft angle, deg", ANGLES, angles["none"])}
    named["gimbal level"] = ("shaft angle, deg", ANGLES, angles["level"])
    named["turn of the hub"] = ("load factor", LOADS, loads)
    for part, (name, at, found) in named.items():
        mark = f"python -m benchmarks.tilted_flight --page: {part}"
        write_table("theory/tilted-flight.md", mark, markdown((name, *COLUMNS), rows(at, found)))


def draw(case: pp.Case, angles: dict[str, list[Boundary]], loads: list[Boundary]) -> Figure:
    """Draw boundaries against shaft angle and load factor."""
    figure, (left, right) = pictures.panels(2, 9, 3.6, sharey=True)
    for place, (cyclic, found) in enumerate(angles.items()):
        pictures.draw_case(left, ANGLES, _knots(found), place, LABELS[cyclic])
    pictures.draw_case(right, LOADS, _knots(loads), 0, "turn of the hub alone")
    left.set(xlabel="Shaft angle (deg)", ylabel="Flutter speed, KTAS")
    right.set(xlabel="Load factor (g)")
    for axes in (left, right):
        axes.margins(y=0.3)
        axes.legend(loc="upper left", frameon=False)
    varied = "options beside the defaults: shaft angle, cyclic, load factor"
    pictures.tell_case(left, case, f"Boundaries of the average over the azimuth; {varied}.")
    return figure


def _knots(found: list[Boundary]) -> Array:
    return np.array([one.speed for one in found]) / KNOT


def main() -> None:
    """Print both tables and write the figure."""
    page, case, console = page_is_wanted(__doc__), pp.load_case("xv15"), Console()
    angles = {cyclic: against_angle(case, cyclic) for cyclic in LABELS}
    loads = against_load(case)
    for cyclic, found in angles.items():
        console.print(table(f"XV-15, {LABELS[cyclic]}", "shaft angle, deg", ANGLES, found))
    console.print(table("XV-15, turn of the hub", "load factor", LOADS, loads))
    pictures.write(partial(draw, case, angles, loads), "tilted-flight.png")
    if page:
        write_page(angles, loads)


if __name__ == "__main__":
    main()
