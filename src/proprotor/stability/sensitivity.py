"""Exact derivatives of eigenvalues, damping and flutter speed by the inputs of a case.

Every input is moved by a complex step, all of them in one batch of models, through trim, airloads, springs and support:
the imaginary parts of the matrices are their derivatives to rounding. The change of an eigenvalue follows from its two
vectors without another eigenvalue problem. A boundary G(V, p) = 0 moves by dV/dp = -G_p / G_V; with the level of no
damping that is -Re λ_p / Re λ_V.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import compress
from typing import Any

import numpy as np

from proprotor.datum import Datum
from proprotor.deck.vary import design_inputs, inputs_at
from proprotor.deck.vary import vary as vary_case
from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.configuration import Configuration
from proprotor.model.linear_model import LinearModel
from proprotor.model.options_of_result import options_of
from proprotor.stability.boundary import Boundary
from proprotor.stability.eigenvalue_derivatives import (
    STEP,
    defect,
    differences,
    eigenvalue_change,
    matrix_derivatives,
)
from proprotor.stability.flutter import boundary_of, flutter_point
from proprotor.stability.matching import Modes
from proprotor.stability.modes import decomposition
from proprotor.stability.named_modes import doubtful_numbers, named_modes
from proprotor.stability.points import growth_rate
from proprotor.stability.root_error import refined
from proprotor.typing import Array, Dataset

_QUANTITIES = ("flutter_speed", "damping", "eigenvalue")
_NEARLY_DEFECTIVE = 10.0  # times the defect of a mode that nothing couples


def _input_rates(
    linearize: Callable[[Mapping[str, Array]], LinearModel],
    values: Mapping[str, float],
    model: LinearModel,
    modes: Modes,
) -> Array:
    """Return derivatives of eigenvalues by many inputs (inputs, ..., modes), from one batch of models.

    Parameters
    ----------
    linearize : callable
        Models for arrays (inputs, ...) of the inputs by name, analytic in them.
    values : mapping of str to float
        Values of the inputs at which the derivatives are wanted.
    model : LinearModel
        The model at these values; one point, or one for each airspeed (...,).
    modes : Modes
        Modes of the model.
    """
    count = len(values)
    number = np.arange(count).reshape(-1, *[1] * (modes.values.ndim - 1))
    moved = {
        name: value + 1j * STEP * (number == place) for place, (name, value) in enumerate(values.items())
    }
    return eigenvalue_change(model, matrix_derivatives(linearize(moved)), modes)


def damping_rate(values: Array, changes: Array) -> Array:
    """Return the change of the damping ratio -Re λ/|λ| with a change of λ; NaN for a root at zero."""
    size = np.abs(values)
    with np.errstate(all="ignore"):
        turned = values.real * (values.conj() * changes).real / size**3
        return np.where(size > 0, -changes.real / size + turned, np.nan)


def sensitivity(
    case: Configuration,
    of: str = "flutter_speed",
    wrt: Sequence[str] | None = None,
    *,
    airspeed: Any = None,
    mode: str | None = None,
    level: float = 0.0,
    **options: Any,
) -> Dataset:
    """Return exact derivatives by inputs of a case's deck.

    Parameters
    ----------
    case : Case
    of : "flutter_speed", "damping" or "eigenvalue"
        Damping is the ratio -Re λ/|λ|.
    wrt : sequence of str, optional
        Paths of inputs, see `proprotor.deck.vary.design_inputs`; all by default.
    airspeed : float in m/s, text such as "300 kt", or pint quantity
        Airspeed of damping or eigenvalues; for the flutter speed optionally the airspeeds of the scan.
    mode : str, optional
        One mode by what moves at the airspeed; all by default. For the flutter speed the first boundary, onset or
        end, of the mode with this name, instead of the lowest onset of any mode.
    level : float
        Damping ratio that counts as the boundary of the flutter speed.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    xarray.Dataset
        derivative (input,) or (input, mode), SI units per SI unit of the input; relative, the derivative times the
        input: the change per change of the input by its own size; value, unit and status of every input; exact, whether
        its matrices were derived by a complex step or, for numbers of a file, by extrapolated differences; defect
        and nearly_defective of the modes (`proprotor.stability.eigenvalue_derivatives.defect`): derivatives of a nearly
        defective mode hold in a small range only. For the flutter speed also frequency_derivative, of the frequency at
        the boundary as it moves. warning is what makes the numbers doubtful. Attributes: of, its value where there is
        one, eigen_solves, and the case and its options (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        For an unknown quantity, input, mode or option, or where nothing becomes unstable.
    """
    if of not in _QUANTITIES:
        raise InputError("of", of, f"must be one of {', '.join(_QUANTITIES)}")
    inputs = chosen_inputs(case, wrt)
    if of == "flutter_speed":
        return _of_flutter_speed(case, inputs, airspeed, mode, level, options)
    if airspeed is None:
        raise InputError("airspeed", None, f"must be given for the {of}")
    return _of_modes(case, of, inputs, airspeed, mode, options)


def chosen_inputs(case: Configuration, wrt: Sequence[str] | None) -> dict[str, Datum]:
    """Return the inputs of a case at some paths, in their order; all inputs if no paths are given.

    Raises
    ------
    InputError
        For an unknown path, or a case that was not made from a deck.
    """
    if wrt is not None and not len(wrt):
        return {}
    return design_inputs(case) if wrt is None else inputs_at(case, wrt)


def eigenvalue_rates(
    case: Configuration,
    inputs: Mapping[str, Datum],
    airspeed: float | Array,
    modes: Modes,
    model: LinearModel,
    options: Any,
) -> tuple[Array, Array]:
    """Return derivatives of eigenvalues (inputs, ..., modes), and which inputs (inputs,) took a complex step.

    Parameters
    ----------
    case : Case
    inputs : mapping of str to Datum
        By path.
    airspeed : float or array (...)
        m/s.
    modes : Modes
        Of the model (..., modes).
    model : LinearModel
        The case at the airspeed (...).
    options : mapping
        See `proprotor.rotor.options.Options`.

    Raises
    ------
    InputError
        For an unknown option, or a number that is not physical.
    """

    def linearize(values: Mapping[str, Array]) -> LinearModel:
        return vary_case(case, values).linearize(airspeed, **options)

    def by_differences(path: str) -> Array:
        changes = differences(lambda value: linearize({path: value}), np.array(values[path]))
        return eigenvalue_change(model, changes, modes)

    values = {path: float(number.si) for path, number in inputs.items()}
    try:
        return _input_rates(linearize, values, model, modes), np.ones(len(values), dtype=bool)
    except InputError:
        exact = np.array([_takes_complex(case, path, value) for path, value in values.items()])
        if exact.all():  # something else is wrong
            raise
    rates = np.empty((len(values), *modes.values.shape), dtype=complex)
    if exact.any():
        rates[exact] = _input_rates(linearize, dict(compress(values.items(), exact)), model, modes)
    for place in np.flatnonzero(~exact):
        rates[place] = by_differences(list(values)[place])
    return rates, exact


def _takes_complex(case: Configuration, path: str, value: float) -> bool:
    try:
        vary_case(case, {path: np.array(value + 1j * STEP)})
    except InputError:
        return False
    return True


def _of_flutter_speed(
    case: Configuration,
    inputs: Mapping[str, Datum],
    airspeeds: Any,
    mode: str | None,
    level: float,
    options: Mapping[str, Any],
) -> Dataset:
    found = flutter_point(case, airspeeds, level=level, **options)
    return at_boundary(case, boundary_of(found, mode), inputs, options, found.eigen_solves)


def at_boundary(
    case: Configuration,
    boundary: Boundary,
    inputs: Mapping[str, Datum],
    options: Mapping[str, Any],
    eigen_solves: int = 0,
) -> Dataset:
    """Return derivatives of the airspeed of one boundary, see `sensitivity`, by one more eigen-solve for the vectors.

    The level and the options are the boundary's own; options may be repeated.

    Raises
    ------
    InputError
        For another case or another option than the boundary's.
    """
    options = options_of(boundary.stamp, case, options)
    speed, level = boundary.position, boundary.level
    model = case.linearize(speed, **options)
    spectrum = decomposition(model)
    modes = spectrum.modes(spectrum.nearest(np.array([boundary.eigenvalue])))
    rates, exact = eigenvalue_rates(case, inputs, speed, modes, model, options)
    rates = rates[:, 0]
    moves = -growth_rate(modes.values, rates, level) / boundary.rate
    frequency = rates.imag + boundary.eigenvalue_rate.imag * moves
    data = _dataset(inputs, moves, "m/s", exact, defect(modes)[0], boundary.warning)
    data["frequency_derivative"] = ("input", frequency, {"units": "rad/s per SI unit of the input"})
    data.attrs = dict(boundary.stamp) | {
        "of": "flutter_speed",
        "value": speed,
        "units": "m/s",
        "mode": boundary.mode,
        "branch": boundary.branch,
        "level": level,
        "eigen_solves": eigen_solves + 1,
    }
    return data


def _of_modes(
    case: Configuration,
    of: str,
    inputs: Mapping[str, Datum],
    airspeed: Any,
    mode: str | None,
    options: Mapping[str, Any],
) -> Dataset:
    names, modes, model, speed = named_modes(case, airspeed, mode, options)
    rates, exact = eigenvalue_rates(case, inputs, speed, modes, model, options)
    value, units = modes.values, "rad/s"
    if of == "damping":
        root = refined(model, modes)
        at_zero = np.abs(root.values) <= root.error
        value, units = np.where(at_zero, np.nan, -modes.values.real / np.abs(modes.values)), "1"
        rates = np.where(at_zero, np.nan, damping_rate(modes.values, rates))
    data = _dataset(inputs, rates, units, exact, defect(modes), model.trim.warning).assign_coords(mode=names)
    data[of] = ("mode", value, {"units": units})
    data.attrs = stamp.of_model(model) | {"of": of, "airspeed": speed, "eigen_solves": 1}
    return data


def _dataset(
    inputs: Mapping[str, Datum], derivative: Array, units: str, exact: Array, defects: Array, warning: Any
) -> Dataset:
    """Return the dataset of derivatives (inputs,) of a boundary, or (inputs, modes), with the defect of each mode."""
    import xarray  # here, because it takes long to import

    size = np.array([float(number.si) for number in inputs.values()])
    per = {"units": f"{units} per SI unit of the input"}
    dims = ("input", "mode")[: derivative.ndim]
    relative = derivative * size.reshape(-1, *[1] * (derivative.ndim - 1))
    return xarray.Dataset(
        {
            "derivative": (dims, derivative, per),
            "relative": (dims, relative, {"units": units}),
            "defect": (dims[1:], defects),
            "nearly_defective": (dims[1:], defects > _NEARLY_DEFECTIVE),
            "warning": doubtful_numbers(warning),
        },
        coords={
            "input": list(inputs),
            "value": ("input", size),
            "unit": ("input", [number.unit for number in inputs.values()]),
            "exact": ("input", exact),
            "status": ("input", [number.status for number in inputs.values()]),
        },
    )
