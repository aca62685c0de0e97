"""Sensors of a model by name: displacement, rate and acceleration of its coordinates and of the hub.

A name is that of a coordinate ("beam", "gimbal_1c", "azimuth") or of a motion of the hub ("x" … "alpha_z"; of two
rotors "symmetric x", that of the right hub in its half of the motion), with nothing, " rate" or " acceleration" after
it. The bending strain of a wing is in proportion to the displacement of its beam mode; an accelerometer elsewhere on a
rigid pylon is a weighted sum of the accelerations of the hub.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from typing import NamedTuple, Self

import numpy as np

from proprotor.errors import InputError
from proprotor.model.linear_model import LinearModel
from proprotor.model.pair import halves_of
from proprotor.rotor.motions import HUB
from proprotor.typing import Array

_ENDINGS = {"": 0, " rate": 1, " acceleration": 2}


class Signal(NamedTuple):
    """A quantity of a model per unit of displacement, rate and acceleration of each coordinate, each (..., n)."""

    displacement: Array
    rate: Array
    acceleration: Array

    def times(self, factor: Array | float) -> Self:
        """Return the signal times a factor (...)."""
        factor = np.asarray(factor)[..., None]
        return type(self)(*(factor * part for part in self))

    def plus(self, other: Signal) -> Self:
        """Return the sum of two signals."""
        return type(self)(*(one + more for one, more in zip(self, other, strict=True)))

    def at(self, omega: Array) -> Array:
        """Return the rows (frequencies, n) per unit of displacements e^{iωt}, at ω (frequencies,) in rad/s."""
        s = 1j * np.asarray(omega)[:, None]
        return np.asarray(self.displacement + s * self.rate + s**2 * self.acceleration)

    @classmethod
    def none(cls, n: int) -> Self:
        """Return the signal that is zero."""
        return cls(*np.zeros((3, n)))

    @classmethod
    def sum(cls, signals: list[Signal], n: int) -> Self:
        """Return the sum of many signals."""
        return cls(*reduce(Signal.plus, signals, cls.none(n)))


def sensor(model: LinearModel, name: str, field: str = "sensors") -> Signal:
    """Return what a sensor reads, in m or rad, per s or per s².

    Parameters
    ----------
    model : LinearModel
    name : str
    field : str
        Name of the input, for the message.

    Raises
    ------
    InputError
        For a name that no motion of the model has, with the names; for the displacement of a motion that has a rate
        alone.
    """
    known = _motions(model)
    ending = next((end for end in (" acceleration", " rate") if name.endswith(end)), "")
    motion = name.removesuffix(ending) if ending else name
    if motion not in known:
        rule = f'unknown motion; known, also with " rate" or " acceleration": {", ".join(known)}'
        raise InputError(field, name, rule)
    row = known[motion]
    loose = _without_displacement(model)
    if not ending and (row[..., loose] != 0).any():
        rule = "has no displacement among the states: nothing holds it; take its rate or acceleration"
        raise InputError(field, name, rule)
    parts = [np.zeros(row.shape)] * len(_ENDINGS)
    parts[_ENDINGS[ending]] = row
    return Signal(*parts)


def _motions(model: LinearModel) -> Mapping[str, Array]:
    """Return the rows (..., n) of all motions of a model, by name."""
    n = len(model.dofs)
    found: dict[str, Array] = {}
    if model.left_hub is not None:
        for half, to_rotor in halves_of(model):
            found |= {f"{half} {axis}": to_rotor[..., place, :] for place, axis in enumerate(HUB)}
    elif model.hub is not None:
        found |= {axis: np.asarray(model.hub)[..., place, :] for place, axis in enumerate(HUB)}
    return found | dict(zip(model.dofs, np.eye(n), strict=True))


def _without_displacement(model: LinearModel) -> list[int]:
    """Return the places of coordinates along which nothing has stiffness at some point, so that only rates count."""
    held = np.moveaxis(model.azimuths_held, -1, 0)
    free = {name for name, points in zip(model.azimuths, held, strict=True) if not np.all(points)}
    return [place for place, name in enumerate(model.dofs) if name in free or name in model.rates]
