"""The command `proprotor`."""

from __future__ import annotations

import inspect
import json
import re
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import click

from proprotor.deck_file import list_cases, read_tables
from proprotor.errors import InputError
from proprotor.figures_command import figures
from proprotor.options import CHOICES, LOCKABLE, Options
from proprotor.output_file import write_whole
from proprotor.study_command import study_command
from proprotor.waiting import waiting

# pint, xarray, rich and matplotlib are slow to import: each is imported where it is needed.
if TYPE_CHECKING:
    from proprotor.case import Case
    from proprotor.tables import SweepTable

_NUMBERS = ("pitch_flap_coupling", "pitch_lag_coupling")  # options of the model that are plain numbers
_FIGURE_FORMATS = (".png", ".pdf", ".svg")
_RANGE = re.compile(r"(?:[\d.:+\s-]|[eE](?=[\d+-]))*")  # those of a range; what follows is the unit

_EXIT_CODES = """\b
Exit codes:
  0  done; unstable modes and single speeds that fail are results
  1  no speed could be analysed, or an output could not be written
  2  an input cannot be used: the message says which and why"""


class _InputErrorsTold(click.Group):
    """A group of commands that tells errors in one message, without a traceback."""

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except InputError as error:
            told = click.ClickException(str(error))
            told.exit_code = 2
            raise told from None


def _model_options(command: Callable) -> Callable:
    """A flag for each choice of the model, as `proprotor.options` has them."""
    meanings = _meanings(Options)
    locked = {"multiple": True, "type": click.Choice(LOCKABLE), "help": f"{meanings['locked']} Repeatable."}
    command = click.option("--locked", **locked)(command)
    for name in reversed(_NUMBERS):
        command = click.option(f"--{name.replace('_', '-')}", type=float, help=meanings[name])(command)
    for name, choices in reversed(CHOICES.items()):
        command = _model_option(name, choices, meanings[name])(command)
    return command


def _model_option(name: str, choices: tuple, meaning: str) -> Callable:
    flag = name.replace("_", "-")
    declared = {"default": choices[0], "show_default": True, "help": meaning}
    if isinstance(choices[0], bool):
        return click.option(f"--{flag}/--no-{flag}", name, **declared)
    return click.option(f"--{flag}", name, type=click.Choice(choices), **declared)


def _meanings(documented: type) -> dict[str, str]:
    """What the docstring says on each parameter; nothing in a Python without docstrings."""
    lines = inspect.getdoc(documented) or ""
    found = re.findall(r"^([\w, ]+) : .*\n((?:    .*\n)+)", lines, re.MULTILINE)
    meanings = {name: " ".join(text.split()) for names, text in found for name in names.split(", ")}
    return defaultdict(str, meanings)


@click.group(cls=_InputErrorsTold, epilog=_EXIT_CODES)
@click.version_option(package_name="proprotor")
def main() -> None:
    """Whirl-flutter stability of gimballed tiltrotors.

    \b
    Try:
      proprotor cases                               the bundled cases
      proprotor sweep xv15 --speed 50:400:5kt       frequency and damping of each mode
      proprotor sweep --help                        all there is to choose
      proprotor study --help                        many designs
      proprotor figures                             the figures of AIAA-2002-1604
    """


main.add_command(figures)
main.add_command(study_command(_model_options, _EXIT_CODES))


@main.command(epilog=_EXIT_CODES)
@click.argument("case")
@click.option(
    "--speed",
    required=True,
    metavar="RANGE",
    help='Airspeeds with their unit: "50:400:5kt" is 50 to 400 kt by 5 kt; also "300 kt", "25:200:2.5 m/s".',
)
@click.option("--plot", metavar="FILE", help="Draw frequency and damping: a .png, .pdf or .svg file.")
@click.option("--csv", metavar="FILE", help="Write all modes, one row for each airspeed and mode.")
@click.option("--json", "as_json", is_flag=True, help="Print all modes as JSON instead of the table.")
@click.option("--all-modes", is_flag=True, help="Put every mode into the table, not only as many as fit.")
@_model_options
def sweep(
    case: str, speed: str, plot: str | None, csv: str | None, as_json: bool, all_modes: bool, **options: Any
) -> None:
    """Frequency and damping of each mode along a range of airspeeds.

    CASE is a bundled case (see `proprotor cases`) or a TOML file that describes one.

    The table has the modes that become unstable, the support's, and others that move it the most. Damping
    is -Re s/|s| of the eigenvalue s in percent of critical, negative where a mode is unstable. An airspeed
    that cannot be analysed is a row that says why.

    \b
    Examples:
      proprotor sweep xv15 --speed 50:400:5kt --plot damping.png
      proprotor sweep xv15 --speed 50:400:5kt --pitch coupling --locked gimbal --csv modes.csv
    """
    _check_figure_format(plot)
    options = {name: options[name] for name in (*CHOICES, *_NUMBERS, "locked")}  # in a fixed order
    with waiting("Analysing"):
        loaded, table = _analysed(case, speed, options)
    # Files first: a reader of the table, such as `head`, may leave early.
    if csv:
        _write("--csv", csv, lambda file: file.write(table.csv()))
    if plot:
        with waiting("Drawing"):
            _write("--plot", plot, lambda file: _draw(loaded, table, file, Path(plot).suffix))
    if as_json:
        click.echo(json.dumps(_document(loaded, table, options), indent=1, allow_nan=False))
    else:
        from proprotor.report import print_sweep

        print_sweep(loaded, table, options, all_modes)
    if table.failed.all():
        raise click.exceptions.Exit(1)


def _check_figure_format(plot: str | None) -> None:
    if plot and Path(plot).suffix.lower() not in _FIGURE_FORMATS:
        raise InputError("--plot", plot, f"must end in {', '.join(_FIGURE_FORMATS)}")


def _analysed(name: str, speed: str, options: dict[str, Any]) -> tuple[Case, SweepTable]:
    from proprotor.case import load_case
    from proprotor.tables import SweepTable
    from proprotor.units import speeds

    airspeeds = speeds(speed, "--speed")
    case = load_case(name)
    unit = _RANGE.sub("", speed, count=1).strip()
    return case, SweepTable(case.sweep(airspeeds, **options), case.operation.rotor_speed, unit)


def _document(case: Case, table: SweepTable, options: dict[str, Any]) -> dict[str, Any]:
    from proprotor.provenance import reservations
    from proprotor.sweep_summary import unstable_ranges
    from proprotor.tables import CONVENTION

    return {
        "case": case.name,
        "title": case.title,
        "rotor speed (rad/s)": table.rotor_speed,
        "options": options,
        "convention": CONVENTION,
        "reservations": reservations(case),
        "warnings": list(case.warnings),
        "unstable ranges (m/s, interpolated)": [found._asdict() for found in unstable_ranges(table.sweep)],
        "points": list(table.records()),
    }


def _draw(case: Case, table: SweepTable, file: IO[bytes], suffix: str) -> None:
    import matplotlib

    matplotlib.use("Agg")  # no window, and no display needed
    from matplotlib import pyplot

    from proprotor.plots import plot_sweep
    from proprotor.provenance import reservations
    from proprotor.report import heading

    labels = {"title": heading(case), "footer": " ".join((*reservations(case), *table.doubts()))}
    figure = plot_sweep(table.sweep, rotor_speed=table.rotor_speed, unit=table.unit, **labels)
    figure.savefig(file, format=suffix.removeprefix(".").lower(), dpi=160)
    pyplot.close(figure)


def _write(option: str, path: str, write: Callable[[IO[bytes]], object]) -> None:
    try:
        write_whole(path, write)
    except InputError as error:
        raise InputError(option, path, error.rule) from None
    except OSError as error:
        reason = error.strerror or error
        raise click.ClickException(f"{option} = {path}: cannot be written ({reason})") from None
    click.echo(f"Wrote {path}", err=True)


@main.command(epilog=_EXIT_CODES, short_help="List the bundled cases, or tell what one rests on.")
@click.argument("name", required=False)
def cases(name: str | None) -> None:
    """List the bundled cases, or tell what one case, bundled or a TOML file, is and rests on."""
    if name is None:
        for bundled in list_cases():
            click.echo(f"{bundled:<24} {read_tables(bundled).get('case', {}).get('title', '')}")
    else:
        from proprotor.case import load_case
        from proprotor.report import print_case

        print_case(load_case(name))
