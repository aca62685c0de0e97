"""The command `proprotor margins`: how much each control loop may change, over airspeed."""

from __future__ import annotations

import math
from typing import Any

import click

from proprotor.case import Case
from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError
from proprotor.model.doubts import doubts_along
from proprotor.model.provenance import reservations
from proprotor.stability.margin_ranges import Kept, Needed, kept_ranges
from proprotor.tables.csv_text import csv_of
from proprotor.tables.margin_table import margin_cells, margin_records, verdict
from proprotor.tables.sweep_table import heading
from proprotor.typing import Dataset
from proprotor.units import airspeed_unit, speed_factor, speeds, to_si

_COLUMNS = ("loop", "gain dB", "Hz", "down dB", "Hz", "phase deg", "Hz", "delay ms", "Hz", "disk", "")


@arguments.command()
@arguments.case_argument
@arguments.range_option(
    'Airspeeds with their unit: "150:400:10ktas" (kt is the same), "300 keas".', required=True
)
@click.option(
    "--gain-margin",
    default="6",
    show_default=True,
    metavar="DB",
    help="Gain margin that is needed either way, in dB.",
)
@click.option(
    "--phase-margin",
    default="45 deg",
    show_default=True,
    metavar="ANGLE",
    help="Phase margin that is needed.",
)
@output.output_options(csv="Write a row for each airspeed and loop.", plot="Draw the margins over airspeed")
@arguments.model_options
def margins(
    request: arguments.Request, outputs: output.Outputs, speed: str, gain_margin: str, phase_margin: str
) -> None:
    """Show the margins of each control loop along airspeeds, and where they no longer suffice.

    CASE is a bundled case (see `proprotor cases`) or a TOML file with a section [control].

    Each loop is cut at its actuator while all others stay closed. A margin is the change of gain up or down, phase to
    either side, or delay at which the closed loop becomes unstable, with the frequency of that motion. The disk margin
    is gain and phase that may change at once. Delays are exact.

    \b
    Examples:
      proprotor margins my.toml --speed 150:400:10kt
      proprotor margins my.toml --speed 150:400:10kt --phase-margin "60 deg" \\
        --plot margins.png
      proprotor margins my.toml --speed "300 kt" \\
        --set "control.loops[damper].gain=0.02" --json
    """
    needed = _needed(gain_margin, phase_margin)
    case = request.load()
    airspeeds = speeds(speed, "--speed", case.operation.density)
    with waiting("Analysing"):
        found = case.margins(airspeeds, **request.options)
        kept = kept_ranges(case, found, needed)
    records = margin_records(found)

    def draw() -> Any:
        from proprotor.plots import plot_margins  # here, so that --help answers without it

        return plot_margins(
            found,
            gain_margin=needed.gain,
            phase_margin=needed.phase,
            unit=arguments.unit_of(speed),
            title=heading(case),
            footer=" ".join(reservations(case)),
        )

    outputs.write(
        document=lambda: output.about(case, request) | _document(found, records, kept, needed),
        table=lambda: _print(case, found, records, kept, needed, arguments.unit_of(speed)),
        csv=lambda: csv_of(records, list(records[0]), found.attrs),
        plot=draw,
    )
    output.exit_without((found.reason.values == "").any())


def _needed(gain: str, phase: str) -> Needed:
    """Return the margins that are needed.

    Raises
    ------
    InputError
        For a margin that is no number above zero.
    """
    found = []
    for option, text, unit in (("--gain-margin", gain, ""), ("--phase-margin", phase, "rad")):
        try:
            value = to_si(text, unit)
        except InputError as error:
            raise error.within(option) from None
        if value <= 0:
            raise InputError(option, text, "must be above zero")
        found.append(value)
    return Needed(*found)


def _document(
    found: Dataset, records: list[dict[str, Any]], kept: list[Kept], needed: Needed
) -> dict[str, Any]:
    return {
        "control": found.attrs["control"],
        "needed": {"gain margin (dB)": needed.gain, "phase margin (deg)": math.degrees(needed.phase)},
        "kept (m/s)": [one._asdict() for one in kept],
        "margins": records,
    }


def _print(
    case: Case, found: Dataset, records: list[dict[str, Any]], kept: list[Kept], needed: Needed, unit: str
) -> None:
    output.print_head(case, found.attrs)
    unit, factor = airspeed_unit(unit), float(speed_factor(unit, case.operation.density))
    rows = (margin_cells(record, factor) for record in records)
    output.print_table((unit, *_COLUMNS), rows, text=("loop", ""))
    output.print_doubts(doubts_along(found.airspeed.values, found.warning.values), unit, factor)
    for line in verdict(found, kept, needed, unit, factor):
        output.console().print(line, style="bold")
