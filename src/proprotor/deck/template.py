"""Write a deck as commented text: every field with its meaning, fields left out as comments with an example."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from proprotor.deck.describe import DeckField, deck_fields
from proprotor.deck.per_revolution import as_one_file
from proprotor.deck.sections import LISTS, section_places
from proprotor.deck.written import FileName
from proprotor.units import meaning

_HEAD = """\
# A deck of proprotor{origin}. Every number with a dimension has its unit, US or SI:
#   radius = "12.5 ft"
# or is a table that also names the source, which results then repeat:
#   radius = {{ value = "12.5 ft", status = "published", source = "report, table" }}
# with a status of published, measured, derived, recalled, calibrated or assumed; default_status in [case] is the status
# of every number of this file that states none.
#
#   proprotor describe rotor.precone        what a field is
#   proprotor flutter {file}
#   proprotor sweep {file} --speed 50:400:5kt --plot damping.png
"""
_EXAMPLE = re.compile(r'such as ("[^"]*"|\S+?)(?:,| or|$)')
_EXAMPLES = {
    "": '""',
    "list": "[]",
    "bool": "true",
    "count": "4",
    "file": '"name-of-file"',
    "files": '"name-of-file"',
    "rising list": '{ value = [0, 20, 40], unit = "deg" }',
    "curve": "{ value = [1.9, 1.8, 1.7] }",
    "table": '{ x = "hub_x" }',
}
_EXAMPLES_OF_FIELDS = {
    "rotor.airfoil.lift_slope": '"5.7/rad"',
    "rotor.airfoil.region_ends": "{ value = [0.55, 0.80] }",
    "left.rotor": '{ control_stiffness = "8000 ft*lbf/rad" }',
    "left.operation": '{ trim = { collective = "30 deg" } }',
    "left.drive_train": '{ drive_damping = "100 N*m*s/rad" }',
    "left.support": "{ downstop = false }",
    "envelope.dive_mach": "0.6",
    "envelope.altitudes": '{ value = [0, 10000, 20000], unit = "ft" }',
    "envelope.speed_factor": "1.2",
    "envelope.failure_speed_factor": "1.0",
    "envelope.damping_ratio": "0.015",
    "envelope.rotor_speeds": '{ value = [458, 500], unit = "rpm" }',
    "envelope.powers": '{ value = [0, 900], unit = "hp" }',
    "variants.NAME.rotor": '{ control_stiffness = "8000 ft*lbf/rad" }',
    "variants.NAME.operation": '{ rotor_speed = "500 rpm" }',
    "variants.NAME.drive_train": '{ drive_damping = "100 N*m*s/rad" }',
    "variants.NAME.support": "{ downstop = false }",
    "variants.NAME.left": '{ rotor = { control_stiffness = "8000 ft*lbf/rad" } }',
}
_COLUMNS = 13  # numbers of a list in one line


def deck_text(
    tables: Mapping[str, Any], file: str | os.PathLike[str], base: str = "", variant: bool = False
) -> str:
    """Return the text of a deck with every possible field.

    Parameters
    ----------
    tables : mapping
        Tables of a valid deck, see `proprotor.deck.file.read_tables`.
    file : str or path
        Place of the new deck: names of files start from its folder, and the case takes its name.
    base : str
        Name of the deck that the tables belong to, for the head of the file.
    variant : bool
        Whether to write a variant of the base: the fields of the base are comments, to be activated where they change.
    """
    place = Path(file)
    tables = tables if variant else as_one_file(dict(tables))
    parts = [_HEAD.format(origin=f", made from {base}" if base else "", file=place.name)]
    if variant:
        parts.append(f"# A variant: each field replaces the same field of the base.\nbase = {toml(base)}\n")
    for section in map(".".join, section_places()):
        if section not in ("operation.trim", *LISTS, "variants"):  # the trim is a value, the others follow
            parts.append("\n".join(_section(section, tables, place, variant)))
    for name, given in tables.get("variants", {}).items():
        parts.append("\n".join(_variant(name, given, place, variant)))
    for listed in LISTS:
        outer, _, inner = listed.partition(".")
        entries = tables.get(outer, {}).get(inner)
        for entry in entries if isinstance(entries, list) else ():
            parts.append("\n".join(_of_list(listed, entry, place, variant)))
    return "\n".join(f"{part.rstrip()}\n" for part in parts if part)


def case_name(file: str | os.PathLike[str]) -> str:
    """Return the name of a case after its file."""
    name = re.sub(r"[^A-Za-z0-9 _.-]", "_", Path(file).name.removesuffix(".toml")).lstrip(" _.-")
    return name[:60] or "case"


def example(field: DeckField) -> str:
    """Return an example of a field as TOML: the default if it has one."""
    if field.default:
        return field.default if field.default[0] == '"' or " " not in field.default else f'"{field.default}"'
    if field.form == "distribution":
        unit = _first_example(field.unit).strip('"').partition(" ")[2]
        return f'{{ r_over_R = [0, 1], value = [0.3, 0.2], unit = "{unit}" }}'
    if field.path in _EXAMPLES_OF_FIELDS:
        return _EXAMPLES_OF_FIELDS[field.path]
    if field.form in ("choice", "joint"):
        return field.takes.partition(" or ")[0]
    unit = field.unit.partition(" or ")[0]
    return _EXAMPLES.get(field.form) or _first_example("" if unit == "1" else unit)


def _first_example(unit: str) -> str:
    """Return the first example of a value in a unit that messages give."""
    found = _EXAMPLE.search(meaning(unit))
    return found[1] if found else "0"


def _section(section: str, tables: Mapping[str, Any], place: Path, variant: bool) -> Iterator[str]:
    """Yield the lines of a section."""
    given: Any = tables
    for name in section.split("."):
        given = given.get(name) if isinstance(given, Mapping) else None
    kind = tables["support"]["kind"] if section.startswith("support") else ""
    own = [f for f in deck_fields() if f.path.rpartition(".")[0] == section and f.kind == kind]
    if not own:
        return
    entries = given if isinstance(given, Mapping) else {}
    mark = "# " if given is None or (variant and section == "support.wing_aerodynamics") else ""
    yield f"{mark}[{section}]"
    for field in own:
        name = _name(field)
        if section == "case" and name == "name":
            yield from _entry(field, toml(case_name(place)), "")
        elif name in entries:
            keep = not variant or (section, name) == ("case", "title")
            yield from _entry(field, toml(_from(entries[name], place)), "" if keep else "# ")
        elif not (variant or name == "warnings"):
            yield from _entry(field, example(field), "# ")


def _variant(name: str, given: Mapping[str, Any], place: Path, variant: bool) -> Iterator[str]:
    """Yield the lines of one variant of the deck."""
    mark = "# " if variant else ""
    yield f"{mark}[variants.{toml(name)}]"
    for field in deck_fields():
        if field.path.startswith("variants.NAME.") and _name(field) in given:
            yield from _entry(field, toml(_from(given[_name(field)], place)), mark)


def _of_list(listed: str, entry: Mapping[str, Any], place: Path, variant: bool) -> Iterator[str]:
    """Yield the lines of one entry of a list: of a normal mode of a support, or of a control loop."""
    mark = "# " if variant else ""
    yield f"{mark}[[{listed}]]"
    for field in deck_fields():
        if field.path.startswith(f"{listed}[NAME].") and _name(field) in entry:
            yield from _entry(field, toml(_from(entry[_name(field)], place)), mark)


def _entry(field: DeckField, text: str, mark: str) -> Iterator[str]:
    """Yield the lines of a field: its meaning, and its value as TOML behind a mark."""
    yield f"# {_comment(field)}"
    yield "\n".join(f"{mark}{line}" for line in f"{_name(field)} = {text}".split("\n"))


def _name(field: DeckField) -> str:
    return field.path.rpartition(".")[2]


def _comment(field: DeckField) -> str:
    """Return meaning, range, default and alternatives of a field."""
    texts = {"": field.range, "default ": field.default, "instead of ": ", ".join(field.instead_of)}
    return "; ".join([field.meaning.rstrip("."), *(label + text for label, text in texts.items() if text)])


def _from(value: Any, place: Path) -> Any:
    """Return a value in which names of files start from the folder of the new deck."""
    if isinstance(value, FileName):
        return os.path.relpath(value.folder / value, place.parent).replace(os.sep, "/")
    if isinstance(value, Mapping):
        return {key: _from(entry, place) for key, entry in value.items()}
    if isinstance(value, list):
        return [_from(entry, place) for entry in value]
    return value


def toml(value: Any) -> str:
    """Return a value as TOML."""
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
    """Return a list as TOML, a long list over several lines."""
    texts = [toml(value) for value in values]
    if len(texts) <= _COLUMNS and not any(isinstance(value, str) for value in values):
        return f"[{', '.join(texts)}]"
    step = 1 if isinstance(values[0], str) else _COLUMNS
    rows = (", ".join(texts[start : start + step]) for start in range(0, len(texts), step))
    return "[\n" + "".join(f"    {row},\n" for row in rows) + "]"
