"""Which designs a study looks at: grids, lists, and samples of distributions.

A plan says how inputs vary, in any unit; with the numbers of a deck it becomes `Designs`, arrays in SI.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sized
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol

import numpy as np

from proprotor.datum import Datum
from proprotor.errors import InputError, unknown_name
from proprotor.needs import check_memory, need
from proprotor.typing import Array

AIRSPEED = "airspeed"
DESIGN = "design"  # the dimension of a list or a sample
_MOST_DESIGNS = 100_000_000
_BYTES_OF_INPUT = (
    32  # of each design, while designs are laid out: what was drawn, its value, and a copy of both
)


class Quantity(Protocol):
    """What a plan needs to know of an input: its value in the deck, and its SI unit."""

    @property
    def si(self) -> Any:
        """Value in the deck, in SI units."""
        ...

    @property
    def unit(self) -> str:
        """SI unit."""
        ...


_SPEED = Datum("", None, "m/s")  # airspeed is no number of the deck


class Range(NamedTuple):
    """Any value between two, all equally likely; numbers are in SI.

    Parameters
    ----------
    low, high : float, text with a unit, or pint quantity
    """

    low: Any
    high: Any

    def ppf(self, share: Array) -> Array:
        """The value below which a share lies.

        Parameters
        ----------
        share : array (...)
            0 to 1, dimensionless.

        Returns
        -------
        array (...)
            In the unit of the limits, SI once it is resolved.
        """
        value: Array = self.low + (self.high - self.low) * share
        return value


class Normal(NamedTuple):
    """A normal distribution by its mean and standard deviation, in any unit of the input.

    Parameters
    ----------
    mean, deviation : float, text with a unit, or pint quantity
        The deviation is that of the distribution; numbers are in SI.
    """

    mean: Any
    deviation: Any

    def ppf(self, share: Array) -> Array:
        """The value below which a share lies.

        Parameters
        ----------
        share : array (...)
            0 to 1, dimensionless.

        Returns
        -------
        array (...)
            In the unit of the limits, SI once it is resolved.
        """
        from scipy.special import ndtri

        value: Array = self.mean + self.deviation * ndtri(share)
        return value


class Relative(NamedTuple):
    """Any value between two multiples of what the deck has: ``Relative(0.9, 1.1)`` is 10 % either way.

    Parameters
    ----------
    low, high : float
        Factors, dimensionless.
    """

    low: float
    high: float


@dataclass(frozen=True, eq=False)
class Designs:
    """Designs of a study, in SI.

    Attributes
    ----------
    values : dict of array (designs,)
        Each input by its deck path, SI; all of one length, the last axis of a grid fastest.
    axes : dict of array
        Values of each input along its own axis of a grid, SI; ``{"design": 0, 1, 2, …}`` for lists and samples.
    units : dict of str
    sample : dict
        How a sample was drawn: method, size, seed and what is needed to analyse it; empty for grids and lists.
    """

    values: dict[str, Array]
    axes: dict[str, Array]
    units: dict[str, str]
    sample: dict[str, Any] = field(default_factory=dict)

    def __len__(self) -> int:
        return int(np.prod(self.shape, dtype=int))

    @property
    def shape(self) -> tuple[int, ...]:
        """Designs along each axis."""
        return tuple(len(axis) for axis in self.axes.values())

    @property
    def coordinates(self) -> dict[str, tuple[Any, ...]]:
        """Coordinates of an `xarray.Dataset` over the axes: its inputs, with units."""
        if DESIGN not in self.axes:
            return {name: (name, axis, {"units": self.units[name]}) for name, axis in self.axes.items()}
        own = {name: (DESIGN, array, {"units": self.units[name]}) for name, array in self.values.items()}
        return {DESIGN: (DESIGN, self.axes[DESIGN])} | own

    @property
    def attributes(self) -> dict[str, str]:
        """Attributes of such a dataset, from which a sample can be analysed."""
        return {"sample": json.dumps(self.sample)} if self.sample else {}


@dataclass(frozen=True)
class Plan:
    """How inputs vary; made by `grid`, `points`, `latin_hypercube`, `sobol` or `saltelli`.

    Parameters
    ----------
    inputs : mapping
        As they were given, by deck path.
    lay_out : callable
        Designs from the values that were read and their SI units.
    read : callable
        A value in SI from an input's name, what was given, and the `Quantity` of the deck.
    """

    inputs: Mapping[str, Any]
    lay_out: Callable[[dict[str, Any], dict[str, str]], Designs]
    read: Callable[[str, Any, Quantity], Any]

    def resolve(self, known: Mapping[str, Quantity]) -> Designs:
        """The designs in SI.

        Parameters
        ----------
        known : mapping
            The inputs that may vary, such as `proprotor.design_inputs(case)`; ``airspeed`` always may.

        Returns
        -------
        Designs

        Raises
        ------
        InputError
            For an unknown path, with the nearest one, a value of another dimension, or lists of unequal lengths.
        """
        known = {**known, AIRSPEED: _SPEED}
        for name in self.inputs:
            if name not in known:
                raise InputError(name, None, unknown_name(name, known, "input"))
        read = {name: self.read(name, given, known[name]) for name, given in self.inputs.items()}
        return self.lay_out(read, {name: known[name].unit for name in self.inputs})


def grid(inputs: Mapping[str, Any]) -> Plan:
    """Every combination of the values of each input.

    Parameters
    ----------
    inputs : mapping
        Values by deck path (``"rotor.precone"``): numbers in SI, a pint quantity, text with a unit, or a list of them;
        ``"1:4:0.5 deg"`` is 1 to 4 deg by 0.5 deg.

    Returns
    -------
    Plan
    """
    return Plan(dict(inputs), _outer_product, _values)


def points(inputs: Mapping[str, Any]) -> Plan:
    """Designs given one by one: lists of equal lengths; a single value is that of every design.

    Parameters
    ----------
    inputs : mapping
        Lists by deck path, as for `grid`.

    Returns
    -------
    Plan
    """
    return Plan(dict(inputs), _side_by_side, _values)


def latin_hypercube(inputs: Mapping[str, Any], size: int, seed: int = 0) -> Plan:
    """A Latin hypercube sample (scipy.stats.qmc.LatinHypercube) of independent inputs.

    Parameters
    ----------
    inputs : mapping
        By deck path a pair of limits in any unit, a `Range`, `Normal` or `Relative`, or a frozen distribution of
        scipy.stats in SI.
    size : int
        Number of designs.
    seed : int

    Returns
    -------
    Plan
    """
    return _sampled("latin hypercube", inputs, size, seed, _draw_latin_hypercube)


def sobol(inputs: Mapping[str, Any], size: int, seed: int = 0) -> Plan:
    """A scrambled Sobol sequence (scipy.stats.qmc.Sobol) of independent inputs, as `latin_hypercube`.

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
    return _sampled("sobol", inputs, size, seed, _draw_sobol)


def saltelli(inputs: Mapping[str, Any], size: int, seed: int = 0, second_order: bool = False) -> Plan:
    """The sample from which `proprotor.sobol_indices` are found: size · (k + 2) designs for k inputs.

    Parameters
    ----------
    inputs : mapping
        As for `latin_hypercube`.
    size : int
        Number of base samples, a power of two.
    seed : int
    second_order : bool
        Also what interactions of two inputs need: size · (2k + 2) designs.

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
    """A plan as it is, and a mapping as a `grid`.

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
    raise InputError(
        "inputs", inputs, "must be a mapping of deck paths to values, or a plan of proprotor.study.sampling"
    )


# Reading ------------------------------------------------------------------------------------------


def _values(name: str, given: Any, known: Quantity) -> Array:
    """Values of an input in SI, one dimension; a single value has none."""
    from proprotor.units import values_in_si  # here, because pint takes long to import

    values = values_in_si(given, known.unit, name)
    if values.ndim > 1:
        raise InputError(name, f"array of shape {values.shape}", "must be a value or a list of values")
    if not values.size:
        raise InputError(name, given, "must have at least one value")
    return values


def _distribution(name: str, given: Any, known: Quantity) -> Any:
    """Something with a ppf in SI."""
    if hasattr(given, "ppf") and not isinstance(given, Range | Normal):
        return given
    if isinstance(given, Relative):
        is_number = np.isscalar(known.si) and not isinstance(known.si, str)
        if not is_number:
            raise InputError(name, given, "must be given in absolute terms: the deck has no such number")
        return Range(*sorted(float(factor) * known.si for factor in given))
    is_pair = (
        not isinstance(given, str) and np.iterable(given) and isinstance(given, Sized) and len(given) == 2
    )
    if not is_pair:
        rule = "must be a pair of limits, a Range, Normal or Relative, or a distribution of scipy.stats"
        raise InputError(name, given, rule)
    first, second = (float(_values(name, value, known)) for value in given)
    if isinstance(given, Normal):
        if not second > 0:
            raise InputError(name, second, "must have a standard deviation above zero")
        return Normal(first, second)
    if not first < second:
        raise InputError(name, given, "must have its lower limit first")
    return Range(first, second)


# Laying out ---------------------------------------------------------------------------------------


def _outer_product(read: dict[str, Array], units: dict[str, str]) -> Designs:
    axes = {name: np.atleast_1d(values) for name, values in read.items()}
    designs = math.prod(len(axis) for axis in axes.values())
    _check_size("inputs", f"{designs:.4g} designs", designs, len(axes))
    grids = np.meshgrid(*axes.values(), indexing="ij")
    return Designs(
        {name: grid.reshape(-1) for name, grid in zip(axes, grids, strict=True)}, _axes_of(axes), units
    )


def _axes_of(axes: dict[str, Array]) -> dict[str, Array]:
    return axes or {DESIGN: np.arange(1)}  # a study of nothing but airspeeds


def _side_by_side(read: dict[str, Array], units: dict[str, str]) -> Designs:
    lengths = {name: values.size for name, values in read.items() if values.ndim}
    if len(set(lengths.values())) > 1:
        told = ", ".join(f"{name} has {length}" for name, length in lengths.items())
        raise InputError("inputs", told, "must be lists of equal lengths")
    size = max(lengths.values(), default=1)
    values = {name: np.broadcast_to(array, (size,)).copy() for name, array in read.items()}
    return Designs(values, {DESIGN: np.arange(size)}, units)


def _sampled(
    method: str, inputs: Mapping[str, Any], size: int, seed: int, draw: Callable[..., Array], **extra: Any
) -> Plan:
    if not inputs:
        raise InputError("inputs", None, "must have at least one input to sample")
    if isinstance(size, bool) or not isinstance(size, int | np.integer) or size < 1:
        raise InputError("size", size, "must be a whole number above zero")
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise InputError("seed", seed, "must be a whole number, not negative")
    rows = {"saltelli": (2 if extra.get("second_order") else 1) * len(inputs) + 2}.get(method, 1)
    _check_size("size", int(size), rows * int(size), len(inputs))

    def lay_out(read: dict[str, Any], units: dict[str, str]) -> Designs:
        shares = draw(len(read), int(size), seed, **extra)
        values = {
            name: np.asarray(distribution.ppf(column), dtype=float)
            for (name, distribution), column in zip(read.items(), shares.T, strict=True)
        }
        drawn = {"method": method, "size": int(size), "seed": seed, "inputs": list(read)} | extra
        return Designs(values, {DESIGN: np.arange(len(shares))}, units, drawn)

    return Plan(dict(inputs), lay_out, _distribution)


def _draw_latin_hypercube(inputs: int, size: int, seed: int) -> Array:
    from scipy.stats import qmc

    shares: Array = qmc.LatinHypercube(inputs, rng=seed).random(size)
    return shares


def _draw_sobol(inputs: int, size: int, seed: int) -> Array:
    from scipy.stats import qmc

    shares: Array = qmc.Sobol(inputs, rng=seed).random(size)
    return shares


def _draw_saltelli(inputs: int, size: int, seed: int, second_order: bool) -> Array:
    from SALib.sample import sobol as salib_sobol

    unit = {"num_vars": inputs, "names": [str(place) for place in range(inputs)], "bounds": [[0, 1]] * inputs}
    shares: Array = salib_sobol.sample(unit, size, calc_second_order=second_order, seed=seed)
    return shares


def _check_power_of_two(size: int) -> None:
    if not isinstance(size, int | np.integer) or size < 1 or size & (size - 1):
        raise InputError("size", size, "must be a power of two, such as 1024")


def _check_size(field: str, given: object, designs: int, inputs: int) -> None:
    """Refuse more designs than there is memory for their inputs, before any are laid out."""
    if designs > _MOST_DESIGNS:
        raise InputError(field, given, f"must be at most {_MOST_DESIGNS} designs")
    size = float(_BYTES_OF_INPUT * designs * max(1, inputs))
    check_memory(field, given, size, f"the inputs of {designs:.4g} designs")
