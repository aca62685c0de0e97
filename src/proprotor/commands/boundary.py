"""The command `proprotor boundary`: boundaries against an input such as altitude, or the worst of a box of inputs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import click
from click.core import ParameterSource

from proprotor.case import Case
from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.commands.worst_of import write_worst_of
from proprotor.deck.input_values import shown_unit
from proprotor.deck.vary import design_inputs, inputs_at
from proprotor.errors import InputError
from proprotor.model.doubts import doubts_along
from proprotor.tables.boundary_table import (
    boundary_cells,
    boundary_records,
    input_of,
    of_mode,
    only_first,
    without_doubtful,
)
from proprotor.tables.csv_text import csv_of
from proprotor.tables.points import Quantity
from proprotor.typing import Dataset
from proprotor.units import KEAS, KTAS, factor_to_si, is_equivalent, speeds, values_in_si

_EXAMPLE = '"operation.rotor_speed=300:610:20 rpm"'
_OPERATION = "operation."
_OF_AGAINST = ("against", "mode", "first", "all_boundaries", "speed_unit", "level", "points", "plot")


@arguments.command()
@arguments.case_argument
@click.option(
    "--against",
    type=arguments.InputValues(),
    metavar="INPUT=RANGE",
    help=f'Input by deck path, and its values: {_EXAMPLE}, "altitude=0:20000:2000 ft".',
)
@click.option(
    "--worst-of",
    multiple=True,
    type=arguments.InputValues(),
    metavar="INPUT=LIMITS",
    help='In place of --against: an input and its limits, "rotor.precone=1:4 deg" or "=0.9:1.1 of deck". Repeatable; '
    "the lowest flutter speed between all limits is looked for.",
)
@arguments.scan_option
@click.option("--mode", help="Show the boundaries of this mode alone.")
@click.option("--first", is_flag=True, help="Show the first instability alone, whatever mode it is.")
@click.option(
    "--all-boundaries",
    is_flag=True,
    help="Show boundaries above the others as well that are doubtful at every value of the input.",
)
@click.option(
    "--speed-unit",
    type=click.Choice(("ktas", "keas")),
    help="Airspeed of the plot; by default that of --scan, KTAS without it.",
)
@arguments.level_option
@arguments.points_option
@output.output_options(
    csv="Write a row for each boundary.", plot="Draw the airspeed of each boundary over the input"
)
@arguments.model_options
def boundary(
    request: arguments.Request,
    outputs: output.Outputs,
    against: str | None,
    worst_of: tuple[str, ...],
    scan: str | None,
    mode: str | None,
    first: bool,
    all_boundaries: bool,
    speed_unit: str | None,
    level: float,
    points: str | None,
) -> None:
    """Find the airspeeds at which modes become unstable, or stable again, at each value of an input.

    CASE is a bundled case or a TOML file; `proprotor describe` lists the inputs. Each boundary is exact to
    rounding. Boundaries at neighbouring values are one branch if the same root becomes unstable. A branch that is
    doubtful at every value, and nowhere below another that is shown, is in files alone, or shown with
    --all-boundaries. A deck that gives the air by density and speed of sound is taken to an altitude in the standard
    atmosphere by --against altitude=...

    With --worst-of the lowest flutter speed of all designs between some limits is looked for: at the corners, at
    designs inside, and down along derivatives from the lowest design of each mode. A search is no proof.

    \b
    Examples:
      proprotor boundary xv15 --against "operation.rotor_speed=300:610:20 rpm" \\
        --plot boundary.png
      proprotor boundary xv15 --against "altitude=0:20000:2000 ft" \\
        --scan 200:450:10keas --mode chord
      proprotor boundary my.toml --against "rotor_speed=400:600:20 rpm" \\
        --points measured.csv --plot boundary.png
      proprotor boundary xv15 --worst-of "rotor.precone=1:4 deg" \\
        --worst-of "rotor.control_stiffness=0.7:1.5 of deck"
    """
    if worst_of:
        _check_alone()
        write_worst_of(request, outputs, worst_of, scan)
        return
    if against is None:
        raise InputError("--against", None, f"must be given, such as {_EXAMPLE}, or --worst-of in its place")
    if mode and first:
        raise InputError("--first", None, "goes without --mode")
    case, path, given = _case_and_input(request, against)
    number = inputs_at(case, [path])[path]
    unit, across = shown_unit(arguments.unit_of(given), number), Quantity(path, number.unit)
    measured = arguments.points_of(
        points, outputs.plot, across, [arguments.airspeed_points(case.operation.density)]
    )
    with waiting("Looking for boundaries"):
        found = case.boundary_against({path: given}, _scan_of(case, scan), level=level, **request.options)
    chosen = only_first(found) if first else of_mode(found, mode) if mode else found
    shown, left_out = (chosen, []) if first or mode or all_boundaries else without_doubtful(found)
    records = boundary_records(chosen, unit)
    shown_in = speed_unit or ("keas" if scan and is_equivalent(scan) else "ktas")

    def draw() -> Any:
        from proprotor.plots import plot_boundary_against, rests_on  # here, so that --help answers without it

        ax = plot_boundary_against(shown, unit=unit, speed_unit=shown_in, points=measured)
        more = ["Boundaries that are doubtful throughout are not drawn."] if left_out else []
        return rests_on(ax, case, f"{case.title or case.name}.", *more)

    outputs.write(
        document=lambda: output.about(case, request) | _document(found, records, level),
        table=lambda: _print(case, shown, left_out, unit),
        csv=lambda: csv_of(records, list(records[0]), found.attrs),
        plot=draw,
    )
    if not (found.searched.values > 0).any():
        raise click.exceptions.Exit(1)


def _check_alone() -> None:
    """Refuse options that say what is shown of boundaries against an input, beside --worst-of."""
    context = click.get_current_context()
    for option in context.command.params:
        given = context.get_parameter_source(str(option.name)) is ParameterSource.COMMANDLINE
        if given and option.name in _OF_AGAINST:
            raise InputError(option.opts[0], None, "goes without --worst-of")


def _case_and_input(request: arguments.Request, against: str) -> tuple[Case, str, str]:
    """Return the case, and the path and the values of the input.

    Where the deck gives the air by its density, an altitude takes its place. A field of [operation] may stand without
    the name of the table.
    """
    path, given = arguments.name_and_value(
        "--against", against, f"must be an input and its values, such as {_EXAMPLE}"
    )
    case = request.load()
    known = design_inputs(case)
    whole = path if "." in path else f"{_OPERATION}{path}"
    if whole == "operation.altitude" and whole not in known:
        at = f"0 {arguments.unit_of(given)}"
        values_in_si(given, "m", whole)  # raises an error that names the input
        own = {"case.title": case.title or case.name, whole: at}  # the title must not tell one altitude
        request = request._replace(settings={**request.settings, **own})
        return request.load(), whole, given
    return case, whole if whole in known else path, given


def _scan_of(case: Case, scan: str | None) -> str | None:
    """Return the airspeeds of the search as text, which the analysis converts in the air of each value."""
    if scan is not None and speeds(scan, "--scan", case.operation.density).size < 2:
        raise InputError("--scan", scan, 'must be a range of airspeeds that rise, such as "50:400:5ktas"')
    return scan


def _document(found: Dataset, records: Sequence[dict[str, Any]], level: float) -> dict[str, Any]:
    path = input_of(found)
    low, high = (found.searched.sel(end=end).values.tolist() for end in ("low", "high"))
    return {
        "level (damping ratio)": level,
        "against": path,
        "against (SI)": {"unit": found[path].attrs["units"], "values": found[path].values.tolist()},
        "density (kg/m³)": found.density.values.tolist(),
        "searched from (m/s)": low,
        "searched to (m/s)": high,
        "boundaries": list(records),
        "eigen-solves": int(found.attrs["eigen_solves"]),
    }


def _print(case: Case, shown: Dataset, left_out: Sequence[str], unit: str) -> None:
    path, records = input_of(shown), boundary_records(shown, unit)
    output.print_head(case, shown.attrs, (path,))
    out = output.console()
    out.print(f"Boundaries against {path}" + (f" ({unit})" if unit else "") + ":")
    columns = (unit or "value", KTAS, KEAS, "Hz", "/rev", "mode", "kind", "")
    output.print_table(columns, map(boundary_cells, records), text=columns[5:])
    if left_out:
        out.print(f"Not shown, doubtful throughout (--all-boundaries): {'; '.join(left_out)}.")
    failures = dict.fromkeys(reason for reason in shown.reason.values.tolist() if reason)
    for reason in failures:
        values = [r for r in records if r["failure"] == reason]
        out.print(f"Not analysed at {next(iter(values[0].values())):g} {unit}: {reason}.")
    warnings = shown.warning.values
    rows, places = (warnings != "").nonzero()
    if len(rows):
        factor = factor_to_si(unit, unit, str(shown[path].attrs["units"]))
        output.print_doubts(doubts_along(shown[path].values[rows], warnings[rows, places]), unit, factor)
