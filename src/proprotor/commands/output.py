"""What commands print and write: JSON, tables, files and figures."""

from __future__ import annotations

import json
import math
import textwrap
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import click

from proprotor.commands.arguments import Command, Option
from proprotor.errors import InputError
from proprotor.files import output as output_file
from proprotor.model import stamp
from proprotor.model.doubts import MARK, Doubt, footnotes
from proprotor.rotor.options import CHOICES, parse_options
from proprotor.units import KNOT

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from proprotor.case import Case
    from proprotor.commands.terminal import PlainConsole

STANDARD_OUTPUT = "-"  # as the file of an option: print instead, as other programs have it
FIGURE_FORMATS = (".png", ".pdf", ".svg")
_NARROWEST = 30  # characters of a wrapped column


def output_options(*, csv: str = "", plot: str = "") -> Option:
    """`--json`, and `--csv` and `--plot` with what they hold."""

    def declare(command: Command) -> Command:
        json_help = "Print everything as JSON instead of the table."
        command = click.option("--json", "as_json", is_flag=True, help=json_help)(command)
        if csv:
            csv_help = f"{csv} - prints it instead of the table."
            command = click.option("--csv", metavar="FILE", help=csv_help)(command)
        if plot:
            command = click.option("--plot", metavar="FILE", help=f"{plot}: a .png, .pdf or .svg file.")(
                command
            )
        return command

    return declare


def print_json(document: Any) -> None:
    """Print plain data as JSON; what is not finite as null."""
    click.echo(json.dumps(_finite(document), indent=1, allow_nan=False))


def _finite(data: Any) -> Any:
    if isinstance(data, Mapping):
        return {str(key): _finite(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [_finite(value) for value in data]
    return None if isinstance(data, float) and not math.isfinite(data) else data


def about(case: Case, options: Mapping[str, Any], settings: Mapping[str, str]) -> dict[str, Any]:
    """What stands at the head of every JSON document of a case."""
    from proprotor.model.provenance import reservations

    own = stamp.of_case(case, options)
    return {
        "case": case.name,
        "title": case.title,
        "set": dict(settings),
        "rotor speed (rad/s)": float(case.operation.rotor_speed),
        "deck": own["deck"],
        "options": json.loads(own["options"]),
        "reservations": reservations(case),
        "warnings": list(case.warnings),
        "made by": own["made_by"],
    }


def told_options(case: Case, options: Mapping[str, Any]) -> dict[str, Any]:
    """The choices as they hold for a case, and the other options that are given, as keywords."""
    choice = parse_options(case.model_options(options))
    return {name: getattr(choice, name) for name in (*CHOICES, *options)}


def console() -> PlainConsole:
    """Of the standard output; text is printed as it is."""
    from proprotor.commands.terminal import PlainConsole  # here, because rich takes long to import

    return PlainConsole()


def print_head(case: Case, found: Mapping[Any, Any]) -> None:
    """Print what was analysed, with which options of those that are no defaults, and what it rests on."""
    from proprotor.model.provenance import reservations
    from proprotor.tables.sweep_table import heading

    out = console()
    for line in (heading(case), *stamp.unusual_options(found), *reservations(case), ""):
        out.print(line)


def print_doubts(doubts: Iterable[Doubt], unit: str = "kt", factor: float = KNOT) -> None:
    """Print what the question marks above mean, positions in a unit of so many SI units."""
    for line in footnotes(doubts, unit, factor):
        console().print(f"{MARK} {line}", style="yellow")


def doubts_as_data(doubts: Iterable[Doubt]) -> list[dict[str, Any]]:
    """Doubts along airspeeds, as JSON has them."""
    return [{"doubt": doubt.text, "from (m/s)": doubt.low, "to (m/s)": doubt.high} for doubt in doubts]


def print_table(columns: Sequence[str], rows: Iterable[Sequence[str]], *, text: Sequence[str] = ()) -> None:
    """Print a table: numbers to the right, columns named in `text` to the left.

    Nothing is cut off; only the last column, when it is text, is wrapped to the width of the terminal.
    """
    table = [tuple(columns), *map(tuple, rows)]
    widths = [max(len(row[place]) for row in table) for place in range(len(columns))]
    out = console()
    indent = sum(widths[:-1]) + 2 * (len(widths) - 1)
    room = max(_NARROWEST, out.width - indent) if columns[-1] in text else 10_000
    for number, row in enumerate(table):
        cells = [
            cell.ljust(width) if name in text else cell.rjust(width)
            for cell, width, name in zip(row[:-1], widths, columns, strict=False)
        ]
        last = row[-1] if columns[-1] in text else row[-1].rjust(widths[-1])
        wrapped = textwrap.wrap(last, room, drop_whitespace=columns[-1] in text) or [""]
        lines = ["  ".join([*cells, wrapped[0]]), *(" " * indent + line for line in wrapped[1:])]
        for line in lines:
            out.print(line.rstrip(), style="" if number else "dim", soft_wrap=True)
    out.print()


@contextmanager
def told(option: str, path: str | None) -> Iterator[None]:
    """An output that cannot be written, in one message; another error where no path is given."""
    try:
        yield
    except OSError as error:
        if path is None:
            raise
        reason = error.strerror or error
        raise click.ClickException(f"{option} = {path}: cannot be written ({reason})") from None


def check_writable(option: str, path: str | None) -> None:
    """Refuse a file that cannot be written, before a long analysis instead of after it.

    Raises
    ------
    InputError
        When the path is no place for a file.
    click.ClickException
        When no file can be made in its folder, or the one that is there may not be replaced.
    """
    if path is None:
        return
    try:
        with told(option, path):
            output_file.check_writable(path)
    except InputError as error:
        raise InputError(option, path, error.rule) from None


def check_outputs(csv: str | None = None, plot: str | None = None, *, as_json: bool) -> None:
    """Refuse `--csv` and `--plot` that cannot be written, or a figure of another kind, before anything is analysed.

    Raises
    ------
    InputError, click.ClickException
        As `check_writable`; for a figure whose name does not end in .png, .pdf or .svg; for CSV and JSON on one
        standard output.
    """
    if as_json and csv == STANDARD_OUTPUT:
        raise InputError("--csv", csv, "goes without --json: both would be printed")
    if plot and Path(plot).suffix.lower() not in FIGURE_FORMATS:
        raise InputError("--plot", plot, f"must end in {', '.join(FIGURE_FORMATS)}")
    check_writable("--csv", None if csv == STANDARD_OUTPUT else csv)
    check_writable("--plot", plot)


def write_csv(path: str, content: bytes) -> None:
    """Write the file of `--csv`, or print it.

    Raises
    ------
    InputError, click.ClickException
        As `write`.
    """
    if path == STANDARD_OUTPUT:
        click.echo(content, nl=False)
    else:
        write("--csv", path, content)


def write(option: str, path: str, content: Callable[[IO[bytes]], object] | bytes) -> None:
    """Write the file of an option, and say so on the error stream.

    Raises
    ------
    InputError
        When the path is no place for a file.
    click.ClickException
        When the file cannot be written.
    """
    try:
        with told(option, path):
            output_file.write_whole(path, content if callable(content) else lambda file: file.write(content))
    except InputError as error:
        raise InputError(option, path, error.rule) from None
    click.echo(f"Wrote {path}", err=True)


def write_plot(path: str, case: Case, draw: Callable[[], Axes]) -> None:
    """Write the figure of `--plot`, with what it is and what it rests on below.

    Raises
    ------
    InputError, click.ClickException
        As `write`.
    """
    from proprotor.commands.waiting import waiting

    with waiting("Drawing"):
        import matplotlib

        matplotlib.use("Agg")  # no window, and no display needed
        from matplotlib import pyplot

        from proprotor.plots import rests_on
        from proprotor.tables.sweep_table import heading

        axes = draw()
        rests_on(axes, case, f"{heading(case)}.")
        figure = axes.get_figure(root=True)
        if figure is None:
            raise RuntimeError("axes without a figure")
        suffix = Path(path).suffix.removeprefix(".").lower()
        write("--plot", path, lambda file: figure.savefig(file, format=suffix, dpi=160, bbox_inches="tight"))
        pyplot.close(figure)
