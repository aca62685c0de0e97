"""Gauss-Legendre panels along the blade and the radial moments of section loads."""

from __future__ import annotations

import functools
import itertools
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from proprotor.arrays import Array

POWERS = 3  # moments of r^0, r^1 and r^2
# Points for a panel of a given share of the radius: at high airspeed section loads vary over the radius. At low
# airspeed they turn within V/Ω of the axis: panels near the root double outward, with points by distance from the
# axis. These keep every radial moment within 1e-10 of itself (tests/test_quadrature.py).
_LONGEST_PANEL = 0.1
_POINTS = ((0.021, 3), (0.03, 4), (0.06, 6), (np.inf, 8))
_NEAR_ROOT = 0.2 / 2.0 ** np.arange(7)  # of the radius
_TINY = np.finfo(float).tiny
_DIGITS, _MOST_POINTS = 12, 16
_COARSE_POINTS = 12


@dataclass(frozen=True, eq=False)
class RadialQuadrature:
    """Stations of the blade and the weights that turn section loads into radial moments by segment.

    Attributes
    ----------
    stations : array (..., stations)
        Radii, m.
    segment : array (..., stations)
        Segment each station lies on.
    weights : array (..., stations, segments, 3)
        Weight of a station in the integral of f r^n over each segment.
    edges : array (..., segments, 2)
        Where each segment begins and ends, m.
    beyond_flap_hinge, beyond_lag_hinge : array (segments,)
        1 on segments outboard of the hinge, else 0.
    """

    stations: Array
    segment: Array
    weights: Array
    edges: Array
    beyond_flap_hinge: Array
    beyond_lag_hinge: Array

    @property
    def real(self) -> RadialQuadrature:
        """The same without imaginary parts."""
        return replace(
            self, **{name: np.real(getattr(self, name)) for name in ("stations", "weights", "edges")}
        )

    def flattened(self, shape: tuple[int, ...]) -> RadialQuadrature:
        """The same with leading axes, if there are any, broadcast to `shape` and flattened."""
        if self.segment.ndim == 1:
            return self
        points = {"stations": 1, "segment": 1, "weights": 3, "edges": 2}
        flat = {name: flatten_points(getattr(self, name), shape, own) for name, own in points.items()}
        return replace(self, **flat)

    def take(self, rows: Array | slice) -> RadialQuadrature:
        """The quadrature at some of the points."""
        if self.segment.ndim == 1:
            return self
        return replace(
            self, **{name: getattr(self, name)[rows] for name in ("stations", "segment", "weights", "edges")}
        )

    def along_lines(self, at_axis: Array, per_radius: Array | None = None) -> Array:
        """Values (..., stations) of what is linear in r along each segment.

        Parameters
        ----------
        at_axis, per_radius : array (..., segments)
            Value at r = 0, and its change with r; without the latter it is constant.
        """
        if self.segment.ndim > 1:
            start = self._spread(at_axis)
            return start if per_radius is None else start + self._spread(per_radius) * self.stations
        line = np.empty(
            (*at_axis.shape[:-1], len(self.stations)), dtype=np.result_type(at_axis, self.stations)
        )
        for place, own in enumerate(self._slices):
            segment = min(place, at_axis.shape[-1] - 1)
            if per_radius is None:
                line[..., own] = at_axis[..., segment, None]
            else:
                np.multiply(per_radius[..., segment, None], self.stations[own], out=line[..., own])
                line[..., own] += at_axis[..., segment, None]
        return line

    @functools.cached_property
    def _slices(self) -> list[slice]:
        """Stations of each segment, which follow each other."""
        ends = np.searchsorted(self.segment, np.arange(len(self.beyond_lag_hinge)), side="right")
        return [slice(start, end) for start, end in itertools.pairwise([0, *ends])]

    def _spread(self, at_segments: Array) -> Array:
        segments = np.broadcast_to(at_segments, (*at_segments.shape[:-1], self.weights.shape[-2]))
        places = np.broadcast_to(self.segment, (*segments.shape[:-1], self.segment.shape[-1]))
        return np.take_along_axis(segments, places, axis=-1)

    def moments(self, section_load: Array) -> Array:
        """Radial moments (..., segments, 3) of a section load (..., stations)."""
        *leading, stations, segments, powers = self.weights.shape
        table = self.weights.reshape(*leading, stations, segments * powers)
        moments = (section_load[..., None, :] @ table)[..., 0, :] if leading else section_load @ table
        return moments.reshape(*moments.shape[:-1], segments, powers)


def flatten_points(array: Array, shape: tuple[int, ...], own_axes: int) -> Array:
    """An array whose axes before its own ones are broadcast to `shape` and flattened; left alone without such axes."""
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
    """Panels from cutout to tip, split at the hinges and at tabulated stations.

    Parameters
    ----------
    root_cutout, radius, flap_hinge_offset, lag_hinge_offset : float or array (...)
        m; arrays for many blades at once.
    knots : array (..., k)
        Further radii at which chord or twist has a kink, m.
    """
    at = np.zeros(knots.shape[:-1])
    root, tip, flap, lag, _ = np.broadcast_arrays(
        root_cutout, radius, flap_hinge_offset, lag_hinge_offset, at
    )
    share = np.linspace(0, 1, max(2, int(np.ceil(1 / _LONGEST_PANEL)) + 1))[1:-1]
    interior = root[..., None] + (tip - root)[..., None] * share
    if knots.shape[-1]:
        tabulated = np.broadcast_to(knots, (*root.shape, knots.shape[-1]))
        # Where a table already splits the blade finely, even panels would only add stations.
        longest = np.max(np.diff(np.sort(np.real(knots), axis=-1)), initial=0)
        finely = longest <= _LONGEST_PANEL * np.real(tip).min()
        interior = tabulated if finely else np.concatenate([tabulated, interior], axis=-1)
    near_root = tip[..., None] * _NEAR_ROOT
    ends = [root[..., None], tip[..., None], flap[..., None], lag[..., None], interior, near_root]
    edges = np.sort(_within(np.concatenate(ends, axis=-1), root[..., None], tip[..., None]), axis=-1)
    widths = np.real(np.diff(edges, axis=-1))
    used = (widths > 1e-12 * np.real(tip)[..., None]).reshape(-1, widths.shape[-1]).any(axis=0)
    # Between edges that coincide the last one counts for both sides: with complex radii they may differ a little.
    starts = edges[..., :-1][..., used]
    widths = np.diff(np.concatenate([starts, tip[..., None]], axis=-1), axis=-1)
    stations, weights = _gauss_points(starts, widths, tip)
    return _by_segment(stations, weights, root, tip, flap, lag)


def coarse_panels(
    *,
    root_cutout: ArrayLike,
    radius: ArrayLike,
    flap_hinge_offset: ArrayLike,
    lag_hinge_offset: ArrayLike,
) -> RadialQuadrature:
    """One panel for each segment and two outboard of the hinges, with few points; parameters as `gauss_panels`.

    Coarse moments are within some thousandths of the fine ones: enough for first iterations and for slopes.
    """
    root, tip, flap, lag = np.broadcast_arrays(root_cutout, radius, flap_hinge_offset, lag_hinge_offset)
    hinges = [_within(hinge, root, tip) for hinge in (flap, lag)]
    edges = np.stack([root, *hinges, (hinges[-1] + tip) / 2, tip], axis=-1)
    widths = np.diff(edges, axis=-1)
    used = (np.real(widths) > 1e-12 * np.real(tip)[..., None]).reshape(-1, widths.shape[-1]).any(axis=0)
    nodes, gauss = _gauss(_COARSE_POINTS)
    half = widths[..., used, None] / 2
    stations = edges[..., :-1][..., used][..., None] + half * (1 + nodes)
    flat = (*root.shape, -1)
    return _by_segment(stations.reshape(flat), (half * gauss).reshape(flat), root, tip, flap, lag)


def _within(edges: Array, root: Array, tip: Array) -> Array:
    """Edges moved onto root or tip where they lie beyond."""
    edges = np.where(np.real(edges) <= np.real(root), root, edges)
    return np.where(np.real(edges) >= np.real(tip), tip, edges)


def _gauss_points(starts: Array, widths: Array, tip: Array) -> tuple[Array, Array]:
    """Stations and weights of all panels; panels get points by their share of the radius and their place."""
    long, ends = np.real(widths), np.real(starts + widths)
    shares = (long / np.real(tip)[..., None]).reshape(-1, widths.shape[-1]).max(axis=0)
    nearness = (long / np.maximum(ends, _TINY)).reshape(-1, widths.shape[-1]).max(axis=0)
    stations, weights = [], []
    for panel, share in enumerate(shares):
        by_share = next(count for limit, count in _POINTS if share <= limit)
        points = max(by_share, _points_near_axis(nearness[panel]))
        nodes, gauss = _gauss(points)
        half = widths[..., panel, None] / 2
        stations.append(starts[..., panel, None] + half * (1 + nodes))
        weights.append(half * gauss)
    return np.concatenate(stations, axis=-1), np.concatenate(weights, axis=-1)


@functools.cache
def _gauss(points: int) -> tuple[Array, Array]:
    """Nodes and weights on -1 to 1, which take longer to find than a rotor's panels to fill."""
    return np.polynomial.legendre.leggauss(points)


def _points_near_axis(nearness: float) -> int:
    """Points that resolve what turns at the axis, for a panel whose width is this share of its outer radius.

    Gauss errors fall as rho^(-2n), with rho the size of the ellipse about the panel that reaches the axis.
    """
    center = 2 / max(nearness, 1e-3) - 1  # of the panel, in half widths from the axis
    rho = center + np.sqrt(max(center**2 - 1, 0.0))
    return _MOST_POINTS if rho <= 1 else min(_MOST_POINTS, int(np.ceil(_DIGITS / (2 * np.log10(rho)))))


def _by_segment(
    stations: Array, weights: Array, root: Array, tip: Array, flap: Array, lag: Array
) -> RadialQuadrature:
    beyond_flap, beyond_lag = (np.real(stations) > np.real(hinge)[..., None] for hinge in (flap, lag))
    kinds = ((False, False), (True, False), (True, True))
    masks = [(beyond_flap == flap_side) & (beyond_lag == lag_side) for flap_side, lag_side in kinds]
    present = [place for place, mask in enumerate(masks) if mask.any()]
    moments = weights[..., None] * stations[..., None] ** np.arange(POWERS)
    table = np.stack([masks[place][..., None] * moments for place in present], axis=-2)
    segment = np.argmax(np.stack([masks[place] for place in present]), axis=0)
    steps = np.array([kinds[place] for place in present], dtype=float)
    hinges = _within(np.stack([flap, lag], axis=-1), root[..., None], tip[..., None])
    ends = np.concatenate([root[..., None], hinges, tip[..., None]], axis=-1)
    edges = np.stack([ends[..., present], ends[..., np.add(present, 1)]], axis=-1)
    return RadialQuadrature(stations, segment, table, edges, steps[:, 0], steps[:, 1])
