"""Margins of a loop from its transfer function L: how much gain, phase, delay, or both at once it may change.

The loop is stable, and L = -1 is the limit. Crossings of |L| = 1 and of the negative real axis are bracketed on a grid
of frequencies that resolves every root of the cut and of the closed loop, and found by bisection and secants. The disk
margin α is that of the balanced sensitivity, 2/α = max |S - T| = max |(1 - L)/(1 + L)|: gain and phase may change
together within a disk that allows gains from (2 - α)/(2 + α) to (2 + α)/(2 - α) and phases up to 2 atan(α/2).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from proprotor.typing import Array

_Transfer = Callable[[Array], Array]

_AROUND_ROOT = np.tan(np.linspace(-1.5, 1.5, 41))  # in parts of the decay of a root
_EVERYWHERE = 400  # frequencies of a grid that knows no root
_WIDER = 4.0  # times the fastest root
_SLOWEST = 1e-4  # of the slowest root: as good as zero
_TURN = 0.25  # rad of phase of a delay between two frequencies
_REAL = 1e-3  # imaginary part beside the real one at the slowest frequency, where a loop is static
_MOST_OF_DELAY = 4000  # frequencies that resolve a delay
_NEIGHBOURS = 1e-9  # of a frequency: grid points that are one


class _Margin(NamedTuple):
    """A margin, and the frequency where it is lost, rad/s; NaN without one."""

    value: float
    frequency: float


class LoopMargins(NamedTuple):
    """The margins of one loop.

    gain_margin : factor above 1 on the gain, inf without limit; gain_reduction : factor below 1, 0 without limit;
    phase_margin : rad to either side; delay_margin : s; disk_margin : α, 0 to 2
    """

    gain_margin: _Margin
    gain_reduction: _Margin
    phase_margin: _Margin
    delay_margin: _Margin
    disk_margin: _Margin


def frequencies(roots: Array, delay: float) -> Array:
    """Return frequencies (k,) in rad/s that resolve all roots, and the phase of a delay in s."""
    roots = roots[np.isfinite(roots) & (np.abs(roots) > 0)]
    size = np.abs(roots)
    low, high = _SLOWEST * size.min(), _WIDER * size.max()
    upper = roots[roots.imag >= 0]
    near = upper.imag[:, None] + np.abs(upper.real)[:, None] * _AROUND_ROOT
    turning = np.zeros(0)
    if delay > 0:
        turning = np.linspace(low, high, int(min(_MOST_OF_DELAY, high * delay / _TURN)) + 2)
    found = np.sort(np.concatenate([near.ravel(), np.geomspace(low, high, _EVERYWHERE), turning]))
    found = found[(found >= low) & (found <= high)]
    return np.asarray(found[np.concatenate([[True], np.diff(found) > _NEIGHBOURS * found[:-1]])])


def margins_of(transfer: _Transfer, grid: Array) -> LoopMargins:
    """Return the margins of a stable loop.

    Parameters
    ----------
    transfer : callable
        L at frequencies in rad/s, for arrays of any shape.
    grid : array (k,)
        Frequencies between which L is followed, rising.
    """
    values = transfer(grid)
    real, at_real = _on_the_real_axis(transfer, grid, values)
    beyond, within = real[real <= -1], real[real > -1]
    phase, delay = _by_phase(*_of_size_one(transfer, grid, values))
    return LoopMargins(
        gain_margin=_Margin(-1 / within.min(), float(at_real[real > -1][within.argmin()]))
        if len(within)
        else _Margin(np.inf, np.nan),
        gain_reduction=_Margin(-1 / beyond.max(), float(at_real[real <= -1][beyond.argmax()]))
        if len(beyond)
        else _Margin(0.0, np.nan),
        phase_margin=phase,
        delay_margin=delay,
        disk_margin=_disk(transfer, grid, values),
    )


def _on_the_real_axis(transfer: _Transfer, grid: Array, values: Array) -> tuple[Array, Array]:
    """Return where L is real and negative, and the frequencies there; a loop that is static at the start counts."""
    change = np.signbit(values.imag[1:]) != np.signbit(values.imag[:-1])
    omega = _zeros(lambda at: transfer(at).imag, grid, np.flatnonzero(change))
    found = transfer(omega)
    kept = (found.real < 0) & (np.abs(found.imag) < _REAL * np.abs(found.real))
    real, at = found.real[kept], omega[kept]
    first = values[0]
    if first.real < 0 and abs(first.imag) < _REAL * abs(first.real):
        real, at = np.append(real, first.real), np.append(at, 0.0)
    return real, at


def _of_size_one(transfer: _Transfer, grid: Array, values: Array) -> tuple[Array, Array]:
    """Return L where its size is one, and the frequencies there."""
    larger = np.abs(values) > 1
    omega = _zeros(lambda at: np.abs(transfer(at)) - 1, grid, np.flatnonzero(larger[1:] != larger[:-1]))
    return transfer(omega), omega


def _by_phase(values: Array, omega: Array) -> tuple[_Margin, _Margin]:
    """Return the phase margin, to either side, and the delay margin from L (k,) of size one."""
    if not len(values):
        return _Margin(np.inf, np.nan), _Margin(np.inf, np.nan)
    lag = np.mod(np.angle(values) + np.pi, 2 * np.pi)  # that turns L to -1
    either, delay = np.minimum(lag, 2 * np.pi - lag), lag / omega
    least, first = int(either.argmin()), int(delay.argmin())
    return _Margin(float(either[least]), float(omega[least])), _Margin(
        float(delay[first]), float(omega[first])
    )


def _disk(transfer: _Transfer, grid: Array, values: Array) -> _Margin:
    """Return the disk margin, from the largest |S - T| at and between the frequencies of the grid."""
    from scipy.optimize import elementwise  # here, because it takes long to import

    def below(omega: Array) -> Array:
        return -_balanced(transfer(omega))

    size = _balanced(values)
    peak = np.flatnonzero((size[1:-1] >= size[:-2]) & (size[1:-1] >= size[2:])) + 1
    largest, at = float(size.max()), float(grid[size.argmax()])
    if len(peak):
        found = elementwise.find_minimum(below, (grid[peak - 1], grid[peak], grid[peak + 1]))
        best = int(np.nanargmin(found.f_x))
        if -found.f_x[best] > largest:
            largest, at = float(-found.f_x[best]), float(found.x[best])
    return _Margin(2 / largest, at)


def _balanced(values: Array) -> Array:
    """Return |S - T|."""
    return np.asarray(np.abs((1 - values) / (1 + values)))


def _zeros(function: _Transfer, grid: Array, places: Array) -> Array:
    """Return the zeros of a function between the points of a grid at some places and the next ones."""
    from scipy.optimize import elementwise  # here, because it takes long to import

    if not len(places):
        return np.zeros(0)
    return np.asarray(elementwise.find_root(function, (grid[places], grid[places + 1])).x)
