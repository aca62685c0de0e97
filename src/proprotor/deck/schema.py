"""The JSON schema of decks, by which editors complete and check a TOML file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from proprotor.datum import STATUSES
from proprotor.deck.reading import BELOW_CRITICAL, FRACTION, NOT_NEGATIVE, POSITIVE, Bound
from proprotor.units import meaning

if TYPE_CHECKING:
    from proprotor.deck.fields import Reading

Schema = dict[str, Any]

_DIALECT = "http://json-schema.org/draft-07/schema#"  # the one that editors of TOML know
_NUMBER = r"^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?"
_PROVENANCE: Schema = {
    "status": {"enum": list(STATUSES), "description": "How well the number is known."},
    "source": {"type": "string", "description": "Where it was read, or how it was found."},
}
_LIMITS: dict[Bound, Schema] = {
    POSITIVE: {"exclusiveMinimum": 0},
    NOT_NEGATIVE: {"minimum": 0},
    FRACTION: {"minimum": 0, "maximum": 1},
    BELOW_CRITICAL: {"minimum": 0, "exclusiveMaximum": 1},
}
_NUMBERS: Schema = {"type": "array", "items": {"type": "number"}, "minItems": 2}
_STATIONS = {"distribution": "r_over_R", "along the blade": "r_over_R", "along the wing": "y_over_span"}


def deck_schema() -> Schema:
    """The JSON schema of a deck, draft 7.

    It knows every table and field, what kind of value each takes, and what must be given, which with `base` is nothing.
    It does not know units: that is for `proprotor.deck.sections.validate`, which is the judge.
    """
    from proprotor.deck.sections import Deck

    schema: Schema = Deck.model_json_schema(ref_template="#/definitions/{model}")
    definitions: Schema = schema.pop("$defs")
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


def _what_must_be_given(definitions: Schema, sections: list[str], kinds: list[Schema]) -> Schema:
    """Of a deck that stands alone; taken out of the definitions, where a deck with a base may leave it out."""
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


# Definitions whose fields a base may give, and the section of the deck; the airfoil's stands within the rotor's.
_TABLES = {
    "CaseSection": "case",
    "RotorSection": "rotor",
    "OperationSection": "operation",
    "AirfoilSection": "",
}


def value_schema(reading: Reading) -> Schema:
    """What a field that a `Reading` reads may be: a value, or a table with its provenance."""
    if reading.form == "distribution":
        return {"anyOf": [_distribution(reading), _with_beyond(_COLUMN, reading)]}
    if reading.form == "rising list":
        return _table({"value": _NUMBERS, "unit": {"type": "string"}})
    value = _value(reading)
    table = _table({"value": value})
    choices = [*value["anyOf"], table] if "anyOf" in value else [value, table]
    if reading.form == "curve":
        choices.append(_table({"value": _NUMBERS}))
    if reading.form in _STATIONS:
        choices.append(_distribution(reading))
    if reading.form == "along the blade":
        choices.append(_with_beyond(_COLUMN, reading))
    return {"anyOf": choices}


def _value(reading: Reading) -> Schema:
    if reading.form == "count":
        return {"type": "integer", "minimum": reading.least}
    if reading.form == "file":
        return {"type": "string", "minLength": 1}
    if reading.form == "choice":
        return {"enum": list(reading.choices)}
    text = {"type": "string", "pattern": _NUMBER, "description": _told(reading)}
    plain = {"type": "number", **_LIMITS.get(reading.bound, {})}
    dimensional = reading.unit and getattr(reading, "of_angle", reading.unit)
    return text if dimensional else {"anyOf": [text, plain]}


def _told(reading: Reading) -> str:
    rule = f"; {reading.bound.rule}" if reading.bound.rule else ""
    per_rev = ', or per revolution, "0.42/rev"' if reading.form == "frequency" else ""
    return f"{meaning(reading.unit)}{per_rev}{rule}"


def _distribution(reading: Reading) -> Schema:
    stations = {"type": "array", "items": {"type": "number", "minimum": 0, "maximum": 1}, "minItems": 2}
    table = _table({_STATIONS[reading.form]: stations, "value": _NUMBERS, "unit": {"type": "string"}})
    return _with_beyond(table, reading)


def _with_beyond(table: Schema, reading: Reading) -> Schema:
    """The table of a distribution, with what it may say of the blade beyond its stations."""
    if not reading.beyond:
        return table
    return table | {"properties": table["properties"] | {"beyond": {"const": reading.beyond}}}


def _table(properties: Schema) -> Schema:
    return {
        "type": "object",
        "properties": {**properties, **_PROVENANCE},
        "required": list(properties),
        "additionalProperties": False,
    }


_COLUMN = _table({name: {"type": "string", "minLength": 1} for name in ("file", "column")})

TRIM_SCHEMA: Schema = {
    "anyOf": [
        {"const": "windmill"},
        *(
            {
                "type": "object",
                "properties": {
                    target: {
                        "anyOf": [
                            {"type": ["string", "number"]},
                            _table({"value": {"type": ["string", "number"]}}),
                        ]
                    }
                },
                "required": [target],
                "additionalProperties": False,
            }
            for target in ("collective", "thrust_coefficient", "power_coefficient")
        ),
    ]
}
