"""The designs of a study, and plans that say how inputs vary before the numbers of the deck are known."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from proprotor.datum import Datum
from proprotor.deck.vary import check_input
from proprotor.errors import InputError
from proprotor.needs import check_memory
from proprotor.study.input_ranges import has_number
from proprotor.typing import Array

AIRSPEED = "airspeed"
_DESIGN = "design"  # the dimension of a list or a sample
_SPEED = Datum("", None, "m/s")  # airspeed is no number of the deck
_FACTOR = Datum("", 1.0, "")  # on several numbers of the deck, which vary together
_MOST_DESIGNS = 100_000_000
# Of each design, while designs are laid out: the number drawn, its value, and a copy of both.
_BYTES_OF_INPUT = 32

_Path = str | tuple[str, ...]  # of one input, or of several that vary together


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
        How a sample was drawn: method, size, seed and inputs; empty for grids and lists.
    """

    values: dict[str, Array]
    axes: dict[str, Array]
    units: dict[str, str]
    sample: dict[str, Any] = field(default_factory=dict)

    def __len__(self) -> int:
        return math.prod(self.shape)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of designs along each axis."""
        return tuple(len(axis) for axis in self.axes.values())

    @property
    def coordinates(self) -> dict[str, tuple[Any, ...]]:
        """Coordinates of an `xarray.Dataset` over the axes: the inputs, with units."""
        if _DESIGN not in self.axes:
            return {name: (name, axis, {"units": self.units[name]}) for name, axis in self.axes.items()}
        own = {name: (_DESIGN, array, {"units": self.units[name]}) for name, array in self.values.items()}
        return {_DESIGN: (_DESIGN, self.axes[_DESIGN])} | own

    @property
    def attributes(self) -> dict[str, str]:
        """Attributes of a dataset of results, from which a sample can be analysed."""
        return {"sample": json.dumps(self.sample)} if self.sample else {}


@dataclass(frozen=True)
class Plan:
    """How inputs vary; made by `grid`, `points`, `latin_hypercube`, `sobol` or `saltelli`.

    Parameters
    ----------
    inputs : mapping
        The values or distributions as the user gave them, by deck path, or by the tuple of paths that vary together by
        one factor.
    lay_out : callable
        Returns the designs, from the inputs that were read and the numbers of the deck by path.
    read : callable
        Returns an input in SI, from its label, the value or distribution of the user, and the number of the deck.
    """

    inputs: Mapping[Any, Any]
    lay_out: Callable[[dict[Any, Any], Mapping[str, Datum]], Designs]
    read: Callable[[str, Any, Datum], Any]

    def resolve(self, known: Mapping[str, Datum]) -> Designs:
        """Return the designs in SI.

        Parameters
        ----------
        known : mapping
            The numbers of the inputs that may vary, such as `proprotor.design_inputs(case)`; ``airspeed`` always may.

        Returns
        -------
        Designs

        Raises
        ------
        InputError
            For an unknown path, with the nearest one, a value of another dimension, lists of unequal lengths, or a
            factor on an input that has no number in the deck.
        """
        known = {**known, AIRSPEED: _SPEED}
        for path in paths_of(self.inputs):
            check_input(path, known)
        read = {
            name: self.read(label_of(name), given, _number(name, known))
            for name, given in self.inputs.items()
        }
        return self.lay_out(read, known)


def paths_of(inputs: Mapping[Any, Any]) -> list[str]:
    """Return every deck path of inputs, also each path of inputs that vary together."""
    return [path for name in inputs for path in ([name] if isinstance(name, str) else name)]


def label_of(name: _Path) -> str:
    """Return the name of an input for tables: the path, or the paths that vary together."""
    return name if isinstance(name, str) else ", ".join(name)


def _number(name: _Path, known: Mapping[str, Datum]) -> Datum:
    """Return the number of the deck that an input varies, or the factor of several numbers."""
    if isinstance(name, str):
        return known[name]
    for path in name:
        if not has_number(known[path]):
            raise InputError(path, None, "must be a number of the deck, to vary together with others")
    return _FACTOR


def outer_product(read: dict[str, Array], known: Mapping[str, Datum]) -> Designs:
    """Return every combination of the values of each input."""
    axes = {name: np.atleast_1d(values) for name, values in read.items()}
    designs = math.prod(len(axis) for axis in axes.values())
    check_size("inputs", f"{designs:.4g} designs", designs, len(axes))
    values = [part.reshape(-1) for part in np.meshgrid(*axes.values(), indexing="ij")]
    along = axes or {_DESIGN: np.arange(1)}  # a study of nothing but airspeeds
    return Designs(dict(zip(axes, values, strict=True)), along, _units(axes, known))


def side_by_side(read: dict[str, Array], known: Mapping[str, Datum]) -> Designs:
    """Return the designs whose values stand at the same place of each list.

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
    return Designs(values, {_DESIGN: np.arange(size)}, _units(values, known))


def drawn(read: dict[Any, Any], known: Mapping[str, Datum], shares: Array, sample: dict[str, Any]) -> Designs:
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
    return Designs(values, {_DESIGN: np.arange(len(shares))}, _units(values, known), sample)


def _units(values: Mapping[str, Array], known: Mapping[str, Datum]) -> dict[str, str]:
    return {path: known[path].unit for path in values}


def check_size(field: str, given: object, designs: int, inputs: int) -> None:
    """Refuse designs whose inputs do not fit into memory, before the designs are laid out."""
    if designs > _MOST_DESIGNS:
        raise InputError(field, given, f"must be at most {_MOST_DESIGNS} designs")
    size = float(_BYTES_OF_INPUT * designs * max(1, inputs))
    check_memory(field, given, size, f"the inputs of {designs:.4g} designs")


def check_count(field: str, count: object) -> None:
    """Refuse anything but a whole number above zero."""
    if isinstance(count, bool) or not isinstance(count, int | np.integer) or count < 1:
        raise InputError(field, count, "must be a whole number above zero")
