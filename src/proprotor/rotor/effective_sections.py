"""Chord and twist from tables as polynomials on each panel, so that the kinks of a table need no panels of their own.

Loads of a section with a straight lift line are sums of c, c τ, c² and c³, each times a smooth function g of the
radius: lift and drag have c and, by the angle of attack, c τ; the lift of a turning section has c², the moment c² and,
by the turn, c³. With n Gauss points on a panel and Π the L2 projection onto polynomials of a degree below n, the sum of
g times Π[c τ] over the points is the integral of c τ times the polynomial that meets g at the points, without any
further error. What is left is the integral of (g - polynomial) times (c τ - Π[c τ]): a product of two small errors.

So a section has the effective chord Π[c] and the effective twist Π[c τ]/Π[c], and factors for the second and third
power of the chord. The Prandtl-Glauert factor and the air are parts of g; no load has the twist squared.

The projection of a table has a closed form. The table is a line at the start of the panel and, at each knot y, a jump
of its slope times x - y to the right of the knot. The integral of x - y times a Legendre polynomial from y to the end
of the panel is the second antiderivative of the Legendre polynomial at y. Products of tables would take further
antiderivatives, whose differences lose their digits where two knots are close; so products are integrated by Gauss
points between the knots, exactly as well. Both ways are analytic in edges, knots and values, for derivatives by a
complex step.
"""

from __future__ import annotations

from collections.abc import Callable
from math import prod
from typing import NamedTuple

import numpy as np

from proprotor.rotor.quadrature import Panels, gauss
from proprotor.typing import Array

_BLOCK = 100_000  # numbers in an array of Legendre polynomials: panels times places times degrees
# Legendre coefficients (functions, n, number) of functions on n panels, from the number of coefficients, inner radii
# and half widths (n,) and the blades of the panels.
_Series = Callable[[int, Array, Array, Array], Array]


class Line(NamedTuple):
    """A quantity that is linear between knots.

    knots : radii (..., k), m.
    values : values (..., k) at the knots.
    slopes : changes with r (..., k + 1) before the first knot, after each knot and so after the last.
    """

    knots: Array
    values: Array
    slopes: Array

    @classmethod
    def through(cls, knots: Array, values: Array) -> Line:
        """Return the line through the points of a table, constant beyond its ends."""
        slopes = np.diff(values) / np.diff(knots)
        beyond = np.zeros((*slopes.shape[:-1], 1))
        return cls(knots, values, np.concatenate([beyond, slopes, beyond], axis=-1))

    @classmethod
    def straight(cls, at_axis: Array, slope: Array) -> Line:
        """Return a quantity that is linear along the whole blade."""
        slopes = np.repeat(np.asarray(slope)[..., None], 2, axis=-1)
        return cls(np.zeros(1), np.asarray(at_axis)[..., None], slopes)

    def flattened(self, shape: tuple[int, ...]) -> Line:
        """Return the line of each blade, with leading axes broadcast to `shape` and flattened to one."""
        parts = (np.broadcast_to(part, (*shape, part.shape[-1])).reshape(-1, part.shape[-1]) for part in self)
        return Line(*parts)

    def of(self, blades: Array) -> Line:
        """Return the lines of some blades."""
        return Line(*(part[blades] for part in self))

    @property
    def is_constant(self) -> bool:
        """Whether the quantity is one value along the whole blade."""
        return self.knots.shape[-1] == 1 and not self.slopes.any()

    def near(self, r: Array, inboard: bool = False) -> tuple[Array, Array]:
        """Return value and slope (blades, n) at radii of the same shape; at a knot the slope outboard, or inboard."""
        passed = np.greater if inboard else np.greater_equal
        piece = passed(np.real(r)[..., None], np.real(self.knots)[..., None, :]).sum(axis=-1)
        knot = np.maximum(piece - 1, 0)
        start, value = (np.take_along_axis(part, knot, axis=-1) for part in (self.knots, self.values))
        slope = np.take_along_axis(self.slopes, piece, axis=-1)
        return value + slope * (r - start), slope


class EffectiveSections(NamedTuple):
    """Chord and twist at the stations (..., stations) of panels that need no edges at the knots of tables.

    chord : Π[c], m; one station for a constant chord.
    twist : Π[c τ]/Π[c], rad.
    square, cube : Π[c²]/Π[c]² and Π[c³]/Π[c]³; one station, 1, where chord and twist are those of the stations.
    bent : twist at the stations themselves less the effective twist, rad; one station, 0, where there is none.
    center : aerodynamic centre at the stations themselves, m aft of the pitch axis; one station where it is constant.
    """

    chord: Array
    twist: Array
    square: Array = np.ones(1)
    cube: Array = np.ones(1)
    bent: Array = np.zeros(1)
    center: Array = np.zeros(1)

    def each(self, change: Callable[[Array], Array]) -> EffectiveSections:
        """Return the sections after a change to each array."""
        return EffectiveSections(*map(change, self))


def effective_sections(chord: Line, twist: Line, panels: Panels) -> EffectiveSections:
    """Return chord and twist at the stations of panels; a constant chord has one station.

    Parameters
    ----------
    chord, twist : Line
        m and rad; leading axes broadcast with the blades of the panels.
    panels : Panels
    """
    shapes = (panels.points.shape[:-1], *(part.shape[:-1] for part in (*chord, *twist)))
    leading = np.broadcast_shapes(*shapes)
    lines = [line.flattened(leading) for line in (chord, twist)]
    kind = np.result_type(panels.widths, *(part for line in lines for part in line))
    knots = sum(line.knots.shape[-1] for line in lines)

    def along(series: _Series, functions: int, places: int) -> Array:
        found = _at_stations(series, panels.spread(leading), (functions, prod(leading)), places, kind)
        return found.reshape(functions, *leading, -1)

    if chord.is_constant:
        (effective,) = along(lambda *panel: _series_of_line(lines[1], *panel), 1, knots)
        return EffectiveSections(chord.values, effective)
    most = int(panels.points.max(initial=0))
    products = along(lambda *panel: _series_of_products(lines, *panel), 4, knots * _between_knots(most))
    c, c_twist, c_square, c_cube = products
    return EffectiveSections(c, c_twist / c, c_square / c**2, c_cube / c**3)


def _at_stations(
    series: _Series, panels: Panels, shape: tuple[int, int], places: int, kind: np.dtype
) -> Array:
    """Return functions (functions, blades, stations) given by their series, a block of panels at a time.

    `places` is the number of radii at which the Legendre polynomials of one panel are needed.
    """
    # One stands at the stations without weight that some blades have.
    found = np.ones((*shape, panels.station_count), dtype=kind)
    for number, starts, half, (blades, stations) in panels.groups():
        at_nodes = _legendre(gauss(number)[0], number)
        rows = max(1, _BLOCK // (number * places))
        for first in range(0, len(starts), rows):
            some = slice(first, first + rows)
            own = np.ascontiguousarray(series(number, starts[some], half[some], blades[some, 0]))
            # Each panel has a product of its own, whose result does not depend on the number of panels.
            found[:, blades[some], stations[some]] = (own[..., None, :] @ at_nodes)[..., 0, :]
    return found


def _series_of_line(line: Line, number: int, starts: Array, half: Array, blades: Array) -> Array:
    """Return the series (1, n, number) of a table on n panels, as `_Series`."""
    line = line.of(blades)
    start, slope = (part[:, 0] for part in line.near(starts[:, None]))
    inside = np.real(line.knots) > np.real(starts)[:, None]
    inside &= np.real(line.knots) < np.real(starts + 2 * half)[:, None]
    knots = np.where(inside, (line.knots - starts[:, None]) / half[:, None] - 1, 1.0)
    jumps = inside * np.diff(line.slopes) * half[:, None]
    series = (_integrated(_integrated(_legendre(knots, number + 2))) * jumps).sum(axis=-1)
    series *= (np.arange(number) + 0.5)[:, None]
    series[0] += start + slope * half
    series[1] += slope * half
    return np.asarray(series.T[None])


def _series_of_products(lines: list[Line], number: int, starts: Array, half: Array, blades: Array) -> Array:
    """Return the series (4, n, number) of c, c τ, c² and c³ on n panels from chord and twist, as `_Series`."""
    lines = [line.of(blades) for line in lines]
    inner, outer = starts[:, None], (starts + 2 * half)[:, None]
    knots = np.concatenate([line.knots for line in lines], axis=-1)
    knots = np.where(np.real(knots) <= np.real(inner), inner, knots)
    knots = np.sort(np.where(np.real(knots) >= np.real(outer), outer, knots), axis=-1)
    edges = np.concatenate([inner, knots, outer], axis=-1)
    nodes, weights = gauss(_between_knots(number))
    share, width = (1 + nodes) / 2, np.diff(edges)[..., None]
    radii = (edges[:, :-1, None] + width * share).reshape(len(starts), -1)
    weight = (width * weights / 4).reshape(len(starts), -1) / half[:, None]
    ends = ((line.near(edges[:, :-1])[0], line.near(edges[:, 1:], inboard=True)[0]) for line in lines)
    c, t = ((a[..., None] + (b - a)[..., None] * share).reshape(len(starts), -1) for a, b in ends)
    polynomials = np.moveaxis(_legendre((radii - inner) / half[:, None] - 1, number), 0, -1)
    functions = np.stack([c, c * t, c**2, c**3], axis=1) * weight[:, None]
    series = functions @ np.ascontiguousarray(polynomials) * (2 * np.arange(number) + 1)
    return np.asarray(series.swapaxes(0, 1))


def _between_knots(number: int) -> int:
    """Return the number of Gauss points that integrate a chord cubed times that many Legendre polynomials exactly."""
    return (number + 4) // 2


def _legendre(x: Array, count: int) -> Array:
    """Return the first Legendre polynomials (count, ...) at x."""
    found = np.empty((count, *x.shape), dtype=x.dtype)
    found[0], found[1] = 1.0, x
    for k in range(1, count - 1):
        found[k + 1] = ((2 * k + 1) * x * found[k] - k * found[k - 1]) / (k + 1)
    return found


def _integrated(polynomials: Array) -> Array:
    """Return the integrals (count - 1, ...) from x to 1 of Legendre polynomials (count, ...), or of such integrals.

    (2k + 1) P_k is the derivative of P_(k+1) - P_(k-1); with P_(-1) = P_0 this holds for k = 0 too, and the difference
    is zero at the outer edge.
    """
    lower = np.concatenate([polynomials[:1], polynomials[:-2]])
    degrees = np.arange(len(lower)).reshape(-1, *[1] * (polynomials.ndim - 1))
    return np.asarray((lower - polynomials[1:]) / (2 * degrees + 1))
