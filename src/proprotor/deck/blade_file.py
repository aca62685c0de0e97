"""Read the stations of an elastic blade from CSV, as spreadsheets write it."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from proprotor.errors import InputError
from proprotor.files.csv_columns import (
    Fault,
    Head,
    Line,
    check_order,
    factor_of,
    fault_at,
    number_in,
    table_of,
)
from proprotor.files.text import read_text
from proprotor.rotor.blade_stations import FEWEST_STATIONS, BladeStations
from proprotor.typing import Array

_LARGEST = 1_000_000  # bytes
_MOST_STATIONS = 10_000
_ROUNDING = 1e-3  # of the radius, by which the last station may miss the tip
# Columns by their names in files, with the SI unit and the sign of their values.
_COLUMNS = {
    "radius": ("m", "not negative", ("r", "r_over_R", "radius", "station", "x", "x/R", "r/R")),
    "mass_per_length": ("kg/m", "above zero", ("mass", "m", "mass_per_length")),
    "flatwise_stiffness": (
        "N*m**2",
        "above zero",
        ("EI_flat", "EI_flatwise", "EI_beam", "EI_beamwise", "EI_flap"),
    ),
    "edgewise_stiffness": (
        "N*m**2",
        "above zero",
        ("EI_edge", "EI_edgewise", "EI_chord", "EI_chordwise", "EI_lag"),
    ),
    "torsion_stiffness": ("N*m**2", "above zero", ("GJ", "torsion_stiffness")),
    "twist": ("rad", "", ("twist", "structural_twist", "theta")),
    "chord": ("m", "above zero", ("chord", "c")),
    "mass_offset": ("m", "", ("mass_offset", "x_cg", "cg", "center_of_gravity", "centre_of_gravity")),
    "aerodynamic_center": (
        "m",
        "",
        ("aerodynamic_center", "aerodynamic_centre", "x_ac", "ac", "quarter_chord"),
    ),
    "elastic_axis": ("m", "", ("elastic_axis", "x_ea", "ea", "pitch_axis", "shear_center")),
    "pitch_inertia_per_length": ("kg*m", "not negative", ("pitch_inertia", "I_theta", "inertia")),
}
_PLACES = (
    "mass_offset",
    "aerodynamic_center",
)  # aft of the pitch axis, or of the line that elastic_axis is told from
_OPTIONAL = ("chord", "pitch_inertia_per_length", "elastic_axis", *_PLACES)
_PER_RADIUS = ("r_over_R", "x/R", "r/R")


def read_blade(path: str | os.PathLike[str], *, radius: float | None = None, **held: Any) -> BladeStations:
    """Return the stations of a blade from a CSV file.

    The first line names the columns with their units, in brackets or parentheses: ``r [in], mass [lb/ft], EI_flat
    [lbf*in**2], EI_edge [lbf*in**2], GJ [lbf*in**2], twist [deg]``, and perhaps ``chord`` and ``pitch_inertia``. The
    columns ``mass_offset`` (or ``x_cg``) and ``aerodynamic_center`` (``x_ac``) are aft of the pitch axis; with a column
    ``elastic_axis`` (``x_ea``) all three are aft of one line, and the elastic axis stands for the pitch axis. Other
    columns are left aside. Between semicolons or tabs a number may have a decimal comma.

    Parameters
    ----------
    path : str or path
    radius : float, optional
        Radius of the rotor, m, at which the last station must be; needed where the stations are r/R.
    **held
        Fields of `BladeStations` that no column has: `pitch_bearing` and `control_stiffness`.

    Returns
    -------
    BladeStations

    Raises
    ------
    InputError
        When the file cannot be read or breaks a rule: one line with the file, the line and column in it and the rule.
    """
    name = Path(path).name
    try:
        heads, rows = table_of(read_text(Path(path), "file", name, _LARGEST))
        own = _own_columns(heads)
        columns: dict[str, Any] = _from_pitch_axis(_columns(own, rows, _scales(own, radius), radius))
    except Fault as fault:
        raise InputError("file", name, str(fault)) from None
    return BladeStations(**columns, **held)


def _own_columns(heads: list[Head]) -> dict[str, Head]:
    """Return the heads of the columns by field; refuse a table that lacks a column or has it twice."""
    found: dict[str, Head] = {}
    for field, (_, _, names) in _COLUMNS.items():
        known = {name.lower() for name in names}
        fit = [head for head in heads if head.name.lower() in known]
        if len(fit) > 1:
            raise Fault(f"has two columns for {field}: {fit[0].text} and {fit[1].text}")
        if fit:
            found[field] = fit[0]
        elif field not in _OPTIONAL:
            raise Fault(f"has no column for {field}; name it {' or '.join(names[:3])}, with its unit")
    return found


def _scales(own: dict[str, Head], radius: float | None) -> dict[str, float]:
    """Return how many SI units one unit of each column is."""
    found = {field: factor_of(head, _COLUMNS[field][0]) for field, head in own.items() if field != "radius"}
    head = own["radius"]
    if head.name not in _PER_RADIUS:
        return found | {"radius": factor_of(head, "m")}
    if radius is None:
        raise Fault(f"column {head.place + 1} ({head.text}): needs the radius of the rotor")
    return found | {"radius": factor_of(head, "") * radius}


def _columns(
    own: dict[str, Head], rows: Iterator[Line], scales: dict[str, float], radius: float | None
) -> dict[str, Array]:
    """Return the columns in SI; refuse a value that breaks its rule, stations that do not increase or miss the tip."""
    import numpy as np

    found: dict[str, list[float]] = {field: [] for field in own}
    for number, cells in rows:
        for field, head in own.items():
            value = number_in(number, cells, head) * scales[field]
            _check(number, head, _COLUMNS[field][1], value)
            found[field].append(value)
        if len(found["radius"]) > 1:
            check_order(number, own["radius"], *found["radius"][:-3:-1])
        if len(found["radius"]) > _MOST_STATIONS:
            raise Fault(f"line {number}: must have at most {_MOST_STATIONS} stations")
    if len(found["radius"]) < FEWEST_STATIONS:
        raise Fault(f"must have at least {FEWEST_STATIONS} stations, and has {len(found['radius'])}")
    if radius is not None:
        _check_tip(number, own["radius"], found["radius"][-1], radius)
    return {field: np.array(values) for field, values in found.items()}


def _from_pitch_axis(columns: dict[str, Array]) -> dict[str, Array]:
    """Return the columns with places on the chord aft of the elastic axis, for which the pitch axis stands."""
    axis = columns.pop("elastic_axis", None)
    if axis is None:
        return columns
    if not any(name in columns for name in _PLACES):
        raise Fault(
            "has a column for elastic_axis, and none for mass_offset or aerodynamic_center to count from it"
        )
    return columns | {name: columns[name] - axis for name in _PLACES if name in columns}


def _check(number: int, head: Head, sign: str, value: float) -> None:
    if (sign == "above zero" and value <= 0) or (sign == "not negative" and value < 0):
        raise fault_at(number, head, f"must be {sign}" if sign == "above zero" else "must not be negative")


def _check_tip(number: int, head: Head, tip: float, radius: float) -> None:
    """Refuse a last station that is not at the radius of the rotor, as that of r in a column for r/R."""
    if abs(tip - radius) > _ROUNDING * radius:
        rule = f"is {tip / radius:.6g} R; the last station must be the tip, R = {radius:.6g} m"
        raise fault_at(number, head, rule)
