"""A study as a table of its designs: inputs in the units of the deck, and the stability or the failure of each."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.doubts import reasons_for_doubt
from proprotor.tables.csv_text import csv_of
from proprotor.tables.study_summary import study_summary
from proprotor.typing import Array, DataArray, Dataset
from proprotor.units import KNOT, KTAS

_AIRSPEED, _DESIGN = "airspeed", "design"
_AS_JSON = ("options", "study")  # attributes of results that hold plain data
_TRIM = {  # of a study at one airspeed: variable, column, and its unit in SI
    "collective": ("collective (deg)", math.radians(1)),
    "thrust": ("thrust (N)", 1.0),
    "torque": ("torque (N m)", 1.0),
}


@dataclass(frozen=True, eq=False)
class StudyTable:
    """The designs of a study, one after another, with numbers in the units that people read.

    Parameters
    ----------
    results : xarray.Dataset
        Of `proprotor.study`.

    Raises
    ------
    InputError
        When the results are not of a study.
    """

    results: Dataset

    def __post_init__(self) -> None:
        if not {"reason", "warning"} <= set(self.results.data_vars) or "mode" in self.results.dims:
            raise InputError("results", None, "must be a study of proprotor.study")

    @cached_property
    def axes(self) -> tuple[str, ...]:
        """Dimensions of the designs: the inputs of a grid, or ``design``."""
        return tuple(str(name) for name in self.results.reason.dims if name != _AIRSPEED)

    @cached_property
    def speeds(self) -> Array | None:
        """Airspeeds (speeds,) of every design, m/s; None where airspeed is an input of the designs."""
        airspeed = self.results.get(_AIRSPEED)
        if airspeed is None or _DESIGN in airspeed.dims:
            return None
        return np.atleast_1d(np.asarray(airspeed.values, dtype=float))

    def of_designs(self, name: str) -> Array:
        """Return a variable of the designs (designs,), or of their points (designs, speeds)."""
        found = self.results[name]
        along = _AIRSPEED in found.dims and _AIRSPEED not in self.axes
        array = found.transpose(*self.axes, *[_AIRSPEED] * along).values
        count = math.prod(self.results.sizes[axis] for axis in self.axes)
        return array.reshape(count, *array.shape[len(self.axes) :])

    @cached_property
    def inputs(self) -> dict[str, list[float]]:
        """Inputs (designs,) by the head of their column, in the units of the deck; the airspeed in knots and in m/s."""
        sizes = {axis: self.results.sizes[axis] for axis in self.axes}
        found: dict[str, Any] = {}
        for name, own in self.results.coords.items():
            if name == _DESIGN or not set(own.dims) <= set(self.axes) or (name == _AIRSPEED and not own.dims):
                continue
            values = own.expand_dims({axis: size for axis, size in sizes.items() if axis not in own.dims})
            flat = np.asarray(values.transpose(*self.axes).values, dtype=float).reshape(-1)
            found |= {head: _rounded(flat / size) for head, size in _columns(str(name), own).items()}
        return found

    def records(self) -> list[dict[str, Any]]:
        """Return a record for each design, with units in the names; None for what a design has not.

        Returns
        -------
        list of dict
            The number of the design, its inputs in the units of the deck, what is known of its stability, and the texts
            "note", "warning" (of the flutter speed), "doubts" (of its points) and "reason" (why points failed).
        """
        columns = {_DESIGN: self._numbers, **self.inputs, **self._stability(), **self._texts()}
        plain = {head: [_plain(value) for value in column] for head, column in columns.items()}
        return [dict(zip(plain, row, strict=True)) for row in zip(*plain.values(), strict=True)]

    def csv(self) -> bytes:
        """Return `records` as CSV in UTF-8, see `proprotor.tables.csv_text`."""
        records = self.records()
        return csv_of(records, list(records[0]), self.results.attrs)

    def document(self) -> dict[str, Any]:
        """Return the whole study as plain data: its origin, what was asked, and `findings`."""
        asked = {
            name: json.loads(self.results.attrs[name]) for name in _AS_JSON if name in self.results.attrs
        }
        return stamp.of(self.results.attrs) | asked | self.findings()

    def findings(self) -> dict[str, Any]:
        """Return what the study found as plain data: `study_summary`, and the records as ``designs``."""
        return study_summary(self.results) | {"designs": self.records()}

    @property
    def _numbers(self) -> Array:
        return np.arange(math.prod(self.results.sizes[axis] for axis in self.axes))

    def _stability(self) -> dict[str, Any]:
        """Return the columns of numbers, by head."""
        found: dict[str, Any] = {}
        if "flutter_speed" in self.results:
            found |= self._flutter()
        elif "damping_ratio" in self.results:
            found |= self._least_stable()
        if self.of_designs("reason").ndim == 1:
            for name, (head, size) in _TRIM.items():
                if name in self.results:
                    found[head] = self.of_designs(name) / size
        return found

    def _flutter(self) -> dict[str, Any]:
        names = ("flutter_speed", "flutter_speed_above", "flutter_speed_below")
        speed, above, below = (self.of_designs(name) for name in names)
        frequency = self.of_designs("flutter_frequency")
        limits = {"flutter speed above": above, "flutter speed below": below}
        return {
            "result": list(map(_result, speed, above, below, frequency)),
            f"flutter speed ({KTAS})": speed / KNOT,
            "flutter speed (m/s)": speed,
            **{f"{head} ({KTAS})": limit / KNOT for head, limit in limits.items()},
            "flutter frequency (Hz)": frequency / (2 * math.pi),
            "flutter mode": self.of_designs("flutter_mode"),
            "flutter coordinate": self.of_designs("flutter_coordinate"),
            "least damping (% of critical)": 100 * self.of_designs("flutter_least_damping"),
        }

    def _least_stable(self) -> dict[str, Any]:
        """Return the point of each design with the lowest damping ratio."""
        ratio, growth, frequency = (
            _two_axes(self.of_designs(name)) for name in ("damping_ratio", "growth_rate", "frequency")
        )
        known = np.isfinite(ratio)
        at = np.where(known, ratio, np.inf).argmin(axis=1)[:, None]
        found = {
            "lowest damping (% of critical)": 100 * np.take_along_axis(ratio, at, 1)[:, 0],
            "lowest damping frequency (Hz)": np.take_along_axis(frequency, at, 1)[:, 0] / (2 * math.pi),
            "unstable points": (growth > 0).sum(axis=1),
        }
        if self.speeds is not None:
            where = np.where(known.any(axis=1), self.speeds[at[:, 0]], np.nan)
            found[f"lowest damping at ({KTAS})"] = where / KNOT
        return found

    def _texts(self) -> dict[str, Any]:
        reasons, warnings = (_two_axes(self.of_designs(name)) for name in ("reason", "warning"))
        found: dict[str, Any] = {}
        if "flutter_note" in self.results:
            found |= {"note": self.of_designs("flutter_note"), "warning": self.of_designs("flutter_warning")}
        return found | {
            "doubts": ["; ".join(reasons_for_doubt(row.tolist())) for row in warnings],
            "reason": [self._reason(row) for row in reasons],
        }

    def _reason(self, reasons: Array) -> str:
        """Return why a design failed, or that some of its airspeeds did."""
        failed = np.flatnonzero(reasons != "")
        if not len(failed):
            return ""
        first = str(reasons[failed[0]])
        if len(failed) == len(reasons) or self.speeds is None:
            return first
        at = f"{self.speeds[failed[0]] / KNOT:.6g} {KTAS}"
        return f"{len(failed)} of {len(reasons)} airspeeds failed, at {at}: {first}"


def _columns(name: str, own: DataArray) -> dict[str, float]:
    """Return the heads of the columns of an input, each with its unit in SI."""
    if name == _AIRSPEED:
        return {f"{name} ({KTAS})": KNOT, f"{name} (m/s)": 1.0}
    unit = str(own.attrs.get("deck_unit", own.attrs.get("units", "")))
    return {f"{name} ({unit})" if unit else name: float(own.attrs.get("deck_unit_in_si", 1.0))}


def _result(speed: float, above: float, below: float, frequency: float) -> str:
    """Return what became of a design in words."""
    if math.isfinite(above):
        return f"none up to {above / KNOT:.2f} {KTAS}"
    if math.isfinite(below):
        return f"unstable at {below / KNOT:.2f} {KTAS} already"
    if math.isfinite(speed):
        return "flutter" if frequency else "divergence"
    return "failed"


def _two_axes(array: Array) -> Array:
    return array[:, None] if array.ndim == 1 else array


def _rounded(values: Array) -> list[float]:
    """Return values without the rounding of the conversion of their unit."""
    return [float(f"{value:.12g}") for value in values]


def _plain(entry: Any) -> Any:
    """Return a number or a text of a record; None for a number that is not finite."""
    if isinstance(entry, str):
        return str(entry)
    if isinstance(entry, int | np.integer):
        return int(entry)
    return float(entry) if np.isfinite(entry) else None
