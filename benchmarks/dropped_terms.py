"""What each term the paper drops does to the XV-15's stability boundary, in knots.

    python -m benchmarks.dropped_terms           # prints the tables
    python -m benchmarks.dropped_terms --page    # and writes one into docs/xv15-effects.md

The reduced equations are derived in memory, which takes minutes.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from rich.console import Console
from rich.progress import track
from rich.table import Table

import proprotor as pp
from benchmarks.page_table import PageTable, page_is_wanted
from benchmarks.xv15_boundary import WING, as_text, boundaries
from derive.audit.consequences import consistent_but
from derive.published import DROPPED_TERMS, PUBLISHED

MODELS = {"pitch equations": "dynamic", "couplings": "coupling"}
Rows = dict[str, dict[str, float]]


def found_without(case: pp.Case, **options) -> Rows:
    """Return the boundaries of the consistent equations, without each term alone, and as published."""
    rows = {"nothing": boundaries(case, **options)}
    for name, term in track(DROPPED_TERMS.items(), description="terms"):
        dropped = {term.option: False} if term.option else {"equations": consistent_but(name)}
        rows[name.replace("_", " ")] = boundaries(case, **dropped, **options)
    rows["all of them: published"] = boundaries(case, equations="published", **options)
    assert len(rows) == len(PUBLISHED) + 2
    return rows


def printed(title: str, rows: Rows) -> Table:
    """Return all boundaries without each term."""
    table = Table("without", *WING, "change of chord", title=title)
    for label, found in rows.items():
        change = found["chord"] - rows["nothing"]["chord"]
        table.add_row(label, *(f"{found[mode]:.1f}" for mode in WING), f"{change:+z.1f}")
    return table


def of_page(models: dict[str, Rows]) -> PageTable:
    """Return the boundaries of chord and beam without each term, with the change of chord."""
    headings = [f"{mode}, {model}" for mode in ("chord", "beam") for model in models]
    return PageTable(
        "python -m benchmarks.dropped_terms --page", ("without", *headings), list(_cells(models))
    )


def _cells(models: dict[str, Rows]) -> Iterator[tuple[str, ...]]:
    for label in next(iter(models.values())):
        chord = [
            f"{rows[label]['chord']:.1f} ({rows[label]['chord'] - rows['nothing']['chord']:+z.1f})"
            for rows in models.values()
        ]
        yield (label, *chord, *(_of_beam(rows[label]["beam"]) for rows in models.values()))


def _of_beam(speed: float) -> str:
    """Return a boundary to a tenth of a knot, or that there is none."""
    return f"{speed:.1f}" if np.isfinite(speed) else as_text(speed)


def main() -> None:
    """Print all boundaries, and write those of chord and beam into the page."""
    page = page_is_wanted(__doc__)
    case = pp.load_case("xv15-uncoupled")
    models = {model: found_without(case, pitch=pitch) for model, pitch in MODELS.items()}
    for model, rows in models.items():
        Console(width=120).print(printed(f"XV-15 boundary, kt, {model}", rows))
    print("Assumed or recalled inputs: see the deck; differences matter here, not the boundary itself.")
    if page:
        of_page(models).write("xv15-effects.md")


if __name__ == "__main__":
    main()
