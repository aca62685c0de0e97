"""Gauss-Legendre panels along the blade, and radial moments of section loads.

Long panels, one on most segments, are for loads that are linear in chord and twist: `effective_sections` makes the
kinks of tables harmless. Short panels with an edge at each kink are for all other loads.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.typing import Array

POWERS = 3  # moments of r^0, r^1 and r^2
# Number of points for a panel of a given share of the radius: at high airspeed section loads vary over the radius. At
# low airspeed section loads change quickly within V/Ω of the axis: panels near the root double in width outward, and
# the number of their points follows from the distance to the axis. Every radial moment then has a relative error below
# 1e-10 (tests/rotor/test_quadrature.py).
_LONGEST_PANEL = 0.1
_SHARES, _POINTS = np.array([0.021, 0.03, 0.06]), np.array([3, 4, 6, 8])
_NEAR_ROOT = 0.2 / 2.0 ** np.arange(7)  # of the radius
_TINY = np.finfo(float).tiny
_DIGITS, _MOST_POINTS = 12, 16
# Width of a panel, as a share of its outer radius, up to which 1, 2, ... points resolve loads that change quickly at
# the axis. Gauss errors fall as rho^(-2n), with rho the size of the ellipse about the panel that reaches the axis; the
# axis is (rho + 1/rho)/2 half widths from the panel's centre.
_NEARNESS = 2 / (1 + np.cosh(_DIGITS * np.log(10) / (2 * np.arange(1, _MOST_POINTS))))
# Long panels: the factors of chord and twist in the loads have singularities at r = ±iV/Ω, where the air stands still,
# and where the air has the speed of sound. An ellipse about a panel's ends through the nearest singularity has the size
# rho: a polynomial of degree n comes within rho^(-n) of such a factor. The error of a moment is this times the error of
# a polynomial for the table, which is below 1e-2 even for jumps: eight digits of rho^n leave 1e-10 of the moment.
_SLOWEST = 0.002  # of ΩR, airspeed
_SONIC = 1 / 0.9  # of the radius: for slow air and a tip of Mach 0.9, beyond the end of a straight lift line
_LONG_DIGITS = 8
_FEWEST = 4  # points: a chord cubed is a polynomial of degree 3
_NOWHERE = np.empty(0)
_GRADES = np.array([0.004, 0.02, 0.1])  # edges of long panels near the axis, of the radius
# Nodes and weights on -1 to 1, kept because to find them takes longer than to fill a rotor's panels.
gauss = functools.cache(np.polynomial.legendre.leggauss)


@dataclass(frozen=True, eq=False)
class RadialQuadrature:
    """Stations of the blade, and the weights that turn section loads into radial moments by segment.

    Each of many blades has the stations that it would have alone. A blade with fewer stations than others has further
    stations without weight behind its own.

    Attributes
    ----------
    stations : array (..., stations)
        Radii from root to tip, m.
    weights : array (..., stations, 3)
        Weight of a station in the integral of f r^n over its segment.
    counts : array (..., segments)
        How many stations lie on each segment; none on a segment that only other blades have.
    edges : array (..., segments, 2)
        Inner and outer radius of each segment, m; both at the tip for a segment without stations.
    beyond_flap_hinge, beyond_lag_hinge : array (segments,)
        1 on segments outboard of the hinge, else 0.
    """

    stations: Array
    weights: Array
    counts: Array
    edges: Array
    beyond_flap_hinge: Array
    beyond_lag_hinge: Array

    @property
    def real(self) -> RadialQuadrature:
        """The same quadrature without imaginary parts."""
        return replace(
            self, **{name: np.real(getattr(self, name)) for name in ("stations", "weights", "edges")}
        )

    def flattened(self, shape: tuple[int, ...]) -> RadialQuadrature:
        """Return the quadrature with its leading axes, if any, broadcast to `shape` and flattened."""
        flat = {name: flatten_points(getattr(self, name), shape, own) for name, own in _OWN_AXES.items()}
        return replace(self, **flat)

    def take(self, rows: Array | slice) -> RadialQuadrature:
        """Return the quadrature at some of the points, without the stations that none of these points has."""
        if self.counts.ndim == 1:
            return self
        some = {name: getattr(self, name)[rows] for name in _OWN_AXES}
        longest = some["counts"].sum(axis=-1).max(initial=0)
        some |= {name: some[name][:, :longest] for name in ("stations", "weights")}
        return replace(self, **some)

    def alike(self) -> list[Array]:
        """Return groups of points with equal numbers of stations on each segment; points have stations of their own."""
        order = np.lexsort(self.counts.T)
        differ = np.diff(self.counts[order], axis=0).any(axis=-1)
        return np.split(order, 1 + np.flatnonzero(differ))

    def along_lines(self, at_axis: Array, per_radius: Array | None = None) -> Array:
        """Return values (..., stations) of a quantity that is linear in r along each segment.

        Parameters
        ----------
        at_axis, per_radius : array (..., segments)
            Value at r = 0, and change with r; the quantity is constant if no change is given. The points must be alike.
        """
        leading = np.broadcast_shapes(at_axis.shape[:-1], self.stations.shape[:-1])
        line = np.empty((*leading, self.stations.shape[-1]), dtype=np.result_type(at_axis, self.stations))
        for place, own in enumerate(self.slices):
            segment = min(place, at_axis.shape[-1] - 1)
            if per_radius is None:
                line[..., own] = at_axis[..., segment, None]
            else:
                np.multiply(per_radius[..., segment, None], self.stations[..., own], out=line[..., own])
                line[..., own] += at_axis[..., segment, None]
        return line

    def moments(self, section_load: Array) -> Array:
        """Return the radial moments (..., segments, 3) of a section load (..., stations); the points must be alike.

        Each point has a product of its own, whose shape and so whose result does not depend on the number of points.
        """
        products = [section_load[..., None, own] @ self.weights[..., own, :] for own in self.slices]
        return np.concatenate(products, axis=-2)

    @functools.cached_property
    def slices(self) -> list[slice]:
        """Stations of each segment, which follow each other outward."""
        counts = self.counts.reshape(-1, self.counts.shape[-1])
        assert (counts == counts[0]).all(), "these points' stations have no slices in common"
        return [slice(start, end) for start, end in itertools.pairwise([0, *np.cumsum(counts[0])])]


_OWN_AXES = {"stations": 1, "weights": 2, "counts": 1, "edges": 2}  # of each blade


def flatten_points(array: Array, shape: tuple[int, ...], own_axes: int) -> Array:
    """Return an array with the axes before its own axes, if any, broadcast to `shape` and flattened."""
    array = np.asarray(array)
    if array.ndim == own_axes:
        return array
    own = array.shape[array.ndim - own_axes :]
    return np.broadcast_to(array, (*shape, *own)).reshape(-1, *own)


class Panels(NamedTuple):
    """Panels (..., panels) of each blade; panels without points stand at the tip, behind the others.

    starts, widths : inner radius and width, m.
    points : number of Gauss points.
    root, tip, flap_hinge, lag_hinge : radii (...), m.
    """

    starts: Array
    widths: Array
    points: Array
    root: Array
    tip: Array
    flap_hinge: Array
    lag_hinge: Array

    def groups(self) -> Iterator[tuple[int, Array, Array, tuple[Array, Array]]]:
        """Yield panels with equal numbers of points: number, inner radii and half widths (n,), places of their points.

        The places are (n, 1) of the blade, with all axes of the blades flattened, and (n, number) of the station.
        """
        starts, half, points = (
            part.reshape(-1, self.points.shape[-1]) for part in (self.starts, self.widths / 2, self.points)
        )
        ends = np.cumsum(points, axis=-1)
        for number in np.unique(points[points > 0]).tolist():
            blade, panel = np.nonzero(points == number)
            places = blade[:, None], (ends[blade, panel] - number)[:, None] + np.arange(number)
            yield number, starts[blade, panel], half[blade, panel], places

    def spread(self, shape: tuple[int, ...]) -> Panels:
        """Return the panels of blades with more axes."""
        own = (1, 1, 1, 0, 0, 0, 0)
        parts = zip(self, own, strict=True)
        return Panels(*(np.broadcast_to(part, (*shape, *part.shape[part.ndim - k :])) for part, k in parts))

    @property
    def station_count(self) -> int:
        """Number of stations of the blade that has most of them."""
        return int(self.points.sum(axis=-1).max(initial=0))

    def quadrature(self) -> RadialQuadrature:
        """Return stations and weights, divided into segments at the hinges."""
        count, leading = self.station_count, self.points.shape[:-1]
        stations = np.repeat(self.tip.reshape(-1, 1), count, axis=-1).astype(self.widths.dtype)
        weights = np.zeros_like(stations)
        for number, starts, half, places in self.groups():
            nodes, of_nodes = gauss(number)
            stations[places] = starts[:, None] + half[:, None] * (1 + nodes)
            weights[places] = half[:, None] * of_nodes
        found = stations.reshape(*leading, count), weights.reshape(*leading, count)
        return _by_segment(*found, self.root, self.tip, self.flap_hinge, self.lag_hinge)


def short_panels(
    *,
    root_cutout: ArrayLike,
    radius: ArrayLike,
    flap_hinge_offset: ArrayLike,
    lag_hinge_offset: ArrayLike,
    knots: Array,
) -> Panels:
    """Return panels from cutout to tip, split at the hinges and at tabulated stations.

    Parameters
    ----------
    root_cutout, radius, flap_hinge_offset, lag_hinge_offset : float or array (...)
        m; arrays for many blades at once.
    knots : array (..., k)
        Radii at which chord or twist has a kink, m.
    """
    blades = np.zeros(knots.shape[:-1])
    given = root_cutout, radius, flap_hinge_offset, lag_hinge_offset, blades
    root, tip, flap, lag, _ = np.broadcast_arrays(*given)
    inner, outer = root[..., None], tip[..., None]
    share = np.linspace(0, 1, round(1 / _LONGEST_PANEL) + 1)[1:-1]
    even, tabulated = inner + (outer - inner) * share, np.broadcast_to(knots, (*root.shape, knots.shape[-1]))
    if knots.shape[-1]:
        # If a table splits the blade finely already, even panels would only add stations.
        longest = np.max(np.diff(np.sort(np.real(tabulated), axis=-1)), axis=-1, initial=0)
        even = np.where((longest <= _LONGEST_PANEL * np.real(tip))[..., None], inner, even)
    starts, widths = _between(root, tip, flap, lag, tabulated, even, outer * _NEAR_ROOT)
    return Panels(starts, widths, _points(starts, widths, tip), root, tip, flap, lag)


def long_panels(
    *,
    root_cutout: ArrayLike,
    radius: ArrayLike,
    flap_hinge_offset: ArrayLike,
    lag_hinge_offset: ArrayLike,
    knots: Array = _NOWHERE,
) -> Panels:
    """Return one panel for each segment between hinges and knots, more for a blade that begins near the axis.

    Parameters
    ----------
    root_cutout, radius, flap_hinge_offset, lag_hinge_offset : float or array (...)
        m; arrays for many blades at once.
    knots : array (..., k)
        Radii at which the airfoil changes its coefficients with a kink or a jump, m.
    """
    blades = np.zeros(knots.shape[:-1])
    given = root_cutout, radius, flap_hinge_offset, lag_hinge_offset, blades
    root, tip, flap, lag, _ = np.broadcast_arrays(*given)
    edges = np.broadcast_to(knots, (*root.shape, knots.shape[-1]))
    inner, outer = root[..., None], tip[..., None]
    # A blade that begins beyond half of such a radius has no panel that spans a wide range of radii.
    grades = np.where(np.real(inner) < np.real(outer) * _GRADES / 2, outer * _GRADES, inner)
    starts, widths = _between(root, tip, flap, lag, grades, edges)
    return Panels(starts, widths, _long_points(starts, widths, tip), root, tip, flap, lag)


def _between(root: Array, tip: Array, flap: Array, lag: Array, *others: Array) -> tuple[Array, Array]:
    """Return starts and widths (..., panels) of panels with edges at both ends, at hinges and at other radii."""
    inner, outer = root[..., None], tip[..., None]
    edges = _within(
        np.concatenate([inner, outer, flap[..., None], lag[..., None], *others], axis=-1), inner, outer
    )
    edges = np.sort(edges, axis=-1)
    # Between edges that coincide the last one counts for both sides: with complex radii they may differ a little.
    # Panels without width stand behind the others, at the tip.
    starts = np.sort(np.where(_wide(edges, tip), edges[..., :-1], outer), axis=-1)
    return starts, np.diff(starts, axis=-1, append=outer)


def _within(edges: Array, root: Array, tip: Array) -> Array:
    """Return edges, with edges beyond root or tip moved onto root or tip."""
    edges = np.where(np.real(edges) <= np.real(root), root, edges)
    return np.where(np.real(edges) >= np.real(tip), tip, edges)


def _wide(edges: Array, tip: Array) -> Array:
    """Return which panels between edges (..., n) have a width, (..., n - 1)."""
    return np.real(np.diff(edges, axis=-1)) > 1e-12 * np.real(tip)[..., None]


def _points(starts: Array, widths: Array, tip: Array) -> Array:
    """Return the number of points of each panel (..., panels), by width and place; none on a panel without width."""
    long, ends = np.real(widths), np.real(starts + widths)
    by_share = _POINTS[np.searchsorted(_SHARES, long / np.real(tip)[..., None])]
    near_axis = 1 + np.searchsorted(_NEARNESS, long / np.maximum(ends, _TINY))
    return np.where(long > 0, np.maximum(by_share, near_axis), 0)


def _long_points(starts: Array, widths: Array, tip: Array) -> Array:
    """Return the number of points of each long panel (..., panels); none on a panel without width."""
    radius = np.real(tip)[..., None]
    start, width = np.real(starts) / radius, np.real(widths) / radius
    there, width = width > 0, np.where(width > 0, width, 1.0)
    still = np.hypot(start, _SLOWEST) + np.hypot(start + width, _SLOWEST)
    # Sum of the distances of a point of the ellipse from the panel's ends, by the panel's width: (rho + 1/rho)/2.
    across = np.minimum(still, 2 * (_SONIC - start) - width) / width
    degree = np.ceil(_LONG_DIGITS * np.log(10) / np.arccosh(np.where(there, across, 2.0))).astype(int)
    return np.where(there, np.maximum(degree + 1, _FEWEST), 0)


def _by_segment(
    stations: Array, weights: Array, root: Array, tip: Array, flap: Array, lag: Array
) -> RadialQuadrature:
    """Return the quadrature of stations and weights, divided into segments at the hinges."""
    inboard = (np.sum(np.real(stations) <= np.real(hinge)[..., None], axis=-1) for hinge in (flap, lag))
    whole = np.sum(np.real(weights) > 0, axis=-1)
    counts = np.diff(np.stack([*inboard, whole], axis=-1), axis=-1, prepend=0)
    present = np.flatnonzero(counts.any(axis=tuple(range(counts.ndim - 1))))
    counts = counts[..., present]
    steps = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)])[present]
    moments = weights[..., None] * stations[..., None] ** np.arange(POWERS)
    hinges = _within(np.stack([flap, lag], axis=-1), root[..., None], tip[..., None])
    ends = np.concatenate([root[..., None], hinges, tip[..., None]], axis=-1)
    edges = np.stack([ends[..., present], ends[..., present + 1]], axis=-1)
    edges = np.where(counts[..., None] > 0, edges, tip[..., None, None])
    return RadialQuadrature(stations, moments, counts, edges, steps[:, 0], steps[:, 1])
