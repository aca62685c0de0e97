"""One section coefficient over angle of attack and Mach number: a smooth surface through the nodes of a table.

Between the nodes the surface is bicubic, with nodal slopes after Fritsch and Butland (SciPy's PCHIP) in both
directions; the cross derivative is the slope, in Mach number, of the slopes in angle of attack. The surface
meets the table at every node, is continuously differentiable, and along every row and column runs
monotonically from node to node: the surface does not overshoot, and lift peaks where it peaks in the table. A slope
follows from the two cells beside the node alone. A C² spline would be smoother, but the kink of a stall makes
the spline oscillate in the linear range, whose slope decides flutter.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from proprotor.typing import Array

_CLOSEST = 1e-9  # nodes nearer than this count as one node
_FASTEST = 10.0  # Mach number
_LARGEST = 1000.0  # of a coefficient
_SAME = 1e-9  # coefficients and angles that differ by less are equal


@dataclass(frozen=True, eq=False)
class CoefficientSurface:
    """A coefficient at n angles and m Mach numbers, and between and beyond these nodes.

    Outside the table the surface continues on straight lines in angle of attack and is constant in Mach number, with
    a Mach derivative of zero. A table from -180 to 180 deg whose ends agree closes on itself instead, and a table with
    a single column holds at every Mach number.

    Parameters
    ----------
    alpha : array (n,)
        Angles of attack, rad, increasing, within half a turn; two or more.
    mach : array (m,)
        Mach numbers, increasing, 0 to 10.
    values : array (n, m)
    """

    alpha: Array
    mach: Array
    values: Array

    @cached_property
    def wraps(self) -> bool:
        """Whether the table closes on itself at half a turn."""
        full = np.allclose(self.alpha[[0, -1]], [-np.pi, np.pi], rtol=0, atol=_SAME)
        return full and np.allclose(self.values[0], self.values[-1], rtol=0, atol=_SAME)

    def at(self, alpha: Array, mach: Array) -> tuple[Array, Array, Array]:
        """Return value and exact derivatives with angle of attack (1/rad) and Mach number, (...).

        Parameters
        ----------
        alpha, mach : array (...)
            Angle in rad and Mach number, real, or complex for a complex step. NaN in either gives NaN.
        """
        row, angle = _place(self.alpha, self.turned(alpha))
        column, speed = _place(self.mach, mach)
        along_alpha, by_mach = _horner(self._polynomials[:, :, row, column], speed)
        return *_horner(along_alpha, angle), _horner(by_mach, angle)[0]

    def beyond_alpha(self, alpha: Array) -> Array:
        """Return whether angles of attack lie outside the table, (...)."""
        return _outside(self.alpha, alpha) & (not self.wraps)

    def beyond_mach(self, mach: Array) -> Array:
        """Return whether Mach numbers lie outside the table, (...)."""
        return _outside(self.mach, mach) & (len(self.mach) > 1)

    def turned(self, alpha: Array) -> Array:
        """Return an angle of attack moved to within half a turn if the table closes on itself."""
        return alpha - 2 * np.pi * np.round(np.real(alpha) / (2 * np.pi)) if self.wraps else alpha

    @cached_property
    def _polynomials(self) -> Array:
        """Coefficients (4, 4, n + 1, m + 1) of the powers of Mach number and angle from the start of each cell.

        The first and last cell of either direction lie outside the table.
        """
        by_alpha, by_mach = self._alpha_slopes, _slopes(self.mach, self.values.T).T
        values = _cubics(self.alpha, self.values, by_alpha, outside=1.0)
        slopes = _cubics(self.alpha, by_mach, _slopes(self.mach, by_alpha.T).T, outside=1.0)
        cells = _cubics(self.mach, values.transpose(2, 1, 0), slopes.transpose(2, 1, 0), outside=0.0)
        return np.ascontiguousarray(cells.transpose(1, 2, 3, 0))

    @property
    def _alpha_slopes(self) -> Array:
        """Slopes at the nodes along the angle of attack; the slopes of a closed table go across its ends."""
        if not self.wraps:
            return _slopes(self.alpha, self.values)
        turn = 2 * np.pi
        alpha = np.concatenate([self.alpha[-2:-1] - turn, self.alpha, self.alpha[1:2] + turn])
        return _slopes(alpha, np.concatenate([self.values[-2:-1], self.values, self.values[1:2]]))[1:-1]


def broken_rules(alpha: Array, mach: Array, values: Array, least: float) -> Iterator[tuple[int, str]]:
    """Yield row and rule of every fault in a table of the right shape; row 0 stands for the Mach numbers.

    Parameters
    ----------
    alpha, mach, values : array (n,), (m,), (n, m)
    least : float
        Least allowed value.
    """
    if not np.all((mach >= 0) & (mach <= _FASTEST)):
        yield 0, f"Mach numbers must lie between 0 and {_FASTEST:g}"
    elif np.any(np.diff(mach) < _CLOSEST):
        yield 0, "Mach numbers must increase from column to column"
    in_turn = np.abs(alpha) <= np.pi + _SAME
    yield from _first_row(in_turn, "the angle of attack must lie between -180 and 180 deg, -π and π rad")
    if in_turn.all():
        increases = np.append(True, np.diff(alpha) >= _CLOSEST)
        yield from _first_row(increases, "angles of attack must increase from row to row")
    small = np.all(np.abs(values) <= _LARGEST, axis=1)
    yield from _first_row(small, f"coefficients must be finite and at most {_LARGEST:g}")
    yield from _first_row(~np.any(values < least, axis=1), f"coefficients must not be less than {least:g}")


def _first_row(holds: Array, rule: str) -> Iterator[tuple[int, str]]:
    """Yield the first row in which a rule does not hold."""
    return ((int(row) + 1, rule) for row in np.flatnonzero(~holds)[:1])


def _outside(nodes: Array, x: Array) -> Array:
    """Return whether each x lies below the first node or above the last."""
    return np.asarray((np.real(x) < nodes[0]) | (np.real(x) > nodes[-1]))


def _place(nodes: Array, x: Array) -> tuple[Array, Array]:
    """Return the cell of each x, 0 below the first node, and the distance from the cell's start; nodes are inside."""
    starts = np.append(nodes[:-1], np.nextafter(nodes[-1], np.inf))
    cell = np.searchsorted(starts, np.real(x), side="right")
    return cell, x - nodes[np.maximum(cell - 1, 0)]


def _horner(coefficients: Array, t: Array) -> tuple[Array, Array]:
    """Return a polynomial and its derivative; coefficients stand along the first axis, the constant term first."""
    value, slope = coefficients[-1], np.zeros_like(t)
    for coefficient in coefficients[-2::-1]:
        slope = slope * t + value
        value = value * t + coefficient
    return value, slope


def _slopes(x: Array, values: Array) -> Array:
    """Return the slopes at the nodes along the first axis."""
    from scipy.interpolate import PchipInterpolator  # here, because it takes long to import

    if len(x) == 1:
        return np.zeros_like(values)
    # Reciprocals of the smallest differences overflow, and become zero slopes.
    with np.errstate(over="ignore"):
        return np.asarray(PchipInterpolator(x, values, axis=0)(x, nu=1))


def _cubics(x: Array, values: Array, slopes: Array, outside: float) -> Array:
    """Return the coefficients (n + 1, 4, ...) of the cubics between n nodes along the first axis, and of lines outside.

    `outside` is the factor on the slope beyond the ends: 1 for a straight line, 0 for a constant value.
    """
    step = np.diff(x).reshape(-1, *[1] * (values.ndim - 1))
    secant, left, right = np.diff(values, axis=0) / step, slopes[:-1], slopes[1:]
    bent, twisted = (3 * secant - 2 * left - right) / step, (left + right - 2 * secant) / step**2
    between = np.stack([values[:-1], left, bent, twisted], axis=1)
    ends = np.stack([values, outside * slopes, 0 * values, 0 * values], axis=1)
    return np.concatenate([ends[:1], between, ends[-1:]])
