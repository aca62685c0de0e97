"""The command `proprotor`: the group of all commands, and the messages with which an error ends a command."""

from __future__ import annotations

import contextlib
import errno
import io
import os
import sys
from collections import UserDict
from collections.abc import Iterator
from importlib import import_module
from typing import IO, Any

import click

from proprotor.commands.exit_codes import EXIT_CODES
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError

# The commands in the order in which a newcomer meets them. A command is imported when it is called, and NumPy and the
# engine with it; functions import xarray, pydantic, rich, bokeh and matplotlib, which are slower still.
_SUMMARIES = {
    "cases": "List the bundled cases, or show one case.",
    "new": "Write a commented deck that runs as it is.",
    "describe": "Show the fields of a deck: meaning, unit, range, default.",
    "sweep": "Show frequency and damping of each mode along airspeeds.",
    "flutter": "Find flutter and divergence boundaries, and the margin.",
    "boundary": "Follow the boundaries over altitude, rotor speed or another input.",
    "envelope": "Hold the flutter speeds of all conditions against V_D at altitude.",
    "margins": "Show how much each control loop may change before it is unstable.",
    "map": "Show where in the plane of two inputs a case is stable.",
    "sensitivity": "Show how each input moves the flutter speed or a damping.",
    "blade": "Make a hinged blade of a table of stations.",
    "attribution": "Show what drives and what damps a mode, by physical origin.",
    "gust": "Show what turbulence or single gusts do to hub loads and motion.",
    "identify": "Find frequency and damping in the record of a free decay.",
    "calibrate": "Fit inputs of a deck to test points.",
    "mac": "Compare measured modes of a structure with those of a model.",
    "report": "Write all results on a case as one page: HTML, PDF or DOCX.",
    "explore": "Move sliders on the inputs, and see the modes follow.",
    "study": "Analyse many designs: grids, lists and samples.",
    "export": "Write the equations at an airspeed for Nastran or MATLAB.",
}
_MODULES = {"map": "stability_map"}  # whose name is not that of the command
_NOT_NEEDED = ("dask", "pint")  # xarray imports them where they are installed, for longer than a sweep takes


class _UnusableInput(click.ClickException):
    exit_code = 2


class _Interrupted(click.ClickException):
    exit_code = 130  # 128 and the number of the signal, as shells have it

    def show(self, file: IO[Any] | None = None) -> None:
        click.echo(f"\n{self.format_message()}", err=True, file=file)


@contextlib.contextmanager
def errors_as_messages() -> Iterator[None]:
    """Turn errors about inputs and files, and an interruption, into one message each, without a traceback."""
    try:
        yield
    except InputError as error:
        raise _UnusableInput(str(error)) from None
    except KeyboardInterrupt as stopped:
        told = ["interrupted", "no file was left half-written", *getattr(stopped, "__notes__", ())]
        raise _Interrupted("; ".join(told)) from None
    except OSError as error:
        if error.errno == errno.EPIPE:  # a reader such as `head` has left: click ends quietly
            raise
        _let_go_of_standard_output()
        where = error.filename or "standard output"
        raise click.ClickException(f"{where}: {error.strerror or error}") from None


class _Imported(UserDict[str, Any]):
    """The commands by name, each imported when it is asked for."""

    def __getitem__(self, name: str) -> click.Command:
        summary = self.data[name]
        module = _MODULES.get(name, name)
        with waiting("Starting"):
            command: click.Command = getattr(import_module(f"proprotor.commands.{module}"), module)
        command.short_help = summary
        return command


class _Commands(click.Group):
    """Commands in the order in which a newcomer meets them; an error is one message, without a traceback."""

    def __call__(self, *args: Any, **more: Any) -> Any:
        if not args:  # the words of the shell: this process runs one command and nothing else
            _leave_out(_NOT_NEEDED)
        return super().__call__(*args, **more)

    def main(self, *args: Any, **more: Any) -> Any:
        _write_any_character()
        return super().main(*args, **more)

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.commands)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl(list(_SUMMARIES.items()))

    def invoke(self, ctx: click.Context) -> Any:
        with errors_as_messages():
            return super().invoke(ctx)


def _leave_out(packages: tuple[str, ...]) -> None:
    """Let packages count as not installed for the rest of the process."""
    for package in packages:
        sys.modules.setdefault(package, None)  # type: ignore[arg-type]


def _let_go_of_standard_output() -> None:
    """Discard the rest of the output; otherwise Python would try to write it once more at its end, and complain."""
    with contextlib.suppress(OSError, AttributeError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


def _write_any_character() -> None:
    """Write characters that the encoding of the terminal lacks, such as Greek in cp1252, as their codes."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


@click.group(
    cls=_Commands,
    commands=_Imported(_SUMMARIES),
    epilog=EXIT_CODES,
    context_settings={"max_content_width": 100},
)
@click.version_option(package_name="proprotor")
def main() -> None:
    """Whirl-flutter stability of gimballed tiltrotors.

    \b
    Try:
      proprotor cases                           the bundled cases
      proprotor sweep xv15 --speed 50:400:5kt   frequency and damping of modes
      proprotor flutter xv15                    flutter speed, all boundaries
      proprotor boundary --help                 boundaries over another input
      proprotor report xv15                     all results: HTML, PDF or DOCX
      proprotor explore xv15                    a page with sliders on inputs
      proprotor new my.toml                     a commented deck of your own
      proprotor describe rotor.precone          what a field of a deck means
      proprotor sweep --help                    every option of a command

    A deck is the TOML file that describes a case. --set changes a field of the deck for one run; --json prints
    everything that a command finds. Each command lists its options with --help.

    \b
    To have the shell complete commands and fields, in bash (or zsh or fish):
      eval "$(_PROPROTOR_COMPLETE=bash_source proprotor)"
    """
