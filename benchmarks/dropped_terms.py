"""What each term the paper drops does to the XV-15's stability boundary, in knots.

    python -m benchmarks.dropped_terms

The reduced equations are derived in memory, which takes minutes.
"""

from __future__ import annotations

from rich.console import Console
from rich.progress import track
from rich.table import Table

import proprotor as pp
from benchmarks.xv15_boundary import WING, boundaries
from derive.audit.consequences import consistent_but
from derive.published import DROPPED_TERMS, PUBLISHED


def table_rows(case: pp.Case, **options) -> list[tuple[str, dict[str, float]]]:
    """Boundaries of the consistent equations, without each term alone, and as published."""
    rows = [("consistent", boundaries(case, **options))]
    for name, term in track(DROPPED_TERMS.items(), description="terms"):
        dropped = {term.option: False} if term.option else {"equations": consistent_but(name)}
        rows.append((f"without {name}", boundaries(case, **dropped, **options)))
    rows.append(("published", boundaries(case, equations="published", **options)))
    assert len(rows) == len(PUBLISHED) + 2
    return rows


def main() -> None:
    case = pp.load_case("xv15-uncoupled")
    for pitch in ("dynamic", "coupling"):
        table = Table("equations", *WING, "change of chord", title=f"XV-15 boundary, kt, pitch={pitch}")
        rows = table_rows(case, pitch=pitch)
        base = rows[0][1]["chord"]
        for label, found in rows:
            table.add_row(label, *(f"{found[mode]:.1f}" for mode in WING), f"{found['chord'] - base:+.1f}")
        Console(width=120).print(table)
    print("Assumed or recalled inputs: see the deck; differences matter here, not the boundary itself.")


if __name__ == "__main__":
    main()
