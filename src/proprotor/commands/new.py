"""The command `proprotor new`: a commented deck as a start."""

from __future__ import annotations

import os
from pathlib import Path

import click

from proprotor.commands import arguments, output
from proprotor.deck.file import list_cases, read_tables
from proprotor.errors import InputError


@arguments.command()
@click.argument("file", metavar="FILE")
@click.option(
    "--from",
    "base",
    type=arguments.CaseName(),
    default="xv15",
    show_default=True,
    metavar="CASE",
    help="Case whose numbers the deck gets: a bundled case or a TOML file.",
)
@click.option("--variant", is_flag=True, help="Write a short deck that refers to CASE and alters it.")
@click.option("--force", is_flag=True, help="Replace a file that exists.")
@output.json_option
def new(file: str, base: str, variant: bool, force: bool, as_json: bool) -> None:
    """Write a deck with all fields of decks, each with its meaning, range and default.

    The deck has the numbers of another case and runs as it is; change the numbers that differ. Fields that the other
    case does not set are comments with an example.

    \b
    Examples:
      proprotor new my.toml
      proprotor new wing.toml --from xv15-wing
      proprotor new stiffer.toml --variant
    """
    from proprotor.deck.template import deck_text  # here, because pydantic takes long to import
    from proprotor.deck.validation import validate

    place = Path(file)
    if place.suffix != ".toml":
        raise InputError("FILE", file, "must end in .toml")
    if place.exists() and not force:
        raise InputError("FILE", file, "exists; --force replaces it")
    output.check_writable("FILE", file)
    tables = read_tables(base)
    validate(tables)
    if variant and base not in list_cases():
        if place.resolve() == Path(base).resolve():
            raise InputError("FILE", file, "must not be the deck that it alters")
        base = os.path.relpath(base, place.parent).replace(os.sep, "/")
    output.write("FILE", file, deck_text(tables, place, base, variant).encode())
    if as_json:
        output.print_json({"written": file, "from": base, "variant": variant})
    else:
        click.echo(f"Try: proprotor sweep {file} --speed 50:400:5kt --plot damping.png")
