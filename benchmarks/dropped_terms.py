"""What each term the paper drops does to the XV-15's stability boundary, in knots.

    python benchmarks/dropped_terms.py

Run from the repository: the reduced equations are derived in memory. A boundary is where a mode's damping falls
through zero, by
linear interpolation between points 5 kt apart.
"""

from __future__ import annotations

import numpy as np
from rich.console import Console
from rich.progress import track
from rich.table import Table

import proprotor as pp
from derive.emit import reduced_modules
from derive.published import DROPPED_TERMS, PUBLISHED
from proprotor.equation_set import EquationSet

KNOT = 1852 / 3600
SPEEDS = np.arange(100, 521, 5) * KNOT
WING = ("beam", "chord", "torsion")


def boundaries(case: pp.Case, **options) -> dict[str, float]:
    """Lowest speed (kt) at which each wing mode loses its damping, and the lowest of all; NaN where none does."""
    modes = case.sweep(SPEEDS, **options)
    found = {}
    for name in modes.mode.values:
        damping = modes.damping_ratio.sel(mode=name).values
        crossing = np.flatnonzero((damping[:-1] > 0) & (damping[1:] <= 0))
        if len(crossing):
            i = crossing[0]
            found[str(name)] = np.interp(0, [damping[i + 1], damping[i]], SPEEDS[[i + 1, i]] / KNOT)
    wing = {name: min((v for n, v in found.items() if n.endswith(name)), default=np.nan) for name in WING}
    return wing | {"lowest": min(found.values(), default=np.nan)}


def table_rows(case: pp.Case, **options) -> list[tuple[str, dict[str, float]]]:
    """Boundaries of the consistent equations, without each term alone, and as published."""
    rows = [("consistent", boundaries(case, **options))]
    for name in track(DROPPED_TERMS, description="terms"):
        reduced = EquationSet(**reduced_modules(frozenset({name})))
        rows.append((f"without {name}", boundaries(case, equations=reduced, **options)))
    rows.append(("published", boundaries(case, equations="published", **options)))
    assert len(rows) == len(PUBLISHED) + 2
    return rows


def main() -> None:
    case = pp.load_case("xv15")
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
