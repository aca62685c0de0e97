"""The command `proprotor`."""

from __future__ import annotations

from typing import Any

import click

from proprotor.commands.arguments import EXIT_CODES as _EXIT_CODES
from proprotor.commands.arguments import model_options as _model_options
from proprotor.commands.attribution import attribution
from proprotor.commands.audit import audit
from proprotor.commands.cases import cases
from proprotor.commands.describe import describe
from proprotor.commands.flutter import flutter
from proprotor.commands.new import new
from proprotor.commands.report import report
from proprotor.commands.sensitivity import sensitivity
from proprotor.commands.stability_map import stability_map
from proprotor.commands.sweep import sweep
from proprotor.errors import InputError
from proprotor.figures_command import figures
from proprotor.study_command import study_command

# pint, pydantic, xarray, rich and matplotlib are slow to import: each is imported where it is needed.

__all__ = ["main", "sweep"]


class _UnusableInput(click.ClickException):
    exit_code = 2


class _InputErrorsTold(click.Group):
    """A group of commands that tells errors in one message, without a traceback."""

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except InputError as error:
            raise _UnusableInput(str(error)) from None


class _InOrder(_InputErrorsTold):
    """Commands listed as a newcomer meets them."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(self.commands)


@click.group(cls=_InOrder, epilog=_EXIT_CODES, context_settings={"max_content_width": 100})
@click.version_option(package_name="proprotor")
def main() -> None:
    """Whirl-flutter stability of gimballed tiltrotors.

    \b
    Try:
      proprotor cases                               the bundled cases
      proprotor sweep xv15 --speed 50:400:5kt       frequency and damping of each mode
      proprotor flutter xv15                        flutter speed and all other boundaries
      proprotor report xv15                         all of it on one page, HTML or PDF
      proprotor new my.toml                         a commented deck of your own
      proprotor describe rotor.precone              what a field of it is
      proprotor sweep --help                        all there is to choose

    Each command tells its options with --help. --set changes a field of the deck for one run; --json prints
    everything a command finds.

    \b
    Completion in the shell, for bash (likewise zsh, fish):
      eval "$(_PROPROTOR_COMPLETE=bash_source proprotor)"
    """


for _command in (
    cases,
    new,
    describe,
    sweep,
    flutter,
    stability_map,
    sensitivity,
    attribution,
    report,
    study_command(_model_options, _EXIT_CODES),
    figures,
    audit,
):
    main.add_command(_command)
