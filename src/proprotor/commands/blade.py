"""The command `proprotor blade`: the hinged blade of a table of stations, and how far it is from the elastic blade."""

from __future__ import annotations

from typing import Any

import click
import numpy as np

from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError
from proprotor.rotor.blade_stations import BladeStations
from proprotor.rotor.hinged_blade import HingedBlade, hinged_blade
from proprotor.tables.blade_table import (
    comparison_columns,
    comparison_rows,
    deck_lines,
    number_rows,
    pitch_stiffness_rows,
    records,
    verdict,
)
from proprotor.tables.csv_text import csv_of
from proprotor.units import to_si, values_in_si

_FAN = (0.0, 1.3)  # rotor speeds of the plot, of that of the fit


@arguments.command()
@click.argument("stations", metavar="STATIONS")
@click.option(
    "--at-rotor-speed", required=True, metavar="SPEED", help='Rotor speed of the fit, such as "458 rpm".'
)
@click.option(
    "--collective",
    required=True,
    metavar="RANGE",
    help='Collectives at 0.75 R for which the blade is fitted, such as "15:50:5 deg".',
)
@click.option(
    "--control-stiffness",
    required=True,
    metavar="STIFFNESS",
    help='Stiffness of the control system, as the blade sees it at its root: "22400 ft*lbf/rad".',
)
@click.option(
    "--pitch-bearing",
    default="0 m",
    show_default=True,
    metavar="RADIUS",
    help="Radius of the pitch bearing; inboard of it nothing turns with the pitch.",
)
@click.option(
    "--radius",
    metavar="RADIUS",
    help="Radius of the rotor, at the last station; needed where the stations are r/R.",
)
@click.option("--deck", metavar="FILE", help="Write the [rotor] fields that were found, as lines for a deck.")
@output.output_options(
    csv="Write a row for each compared quantity and collective.",
    plot="Draw frequencies over collective and rotor speed",
)
def blade(
    outputs: output.Outputs,
    stations: str,
    at_rotor_speed: str,
    collective: str,
    control_stiffness: str,
    pitch_bearing: str,
    radius: str | None,
    deck: str | None,
) -> None:
    """Make a hinged blade of a table of stations, and show how near it is to the elastic blade.

    STATIONS is a CSV file whose first line names the columns with units: r, mass, EI_flat, EI_edge, GJ, twist, and
    perhaps chord, pitch_inertia, x_cg and x_ac aft of the pitch axis, such as "r [in], mass [lb/ft], EI_flat
    [lbf*in**2]". The blade is held at its first station. Where the hinged blade differs by more than 5 % from the
    elastic one, the command says so.

    \b
    Examples:
      proprotor blade blade.csv --at-rotor-speed "458 rpm" \\
        --collective "15:50:5 deg" --control-stiffness "22400 ft*lbf/rad" \\
        --pitch-bearing "1.4 ft" --deck rotor.toml --plot fan.png
    """
    from proprotor.deck.blade_file import read_blade  # here, so that --help answers without them
    from proprotor.model.blade_comparison import compare_blades

    output.check_writable("--deck", deck)
    speed = _positive("--at-rotor-speed", at_rotor_speed, "rad/s")
    pitch = np.atleast_1d(values_in_si(collective, "rad", "--collective"))
    if len(set(pitch.tolist())) < 3:
        raise InputError("--collective", collective, 'must have at least 3 values, such as "15:50:5 deg"')
    held = {
        "pitch_bearing": _in_si("--pitch-bearing", pitch_bearing, "m"),
        "control_stiffness": _positive("--control-stiffness", control_stiffness, "N*m/rad"),
    }
    tip = None if radius is None else _positive("--radius", radius, "m")
    table = read_blade(stations, radius=tip, **held)
    with waiting("Bending the blade"):
        found = hinged_blade(table, speed, pitch)
        compared = compare_blades(table, found)
    if deck:
        output.write("--deck", deck, deck_lines(found, table, stations).encode())

    def draw() -> Any:
        from proprotor.plots import plot_blade_frequencies

        return plot_blade_frequencies(table, found, [speed * part for part in _FAN])

    outputs.write(
        document=lambda: _document(table, found, compared),
        table=lambda: _print(table, found, compared),
        csv=lambda: csv_of(rows := records(compared), list(rows[0]), {}),
        plot=draw,
    )


def _in_si(option: str, text: str, unit: str) -> float:
    """Return the SI value of an option; an error names the option."""
    try:
        return to_si(text, unit)
    except InputError as error:
        raise InputError(option, text, error.rule) from None


def _positive(option: str, text: str, unit: str) -> float:
    found = _in_si(option, text, unit)
    if not found > 0:
        raise InputError(option, text, "must be above zero")
    return found


def _document(table: BladeStations, found: HingedBlade, compared: Any) -> dict[str, Any]:
    return {
        "rotor (SI)": found.numbers,
        "pitch stiffness (N m/rad)": found.pitch_stiffness._asdict(),
        "held at (m)": float(table.radius[0]),
        "compared": records(compared),
        "differences": {one.name: one.difference for one in compared.quantities if one.counts},
        "good": not compared.poor,
    }


def _print(table: BladeStations, found: HingedBlade, compared: Any) -> None:
    out = output.console()
    out.print("The hinged blade nearest to the elastic one:")
    output.print_table(("field", "value", "unit"), number_rows(found), text=("field", "unit"))
    out.print("Torque per turn at 0.75 R, by the way the torque is spread:")
    output.print_table(("spread", "N m/rad"), pitch_stiffness_rows(found), text=("spread",))
    out.print(
        "Elastic and hinged blade at the ends of the collective range, and the largest difference in the whole range, "
        "in brackets where it is not judged:"
    )
    output.print_table(comparison_columns(compared), comparison_rows(compared), text=("quantity",))
    if table.radius[0] > 0:
        out.print(
            f"The blade is held at its first station, {table.radius[0]:.4g} m; what is inboard has no mass here."
        )
    for line in verdict(compared):
        out.print(line)
