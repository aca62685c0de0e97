"""Check the tables of a deck against its sections, and put every problem into one line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import ValidationError

from proprotor.deck.alternatives import altered
from proprotor.deck.left import left_tables
from proprotor.deck.sections import SECTIONS, SUPPORT_KINDS, Deck, in_the_deck
from proprotor.deck.text import plain_text
from proprotor.errors import InputError, unknown_name

# Rules in messages, by pydantic's name of an error.
_RULES = {
    **dict.fromkeys(("model_type", "model_attributes_type", "dict_type"), "must be a table"),
    "int_type": "must be a whole number",
    "list_type": "must be a list",
    "string_type": "must be text",
    "bool_type": "must be true or false",
    **dict.fromkeys(("too_short", "string_too_short"), "must not be empty"),
    "string_pattern_mismatch": "must be letters, digits, spaces, dots, dashes and underscores",
}


def validate(tables: dict[str, Any]) -> Deck:
    """Return the deck in the tables of a TOML file.

    Raises
    ------
    InputError
        With a line for every problem.
    """
    tables = plain_text(tables, _field_name)
    deck = _whole(tables)
    own = {name: table for name, table in tables.items() if name not in ("variants", "envelope")}
    deck = deck.with_tables(own)
    for name in deck.variants:
        deck_of_condition(deck, (name,))
    return deck


def deck_of_condition(deck: Deck, variants: Sequence[str], changes: Mapping[str, Any] | None = None) -> Deck:
    """Return the deck of a condition: with the fields of some of its variants, one after the other, and with changes.

    Parameters
    ----------
    deck : Deck
    variants : sequence of str
    changes : mapping, optional
        Tables with further fields.

    Raises
    ------
    InputError
        With a line for every problem.
    """
    tables = deck.tables
    for name in variants:
        given = deck.variants[name].model_dump(exclude_none=True, exclude={"condition"})
        tables = altered(tables, given)
    try:
        whole = _whole(altered(tables, dict(changes or {})))
    except InputError as error:
        place = ".".join(("variants", *variants)) if variants else ""
        first, *others = [one.within(place) for one in (error, *error.others)]
        raise InputError(first.field, first.value, first.rule, others) from None
    return whole.with_origin(*deck.origin)


def _whole(tables: dict[str, Any]) -> Deck:
    """Return the deck in tables, with the deck of the left side where it differs."""
    deck = _checked(tables)
    if deck.left is None:
        return deck
    own = {name: table for name, table in tables.items() if name not in ("left", "variants", "envelope")}
    of_left = left_tables(own, tables["left"])
    try:
        return deck.with_left_side(_checked(of_left))
    except InputError as error:
        first, *others = [one.within("left") for one in (error, *error.others)]
        raise InputError(first.field, first.value, first.rule, others) from None


def _checked(tables: dict[str, Any]) -> Deck:
    """Return the deck in tables, without the deck of the left side."""
    try:
        return Deck.model_validate(tables)
    except ValidationError as error:
        first, *others = [_input_error(problem, tables) for problem in error.errors(include_url=False)]
        raise InputError(first.field, first.value, first.rule, others) from None


def _input_error(problem: Any, tables: dict[str, Any]) -> InputError:
    """Return an error of pydantic with the field's name in the deck and a rule in the words of this package."""
    place, kind = problem["loc"], problem["type"]
    field = _field_name(in_the_deck(place), tables)
    if kind == "value_error":
        error: InputError = problem["ctx"]["error"]
        return error.within(field)
    if kind == "extra_forbidden":
        names = tuple(part for part in place[:-1] if isinstance(part, str))
        known = SECTIONS[names[:1] if names[:1] == ("variants",) else names].model_fields
        return InputError(field, problem["input"], unknown_name(str(place[-1]), known))
    if kind == "literal_error":
        return InputError(field, problem["input"], f"must be {problem['ctx']['expected']}")
    if kind in ("missing", "union_tag_not_found"):
        return InputError(field if kind == "missing" else f"{field}.kind", None, "is missing")
    if kind == "union_tag_invalid":
        rule = f"must be {', '.join(map(repr, SUPPORT_KINDS))}"
        return InputError(f"{field}.kind", problem["ctx"]["tag"], rule)
    return InputError(field, problem["input"], _RULES.get(kind, problem["msg"]))


def _field_name(place: tuple[str | int, ...], tables: Any) -> str:
    """Return the name of a field, ``support.modes[beam].x`` for ``("support", "modes", 0, "x")``."""
    text = ""
    for part in place:
        tables = tables[part] if not isinstance(tables, dict) or part in tables else None
        if isinstance(part, str):
            text += f".{part}" if text else part
        else:
            name = tables.get("name") if isinstance(tables, dict) else None
            text += f"[{name if isinstance(name, str) and name else part}]"
    return text
