"""What the methods for one mode share: the strongest line of a channel, and the noise beside a decaying sinusoid."""

from __future__ import annotations

import numpy as np

from proprotor.errors import InputError
from proprotor.records.record import Record
from proprotor.typing import Array

FEWEST_CYCLES = (
    3  # of a mode in a record, below which frequency and damping cannot be told apart from a trend
)
_FINE = 16  # points of the spectrum between two independent frequencies
_NEAR = 0.3  # of a wanted frequency: how far from it the strongest line may lie


def strongest_line(record: Record, near: float | None = None) -> float:
    """Return the frequency, rad/s, at which a record of one channel is strongest; near a frequency if one is given.

    Raises
    ------
    InputError
        When the record is too short for the frequency.
    """
    channel = record.values[:, 0] - record.values[:, 0].mean()
    if not channel.any():
        raise InputError("channel", record.channels[0], "must move: all its samples are equal")
    check_length(record, near)
    size = np.abs(np.fft.rfft(channel * np.hanning(len(channel)), _FINE * len(channel)))
    omega = 2 * np.pi * np.fft.rfftfreq(_FINE * len(channel), record.step)
    allowed = omega >= 2 * np.pi / record.duration
    if near is not None:
        allowed &= np.abs(omega - near) <= _NEAR * near
    found = float(omega[np.argmax(np.where(allowed, size, -1.0))])
    check_length(record, found)
    return found


def check_length(record: Record, frequency: float | None) -> None:
    """Refuse a record that holds too few cycles of a frequency (rad/s), or too few samples in each."""
    if frequency is None:
        return
    hertz = frequency / (2 * np.pi)
    cycles, samples = record.duration * hertz, 1 / (record.step * hertz)
    if cycles < FEWEST_CYCLES:
        rule = f"is too short: it holds {cycles:.2g} cycles of {hertz:.3g} Hz, and {FEWEST_CYCLES} are needed"
        raise InputError("record", f"{record.duration:.3g} s", rule)
    if samples < 4:
        rule = f"is too coarse: it has {samples:.2g} samples in a cycle of {hertz:.3g} Hz, and 4 are needed"
        raise InputError("record", f"step of {record.step:.3g} s", rule)


def decaying(time: Array, decay: float, frequency: float) -> Array:
    """Return e^{-αt} cos ωt, e^{-αt} sin ωt and 1 at some times (samples, 3)."""
    size = np.exp(-decay * time)
    return np.stack(
        [size * np.cos(frequency * time), size * np.sin(frequency * time), np.ones_like(time)], axis=-1
    )
