"""Periodic trim by harmonic balance: a blade and a gimbal that swing once a turn, in a rotor that flies at an angle.

The blade's angles are sums of harmonics, the gimbal's tilt has the harmonics that the blades have in common. Newton's
method takes its slopes from the same matrices as the equations of motion: a small change q(ψ) of the trim changes the
balance by M q'' + C q' + K q.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from proprotor_equations import coordinates, moving

from proprotor.rotor.around_the_turn import azimuths, derivative, harmonics, number_of_azimuths
from proprotor.rotor.moving_blade import BladeAround, Flight, Motion, blade_around
from proprotor.rotor.options import Options
from proprotor.rotor.section_loads import BladeSections
from proprotor.rotor.trim import TORQUE, Target, Trim
from proprotor.rotor.trim_balance import is_last
from proprotor.rotor.trim_reasons import LARGEST_ANGLE
from proprotor.typing import Array

_HIGHEST = 8  # harmonic of the blade's angles
_ITERATIONS = 20
_LARGEST_STEP = 0.2  # rad
_ANGLES = (("coning", moving.FLAP), ("lag", moving.LAG), ("elastic_pitch", moving.PITCH))
_TILTS = (coordinates.GIMBAL_1C, coordinates.GIMBAL_1S)
_CUT = 1e-4  # rad, of the highest harmonic that is kept
_NOT_FOUND = "no periodic trim found near the trim in axial flight: Newton did not converge"


class PeriodicTrim(NamedTuple):
    """A trim that moves, of n points.

    motion : what the blade at each azimuth does.
    blade : balance and matrices of a blade along the trim.
    thrust, torque : arrays (n,) of the mean loads of the airloads on the whole rotor, N and N m.
    reason, warning : arrays of str (n,), why a point failed or is doubtful.
    iterations : array of int (n,)
    """

    motion: Motion
    blade: BladeAround
    thrust: Array
    torque: Array
    reason: Array
    warning: Array
    iterations: Array


class _Unknown(NamedTuple):
    """One number of the trim: the motion of the blade that it stands for, and the balance that it closes.

    motion : array (azimuths, 12)
        Change of the blade's coordinates per unit.
    row : array (azimuths, 12)
        Weight of the blade's balance.
    swashplate : bool
        Whether the motion is one of the swashplate, which loads neither the control system nor the pitch damper.
    part, place, wave : str, int, array (azimuths,)
        What the number changes in a `Motion`.
    """

    motion: Array
    row: Array
    swashplate: bool
    part: str
    place: int
    wave: Array


@dataclass(frozen=True)
class HarmonicBalance:
    """Harmonic balance of a rotor at some points: inputs and unknowns."""

    sections: BladeSections
    quantities: Mapping[str, Any]
    options: Options
    target: Target
    flight: Flight
    n_blades: int
    unknowns: tuple[_Unknown, ...]

    @classmethod
    def of(
        cls,
        sections: BladeSections,
        quantities: Mapping[str, Any],
        options: Options,
        target: Target,
        flight: Flight,
        n_blades: int,
    ) -> HarmonicBalance:
        """Return the balance with the unknowns that the options leave free."""
        unknowns = _unknowns(options, target, n_blades)
        return cls(sections, quantities, options, target, flight, n_blades, unknowns)

    def blade(self, motion: Motion) -> BladeAround:
        """Return balance and matrices of a blade along a motion."""
        return blade_around(self.sections, self.quantities, self.options, self.flight, motion)

    def step(self, motion: Motion, blade: BladeAround) -> Array:
        """Return Newton's step (points, unknowns) to subtract."""
        rotor_speed = np.broadcast_to(self.quantities["rotor_speed"], blade.balance.shape[:1])[:, None, None]
        count = motion.azimuths
        moved = np.stack([unknown.motion for unknown in self.unknowns], axis=-1)
        rows = np.stack([unknown.row for unknown in self.unknowns])
        once = np.einsum("kl,liu->kiu", derivative(count), moved)
        twice = np.einsum("kl,liu->kiu", derivative(count), once)
        speed = rotor_speed[..., None]
        changed = speed**2 * (blade.M @ twice) + speed * (blade.C @ once) + blade.K @ moved
        flat = rows.reshape(len(rows), -1)
        slopes = flat @ changed.reshape(len(changed), flat.shape[1], -1) / count
        residual = blade.balance.reshape(len(changed), -1) @ flat.T / count
        springs, loads = self._held(motion, rotor_speed[:, 0, 0])
        residual = residual + loads
        slopes = slopes + springs
        for place, unknown in enumerate(self.unknowns):
            if unknown.part == "collective":
                residual[:, place] += np.asarray(self.target.load)
        return _solved(slopes, residual)

    def advancing_mach(self) -> Array:
        """Return the Mach number (points,) of the blade tips where they advance into the air."""
        names = ("rotor_speed", "radius", "speed_of_sound")
        rotor_speed, radius, sound = (np.real(self.quantities[name]) for name in names)
        velocity = np.real(self.flight.velocity)
        across = np.hypot(velocity[:, 0], velocity[:, 1]) + rotor_speed * radius
        return np.asarray(np.hypot(across, velocity[:, 2]) / sound)

    def _held(self, motion: Motion, rotor_speed: Array) -> tuple[Array, Array]:
        """Return slopes and loads of control system, pitch damper and gimbal."""
        count, rate = motion.azimuths, derivative(motion.azimuths)
        waves = np.stack([unknown.wave for unknown in self.unknowns])
        kinds = [(unknown.part, unknown.place) for unknown in self.unknowns]
        alike = np.array([[one == other for other in kinds] for one in kinds])
        shape = (len(rotor_speed), len(waves))
        held = [self._spring_and_damper(unknown) for unknown in self.unknowns]
        springs, dampers = (
            np.stack([np.broadcast_to(part[place], shape[:1]) for part in held], axis=-1)
            for place in range(2)
        )
        dampers = dampers * rotor_speed[:, None]
        slopes = springs[..., None] * (alike * (waves @ waves.T)) / count
        slopes = slopes + dampers[..., None] * (alike * (waves @ rate @ waves.T)) / count
        loads = np.zeros(shape, dtype=np.result_type(slopes, motion.angles))
        for i, (part, place) in enumerate(kinds):
            if part in ("angles", "tilt"):
                values = getattr(motion, part)[..., place]
                loads[:, i] = springs[:, i] * (values @ waves[i]) + dampers[:, i] * (
                    values @ rate.T @ waves[i]
                )
        return slopes, loads / count

    def _spring_and_damper(self, unknown: _Unknown) -> tuple[Array, Array]:
        """Return what holds one motion of a blade, or of the gimbal by one blade's share, (points,) or ()."""
        q = {name: np.asarray(value) for name, value in self.quantities.items()}
        none = np.asarray(0.0)
        if unknown.part == "tilt":
            return q["gimbal_stiffness"] / self.n_blades, q["gimbal_damping"] / self.n_blades
        if unknown.part == "angles" and unknown.place == _PITCH:
            return q["control_stiffness"], q["pitch_damping"]
        return none, none

    def moved(self, motion: Motion, step: Array) -> Motion:
        """Return a motion less a step (points, unknowns)."""
        parts = {name: getattr(motion, name).copy() for name in ("angles", "tilt", "cyclic", "collective")}
        for place, unknown in enumerate(self.unknowns):
            amount = step[:, place]
            if unknown.part == "collective":
                parts["collective"] -= amount
            elif unknown.part == "cyclic":
                parts["cyclic"][:, unknown.place] -= amount
            else:
                parts[unknown.part][..., unknown.place] -= amount[:, None] * unknown.wave
        return Motion(**parts)


_PITCH = [name for name, _ in _ANGLES].index("elastic_pitch")


def _unknowns(options: Options, target: Target, n_blades: int) -> tuple[_Unknown, ...]:
    """Return the unknowns of the trim, each with the balance that closes it."""
    count = number_of_azimuths(n_blades)
    free = {"coning": "flap" not in options.locked, "lag": "lag" not in options.locked}
    free["elastic_pitch"] = options.pitch_is_free
    found = []
    unit = np.eye(moving.VALUE)
    for place, (name, coordinate) in enumerate(_ANGLES):
        for wave in harmonics(count, _HIGHEST).T if free[name] else ():
            moved = wave[:, None] * unit[coordinate]
            found.append(_Unknown(moved, moved, False, "angles", place, wave))
    if "gimbal" not in options.locked:
        seen = coordinates.transform(psi=azimuths(count))[..., _TILTS]
        for place in range(2):
            for wave in harmonics(count, _HIGHEST, n_blades).T:
                moved = wave[:, None] * seen[..., place]
                found.append(_Unknown(moved, moved, False, "tilt", place, wave))
    if options.cyclic == "level":
        found = _levelled(found, options)
    if target.finds_collective:
        coordinate = moving.AZIMUTH if target.row == TORQUE else moving.HUB_K
        wave = np.ones(count)
        pitch, row = (wave[:, None] * unit[place] for place in (moving.PITCH, coordinate))
        found.append(_Unknown(pitch, row, True, "collective", 0, wave))
    return tuple(found)


def _levelled(unknowns: list[_Unknown], options: Options) -> list[_Unknown]:
    """Return unknowns with cyclic pitch of the swashplate in place of the steady tilt, or of flapping once a turn."""
    waves = harmonics(len(unknowns[0].wave), 1).T[1:]
    pitch = np.eye(moving.VALUE)[moving.PITCH]
    found = []
    for unknown in unknowns:
        level = unknown.part == "tilt" and np.ptp(unknown.wave) == 0
        place = unknown.place
        if "gimbal" in options.locked and unknown.part == "angles" and unknown.place == 0:
            alike = [number for number, wave in enumerate(waves) if np.array_equal(wave, unknown.wave)]
            level, place = bool(alike), alike[0] if alike else 0
        if level:
            wave = waves[place]
            unknown = _Unknown(wave[:, None] * pitch, unknown.row, True, "cyclic", place, wave)
        found.append(unknown)
    return found


def periodic_trim(balance: HarmonicBalance, axial: Trim) -> PeriodicTrim:
    """Return the periodic trim near a trim in axial flight.

    Parameters
    ----------
    balance : HarmonicBalance
    axial : Trim
        Of n points that have converged.
    """
    motion = _steady(axial, balance.n_blades)
    points = len(motion.collective)
    converged, iterations = np.zeros(points, dtype=bool), np.zeros(points, dtype=int)
    before = np.full(points, np.inf)
    for _ in range(_ITERATIONS):
        blade = balance.blade(motion)
        step = _bounded(balance.step(motion, blade)) if balance.unknowns else np.zeros((points, 0))
        size = np.abs(step).max(axis=1, initial=0.0)
        converged |= is_last(size, before)
        before = size
        motion = balance.moved(motion, step)
        iterations += ~converged
        if (converged | np.isnan(size)).all():
            break
    blade = balance.blade(motion)
    loads = blade.work.mean(axis=1) * balance.n_blades
    warning = _warnings(balance, motion, blade.doubts)
    return PeriodicTrim(
        motion,
        blade,
        loads[:, moving.HUB_K],
        loads[:, moving.AZIMUTH],
        _reasons(balance, converged & np.isfinite(before)),
        warning,
        iterations + 1,
    )


def _solved(slopes: Array, residual: Array) -> Array:
    """Return the solution (points, k) of linear equations; NaN at points whose slopes have no inverse."""
    try:
        return np.asarray(np.linalg.solve(slopes, residual[..., None])[..., 0])
    except np.linalg.LinAlgError:
        found = np.full_like(residual, np.nan)
        for point, slope in enumerate(slopes):
            if np.linalg.matrix_rank(slope) == len(slope):
                found[point] = np.linalg.solve(slope, residual[point])
        return found


def _reasons(balance: HarmonicBalance, converged: Array) -> Array:
    """Return why each point (points,) has no periodic trim, empty where it has one."""
    reason = np.where(converged, "", _NOT_FOUND).astype(object)
    options, airfoil = balance.options, balance.sections.airfoil
    if options.compressibility and not airfoil.contains_compressibility:
        mach = balance.advancing_mach()
        for place in np.flatnonzero(mach >= 1):
            reason[place] = (
                f"tip Mach number {mach[place]:.3f} where the blade advances: Prandtl-Glauert needs it below 1"
            )
    return reason


def _bounded(step: Array) -> Array:
    """Return a step (points, unknowns) no larger than Newton is trusted with."""
    if np.iscomplexobj(step):
        return step
    return np.clip(step, -_LARGEST_STEP, _LARGEST_STEP)


def _steady(axial: Trim, n_blades: int) -> Motion:
    """Return a trim in axial flight as a motion."""
    count = number_of_azimuths(n_blades)
    angles = np.stack([getattr(axial, name) for name, _ in _ANGLES], axis=-1)
    still = np.zeros((len(angles), 2), dtype=angles.dtype)
    around = np.ones((1, count, 1))
    return Motion(angles[:, None] * around, still[:, None] * around, still, axial.collective.copy())


def _warnings(balance: HarmonicBalance, motion: Motion, doubts: Mapping[str, Array]) -> Array:
    """Return what makes the trim of each point doubtful, empty where nothing does."""
    limit = f"{np.degrees(LARGEST_ANGLE):.0f} deg"
    largest = np.abs(np.real(motion.angles)).max(axis=1)
    masks = {
        f"{name.replace('_', ' ')} beyond {limit} on the way round, where rigid hinges are no model": largest[
            :, place
        ]
        > LARGEST_ANGLE
        for place, (name, _) in enumerate(_ANGLES)
    }
    waves = harmonics(motion.azimuths, _HIGHEST)[:, -2:]
    highest = np.abs(np.einsum("pka,kw->paw", np.real(motion.angles), waves)).max(axis=(1, 2))
    masks["the blades move in more harmonics than the trim has"] = highest * 2 / motion.azimuths > _CUT
    masks |= doubts
    found = np.full(len(largest), "", dtype=object)
    for place in range(len(found)):
        found[place] = "; ".join(text for text, mask in masks.items() if mask[place])
    return found
