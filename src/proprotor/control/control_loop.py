"""The record of a control loop: sensors, law, gain, delay and actuator, and the inputs that it moves."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.control.control_law import ControlLaw
from proprotor.control.pade import MOST
from proprotor.errors import InputError, check_finite
from proprotor.rotor.smooth_table import smooth_table
from proprotor.typing import Array

NUMBERS = {
    "gain": "",
    "actuator_bandwidth": "rad/s",
    "actuator_damping": "",
    "delay": "s",
}  # with their SI units
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9 _.-]{0,59}")
_POSITIVE = ("actuator_bandwidth", "actuator_damping", "delay")


@dataclass(frozen=True, kw_only=True, eq=False)
class ControlLoop:
    """Feedback from sensors to inputs: u = actuator · delay · gain · law · sensors, added to the inputs.

    The sign is that of the gain: a positive gain adds what the law makes of the sensors. Numbers may be arrays (...) of
    many designs, or complex for derivatives by a complex step.

    Parameters
    ----------
    name : str
        Name of the loop in all results.
    sensors : str or sequence of str
        Displacements, rates and accelerations of the model: "beam", "x acceleration", "gimbal_1c rate", "azimuth rate";
        see `proprotor.model.sensors`. SI units: m, rad, per s, per s².
    inputs : str or sequence of str
        "collective", "cyclic_1c", "cyclic_1s" (rad at the swashplate), "flaperon" (rad) of a wing that has one; of two
        rotors "symmetric collective" and so on.
    weights : sequence of float, optional
        Weight of each sensor, dimensionless; the weighted sum is then the one signal of the law. Without weights each
        sensor is a signal.
    law : optional
        A transfer function (numerator, denominator), a state space (A, B, C, D), or an object of python-control or
        scipy.signal, see `ControlLaw.of`: from the signals to a command for each input. Without a law the gain alone.
    gain : float or array (...)
        Input in rad per unit of the law's command.
    scheduled_at, scheduled_gains : array (k,), optional
        Airspeeds, m/s, rising, and factors on the gain there; smooth between them without overshoot, held beyond.
    actuator_bandwidth : float or array (...), optional
        rad/s: of a lag 1/(1 + s/ω), or with a damping of ω²/(s² + 2ζωs + ω²). Without it actuators follow at once.
    actuator_damping : float or array (...), optional
        Damping ratio ζ of an actuator of second order.
    delay : float or array (...), optional
        s, of each command.
    delay_order : int
        Order of the Padé approximation of the delay in eigenvalues; margins have the delay itself.

    Raises
    ------
    InputError
        When a name is malformed, sizes do not fit, a number is not finite or has the wrong sign, or a law is improper.
    """

    name: str
    sensors: str | Sequence[str]
    inputs: str | Sequence[str]
    weights: ArrayLike | None = None
    law: Any = None
    gain: float | Array = 1.0
    scheduled_at: ArrayLike | None = None
    scheduled_gains: ArrayLike | None = None
    actuator_bandwidth: float | Array | None = None
    actuator_damping: float | Array | None = None
    delay: float | Array | None = None
    delay_order: int = 3

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not _NAME.fullmatch(self.name):
            raise InputError(
                "name", self.name, "must be letters, digits, spaces, dots, dashes and underscores"
            )
        for field in ("sensors", "inputs"):
            object.__setattr__(self, field, _names(field, getattr(self, field)))
        for field in NUMBERS:
            if (value := getattr(self, field)) is not None:
                check_finite(field, value, "above zero" if field in _POSITIVE else "")
        if self.actuator_damping is not None and self.actuator_bandwidth is None:
            raise InputError("actuator_bandwidth", None, "must be given with actuator_damping")
        if self.delay_order not in range(1, MOST + 1):
            raise InputError("delay_order", self.delay_order, f"must be a whole number, 1 to {MOST}")
        self._check_weights()
        self._check_schedule()
        law = ControlLaw.gain(self.signals, len(self.inputs)) if self.law is None else ControlLaw.of(self.law)
        if law.D.shape != (len(self.inputs), self.signals):
            rule = f"must lead {self.signals} signals of the sensors to {len(self.inputs)} inputs"
            raise InputError("law", f"{law.D.shape[1]} signals to {law.D.shape[0]} commands", rule)
        object.__setattr__(self, "law", law)

    def _check_weights(self) -> None:
        if self.weights is None:
            return
        check_finite("weights", self.weights)
        weights = np.atleast_1d(np.asarray(self.weights, dtype=float))
        if weights.shape != (len(self.sensors),):
            raise InputError(
                "weights", list(weights), f"must be one for each of the {len(self.sensors)} sensors"
            )
        object.__setattr__(self, "weights", weights)

    def _check_schedule(self) -> None:
        if self.scheduled_at is None and self.scheduled_gains is None:
            return
        for field, other in (("scheduled_at", "scheduled_gains"), ("scheduled_gains", "scheduled_at")):
            if getattr(self, field) is None:
                raise InputError(field, None, f"must be given with {other}")
            check_finite(field, getattr(self, field))
            object.__setattr__(self, field, np.asarray(getattr(self, field), dtype=float))
        at, gains = np.asarray(self.scheduled_at), np.asarray(self.scheduled_gains)
        if at.ndim != 1 or len(at) < 2 or np.any(np.diff(at) <= 0):
            raise InputError("scheduled_at", at.tolist(), "must be two airspeeds or more that rise")
        if gains.shape != at.shape:
            raise InputError(
                "scheduled_gains", gains.tolist(), f"must be one for each of the {len(at)} airspeeds"
            )

    @property
    def signals(self) -> int:
        """Number of signals of the law: of sensors, or of their one weighted sum."""
        return len(self.sensors) if self.weights is None else 1

    @property
    def mixing(self) -> Array:
        """Signals per unit of each sensor, (signals, sensors)."""
        return np.eye(len(self.sensors)) if self.weights is None else np.asarray(self.weights)[None, :]

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the arrays among the numbers, broadcast together."""
        given = (getattr(self, field) for field in NUMBERS)
        return np.broadcast_shapes(*(np.shape(value) for value in given if value is not None))

    def gain_at(self, airspeed: Array) -> Array:
        """Return the gain at airspeeds.

        Parameters
        ----------
        airspeed : array (...)
            m/s.

        Returns
        -------
        array (...)
            rad per unit of the law's command.
        """
        if self.scheduled_at is None or self.scheduled_gains is None:
            return np.asarray(self.gain)
        return np.asarray(self.gain * smooth_table(self.scheduled_at, self.scheduled_gains, airspeed))

    def after_the_law(self, omega: Array, airspeed: float) -> Array:
        """Return the exact frequency response of gain, delay and actuator; the delay is e^{-iωτ} itself.

        Parameters
        ----------
        omega : array (frequencies,)
            rad/s.
        airspeed : float
            m/s.

        Returns
        -------
        array (frequencies,)
            Complex, rad per unit of the law's command. The numbers of the loop must be those of one design.
        """
        s = 1j * np.asarray(omega)
        found = complex(self.gain_at(np.asarray(airspeed))) * np.exp(
            -s * (0.0 if self.delay is None else self.delay)
        )
        if self.actuator_bandwidth is None:
            return np.asarray(found)
        ratio = s / self.actuator_bandwidth
        if self.actuator_damping is None:
            return np.asarray(found / (1 + ratio))
        return np.asarray(found / (1 + 2 * self.actuator_damping * ratio + ratio**2))

    def response(self, omega: Array, airspeed: float) -> Array:
        """Return the exact frequency response of the loop from its sensors to its inputs.

        Parameters
        ----------
        omega : array (frequencies,)
            rad/s.
        airspeed : float
            m/s.

        Returns
        -------
        array (frequencies, inputs, sensors)
            Complex, rad per SI unit of each sensor.
        """
        law: ControlLaw = self.law
        return np.asarray(
            self.after_the_law(omega, airspeed)[:, None, None] * (law.response(omega) @ self.mixing)
        )

    def __repr__(self) -> str:
        """Return the loop in a line, without its numbers."""
        return f"ControlLoop({loop_text(self)})"


def loop_text(loop: ControlLoop) -> str:
    """Return a loop in words: its name, its sensors and its inputs."""
    return f"{loop.name}: {', '.join(loop.sensors)} to {', '.join(loop.inputs)}"


def _names(field: str, given: str | Sequence[str]) -> tuple[str, ...]:
    """Return one name or more as a tuple."""
    names: tuple[Any, ...] = tuple(given) if isinstance(given, list | tuple) else (given,)
    if not names or not all(isinstance(name, str) and name for name in names):
        raise InputError(field, given, "must be one name or more")
    if len(set(names)) < len(names):
        raise InputError(field, ", ".join(names), "must not name one twice")
    return names
