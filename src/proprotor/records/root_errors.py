"""Standard errors of frequency and damping ratio from the covariance of a root, to first order.

A root is s = -α + iω: the damped frequency is ω, the damping ratio ζ = α/√(α² + ω²).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from proprotor.typing import Array


class Root(NamedTuple):
    """A root and its standard errors.

    decay : α, 1/s; frequency : ω, rad/s; covariance (2, 2) : of α and ω.
    """

    decay: float
    frequency: float
    covariance: Array

    @property
    def value(self) -> complex:
        """The root s, rad/s."""
        return complex(-self.decay, self.frequency)

    @property
    def damping_ratio(self) -> float:
        """ζ, negative where the motion grows."""
        return float(self.decay / np.hypot(self.decay, self.frequency))

    @property
    def frequency_error(self) -> float:
        """Standard error of ω, rad/s."""
        return float(np.sqrt(self.covariance[1, 1]))

    @property
    def damping_error(self) -> float:
        """Standard error of ζ."""
        alpha, omega = self.decay, self.frequency
        slope = np.array([omega, -alpha]) * omega / np.hypot(alpha, omega) ** 3
        return float(np.sqrt(slope @ self.covariance @ slope))
