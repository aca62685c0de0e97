"""Plans of which designs a study looks at: grids, lists, and samples of distributions.

A plan says how inputs vary, in any unit; with the numbers of a deck it becomes `Designs`, arrays in SI.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from proprotor.datum import Datum
from proprotor.errors import InputError
from proprotor.needs import need
from proprotor.study.designs import (
    Designs,
    Plan,
    check_count,
    check_size,
    drawn,
    label_of,
    outer_product,
    paths_of,
    side_by_side,
)
from proprotor.study.input_ranges import LogRange, Normal, Range, Relative, read_distribution, read_values
from proprotor.typing import Array

__all__ = [
    "Designs",
    "LogRange",
    "Normal",
    "Plan",
    "Range",
    "Relative",
    "as_plan",
    "grid",
    "latin_hypercube",
    "points",
    "saltelli",
    "sobol",
]


def grid(inputs: Mapping[str, Any]) -> Plan:
    """Return the plan of every combination of the values of each input.

    Parameters
    ----------
    inputs : mapping
        Values by deck path (``"rotor.precone"``): numbers in SI, a pint quantity, text with a unit, or a list of
        numbers, quantities or texts; ``"1:4:0.5 deg"`` is 1 to 4 deg by 0.5 deg.

    Returns
    -------
    Plan
    """
    return _plan_of_values(inputs, outer_product)


def points(inputs: Mapping[str, Any]) -> Plan:
    """Return the plan of designs given one by one: lists of equal lengths; a single value is that of every design.

    Parameters
    ----------
    inputs : mapping
        Lists by deck path, as for `grid`.

    Returns
    -------
    Plan
    """
    return _plan_of_values(inputs, side_by_side)


def latin_hypercube(inputs: Mapping[Any, Any], size: int, seed: int = 0) -> Plan:
    """Return the plan of a Latin hypercube sample (scipy.stats.qmc.LatinHypercube) of independent inputs.

    Parameters
    ----------
    inputs : mapping
        By deck path a pair of limits in any unit, a `Range`, `LogRange`, `Normal` or `Relative`, or a frozen
        distribution of scipy.stats in SI. A tuple of paths varies together by one factor, whose distribution is
        dimensionless: ``{("rotor.chord", "rotor.mass"): (0.9, 1.1)}``. Where a path has several factors, they multiply.
    size : int
        Number of designs.
    seed : int

    Returns
    -------
    Plan
    """
    return _sampled("latin hypercube", inputs, size, seed, partial(_draw, "LatinHypercube"))


def sobol(inputs: Mapping[Any, Any], size: int, seed: int = 0) -> Plan:
    """Return the plan of a scrambled Sobol sequence (scipy.stats.qmc.Sobol) of independent inputs.

    Parameters
    ----------
    inputs : mapping
        As for `latin_hypercube`.
    size : int
        Number of designs, a power of two.
    seed : int

    Returns
    -------
    Plan

    Raises
    ------
    InputError
        When the size is no power of two, without which the sequence loses its balance.
    """
    _check_power_of_two(size)
    return _sampled("sobol", inputs, size, seed, partial(_draw, "Sobol"))


def saltelli(inputs: Mapping[Any, Any], size: int, seed: int = 0, second_order: bool = False) -> Plan:
    """Return the plan of the sample from which `proprotor.sobol_indices` are found: size · (k + 2) designs, k inputs.

    Parameters
    ----------
    inputs : mapping
        As for `latin_hypercube`.
    size : int
        Number of base samples, a power of two.
    seed : int
    second_order : bool
        Whether to add the designs that interactions of two inputs need: size · (2k + 2) designs.

    Returns
    -------
    Plan

    Raises
    ------
    InputError
        When the size is no power of two, or SALib is not installed.
    """
    need("SALib", "sample", "Saltelli samples", "study")
    _check_power_of_two(size)
    return _sampled("saltelli", inputs, size, seed, _draw_saltelli, second_order=second_order)


def as_plan(inputs: Plan | Mapping[str, Any]) -> Plan:
    """Return a plan as it is, and a mapping as a `grid`.

    Parameters
    ----------
    inputs : Plan or mapping

    Returns
    -------
    Plan

    Raises
    ------
    InputError
        For anything else.
    """
    if isinstance(inputs, Plan):
        return inputs
    if isinstance(inputs, Mapping):
        return grid(inputs)
    rule = "must be a mapping of deck paths to values, or a plan of proprotor.sampling"
    raise InputError("inputs", inputs, rule)


def _plan_of_values(inputs: Mapping[str, Any], lay_out: Callable[..., Designs]) -> Plan:
    for name, given in inputs.items():
        if not isinstance(name, str):
            rule = "must be one input: several vary together only in a sample"
            raise InputError(label_of(name), given, rule)
    return Plan(dict(inputs), lay_out, read_values)


# Samples ------------------------------------------------------------------------------------------


def _sampled(
    method: str, inputs: Mapping[Any, Any], size: int, seed: int, draw: Callable[..., Array], **extra: Any
) -> Plan:
    """Return the plan of a sample, whose shares `draw` finds once the plan is resolved."""
    if not inputs:
        raise InputError("inputs", None, "must have at least one input to sample")
    check_count("size", size)
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise InputError("seed", seed, "must be a whole number, not negative")
    rows = {"saltelli": (2 if extra.get("second_order") else 1) * len(inputs) + 2}.get(method, 1)
    check_size("size", int(size), rows * int(size), len(paths_of(inputs)))

    def lay_out(read: dict[Any, Any], known: Mapping[str, Datum]) -> Designs:
        shares = draw(len(read), int(size), seed, **extra)
        labels = [label_of(name) for name in read]
        sample = {"method": method, "size": int(size), "seed": seed, "inputs": labels} | extra
        return drawn(read, known, shares, sample)

    return Plan(dict(inputs), lay_out, read_distribution)


def _draw(engine: str, inputs: int, size: int, seed: int) -> Array:
    """Return shares (size, inputs) drawn by an engine of scipy.stats.qmc."""
    from scipy.stats import qmc

    return np.asarray(getattr(qmc, engine)(inputs, rng=seed).random(size))


def _draw_saltelli(inputs: int, size: int, seed: int, second_order: bool) -> Array:
    from SALib.sample import sobol as salib_sobol

    unit = {"num_vars": inputs, "names": [str(place) for place in range(inputs)], "bounds": [[0, 1]] * inputs}
    return np.asarray(salib_sobol.sample(unit, size, calc_second_order=second_order, seed=seed))


def _check_power_of_two(size: int) -> None:
    if not isinstance(size, int | np.integer) or size < 1 or size & (size - 1):
        raise InputError("size", size, "must be a power of two, such as 1024")
