"""Plans of which designs a study looks at: grids, lists, and samples of distributions.

A plan says how inputs vary, in any unit; with the numbers of a deck it becomes `Designs`, arrays in SI.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from proprotor.datum import Datum
from proprotor.errors import InputError
from proprotor.needs import check_memory, need
from proprotor.study.designs import DESIGN, Designs, Plan, check_count, label_of, paths_of
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

_MOST_DESIGNS = 100_000_000
# Of each design, while designs are laid out: the number drawn, its value, and a copy of both.
_BYTES_OF_INPUT = 32


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
    return _plan_of_values(inputs, _outer_product, "grid", {})


def points(inputs: Mapping[str, Any], drawn: bool = False) -> Plan:
    """Return the plan of designs given one by one: lists of equal lengths; a single value is that of every design.

    Parameters
    ----------
    inputs : mapping
        Lists by deck path, as for `grid`.
    drawn : bool
        Whether the caller has drawn the designs at random, so that their results have percentiles.

    Returns
    -------
    Plan
    """
    return _plan_of_values(
        inputs, partial(_side_by_side, drawn=drawn), "points", {"drawn": True} if drawn else {}
    )


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


def as_plan(inputs: Any) -> Plan:
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


def _plan_of_values(
    inputs: Mapping[str, Any], lay_out: Callable[..., Designs], method: str, settings: Mapping[str, Any]
) -> Plan:
    for name, given in inputs.items():
        if not isinstance(name, str):
            rule = "must be one input: several vary together only in a sample"
            raise InputError(label_of(name), given, rule)
    return Plan(dict(inputs), lay_out, read_values, method, settings)


def _outer_product(read: dict[str, Array], known: Mapping[str, Datum]) -> Designs:
    """Return every combination of the values of each input."""
    axes = {name: np.atleast_1d(values) for name, values in read.items()}
    designs = math.prod(len(axis) for axis in axes.values())
    _check_size("inputs", f"{designs:.4g} designs", designs, len(axes))
    values = [part.reshape(-1) for part in np.meshgrid(*axes.values(), indexing="ij")]
    along = axes or {DESIGN: np.arange(1)}  # a study of nothing but airspeeds
    return Designs(dict(zip(axes, values, strict=True)), along, _units(axes, known))


def _side_by_side(read: dict[str, Array], known: Mapping[str, Datum], drawn: bool) -> Designs:
    """Return the designs whose values stand at the same place of each list, and whether they were drawn at random.

    Raises
    ------
    InputError
        For lists of unequal lengths.
    """
    lengths = {name: values.size for name, values in read.items() if values.ndim}
    if len(set(lengths.values())) > 1:
        given = ", ".join(f"{name} has {length}" for name, length in lengths.items())
        raise InputError("inputs", given, "must be lists of equal lengths")
    size = max(lengths.values(), default=1)
    values = {name: np.broadcast_to(array, (size,)).copy() for name, array in read.items()}
    sample = {"method": "points", "size": size, "inputs": list(values)} if drawn else {}
    return Designs(values, {DESIGN: np.arange(size)}, _units(values, known), sample)


def _check_size(field: str, given: object, designs: int, inputs: int) -> None:
    """Refuse designs whose inputs do not fit into memory, before the designs are laid out."""
    if designs > _MOST_DESIGNS:
        raise InputError(field, given, f"must be at most {_MOST_DESIGNS} designs")
    size = float(_BYTES_OF_INPUT * designs * max(1, inputs))
    check_memory(field, given, size, f"the inputs of {designs:.4g} designs")


def _units(values: Mapping[str, Array], known: Mapping[str, Datum]) -> dict[str, str]:
    return {path: known[path].unit for path in values}


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
    _check_size("size", int(size), rows * int(size), len(paths_of(inputs)))

    def lay_out(read: dict[Any, Any], known: Mapping[str, Datum]) -> Designs:
        shares = draw(len(read), int(size), seed, **extra)
        labels = [label_of(name) for name in read]
        sample = {"method": method, "size": int(size), "seed": seed, "inputs": labels} | extra
        return _drawn(read, known, shares, sample)

    settings = {"size": int(size), "seed": seed} | extra
    return Plan(dict(inputs), lay_out, read_distribution, method, settings)


def _drawn(
    read: dict[Any, Any], known: Mapping[str, Datum], shares: Array, sample: dict[str, Any]
) -> Designs:
    """Return the designs of a sample.

    Parameters
    ----------
    read : dict
        A distribution, with a method ``ppf``, of each input.
    known : mapping
        The numbers of the deck by path.
    shares : array (designs, inputs)
        0 to 1: the share of each distribution that lies below the value of a design.
    sample : dict
        How the shares were drawn.
    """
    of_each = {
        name: np.asarray(distribution.ppf(column), dtype=float)
        for (name, distribution), column in zip(read.items(), shares.T, strict=True)
    }
    values = {name: found for name, found in of_each.items() if isinstance(name, str)}
    for name, factor in of_each.items():
        for path in () if isinstance(name, str) else name:
            values[path] = values.get(path, known[path].si) * factor
    return Designs(values, {DESIGN: np.arange(len(shares))}, _units(values, known), sample)


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
