"""Sliders for the inputs of a deck: which inputs have one at first, and the range of each slider."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from proprotor.case import Case
from proprotor.datum import deck_unit
from proprotor.deck.describe import deck_fields, plain_path
from proprotor.deck.vary import design_inputs, inputs_at
from proprotor.plots.input_names import short_name
from proprotor.plots.line_of_sweep import written
from proprotor.stability.parameter_lines import AIRSPEED
from proprotor.typing import Array
from proprotor.units import KNOT, KTAS

_FIRST = (
    "rotor.precone",
    "rotor.control_stiffness",
    "rotor.gimbal_stiffness",
    "rotor.pitch_gimbal_coupling",
    "rotor.flap_frequency",
    "rotor.flap_stiffness",
    "rotor.lag_frequency",
    "rotor.lag_stiffness",
    "rotor.structural_pitch_offset",
)
_FIRST_OF_SUPPORT = ("frequency", "damping_ratio")
_MOST = 13  # sliders at first

# By the end of a path: the ends of the range, as factors on the value of the deck.
_FACTORS = {
    "frequency": (0.5, 1.6),
    "stiffness": (0.2, 3.0),
    "damping_ratio": (0.0, 4.0),
    "rotor_speed": (0.7, 1.3),
    "density": (0.2, 1.2),
}
_ANGLES = ("rad", 0.0873)  # at least five degrees to either side
_COUPLING = 0.6  # to either side, for a coupling such as K_PG
_STEPS = 250  # of a slider, at most


@dataclass(frozen=True)
class SliderInput:
    """An input and the range of its slider, in the unit of the deck.

    Attributes
    ----------
    path, name, unit, meaning : str
    factor : float
        The unit of the deck in SI units.
    value, low, high : float
        Value of the deck, and ends of the range.
    """

    path: str
    name: str
    unit: str
    meaning: str
    factor: float
    value: float
    low: float
    high: float

    @property
    def label(self) -> str:
        """The name of the input, with its unit."""
        return f"{self.name} ({written(self.unit)})" if self.unit else self.name

    @property
    def step(self) -> float:
        """The step of the slider: a round number, so that the range has 100 to 250 steps."""
        raw = (self.high - self.low) / _STEPS
        power = 10.0 ** int(f"{raw:e}".partition("e")[2])
        return next(digit * power for digit in (1, 2, 5, 10) if digit * power >= raw * 0.999)


def first_inputs(case: Case) -> list[str]:
    """Return the paths of the inputs that have sliders at first: the inputs that engineers vary most often."""
    known = design_inputs(case)
    of_support = [
        path
        for last in _FIRST_OF_SUPPORT
        for path in known
        if path.startswith("support.") and path.endswith(f".{last}")
    ]
    return [path for path in (*_FIRST, *of_support) if path in known][:_MOST]


def slider_input(case: Case, path: str) -> SliderInput:
    """Return the slider of an input, at its default for one that the deck leaves out.

    Raises
    ------
    InputError
        For a path that is no input, and a field that cannot vary in this deck.
    """
    number = inputs_at(case, [path])[path]
    unit, factor = deck_unit(number)
    value = float(f"{float(number.si) / factor:.10g}")  # free of the rounding of conversion
    low, high = (float(f"{end:.3g}") for end in _range(path, value, number.unit, factor))
    meaning = _meanings().get(plain_path(path), "")
    return SliderInput(path, short_name(path), unit, meaning, factor, value, low, high)


@dataclass(frozen=True, eq=False)
class MapAxis:
    """An axis of the stability map.

    Attributes
    ----------
    path, label : str
    factor : float
        The unit of the axis in SI units.
    values : array (points,)
        SI, rising.
    """

    path: str
    label: str
    factor: float
    values: Array


def map_axis(case: Case, path: str, airspeeds: Array, value: float | None, points: int) -> MapAxis:
    """Return the axis of an input over the range of its slider, or of the airspeed over the airspeeds of the page.

    Parameters
    ----------
    case : Case
    path : str
        Of an input, or "airspeed".
    airspeeds : array
        m/s, of which the first and the last are the ends of an axis of airspeed.
    value : float, optional
        What the input is set to, SI; the axis reaches as far.
    points : int

    Raises
    ------
    InputError
        For a path that is no input.
    """
    if path == AIRSPEED:
        return MapAxis(path, f"Airspeed, {KTAS}", KNOT, np.linspace(airspeeds[0], airspeeds[-1], points))
    slider = slider_input(case, path)
    ends = [slider.low * slider.factor, slider.high * slider.factor, *([] if value is None else [value])]
    return MapAxis(path, slider.label, slider.factor, np.linspace(min(ends), max(ends), points))


def _range(path: str, value: float, si_unit: str, factor: float) -> tuple[float, float]:
    """Return the ends of a slider in the unit of the deck; `factor` is this unit in SI units."""
    last = path.rpartition(".")[2]
    if last.endswith("coupling"):
        return value - _COUPLING, value + _COUPLING
    if si_unit == _ANGLES[0]:
        reach = max(abs(value), _ANGLES[1] / factor)
        return value - reach, value + reach
    if value == 0:
        return -1.0, 1.0
    ends = next((ends for end, ends in _FACTORS.items() if last.endswith(end)), (0.5, 1.5))
    low, high = sorted(part * value for part in ends)
    return low, high


@functools.cache
def _meanings() -> Mapping[str, str]:
    """Return the meaning of each field of a deck by its path."""
    return {plain_path(field.path): field.meaning for field in deck_fields()}
