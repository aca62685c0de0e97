"""Read the numbers of a deck: what is written, converted to SI and checked, with its status and source."""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from proprotor.datum import PER_REV, STATUSES, Datum
from proprotor.errors import InputError, as_toml, is_choice, list_choices, unknown_name
from proprotor.units import LARGEST, factor_to_si, meaning, to_si

_MOST_STATIONS = 10_000


class FileName(str):
    """The name of a file as a deck has it, and the folder it starts from."""

    folder = Path()

    @classmethod
    def inside(cls, folder: Path, name: str) -> FileName:
        """A name that starts from a folder."""
        file = cls(name)
        file.folder = folder
        return file


class PerRevolution(str):
    """A frequency per revolution as a deck has it, and the rotor speed (rad/s) of the file that it was written in."""

    rotor_speed: float

    @classmethod
    def of(cls, text: str, rotor_speed: float) -> PerRevolution:
        """A frequency per revolution of a rotor speed."""
        frequency = cls(text)
        frequency.rotor_speed = rotor_speed
        return frequency

    @property
    def per_second(self) -> str:
        """The same in rad/s, or as it is where it is no number."""
        try:
            return f"{to_si(self.removesuffix('/rev'), '') * self.rotor_speed!r} rad/s"
        except InputError:
            return str(self)


class FilePath(str):
    """The path of a file, the SI value of a field that names one."""


class Bound(NamedTuple):
    """A condition on the SI value, and how a message states it."""

    holds: Callable[[float], bool]
    rule: str


ANY = Bound(lambda x: True, "")
POSITIVE = Bound(lambda x: x > 0, "must be positive")
NOT_NEGATIVE = Bound(lambda x: x >= 0, "must not be negative")
FRACTION = Bound(lambda x: 0 <= x <= 1, "must lie between 0 and 1")
BELOW_CRITICAL = Bound(lambda x: 0 <= x < 1, 'must be at least 0 and below 1; write one percent as "1 %"')


def read_quantity(raw: Any, unit: str, bound: Bound = ANY) -> Datum:
    """A value, or a table ``{ value, status, source }``, as a `Datum`.

    Raises
    ------
    InputError
        With the field name relative to the value ("" for the value itself).
    """
    table = _as_table(raw, ("value",))
    return _datum(table, str(table["value"]), _bounded(table["value"], unit, bound), unit)


def read_count(raw: Any, least: int) -> Datum:
    """A whole number, or a table holding one."""
    table = _as_table(raw, ("value",))
    value = table["value"]
    if not _is_number(value) or not isinstance(value, int) or value < least:
        raise InputError("", value, f"must be a whole number, at least {least}")
    return _datum(table, str(value), value, "")


def read_choice(raw: Any, choices: tuple[bool | str, ...]) -> Datum:
    """One of some words, true or false, or a table holding one."""
    table = _as_table(raw, ("value",))
    value = table["value"]
    if not is_choice(value, choices):
        raise InputError("", value, f"must be {list_choices(choices)}")
    return _datum(table, as_toml(value), value, "")


def read_frequency(raw: Any, bound: Bound = NOT_NEGATIVE) -> Datum:
    """A frequency; one written per revolution (``"0.42/rev"``) has the unit `PER_REV` and its rotor speed, if told."""
    table = _as_table(raw, ("value",))
    value = table["value"]
    if not isinstance(value, str) or not value.endswith("/rev"):
        return read_quantity(raw, "rad/s", bound)
    try:
        found = _datum(table, str(value), _bounded(value.removesuffix("/rev"), "", bound), PER_REV)
    except InputError as error:
        raise InputError(error.field, value, error.rule) from None
    return replace(found, rotor_speed=value.rotor_speed) if isinstance(value, PerRevolution) else found


def read_distribution(raw: Any, unit: str, bound: Bound = ANY, beyond: str = "") -> Datum:
    """A table ``{ r_over_R, value, unit, status, source }`` of two equally long lists, perhaps with ``beyond``.

    Parameters
    ----------
    beyond : str
        The one word that the table may have for what lies beyond its stations; "" where it may have none.
    """
    if not isinstance(raw, dict):
        raise InputError("", raw, "must be a table with r_over_R, value and unit")
    table = _as_table(raw, ("r_over_R", "value", "unit"), ("beyond",) if beyond else ())
    stations, values, written_unit = table["r_over_R"], table["value"], table["unit"]
    _check_stations(stations)
    _check_numbers("value", values)
    if len(values) != len(stations):
        rule = f"must have one value for each of the {len(stations)} r_over_R"
        raise InputError("value", f"{len(values)} values", rule)
    si = _converted(values, _factor_of_list(written_unit, unit), bound)
    written = f"{len(values)} values in {written_unit}"
    return _along_the_blade(table, written, si, unit, tuple(map(float, stations)), beyond)


def _along_the_blade(
    table: Mapping[str, Any],
    written: str,
    si: tuple[float, ...],
    unit: str,
    r_over_R: tuple[float, ...],
    beyond: str,
) -> Datum:
    """A distribution with what its table says of the blade beyond it."""
    said = table.get("beyond")
    if said is None:
        return _datum(table, written, si, unit, r_over_R)
    if said != beyond:
        raise InputError("beyond", said, f'must be "{beyond}", or left out')
    return replace(_datum(table, f"{written}, {said} beyond", si, unit, r_over_R), beyond=beyond)


def read_curve(raw: Any, unit: str, bound: Bound = ANY) -> Datum:
    """One number, or a table ``{ value, unit, status, source }`` with a list of them; what has no dimension no unit."""
    if not isinstance(raw, dict) or not isinstance(raw.get("value"), list):
        return read_quantity(raw, unit, bound)
    return read_list(raw, unit, bound)


def read_list(raw: Any, unit: str, bound: Bound = ANY, *, rising: bool = False) -> Datum:
    """A table ``{ value, unit, status, source }`` with a list of numbers, perhaps of rising ones."""
    if not isinstance(raw, dict):
        raise InputError("", raw, f"must be a table with a list{' and its unit' if unit else ''}")
    table = _as_table(raw, ("value", "unit") if unit else ("value",))
    values = table["value"]
    _check_numbers("value", values)
    if len(values) < 2:
        raise InputError("value", values, "must have two values or more")
    factor = _factor_of_list(table["unit"], unit) if unit else 1.0
    si = _converted(values, factor, bound)
    for first, second in pairwise(si) if rising else ():
        if second <= first:
            raise InputError(
                "value", f"{first / factor:g}, {second / factor:g}", "must rise from value to value"
            )
    written = f"{len(values)} values in {table['unit']}" if unit else f"{len(values)} values"
    return _datum(table, written, si, unit)


def read_profile(raw: Any, unit: str, bound: Bound = ANY, beyond: str = "") -> Datum:
    """One number for the whole blade, or a distribution along it."""
    is_distribution = isinstance(raw, dict) and ("r_over_R" in raw or isinstance(raw.get("value"), list))
    return read_distribution(raw, unit, bound, beyond) if is_distribution else read_quantity(raw, unit, bound)


def _factor_of_list(written_unit: Any, unit: str) -> float:
    if not isinstance(written_unit, str):
        raise InputError("unit", written_unit, f"must be the unit of {meaning(unit)}")
    try:
        return factor_to_si(written_unit, written_unit, unit)
    except InputError as error:
        raise error.within("unit") from None


def _converted(values: list[float], factor: float, bound: Bound) -> tuple[float, ...]:
    si = tuple(float(value) * factor for value in values)
    for value, converted in zip(values, si, strict=True):
        if not abs(converted) <= LARGEST:
            raise InputError("value", value, f"must be finite, and not beyond {LARGEST:g} in SI units")
        if not bound.holds(converted):
            raise InputError("value", value, bound.rule)
    return si


def read_column(raw: Any, unit: str, bound: Bound, radius: float, beyond: str) -> Datum:
    """A table ``{ file, column, status, source }``: one column of a file of blade stations, see `stations_file`.

    It may have ``beyond``, as for `read_distribution`.
    """
    from proprotor.deck.stations import read_stations  # here, because few decks have one

    table = _as_table(raw, ("file", "column"), ("beyond",))
    try:
        file = read_file(table["file"])
    except InputError as error:
        raise error.within("file") from None
    column = table["column"]
    if not isinstance(column, str) or not column:
        raise InputError("column", column, "must be the name of a column")
    try:
        found = read_stations(file.si, column, unit, radius=radius, holds=bound.holds, rule=bound.rule)
    except InputError as error:
        raise InputError(error.field, file.written, error.rule) from None
    written = f"{len(found.values)} values of {column} in {file.written}"
    return _along_the_blade(table, written, found.values, unit, found.r_over_R, beyond)


def read_file(raw: Any) -> Datum:
    """The name of a file, or a table holding one; plain text starts from the working directory."""
    table = _as_table(raw, ("value",))
    name = table["value"]
    if not isinstance(name, str) or not name:
        raise InputError("", name, "must be the name of a file")
    folder = name.folder if isinstance(name, FileName) else FileName.folder
    return _datum(table, str(name), FilePath(folder / name), "")


def _datum(
    table: Mapping[str, Any],
    written: str,
    si: bool | float | tuple[float, ...] | str,
    unit: str,
    r_over_R: tuple[float, ...] | None = None,
) -> Datum:
    status, source = table.get("status", "unstated"), table.get("source", "")
    if "status" in table and status not in STATUSES:
        raise InputError("status", status, f"must be one of {', '.join(STATUSES)}")
    if not isinstance(source, str):
        raise InputError("source", source, "must be text")
    return Datum(written, si, unit, status, source, r_over_R)


def _as_table(raw: Any, required: Collection[str], further: Collection[str] = ()) -> dict[str, Any]:
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
    if not isinstance(value, str) and not _is_number(value):
        raise InputError("", value, f"must be {meaning(unit)}")
    si = to_si(value, unit)
    if not bound.holds(si):
        raise InputError("", value, bound.rule)
    return si


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _check_stations(stations: Any) -> None:
    _check_numbers("r_over_R", stations)
    if len(stations) < 2:
        raise InputError("r_over_R", stations, "must have two stations or more")
    if stations[0] < 0 or stations[-1] > 1:
        raise InputError("r_over_R", stations, "must lie between 0 (centre of rotation) and 1 (tip)")
    for inboard, outboard in pairwise(stations):
        if outboard <= inboard:
            raise InputError("r_over_R", f"{inboard}, {outboard}", "must increase from station to station")


def _check_numbers(key: str, values: Any) -> None:
    if not isinstance(values, list) or not all(_is_number(value) for value in values):
        raise InputError(key, values, "must be a list of numbers")
    if len(values) > _MOST_STATIONS:
        raise InputError(key, f"{len(values)} values", f"must have at most {_MOST_STATIONS} values")
    for value in values:
        if not abs(value) <= sys.float_info.max:  # also an integer beyond it, which math.isfinite cannot take
            raise InputError(key, value, "must be finite")
