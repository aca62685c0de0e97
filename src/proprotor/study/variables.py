"""The variables of a study's results: which quantities there are, and the arrays and the dataset that hold them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from proprotor.study.designs import AIRSPEED
from proprotor.typing import Array

if TYPE_CHECKING:
    import xarray

QUANTITIES = ("eigenvalue", "least_stable", "trim", "flutter", "vectors", "modes")
ALONG_AIRSPEEDS = ("flutter", "modes")  # need all airspeeds of a design at once
DEFAULT_QUANTITIES = QUANTITIES[:3]
STABLE = "stable throughout"
UNSTABLE = "unstable at the lowest airspeed"

POINT, _DESIGN = "point", "design"


class _Variable(NamedTuple):
    """A variable of the results: whether each point or each design has it, further dimensions, type, unit, meaning."""

    on: str
    dims: tuple[str, ...]
    dtype: Any
    units: str
    meaning: str


VARIABLES: dict[str, dict[str, _Variable]] = {
    "eigenvalue": {
        "eigenvalue": _Variable(POINT, ("state",), complex, "rad/s", "all eigenvalues, by frequency |Im s|"),
    },
    "least_stable": {
        "growth_rate": _Variable(POINT, (), float, "1/s", "largest real part of all eigenvalues"),
        "damping_ratio": _Variable(
            POINT, (), float, "1", "-Re s/|s| of the mode with the lowest damping ratio"
        ),
        "frequency": _Variable(POINT, (), float, "rad/s", "|Im s| of the mode with the lowest damping ratio"),
    },
    "trim": {
        "collective": _Variable(POINT, (), float, "rad", "pitch at 0.75 R without the elastic pitch"),
        "coning": _Variable(POINT, (), float, "rad", "trim flap angle beyond the precone"),
        "lag": _Variable(POINT, (), float, "rad", "trim lag angle"),
        "elastic_pitch": _Variable(POINT, (), float, "rad", "trim elastic pitch"),
        "thrust": _Variable(POINT, (), float, "N", "thrust of the airloads on the rotor"),
        "torque": _Variable(
            POINT,
            (),
            float,
            "N*m",
            "torque of the airloads on the rotor, positive where it speeds the rotor up",
        ),
    },
    "flutter": {
        "flutter_speed": _Variable(
            _DESIGN, (), float, "m/s", "lowest airspeed of the range at which a mode becomes unstable"
        ),
        "flutter_frequency": _Variable(
            _DESIGN, (), float, "rad/s", "|Im s| of the mode that becomes unstable; 0: divergence"
        ),
        "flutter_mode": _Variable(_DESIGN, (), str, "", "what moves in that mode at that airspeed"),
        "flutter_coordinate": _Variable(_DESIGN, (), str, "", "coordinate that takes most part in that mode"),
        "flutter_warning": _Variable(_DESIGN, (), str, "", "what makes the flutter speed doubtful"),
        "flutter_note": _Variable(
            _DESIGN, (), str, "", "why there is no flutter speed, or that it is not the first instability"
        ),
        "flutter_least_damping": _Variable(
            _DESIGN, (), float, "1", "lowest -Re s/|s| of all modes at the airspeeds of the range"
        ),
    },
    "vectors": {
        "vector": _Variable(
            POINT, ("dof", "state"), complex, "", "motion of the coordinates; largest component 1"
        ),
    },
    "modes": {
        "mode_eigenvalue": _Variable(
            POINT, ("state",), complex, "rad/s", "eigenvalues, followed along the airspeeds"
        ),
        "mode_quality": _Variable(
            POINT, ("state",), float, "1", "trust in the step from the airspeed before, 0 to 1"
        ),
        "mode_name": _Variable(POINT, ("state",), str, "", "what moves in the mode at the point"),
        "mode_share": _Variable(
            POINT, ("state",), float, "1", "participation of the motion that the mode is named after, 0 to 1"
        ),
        "mode_support_share": _Variable(
            POINT, ("state",), float, "1", "participation of the coordinates of the support, 0 to 1"
        ),
        "mode_coordinate": _Variable(
            _DESIGN, ("state",), str, "", "coordinate that takes most part at the first airspeed"
        ),
    },
}
ALWAYS = {
    "reason": _Variable(POINT, (), str, "", "why a point failed"),
    "warning": _Variable(POINT, (), str, "", "what makes a point doubtful"),
    "missing": _Variable(POINT, (), str, "", "why a point has fewer eigenvalues than others"),
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
        Of the model.
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


def dataset_of(
    found: Mapping[str, Array],
    axes: Mapping[str, int],
    coordinates: Mapping[str, Any],
    attributes: Mapping[str, Any],
    over_airspeeds: bool = True,
) -> xarray.Dataset:
    """Return arrays of variables as a dataset.

    Parameters
    ----------
    found : mapping of array
        By variable: (designs, airspeeds, …) of points, (designs, …) of designs.
    axes : mapping of int
        Name and length of each axis of the designs.
    coordinates, attributes : mapping
        Of the dataset.
    over_airspeeds : bool
        Whether there is an axis of airspeeds.
    """
    import xarray  # here, because it takes long to import

    data = {}
    for name, array in found.items():
        if name == "missing" and not (array != "").any():
            continue
        one = VARIABLE[name]
        along = over_airspeeds and one.on == POINT
        tail = array.shape[1 + (one.on == POINT) :]
        dims = (*axes, *[AIRSPEED] * along, *one.dims)
        own = {"long_name": one.meaning} | ({"units": one.units} if one.units else {})
        data[name] = (dims, array.reshape(*axes.values(), *array.shape[1:2] * along, *tail), own)
    return xarray.Dataset(data, dict(coordinates), dict(attributes))
