"""Loads of a blade section written down from lift, drag and moment, for an airfoil with every derivative at work."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

STEP = 1e-30
LOADS = ("fx", "fn", "fd", "m")
DERIVATIVES = {"ut": "tangential", "up": "axial", "ur": "radial", "theta": "pitch", "spin": "spin"}


@dataclass(frozen=True)
class Air:
    """What a section is and meets: velocities u_T, u_P, u_R, its pitch, and its rotation about the span, nose up.

    Velocities are those of the pitch axis, `center` aft of which the aerodynamic centre lies.
    """

    tangential: Any
    axial: Any
    radial: Any
    pitch: Any
    spin: Any
    chord: Any
    density: Any
    speed_of_sound: Any
    center: Any = 0.0

    def mapped(self, function: Callable) -> Air:
        """The same with a function applied to every number."""
        return Air(**{entry.name: function(getattr(self, entry.name)) for entry in fields(self)})


@dataclass(frozen=True)
class PolynomialAirfoil:
    """Lift, drag and moment coefficients as polynomials of angle of attack and Mach number: no derivative vanishes."""

    def coefficients(self, alpha: Any, mach: Any) -> tuple[Any, Any, Any]:
        lift = 0.3 + 5.7 * alpha + 0.8 * alpha * mach + 0.4 * mach**2 - 1.1 * alpha**2
        drag = 0.05 + 0.3 * alpha**2 + 0.2 * alpha + 0.06 * mach**2 + 0.1 * alpha * mach
        moment = -0.04 + 0.2 * alpha - 0.09 * mach**2 + 0.07 * alpha * mach
        return lift, drag, moment


POLYNOMIAL = PolynomialAirfoil()


@dataclass(frozen=True)
class StraightAirfoil:
    """A straight lift line with the Prandtl-Glauert factor on lift and moment, and a constant drag."""

    lift_slope: float = 5.7
    zero_lift_angle: float = -0.02
    drag: float = 0.05
    moment: float = -0.03

    def coefficients(self, alpha: Any, mach: Any) -> tuple[Any, Any, Any]:
        factor = 1 / np.sqrt(1 - mach**2)
        lift = factor * self.lift_slope * (alpha - self.zero_lift_angle)
        return lift, self.drag + 0 * alpha, factor * self.moment


def inflow(air: Air) -> tuple[Any, Any, Any]:
    """Speed in the section's plane, inflow angle and angle of attack."""
    angle = np.arctan(air.axial / air.tangential)
    return np.sqrt(air.tangential**2 + air.axial**2), angle, air.pitch - angle


def turn_incidence(air: Air, damped: float = 1.0) -> Any:
    """What the rotation adds to the incidence half a chord behind the quarter chord."""
    return damped * air.spin * air.chord / 2 / inflow(air)[0]


def at_center(air: Air) -> Air:
    """What the aerodynamic centre meets: nose up, its section's turn moves it ahead and down where it lies aft."""
    ahead, down = (air.center * wave(air.pitch) * air.spin for wave in (np.sin, np.cos))
    return replace(air, tangential=air.tangential + ahead, axial=air.axial - down, center=0.0 * air.center)


def about_axis(air: Air, loads: dict[str, Any]) -> dict[str, Any]:
    """Loads about the pitch axis of loads at the aerodynamic centre: along i' and against n it has two levers."""
    aft, below = (air.center * wave(air.pitch) for wave in (np.cos, np.sin))
    return loads | {"m": loads["m"] - aft * loads["fn"] - below * loads["fx"]}


def section_loads(
    airfoil: PolynomialAirfoil | StraightAirfoil,
    air: Air,
    damped: float = 1.0,
    powers: tuple[float, float] = (1.0, 1.0),
) -> dict[str, Any]:
    """Force along i', n and d and nose-up moment, per length.

    Lift is normal to the air in the section's plane, drag along the air, the part along the span included. Thin
    airfoils resist rotation with π/8 ρ c³ U per rad/s about the quarter chord, and lift by the incidence at 3/4 chord.
    `powers` are what stands for c² and c³, over the square and the cube of the chord.
    """
    square, cube = powers
    whole, air = air, at_center(air)
    speed, angle, alpha = inflow(air)
    mach = speed / air.speed_of_sound
    _, drag, moment = airfoil.coefficients(alpha, mach)
    lift, _, _ = airfoil.coefficients(alpha + square * turn_incidence(air, damped), mach)
    area = 0.5 * air.density * air.chord
    loads = {
        "fx": area * speed**2 * (lift * np.sin(angle) + drag * np.cos(angle)),
        "fn": area * speed**2 * (lift * np.cos(angle) - drag * np.sin(angle)),
        "fd": -area * speed * drag * air.radial,
        "m": area * square * air.chord * speed**2 * moment
        - damped * np.pi / 8 * air.density * cube * air.chord**3 * speed * air.spin,
    }
    return about_axis(whole, loads)


def section_derivatives(
    airfoil: PolynomialAirfoil | StraightAirfoil,
    air: Air,
    damped: float = 1.0,
    powers: tuple[float, float] = (1.0, 1.0),
) -> dict[str, NDArray]:
    """Loads and their derivatives, by the names of the derivation."""
    found = dict(section_loads(airfoil, air, damped, powers))
    for name, argument in DERIVATIVES.items():
        moved = replace(air, **{argument: getattr(air, argument) + 1j * STEP})
        loads = section_loads(airfoil, moved, damped, powers)
        found |= {f"{load}_{name}": np.imag(loads[load]) / STEP for load in LOADS}
    return found


def coefficients_of(airfoil: PolynomialAirfoil, air: Air) -> dict[str, NDArray]:
    """Coefficients of a section that turns and their derivatives, by the names of the derivation."""
    air = at_center(air)
    speed, _, alpha = inflow(air)
    mach, turned = speed / air.speed_of_sound, alpha + turn_incidence(air)
    steps = {"": (0.0, 0.0), "_alpha": (1j * STEP, 0.0), "_mach": (0.0, 1j * STEP)}
    found = {}
    for suffix, (da, dm) in steps.items():
        lift, _, _ = airfoil.coefficients(turned + da, mach + dm)
        values = (lift, *airfoil.coefficients(alpha + da, mach + dm)[1:])
        for name, value in zip(("lift", "drag", "moment"), values, strict=True):
            found[f"{name}_coefficient{suffix}"] = np.imag(value) / STEP if suffix else value
    return found
