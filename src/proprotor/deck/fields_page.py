"""Write the page docs/decks.md: every field of a deck, section by section."""

from __future__ import annotations

from collections.abc import Iterator

from proprotor.deck.describe import DeckField, deck_fields, plain_path
from proprotor.deck.sections import LISTS, section_places, sections_at

_HEAD = """# Fields of a deck

Written by `proprotor describe --markdown` from the definitions in `src/proprotor/deck/sections.py`,
`support_sections.py` and `control_sections.py`.

A deck is a TOML file. A number with a dimension is text with its unit, US or SI, `radius = "12.5 ft"`; a number without
a dimension is plain. Either may be a table that names its source:

    radius = { value = "12.5 ft", status = "published", source = "AIAA-2002-1604, Table 1" }

with a status of published, measured, derived, recalled, calibrated or assumed. `default_status = "measured"` in [case],
perhaps with `default_source = "weighing report 12"`, is the status of every number of the same file that states none.
`base = "xv15"` above all sections alters another deck: a field given replaces the base's and its alternatives.

A frequency per revolution, `"0.42/rev"`, refers to the rotor speed that is written in the same file, or in its base if
the file gives none. The frequency is then fixed in hertz, because the frequencies of a wing do not depend on the rotor:
`--set`, `vary`, a study, a map, a slider or a deck that alters this deck changes the rotor speed and not the frequency.
A frequency that is set in /rev also refers to the deck's own rotor speed.

    proprotor new my.toml --from xv15                       # a commented deck that runs as it is
    proprotor describe rotor.precone                        # one field
    proprotor describe --schema > deck.schema.json          # for editors
    proprotor sweep my.toml --speed 50:400:5kt --set rotor.precone="1.5 deg"

An editor that knows JSON schemas for TOML (Even Better TOML, taplo) completes and checks a deck whose first line is
`#:schema ./deck.schema.json`.
"""


_BRACKETS = {place: f"[[{place}]]" for place in LISTS} | {"variants": "[variants.NAME]"}


def markdown() -> str:
    """Return the text of docs/decks.md."""
    return "\n".join([_HEAD, *_sections()]) + "\n"


def _sections() -> Iterator[str]:
    for place in section_places():
        for kind, section in sections_at(place).items():
            name = ".".join(place)
            brackets = _BRACKETS.get(name, f"[{name}]")
            yield f"## {brackets}{f' of kind {kind}' if kind else ''}\n"
            yield f"{' '.join((section.__doc__ or '').split())}\n"
            yield "| field | meaning | takes | range | default | instead of |"
            yield "|---|---|---|---|---|---|"
            yield from (
                _row(field)
                for field in deck_fields()
                if field.kind == kind and plain_path(field.path).rpartition(".")[0] == name
            )
            yield ""


def _row(field: DeckField) -> str:
    name = field.path.rpartition(".")[2]
    default = "**needed**" if field.required and not field.default else field.default
    cells = (f"`{name}`", field.meaning, field.takes, field.range, default, ", ".join(field.instead_of))
    return f"| {' | '.join(cell.replace('|', '&#124;') for cell in cells)} |"
