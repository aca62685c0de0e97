"""Set single fields of a deck to other values before it is validated: ``rotor.precone = "1.5 deg"``."""

from __future__ import annotations

import difflib
import re
import tomllib
from collections.abc import Mapping
from typing import Any, Literal, get_origin

from proprotor.deck.alternatives import altered
from proprotor.deck.describe import deck_fields
from proprotor.deck.fields import Reading
from proprotor.deck.per_revolution import per_revolution_of
from proprotor.deck.sections import Deck, sections_at
from proprotor.errors import InputError, unknown_name

_STEP = re.compile(r"([^.\[\]]+)(?:\[([^\[\]]+)\])?(?:\.|$)")
_LONGEST_TITLE = 300  # characters of settings that a title repeats


class _Entry(str):
    """The name or number of an entry of a list."""


_Place = tuple[str, ...]


def with_settings(tables: Mapping[str, Any], settings: Mapping[str, str]) -> dict[str, Any]:
    """Return the tables of a deck with some fields set, as if the deck had these values.

    Parameters
    ----------
    tables : mapping
        Tables of a deck, see `proprotor.deck.file.read_tables`.
    settings : mapping of str to str
        Text by place: ``rotor.precone``, ``operation.trim``, ``support.modes[beam].frequency``, an entry of a list by
        its name. A number has its unit, as in a deck; any other TOML value is read as TOML, and the rest is text. A
        field replaces its alternatives, as a chord replaces a Lock number. Numbers get the status assumed, and the
        settings are added to the title. A frequency per revolution refers to the deck's own rotor speed, even if
        another rotor speed is set.

    Raises
    ------
    InputError
        For a place that no deck has, with the nearest place. `proprotor.deck.validation.validate` checks the values.
    """
    entries: list[tuple[_Place, Any]] = []
    changes: dict[str, Any] = {}
    for path, text in settings.items():
        place = _place(path, text)
        value = _value(text, place)
        if any(isinstance(part, _Entry) for part in place):
            entries.append((place, value))
        else:
            _put(changes, place, value)
    result = altered(dict(tables), changes)
    for place, value in entries:
        result = _replaced(result, place, value, "")
    return _titled(per_revolution_of(tables, result), settings)


def _place(path: str, text: str) -> _Place:
    """Return the names and entries of a path, one after the other."""
    steps = list(_STEP.finditer(path))
    if "".join(step[0] for step in steps) != path or path.endswith("."):
        raise InputError(path, text, "must be a field of a deck, such as rotor.precone")
    place: list[str] = []
    for step in steps:
        place.append(step[1].strip())
        if entry := (step[2] or "").strip():
            place.append(_Entry(entry))
    if not place or place[0] not in Deck.model_fields:
        raise InputError(path, text, _nearest(path))
    return tuple(place)


def _nearest(path: str) -> str:
    """Return the message for a field that is in no section of a deck, with the nearest field."""
    by_name = {field.path.rpartition(".")[2]: field.path for field in deck_fields()}
    close = difflib.get_close_matches(path.rpartition(".")[2].lower(), by_name, n=1)
    if "." not in path and close:
        return f"unknown field {path!r}; did you mean {by_name[close[0]]}?"
    return unknown_name(path.partition(".")[0], Deck.model_fields)


def _value(text: str, place: _Place) -> Any:
    """Return text as a TOML value if possible, with a provenance for a field that is a number."""
    field = _field([part for part in place if not isinstance(part, _Entry)])
    try:
        read = tomllib.loads(f"value = {text}")
        value = read["value"] if set(read) == {"value"} else text
    except (ValueError, RecursionError):
        value = text
    if field is None:
        return value
    is_text = field.annotation is str or get_origin(field.annotation) is Literal
    if is_text and not isinstance(value, str):
        return text
    is_number = any(isinstance(part, Reading) for part in field.metadata)
    if isinstance(value, dict) or not is_number:
        return value
    return {"value": value, "status": "assumed", "source": "set for this run"}


def _field(names: list[str]) -> Any:
    """Return the definition of a field, for [support] of the first kind that has it; None for an unknown field."""
    names = names[2:] if names[0] == "variants" and len(names) > 2 else names
    *outer, last = names[1:] if names[0] == "left" and len(names) > 1 else names
    sections = sections_at(tuple(outer)).values()
    return next((section.model_fields[last] for section in sections if last in section.model_fields), None)


def _put(changes: dict[str, Any], place: _Place, value: Any) -> None:
    """Put a value into nested tables."""
    *outer, last = place
    for name in outer:
        within = changes.setdefault(name, {})
        if not isinstance(within, dict) or "value" in within:
            raise InputError(".".join(place), None, f"must not be set together with {name} itself")
        changes = within
    if isinstance(changes.get(last), dict) and isinstance(value, dict):
        raise InputError(".".join(place), None, "must not be set twice")
    changes[last] = value


def _replaced(tables: Any, place: _Place, value: Any, path: str) -> Any:
    """Return nested tables and lists with one value replaced; the given ones do not change."""
    if not place:
        return value
    key, further = place[0], place[1:]
    if isinstance(key, _Entry):
        if not isinstance(tables, list):
            there = f"has no {path}" if tables is None else f"has no list at {path}"
            raise InputError(f"{path}[{key}]", None, f"is no entry of a list of this deck, which {there}")
        position = _position(tables, key, path)
        replaced = _replaced(tables[position], further, value, f"{path}[{key}]")
        return [*tables[:position], replaced, *tables[position + 1 :]]
    inner = f"{path}.{key}" if path else key
    if not isinstance(tables, dict):
        raise InputError(inner, None, "stands in no table of this deck")
    return tables | {key: _replaced(tables.get(key), further, value, inner)}


def _position(entries: list[Any], name: str, path: str) -> int:
    """Return the position of an entry in a list, by its name or by its number from 0."""
    names = [str(entry.get("name")) if isinstance(entry, dict) else "" for entry in entries]
    if name in names:
        return names.index(name)
    if name.isdecimal() and len(name) < 6 and int(name) < len(entries):
        return int(name)
    raise InputError(f"{path}[{name}]", None, unknown_name(name, names, "name"))


def _titled(tables: dict[str, Any], settings: Mapping[str, str]) -> dict[str, Any]:
    """Return the tables with the settings in the title, so that no result is mistaken for one of the deck itself."""
    case = tables.get("case")
    if not settings or "case.title" in settings or not isinstance(case, dict):
        return tables
    listed = ", ".join(f"{path} = {' '.join(text.split())}" for path, text in settings.items())
    listed = listed if len(listed) <= _LONGEST_TITLE else f"{len(settings)} fields set"
    title = case.get("title")
    return tables | {"case": case | {"title": f"{title} ({listed})"}} if isinstance(title, str) else tables
