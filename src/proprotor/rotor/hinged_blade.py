"""The hinged blade that is nearest to an elastic one: offsets, springs, their turning, and the pitch stiffness.

The elastic blade deflects under the inertia loads of the hinged one, m (r - e) outboard of each hinge, up and against
the rotation. Its two deflections have a stiffness and a mass that are exact for these shapes at every pitch and rotor
speed. The hinged blade has

1. the offsets whose straight lines are nearest to the shapes, weighted by mass; loads and shapes follow the offsets;
2. the springs whose flexibility, that of a hub and that of a blade that turns with the pitch, is nearest to the elastic
   one over the collective range: four numbers, linear in the flexibility. The part that is alike in all directions can
   belong to hub or blade, without a difference to the hinged blade; it is shared as the strain energy is;
3. the pitch stiffness that turns the blade at 0.75 R as the torque of flap and lag bending turns the elastic one. It
   acts where the blade bends. Torques spread in other ways turn the blade by more or less, see `PitchStiffness`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from proprotor_equations import blade_element as element
from proprotor_equations import flap_lag_springs

from proprotor.errors import InputError
from proprotor.rotor.blade_stations import BladeStations
from proprotor.rotor.elastic_blade import ElasticBlade
from proprotor.rotor.generated import evaluate
from proprotor.typing import Array

_ROUNDS = 30
_CONVERGED = 1e-10  # of the radius, the last change of an offset
_PLANES = (element.OUT_OF_PLANE, element.IN_PLANE)  # flap, lag
_SEARCHED = np.linspace(0.0, 0.6, 61)  # of the radius, hinge offsets
REFERENCE = 0.75  # of the radius, where pitch is counted


class Deflection(NamedTuple):
    """A blade that deflects under two loads, flap and lag, counted so that each has the kinetic energy of its hinge.

    shape (..., motions, 2) : motions of the stations per unit of the two deflections.
    stiffness (..., 2, 2) : their stiffness, with that of the centrifugal force.
    torque (..., 2, 2) : change of the stiffness with pitch; half of it, times two deflections, opposes pitch.
    """

    shape: Array
    stiffness: Array
    torque: Array


class PitchStiffness(NamedTuple):
    """Torque on a blade per turn at 0.75 R, N m/rad, for torques that are spread in different ways.

    flap_lag : as bending in flap and lag spreads them: that of the hinged blade.
    section_moment : as chord² r², the moments of airfoils; None without a chord.
    propeller_moment : as the pitch inertia times the sine of twice the angle; None without a pitch inertia.
    even : evenly outboard of the bearing.
    """

    flap_lag: float
    section_moment: float | None
    propeller_moment: float | None
    even: float


class HingedBlade(NamedTuple):
    """The hinged blade: numbers by the names of `Rotor`, and what they were found from.

    numbers : fields of `Rotor`.
    pitch_stiffness : the pitch stiffness by the way a torque is spread.
    pitch (p,) : collectives at 0.75 R, rad, at which it was fitted; rotor_speed, rad/s.
    elastic : deflections of the elastic blade at these.
    """

    numbers: dict[str, float]
    pitch_stiffness: PitchStiffness
    pitch: Array
    rotor_speed: float
    elastic: Deflection


def hinged_blade(stations: BladeStations, rotor_speed: float, pitch: Array) -> HingedBlade:
    """Return the hinged blade nearest to an elastic one.

    Parameters
    ----------
    stations : BladeStations
    rotor_speed : float
        rad/s.
    pitch : array (p,)
        Collective range, rad at 0.75 R; at least 3.

    Returns
    -------
    HingedBlade

    Raises
    ------
    InputError
        For a blade that bends more easily than a straight blade on a hinge without a spring.
    """
    blade = ElasticBlade(stations)
    flexibility = blade.flexibility(rotor_speed, pitch)
    offsets = _offsets(blade, flexibility)
    numbers = mass_integrals(blade, offsets)
    deflection = _deflection(blade, flexibility, pitch, numbers)
    centrifugal = rotor_speed**2 * np.array(
        [
            numbers["flap_inertia"] + offsets[0] * numbers["flap_first_moment"],
            offsets[1] * numbers["lag_first_moment"],
        ]
    )
    springs = deflection.stiffness - np.diag(centrifugal)
    numbers |= _springs(np.linalg.inv(springs), pitch, _share_of_blade(blade, deflection, pitch))
    _check_springs(numbers)
    turn, total = _turns(blade, deflection, pitch)
    _, slope = spring_matrix(numbers, pitch)
    numbers["control_stiffness"] = _nearest(blade, slope, turn)
    stiffness = _pitch_stiffness(blade, _nearest(blade, total, turn), pitch)
    return HingedBlade(numbers, stiffness, pitch, rotor_speed, deflection)


def mass_integrals(blade: ElasticBlade, offsets: tuple[float, float]) -> dict[str, float]:
    """Return the integrals of the mass by the names of `Rotor`, with hinge offsets, radius and pitch inertia."""
    mass = blade.stations.at("mass_per_length", blade.radius) * blade.weight
    found = {"radius": blade.stations.tip}
    found["flap_hinge_offset"], found["lag_hinge_offset"] = offsets
    found |= {"blade_mass": mass.sum()}
    for name, offset in (("blade", 0.0), ("flap", offsets[0]), ("lag", offsets[1])):
        arm = _arm(blade.radius, offset)
        found |= {f"{name}_first_moment": (mass * arm).sum(), f"{name}_inertia": (mass * arm**2).sum()}
    if blade.stations.pitch_inertia_per_length is not None:
        turning = np.where(blade.turns, blade.weight, 0.0)
        found["pitch_inertia"] = (turning * blade.stations.at("pitch_inertia_per_length", blade.radius)).sum()
    return {name: float(value) for name, value in found.items()}


def _arm(radius: Array, offset: float) -> Array:
    return np.maximum(radius - offset, 0.0)


def _offsets(blade: ElasticBlade, flexibility: Array) -> tuple[float, float]:
    """Return the hinge offsets of flap and lag: loads give shapes, shapes give offsets, offsets give loads."""
    offsets = (0.0, 0.0)
    for _ in range(_ROUNDS):
        shape, _ = _bent(flexibility, _loads(blade, offsets))
        flap, lag = (_nearest_offset(blade, shape[..., place], place) for place in range(2))
        if lag < flap:  # the model's lag hinge is not inboard of its flap hinge
            flap = lag = (flap + lag) / 2
        change = max(abs(flap - offsets[0]), abs(lag - offsets[1]))
        offsets = (flap, lag)
        if change <= _CONVERGED * blade.stations.tip:
            break
    return offsets


def _bent(flexibility: Array, loads: Array) -> tuple[Array, Array]:
    """Return shape (..., motions, 2) and stiffness (..., 2, 2) of deflections, each counted by its own load."""
    moved = flexibility @ loads
    stiffness = np.linalg.inv(loads.T @ moved)
    return moved @ stiffness, stiffness


def _deflection(
    blade: ElasticBlade, flexibility: Array, pitch: Array, numbers: dict[str, float]
) -> Deflection:
    """Return the deflections under the loads of the hinges, counted so that each has the hinge's kinetic energy."""
    offsets = numbers["flap_hinge_offset"], numbers["lag_hinge_offset"]
    shape, stiffness = _bent(flexibility, _loads(blade, offsets))
    mass, torque = blade.deflection(pitch, shape)
    own = np.array([numbers["flap_inertia"], numbers["lag_inertia"]])
    scale = np.sqrt(own / np.diagonal(mass, axis1=-2, axis2=-1))
    both = scale[..., :, None] * scale[..., None, :]
    return Deflection(shape * scale[..., None, :], stiffness * both, torque * both)


def _loads(blade: ElasticBlade, offsets: tuple[float, float]) -> Array:
    """Return the inertia loads (motions, 2) of the hinged blade, scaled to measure its angles."""
    mass = blade.stations.at("mass_per_length", blade.radius)
    columns = []
    for plane, offset in zip(_PLANES, offsets, strict=True):
        arm = _arm(blade.radius, offset)
        columns.append(blade.integral(plane, mass * arm) / (mass * arm**2 * blade.weight).sum())
    return np.stack(columns, axis=-1)


def _nearest_offset(blade: ElasticBlade, shape: Array, place: int) -> float:
    """Return the offset of the hinge whose straight blade is nearest to shapes (p, motions), weighted by mass."""
    bent = blade.at_points(shape, _PLANES[place])
    mass = blade.stations.at("mass_per_length", blade.radius) * blade.weight

    def misfit(offset: Array) -> Array:
        arm = np.maximum(blade.radius - offset[:, None, None], 0.0)
        along = np.einsum("ep,oep,qep->oq", mass, arm, bent)
        return np.asarray(-(along**2).sum(axis=1) / (mass * arm**2).sum(axis=(1, 2)))

    centre, step = 0.0, blade.stations.tip
    tried = _SEARCHED * blade.stations.tip
    while step > _CONVERGED * blade.stations.tip / 10:
        centre = float(tried[np.argmin(misfit(tried))])
        step = tried[1] - tried[0]
        tried = np.clip(centre + np.linspace(-step, step, 21), 0.0, None)
    return centre


def _share_of_blade(blade: ElasticBlade, deflection: Deflection, pitch: Array) -> float:
    """Return the share of the strain energy of both deflections that is outboard of the pitch bearing."""
    within = blade.strain_energy(pitch, deflection.shape)
    outboard = np.where(blade.turns, within, 0.0)
    return float(outboard.sum() / within.sum())


def _springs(flexibility: Array, pitch: Array, share: float) -> dict[str, float]:
    """Return springs, outboard fractions and structural pitch offset of the nearest flexibility (p, 2, 2).

    The flexibility is a + d (1, -1) of the hub + T (b, c) T' of the blade, T the turn by the pitch.
    """
    double = 2 * pitch
    one, none = np.ones(len(pitch)), np.zeros(len(pitch))
    # The blade's part turns as flat and edge do: what is flatwise goes into lag as the sine of the pitch.
    rows = {
        (0, 0): (one, one, np.cos(double), -np.sin(double)),
        (0, 1): (none, none, np.sin(double), np.cos(double)),
        (1, 1): (one, -one, -np.cos(double), np.sin(double)),
    }
    left = np.concatenate([np.stack(row, axis=1) for row in rows.values()])
    right = np.concatenate([flexibility[:, i, j] for i, j in rows])
    (alike, hub, cosine, sine), *_ = np.linalg.lstsq(left, right, rcond=None)
    return _as_springs(alike, hub, cosine, sine, share)


def _as_springs(alike: float, hub: float, cosine: float, sine: float, share: float) -> dict[str, float]:
    """Return the springs of a flexibility in its four parts."""
    differ = float(np.hypot(cosine, sine))
    blade = float(np.clip(share * alike, differ, alike - abs(hub)))
    flat, edge = blade + differ, blade - differ
    flap, lag = flat + alike - blade + hub, edge + alike - blade - hub
    return {
        "flap_stiffness": float(1 / flap),
        "lag_stiffness": float(1 / lag),
        "flap_outboard_fraction": float(np.clip(flat / flap, 0, 1)),
        "lag_outboard_fraction": float(np.clip(edge / lag, 0, 1)),
        "structural_pitch_offset": float(np.arctan2(sine, cosine) / 2),
    }


def _check_springs(numbers: dict[str, float]) -> None:
    """Refuse a blade whose shape needs a spring that pushes away from the middle."""
    for axis in ("flap", "lag"):
        if numbers[f"{axis}_stiffness"] < 0:
            raise InputError(
                "stations",
                None,
                f"have no hinged blade: at this rotor speed the blade bends in {axis} more easily than a straight "
                "blade on a free hinge; see whether the units of mass and stiffness are right",
            )


def _turns(blade: ElasticBlade, deflection: Deflection, pitch: Array) -> tuple[Array, Array]:
    """Return the turn (p, 2, 2) at 0.75 R by the torque of two deflections, and this torque."""
    torque = blade.torque_along(pitch, deflection.shape)
    return blade.turned_by(torque, REFERENCE * blade.stations.tip)


def _pitch_stiffness(blade: ElasticBlade, flap_lag: float, pitch: Array) -> PitchStiffness:
    """Return the pitch stiffness for each way to spread a torque."""
    stations = blade.stations
    even = np.ones(blade.radius.shape)
    section = propeller = None
    if stations.chord is not None:
        section = _ratio(blade, (stations.at("chord", blade.radius) * blade.radius) ** 2)
    if stations.pitch_inertia_per_length is not None:
        turned = np.sin(2 * (pitch[:, None, None] + stations.angle(blade.radius)))
        propeller = _ratio(blade, stations.at("pitch_inertia_per_length", blade.radius) * turned)
    return PitchStiffness(flap_lag, section, propeller, _ratio(blade, even))


def _ratio(blade: ElasticBlade, torque: Array) -> float:
    turn, total = blade.turned_by(torque, REFERENCE * blade.stations.tip)
    return _nearest(blade, total, turn)


def _nearest(blade: ElasticBlade, total: Array, turn: Array) -> float:
    """Return the stiffness whose turns are nearest to those of torques, large torques before small ones.

    Without a torque it is that of the control system.
    """
    work = float((np.asarray(total) * turn).sum())
    return float((np.asarray(total) ** 2).sum()) / work if work else float(blade.stations.control_stiffness)


def spring_matrix(numbers: dict[str, Any], pitch: Array) -> tuple[Array, Array]:
    """Return stiffness (p, 2, 2) of flap and lag of the hinged blade, without centrifugal force, and its slope."""
    turned = {"structural_pitch": pitch + numbers["structural_pitch_offset"]}
    found = evaluate(flap_lag_springs.effective_stiffness, numbers | turned)._asdict()

    def matrix(suffix: str) -> Array:
        flap, both, lag = (
            np.broadcast_to(found[f"{pair}_stiffness{suffix}"], pitch.shape)
            for pair in ("flap_flap", "flap_lag", "lag_lag")
        )
        return np.stack([np.stack([flap, both], -1), np.stack([both, lag], -1)], -2)

    return matrix(""), matrix("_slope")
