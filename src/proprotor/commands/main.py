"""The command `proprotor`: the group of all commands, and the messages with which an error ends a command."""

from __future__ import annotations

import contextlib
import errno
import io
import os
import sys
from collections.abc import Iterator
from typing import IO, Any

import click

from proprotor.commands.arguments import EXIT_CODES
from proprotor.commands.attribution import attribution
from proprotor.commands.boundary import boundary
from proprotor.commands.cases import cases
from proprotor.commands.describe import describe
from proprotor.commands.explore import explore
from proprotor.commands.flutter import flutter
from proprotor.commands.new import new
from proprotor.commands.report import report
from proprotor.commands.sensitivity import sensitivity
from proprotor.commands.stability_map import stability_map
from proprotor.commands.study import study
from proprotor.commands.sweep import sweep
from proprotor.errors import InputError

# pint, pydantic, xarray, rich, bokeh and matplotlib are slow to import: functions import them when they need them.


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
    except KeyboardInterrupt:
        raise _Interrupted("interrupted; no file was left half-written") from None
    except OSError as error:
        if error.errno == errno.EPIPE:  # a reader such as `head` has left: click ends quietly
            raise
        _let_go_of_standard_output()
        where = error.filename or "standard output"
        raise click.ClickException(f"{where}: {error.strerror or error}") from None


class _Commands(click.Group):
    """Commands in the order in which a newcomer meets them; an error is one message, without a traceback."""

    def main(self, *args: Any, **more: Any) -> Any:
        _write_any_character()
        return super().main(*args, **more)

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.commands)

    def invoke(self, ctx: click.Context) -> Any:
        with errors_as_messages():
            return super().invoke(ctx)


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


@click.group(cls=_Commands, epilog=EXIT_CODES, context_settings={"max_content_width": 100})
@click.version_option(package_name="proprotor")
def main() -> None:
    """Whirl-flutter stability of gimballed tiltrotors.

    \b
    Try:
      proprotor cases                               the bundled cases
      proprotor sweep xv15 --speed 50:400:5kt       frequency and damping of each mode
      proprotor flutter xv15                        flutter speed and all other boundaries
      proprotor boundary --help                     boundaries over altitude, rotor speed or an input
      proprotor report xv15                         all results on one page, HTML or PDF
      proprotor explore xv15                        a page with sliders on the inputs
      proprotor new my.toml                         a commented deck of your own
      proprotor describe rotor.precone              what a field of a deck means
      proprotor sweep --help                        every option of a command

    A deck is the TOML file that describes a case. --set changes a field of the deck for one run; --json prints
    everything that a command finds. Each command lists its options with --help.

    \b
    To have the shell complete commands and fields, in bash (likewise in zsh and fish):
      eval "$(_PROPROTOR_COMPLETE=bash_source proprotor)"
    """


_ANALYSES = (sweep, flutter, boundary, stability_map, sensitivity, attribution, report, explore, study)
for _command in (cases, new, describe, *_ANALYSES):
    main.add_command(_command)
