"""The options in force of a model: as plain data for files and attributes, and in words."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from proprotor.model.deck_fingerprint import short_fingerprint
from proprotor.rotor.generated import EQUATION_SETS, EquationSet
from proprotor.rotor.options import Options

_LISTED = 24  # largest array that is written out; a larger one is replaced by its fingerprint
_UNITS = {  # of numbers in the options of a record
    "at_rotor_speed": "rad/s",
    "drive_inertia": "kg m²",
    "drive_damping": "N m s/rad",
    "shaft_stiffness": "N m/rad",
    "mast_stiffness": "N m/rad",
    "engine_inertia": "kg m²",
    "engine_damping": "N m s/rad",
    "interconnect_stiffness": "N m/rad",
}
_UNITS_OF_OPTIONS = {"shaft_angle": "rad"}
_ABSCISSAE = {"collective": "rad", "airspeed": "m/s"}  # of a table of blade frequencies


def in_force(options: Options) -> dict[str, Any]:
    """Return every option in force as plain data, with a fingerprint in place of a value that cannot be written out."""
    return {entry.name: plain(getattr(options, entry.name)) for entry in fields(options)}


def options_in_result(found: Mapping[Any, Any]) -> dict[str, Any]:
    """Return every option in force from the attributes of a result, as plain data."""
    return dict(json.loads(found["options"]))


def chosen(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options in force, as plain data, that differ from the defaults of their equations."""
    equations = options["equations"] if options["equations"] in EQUATION_SETS else "consistent"
    usual = in_force(Options(equations=equations)) | {"equations": Options().equations}
    return {name: value for name, value in options.items() if value != usual.get(name)}


def plain(value: Any) -> Any:
    """Return one option as plain data: text, numbers, lists and mappings of these."""
    if isinstance(value, EquationSet):
        names = [name for name, known in EQUATION_SETS.items() if known == value]
        return names[0] if names else ", ".join(part.__name__ for part in vars(value).values())
    if is_dataclass(value) and not isinstance(value, type):
        return {entry.name: plain(getattr(value, entry.name)) for entry in fields(value)}
    if value is None or isinstance(value, str | bool | int | float):
        return value
    if callable(value):
        name = getattr(value, "__qualname__", type(value).__name__)
        return f"function {name}, {short_fingerprint(value)}"
    array = np.asarray(value)
    if array.dtype.kind == "O" or array.size > _LISTED:
        return f"array of shape {array.shape}, {short_fingerprint(array)}"
    return array.tolist()


def options_text(options: Mapping[str, Any]) -> str:
    """Return options, given as plain data, in a line; options that are not set are left out."""
    return ", ".join(
        f"{name.replace('_', ' ')} {option_text(value)} {_UNITS_OF_OPTIONS.get(name, '')}".rstrip()
        for name, value in options.items()
        if value is not None
    )


def option_text(value: Any) -> str:
    """Return the value of one option, given as plain data, in words."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, Mapping):
        units = _UNITS | {"at": _ABSCISSAE.get(str(value.get("against")), "")}
        parts = {
            name: f"{option_text(part)} {units.get(name, '')}".strip() for name, part in value.items() if part
        }
        return options_text(parts)
    if isinstance(value, list | tuple):
        return " and ".join(map(option_text, value)) or "nothing"
    return f"{value:.4g}" if isinstance(value, float) else str(value)
