"""The command `proprotor sweep`: frequency and damping along airspeeds."""

from __future__ import annotations

from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import click

from proprotor.commands import output
from proprotor.commands.arguments import (
    EXIT_CODES,
    case_argument,
    in_order,
    loaded_case,
    model_options,
    settings_of,
    unit_of,
)
from proprotor.commands.waiting import waiting

if TYPE_CHECKING:
    from proprotor.case import Case
    from proprotor.tables.sweep_table import SweepTable


@click.command(epilog=EXIT_CODES)
@case_argument
@click.option(
    "--speed",
    required=True,
    metavar="RANGE",
    help='Airspeeds with their unit: "50:400:5kt" is 50 to 400 kt by 5 kt; also "300 kt", "25:200:2.5 m/s".',
)
@click.option("--all-modes", is_flag=True, help="Put every mode into the table, not only as many as fit.")
@output.output_options(csv="Write a row for each airspeed and mode.", plot="Draw frequency and damping")
@model_options
def sweep(
    case: str,
    settings: tuple[str, ...],
    speed: str,
    plot: str | None,
    csv: str | None,
    as_json: bool,
    all_modes: bool,
    **options: Any,
) -> None:
    """Frequency and damping of each mode along a range of airspeeds.

    CASE is a bundled case (see `proprotor cases`) or a TOML file that describes one.

    The table has the modes that become unstable, the support's, and others that move it the most. Damping
    is -Re s/|s| of the eigenvalue s in percent of critical, negative where a mode is unstable. An airspeed
    that cannot be analysed is a row that says why.

    \b
    Examples:
      proprotor sweep xv15 --speed 50:400:5kt --plot damping.png
      proprotor sweep xv15 --speed 50:400:5kt --set rotor.precone="1.5 deg"
      proprotor sweep xv15 --speed 50:400:5kt --pitch coupling --locked gimbal --csv modes.csv
    """
    output.check_outputs(csv, plot, as_json=as_json)
    options = in_order(options)
    with waiting("Analysing"):
        loaded, table = _analysed(case, settings, speed, options)
    # Files first: a reader of the table, such as `head`, may leave early.
    if csv:
        output.write_csv(csv, table.csv())
    if plot:
        suffix = Path(plot).suffix
        with waiting("Drawing"):
            output.write("--plot", plot, lambda file: _draw(loaded, table, file, suffix))
    if as_json:
        output.print_json(output.about(loaded, options, settings_of(settings)) | _document(table))
    elif csv != output.STANDARD_OUTPUT:
        from proprotor.commands.terminal import print_sweep

        print_sweep(loaded, table, all_modes)
    if table.failed.all():
        raise click.exceptions.Exit(1)


def _analysed(
    name: str, settings: tuple[str, ...], speed: str, options: dict[str, Any]
) -> tuple[Case, SweepTable]:
    from proprotor.tables.sweep_table import SweepTable
    from proprotor.units import speeds

    airspeeds = speeds(speed, "--speed")
    case = loaded_case(name, settings)
    return case, SweepTable(case.sweep(airspeeds, **options), case.operation.rotor_speed, unit_of(speed))


def _document(table: SweepTable) -> dict[str, Any]:
    from proprotor.tables.sweep_summary import unstable_ranges
    from proprotor.tables.sweep_table import CONVENTION

    return {
        "convention": CONVENTION,
        "unstable ranges (m/s, interpolated)": [found._asdict() for found in unstable_ranges(table.sweep)],
        "points": list(table.records()),
    }


def _draw(case: Case, table: SweepTable, file: IO[bytes], suffix: str) -> None:
    import matplotlib

    matplotlib.use("Agg")  # no window, and no display needed
    from matplotlib import pyplot

    from proprotor.model.provenance import reservations
    from proprotor.plots import plot_sweep
    from proprotor.tables.sweep_table import heading

    footer = " ".join(reservations(case))
    figure = plot_sweep(
        table.sweep, rotor_speed=table.rotor_speed, unit=table.unit, title=heading(case), footer=footer
    )
    figure.savefig(file, format=suffix.removeprefix(".").lower(), dpi=160)
    pyplot.close(figure)
