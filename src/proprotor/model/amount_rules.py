"""The range in which each amount of a plausible proprotor lies, one line for each, with what a value outside suggests.

A mark means a slip of a unit, or a rotor unlike most proprotors that flew or ran in a tunnel. Nothing is refused: a
mark is a question, and a blade with a heavy root has an answer.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Rule(NamedTuple):
    """The range of an amount, what a value outside suggests, and the unit of the range."""

    low: float
    high: float
    reason: str
    unit: str = ""


RULES: dict[str, Rule] = {
    "Lock number": Rule(
        1, 15, "proprotors have 3 to 10, so check blade_inertia (slug ft² for lb ft²), chord, density"
    ),
    "solidity": Rule(0.03, 0.4, "proprotors have 0.06 to 0.3, so check the chord and the radius"),
    "mean chord": Rule(
        0.02, 0.4, "blades have 0.05 to 0.25 of the radius, so check ft for inches in the chord", "R"
    ),
    "precone": Rule(-10, 10, "hubs have 0 to 5 deg, so check rad for degrees", "deg"),
    "density": Rule(
        0.2,
        6,
        "air has 0.3 to 1.4 kg/m³ up to 12 km, a heavy gas up to 6, so check lb/ft³ for slug/ft³",
        "kg/m³",
    ),
    "speed of sound": Rule(
        120, 400, "air has 295 to 350 m/s, a heavy gas 130 to 180, so check ft/s for m/s", "m/s"
    ),
    "tip Mach number": Rule(0.2, 0.95, "proprotors have 0.4 to 0.8 in cruise, so check rad/s for rpm"),
    "centre of mass": Rule(
        0.2, 0.6, "blades have it at 0.3 to 0.5 of the radius, so check blade_first_moment", "R"
    ),
    "radius of gyration": Rule(
        0.3, 0.75, "blades have 0.4 to 0.6 of the radius, so check the units of blade_inertia", "R"
    ),
    "smallest eigenvalue of the Gram matrix": Rule(
        1e-9, np.inf, "the mass integrals are those of a few point masses, or one is rounded too far"
    ),
    "flap frequency": Rule(
        1, 3, "a blade that flaps outboard of the shaft has above 1/rev, so check flap_stiffness", "/rev"
    ),
    "lag frequency": Rule(
        1, 4, "below 1/rev ground and air resonance is possible, so check lag_stiffness", "/rev"
    ),
    "gimbal frequency": Rule(1, 1.3, "a hub spring adds little to 1/rev, so check gimbal_stiffness", "/rev"),
    "K_Pβ": Rule(-1, 1, "a blade turns less than it bends, so check control_stiffness"),
    "K_Pζ": Rule(-1, 1, "a blade turns less than it bends, so check control_stiffness"),
    "mode of the support": Rule(
        0.03, 20, "wing modes lie near 1/rev, so check Hz for rad/s, masses and stiffness", "/rev"
    ),
}


def doubt_of(name: str, value: float) -> str:
    """Return why an amount is doubtful, with the rule; "" for an amount within its range or without a rule."""
    rule = RULES.get(name)
    if rule is None or not np.isfinite(value) or rule.low <= value <= rule.high:
        return ""
    bound = (f"below {rule.low:g}" if value < rule.low else f"above {rule.high:g}") + f" {rule.unit}".rstrip()
    return f"{name} {f'{value:.4g} {rule.unit}'.strip()} is {bound}: {rule.reason}"
