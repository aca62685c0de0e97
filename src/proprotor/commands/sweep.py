"""The command `proprotor sweep`: frequency and damping along airspeeds."""

from __future__ import annotations

import shlex
import textwrap
from typing import Any

import click

from proprotor.case import Case
from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.model.options_in_force import options_in_result, options_text
from proprotor.model.provenance import reservations
from proprotor.tables.sweep_summary import unstable_ranges
from proprotor.tables.sweep_table import CONVENTION, SweepTable, heading
from proprotor.units import speeds


@arguments.command()
@arguments.case_argument
@arguments.range_option(
    'Airspeeds with their unit: "50:400:5ktas" is 50 to 400 KTAS by 5 (kt is the same); also "300 keas", '
    '"25:200:2.5 m/s".',
    required=True,
)
@click.option("--all-modes", is_flag=True, help="Show all modes, not only as many as fit into one table.")
@arguments.points_option
@output.output_options(csv="Write a row for each airspeed and mode.", plot="Draw frequency and damping")
@arguments.model_options
def sweep(
    request: arguments.Request, outputs: output.Outputs, speed: str, all_modes: bool, points: str | None
) -> None:
    """Show frequency and damping of each mode along a range of airspeeds.

    CASE is a bundled case (see `proprotor cases`) or a TOML file.

    The table shows the modes that become unstable, the modes of the support, and the modes that move the support most.
    Damping is -Re s/|s| of the eigenvalue s in percent of critical, negative where a mode is unstable. If an airspeed
    cannot be analysed, its row says why.

    \b
    Examples:
      proprotor sweep xv15 --speed 50:400:5kt --plot damping.png
      proprotor sweep xv15 --speed 50:400:5kt --set rotor.precone="1.5 deg"
      proprotor sweep xv15 --speed 50:400:5kt --plot damping.png \\
        --points measured.csv
      proprotor sweep xv15 --speed 50:400:5kt --pitch coupling --locked gimbal \\
        --csv modes.csv
    """
    from proprotor.plots import plot_sweep  # here, so that --help answers without it

    with waiting("Analysing"):
        case = request.load()
        density = case.operation.density
        airspeeds = speeds(speed, "--speed", density)
        up = [arguments.FREQUENCY, arguments.DAMPING]
        measured = arguments.points_of(points, outputs.plot, arguments.airspeed_points(density), up)
        found = case.sweep(airspeeds, **request.options)
    table = SweepTable(found, case.operation.rotor_speed, arguments.unit_of(speed))
    outputs.write(
        document=lambda: output.about(case, request) | _document(table),
        table=lambda: _print(case, request.name, table, all_modes),
        csv=table.csv,
        plot=lambda: plot_sweep(
            found,
            rotor_speed=table.rotor_speed,
            unit=table.unit,
            title=heading(case),
            footer=" ".join(reservations(case)),
            points=measured,
        ),
    )
    output.exit_without(not table.failed.all())


def _document(table: SweepTable) -> dict[str, Any]:
    return {
        "convention": CONVENTION,
        "unstable ranges (m/s, interpolated)": [found._asdict() for found in unstable_ranges(table.sweep)],
        "points": list(table.records()),
    }


def _print(case: Case, name: str, table: SweepTable, all_modes: bool) -> None:
    """Print the case with its reservations, the table of a sweep, and where modes are unstable."""
    out = output.console()
    for line in (
        heading(case),
        f"Model: {options_text(options_in_result(table.sweep.attrs))}.",
        CONVENTION,
        *reservations(case),
        *(_shortened(f"Warning: {text}", name, out.width) for text in case.warnings),
        "",
    ):
        out.print(line)
    for row in table.lines(out.width, all_modes):
        out.print(row, soft_wrap=True)
    output.print_footnotes(table.doubts())
    if mixed := table.mixed():
        out.print(mixed)
    for line in table.verdict():
        out.print(line, style="bold")


def _shortened(text: str, name: str, width: int) -> str:
    """Return about two lines of a warning, and the command that prints all of it; `name` is of a deck or its file."""
    return textwrap.shorten(text, 2 * width - 20, placeholder=f" ... (proprotor cases {shlex.quote(name)})")
