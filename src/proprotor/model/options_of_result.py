"""The options that a result was computed with, for an analysis that goes on from the result."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from proprotor.errors import InputError
from proprotor.model.deck_fingerprint import deck_fingerprint
from proprotor.model.options_in_force import in_force, options_in_result, plain
from proprotor.rotor.blade_frequencies import BladeFrequencies
from proprotor.rotor.drive_train import DriveTrain
from proprotor.rotor.generated import EQUATION_SETS
from proprotor.rotor.options import Options, parse_options

if TYPE_CHECKING:
    from proprotor.model.configuration import Configuration

_RECORDS = {"frequencies": BladeFrequencies, "drive_train": DriveTrain}
# Options whose plain data are a text in place of functions and large arrays.
_ARRAYS = ("equations", "pitch_flap_coupling", "pitch_lag_coupling", "shaft_angle", "load_factor")


def options_of(found: Mapping[Any, Any], case: Configuration, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options that a result of a case was computed with, as keywords for the next analysis of the case.

    Parameters
    ----------
    found : mapping
        Attributes of a dataset, or a stamp.
    case : Case
        The case of the result.
    given : mapping
        Options that the caller repeats; only options that hold functions or large arrays have to be repeated.

    Raises
    ------
    InputError
        For another case, or another value of an option than the result was computed with, with both; for a result that
        has no options among its attributes, and an option that cannot be read back and is not repeated.
    """
    own = check_options(found, case, given)
    # What the case itself brings is left out, so that a varied case brings its own.
    brought = {name for name in _RECORDS if own[name] is not None and plain(getattr(case, name)) == own[name]}
    return {
        name: _keyword(case, name, value, given)
        for name, value in own.items()
        # Without None here, the drive train of the case would count.
        if (value is not None or name == "drive_train") and (name not in brought or name in given)
    }


def check_options(found: Mapping[Any, Any], case: Configuration, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options in force of a result as plain data; refuse another case and other options.

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
    own, usual = options_in_result(found), in_force(Options())
    for name, value in given.items():
        if name not in own:
            parse_options({name: value})  # raises the error for an unknown option
        repeated = [value] if name == "locked" and isinstance(value, str) else plain(value)
        unset = value is None and usual.get(name) is not None
        if not unset and repeated != own[name]:
            rule = f"must be {_written(own[name])}, with which the result was computed, or be left out"
            raise InputError(name, value, rule)
    return own


def _written(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _keyword(case: Configuration, name: str, value: Any, given: Mapping[str, Any]) -> Any:
    """Return the value of an option from plain data."""
    if given.get(name) is not None:
        return given[name]
    if isinstance(value, dict):
        if plain(getattr(case, name)) == value:
            return getattr(case, name)
        if not any(isinstance(p, str) and p.startswith(("function", "array")) for p in value.values()):
            return _RECORDS[name](**value)
    elif name in _ARRAYS:
        if not isinstance(value, str) or value in EQUATION_SETS:
            return np.asarray(value) if isinstance(value, list) else value
    else:
        return tuple(value) if isinstance(value, list) else value
    raise InputError(name, None, f"must be given again: the result was computed with {value}")
