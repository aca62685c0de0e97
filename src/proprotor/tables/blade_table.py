"""Rows and words on the hinged blade of an elastic one, and the lines of a deck that describe it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from proprotor.model.blade_comparison import GOOD, BladeComparison, Compared
from proprotor.rotor.blade_stations import BladeStations
from proprotor.rotor.hinged_blade import HingedBlade
from proprotor.rotor.rotor import HELD, MASS_INTEGRALS, NOTHING

_UNITS = {
    "radius": "m",
    "flap_hinge_offset": "m",
    "lag_hinge_offset": "m",
    "blade_mass": "kg",
    "structural_pitch_offset": "deg",
    "flap_stiffness": "N*m/rad",
    "lag_stiffness": "N*m/rad",
    "control_stiffness": "N*m/rad",
    "flap_outboard_fraction": "",
    "lag_outboard_fraction": "",
}
_ENDINGS = {"first_moment": "kg*m", "inertia": "kg*m**2"}
_SPREAD = {
    "flap_lag": "by bending in flap and lag",
    "section_moment": "as section moments, chord² r²",
    "propeller_moment": "as the propeller moment",
    "even": "evenly",
}


def unit_of(name: str) -> str:
    """Return the unit in which a field of a rotor is shown."""
    return (
        _UNITS[name] if name in _UNITS else next(unit for end, unit in _ENDINGS.items() if name.endswith(end))
    )


def _shown(name: str, value: float) -> float:
    return float(np.degrees(value)) if unit_of(name) == "deg" else value


def number_rows(found: HingedBlade) -> Iterator[tuple[str, str, str]]:
    """Yield field, value and unit of each number of the hinged blade."""
    for name, value in found.numbers.items():
        yield name, f"{_shown(name, value):.5g}", unit_of(name)


def pitch_stiffness_rows(found: HingedBlade) -> Iterator[tuple[str, str]]:
    """Yield each way to spread a torque with its pitch stiffness."""
    for name, value in found.pitch_stiffness._asdict().items():
        if value is not None:
            yield _SPREAD[name], f"{value:.5g}"


def comparison_columns(compared: BladeComparison) -> tuple[str, ...]:
    """Return the headings of `comparison_rows`."""
    ends = (
        f"{np.degrees(pitch):.3g} deg: {blade}"
        for pitch in compared.pitch[[0, -1]]
        for blade in ("elastic", "hinged")
    )
    return ("quantity", *ends, "difference")


def comparison_rows(compared: BladeComparison) -> Iterator[tuple[str, ...]]:
    """Yield the name of each quantity, both blades at the first and the last collective, and the largest difference.

    A difference that is not judged stands in brackets.
    """
    for one in compared.quantities:
        elastic, hinged = (_in_its_unit(compared, one, values) for values in (one.elastic, one.hinged))
        ends = (elastic[0], hinged[0], elastic[-1], hinged[-1])
        difference = f"{100 * one.difference:.1f} %"
        yield (
            f"{one.name}{_unit_in_words(one)}",
            *(f"{end:.4g}" for end in ends),
            difference if one.counts else f"({difference})",
        )


def _in_its_unit(compared: BladeComparison, one: Compared, values: Any) -> Any:
    """Return frequencies per revolution, and other values as they are."""
    return values / compared.rotor_speed if one.unit == "rad/s" else values


def _unit_in_words(one: Compared) -> str:
    unit = {"rad/s": "per rev"}.get(one.unit, one.unit)
    return f" ({unit})" if unit else ""


def records(compared: BladeComparison) -> list[dict[str, Any]]:
    """Return a row for each compared quantity and collective."""
    return [
        {
            "collective (deg)": float(np.degrees(pitch)),
            "quantity": one.name,
            "unit": one.unit,
            "elastic": float(elastic),
            "hinged": float(hinged),
            "judged": one.counts,
        }
        for one in compared.quantities
        for pitch, elastic, hinged in zip(compared.pitch, one.elastic, one.hinged, strict=True)
    ]


def verdict(compared: BladeComparison) -> Iterator[str]:
    """Yield sentences on whether a hinged blade is a good model of this blade."""
    if not compared.poor:
        within = f"all judged quantities are within {100 * GOOD:.0f} % over the whole range"
        yield f"A hinged blade is a good model: {within}."
        return
    worst = ", ".join(f"{one.name} ({100 * one.difference:.0f} %)" for one in compared.poor)
    yield f"A hinged blade is no good model of this blade in: {worst}."


def deck_lines(found: HingedBlade, table: BladeStations, file: str) -> str:
    """Return the fields of [rotor] that were found, as lines of a deck, each with its source.

    Where the table has the centre of the mass, the mass stands by stations in place of its integrals.
    """
    rpm = found.rotor_speed * 30 / np.pi
    low, high = np.degrees([found.pitch.min(), found.pitch.max()])
    source = (
        f"{Path(file).name}, nearest hinged blade at {rpm:.5g} rpm, collective {low:.4g} to {high:.4g} deg"
    )
    source = source.replace("\\", "/").replace('"', "'")
    lines = ["[rotor]"]
    by_stations = () if table.mass_offset is None else MASS_INTEGRALS
    for name, value in found.numbers.items():
        if name in by_stations:
            continue
        unit = unit_of(name)
        text = f'"{_shown(name, value):.10g} {unit}"' if unit else f"{value:.10g}"
        lines.append(f'{name} = {{ value = {text}, status = "derived", source = "{source}" }}')
    return "\n".join([*lines, *_lines_along(table, source)]) + "\n"


def _lines_along(table: BladeStations, source: str) -> Iterator[str]:
    """Yield the places on the chord along the blade, as lines of a deck, and the mass to which they belong."""
    wanted = {"aerodynamic_center": ("aerodynamic_center", "m", HELD)}
    if table.mass_offset is not None:
        wanted |= {
            "mass_distribution": ("mass_per_length", "kg/m", NOTHING),
            "mass_offset": ("mass_offset", "m", HELD),
        }
    for name, (column, unit, beyond) in wanted.items():
        values = getattr(table, column)
        if values is None:
            continue
        r, value = (
            ", ".join(f"{number:.10g}" for number in part) for part in (table.radius / table.tip, values)
        )
        told = f'unit = "{unit}", beyond = "{beyond}", status = "derived", source = "{source}"'
        yield f"{name} = {{ r_over_R = [{r}], value = [{value}], {told} }}"
