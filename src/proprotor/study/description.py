"""What a study was asked, as plain data: enough to ask the same again, from a file or from the attributes of a result.

The tables of a description are those of a study file (`proprotor.study.study_file`). A result has them as JSON in its
attribute ``study``. Lists of more than a few values stay out of it, because the result has them as coordinates.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from proprotor.datum import Datum, deck_unit
from proprotor.deck.vary import added_loops, varied_numbers
from proprotor.model.configuration import Configuration
from proprotor.model.deck_fingerprint import deck_fingerprint
from proprotor.model.options_in_force import plain
from proprotor.study.designs import AIRSPEED, SPEED, Plan, label_of, number_of
from proprotor.study.input_ranges import LogRange, Normal, Relative
from proprotor.typing import Array

ATTRIBUTE = "study"  # of a result
IN_RESULTS = "as in the results"  # in place of a long list of values
NONE = "none"  # in place of None, which TOML has not
_MOST_VALUES = 100  # of a list that is written out


def described(
    case: Configuration,
    plan: Plan,
    known: Mapping[str, Datum],
    airspeed: Any,
    speeds: Array | None,
    quantities: Sequence[str],
    tolerance: float | None,
    options: Mapping[str, Any],
) -> dict[str, Any]:
    """Return what a study was asked as plain data.

    Parameters
    ----------
    case : Case
    plan : Plan
    known : mapping
        The numbers that may vary, by path.
    airspeed : object
        As the caller gave it.
    speeds : array or None
        The same in m/s; None where airspeed is among the inputs.
    quantities : sequence of str
    tolerance : float, optional
        Of a flutter speed, m/s, if the caller gave one.
    options : mapping
        Options of the model as the caller gave them.
    """
    own: dict[str, Any] = {"case": _origin(case)[0], "deck": deck_fingerprint(case), "plan": plan.method}
    own |= plan.settings
    if speeds is not None:
        own["airspeed"] = airspeed if isinstance(airspeed, str) else _listed(speeds.tolist())
    own["quantities"] = list(quantities)
    if tolerance is not None:
        own["tolerance"] = float(tolerance)
    return {
        "study": own,
        **_origin(case)[1],
        "inputs": {label_of(name): _input(plan, name, known) for name in plan.inputs},
        "options": {name: _option(value) for name, value in options.items()},
    }


def _origin(case: Configuration) -> tuple[str, dict[str, Any]]:
    """Return the name or path of the deck of a case, and what was set or varied in it, as tables of a description."""
    if case.deck is None or added_loops(case):
        return "", {}
    name, settings = case.deck.origin
    tables = {"set": settings, "vary": {path: plain(si) for path, si in varied_numbers(case).items()}}
    return name, {table: entries for table, entries in tables.items() if entries}


def _input(plan: Plan, name: Any, known: Mapping[str, Datum]) -> Any:
    """Return how an input varies as plain data: as it was given if that is plain, else in SI."""
    given = plan.inputs[name]
    drawn = plan.method not in ("grid", "points")
    known_kind = not hasattr(given, "ppf") or isinstance(given, tuple)
    if drawn and not known_kind:
        return _of_scipy(given)
    entries = given if isinstance(given, list | tuple) else [given]
    if not all(isinstance(entry, str | int | float) for entry in entries):
        given = plan.read(label_of(name), given, number_of(name, {**known, AIRSPEED: SPEED}))
    if drawn:
        return _limits(given)
    if isinstance(given, str | int | float):
        return _number(given)
    values = list(map(_number, given)) if isinstance(given, list | tuple) else given.tolist()
    return _listed(values)


def _number(given: Any) -> Any:
    """Return a text as it is, and a number as one of Python's own."""
    return given if isinstance(given, str | bool | int) else float(given)


def _listed(values: Any) -> Any:
    """Return a list of values; a long one stands in the results."""
    return IN_RESULTS if isinstance(values, list) and len(values) > _MOST_VALUES else values


def _limits(given: Any) -> dict[str, Any]:
    """Return a pair of limits, or a distribution of this package, as plain data."""
    first, second = map(_number, given[:2])
    if isinstance(given, Normal):
        return {"mean": first, "deviation": second}
    found = {"low": first, "high": second}
    if isinstance(given, Relative):
        found["relative"] = True
    if isinstance(given, LogRange) or (isinstance(given, Relative) and given.logarithmic):
        found["logarithmic"] = True
    return found


def _of_scipy(given: Any) -> dict[str, Any]:
    """Return a frozen distribution of scipy.stats as plain data; of any other distribution the name of its class."""
    if not (hasattr(given, "dist") and hasattr(given, "kwds")):
        return {"unknown": type(given).__name__}
    arguments = {
        "args": list(map(_number, given.args)),
        "kwds": {name: _number(value) for name, value in given.kwds.items()},
    }
    return {"scipy": given.dist.name} | {name: some for name, some in arguments.items() if some}


def _option(value: Any) -> Any:
    """Return an option as plain data without None, which TOML has not."""
    written = plain(value)
    if isinstance(written, dict):
        return {name: part for name, part in written.items() if part is not None}
    return NONE if written is None else written


def as_attribute(description: Mapping[str, Any]) -> dict[str, str]:
    """Return a description as an attribute of the results."""
    return {ATTRIBUTE: json.dumps(description)}


def with_deck_units(coordinates: Mapping[str, Any], case: Configuration) -> dict[str, Any]:
    """Return coordinates of a dataset with the units, as attributes, in which the deck has the inputs.

    Parameters
    ----------
    coordinates : mapping
        Dimensions, values and perhaps attributes of each, by name.
    case : Case
    """
    found = {}
    for name, (dims, values, *attributes) in coordinates.items():
        number = case.given.get(name)
        if number is not None and isinstance(number.si, float):
            unit, size = deck_unit(number)
            attributes = [{**attributes[0], "deck_unit": unit, "deck_unit_in_si": size}]
        found[name] = (dims, values, *attributes)
    return found
