"""One blade about a trim that moves: its balance and its matrices at equal steps of azimuth.

`derive/moving.py` has the derivation. All vectors are along the blade's rotating axes, arrays (points, azimuths, ...);
the rate of a vector in inertial axes is its derivative around the turn and the cross product with the axes' own speed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from proprotor_equations import airloads, moving
from proprotor_equations.coordinates import SEGMENT_LOADS, SEGMENT_MOTIONS

from proprotor.rotor.around_the_turn import along_blade, derivative
from proprotor.rotor.generated import evaluate
from proprotor.rotor.options import Options
from proprotor.rotor.section_loads import BladeSections, load_moments
from proprotor.rotor.trim import blade_pitch, springs
from proprotor.typing import Array

_N = moving.VALUE  # coordinates of a blade; the next column of a geometry has the value itself
_HUB, _TURN = slice(0, 3), slice(3, 6)
_SPRUNG = [moving.FLAP, moving.LAG, moving.PITCH]
_SENSE = np.array([-1.0, 1.0, 1.0])  # of the air along i', n and d, by a section's own velocity
_MOTIONS = [place for place, motion in enumerate(SEGMENT_MOTIONS) if motion.axis]
_SPIN, _THETA = (
    next(place for place, motion in enumerate(SEGMENT_MOTIONS) if motion.argument == name)
    for name in ("spin", "theta")
)
_X, _NORMAL = 0, 1  # of the axes of a section


class Flight(NamedTuple):
    """How the rotor flies, in the fixed frame of the hub, (points, 3).

    velocity : of the hub, m/s; turn : speed at which the hub's axes turn, rad/s.
    """

    velocity: Array
    turn: Array


@dataclass(frozen=True)
class Motion:
    """A trim that moves: what the blade at each azimuth does.

    Attributes
    ----------
    angles : array (points, azimuths, 3)
        Flap, lag and elastic pitch of the blade, rad.
    tilt : array (points, azimuths, 2)
        Gimbal tilt β_GC and β_GS in the fixed frame while the blade is at the azimuth, rad.
    cyclic : array (points, 2)
        Cyclic pitch of the swashplate, cosine and sine part, rad.
    collective : array (points,)
        rad.
    """

    angles: Array
    tilt: Array
    cyclic: Array
    collective: Array

    @property
    def azimuths(self) -> int:
        """Number of azimuths."""
        return int(self.angles.shape[-2])

    def reshaped(self, shape: tuple[int, ...]) -> Motion:
        """Return the motion with the axes of a batch in place of the points."""
        parts = {"angles": 2, "tilt": 2, "cyclic": 1, "collective": 0}
        return Motion(
            **{
                name: (value := getattr(self, name)).reshape((*shape, *value.shape[value.ndim - own :]))
                for name, own in parts.items()
            }
        )


class BladeAround(NamedTuple):
    """Balance and matrices of a blade around the turn, SI.

    balance : array (points, azimuths, 12)
        Left-hand side of the blade's equations along the trim.
    work : array (points, azimuths, 12)
        Virtual work of the airloads, which the balance has with a minus.
    M, C, K : array (points, azimuths, 12, 12)
        Without control system, pitch damper and gimbal.
    gusts : array (points, azimuths, 12, 3)
        Loads of gusts along the blade's axes, on the right.
    doubts : mapping of str to array of bool (points,)
        Reasons to doubt the airfoil's coefficients somewhere around the turn.
    """

    balance: Array
    work: Array
    M: Array
    C: Array
    K: Array
    gusts: Array
    doubts: Mapping[str, Array]


def blade_around(
    sections: BladeSections, quantities: Mapping[str, Any], options: Options, flight: Flight, motion: Motion
) -> BladeAround:
    """Return balance and matrices of one blade along a trim that moves.

    Parameters
    ----------
    sections : BladeSections
    quantities : mapping
        Of rotor, operation and airspeed, numbers or arrays (points,).
    options : Options
    flight : Flight
    motion : Motion
    """
    return _Around.of(sections, quantities, options, flight, motion).blade()


@dataclass(frozen=True)
class _Around:
    """What the parts of a blade's equations have in common, arrays of all points and azimuths.

    given : quantities of the blade at each azimuth of each point, (points × azimuths,).
    speed : speed of the blade's axes (points, azimuths, 3).
    points : position per unit of the four arms, (points, azimuths, arm, coordinate or value, 3).
    rates : the rates of these, with the velocity of the hub.
    pitch : pitch to shaft and yoke, (points, azimuths, 2, coordinate or value).
    """

    sections: BladeSections
    options: Options
    given: dict[str, Any]
    shape: tuple[int, int]
    rotor_speed: Array
    speed: Array
    points: Array
    rates: Array
    pitch: Array

    @classmethod
    def of(
        cls,
        sections: BladeSections,
        quantities: Mapping[str, Any],
        options: Options,
        flight: Flight,
        motion: Motion,
    ) -> _Around:
        shape = motion.angles.shape[:2]
        given = _at_each_azimuth(quantities, motion)
        rotor_speed = np.broadcast_to(quantities["rotor_speed"], shape[:1])
        speed = along_blade(flight.turn, shape[1]) + rotor_speed[:, None, None] * np.array([0.0, 0.0, 1.0])
        pitch = evaluate(moving.pitch_of_blade, given).reshape(*shape, 2, -1)
        own = pitch[..., moving.YOKE, _N].reshape(-1)
        given |= {"pitch": own, "structural_pitch": own + given["structural_pitch_offset"]}
        given |= springs(options, given)
        points = _points(given, shape)
        around = cls(sections, options, given, shape, rotor_speed, speed, points, points, pitch)
        rates = around.rate(points)
        rates[:, :, -1, _N] += along_blade(flight.velocity, shape[1])
        return replace(around, rates=rates)

    def rate(self, vectors: Array) -> Array:
        """Return the rate in inertial axes of vectors (points, azimuths, ..., 3) along the blade's axes."""
        speed = self.speed.reshape(*self.shape, *(1,) * (vectors.ndim - 3), 3)
        return np.asarray(self.rate_of_number(vectors) + np.cross(speed, vectors))

    def rate_of_number(self, numbers: Array) -> Array:
        """Return the rate of numbers (points, azimuths, ...)."""
        flat = numbers.reshape(*self.shape, -1)
        changed = self.rotor_speed[:, None, None] * (derivative(self.shape[1]) @ flat)
        return np.asarray(changed.reshape(numbers.shape))

    def around(self, values: Any, own: int = 0) -> Array:
        """Return flattened values with `own` axes of their own, with an axis each for points and azimuths."""
        values = np.asarray(values)
        shape = values.shape[values.ndim - own :]
        whole = np.broadcast_to(values, (self.shape[0] * self.shape[1], *shape))
        return whole.reshape(*self.shape, *shape)

    def of_segments(self, values: Any, own: int = 0) -> Array:
        """Return flattened values of each segment, with an axis each for points, azimuths and segments."""
        values = np.asarray(values)
        shape = (len(self.sections.quadrature.beyond_lag_hinge), *values.shape[values.ndim - own :])
        whole = np.broadcast_to(values, (self.shape[0] * self.shape[1], *shape))
        return whole.reshape(*self.shape, *shape)

    def blade(self) -> BladeAround:
        """Return balance and matrices."""
        virtual = self.virtual_displacements()
        M, C, K, balance, forces = self.of_masses(virtual)
        self.add_pitch(M, C, K, balance)
        doubts: dict[str, Array] = {}
        damping, stiffness, work, air_forces = self.of_airloads(virtual, doubts)
        C, K, balance = C + damping, K + stiffness, balance - work
        K = K + self.of_forces(forces - air_forces)
        return BladeAround(balance, work, M, C, K, damping[..., _HUB], doubts)

    def virtual_displacements(self) -> Array:
        """Return virtual displacements (points, azimuths, arm, coordinate, 3); hub rotations are about fixed axes."""
        virtual = self.points[..., :_N, :].copy()
        for place in range(3):
            axis = np.eye(3)[place]
            virtual[..., _TURN.start + place, :] = np.cross(axis, self.points[..., _N, :])
        return virtual

    def of_masses(self, virtual: Array) -> tuple[Array, Array, Array, Array, Array]:
        """Return M, C, K and balance of the inertia forces, and these forces times the arms."""
        inertia = self.around(evaluate(moving.arm_inertia, self.given), 2)
        accelerations = self.rate(self.rates)
        by_mass = [_joined(inertia, part) for part in (self.points, self.rates, accelerations)]
        rows = _rows(virtual)
        M, C, K = (rows @ _columns(part) for part in by_mass)
        balance = K[..., _N]
        return M[..., :_N], 2 * C[..., :_N], K[..., :_N], balance, by_mass[2][..., _N, :]

    def add_pitch(self, M: Array, C: Array, K: Array, balance: Array) -> None:
        """Add lumped pitch inertia, springs, propeller moment and dampers of flap and lag."""
        inertia = self.around(self.given["pitch_inertia"])[..., None, None]
        shaft = self.pitch[..., moving.SHAFT, :]
        rate = self.rate_of_number(shaft)
        acceleration = self.rate_of_number(rate)
        row = shaft[..., :_N, None] * inertia
        M += row * shaft[..., None, :_N]
        C += 2 * row * rate[..., None, :_N]
        K += row * acceleration[..., None, :_N]
        balance += row[..., 0] * acceleration[..., _N, None]
        moment = self.around(evaluate(moving.spring_moment, self.given)[..., moving.TRIM], 1)[..., _SPRUNG]
        stiffness = self.around(evaluate(moving.spring_stiffness, self.given), 2)[..., _SPRUNG, :][
            ..., _SPRUNG
        ]
        angles = np.zeros((*self.shape, len(_SPRUNG), _N), dtype=shaft.dtype)
        angles[..., 0, moving.FLAP] = angles[..., 1, moving.LAG] = 1.0
        angles[..., 2, :] = self.pitch[..., moving.YOKE, :_N]
        K += np.swapaxes(angles, -1, -2) @ stiffness @ angles
        balance += np.einsum("...ai,...a->...i", angles, moment)
        steady = {
            "shaft_pitch_moment": (inertia[..., 0, 0] * acceleration[..., _N]).reshape(-1),
            "yoke_pitch_moment": moment[..., 2].reshape(-1),
        }
        K += self.around(evaluate(moving.pitch_stiffness, self.given | steady), 2)
        for name, place in (("flap", moving.FLAP), ("lag", moving.LAG)):
            damper = self.around(self.given[f"{name}_damping"])
            C[..., place, place] += damper
            angle = self.around(self.given["coning" if name == "flap" else name])
            balance[..., place] += damper * self.rate_of_number(angle)

    def of_forces(self, forces: Array) -> Array:
        """Return the work of steady forces times arms, (points, azimuths, arm, 3), on displacements of second order."""
        named = {
            f"{arm}_force_{axis}": forces[..., place, component].reshape(-1)
            for place, arm in enumerate(("inboard", "outboard", "lag"))
            for component, axis in enumerate("ijk")
        }
        return self.around(evaluate(moving.force_stiffness, self.given | named), 2)

    def of_airloads(self, virtual: Array, doubts: dict[str, Array]) -> tuple[Array, Array, Array, Array]:
        """Return damping, stiffness and work of the airloads, and the forces of the air times the arms."""
        air = _Air.of(self, virtual)
        return air.loads(doubts)


@dataclass(frozen=True)
class _Air:
    """Segments of the blade in the air, arrays (points, azimuths, segment, ...).

    segments : quantities of the segments, flattened over points and azimuths.
    arms : arms of the four points at r = 0 and per radius (points, azimuths, segment, 2, 4).
    axes : i', n and d, (points, azimuths, segment, axis, coordinate or value, 3), and `turning` their rates.
    points, rates, virtual : of the segment's line at r = 0 and per radius, (..., segment, 2, coordinate or value, 3).
    """

    blade: _Around
    segments: dict[str, Any]
    arms: Array
    axes: Array
    turning: Array
    points: Array
    rates: Array
    virtual: Array

    @classmethod
    def of(cls, blade: _Around, virtual: Array) -> _Air:
        segments = {
            name: value[:, None] if np.ndim(value) else value for name, value in blade.given.items()
        } | blade.sections.sides
        segments |= evaluate(moving.section_angles, segments)._asdict()
        axes = blade.of_segments(evaluate(moving.axes, segments), 2)
        axes = axes.reshape(*axes.shape[:3], 3, 3, _N + 1).swapaxes(-1, -2)
        arms = blade.of_segments(evaluate(moving.arms_of_segment, segments), 2)
        lines = [
            np.einsum("pnsba,pnajx->pnsbjx", arms, part) for part in (blade.points, blade.rates, virtual)
        ]
        return cls(blade, segments, arms, axes, blade.rate(axes), *lines)

    def loads(self, doubts: dict[str, Array]) -> tuple[Array, Array, Array, Array]:
        """Return damping, stiffness and work of the airloads, and the forces of the air times the arms."""
        blade, direction = self.blade, self.axes[..., _N, :]
        segments = self.segments | self._trim()
        found = load_moments(
            _repeated(blade.sections, blade.shape),
            segments,
            compressibility=blade.options.compressibility,
            equations=moving,
            doubts=doubts,
        )
        for name in doubts:
            doubts[name] = np.asarray(doubts[name].reshape(blade.shape).any(axis=1))
        segments |= found
        derivatives = blade.of_segments(evaluate(airloads.load_derivatives, segments), 2)
        steady = blade.of_segments(evaluate(airloads.steady_loads, segments)[..., airloads.TRIM], 1)
        rotation = blade.of_segments(evaluate(moving.rotation_of_section, segments), 2)[..., 0, :]
        motion, rates, changes = self._motions(rotation)
        left = np.swapaxes(motion, -1, -2) @ derivatives
        damping = -(left @ rates).sum(axis=2)
        stiffness = -(left @ changes).sum(axis=2)
        work = np.einsum("pnsli,pnsl->pni", motion, steady)
        of_forces = steady[..., : len(SEGMENT_LOADS) - 1].reshape(*steady.shape[:-1], 2, 3)
        stiffness -= np.einsum(
            "pnsbix,pnsajx,pnsba->pnij", self.virtual, self.axes[..., :_N, :], of_forces, optimize=True
        )
        stiffness -= self._of_moments(segments)
        force = np.einsum("pnsba,pnsax->pnsbx", of_forces, direction)
        return damping, stiffness, work, np.einsum("pnsba,pnsbx->pnax", self.arms, force)

    def _trim(self) -> dict[str, Array]:
        """Return velocity, rotation and chordwise axis of the sections along the trim."""
        blade, flat = self.blade, (self.blade.shape[0] * self.blade.shape[1], -1)
        value = self.axes[..., _N, :]
        named = {
            f"point_velocity_{axis}_{power}": self.rates[..., power, _N, component].reshape(flat)
            for power in range(2)
            for component, axis in enumerate("ijk")
        }
        turning = (self.turning[..., _NORMAL, _N, :] * value[..., _X, :]).sum(axis=-1)
        yoke = blade.rate_of_number(blade.pitch[..., moving.YOKE, _N])[..., None]
        named |= {
            f"chordwise_{axis}": value[..., _X, place].reshape(flat) for place, axis in enumerate("ijk")
        }
        return named | {"trim_spin": (turning + yoke).reshape(flat)}

    def _motions(self, rotation: Array) -> tuple[Array, Array, Array]:
        """Return virtual motions W, and motions U of the air by rates and by displacements, of each segment."""
        blade, value = self.blade, self.axes[..., _N, :]
        shape = (*rotation.shape[:3], -1, _N)
        along = np.einsum("pnsax,pnsbix->pnsbai", value, self.virtual).reshape(shape)
        motion = np.concatenate([along, rotation[..., None, :]], axis=-2)
        rates = np.zeros((*rotation.shape[:3], len(SEGMENT_MOTIONS), _N), dtype=motion.dtype)
        changes = np.zeros_like(rates)
        sense = _SENSE[:, None]
        moved = np.einsum("pnsax,pnsbjx->pnsbaj", value, self.points[..., :_N, :])
        rates[..., _MOTIONS, :] = (sense * moved).reshape(shape)
        rates[..., _SPIN, :] = rotation
        moved = np.einsum("pnsax,pnsbjx->pnsbaj", value, self.rates[..., :_N, :])
        moved = moved + np.einsum("pnsajx,pnsbx->pnsbaj", self.axes[..., :_N, :], self.rates[..., _N, :])
        changes[..., _MOTIONS, :] = (sense * moved).reshape(shape)
        yoke = blade.pitch[..., moving.YOKE, :]
        turned = np.einsum("pnsjx,pnsx->pnsj", self.turning[..., _NORMAL, :_N, :], value[..., _X, :])
        turned = turned + np.einsum(
            "pnsx,pnsjx->pnsj", self.turning[..., _NORMAL, _N, :], self.axes[..., _X, :_N, :]
        )
        changes[..., _SPIN, :] = turned + blade.rate_of_number(yoke)[:, :, None, :_N]
        changes[..., _THETA, :] = yoke[:, :, None, :_N]
        return motion, rates, changes

    def _of_moments(self, segments: Mapping[str, Any]) -> Array:
        """Return the work of the steady pitching moments on rotations of second order, of all segments."""
        total = self.blade.of_segments(evaluate(moving.moment_stiffness, segments), 2).sum(axis=2)
        turned = np.einsum("pnsix,pnsjx->pnsij", self.axes[..., _NORMAL, :_N, :], self.axes[..., _X, :_N, :])
        turned[..., _TURN, :] = 0.0  # moments about fixed axes
        moment = self.blade.of_segments(segments["m_0"])
        return np.asarray(total + np.einsum("pnsij,pns->pnij", turned, moment))


def _at_each_azimuth(quantities: Mapping[str, Any], motion: Motion) -> dict[str, Any]:
    """Return the quantities of the blade at all azimuths of all points, flattened."""
    count = motion.azimuths
    given = {name: np.repeat(value, count) if np.ndim(value) else value for name, value in quantities.items()}
    tilt = np.stack([motion.tilt[..., 1], -motion.tilt[..., 0]], axis=-1)
    swashplate = np.stack([motion.cyclic[:, 1], -motion.cyclic[:, 0], 0 * motion.cyclic[:, 0]], axis=-1)
    axes = along_blade(np.eye(3), count)  # (vector, azimuth, component)
    seen = np.einsum("pnv,vnx->pnx", tilt, axes[:2])
    swung = along_blade(swashplate, count)
    state = {
        "collective": np.repeat(motion.collective, count),
        "coning": motion.angles[..., 0],
        "lag": motion.angles[..., 1],
        "elastic_pitch": motion.angles[..., 2],
        "trim_gimbal_flap": seen[..., 0],
        "trim_gimbal_roll": seen[..., 1],
        "trim_cyclic": swung[..., 0],
        "trim_cyclic_slope": swung[..., 1],
    }
    given |= {name: value.reshape(-1) for name, value in state.items()}
    given["pitch"] = blade_pitch(given, given)
    given |= evaluate(moving.blade_angles, given)._asdict()
    given |= evaluate(moving.tilt_of_yoke, given)._asdict()
    return given


def _points(given: Mapping[str, Any], shape: tuple[int, int]) -> Array:
    """Return positions per unit of each arm, the hub's own last, (points, azimuths, 4, coordinate or value, 3)."""
    found = evaluate(moving.points, given).reshape(*shape, 3, 3, _N + 1).swapaxes(-1, -2)
    hub = np.zeros((*shape, 1, _N + 1, 3), dtype=found.dtype)
    hub[..., range(3), range(3)] = 1.0
    return np.concatenate([found, hub], axis=2)


def _joined(inertia: Array, vectors: Array) -> Array:
    """Return the mass times an arm, integrated, of vectors (points, azimuths, arm, column, 3) per unit of an arm."""
    return np.asarray(np.einsum("pnab,pnbjx->pnajx", inertia, vectors))


def _rows(vectors: Array) -> Array:
    """Return vectors (points, azimuths, arm, row, 3) as rows of a product over arms and components."""
    return np.moveaxis(vectors, 3, 2).reshape(*vectors.shape[:2], vectors.shape[3], -1)


def _columns(vectors: Array) -> Array:
    """Return vectors (points, azimuths, arm, column, 3) as columns of a product over arms and components."""
    return np.swapaxes(_rows(vectors), -1, -2)


def _repeated(sections: BladeSections, shape: tuple[int, int]) -> BladeSections:
    """Return the sections of each point at each azimuth."""
    return sections.take(np.repeat(np.arange(shape[0]), shape[1]))
