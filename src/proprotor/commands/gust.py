"""The command `proprotor gust`: hub loads and motion in turbulence, or in single gusts."""

from __future__ import annotations

from typing import Any

import click

from proprotor.case import Case
from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError
from proprotor.model.doubts import doubts_along
from proprotor.model.linear_model import LinearModel
from proprotor.responses.discrete_gust import discrete_gust
from proprotor.responses.gust_response import gust_response
from proprotor.responses.turbulence import COMPONENTS, SPECTRA, Turbulence
from proprotor.tables.csv_text import csv_of
from proprotor.tables.response_table import gust_records, turbulence_records
from proprotor.typing import Dataset
from proprotor.units import KNOT, KTAS


@arguments.command()
@arguments.case_argument
@click.option(
    "--speed", required=True, metavar="SPEED", help='Airspeed: "300 ktas" (kt is the same) or "300 keas".'
)
@click.option(
    "--spectrum",
    type=click.Choice(SPECTRA),
    default=SPECTRA[0],
    show_default=True,
    help="Spectrum of turbulence.",
)
@click.option(
    "--component",
    type=click.Choice(COMPONENTS),
    default=COMPONENTS[0],
    show_default=True,
    help="Velocity of the air up, sideways, or along the shaft.",
)
@click.option(
    "--intensity", default="1 m/s", show_default=True, metavar="SPEED", help="Root mean square of turbulence."
)
@click.option(
    "--scale", metavar="LENGTH", help='Scale of turbulence: "2500 ft"; by default that of MIL-HDBK-1797.'
)
@click.option(
    "--gradient",
    metavar="LENGTHS",
    help='Single gusts of one minus the cosine instead, by the distance over which they grow: "30:350:40 ft".',
)
@click.option("--velocity", metavar="SPEED", help='Velocity of single gusts: "30 ft/s"; by default 1 m/s.')
@click.option(
    "--output",
    "names",
    multiple=True,
    metavar="NAME",
    help="Output, such as force_x; by default all. Repeatable.",
)
@output.output_options(csv="Write a row for each output.", plot="Draw spectra, or outputs over time")
@arguments.model_options
def gust(
    request: arguments.Request,
    outputs: output.Outputs,
    speed: str,
    spectrum: str,
    component: str,
    intensity: str,
    scale: str | None,
    gradient: str | None,
    velocity: str | None,
    names: tuple[str, ...],
) -> None:
    """Show what turbulence or single gusts do to a rotor on its support at one airspeed.

    CASE is a bundled case or a TOML file. Gusts act on the rotor alone, evenly over its disk. Turbulence gives root
    mean squares over all frequencies, single gusts the extremes of each output.

    \b
    Examples:
      proprotor gust xv15 --speed "200 kt" --output force_x --output moment_y
      proprotor gust xv15 --speed "200 kt" --spectrum dryden \\
        --intensity "3 ft/s" --plot spectra.png
      proprotor gust xv15 --speed "200 kt" --gradient "30:350:80 ft" \\
        --velocity "30 ft/s"
    """
    turbulence = _turbulence(spectrum, component, intensity, scale, gradient, velocity)
    case = request.load()
    airspeed = arguments.one_speed(speed, case)
    with waiting("Computing"):
        model = case.linearize(airspeed, **request.options)
        reason = model.trim.reason.item()
        if reason:
            raise InputError("--speed", speed, reason)
        found = _found(model, turbulence, component, gradient, velocity, names)
    if found.reason.item():
        raise InputError("--speed", speed, found.reason.item())
    rows = turbulence_records(found) if gradient is None else gust_records(found)
    outputs.write(
        document=lambda: output.about(case, request) | _document(found, airspeed, rows),
        table=lambda: _print(case, found, airspeed, rows),
        csv=lambda: csv_of(rows, list(rows[0]), found.attrs),
        plot=lambda: output.with_origin(_drawn(found), case),
    )


def _turbulence(
    spectrum: str,
    component: str,
    intensity: str,
    scale: str | None,
    gradient: str | None,
    velocity: str | None,
) -> Turbulence:
    """Return the turbulence; refuse options that do not go together."""
    if gradient is None and velocity is not None:
        raise InputError("--velocity", velocity, "goes with --gradient")
    context = click.get_current_context()
    for name, value in (("spectrum", spectrum), ("intensity", intensity), ("scale", scale)):
        if (
            gradient is not None
            and context.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE
        ):
            raise InputError(f"--{name}", value, "goes without --gradient")
    return Turbulence(spectrum, component, intensity, scale)


def _found(
    model: LinearModel,
    turbulence: Turbulence,
    component: str,
    gradient: str | None,
    velocity: str | None,
    names: tuple[str, ...],
) -> Dataset:
    if gradient is None:
        return gust_response(model, turbulence, outputs=names or None)
    return discrete_gust(model, gradient, size=velocity or 1.0, component=component, outputs=names or None)


def _drawn(found: Dataset) -> Any:
    from proprotor.plots import (
        plot_gust_spectra,
        plot_time_response,
    )  # here, so that --help answers without it

    return plot_gust_spectra(found) if "psd" in found else plot_time_response(found)


def _document(found: Dataset, airspeed: float, rows: list[dict[str, Any]]) -> dict[str, Any]:
    own = {
        name: found.attrs[name]
        for name in ("spectrum", "component", "intensity", "scale")
        if name in found.attrs
    }
    return {"airspeed (m/s)": airspeed, "warning": found.warning.item()} | own | {"outputs": rows}


def _print(case: Case, found: Dataset, airspeed: float, rows: list[dict[str, Any]]) -> None:
    output.print_head(case, found.attrs)
    out = output.console()
    at = f"at {airspeed / KNOT:.4g} {KTAS}"
    if "psd" in found:
        own = found.attrs
        what = f"{own['component']} turbulence, {own['spectrum']}, {own['intensity']:.4g} m/s"
        what += f", scale {own['scale']:.4g} m"
    else:
        what = f"{found.attrs['component']} gusts of one minus the cosine, {float(found.gust.max()):.4g} m/s at most"
    out.print(f"{what[0].upper()}{what[1:]}, {at}", style="bold")
    numbers = [name for name in rows[0] if name not in ("output", "unit")]
    table = [(row["output"], *(f"{row[name]:.4g}" for name in numbers), row["unit"]) for row in rows]
    output.print_table(("output", *numbers, "unit"), table, text=("output", "unit"))
    output.print_doubts(doubts_along(airspeed, found.warning.values))
