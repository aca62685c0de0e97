"""Spectra and root mean squares of the outputs of a model in turbulence."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from proprotor.errors import InputError
from proprotor.model.linear_model import LinearModel
from proprotor.model.state_space import StateSpace
from proprotor.responses.spectral_integral import rule_for
from proprotor.responses.turbulence import Turbulence
from proprotor.rotor.motions import in_half
from proprotor.stability.modes import doubt_and_failure, leading_dims
from proprotor.stability.transfer import (
    System,
    decays_everywhere,
    frequencies_in_si,
    places_of,
    system_at,
    transfer,
    unit_of_output,
)
from proprotor.typing import Array, Dataset

_INPUTS = {"vertical": "gust_x", "lateral": "gust_y", "longitudinal": "gust_z"}
# Of two rotors: the left one has mirrored axes, in which a velocity sideways is the opposite.
_HALVES = {"vertical": "symmetric", "lateral": "antisymmetric", "longitudinal": "symmetric"}
_UNSTABLE = "a mode is not damped: turbulence leads to no steady state"
_SHOWN = 300  # frequencies of the spectra where the caller names none


def gust_input(inputs: Sequence[str], component: str) -> int:
    """Return the place of the input through which a gust acts on all rotors evenly.

    Parameters
    ----------
    inputs : sequence of str
        Of a model.
    component : "vertical", "lateral" or "longitudinal"

    Raises
    ------
    InputError
        For a model without this input.
    """
    names = (_INPUTS[component], in_half(_HALVES[component], _INPUTS[component]))
    found = [place for place, name in enumerate(inputs) if name in names]
    if not found:
        rule = f"needs an input {' or '.join(names)}; the model has {', '.join(inputs)}"
        raise InputError("component", component, rule)
    return found[0]


def gust_response(
    model: LinearModel,
    turbulence: Turbulence | None = None,
    *,
    frequency: Any = None,
    outputs: Sequence[str] | None = None,
) -> Dataset:
    """Return spectral densities and root mean squares of outputs in turbulence that acts on the rotor.

    Parameters
    ----------
    model : LinearModel
        Leading axes of a batch are kept; each point meets the turbulence at its own airspeed.
    turbulence : Turbulence, optional
        Vertical, of von Kármán's spectrum, with 1 m/s by default.
    frequency : array (frequencies,) in rad/s, text such as "0.1:10:0.1 Hz", or pint quantity, optional
        Where to give the spectra; by default 300 frequencies up to the highest root.
    outputs : sequence of str, optional
        Names of outputs of `StateSpace`; all by default.

    Returns
    -------
    xarray.Dataset
        psd (..., frequency, output), one-sided, in the output's unit squared per rad/s; rms (..., output) in the
        output's unit, over all frequencies from zero; gust_psd (..., frequency); stable (...); warning and reason
        (...). NaN with a reason where a point failed or has a mode that is not damped. Attributes: spectrum,
        component, intensity (m/s), scale (m), the case and its options (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        For an unknown output, a frequency that is negative or not finite, a model without inputs, and at an airspeed of
        zero, where frozen turbulence stands still.
    """
    import xarray  # here, because it takes long to import

    own = Turbulence() if turbulence is None else turbulence
    space = model.to_state_space()
    column, rows = gust_input(space.inputs, own.component), places_of(outputs, space.outputs, "outputs")
    airspeed = np.broadcast_to(np.real(model.airspeed), space.A.shape[:-2])
    if not (airspeed > 0).all():
        raise InputError(
            "airspeed", float(airspeed.min()), "must be above zero: turbulence is frozen in space"
        )
    omega = _shown(space) if frequency is None else frequencies_in_si(frequency)
    stable = decays_everywhere(model)
    psd = np.full((*airspeed.shape, len(omega), len(rows)), np.nan)
    rms, gust = np.full((*airspeed.shape, len(rows)), np.nan), np.empty((*airspeed.shape, len(omega)))
    for point in np.ndindex(airspeed.shape):
        speed = float(airspeed[point])
        gust[point] = own.density(omega, speed)
        if stable[point]:
            at_point = system_at(space, point)
            psd[point] = _gain(at_point, omega, rows, column) * gust[point][:, None]
            rms[point] = _rms(at_point, rows, column, own, speed)
    leading, names = leading_dims(model), [space.outputs[row] for row in rows]
    told = doubt_and_failure(model, leading)
    reason = np.where((told["reason"][1] == "") & ~stable, _UNSTABLE, told["reason"][1])
    return xarray.Dataset(
        {
            "psd": ((*leading, "frequency", "output"), psd, {"units": "output_unit**2*s/rad"}),
            "rms": ((*leading, "output"), rms, {"units": "output_unit"}),
            "gust_psd": ((*leading, "frequency"), gust, {"units": "m**2/s/rad"}),
            "stable": (leading, stable),
            **told,
            "reason": (leading, reason, {"long_name": "why a point failed"}),
        },
        coords={
            "frequency": ("frequency", omega, {"units": "rad/s"}),
            "output": names,
            "output_unit": ("output", [unit_of_output(name) for name in names]),
            "airspeed": (leading, model.airspeed, {"units": "m/s"}),
        },
        attrs=dict(space.stamp)
        | {
            "spectrum": own.spectrum,
            "component": own.component,
            "intensity": own.intensity,
            "scale": own.scale,
        },
    )


def _gain(system: System, omega: Array, rows: list[int], column: int) -> Array:
    """Return |H|² (frequencies, outputs) from a gust to outputs."""
    return np.abs(transfer(system, omega, rows, [column])[..., 0]) ** 2


def _rms(system: System, rows: list[int], column: int, own: Turbulence, airspeed: float) -> Array:
    """Return root mean squares (outputs,)."""
    roots = np.append(np.linalg.eigvals(system.A), -airspeed / own.scale)
    rule = rule_for(roots)
    density = _gain(system, rule.frequency, rows, column) * own.density(rule.frequency, airspeed)[:, None]
    return np.asarray(np.sqrt(rule.weight @ density))


def _shown(space: StateSpace) -> Array:
    """Return frequencies up to the highest root of all points, those of the roots among them."""
    own = np.abs(np.linalg.eigvals(np.nan_to_num(space.A)).imag).ravel()
    highest = float(own.max())
    spread = np.geomspace(1e-3 * highest, 1.1 * highest, _SHOWN)
    return np.unique(np.concatenate([spread, own[own > spread[0]] if space.A.ndim == 2 else []]))
