"""Responses to gusts as records: one for each output."""

from __future__ import annotations

from typing import Any

from proprotor.typing import Dataset


def turbulence_records(found: Dataset) -> list[dict[str, Any]]:
    """Return a record for each output with its root mean square.

    Parameters
    ----------
    found : xarray.Dataset
        Of `proprotor.responses.gust_response.gust_response`, at one airspeed.
    """
    return [
        {
            "output": str(name),
            "rms": float(found.rms.sel(output=name)),
            "unit": str(found.output_unit.sel(output=name).item()),
        }
        for name in found.output.values
    ]


def gust_records(found: Dataset) -> list[dict[str, Any]]:
    """Return a record for each output and gradient with the extremes.

    Parameters
    ----------
    found : xarray.Dataset
        Of `proprotor.responses.discrete_gust.discrete_gust`.
    """
    return [
        {
            "output": str(name),
            "gradient (m)": float(gradient),
            "lowest": float(found.lowest.sel(output=name, gradient=gradient)),
            "highest": float(found.highest.sel(output=name, gradient=gradient)),
            "unit": str(found.output_unit.sel(output=name).item()),
        }
        for name in found.output.values
        for gradient in found.gradient.values
    ]
