"""One smooth number that says whether every root at every airspeed has the damping wanted: a constraint for optimisers.

A flutter speed exists only where something becomes unstable, so a search for it fails at every good design. The growth
G = Re λ + ζ0 |λ| of each root exists at every design, negative where the root has the damping ratio ζ0. Many growths
become one by the sum of Kreisselmeier and Steinhauser (IFAC Symposium on Computer Aided Design of Control Systems,
Zürich 1979),

    C = max G + log Σ exp(ρ (G - max G)) / ρ,    max G ≤ C ≤ max G + log(n) / ρ,

over the n roots of all airspeeds; the second form of the sum does not overflow. C ≤ 0 says that no root grows.

The sum takes both roots of a pair, so that n stays the same where a pair parts into two real roots. Where two roots
a ± √d fall into one, the derivative of either has no bound, but the two terms make 2 exp(ρa) cosh(ρ Re √d), which
changes with the size of d: C has a kink there, and slopes of finite size on both sides.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from proprotor.datum import Datum
from proprotor.errors import InputError, check_finite
from proprotor.model import stamp
from proprotor.model.configuration import Configuration
from proprotor.model.linear_model import LinearModel
from proprotor.stability.kinds import FLUTTER, flies_free, kinds
from proprotor.stability.matching import Modes
from proprotor.stability.mode_names import moving
from proprotor.stability.modes import decomposition
from proprotor.stability.points import growth_rate
from proprotor.stability.root_error import growth, refined
from proprotor.stability.sensitivity import chosen_inputs, eigenvalue_rates
from proprotor.typing import Array, Dataset
from proprotor.units import in_metres_per_second

SHARPNESS = 100.0  # s: 1000 roots add 0.07 1/s at most
_AT_ONCE = 2000  # models of one batch


class _Roots(NamedTuple):
    """Roots of all airspeeds (speeds, states): the modes, refined; which of them count; how many are always zero."""

    modes: Modes
    counts: Array
    zero: int


def growth_constraint(
    case: Configuration,
    airspeeds: Any,
    wrt: Sequence[str] | None = None,
    *,
    level: float = 0.0,
    sharpness: float = SHARPNESS,
    **options: Any,
) -> Dataset:
    """Return the aggregated growth of all roots at some airspeeds, at or below zero where all are damped enough.

    The number exists at stable designs and at unstable ones. Roots that are zero at every airspeed, as those of a free
    azimuth and of an aircraft's place in the air, are left out; of an aircraft that flies free the pairs of flutter
    alone count, as for its flutter speed.

    Parameters
    ----------
    case : Case
    airspeeds : array (speeds,) in m/s, text such as "100:360:10kt", or pint quantity
        Where damping is wanted: up to 1.2 of the design dive speed, say. A root that grows between two of them only is
        not seen.
    wrt : sequence of str, optional
        Paths of inputs for derivatives, see `proprotor.deck.vary.design_inputs`; all by default, () for none.
    level : float
        Damping ratio that every root must have.
    sharpness : float
        ρ, s: how closely the largest growth is followed. The result lies above it by log(n)/ρ at most, never below.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    xarray.Dataset
        constraint, C in 1/s; derivative (input,), 1/s per SI unit of the input, with value, unit and status of each
        input, and exact, whether a complex step or a difference made it; largest (airspeed,), the largest growth of a
        root that counts, 1/s; mode and frequency (airspeed,) of this root; warning (airspeed,), what makes an airspeed
        doubtful. Attributes: level, sharpness, bound, log(n)/ρ in 1/s, counted, n, and left_out, how many roots are
        left out at each airspeed because they are always zero; case and options (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        For an unknown input or option, a level that is no damping ratio, a sharpness that is not above zero, and an
        airspeed that cannot be analysed, with the reason.
    """
    if not -1 < level < 1:
        raise InputError("level", level, "must be a damping ratio, between -1 and 1")
    check_finite("sharpness", sharpness, "above zero")
    inputs = chosen_inputs(case, wrt)
    speeds = np.atleast_1d(in_metres_per_second(airspeeds, stamp.one_density(case))).reshape(-1)
    if not speeds.size:
        raise InputError("airspeeds", airspeeds, "must be one airspeed or more")
    model = case.linearize(speeds, **options)
    for speed, reason in zip(speeds, model.trim.reason, strict=True):
        if reason:
            raise InputError("airspeed", f"{speed:.6g} m/s", str(reason))
    roots = _roots(model, flies_free(case))
    values = np.where(roots.counts, growth(roots.modes.values, level), -np.inf)
    constraint, weights = aggregate(values, sharpness)
    rates, exact = _rates(case, inputs, speeds, roots, model, options)
    each = np.where(roots.counts, weights * growth_rate(roots.modes.values, rates, level), 0.0)
    data = _dataset(inputs, each.sum(axis=(-2, -1)), exact)
    counted = int(roots.counts.sum())
    data["constraint"] = ((), constraint, {"units": "1/s", "long_name": "aggregated growth of all roots"})
    return _with_largest(data, model, roots, values).assign_attrs(
        stamp.of_case(case, options)
        | {
            "level": level,
            "sharpness": sharpness,
            "bound": math.log(counted) / sharpness,
            "counted": counted,
            "left_out": roots.zero,
        }
    )


def aggregate(values: Array, sharpness: float) -> tuple[float, Array]:
    """Return the sum of Kreisselmeier and Steinhauser of values of any shape, and its derivative by each value."""
    largest = values.max()
    powers = np.exp(sharpness * (values - largest))
    total = powers.sum()
    return float(largest + np.log(total) / sharpness), powers / total


def _roots(model: LinearModel, free: bool) -> _Roots:
    """Return the roots of all airspeeds, and which of them count."""
    every = decomposition(model).all_modes
    found = refined(model, every)
    modes = every._replace(values=found.values)
    size = np.abs(found.values)
    zero = int((size <= found.error).sum(axis=-1).min())
    # A root that passes through zero at one airspeed alone is no smaller there than those that are zero throughout.
    counts = size.argsort(axis=-1, kind="stable").argsort(axis=-1, kind="stable") >= zero
    if free:
        counts &= kinds(model, modes) == FLUTTER
    if not counts.any():
        raise InputError("case", None, "has no root that counts")
    return _Roots(modes, counts, zero)


def _rates(
    case: Configuration,
    inputs: Mapping[str, Datum],
    speeds: Array,
    roots: _Roots,
    model: LinearModel,
    options: Mapping[str, Any],
) -> tuple[Array, Array]:
    """Return the change of every root by every input (inputs, speeds, states), and which inputs took a complex step."""
    names = list(inputs)
    step = max(1, _AT_ONCE // len(speeds))
    rates = np.empty((len(names), *roots.modes.values.shape), dtype=complex)
    exact = np.ones(len(names), dtype=bool)
    for start in range(0, len(names), step):
        some = {name: inputs[name] for name in names[start : start + step]}
        part = slice(start, start + step)
        rates[part], exact[part] = eigenvalue_rates(case, some, speeds, roots.modes, model, options)
    return rates, exact


def _dataset(inputs: Mapping[str, Datum], derivative: Array, exact: Array) -> Dataset:
    """Return the dataset of the derivatives."""
    import xarray  # here, because it takes long to import

    per = {"units": "1/s per SI unit of the input"}
    return xarray.Dataset(
        {"derivative": ("input", derivative, per)},
        coords={
            "input": np.array(list(inputs), dtype=str),
            "value": ("input", np.array([float(number.si) for number in inputs.values()])),
            "unit": ("input", np.array([number.unit for number in inputs.values()], dtype=str)),
            "exact": ("input", exact),
            "status": ("input", np.array([number.status for number in inputs.values()], dtype=str)),
        },
    )


def _with_largest(data: Dataset, model: LinearModel, roots: _Roots, values: Array) -> Dataset:
    """Return the dataset with the largest growth at each airspeed, and the mode that has it."""
    rows = np.arange(len(values))
    place = values.argmax(axis=-1)
    names = moving(model, roots.modes.values, roots.modes.left, roots.modes.right).names
    frequency = np.abs(roots.modes.values[rows, place].imag)
    return data.assign(
        largest=("airspeed", values[rows, place], {"units": "1/s", "long_name": "largest growth"}),
        mode=(
            "airspeed",
            names[rows, place].astype(str),
            {"long_name": "what moves in the mode that has it"},
        ),
        frequency=("airspeed", frequency, {"units": "rad/s", "long_name": "of this mode"}),
        warning=(
            "airspeed",
            model.trim.warning.astype(str),
            {"long_name": "what makes an airspeed doubtful"},
        ),
    ).assign_coords(airspeed=("airspeed", np.asarray(model.airspeed, dtype=float), {"units": "m/s"}))
