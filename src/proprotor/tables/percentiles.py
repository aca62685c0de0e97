"""Percentiles of a result as text: a number, or the bounds that are known where designs lie beyond the airspeeds."""

from __future__ import annotations

import math

from proprotor.typing import Dataset


def percentile_text(found: Dataset, place: int, factor: float = 1.0, form: str = ".2f") -> str:
    """Return a percentile as text: "312.40", "> 440.00", "< 160.00", or "300.00 to 310.00".

    Parameters
    ----------
    found : xarray.Dataset
        Of `proprotor.distribution`.
    place : int
        Which of the percentiles.
    factor : float
        SI units in the unit of the text.
    form : str
        Format of a number.
    """
    low, high = (float(found[name][place]) / factor for name in ("at_least", "at_most"))
    if low == high and math.isfinite(low):
        return f"{low:{form}}"
    if math.isinf(high):
        return f"> {low:{form}}" if math.isfinite(low) else "not known"
    return f"{low:{form}} to {high:{form}}" if math.isfinite(low) else f"< {high:{form}}"
