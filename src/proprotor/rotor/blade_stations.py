"""A blade as a table of stations: mass, stiffnesses, twist and chord along the radius, and how its pitch is held."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from proprotor.errors import InputError, check_finite
from proprotor.typing import Array

FEWEST_STATIONS = 3
_ALONG = ("mass_per_length", "flatwise_stiffness", "edgewise_stiffness", "torsion_stiffness")
_OPTIONAL = {"chord": "above zero", "pitch_inertia_per_length": "not negative"}
_OPTIONAL |= dict.fromkeys(("mass_offset", "aerodynamic_center"), "")


@dataclass(frozen=True, kw_only=True, eq=False)
class BladeStations:
    """A blade by stations, between which every property is linear; the blade is held at its first station.

    Inboard of the pitch bearing the blade is hub: its axes stay in and across the disk whatever the pitch is, and the
    twist there is not used. Outboard, the flatwise axis is turned from the disk by pitch and twist.

    Parameters
    ----------
    radius : array (n,)
        Distances from the centre of rotation, m, increasing; the first is where the hub ends and the blade begins to
        bend, the last is the tip.
    mass_per_length : array (n,)
        kg/m.
    flatwise_stiffness, edgewise_stiffness : array (n,)
        EI about the structural axes, N m².
    torsion_stiffness : array (n,)
        GJ, N m².
    twist : array (n,)
        Angle of the structural axes, nose up, rad; only its differences count, pitch is that at 0.75 R.
    chord : array (n,), optional
        m.
    pitch_inertia_per_length : array (n,), optional
        kg m²/m about the pitch axis.
    mass_offset, aerodynamic_center : array (n,), optional
        Centre of the mass, and the quarter chord, in m aft of the pitch axis; on it where they are left out.
    pitch_bearing : float
        Radius of the pitch bearing, m.
    control_stiffness : float
        Stiffness of the control system against turning the blade at its bearing, N m/rad.

    Raises
    ------
    InputError
        When a value is not finite or has the wrong sign, columns differ in length, stations do not increase, or the
        bearing is not on the blade.
    """

    radius: Array
    mass_per_length: Array
    flatwise_stiffness: Array
    edgewise_stiffness: Array
    torsion_stiffness: Array
    twist: Array
    chord: Array | None = None
    pitch_inertia_per_length: Array | None = None
    mass_offset: Array | None = None
    aerodynamic_center: Array | None = None
    pitch_bearing: float = 0.0
    control_stiffness: float

    def __post_init__(self) -> None:
        for entry in fields(self):
            value = getattr(self, entry.name)
            if entry.type == "float" or value is None:
                continue
            object.__setattr__(self, entry.name, np.asarray(value))
        signs = dict.fromkeys(_ALONG, "above zero") | _OPTIONAL
        signs |= {"radius": "not negative", "twist": "", "pitch_bearing": "not negative"}
        for name, sign in (signs | {"control_stiffness": "above zero"}).items():
            if getattr(self, name) is not None:
                check_finite(name, getattr(self, name), sign)
        self._check_columns()

    def _check_columns(self) -> None:
        """Refuse columns of different lengths, stations that do not increase, and a bearing beyond the blade."""
        count = self.radius.size
        if self.radius.ndim != 1 or count < FEWEST_STATIONS:
            rule = f"must be a list of at least {FEWEST_STATIONS} stations"
            raise InputError("radius", f"array of shape {self.radius.shape}", rule)
        for name in (*_ALONG, "twist", *_OPTIONAL):
            value = getattr(self, name)
            if value is not None and value.shape != (count,):
                rule = f"must have a value for each of {count} stations"
                raise InputError(name, f"array of shape {value.shape}", rule)
        if np.any(np.diff(self.radius) <= 0):
            raise InputError("radius", f"{count} stations", "must increase from station to station")
        if self.pitch_bearing >= 0.75 * self.radius[-1]:
            rule = f"must lie inboard of 0.75 R ({0.75 * self.radius[-1]:.6g} m), where pitch is counted"
            raise InputError("pitch_bearing", self.pitch_bearing, rule)

    @property
    def tip(self) -> float:
        """Radius of the tip, m."""
        return float(self.radius[-1])

    def at(self, name: str, radius: Array) -> Array:
        """Return a column at other radii, linear between the stations.

        Parameters
        ----------
        name : str
            Name of the column.
        radius : array (...)
            m.

        Returns
        -------
        array (...)
            SI.
        """
        found: Array = np.interp(radius, self.radius, getattr(self, name))
        return found

    def angle(self, radius: Array) -> Array:
        """Return the angle of the structural axes from those at 0.75 R.

        Parameters
        ----------
        radius : array (...)
            m.

        Returns
        -------
        array (...)
            rad.
        """
        return self.at("twist", radius) - self.at("twist", np.asarray(0.75 * self.tip))

    @property
    def nodes(self) -> Array:
        """Radii (nodes,) of the stations, m, with that of the pitch bearing if it lies between two stations."""
        inside = self.radius[0] < self.pitch_bearing
        more = [self.pitch_bearing] if inside else []
        return np.unique(np.concatenate([self.radius, more]))
