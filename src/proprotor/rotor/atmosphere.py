"""Air of the International Standard Atmosphere at a pressure altitude, on a standard, hot or cold day.

The library `fluids` has the atmosphere (US Standard Atmosphere 1976, up to 32 km the same as ISO 2533 and ICAO Doc
7488). Here altitudes are geopotential, like the altitudes of altimeters and flight levels; a temperature offset changes
temperature and density at the pressure of the altitude ("ISA + 15").
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, check_number
from proprotor.typing import Array

# m: the lower limit of the library, and the height up to which the standards agree.
_LOWEST, _HIGHEST = -610.0, 32_000.0
# K: more than the air of any day has, so that a temperature that is given as an offset is refused.
_MOST_OFFSET = 100.0


class Air(NamedTuple):
    """State of the air; arrays of one shape (...).

    density : kg/m³; speed_of_sound : m/s; pressure : Pa; temperature : K
    """

    density: Array
    speed_of_sound: Array
    pressure: Array
    temperature: Array


def standard_air(altitude: ArrayLike, temperature_offset: ArrayLike = 0.0) -> Air:
    """Return the air at pressure altitudes.

    Parameters
    ----------
    altitude : float or array (...)
        Geopotential pressure altitude, m, -610 to 32 000. Complex numbers are followed to first order in their
        imaginary part, for derivatives by a complex step.
    temperature_offset : float or array (...)
        Above the standard temperature, K, within 100 K.

    Returns
    -------
    Air

    Raises
    ------
    InputError
        When an altitude or an offset is not finite or out of range.
    """
    _check("altitude", altitude, _LOWEST, _HIGHEST, "m")
    _check("temperature_offset", temperature_offset, -_MOST_OFFSET, _MOST_OFFSET, "K")
    altitude, offset = np.broadcast_arrays(altitude, temperature_offset)
    density, sound, pressure, temperature, lapse, gravity = _standard(altitude.real)
    # dp/dH = -g0 ρ, dT/dH as in the layer, ρ ~ p/T
    step = 1j * altitude.imag if np.iscomplexobj(altitude) else 0.0
    fall = gravity * density / pressure
    density = density * (1 - (fall + lapse / temperature) * step)
    pressure = pressure * (1 - fall * step)
    standard = temperature + lapse * step
    actual = standard + offset
    return Air(density * standard / actual, sound * np.sqrt(actual / temperature), pressure, actual)


def _check(field: str, given: ArrayLike, least: float, most: float, unit: str) -> None:
    """Refuse values that are no numbers, not finite or out of range."""
    check_number(field, given)
    values = np.asarray(given)
    wrong = ~((values.real >= least) & (values.real <= most) & np.isfinite(values))
    if wrong.any():
        rule = f"must lie between {least:g} and {most:g} {unit}"
        raise InputError(field, f"{values.real[wrong].flat[0]:g} {unit}", rule)


def _standard(altitude: Array) -> tuple[Array, ...]:
    """Return ρ, a, p, T, dT/dH and g0 at real altitudes; the library takes one altitude at a time."""
    from fluids import atmosphere  # here, because few decks need it

    found = np.empty((altitude.size, 5))
    for place, height in enumerate(altitude.flat):
        geometric = atmosphere.r0 * float(height) / (atmosphere.r0 - float(height))
        air = atmosphere.ATMOSPHERE_1976(geometric)
        found[place] = air.rho, air.v_sonic, air.P, air.T, air.T_increase
    return *np.moveaxis(found, -1, 0).reshape(5, *altitude.shape), np.asarray(atmosphere.g0)
