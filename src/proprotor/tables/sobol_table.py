"""Shares of the variance of a flutter speed as records: each with half the width of its confidence interval."""

from __future__ import annotations

from typing import Any

from proprotor.errors import InputError
from proprotor.model.doubts import marked
from proprotor.study.uncertainty import sobol_indices
from proprotor.typing import Dataset

SHARES = "shares of the variance"
WHY_NOT = "why there are no shares of the variance"
SOBOL_COLUMNS = ("input", "alone, %", "±", "with interactions, %", "±")


def sobol_summary(results: Dataset) -> dict[str, Any]:
    """Return the shares of the variance of the flutter speed of a Saltelli sample, or why there are none.

    Parameters
    ----------
    results : xarray.Dataset
        Of `proprotor.study`; of any other sample nothing is returned.

    Returns
    -------
    dict
        Shares by input with half the widths of their intervals, in percent; level of the intervals; treatment of
        designs beyond the airspeeds; doubts about flutter speeds of the sample.
    """
    if '"saltelli"' not in results.attrs.get("sample", ""):
        return {}
    try:
        found = sobol_indices(results)
    except InputError as error:
        return {WHY_NOT: str(error)}
    names = ("alone (%)", "alone ± (%)", "with interactions (%)", "with interactions ± (%)")
    parts = ("first", "first_half_interval", "total", "total_half_interval")
    records = [
        {
            "input": name,
            **{own: 100 * float(found[part][place]) for own, part in zip(names, parts, strict=True)},
        }
        for place, name in enumerate(found.input.values.tolist())
    ]
    largest_first = sorted(records, key=lambda record: -record["with interactions (%)"])
    own = {name: found.attrs[name] for name in ("confidence", "treatment", "doubts")}
    return {SHARES: largest_first} | {f"{name} of the shares": value for name, value in own.items()}


def sobol_cells(record: dict[str, Any], doubts: str) -> tuple[str, ...]:
    """Return a record as the cells of a row, in the order of `SOBOL_COLUMNS`, with a mark where there are doubts."""
    name, *numbers = record.values()
    return (name, *(marked(f"{number:.1f}", doubts) for number in numbers))
