"""Outputs in single gusts of one minus the cosine, U/2 (1 - cos πs/H) over the distance s from 0 to 2H."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from proprotor.errors import InputError, is_choice, list_choices
from proprotor.model.linear_model import LinearModel
from proprotor.needs import check_memory
from proprotor.responses.gust_response import gust_input
from proprotor.responses.time_response import time_response
from proprotor.responses.turbulence import COMPONENTS
from proprotor.stability.modes import eigenvalues
from proprotor.typing import Array, Dataset
from proprotor.units import values_in_si

_PER_CYCLE = 40  # samples in a cycle of the highest root, and
_PER_GUST = 200  # in a gust
_BYTES = 32.0  # of a number of the response, with copies


def discrete_gust(
    model: LinearModel,
    gradient: Any,
    *,
    size: Any = 1.0,
    component: str = "vertical",
    duration: Any = 3.0,
    outputs: Sequence[str] | None = None,
) -> Dataset:
    """Return outputs in gusts of one minus the cosine that pass the rotor, and their extremes.

    Parameters
    ----------
    model : LinearModel
        One point.
    gradient : float or array (gradients,) in m, text such as "30:350:40 ft", or pint quantity
        H, the distance over which the gust grows.
    size : float or array (gradients,) in m/s, text, or pint quantity
        U, true; `proprotor.responses.design_gusts.design_gust` has that of regulations.
    component : "vertical", "lateral" or "longitudinal"
    duration : float in s, text, or pint quantity
        How long to go on after the longest gust.
    outputs : sequence of str, optional
        Names of outputs of `StateSpace`; all by default.

    Returns
    -------
    xarray.Dataset
        response (gradient, time, output), gust (gradient, time), highest and lowest (gradient, output); warning and
        reason. The gust runs linearly between samples, at least 200 in a gust and 40 in a cycle of the highest root.
        Attributes: component, the case and its options (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        For a batch of models, an airspeed of zero, a gradient or duration that is not above zero, an unknown output,
        and a response that does not fit into memory.
    """
    import xarray  # here, because it takes long to import

    if np.ndim(model.airspeed):
        raise InputError("model", f"batch of shape {model.airspeed.shape}", "must be one point")
    if not is_choice(component, COMPONENTS):
        raise InputError("component", component, f"must be {list_choices(COMPONENTS)}")
    distances = _positive("gradient", gradient, "m")
    sizes = np.broadcast_to(values_in_si(size, "m/s", "size").reshape(-1), distances.shape)
    time = _times(model, distances, float(_positive("duration", duration, "s")[0]))
    name = model.inputs[gust_input(model.inputs, component)]
    count = len(model.to_state_space().outputs) if outputs is None else len(outputs)
    asked = f"{len(distances)} gradients, {len(time)} times and {count} outputs"
    check_memory("gradient", asked, _BYTES * len(distances) * len(time) * count, "the response", "take fewer")
    gusts = np.array([_gust(time, *one, float(model.airspeed)) for one in zip(distances, sizes, strict=True)])
    found = [time_response(model, time, {name: gust}, outputs=outputs) for gust in gusts]
    response = xarray.concat([one.response for one in found], "gradient")
    unit = {"units": "output_unit"}
    return xarray.Dataset(
        {
            "response": response.assign_attrs(unit),
            "gust": (("gradient", "time"), gusts, {"units": "m/s"}),
            "highest": response.max("time").assign_attrs(unit),
            "lowest": response.min("time").assign_attrs(unit),
            "warning": found[0].warning,
            "reason": found[0].reason,
        },
        coords={"gradient": ("gradient", distances, {"units": "m"})},
        attrs=dict(found[0].attrs) | {"component": component, "input": name},
    )


def _positive(field: str, value: Any, unit: str) -> Array:
    found = values_in_si(value, unit, field).reshape(-1)
    if not len(found) or not (np.isfinite(found) & (found > 0)).all():
        raise InputError(field, value, "must be above zero")
    return found


def _times(model: LinearModel, distances: Array, duration: float) -> Array:
    """Return times from the start of the gusts, fine enough for the highest root and the shortest gust."""
    airspeed = float(model.airspeed)
    if not airspeed > 0:
        raise InputError("airspeed", airspeed, "must be above zero: the rotor flies through the gust")
    highest = float(np.nanmax(np.abs(eigenvalues(model).imag), initial=0.0))
    shortest = 2 * float(distances.min()) / airspeed / _PER_GUST
    step = min(shortest, 2 * np.pi / highest / _PER_CYCLE) if highest else shortest
    end = 2 * float(distances.max()) / airspeed + duration
    return step * np.arange(int(np.ceil(end / step)) + 1)


def _gust(time: Array, gradient: float, size: float, airspeed: float) -> Array:
    """Return the velocity of a gust at times."""
    way = airspeed * time
    return np.where(way < 2 * gradient, size / 2 * (1 - np.cos(np.pi * way / gradient)), 0.0)
