"""An envelope as records, as the lines of a table, and as sentences."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from proprotor.model.doubts import MARK, marked, reasons_for_doubt
from proprotor.stability import MET, NOT_KNOWN, NOT_MET
from proprotor.typing import Dataset
from proprotor.units import KEAS, KNOT, KTAS, SEA_LEVEL_DENSITY

SCOPE = (
    "Whirl flutter of this model alone: one part of what a showing of compliance needs, beside control surfaces, "
    "control reversal, tolerances, tests and whatever else the certification basis asks for."
)
COLUMNS = ("verdict", "ft", "rpm", "kW", KEAS, "needed", "margin", "ζ", "condition")
HEADING = f"Each condition at its worst altitude; onset and speed needed in {KEAS}, margin and ζ there in %"
TEXT = ("verdict", "condition")  # columns of the table that are words
_WORST = 3  # places of a verdict whose reasons stand below the table
_FOOT, _RPM = 0.3048, math.pi / 30


def envelope_records(found: Dataset) -> list[dict[str, Any]]:
    """Return a record for each place of an envelope: condition, rotor speed, power and altitude.

    Parameters
    ----------
    found : xarray.Dataset
        Of `Case.envelope`.
    """
    return [
        _record(found.isel(dict(zip(found.verdict.dims, place, strict=True))))
        for place in np.ndindex(found.verdict.shape)
    ]


def _record(here: Dataset) -> dict[str, Any]:
    """Return the record of one place."""
    per = math.sqrt(SEA_LEVEL_DENSITY / float(here.density))
    power = float(here.power)

    def of(name: str, factor: float = 1.0) -> float | None:
        value = float(here[name]) / factor
        return value if math.isfinite(value) else None

    def text(name: str) -> str:
        return str(here[name].item())

    return {
        "condition": text("condition"),
        "failure": bool(here.failure),
        "rotor speed (rpm)": of("turning", _RPM),
        "power (kW)": power / 1e3 if math.isfinite(power) else None,
        "altitude (m)": of("altitude"),
        "verdict": text("verdict"),
        "why": text("why"),
        f"onset ({KEAS})": of("equivalent_onset", KNOT),
        f"onset ({KTAS})": of("onset", KNOT),
        "onset (Mach)": of("mach_onset"),
        f"needed ({KEAS})": of("required", KNOT * per),
        f"dive ({KEAS})": of("dive", KNOT * per),
        "margin": of("margin"),
        "mode": text("mode") or None,
        "kind": text("kind") or None,
        "frequency (Hz)": of("frequency", 2 * math.pi),
        f"damping below required from ({KEAS})": of("damping_onset", KNOT * per),
        "damping there needed": of("damping"),
        f"damping per knot ({KEAS})": of("damping_rate", 1 / KNOT),
        "damping of mode": text("damping_mode") or None,
        "warning": text("warning"),
        "note": text("note"),
        "failure of airspeeds": text("reason"),
    }


def envelope_rows(found: Dataset) -> list[tuple[str, ...]]:
    """Return a row for each condition, rotor speed and power, at its worst altitude, as `COLUMNS` names the cells."""
    records = envelope_records(found)
    count = found.sizes["altitude"]
    groups = [records[start : start + count] for start in range(0, len(records), count)]
    return [_row(min(group, key=_severity)) for group in groups]


def _severity(record: dict[str, Any]) -> tuple[int, float, float]:
    """Return the place of a record among others, the worst first: the order of `Case.envelope`."""
    rank = (NOT_MET, NOT_KNOWN, MET).index(record["verdict"])
    margin = math.inf if record["margin"] is None else record["margin"]
    if rank == 0 and math.isinf(margin):
        margin = -math.inf
    damping = record["damping there needed"]
    return rank, margin, -math.inf if damping is None else damping


def _row(record: dict[str, Any]) -> tuple[str, ...]:
    def number(name: str, form: str, factor: float = 1.0) -> str:
        value = record[name]
        return "–" if value is None else f"{value * factor:{form}}"

    onset = number(f"onset ({KEAS})", ".1f")
    return (
        record["verdict"],
        number("altitude (m)", ".0f", 1 / _FOOT),
        number("rotor speed (rpm)", ".0f"),
        number("power (kW)", ".0f"),
        marked(onset, record["warning"]),
        number(f"needed ({KEAS})", ".1f"),
        number("margin", "+.1f", 100),
        number("damping there needed", ".2f", 100),
        record["condition"],
    )


def envelope_verdict(found: Dataset) -> str:
    """Return how many places meet the requirement, and the worst case, in sentences."""
    verdicts = found.verdict.values
    counts = {verdict: int((verdicts == verdict).sum()) for verdict in (MET, NOT_MET, NOT_KNOWN)}
    total = "; ".join(f"{count} {verdict}" for verdict, count in counts.items() if count)
    here = found.isel(dict(zip(found.verdict.dims, found.attrs["worst_place"], strict=True)))
    record = _record(here)
    margin = record["margin"]
    if record["why"]:
        how = record["why"]
    elif margin is None:
        how = f"no onset; least damping {100 * record['damping there needed']:.2g} %, {record['damping of mode']}"
    else:
        how = f"{record['kind']} of {record['mode']} {100 * margin:+.1f} % from the speed needed"
    return f"{verdicts.size} places: {total}. Worst case: {_place(record)}: {how}."


def envelope_footnotes(found: Dataset) -> Iterator[str]:
    """Yield a sentence for each reason why a place does not meet the requirement, then one for each doubt."""
    records = envelope_records(found)
    for verdict in (NOT_MET, NOT_KNOWN):
        of = [record for record in records if record["verdict"] == verdict]
        for record in sorted(of, key=_severity)[:_WORST]:
            yield f"{verdict.capitalize()}: {_place(record)}: {record['why']}."
        if len(of) > _WORST:
            yield f"{verdict.capitalize()} at {len(of) - _WORST} more."
    doubts = reasons_for_doubt(found.warning.values.ravel().tolist())
    for text, places in doubts.items():
        yield f"{MARK} Doubtful at {len(places)} of {found.verdict.size} places: {text}."


def _place(record: dict[str, Any]) -> str:
    power = record["power (kW)"]
    there = f"{record['condition']}, {record['altitude (m)'] / _FOOT:.0f} ft, {record['rotor speed (rpm)']:.0f} rpm"
    return there if power is None else f"{there}, {power:.0f} kW"
