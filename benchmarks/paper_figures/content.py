"""The content of a figure before the figure is drawn: curves, a band, marks and reservations."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass

import numpy as np

from proprotor.errors import printable
from proprotor.typing import Array

AIRSPEED = "airspeed (kt)"


@dataclass(frozen=True, eq=False)
class Curve:
    """A line of a figure.

    Attributes
    ----------
    name : str
        Name of the column in the CSV file.
    airspeed, values : array (points,)
        In kt, and in the unit of the figure; NaN where a point failed.
    label : str
        Text of the legend; the name where the label is empty.
    boundary : float
        Airspeed in kt at which a damping falls through zero; NaN without one.
    """

    name: str
    airspeed: Array
    values: Array
    label: str = ""
    boundary: float = np.nan


@dataclass(frozen=True, eq=False)
class BandCurves:
    """Percentiles of a sample over airspeeds in kt: low, median, high (points,), with a label for the legend."""

    airspeed: Array
    low: Array
    median: Array
    high: Array
    label: str


@dataclass(frozen=True)
class Mark:
    """Airspeeds in kt of a source, drawn as a band from the lowest to the highest and a line at each."""

    airspeeds: tuple[float, ...]
    label: str


@dataclass(frozen=True, eq=False, kw_only=True)
class Content:
    """The content of one figure.

    Attributes
    ----------
    number : int
        Number of the figure in AIAA-2002-1604.
    title : str
    quantity, unit : str
        Quantity and unit of the vertical axis; the unit of a plain number is "1".
    x_limits, y_limits : (float, float)
        Axes of the paper, extended downwards where a damping falls below zero.
    curves : tuple of Curve
        The first curve is the model of the paper's figures.
    band : BandCurves, optional
    marks : tuple of Mark
    points : tuple of (airspeed, value, label)
        Single points of the figure.
    notes : tuple of str
        Sentences on what the figure rests on.
    assumed : bool
        Whether any input was assumed.
    is_damping : bool
        Whether what lies below zero is unstable.
    """

    number: int
    title: str
    quantity: str
    unit: str
    x_limits: tuple[float, float]
    y_limits: tuple[float, float]
    curves: tuple[Curve, ...]
    band: BandCurves | None = None
    marks: tuple[Mark, ...] = ()
    points: tuple[tuple[float, float, str], ...] = ()
    notes: tuple[str, ...] = ()
    assumed: bool = False
    is_damping: bool = False


def csv_of(content: Content) -> bytes:
    """Return the curves as CSV in UTF-8: a row for each airspeed, units in the heads, empty cells for missing values.

    Lines that begin with # stand above the table and say what the figure shows and rests on.
    """
    columns = {curve.name: (curve.airspeed, curve.values) for curve in content.curves}
    if band := content.band:
        columns |= {
            f"{part} of sample": (band.airspeed, values)
            for part, values in zip(
                ("5th percentile", "median", "95th percentile"),
                (band.low, band.median, band.high),
                strict=True,
            )
        }
    airspeeds = np.unique(np.round(np.concatenate([airspeed for airspeed, _ in columns.values()]), 9))
    rows = np.full((len(airspeeds), len(columns)), np.nan)
    for place, (airspeed, values) in enumerate(columns.values()):
        rows[np.searchsorted(airspeeds, np.round(airspeed, 9)), place] = values
    text = io.StringIO(newline="")
    for note in (f"Fig. {content.number} of AIAA-2002-1604: {content.title}", *content.notes):
        text.write(f"# {printable(note)}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([AIRSPEED, *(f"{name} ({content.unit})" for name in columns)])
    for airspeed, row in zip(airspeeds, rows, strict=True):
        writer.writerow([f"{airspeed:g}", *("" if np.isnan(v) else f"{v:.7g}" for v in row)])
    return text.getvalue().encode()
