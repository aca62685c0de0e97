"""Periodic functions by their values at equal steps of azimuth: rates, harmonics, and the axes of a blade."""

from __future__ import annotations

import functools

import numpy as np

from proprotor.typing import Array

_FEWEST = 24  # azimuths; harmonics of a trim fall off by about the advance ratio each


def number_of_azimuths(n_blades: int) -> int:
    """Return the number of azimuths at which a turn is sampled: a multiple of the number of blades."""
    return n_blades * -(-_FEWEST // n_blades)


def azimuths(count: int) -> Array:
    """Return equal steps of azimuth (count,), rad, from 0."""
    return 2 * np.pi * np.arange(count) / count


@functools.cache
def derivative(count: int) -> Array:
    """Return the matrix (count, count) that differentiates values at equal steps of azimuth.

    Exact for harmonics below half the count. The highest harmonic of an even count has the derivative zero.
    """
    harmonic = np.fft.fftfreq(count, 1 / count)
    if count % 2 == 0:
        harmonic[count // 2] = 0.0
    matrix = np.fft.ifft(1j * harmonic[:, None] * np.fft.fft(np.eye(count), axis=0), axis=0).real
    matrix.flags.writeable = False
    return matrix


def harmonics(count: int, highest: int, step: int = 1) -> Array:
    """Return 1, then cos hψ and sin hψ of the harmonics h up to the highest, (count, functions).

    Parameters
    ----------
    count : int
        Number of azimuths.
    highest : int
    step : int
        Only multiples of this harmonic.
    """
    psi = azimuths(count)
    waves = [np.ones(count)]
    for harmonic in range(step, highest + 1, step):
        waves += [np.cos(harmonic * psi), np.sin(harmonic * psi)]
    return np.stack(waves, axis=-1)


def along_blade(vector: Array, count: int) -> Array:
    """Return a steady vector (..., 3) of the fixed frame along the blade's axes at each azimuth, (..., count, 3).

    The axes i, j, k are those of AIAA-2002-1604: i = (sin ψ, -cos ψ, 0) and j = (cos ψ, sin ψ, 0).
    """
    psi = azimuths(count)
    sine, cosine = np.sin(psi), np.cos(psi)
    x, y, z = (vector[..., place, None] for place in range(3))
    return np.stack([x * sine - y * cosine, x * cosine + y * sine, z + 0 * sine], axis=-1)
