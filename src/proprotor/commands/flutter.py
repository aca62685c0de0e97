"""The command `proprotor flutter`: where a case becomes unstable."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import click

from proprotor.commands import output
from proprotor.commands.arguments import (
    EXIT_CODES,
    case_argument,
    in_order,
    level_of,
    level_option,
    loaded_case,
    model_options,
    one_speed,
    scan_option,
    settings_of,
    unit_of,
)
from proprotor.errors import InputError
from proprotor.waiting import waiting

if TYPE_CHECKING:
    from proprotor.case import Case
    from proprotor.flutter import Boundary, FlutterPoint

COLUMNS = (
    "airspeed (kt)",
    "airspeed (m/s)",
    "frequency (Hz)",
    "frequency (per rev)",
    "mode",
    "kind",
    "onset",
    "mechanism",
    "growth per airspeed (1/m)",
)


@click.command(epilog=EXIT_CODES, short_help="Flutter and divergence boundaries, and the margin.")
@case_argument
@scan_option
@click.option(
    "--speed", metavar="SPEED", help='An airspeed, such as "250 kt", whose margin to flutter is told.'
)
@level_option
@output.output_options(csv="Write a row for each boundary.")
@model_options
def flutter(
    case: str,
    settings: tuple[str, ...],
    scan: str | None,
    speed: str | None,
    level: str,
    csv: str | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Airspeeds at which modes become unstable, or stable again.

    CASE is a bundled case (see `proprotor cases`) or a TOML file that describes one.

    Every boundary in the range is found, to rounding: flutter, where a pair of eigenvalues loses its damping, and
    divergence, where a real one does. The mechanism tells which modes take part in the motion there and how much.

    \b
    Examples:
      proprotor flutter xv15
      proprotor flutter xv15 --speed "160 kt" --level "3 %"
      proprotor flutter my.toml --set rotor.precone="1.5 deg" --json
    """
    from proprotor.units import speeds

    options, damping = in_order(options), level_of(level)
    airspeeds = None if scan is None else speeds(scan, "--scan")
    at = None if speed is None else one_speed(speed)
    if at == 0:
        raise InputError("--speed", speed, "must be above zero")
    loaded = loaded_case(case, settings)
    with waiting("Looking for boundaries"):
        found = loaded.flutter_point(airspeeds, level=damping, **options)
    records = [_record(boundary, loaded) for boundary in found.boundaries]
    if csv:
        rows = [record | {"mechanism": _told(record["mechanism"])} for record in records]
        output.write("--csv", csv, output.csv_of(rows, COLUMNS))
    if as_json:
        head = output.about(loaded, options, settings_of(settings))
        output.print_json(head | _document(found, records, at))
    else:
        _print(loaded, found, at, unit_of(scan or speed or "kt"))
    if not math.isfinite(found.searched[0]):
        raise click.exceptions.Exit(1)


def _record(boundary: Boundary, case: Case) -> dict[str, Any]:
    values = (
        boundary.position / output.KNOT,
        boundary.position,
        boundary.frequency / (2 * math.pi),
        boundary.frequency / float(case.operation.rotor_speed),
        boundary.mode,
        boundary.kind,
        boundary.onset,
        dict(boundary.mechanism),
        boundary.rate,
    )
    return dict(zip(COLUMNS, values, strict=True))


def _document(found: FlutterPoint, records: list[dict[str, Any]], at: float | None) -> dict[str, Any]:
    document = {
        "level (damping ratio)": found.level,
        "searched (m/s)": list(found.searched),
        "flutter speed (kt)": found.speed / output.KNOT,
        "flutter speed (m/s)": found.speed,
        "mode": found.mode or None,
        "kind": found.kind or None,
        "beyond the level at the lowest airspeed": list(found.unstable_at_start),
        "boundaries": records,
        "eigen-solves": found.eigen_solves,
    }
    if at is None:
        return document
    margin = {"airspeed (m/s)": at, "margin": found.margin(at), "modes beyond the level": _beyond(found, at)}
    return document | {"at": margin}


def _beyond(found: FlutterPoint, airspeed: float) -> int | None:
    """How many modes are beyond the level at an airspeed; None outside the range that was searched."""
    low, high = found.searched
    if not low <= airspeed <= high:
        return None
    passed = [boundary.onset for boundary in found.boundaries if boundary.position < airspeed]
    return len(found.unstable_at_start) + 2 * sum(passed) - len(passed)


def _print(case: Case, found: FlutterPoint, at: float | None, unit: str) -> None:
    from proprotor.units import factor_to_si

    output.print_head(case)
    if not math.isfinite(found.searched[0]):
        output.console().print("No airspeed could be analysed.", style="bold")
        return
    factor = factor_to_si(unit, unit, "m/s")
    if found.boundaries:
        columns = (unit, "Hz", "/rev", "mode", "kind", "", "mechanism")
        rows = (_row(_record(boundary, case), factor) for boundary in found.boundaries)
        output.print_table(columns, rows, text=columns[3:])
    for line in _verdict(found, at, unit, factor):
        output.console().print(line, style="bold")


def _row(record: dict[str, Any], factor: float) -> tuple[str, ...]:
    return (
        f"{record['airspeed (m/s)'] / factor:.2f}",
        f"{record['frequency (Hz)']:.3f}",
        f"{record['frequency (per rev)']:.3f}",
        record["mode"],
        record["kind"],
        "begins" if record["onset"] else "ends",
        _told(record["mechanism"]),
    )


def _told(mechanism: dict[str, float]) -> str:
    return ", ".join(f"{name} {100 * share:.0f} %" for name, share in mechanism.items())


def _verdict(found: FlutterPoint, at: float | None, unit: str, factor: float) -> Iterator[str]:
    low, high = (speed / factor for speed in found.searched)
    beyond = f"below {100 * found.level:g} % of critical" if found.level else "unstable"
    if found.unstable_at_start:
        yield f"Already {beyond} at {low:.4g} {unit}: {', '.join(found.unstable_at_start)}."
    if math.isnan(found.speed):
        yield f"No mode becomes {beyond} between {low:.4g} and {high:.4g} {unit}."
    else:
        yield f"Flutter speed {found.speed / factor:.2f} {unit} ({found.mode}, {found.kind})."
    if at is None:
        return
    count = _beyond(found, at)
    if count is None:
        yield f"{at / factor:.4g} {unit} lies outside the range searched, {low:.4g} to {high:.4g} {unit}."
    elif count:
        yield f"At {at / factor:.4g} {unit} {count} mode{'s are' if count > 1 else ' is'} {beyond}."
    if not math.isnan(found.speed):
        yield f"Margin at {at / factor:.4g} {unit}: {100 * found.margin(at):+.1f} % of that airspeed."
