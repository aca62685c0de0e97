"""Read distributions along the blade from a CSV file: one row a station, a unit in the head of each column.

::

    r [ft], twist [deg], chord [inch], mass_per_length [slug/ft]
    0.0,    34.4,        17.0,         0.90
    12.5,   -5.8,        13.5,         0.15

The column of the stations is ``r_over_R``, without a unit, or ``r`` with a unit; `proprotor.files.csv_columns` has the
rules of all such files.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from proprotor.deck.reading import ANY, Bound
from proprotor.errors import InputError
from proprotor.files.csv_columns import (
    Fault,
    Head,
    Line,
    check_order,
    factor_of,
    fault_at,
    head_of,
    number_in,
    table_of,
)
from proprotor.files.text import read_text

_STATIONS = ("r_over_R", "r")

_LARGEST = 1_000_000  # bytes
MOST_STATIONS = 10_000
_ROUNDING = 1e-9  # relative to the radius: a tip at 150 inch equals one at 12.5 ft


class _Distribution(NamedTuple):
    """A column of a file, along the blade.

    r_over_R : stations (n,), increasing; values : (n,) in SI
    """

    r_over_R: tuple[float, ...]
    values: tuple[float, ...]


def read_stations(
    path: str | os.PathLike[str],
    column: str,
    unit: str,
    *,
    radius: float | None = None,
    bound: Bound = ANY,
) -> _Distribution:
    """Return one column of a file of blade stations.

    Parameters
    ----------
    path : str or path
    column : str
        Name of the column, without its unit.
    unit : str
        SI unit of the returned values; ``""`` for plain numbers.
    radius : float, optional
        m; needed where the stations are ``r``.
    bound : Bound
        A condition on each SI value, with its rule for a message.

    Raises
    ------
    InputError
        When the file cannot be read or is malformed: one line with the file, the line and column in it and the rule.
    """
    try:
        heads, rows = table_of(read_text(Path(path), "file", Path(path).name, _LARGEST))
        stations, values = _stations_head(heads), head_of(heads, column)
        to_si, scale = factor_of(values, unit), _scale(stations, radius)
        return _distribution(rows, stations, scale, values, to_si, bound)
    except Fault as fault:
        raise InputError("file", Path(path).name, str(fault)) from None


def _stations_head(heads: list[Head]) -> Head:
    """Return the head of the column of stations."""
    found = [head for head in heads if head.name in _STATIONS]
    if len(found) != 1:
        fault = "has no column of stations" if not found else "has two columns of stations"
        raise Fault(f'{fault}; give "r_over_R", or "r" with a unit')
    return found[0]


def _scale(head: Head, radius: float | None) -> float:
    """Return r/R of one unit of the stations."""
    if head.name == "r_over_R":
        return factor_of(head, "")
    if radius is None:
        raise Fault(f"column {head.place + 1} ({head.text}): needs the radius; give r_over_R")
    return factor_of(head, "m") / radius


def _distribution(
    rows: Iterator[Line], stations: Head, scale: float, values: Head, to_si: float, bound: Bound
) -> _Distribution:
    """Return the stations and values of all lines; refuse a station or value that breaks a rule."""
    r_over_R: list[float] = []
    found: list[float] = []
    for number, cells in rows:
        r = _on_the_blade(number, stations, number_in(number, cells, stations) * scale)
        if r_over_R:
            check_order(number, stations, r, r_over_R[-1])
        value = number_in(number, cells, values) * to_si
        if not math.isfinite(value):
            raise fault_at(number, values, "must be finite")
        if not bound.holds(value):
            raise fault_at(number, values, bound.rule)
        r_over_R.append(r)
        found.append(value)
        if len(found) > MOST_STATIONS:
            raise Fault(f"line {number}: must have at most {MOST_STATIONS} stations")
    if len(found) < 2:
        raise Fault("must have two stations or more")
    return _Distribution(tuple(r_over_R), tuple(found))


def _on_the_blade(number: int, head: Head, r: float) -> float:
    """Return r/R, with rounding at root and tip removed."""
    if not -_ROUNDING <= r <= 1 + _ROUNDING:
        raise fault_at(number, head, f"is {r:.6g} R; must lie between 0 (centre of rotation) and R (tip)")
    return min(max(r, 0.0), 1.0)
