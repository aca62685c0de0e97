"""Points of the XV-15's stability boundaries, and the boundary of the model that belongs to each point.

A boundary of the model is the lowest airspeed at which flutter of one symmetry begins with a frequency inside a band.
The bands follow from the published frequencies of the airframe at rest (NASA TM X-62,407, Fig. 7.1.4), and not from the
points:

- symmetric chord: from the geometric mean with the frequency below, of beam, to that with the one above, of torsion;
- antisymmetric beam: beam, chord and torsion lie so near each other (5.6, 6.15 and 7.3 Hz) that at 400 kt no frequency
  tells one from another. One band, from half an octave below the lowest to half an octave above the highest of the
  three, leaves out what is not of the wing: rigid body and gimbals below, pylon yaw above.

With 20 % less stiffness everywhere all frequencies of the airframe are √0.8 of themselves.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import proprotor as pp
from proprotor.units import KNOT

PUBLISHED = Path(__file__).parent / "data" / "xv15_aircraft_boundaries.csv"
RPM = np.pi / 30
SYMMETRIES = {"chord symmetric": "symmetric", "beam antisymmetric": "antisymmetric"}
HIGH_MACH = 0.9  # Prandtl and Glauert's factor is no model beyond
SCAN = "150:600:7.5ktas"
_REST = {  # NASA TM X-62,407, Fig. 7.1.4, Hz: beam, chord, torsion
    ("on", "symmetric"): (3.0, 5.9, 7.9),
    ("on", "antisymmetric"): (5.6, 6.15, 7.3),
    ("off", "symmetric"): (3.0, 5.5, 6.8),
    ("off", "antisymmetric"): (5.35, 6.0, 6.4),
}
_STIFFNESSES = (
    *("beam_stiffness", "chord_stiffness", "torsion_stiffness"),
    *(
        "downstop_stiffness_on",
        "downstop_stiffness_off",
        "spindle_yaw_stiffness_on",
        "spindle_yaw_stiffness_off",
    ),
)


class Configuration(NamedTuple):
    """A configuration of the aircraft: its deck, the share of all stiffness of wing and pylon, and the downstop."""

    deck: str
    stiffness: float
    downstop: str

    def case(self, settings: Mapping[str, str] | None = None) -> pp.Case:
        """Return the case, with settings of the deck before the loss of stiffness."""
        whole = pp.load_case(self.deck, settings)
        if self.stiffness == 1:
            return whole
        lost = {
            f"support.{name}": self.stiffness * whole.given[f"support.{name}"].si for name in _STIFFNESSES
        }
        return whole.vary(lost)

    def band(self, symmetry: str) -> tuple[float, float]:
        """Return the frequencies, Hz, between which a boundary of a symmetry is looked for."""
        beam, chord, torsion = np.sqrt(self.stiffness) * np.array(_REST[self.downstop, symmetry])
        if symmetry == "symmetric":
            return float(np.sqrt(beam * chord)), float(np.sqrt(chord * torsion))
        return float(beam / np.sqrt(2)), float(torsion * np.sqrt(2))


CONFIGURATIONS = {
    "on the downstop": Configuration("xv15-aircraft", 1.0, "on"),
    "20 % less stiff": Configuration("xv15-aircraft", 0.8, "on"),
    "off the downstop": Configuration("xv15-aircraft-off", 1.0, "off"),
}


class Point(NamedTuple):
    """A point of a boundary: configuration, mode, rotor speed in rpm, altitude in ft, true airspeed in kt."""

    configuration: str
    mode: str
    rpm: float
    altitude: float
    airspeed: float


# Points ---------------------------------------------------------------------------------------------------------------

_COLUMNS = {
    "rpm": ("rotor_speed [rpm]", "rotor_rpm"),
    "airspeed": ("airspeed [ktas]", "airspeed [kt]", "airspeed_kt"),
    "altitude": ("altitude [ft]", "altitude_ft"),
    "configuration": ("configuration", "label"),
    "mode": ("mode", "label"),
}


def read(path: str | Path = PUBLISHED) -> list[Point]:
    """Return the points of a CSV file.

    A file has the columns of `PUBLISHED`, which every plot of the package can show, or rotor_rpm, airspeed_kt,
    altitude_ft (0 where there is no such column), configuration and mode.

    Raises
    ------
    InputError
        For a missing column, and for words and numbers that are none of those known.
    """
    with open(path, newline="", encoding="utf-8") as file:
        rows = csv.DictReader(file, skipinitialspace=True)
        heads = [head.strip() for head in rows.fieldnames or ()]
        columns = {field: _column(field, heads) for field in _COLUMNS}
        rows.fieldnames = heads
        return [_point(row, columns, f"{Path(path).name}, line {rows.line_num}") for row in rows]


def _column(field: str, heads: list[str]) -> str:
    """Return the head of the column of a field."""
    found = next((head for head in _COLUMNS[field] if head in heads), None)
    if found is None and field != "altitude":
        raise pp.InputError("points", ", ".join(heads), f"needs a column {' or '.join(_COLUMNS[field])}")
    return found or ""


def _point(row: Mapping[str, str], columns: Mapping[str, str], where: str) -> Point:
    """Return the point of a row."""
    words = {field: row[columns[field]].lower() for field in ("configuration", "mode")}
    numbers = {}
    for field in ("rpm", "altitude", "airspeed"):
        written = row.get(columns[field]) or "0"
        try:
            numbers[field] = float(written)
        except ValueError:
            raise pp.InputError(where, written, "must be a number") from None
    return Point(_configuration_of(words["configuration"], where), _mode_of(words["mode"], where), **numbers)


def _configuration_of(words: str, where: str) -> str:
    """Return the name of the configuration that words mean."""
    if "20" in words and ("stiff" in words or "%" in words):
        return "20 % less stiff"
    if "off" in words or "not engaged" in words:
        return "off the downstop"
    if "on" in words.split() or "(on" in words or "airplane" in words:
        return "on the downstop"
    raise pp.InputError(where, words, f"must be a configuration: {', '.join(CONFIGURATIONS)}")


def _mode_of(words: str, where: str) -> str:
    """Return the name of the mode that words mean."""
    if "chord" in words and "asym" not in words and "anti" not in words:
        return "chord symmetric"
    if "beam" in words and ("asym" in words or "anti" in words):
        return "beam antisymmetric"
    raise pp.InputError(where, words, f"must be a mode: {', '.join(SYMMETRIES)}")


# The model ------------------------------------------------------------------------------------------------------------


class Crossing(NamedTuple):
    """The boundary of the model: true airspeed in kt (NaN without any), frequency in Hz, and its name there."""

    airspeed: float
    frequency: float
    mode: str


NONE = Crossing(np.nan, np.nan, "")


def first_crossings(found: Any, symmetry: str, band: tuple[float, float]) -> list[Crossing]:
    """Return the first flutter of a symmetry within a band of frequencies at each value of a result's input."""
    return [_first(row, symmetry, band) for row in _onsets(found)]


def _onsets(found: Any) -> Iterator[list[Crossing]]:
    """Yield where flutter begins at each value of the input, by airspeed."""
    begins = np.where(
        found.onset.values & (found.kind.values == "flutter"), found.airspeed.values / KNOT, np.nan
    )
    frequency, mode = found.frequency.values / (2 * np.pi), found["mode"].values
    for speeds, frequencies, modes in zip(begins, frequency, mode, strict=True):
        order = np.argsort(speeds)[: np.isfinite(speeds).sum()]
        yield [Crossing(*(of[place].item() for of in (speeds, frequencies, modes))) for place in order]


def _first(onsets: Iterable[Crossing], symmetry: str, band: tuple[float, float]) -> Crossing:
    own = (one for one in onsets if one.mode.startswith(symmetry) and band[0] <= one.frequency <= band[1])
    return next(own, NONE)


def boundaries(case: pp.Case, rpm: Iterable[float], **options: Any) -> Any:
    """Return all boundaries of a case at some rotor speeds, rpm."""
    return case.boundary_against({"operation.rotor_speed": np.array(sorted(rpm)) * RPM}, SCAN, **options)


def beside(points: Iterable[Point]) -> dict[Point, Crossing]:
    """Return the boundary of the model for each point."""
    points = list(points)
    found: dict[Point, Crossing] = {}
    for name, altitude in dict.fromkeys((one.configuration, one.altitude) for one in points):
        own = [one for one in points if (one.configuration, one.altitude) == (name, altitude)]
        configuration = CONFIGURATIONS[name]
        rpm = sorted({one.rpm for one in own})
        lines = boundaries(configuration.case(_altitude(altitude)), rpm)
        for mode, symmetry in SYMMETRIES.items():
            crossings = first_crossings(lines, symmetry, configuration.band(symmetry))
            at = dict(zip(rpm, crossings, strict=True))
            found |= {one: at[one.rpm] for one in own if one.mode == mode}
    return {one: found[one] for one in points}


def tip_mach(point: Point, configuration: Configuration) -> float:
    """Return the Mach number of the blade tips at a point."""
    return _mach(point, configuration.deck)


@cache
def _mach(point: Point, deck: str) -> float:
    case = pp.load_case(deck, _altitude(point.altitude))
    speed = np.hypot(point.airspeed * KNOT, point.rpm * RPM * case.rotor.radius)
    return float(speed / case.operation.speed_of_sound)


def _altitude(feet: float) -> dict[str, str] | None:
    """Return the settings of an altitude; None at sea level, where the air of the deck is kept."""
    return {"operation.altitude": f"{feet:g} ft"} if feet else None
