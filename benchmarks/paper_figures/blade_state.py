"""What a blade is like at the trim of each airspeed: pitch, deflection, couplings, lag frequency."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from proprotor_equations import pitch

from proprotor.model.quantities import rotor_quantities
from proprotor.model.rotor_model import rotor_model
from proprotor.rotor.generated import evaluate
from proprotor.rotor.motions import HUB
from proprotor.rotor.options import Options
from proprotor.rotor.trim import UNKNOWNS, with_trim
from proprotor.stability.branches import by_branch
from proprotor.stability.sweep import sweep
from proprotor.typing import Array

if TYPE_CHECKING:
    from proprotor.case import Case

_PAIRS = {
    ("coning", ""): ("flap_0",),
    ("low cyclic lag", "high cyclic lag"): ("lag_1c", "lag_1s"),
    ("low gimbal", "high gimbal"): ("gimbal_1c", "gimbal_1s"),
}
AS_THE_PAPER: dict[str, Any] = {"section_damping": False}  # its sections turn without damping
ROTOR_MODES = tuple(name for pair in _PAIRS for name in pair if name)


class BladeState(NamedTuple):
    """What the couplings follow from, arrays over airspeed: angles in rad, frequency per rev."""

    structural_pitch: Array
    coning: Array
    lag: Array
    pitch_flap_coupling: Array
    pitch_lag_coupling: Array
    pitch_lag_coupling_without_lag: Array
    lag_frequency: Array


def blade_state(case: Case, airspeed: ArrayLike) -> BladeState:
    """Trim, the couplings of Eqs. 36 and 37, and the uncoupled lag frequency √(K_ζζ/I_ζ + Ω² e S/I)/Ω.

    Sections turn without damping, as in the paper.

    Parameters
    ----------
    case : Case
    airspeed : array (points,)
        m/s.
    """
    airspeed = np.atleast_1d(airspeed)
    rotor, operation = case.rotor, case.operation
    options = Options(pitch="coupling", **AS_THE_PAPER)
    trim = rotor_model(rotor, operation, airspeed, pitch="coupling", **AS_THE_PAPER).trim
    quantities = rotor_quantities(rotor, operation, airspeed, airspeed.shape)
    pool = with_trim(quantities, options, {name: getattr(trim, name) for name in UNKNOWNS})
    centrifugal = rotor.lag_hinge_offset * rotor.lag_first_moment
    squared = centrifugal + pool["lag_lag_stiffness"] / operation.rotor_speed**2
    couplings = evaluate(pitch.couplings, pool)
    return BladeState(
        pool["structural_pitch"],
        trim.coning,
        trim.lag,
        couplings.pitch_flap_coupling,
        couplings.pitch_lag_coupling,
        evaluate(pitch.couplings, pool | {"lag": 0.0}).pitch_lag_coupling,
        np.sqrt(squared / rotor.lag_inertia),
    )


def on_rigid_hub(case: Case, airspeed: Array, **options: Any) -> dict[str, Array]:
    """Frequencies per rev (points,), in the fixed frame, of `ROTOR_MODES`; NaN at failed points.

    Modes are roots here, followed over all airspeeds. Coning is that with most of the collective flap; of the two with
    most of the cyclic lag, or of the gimbal, the one with the lower mean frequency is the low one. Locked coordinates
    have no modes. Sections turn without damping, as in the paper, unless it is chosen.
    """
    model = rotor_model(case.rotor, case.operation, airspeed, **AS_THE_PAPER | options)
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
