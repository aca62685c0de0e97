"""Write the JSON schema of decks, by which editors complete and check a TOML file."""

from __future__ import annotations

from typing import Any

from pydantic.json_schema import GenerateJsonSchema
from pydantic_core import CoreSchema

from proprotor.datum import STATUSES
from proprotor.deck.fields import AfterChoice, Reading
from proprotor.deck.reading import BELOW_CRITICAL, FRACTION, NOT_NEGATIVE, POSITIVE, Bound
from proprotor.deck.sections import Deck, TrimSection
from proprotor.units import meaning

_Schema = dict[str, Any]

_DIALECT = "http://json-schema.org/draft-07/schema#"  # the one that editors of TOML know
_NUMBER = r"^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?"
_PROVENANCE: _Schema = {
    "status": {"enum": list(STATUSES), "description": "How well the number is known."},
    "source": {"type": "string", "description": "Where it was read, or how it was found."},
}
_LIMITS: dict[Bound, _Schema] = {
    POSITIVE: {"exclusiveMinimum": 0},
    NOT_NEGATIVE: {"minimum": 0},
    FRACTION: {"minimum": 0, "maximum": 1},
    BELOW_CRITICAL: {"minimum": 0, "exclusiveMaximum": 1},
}
_NUMBERS: _Schema = {"type": "array", "items": {"type": "number"}, "minItems": 2}
_NAMES: _Schema = {"type": "array", "items": {"type": "string", "minLength": 1}, "minItems": 2}
_STATIONS = {"distribution": "r_over_R", "along the blade": "r_over_R", "along the wing": "y_over_span"}


def deck_schema() -> _Schema:
    """Return the JSON schema of a deck, draft 7.

    The schema has every table and field, the kind of each value, and the required fields, of which a deck with `base`
    has none. It does not check units: `proprotor.deck.validation.validate` does, and decides whether a deck is valid.
    """
    schema: _Schema = Deck.model_json_schema(
        ref_template="#/definitions/{model}", schema_generator=_SchemaOfFields
    )
    definitions: _Schema = schema.pop("$defs")
    kinds = schema["properties"]["support"]
    kinds.pop("discriminator", None)
    whole = _what_must_be_given(definitions, schema.pop("required"), kinds.pop("oneOf"))
    schema["properties"] = {
        "base": {"type": "string", "description": "The deck that this one alters: a bundled name or a file."}
    } | schema["properties"]
    kinds["anyOf"] = [{"$ref": f"#/definitions/{name}"} for name in whole["support"]]
    return {
        "$schema": _DIALECT,
        **schema,
        "if": {"not": {"required": ["base"]}},
        "then": whole["deck"],
        "definitions": definitions,
    }


class _SchemaOfFields(GenerateJsonSchema):
    """Pydantic's schema of the sections, with the schema of each field by its `Reading`."""

    def function_plain_schema(self, schema: CoreSchema) -> _Schema:
        """Return the schema of a field with a reader of its own; the only such field without a `Reading` is trim."""
        reading = (schema.get("metadata") or {}).get("reading")
        return _TRIM_SCHEMA if reading is None else _value_schema(reading)


def _what_must_be_given(definitions: _Schema, sections: list[str], kinds: list[_Schema]) -> _Schema:
    """Move the required fields out of the definitions, because only a deck without a base must give them."""
    names = [kind["$ref"].rpartition("/")[2] for kind in kinds]
    required = {name: definitions[name].pop("required", []) for name in (*names, *_TABLES)}
    places = {section: {"required": required[name]} for name, section in _TABLES.items() if section}
    places["rotor"]["properties"] = {"airfoil": {"required": required["AirfoilSection"]}}
    kind_of = {name: definitions[name]["properties"]["kind"] for name in names}
    places["support"] = {
        "required": ["kind"],
        "anyOf": [
            {"properties": {"kind": {"const": kind_of[name]["const"]}}, "required": required[name]}
            for name in names
        ],
    }
    return {"deck": {"required": sections, "properties": places}, "support": names}


# Definitions whose fields a base may give, with the section of the deck; the airfoil is a section of the rotor.
_TABLES = {
    "CaseSection": "case",
    "RotorSection": "rotor",
    "OperationSection": "operation",
    "AirfoilSection": "",
    "EnvelopeSection": "envelope",
}


def _value_schema(reading: Reading) -> _Schema:
    """Return the schema of a field: of a plain value, or of a table with its provenance."""
    if reading.form == "rising list":
        return _table({"value": _NUMBERS, "unit": {"type": "string"}})
    value = _value(reading)
    choices = (
        [] if reading.form == "distribution" else [*value.get("anyOf", [value]), _table({"value": value})]
    )
    if reading.form == "curve":
        choices.append(_table({"value": _NUMBERS} | ({"unit": {"type": "string"}} if reading.unit else {})))
    if reading.form == "files":
        choices += [_NAMES, _table({"value": _NAMES})]
    if reading.form in _STATIONS:
        choices.append(_distribution(reading))
    if reading.form in ("along the blade", "distribution"):
        choices.append(_with_beyond(_COLUMN, reading))
    return {"anyOf": choices}


def _value(reading: Reading) -> _Schema:
    """Return the schema of a plain value."""
    if reading.form == "count":
        return {"type": "integer", "minimum": reading.least}
    if reading.form in ("file", "files"):
        return {"type": "string", "minLength": 1}
    if reading.form == "choice":
        return {"enum": list(reading.choices)}
    text: _Schema = {"type": "string", "pattern": _NUMBER, "description": _description(reading)}
    if reading.form == "joint":
        return {"anyOf": [{"enum": list(reading.choices)}, text]}
    plain = {"type": "number", **_LIMITS.get(reading.bound, {})}
    may_be_plain = not reading.unit or (isinstance(reading, AfterChoice) and not reading.other_unit)
    return {"anyOf": [text, plain]} if may_be_plain else text


def _description(reading: Reading) -> str:
    """Return the form and the range of a number in words."""
    rule = f"; {reading.bound.rule}" if reading.bound.rule else ""
    per_rev = ', or per revolution, "0.42/rev"' if reading.form == "frequency" else ""
    return f"{meaning(reading.unit)}{per_rev}{rule}"


def _distribution(reading: Reading) -> _Schema:
    """Return the schema of a distribution along the blade or the wing."""
    stations = {"type": "array", "items": {"type": "number", "minimum": 0, "maximum": 1}, "minItems": 2}
    table = _table({_STATIONS[reading.form]: stations, "value": _NUMBERS, "unit": {"type": "string"}})
    return _with_beyond(table, reading)


def _with_beyond(table: _Schema, reading: Reading) -> _Schema:
    """Return the table of a distribution with its word for the blade beyond the stations."""
    if not reading.beyond:
        return table
    return table | {"properties": table["properties"] | {"beyond": {"const": reading.beyond}}}


def _table(required: _Schema, optional: _Schema = _PROVENANCE) -> _Schema:
    """Return the schema of a table with required and optional properties, and no others."""
    return {
        "type": "object",
        "properties": {**required, **optional},
        "required": list(required),
        "additionalProperties": False,
    }


def _target(name: str) -> _Schema:
    """Return the schema of a trim with one target."""
    value: _Schema = {"type": ["string", "number"]}
    return _table({name: {"anyOf": [value, _table({"value": value})]}}, {})


_COLUMN = _table({name: {"type": "string", "minLength": 1} for name in ("file", "column")})
_TRIM_SCHEMA: _Schema = {"anyOf": [{"const": "windmill"}, *map(_target, TrimSection.model_fields)]}
