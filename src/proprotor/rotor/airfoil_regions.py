"""Airfoils along the span of a blade: an airfoil for each region, and how one region passes into the next.

Across a joint, which is centred on the end of a region and has a width, the share of the outer airfoil rises linearly
from 0 to 1, and the coefficients are added up by these shares. The sum of two straight lift lines is a straight lift
line, so that regions of `Airfoil` stay one `Airfoil`, whose numbers are arrays along the blade. Joints are sharp unless
a width is given: published data say which airfoil holds from where to where, and a width that nobody has published
would be a number without a source.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, check_finite
from proprotor.rotor.airfoil import Airfoil, SectionCoefficients, SectionModel, Warns
from proprotor.rotor.quadrature import flatten_points
from proprotor.typing import Array

_MET = 1e-9  # of the radius: joints that overlap by less have their ends in common


@dataclass(frozen=True, kw_only=True, eq=False)
class AirfoilRegions:
    """Airfoils by region of the span, from the root outward.

    Parameters
    ----------
    airfoils : tuple of SectionModel
        An airfoil for each of n regions, such as `Airfoil` or `AirfoilTable`; two or more. Numbers of an `Airfoil` may
        be arrays of designs.
    region_ends : array_like (..., n - 1)
        Outer ends r/R of all regions but the last, dimensionless, increasing between 0 and 1; a single number for two
        regions. Leading axes are those of many designs, here and in `blend`.
    blend : array_like, () or (..., n - 1) or (..., 1)
        Width of the joint at each end, as a share of the radius: half of the width lies on each side of the end, and
        across the width the coefficients change linearly from one airfoil to the next. 0 is a sharp joint. Joints may
        meet, and must not overlap.

    Raises
    ------
    InputError
        When the numbers of airfoils, ends and widths do not fit each other, ends are out of order or beyond the blade,
        joints overlap, or some of the airfoils contain compressibility and others do not.
    """

    airfoils: tuple[SectionModel, ...]
    region_ends: ArrayLike
    blend: ArrayLike = 0.0

    def __post_init__(self) -> None:
        count = len(self.airfoils)
        check_finite("region_ends", self.region_ends)
        check_finite("blend", self.blend, "not negative")
        if count < 2 or self._ends.shape[-1] != count - 1:
            rule = f"must be one fewer than the regions: there are {count} airfoils"
            raise InputError("region_ends", np.real(self._ends).tolist(), rule)
        if self._widths.shape[-1] not in (1, count - 1):
            raise InputError("blend", f"{self._widths.shape[-1]} widths", f"must be one, or {count - 1}")
        ends = np.real(self._ends)
        if np.any(np.diff(ends) <= 0) or np.any(ends <= 0) or np.any(ends >= 1):
            rule = "must increase from region to region, between 0 (centre of rotation) and 1 (tip)"
            raise InputError("region_ends", ends.tolist(), rule)
        self._check_joints()
        self._check_compressibility()

    def _check_joints(self) -> None:
        """Refuse joints that overlap or reach beyond the blade."""
        low, high = (np.real(side) for side in self._joints)
        if np.any(high[..., :-1] > low[..., 1:] + _MET):
            raise InputError("blend", np.real(self._widths).tolist(), "must not make two joints overlap")
        if np.any(low < -_MET) or np.any(high > 1 + _MET):
            raise InputError("blend", np.real(self._widths).tolist(), "must not reach beyond centre or tip")

    def _check_compressibility(self) -> None:
        """Refuse airfoils of which some take a Prandtl-Glauert factor and others do not."""
        lifting = [airfoil for airfoil in self.airfoils if not _has_drag_alone(airfoil)]
        if len({bool(airfoil.contains_compressibility) for airfoil in lifting}) > 1:
            rule = (
                "must all contain compressibility, as tables at several Mach numbers do, or none of them, but for an "
                "Airfoil without lift slope and moment"
            )
            raise InputError("airfoils", None, rule)

    @property
    def are_straight(self) -> bool:
        """Whether all airfoils have straight lift lines, whose sum along the blade is one again."""
        return all(type(airfoil) is Airfoil for airfoil in self.airfoils)

    def edges(self, radius: ArrayLike) -> Array:
        """Return the radii at which the coefficients have a kink or a jump: the ends of all joints.

        Parameters
        ----------
        radius : float or array (...)
            Radius of the rotor, m.

        Returns
        -------
        array (..., k)
            m.
        """
        edges: Array = np.concatenate(self._joints, axis=-1) * np.asarray(radius)[..., None]
        return edges

    def numbers(self) -> Iterator[Any]:
        """Yield everything that may be an array of designs.

        Yields
        ------
        float or array (...)
            End and width of the first joint (r/R, dimensionless), and the numbers of each `Airfoil` in its units.
        """
        for values in (self._ends, self._widths):
            yield values[..., 0]
        for airfoil in self.airfoils:
            if isinstance(airfoil, Airfoil):
                yield from vars(airfoil).values()

    def _shares(self, r_over_R: Array) -> Array:
        """Return the share of each airfoil (n, points, stations) at stations (points, stations); their sum is 1.

        The joints have no axis of designs, or one axis of points.
        """
        low, high = (np.atleast_2d(side).T[..., None] for side in self._joints)
        width = high - low
        sharp = np.real(width) == 0
        across = (r_over_R - low) / np.where(sharp, 1.0, width)
        inner, outer = np.real(across) <= 0, np.real(across) >= np.where(sharp, 0.0, 1.0)
        beyond = np.where(outer, 1.0, np.where(inner, 0.0, across))
        return -np.diff(beyond, axis=0, prepend=1.0, append=0.0)

    def at(self, r_over_R: Array, shape: tuple[int, ...]) -> SectionModel:
        """Return the airfoil of the stations of a blade: one `Airfoil` if all lift lines are straight.

        Parameters
        ----------
        r_over_R : array (stations,) or (points, stations)
            Radii of the stations r/R, dimensionless.
        shape : tuple of int
            Shape of the batch of designs, of which the points are the flattened places.

        Returns
        -------
        SectionModel
            For angles of attack (points, stations).
        """
        ends, widths = (flatten_points(part, shape, 1) for part in (self._ends, self._widths))
        flat = replace(self, region_ends=ends, blend=widths)
        shares = flat._shares(np.atleast_2d(r_over_R))
        parts = [part.flattened(shape) if isinstance(part, Airfoil) else part for part in self.airfoils]
        if self.are_straight:
            return _straight(cast("list[Airfoil]", parts), shares)
        return _AirfoilsAtStations(tuple(parts), shares)

    @property
    def _ends(self) -> Array:
        """Ends (..., n - 1)."""
        return np.atleast_1d(np.asarray(self.region_ends))

    @property
    def _widths(self) -> Array:
        """Widths of the joints (..., n - 1) or (..., 1)."""
        return np.atleast_1d(np.asarray(self.blend))

    @property
    def _joints(self) -> tuple[Array, Array]:
        """Inner and outer ends of the joints (..., n - 1), of the radius."""
        ends, half = np.broadcast_arrays(self._ends, self._widths / 2)
        # A width of 0 moves nothing to first order, so that its imaginary part, a complex step, counts for nothing.
        half = np.where(np.real(half) == 0, 0.0, half)
        return ends - half, ends + half


@dataclass(frozen=True, eq=False)
class _AirfoilsAtStations:
    """Airfoils of the stations of a blade, of which some have no straight lift line.

    airfoils : tuple of SectionModel
    shares : array (n, points, stations), of each of the n airfoils; one point for stations that all points share.
    """

    airfoils: tuple[SectionModel, ...]
    shares: Array

    @property
    def contains_compressibility(self) -> bool:
        """Whether the coefficients take no Prandtl-Glauert factor."""
        return any(airfoil.contains_compressibility for airfoil in self.airfoils)

    @property
    def is_complex(self) -> bool:
        """Whether any number is complex."""
        lines = (part for part in self.airfoils if isinstance(part, Airfoil))
        return np.iscomplexobj(self.shares) or any(part.is_complex for part in lines)

    @property
    def real(self) -> _AirfoilsAtStations:
        """The same airfoils without imaginary parts."""
        parts = (part.real if isinstance(part, Airfoil) else part for part in self.airfoils)
        return _AirfoilsAtStations(tuple(parts), np.real(self.shares))

    def take(self, rows: Array | slice, stations: slice) -> _AirfoilsAtStations:
        """Return the airfoils at some of the points and stations."""
        parts = (part.take(rows, stations) if isinstance(part, Airfoil) else part for part in self.airfoils)
        some = self.shares if self.shares.shape[1] == 1 else self.shares[:, rows]
        return _AirfoilsAtStations(tuple(parts), some[..., stations])

    def coefficients(self, alpha: Array, mach: Array) -> SectionCoefficients:
        """Return the coefficients of the airfoils, added up by their shares, of the broadcast shape (..., stations)."""
        alpha, mach = np.broadcast_arrays(alpha, mach)
        kind = np.result_type(alpha, mach, self.shares)
        found = {name: np.zeros(alpha.shape, dtype=kind) for name in SectionCoefficients._fields}
        for airfoil, share, here in self._present():
            own = airfoil.coefficients(alpha[..., here], mach[..., here])
            for name, value in own._asdict().items():
                found[name][..., here] += share[..., here] * value
        return SectionCoefficients(**found)

    def warnings(self, alpha: Array, mach: Array) -> dict[str, Array]:
        """Return masks (..., stations) by reason and region; an airfoil counts at its own stations alone."""
        alpha, mach = np.broadcast_arrays(alpha, mach)
        found: dict[str, Array] = {}
        for place, (airfoil, share, here) in enumerate(self._present(), start=1):
            if not isinstance(airfoil, Warns):
                continue
            for text, mask in airfoil.warnings(alpha[..., here], mach[..., here]).items():
                marks = found.setdefault(
                    f"{text} in airfoil region {place}", np.zeros(alpha.shape, dtype=bool)
                )
                marks[..., here] = mask & (np.real(share[..., here]) > 0)
        return found

    def _present(self) -> Iterator[tuple[SectionModel, Array, Array]]:
        """Yield each airfoil with its shares, and the stations (stations,) that it has at any point."""
        for airfoil, share in zip(self.airfoils, self.shares, strict=True):
            yield airfoil, share, (share != 0).any(axis=0)


def _straight(airfoils: list[Airfoil], shares: Array) -> Airfoil:
    """Return straight lift lines, added up by shares (n, points, stations), as one whose numbers are arrays."""
    parts = {
        field.name: [
            share * getattr(airfoil, field.name) for airfoil, share in zip(airfoils, shares, strict=True)
        ]
        for field in fields(Airfoil)
    }
    pairs = zip(parts["lift_slope"], airfoils, strict=True)
    without_angle = sum(slope * airfoil.zero_lift_angle for slope, airfoil in pairs)
    whole = {name: sum(values) for name, values in parts.items()}
    slope = whole["lift_slope"]
    flat = slope == 0  # no lift at any angle
    whole["zero_lift_angle"] = np.where(flat, 0.0, without_angle / np.where(flat, 1.0, slope))
    return Airfoil(**whole)


def _has_drag_alone(airfoil: SectionModel) -> bool:
    """Return whether an airfoil has neither lift nor moment, which take a Prandtl-Glauert factor."""
    return isinstance(airfoil, Airfoil) and not (np.any(airfoil.lift_slope) or np.any(airfoil.moment))
