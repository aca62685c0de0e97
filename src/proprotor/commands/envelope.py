"""The command `proprotor envelope`: the flutter speeds of all conditions of a deck against V_D at altitude."""

from __future__ import annotations

from typing import Any

import click

from proprotor.case import Case
from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError
from proprotor.tables.csv_text import csv_of
from proprotor.tables.envelope_table import (
    COLUMNS,
    HEADING,
    SCOPE,
    TEXT,
    envelope_footnotes,
    envelope_records,
    envelope_rows,
    envelope_verdict,
)
from proprotor.typing import Dataset
from proprotor.units import speeds

_NARROWEST = 16  # characters of the names of conditions, which are wrapped


@arguments.command()
@arguments.case_argument
@click.option(
    "--only",
    "variants",
    multiple=True,
    metavar="NAME",
    help="A variant of the deck; all of them by default. The deck itself is always a condition. Repeatable.",
)
@click.option(
    "--scan",
    metavar="RANGE",
    help='Airspeeds between which to search: "100:400:10keas"; by default 0.2 to 1.2 of the tip speed, or to 1.1 of '
    "the speed needed.",
)
@output.output_options(
    csv="Write a row for each condition, rotor speed, power and altitude.",
    plot="Draw the boundary of each condition over equivalent airspeed and altitude",
)
@arguments.model_options
def envelope(
    request: arguments.Request, outputs: output.Outputs, variants: tuple[str, ...], scan: str | None
) -> None:
    """Hold the flutter speeds of all conditions of a deck against its dive speed at altitude.

    CASE is a bundled case or a TOML file with a table [envelope]: V_D and M_D, altitudes, perhaps rotor speeds, powers
    and a damping. Its tables [variants.NAME] are further conditions, normal ones or failures, which must be free of
    flutter up to 1.15 V_D and up to V_D unless the deck says otherwise. The table has the worst altitude of each
    condition; files have all. The exit code is 1 if nothing could be analysed.

    \b
    Examples:
      proprotor envelope my.toml --plot envelope.png
      proprotor envelope my.toml --only downstop-off --csv envelope.csv
      proprotor envelope my.toml --set "envelope.speed_factor=1.2"
    """
    case = request.load()
    if scan is not None and speeds(scan, "--scan", case.operation.density).size < 2:
        raise InputError("--scan", scan, 'must be a range of airspeeds that rise, such as "100:400:10keas"')
    with waiting("Looking for boundaries"):
        found = case.envelope(scan, variants=variants or None, **request.options)
    records = envelope_records(found)

    def draw() -> Any:
        from proprotor.plots import plot_envelope, rests_on  # here, so that --help answers without it

        return rests_on(plot_envelope(found), case, f"{case.title or case.name}.", SCOPE)

    outputs.write(
        document=lambda: output.about(case, request) | _document(found, records),
        table=lambda: _print(case, found),
        csv=lambda: csv_of(records, list(records[0]), found.attrs),
        plot=draw,
    )
    output.exit_without(bool((found.searched.values > 0).any()))


def _document(found: Dataset, records: list[dict[str, Any]]) -> dict[str, Any]:
    return {
        "damping required": found.attrs["damping_ratio"],
        "worst case": found.attrs["worst"],
        "summary": envelope_verdict(found),
        "scope": SCOPE,
        "places": records,
        "eigen-solves": int(found.attrs["eigen_solves"]),
    }


def _print(case: Case, found: Dataset) -> None:
    output.print_head(case, found.attrs)
    out = output.console()
    out.print(f"{HEADING}:")
    output.print_table(COLUMNS, envelope_rows(found), text=TEXT, narrowest=_NARROWEST)
    for sentence in (*envelope_footnotes(found), SCOPE):
        out.print(sentence)
    out.print(envelope_verdict(found), style="bold")
