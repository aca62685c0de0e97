"""Several modes of several channels at once: the sum of decaying sinusoids that fits a record best.

Every channel is a sum of the same decaying sinusoids and a constant, with amplitudes and phases of its own. These enter
linearly, so that for given roots they follow by linear least squares, and only the roots are searched for (variable
projection, Golub and Pereyra, SIAM J. Numer. Anal. 10, 413, 1973), from those of `proprotor.records.realisation`. With
white noise the roots are those of greatest likelihood, and their covariance is the Cramér-Rao bound, σ² (JᵀJ)⁻¹ with J
the derivatives of the sum by the roots without the part that amplitudes make up for. How many modes there are is told
by the Bayesian information criterion.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from proprotor.errors import InputError
from proprotor.records.realisation import realisation
from proprotor.records.record import Record
from proprotor.records.root_errors import Root
from proprotor.records.single_mode import FEWEST_CYCLES, check_length
from proprotor.typing import Array

_MOST_MODES = 8
_ROUNDS = 2  # with equal weights, then with those of each channel's noise
_GROWTH = 5.0  # over the record, as a power of e: a mode that grows by more has no noise to speak of
_COLOURED = (
    5.0  # errors of a correlation of white noise: residuals that are more alike from sample to sample are not
)


class Fit(NamedTuple):
    """The modes of a record.

    roots : with their covariance; amplitude (modes, channels) : complex, at the start of the record; noise (channels,)
    : standard deviation of what is left; coloured : whether what is left is no white noise; criterion : of Bayes,
    smaller for a better number of modes
    """

    roots: tuple[Root, ...]
    amplitude: Array
    noise: Array
    coloured: bool
    criterion: float


class _Projection:
    """What decaying sinusoids of given roots leave of a record, and how this changes with the roots."""

    def __init__(self, time: Array, values: Array) -> None:
        self.time, self.values = time, values

    def basis(self, roots: Array) -> Array:
        """Return the exponentials, cosine and sine of each root, and the constant (samples, 2 modes + 1)."""
        waves = np.exp((-roots[0] + 1j * roots[1]) * self.time[:, None])
        parts = np.stack([waves.real, waves.imag], axis=-1).reshape(len(self.time), -1)
        return np.concatenate([parts, np.ones((len(self.time), 1))], axis=1)

    def solved(self, roots: Array) -> tuple[Array, Array, Array]:
        """Return an orthonormal basis, the amplitudes (2 modes + 1, channels) and what is left (samples, channels)."""
        basis = self.basis(roots)
        q, r = np.linalg.qr(basis)
        inside = q.T @ self.values
        return q, np.linalg.lstsq(r, inside, rcond=None)[0], self.values - q @ inside

    def left(self, flat: Array) -> Array:
        """Return what is left, flat."""
        return self.solved(flat.reshape(2, -1))[2].T.ravel()

    def jacobian(self, flat: Array) -> Array:
        """Return how what is left changes with decays and frequencies (samples of all channels, 2 modes)."""
        roots = flat.reshape(2, -1)
        q, found, _ = self.solved(roots)
        modes = roots.shape[1]
        waves = np.exp((-roots[0] + 1j * roots[1]) * self.time[:, None])
        amplitude = found[0:-1:2] - 1j * found[1:-1:2]
        by_root = (self.time[:, None] * waves)[
            :, :, None
        ] * amplitude  # of each mode (samples, modes, channels)
        columns = np.concatenate([-by_root.real, -by_root.imag], axis=1)  # by decay, then by frequency
        columns -= np.einsum("nk,km...->nm...", q, np.tensordot(q.T, columns, 1))
        return -np.moveaxis(columns, 2, 0).reshape(-1, 2 * modes)


def decaying_modes(record: Record, modes: int | None = None, frequency: float | None = None) -> Fit:
    """Return the modes of a record.

    Parameters
    ----------
    record : Record
        One or several channels of the same decay.
    modes : int, optional
        How many modes there are; by default as many as the record tells apart from noise, at most 8.
    frequency : float, optional
        rad/s, of the lowest mode that has to fit into the record.

    Raises
    ------
    InputError
        When the record is too short, or has not so many modes.
    """
    check_length(record, frequency)
    still = [
        name for name, own in zip(record.channels, np.ptp(record.values, axis=0), strict=True) if own == 0
    ]
    if still:
        raise InputError("channel", still[0], "must move: all its samples are equal")
    start = realisation(record)
    best: Fit | None = None
    for count in range(1, _MOST_MODES + 1) if modes is None else [modes]:
        roots = start.roots(count)
        if len(roots) < count or len(record.time) < 4 * count + 2:
            break
        found = _fit(record, roots)
        if found is None or (best is not None and found.criterion >= best.criterion):
            break
        best = found
    if best is None:
        rule = f"must show {'a decaying oscillation' if modes is None else f'{modes} decaying oscillations'}"
        raise InputError("record", record.name, rule)
    return best


def _fit(record: Record, roots: Array) -> Fit | None:
    """Return the best fit from roots to start from; None where two of its modes are one."""
    time = record.step * np.arange(len(record.time))
    flat = np.concatenate([-roots.real, roots.imag])
    noise = np.ptp(record.values, axis=0)
    for _ in range(_ROUNDS):
        part = _Projection(time, record.values / noise)
        flat = _settled(part, flat, record)
        left = part.solved(flat.reshape(2, -1))[2] * noise
        free = len(time) - (2 * len(roots) + 1) - 2 * len(roots) / record.values.shape[1]
        noise = np.sqrt((left**2).sum(axis=0) / free) + np.finfo(float).eps * np.ptp(record.values, axis=0)
    return _as_fit(record, _Projection(time, record.values / noise), flat, left, noise)


def _settled(part: _Projection, flat: Array, record: Record) -> Array:
    """Return the decays and frequencies that leave least of a record, from some to start from."""
    count, fastest = len(flat) // 2, np.pi / record.step
    ends = np.repeat([[-_GROWTH / record.duration, 0.0], [fastest, fastest]], count, axis=1)
    room = 1e-6 * (ends[1] - ends[0])
    done = least_squares(
        part.left,
        np.clip(flat, ends[0] + room, ends[1] - room),
        jac=part.jacobian,
        bounds=(ends[0], ends[1]),
        x_scale=np.full(len(flat), 1 / record.duration),
        xtol=1e-9,
        ftol=1e-9,
    )
    return np.asarray(done.x)


def _as_fit(record: Record, part: _Projection, flat: Array, left: Array, noise: Array) -> Fit | None:
    """Return the fit with covariance, amplitudes and the criterion of the number of modes."""
    count, channels = len(flat) // 2, record.values.shape[1]
    jacobian = part.jacobian(flat)
    try:
        covariance = np.linalg.inv(jacobian.T @ jacobian)
    except np.linalg.LinAlgError:
        return None
    found = part.solved(flat.reshape(2, -1))[1] * noise
    amplitude = found[0:-1:2] - 1j * found[1:-1:2]
    order = np.argsort(flat[count:])
    roots = tuple(
        Root(float(flat[k]), float(flat[count + k]), covariance[np.ix_([k, count + k], [k, count + k])])
        for k in order
    )
    criterion = len(left) * np.log((left**2).mean(axis=0) + np.finfo(float).tiny).sum()
    criterion += (2 * count + channels * (2 * count + 1)) * np.log(left.size)
    return Fit(roots, amplitude[order], noise, _is_coloured(left), float(criterion))


def _is_coloured(left: Array) -> bool:
    """Return whether a sample of what is left tells something about the next, more than chance does."""
    alike = (left[1:] * left[:-1]).sum(axis=0) / (left**2).sum(axis=0).clip(np.finfo(float).tiny)
    return bool((np.abs(alike) > _COLOURED / np.sqrt(len(left))).any())


def too_close(roots: tuple[Root, ...], duration: float) -> list[bool]:
    """Return for each mode whether another lies closer than the record can tell apart without knowing their number."""
    apart = 2 * np.pi / duration
    return [
        any(other is not one and abs(other.frequency - one.frequency) < apart for other in roots)
        for one in roots
    ]


def too_few_cycles(roots: tuple[Root, ...], duration: float) -> list[bool]:
    """Return for each mode whether the record holds too few of its cycles."""
    return [root.frequency * duration < 2 * np.pi * FEWEST_CYCLES for root in roots]
