"""Response of hub loads, hub motion and blades to gusts and to the swashplate, over frequency."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from proprotor.errors import InputError, check_known
from proprotor.model.linear_model import SWASHPLATE, LinearModel
from proprotor.model.state_space import LOADS, StateSpace
from proprotor.model.theodorsen import at_frequencies
from proprotor.needs import check_memory
from proprotor.rotor.motions import HUB, half_of, is_lift
from proprotor.stability.modes import doubt_and_failure, leading_dims
from proprotor.stability.root_error import roots
from proprotor.typing import Array, Dataset
from proprotor.units import values_in_si

_BYTES_PER_ENTRY = 48.0  # of a response: a complex number, its magnitude and phase, and a copy
_PER = {" rate": "/s", " acceleration": "/s**2"}  # by the end of an output's name
_BLOCK = 4096  # matrices solved at once


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

    omega = _frequencies(frequency)
    if lift not in (None, "theodorsen"):
        raise InputError("lift", lift, 'must be "theodorsen", or left out')
    late = None if lift is None else at_frequencies(model, omega)
    space = model.to_state_space()
    columns, rows = _places(inputs, space.inputs, "inputs"), _places(outputs, space.outputs, "outputs")
    count = space.A[..., 0, 0].size * omega.size
    asked = f"{omega.size} frequencies"
    size = _BYTES_PER_ENTRY * count * len(rows) * len(columns)
    check_memory("frequency", asked, size, "the response", "take fewer, or fewer inputs and outputs")
    found = _late_response(late, omega, rows, columns) if late else _response(space, omega, rows, columns)
    leading = leading_dims(model)
    dims = (*leading, "frequency", "output", "input")
    names, moved = [space.outputs[row] for row in rows], [space.inputs[column] for column in columns]
    unit = {"units": "output_unit / input_unit"}
    return xarray.Dataset(
        {
            "response": (dims, found, unit),
            "magnitude": (dims, np.abs(found), unit),
            "phase": (dims, np.angle(found), {"units": "rad"}),
            "stable": (leading, _stable(model)),
            **doubt_and_failure(model, leading),
        },
        coords={
            "frequency": ("frequency", omega, {"units": "rad/s"}),
            "output": names,
            "input": moved,
            "output_unit": ("output", [_unit_of(name) for name in names]),
            "input_unit": ("input", ["rad" if half_of(name)[1] in SWASHPLATE else "m/s" for name in moved]),
            "airspeed": (leading, model.airspeed, {"units": "m/s"}),
        },
        attrs=dict(space.stamp),
    )


def _frequencies(frequency: Any) -> Array:
    """Return frequencies (k,) in rad/s; raise an error for one that is negative or not finite."""
    omega = values_in_si(frequency, "rad/s", "frequency").reshape(-1)
    wrong = ~(np.isfinite(omega) & (omega >= 0))
    if wrong.any():
        raise InputError("frequency", omega[wrong][0], "must be finite and not negative")
    return omega


def _places(wanted: Sequence[str] | None, known: tuple[str, ...], what: str) -> list[int]:
    """Return the places of wanted names among known names; of all names where none is wanted."""
    names = known if wanted is None else (wanted,) if isinstance(wanted, str) else tuple(wanted)
    for name in names:
        check_known(what, name, known, what.removesuffix("s"))
    return [known.index(name) for name in names]


def _late_response(models: Iterator[LinearModel], omega: Array, rows: list[int], columns: list[int]) -> Array:
    """Return the response (..., frequencies, rows, columns) of models that hold at one frequency each."""
    found = [
        _response(model.to_state_space(), omega[place : place + 1], rows, columns)
        for place, model in enumerate(models)
    ]
    return np.concatenate(found, axis=-3)


def _response(space: StateSpace, omega: Array, rows: list[int], columns: list[int]) -> Array:
    """Return C (iω - A)⁻¹ B + D (..., frequencies, rows, columns)."""
    leading = space.A.shape[:-2]
    count = int(np.prod(leading, dtype=int))
    whole = space.A, space.B[..., columns], space.C[..., rows, :], space.D[..., rows, :][..., columns]
    a, b, c, d = (np.broadcast_to(m, (*leading, *m.shape[-2:])).reshape(count, *m.shape[-2:]) for m in whole)
    found = np.full((count, len(omega), len(rows), len(columns)), complex(np.nan, np.nan))
    for points, own in _alike(a):
        parts = a[points][:, own][:, :, own], b[points][:, own], c[points][:, :, own], d[points]
        found[points] = _of_alike(*parts, omega)
    return found.reshape(*leading, *found.shape[1:])


def _of_alike(a: Array, b: Array, c: Array, d: Array, omega: Array) -> Array:
    """Return C (iω - A)⁻¹ B + D (points, frequencies, rows, columns) of points with the same states."""
    found = np.empty((len(a), len(omega), *d.shape[1:]), dtype=complex)
    step = max(1, _BLOCK // max(len(a), 1))
    for start in range(0, len(omega), step):
        at = slice(start, start + step)
        turning = 1j * omega[at, None, None] * np.eye(a.shape[-1])
        found[:, at] = c[:, None] @ _solved(turning - a[:, None], b[:, None]) + d[:, None]
    return found


def _alike(systems: Array) -> Iterator[tuple[Array, Array]]:
    """Yield points (k,) of matrices (points, states, states) with the same states, and the states; no failed points."""
    present = np.isfinite(np.diagonal(systems, axis1=-2, axis2=-1))
    kinds, kind = np.unique(present, axis=0, return_inverse=True)
    for place, states in enumerate(kinds):
        points = np.flatnonzero(kind.reshape(-1) == place)
        own = np.flatnonzero(states)
        if not len(own):
            continue
        works = np.isfinite(systems[points][:, own][:, :, own]).all(axis=(-2, -1))
        yield points[works], own


def _solved(matrices: Array, loads: Array) -> Array:
    """Return solutions (points, frequencies, states, columns); NaN where a matrix is singular."""
    loads = np.broadcast_to(loads, (*matrices.shape[:-1], loads.shape[-1]))
    try:
        return np.linalg.solve(matrices, loads)
    except np.linalg.LinAlgError:  # one of them, at least, is singular
        solutions = np.full(loads.shape, np.nan, dtype=complex)
        for place in np.ndindex(matrices.shape[:-2]):
            try:
                solutions[place] = np.linalg.solve(matrices[place], loads[place])
            except np.linalg.LinAlgError:
                continue
        return solutions


def _stable(model: LinearModel) -> NDArray[np.bool_]:
    """Return at which points (...) every root decays, by more than its error."""
    values, error = roots(model)
    decays = (values.real < -error) | np.isnan(values)  # a state that a point does not have
    return np.asarray(decays.all(axis=-1) & np.isfinite(values).any(axis=-1))


def _unit_of(output: str) -> str:
    """Return the SI unit of an output by its name."""
    name = half_of(output)[1]
    if name in LOADS:
        return "N" if name.startswith("force") else "N*m"
    per = next((unit for ending, unit in _PER.items() if name.endswith(ending)), "")
    length = name.split(" ")[0] in HUB[:3] or is_lift(name.removesuffix(" rate"))
    return ("m" if length else "rad") + per
