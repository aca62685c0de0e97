"""Margins of control loops as records and cells of a table, and the airspeeds up to which they suffice."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from proprotor.model.doubts import marked
from proprotor.typing import Array, Dataset
from proprotor.units import KNOT, KTAS

_HERTZ = 2 * math.pi
_NONE = "-"  # in place of a margin that has no limit


class Needed(NamedTuple):
    """What a loop must keep: decibels of gain, either way, and phase in rad."""

    gain: float = 6.0
    phase: float = math.pi / 4

    @property
    def text(self) -> str:
        """The margins in words, such as "6 dB and 45 deg"."""
        return f"{self.gain:g} dB and {math.degrees(self.phase):g} deg"


class _Kept(NamedTuple):
    """A range of airspeeds of one loop over which the margins suffice, m/s, interpolated.

    open_start, open_stop : whether the range goes on beyond the airspeeds that were analysed; lost_by : the margin that
    is too small above the range.
    """

    loop: str
    start: float
    stop: float
    open_start: bool
    open_stop: bool
    lost_by: str


def decibels(found: Dataset) -> Array:
    """Return the gain margin (airspeed, loop) in dB: the smaller of what factors above and below 1 allow."""
    with np.errstate(divide="ignore"):
        up, down = (20 * np.log10(found[name].values) for name in ("gain_margin", "gain_reduction"))
    return np.asarray(np.minimum(up, -down))


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


def kept_ranges(found: Dataset, needed: Needed) -> list[_Kept]:
    """Return the ranges of airspeeds over which each loop keeps the margins, interpolated between airspeeds.

    Where the closed loop is unstable, or nothing is known, no margin is kept.
    """
    return [
        kept
        for place, loop in enumerate(found.loop.values.tolist())
        for kept in _ranges(found, place, loop, needed)
    ]


def _ranges(found: Dataset, place: int, loop: str, needed: Needed) -> Iterator[_Kept]:
    """Yield the ranges of one loop."""
    speeds = found.airspeed.values
    spare = np.stack(
        [
            decibels(found)[:, place] / needed.gain - 1,
            found.phase_margin.values[:, place] / needed.phase - 1,
        ]
    )
    unstable = np.isnan(spare).any(axis=0)
    least = np.where(
        unstable, -1.0, np.minimum(spare.min(axis=0), 1e6)
    )  # a margin without limit is very large
    good = least >= 0
    names = ("gain margin", "phase margin")
    edges = np.flatnonzero(np.diff(np.concatenate([[False], good, [False]]).astype(int)))
    for first, last in edges.reshape(-1, 2) - np.array([0, 1]):
        after = last + 1
        open_stop = after == len(speeds)
        lost = "" if open_stop else "instability" if unstable[after] else names[int(spare[:, after].argmin())]
        yield _Kept(
            loop,
            speeds[0] if first == 0 else _between(speeds, least, first - 1),
            speeds[-1] if open_stop else _between(speeds, least, last),
            first == 0,
            bool(open_stop),
            lost,
        )


def _between(speeds: Array, least: Array, place: int) -> float:
    """Return the airspeed at which the margins just suffice, between two airspeeds."""
    low, high = np.clip(least[place : place + 2], -1.0, 1.0)
    return float(speeds[place] + (speeds[place + 1] - speeds[place]) * low / (low - high))


def verdict(found: Dataset, needed: Needed, unit: str, speed: float) -> list[str]:
    """Return a sentence for each loop: between which airspeeds it keeps the margins, and what is lost then.

    Parameters
    ----------
    found : xarray.Dataset
        Of `Case.margins`.
    needed : Needed
    unit : str
        Unit of the airspeeds, as outputs name it.
    speed : float
        That unit in m/s.
    """
    every, sentences = kept_ranges(found, needed), []
    for loop in found.loop.values.tolist():
        own = [kept for kept in every if kept.loop == loop]
        parts = [_range_text(kept, unit, speed) for kept in own]
        text = (
            f"keeps {needed.text} {', '.join(parts)}"
            if parts
            else f"keeps {needed.text} at none of the airspeeds"
        )
        sentences.append(f"{loop}: {text}.")
    return sentences


def _range_text(kept: _Kept, unit: str, speed: float) -> str:
    """Return a range of airspeeds in words."""
    start, stop = (f"{end / speed:.4g}" for end in (kept.start, kept.stop))
    lost = f" (interpolated; then lost by {kept.lost_by})" if kept.lost_by else ""
    first = f"from {start} {unit}" + ("" if kept.open_start else " (interpolated)")
    return f"{first} to {stop} {unit}{lost}" + (", the highest analysed" if kept.open_stop else "")
