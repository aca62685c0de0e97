"""Lift of a wing apart from all other loads, in shape functions along the span, so that it may come late.

The downwash w of a strip is gathered in few functions P_k of the span, in the mean over the strips: w_k = G⁻¹ ∫ P_k w
dy with G = ∫ P_k P_l dy. Where the lift lags, the work that comes late is that of ρV Σ P_k w_k: see
`proprotor.model.wing_lift_lag`. All strips have one chord and meet one wind, so that the air passes all of them in the
same time.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.typing import Array

_SHAPES = 3  # functions of the span; tests/model/test_wing_lift_lag.py has their error


class WingCirculation(NamedTuple):
    """Downwash of a wing in m functions, and the work of its lift on n coordinates, at some airspeeds.

    work : array (..., n, m)
        Work on each coordinate per unit of downwash, N s/m or N s.
    by_rates, by_displacements : array (..., m, n)
        Downwash per unit of the rate and of the displacement of each coordinate, m/s.
    way : array (...)
        Half chords that the air passes in a second, 1/s: of both, the speed and the chord across a swept wing, the
        cosine of the sweep cancels.
    symmetry : tuple of str
        "symmetric" or "antisymmetric" for each function, "" on a single wing.
    damping, stiffness : array (..., n, n)
        Parts in C and K of all of the lift, where it comes at once.
    """

    work: Array
    by_rates: Array
    by_displacements: Array
    way: Array
    symmetry: tuple[str, ...]
    damping: Array
    stiffness: Array


class WingLift(NamedTuple):
    """The same at any airspeed V and density ρ: work per ρV, downwash by displacements per V,

    damping and stiffness per ρV and ρV².

    chord : float or array (...)
        m, along the wind.
    """

    work: Array
    by_rates: Array
    by_displacements: Array
    chord: ArrayLike
    symmetry: tuple[str, ...]
    damping: Array
    stiffness: Array

    def at(self, airspeed: ArrayLike, density: ArrayLike) -> WingCirculation:
        """Return downwash and work at airspeeds (m/s) and densities (kg/m³) that broadcast."""
        speed = np.asarray(airspeed)
        flow = (np.asarray(density) * speed)[..., None, None]
        downwash = speed[..., None, None] * self.by_displacements
        return WingCirculation(
            flow * self.work,
            self.by_rates,
            downwash,
            2 * speed / np.asarray(self.chord),
            self.symmetry,
            flow * self.damping,
            flow * speed[..., None, None] * self.stiffness,
        )


def of_both_wings(right: WingLift, left: WingLift, halves: tuple[str, ...]) -> WingLift:
    """Return the lift of half an aircraft, mean and half difference of both wings."""
    signs = {half: -1.0 if half == "antisymmetric" else 1.0 for half in halves}

    def together(one: Array, other: Array, axis: int) -> Array:
        return np.concatenate([(one + sign * other) / 2 for sign in signs.values()], axis=axis)

    return WingLift(
        together(right.work, left.work, -1),
        together(right.by_rates, left.by_rates, -2),
        together(right.by_displacements, left.by_displacements, -2),
        right.chord,
        tuple(half for half in halves for _ in right.symmetry),
        (right.damping + left.damping) / 2,
        (right.stiffness + left.stiffness) / 2,
    )


def span_functions(width: Array) -> Array:
    """Return the first Legendre polynomials (..., k, m) over the span, at the middles of strips side by side."""
    tip = np.sum(width, axis=-1, keepdims=True)
    share = (np.cumsum(width, axis=-1) - width / 2) / tip
    return np.polynomial.legendre.legvander(2 * share - 1, _SHAPES - 1)
