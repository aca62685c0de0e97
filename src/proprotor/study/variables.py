"""The quantities of a study, the variables of each quantity, and arrays for variables that are not found yet."""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import numpy as np

from proprotor.typing import Array

QUANTITIES = ("eigenvalue", "least_stable", "trim", "flutter", "vectors", "modes")
ALONG_AIRSPEEDS = ("flutter", "modes")  # need all airspeeds of a design at once
DEFAULT_QUANTITIES = QUANTITIES[:3]
STABLE = "stable throughout"
UNSTABLE = "unstable at the lowest airspeed"
ABOVE, BELOW = "flutter_speed_above", "flutter_speed_below"  # limits of flutter speeds beyond the airspeeds

POINT, _DESIGN = "point", "design"


class _Variable(NamedTuple):
    """A variable of the results: meaning, unit, further dimensions, type, and whether points or designs have it."""

    meaning: str
    units: str = "1"
    dims: tuple[str, ...] = ()
    dtype: Any = float
    on: str = POINT


_text = partial(_Variable, units="", dtype=str)  # a variable of texts, which have no unit


_FLUTTER = {  # of a design
    "flutter_speed": _Variable("lowest airspeed of the range at which a mode becomes unstable", "m/s"),
    ABOVE: _Variable("limit above which the flutter speed lies: no mode is unstable up to here", "m/s"),
    BELOW: _Variable("limit below which the flutter speed lies: a mode is unstable here already", "m/s"),
    "flutter_frequency": _Variable("|Im s| of the mode that becomes unstable; 0: divergence", "rad/s"),
    "flutter_mode": _text("what moves in that mode at that airspeed"),
    "flutter_coordinate": _text("coordinate that takes most part in that mode"),
    "flutter_warning": _text("what makes the flutter speed doubtful"),
    "flutter_note": _text("why there is no flutter speed, or that it is not the first instability"),
    "flutter_least_damping": _Variable("lowest -Re s/|s| of all modes at the airspeeds of the range"),
}
_MODES = {  # of every state
    "mode_eigenvalue": _Variable("eigenvalues, followed along the airspeeds", "rad/s", dtype=complex),
    "mode_quality": _Variable("trust in the step from the airspeed before, 0 to 1"),
    "mode_name": _text("what moves in the mode at the point"),
    "mode_share": _Variable("participation of the motion that the mode is named after, 0 to 1"),
    "mode_support_share": _Variable("participation of the coordinates of the support, 0 to 1"),
    "mode_coordinate": _text("coordinate that takes most part at the first airspeed", on=_DESIGN),
}
VARIABLES: dict[str, dict[str, _Variable]] = {
    "eigenvalue": {
        "eigenvalue": _Variable("all eigenvalues, by frequency |Im s|", "rad/s", ("state",), complex),
    },
    "least_stable": {
        "growth_rate": _Variable("largest real part of all eigenvalues", "1/s"),
        "damping_ratio": _Variable("-Re s/|s| of the mode with the lowest damping ratio"),
        "frequency": _Variable("|Im s| of the mode with the lowest damping ratio", "rad/s"),
    },
    "trim": {
        "collective": _Variable("pitch at 0.75 R without the elastic pitch", "rad"),
        "coning": _Variable("trim flap angle beyond the precone", "rad"),
        "lag": _Variable("trim lag angle", "rad"),
        "elastic_pitch": _Variable("trim elastic pitch", "rad"),
        "thrust": _Variable("thrust of the airloads on the rotor", "N"),
        "torque": _Variable("torque of the airloads, positive where it speeds the rotor up", "N*m"),
        "inflow": _Variable("induced velocity against the thrust, zero without the option inflow", "m/s"),
    },
    "flutter": {name: one._replace(on=_DESIGN) for name, one in _FLUTTER.items()},
    "vectors": {
        "vector": _Variable("motion of the coordinates; largest component 1", "", ("dof", "state"), complex),
    },
    "modes": {name: one._replace(dims=("state",)) for name, one in _MODES.items()},
}
ALWAYS = {
    "reason": _text("why a point failed"),
    "warning": _text("what makes a point doubtful"),
    "missing": _text("why a point has fewer eigenvalues than others"),
}

VARIABLE = {name: one for some in (*VARIABLES.values(), ALWAYS) for name, one in some.items()}


def variables(quantities: tuple[str, ...]) -> dict[str, _Variable]:
    """Return the variables of the chosen quantities, by name."""
    return {name: one for quantity in quantities for name, one in VARIABLES[quantity].items()} | ALWAYS


def blank(
    quantities: tuple[str, ...], shape: tuple[int, int], states: int, coordinates: int
) -> dict[str, Array]:
    """Return an array of each variable in which nothing is found yet.

    Parameters
    ----------
    quantities : tuple of str
    shape : tuple of int
        Designs and airspeeds.
    states, coordinates : int
        Number of eigenvalues and of coordinates of the model.
    """
    return {
        name: np.full(shape_of(one, shape, states, coordinates), *_nothing(one))
        for name, one in variables(quantities).items()
    }


def shape_of(variable: _Variable, shape: tuple[int, int], states: int, coordinates: int) -> tuple[int, ...]:
    """Return the shape of the array of a variable, for designs and airspeeds."""
    sizes = {"state": states, "dof": coordinates}
    leading = shape if variable.on == POINT else shape[:1]
    return (*leading, *(sizes[dim] for dim in variable.dims))


def bytes_of(variable: _Variable) -> int:
    """Return the bytes of one number or text of a variable."""
    return int(np.dtype(_nothing(variable)[1]).itemsize)


def _nothing(variable: _Variable) -> tuple[Any, Any]:
    """Return what stands for a number or text that is not found, and its type."""
    return ("", object) if variable.dtype is str else (np.nan, variable.dtype)
