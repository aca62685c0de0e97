"""Response of hub loads, hub motion and blades to gusts and to the swashplate, over frequency."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from proprotor.errors import InputError
from proprotor.model.linear_model import LinearModel
from proprotor.model.theodorsen import at_frequencies
from proprotor.needs import check_memory
from proprotor.stability.modes import doubt_and_failure, leading_dims
from proprotor.stability.transfer import (
    decays_everywhere,
    frequencies_in_si,
    places_of,
    transfer,
    unit_of_input,
    unit_of_output,
)
from proprotor.typing import Array, Dataset

_BYTES_PER_ENTRY = 48.0  # of a response: a complex number, its magnitude and phase, and a copy


def frequency_response(
    model: LinearModel,
    frequency: Any,
    *,
    inputs: Sequence[str] | None = None,
    outputs: Sequence[str] | None = None,
    lift: str | None = None,
) -> Dataset:
    """Return the steady response to an input of one frequency: output = response × input, both e^{iωt}.

    The same as `StateSpace.to_control` gives to python-control, for whole batches and with names and units. Where the
    model is unstable no steady state is ever reached: see `stable`.

    Parameters
    ----------
    model : LinearModel
        Leading axes of a batch are kept.
    frequency : array (frequencies,) in rad/s, text such as "3 Hz" or "1:5:0.1 Hz", or pint quantity
        Frequencies of the excitation; not negative.
    inputs, outputs : sequence of str, optional
        Names of inputs and outputs of `StateSpace`; all by default.
    lift : "theodorsen", optional
        Let the lift of blades and wing come late by Theodorsen's function C(k) itself, at the frequencies that each
        section meets, in place of states that follow it closely. For a model of a case with lift at once, whose modes
        `stable` then speaks of.

    Returns
    -------
    xarray.Dataset
        response (..., frequency, output, input), complex, in the output's unit per unit of the input; magnitude and
        phase (rad) of the response; stable (...), whether every mode is damped; warning and reason (...) of points that
        are doubtful, and of points that failed. Attributes: the case and its options (`proprotor.model.stamp`).
        Coordinates: frequency, output_unit, input_unit, airspeed. NaN where a point failed, or where a frequency is
        that of an undamped mode.

    Raises
    ------
    InputError
        For an unknown name, a frequency that is negative or not finite, a model without inputs, a response that does
        not fit into memory, or a model that `lift` does not go with.
    """
    import xarray  # here, because it takes long to import

    omega = frequencies_in_si(frequency)
    if lift not in (None, "theodorsen"):
        raise InputError("lift", lift, 'must be "theodorsen", or left out')
    late = None if lift is None else at_frequencies(model, omega)
    space = model.to_state_space()
    columns, rows = places_of(inputs, space.inputs, "inputs"), places_of(outputs, space.outputs, "outputs")
    count = space.A[..., 0, 0].size * omega.size
    asked = f"{omega.size} frequencies"
    size = _BYTES_PER_ENTRY * count * len(rows) * len(columns)
    check_memory("frequency", asked, size, "the response", "take fewer, or fewer inputs and outputs")
    found = _late_response(late, omega, rows, columns) if late else transfer(space, omega, rows, columns)
    leading = leading_dims(model)
    dims = (*leading, "frequency", "output", "input")
    names, moved = [space.outputs[row] for row in rows], [space.inputs[column] for column in columns]
    unit = {"units": "output_unit / input_unit"}
    return xarray.Dataset(
        {
            "response": (dims, found, unit),
            "magnitude": (dims, np.abs(found), unit),
            "phase": (dims, np.angle(found), {"units": "rad"}),
            "stable": (leading, decays_everywhere(model)),
            **doubt_and_failure(model, leading),
        },
        coords={
            "frequency": ("frequency", omega, {"units": "rad/s"}),
            "output": names,
            "input": moved,
            "output_unit": ("output", [unit_of_output(name) for name in names]),
            "input_unit": ("input", [unit_of_input(name) for name in moved]),
            "airspeed": (leading, model.airspeed, {"units": "m/s"}),
        },
        attrs=dict(space.stamp),
    )


def _late_response(models: Iterator[LinearModel], omega: Array, rows: list[int], columns: list[int]) -> Array:
    """Return the response (..., frequencies, rows, columns) of models that hold at one frequency each."""
    found = [
        transfer(model.to_state_space(), omega[place : place + 1], rows, columns)
        for place, model in enumerate(models)
    ]
    return np.concatenate(found, axis=-3)
