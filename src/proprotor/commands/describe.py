"""The command `proprotor describe`: the fields of a deck, or what the inputs of one amount to."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING

import click

from proprotor.case import Case, list_cases, load_case
from proprotor.commands import arguments, output
from proprotor.errors import InputError
from proprotor.model.amounts import amounts, blade_at_trims, support_modes
from proprotor.tables.amounts_table import amounts_tables
from proprotor.tables.sweep_table import heading

if TYPE_CHECKING:
    from proprotor.deck.describe import DeckField

_COLUMNS = ("field", "SI unit", "range", "meaning")
_MOST_IN_FULL = 3  # up to so many fields are printed in full, more fields as a table


@arguments.command()
@click.argument("field", required=False, type=arguments.FieldOrCase(), metavar="[FIELD]")
@click.option("--schema", is_flag=True, help="Print the JSON schema, with which editors check a deck.")
@click.option("--markdown", is_flag=True, help="Print all fields as a page in Markdown (docs/decks.md).")
@output.json_option
def describe(field: str | None, schema: bool, markdown: bool, as_json: bool) -> None:
    """Show the fields of a deck: the meaning, unit, range, default and alternatives of each field.

    FIELD is a field, a section, a kind of support or the last part of a field's name. Without FIELD all fields are
    listed. A deck in its place, a bundled case or a TOML file, shows what its inputs amount to: Lock number,
    frequencies, couplings and so on; a doubtful number is marked, and the rule told.

    \b
    Examples:
      proprotor describe rotor.precone
      proprotor describe rotor
      proprotor describe beam-wing
      proprotor describe my.toml
      proprotor describe --schema > deck.schema.json
    """
    from proprotor.deck import describe as fields  # here, because pydantic takes long to import
    from proprotor.deck.fields_page import markdown as markdown_page
    from proprotor.deck.schema import deck_schema

    if sum((schema, markdown, as_json)) > 1:
        raise InputError("--schema", None, "must not be given with --markdown or --json")
    if field is not None and not (schema or markdown) and (field in list_cases() or field.endswith(".toml")):
        _describe_case(load_case(field), as_json)
        return
    if field is not None and (schema or markdown):
        raise InputError("FIELD", field, "goes with the table or --json; a schema or page has all fields")
    if schema:
        output.print_json(deck_schema())
        return
    if markdown:
        click.echo(markdown_page(), nl=False)
        return
    found = fields.deck_fields() if field is None else fields.find_fields(field)
    if as_json:
        output.print_json([asdict(field) for field in found])
    elif len(found) <= _MOST_IN_FULL:
        _print_in_full(found)
    else:
        _print_table(found)


def _describe_case(case: Case, as_json: bool) -> None:
    """Print what the inputs of a case amount to, with the rule for each doubtful number."""
    if as_json:
        output.print_json(
            {
                "amounts": [asdict(one) for one in amounts(case)],
                "blade at trim": [asdict(one) for one in blade_at_trims(case)],
                "support modes": [asdict(one) for one in support_modes(case)],
            }
        )
        return
    tables, doubts = amounts_tables(case)
    out = output.console()
    out.print(heading(case))
    for table in tables:
        out.print(table.caption, style="bold")
        output.print_table(table.columns, table.rows, text=table.text)
    for doubt in doubts:
        out.print(doubt, style="yellow")


def _print_in_full(found: tuple[DeckField, ...]) -> None:
    from proprotor.deck.describe import field_lines

    out = output.console()
    for field in found:
        out.print(field.path, style="bold")
        for label, text in field_lines(field):
            out.print_hanging(f"  {label:<11}", text)


def _print_table(found: tuple[DeckField, ...]) -> None:
    out = output.console()
    for kind in dict.fromkeys(field.kind for field in found):
        if kind:
            out.print(f'[support] of kind "{kind}"', style="bold")
        rows = [
            (f"{field.path}{'*' * field.required}", field.unit, field.range, field.meaning)
            for field in found
            if field.kind == kind
        ]
        output.print_table(_COLUMNS, rows, text=("field", "SI unit", "meaning"))
    out.print("* must be given, or one of its alternatives. `proprotor describe FIELD` shows one in full.")
