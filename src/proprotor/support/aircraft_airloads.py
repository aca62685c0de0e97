"""Quasi-steady airloads of a free aircraft: strips of its wing, and its tails as derivatives.

A tail moves with the fuselage. Its normal force, with n up for a horizontal and to the right for a vertical tail, is

    N = -½ ρ V² S a ( (ṅ_tail - κ ṅ_datum) / V + (1 - κ) s )        s = -αy or αx

with κ the share of the incidence at the wing that the wash of wing and fuselage takes off at the tail, without delay. A
displacement, and roll, turn nothing against the wind, so they have no stiffness.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import NamedTuple

import numpy as np

from proprotor.errors import check_finite
from proprotor.support.aircraft_structure import HalfAircraft
from proprotor.support.airframe import SYMMETRIES, Airframe
from proprotor.support.beam import rigid_motion
from proprotor.support.free_airframe import FreeAirframe
from proprotor.support.normal_modes import HUB_AXES
from proprotor.support.wing_aerodynamics import Strips, WingAerodynamics, beam_strips, strip_positions
from proprotor.support.wing_circulation import WingLift, of_both_wings
from proprotor.typing import Array, Numbers

_UP, _OUTBOARD, _YAW, _PITCH = (HUB_AXES.index(axis) for axis in ("x", "y", "alpha_x", "alpha_y"))


@dataclass(frozen=True, kw_only=True)
class Tail:
    """A horizontal tail, or all vertical tails together; numbers, or arrays (...) of many designs.

    Parameters
    ----------
    area : float
        m², of the whole tail.
    lift_slope : float
        1/rad, of the whole tail on its area.
    arm, height : float
        Distances of its aerodynamic centre behind and above the datum of the aircraft, m.
    wash : float
        Downwash dε/dα or sidewash: share of the incidence at the wing that the tail does not see.

    Raises
    ------
    InputError
        When a value is not finite, or area or lift slope is negative.
    """

    area: Numbers
    lift_slope: Numbers
    arm: Numbers
    height: Numbers = 0.0
    wash: Numbers = 0.0

    def __post_init__(self) -> None:
        for entry in fields(self):
            sign = "not negative" if entry.name in ("area", "lift_slope") else ""
            check_finite(entry.name, getattr(self, entry.name), sign)

    def matrices(self, fuselage: Array, *, vertical: bool = False) -> tuple[Array, Array]:
        """Return the parts of the tail's airloads in C per ρV and in K per ρV²; both (..., n, n).

        Parameters
        ----------
        fuselage : array (..., 6, n)
            Motion of the datum for each coordinate.
        vertical : bool
            Whether the tail stands upright.
        """
        own = {entry.name: np.asarray(getattr(self, entry.name))[..., None] for entry in fields(self)}
        # The tail's point moves with ω × (height, 0, -arm).
        pitch, yaw = fuselage[..., _PITCH, :], fuselage[..., _YAW, :]
        roll = fuselage[..., HUB_AXES.index("alpha_z"), :]
        if vertical:
            datum, turn = fuselage[..., _OUTBOARD, :], yaw
            moved = datum + own["height"] * roll + own["arm"] * yaw
        else:
            datum, turn = fuselage[..., _UP, :], -pitch
            moved = datum - own["arm"] * pitch
        force = (own["area"] * own["lift_slope"] / 2 * moved)[..., :, None]
        washed = (moved - own["wash"] * datum)[..., None, :]
        return force * washed, force * ((1 - own["wash"]) * turn)[..., None, :]


class AircraftMotion(NamedTuple):
    """Motion of what the air loads, for each coordinate of an airframe.

    fuselage : array (..., 6, n)
        Motion of the datum, in the axes of the right rotor.
    right, left : Strips
        Of both wings, each in the axes of its own rotor.
    """

    fuselage: Array
    right: Strips
    left: Strips


def aircraft_motion(free: FreeAirframe) -> AircraftMotion:
    """Return the motion of fuselage and wing strips of a free airframe."""
    right, left = (
        _strips(half, shapes)
        for half, shapes in ((free.right, free.right_shapes), (free.left, free.left_shapes))
    )
    return AircraftMotion(free.right_shapes[..., :6, :], right, left)


def with_airloads(
    airframe: Airframe,
    motion: AircraftMotion,
    *,
    wing: WingAerodynamics | None = None,
    horizontal_tail: Tail | None = None,
    vertical_tail: Tail | None = None,
) -> Airframe:
    """Return an airframe with the airloads of half the aircraft; left out what is None.

    Parameters
    ----------
    airframe : Airframe
    motion : AircraftMotion
    wing : WingAerodynamics, optional
        Of the strips from the plane of symmetry to the pylon.
    horizontal_tail, vertical_tail : Tail, optional

    Returns
    -------
    Airframe
    """
    lift: WingLift | None = None
    found = [wing.matrices(strips) for strips in (motion.right, motion.left)] if wing else []
    if wing is not None:
        halves = tuple(half for half in SYMMETRIES if half in airframe.symmetry or "" in airframe.symmetry)
        lift = of_both_wings(wing.lift(motion.right), wing.lift(motion.left), halves)
    if horizontal_tail is not None:
        found.append(horizontal_tail.matrices(motion.fuselage))
    if vertical_tail is not None:
        found.append(vertical_tail.matrices(motion.fuselage, vertical=True))
    if not found:
        return airframe
    damping, stiffness = (sum(parts[1:], start=parts[0]) / 2 for parts in zip(*found, strict=True))
    return replace(airframe, airload_damping=damping, airload_stiffness=stiffness, wing=lift)


def _strips(half: HalfAircraft, shapes: Array) -> Strips:
    """Return the strips of one wing: deformation, and exactly the motion of the fuselage."""
    bent = beam_strips(half.structure, shapes[..., 6:, :])
    carried = rigid_motion(strip_positions(half.structure.positions)) @ shapes[..., None, :6, :]
    return bent._replace(
        rise=bent.rise + carried[..., _UP, :], pitch=bent.pitch + shapes[..., None, _PITCH, :]
    )
