"""Rotor frequencies of the XV-15 against airspeed, beside what the paper and the tests say.

    python -m benchmarks.xv15_frequencies           # prints the tables
    python -m benchmarks.xv15_frequencies --page    # and writes two of them into docs/xv15.md

The rotor stands on a rigid hub, with the springs of AIAA-2002-1604 and with the blade frequencies that Bell calculated;
frequencies are in the fixed frame, per revolution at 458 rpm.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks.page_table import markdown, page_is_wanted, write_table
from benchmarks.paper_figures.blade_state import on_rigid_hub
from proprotor.units import KNOT

DECKS = ("xv15-uncoupled", "xv15-bell-frequencies")
SPEEDS = np.arange(50, 451, 50) * KNOT
MODES_OF_THE_PAGE = ("low cyclic lag", "coning")
MODES = ("coning", "low cyclic lag", "low gimbal", "high gimbal")
STATEMENTS = (
    "AIAA-2002-1604: low cyclic lag from about 0.8 to 0.2 per rev (Fig. 14); coning 1.85; gimbal 1.0355.",
    "NASA TM X-62,407, test: coning 1.70 per rev at 458 rpm; lag 1.72 per rev, rotating, at low pitch.",
    "NASA TM X-62,407, calculated: coning 1.69 to 2.04, lag 1.454 to 1.052, rotating, over the airplane's collective.",
)


def print_case(console: Console, case: pp.Case) -> None:
    console.print(f"[bold]{case.title}[/bold]  calibrated: {case.calibration}")
    for airloads in ("none", "full"):
        for rotor_speed in ("windmilling", "constant"):
            options = case.model_options({"airloads": airloads, "rotor_speed": rotor_speed})
            found = on_rigid_hub(case, SPEEDS, **options)
            columns = (found[name] for name in MODES)
            title = f"airloads {airloads}, rotor speed {'free' if rotor_speed == 'windmilling' else 'locked'}"
            table = Table("kt", *MODES, title=title)
            for speed, *values in zip(SPEEDS / KNOT, *columns, strict=True):
                cells = (f"{value:.3f}" if np.isfinite(value) else "-" for value in values)
                table.add_row(f"{speed:.0f}", *cells)
            console.print(table)


def page_rows(case: pp.Case) -> Iterator[tuple[str, ...]]:
    """Yield lag and coning in a vacuum and with airloads, with free rotor speed."""
    frequencies = [
        on_rigid_hub(case, SPEEDS, **case.model_options({"airloads": airloads, "rotor_speed": "windmilling"}))
        for airloads in ("none", "full")
    ]
    columns = [found[mode] for mode in MODES_OF_THE_PAGE for found in frequencies]
    for speed, *values in zip(SPEEDS / KNOT, *columns, strict=True):
        yield (f"{speed:.0f}", *(f"{value:.2f}" for value in values))


def main() -> None:
    page = page_is_wanted(__doc__)
    console = Console(width=120)
    for name in DECKS:
        case = pp.load_case(name)
        print_case(console, case)
        if page:
            headings = [
                f"{mode} {air}" for mode in MODES_OF_THE_PAGE for air in ("in a vacuum", "with airloads")
            ]
            mark = f"python -m benchmarks.xv15_frequencies --page: {name}"
            write_table("xv15.md", mark, markdown(("kt", *headings), page_rows(case)))
    for statement in STATEMENTS:
        console.print(statement)


if __name__ == "__main__":
    main()
