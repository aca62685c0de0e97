"""One mode by moving blocks: the line of its frequency in blocks that move along the record, Hammond and Doggett, NASA
SP-385 (1975).

The logarithm of the size of that line falls by the decay per second, and its phase tells what the frequency is off.
Blocks overlap, so that their errors go together: the slope is a weighted sum of all samples to first order in the
noise, and its variance is the sum of the squares of these weights times the variance of the noise beside the mode. A
Hann window in each block keeps out modes at other frequencies, and the mirror image of the line at its negative
frequency.
"""

from __future__ import annotations

import numpy as np
from scipy.signal import fftconvolve

from proprotor.errors import InputError
from proprotor.records.record import Record
from proprotor.records.root_errors import Root
from proprotor.records.single_mode import decaying, strongest_line
from proprotor.typing import Array

_ROUNDS = 4
_SHARE = 0.5  # of the record in a block
_FEWEST_CYCLES = 2  # in a block
_ROOM = 1.0  # cycles of the record by which a block moves at least
_ABOVE_NOISE = 4.0  # errors of its line: what a block has to stand above
_BEYOND_NOISE = 4.0  # times what noise explains, and
_SYSTEMATIC = 0.02  # of the line's size: departures from a straight line that are no chance


def moving_block(record: Record, frequency: float | None = None, block: float | None = None) -> Root:
    """Return the root of one mode that a channel shows, perhaps beside modes at other frequencies.

    Parameters
    ----------
    record : Record
        One channel.
    frequency : float, optional
        rad/s, near which the mode is sought; by default where the channel is strongest.
    block : float, optional
        Length of a block, s, rounded to whole cycles; half of the record by default.

    Raises
    ------
    InputError
        When the record is too short, the block does not fit, or the line does not decay evenly.
    """
    omega, decay = strongest_line(record, frequency), 0.0
    values = record.values[:, 0] - record.values[:, 0].mean()
    time = record.step * np.arange(len(values))
    for _ in range(_ROUNDS):
        window = _window(record, omega, block)
        start, turning = time[: len(time) - len(window) + 1], np.exp(-1j * omega * time)
        lines = fftconvolve(turning * values, window, mode="valid")
        noise = _noise(time, values, decay, omega)
        error = noise * np.sqrt((window**2).sum() / 2)
        size = _even_decay(start, lines, decay)
        used = slice(0, _above(size, error, record))
        slopes = _regression(start[used], size[used] ** 2)
        rate = complex(slopes @ (np.log(np.abs(lines[used])) + 1j * np.unwrap(np.angle(lines[used]))))
        decay, omega = -rate.real, omega + rate.imag
    _check_line(record, start[used], lines[used], error)
    moves = fftconvolve(slopes / lines[used], window) * turning[: len(window) + len(slopes) - 1]
    parts = np.stack([-moves.real, moves.imag])  # how decay and frequency move with each sample
    return Root(decay, omega, noise**2 * parts @ parts.T)


def _window(record: Record, omega: float, block: float | None) -> Array:
    """Return the weights of the samples of a block: whole cycles, as many as fit into the wanted length."""
    period = 2 * np.pi / omega
    wanted = max(_SHARE * record.duration, _FEWEST_CYCLES * period) if block is None else block
    cycles = int(wanted / period + 1e-9)
    if cycles < _FEWEST_CYCLES or wanted > record.duration - _ROOM * period:
        rule = f"must hold {_FEWEST_CYCLES} cycles of {1 / period:.3g} Hz and leave {_ROOM:g} of the record to move"
        raise InputError("block", f"{wanted:.3g} s", rule)
    size = round(cycles * period / record.step)
    shape = np.hanning(size + 2)[1:-1]
    return np.asarray(2 / shape.sum() * shape)


def _even_decay(start: Array, lines: Array, decay: float) -> Array:
    """Return the size that an even decay gives the lines of the blocks."""
    size = np.exp(-decay * start)
    return np.asarray(size * (size @ np.abs(lines)) / (size @ size))


def _above(size: Array, error: float, record: Record) -> int:
    """Return how many blocks, from the first, have a line of a size above the noise."""
    below = np.flatnonzero(size < _ABOVE_NOISE * error)
    count = int(below[0]) if len(below) else len(size)
    if count < 2:
        raise InputError(
            "channel",
            record.channels[0],
            "must stand above the noise, and above other modes, in more than one block",
        )
    return count


def _noise(time: Array, values: Array, decay: float, omega: float) -> float:
    """Return the standard deviation of what a decaying sinusoid and a constant leave."""
    basis = decaying(time, decay, omega)
    left = values - basis @ np.linalg.lstsq(basis, values, rcond=None)[0]
    return float(np.sqrt((left**2).sum() / max(len(left) - 5, 1)))


def _regression(time: Array, weight: Array) -> Array:
    """Return the factors (blocks,) of values whose weighted sum is the slope of a line through the values."""
    off = time - np.average(time, weights=weight)
    return np.asarray(weight * off / (weight * off**2).sum())


def _check_line(record: Record, time: Array, lines: Array, error: float) -> None:
    """Refuse lines whose size does not fall evenly."""
    size = np.abs(lines)
    slope = _regression(time, size**2)
    off = np.log(size) - (slope @ np.log(size)) * time
    off -= np.average(off, weights=size**2)
    share = float(np.sqrt(np.average(off**2, weights=size**2)))
    expected = error / float(np.sqrt(np.average(size**2, weights=size**2)))
    if share > max(_BEYOND_NOISE * expected, _SYSTEMATIC):
        rule = (
            f"must decay evenly: the size of the line departs by {share:.0%} from an even decay, more than noise "
            'explains; two close modes beat so (method "least squares" tells them apart)'
        )
        raise InputError("channel", record.channels[0], rule)
