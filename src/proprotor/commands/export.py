"""The command `proprotor export`: the equations of a case at one airspeed as a file for another program."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError
from proprotor.model.linear_model import LinearModel
from proprotor.units import to_si

_NASTRAN, _MATLAB = ".bdf", ".mat"


@arguments.command()
@arguments.case_argument
@click.argument("file", metavar="FILE")
@click.option(
    "--speed", required=True, metavar="SPEED", help='Airspeed: "300 ktas" (kt is the same) or "300 keas".'
)
@click.option("--grid", type=int, metavar="NUMBER", help="Grid point of Nastran at the hub.")
@click.option(
    "--first-extra-point",
    type=int,
    metavar="NUMBER",
    help="Extra point of Nastran for the rotor's first coordinate; the others follow.",
)
@click.option("--length-unit", default="1 m", show_default=True, help="Unit of length of the Nastran run.")
@click.option(
    "--mass-unit",
    default="1 kg",
    show_default=True,
    help='Unit of mass of the Nastran run: "1 lbf*s**2/in" with inches.',
)
@output.json_option
@arguments.model_options
def export(
    request: arguments.Request,
    file: str,
    speed: str,
    grid: int | None,
    first_extra_point: int | None,
    length_unit: str,
    mass_unit: str,
    as_json: bool,
) -> None:
    """Write the equations of a case at one airspeed for Nastran or MATLAB.

    CASE is a bundled case or a TOML file. A FILE that ends in .bdf gets the rotor alone, as direct matrix input (M2PP,
    B2PP, K2PP) on the hub's grid point and on extra points. A FILE that ends in .mat gets M, C, K and B of rotor and
    support, and a state space.

    \b
    Examples:
      proprotor export xv15 rotor.bdf --speed "370 kt" --grid 4001 \\
        --first-extra-point 9001
      proprotor export xv15 xv15.mat --speed "370 kt"
    """
    write = _writer(file, grid, first_extra_point, length_unit, mass_unit)
    output.check_writable("FILE", file)
    case = request.load()
    airspeed = arguments.one_speed(speed, case)
    with waiting("Computing"):
        model = case.linearize(airspeed, **request.options)
    if reason := str(model.trim.reason):  # matrices without a single number
        raise InputError("--speed", speed, reason)
    write(model)
    click.echo(f"Wrote {file}", err=True)
    if as_json:
        rotor = model.rotor if _ending(file) == _NASTRAN and model.rotor else model
        output.print_json(
            output.about(case, request)
            | {"written": file, "airspeed (m/s)": airspeed, "coordinates": list(rotor.dofs)}
        )


def _ending(file: str) -> str:
    """Return the ending of the file's name, which says the kind of the file, in small letters."""
    return Path(file).suffix.lower()


def _writer(
    file: str, grid: int | None, first_extra_point: int | None, length_unit: str, mass_unit: str
) -> Callable[[LinearModel], None]:
    """Return the function that writes a model to a file of its kind, or refuse a file of no kind."""
    ending = _ending(file)
    given = {"--grid": grid, "--first-extra-point": first_extra_point}
    if ending == _MATLAB:
        for name, value in given.items():
            if value is not None:
                raise InputError(name, value, "goes with a .bdf file")
        from proprotor.exchange.matlab import save_matlab  # here, so that --help answers without it

        return lambda model: save_matlab(model, file)
    if ending != _NASTRAN:
        raise InputError("FILE", file, "must end in .bdf, for Nastran, or in .mat, for MATLAB")
    points: dict[str, Any] = {}
    for name, value in given.items():
        if value is None:
            raise InputError(name, None, "must be given with a .bdf file")
        points[name.removeprefix("--").replace("-", "_")] = value
    for name, text, unit in (("--length-unit", length_unit, "m"), ("--mass-unit", mass_unit, "kg")):
        try:
            points[name.removeprefix("--").replace("-", "_")] = to_si(text, unit)
        except InputError as error:
            raise error.within(name) from None
    from proprotor.exchange.dmig import save_dmig  # here, so that --help answers without it

    return lambda model: save_dmig(model, file, **points)
