"""Outputs over time for inputs that run linearly between samples.

For such inputs the state at the next sample follows exactly from the exponential of one matrix,

    x(t+h) = e^{Ah} x(t) + Γ0 u(t) + Γ1 (u(t+h) - u(t)),

whose blocks Γ0 = ∫ e^{As} ds B and Γ1 the exponential of A, B and the input's rate in one matrix has (Van Loan, IEEE
Trans. Automatic Control 23, 395, 1978).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from proprotor.errors import InputError, check_known
from proprotor.model.linear_model import LinearModel
from proprotor.needs import check_memory
from proprotor.stability.modes import doubt_and_failure, leading_dims
from proprotor.stability.transfer import places_of, system_at, unit_of_input, unit_of_output
from proprotor.typing import Array, Dataset
from proprotor.units import values_in_si

_UNEVEN = 1e-6  # of a step
_BYTES = 24.0  # of a number of the response, with copies


def time_response(
    model: LinearModel,
    time: Any,
    inputs: Mapping[str, Any] | None = None,
    *,
    impulses: Mapping[str, float] | None = None,
    outputs: Sequence[str] | None = None,
) -> Dataset:
    """Return outputs over time from rest, for inputs that run linearly between samples.

    Parameters
    ----------
    model : LinearModel
        Leading axes of a batch are kept.
    time : array (samples,) in s, text such as "0:5:0.01 s", or pint quantity
        From the start, in even steps.
    inputs : mapping of str to float or array (samples,), optional
        By name, SI (rad of the swashplate, m/s of gusts), a number for a step at the start.
    impulses : mapping of str to float, optional
        Impulses at the start by the name of the input: integral over time, SI. What an impulse makes of an output that
        follows its input at once, as hub loads do, lasts for that moment and is left out.
    outputs : sequence of str, optional
        Names of outputs of `StateSpace`; all by default.

    Returns
    -------
    xarray.Dataset
        response (..., time, output) in the output's unit, exact at the samples to rounding; input_over_time (time,
        input_name); warning and reason (...). NaN where a point failed. Attributes: the case and its options
        (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        For an unknown input or output, an input of another length, times that do not run in even steps, and a response
        that does not fit into memory.
    """
    import xarray  # here, because it takes long to import

    samples = _even(time)
    space = model.to_state_space()
    rows = places_of(outputs, space.outputs, "outputs")
    run = _inputs_over(samples, inputs or {}, space.inputs)
    moment = np.zeros(len(space.inputs))
    for name, value in (impulses or {}).items():
        check_known("impulses", name, space.inputs, "input")
        moment[space.inputs.index(name)] = float(values_in_si(value, unit_of_input(name), name))
    leading = leading_dims(model)
    shape = (*space.A.shape[:-2], len(samples), len(rows))
    remedy = "take fewer samples, or fewer outputs"
    check_memory("time", f"{len(samples)} samples", _BYTES * float(np.prod(shape)), "the response", remedy)
    response = np.full(shape, np.nan)
    for point in np.ndindex(shape[:-2]):
        a, b, c, d = system_at(space, point)
        if len(a) and np.isfinite(a).all():
            states = _states(a, b, run, moment, float(samples[1] - samples[0]))
            response[point] = states @ c[rows].T + run @ d[rows].T
    names = [space.outputs[row] for row in rows]
    moved = [name for name in space.inputs if name in (inputs or {}) or name in (impulses or {})]
    return xarray.Dataset(
        {
            "response": ((*leading, "time", "output"), response, {"units": "output_unit"}),
            "input_over_time": (("time", "input_name"), run[:, [space.inputs.index(name) for name in moved]]),
            **doubt_and_failure(model, leading),
        },
        coords={
            "time": ("time", samples, {"units": "s"}),
            "output": names,
            "output_unit": ("output", [unit_of_output(name) for name in names]),
            "input_name": moved,
            "airspeed": (leading, model.airspeed, {"units": "m/s"}),
        },
        attrs=dict(space.stamp),
    )


def _even(time: Any) -> Array:
    """Return times in s, or refuse times that do not run in even steps."""
    samples = values_in_si(time, "s", "time").reshape(-1)
    steps = np.diff(samples)
    if len(samples) < 2 or not np.isfinite(samples).all() or not (steps > 0).all():
        raise InputError("time", None, "must be two times or more that rise")
    if np.ptp(steps) > _UNEVEN * steps.mean() + 1e-12 * np.abs(samples).max():
        raise InputError("time", None, "must run in even steps")
    return samples


def _inputs_over(samples: Array, given: Mapping[str, Any], known: Sequence[str]) -> Array:
    """Return all inputs at the samples (samples, inputs)."""
    run = np.zeros((len(samples), len(known)))
    for name, value in given.items():
        check_known("inputs", name, known, "input")
        own = values_in_si(value, unit_of_input(name), name)
        if own.shape not in ((), (len(samples),)) or not np.isfinite(own).all():
            rule = f"must be one number, or a finite number for each of {len(samples)} times"
            raise InputError(name, f"array of shape {own.shape}", rule)
        run[:, known.index(name)] = own
    return run


def _states(a: Array, b: Array, run: Array, moment: Array, step: float) -> Array:
    """Return the states at the samples (samples, states)."""
    from scipy.linalg import expm  # here, because scipy.linalg takes long to import

    states, inputs = b.shape
    whole = np.zeros((states + 2 * inputs, states + 2 * inputs))
    whole[:states, :states], whole[:states, states : states + inputs] = a * step, b * step
    whole[states : states + inputs, states + inputs :] = np.eye(inputs)
    power = expm(whole)
    forward = power[:states, :states]
    steady, rising = power[:states, states : states + inputs], power[:states, states + inputs :]
    driven = run[:-1] @ steady.T + np.diff(run, axis=0) @ rising.T
    found = np.empty((len(run), states))
    found[0] = b @ moment
    for place, add in enumerate(driven):
        found[place + 1] = forward @ found[place] + add
    return found
