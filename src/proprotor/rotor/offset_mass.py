"""Mass of a blade whose centre lies beside the pitch axis, by its integrals outboard of the lag hinge."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from proprotor.errors import check_finite
from proprotor.rotor.quadrature import gauss
from proprotor.typing import Array

_POINTS = 10  # of a panel on which mass, offset and twist are straight
_Along = Callable[[Array], Array]


@dataclass(frozen=True, kw_only=True, eq=False)
class OffsetMass:
    """Integrals of the mass outboard of the lag hinge times its offset x from the pitch axis, positive aft.

    τ is the twist from 0.75 R and ρζ the distance from the lag hinge. Numbers or arrays of many designs.

    Parameters
    ----------
    offset_cosine_moment, offset_sine_moment : float
        ∫ m x cos τ and ∫ m x sin τ, kg m.
    offset_cosine_lag_inertia, offset_sine_lag_inertia : float
        ∫ m x ρζ cos τ and ∫ m x ρζ sin τ, kg m².
    offset_cosine_inertia, offset_product_inertia, offset_sine_inertia : float
        ∫ m x² cos² τ, ∫ m x² cos τ sin τ and ∫ m x² sin² τ, kg m².

    Raises
    ------
    InputError
        When a number is not finite, or an integral of a square is negative.
    """

    offset_cosine_moment: float
    offset_sine_moment: float
    offset_cosine_lag_inertia: float
    offset_sine_lag_inertia: float
    offset_cosine_inertia: float
    offset_product_inertia: float
    offset_sine_inertia: float

    def __post_init__(self) -> None:
        squares = ("offset_cosine_inertia", "offset_sine_inertia")
        for entry in fields(self):
            sign = "not negative" if entry.name in squares else ""
            check_finite(entry.name, getattr(self, entry.name), sign)

    @property
    def inertia(self) -> Any:
        """∫ m x², the part of the pitch inertia that comes from the offset, kg m²."""
        return self.offset_cosine_inertia + self.offset_sine_inertia

    @classmethod
    def along(cls, knots: Array, hinge: Any, mass: _Along, offset: _Along, twist: _Along) -> OffsetMass:
        """Return the integrals of a mass per length with its offset, both straight between knots as the twist is.

        Parameters
        ----------
        knots : array (..., k)
            Radii from the first to the last mass, m, in any order.
        hinge : float or array (...)
            Lag hinge from the centre of rotation, m.
        mass, offset, twist : callable
            kg/m, m aft of the pitch axis and rad, at radii (..., points).

        Returns
        -------
        OffsetMass
            Integrals in kg m and kg m², of shape (...).
        """
        hinge = np.asarray(hinge)[..., None]
        inner = np.where(np.real(knots) > np.real(hinge), knots, hinge)
        edges = np.sort(inner, axis=-1)
        nodes, weights = gauss(_POINTS)
        half = np.diff(edges)[..., None] / 2
        radii = (edges[..., :-1, None] + half * (1 + nodes)).reshape(*edges.shape[:-1], -1)
        weight = (half * weights).reshape(radii.shape) * mass(radii)
        x, angle, arm = offset(radii), twist(radii), radii - hinge
        cosine, sine = x * np.cos(angle), x * np.sin(angle)
        integrands = (cosine, sine, cosine * arm, sine * arm, cosine**2, cosine * sine, sine**2)
        names = (entry.name for entry in fields(cls))
        found = (np.sum(weight * part, axis=-1)[()] for part in integrands)
        return cls(**dict(zip(names, found, strict=True)))
