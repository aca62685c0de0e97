"""Points of a CSV file, measured, published or of another program, to stand on plots beside results.

::

    rotor_speed [rpm], airspeed [ktas], airspeed_error [ktas], label, source
    458,               285,             10,                    Nixon, "thesis, Fig. 8"
    458,               305,             ,                      Johnson, "NASA TP, Fig. 12"

A column has the name of the quantity of an axis and a unit: ``airspeed``, ``frequency``, ``damping``, or an input by
its path in the deck or the last word of the path. ``NAME_error``, or ``NAME_low`` and ``NAME_high``, are the ends of an
error bar, in the unit of NAME; an empty cell is a point without the number. Points of one ``label`` look the same;
``mode`` names the mode of a point, for `proprotor.calibration`. `proprotor.files.csv_columns` has the rules of all such
files.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from proprotor.errors import InputError, printable
from proprotor.files.csv_columns import Fault, Head, Line, factor_of, fault_at, number_in, table_of
from proprotor.files.text import read_text
from proprotor.typing import Array

Scale = (
    float | Callable[[Array], Array]
)  # of a unit in SI: a number, or a function of the position across in SI

FREQUENCY, DAMPING, GROWTH = "frequency", "damping", "growth"  # names of columns

_LARGEST = 1_000_000  # bytes
_MOST_POINTS = 10_000
_WORDS = ("label", "source", "mode")
_NO_QUANTITIES = (*_WORDS, "warning")
_ENDS = ("_error", "_low", "_high")
_PER_REV = ("per rev", "/rev")


class Quantity(NamedTuple):
    """A quantity of an axis, to which a column of points is converted.

    Parameters
    ----------
    name : str
        "airspeed", "frequency", "damping", or the path of an input.
    unit : str
        SI unit.
    factor : float or callable
        Unit of the axis in SI; a function of the position across where it differs from point to point.
    special : mapping of str to (float or callable)
        Sizes in SI of units that are no fixed multiples of the SI unit: keas, and "per rev" of a frequency.
    """

    name: str
    unit: str
    factor: Scale = 1.0
    special: Mapping[str, Scale] = {}

    @property
    def columns(self) -> tuple[str, ...]:
        """Names that a column of the quantity may have."""
        return (self.name, self.name.rpartition(".")[2])


class Column(NamedTuple):
    """A column: values with the ends of their error bars (k,) in a unit, NaN where a cell is empty; its head."""

    values: Array
    low: Array
    high: Array
    head: Head


class Points(NamedTuple):
    """Points of a file.

    Parameters
    ----------
    name : str
        Of the file.
    columns : mapping of str to Column
    label, source : array of str
        (k,), of each point; the label is the name of the file where the file gives none.
    mode : array of str
        (k,), the mode that was measured, by its name in a sweep; "" where the file gives none.
    """

    name: str
    columns: Mapping[str, Column]
    label: Array
    source: Array
    mode: Array

    def find(self, quantity: Quantity) -> Column | None:
        """Return the column of a quantity; None where the file has no such column."""
        return next((self.columns[name] for name in quantity.columns if name in self.columns), None)

    def check(self, across: Quantity, up: Sequence[Quantity], field: str = "points") -> None:
        """Refuse points that a plot cannot show.

        Raises
        ------
        InputError
            Without a column for the axis across or for any of the axes up, or with a unit of another dimension.
        """
        for needed in ((across,), up):
            found = [(quantity, self.find(quantity)) for quantity in needed]
            if not any(column for _, column in found):
                names = " or ".join(quantity.columns[-1] for quantity in needed)
                has = ", ".join(self.columns)
                raise InputError(field, self.name, f"needs a column {names} for this plot; it has {has}")
            for quantity, column in found:
                if column is not None:
                    _scale_of(self.name, column, quantity, field)

    def on_axes(self, across: Quantity, up: Quantity) -> tuple[Column, Column] | None:
        """Return the columns of two axes in the units of the axes; None where the file has no column for one of them.

        Raises
        ------
        InputError
            For a unit of another dimension, or a unit that the plot cannot convert.
        """
        x, y = self.find(across), self.find(up)
        if x is None or y is None:
            return None
        positions = x.values * _at(_scale_of(self.name, x, across), x.values)
        return _converted(self.name, x, across, positions), _converted(self.name, y, up, positions)


def read_points(path: str | os.PathLike[str], field: str = "points") -> Points:
    """Return the points of a CSV file.

    Parameters
    ----------
    path : str or path
    field : str
        Name of the input, for messages.

    Returns
    -------
    Points

    Raises
    ------
    InputError
        When the file cannot be read or is malformed: one line with the file, the line and column in it and the rule.
    """
    name = Path(path).name
    try:
        heads, rows = table_of(read_text(Path(path), field, name, _LARGEST))
        return _points(name, heads, list(rows))
    except Fault as fault:
        raise InputError(field, name, str(fault)) from None


def _points(name: str, heads: list[Head], rows: list[Line]) -> Points:
    if not rows or len(rows) > _MOST_POINTS:
        raise Fault(f"must have 1 to {_MOST_POINTS} points, a line for each")
    by_name = {head.name: head for head in heads}
    quantities = [
        head for head in heads if head.name not in _NO_QUANTITIES and _base_of(head, by_name) is None
    ]
    if len(quantities) < 2:
        raise Fault('must have a column for each axis, such as "airspeed [ktas]" and "damping [%]"')
    columns = {head.name: _column(head, by_name, rows) for head in quantities}
    label, source, mode = (_words(by_name.get(word), rows) for word in _WORDS)
    return Points(name, columns, np.where(label == "", name, label), source, mode)


def _base_of(head: Head, by_name: Mapping[str, Head]) -> Head | None:
    """Return the column of which a column has the ends of error bars; None for a column of its own."""
    for end in _ENDS:
        base = by_name.get(head.name.removesuffix(end))
        if head.name.endswith(end) and base is not None:
            if head.unit not in ("", base.unit):
                rule = f"must have the unit of {base.text}, or none"
                raise Fault(f"column {head.place + 1} ({head.text}): {rule}")
            return base
    return None


def _column(head: Head, by_name: Mapping[str, Head], rows: list[Line]) -> Column:
    """Return the values of a column and the ends of their error bars."""
    values = _numbers(head, rows)
    error, low, high = (_numbers(by_name.get(head.name + end), rows) for end in _ENDS)
    if head.name + "_error" in by_name and {head.name + "_low", head.name + "_high"} & set(by_name):
        raise Fault(f"{head.name}: must have {head.name}_error or {head.name}_low and _high, not both")
    for place, (number, _) in enumerate(rows):
        if error[place] < 0:
            raise fault_at(number, by_name[head.name + "_error"], "must not be negative")
        if low[place] > values[place] or high[place] < values[place]:
            raise fault_at(number, head, "must lie between the ends of its error bar")
    low = np.where(np.isfinite(low), low, values - np.nan_to_num(error))
    high = np.where(np.isfinite(high), high, values + np.nan_to_num(error))
    return Column(values, low, high, head)


def _numbers(head: Head | None, rows: list[Line]) -> Array:
    """Return the numbers of a column, NaN for empty cells and for a column that the file does not have."""
    if head is None:
        return np.full(len(rows), np.nan)
    empty = [head.place >= len(cells) or not cells[head.place].strip() for _, cells in rows]
    return np.array(
        [
            np.nan if no else number_in(number, cells, head)
            for no, (number, cells) in zip(empty, rows, strict=True)
        ]
    )


def _words(head: Head | None, rows: list[Line]) -> Array:
    """Return the words of a column, "" for empty cells and for a column that the file does not have."""
    cells = [cells[head.place] if head and head.place < len(cells) else "" for _, cells in rows]
    return np.array([printable(cell).strip() for cell in cells], dtype=object)


def _converted(name: str, column: Column, quantity: Quantity, positions: Array) -> Column:
    """Return a column in the unit of its axis."""
    size = _at(_scale_of(name, column, quantity), positions) / _at(quantity.factor, positions)
    return Column(column.values * size, column.low * size, column.high * size, column.head)


def _at(scale: Scale, positions: Array) -> Array:
    return np.asarray(scale(positions) if callable(scale) else scale)


def _scale_of(name: str, column: Column, quantity: Quantity, field: str = "points") -> Scale:
    """Return the size in SI of the unit of a column."""
    unit = "per rev" if column.head.unit in _PER_REV else column.head.unit.lower()
    if unit in quantity.special:
        return quantity.special[unit]
    try:
        return factor_of(column.head, quantity.unit)
    except Fault as fault:
        raise InputError(field, name, str(fault)) from None
