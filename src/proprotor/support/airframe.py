"""Coordinates of an airframe that carries two rotors, one the mirror image of the other, with its own airloads.

A coordinate is symmetric, antisymmetric, or neither. Symmetric means the mirror image across the plane of I and K: the
left hub moves as the right hub does, seen in axes that are mirrored with the rotor. Antisymmetric means the opposite.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from proprotor.support.normal_modes import NormalModes, in_air
from proprotor.support.wing_circulation import WingLift
from proprotor.typing import Array

SYMMETRIES = ("symmetric", "antisymmetric")


@dataclass(frozen=True, eq=False)
class Airframe(NormalModes):
    """An airframe without its rotors; all matrices are those of half the airframe, half of each energy.

    `hub` is the motion of the right hub along and about the axes I, J, K of the right rotor.

    Parameters
    ----------
    left_hub : array (..., 6, n)
        Motion of the left hub per unit of each coordinate, in the axes of the left rotor: I up, J outboard to the left,
        K forward, and rotations mirrored as well. `hub` for a symmetric coordinate, `-hub` for an antisymmetric one.
    symmetry : tuple of str
        "symmetric", "antisymmetric" or "" for each coordinate.
    rigid_body : tuple of str
        Names of the coordinates that move the aircraft as one body.
    rates : tuple of str
        Names of the coordinates along which neither structure nor air has stiffness; only their rates are states.
    airload_damping, airload_stiffness : array (..., n, n)
        Parts of the airloads of half the airframe in C per ρV and in K per ρV².
    wing : WingLift, optional
        The part of these airloads that is lift of the wing, which may lag; the lift of tails does not.
    refusal : array (...) of str, optional
        Of many designs: the reason for which a design is not physical, "" for others. The matrices of such a design
        are those of some other aircraft, and its points fail with the reason.
    """

    left_hub: Array = field(kw_only=True)
    symmetry: tuple[str, ...] = field(kw_only=True)
    rigid_body: tuple[str, ...] = field(kw_only=True, default=())
    rates: tuple[str, ...] = field(kw_only=True, default=())
    airload_damping: ArrayLike = field(kw_only=True, default=0.0)
    airload_stiffness: ArrayLike = field(kw_only=True, default=0.0)
    wing: WingLift | None = field(kw_only=True, default=None)  # type: ignore[misc]
    refusal: Array | None = field(kw_only=True, default=None)

    symmetric = ("mass",)

    def __post_init__(self) -> None:
        super().__post_init__()
        left_hub = np.array(self.left_hub)
        left_hub.flags.writeable = False  # like the other matrices
        object.__setattr__(self, "left_hub", left_hub)

    def at(self, airspeed: ArrayLike, density: ArrayLike) -> Airframe:
        """Return the airframe, with matrices (..., n, n), at airspeeds (m/s) and densities (kg/m³) that broadcast."""
        speed, density = np.asarray(airspeed)[..., None, None], np.asarray(density)[..., None, None]
        damping = self.damping + density * speed * np.asarray(self.airload_damping)
        stiffness = self.stiffness + density * speed**2 * np.asarray(self.airload_stiffness)
        return in_air(self, Airframe, damping, stiffness, airload_damping=0.0, airload_stiffness=0.0)
