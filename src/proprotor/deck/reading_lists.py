"""Read the lists of numbers of a deck: curves, and distributions along the blade or the wing."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Any

from proprotor.datum import Datum
from proprotor.deck.reading import ANY, Bound, as_table, datum, is_number, read_file, read_quantity
from proprotor.deck.stations import MOST_STATIONS, read_stations
from proprotor.errors import InputError
from proprotor.units import LARGEST, factor_to_si, meaning


def read_profile(raw: Any, unit: str, bound: Bound = ANY, beyond: str = "") -> Datum:
    """Return one number for the whole blade, or a distribution along the blade."""
    is_distribution = isinstance(raw, dict) and ("r_over_R" in raw or isinstance(raw.get("value"), list))
    return read_distribution(raw, unit, bound, beyond) if is_distribution else read_quantity(raw, unit, bound)


def read_spanwise(raw: Any, unit: str, bound: Bound = ANY) -> Datum:
    """Return one number for the whole wing, or a distribution from ``{ y_over_span, value, unit, status, source }``."""
    if not isinstance(raw, dict) or "y_over_span" not in raw:
        return read_quantity(raw, unit, bound)
    try:
        table = {"r_over_R" if key == "y_over_span" else key: entry for key, entry in raw.items()}
        return read_distribution(table, unit, bound)
    except InputError as error:
        field = error.field.replace("r_over_R", "y_over_span")
        rule = error.rule.replace("r_over_R", "y_over_span").replace("centre of rotation", "mount")
        raise InputError(field, error.value, rule) from None


def read_distribution(raw: Any, unit: str, bound: Bound = ANY, beyond: str = "") -> Datum:
    """Return the distribution in a table ``{ r_over_R, value, unit, status, source }`` of two equally long lists.

    Parameters
    ----------
    raw : dict
    unit : str
        SI unit.
    bound : Bound
    beyond : str
        The word that the table may have in ``beyond`` for the blade beyond its stations; "" if it may have none.
    """
    if not isinstance(raw, dict):
        raise InputError("", raw, "must be a table with r_over_R, value and unit")
    table = as_table(raw, ("r_over_R", "value", "unit"), ("beyond",) if beyond else ())
    stations, values, written_unit = table["r_over_R"], table["value"], table["unit"]
    _check_stations(stations)
    _check_numbers("value", values)
    if len(values) != len(stations):
        rule = f"must have one value for each of the {len(stations)} r_over_R"
        raise InputError("value", f"{len(values)} values", rule)
    si = _converted(values, _factor_of_list(written_unit, unit), bound)
    written = f"{len(values)} values in {written_unit}"
    return _along_the_blade(table, written, si, unit, tuple(map(float, stations)), beyond)


def read_column(raw: Any, unit: str, bound: Bound, radius: float, beyond: str) -> Datum:
    """Return the distribution that ``{ file, column, status, source }`` names, see `proprotor.deck.stations`.

    The table may have ``beyond``, as for `read_distribution`.
    """
    table = as_table(raw, ("file", "column"), ("beyond",))
    try:
        file = read_file(table["file"])
    except InputError as error:
        raise error.within("file") from None
    column = table["column"]
    if not isinstance(column, str) or not column:
        raise InputError("column", column, "must be the name of a column")
    try:
        found = read_stations(file.si, column, unit, radius=radius, bound=bound)
    except InputError as error:
        raise InputError(error.field, file.written, error.rule) from None
    written = f"{len(found.values)} values of {column} in {file.written}"
    return _along_the_blade(table, written, found.values, unit, found.r_over_R, beyond)


def _along_the_blade(
    table: Mapping[str, Any],
    written: str,
    si: tuple[float, ...],
    unit: str,
    r_over_R: tuple[float, ...],
    beyond: str,
) -> Datum:
    """Return a distribution with the word of its table for the blade beyond the stations."""
    word = table.get("beyond")
    if word is None:
        return datum(table, written, si, unit, r_over_R)
    if word != beyond:
        raise InputError("beyond", word, f'must be "{beyond}", or left out')
    return replace(datum(table, f"{written}, {word} beyond", si, unit, r_over_R), beyond=beyond)


def read_curve(raw: Any, unit: str, bound: Bound = ANY) -> Datum:
    """Return one number, or the list in ``{ value, unit, status, source }``; a list without dimension has no unit."""
    if not isinstance(raw, dict) or not isinstance(raw.get("value"), list):
        return read_quantity(raw, unit, bound)
    return read_list(raw, unit, bound)


def read_list(raw: Any, unit: str, bound: Bound = ANY, *, rising: bool = False) -> Datum:
    """Return the list of numbers in ``{ value, unit, status, source }``; if `rising`, each above the one before."""
    if not isinstance(raw, dict):
        raise InputError("", raw, f"must be a table with a list{' and its unit' if unit else ''}")
    table = as_table(raw, ("value", "unit") if unit else ("value",))
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
    return datum(table, written, si, unit)


def _factor_of_list(written_unit: Any, unit: str) -> float:
    """Return the size of a written unit in the SI unit."""
    if not isinstance(written_unit, str):
        raise InputError("unit", written_unit, f"must be the unit of {meaning(unit)}")
    try:
        return factor_to_si(written_unit, written_unit, unit)
    except InputError as error:
        raise error.within("unit") from None


def _converted(values: list[float], factor: float, bound: Bound) -> tuple[float, ...]:
    """Return values in SI; refuse one that is not finite or out of bounds."""
    si = tuple(float(value) * factor for value in values)
    for value, converted in zip(values, si, strict=True):
        if not abs(converted) <= LARGEST:
            raise InputError("value", value, f"must be finite, and not beyond {LARGEST:g} in SI units")
        if not bound.holds(converted):
            raise InputError("value", value, bound.rule)
    return si


def _check_stations(stations: Any) -> None:
    """Refuse stations that do not rise between 0 and 1."""
    _check_numbers("r_over_R", stations)
    if len(stations) < 2:
        raise InputError("r_over_R", stations, "must have two stations or more")
    if stations[0] < 0 or stations[-1] > 1:
        raise InputError("r_over_R", stations, "must lie between 0 (centre of rotation) and 1 (tip)")
    for inboard, outboard in pairwise(stations):
        if outboard <= inboard:
            raise InputError("r_over_R", f"{inboard}, {outboard}", "must increase from station to station")


def _check_numbers(key: str, values: Any) -> None:
    """Refuse anything but a list of finite numbers."""
    if not isinstance(values, list) or not all(is_number(value) for value in values):
        raise InputError(key, values, "must be a list of numbers")
    if len(values) > MOST_STATIONS:
        raise InputError(key, f"{len(values)} values", f"must have at most {MOST_STATIONS} values")
    for value in values:
        if not abs(value) <= sys.float_info.max:  # math.isfinite fails for a larger integer
            raise InputError(key, value, "must be finite")
