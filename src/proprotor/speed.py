"""Airspeeds as people give them."""

from __future__ import annotations

from typing import Any

import numpy as np

from proprotor.arrays import Array

KNOT = 1852 / 3600  # m/s


def in_metres_per_second(airspeed: Any) -> Array:
    """Airspeed as an array in m/s.

    Parameters
    ----------
    airspeed : float, array (...), text or pint quantity
        A bare number is in m/s and may be complex, for derivatives by a complex step; text such as "250 kt" or
        "50:400:5kt" and quantities are converted.

    Raises
    ------
    InputError
        When it is not a speed.
    """
    if isinstance(airspeed, str) or hasattr(airspeed, "to"):
        from proprotor import units  # here, because pint takes long to import

        return (
            units.speeds(airspeed) if isinstance(airspeed, str) else units.as_si(airspeed, "m/s", "airspeed")
        )
    return np.asarray(airspeed, dtype=complex if np.iscomplexobj(airspeed) else float)
