"""The command `proprotor sensitivity`: which inputs move the flutter speed, or the damping of a mode."""

from __future__ import annotations

from typing import Any

import click
import numpy as np

from proprotor.case import Case
from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError
from proprotor.model.doubts import doubts_along, marked
from proprotor.tables.csv_text import csv_of
from proprotor.tables.sensitivity_summary import (
    NEARLY_DEFECTIVE,
    READ_IN,
    sensitivity_records,
    sensitivity_row,
)
from proprotor.typing import Dataset
from proprotor.units import KNOT, KTAS, speeds


@arguments.command()
@arguments.case_argument
@click.option(
    "--of",
    "of",
    type=click.Choice(tuple(READ_IN)),
    default="flutter_speed",
    show_default=True,
    help="Quantity whose derivatives are wanted.",
)
@click.option("--speed", metavar="SPEED", help='Airspeed, for --of damping: "300 ktas" or "300 keas".')
@click.option("--mode", help="Name of the mode; by default the mode that flutters first, or is damped least.")
@click.option(
    "--wrt",
    multiple=True,
    type=arguments.Input(),
    metavar="INPUT",
    help="Input with respect to which to differentiate: rotor.precone; by default all inputs. Repeatable.",
)
@arguments.scan_option
@arguments.level_option
@click.option(
    "--top", type=click.IntRange(0), default=20, show_default=True, help="Rows of the table; 0 for all."
)
@output.output_options(csv="Write a row for each input.", plot="Draw a tornado")
@arguments.model_options
def sensitivity(
    request: arguments.Request,
    outputs: output.Outputs,
    of: str,
    speed: str | None,
    mode: str | None,
    wrt: tuple[str, ...],
    scan: str | None,
    level: float,
    top: int,
) -> None:
    """Differentiate the flutter speed, or the damping of a mode, with respect to inputs of the deck.

    CASE is a bundled case or a TOML file. Derivatives are exact, with the change of the trim, per unit of the deck. The
    last column, which sorts the table, is the change if an input grows by 1 % of itself; inputs that are zero have
    none.

    \b
    Examples:
      proprotor sensitivity xv15 --plot tornado.png
      proprotor sensitivity xv15 --of damping --speed "300 kt" --mode chord
      proprotor sensitivity xv15 --wrt rotor.precone \\
        --wrt rotor.control_stiffness --json
    """
    from proprotor.plots import plot_sensitivity  # here, so that --help answers without it

    case = request.load()
    where = _where(case, of, speed, scan, level)
    with waiting("Deriving"):
        found = _one_mode(case.sensitivity(of, wrt or None, mode=mode, **where, **request.options))
    records = sensitivity_records(case, found, of)
    outputs.write(
        document=lambda: output.about(case, request) | _document(found, records, of),
        table=lambda: _print(case, found, records, of, top),
        csv=lambda: csv_of(records, list(records[0]), found.attrs),
        plot=lambda: output.with_origin(plot_sensitivity(found, count=top or found.sizes["input"]), case),
    )


def _where(case: Case, of: str, speed: str | None, scan: str | None, level: float) -> dict[str, Any]:
    """Return the arguments of `Case.sensitivity` that give the airspeed, or the range of the search for flutter."""
    if of == "damping":
        for option, given in (("--scan", scan), ("--level", level or None)):
            if given is not None:
                raise InputError(option, given, "goes with --of flutter_speed")
        if speed is None:
            raise InputError("--speed", None, 'must be given for the damping, such as "300 kt"')
        return {"airspeed": arguments.one_speed(speed, case)}
    if speed is not None:
        raise InputError("--speed", speed, "goes with --of damping; --scan is the range of the search")
    searched = None if scan is None else speeds(scan, "--scan", case.operation.density)
    return {"airspeed": searched, "level": level}


def _one_mode(found: Dataset) -> Dataset:
    """Return the part of the dataset on the mode that is damped least, if the dataset has several modes."""
    if "mode" not in found.dims:
        return found
    return found.isel(mode=int(np.nanargmin(found.damping.values)))


def _point(found: Dataset, of: str) -> tuple[str, float, float]:
    """Return the mode, the airspeed (m/s) and the value of the quantity, in SI units."""
    if of == "flutter_speed":
        return str(found.attrs["mode"]), float(found.attrs["value"]), float(found.attrs["value"])
    return str(found.mode.item()), float(found.attrs["airspeed"]), float(found.damping)


def _document(found: Dataset, records: list[dict[str, Any]], of: str) -> dict[str, Any]:
    read_in, factor = READ_IN[of]
    mode, airspeed, value = _point(found, of)
    return {
        "of": of,
        "mode": mode,
        "airspeed (m/s)": airspeed,
        f"value ({read_in})": value / factor,
        "nearly defective": bool(found.nearly_defective),
        "warning": found.warning.item(),
        "sensitivities": records,
    }


def _print(case: Case, found: Dataset, records: list[dict[str, Any]], of: str, top: int) -> None:
    output.print_head(case, found.attrs)
    out = output.console()
    read_in, factor = READ_IN[of]
    mode, airspeed, value = _point(found, of)
    number = marked(f"{value / factor:.4g}", found.warning.item())
    at = f" at {airspeed / KNOT:.4g} {KTAS}" if of == "damping" else ""
    out.print(f"{of.replace('_', ' ').capitalize()} {number} {read_in}{at} ({mode})", style="bold")
    shown = records[: top or None]
    columns = ("input", "value", f"{read_in} per unit", "unit", f"{read_in} for +1 %")
    rows = (sensitivity_row(record, read_in) for record in shown)
    output.print_table(columns, rows, text=("input", "value", "unit"))
    if len(shown) < len(records):
        out.print(f"{len(records) - len(shown)} more inputs (--top 0).")
    output.print_doubts(doubts_along(airspeed, found.warning.values))
    if bool(found.nearly_defective):
        out.print(NEARLY_DEFECTIVE)
