"""The numbers that a deck leaves out: their defaults, from which they may vary, or what a deck must say first."""

from __future__ import annotations

import re
from collections.abc import Collection
from typing import TYPE_CHECKING, Any

from proprotor.datum import Datum
from proprotor.deck.numbers import LEFT
from proprotor.errors import InputError, unknown_name

if TYPE_CHECKING:
    from proprotor.deck.describe import DeckField
    from proprotor.deck.fields import Section
    from proprotor.deck.sections import Deck

_NUMBERS = (
    "number",
    "tangent",
    "frequency",
    "curve",
    "along the blade",
    "along the wing",
)  # forms of one number
_STEP = re.compile(r"([^.\[\]]+)(?:\[([^\[\]]+)\])?")
_SOURCE = "default of a field that the deck leaves out"


def number_left_out(deck: Deck, path: str, known: Collection[str]) -> Datum:
    """Return a number that a deck leaves out at its default.

    Parameters
    ----------
    deck : Deck
    path : str
        Of a number that is not among the deck's inputs.
    known : collection of str
        Paths of the deck's inputs.

    Raises
    ------
    InputError
        For a path that no deck has, with the nearest known one; and for a field that cannot vary in this deck, with
        what to write in the deck instead.
    """
    from proprotor.deck.describe import deck_fields, plain_path  # here, because pydantic is slow to import

    plain = plain_path(path)
    fields = (one for one in deck_fields() if plain_path(one.path) == plain)
    field = next((one for one in fields if one.kind in ("", deck.support.kind)), None)
    table, _, name = path.rpartition(".")
    if path.removeprefix(LEFT) in known:
        rule = "is that of the right side in this deck; give it under [left] in the deck to vary it alone"
        raise InputError(path, None, rule)
    if field is None or "[" in name:
        raise InputError(path, None, unknown_name(path, known, "input"))
    section = _section_at(deck, table)
    if section is None:
        raise InputError(
            path, None, f"stands in no table of this deck; write [{table}] in the deck to vary it"
        )
    default = _default(section, name, field)
    if default is None:
        each = [one for one in known if one.startswith(f"{path}[")]
        rule = f"has a value for each region: {', '.join(each)}" if each else _why_not(section, name, field)
        raise InputError(path, None, rule)
    return default


def _section_at(deck: Deck, table: str) -> Section | None:
    """Return the section of a deck at a path, such as ``support.modes[beam]``; None where the deck has none."""
    here: Any = deck
    for step in _STEP.finditer(table):
        here = getattr(here, step[1].strip(), None)
        if step[2] is not None:
            here = next((entry for entry in here or () if getattr(entry, "name", None) == step[2]), None)
    return here if hasattr(type(here), "model_fields") else None


def _default(section: Section, name: str, field: DeckField) -> Datum | None:
    """Return the default of a number that a section leaves out, if there is one from which it may vary."""
    from proprotor.deck.describe import defaults_of
    from proprotor.deck.fields import Reading

    si = defaults_of(type(section)).get(name)
    given = getattr(section, name) is not None or _replaced_by(section, field) or _lacks(section, name)
    if given or field.form not in _NUMBERS or not isinstance(si, int | float):
        return None
    metadata = type(section).model_fields[name].metadata
    unit = next(part for part in metadata if isinstance(part, Reading)).unit_after(dict(section))
    form = field.form if field.form == "tangent" else ""
    return Datum(f"{si:g} {unit}".strip(), float(si), unit, "assumed", _SOURCE, form=form)


def _replaced_by(section: Section, field: DeckField) -> list[str]:
    """Return the fields of a section that stand in place of a field."""
    return [other for other in field.instead_of if other in section.model_fields_set]


def _lacks(section: Section, name: str) -> str:
    """Return the field that a section lacks, beside which alone a field has a meaning; "" for most."""
    other = section.needs.get(name, "")
    return other if other not in section.model_fields_set else ""


def _why_not(section: Section, name: str, field: DeckField) -> str:
    """Return why a field of a section cannot vary."""
    if field.form not in _NUMBERS:
        return f"cannot vary; it is {field.takes}"
    if getattr(section, name) is not None:
        return "cannot vary, as distributions, blade frequencies and numbers of an envelope cannot"
    if other := _lacks(section, name):
        return f"cannot vary; the deck gives no {other}"
    if others := _replaced_by(section, field):
        return f"cannot vary; the deck gives {', '.join(others)} instead"
    return f"is left out of this deck and has no default to vary from; give it in the deck or with --set: {field.takes}"
