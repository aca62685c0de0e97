"""The command `proprotor identify`: frequency and damping from a record of a free decay."""

from __future__ import annotations

from typing import Any

import click

from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError
from proprotor.model.doubts import marked
from proprotor.records.identify import METHODS
from proprotor.records.identify import identify as identified
from proprotor.records.record import read_record
from proprotor.tables.csv_text import csv_of
from proprotor.tables.record_table import identified_records
from proprotor.units import airspeed_unit, speeds

_FLAGS = {name.replace(" ", "-"): name for name in METHODS}


@arguments.command()
@click.argument("record", metavar="RECORD")
@click.option(
    "--method",
    type=click.Choice(list(_FLAGS)),
    default="least-squares",
    show_default=True,
    help="Several modes in several channels at once, or one mode in one channel by either of the others.",
)
@click.option("--channel", multiple=True, metavar="NAME", help="Channel to take; by default all. Repeatable.")
@click.option("--between", metavar="TIMES", help='Part of the record that decays freely: "0.4:3 s".')
@click.option("--frequency", metavar="FREQUENCY", help='Frequency near which the mode is sought: "3 Hz".')
@click.option("--modes", type=int, metavar="NUMBER", help="How many modes there are, for least-squares.")
@click.option("--block", metavar="TIME", help='Length of the block, for moving-block: "1.5 s".')
@click.option(
    "--at", metavar="SPEED", help='Airspeed of the test, to go with the rows: "250 ktas" or "250 keas".'
)
@click.option("--called", metavar="MODE", help="Name of the mode in a sweep, to go with the rows.")
@output.output_options(csv="Write a row for each mode, which --points and `proprotor calibrate` read.")
def identify(
    outputs: output.Outputs,
    record: str,
    method: str,
    channel: tuple[str, ...],
    between: str | None,
    frequency: str | None,
    modes: int | None,
    block: str | None,
    at: str | None,
    called: str | None,
) -> None:
    """Find frequency and damping of the modes in the record of a free decay, with standard errors.

    RECORD is a CSV file: a column "time [s]" in even steps, and a column for each channel. Errors follow from the noise
    beside the modes, as if it were white.

    \b
    Examples:
      proprotor identify decay.csv
      proprotor identify decay.csv --between "0.5:4 s" --channel beam \\
        --method moving-block --frequency "3 Hz"
      proprotor identify decay.csv --at "250 ktas" --called beam \\
        --frequency "3 Hz" --csv point.csv
    """
    point = _point(at, called)
    how: dict[str, Any] = {
        "channels": channel or None,
        "frequency": frequency,
        "modes": modes,
        "block": block,
    }
    with waiting("Reading"):
        read = read_record(record, "RECORD")
        found = identified(read, _FLAGS[method], between=_times(between), **how)
    rows = identified_records(found, point)
    outputs.write(
        document=lambda: dict(found.attrs) | {"modes": rows},
        table=lambda: _print(dict(found.attrs), rows),
        csv=lambda: csv_of(rows, list(rows[0])),
    )


def _point(at: str | None, called: str | None) -> dict[str, Any]:
    """Return the entries of a test point."""
    point: dict[str, Any] = {}
    if at is not None:
        speeds(at, "--at", 1.0)  # which refuses what is no airspeed
        unit = arguments.unit_of(at)
        point[f"airspeed [{airspeed_unit(unit).lower()}]"] = float(at.strip().removesuffix(unit))
    return point | ({} if called is None else {"mode": called})


def _times(between: str | None) -> tuple[str, str] | None:
    """Return the two times of ``"0.4:3 s"``."""
    if between is None:
        return None
    start, colon, stop = between.partition(":")
    if not colon or ":" in stop:
        raise InputError("--between", between, 'must be two times, such as "0.4:3 s"')
    return f"{start.strip()} {arguments.unit_of(stop)}", stop.strip()


def _print(about: dict[str, Any], rows: list[dict[str, Any]]) -> None:
    out = output.console()
    start, stop = about["start"], about["start"] + about["duration"]
    out.print(f"{about['record']}: {about['method']}, {start:.4g} to {stop:.4g} s")
    out.print("Frequency is damped; errors are standard errors by the noise beside the modes.")
    out.print()
    columns = ("Hz", "error", "damping %", "error ")
    table = [
        (
            marked(f"{row['frequency [Hz]']:.5g}", row["warning"]),
            f"{row['frequency_error [Hz]']:.2g}",
            marked(f"{row['damping [%]']:.4g}", row["warning"]),
            f"{row['damping_error [%]']:.2g}",
        )
        for row in rows
    ]
    output.print_table(columns, table)
    output.print_footnotes(dict.fromkeys(f"Doubtful: {row['warning']}." for row in rows if row["warning"]))
