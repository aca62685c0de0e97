"""Records and sentences on stability boundaries, in the units people read."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from proprotor.model.configuration import Configuration
from proprotor.model.doubts import doubt_at, marked
from proprotor.model.stamp import density_of
from proprotor.units import KEAS, KNOT, KTAS, SEA_LEVEL_DENSITY, speed_factor

if TYPE_CHECKING:
    from proprotor.stability.boundary import Boundary
    from proprotor.stability.flutter import FlutterPoint

_SAME_AIR = 0.005  # of the density at sea level: KEAS and KTAS differ by a quarter of a percent

_CELLS: dict[str, Callable[[Boundary, float], Any]] = {  # of a boundary, and of a rotor speed in rad/s
    "airspeed (KTAS)": lambda boundary, _: boundary.position / KNOT,
    "airspeed (KEAS)": lambda boundary, _: equivalent(boundary.position, boundary.stamp),
    "airspeed (m/s)": lambda boundary, _: boundary.position,
    "frequency (Hz)": lambda boundary, _: boundary.frequency / (2 * math.pi),
    "frequency (per rev)": lambda boundary, rotor_speed: boundary.frequency / rotor_speed,
    "mode": lambda boundary, _: boundary.mode,
    "kind": lambda boundary, _: boundary.kind,
    "onset": lambda boundary, _: boundary.onset,
    "mechanism": lambda boundary, _: dict(boundary.mechanism),
    "growth per airspeed (1/m)": lambda boundary, _: boundary.rate,
    "branch": lambda boundary, _: boundary.branch,
    "warning": lambda boundary, _: boundary.warning,
}
COLUMNS = tuple(_CELLS)


def equivalent(airspeed: float, found: Mapping[Any, Any]) -> float:
    """Return a true airspeed (m/s) in KEAS, in the air of a stamp; NaN in a vacuum or in air that is not known."""
    density = density_of(found)
    return airspeed / float(speed_factor(KEAS, density)) if density else math.nan


def _and_equivalent(airspeed: float, found: Mapping[Any, Any], unit: str, warning: str) -> str:
    """Return an airspeed in KEAS to stand beside KTAS, where the air is not that at sea level; "" otherwise."""
    density = density_of(found)
    if unit != KTAS or not density or abs(density / SEA_LEVEL_DENSITY - 1) < _SAME_AIR:
        return ""
    return f", {marked(f'{equivalent(airspeed, found):.2f}', warning)} {KEAS}"


def boundary_record(boundary: Boundary, case: Configuration) -> dict[str, Any]:
    """Return a boundary in the units people read, by `COLUMNS`."""
    rotor_speed = float(case.operation.rotor_speed)
    return {column: cell(boundary, rotor_speed) for column, cell in _CELLS.items()}


def boundary_row(record: dict[str, Any], factor: float) -> tuple[str, ...]:
    """Return a boundary's airspeed, Hz, /rev, mode, kind, "begins" or "ends", and mechanism as cells of a table.

    The airspeed is in a unit of `factor` m/s.
    """
    return (
        marked(f"{record['airspeed (m/s)'] / factor:.2f}", record["warning"]),
        f"{record['frequency (Hz)']:.3f}",
        f"{record['frequency (per rev)']:.3f}",
        record["mode"],
        record["kind"],
        "begins" if record["onset"] else "ends",
        mechanism_message(record["mechanism"]),
    )


def modes_beyond(found: FlutterPoint, airspeed: float) -> int | None:
    """Return how many modes are beyond the level at an airspeed; None outside the range that was searched."""
    low, high = found.searched
    if not low <= airspeed <= high:
        return None
    passed = [boundary.onset for boundary in found.boundaries if boundary.position < airspeed]
    return len(found.unstable_at_start) + 2 * sum(passed) - len(passed)


def mechanism_message(mechanism: Mapping[str, float]) -> str:
    """Return which modes take part in a boundary, and how much."""
    return ", ".join(f"{name} {100 * share:.0f} %" for name, share in mechanism.items())


def least_damping_message(found: FlutterPoint, unit: str, factor: float) -> str:
    """Return the least damping of a search, with its mode and airspeed; "" where there was no mode."""
    if math.isnan(found.least_damping):
        return ""
    speed = found.least_damping_speed
    ratio = marked(f"{100 * found.least_damping:.2g}", doubt_at(found.doubts, speed))
    return f"{ratio} % of critical: {found.least_damping_mode} at {speed / factor:.4g} {unit}"


def _other_onsets(found: FlutterPoint, unit: str, factor: float) -> Iterator[str]:
    """Yield a sentence on the first onset of each kind that the flutter speed of an aircraft leaves aside."""
    kinds = {one.kind: one for one in reversed(found.boundaries) if one.onset}
    for one in sorted(kinds.values(), key=lambda one: one.position):
        if found.boundary is None or (one.kind != found.kind and one.position < found.speed):
            yield f"At {marked(f'{one.position / factor:.2f}', one.warning)} {unit} {one.event}."


def failed_records(found: FlutterPoint) -> list[dict[str, Any]]:
    """Return the airspeeds that could not be analysed, and why, as plain data."""
    return [{"from (m/s)": first, "to (m/s)": last, "reason": reason} for first, last, reason in found.failed]


def verdict(found: FlutterPoint, at: float | None, unit: str, factor: float) -> Iterator[str]:
    """Yield sentences on a search for boundaries, the answer last, where people look at the end of a terminal.

    Parameters
    ----------
    found : FlutterPoint
    at : float, optional
        Airspeed (m/s) whose margin is wanted.
    unit, factor : str, float
        Unit of airspeeds, and the unit in m/s.
    """
    yield from remarks(found, unit, factor)
    yield from answer(found, at, unit, factor)


def remarks(found: FlutterPoint, unit: str, factor: float) -> Iterator[str]:
    """Yield sentences on what stands beside the answer: other kinds of onsets, and airspeeds that failed."""
    yield from _other_onsets(found, unit, factor)
    yield from (stretch.message(unit, factor) for stretch in found.failed)


def answer(found: FlutterPoint, at: float | None, unit: str, factor: float) -> Iterator[str]:
    """Yield sentences on where a case becomes unstable, and on the margin at an airspeed; arguments of `verdict`."""
    if not math.isfinite(found.searched[0]):
        yield "No airspeed could be analysed."
        return
    low, high = (marked(f"{at / factor:.4g}", doubt_at(found.doubts, at)) for at in found.searched)
    beyond = f"below {100 * found.level:g} % of critical" if found.level else "unstable"
    if found.unstable_at_start:
        yield f"Already {beyond} at {low} {unit}: {', '.join(found.unstable_at_start)}."
    if math.isnan(found.speed) and any(one.onset for one in found.boundaries):
        yield f"No flutter begins between {low} and {high} {unit}."
    elif math.isnan(found.speed):
        yield f"No mode becomes {beyond} between {low} and {high} {unit}."
        if least := least_damping_message(found, unit, factor):
            yield f"The least damping there is {least}."
    else:
        speed = marked(f"{found.speed / factor:.2f}", found.warning)
        other = _and_equivalent(found.speed, found.stamp, unit, found.warning)
        yield f"Flutter speed {speed} {unit}{other} ({found.mode}, {found.kind})."
    if at is not None:
        yield from _margin(found, at, unit, factor)


def _margin(found: FlutterPoint, at: float, unit: str, factor: float) -> Iterator[str]:
    """Yield sentences on an airspeed: whether it was searched, whether it is stable there, and the margin."""
    beyond = f"below {100 * found.level:g} % of critical" if found.level else "unstable"
    count = modes_beyond(found, at)
    if count is None:
        ends = " to ".join(f"{end / factor:.4g}" for end in found.searched)
        yield f"{at / factor:.4g} {unit} lies outside the range searched, {ends} {unit}."
    elif count:
        here = marked(f"{at / factor:.4g}", doubt_at(found.doubts, at))
        yield f"At {here} {unit} {count} mode{'s are' if count > 1 else ' is'} {beyond}."
    if not math.isnan(found.speed):
        margin = marked(f"{100 * found.margin(at):+.1f}", found.warning)
        yield f"Margin at {at / factor:.4g} {unit}: {margin} % of that airspeed."
