"""Read the numbers of a deck: written text, converted to SI and checked, with status and source."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

from proprotor.datum import PER_REV, STATUSES, UNSTATED, Datum
from proprotor.deck.written import FileName, FilePath, PerRevolution
from proprotor.errors import InputError, as_toml, is_choice, list_choices, unknown_name
from proprotor.units import meaning, to_si


class Bound(NamedTuple):
    """A condition on the SI value, the range of the value in words, and the rule for a message."""

    holds: Callable[[float], bool]
    range: str
    rule: str


_BELOW_1 = 'must be at least 0 and below 1; write one percent as "1 %"'
ANY = Bound(lambda x: True, "", "")
POSITIVE = Bound(lambda x: x > 0, "above 0", "must be positive")
NOT_NEGATIVE = Bound(lambda x: x >= 0, "0 or more", "must not be negative")
FRACTION = Bound(lambda x: 0 <= x <= 1, "0 to 1", "must lie between 0 and 1")
BELOW_QUARTER_TURN = Bound(lambda x: abs(x) < math.pi / 2, "within 90 deg", "must lie within 90 deg")
BELOW_CRITICAL = Bound(lambda x: 0 <= x < 1, "0 to below 1", _BELOW_1)


def read_quantity(raw: Any, unit: str, bound: Bound = ANY) -> Datum:
    """Return the quantity in a value or a table ``{ value, status, source }``.

    Raises
    ------
    InputError
        With the field named relative to the value ("" for the value itself).
    """
    table = as_table(raw, ("value",))
    return datum(table, str(table["value"]), _bounded(table["value"], unit, bound), unit)


def read_tangent(raw: Any) -> Datum:
    """Return a plain number, or the tangent of an angle that is given instead: -0.268 for ``"-15 deg"``."""
    try:
        return replace(read_quantity(raw, ""), form="tangent")
    except InputError as error:
        if error.field:
            raise
        try:
            angle = read_quantity(raw, "rad", BELOW_QUARTER_TURN)
        except InputError as of_angle:
            if of_angle.rule == BELOW_QUARTER_TURN.rule:
                raise
            raise InputError("", error.value, rule_of_tangent(error)) from None
    return replace(angle, si=math.tan(angle.si), unit="", form="tangent")


def rule_of_tangent(error: InputError) -> str:
    """Return the rule that neither a number nor an angle keeps, by the error about the number."""
    rule = f"must be {meaning('')}"
    is_quantity = error.rule.startswith(rule)
    return (
        f'{rule}, or the angle of which it is the tangent, such as "-15 deg"' if is_quantity else error.rule
    )


def read_count(raw: Any, least: int) -> Datum:
    """Return a whole number, or the whole number in a table."""
    table = as_table(raw, ("value",))
    value = table["value"]
    if not is_number(value) or not isinstance(value, int) or value < least:
        raise InputError("", value, f"must be a whole number, at least {least}")
    return datum(table, str(value), value, "")


def read_choice(raw: Any, choices: tuple[bool | str, ...]) -> Datum:
    """Return one of some words, true or false, or the choice in a table."""
    table = as_table(raw, ("value",))
    value = table["value"]
    if not is_choice(value, choices):
        raise InputError("", value, f"must be {list_choices(choices)}")
    return datum(table, as_toml(value), value, "")


def read_joint(raw: Any, unit: str, bound: Bound, choices: tuple[bool | str, ...]) -> Datum:
    """Return one of some words, or a quantity."""
    value = as_table(raw, ("value",))["value"]
    try:
        return read_choice(raw, choices) if value in choices else read_quantity(raw, unit, bound)
    except InputError as error:
        if error.field:
            raise
        raise InputError(
            "", value, f"must be {list_choices(choices)}, or {meaning(unit)} above zero"
        ) from None


def read_frequency(raw: Any, bound: Bound = NOT_NEGATIVE) -> Datum:
    """Return a frequency; per revolution (``"0.42/rev"``) with the unit `PER_REV` and the rotor speed, if known."""
    table = as_table(raw, ("value",))
    value = table["value"]
    if not isinstance(value, str) or not value.endswith("/rev"):
        return replace(read_quantity(raw, "rad/s", bound), form="frequency")
    try:
        found = datum(table, str(value), _bounded(value.removesuffix("/rev"), "", bound), PER_REV)
    except InputError as error:
        raise InputError(error.field, value, error.rule) from None
    rotor_speed = value.rotor_speed if isinstance(value, PerRevolution) else None
    return replace(found, rotor_speed=rotor_speed, form="frequency")


def read_file(raw: Any) -> Datum:
    """Return the name of a file, or the name in a table; plain text starts from the working directory."""
    table = as_table(raw, ("value",))
    return datum(table, str(table["value"]), _path_of(table["value"]), "")


def read_files(raw: Any) -> Datum:
    """Return the name of a file, or a list of names, or either in a table."""
    table = as_table(raw, ("value",))
    names = table["value"]
    if not isinstance(names, list):
        return read_file(raw)
    if len(names) < 2:
        raise InputError("", names, "must have two files or more, or be the name of one")
    paths = tuple(_path_of(name) for name in names)
    return datum(table, ", ".join(names), paths, "")


def _path_of(name: Any) -> FilePath:
    """Return the path of a file by its name in a deck."""
    if not isinstance(name, str) or not name:
        raise InputError("", name, "must be the name of a file")
    folder = name.folder if isinstance(name, FileName) else FileName.folder
    return FilePath(folder / name)


def datum(
    table: Mapping[str, Any],
    written: str,
    si: bool | float | tuple[float, ...] | tuple[str, ...] | str,
    unit: str,
    r_over_R: tuple[float, ...] | None = None,
) -> Datum:
    """Return a number with the status and source of its table."""
    status, source = table.get("status", UNSTATED), table.get("source", "")
    if "status" in table and status not in STATUSES:
        raise InputError("status", status, f"must be one of {', '.join(STATUSES)}")
    if not isinstance(source, str):
        raise InputError("source", source, "must be text")
    return Datum(written, si, unit, status, source, r_over_R)


def as_table(raw: Any, required: Collection[str], further: Collection[str] = ()) -> dict[str, Any]:
    """Return a value as a table; refuse unknown and missing keys."""
    table = raw if isinstance(raw, dict) else {"value": raw}
    known = (*required, *further, "status", "source")
    for key in table:
        if key not in known:
            raise InputError(key, table[key], unknown_name(key, known))
    for key in required:
        if key not in table:
            raise InputError(key, None, "is missing")
    return table


def _bounded(value: Any, unit: str, bound: Bound) -> float:
    """Return a value in SI; refuse one that is no number or out of bounds."""
    if not isinstance(value, str) and not is_number(value):
        raise InputError("", value, f"must be {meaning(unit)}")
    si = to_si(value, unit)
    if not bound.holds(si):
        raise InputError("", value, bound.rule)
    return si


def is_number(value: Any) -> bool:
    """Return whether a value is a number; true and false are not."""
    return isinstance(value, int | float) and not isinstance(value, bool)
