"""The command `proprotor calibrate`: inputs of a deck fitted to test points."""

from __future__ import annotations

from typing import Any

import click
import numpy as np

from proprotor.calibration.calibrate import Calibration
from proprotor.calibration.calibrate import calibrate as fitted
from proprotor.calibration.calibrated_deck import calibrated_deck
from proprotor.case import Case
from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError
from proprotor.tables.calibration_table import input_records, target_records
from proprotor.tables.csv_text import csv_of
from proprotor.tables.points import read_points


@arguments.command()
@arguments.case_argument
@click.option(
    "--to", required=True, metavar="FILE", help="CSV file of test points with errors, as for --points."
)
@click.option(
    "--input",
    "varied",
    multiple=True,
    required=True,
    type=arguments.Input(),
    metavar="INPUT",
    help='Input that may vary, perhaps within bounds: rotor.precone, "rotor.precone=1:3 deg". Repeatable.',
)
@click.option("--mode", help="Name of the mode of points whose file names none.")
@click.option("--out", metavar="FILE", help="Write a deck with the calibrated inputs, a .toml file.")
@output.output_options(csv="Write a row for each number of the test points.")
@arguments.model_options
def calibrate(
    request: arguments.Request,
    outputs: output.Outputs,
    to: str,
    varied: tuple[str, ...],
    mode: str | None,
    out: str | None,
) -> None:
    """Fit inputs of a deck to measured frequencies and dampings, each weighted by its error.

    CASE is a bundled case or a TOML file. Test points have columns such as "airspeed [ktas], frequency [Hz],
    frequency_error, damping [%], damping_error, mode". Derivatives are exact. The command says which inputs the points
    do not tell, and whether the model misses the points by more than their errors.

    \b
    Examples:
      proprotor calibrate xv15 --to points.csv --input rotor.control_stiffness
      proprotor calibrate my.toml --to points.csv \\
        --input "rotor.precone=1:3 deg" --out calibrated.toml
    """
    inputs = _inputs(varied)
    if out is not None and not out.endswith(".toml"):
        raise InputError("--out", out, "must end in .toml")
    output.check_writable("--out", out)
    case = request.load()
    points = read_points(to, "--to")
    with waiting("Fitting"):
        done = fitted(case, points, inputs, mode=mode, **request.options)
    rows = target_records(done.found)
    if out is not None:
        text = calibrated_deck(done, request.name, out, request.settings)
        output.write("--out", out, text.encode())
    outputs.write(
        document=lambda: output.about(case, request) | _document(done, rows),
        table=lambda: _print(case, done, rows),
        csv=lambda: csv_of(rows, list(rows[0]), done.found.attrs),
    )


def _inputs(varied: tuple[str, ...]) -> dict[str, Any]:
    """Return the bounds of inputs by path; None for an input without."""
    found: dict[str, Any] = {}
    for text in varied:
        path, equals, limits = (part.strip() for part in text.partition("="))
        if path in found:
            raise InputError("--input", text, "must not vary an input twice")
        found[path] = None
        if equals:
            low, colon, high = limits.partition(":")
            if not colon or ":" in high:
                raise InputError("--input", text, 'must have two bounds, such as "rotor.precone=1:3 deg"')
            found[path] = (f"{low.strip()} {arguments.unit_of(high)}".strip(), high.strip())
    return found


def _document(done: Calibration, rows: list[dict[str, Any]]) -> dict[str, Any]:
    found = done.found
    return {
        "points": found.attrs["points"],
        "chi squared": found.attrs["chi_squared"],
        "degrees of freedom": found.attrs["degrees_of_freedom"],
        "chance of a larger misfit": found.attrs["chance"],
        "warning": found.warning.item(),
        "inputs": input_records(found, done.case.given),
        "correlation": _correlation(done).tolist(),
        "targets": rows,
    }


def _correlation(done: Calibration) -> Any:
    """Return how the errors of the inputs go together (inputs, inputs), zero for an input at a bound."""
    spread = done.found.standard_error.values
    whole = np.outer(spread, spread)
    return np.divide(done.found.covariance.values, whole, out=np.zeros_like(whole), where=whole > 0)


def _print(case: Case, done: Calibration, rows: list[dict[str, Any]]) -> None:
    found, out = done.found, output.console()
    output.print_head(case, found.attrs)
    inputs = [
        (
            row["input"],
            f"{row['start']:.5g}",
            f"{row['calibrated']:.5g}" + ("?" if found.warning.item() else ""),
            f"{row['standard error']:.2g}",
            row["unit"],
        )
        for row in input_records(found, done.case.given)
    ]
    output.print_table(("input", "start", "calibrated", "error", "unit"), inputs, text=("input", "unit"))
    table = [
        (
            row["mode"],
            f"{row['airspeed (KTAS)']:.4g}",
            f"{row['quantity']} {row['unit']}",
            *(f"{row[name]:.4g}" for name in ("measured", "error", "before", "after")),
            f"{row['misfit (errors)']:+.1f}",
        )
        for row in rows
    ]
    columns = ("mode", "KTAS", "quantity", "measured", "error", "before", "after", "misfit")
    output.print_table(columns, table, text=("mode", "quantity"))
    out.print(
        f"chi squared {found.attrs['chi_squared']:.3g} with {found.attrs['degrees_of_freedom']} degrees of freedom; "
        f"the chance of a larger misfit by the errors of the points is {found.attrs['chance']:.2g}.",
        style="bold",
    )
    output.print_footnotes(f"Doubtful: {text}." for text in found.warning.item().split("; ") if text)
