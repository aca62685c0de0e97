"""Make a rotor of hinged blades from a table of blade stations."""

from __future__ import annotations

import functools
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, check_finite
from proprotor.rotor.blade_stations import BladeStations
from proprotor.rotor.hinged_blade import HingedBlade, hinged_blade
from proprotor.rotor.offset_mass import OffsetMass
from proprotor.rotor.rotor import Rotor

_FEWEST = 3


class FromStations(NamedTuple):
    """A rotor, and the hinged blade with the deflections of the elastic blade that it was made from."""

    rotor: Rotor
    blade: HingedBlade


def rotor_from_stations(
    stations: BladeStations, *, rotor_speed: float, pitch: ArrayLike, **fields: Any
) -> FromStations:
    """Return a rotor whose hinged blades are the nearest to an elastic blade.

    Parameters
    ----------
    stations : BladeStations
    rotor_speed : float
        rad/s.
    pitch : array (p,)
        Collectives at 0.75 R, rad, for which the hinged blade is found; at least 3.
    **fields
        Further fields of `Rotor`: the number of blades and the airfoil at least. Chord, twist and the places on the
        chord are those of the stations, and the blade has air from the first station, unless they are given; any
        number that was found is replaced by one that is given.

    Returns
    -------
    FromStations

    Raises
    ------
    InputError
        When the rotor speed or the pitches are not usable, or the rotor cannot be made of the numbers.
    """
    check_finite("rotor_speed", rotor_speed, "above zero")
    check_finite("pitch", pitch)
    angles = np.asarray(pitch, dtype=float)
    if angles.ndim != 1 or np.unique(angles).size < _FEWEST:
        raise InputError("pitch", pitch, f"must be a list of at least {_FEWEST} different collectives")
    blade = hinged_blade(stations, float(rotor_speed), angles)
    found: dict[str, Any] = dict(blade.numbers)
    found["root_cutout"] = float(stations.radius[0])
    found["twist"] = (stations.radius, stations.angle(stations.radius))
    for name in ("chord", "aerodynamic_center"):
        if getattr(stations, name) is not None:
            found[name] = (stations.radius, getattr(stations, name))
    if stations.mass_offset is not None:
        found["offset_mass"] = _offset_mass(stations, found["lag_hinge_offset"])
    if "chord" not in found and "chord" not in fields:
        raise InputError("chord", None, "must be a column of the stations, or be given")
    return FromStations(Rotor(**found | fields), blade)


def _offset_mass(stations: BladeStations, hinge: float) -> OffsetMass:
    """Return the integrals of the mass beside the pitch axis."""
    mass, offset = (functools.partial(stations.at, name) for name in ("mass_per_length", "mass_offset"))
    return OffsetMass.along(stations.radius, hinge, mass, offset, stations.angle)
