"""Margins of control loops as records, as cells of a table, and in sentences."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from proprotor.model.doubts import marked
from proprotor.stability.margin_ranges import Kept, Needed
from proprotor.typing import Dataset
from proprotor.units import KNOT, KTAS

_HERTZ = 2 * math.pi
_NONE = "-"  # in place of a margin that has no limit


def margin_records(found: Dataset) -> list[dict[str, Any]]:
    """Return a record for each airspeed and loop; None where a margin has no limit or is not known.

    Parameters
    ----------
    found : xarray.Dataset
        Of `Case.margins`.
    """
    return [
        _record(found.isel(airspeed=point, loop=loop))
        for point in range(found.sizes["airspeed"])
        for loop in range(found.sizes["loop"])
    ]


def _record(here: Dataset) -> dict[str, Any]:
    """Return the record of one loop at one airspeed."""

    def of(name: str, factor: float = 1.0, decibel: bool = False) -> float | None:
        value = float(here[name])
        if not math.isfinite(value) or (decibel and value <= 0):
            return None
        return 20 * math.log10(value) if decibel else value / factor

    def at(name: str) -> float | None:
        return of(f"{name}_frequency", _HERTZ)

    speed = float(here.airspeed)
    return {
        f"airspeed ({KTAS})": speed / KNOT,
        "airspeed (m/s)": speed,
        "loop": str(here.loop.item()),
        "stable": bool(here.stable),
        "gain margin (dB)": of("gain_margin", decibel=True),
        "lost at (Hz), gain margin": at("gain_margin"),
        "gain reduction (dB)": of("gain_reduction", decibel=True),
        "lost at (Hz), gain reduction": at("gain_reduction"),
        "phase margin (deg)": of("phase_margin", math.pi / 180),
        "lost at (Hz), phase margin": at("phase_margin"),
        "delay margin (ms)": of("delay_margin", 1e-3),
        "lost at (Hz), delay margin": at("delay_margin"),
        "disk margin": of("disk_margin"),
        "lost at (Hz), disk margin": at("disk_margin"),
        "warning": str(here.warning.item()),
        "failure": str(here.reason.item()),
    }


def margin_cells(record: dict[str, Any], speed: float) -> tuple[str, ...]:
    """Return a record as cells, the airspeed in units of `speed`, m/s; each margin has the frequency beside it."""
    first = marked(f"{record['airspeed (m/s)'] / speed:.5g}", record["warning"])
    if record["failure"] or not record["stable"]:
        return (first, record["loop"], *[""] * 9, record["failure"] or "unstable")
    cells: list[str] = []
    for name, digits in (
        ("gain margin (dB)", 1),
        ("gain reduction (dB)", 1),
        ("phase margin (deg)", 0),
        ("delay margin (ms)", 1),
    ):
        value, where = record[name], record[f"lost at (Hz), {name.partition(' (')[0]}"]
        cells += [_NONE if value is None else f"{value:.{digits}f}", "" if where is None else f"{where:.3g}"]
    return (first, record["loop"], *cells, f"{record['disk margin']:.2f}", "")


def verdict(found: Dataset, every: Sequence[Kept], needed: Needed, unit: str, speed: float) -> list[str]:
    """Return a sentence for each loop: between which airspeeds it keeps the margins, and what is lost then.

    Parameters
    ----------
    found : xarray.Dataset
        Of `Case.margins`.
    every : sequence of Kept
        The ranges of all loops.
    needed : Needed
    unit : str
        Unit of the airspeeds, as outputs name it.
    speed : float
        That unit in m/s.
    """
    sentences = []
    for loop in found.loop.values.tolist():
        ranges = "; ".join(_range_text(kept, unit, speed) for kept in every if kept.loop == loop)
        sentences.append(f"{loop}: keeps {needed.text} {ranges or 'at none of the airspeeds'}.")
    return sentences


def _range_text(kept: Kept, unit: str, speed: float) -> str:
    """Return a range of airspeeds in words."""
    start, stop = kept.start / speed, kept.stop / speed
    first = f"from {start:.4g}" if kept.open_start else f"from {start:.2f}"
    if kept.open_stop:
        return f"{first} to {stop:.4g} {unit}, the highest that was analysed"
    return f"{first} to {stop:.2f} {unit}, then lost by {kept.lost_by}"
