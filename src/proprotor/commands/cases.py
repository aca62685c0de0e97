"""The command `proprotor cases`: the bundled cases, and the sources of the numbers of a case."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import click

from proprotor.case import Case, list_cases
from proprotor.commands import arguments, output
from proprotor.deck.file import read_tables
from proprotor.errors import InputError
from proprotor.model.provenance import doubtful_inputs, reservations


@arguments.command()
@click.argument("name", required=False, type=arguments.CaseName(), metavar="[CASE]")
@arguments.set_option
@output.json_option
def cases(name: str | None, settings: tuple[str, ...], as_json: bool) -> None:
    """List the bundled cases, or describe one case and show which of its inputs are doubtful.

    CASE is a bundled case or a TOML file. With --json the command prints every number of the case: its value as
    written and in SI units, its status and its source.

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
    request = arguments.Request(name, arguments.settings_of(settings), {})
    case = request.load()
    if as_json:
        output.print_json(_document(case, request))
    else:
        _print(case)


def _print(case: Case) -> None:
    """Print the description of a case, and each input that was not read in a source."""
    out = output.console()
    warnings = (f"Warning: {text}" for text in case.warnings)
    for paragraph in filter(None, (case.title, case.description, *reservations(case), *warnings)):
        out.print(f"{paragraph}\n")
    for path, number in doubtful_inputs(case).items():
        out.print_hanging(f"{number.status:<11} ", f"{path} = {number.written}")
        if number.source:
            out.print_hanging(f"{'':<11} ", number.source)


def _list(as_json: bool) -> None:
    titles = {name: read_tables(name).get("case", {}).get("title", "") for name in list_cases()}
    if as_json:
        output.print_json([{"name": name, "title": title} for name, title in titles.items()])
    else:
        for name, title in titles.items():
            click.echo(f"{name:<24} {title}")


def _document(case: Case, request: arguments.Request) -> dict[str, Any]:
    head = output.about(case, request)
    del head["options"]
    inputs = {
        path: {key: value for key, value in asdict(number).items() if value is not None}
        for path, number in case.sources.items()
    }
    return head | {"description": case.description, "calibration": case.calibration, "inputs": inputs}
