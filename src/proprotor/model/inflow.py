"""Add induced velocity to the matrices of a rotor: its tilt with the hub, and states that follow thrust and moments.

`derive/inflow.py` has the equations. The matrices of the rotor are those at the air through the disk, V + λ along the
axis of flight. The induced part of it tilts with the hub, and air that tilts is a gust across the axis. The inflow
itself is the rate of a coordinate without stiffness; the loads along the hub's axis that make it are sums over the
segments of a blade as all airloads are. In the sum over the blades the uniform inflow stands in the place of the
azimuth, which all blades have in common, and the harmonics in that of the gimbal, whose tilt they resemble.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from proprotor_equations import BLADE_COORDINATES, FIXED_COORDINATES, airloads, inflow, multiblade

from proprotor.model.lift_lag import padded
from proprotor.model.linear_model import INPUTS, SWASHPLATE
from proprotor.rotor.generated import evaluate
from proprotor.rotor.motions import INFLOW
from proprotor.rotor.options import Options
from proprotor.typing import Array

_SEEN_FROM_BLADE = [BLADE_COORDINATES.index(name) for name in ("azimuth", "gimbal_flap", "gimbal_roll")]
_PLACES = [FIXED_COORDINATES.index(name) for name in ("azimuth", "gimbal_1c", "gimbal_1s")]
_NOTHING = np.zeros((len(BLADE_COORDINATES),) * 2)
_AXIAL, _AXIAL_GUST = FIXED_COORDINATES.index("z"), INPUTS.index("gust_z")
_TILTS = {"alpha_x": ("gust_y", -1.0), "alpha_y": ("gust_x", 1.0)}  # gust against the tilted induced velocity


def with_inflow(
    rotor: Mapping[str, Array],
    segments: Mapping[str, Any],
    quantities: Mapping[str, Any],
    induced: Array,
    options: Options,
) -> dict[str, Array]:
    """Return M, C, K and B of a rotor with the induced velocity that the options ask for.

    Parameters
    ----------
    rotor : mapping of str to array
        M, C, K (points, 18, 18) and B (points, 18, 6) of the rotor at the air through the disk.
    segments : mapping
        On which side of the hinges each segment is, and the radial moments of the section loads at trim.
    quantities : mapping
        Quantities of the blade at trim by name, numbers or arrays (points,); the airspeed is that through the disk.
    induced : array (points,)
        Induced velocity in trim, m/s.
    options : Options
    """
    if options.inflow_is_dynamic:
        through = {"induced_velocity": induced, "axial_flow": quantities["airspeed"]}
        rotor = _with_states(rotor, segments, {**quantities, **through})
    return _with_tilt(rotor, induced)


def _with_tilt(rotor: Mapping[str, Array], induced: Any) -> dict[str, Array]:
    """Return M, C, K and B of a rotor whose steady induced velocity tilts with the hub.

    Parameters
    ----------
    rotor : mapping of str to array
        M, C, K (points, n, n) and B (points, n, 6), with induced velocity along the axis of flight.
    induced : float or array (points,)
        m/s.
    """
    gusts = np.asarray(induced)[..., None] * np.moveaxis(rotor["B"], -1, 0)
    stiffness = rotor["K"].astype(np.result_type(rotor["K"], gusts))
    for angle, (gust, sign) in _TILTS.items():
        stiffness[..., FIXED_COORDINATES.index(angle)] += sign * gusts[INPUTS.index(gust)]
    return {**rotor, "K": stiffness}


def _with_states(
    rotor: Mapping[str, Array], segments: Mapping[str, Any], quantities: Mapping[str, Any]
) -> dict[str, Array]:
    """Return M, C, K and B of a rotor with the states of the inflow added.

    Parameters
    ----------
    rotor : mapping of str to array
        M, C, K (points, 18, 18) and B (points, 18, 6) of the rotor whose inflow stays.
    segments : mapping
        On which side of the hinges each segment is, and the radial moments of the section loads at trim.
    quantities : mapping
        Quantities of the blade at trim by name, numbers or arrays (points,), with ``induced_velocity`` and
        ``axial_flow``.

    Returns
    -------
    dict of str to array
        On the coordinates of Eq. 17, then `proprotor.rotor.motions.INFLOW`.
    """
    blade, own = _InflowOfBlade.of(segments, quantities), len(FIXED_COORDINATES)
    momentum = evaluate(inflow.momentum, quantities)
    whole = padded(rotor, len(INFLOW), np.result_type(*blade, *momentum))
    rates, displacements = (_in_rows(part) for part in (blade.made_by_rates, blade.made_by_displacements))
    damping, loads, among = (
        evaluate(multiblade.damping, quantities, _NOTHING, part)
        for part in (rates, _in_columns(blade.loads), _in_columns(_in_rows(blade.made_by_inflow)))
    )
    stiffness = evaluate(multiblade.stiffness, quantities, _NOTHING, rates, displacements)
    gusts = evaluate(multiblade.gust_loads, quantities, _in_rows(blade.made_by_gusts))
    whole["C"][:, :own, own:] = loads[..., _PLACES]
    whole["C"][:, own:, :own] = damping[..., _PLACES, :]
    whole["C"][:, own:, own:] = among[..., _PLACES, :][..., _PLACES]
    whole["K"][:, own:, :own] = stiffness[..., _PLACES, :]
    whole["B"][:, own:, len(SWASHPLATE) :] = gusts[..., _PLACES, :]
    _add_momentum(whole, own, momentum)
    return whole


class _InflowOfBlade(NamedTuple):
    """What one blade has to do with the inflow, in rotating axes; on the left of the equations, but for gusts.

    loads (points, 12, 3) : loads on the blade per unit of inflow;
    made_by_rates, made_by_displacements (points, 3, 12), made_by_inflow, made_by_gusts (points, 3, 3) : loads along the
    hub's axis, by the functions of the disk that they are weighed with, per unit of each.
    """

    loads: Array
    made_by_rates: Array
    made_by_displacements: Array
    made_by_inflow: Array
    made_by_gusts: Array

    @classmethod
    def of(cls, loads: Mapping[str, Any], quantities: Mapping[str, Any]) -> _InflowOfBlade:
        """Return the sums over the segments of a blade."""
        segments = {**{name: np.asarray(value)[..., None] for name, value in quantities.items()}, **loads}
        segments |= evaluate(airloads.segment_geometry, segments)._asdict()
        of_blade = {
            name: evaluate(getattr(airloads, name), segments)
            for name in (
                *("virtual_motion", "rate_motion", "displacement_motion", "gust_motion"),
                "load_derivatives",
            )
        }
        made = of_blade | {
            "virtual_motion": evaluate(inflow.virtual_motion, segments),
            "geometric_stiffness": evaluate(inflow.geometric_stiffness, segments),
        }
        through_disk = {"rate_motion": evaluate(inflow.motion, segments)}
        return cls(
            loads=evaluate(airloads.damping, of_blade | through_disk),
            made_by_rates=evaluate(airloads.damping, made),
            made_by_displacements=evaluate(airloads.stiffness, made),
            made_by_inflow=evaluate(airloads.damping, made | through_disk),
            made_by_gusts=evaluate(airloads.gust_loads, made),
        )


def _add_momentum(whole: dict[str, Array], own: int, momentum: Any) -> None:
    """Add the mass of the air and its flow through the disk, which the speed of hub against air changes."""
    masses = (momentum.uniform_apparent_mass, *[momentum.harmonic_apparent_mass] * 2)
    flows = (momentum.uniform_mass_flow, *[momentum.harmonic_mass_flow] * 2)
    for place, (mass, flow) in enumerate(zip(masses, flows, strict=True), start=own):
        whole["M"][:, place, place] = mass
        whole["C"][:, place, place] += flow
    whole["C"][:, own, _AXIAL] += momentum.thrust_by_speed
    whole["B"][:, own, _AXIAL_GUST] += momentum.thrust_by_speed


def _in_rows(matrix: Array) -> Array:
    """Return rows (points, 3, n) of the inflow as rows of a blade (points, 12, n)."""
    whole = np.zeros((*matrix.shape[:-2], len(BLADE_COORDINATES), matrix.shape[-1]), dtype=matrix.dtype)
    whole[..., _SEEN_FROM_BLADE, :] = matrix
    return whole


def _in_columns(matrix: Array) -> Array:
    """Return columns (points, n, 3) of the inflow as columns of a blade (points, n, 12)."""
    return np.swapaxes(_in_rows(np.swapaxes(matrix, -1, -2)), -1, -2)
