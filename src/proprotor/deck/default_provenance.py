"""Give the numbers of one file the status and source that the file states for all of its numbers.

A default belongs to the file in which it is written: neither the base of a deck nor a variant of it takes it over, so
that a number never gets a status that nobody stated about it.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from proprotor.datum import STATUSES, UNSTATED
from proprotor.errors import InputError

DEFAULT_STATUS, DEFAULT_SOURCE = "default_status", "default_source"


def with_default_provenance(tables: dict[str, Any]) -> dict[str, Any]:
    """Return the tables of a file in which every number has a status, if the file states one for all numbers.

    A number with a status of its own stays as it is. A number with a source but no status keeps its source.

    Parameters
    ----------
    tables : dict
        Tables of one TOML file, before they are merged into those of a base; ``[left]`` nested.

    Returns
    -------
    dict
        The tables without ``case.default_status`` and ``case.default_source``.

    Raises
    ------
    InputError
        For a status that does not exist, a source that is no text, and a source without a status.
    """
    case = tables.get("case")
    if not isinstance(case, dict) or case.keys().isdisjoint((DEFAULT_STATUS, DEFAULT_SOURCE)):
        return tables
    provenance = _checked(case)
    rest = {name: entry for name, entry in case.items() if name not in (DEFAULT_STATUS, DEFAULT_SOURCE)}
    kind = tables["support"].get("kind") if isinstance(tables.get("support"), dict) else None
    tables = tables | {"case": rest}
    return _stated(tables, (), kind, provenance) if provenance else tables


def _checked(case: Mapping[str, Any]) -> dict[str, str]:
    """Return status and source of all numbers of a file."""
    status, source = case.get(DEFAULT_STATUS, UNSTATED), case.get(DEFAULT_SOURCE, "")
    if status not in (UNSTATED, *STATUSES):
        raise InputError(f"case.{DEFAULT_STATUS}", status, f"must be one of {', '.join(STATUSES)}")
    if not isinstance(source, str):
        raise InputError(f"case.{DEFAULT_SOURCE}", source, "must be text")
    if status == UNSTATED and source:
        raise InputError(f"case.{DEFAULT_SOURCE}", source, f"must be given with {DEFAULT_STATUS}")
    return {
        name: text for name, text in (("status", status), ("source", source)) if text not in ("", UNSTATED)
    }


def _stated(
    tables: dict[str, Any], place: tuple[str, ...], kind: Any, provenance: Mapping[str, str]
) -> dict[str, Any]:
    """Return the tables at a place of a deck with the provenance of every number, the sections inside included."""
    result = {}
    for name, entry in tables.items():
        is_deck = (not place and name == "left") or place == ("variants",)  # tables of a whole deck
        inner = () if is_deck else (*place, name)
        if _is_number(place, name, kind, entry):
            result[name] = _with_status(entry, provenance)
        elif isinstance(entry, dict):
            result[name] = _stated(entry, inner, kind, provenance)
        elif isinstance(entry, list):
            result[name] = [_stated(e, inner, kind, provenance) if isinstance(e, dict) else e for e in entry]
        else:
            result[name] = entry
    return result


def _is_number(place: tuple[str, ...], name: str, kind: Any, entry: Any) -> bool:
    """Return whether a field is a number, in any kind of support if the file names none; a list of tables is none."""
    from proprotor.deck.sections import is_number_of, sections_at  # here, because pydantic is slow to import

    known = sections_at(place)
    sections = [known[kind]] if kind in known else known.values()
    of_tables = isinstance(entry, list) and any(isinstance(one, dict) for one in entry)
    return not of_tables and any(is_number_of(section, name) for section in sections)


def _with_status(entry: Any, provenance: Mapping[str, str]) -> Any:
    """Return a number as a table with its status."""
    table = entry if isinstance(entry, dict) else {"value": entry}
    return table if "status" in table else {**provenance, **table}
