"""Roots to start from, by the eigensystem realisation algorithm, Juang and Pappa, J. Guidance 8, 620 (1985).

A free decay is a sum of exponentials, and so is its average over short spans of time: with the same roots. A matrix
whose columns are the record, each a sample later than the one before, has as many large singular values as there are
roots, and on their vectors a step of time is multiplication by a small matrix. Its eigenvalues are e^{sΔt}.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from proprotor.records.record import Record
from proprotor.typing import Array

_SAMPLES = 500  # after averaging: enough for 80 cycles in the record
_ROWS = 0.35  # of these samples, in a column


class _Realisation(NamedTuple):
    """Left vectors of the matrix of shifted samples, their singular values, channels in a row, and the step of time."""

    vectors: Array
    values: Array
    channels: int
    step: float

    def roots(self, count: int) -> Array:
        """Return so many roots with a frequency above zero, rad/s, fewer if the record has fewer; largest first."""
        found = np.zeros(0, dtype=complex)
        for order in range(2 * count, min(2 * count + 4, len(self.values)) + 1):
            part = self.vectors[:, :order] * np.sqrt(self.values[:order])
            step = np.linalg.lstsq(part[: -self.channels], part[self.channels :], rcond=None)[0]
            with np.errstate(divide="ignore"):
                every = np.log(np.linalg.eigvals(step).astype(complex)) / self.step
            # A frequency at the end of the band is that of a negative number, and no oscillation.
            inside = (every.imag > 1e-9) & (every.imag < 0.999 * np.pi / self.step) & np.isfinite(every.real)
            found = every[inside]
            if len(found) >= count:
                break
        return found[np.argsort(-found.real)][:count]


def realisation(record: Record) -> _Realisation:
    """Return the realisation of a record, of all its channels at once, each scaled by its own size."""
    span = max(1, len(record.time) // _SAMPLES)
    count = len(record.time) // span
    values = record.values[: span * count] - record.values.mean(axis=0)
    values = values.reshape(count, span, -1).mean(axis=1)
    size = values.std(axis=0)
    values = values / np.where(size > 0, size, 1.0)
    rows = max(int(_ROWS * count), 2)
    windows = np.lib.stride_tricks.sliding_window_view(
        values, count - rows, axis=0
    )  # (rows, channels, columns)
    matrix = windows[:rows].reshape(-1, count - rows)
    vectors, singular, _ = np.linalg.svd(matrix, full_matrices=False)
    return _Realisation(vectors, singular, values.shape[1], span * record.step)
