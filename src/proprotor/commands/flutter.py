"""The command `proprotor flutter`: the airspeeds at which a case becomes unstable."""

from __future__ import annotations

import math
from typing import Any

import click

from proprotor.case import Case
from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError
from proprotor.model.doubts import doubt_at
from proprotor.model.provenance import reservations
from proprotor.model.stamp import unusual_options
from proprotor.stability.flutter import FlutterPoint
from proprotor.stability.flutter_messages import (
    COLUMNS,
    answer,
    boundary_record,
    boundary_row,
    equivalent,
    failed_records,
    mechanism_message,
    modes_beyond,
    remarks,
    verdict,
)
from proprotor.tables.csv_text import csv_of
from proprotor.units import KNOT, airspeed_unit, speed_factor, speeds


@arguments.command()
@arguments.case_argument
@arguments.scan_option
@click.option(
    "--speed", metavar="SPEED", help='Airspeed whose margin to flutter is wanted: "250 ktas" or "250 keas".'
)
@arguments.level_option
@click.option("--brief", is_flag=True, help="Print the answer first, then what it rests on, and no table.")
@output.output_options(csv="Write a row for each boundary.")
@arguments.model_options
def flutter(
    request: arguments.Request,
    outputs: output.Outputs,
    scan: str | None,
    speed: str | None,
    level: float,
    brief: bool,
) -> None:
    """Find the airspeeds at which modes become unstable, or stable again.

    CASE is a bundled case (see `proprotor cases`) or a TOML file.

    The search covers the whole range, also between the airspeeds of the scan, and is exact to rounding. At flutter a
    pair of eigenvalues loses its damping, at divergence a real eigenvalue does. Of an aircraft that flies free,
    instabilities of the rigid body are a third kind, and the flutter speed is that of flutter alone. The mechanism says
    which modes take part in the motion at the boundary, and how much. If no mode becomes unstable, the command prints
    the range of the search, and the least damping in the range with its mode. If airspeeds could not be analysed, it
    says why. The last line is the answer; with --brief it is the first.

    \b
    Examples:
      proprotor flutter xv15
      proprotor flutter xv15 --brief
      proprotor flutter xv15 --speed "160 kt" --level "3 %"
      proprotor flutter my.toml --set rotor.precone="1.5 deg" --json
    """
    if brief and outputs.as_json:
        raise InputError("--brief", None, "goes without --json, which prints everything")
    case = request.load()
    airspeeds = None if scan is None else speeds(scan, "--scan", case.operation.density)
    at = None if speed is None else arguments.one_speed(speed, case)
    if at == 0:
        raise InputError("--speed", speed, "must be above zero")
    with waiting("Looking for boundaries"):
        found = case.flutter_point(airspeeds, level=level, **request.options)
    records = [boundary_record(boundary, case) for boundary in found.boundaries]
    rows = [record | {"mechanism": mechanism_message(record["mechanism"])} for record in records]
    outputs.write(
        document=lambda: output.about(case, request) | _document(found, records, at),
        table=lambda: (_print_brief if brief else _print)(
            case, found, at, arguments.unit_of(scan or speed or "kt")
        ),
        csv=lambda: csv_of(rows, COLUMNS, found.stamp),
    )
    output.exit_without(math.isfinite(found.searched[0]))


def _document(found: FlutterPoint, records: list[dict[str, Any]], at: float | None) -> dict[str, Any]:
    document: dict[str, Any] = {
        "level (damping ratio)": found.level,
        "searched (m/s)": list(found.searched),
        "not analysed": failed_records(found),
        "flutter speed (KTAS)": found.speed / KNOT,
        "flutter speed (KEAS)": equivalent(found.speed, found.stamp),
        "flutter speed (m/s)": found.speed,
        "mode": found.mode or None,
        "kind": found.kind or None,
        "warning": found.warning,
        "beyond the level at the lowest airspeed": list(found.unstable_at_start),
        "least damping (% of critical)": 100 * found.least_damping,
        "mode of the least damping": found.least_damping_mode or None,
        "airspeed of the least damping (KTAS)": found.least_damping_speed / KNOT,
        "airspeed of the least damping (m/s)": found.least_damping_speed,
        "warning of the least damping": doubt_at(found.doubts, found.least_damping_speed),
        "boundaries": records,
        "doubts": output.doubts_as_data(found.doubts),
        "eigen-solves": found.eigen_solves,
    }
    if at is not None:
        document["at"] = {
            "airspeed (m/s)": at,
            "margin": found.margin(at),
            "modes beyond the level": modes_beyond(found, at),
        }
    return document


def _print(case: Case, found: FlutterPoint, at: float | None, unit: str) -> None:
    """Print the case, its boundaries, their doubts, and the answer last."""
    output.print_head(case, found.stamp)
    unit, factor = airspeed_unit(unit), float(speed_factor(unit, case.operation.density))
    if found.boundaries:
        columns = (unit, "Hz", "/rev", "mode", "kind", "", "mechanism")
        rows = (boundary_row(boundary_record(boundary, case), factor) for boundary in found.boundaries)
        output.print_table(columns, rows, text=columns[3:])
    output.print_doubts(found.doubts, unit, factor)
    for line in verdict(found, at, unit, factor):
        output.console().print(line, style="bold")


def _print_brief(case: Case, found: FlutterPoint, at: float | None, unit: str) -> None:
    """Print the answer first, then its doubts and what it rests on."""
    unit, factor = airspeed_unit(unit), float(speed_factor(unit, case.operation.density))
    for line in answer(found, at, unit, factor):
        output.console().print(line, style="bold")
    output.print_doubts(found.doubts, unit, factor)
    for line in (*remarks(found, unit, factor), *unusual_options(found.stamp), *reservations(case)):
        output.console().print(line)
