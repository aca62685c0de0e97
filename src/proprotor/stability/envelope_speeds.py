"""The speeds of an envelope at altitude: V_D and M_D, the speed up to which a condition must be free of flutter.

At a pressure altitude with air of density ρ and speed of sound a, an equivalent airspeed V_E is a true airspeed
V_E √(ρ0/ρ), and a Mach number M is a true airspeed M a. The dive speed at altitude is the lower one of V_D and M_D. A
factor on V_D and on M_D at constant altitude covers the same factor on the equivalent airspeed at constant Mach number:
that one leads from the line of V_D to a point with factor V_D lower down, and from the line of M_D to that line.

V_D meets M_D where the air has the pressure p = ρ0 V_D² / (γ M_D²), whatever its temperature. Below that corner the
equivalent airspeed that is wanted does not change with altitude while onsets fall, above it that airspeed falls faster
than most onsets: the corner is often the worst altitude, and is one of those that are analysed.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from proprotor.rotor.atmosphere import standard_air
from proprotor.typing import Array
from proprotor.units import KNOT, SEA_LEVEL_DENSITY

_SPEED_FACTOR, _FAILURE_SPEED_FACTOR = 1.15, 1.0  # CS and 14 CFR 25.629(b)(1) and (b)(2)(i)


_GAMMA = 1.4  # ratio of specific heats of air, ISO 2533
_CLOSE = 1e-6  # m, of the altitude of the corner


class EnvelopeSpeeds(NamedTuple):
    """Speeds at the altitudes (k,) of an envelope, true, m/s.

    altitude : m; density : kg/m³; speed_of_sound : m/s; dive : V_D or M_D, whichever is lower; normal, failure : up to
    which these conditions must be free of flutter
    """

    altitude: Array
    density: Array
    speed_of_sound: Array
    dive: Array
    normal: Array
    failure: Array

    @property
    def per_equivalent(self) -> Array:
        """True airspeed per equivalent airspeed (k,)."""
        return np.sqrt(SEA_LEVEL_DENSITY / self.density)


def altitudes_of(envelope: Any) -> Array:
    """Return the altitudes of the section [envelope] of a deck, m, rising, with that of the corner of V_D and M_D.

    Parameters
    ----------
    envelope : proprotor.deck.envelope_sections.EnvelopeSection

    Raises
    ------
    InputError
        For an altitude without a standard atmosphere.
    """
    from scipy.optimize import brentq  # here, because it takes long to import

    given = np.array(envelope.altitudes.si)
    low, high = given[0], given[-1]
    ends = standard_air(given[[0, -1]]).pressure
    if envelope.dive_mach is None:
        return given
    corner = SEA_LEVEL_DENSITY * (envelope.dive_speed.si * KNOT / envelope.dive_mach.si) ** 2 / _GAMMA
    if not ends[1] < corner < ends[0]:
        return given
    found = brentq(lambda height: float(standard_air(height).pressure) - corner, low, high, xtol=_CLOSE)
    return np.unique(np.append(given, found))


def envelope_speeds(envelope: Any, altitude: Array, temperature_offset: float = 0.0) -> EnvelopeSpeeds:
    """Return the speeds of the section [envelope] of a deck at altitudes.

    Parameters
    ----------
    envelope : proprotor.deck.envelope_sections.EnvelopeSection
    altitude : array (k,)
        Pressure altitudes, m.
    temperature_offset : float
        Above the standard temperature, K.

    Raises
    ------
    InputError
        For an altitude without a standard atmosphere.
    """
    air = standard_air(altitude, temperature_offset)
    sound, per_equivalent = air.speed_of_sound, np.sqrt(SEA_LEVEL_DENSITY / air.density)
    mach = np.inf if envelope.dive_mach is None else envelope.dive_mach.si
    dive = np.minimum(envelope.dive_speed.si * KNOT * per_equivalent, mach * sound)
    factors = (
        default if number is None else number.si
        for number, default in (
            (envelope.speed_factor, _SPEED_FACTOR),
            (envelope.failure_speed_factor, _FAILURE_SPEED_FACTOR),
        )
    )
    most = sound if mach < 1 else np.inf  # an envelope with M_D below 1 may end at Mach 1
    normal, failure = (np.minimum(factor * dive, most) for factor in factors)
    return EnvelopeSpeeds(altitude, air.density, sound, dive, normal, failure)
