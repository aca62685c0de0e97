"""A deck as commented text: every field with its meaning, those left out as comments with an example."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from proprotor.deck.describe import DeckField, deck_fields
from proprotor.deck.per_revolution import as_one_file
from proprotor.deck.written import FileName
from proprotor.units import meaning

_HEAD = """\
# A deck of proprotor{origin}. Every number with a dimension carries its unit, US or SI as you like:
#   radius = "12.5 ft"
# or says as well where it comes from, which results then repeat:
#   radius = {{ value = "12.5 ft", status = "published", source = "report, table" }}
# with a status of published, derived, recalled, calibrated or assumed.
#
#   proprotor describe rotor.precone        what a field is
#   proprotor flutter {file}
#   proprotor sweep {file} --speed 50:400:5kt --plot damping.png
"""
_SECTIONS = (
    "case",
    "rotor",
    "rotor.airfoil",
    "rotor.frequencies",
    "operation",
    "drive_train",
    "support",
    "support.wing_aerodynamics",
)
_EXAMPLE = re.compile(r'such as ("[^"]*"|\S+?)(?:,| or|$)')
_COLUMNS = 13  # of a list of numbers


def deck_text(
    tables: Mapping[str, Any], file: str | os.PathLike[str], base: str = "", variant: bool = False
) -> str:
    """A deck with every field that there is.

    Parameters
    ----------
    tables : mapping
        Of a valid deck, see `proprotor.deck.file.read_tables`.
    file : str or path
        Where the deck will stand: names of files start from there, and the case takes its name.
    base : str
        The deck that these tables are of, for the head of the file.
    variant : bool
        Only what differs from the base: its fields are comments, to be taken in where they change.
    """
    place = Path(file)
    tables = tables if variant else as_one_file(dict(tables))
    parts = [_HEAD.format(origin=f", made from {base}" if base else "", file=place.name)]
    if variant:
        parts.append(f"# A variant: what stands here replaces what the base has.\nbase = {toml(base)}\n")
    for section in _SECTIONS:
        parts.append("\n".join(_section(section, tables, place, variant)))
    modes = tables.get("support", {}).get("modes")
    for mode in modes if isinstance(modes, list) else ():
        parts.append("\n".join(_mode(mode, place, variant)))
    return "\n".join(f"{part.rstrip()}\n" for part in parts if part)


def case_name(file: str | os.PathLike[str]) -> str:
    """The name of a case after its file."""
    name = re.sub(r"[^A-Za-z0-9 _.-]", "_", Path(file).name.removesuffix(".toml")).lstrip(" _.-")
    return name[:60] or "case"


def example(field: DeckField) -> str:
    """A value of a field as TOML has it: its default where it has one."""
    if field.default:
        return field.default if field.default[0] == '"' or " " not in field.default else f'"{field.default}"'
    if field.form == "distribution":
        unit = _first_example(field.unit).strip('"').partition(" ")[2]
        return f'{{ r_over_R = [0, 1], value = [0.3, 0.2], unit = "{unit}" }}'
    if field.form == "choice":
        return field.takes.partition(" or ")[0]
    unit = field.unit.partition(" or ")[0]
    return _EXAMPLES.get(field.form) or _first_example("" if unit == "1" else unit)


_EXAMPLES = {
    "": '""',
    "list": "[]",
    "bool": "true",
    "count": "4",
    "file": '"name-of-file"',
    "rising list": '{ value = [0, 20, 40], unit = "deg" }',
    "curve": "{ value = [1.9, 1.8, 1.7] }",
    "table": '{ x = "hub_x" }',
}


def _first_example(unit: str) -> str:
    """Of a value in a unit, as messages give it."""
    found = _EXAMPLE.search(meaning(unit))
    return found[1] if found else "0"


def _section(section: str, tables: Mapping[str, Any], place: Path, variant: bool) -> Iterator[str]:
    given: Any = tables
    for name in section.split("."):
        given = given.get(name) if isinstance(given, Mapping) else None
    kind = tables["support"]["kind"] if section.startswith("support") else ""
    own = [field for field in deck_fields() if _is_in(field, section, kind)]
    if not own:
        return
    absent = given is None
    mark = "# " if absent or (variant and section == "support.wing_aerodynamics") else ""
    yield f"{mark}[{section}]"
    for field in own:
        name = field.path.rpartition(".")[2]
        if section == "case" and name == "name":
            yield from _given(field, name, case_name(place), place, "")
        elif isinstance(given, Mapping) and name in given and not _is_list_of_tables(given[name]):
            keep = not variant or (section, name) in (("case", "title"),)
            yield from _given(field, name, given[name], place, "" if keep else "# ")
        elif (
            not variant
            and not (isinstance(given, Mapping) and name in given)
            and not field.path.endswith("warnings")
        ):
            yield from _left_out(field, name)


def _is_in(field: DeckField, section: str, kind: str) -> bool:
    return field.path.rpartition(".")[0] == section and field.kind == kind


def _is_list_of_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], Mapping)


def _mode(mode: Mapping[str, Any], place: Path, variant: bool) -> Iterator[str]:
    mark = "# " if variant else ""
    yield f"{mark}[[support.modes]]"
    for field in deck_fields():
        prefix, _, name = field.path.rpartition(".")
        if prefix == "support.modes[NAME]" and name in mode:
            yield from _given(field, name, mode[name], place, mark)


def _given(field: DeckField, name: str, value: Any, place: Path, mark: str) -> Iterator[str]:
    yield f"# {_told(field)}"
    yield "\n".join(f"{mark}{line}" for line in f"{name} = {toml(_from(value, place))}".split("\n"))


def _left_out(field: DeckField, name: str) -> Iterator[str]:
    yield f"# {_told(field)}"
    yield f"# {name} = {example(field)}"


def _told(field: DeckField) -> str:
    parts = [field.meaning.rstrip(".")]
    if field.range:
        parts.append(field.range)
    if field.default:
        parts.append(f"default {field.default}")
    if field.instead_of:
        parts.append(f"instead of {', '.join(field.instead_of)}")
    return "; ".join(parts)


def _from(value: Any, place: Path) -> Any:
    """A value whose names of files start from the folder of the new deck."""
    if isinstance(value, FileName):
        return os.path.relpath(value.folder / value, place.parent).replace(os.sep, "/")
    if isinstance(value, Mapping):
        return {key: _from(entry, place) for key, entry in value.items()}
    return value


def toml(value: Any) -> str:
    """A value as TOML has it."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(str(value), ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{key} = {toml(entry)}' for key, entry in value.items())} }}"
    if isinstance(value, list):
        return _list(value)
    return repr(value)


def _list(values: list[Any]) -> str:
    texts = [toml(value) for value in values]
    if len(texts) <= _COLUMNS and not any(isinstance(value, str) for value in values):
        return f"[{', '.join(texts)}]"
    step = 1 if isinstance(values[0], str) else _COLUMNS
    rows = (", ".join(texts[start : start + step]) for start in range(0, len(texts), step))
    return "[\n" + "".join(f"    {row},\n" for row in rows) + "]"
