"""Every field of a deck in words: what it means, what it takes, its range, its default and its alternatives.

All of it is read from the models of `proprotor.deck.sections`. `proprotor describe` prints it, docs/decks.md holds it.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterator
from dataclasses import MISSING, asdict, dataclass, fields
from functools import cache
from typing import TYPE_CHECKING, Any, Literal, get_args, get_origin

from proprotor.deck.reading import BELOW_CRITICAL, FRACTION, NOT_NEGATIVE, POSITIVE, Bound
from proprotor.errors import InputError, list_choices
from proprotor.units import meaning

if TYPE_CHECKING:
    from pydantic.fields import FieldInfo

    from proprotor.deck.fields import Reading, Section

_RANGES: dict[Bound, str] = {
    POSITIVE: "above 0",
    NOT_NEGATIVE: "0 or more",
    FRACTION: "0 to 1",
    BELOW_CRITICAL: "0 to below 1",
}
_ALONG = {
    "along the blade": "one value, { r_over_R = [...], value = [...], unit = ... }, or { file = ..., column = ... }",
    "distribution": "{ r_over_R = [...], value = [...], unit = ... } or { file = ..., column = ... }",
    "curve": "one value, or { value = [...] }",
    "along the wing": "one value, or { y_over_span = [...], value = [...], unit = ... }",
}
_PLAIN = {bool: "true or false", str: "text"}


@dataclass(frozen=True)
class DeckField:
    """One field of a deck.

    Attributes
    ----------
    path : str
        ``rotor.precone``; ``support.modes[NAME].x`` for an entry of a list.
    kind : str
        Kind of support that has it; "" for the other sections.
    meaning, takes : str
        What it is, and what its value may be.
    unit : str
        SI unit, "" for what has none.
    range : str
        "" where any value will do.
    required : bool
        Whether it must be given, by itself or in place of its alternatives.
    default : str
        What holds where it is left out, as a deck would have it; "" where nothing does, or the meaning says it.
    instead_of : tuple of str
        Fields it takes the place of.
    form : str
        How a value is read: that of `proprotor.deck.fields.Reading`, or "bool", "list", "table" or "".
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
    """Every field of every section, in the order of a deck; of [support] kind by kind."""
    return tuple(_fields())


def find_fields(path: str) -> tuple[DeckField, ...]:
    """The fields at or below a path; of [support] those of every kind.

    Raises
    ------
    InputError
        For a path that no deck has, with the nearest one.
    """
    wanted = _plain(path.strip())
    here: tuple[Callable[[DeckField], bool], ...] = (
        lambda field: _plain(field.path) == wanted,
        lambda field: _plain(field.path).startswith(f"{wanted}."),
        lambda field: field.kind == wanted,
        lambda field: field.path.rpartition(".")[2] == wanted,
    )
    for matches in here:
        if found := tuple(field for field in deck_fields() if matches(field)):
            return found
    raise InputError("FIELD", path, f"unknown field {path.strip()!r}; {_hint(wanted)}")


def _hint(wanted: str) -> str:
    """The nearest field, by its whole path or its last name."""
    known = {_plain(field.path): _plain(field.path) for field in deck_fields()}
    by_last_name = {path.rpartition(".")[2]: path for path in known}
    names = known if "." in wanted else by_last_name
    nearest = difflib.get_close_matches(wanted.lower(), names, n=1)
    return f"did you mean {names[nearest[0]]}?" if nearest else "`proprotor describe` lists them"


def _plain(path: str) -> str:
    """A path without the names of entries of lists."""
    return "".join(part.partition("]")[2] if "]" in part else part for part in path.split("["))


def _fields() -> Iterator[DeckField]:
    from proprotor.deck.sections import section_places, sections_at

    for place in section_places():
        if not place:
            continue
        for kind, section in sections_at(place).items():
            prefix = ".".join(place).replace("support.modes", "support.modes[NAME]")
            yield from _of_section(section, prefix, kind)


def _of_section(section: type[Section], prefix: str, kind: str) -> Iterator[DeckField]:
    defaults = _defaults(section)
    for name, field in section.model_fields.items():
        reading = _reading(field)
        takes = _takes(field, reading)
        if not takes:  # a section of its own
            continue
        others = _instead_of(section, name)
        yield DeckField(
            path=f"{prefix}.{name}",
            kind=kind,
            meaning=field.description or "",
            takes=takes,
            unit="" if reading is None else _unit(reading),
            range="" if reading is None else _range(reading),
            required=field.is_required() or name in section.needed_unless_replaced,
            default=_default(field, reading, defaults.get(name, MISSING)),
            instead_of=others,
            form=_form(field) if reading is None else reading.form,
        )


def _reading(field: FieldInfo) -> Reading | None:
    from proprotor.deck.fields import Reading

    return next((part for part in field.metadata if isinstance(part, Reading)), None)


def _takes(field: FieldInfo, reading: Reading | None) -> str:
    """What a value may be; "" for a section of its own."""
    if reading is None:
        return _takes_plain(field.annotation)
    if reading.form == "count":
        return "a whole number"
    if reading.form == "file":
        return "the name of a file"
    if reading.form == "choice":
        return list_choices(reading.choices)
    by_angle = getattr(reading, "of_angle", None)
    if reading.form == "rising list":
        return "{ value = [...], unit = ... }"
    told = meaning(reading.unit)
    if by_angle is not None:
        told = f"of a length {told}; of an angle {meaning(by_angle)}"
    if reading.form == "frequency":
        told += ', or "0.42/rev"'
    return f"{told}; {_ALONG[reading.form]}" if reading.form in _ALONG else told


def _takes_plain(annotation: Any) -> str:
    if annotation in _PLAIN:
        return _PLAIN[annotation]
    if get_origin(annotation) is Literal:
        return " or ".join(f'"{choice}"' for choice in get_args(annotation))
    if (
        get_origin(annotation) is list
        and get_args(annotation)[0] is not str
        and not _is_text_list(annotation)
    ):
        return ""
    if get_origin(annotation) is list:
        return "a list of texts"
    if any(get_origin(choice) is dict for choice in get_args(annotation)):
        return "a table of texts"
    return "" if annotation is not Any else '"windmill", or a table with one of the fields below'


def _form(field: FieldInfo) -> str:
    if field.annotation is bool:
        return "bool"
    if get_origin(field.annotation) is list:
        return "list"
    is_table = any(get_origin(choice) is dict for choice in get_args(field.annotation))
    return "table" if is_table else ""


def _is_text_list(annotation: Any) -> bool:
    inner = get_args(annotation)[0]
    return inner is str or (get_args(inner) or (None,))[0] is str


def _unit(reading: Reading) -> str:
    if of_speed := getattr(reading, "of_speed", ""):
        return f"{reading.unit} or {of_speed}"
    by_angle = getattr(reading, "of_angle", None)
    return reading.unit if by_angle is None else f"{reading.unit or '1'} or {by_angle or '1'}"


def _range(reading: Reading) -> str:
    return f"{reading.least} or more" if reading.form == "count" else _RANGES.get(reading.bound, "")


def _instead_of(section: type[Section], name: str) -> tuple[str, ...]:
    return tuple(
        other
        for choice in section.alternatives
        for side in choice
        if name not in side and any(name in own for own in choice)
        for other in side
    )


@cache
def _defaults(section: type[Section]) -> dict[str, Any]:
    """What the class that a section describes takes where a field is left out."""
    from proprotor.deck import sections as deck
    from proprotor.deck import support_sections
    from proprotor.rotor.airfoil import Airfoil
    from proprotor.rotor.drive_train import DriveTrain
    from proprotor.rotor.rotor import Rotor
    from proprotor.support.beam_wing import Pylon, Wing
    from proprotor.support.wing_aerodynamics import WingAerodynamics

    described: dict[type[Section], tuple[type, ...]] = {
        deck.RotorSection: (Rotor,),
        deck.AirfoilSection: (Airfoil,),
        deck.DriveTrainSection: (DriveTrain,),
        support_sections.BeamWingSection: (Wing, Pylon),
        support_sections.WingAerodynamicsSection: (WingAerodynamics,),
        support_sections.AssumedShapeSection: (WingAerodynamics,),
    }
    return {entry.name: entry.default for kind in described.get(section, ()) for entry in fields(kind)}


def _default(field: FieldInfo, reading: Reading | None, constructed: Any) -> str:
    if field.is_required():
        return ""
    if isinstance(constructed, int | float) and not isinstance(constructed, bool):
        return f"{constructed:g}" + (f" {reading.unit}" if reading and reading.unit else "")
    value = field.default
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) and value else ""


# In words -------------------------------------------------------------------------------------------------------


def field_lines(field: DeckField) -> Iterator[tuple[str, str]]:
    """Label and text of what there is to say on a field."""
    yield "means", field.meaning
    if field.kind:
        yield "of", f'[support] of kind "{field.kind}"'
    yield "takes", field.takes
    if field.unit:
        yield "SI unit", field.unit
    if field.range:
        yield "range", field.range
    if field.default:
        yield "default", field.default
    if field.instead_of:
        yield "instead of", ", ".join(field.instead_of)
    yield "needed", "yes" if field.required and not field.instead_of else _needed(field)


def _needed(field: DeckField) -> str:
    return f"yes, or {', '.join(field.instead_of)}" if field.required else "no"


def field_records(found: tuple[DeckField, ...]) -> list[dict[str, Any]]:
    """Fields as plain data, for JSON."""
    return [asdict(field) for field in found]


_HEAD = """# Fields of a deck

Written by `proprotor describe --markdown` from the definitions in `src/proprotor/deck/sections.py` and `support_sections.py`.

A deck is a TOML file. A number with a dimension is text with its unit, `radius = "12.5 ft"`, US and SI units as one
likes; a plain number has none. Either may be a table that says where it comes from:

    radius = { value = "12.5 ft", status = "published", source = "AIAA-2002-1604, Table 1" }

with a status of published, derived, recalled, calibrated or assumed. `base = "xv15"` above all sections alters another
deck: a field given replaces the base's and its alternatives.

A frequency per revolution, `"0.42/rev"`, is one of the rotor speed that is written in the same file, or in its base
where the file gives none. Another rotor speed, by `--set`, `vary`, a study, a map, a slider or a deck that alters this
one, leaves it its hertz: a wing does not know how fast the rotor turns. A frequency that is set in /rev is one of the
deck's own rotor speed too.

    proprotor new my.toml --from xv15                       # a commented deck that runs as it is
    proprotor describe rotor.precone                        # one field
    proprotor describe --schema > deck.schema.json          # for editors
    proprotor sweep my.toml --speed 50:400:5kt --set rotor.precone="1.5 deg"

An editor that knows JSON schemas for TOML (Even Better TOML, taplo) completes and checks a deck whose first line is
`#:schema ./deck.schema.json`.
"""


def markdown() -> str:
    """docs/decks.md."""
    return "\n".join([_HEAD, *_sections()]) + "\n"


def _sections() -> Iterator[str]:
    from proprotor.deck.sections import section_places, sections_at

    for place in section_places():
        for kind, section in sections_at(place).items() if place else ():
            name = ".".join(place)
            own = [
                field
                for field in deck_fields()
                if field.kind == kind and _plain(field.path).rpartition(".")[0] == name
            ]
            brackets = f"[[{name}]]" if name == "support.modes" else f"[{name}]"
            yield f"## {brackets}{f' of kind {kind}' if kind else ''}\n"
            yield f"{' '.join((section.__doc__ or '').split())}\n"
            yield "| field | meaning | takes | range | default | instead of |"
            yield "|---|---|---|---|---|---|"
            yield from map(_row, own)
            yield ""


def _row(field: DeckField) -> str:
    name = field.path.rpartition(".")[2]
    default = "**needed**" if field.required and not field.default else field.default
    cells = (f"`{name}`", field.meaning, field.takes, field.range, default, ", ".join(field.instead_of))
    return f"| {' | '.join(cell.replace('|', '&#124;') for cell in cells)} |"
