"""A delay as the diagonal Padé approximation of e^{-sτ}, in a chain of all-pass sections.

The approximation of order n is Q(-x)/Q(x) with x = sτ and Q(x) = Σ (2n - k)! n! / ((2n)! k! (n - k)!) x^k. Each pair of
roots of Q is a section (x² - a x + b)/(x² + a x + b) = 1 - 2 a x/(x² + a x + b), each real root a section
(b - x)/(b + x) = 2 b/(x + b) - 1. The magnitude is 1 at all frequencies, and only the phase is off: the approximation
lags less than the delay, the more so the higher the frequency.
"""

from __future__ import annotations

from functools import lru_cache
from math import atan2, factorial, pi, radians
from typing import NamedTuple

import numpy as np

MOST = 8  # order: beyond it nothing is gained before rounding shows
_WRONG = radians(1.0)  # phase by which an approximation may be off


class _Section(NamedTuple):
    """A section of the chain for a delay of one second: damping a and stiffness b; a real root has no damping."""

    damping: float | None
    stiffness: float


@lru_cache(maxsize=MOST)
def sections(order: int) -> tuple[_Section, ...]:
    """Return the sections of an approximation, the slowest first.

    Parameters
    ----------
    order : int
        1 to `MOST`.
    """
    whole, half = factorial(2 * order), factorial(order)
    powers = range(order, -1, -1)
    coefficients = [
        factorial(2 * order - k) * half / (whole * factorial(k) * factorial(order - k)) for k in powers
    ]
    roots = np.roots(coefficients)
    pairs = [_Section(float(-2 * root.real), float(abs(root) ** 2)) for root in roots if root.imag > 0]
    real = [_Section(None, float(-root.real)) for root in roots if root.imag == 0]
    return tuple(sorted(pairs, key=lambda one: one.stiffness)) + tuple(real)


@lru_cache(maxsize=MOST)
def phase_limit(order: int) -> float:
    """Return ωτ up to which the phase of an approximation is right to one degree."""
    from scipy.optimize import brentq  # here, because it takes long to import

    def wrong(turn: float) -> float:
        lags = (
            atan2(turn, one.stiffness)
            if one.damping is None
            else atan2(one.damping * turn, one.stiffness - turn**2)
            for one in sections(order)
        )
        return turn - 2 * sum(lags) - _WRONG

    return float(brentq(wrong, 0.0, pi * (order + 1)))
