"""What a figure shows: curves, a band, marks and reservations, before anything is drawn."""

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
        For the column of the CSV file.
    airspeed, values : array (points,)
        In kt, and in the unit of the figure; NaN where a point failed.
    label : str
        For the legend; the name where it is empty.
    """

    name: str
    airspeed: Array
    values: Array
    label: str = ""


@dataclass(frozen=True, eq=False)
class BandCurves:
    """Percentiles of a sample: low, median, high (points,), and what the sample is."""

    airspeed: Array
    low: Array
    median: Array
    high: Array
    label: str


@dataclass(frozen=True)
class Mark:
    """Airspeeds in kt read in a source: a band from the lowest to the highest, and a line at each."""

    airspeeds: tuple[float, ...]
    label: str


@dataclass(frozen=True, eq=False, kw_only=True)
class Content:
    """All of one figure.

    Attributes
    ----------
    number : int
        In AIAA-2002-1604.
    title : str
    quantity, unit : str
        Of the vertical axis; the unit of a plain number is "1".
    x_limits, y_limits : (float, float)
        Axes of the paper, downwards extended where a damping falls below zero.
    curves : tuple of Curve
        The first one is the model as the paper's figures have it.
    band : BandCurves, optional
    marks : tuple of Mark
    points : tuple of (airspeed, value, label)
        Single points with a meaning of their own.
    notes : tuple of str
        What the figure rests on.
    assumed : bool
        Whether any input was assumed.
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


def csv_of(content: Content) -> bytes:
    """The curves as CSV in UTF-8: a row for each airspeed, units in the heads, cells empty where there is nothing.

    What the figure shows and rests on stands above in lines that begin with #.
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
