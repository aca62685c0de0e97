"""Rotor frequencies of the XV-15 against airspeed, beside what the paper and the tests say, and the stability boundary.

    python benchmarks/xv15_frequencies.py

The rotor stands on a rigid hub; frequencies are in the fixed frame, per revolution at 458 rpm.
"""

from __future__ import annotations

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from proprotor.model import HUB
from proprotor.sweep import sweep

KNOT = 1852 / 3600
SPEEDS = np.arange(50, 451, 50) * KNOT
STATEMENTS = (
    "Paper: low-frequency cyclic lag 0.8 to 0.2 per rev (Fig. 14), coning near 1.85, gimbal 1.0355 (Fig. 18).",
    "Test (TM X-62,407): coning 1.70 per rev at 458 rpm; lag 1.72 per rev in the rotating frame at low pitch.",
)


def on_rigid_hub(case: pp.Case, **options) -> list[np.ndarray]:
    """Frequencies per rev of the coning, low cyclic lag and gimbal modes at `SPEEDS`."""
    model = pp.rotor_model(case.rotor, case.operation, SPEEDS, **options)
    modes = sweep(model.submodel(tuple(name for name in model.dofs if name not in HUB)))
    names = [str(name) for name in modes.mode.values]
    per_rev = modes.frequency.values / case.operation.rotor_speed
    picked = []
    for wanted in ("coning", "low cyclic lag", "low gimbal", "high gimbal"):
        picked.append(per_rev[:, names.index(wanted)] if wanted in names else np.full(len(SPEEDS), np.nan))
    return picked


def main() -> None:
    console = Console(width=120)
    case = pp.load_case("xv15")
    console.print(f"[bold]{case.title}[/bold]  calibrated: {case.calibration}")
    for airloads in ("none", "full"):
        for rotor_speed in ("windmilling", "constant"):
            columns = on_rigid_hub(case, airloads=airloads, rotor_speed=rotor_speed)
            title = f"airloads {airloads}, rotor speed {'free' if rotor_speed == 'windmilling' else 'locked'}"
            table = Table("kt", "coning", "low cyclic lag", "low gimbal", "high gimbal", title=title)
            for speed, *values in zip(SPEEDS / KNOT, *columns, strict=True):
                table.add_row(f"{speed:.0f}", *(f"{value:.3f}" for value in values))
            console.print(table)
    for statement in STATEMENTS:
        console.print(statement)


if __name__ == "__main__":
    main()
