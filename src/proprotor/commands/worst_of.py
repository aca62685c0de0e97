"""The option `--worst-of` of `proprotor boundary`: the worst flutter speed of a box of inputs."""

from __future__ import annotations

from typing import Any

import numpy as np

from proprotor.case import Case
from proprotor.commands import arguments, output
from proprotor.commands.waiting import waiting
from proprotor.errors import InputError
from proprotor.tables.csv_text import csv_of
from proprotor.tables.robust_table import (
    COLUMNS,
    lowest_of_each_mode,
    robust_cells,
    robust_counts,
    robust_records,
    robust_verdict,
)
from proprotor.typing import Dataset
from proprotor.units import KTAS

_RULE = 'must be an input and two limits, such as "rotor.precone=1:4 deg" or "rotor.chord=0.9:1.1 of deck"'


def write_worst_of(
    request: arguments.Request, outputs: output.Outputs, worst_of: tuple[str, ...], scan: str | None
) -> None:
    """Search the box of `--worst-of`, and write what was found.

    Raises
    ------
    InputError
        For what is no input with two limits, and an input that is given twice.
    """
    from proprotor.study.robust_boundary import robust_boundary  # here, because --against needs no study

    box: dict[str, Any] = {}
    for text in worst_of:
        path, values = arguments.name_and_value("--worst-of", text, _RULE)
        if path in box:
            raise InputError("--worst-of", text, "must not give an input twice")
        box[path] = arguments.limits("--worst-of", text, values)
    case = request.load()
    with waiting("Looking for the worst design"):
        found = robust_boundary(case, box, scan, **request.options)
    records = robust_records(found)
    outputs.write(
        document=lambda: output.about(case, request) | _document(found, records),
        table=lambda: _print(case, found, records),
        csv=lambda: csv_of(records, COLUMNS, found.attrs),
    )
    output.exit_without(np.isfinite([found.speed, found.speed_below, found.speed_above]).any())


def _document(found: Dataset, records: list[dict[str, Any]]) -> dict[str, Any]:
    numbers = {
        "worst flutter speed (m/s)": "speed",
        "unstable from the lowest airspeed (m/s)": "speed_below",
        "stable up to (m/s)": "speed_above",
        "frequency (rad/s)": "frequency",
        "least damping (damping ratio)": "least_damping",
    }
    return {name: float(found[own]) for name, own in numbers.items()} | {
        "mode": found["mode"].item() or None,
        "warning": found.warning.item(),
        "inputs": records,
        "lowest flutter speed of each mode (m/s)": dict(
            zip(found["first"].values.tolist(), found.speed_of_first.values.tolist(), strict=True)
        ),
        **{name: found.attrs[name] for name in ("evaluated", "below", "above", "failed", "reason", "search")},
    }


def _print(case: Case, found: Dataset, records: list[dict[str, Any]]) -> None:
    output.print_head(case, found.attrs, found.input.values.tolist())
    output.print_table(COLUMNS, map(robust_cells, records), text=("input", "unit", "side"))
    if found.sizes["first"] > 1:
        output.print_table(
            ("first instability", f"lowest found, {KTAS}"),
            lowest_of_each_mode(found),
            text=("first instability",),
        )
    out = output.console()
    out.print(robust_verdict(found), style="bold")
    output.print_footnotes(filter(None, [found.warning.item()]))
    for line in robust_counts(found):
        out.print(line)
