"""The command `proprotor cases`: the bundled cases, and what a case rests on."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import click

from proprotor.commands import output
from proprotor.commands.arguments import EXIT_CODES, CaseName, loaded_case, set_option, settings_of
from proprotor.deck.file import list_cases, read_tables
from proprotor.errors import InputError

if TYPE_CHECKING:
    from proprotor.case import Case


@click.command(epilog=EXIT_CODES, short_help="List the bundled cases, or tell what one rests on.")
@click.argument("name", required=False, type=CaseName(), metavar="[CASE]")
@set_option
@output.output_options()
def cases(name: str | None, settings: tuple[str, ...], as_json: bool) -> None:
    """List the bundled cases, or tell what one case, bundled or a TOML file, is and rests on.

    With --json every number of the case is told, with its value as written, in SI units, its status and source.

    \b
    Examples:
      proprotor cases
      proprotor cases xv15
      proprotor cases my.toml --json
    """
    if name is None:
        if settings:
            raise InputError("--set", settings[0], "needs a case")
        _list(as_json)
        return
    case = loaded_case(name, settings)
    if as_json:
        output.print_json(_document(case, settings))
        return
    from proprotor.commands.terminal import print_case

    print_case(case)


def _list(as_json: bool) -> None:
    titles = {name: read_tables(name).get("case", {}).get("title", "") for name in list_cases()}
    if as_json:
        output.print_json([{"name": name, "title": title} for name, title in titles.items()])
    else:
        for name, title in titles.items():
            click.echo(f"{name:<24} {title}")


def _document(case: Case, settings: tuple[str, ...]) -> dict[str, Any]:
    head = output.about(case, {}, settings_of(settings))
    del head["options"]
    inputs = {
        path: {key: value for key, value in asdict(number).items() if value is not None}
        for path, number in case.sources.items()
    }
    return head | {"description": case.description, "calibration": case.calibration, "inputs": inputs}
