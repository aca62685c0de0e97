"""What each switch of the model does to the XV-15's stability boundary, beside what AIAA-2002-1604 says.

    python -m benchmarks.xv15_switches

The paper's figures up to Fig. 21 have pitch-flap and pitch-lag couplings in place of the pitch equations, and its
sections turn without damping; so does the baseline here.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.optimize import brentq

import proprotor as pp
from benchmarks.paper_figures.blade_state import blade_state, on_rigid_hub
from benchmarks.paper_figures.published import PAPER_FREQUENCIES
from benchmarks.xv15_boundary import KNOT, SPEEDS, WING, boundaries, told
from proprotor.rotor.blade_frequencies import BladeFrequencies

TABLE_SPEEDS = np.arange(50, 451, 50) * KNOT


def switches(case: pp.Case) -> dict[str, dict[str, Any]]:
    """Options of each row of the table, to be added to those of the baseline."""
    at_trim = blade_state(case, SPEEDS)
    flap, lag = at_trim.pitch_flap_coupling, at_trim.pitch_lag_coupling
    kept = {"pitch_flap_coupling": flap, "pitch_lag_coupling": lag}
    vacuum = 1 + on_rigid_hub(case, SPEEDS, airloads="none", pitch="coupling")["low cyclic lag"]
    tabulated = {"structure": "tabulated"} | kept
    of_this_model = BladeFrequencies(flap=1.85, lag=vacuum, against="airspeed", at=SPEEDS)
    return {
        "baseline": {},
        "K_Pβ = K_Pζ = 0": {"pitch_flap_coupling": 0.0, "pitch_lag_coupling": 0.0},
        "K_Pβ = 0": {"pitch_flap_coupling": 0.0},
        "K_Pζ = 0": {"pitch_lag_coupling": 0.0},
        "K_βζ = 0, couplings as they were": {"structure": "diagonal"} | kept,
        "K_βζ = 0, also in the couplings": {"structure": "diagonal"},
        "lag 1.8 to 1.2, flap 1.85 given": tabulated | {"frequencies": PAPER_FREQUENCIES},
        "lag of this model, flap 1.85 given": tabulated | {"frequencies": of_this_model},
        "pitch equations": {"pitch": "dynamic"},
        "pitch equations, sections with pitch damping": {"pitch": "dynamic", "section_damping": True},
        "lift-slope airloads": {"airloads": "lift-slope"},
        "no compressibility": {"compressibility": False},
        "constant rotor speed": {"rotor_speed": "constant"},
    }


def switch_table(case: pp.Case, equations: str) -> dict[str, dict[str, float]]:
    """Boundaries of each row."""
    baseline = {"pitch": "coupling", "equations": equations, "section_damping": False}
    return {label: boundaries(case, **baseline | options) for label, options in switches(case).items()}


def zero_of_pitch_lag_coupling(case: pp.Case, name: str) -> tuple[float, float]:
    """Airspeed (kt) and structural pitch (deg) at which K_Pζ, or K_Pζ without trim lag, changes sign."""
    speed = brentq(lambda v: getattr(blade_state(case, v), name)[0], TABLE_SPEEDS[0], TABLE_SPEEDS[-1])
    return speed / KNOT, float(np.degrees(blade_state(case, speed).structural_pitch[0]))


def print_switches(console: Console, title: str, rows: dict[str, dict[str, float]]) -> None:
    table = Table("", *WING, "change of chord", "first of the rotor", title=f"{title}: boundary, kt")
    for label, found in rows.items():
        change = found["chord"] - rows["baseline"]["chord"]
        change = f"{change:+.0f}" if np.isfinite(change) else ""
        table.add_row(label, *(told(found[mode]) for mode in WING), change, told(found["rotor"]))
    console.print(table)


COLUMNS = {
    "Θ + δs": "{:.1f}",
    "coning": "{:.2f}",
    "lag": "{:.2f}",
    "K_Pβ": "{:+.2f}",
    "K_Pζ": "{:+.2f}",
    "K_Pζ without lag": "{:+.2f}",
    "ν_ζ uncoupled": "{:.2f}",
    "low cyclic lag": "{:.2f}",
    "in a vacuum": "{:.2f}",
}


def print_blade(console: Console, case: pp.Case) -> None:
    """Trim, couplings and lag frequencies against airspeed."""
    table = Table("kt", *COLUMNS, title="deg, and per rev; low cyclic lag in the fixed frame, on a rigid hub")
    state = blade_state(case, TABLE_SPEEDS)
    low_lag = (
        on_rigid_hub(case, TABLE_SPEEDS, airloads=airloads, pitch="coupling")["low cyclic lag"]
        for airloads in ("full", "none")
    )
    columns = (*np.degrees(state[:3]), *state[3:], *low_lag)
    for speed, *values in zip(TABLE_SPEEDS / KNOT, *columns, strict=True):
        cells = (text.format(value) for text, value in zip(COLUMNS.values(), values, strict=True))
        table.add_row(f"{speed:.0f}", *cells)
    console.print(table)
    for name in ("pitch_lag_coupling", "pitch_lag_coupling_without_lag"):
        speed, angle = zero_of_pitch_lag_coupling(case, name)
        console.print(f"{name.replace('_', ' ')} is zero at {speed:.0f} kt, Θ + δs = {angle:.1f} deg")


def main() -> None:
    console = Console(width=130, highlight=False)
    case = pp.load_case("xv15")
    for equations in ("consistent", "published"):
        rows = switch_table(case, equations)
        print_switches(console, f"{equations} equations", rows)
        at_boundary = blade_state(case, rows["baseline"]["chord"] * KNOT)
        console.print(
            f"at the baseline's boundary K_Pζ = {at_boundary.pitch_lag_coupling[0]:.2f}, "
            f"K_Pβ = {at_boundary.pitch_flap_coupling[0]:.2f}"
        )
    print_blade(console, case)
    console.print(f"Calibrated: {case.calibration}")


if __name__ == "__main__":
    main()
