"""Describe every field of a deck in words: meaning, values, range, default and alternatives.

The descriptions follow from the models of `proprotor.deck.sections`. `proprotor describe` prints them, and
docs/decks.md (`proprotor.deck.fields_page`) lists them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import MISSING, dataclass, fields
from functools import cache
from typing import Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from proprotor.control.control_loop import ControlLoop
from proprotor.deck import control_sections, support_sections
from proprotor.deck import sections as deck
from proprotor.deck.fields import AfterChoice, Reading, Section
from proprotor.deck.file import list_cases
from proprotor.deck.sections import LISTS, SUPPORT_KINDS, section_places, sections_at, sections_of
from proprotor.errors import InputError, list_choices, nearest_name
from proprotor.rotor.airfoil import Airfoil
from proprotor.rotor.airfoil_regions import AirfoilRegions
from proprotor.rotor.drive_train import DriveTrain
from proprotor.rotor.rotor import Rotor
from proprotor.support.aircraft_airloads import Tail
from proprotor.support.aircraft_structure import CarryThrough, Fuselage
from proprotor.support.beam_wing import Pylon, Wing
from proprotor.support.wing_aerodynamics import WingAerodynamics
from proprotor.units import meaning

_ALONG = {
    "along the blade": "one value, { r_over_R = [...], value = [...], unit = ... }, or { file = ..., column = ... }",
    "distribution": "{ r_over_R = [...], value = [...], unit = ... } or { file = ..., column = ... }",
    "curve": "one value, or { value = [...] }",
    "along the wing": "one value, or { y_over_span = [...], value = [...], unit = ... }",
}
_FORMS = {
    "count": "a whole number",
    "file": "the name of a file",
    "files": "the name of a file, or a list of names",
    "rising list": "{ value = [...], unit = ... }",
}
_NAMED = {
    **{place: f"{place}[NAME]" for place in LISTS},
    "variants": "variants.NAME",
}  # sections of which there are several
_PLAIN = {bool: "true or false", str: "text"}
# Forms of fields that are no numbers, by their possible values.
_PLAIN_FORMS = {
    "true or false": "bool",
    "a list of texts": "list",
    "a table of texts": "table",
    "a table of fields": "fields",
}


@dataclass(frozen=True)
class DeckField:
    """One field of a deck.

    Attributes
    ----------
    path : str
        ``rotor.precone``; ``support.modes[NAME].x`` for an entry of a list.
    kind : str
        Kind of support that has the field; "" for other sections.
    meaning, takes : str
        The meaning, and the possible values.
    unit : str
        SI unit, "" for a field without a unit.
    range : str
        "" if any value is allowed.
    required : bool
        Whether a deck must give the field or one of its alternatives.
    default : str
        The value of a field that is left out, as a deck would have it; "" without a default, or with one that the
        meaning states.
    instead_of : tuple of str
        Fields that this field replaces.
    form : str
        Form of a value: of `proprotor.deck.fields.Reading`, or "bool", "list", "table" or "".
    """

    path: str
    kind: str
    meaning: str
    takes: str
    unit: str
    range: str
    required: bool
    default: str
    instead_of: tuple[str, ...]
    form: str


@cache
def deck_fields() -> tuple[DeckField, ...]:
    """Return every field of every section, in the order of a deck; the fields of [support] kind by kind."""
    return tuple(
        field
        for place in section_places()
        for kind, section in sections_at(place).items()
        for field in _of_section(section, ".".join(place), kind)
    )


def find_fields(path: str) -> tuple[DeckField, ...]:
    """Return the fields at or below a path; for [support] the fields of every kind.

    Raises
    ------
    InputError
        For a path that no deck has, with the nearest path.
    """
    wanted = plain_path(path.strip())
    here: tuple[Callable[[DeckField], bool], ...] = (
        lambda field: plain_path(field.path) == wanted,
        lambda field: plain_path(field.path).startswith(f"{wanted}."),
        lambda field: field.kind == wanted,
        lambda field: field.path.rpartition(".")[2] == wanted,
    )
    for matches in here:
        if found := tuple(field for field in deck_fields() if matches(field)):
            return found
    raise InputError("FIELD", path, f"unknown field {path.strip()!r}; {_hint(wanted)}")


def _hint(wanted: str) -> str:
    """Return a hint at the nearest field, by its whole path or its last name, kind of support or bundled deck."""
    known = [plain_path(field.path) for field in deck_fields()]
    names = {path if "." in wanted else path.rpartition(".")[2]: path for path in known}
    names |= {name: name for name in (*SUPPORT_KINDS, *list_cases())}
    nearest = nearest_name(wanted, names)
    return f"did you mean {names[nearest]}?" if nearest else "`proprotor describe` lists them"


def plain_path(path: str) -> str:
    """Return a path without the names of entries of lists and of variants."""
    plain = "".join(part.partition("]")[2] if "]" in part else part for part in path.split("["))
    first, _, rest = plain.partition(".")
    return f"variants.{rest.partition('.')[2]}" if first == "variants" and "." in rest else plain


def _of_section(section: type[Section], place: str, kind: str) -> Iterator[DeckField]:
    """Yield the fields of a section at a place of the deck."""
    for name, field in section.model_fields.items():
        number = next((part for part in field.metadata if isinstance(part, Reading)), None)
        takes = _takes_plain(field.annotation) if number is None else _takes(number)
        if not takes:  # a section
            continue
        reading = number or Reading(_PLAIN_FORMS.get(takes, ""))
        is_one_side = any(name in side for choice in section.alternatives for side in choice)
        yield DeckField(
            path=f"{_NAMED.get(place, place)}.{name}",
            kind=kind,
            meaning=field.description or "",
            takes=takes,
            unit=_unit(reading),
            range=f"{reading.least} or more" if reading.form == "count" else reading.bound.range,
            required=field.is_required() or (is_one_side and name not in section.may_lack),
            default=_default(field, reading, defaults_of(section).get(name, MISSING)),
            instead_of=_instead_of(section, name),
            form=reading.form,
        )


def _takes(reading: Reading) -> str:
    """Return the possible values of a field that is a number, in words."""
    if reading.form in _FORMS:
        return _FORMS[reading.form]
    if reading.form == "choice":
        return list_choices(reading.choices)
    if reading.form == "joint":
        return f"{list_choices(reading.choices)}, or {meaning(reading.unit)}"
    values = meaning(reading.unit)
    if isinstance(reading, AfterChoice):
        values = f"of a length {values}; of an angle {meaning(reading.other_unit)}"
    if reading.form == "tangent":
        values += ', or the angle of which it is the tangent, "-15 deg"'
    if reading.form == "frequency":
        values += ', or "0.42/rev"'
    if reading.form == "curve" and reading.unit:
        return f"{values}; {_ALONG['curve'].replace(' }', ', unit = ... }')}"
    return f"{values}; {_ALONG[reading.form]}" if reading.form in _ALONG else values


def _takes_plain(annotation: Any) -> str:
    """Return the possible values of a field that is no number; "" for a section."""
    if annotation in _PLAIN:
        return _PLAIN[annotation]
    if str in get_args(annotation) and any(get_origin(part) is list for part in get_args(annotation)):
        return "text, or a list of texts"
    if get_origin(annotation) is Literal:
        return list_choices(get_args(annotation))
    if sections_of(annotation):
        return '"windmill", or a table with one of the fields below' if str in get_args(annotation) else ""
    if get_origin(annotation) is list:
        return "a list of texts"
    return "a table of fields" if dict[str, Any] in get_args(annotation) else "a table of texts"


def _unit(reading: Reading) -> str:
    """Return the SI unit, or both units of a field with two."""
    if isinstance(reading, AfterChoice):
        return f"{reading.unit or '1'} or {reading.other_unit or '1'}"
    return reading.unit


def _instead_of(section: type[Section], name: str) -> tuple[str, ...]:
    """Return the fields on the other sides of the choices that a field belongs to."""
    return tuple(
        other
        for choice in section.alternatives
        for side in choice
        if name not in side and any(name in own for own in choice)
        for other in side
    )


@cache
def defaults_of(section: type[Section]) -> dict[str, Any]:
    """Return the SI values of fields that a deck leaves out, by field, as far as the section or its class has them."""
    described: dict[type[Section], tuple[type, ...]] = {
        deck.RotorSection: (Rotor,),
        deck.AirfoilSection: (Airfoil, AirfoilRegions),
        deck.DriveTrainSection: (DriveTrain,),
        control_sections.ControlLoopSection: (ControlLoop,),
        support_sections.BeamWingSection: (Wing, Pylon),
        support_sections.AircraftSection: (Wing, Pylon),
        support_sections.FuselageSection: (Fuselage,),
        support_sections.CarryThroughSection: (CarryThrough,),
        support_sections.TailSection: (Tail,),
        support_sections.WingAerodynamicsSection: (WingAerodynamics,),
        support_sections.AssumedShapeSection: (WingAerodynamics,),
    }
    of_class = {entry.name: entry.default for kind in described.get(section, ()) for entry in fields(kind)}
    return of_class | dict(section.defaults)


def _default(field: FieldInfo, reading: Reading, constructed: Any) -> str:
    """Return the default of a field as a deck would have it; "" without one."""
    if field.is_required():
        return ""
    if isinstance(constructed, int | float) and not isinstance(constructed, bool):
        unit = "" if isinstance(reading, AfterChoice) else reading.unit
        return f"{constructed:g} {unit}".strip()
    is_word = isinstance(field.default, bool | str) and field.default != ""
    return list_choices((field.default,)) if is_word else ""


def field_lines(field: DeckField) -> Iterator[tuple[str, str]]:
    """Yield label and text of each property of a field."""
    others = ", ".join(field.instead_of)
    texts = {
        "means": field.meaning,
        "of": f'[support] of kind "{field.kind}"' if field.kind else "",
        "takes": field.takes,
        "SI unit": field.unit,
        "range": field.range,
        "default": field.default,
        "instead of": others,
        "needed": ", or ".join(filter(None, ("yes", others))) if field.required else "no",
    }
    yield from ((label, text) for label, text in texts.items() if text)
