"""Random rotors of about the XV-15's size, no parameter at zero: numbers by name, arrays over the rotors.

A blade is three thin rods, inboard of the flap hinge, between the hinges and outboard of the lag hinge, so that a
multibody engine can have it; the mass integrals of the generated equations follow.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Quantities = dict[str, NDArray]

# Least and greatest value of each number, SI.
RANGES = {
    "rotor_speed": (40.0, 55.0),
    "flap_hinge_offset": (0.3, 0.5),
    "precone": (0.02, 0.08),
    "flap_stiffness": (2e5, 5e5),
    "lag_stiffness": (8e5, 1.5e6),
    "flap_outboard_fraction": (0.1, 0.9),
    "lag_outboard_fraction": (0.1, 0.9),
    "gimbal_stiffness": (1e4, 4e4),
    "pitch_gimbal_coupling": (-0.4, -0.1),
    "pitch_inertia": (1.0, 2.0),
    "control_stiffness": (3e4, 6e4),
    "flap_damping": (100.0, 400.0),
    "lag_damping": (100.0, 400.0),
    "pitch_damping": (2.0, 9.0),
    "gimbal_damping": (50.0, 200.0),
    "structural_pitch_offset": (-0.3, 0.3),
    "inboard_mass": (5.0, 15.0),
    "middle_mass": (1.0, 5.0),
    "outboard_mass": (30.0, 60.0),
    "coning": (-0.03, 0.03),
    "lag": (-0.03, 0.03),
    "elastic_pitch": (-0.05, 0.05),
    "collective": (0.2, 0.8),
}
GAP = (0.1, 0.3)  # between the hinges, m
RADIUS = 3.81


def random_rotors(count: int, seed: int = 0) -> Quantities:
    """Arrays (count,) by name. The trim angles are drawn too: the matrices are compared at any of them."""
    rng = np.random.default_rng(seed)
    q = {name: rng.uniform(*limits, count) for name, limits in RANGES.items()}
    q["lag_hinge_offset"] = q["flap_hinge_offset"] + rng.uniform(*GAP, count)
    lengths = {
        "inboard": q["flap_hinge_offset"],
        "middle": q["lag_hinge_offset"] - q["flap_hinge_offset"],
        "outboard": RADIUS - q["lag_hinge_offset"],
    }
    for name, length in lengths.items():
        q[f"{name}_centre"] = rng.uniform(0.4, 0.6, count) * length
        q[f"{name}_inertia"] = rng.uniform(0.05, 0.1, count) * q[f"{name}_mass"] * length**2
    q |= {"n_blades": np.full(count, 3.0), "propeller_moment": np.ones(count)}
    q["pitch"] = q["collective"] + q["elastic_pitch"]
    q["structural_pitch"] = q["pitch"] + q["structural_pitch_offset"]
    return q | mass_integrals(q)


def mass_integrals(q: Quantities) -> Quantities:
    """The seven integrals of the three rods: mass, first and second moment about the centre and about each hinge."""
    roots = {"inboard": 0.0, "middle": q["flap_hinge_offset"], "outboard": q["lag_hinge_offset"]}

    def moments(origin, rods):
        arms = {name: roots[name] - origin + q[f"{name}_centre"] for name in rods}
        first = sum(q[f"{name}_mass"] * arm for name, arm in arms.items())
        second = sum(q[f"{name}_inertia"] + q[f"{name}_mass"] * arm**2 for name, arm in arms.items())
        return first, second

    whole = moments(0.0, ("inboard", "middle", "outboard"))
    flap = moments(q["flap_hinge_offset"], ("middle", "outboard"))
    lag = moments(q["lag_hinge_offset"], ("outboard",))
    return {
        "blade_mass": sum(q[f"{name}_mass"] for name in roots),
        "blade_first_moment": whole[0],
        "blade_inertia": whole[1],
        "flap_first_moment": flap[0],
        "flap_inertia": flap[1],
        "lag_first_moment": lag[0],
        "lag_inertia": lag[1],
    }


def rotor(q: Quantities, place: int) -> Quantities:
    """One of them, as floats."""
    return {name: float(value[place]) for name, value in q.items()}
