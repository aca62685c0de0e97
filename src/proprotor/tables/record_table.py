"""Modes that were identified in a record as records: rows that `proprotor.tables.points` reads again."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from proprotor.typing import Dataset

_HERTZ, _PERCENT = 2 * np.pi, 0.01


def identified_records(found: Dataset, point: Mapping[str, Any] | None = None) -> list[dict[str, Any]]:
    """Return a record for each mode, in Hz and percent of critical damping, each with its standard error.

    Parameters
    ----------
    found : xarray.Dataset
        Of `proprotor.records.identify.identify`.
    point : mapping, optional
        Entries that go before the others in every record, such as the airspeed of the test point.
    """
    rows = []
    for place in range(found.sizes["mode"]):
        own = found.isel(mode=place)
        rows.append(
            dict(point or {})
            | {
                "frequency [Hz]": float(own.frequency) / _HERTZ,
                "frequency_error [Hz]": float(own.frequency_error) / _HERTZ,
                "damping [%]": float(own.damping_ratio) / _PERCENT,
                "damping_error [%]": float(own.damping_error) / _PERCENT,
                "label": str(found.attrs["record"]),
                "source": f"{found.attrs['method']}, {found.attrs['duration']:.4g} s",
                "warning": str(own.warning.item()),
            }
        )
    return rows
