"""Airspeeds as people give them."""

from __future__ import annotations

from typing import Any

import numpy as np

from proprotor.arrays import Array
from proprotor.errors import InputError

KNOT = 1852 / 3600  # m/s


def has_own_unit(value: Any) -> bool:
    """Whether a value says its unit: text, a quantity, a data array with an attribute ``units``, or a list of these."""
    if isinstance(value, list | tuple):
        return any(map(has_own_unit, value))
    return isinstance(value, str) or hasattr(value, "to") or "units" in getattr(value, "attrs", {})


def in_metres_per_second(airspeed: Any) -> Array:
    """Airspeed as an array in m/s.

    Parameters
    ----------
    airspeed : float, array (...), text, pint quantity or xarray.DataArray
        A bare number is in m/s and may be complex, for derivatives by a complex step; text such as "250 kt" (one
        speed) or "50:400:5kt" (a list), quantities, lists of these, and data arrays with an attribute
        ``units`` are converted.

    Returns
    -------
    array (...)
        m/s; without axes for a single speed.

    Raises
    ------
    InputError
        When it is not a speed.
    """
    if isinstance(airspeed, str) or (isinstance(airspeed, list | tuple) and has_own_unit(airspeed)):
        from proprotor import units  # here, because pint takes long to import

        if not isinstance(airspeed, str):
            return units.values_in_si(airspeed, "m/s", "airspeed")
        found = units.speeds(airspeed)
        return found if ":" in airspeed else found.reshape(())
    if has_own_unit(airspeed):
        from proprotor import units

        return units.as_si(airspeed, "m/s", "airspeed")
    try:
        return np.asarray(airspeed, dtype=complex if np.iscomplexobj(airspeed) else float)
    except (TypeError, ValueError):
        raise InputError("airspeed", airspeed, 'must be in m/s, or text such as "300 kt"') from None
