"""The transfer function of each control loop, cut at one actuator with all other loops closed, at one airspeed.

With T the commands of all loops per unit of the motion of all actuators, T = K(iω) P(iω), and the loop cut at actuator
j while the others o stay closed, L = -(T_jj + T_jo (1 - T_oo)⁻¹ T_oj): the loop is u = -L u, so that L = -1 is the
limit of stability. P is that of the equations of motion and K that of the laws, with each delay as e^{-iωτ}.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from proprotor.control.control_law import ControlLaw
from proprotor.control.control_loop import ControlLoop
from proprotor.model.closed_loop import close_loops
from proprotor.model.linear_model import LinearModel
from proprotor.model.sensors import Signal, sensor
from proprotor.stability.modes import eigenvalues
from proprotor.typing import Array

_BLOCK = 2048  # frequencies solved at once


class _Cut(NamedTuple):
    """Where a loop may be cut: place of the loop, and of the actuator among the inputs of the loop."""

    loop: int
    actuator: int


def cuts_of(loops: Sequence[ControlLoop]) -> dict[str, _Cut]:
    """Return every actuator of every loop by name: that of the loop, with the input where a loop has several."""
    return {
        loop.name if len(loop.inputs) == 1 else f"{loop.name} {name}": _Cut(place, actuator)
        for place, loop in enumerate(loops)
        for actuator, name in enumerate(loop.inputs)
    }


@dataclass(frozen=True)
class LoopTransfer:
    """The loops of one design at one airspeed.

    opened : LinearModel
        One point, without the loops.
    loops : sequence of ControlLoop
    """

    opened: LinearModel
    loops: Sequence[ControlLoop]

    def transfer(self, cut: _Cut, omega: Array) -> Array:
        """Return L (...) at frequencies ω (...) above zero, rad/s."""
        flat = np.reshape(omega, -1)
        parts = [self._at(cut, flat[start : start + _BLOCK]) for start in range(0, len(flat), _BLOCK)]
        return np.concatenate([*parts, np.zeros(0, dtype=complex)]).reshape(np.shape(omega))

    def roots(self, cut: _Cut | None = None) -> Array:
        """Return the eigenvalues of all loops closed or, with a cut, of all others; delays are approximated."""
        loops = [
            _silent(loop, cut.actuator) if cut is not None and place == cut.loop else loop
            for place, loop in enumerate(self.loops)
        ]
        return eigenvalues(close_loops(self.opened, loops))

    def _at(self, cut: _Cut, omega: Array) -> Array:
        """Return L (frequencies,) of a few frequencies."""
        every = self._commands(omega)
        own = list(cuts_of(self.loops).values()).index(cut)
        others = [place for place in range(every.shape[-1]) if place != own]
        straight, there, back = every[:, own, own], every[:, own, others], every[:, others, own]
        if not others:
            return np.asarray(-straight)
        inner = np.eye(len(others)) - every[:, others][:, :, others]
        around = (there[:, None, :] @ np.linalg.solve(inner, back[:, :, None]))[:, 0, 0]
        return np.asarray(-(straight + around))

    def _commands(self, omega: Array) -> Array:
        """Return T (frequencies, actuators, actuators)."""
        model, s = self.opened, 1j * omega[:, None, None]
        assert model.B is not None  # the model has the inputs of its loops
        moved = [model.inputs.index(name) for loop in self.loops for name in loop.inputs]
        motion = np.linalg.solve(
            s**2 * model.M + s * model.C + model.K, np.asarray(model.B[:, moved], dtype=complex)
        )
        airspeed = float(np.real(model.airspeed))
        rows = [loop.response(omega, airspeed) @ (self._read(loop, omega) @ motion) for loop in self.loops]
        return np.concatenate(rows, axis=1)

    def _read(self, loop: ControlLoop, omega: Array) -> Array:
        """Return what the sensors of a loop read (frequencies, sensors, n) per unit of each coordinate."""
        read: list[Signal] = [sensor(self.opened, name) for name in loop.sensors]
        return np.stack([one.at(omega) for one in read], axis=1)


def _silent(loop: ControlLoop, actuator: int) -> ControlLoop:
    """Return a loop that does not command one of its actuators."""
    keep = (np.arange(len(loop.inputs)) != actuator)[:, None]
    law: ControlLaw = loop.law
    return replace(loop, law=ControlLaw(law.A, law.B, law.C * keep, law.D * keep))
