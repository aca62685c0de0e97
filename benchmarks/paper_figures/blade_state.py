"""A blade at the trim of each airspeed: pitch, deflection, couplings, and the rotor's modes on a rigid hub."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from proprotor_equations import flap_lag_springs, pitch

import proprotor as pp
from proprotor.rotor.motions import HUB
from proprotor.stability.branches import by_branch
from proprotor.stability.sweep import sweep
from proprotor.typing import Array

_PAIRS = {
    ("coning", ""): ("flap_0",),
    ("low cyclic lag", "high cyclic lag"): ("lag_1c", "lag_1s"),
    ("low gimbal", "high gimbal"): ("gimbal_1c", "gimbal_1s"),
}
AS_THE_PAPER: dict[str, Any] = {"section_damping": False}  # the paper's sections turn without damping


class BladeState(NamedTuple):
    """A blade at trim, arrays over airspeed: angles in rad, couplings dimensionless, frequency per revolution."""

    structural_pitch: Array
    coning: Array
    lag: Array
    pitch_flap_coupling: Array
    pitch_lag_coupling: Array
    pitch_lag_coupling_without_lag: Array
    lag_frequency: Array


def effective_springs(rotor: pp.Rotor, structural_pitch: Array) -> flap_lag_springs.EffectiveStiffness:
    """Return the stiffness of flap and lag at a structural pitch (points,) in rad, and its slopes over the pitch."""
    return flap_lag_springs.effective_stiffness(
        flap_stiffness=rotor.flap_stiffness,
        lag_stiffness=rotor.lag_stiffness,
        flap_outboard_fraction=rotor.flap_outboard_fraction,
        lag_outboard_fraction=rotor.lag_outboard_fraction,
        structural_pitch=structural_pitch,
    )


def couplings(
    rotor: pp.Rotor, springs: flap_lag_springs.EffectiveStiffness, coning: ArrayLike, lag: ArrayLike
) -> pitch.Couplings:
    """Return pitch-flap and pitch-lag coupling by Eqs. 36 and 37, of springs at trim angles in rad."""
    slopes = {name: slope for name, slope in springs._asdict().items() if name.endswith("_slope")}
    return pitch.couplings(control_stiffness=rotor.control_stiffness, coning=coning, lag=lag, **slopes)


def blade_state(case: pp.Case, airspeed: ArrayLike) -> BladeState:
    """Return trim, couplings, and the uncoupled lag frequency √(K_ζζ/I_ζ + Ω² e S/I)/Ω; sections turn without damping.

    Parameters
    ----------
    case : Case
    airspeed : array (points,)
        m/s.

    Returns
    -------
    BladeState
    """
    rotor, operation = case.rotor, case.operation
    trim = pp.rotor_model(rotor, operation, np.atleast_1d(airspeed), pitch="coupling", **AS_THE_PAPER).trim
    structural_pitch = trim.pitch + rotor.structural_pitch_offset
    springs = effective_springs(rotor, structural_pitch)
    centrifugal = rotor.lag_hinge_offset * rotor.lag_first_moment
    coupled = couplings(rotor, springs, trim.coning, trim.lag)
    squared = centrifugal + springs.lag_lag_stiffness / operation.rotor_speed**2
    return BladeState(
        structural_pitch,
        trim.coning,
        trim.lag,
        coupled.pitch_flap_coupling,
        coupled.pitch_lag_coupling,
        couplings(rotor, springs, trim.coning, 0.0).pitch_lag_coupling,
        np.sqrt(squared / rotor.lag_inertia),
    )


def on_rigid_hub(case: pp.Case, airspeed: Array, **options: Any) -> dict[str, Array]:
    """Return frequencies per revolution (points,) of the rotor's modes in the fixed frame; NaN at failed points.

    Modes are roots here, followed over all airspeeds. Coning is the root with most of the collective flap. Of the two
    roots with most of the cyclic lag, or of the gimbal, the low one has the lower mean frequency. Locked coordinates
    have no modes. Sections turn without damping, as in the paper, unless the options say otherwise.
    """
    model = pp.rotor_model(case.rotor, case.operation, airspeed, **AS_THE_PAPER | options)
    modes = by_branch(sweep(model.submodel(tuple(name for name in model.dofs if name not in HUB))))
    per_rev = modes.frequency.values / case.operation.rotor_speed
    found = {}
    for (low, high), coordinates in _PAIRS.items():
        if not set(coordinates) <= set(model.dofs):
            continue
        share = modes.participation.sel(dof=list(coordinates)).sum("dof").mean("airspeed").values
        places = np.argsort(-share)[: 2 if high else 1]
        ordered = places[np.argsort(np.nanmean(per_rev[:, places], axis=0))]
        found[low] = per_rev[:, ordered[0]]
        if high:
            found[high] = per_rev[:, ordered[-1]]
    return found
