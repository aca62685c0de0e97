"""Flap and lag frequencies of a blade against collective or airspeed, from which its springs follow.

A frequency per revolution holds at one rotor speed: centrifugal force makes a part of its square and a spring makes
the rest, K = I (ω² - ν_c² Ω²), with ν_c² = 1 + e S/I in flap and e S/I in lag. So a table states its rotor speed. The
spring that follows is the blade's and holds at each other rotor speed, where the blade has another frequency.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError, check_finite, check_number
from proprotor.rotor.smooth_table import smooth_table
from proprotor.typing import Array

_Curve = float | ArrayLike | Callable[[Array], Array]
_ABSCISSAE = ("collective", "airspeed")
_PITCH_COUPLING = ("none", "springs")
_SPEED_RULE = (
    "is missing; frequencies per revolution hold at one rotor speed, in rad/s, and give the springs there"
)
_STEP = 1e-6  # of the abscissa, for the slope of a function


@dataclass(frozen=True, kw_only=True, eq=False)
class BladeFrequencies:
    """Rotating frequencies of a blade per revolution of a stated rotor speed, uncoupled and at zero cone.

    The model takes the springs that make these frequencies at the stated rotor speed, and keeps the springs at any
    other rotor speed.

    Parameters
    ----------
    at_rotor_speed : float
        Rotor speed at which the blade has these frequencies, rad/s; must be given.
    against : "collective" or "airspeed"
        Abscissa of the frequencies: trim collective in rad, or airspeed in m/s. Springs turn with the pitch, and at
        another rotor speed an airspeed has another pitch: a table that serves several rotor speeds is one against
        collective.
    at : array (k,), optional
        Abscissae of the tables' entries, rad or m/s, increasing; not needed for numbers and functions.
    flap, lag : float, array (k,) or function of an array
        Frequency per revolution. Tables are interpolated smoothly without overshoot; beyond its ends a table
        keeps its end values.
    cyclic_flap : the same, optional
        Frequency of cyclic flapping if it differs from collective flapping, as when the gimbal is locked and the
        gimbal's mode stands in the blade's place.
    pitch_coupling : "none" or "springs"
        Whether a bent blade turns in pitch. With "none" the springs do not turn with the pitch, and no deflection makes
        a pitching moment. With "springs" elastic pitch and the yoke's roll change the stiffness as they change that of
        the rotor's own springs, so that pitch equations and K_Pβ, K_Pζ keep their couplings; flap and lag are uncoupled
        at zero elastic pitch and where no linkage turns the blade.

    Raises
    ------
    InputError
        When no rotor speed is stated, a table does not fit its abscissa, or a number is not positive.
    """

    flap: _Curve
    lag: _Curve
    cyclic_flap: _Curve | None = None
    against: str = "collective"
    at: ArrayLike | None = None
    at_rotor_speed: float = np.nan  # refused: one must be given
    pitch_coupling: str = "none"

    def __post_init__(self) -> None:
        for name, choices in (("against", _ABSCISSAE), ("pitch_coupling", _PITCH_COUPLING)):
            if getattr(self, name) not in choices:
                raise InputError(name, getattr(self, name), f"must be one of {', '.join(choices)}")
        self._check_rotor_speed()
        if self.at is not None:
            at = np.asarray(self.at, dtype=float)
            if at.ndim != 1 or at.size < 2 or not np.all(np.isfinite(at)) or np.any(np.diff(at) <= 0):
                raise InputError("at", self.at, "must increase, as a list of at least two numbers")
        for name in ("flap", "lag", "cyclic_flap"):
            self._check(name, getattr(self, name))

    def _check_rotor_speed(self) -> None:
        """Refuse frequencies without a rotor speed, and a rotor speed that is not one positive number."""
        check_number("at_rotor_speed", self.at_rotor_speed)
        if np.ndim(self.at_rotor_speed):
            raise InputError("at_rotor_speed", self.at_rotor_speed, "must be one number")
        if np.isnan(self.at_rotor_speed):
            raise InputError("at_rotor_speed", None, _SPEED_RULE)
        check_finite("at_rotor_speed", self.at_rotor_speed, "above zero")

    def _check(self, name: str, curve: _Curve | None) -> None:
        """Refuse a table that does not fit the abscissae, or a frequency that is not positive."""
        if curve is None or callable(curve):
            return
        values = np.asarray(curve, dtype=float)
        if values.ndim and (self.at is None or values.shape != np.shape(self.at)):
            raise InputError(name, f"array of shape {values.shape}", "must have one entry for each of at")
        if not np.all(np.isfinite(values)) or np.any(values <= 0):
            raise InputError(name, curve, "must be above zero")

    def _evaluate(self, curve: _Curve, abscissa: Array) -> Array:
        """Return a curve at an abscissa; an imaginary part is followed to first order, for a complex step."""
        if callable(curve):
            return _of_function(curve, abscissa)
        if np.ndim(curve) == 0:
            return np.full(np.shape(abscissa), float(np.asarray(curve)))
        assert self.at is not None  # checked with the table
        return smooth_table(self.at, curve, abscissa)

    def rotating(self, collective: Array, airspeed: Array) -> dict[str, Any]:
        """Return rotating frequencies and their rotor speed by the names of the derivation; the arguments broadcast.

        Parameters
        ----------
        collective : array (...)
            Trim collective, rad.
        airspeed : array (...)
            m/s.

        Returns
        -------
        dict of str to float or array (...)
            rad/s.

        Raises
        ------
        InputError
            When a function gives a frequency that is not above zero.
        """
        abscissa = np.asarray(collective if self.against == "collective" else airspeed)
        curves = {
            "rotating_flap_frequency": self.flap,
            "rotating_lag_frequency": self.lag,
            "cyclic_flap_frequency": self.flap if self.cyclic_flap is None else self.cyclic_flap,
        }
        per_rev = {name: self._evaluate(curve, abscissa) for name, curve in curves.items()}
        frequencies = {name: ratio * self.at_rotor_speed for name, ratio in per_rev.items()}
        return {"rotor_speed": self.at_rotor_speed} | frequencies


def _of_function(curve: Callable[[Array], Array], abscissa: Array) -> Array:
    """Return a function, which must give positive values, at an abscissa; its slope comes from central differences."""
    if not np.iscomplexobj(abscissa):
        values = np.asarray(curve(abscissa), dtype=float)
        if np.any(np.isfinite(abscissa) & ~(values > 0)):
            rule = "must be above zero wherever a function gives them"
            raise InputError("frequencies", float(np.min(values)), rule)
        return values
    at = np.asarray(abscissa.real)
    step = _STEP * np.maximum(np.abs(at), 1.0)
    slope = (_of_function(curve, at + step) - _of_function(curve, at - step)) / (2 * step)
    return np.asarray(_of_function(curve, at) + 1j * slope * abscissa.imag)
