"""Sensitivities as records: in the units that people read, and in the units that the deck is written in."""

from __future__ import annotations

from typing import Any

from proprotor.case import Case
from proprotor.datum import deck_unit
from proprotor.deck.vary import inputs_at
from proprotor.model.doubts import marked
from proprotor.tables.digits import significant
from proprotor.typing import Dataset
from proprotor.units import KNOT, KTAS

# For each quantity: the unit that people read, and how many SI units one such unit is.
READ_IN = {"flutter_speed": (KTAS, KNOT), "damping": ("% of critical", 0.01)}
NEARLY_DEFECTIVE = "The mode nearly coincides with another: derivatives hold in a small range only."


def sensitivity_records(case: Case, found: Dataset, of: str) -> list[dict[str, Any]]:
    """Return a record for each input of a sensitivity, the largest effect of 1 % first.

    Parameters
    ----------
    case : Case
    found : xarray.Dataset
        Of `Case.sensitivity`, for one boundary or mode.
    of : str
        Quantity whose derivatives were found, a key of `READ_IN`.

    Returns
    -------
    list of dict
        Value, derivatives and status of each input, with units in the names.
    """
    read_in, factor = READ_IN[of]
    numbers = inputs_at(case, found.input.values.tolist())
    records = []
    for place, path in enumerate(found.input.values.tolist()):
        unit, size = deck_unit(numbers[path])
        relative = float(found.relative.values[place]) / factor
        records.append(
            {
                "input": path,
                "value": numbers[path].written,
                "unit": unit,
                f"derivative ({read_in} per unit)": float(found.derivative.values[place]) * size / factor,
                f"for +1 % ({read_in})": relative / 100 if found.value.values[place] else None,
                "SI unit": numbers[path].unit,
                "derivative (SI)": float(found.derivative.values[place]),
                "exact": bool(found.exact.values[place]),
                "status": numbers[path].status,
                "warning": found.warning.item(),
            }
        )
    return sorted(records, key=lambda record: -abs(record[f"for +1 % ({read_in})"] or 0.0))


def sensitivity_row(record: dict[str, Any], read_in: str) -> tuple[str, ...]:
    """Return an input, its value, derivative, unit and change for +1 % as cells of a table; "" for no change.

    `read_in` is the unit of the quantity, from `READ_IN`.
    """
    change = record[f"for +1 % ({read_in})"]
    return (
        record["input"],
        record["value"],
        marked(significant(record[f"derivative ({read_in} per unit)"], 4, "+"), record["warning"]),
        record["unit"],
        "" if change is None else marked(significant(change, 3, "+"), record["warning"]),
    )
