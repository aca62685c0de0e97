"""Continuous turbulence: the spectra of von Kármán and of Dryden, one-sided over the circular frequency.

Turbulence is frozen in space, so that an aircraft at the airspeed V meets the spatial frequency Ω as ω = V Ω. With
τ = L/V the spectra of the velocity, whose integral over all ω from zero is σ², are

    von Kármán  along  σ² 2τ/π (1 + (aτω)²)^(-5/6)    across  σ² τ/π (1 + 8/3 (aτω)²) (1 + (aτω)²)^(-11/6)
    Dryden      along  σ² 2τ/π (1 + (τω)²)^(-1)       across  σ² τ/π (1 + 3 (τω)²) (1 + (τω)²)^(-2)

with a = 1.339. MIL-HDBK-1797 writes the scale across as L/2 and has 2 L_v in its formulas, which are these.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from proprotor.errors import InputError, is_choice, list_choices
from proprotor.typing import Array
from proprotor.units import values_in_si

SPECTRA = ("von-karman", "dryden")
COMPONENTS = ("vertical", "lateral", "longitudinal")
_FOOT = 0.3048
# Above 2000 ft, MIL-HDBK-1797; that of von Kármán also 14 CFR 25.341(b).
_SCALES = {"von-karman": 2500 * _FOOT, "dryden": 1750 * _FOOT}
_KARMAN = 1.339  # 11/3 Γ(11/6)/Γ(1/3)/√π to four digits, as the regulations print it


@dataclass(frozen=True)
class Turbulence:
    """Turbulence by its spectrum.

    Parameters
    ----------
    spectrum : "von-karman" or "dryden"
    component : "vertical", "lateral" or "longitudinal"
        Velocity of the air up, sideways, or along the shaft.
    intensity : float in m/s, text such as "3 ft/s", or pint quantity
        Root mean square σ of the velocity. With the default of 1 m/s a root mean square is the ratio Ā of regulations,
        per m/s.
    scale : float in m, text, or pint quantity, optional
        Length L; by default 2500 ft with the spectrum of von Kármán (14 CFR 25.341(b); MIL-HDBK-1797 above 2000 ft) and
        1750 ft with that of Dryden (MIL-HDBK-1797 above 2000 ft).

    Raises
    ------
    InputError
        For an unknown word, or a number that is not above zero.
    """

    spectrum: str = "von-karman"
    component: str = "vertical"
    intensity: Any = 1.0
    scale: Any = None

    def __post_init__(self) -> None:
        for field, choices in (("spectrum", SPECTRA), ("component", COMPONENTS)):
            if not is_choice(getattr(self, field), choices):
                raise InputError(field, getattr(self, field), f"must be {list_choices(choices)}")
        scale = _SCALES[self.spectrum] if self.scale is None else self.scale
        for field, value, unit in (("intensity", self.intensity, "m/s"), ("scale", scale, "m")):
            number = values_in_si(value, unit, field).reshape(-1)
            if len(number) != 1 or not (np.isfinite(number[0]) and number[0] > 0):
                raise InputError(field, value, "must be one number above zero")
            object.__setattr__(self, field, float(number[0]))

    def density(self, frequency: Array, airspeed: float) -> Array:
        """Return the one-sided spectral density of the velocity.

        Parameters
        ----------
        frequency : array (...)
            rad/s, not negative.
        airspeed : float
            m/s, true.

        Returns
        -------
        array (...)
            (m/s)²/(rad/s).
        """
        time = self.scale / airspeed
        along = self.component == "longitudinal"
        if self.spectrum == "dryden":
            square = (time * np.asarray(frequency)) ** 2
            shape = 2 / (1 + square) if along else (1 + 3 * square) / (1 + square) ** 2
        else:
            square = (_KARMAN * time * np.asarray(frequency)) ** 2
            shape = (
                2 * (1 + square) ** (-5 / 6) if along else (1 + 8 / 3 * square) * (1 + square) ** (-11 / 6)
            )
        return np.asarray(self.intensity**2 * time / np.pi * shape)


class _Filter(NamedTuple):
    """ẋ = A x + B w, v = C x: a velocity v of turbulence from white noise w of unit intensity."""

    A: Array
    B: Array
    C: Array


def dryden_filter(turbulence: Turbulence, airspeed: float) -> _Filter:
    """Return the filter whose output has the spectrum of Dryden.

    Along it is σ √(2τ)/(1 + τs), across σ √τ (1 + √3 τs)/(1 + τs)².

    Parameters
    ----------
    turbulence : Turbulence
        With the spectrum of Dryden.
    airspeed : float
        m/s, true.

    Raises
    ------
    InputError
        For another spectrum, which no filter of finite order has.
    """
    if turbulence.spectrum != "dryden":
        raise InputError("spectrum", turbulence.spectrum, "must be dryden: no other has a filter")
    rate, size = airspeed / turbulence.scale, turbulence.intensity
    if turbulence.component == "longitudinal":
        return _Filter(np.array([[-rate]]), np.array([[1.0]]), np.array([[size * np.sqrt(2 * rate)]]))
    system = np.array([[0.0, 1.0], [-(rate**2), -2 * rate]])
    output = size * np.sqrt(rate) * np.array([[rate, np.sqrt(3)]])
    return _Filter(system, np.array([[0.0], [1.0]]), output)
