"""Gauss-Legendre panels along the blade, and radial moments of section loads."""

from __future__ import annotations

import functools
import itertools
from dataclasses import dataclass, replace

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
_COARSE_POINTS = 12
# Nodes and weights on -1 to 1, kept because to find them takes longer than to fill a rotor's panels.
_gauss = functools.cache(np.polynomial.legendre.leggauss)


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
        for place, own in enumerate(self._slices):
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
        products = [section_load[..., None, own] @ self.weights[..., own, :] for own in self._slices]
        return np.concatenate(products, axis=-2)

    @functools.cached_property
    def _slices(self) -> list[slice]:
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


def gauss_panels(
    *,
    root_cutout: ArrayLike,
    radius: ArrayLike,
    flap_hinge_offset: ArrayLike,
    lag_hinge_offset: ArrayLike,
    knots: Array,
) -> RadialQuadrature:
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
    ends = [inner, outer, flap[..., None], lag[..., None], tabulated, even, outer * _NEAR_ROOT]
    edges = np.sort(_within(np.concatenate(ends, axis=-1), inner, outer), axis=-1)
    # Between edges that coincide the last one counts for both sides: with complex radii they may differ a little.
    # Panels without width stand behind the others, at the tip.
    starts = np.sort(np.where(_wide(edges, tip), edges[..., :-1], outer), axis=-1)
    widths = np.diff(starts, axis=-1, append=outer)
    stations, weights = _gauss_points(starts, widths, _points(starts, widths, tip), tip)
    return _by_segment(stations, weights, root, tip, flap, lag)


def coarse_panels(
    *,
    root_cutout: ArrayLike,
    radius: ArrayLike,
    flap_hinge_offset: ArrayLike,
    lag_hinge_offset: ArrayLike,
) -> RadialQuadrature:
    """Return one panel for each segment and two outboard of the hinges, with few points; parameters as `gauss_panels`.

    Coarse moments are within some thousandths of the fine moments: enough for first iterations and for slopes.
    """
    root, tip, flap, lag = np.broadcast_arrays(root_cutout, radius, flap_hinge_offset, lag_hinge_offset)
    hinges = [_within(hinge, root, tip) for hinge in (flap, lag)]
    edges = np.stack([root, *hinges, (hinges[-1] + tip) / 2, tip], axis=-1)
    points = np.where(_wide(edges, tip), _COARSE_POINTS, 0)
    stations, weights = _gauss_points(edges[..., :-1], np.diff(edges, axis=-1), points, tip)
    return _by_segment(stations, weights, root, tip, flap, lag)


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


def _gauss_points(starts: Array, widths: Array, points: Array, tip: Array) -> tuple[Array, Array]:
    """Return stations and weights (..., stations) of panels (..., panels), each with its number of points."""
    *leading, panels = points.shape
    starts, half, points = (part.reshape(-1, panels) for part in (starts, widths / 2, points))
    ends = np.cumsum(points, axis=-1)
    count = ends[:, -1].max(initial=0)
    stations = np.repeat(tip.reshape(-1, 1), count, axis=-1).astype(half.dtype)
    weights = np.zeros_like(stations)
    for number in np.unique(points[points > 0]):
        nodes, gauss = _gauss(int(number))
        blade, panel = np.nonzero(points == number)
        places = blade[:, None], (ends[blade, panel] - number)[:, None] + np.arange(number)
        stations[places] = starts[blade, panel, None] + half[blade, panel, None] * (1 + nodes)
        weights[places] = half[blade, panel, None] * gauss
    return stations.reshape(*leading, count), weights.reshape(*leading, count)


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
