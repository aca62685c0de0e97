"""Sizes of design gusts and of design turbulence by 14 CFR 25.341 and CS 25.341, at the design airspeeds up to V_C.

Velocities between the altitudes of the table are linear in the altitude. At V_D half of each counts.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from proprotor.errors import InputError
from proprotor.typing import Array
from proprotor.units import values_in_si

_FOOT = 0.3048
# 14 CFR 25.341(a)(5)(i), amendment 25-141: ft, and ft/s of equivalent airspeed.
_GUSTS = ((0.0, 56.0), (15_000.0, 44.0), (60_000.0, 20.86))
# 14 CFR 25.341(b)(3): ft, and ft/s of true airspeed.
_TURBULENCE = ((0.0, 90.0), (24_000.0, 79.0), (60_000.0, 79.0))
_FULL_GRADIENT = 350.0 * _FOOT  # with which a gust has the whole reference velocity
_SEA_LEVEL_DENSITY = 1.225  # kg/m³, of the standard atmosphere
_HIGHEST = 60_000.0 * _FOOT
_GRADIENTS = (30.0 * _FOOT, 350.0 * _FOOT)  # the range of 14 CFR 25.341(a)(3), m


def design_gust(
    altitude: Any, gradient: Any, *, density: float | None = None, alleviation: float = 1.0
) -> Array:
    """Return the design velocity of a single gust, U_ref F_g (H/350 ft)^(1/6).

    Parameters
    ----------
    altitude : float in m, text such as "10000 ft", or pint quantity
        Up to 60,000 ft.
    gradient : float or array (...) in m, text, or pint quantity
        H, the distance over which the gust grows: 30 to 350 ft.
    density : float, optional
        kg/m³: with it the velocity is true, without it equivalent.
    alleviation : float
        F_g, the flight profile alleviation factor, 1 at the maximum operating altitude.

    Returns
    -------
    array (...)
        m/s.

    Raises
    ------
    InputError
        For an altitude or a gradient outside its range.
    """
    height = _altitude(altitude)
    distance = values_in_si(gradient, "m", "gradient")
    low, high = _GRADIENTS
    if not ((distance >= low * (1 - 1e-9)) & (distance <= high * (1 + 1e-9))).all():
        raise InputError("gradient", gradient, f"must be from {low:.4g} to {high:.4g} m (30 to 350 ft)")
    size = _reference(_GUSTS, height) * _factor(alleviation) * (distance / _FULL_GRADIENT) ** (1 / 6)
    return np.asarray(size if density is None else size * np.sqrt(_SEA_LEVEL_DENSITY / density))


def design_turbulence(altitude: Any, *, alleviation: float = 1.0) -> float:
    """Return the design intensity of turbulence, U_σref F_g.

    A limit load is the load of level flight and this times the root mean square per unit of intensity.

    Parameters
    ----------
    altitude : float in m, text such as "10000 ft", or pint quantity
        Up to 60,000 ft.
    alleviation : float
        F_g, the flight profile alleviation factor.

    Returns
    -------
    float
        m/s, true.

    Raises
    ------
    InputError
        For an altitude outside the range.
    """
    return float(_reference(_TURBULENCE, _altitude(altitude)) * _factor(alleviation))


def _altitude(altitude: Any) -> float:
    found = values_in_si(altitude, "m", "altitude").reshape(-1)
    if len(found) != 1 or not 0 <= found[0] <= _HIGHEST:
        raise InputError("altitude", altitude, f"must be one altitude from 0 to {_HIGHEST:g} m (60,000 ft)")
    return float(found[0])


def _reference(table: tuple[tuple[float, float], ...], altitude: float) -> float:
    """Return the velocity of a table at an altitude, m/s."""
    heights, sizes = np.array(table).T * _FOOT
    return float(np.interp(altitude, heights, sizes))


def _factor(alleviation: float) -> float:
    if not 0 < alleviation <= 1:
        raise InputError("alleviation", alleviation, "must be above zero and at most 1")
    return alleviation
