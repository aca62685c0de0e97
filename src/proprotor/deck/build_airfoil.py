"""Build the airfoil of a deck, or the airfoils by region of the span, from the numbers of [rotor.airfoil]."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from proprotor.errors import InputError
from proprotor.rotor.airfoil import Airfoil, SectionModel
from proprotor.rotor.airfoil_regions import AirfoilRegions
from proprotor.rotor.airfoil_table import AirfoilTable

_OF_JOINTS = ("region_ends", "blend")


def airfoil_of(given: Mapping[str, Any], table_name: str | list[str]) -> SectionModel | AirfoilRegions:
    """Return the airfoil of a blade, or the airfoils of its regions.

    Parameters
    ----------
    given : mapping
        SI values by field; a value for each region is a tuple. All but whole tuples may be arrays of designs, and
        complex.
    table_name : str or list of str
        Title of the table, "" for the first of its file; or a title for each region.

    Raises
    ------
    InputError
        When a value is not physical, a file cannot be read, or the regions do not fit each other.
    """
    fields = {name: value for name, value in given.items() if name not in _OF_JOINTS}
    if "table" in fields:
        fields["table_name"] = tuple(table_name) if isinstance(table_name, list) else table_name
    if "region_ends" not in given:
        return _one(fields)
    joints = {name: _along_joints(given[name]) for name in _OF_JOINTS if name in given}
    regions = range(joints["region_ends"].shape[-1] + 1)
    own = [{name: v[k] if isinstance(v, tuple) else v for name, v in fields.items()} for k in regions]
    airfoils: dict[tuple[Any, ...], SectionModel] = {}  # a file that several regions share is read once
    keys = [tuple(map(_key, one.values())) for one in own]
    for key, one in zip(keys, own, strict=True):
        if key not in airfoils:
            airfoils[key] = _one(one)
    try:
        return AirfoilRegions(airfoils=tuple(airfoils[key] for key in keys), **joints)
    except InputError as error:
        raise InputError(
            "table" if error.field == "airfoils" else error.field, error.value, error.rule
        ) from None


def _one(given: dict[str, Any]) -> SectionModel:
    """Return the airfoil of one region."""
    if "table" not in given:
        return Airfoil(**given)
    return AirfoilTable.from_c81(given["table"], given["table_name"] or None, given.get("table_reynolds"))


def _key(value: Any) -> Any:
    """Return what identifies a value; arrays of designs count as one by identity."""
    return id(value) if np.ndim(value) else value


def _along_joints(value: Any) -> Any:
    """Return a number of each joint as an array (..., n - 1), or a number of all as an array (..., 1)."""
    if isinstance(value, tuple):
        return np.stack(np.broadcast_arrays(*value), axis=-1)
    return np.asarray(value)[..., None]
