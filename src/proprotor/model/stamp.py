"""What a result says of itself: its case, the options in force, and what its numbers rest on.

A stamp is a mapping of names to text, the same in every record, dataset, file and picture. Datasets have it among their
attributes, so that it survives netCDF. `of_case` and `of_model` make one, `options_of` takes the options out again for
whoever goes on from a result, and `told` says it in a line.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from proprotor.errors import InputError
from proprotor.files.fingerprint import fingerprint
from proprotor.model.provenance import reservations
from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.rotor.drive_train import DriveTrain
from proprotor.rotor.generated import EQUATION_SETS, EquationSet
from proprotor.rotor.options import Options, parse_options

if TYPE_CHECKING:
    from proprotor.model.configuration import Configuration
    from proprotor.model.linear_model import LinearModel

Stamp = Mapping[str, str]
NAMES = ("case", "title", "deck", "options", "reservations", "case_warnings", "made_by")
_DIGITS = 16  # of a fingerprint
_LISTED = 24  # numbers of an array that are written down; more have a fingerprint


class Origin(NamedTuple):
    """Where a linear model comes from.

    options : of the model, in force; case : None for a rotor that is not of a case
    """

    options: Options
    case: Configuration | None = None


def of_case(case: Configuration, options: Mapping[str, Any]) -> dict[str, str]:
    """The stamp of what is computed of a case with options as they were given.

    Raises
    ------
    InputError
        For options that are none.
    """
    return _stamp(Origin(parse_options(case.model_options(options)), case))


def of_model(model: LinearModel) -> dict[str, str]:
    """The stamp of what is computed of a model; empty for one that was put together elsewhere."""
    return {} if model.origin is None else _stamp(model.origin)


def of(attributes: Mapping[Any, Any]) -> dict[str, str]:
    """The stamp among other attributes."""
    return {name: str(attributes[name]) for name in NAMES if name in attributes}


def _stamp(origin: Origin) -> dict[str, str]:
    case = origin.case
    own = {"options": json.dumps(in_force(origin.options)), "made_by": f"proprotor {_version()}"}
    if case is None:
        return own
    return own | {
        "case": case.name,
        "title": case.title or case.name,
        "deck": deck_fingerprint(case),
        "reservations": " ".join(reservations(case)),
        "case_warnings": " ".join(case.warnings),
    }


@cache
def _version() -> str:
    from importlib.metadata import version

    return version("proprotor")


# The case ------------------------------------------------------------------------------------------------------------


def deck_fingerprint(case: Configuration) -> str:
    """A text that is the same for the same numbers and choices of a deck, whatever they are called.

    What a case without a deck consists of stands for it.
    """
    if case.deck is None:
        parts = [case.rotor, case.operation, case.support, case.frequencies, case.drive_train]
        return _fingerprint(parts)
    numbers = {
        path: [_number(n.si), n.r_over_R] for path, n in case.given.items() if not isinstance(n.si, str)
    }
    of_a_file = case.rotor.airfoil if "rotor.airfoil.table" in case.given else None
    return _fingerprint([numbers, _choices(case.deck), of_a_file])


def _number(si: Any) -> Any:
    """One number as Python has it, whatever it was given as; lists and arrays as they are."""
    return np.asarray(si).item() if np.ndim(si) == 0 else si


def _choices(section: Any) -> dict[str, Any]:
    """What a section of a deck has besides numbers and words: kinds, and yes or no."""
    found: dict[str, Any] = {}
    for name in sorted(type(section).model_fields):
        entry = getattr(section, name)
        if hasattr(type(entry), "model_fields"):
            found[name] = {} if name == "case" else _choices(entry)
        elif isinstance(entry, list | tuple):
            found[name] = [_choices(one) for one in entry if hasattr(type(one), "model_fields")]
        elif isinstance(entry, str | bool | int | dict) or entry is None:
            found[name] = entry
        elif isinstance(getattr(entry, "si", None), str):
            found[name] = entry.written  # the name of a file
    return found


def _fingerprint(content: Any) -> str:
    try:
        return fingerprint(content)[:_DIGITS]
    except InputError:  # what it holds cannot be told
        return "unknown"


# Options -------------------------------------------------------------------------------------------------------------


def in_force(options: Options) -> dict[str, Any]:
    """Every option as it holds, as plain data: what cannot be written down has a fingerprint."""
    return {entry.name: _plain(getattr(options, entry.name)) for entry in fields(options)}


def chosen(options: Mapping[str, Any]) -> dict[str, Any]:
    """Those of the options in force, as plain data, that are not the defaults of their equations."""
    equations = options["equations"] if options["equations"] in EQUATION_SETS else "consistent"
    usual = in_force(Options()) | {
        name: value for name, value in in_force(Options(equations=equations)).items() if name != "equations"
    }
    return {name: value for name, value in options.items() if value != usual.get(name)}


def _plain(value: Any) -> Any:
    if isinstance(value, EquationSet):
        names = [name for name, known in EQUATION_SETS.items() if known == value]
        return names[0] if names else ", ".join(part.__name__ for part in vars(value).values())
    if is_dataclass(value) and not isinstance(value, type):
        return {entry.name: _plain(getattr(value, entry.name)) for entry in fields(value)}
    if value is None or isinstance(value, str | bool | int | float):
        return value
    if callable(value):
        return f"function {getattr(value, '__qualname__', type(value).__name__)}, {_fingerprint(value)}"
    array = np.asarray(value)
    if array.dtype.kind == "O" or array.size > _LISTED:
        return f"array of shape {array.shape}, {_fingerprint(array)}"
    return array.tolist()


def options_of(found: Mapping[Any, Any], case: Configuration, given: Mapping[str, Any]) -> dict[str, Any]:
    """The options that a result of a case was computed with, to go on from it.

    Parameters
    ----------
    found : mapping
        Attributes of a dataset, or a stamp.
    case : Case
        The one of the result.
    given : mapping
        Options as they are repeated; none need be, but such as hold functions or large arrays.

    Raises
    ------
    InputError
        For another case, or another value of an option than the result was computed with, with both; for a result that
        does not say, and an option that cannot be read back and is not repeated.
    """
    own = check_options(found, case, given)
    return {
        name: _keyword(case, name, value, given) for name, value in own.items() if not _follows(name, value)
    }


def check_options(found: Mapping[Any, Any], case: Configuration, given: Mapping[str, Any]) -> dict[str, Any]:
    """The options in force of a result of a case, as plain data; refuse another case, and others than these.

    Raises
    ------
    InputError
        As `options_of`, but for options that cannot be read back.
    """
    if "options" not in found:
        raise InputError("found", None, "must say its options, as results do whose attributes were kept")
    if found.get("deck", deck_fingerprint(case)) != deck_fingerprint(case):
        rule = f"must be the case of the result, {found.get('case')}, with the same numbers in its deck"
        raise InputError("case", case.name, rule)
    own = options_told(found)
    for name, value in given.items():
        if name not in own:
            parse_options({name: value})  # which tells that there is none
        repeated = [value] if name == "locked" and isinstance(value, str) else _plain(value)
        unset = value is None and in_force(Options()).get(name) is not None
        if not unset and repeated != own[name]:
            rule = f"must be {_written(own[name])}, with which the result was computed, or be left out"
            raise InputError(name, value, rule)
    return own


def _written(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _follows(name: str, value: Any) -> bool:
    """Whether an option says nothing that its default does not; without a drive train a case may have one."""
    return value is None and name != "drive_train"


def _keyword(case: Configuration, name: str, value: Any, given: Mapping[str, Any]) -> Any:
    """The value of an option from plain data."""
    if given.get(name) is not None:
        return given[name]
    if isinstance(value, dict):
        of_the_case = getattr(case, name)
        if _plain(of_the_case) == value:
            return of_the_case
        if not any(
            isinstance(part, str) and part.startswith(("function", "array")) for part in value.values()
        ):
            return {"frequencies": BladeFrequencies, "drive_train": DriveTrain}[name](**value)
    elif name in ("equations", "pitch_flap_coupling", "pitch_lag_coupling"):
        if not isinstance(value, str) or value in EQUATION_SETS:
            return np.asarray(value) if isinstance(value, list) else value
    else:
        return tuple(value) if isinstance(value, list) else value
    raise InputError(name, None, f"must be given again: the result was computed with {value}")


# In words ------------------------------------------------------------------------------------------------------------


def told(found: Mapping[Any, Any]) -> str:
    """A line on the case and the options that are not defaults; empty where a result does not say."""
    if "options" not in found:
        return ""
    own = chosen(options_told(found))
    options = f"options: {in_words(own)}" if own else "default options"
    return (
        f"Case {found['case']} ({found['deck']}), {options}."
        if "case" in found
        else f"{options.capitalize()}."
    )


def told_if_unusual(found: Mapping[Any, Any]) -> list[str]:
    """A sentence on the options that are not defaults; none where all are, or a result does not say."""
    own = chosen(options_told(found)) if "options" in found else {}
    return [f"Options: {in_words(own)}."] if own else []


def options_told(found: Mapping[Any, Any]) -> dict[str, Any]:
    """Every option in force of a result that says so, as plain data."""
    told_options: dict[str, Any] = json.loads(found["options"])
    return told_options


def in_words(options: Mapping[str, Any]) -> str:
    """Options as plain data in a line, without those that are not set."""
    return ", ".join(
        f"{name.replace('_', ' ')} {option_told(value)}"
        for name, value in options.items()
        if value is not None
    )


def option_told(value: Any) -> str:
    """The choice of an option in words."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, Mapping):
        return ", ".join(
            f"{name.replace('_', ' ')} {option_told(part)}" for name, part in value.items() if part
        )
    if isinstance(value, list | tuple):
        return " and ".join(map(str, value)) or "nothing"
    return f"{value:g}" if isinstance(value, float) else str(value)
