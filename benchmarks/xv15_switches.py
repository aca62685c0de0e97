"""What each switch of the model does to the XV-15's stability boundary, beside what AIAA-2002-1604 says.

    python -m benchmarks.xv15_switches           # prints the tables
    python -m benchmarks.xv15_switches --page    # and writes them into docs/xv15-effects.md and docs/xv15.md

The paper's figures up to Fig. 21 have pitch-flap and pitch-lag couplings in place of the pitch equations, and its
sections turn without damping; so does the baseline here.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.optimize import brentq

import proprotor as pp
from benchmarks.page_table import markdown, page_is_wanted, write_table
from benchmarks.paper_figures.analyses import VARIANTS
from benchmarks.paper_figures.blade_state import AS_THE_PAPER, blade_state, on_rigid_hub
from benchmarks.xv15_boundary import SPEEDS, WING, as_text, boundaries
from proprotor.units import KNOT

TABLE_SPEEDS = np.arange(50, 451, 50) * KNOT


# Rows of the table that are variants of the paper's figures too.
_OF_FIGURES = {
    "baseline": "couplings",
    "K_Pβ = K_Pζ = 0": "no couplings",
    "K_Pβ = 0": "no pitch-flap coupling",
    "K_Pζ = 0": "no pitch-lag coupling",
    "K_βζ = 0, couplings as they were": "no flap-lag stiffness",
    "K_βζ = 0, also in the couplings": "no flap-lag stiffness, couplings follow",
    "lag 1.8 to 1.2, flap 1.85 given": "given frequencies",
    "lag of this model, flap 1.85 given": "own frequencies given",
    "pitch equations": "pitch equations",
    "pitch equations, sections with pitch damping": "pitch equations, section damping",
}
_OTHERS: dict[str, dict[str, Any]] = {
    "lift-slope airloads": {"airloads": "lift-slope"},
    "no compressibility": {"compressibility": False},
    "constant rotor speed": {"rotor_speed": "constant"},
}


def switch_table(case: pp.Case, equations: str) -> dict[str, dict[str, float]]:
    """Return the boundaries of each row of the table in kt, see `benchmarks.xv15_boundary.boundaries`."""
    rows = {label: VARIANTS[variant](case, SPEEDS) for label, variant in _OF_FIGURES.items()} | _OTHERS
    baseline = {"pitch": "coupling", "equations": equations} | AS_THE_PAPER
    return {label: boundaries(case, **baseline | options) for label, options in rows.items()}


def zero_of_pitch_lag_coupling(case: pp.Case, name: str) -> tuple[float, float]:
    """Return airspeed (kt) and structural pitch (deg) at which K_Pζ, or K_Pζ without trim lag, changes sign."""
    speed = brentq(lambda v: getattr(blade_state(case, v), name)[0], TABLE_SPEEDS[0], TABLE_SPEEDS[-1])
    return speed / KNOT, float(np.degrees(blade_state(case, speed).structural_pitch[0]))


SWITCH_COLUMNS = ("", *WING, "change of chord", "first of the rotor")


def cells_of(rows: dict[str, dict[str, float]]) -> Iterator[tuple[str, ...]]:
    """Yield the boundaries of each row as text."""
    for label, found in rows.items():
        change = found["chord"] - rows["baseline"]["chord"]
        change = f"{change:+.0f}" if np.isfinite(change) else ""
        yield (label, *(as_text(found[mode]) for mode in WING), change, as_text(found["rotor"]))


def print_switches(console: Console, title: str, rows: dict[str, dict[str, float]]) -> None:
    """Print the boundaries of each row."""
    table = Table(*SWITCH_COLUMNS, title=f"{title}: boundary, kt")
    for row in cells_of(rows):
        table.add_row(*row)
    console.print(table)


COLUMNS = {
    "Θ + δs, deg": "{:.1f}",
    "coning, deg": "{:.2f}",
    "lag, deg": "{:.2f}",
    "K_Pβ": "{:+.2f}",
    "K_Pζ": "{:+.2f}",
    "K_Pζ without lag": "{:+.2f}",
    "ν_ζ uncoupled": "{:.2f}",
    "low cyclic lag": "{:.2f}",
    "in a vacuum": "{:.2f}",
}
# Tables of docs/xv15.md with some of the columns.
PARTS = {
    "trim and lag": (
        "Θ + δs, deg",
        "coning, deg",
        "lag, deg",
        "ν_ζ uncoupled",
        "low cyclic lag",
        "in a vacuum",
    ),
    "couplings": ("K_Pβ", "K_Pζ", "K_Pζ without lag"),
}


def blade_rows(case: pp.Case) -> Iterator[tuple[str, ...]]:
    """Yield trim, couplings and lag frequencies against airspeed."""
    state = blade_state(case, TABLE_SPEEDS)
    low_lag = (
        on_rigid_hub(case, TABLE_SPEEDS, airloads=airloads, pitch="coupling")["low cyclic lag"]
        for airloads in ("full", "none")
    )
    columns = (*np.degrees(state[:3]), *state[3:], *low_lag)
    for speed, *values in zip(TABLE_SPEEDS / KNOT, *columns, strict=True):
        cells = (text.format(value) for text, value in zip(COLUMNS.values(), values, strict=True))
        yield (f"{speed:.0f}", *cells)


def print_blade(console: Console, case: pp.Case, rows: list[tuple[str, ...]]) -> None:
    """Print trim, couplings and lag frequencies, and where the coupling of lag vanishes."""
    table = Table("kt", *COLUMNS, title="deg, and per rev; low cyclic lag in the fixed frame, on a rigid hub")
    for row in rows:
        table.add_row(*row)
    console.print(table)
    for name in ("pitch_lag_coupling", "pitch_lag_coupling_without_lag"):
        speed, angle = zero_of_pitch_lag_coupling(case, name)
        console.print(f"{name.replace('_', ' ')} is zero at {speed:.0f} kt, Θ + δs = {angle:.1f} deg")


def write_pages(switches: dict[str, dict[str, dict[str, float]]], blade: list[tuple[str, ...]]) -> None:
    """Put the tables into their pages."""
    for equations, rows in switches.items():
        mark = f"python -m benchmarks.xv15_switches --page: {equations}"
        write_table("xv15-effects.md", mark, markdown(SWITCH_COLUMNS, cells_of(rows)))
    for part, names in PARTS.items():
        places = [0, *(1 + list(COLUMNS).index(name) for name in names)]
        rows = [[row[place] for place in places] for row in blade]
        mark = f"python -m benchmarks.xv15_switches --page: {part}"
        write_table("xv15.md", mark, markdown(("kt", *names), rows))


def main() -> None:
    page = page_is_wanted(__doc__)
    console = Console(width=130, highlight=False)
    case = pp.load_case("xv15-uncoupled")
    switches = {equations: switch_table(case, equations) for equations in ("consistent", "published")}
    for equations, rows in switches.items():
        print_switches(console, f"{equations} equations", rows)
        at_boundary = blade_state(case, rows["baseline"]["chord"] * KNOT)
        console.print(
            f"at the baseline's boundary K_Pζ = {at_boundary.pitch_lag_coupling[0]:.2f}, "
            f"K_Pβ = {at_boundary.pitch_flap_coupling[0]:.2f}"
        )
    blade = list(blade_rows(case))
    print_blade(console, case, blade)
    console.print(f"Calibrated: {case.calibration}")
    if page:
        write_pages(switches, blade)


if __name__ == "__main__":
    main()
