"""One mode by the logarithmic decrement: the ratio of the amplitudes of successive cycles.

The amplitude of a cycle is that of the decaying sinusoid which fits all samples of the cycle best, so that noise does
not move a peak, and a constant beside it takes up an offset. The logarithms of the amplitudes lie on a line whose slope
is the decay, and the phases on a line whose slope is the frequency. Both lines are fitted with the weights that the
noise left in the cycles gives, and the covariance of a weighted regression gives the errors. What remains between
amplitudes and line is compared with the noise: a beat of two modes, or a damping that depends on the amplitude, is no
line.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.stats import chi2

from proprotor.errors import InputError
from proprotor.records.record import Record
from proprotor.records.root_errors import Root
from proprotor.records.single_mode import FEWEST_CYCLES, decaying, strongest_line
from proprotor.typing import Array

_ROUNDS = 6  # the root that a round finds is the one by which the next round divides the record
_ABOVE_NOISE = 3.0  # errors of its amplitude: what a cycle has to stand above
_UNLIKELY = 1e-4  # as chance: departures from a line that noise does not explain
_SYSTEMATIC = 0.01  # of the amplitude: departures that matter however small the noise is


class _Cycles(NamedTuple):
    """Cycles of a record.

    start (cycles,), s; amplitude (cycles,), complex; error (cycles,) : of the two parts of the amplitude; size
    (cycles,) : of the amplitude by an even decay, which the noise in a cycle does not move
    """

    start: Array
    amplitude: Array
    error: Array
    size: Array

    @property
    def weight(self) -> Array:
        """Weights of the cycles in a fit to the logarithm of the amplitude, or to its phase."""
        return (self.size / np.maximum(self.error, 1e-15 * self.size)) ** 2


def logarithmic_decrement(record: Record, frequency: float | None = None) -> Root:
    """Return the root of the one mode that a channel shows.

    Parameters
    ----------
    record : Record
        One channel.
    frequency : float, optional
        rad/s, near which the mode is sought; by default where the channel is strongest.

    Raises
    ------
    InputError
        When the record holds too few cycles above the noise, or the cycles do not decay by one ratio.
    """
    root = Root(0.0, strongest_line(record, frequency), np.zeros((2, 2)))
    for _ in range(_ROUNDS):
        cycles = _above_noise(_cycles(record, root), record)
        root = _lines(cycles, root)
    departure, chance = _departure(cycles)
    if chance < _UNLIKELY and departure > _SYSTEMATIC:
        rule = (
            f"must decay by one ratio from cycle to cycle: amplitudes depart from it by {departure:.0%}, more than "
            'noise explains; two close modes beat so (method "least squares" tells them apart)'
        )
        raise InputError("channel", record.channels[0], rule)
    return root


def _cycles(record: Record, root: Root) -> _Cycles:
    """Return the cycles of a record by a root near that of its mode."""
    per_cycle = 2 * np.pi / (root.frequency * record.step)
    edges = np.round(np.arange(0, len(record.time) + 0.5, per_cycle)).astype(int)
    start, amplitude, spread, left, free = [], [], [], 0.0, 0
    for first, last in pairwise(edges):
        time = record.step * np.arange(last - first)
        basis = decaying(time, root.decay, root.frequency)
        found, rest, *_ = np.linalg.lstsq(basis, record.values[first:last, 0], rcond=None)
        start.append(first * record.step)
        # Turned back by the phase of the start, all cycles of one sinusoid have one phase.
        turned = complex(found[0], -found[1]) * np.exp(-1j * root.frequency * start[-1])
        amplitude.append(turned)
        spread.append(np.sqrt(np.linalg.inv(basis.T @ basis)[:2, :2].diagonal().mean()))
        left, free = left + float(rest.sum()), free + len(time) - basis.shape[1]
    noise = np.sqrt(left / max(free, 1))
    even = np.exp(-root.decay * np.array(start))
    even *= (even @ np.abs(amplitude)) / (even @ even)
    return _Cycles(np.array(start), np.array(amplitude), noise * np.array(spread), even)


def _above_noise(cycles: _Cycles, record: Record) -> _Cycles:
    """Return the unbroken run of cycles around the largest that stand above the noise."""
    clear = cycles.size > _ABOVE_NOISE * cycles.error
    largest = int(np.argmax(cycles.size))
    before = np.flatnonzero(~clear[:largest])
    after = np.flatnonzero(~clear[largest:])
    run = slice(before[-1] + 1 if len(before) else 0, largest + after[0] if len(after) else len(clear))
    found = _Cycles(*(part[run] for part in cycles))
    if len(found.start) < FEWEST_CYCLES:
        rule = f"must hold at least {FEWEST_CYCLES} cycles above the noise, not {len(found.start)}"
        raise InputError("channel", record.channels[0], rule)
    return found


def _lines(cycles: _Cycles, root: Root) -> Root:
    """Return the root by the lines through logarithms and phases of the cycles."""
    size, weight = np.abs(cycles.amplitude), cycles.weight
    phase = np.unwrap(np.angle(cycles.amplitude))
    decay = -_slope(cycles.start, np.log(size), weight)
    turns = _slope(cycles.start, phase, weight)
    middle = np.average(cycles.start, weights=weight)
    variance = 1 / (weight * (cycles.start - middle) ** 2).sum()
    return Root(decay, root.frequency + turns, variance * np.eye(2))


def _slope(time: Array, values: Array, weight: Array) -> float:
    off = time - np.average(time, weights=weight)
    return float((weight * off * values).sum() / (weight * off**2).sum())


def _departure(cycles: _Cycles) -> tuple[float, float]:
    """Return how far the amplitudes lie from an even decay, as a share of them, and the chance of that by noise.

    Differences of amplitudes are compared, since the logarithm of a small amplitude has no normal distribution.
    """
    size, weight = np.abs(cycles.amplitude), cycles.weight
    middle = np.average(cycles.start, weights=weight)
    slope = _slope(cycles.start, np.log(size), weight)
    even = np.exp(np.average(np.log(size), weights=weight) + slope * (cycles.start - middle))
    off = size / even - 1
    share = float(np.sqrt(np.average(off**2, weights=weight)))
    return share, float(chi2.sf((weight * off**2).sum(), max(len(size) - 2, 1)))
