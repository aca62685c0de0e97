"""A rotor at an angle to its flight, or in a pull-up: its matrices around the turn in the fixed frame, and their mean.

Each blade's matrices about the periodic trim are transformed at every azimuth by multiblade coordinates and summed
over the blades; the azimuth is averaged after that, so that what the averaging leaves out repeats N times a turn.

The rotor's azimuth carries the swing of its blades with it: a rotor that is ahead by a small angle has blades and
gimbal that are ahead in their swing. In these coordinates a rotor that is ahead is in balance as well, and the azimuth
has no stiffness of its own, as in axial flight.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from proprotor_equations import coordinates, drive_train, moving
from proprotor_equations.coordinates import BLADE

from proprotor.errors import InputError
from proprotor.rotor.around_the_turn import azimuths, derivative, harmonics, number_of_azimuths
from proprotor.rotor.generated import evaluate
from proprotor.rotor.moving_blade import BladeAround, Flight, Motion
from proprotor.rotor.options import Options
from proprotor.rotor.periodic_trim import HarmonicBalance, PeriodicTrim, periodic_trim
from proprotor.rotor.rotor import Rotor
from proprotor.rotor.section_loads import BladeSections
from proprotor.rotor.trim import Target, Trim, has_offset_mass
from proprotor.rotor.trim_solver import Settled
from proprotor.typing import Array

_GRAVITY = 9.80665  # m/s²
_STILL = "load_factor: without airspeed there is no pull-up"
_GIMBAL = [coordinates.GIMBAL_1C, coordinates.GIMBAL_1S]
_TILT = (moving.GIMBAL_FLAP, moving.GIMBAL_ROLL)
_ANGLES = [moving.FLAP, moving.LAG, moving.PITCH]


class _TiltedRotor(NamedTuple):
    """A rotor about its periodic trim at n points.

    matrices : mapping of str to array
        M, C, K (n, azimuths, 18, 18) and B (n, azimuths, 18, 6) at equal steps of azimuth of one Nth of a turn.
    trim : Trim
        Of all points, by means around the turn.
    rows : array (n,)
        Places of the points that converged.
    motion : Motion
        Of all points, NaN at those that failed.
    """

    matrices: dict[str, Array]
    trim: Trim
    rows: Array
    motion: Motion

    def mean(self) -> dict[str, Array]:
        """Return M, C, K and B averaged over azimuth."""
        return {name: matrix.mean(axis=1) for name, matrix in self.matrices.items()}


def number_of_blades(rotor: Rotor) -> int:
    """Return the number of blades of a rotor whose trim is periodic; refuse what this trim does not serve."""
    if rotor.cyclic_control_stiffness is not None:
        rule = "must be left out with a shaft angle or a load factor"
        raise InputError("cyclic_control_stiffness", rotor.cyclic_control_stiffness, rule)
    if np.ndim(rotor.n_blades):
        rule = "must be one number with a shaft angle or a load factor"
        raise InputError("n_blades", rotor.n_blades, rule)
    return int(rotor.n_blades)


def tilted_rotor(
    sections: BladeSections,
    settled: Settled,
    options: Options,
    target: Target,
    flight: Mapping[str, Array],
    n_blades: int,
) -> _TiltedRotor:
    """Return a rotor about its periodic trim.

    Parameters
    ----------
    sections : BladeSections
    settled : Settled
        The trim in axial flight, from which the search for the periodic one begins.
    options : Options
    target : Target
    flight : mapping of str to array (points,)
        airspeed, shaft_angle and load_factor.
    n_blades : int
    """
    if sections.beside_axis or has_offset_mass(settled.quantities):
        name = "load_factor" if np.all(np.equal(options.shaft_angle, 0)) else "shaft_angle"
        rule = "goes with blades whose mass and aerodynamic centre lie on the pitch axis"
        raise InputError(name, getattr(options, name), rule)
    rows = settled.rows
    own = {name: value[rows] for name, value in flight.items()}
    load = np.asarray(target.load)
    balance = HarmonicBalance.of(
        sections.take(rows),
        settled.quantities,
        options,
        replace(target, load=load[rows] if load.ndim else load),
        _flight(**own),
        n_blades,
    )
    axial = Trim(**{name: value[rows] for name, value in vars(settled.trim).items()})
    with np.errstate(all="ignore"):
        periodic = periodic_trim(balance, axial)
    trim = _trim(settled, periodic, own)
    good = np.flatnonzero(periodic.reason == "")
    good = good[np.asarray(trim.converged[rows][good], dtype=bool)]
    matrices = {name: matrix[good] for name, matrix in _fixed_frame(balance, periodic).items()}
    return _TiltedRotor(
        matrices, trim, rows[good], _of_all(periodic.motion, good, rows[good], len(trim.reason))
    )


def _of_all(motion: Motion, good: Array, rows: Array, points: int) -> Motion:
    """Return the motion of some points among all points, NaN at the others."""
    parts = {}
    for name, part in vars(motion).items():
        parts[name] = np.full((points, *part.shape[1:]), np.nan, dtype=part.dtype)
        parts[name][rows] = part[good]
    return Motion(**parts)


def _flight(airspeed: Array, shaft_angle: Array, load_factor: Array) -> Flight:
    """Return how a hub flies: up is I, forward K; the hub turns nose up about J."""
    zero = 0 * airspeed
    moving_speed = np.where(np.real(airspeed) > 0, airspeed, np.inf)
    turn = _GRAVITY * (load_factor - 1) / moving_speed
    velocity = np.stack([-airspeed * np.sin(shaft_angle), zero, airspeed * np.cos(shaft_angle)], axis=-1)
    return Flight(velocity, np.stack([zero, turn, zero], axis=-1))


def _trim(settled: Settled, periodic: PeriodicTrim, flight: Mapping[str, Array]) -> Trim:
    """Return the trim of all points by its means around the turn, with reasons and warnings."""
    rows, axial = settled.rows, settled.trim
    still = (np.real(flight["airspeed"]) <= 0) & (np.real(flight["load_factor"]) != 1)
    reason = np.where(still, _STILL, periodic.reason).astype(object)
    failed = reason != ""
    coning, lag, elastic_pitch = np.moveaxis(periodic.motion.angles.mean(axis=1), -1, 0)
    values = {"collective": periodic.motion.collective, "coning": coning, "lag": lag}
    values |= {"elastic_pitch": elastic_pitch, "thrust": periodic.thrust, "torque": periodic.torque}
    found = {name: np.array(value, copy=True) for name, value in vars(axial).items()}
    for name, value in values.items():
        found[name] = found[name].astype(np.result_type(found[name], value))
        found[name][rows] = np.where(failed, np.nan, value)
    notes = zip(axial.warning[rows], periodic.warning, strict=True)
    warning = ["; ".join(dict.fromkeys(filter(None, "; ".join(pair).split("; ")))) for pair in notes]
    found["warning"][rows] = np.where(failed, "", np.array(warning, dtype=object))
    found["reason"][rows], found["converged"][rows] = reason, ~failed
    found["iterations"][rows] += periodic.iterations
    return Trim(**found)


def _fixed_frame(balance: HarmonicBalance, periodic: PeriodicTrim) -> dict[str, Array]:
    """Return M, C, K and B of the rotor at steps of azimuth of one Nth of a turn, of all points of a trim."""
    blade, n_blades = _with_control(balance, periodic.blade), balance.n_blades
    speed = np.broadcast_to(balance.quantities["rotor_speed"], blade.balance.shape[:1])[:, None, None, None]
    count = number_of_azimuths(n_blades)
    around = _transform(periodic, count)
    once = np.einsum("kl,plij->pkij", derivative(count), around)
    twice = np.einsum("kl,plij->pkij", derivative(count), once)
    rows = np.swapaxes(around, -1, -2)
    gusts = np.broadcast_to(_blade_gusts(count), (*blade.gusts.shape[:2], 3, 3))
    swashplate = _blade_swashplate(balance.quantities, len(around), count)
    of_blades = {
        "M": rows @ blade.M @ around,
        "C": rows @ (2 * speed * blade.M @ once + blade.C @ around),
        "K": rows @ (speed**2 * blade.M @ twice + speed * blade.C @ once + blade.K @ around),
        "B": rows @ np.concatenate([swashplate, blade.gusts @ gusts], axis=-1),
    }
    found = {name: _over_blades(matrix, n_blades) for name, matrix in of_blades.items()}
    found["K"][..., coordinates.AZIMUTH] = 0.0
    return _with_drive(found, balance.quantities)


def _with_control(balance: HarmonicBalance, blade: BladeAround) -> BladeAround:
    """Return a blade with its control system, its pitch damper and its share of the gimbal's spring and damper."""
    C, K = blade.C.copy(), blade.K.copy()

    def of(name: str) -> Array:
        return np.broadcast_to(balance.quantities[name], K.shape[:1])[:, None]

    C[..., moving.PITCH, moving.PITCH] += of("pitch_damping")
    K[..., moving.PITCH, moving.PITCH] += of("control_stiffness")
    damper = of("gimbal_damping") / balance.n_blades
    for place in _TILT:
        C[..., place, place] += damper
        K[..., place, place] += of("gimbal_stiffness") / balance.n_blades
    flap, roll = _TILT  # the damper does not turn: it feels the tilt that the blade sees turning
    K[..., flap, roll] -= damper * of("rotor_speed")
    K[..., roll, flap] += damper * of("rotor_speed")
    return blade._replace(C=C, K=K)


def _transform(periodic: PeriodicTrim, count: int) -> Array:
    """Return the coordinates of a blade by those of the rotor (points, azimuths, 12, 18).

    The azimuth carries the swing of blade and gimbal with it.
    """
    plain = coordinates.transform(psi=azimuths(count))
    motion = periodic.motion
    around = np.repeat(plain[None], len(motion.angles), axis=0).astype(motion.angles.dtype)
    around[..., _ANGLES, coordinates.AZIMUTH] += derivative(count) @ motion.angles
    tilting = derivative(count) @ motion.tilt
    around[..., coordinates.AZIMUTH] += np.einsum("kij,pkj->pki", plain[..., _GIMBAL], tilting)
    return around


def _blade_gusts(count: int) -> Array:
    """Return the gusts along the blade's axes by those of the fixed frame, (azimuths, 3, 3)."""
    whole = coordinates.transform(psi=azimuths(count))
    hub = [place for place, coordinate in enumerate(BLADE) if coordinate.angle == "hub"]
    return np.asarray(whole[..., hub, : len(hub)])


def _over_blades(matrix: Array, n_blades: int) -> Array:
    """Return the sum over the blades (points, azimuths / N, ...) of what one blade adds at each azimuth."""
    points, count = matrix.shape[:2]
    parts = matrix.reshape(points, n_blades, count // n_blades, *matrix.shape[2:])
    return np.asarray(parts.sum(axis=1))


def _blade_swashplate(quantities: Mapping[str, Any], points: int, count: int) -> Array:
    """Return the loads on a blade by collective and cyclics, which pull at its pitch (points, azimuths, 12, 3)."""
    stiffness, damping, speed = (
        np.broadcast_to(quantities[name], points)[:, None]
        for name in ("control_stiffness", "pitch_damping", "rotor_speed")
    )
    loads = np.zeros((points, count, moving.VALUE, 3), dtype=np.result_type(stiffness, damping, speed))
    for place, wave in enumerate(harmonics(count, 1).T):
        loads[..., moving.PITCH, place] = stiffness * wave + damping * speed * (derivative(count) @ wave)
    return loads


def _with_drive(found: dict[str, Array], quantities: Mapping[str, Any]) -> dict[str, Array]:
    """Return the matrices with the drive train's."""
    given = dict.fromkeys(("drive_inertia", "drive_damping", "shaft_stiffness"), 0.0) | dict(quantities)
    whole = dict(found)
    for name, function in (("M", drive_train.mass), ("C", drive_train.damping), ("K", drive_train.stiffness)):
        matrix = evaluate(function, given)
        whole[name] = whole[name] + (matrix[:, None] if matrix.ndim == 3 else matrix)
    return whole
