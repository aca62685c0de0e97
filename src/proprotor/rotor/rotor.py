"""A proprotor in SI units: geometry, mass, springs, control system and blade sections."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from proprotor_equations import inertia

from proprotor.errors import InputError, check_finite, check_number, nowhere_negative
from proprotor.rotor.airfoil import Airfoil, SectionModel
from proprotor.rotor.blade_stations import BladeStations
from proprotor.rotor.effective_sections import EffectiveSections, Line, effective_sections
from proprotor.rotor.generated import evaluate
from proprotor.rotor.quadrature import Panels, RadialQuadrature, long_panels, short_panels
from proprotor.typing import Array

MASS_INTEGRALS = (
    "blade_mass",
    *(f"{part}_{kind}" for part in ("blade", "flap", "lag") for kind in ("first_moment", "inertia")),
)
_POSITIVE = ("radius", "blade_inertia", "flap_inertia", "lag_inertia", "blade_mass")
_NOT_NEGATIVE = ("flap_hinge_offset", "root_cutout", "flap_first_moment", "lag_first_moment", "pitch_inertia")
_FRACTIONS = ("flap_outboard_fraction", "lag_outboard_fraction")
_REACH = 1e-3  # of the radius: stations may be printed to three digits
HELD, NOTHING = "held", "nothing"  # words for the blade beyond the stations of a table

_Table = tuple[ArrayLike, ArrayLike] | tuple[ArrayLike, ArrayLike, str]  # r, values, perhaps `HELD`
_Distribution = float | _Table | Callable[[Array], Array]


@dataclass(frozen=True, kw_only=True, eq=False)
class Rotor:
    """A gimballed rotor of equal blades, each with a flap and a lag hinge and a flexible control system.

    All values are in SI units and radians. The mass integrals are over the whole blade (blade_*, about the centre of
    rotation) and over the part outboard of a hinge (flap_*, lag_*, about that hinge). Any number may be an array that
    broadcasts with the airspeeds, for many designs at once.

    Parameters
    ----------
    n_blades : int
        At least 3.
    radius, root_cutout, flap_hinge_offset, lag_hinge_offset : float
        m from the centre of rotation; the lag hinge is not inboard of the flap hinge.
    precone : float
        rad.
    blade_mass, blade_first_moment, blade_inertia : float
        Integrals of m, m r and m r²: kg, kg m, kg m².
    flap_first_moment, flap_inertia, lag_first_moment, lag_inertia : float
        Integrals of m (r - e) and m (r - e)² outboard of each hinge: kg m, kg m².
    flap_stiffness, lag_stiffness : float
        Hub and blade spring in series, N m/rad (Eq. 18 of AIAA-2002-1604).
    flap_outboard_fraction, lag_outboard_fraction : float
        Share of the flexibility of that spring outboard of the pitch bearing, dimensionless, 0 to 1 (Eq. 19).
    gimbal_stiffness : float
        Hub spring, N m/rad.
    pitch_gimbal_coupling : float
        K_PG = tan δ3 (Eq. 16), dimensionless.
    pitch_inertia, control_stiffness : float
        Inertia and stiffness for one blade: kg m², N m/rad.
    flap_damping, lag_damping, pitch_damping, gimbal_damping : float
        Viscous dampers, N m s/rad; the gimbal's does not rotate.
    structural_pitch_offset : float
        Angle from the collective reference to the blade's structural axes, rad.
    propeller_moment : bool
        Whether the propeller moment acts on the blade's pitch.
    chord, twist : float, (r, values) or function of r
        m and rad. A number is a constant chord, or a linear twist over the radius. A pair of arrays is interpolated
        linearly between its stations, which reach from the root cutout to the tip; with (r, values, "held") the end
        values hold beyond the stations. A smooth function takes an array of radii. Twist counts from the pitch at
        0.75 R.
    airfoil : SectionModel
        Section coefficients, such as `Airfoil`.

    Raises
    ------
    InputError
        With the field, its value and the rule, when a value is missing, not finite or not physical.
    """

    n_blades: int
    radius: float
    root_cutout: float = 0.0
    flap_hinge_offset: float = 0.0
    lag_hinge_offset: float = 0.0
    precone: float = 0.0
    blade_mass: float
    blade_first_moment: float
    blade_inertia: float
    flap_first_moment: float
    flap_inertia: float
    lag_first_moment: float
    lag_inertia: float
    flap_stiffness: float
    lag_stiffness: float
    flap_outboard_fraction: float = 0.0
    lag_outboard_fraction: float = 0.0
    gimbal_stiffness: float = 0.0
    pitch_gimbal_coupling: float = 0.0
    pitch_inertia: float = 0.0
    control_stiffness: float = 0.0
    flap_damping: float = 0.0
    lag_damping: float = 0.0
    pitch_damping: float = 0.0
    gimbal_damping: float = 0.0
    structural_pitch_offset: float = 0.0
    propeller_moment: bool = True
    chord: _Distribution
    twist: _Distribution = 0.0
    airfoil: SectionModel = field(repr=False)

    def __post_init__(self) -> None:
        for entry in fields(self):
            self._check_number(entry.name, getattr(self, entry.name))
        if np.any(np.asarray(self.n_blades) < 3) or np.any(np.asarray(self.n_blades) % 1 != 0):
            raise InputError("n_blades", self.n_blades, "must be a whole number of at least 3")
        self._check_signs()
        self._check_hinges()
        self._check_reach()
        self._check_mass()

    def _check_number(self, name: str, value: Any) -> None:
        """Refuse a field that is no finite number; distributions wait until the radius is known to be positive."""
        distributed = name in ("chord", "twist") and (isinstance(value, tuple) or callable(value))
        if isinstance(value, tuple) and not distributed:
            raise InputError(name, value, "must be a number in SI units")
        if name != "airfoil" and not distributed:
            check_finite(name, value)

    def _check_signs(self) -> None:
        """Refuse numbers of the wrong sign, and fractions and angles out of range."""
        passive = [e.name for e in fields(self) if e.name.endswith(("_stiffness", "_damping"))]
        for names, sign in ((_POSITIVE, "above zero"), ((*_NOT_NEGATIVE, *passive), "not negative")):
            for name in names:
                check_finite(name, getattr(self, name), sign)
        for name in _FRACTIONS:
            if np.any((np.real(getattr(self, name)) < 0) | (np.real(getattr(self, name)) > 1)):
                raise InputError(name, getattr(self, name), "must lie between 0 and 1")
        for name in ("chord", "twist"):
            if isinstance(getattr(self, name), tuple):
                _check_distribution(name, getattr(self, name))
        chord: Any = self.chord_at(self.quadrature.stations) if callable(self.chord) else self.chord
        chord = chord[1] if isinstance(chord, tuple) else chord
        if np.any(np.real(chord) <= 0):
            raise InputError("chord", chord, "must be above zero")
        if np.any(np.abs(np.real(self.precone)) >= np.pi / 2):
            raise InputError("precone", self.precone, "must lie within 90 deg")

    def _check_hinges(self) -> None:
        """Refuse a root cutout or hinges in the wrong order along the radius."""
        if np.any(np.real(self.lag_hinge_offset) < np.real(self.flap_hinge_offset)):
            rule = f"must not lie inboard of the flap hinge ({_shown(self.flap_hinge_offset)} m)"
            raise InputError("lag_hinge_offset", self.lag_hinge_offset, rule)
        for name in ("root_cutout", "lag_hinge_offset"):
            if np.any(np.real(getattr(self, name)) >= np.real(self.radius)):
                rule = f"must lie inboard of the tip ({_shown(self.radius)} m)"
                raise InputError(name, getattr(self, name), rule)

    def _check_reach(self) -> None:
        """Refuse a chord or twist whose stations do not cover all the airloads, unless its end values hold."""
        radius, cutout = np.real(self.radius), np.real(self.root_cutout)
        for name in ("chord", "twist"):
            table = getattr(self, name)
            if not isinstance(table, tuple) or table[2:] == (HELD,):
                continue
            first, last = (np.real(np.asarray(table[0]))[..., end] / radius for end in (0, -1))
            if np.any(first > cutout / radius + _REACH) or np.any(last < 1 - _REACH):
                rule = (
                    f"has stations from {_shown(first)} R to {_shown(last)} R; they must reach from the root cutout, "
                    f'{_shown(cutout / radius)} R, to the tip, or say beyond = "held" to hold the end values'
                )
                raise InputError(name, f"{np.size(table[1])} values", rule)

    def _check_mass(self) -> None:
        """Refuse mass integrals that no blade can have.

        The integrals of m times two of the arms 1, r, ρβ, ρζ are inner products, so that their Gram matrix has no
        negative eigenvalue.
        """
        i_beta_alpha = np.real(self.flap_hub_inertia)
        if np.any(i_beta_alpha**2 > np.real(self.blade_inertia * self.flap_inertia) * (1 + 1e-12)):
            rule = f"breaks I_βα² ≤ I_b I_β with I_βα = I_β + e_β S_β = {_shown(i_beta_alpha)} kg m²"
            raise InputError("flap_inertia", self.flap_inertia, rule)
        if not nowhere_negative(np.real(self._gram_matrix())):
            rule = (
                "cannot belong to one blade: the Gram matrix of the mass integrals has a negative eigenvalue"
            )
            raise InputError("blade_inertia", self.blade_inertia, rule)

    def _gram_matrix(self) -> Array:
        """Return the integrals of m times two of the arms 1, r, ρβ, ρζ."""
        entries = (
            (self.blade_mass, self.blade_first_moment, self.flap_first_moment, self.lag_first_moment),
            (self.blade_first_moment, self.blade_inertia, self.flap_hub_inertia, self.lag_hub_inertia),
            (self.flap_first_moment, self.flap_hub_inertia, self.flap_inertia, self.flap_lag_inertia),
            (self.lag_first_moment, self.lag_hub_inertia, self.flap_lag_inertia, self.lag_inertia),
        )
        flat = np.broadcast_arrays(*(entry for row in entries for entry in row))
        return np.stack(flat, axis=-1).reshape(*np.shape(flat[0]), 4, 4)

    @classmethod
    def from_stations(
        cls, stations: BladeStations, *, rotor_speed: float, pitch: ArrayLike, **more: Any
    ) -> Rotor:
        """Return the rotor whose hinged blades are the nearest to an elastic blade.

        `proprotor.rotor.from_stations.rotor_from_stations` returns what the fit found as well, and
        `proprotor.model.blade_comparison.compare_blades` how far the hinged blade is from the elastic one.

        Parameters
        ----------
        stations : BladeStations
        rotor_speed : float
            rad/s.
        pitch : array (p,)
            Collectives at 0.75 R for which the blade is fitted, rad; at least 3.
        **more
            Further fields, or other values for fields that were found: the number of blades and the airfoil at least.

        Returns
        -------
        Rotor

        Raises
        ------
        InputError
            When the rotor speed or the pitches are not usable, or no rotor can be made of the numbers.
        """
        from proprotor.rotor.from_stations import rotor_from_stations  # here: it imports this module

        return rotor_from_stations(stations, rotor_speed=rotor_speed, pitch=pitch, **more).rotor

    @functools.cached_property
    def _dependent(self) -> Any:
        """Inertias that follow from the others."""
        return evaluate(inertia.dependent_inertias, {e.name: getattr(self, e.name) for e in fields(self)})

    @property
    def flap_hub_inertia(self) -> Any:
        """I_βα = ∫ m r (r - e_β), kg m², which follows from flap inertia, first moment and hinge offset."""
        return self._dependent.flap_hub_inertia

    @property
    def lag_hub_inertia(self) -> Any:
        """I_ζα = ∫ m r (r - e_ζ), kg m²."""
        return self._dependent.lag_hub_inertia

    @property
    def flap_lag_inertia(self) -> Any:
        """I_βζ = ∫ m (r - e_β)(r - e_ζ), kg m²."""
        return self._dependent.flap_lag_inertia

    @property
    def has_effective_sections(self) -> bool:
        """Whether loads are linear in chord and twist, and both are known at every radius.

        The loads are linear with the straight lift line of `Airfoil`. Kinks of tables then need no panels of their own.
        """
        return type(self.airfoil) is Airfoil and not (callable(self.chord) or callable(self.twist))

    @functools.cached_property
    def _panels(self) -> Panels:
        """Panels of all stations."""
        if self.has_effective_sections:
            return long_panels(**self._radii)
        knots = [np.asarray(d[0]) for d in (self.chord, self.twist) if isinstance(d, tuple)]
        return short_panels(**self._radii, knots=_joined(knots))

    @functools.cached_property
    def quadrature(self) -> RadialQuadrature:
        """Radial stations and weights from cutout to tip, by segments that end at the hinges."""
        return self._panels.quadrature()

    @functools.cached_property
    def sections(self) -> EffectiveSections:
        """Chord and twist at the stations of `quadrature`: the effective ones where the rotor has them."""
        if self.has_effective_sections:
            return self._effective_on(self._panels, self.quadrature)
        return self._sections_at(self.quadrature)

    @functools.cached_property
    def few_sections(self) -> tuple[RadialQuadrature, EffectiveSections]:
        """Stations on long panels with chord and twist there, near enough to all stations to begin a trim with."""
        panels = long_panels(**self._radii)
        quadrature = panels.quadrature()
        if callable(self.chord) or callable(self.twist):
            return quadrature, self._sections_at(quadrature)
        return quadrature, self._effective_on(panels, quadrature)

    def _sections_at(self, quadrature: RadialQuadrature) -> EffectiveSections:
        """Return chord and twist at each station."""
        r = quadrature.stations
        return EffectiveSections(self.chord_at(r), self.twist_at(r))

    def _effective_on(self, panels: Panels, quadrature: RadialQuadrature) -> EffectiveSections:
        """Return the effective chord and twist at the stations of panels."""
        found = effective_sections(self._chord_line, self._twist_line, panels)
        return found._replace(bent=self.twist_at(quadrature.stations) - found.twist)

    @property
    def _chord_line(self) -> Line:
        """The chord as a table or one value."""
        if isinstance(self.chord, tuple):
            return Line.through(*(np.asarray(part) for part in self.chord[:2]))
        chord = np.asarray(self.chord)
        return Line.straight(chord, 0 * chord)

    @property
    def _twist_line(self) -> Line:
        """The twist as a table or linear."""
        radius = np.asarray(self.radius)
        if isinstance(self.twist, tuple):
            r, values = (np.asarray(part) for part in self.twist[:2])
            return Line.through(r, values - _interpolate(self.twist, 0.75 * radius[..., None]))
        return Line.straight(-0.75 * np.asarray(self.twist), self.twist / radius)

    @property
    def _radii(self) -> dict[str, Any]:
        """Radii between which the blade has airloads, by name."""
        names = ("root_cutout", "radius", "flap_hinge_offset", "lag_hinge_offset")
        return {name: getattr(self, name) for name in names}

    def chord_at(self, r: Array) -> Array:
        """Return the chord at radii.

        Parameters
        ----------
        r : array (..., stations)
            Radii from the centre of rotation, m.

        Returns
        -------
        array (..., stations)
            m; a constant chord has one station.
        """
        if isinstance(self.chord, tuple) or callable(self.chord):
            return _interpolate(self.chord, r)
        return np.asarray(self.chord)[..., None]

    def twist_at(self, r: Array) -> Array:
        """Return the twist at radii.

        Parameters
        ----------
        r : array (..., stations)
            Radii from the centre of rotation, m.

        Returns
        -------
        array (..., stations)
            Twist from the pitch at 0.75 R, rad.
        """
        radius = np.asarray(self.radius)[..., None]
        if isinstance(self.twist, tuple) or callable(self.twist):
            return np.asarray(_interpolate(self.twist, r) - _interpolate(self.twist, 0.75 * radius))
        return np.asarray(np.asarray(self.twist)[..., None] * (r - 0.75 * radius) / radius)

    @classmethod
    def from_mass_distribution(
        cls,
        r: ArrayLike,
        mass_per_length: ArrayLike,
        beyond: str = "",
        *,
        hub_mass: ArrayLike | None = None,
        **fields_: Any,
    ) -> Rotor:
        """Return a rotor whose seven mass integrals come from mass per length, linear between stations.

        The integrals are exact for that distribution: the integrand is a cubic between stations and hinges. Hinge
        offsets and, with leading axes, r may be arrays of many designs.

        Stations reach from the centre of rotation to the tip; stations within 0.1 % of the radius count as centre or
        tip.

        Parameters
        ----------
        r : array_like, shape (..., k)
            Stations from the centre of rotation, m, increasing.
        mass_per_length : array_like, shape (k,)
            kg/m, not negative.
        beyond : "" or "nothing"
            "nothing" says that there is no mass inboard of the first station and outboard of the last.
        hub_mass : float or array, optional
            Mass of the whole rotor's hub at the centre of rotation, kg, for stations that begin further out; may be 0.
        **fields_
            The other fields of `Rotor`.

        Returns
        -------
        Rotor

        Raises
        ------
        InputError
            When the distribution does not increase in r or is negative, when it ends short of centre or tip without
            `beyond` or `hub_mass`, or when a field is wrong.
        """
        r, mass = np.asarray(r), np.asarray(mass_per_length, dtype=float)
        _check_distribution("mass_distribution", (r, mass))
        if np.any(mass < 0):
            raise InputError("mass_distribution", float(mass.min()), "must not be negative")
        if beyond not in ("", NOTHING):
            raise InputError("mass_distribution", beyond, f'must have beyond = "{NOTHING}", or no beyond')
        r = _reaching(r, fields_.get("radius"), beyond, hub_mass)
        _check_distribution("mass_distribution", (r, mass))
        axes = {name: fields_.get(f"{name}_hinge_offset", 0.0) for name in ("flap", "lag")}
        integrals = {"blade_mass": _outboard_moment(r, mass, 0.0, 0)}
        for name, axis in {"blade": 0.0, **axes}.items():
            for power, kind in ((1, "first_moment"), (2, "inertia")):
                integrals[f"{name}_{kind}"] = _outboard_moment(r, mass, axis, power)
        rotor = cls(**integrals, **fields_)
        return rotor if hub_mass is None else rotor._with_hub(hub_mass)

    def _with_hub(self, hub_mass: ArrayLike) -> Rotor:
        """Return the rotor with a mass at its centre, of which every blade has a share."""
        check_number("hub_mass", hub_mass)
        if not np.all(np.isfinite(hub_mass)) or np.any(np.real(hub_mass) < 0):
            raise InputError("hub_mass", hub_mass, "must be finite and not negative")
        share: Any = hub_mass / np.asarray(self.n_blades)
        return replace(self, blade_mass=self.blade_mass + share)


def _reaching(r: Array, radius: Any, beyond: str, hub_mass: ArrayLike | None) -> Array:
    """Return stations, the end ones moved to centre and tip if they are near; refuse stations that leave mass out."""
    try:
        tip = np.asarray(radius, dtype=complex if np.iscomplexobj(radius) else float)
    except (TypeError, ValueError):
        return r  # the rotor refuses this radius
    if not np.all(np.real(tip) > 0):
        return r
    at_centre, at_tip = _check_ends(r, tip, beyond, hub_mass)
    first, last = np.where(at_centre, 0.0, r[..., 0]), np.where(at_tip, tip, r[..., -1])
    return _joined([first[..., None], r[..., 1:-1], last[..., None]])


def _check_ends(r: Array, tip: Array, beyond: str, hub_mass: ArrayLike | None) -> tuple[Array, Array]:
    """Return whether the first station is near the centre and the last near the tip; refuse stations that omit mass."""
    first, last = (np.real(r[..., end]) / np.real(tip) for end in (0, -1))
    reached = f"has stations from {_shown(first)} R to {_shown(last)} R"
    at_centre, at_tip = np.abs(first) <= _REACH, np.abs(last - 1) <= _REACH
    if np.any(first < -_REACH) or np.any(last > 1 + _REACH):
        rule = f"{reached}; there is no blade beyond its tip"
        raise InputError("mass_distribution", f"{r.shape[-1]} values", rule)
    if hub_mass is not None and np.any(at_centre):
        rule = "must not be given with a mass_distribution that begins at the centre of rotation and holds the hub"
        raise InputError("hub_mass", hub_mass, rule)
    if beyond != NOTHING and not (np.all(at_tip) and (hub_mass is not None or np.all(at_centre))):
        rule = (
            f"{reached}; they must reach from the centre to the tip. Give hub_mass for the mass inboard of the first, "
            f'or say beyond = "{NOTHING}" where there is no mass beyond the stations'
        )
        raise InputError("mass_distribution", f"{r.shape[-1]} values", rule)
    return at_centre, at_tip


def _shown(value: ArrayLike) -> str:
    """Return a number as text, or the range of an array of designs."""
    low, high = np.min(np.real(value)), np.max(np.real(value))
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"


def _check_distribution(name: str, distribution: _Table) -> None:
    """Refuse a table whose stations and values do not fit each other, are not finite or do not increase."""
    if (further := distribution[2:]) not in ((), (HELD,)):
        raise InputError(name, further, f'must be (r, values), or (r, values, "{HELD}")')
    r, values = (np.real(part) for part in distribution[:2])
    if values.ndim != 1 or r.shape[-1:] != values.shape or values.size < 2:
        shapes = f"arrays of shape {r.shape} and {values.shape}"
        raise InputError(name, shapes, "must be two lists of equal length")
    if not (np.isfinite(r).all() and np.isfinite(values).all()):
        raise InputError(name, values.tolist(), "must be finite")
    if np.any(np.diff(r) <= 0):
        raise InputError(name, r.tolist(), "must have stations that increase from root to tip")


def _joined(parts: list[Array]) -> Array:
    """Return stations in several arrays one after another along the last axis; other axes broadcast."""
    parts = [np.empty(0), *parts]  # without parts there are no stations
    leading = np.broadcast_shapes(*(stations.shape[:-1] for stations in parts))
    return np.concatenate([np.broadcast_to(s, (*leading, s.shape[-1])) for s in parts], axis=-1)


def _interpolate(distribution: _Table | Callable[[Array], Array], r: Array) -> Array:
    """Return values (..., stations) at radii r (..., stations): linear, constant beyond the ends; r may be complex."""
    if callable(distribution):
        return np.asarray(distribution(r))
    stations, values = np.asarray(distribution[0]), np.asarray(distribution[1])
    last = stations.shape[-1] - 2
    panel = np.sum(np.real(r)[..., None] >= np.real(stations)[..., None, :], axis=-1) - 1
    panel = np.clip(panel, 0, last)
    stations = np.broadcast_to(stations, (*r.shape[:-1], last + 2))
    start, end = (np.take_along_axis(stations, panel + step, axis=-1) for step in (0, 1))
    share = (r - start) / (end - start)
    share = np.where(np.real(share) < 0, 0.0, np.where(np.real(share) > 1, 1.0, share))
    return np.asarray(values[panel] + share * (values[panel + 1] - values[panel]))


def _outboard_moment(r: Array, mass: Array, axis: ArrayLike, power: int) -> Any:
    """Return ∫ m (r - axis)^power outboard of an axis at a radius (...); the whole blade is outboard of 0."""
    nodes, weights = np.polynomial.legendre.leggauss(2)
    inboard, outboard = r[..., :-1], r[..., 1:]
    center = np.asarray(axis)[..., None]
    start = np.where(np.real(center) > np.real(inboard), center, inboard)
    start = np.where(np.real(start) > np.real(outboard), outboard, start)
    half = ((outboard - start) / 2)[..., None]
    stations = start[..., None] + half * (1 + nodes)
    slope = (np.diff(mass) / np.diff(r))[..., None]
    density = mass[:-1, None] + slope * (stations - inboard[..., None])
    return np.sum(half * weights * density * (stations - center[..., None]) ** power, axis=(-2, -1))[()]
