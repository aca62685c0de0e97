"""The worst flutter speed of a box of inputs as records, as cells of a table and as sentences."""

from __future__ import annotations

import math
from typing import Any

from proprotor.model.doubts import marked
from proprotor.typing import Dataset
from proprotor.units import KNOT, KTAS

COLUMNS = ("input", "unit", "worst", "low", "high", "side", f"slope ({KTAS} over the range)")


def robust_records(found: Dataset) -> list[dict[str, Any]]:
    """Return a record for each input of the box: the worst design, the limits, and the slope of the speed there.

    Parameters
    ----------
    found : xarray.Dataset
        Of `proprotor.robust_boundary`.
    """
    records = []
    for place, name in enumerate(found.input.values.tolist()):
        one = found.isel(input=place)
        worst, low, high = (float(one[end] / one.deck_unit_in_si) for end in ("value", "low", "high"))
        slope = float(one.derivative * (one.high - one.low)) / KNOT
        row = (name, one.deck_unit.item(), worst, low, high, one.side.item(), slope)
        records.append(dict(zip(COLUMNS, row, strict=True)))
    return records


def robust_cells(record: dict[str, Any]) -> tuple[str, ...]:
    """Return a record as the cells of a row, in the order of `COLUMNS`."""
    name, unit, *numbers, side, slope = record.values()
    return (
        name,
        unit,
        *(f"{number:.5g}" for number in numbers),
        side,
        "" if math.isnan(slope) else f"{slope:.2f}",
    )


def lowest_of_each_mode(found: Dataset) -> list[tuple[str, str]]:
    """Return the name and the lowest flutter speed in KTAS of each mode that is the first instability of a design."""
    speeds = found.speed_of_first.values / KNOT
    return [(str(name), f"{speed:.2f}") for name, speed in zip(found["first"].values, speeds, strict=True)]


def robust_verdict(found: Dataset) -> str:
    """Return the worst flutter speed in a sentence, or the limit that is known of it."""
    below, above = (float(found[end]) / KNOT for end in ("speed_below", "speed_above"))
    if math.isfinite(below):
        return f"A design of the box is unstable already at the lowest airspeed, {below:.2f} {KTAS}."
    if not math.isfinite(found.speed):
        least = f"the least damping is {100 * float(found.least_damping):.3g} % of critical"
        return f"No design that was tried becomes unstable up to {above:.2f} {KTAS}; {least}, at the inputs above."
    speed = marked(f"{float(found.speed) / KNOT:.2f}", found.warning.item())
    where = f"{speed} {KTAS} ({float(found.speed):.6g} m/s)"
    return f"Worst flutter speed found: {where}, {found['mode'].item()}, {float(found.frequency) / math.tau:.4g} Hz."


def robust_counts(found: Dataset) -> list[str]:
    """Return how the box was searched in sentences: the designs tried, and those of which nothing is known."""
    counts = f"{found.attrs['evaluated']} designs were analysed; {found.attrs['above']} are stable throughout"
    lines = [f"{counts}, {found.attrs['below']} are unstable from the lowest airspeed on."]
    if found.attrs["failed"]:
        lines.append(
            f"{found.attrs['failed']} could not be analysed, the first because: {found.attrs['reason']}."
        )
    return [*lines, str(found.attrs["search"])]
