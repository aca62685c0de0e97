"""The output of commands: JSON, tables, files and figures."""

from __future__ import annotations

import json
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, NamedTuple

import click

from proprotor.case import Case
from proprotor.commands.arguments import Command, Option, Request
from proprotor.commands.columns import laid_out
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError
from proprotor.files import output as output_file
from proprotor.files.json_text import json_text
from proprotor.model import stamp
from proprotor.model.doubts import MARK, Doubt, footnotes
from proprotor.model.provenance import reservations
from proprotor.rotor.options import CHOICES, parse_options
from proprotor.tables.sweep_table import heading
from proprotor.typing import Axes, Figure
from proprotor.units import KNOT, KTAS

if TYPE_CHECKING:
    from proprotor.commands.terminal import PlainConsole

_STANDARD_OUTPUT = "-"  # as the file of an option: print instead of writing, as other programs do
_FIGURE_FORMATS = (".png", ".pdf", ".svg")
_NARROWEST = 30  # characters of a wrapped column


class Outputs(NamedTuple):
    """Where a command writes its results: JSON instead of a table, and the files of `--csv` and `--plot`."""

    as_json: bool
    csv: str | None = None
    plot: str | None = None

    def check(self) -> None:
        """Refuse files that cannot be written, before anything is analysed.

        Raises
        ------
        InputError, click.ClickException
            As `check_writable`; for a figure whose name does not end in .png, .pdf or .svg; for CSV and JSON on one
            standard output.
        """
        if self.as_json and self.csv == _STANDARD_OUTPUT:
            raise InputError("--csv", self.csv, "goes without --json: both would be printed")
        if self.plot and Path(self.plot).suffix.lower() not in _FIGURE_FORMATS:
            raise InputError("--plot", self.plot, f"must end in {', '.join(_FIGURE_FORMATS)}")
        check_writable("--csv", None if self.csv == _STANDARD_OUTPUT else self.csv)
        check_writable("--plot", self.plot)

    def write(
        self,
        document: Callable[[], dict[str, Any]],
        table: Callable[[], None],
        csv: Callable[[], bytes],
        plot: Callable[[], Axes | Figure] | None = None,
    ) -> None:
        """Write the files that the user asked for, then print the JSON document or the table.

        Files come first: a reader of the table, such as `head`, may leave early.

        Parameters
        ----------
        document, csv, plot : callable
            Make the content of the outputs; each is called if its output is asked for.
        table : callable
            Prints the table.

        Raises
        ------
        InputError, click.ClickException
            As `write`.
        """
        if self.csv == _STANDARD_OUTPUT:
            click.echo(csv(), nl=False)
        elif self.csv:
            write("--csv", self.csv, csv())
        if self.plot and plot:
            _write_plot(self.plot, plot)
        if self.as_json:
            print_json(document())
        elif self.csv != _STANDARD_OUTPUT:
            table()


def json_option(command: Command) -> Command:
    """Add `--json` to a command; the command gets the flag as `as_json`."""
    json_help = "Print everything as JSON instead of the table."
    return click.option("--json", "as_json", is_flag=True, help=json_help)(command)


def output_options(*, csv: str, plot: str = "") -> Option:
    """Add `--json`, `--csv` and, if `plot` describes the figure, `--plot` to a command, which gets all as `outputs`."""

    def declare(command: Command) -> Command:
        @wraps(command)
        def with_outputs(*, as_json: bool, csv: str | None, plot: str | None = None, **given: Any) -> Any:
            outputs = Outputs(as_json, csv, plot)
            outputs.check()
            return command(outputs=outputs, **given)

        declared = json_option(with_outputs)
        csv_help = f"{csv} The file name - prints the rows instead of the table."
        declared = click.option("--csv", metavar="FILE", help=csv_help)(declared)
        plot_help = f"{plot}: a .png, .pdf or .svg file."
        return click.option("--plot", metavar="FILE", help=plot_help)(declared) if plot else declared

    return declare


def print_json(document: Any) -> None:
    """Print plain data as JSON; numbers that are not finite become null."""
    click.echo(json_text(document))


def about(case: Case, request: Request) -> dict[str, Any]:
    """Return the entries with which every JSON document on a case begins."""
    own = stamp.of_case(case, request.options)
    return {
        "case": case.name,
        "title": case.title,
        "set": dict(request.settings),
        "rotor speed (rad/s)": float(case.operation.rotor_speed),
        "deck": own["deck"],
        "options": json.loads(own["options"]),
        "reservations": reservations(case),
        "warnings": list(case.warnings),
        "made by": own["made_by"],
    }


def options_in_force(case: Case, options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options of the model as keywords, each choice as it holds for the case."""
    choice = parse_options(case.model_options(options))
    return {name: getattr(choice, name) for name in (*CHOICES, *options)}


def console() -> PlainConsole:
    """Return a console of the standard output that prints text as it is."""
    from proprotor.commands.terminal import PlainConsole  # here, because rich takes long to import

    return PlainConsole()


def print_head(case: Case, found: Mapping[Any, Any], varied: Collection[str] = ()) -> None:
    """Print the case, the options that are no defaults, and the reservations about the numbers.

    `varied` are the inputs that have other values than those of the case.
    """
    out = console()
    for line in (heading(case, varied), *stamp.unusual_options(found), *reservations(case), ""):
        out.print(line)


def print_footnotes(sentences: Iterable[str]) -> None:
    """Print the sentences that explain the question marks in a table, a line for each."""
    for sentence in sentences:
        console().print(f"{MARK} {sentence}", style="yellow")


def print_doubts(doubts: Iterable[Doubt], unit: str = KTAS, factor: float = KNOT) -> None:
    """Print the footnotes of doubts along airspeeds in a unit of speed; `factor` is that unit in m/s."""
    print_footnotes(footnotes(doubts, unit, factor))


def doubts_as_data(doubts: Iterable[Doubt]) -> list[dict[str, Any]]:
    """Return doubts along airspeeds as entries of a JSON document."""
    return [{"doubt": doubt.text, "from (m/s)": doubt.low, "to (m/s)": doubt.high} for doubt in doubts]


def print_table(
    columns: Sequence[str],
    rows: Iterable[Sequence[str]],
    *,
    text: Sequence[str] = (),
    narrowest: int = _NARROWEST,
) -> None:
    """Print a table: numbers are set to the right, the columns named in `text` to the left.

    No cell is cut off. A table that is too wide for the terminal wraps its words, see `proprotor.commands.columns`; a
    last column of long text has at least `narrowest` characters, or stands beneath its rows.
    """
    out = console()
    head, body = laid_out(columns, rows, text, out.width, narrowest)
    for line in head:
        out.print(line, style="dim", soft_wrap=True)
    for line in body:
        out.print(line, soft_wrap=True)
    out.print()


@contextmanager
def one_message(option: str, path: str | None) -> Iterator[None]:
    """Turn an `OSError` about the output of an option into one message; without a path the error passes on."""
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
        If the path is no place for a file.
    click.ClickException
        If no file can be made in the folder, or the present file may not be replaced.
    """
    if path is not None:
        with _named(option, path):
            output_file.check_writable(path)


@contextmanager
def _named(option: str, path: str) -> Iterator[None]:
    """Turn errors about a path into errors that name the option of the path."""
    try:
        with one_message(option, path):
            yield
    except InputError as error:
        raise InputError(option, path, error.rule) from None


def write(option: str, path: str, content: Callable[[IO[bytes]], object] | bytes) -> None:
    """Write the file of an option, and say so on the error stream.

    Raises
    ------
    InputError
        If the path is no place for a file.
    click.ClickException
        If the file cannot be written.
    """
    with _named(option, path):
        output_file.write_whole(path, content if callable(content) else lambda file: file.write(content))
    click.echo(f"Wrote {path}", err=True)


def _write_plot(path: str, draw: Callable[[], Axes | Figure]) -> None:
    """Write the figure of `--plot`.

    A figure that was made for single axes is cut close to the drawing; a whole figure keeps its margins.
    """
    from proprotor.plots.headless import drawn  # here, so that --help answers without it

    with waiting("Drawing"), drawn(draw) as (plot, figure):
        box = None if plot is figure else "tight"
        form = Path(path).suffix.removeprefix(".").lower()
        write("--plot", path, lambda file: figure.savefig(file, format=form, dpi=160, bbox_inches=box))


def exit_without(results: object) -> None:
    """End the command with exit code 1 if there are no results, because no airspeed could be analysed."""
    if not results:
        raise click.exceptions.Exit(1)


def with_origin(axes: Axes, case: Case, varied: Collection[str] = ()) -> Axes:
    """Write the case of a plot and the reservations about its numbers beneath the plot; return the axes.

    `varied` are the inputs that have other values than those of the case.
    """
    from proprotor.plots import rests_on

    return rests_on(axes, case, f"{heading(case, varied)}.")
