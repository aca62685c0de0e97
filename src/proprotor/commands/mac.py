"""The command `proprotor mac`: measured modes of a structure beside those of a model."""

from __future__ import annotations

from typing import Any

import click
import numpy as np

from proprotor.calibration.modal_comparison import compare_modes
from proprotor.case import Case, load_case
from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.model.doubts import marked
from proprotor.tables.csv_text import csv_of
from proprotor.typing import Dataset


@arguments.command()
@arguments.case_argument
@click.argument("measured", type=arguments.CaseName())
@click.option(
    "--distance",
    metavar="LENGTH",
    help="At which a rotation counts as a displacement; by default the rotor's radius.",
)
@output.output_options(csv="Write a row for each measured mode.", plot="Draw the criterion for all pairs")
@arguments.model_options
def mac(request: arguments.Request, outputs: output.Outputs, measured: str, distance: str | None) -> None:
    """Compare measured modes of a structure with those of the support of a case.

    CASE and MEASURED are bundled cases or TOML files. The support of MEASURED has the modes of the test, such as those
    of a universal file. The rotor of CASE is held as it was in the test. The modal assurance criterion compares the
    motion of the hub, 1 for the same motion and 0 for motions at right angles.

    \b
    Examples:
      proprotor mac my.toml ground-vibration-test.toml
      proprotor mac xv15 xv15-uncoupled --plot mac.png
    """
    from proprotor.plots import plot_mac  # here, so that --help answers without it

    case, test = request.load(), load_case(measured)
    with waiting("Comparing"):
        found = compare_modes(case, test.support, distance=distance)
    rows = _rows(found)
    outputs.write(
        document=lambda: output.about(case, request) | _document(found, rows),
        table=lambda: _print(case, found, rows),
        csv=lambda: csv_of(rows, list(rows[0]), found.attrs),
        plot=lambda: output.with_origin(plot_mac(found), case),
    )


def _rows(found: Dataset) -> list[dict[str, Any]]:
    """Return a record for each measured mode."""
    rows = []
    for name in found.measured.values:
        own = found.sel(measured=name)
        rows.append(
            {
                "measured": str(name),
                "model": str(own.pair.item()),
                "MAC": float(own.pair_mac),
                "measured (Hz)": float(own.measured_frequency) / (2 * np.pi),
                "model (Hz)": float(own.model_frequency) / (2 * np.pi),
                "misfit (%)": 100 * float(own.frequency_misfit),
                "measured damping (%)": 100 * float(own.measured_damping),
                "model damping (%)": 100 * float(own.model_damping),
                "warning": str(own.warning.item()),
            }
        )
    return rows


def _document(found: Dataset, rows: list[dict[str, Any]]) -> dict[str, Any]:
    return {
        "distance (m)": found.attrs["distance"],
        "modes of the model": found.model.values.tolist(),
        "mac": found.mac.values.tolist(),
        "modes": rows,
    }


def _print(case: Case, found: Dataset, rows: list[dict[str, Any]]) -> None:
    output.print_head(case, found.attrs)
    names = [name for name in rows[0] if name not in ("measured", "model", "warning")]
    table = [
        (
            row["measured"],
            row["model"] or "none",
            marked(f"{row['MAC']:.2f}", row["warning"]),
            *(f"{row[name]:.4g}" for name in names[1:3]),
            *(f"{round(row[name], 2) + 0.0:.2f}" for name in names[3:]),
        )
        for row in rows
    ]
    output.print_table(("measured", "model", *names), table, text=("measured", "model"))
    output.print_footnotes(f"{row['measured']}: {row['warning']}." for row in rows if row["warning"])
