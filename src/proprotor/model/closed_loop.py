"""Close control loops around a model: its sensors move its inputs, through laws, delays and actuators.

A sensor is a row over displacements, rates and accelerations of the coordinates, and so is everything that follows
from it. The commands therefore enter M, C and K, and acceleration feedback needs no inverse of M: with u = a q̈ + v q̇ +
d q, M q̈ + C q̇ + K q = B u becomes (M - B a) q̈ + (C - B v) q̇ + (K - B d) q = 0. States of laws are rates of
coordinates without stiffness, as those of lift that lags; actuators of second order and sections of delays are
coordinates with mass, damping and stiffness. So a closed loop is a linear model like any other, with exact derivatives.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from proprotor.control.control_loop import ControlLoop
from proprotor.control.pade import phase_limit, sections
from proprotor.errors import InputError
from proprotor.model.batches import joint_shape
from proprotor.model.linear_model import GUSTS, Feedback, LinearModel
from proprotor.model.massless import massless
from proprotor.model.mount import at_points, broadcast, failed_where, with_warning
from proprotor.model.sensors import Signal, sensor
from proprotor.rotor.motions import HALVES, check_distinct, half_of
from proprotor.typing import Array

_CIRCULAR = (
    "control loops feed accelerations straight back to the loads that make them, which have no solution then: give an "
    "actuator, or a filter in the law"
)


def close_loops(model: LinearModel, loops: Sequence[ControlLoop]) -> LinearModel:
    """Return the model with control loops closed.

    Parameters
    ----------
    model : LinearModel
        With inputs; one point or a batch.
    loops : sequence of ControlLoop

    Returns
    -------
    LinearModel
        With the states of laws, delays and actuators as further coordinates: "damper law", "damper delay", "damper
        actuator". Sensors and inputs are those of the model; its inputs add to what the loops command.

    Raises
    ------
    InputError
        For a sensor or input that the model does not have, two loops of one name, or loops without a solution.
    """
    if not loops:
        return model
    _check_loops(model, loops)
    shape = joint_shape(model.M.shape[:-2], *(loop.shape for loop in loops))
    closing = _Closing(broadcast(model, shape), loops)
    for loop in loops:
        closing.add(loop)
    return _without_circles(closing.model(), model)


def _check_loops(model: LinearModel, loops: Sequence[ControlLoop]) -> None:
    """Refuse loops whose sensors or inputs a model does not have, and loops of one name; see `close_loops`."""
    names = [loop.name for loop in loops]
    known = _control_inputs(model)
    for place, loop in enumerate(loops):
        field = f"control.loops[{loop.name}]"
        if loop.name in names[:place]:
            raise InputError(f"{field}.name", loop.name, "must not be the name of two loops")
        for name in loop.inputs:
            if name not in known:
                rule = f"unknown input; known: {', '.join(known) or 'none'}"
                raise InputError(f"{field}.inputs", name, rule)
        for name in loop.sensors:
            sensor(model, name, f"{field}.sensors")


def taken_apart(
    model: LinearModel, loops: Sequence[ControlLoop]
) -> tuple[tuple[str, ...], tuple[Array, Array, Array]]:
    """Return the coordinates of a closed loop without those of its loops, and what the loops add to M, C and K.

    Parameters
    ----------
    model : LinearModel
        From `close_loops`.
    loops : sequence of ControlLoop
        The same loops.
    """
    own = {name for loop in loops for name, _ in _coordinates(loop)}
    of_loop = np.array([name in own for name in model.dofs])
    assert model.feedback is not None and model.B is not None
    parts = []
    for matrix, command in zip((model.M, model.C, model.K), reversed(model.feedback), strict=True):
        parts.append(np.where(of_loop[:, None], matrix, -(model.B @ command)))
    return tuple(name for name in model.dofs if name not in own), (parts[0], parts[1], parts[2])


def _control_inputs(model: LinearModel) -> tuple[str, ...]:
    """Return the inputs that a control loop may move: all but the gusts."""
    return () if model.B is None else tuple(name for name in model.inputs if half_of(name)[1] not in GUSTS)


class _Closing:
    """Matrices of a model with the coordinates of its loops, to which the loops are added one by one."""

    def __init__(self, model: LinearModel, loops: Sequence[ControlLoop]) -> None:
        self.plant, self.n = model, len(model.dofs)
        self.added = [coordinate for loop in loops for coordinate in _coordinates(loop)]
        self.size, self.next = self.n + len(self.added), self.n
        shape = model.M.shape[:-2]
        # Numbers of loops may be complex while those of the model are real.
        self.parts = [np.zeros((*shape, self.size, self.size), dtype=complex) for _ in range(3)]
        for part, matrix in zip(self.parts, (model.K, model.C, model.M), strict=True):
            part[..., : self.n, : self.n] = matrix
        self.commands = {name: Signal.none(self.size) for name in model.inputs}
        self.warning = np.full(shape, "", dtype=object)
        self.airspeed = np.asarray(model.airspeed)

    def add(self, loop: ControlLoop) -> None:
        """Add the coordinates of a loop, and its commands to the inputs."""
        read = [self._wide(sensor(self.plant, name)) for name in loop.sensors]
        signals = [
            Signal.sum([one.times(w) for one, w in zip(read, row, strict=True)], self.size)
            for row in loop.mixing
        ]
        gain = loop.gain_at(self.airspeed)
        for name, command in zip(loop.inputs, self._law(loop, signals), strict=True):
            moved = self._actuator(loop, self._delay(loop, command.times(gain)))
            self.commands[name] = self.commands[name].plus(moved)
        self._doubt(loop)

    def _wide(self, signal: Signal) -> Signal:
        """Return a signal of the model with zeros for the coordinates of loops."""
        more = self.size - self.n
        return Signal(*(np.pad(part, [(0, 0)] * (part.ndim - 1) + [(0, more)]) for part in signal))

    def _row(self, stiffness: Any, damping: Any, driven_by: Signal) -> int:
        """Add a coordinate η̈ + damping η̇ + stiffness η = signal, and return its place."""
        place, self.next = self.next, self.next + 1
        for part, own in zip(self.parts, driven_by, strict=True):
            part[..., place, :] -= own
        for part, diagonal in zip(self.parts, (stiffness, damping, 1.0), strict=True):
            part[..., place, place] += diagonal
        return place

    def _unit(self, place: int, derivative: int) -> Signal:
        """Return the signal that is a coordinate, or its first or second derivative."""
        found = np.zeros((3, self.size))
        found[derivative, place] = 1
        return Signal(*found)

    def _law(self, loop: ControlLoop, signals: list[Signal]) -> list[Signal]:
        """Add the states of a law, which are rates, and return its commands."""
        law = loop.law
        driven = [
            Signal.sum([one.times(w) for one, w in zip(signals, row, strict=True)], self.size)
            for row in law.B
        ]
        places = [self._row(0.0, 0.0, signal) for signal in driven]
        for row, place in enumerate(places):
            self.parts[1][..., place, places] -= law.A[row]
        states = [self._unit(place, 1) for place in places]
        return [
            Signal.sum(
                [one.times(w) for one, w in zip((*states, *signals), (*from_states, *through), strict=True)],
                self.size,
            )
            for from_states, through in zip(law.C, law.D, strict=True)
        ]

    def _delay(self, loop: ControlLoop, command: Signal) -> Signal:
        """Add the sections of a delay, each all-pass, and return what leaves them."""
        if loop.delay is None:
            return command
        slowness = 1 / np.asarray(loop.delay)
        for damping, b in sections(loop.delay_order):
            if damping is None:
                place = self._row(0.0, b * slowness, command.times(b * slowness))
                command = self._unit(place, 1).times(2.0).plus(command.times(-1.0))
            else:
                place = self._row(b * slowness**2, damping * slowness, command.times(b * slowness**2))
                command = command.plus(self._unit(place, 1).times(-2 * damping / (b * slowness)))
        return command

    def _actuator(self, loop: ControlLoop, command: Signal) -> Signal:
        """Add an actuator and return its position."""
        if loop.actuator_bandwidth is None:
            return command
        omega = np.asarray(loop.actuator_bandwidth)
        if loop.actuator_damping is None:
            return self._unit(self._row(0.0, omega, command.times(omega)), 1)
        damping = 2 * np.asarray(loop.actuator_damping) * omega
        return self._unit(self._row(omega**2, damping, command.times(omega**2)), 0)

    def _doubt(self, loop: ControlLoop) -> None:
        """Tell where the approximation of a delay reaches less high than the coordinates of the model do."""
        if loop.delay is None:
            return
        limit = phase_limit(loop.delay_order) / np.asarray(loop.delay).real
        lacks = limit < _highest_frequency(self.plant)
        for place in map(tuple, np.argwhere(np.broadcast_to(lacks, self.warning.shape))):
            hertz = float(np.broadcast_to(limit, self.warning.shape)[place]) / (2 * np.pi)
            text = (
                f"control loop {loop.name}: its delay is approximated to order {loop.delay_order}, with an error of "
                f"phase above one degree from {hertz:.3g} Hz on"
            )
            self.warning[place] = "; ".join(filter(None, (self.warning[place], text)))

    def model(self) -> LinearModel:
        """Return the model with its loops closed."""
        plant, shape = self.plant, self.plant.M.shape[:-2]
        assert plant.B is not None  # checked with the inputs of the loops
        rows = [
            np.stack(
                [np.broadcast_to(own[order], (*shape, self.size)) for own in self.commands.values()], axis=-2
            )
            for order in range(3)
        ]
        whole = [part.copy() for part in self.parts]
        for part, commands in zip(whole, rows, strict=True):
            part[..., : self.n, :] -= plant.B @ commands
        stiffness, damping, mass = (_real(part) for part in whole)
        names = tuple(name for name, _ in self.added)
        dofs = (*plant.dofs, *names)
        check_distinct("control.loops", dofs)
        more = len(names)
        wide: dict[str, Any] = {
            side: None if motion is None else np.pad(motion, [(0, 0)] * (np.ndim(motion) - 1) + [(0, more)])
            for side, motion in (("hub", plant.hub), ("left_hub", plant.left_hub))
        }
        closed = replace(
            plant,
            M=mass,
            C=damping,
            K=stiffness,
            B=np.pad(plant.B, [(0, 0)] * (plant.B.ndim - 2) + [(0, more), (0, 0)]),
            dofs=dofs,
            rates=(*plant.rates, *(name for name, held in self.added if not held)),
            feedback=Feedback(*(_real(part) for part in rows)),
            mass_at_rest=None,
            trim=with_warning(plant.trim, at_points(self.warning, shape, 0)),
            **wide,
        )
        return _coupled(closed, more)


def _coordinates(loop: ControlLoop) -> list[tuple[str, bool]]:
    """Return the coordinates of a loop in their order, and whether the displacement of each is a state."""
    found = [(name, False) for name in _law_states(loop.name, len(loop.law.A))]
    for place in loop.inputs:
        stem = loop.name if len(loop.inputs) == 1 else f"{loop.name} {place}"
        if loop.delay is not None:
            chain = sections(loop.delay_order)
            numbered = [f"{stem} delay{f' {k}' if len(chain) > 1 else ''}" for k in range(1, len(chain) + 1)]
            found += [(name, one.damping is not None) for name, one in zip(numbered, chain, strict=True)]
        if loop.actuator_bandwidth is not None:
            found.append((f"{stem} actuator", loop.actuator_damping is not None))
    return found


def _law_states(name: str, count: int) -> list[str]:
    """Return the names of the states of a law: two by two, because two may swing as one pair."""
    several = count > 2
    found = []
    for start in range(0, count, 2):
        stem = f"{name} law{f' {start // 2 + 1}' if several else ''}"
        found += [stem] if start + 1 == count else [f"{stem}_a", f"{stem}_b"]
    return found


def _coupled(closed: LinearModel, more: int) -> LinearModel:
    """Return the model with the half of the motion to which loops belong, and with what the loops couple."""
    n = len(closed.dofs) - more
    touched = _touched(closed, n)
    apart = tuple(
        group for group in closed.apart if not any(closed.dofs.index(name) in touched for name in group)
    )
    if not closed.symmetry:
        return replace(closed, apart=apart)
    halves = {closed.symmetry[place] for place in touched if place < n}
    if closed.halves_couple or len(halves) > 1:
        return replace(closed, apart=apart, halves_couple=True, symmetry=(*closed.symmetry, *[""] * more))
    half = halves.pop() if halves else HALVES[0]
    return replace(closed, apart=apart, symmetry=(*closed.symmetry, *[half] * more))


def _touched(closed: LinearModel, n: int) -> set[int]:
    """Return the places of the coordinates of the plant that loops sense or move."""
    assert closed.feedback is not None and closed.B is not None
    moving = [np.asarray((part != 0).any(axis=-1)) for part in closed.feedback]
    used = np.any([one.reshape(-1, one.shape[-1]).any(axis=0) for one in moving], axis=0)
    loads = (closed.B[..., :n, :][..., used] != 0).any(axis=-1)
    sensed = np.any(
        [(matrix[..., n:, :n] != 0).any(axis=-2) for matrix in (closed.M, closed.C, closed.K)], axis=0
    )
    straight = np.any([(part[..., :n] != 0).any(axis=-2) for part in closed.feedback], axis=0)
    places = [array.reshape(-1, n).any(axis=0) for array in (loads, sensed, straight)]
    return set(np.flatnonzero(np.any(places, axis=0)).tolist())


def _without_circles(closed: LinearModel, opened: LinearModel) -> LinearModel:
    """Return the model with the reason at each point whose loops have no solution; refuse loops that have none."""
    circular = massless(closed.M) & ~opened.massless
    if not circular.any():
        return closed
    if (circular | ~closed.finite).all():
        raise InputError("control.loops", None, _CIRCULAR)
    return failed_where(np.where(circular, _CIRCULAR, ""), closed)


def _highest_frequency(model: LinearModel) -> Array:
    """Return the highest frequency (...) of a coordinate that moves alone, all others held, rad/s."""
    mass, stiffness = (np.real(matrix.diagonal(0, -2, -1)) for matrix in (model.M, model.K))
    with np.errstate(all="ignore"):
        square = np.where((mass > 0) & (stiffness > 0), stiffness / mass, 0.0)
    return np.asarray(np.sqrt(square.max(axis=-1, initial=0.0)))


def _real(matrix: Array) -> Array:
    """Return a matrix without its imaginary part, if there is none."""
    return np.asarray(matrix.real) if not matrix.imag.any() else matrix
