"""The command `proprotor sensitivity`: what moves the flutter speed, or the damping of a mode."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click
import numpy as np

from proprotor.commands import output
from proprotor.commands.arguments import (
    EXIT_CODES,
    Input,
    case_argument,
    in_order,
    level_of,
    level_option,
    loaded_case,
    model_options,
    one_speed,
    scan_option,
    settings_of,
)
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError
from proprotor.model.doubts import doubts_along, marked
from proprotor.tables.csv_text import csv_of
from proprotor.tables.sensitivity_summary import READ_IN, sensitivity_records
from proprotor.units import KNOT

if TYPE_CHECKING:
    import xarray

    from proprotor.case import Case


@click.command(epilog=EXIT_CODES, short_help="What moves the flutter speed or a damping, input by input.")
@case_argument
@click.option(
    "--of",
    "of",
    type=click.Choice(tuple(READ_IN)),
    default="flutter_speed",
    show_default=True,
    help="What is derived.",
)
@click.option("--speed", metavar="SPEED", help='Airspeed, such as "300 kt"; for --of damping.')
@click.option("--mode", help="Mode by name; by default the one that flutters first, or is damped least.")
@click.option(
    "--wrt",
    multiple=True,
    type=Input(),
    metavar="INPUT",
    help="With respect to what, by deck path, such as rotor.precone; all inputs by default. Repeatable.",
)
@scan_option
@level_option
@click.option("--top", type=click.IntRange(0), default=20, show_default=True, help="Rows; 0 for all.")
@output.output_options(csv="Write a row for each input.", plot="Draw a tornado")
@model_options
def sensitivity(
    case: str,
    settings: tuple[str, ...],
    of: str,
    speed: str | None,
    mode: str | None,
    wrt: tuple[str, ...],
    scan: str | None,
    level: str,
    top: int,
    csv: str | None,
    plot: str | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Derivatives of the flutter speed, or of the damping of a mode, by inputs of the deck.

    CASE is a bundled case or a TOML file. Derivatives are exact, trim included, per unit of the deck. The last column
    is the change when an input grows by 1 % of itself; it sorts the table, and cannot be told for inputs that are
    zero.

    \b
    Examples:
      proprotor sensitivity xv15 --plot tornado.png
      proprotor sensitivity xv15 --of damping --speed "300 kt" --mode chord
      proprotor sensitivity xv15 --wrt rotor.precone --wrt rotor.control_stiffness --json
    """
    output.check_outputs(csv, plot, as_json=as_json)
    options, damping = in_order(options), level_of(level)
    where = _where(of, speed, scan, damping)
    loaded = loaded_case(case, settings)
    with waiting("Deriving"):
        found = loaded.sensitivity(of, wrt or None, mode=mode, **where, **options)
    found = _one_mode(found)
    records = sensitivity_records(loaded, found, of)
    if csv:
        output.write_csv(csv, csv_of(records, list(records[0]), found.attrs))
    if plot:
        output.write_plot(plot, loaded, lambda: _draw(found, top))
    if as_json:
        head = output.about(loaded, options, settings_of(settings))
        output.print_json(head | _document(found, records, of))
    elif csv != output.STANDARD_OUTPUT:
        _print(loaded, found, records, of, top)


def _where(of: str, speed: str | None, scan: str | None, level: float) -> dict[str, Any]:
    """Where the quantity is, as `Case.sensitivity` takes it."""
    from proprotor.units import speeds

    if of == "damping":
        for option, given in (("--scan", scan), ("--level", level or None)):
            if given is not None:
                raise InputError(option, given, "goes with --of flutter_speed")
        if speed is None:
            raise InputError("--speed", None, 'must be given for the damping, such as "300 kt"')
        return {"airspeed": one_speed(speed)}
    if speed is not None:
        raise InputError("--speed", speed, "goes with --of damping; --scan is where flutter is looked for")
    return {"airspeed": None if scan is None else speeds(scan, "--scan"), "level": level}


def _one_mode(found: xarray.Dataset) -> xarray.Dataset:
    """Of several modes the one that is damped least."""
    if "mode" not in found.dims:
        return found
    return found.isel(mode=int(np.nanargmin(found.damping.values)))


def _mode(found: xarray.Dataset) -> str:
    return str(found.attrs["mode"] if "mode" in found.attrs else found.mode.item())


def _document(found: xarray.Dataset, records: list[dict[str, Any]], of: str) -> dict[str, Any]:
    read_in, factor = READ_IN[of]
    airspeed = found.attrs["value"] if of == "flutter_speed" else found.attrs["airspeed"]
    return {
        "of": of,
        "mode": _mode(found),
        "airspeed (m/s)": float(airspeed),
        f"value ({read_in})": _value(found, of) / factor,
        "nearly defective": bool(found.nearly_defective),
        "warning": found.warning.item(),
        "sensitivities": records,
    }


def _value(found: xarray.Dataset, of: str) -> float:
    return float(found.attrs["value"] if of == "flutter_speed" else found.damping)


def _draw(found: xarray.Dataset, top: int) -> Any:
    from proprotor.plots import plot_sensitivity

    return plot_sensitivity(found, count=top or found.sizes["input"])


def _print(case: Case, found: xarray.Dataset, records: list[dict[str, Any]], of: str, top: int) -> None:
    output.print_head(case, found.attrs)
    out = output.console()
    read_in, factor = READ_IN[of]
    what = "Flutter speed" if of == "flutter_speed" else "Damping"
    at = "" if of == "flutter_speed" else f" at {found.attrs['airspeed'] / KNOT:.4g} kt"
    value = marked(f"{_value(found, of) / factor:.4g}", found.warning.item())
    out.print(f"{what} {value} {read_in}{at} ({_mode(found)})", style="bold")
    shown = records[: top or None]
    columns = ("input", "value", f"{read_in} per unit", "unit", f"{read_in} for +1 %")
    output.print_table(columns, (_row(record, read_in) for record in shown), text=("input", "value", "unit"))
    if len(shown) < len(records):
        out.print(f"{len(records) - len(shown)} more inputs (--top 0).")
    airspeed = found.attrs["value" if of == "flutter_speed" else "airspeed"]
    output.print_doubts(doubts_along(airspeed, found.warning.values))
    if bool(found.nearly_defective):
        out.print("The mode nearly falls into one with another: derivatives hold in a small range only.")


def _row(record: dict[str, Any], read_in: str) -> tuple[str, ...]:
    change = record[f"for +1 % ({read_in})"]
    return (
        record["input"],
        record["value"],
        marked(f"{record[f'derivative ({read_in} per unit)']:+.4g}", record["warning"]),
        record["unit"],
        "" if change is None else marked(f"{change:+.3g}", record["warning"]),
    )
