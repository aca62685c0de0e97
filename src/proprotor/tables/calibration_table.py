"""A calibration as records: one for each input, in the unit of its deck, and one for each number of the test points."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from proprotor.datum import Datum, deck_unit
from proprotor.typing import Dataset
from proprotor.units import KNOT

_SHOWN = {"frequency": ("Hz", 2 * np.pi), "damping": ("%", 0.01)}


def input_records(found: Dataset, numbers: Mapping[str, Datum]) -> list[dict[str, Any]]:
    """Return a record for each calibrated input.

    Parameters
    ----------
    found : xarray.Dataset
        Of `proprotor.calibration.calibrate.calibrate`.
    numbers : mapping of str to Datum
        Of the case by path, which tell the units.
    """
    rows = []
    for place, path in enumerate(found.input.values.tolist()):
        unit, factor = deck_unit(numbers[path])
        own = {name: float(found[name][place]) / factor for name in ("start", "value", "standard_error")}
        rows.append(
            {
                "input": path,
                "unit": unit,
                "start": own["start"],
                "calibrated": own["value"],
                "standard error": own["standard_error"],
                "change (%)": 100 * (own["value"] / own["start"] - 1) if own["start"] else None,
                "at bound": bool(found.at_bound[place]),
            }
        )
    return rows


def target_records(found: Dataset) -> list[dict[str, Any]]:
    """Return a record for each number of the test points, in Hz or percent of critical damping."""
    rows = []
    for place in range(found.sizes["target"]):
        own = found.isel(target=place)
        unit, factor = _SHOWN[str(own.quantity.item())]
        numbers = {
            name: float(own[name]) / factor for name in ("measured", "measured_error", "before", "after")
        }
        rows.append(
            {
                "mode": str(own["mode"].item()),
                "airspeed (KTAS)": float(own.airspeed) / KNOT,
                "quantity": str(own.quantity.item()),
                "unit": unit,
                "measured": numbers["measured"],
                "error": numbers["measured_error"],
                "before": numbers["before"],
                "after": numbers["after"],
                "misfit (errors)": float(own.misfit),
            }
        )
    return rows
