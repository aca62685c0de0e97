"""The command `proprotor attribution`: what drives and what damps a mode."""

from __future__ import annotations

from typing import Any

import click

from proprotor.case import Case
from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.model.doubts import doubts_along, marked
from proprotor.stability.sensitivity import damping_rate
from proprotor.tables.csv_text import csv_of
from proprotor.typing import Dataset

_COLUMNS = ("origin", "growth (1/s)", "frequency (rad/s)", "damping (% of critical)", "warning")


@arguments.command()
@arguments.case_argument
@click.option(
    "--speed", required=True, metavar="SPEED", help='Airspeed: "300 ktas" (kt is the same) or "300 keas".'
)
@click.option("--mode", help="Name of the mode; by default the mode that is damped least.")
@output.output_options(csv="Write a row for each origin.", plot="Draw the damping of each origin")
@arguments.model_options
def attribution(request: arguments.Request, outputs: output.Outputs, speed: str, mode: str | None) -> None:
    """Show what drives and what damps a mode, by the physical origin of the terms.

    CASE is a bundled case or a TOML file. A number is the change of the eigenvalue if all terms of one origin grew by
    100 %, to first order, with the same trim and mode. An origin with positive growth drives the mode. Over all origins
    the changes sum to zero.

    \b
    Examples:
      proprotor attribution xv15 --speed "380 kt" --mode chord
      proprotor attribution xv15 --speed "380 kt" --plot chord.png --csv chord.csv
    """
    from proprotor.plots import plot_attribution  # here, so that --help answers without it

    case = request.load()
    airspeed = arguments.one_speed(speed, case)
    with waiting("Analysing"):
        found = _least_damped(case.attribution(airspeed, mode, **request.options))
    records = _records(found)
    outputs.write(
        document=lambda: output.about(case, request) | _document(found, records, airspeed),
        table=lambda: _print(case, found, records, speed),
        csv=lambda: csv_of(records, _COLUMNS, found.attrs),
        plot=lambda: output.with_origin(plot_attribution(found), case),
    )


def _least_damped(found: Dataset) -> Dataset:
    """Return the part of the dataset on the mode that is damped least."""
    value = found.eigenvalue.values
    return found.isel(mode=[int((-value.real / abs(value)).argmin())])


def _records(found: Dataset) -> list[dict[str, Any]]:
    """Return a record of `_COLUMNS` for each origin, the largest change of growth first."""
    changes = found.contribution.values[:, 0]
    damping = 100 * damping_rate(found.eigenvalue.values, changes)
    columns = (found.origin.values, changes.real, changes.imag, damping)
    rows = zip(*(column.tolist() for column in columns), strict=True)
    records = [dict(zip(_COLUMNS, (*row, found.warning.item()), strict=True)) for row in rows]
    return sorted(records, key=lambda record: -abs(record["growth (1/s)"]))


def _document(found: Dataset, records: list[dict[str, Any]], airspeed: float) -> dict[str, Any]:
    value = complex(found.eigenvalue.values[0])
    return {
        "airspeed (m/s)": airspeed,
        "mode": str(found.mode.values[0]),
        "Re s (rad/s)": value.real,
        "Im s (rad/s)": value.imag,
        "damping (% of critical)": -100 * value.real / abs(value),
        "warning": found.warning.item(),
        "origins": records,
    }


def _print(case: Case, found: Dataset, records: list[dict[str, Any]], speed: str) -> None:
    output.print_head(case, found.attrs)
    value = complex(found.eigenvalue.values[0])
    out = output.console()
    doubt = found.warning.item()
    damping = f"damping {marked(f'{-100 * value.real / abs(value):.3g}', doubt)} % of critical"
    frequency = f"{marked(f'{abs(value.imag) / float(case.operation.rotor_speed):.3f}', doubt)} per rev"
    mode = f"{found.mode.values[0]} at {arguments.written_speed(speed)}"
    out.print(f"{mode}: {frequency}, {damping}", style="bold")
    rows = (
        (origin, *(marked(f"{n:+.4f}", doubt) for n in numbers), "drives" if numbers[0] > 0 else "damps")
        for origin, *numbers, _ in map(dict.values, records)
    )
    columns = ("origin", "growth, 1/s", "frequency, rad/s", "damping, %", "")
    output.print_table(columns, rows, text=("origin", ""))
    output.print_doubts(doubts_along(found.attrs["airspeed"], found.warning.values))
