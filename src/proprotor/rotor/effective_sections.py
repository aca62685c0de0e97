"""Chord and twist from tables as polynomials on each panel, so that the kinks of a table need no panels of their own.

Loads of a section with a straight lift line are sums of c, c τ, c² and c³, each times a smooth function g of the
radius: lift and drag have c and, by the angle of attack, c τ; the lift of a turning section has c², the moment c² and,
by the turn, c³. With n Gauss points on a panel and Π the L2 projection onto polynomials of a degree below n, the sum of
g times Π[c τ] over the points is the integral of c τ times the polynomial that meets g at the points, without any
further error. What is left is the integral of (g - polynomial) times (c τ - Π[c τ]): a product of two small errors.

So a section has the effective chord Π[c] and the effective twist Π[c τ]/Π[c], and factors for the second and third
power of the chord. The Prandtl-Glauert factor and the air are parts of g; no load has the twist squared.

The projection has a closed form. A table is a polynomial at the start of the panel and, at each knot y, jumps of its
derivatives, that is multiples of (x - y)^m to the right of the knot. The integral of (x - y)^m / m! times a Legendre
polynomial from y to 1 is the (m+1)-th antiderivative of the Legendre polynomial at y. The form is analytic in edges,
knots and values, for derivatives by a complex step.
"""

from __future__ import annotations

from collections.abc import Callable
from math import factorial, prod
from typing import NamedTuple

import numpy as np

from proprotor.rotor.quadrature import Panels, gauss
from proprotor.typing import Array

_BLOCK = 50_000  # numbers in an array of Legendre polynomials: panels times knots times degrees
# Functions of chord, its slope, twist, its slope: values and derivatives with r (functions, orders, ...).
_Functions = Callable[[Array, Array, Array, Array], Array]


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
    def is_straight(self) -> bool:
        """Whether no knot changes the slope."""
        return bool(self.knots.shape[-1] == 1)

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
    """

    chord: Array
    twist: Array
    square: Array = np.ones(1)
    cube: Array = np.ones(1)
    bent: Array = np.zeros(1)

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
    if chord.is_straight and not chord.slopes.any():
        nothing = Line.straight(np.zeros(()), np.zeros(()))
        (effective,) = _projected(_twist_alone, nothing, twist, panels)
        return EffectiveSections(chord.values, effective)
    c, c_twist, c_square, c_cube = _projected(_products, chord, twist, panels)
    return EffectiveSections(c, c_twist / c, c_square / c**2, c_cube / c**3)


def _twist_alone(c: Array, dc: Array, t: Array, dt: Array) -> Array:
    """Return value and slope of the twist."""
    return np.stack(np.broadcast_arrays(t, dt))[None]


def _products(c: Array, dc: Array, t: Array, dt: Array) -> Array:
    """Return values and derivatives with r of c, c τ, c² and c³."""
    none = 0 * (c + dc + t + dt)
    jets = (
        (c, dc, none, none),
        (c * t, dc * t + c * dt, 2 * dc * dt, none),
        (c**2, 2 * c * dc, 2 * dc**2, none),
        (c**3, 3 * c**2 * dc, 6 * c * dc**2, 6 * dc**3),
    )
    return np.array([[none + part for part in jet] for jet in jets])


def _projected(functions: _Functions, chord: Line, twist: Line, panels: Panels) -> Array:
    """Return the projections (functions, ..., stations) of functions of chord and twist at the stations of panels."""
    shapes = (panels.points.shape[:-1], *(part.shape[:-1] for part in (*chord, *twist)))
    leading = np.broadcast_shapes(*shapes)
    panels, chord, twist = panels.spread(leading), chord.flattened(leading), twist.flattened(leading)
    knots, jumps = _jumps(functions, chord, twist)
    shape = len(jumps), prod(leading), panels.station_count
    found = np.zeros(shape, dtype=np.result_type(jumps, knots, panels.widths))
    for number, starts, half, (blades, stations) in panels.groups():
        rows = max(1, _BLOCK // (number * max(1, knots.shape[-1])))
        for first in range(0, len(starts), rows):
            some = slice(first, first + rows)
            own = blades[some, 0]
            before = functions(*(x for line in (chord, twist) for x in line.of(own).near(starts[some, None])))
            there = knots[own], jumps[:, :, own]
            found[:, blades[some], stations[some]] = _on_panels(
                number, starts[some], half[some], before, *there
            )
    return found.reshape(shape[0], *leading, shape[2])


def _jumps(functions: _Functions, chord: Line, twist: Line) -> tuple[Array, Array]:
    """Return knots (blades, k) and the jumps (functions, orders, blades, k) of the derivatives there.

    Where knots of chord and twist coincide, the chord's slope changes inboard of the twist's.
    """
    at_chord, at_twist = (
        (chord.knots, twist.near(chord.knots)),
        (twist.knots, chord.near(twist.knots, inboard=True)),
    )
    steps = []
    for slopes in (np.s_[..., 1:], np.s_[..., :-1]):
        by_chord = functions(chord.values, chord.slopes[slopes], *at_chord[1])
        by_twist = functions(*at_twist[1], twist.values, twist.slopes[slopes])
        steps.append(np.concatenate([by_chord, by_twist], axis=-1))
    bent = [not line.is_straight for line in (chord, twist) for _ in range(line.knots.shape[-1])]
    knots = np.concatenate([chord.knots, twist.knots], axis=-1)
    return knots[:, bent], (steps[0] - steps[1])[..., bent]


def _on_panels(number: int, starts: Array, half: Array, before: Array, knots: Array, jumps: Array) -> Array:
    """Return the projections (functions, n, number) at the Gauss points of n panels.

    Parameters
    ----------
    number : int
        Number of points, and of Legendre polynomials.
    starts, half : array (n,)
        Inner radii and half widths, m.
    before : array (functions, orders, n, 1)
        Values and derivatives at the inner edge.
    knots, jumps : array (n, k), (functions, orders, n, k)
        Knots of the blade and jumps of the derivatives there.
    """
    nodes, _ = gauss(number)
    x = half[:, None] * (1 + nodes)
    found = sum(before[:, order] * x**order / factorial(order) for order in range(before.shape[1]))
    inside = np.real(knots) > np.real(starts)[:, None]
    inside &= np.real(knots) < np.real(starts + 2 * half)[:, None]
    if not inside.any():
        return np.asarray(found)
    place = np.where(inside, (knots - starts[:, None]) / half[:, None] - 1, 1.0)
    antiderivatives = _legendre(place, number + jumps.shape[1])
    series = np.zeros((number, *jumps.shape[::2][:1], len(starts)), dtype=np.result_type(place, jumps))
    for order in range(jumps.shape[1]):
        antiderivatives = _integrated(antiderivatives)  # from the knot to the outer edge, `order` + 1 times
        if order:
            of_unit = inside * jumps[:, order] * half[:, None] ** order
            series += (antiderivatives[:number, None] * of_unit).sum(axis=-1)
    series *= (np.arange(number) + 0.5)[:, None, None]
    series = np.ascontiguousarray(np.moveaxis(series, 0, -1))
    # Each panel has a product of its own, whose result does not depend on the number of panels.
    return np.asarray(found + (series[..., None, :] @ _legendre(nodes, number))[..., 0, :])


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
