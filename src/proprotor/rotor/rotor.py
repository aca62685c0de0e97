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
from proprotor.rotor.airfoil_regions import AirfoilRegions
from proprotor.rotor.blade_stations import BladeStations
from proprotor.rotor.effective_sections import EffectiveSections, Line, effective_sections
from proprotor.rotor.generated import evaluate
from proprotor.rotor.offset_mass import OffsetMass
from proprotor.rotor.quadrature import Panels, RadialQuadrature, flatten_points, long_panels, short_panels
from proprotor.typing import Array

MASS_INTEGRALS = (
    "blade_mass",
    *(f"{part}_{kind}" for part in ("blade", "flap", "lag") for kind in ("first_moment", "inertia")),
)
_POSITIVE = ("radius", "blade_inertia", "flap_inertia", "lag_inertia", "blade_mass")
_NOT_NEGATIVE = ("flap_hinge_offset", "root_cutout", "flap_first_moment", "lag_first_moment", "pitch_inertia")
_FRACTIONS = ("flap_outboard_fraction", "lag_outboard_fraction")
_MAY_LACK = ("cyclic_control_stiffness", "propeller_inertia", "offset_mass")
_TABLES = ("chord", "twist", "aerodynamic_center")
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
    kinematic_pitch_flap_coupling, kinematic_pitch_lag_coupling : float
        K_P3 = tan δ3 and K_P4 = tan δ4 of the blade's own hinges, dimensionless: a linkage turns the blade nose down by
        K_P3 times its flap angle and K_P4 times its lag angle, trim angles included.
    pitch_inertia, control_stiffness : float
        Inertia and stiffness for one blade: kg m², N m/rad.
    cyclic_control_stiffness : float, optional
        Stiffness of the control system for one blade where the swashplate tilts, N m/rad. The default is
        `control_stiffness`, which holds where all blades turn alike, in the trim and for reactionless motions.
    flap_damping, lag_damping, pitch_damping, gimbal_damping : float
        Viscous dampers, N m s/rad; the gimbal's does not rotate.
    structural_pitch_offset : float
        Angle from the collective reference to the blade's structural axes, rad.
    propeller_moment : bool
        Whether the propeller moment acts on the blade's pitch.
    propeller_inertia : float, optional
        I_xx - I_yy, inertia by the chordwise distances of the mass less that by its distances through the thickness,
        which makes the propeller moment, kg m². The default is `pitch_inertia`, I_xx + I_yy: a thin blade.
    offset_mass : OffsetMass, optional
        Integrals of the mass with its offset from the pitch axis; nothing by default. `from_mass_distribution` finds
        them from the offset along the blade. The pitch inertia is about the pitch axis and contains ∫ m x².
    aerodynamic_center : float, (r, values) or function of r
        Aerodynamic centre, to which lift, drag and moment of the airfoil belong, in m aft of the pitch axis.
    chord, twist : float, (r, values) or function of r
        m and rad. A number is a constant chord, or a linear twist over the radius. A pair of arrays is interpolated
        linearly between its stations, which reach from the root cutout to the tip; with (r, values, "held") the end
        values hold beyond the stations. A smooth function takes an array of radii. Twist counts from the pitch at
        0.75 R.
    airfoil : SectionModel or AirfoilRegions
        Section coefficients, such as `Airfoil`, or airfoils by region of the span.

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
    kinematic_pitch_flap_coupling: float = 0.0
    kinematic_pitch_lag_coupling: float = 0.0
    pitch_inertia: float = 0.0
    control_stiffness: float = 0.0
    cyclic_control_stiffness: float | None = None
    flap_damping: float = 0.0
    lag_damping: float = 0.0
    pitch_damping: float = 0.0
    gimbal_damping: float = 0.0
    structural_pitch_offset: float = 0.0
    propeller_moment: bool = True
    propeller_inertia: float | None = None
    offset_mass: OffsetMass | None = None
    aerodynamic_center: _Distribution = 0.0
    chord: _Distribution
    twist: _Distribution = 0.0
    airfoil: SectionModel | AirfoilRegions = field(repr=False)

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
        if name in _MAY_LACK and (value is None or isinstance(value, OffsetMass)):
            return
        distributed = name in _TABLES and (isinstance(value, tuple) or callable(value))
        if isinstance(value, tuple) and not distributed:
            raise InputError(name, value, "must be a number in SI units")
        if name != "airfoil" and not distributed:
            check_finite(name, value)

    def _check_signs(self) -> None:
        """Refuse numbers of the wrong sign, and fractions and angles out of range."""
        passive = [e.name for e in fields(self) if e.name.endswith(("_stiffness", "_damping"))]
        for names, sign in ((_POSITIVE, "above zero"), ((*_NOT_NEGATIVE, *passive), "not negative")):
            for name in names:
                if getattr(self, name) is not None:
                    check_finite(name, getattr(self, name), sign)
        for name in _FRACTIONS:
            if np.any((np.real(getattr(self, name)) < 0) | (np.real(getattr(self, name)) > 1)):
                raise InputError(name, getattr(self, name), "must lie between 0 and 1")
        for name in _TABLES:
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
        """Refuse a table along the blade whose stations do not cover all the airloads, unless its end values hold."""
        radius, cutout = np.real(self.radius), np.real(self.root_cutout)
        for name in _TABLES:
            table = getattr(self, name)
            if isinstance(table, tuple):
                _check_covers(name, table, cutout, radius)

    def _check_mass(self) -> None:
        """Refuse mass integrals that no blade can have.

        The integrals of m times two of the arms 1, r, ρβ, ρζ are inner products, so that their Gram matrix has no
        negative eigenvalue.
        """
        i_beta_alpha = np.real(self.flap_hub_inertia)
        if np.any(i_beta_alpha**2 > np.real(self.blade_inertia * self.flap_inertia) * (1 + 1e-12)):
            rule = f"breaks I_βα² ≤ I_b I_β with I_βα = I_β + e_β S_β = {_shown(i_beta_alpha)} kg m²"
            raise InputError("flap_inertia", self.flap_inertia, rule)
        if not nowhere_negative(np.real(self._gram_of_line)):
            rule = (
                "cannot belong to one blade: the Gram matrix of the mass integrals has a negative eigenvalue"
            )
            raise InputError("blade_inertia", self.blade_inertia, rule)
        self._check_offset_mass()

    def _check_offset_mass(self) -> None:
        """Refuse a pitch inertia that is less than the mass beside the axis has, and moments that no blade can have."""
        if self.offset_mass is None:
            return
        own, whole = np.real(self.offset_mass.inertia), np.real(self.pitch_inertia)
        if np.any(whole < own * (1 - 1e-12)):
            rule = f"must be at least ∫ m x² = {_shown(own)} kg m² of the mass beside the pitch axis"
            raise InputError("pitch_inertia", self.pitch_inertia, rule)
        if not nowhere_negative(np.real(self._gram_of_offsets)):
            rule = (
                "cannot belong to this blade: the Gram matrix of the mass integrals has a negative eigenvalue"
            )
            raise InputError("offset_mass", "∫ m x …", rule)

    @property
    def _gram_of_offsets(self) -> Array:
        """Integrals of m times two of 1, r, ρβ, ρζ and, outboard of the lag hinge, x cos τ, x sin τ, (..., 6, 6)."""
        of: Any = self.offset_mass
        before, between = self.lag_hinge_offset, self.lag_hinge_offset - np.asarray(self.flap_hinge_offset)
        moments = (
            (of.offset_cosine_moment, of.offset_cosine_lag_inertia),
            (of.offset_sine_moment, of.offset_sine_lag_inertia),
        )
        beside = [(first, lag + before * first, lag + between * first, lag) for first, lag in moments]
        product = of.offset_product_inertia
        squares = ((of.offset_cosine_inertia, product), (product, of.offset_sine_inertia))
        own = self._gram_of_line
        rows = [[own[..., i, j] for j in range(4)] + [column[i] for column in beside] for i in range(4)]
        rows += [[*column, *square] for column, square in zip(beside, squares, strict=True)]
        flat = np.broadcast_arrays(*(entry for row in rows for entry in row))
        return np.stack(flat, axis=-1).reshape(*np.shape(flat[0]), 6, 6)

    @property
    def gram_matrix(self) -> Array:
        """Integrals of m times two of the arms 1, r, ρβ, ρζ, (..., 4, 4) in kg, kg m and kg m².

        With mass beside the pitch axis its offsets x cos τ and x sin τ follow, (..., 6, 6).
        """
        return self._gram_of_line if self.offset_mass is None else self._gram_of_offsets

    @property
    def _gram_of_line(self) -> Array:
        """Integrals of m times two of the arms 1, r, ρβ, ρζ, (..., 4, 4)."""
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

        The loads are linear with the straight lift lines of `Airfoil`. Kinks of tables of chord and twist then need no
        panels of their own; between the joints of `AirfoilRegions`, lift slope and the like are smooth factors.
        """
        regions = self.airfoil if isinstance(self.airfoil, AirfoilRegions) else None
        straight = type(self.airfoil) is Airfoil if regions is None else regions.are_straight
        on_axis = not self.has_aerodynamic_center
        return straight and on_axis and not (callable(self.chord) or callable(self.twist))

    @property
    def has_aerodynamic_center(self) -> bool:
        """Whether the aerodynamic centre is anywhere but on the pitch axis, by what is given."""
        center = self.aerodynamic_center
        return isinstance(center, tuple) or callable(center) or bool(np.any(np.asarray(center) != 0))

    @property
    def is_beside_axis(self) -> bool:
        """Whether masses or aerodynamic centres lie beside the pitch axis, by what is given."""
        return self.offset_mass is not None or self.has_aerodynamic_center

    @property
    def propeller_share(self) -> Any:
        """Share that makes the propeller moment, of the pitch inertia that no mass beside the axis has."""
        whole = self.pitch_inertia if self.propeller_inertia is None else self.propeller_inertia
        own = 0.0 if self.offset_mass is None else self.offset_mass.inertia
        lumped = np.asarray(self.pitch_inertia - own)
        share = (whole - own) / np.where(lumped == 0, 1.0, lumped)
        return float(self.propeller_moment) * (1.0 if self.propeller_inertia is None else share)

    @functools.cached_property
    def _panels(self) -> Panels:
        """Panels of all stations."""
        if self.has_effective_sections:
            return long_panels(**self._radii, knots=self._airfoil_edges)
        tables = (getattr(self, name) for name in _TABLES)
        knots = [np.asarray(d[0]) for d in tables if isinstance(d, tuple)]
        return short_panels(**self._radii, knots=_joined([*knots, self._airfoil_edges]))

    @property
    def _airfoil_edges(self) -> Array:
        """Radii (..., k) at which one airfoil begins to pass into the next, or has done so, m."""
        return self.airfoil.edges(self.radius) if isinstance(self.airfoil, AirfoilRegions) else np.empty(0)

    def airfoil_at(self, stations: Array, shape: tuple[int, ...]) -> SectionModel:
        """Return the airfoil of the stations of a batch of designs, which are flattened.

        Parameters
        ----------
        stations : array (..., stations)
            Radii from the centre of rotation, m; leading axes broadcast to `shape`.
        shape : tuple of int
            Shape of the batch.

        Returns
        -------
        SectionModel
            For angles of attack (points, stations).
        """
        if isinstance(self.airfoil, AirfoilRegions):
            r_over_R = stations / np.asarray(self.radius)[..., None]
            return self.airfoil.at(flatten_points(r_over_R, shape, 1), shape)
        return self.airfoil.flattened(shape) if isinstance(self.airfoil, Airfoil) else self.airfoil

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
        panels = long_panels(**self._radii, knots=self._airfoil_edges)
        quadrature = panels.quadrature()
        if callable(self.chord) or callable(self.twist):
            return quadrature, self._sections_at(quadrature)
        return quadrature, self._effective_on(panels, quadrature)

    def _sections_at(self, quadrature: RadialQuadrature) -> EffectiveSections:
        """Return chord, twist and aerodynamic centre at each station."""
        r = quadrature.stations
        return EffectiveSections(self.chord_at(r), self.twist_at(r), center=self.aerodynamic_center_at(r))

    def _effective_on(self, panels: Panels, quadrature: RadialQuadrature) -> EffectiveSections:
        """Return the effective chord and twist at the stations of panels."""
        found = effective_sections(self._chord_line, self._twist_line, panels)
        r = quadrature.stations
        return found._replace(bent=self.twist_at(r) - found.twist, center=self.aerodynamic_center_at(r))

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

    def aerodynamic_center_at(self, r: Array) -> Array:
        """Return the place of the aerodynamic centre at radii.

        Parameters
        ----------
        r : array (..., stations)
            Radii from the centre of rotation, m.

        Returns
        -------
        array (..., stations)
            m aft of the pitch axis; a constant place has one station.
        """
        center = self.aerodynamic_center
        if isinstance(center, tuple) or callable(center):
            return np.asarray(_interpolate(center, r))
        return np.asarray(center, dtype=np.result_type(float, np.asarray(center)))[..., None]

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
        mass_offset: _Distribution | None = None,
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
        mass_offset : float, (r, values) or function of r, optional
            Centre of the mass aft of the pitch axis, m, as `chord`; it counts outboard of the lag hinge.
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
        if mass_offset is not None:
            rotor = rotor._with_mass_beside_axis((r, mass), mass_offset)
        return rotor if hub_mass is None else rotor._with_hub(hub_mass)

    def _with_mass_beside_axis(self, mass: _Table, offset: _Distribution) -> Rotor:
        """Return the rotor with a mass distribution whose centre lies beside the pitch axis."""
        tables = [table for table in (offset, self.twist) if isinstance(table, tuple)]
        if isinstance(offset, tuple):
            _check_distribution("mass_offset", offset)
            _check_covers("mass_offset", offset, np.real(self.lag_hinge_offset), np.real(self.radius))
        elif not callable(offset):
            check_finite("mass_offset", offset)

        def offset_at(r: Array) -> Array:
            if isinstance(offset, tuple) or callable(offset):
                return _interpolate(offset, r)
            return np.asarray(np.asarray(offset)[..., None] + 0 * r)

        first, last = (np.asarray(mass[0])[..., end : end + 1 or None] for end in (0, -1))
        knots = _joined([np.asarray(table[0]) for table in (mass, *tables)])
        knots = np.where(np.real(knots) < np.real(first), first, knots)
        knots = np.where(np.real(knots) > np.real(last), last, knots)
        found = OffsetMass.along(
            knots, self.lag_hinge_offset, lambda r: _interpolate(mass, r), offset_at, self.twist_at
        )
        return replace(self, offset_mass=found)

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


def _check_covers(name: str, table: _Table, start: Any, radius: Any) -> None:
    """Refuse a table whose stations do not reach from a radius to the tip, unless its end values hold."""
    if table[2:] == (HELD,):
        return
    first, last = (np.real(np.asarray(table[0]))[..., end] / radius for end in (0, -1))
    if np.any(first > start / radius + _REACH) or np.any(last < 1 - _REACH):
        where = "lag hinge" if name == "mass_offset" else "root cutout"
        rule = (
            f"has stations from {_shown(first)} R to {_shown(last)} R; they must reach from the {where}, "
            f'{_shown(start / radius)} R, to the tip, or say beyond = "held" to hold the end values'
        )
        raise InputError(name, f"{np.size(table[1])} values", rule)


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
