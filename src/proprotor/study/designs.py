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
from proprotor.study.input_ranges import has_number
from proprotor.typing import Array

AIRSPEED = "airspeed"
DESIGN = "design"  # the dimension of a list or a sample
SPEED = Datum("", None, "m/s")  # airspeed is no number of the deck
_FACTOR = Datum("", 1.0, "")  # on several numbers of the deck, which vary together

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
        if DESIGN not in self.axes:
            return {name: (name, axis, {"units": self.units[name]}) for name, axis in self.axes.items()}
        own = {name: (DESIGN, array, {"units": self.units[name]}) for name, array in self.values.items()}
        return {DESIGN: (DESIGN, self.axes[DESIGN])} | own

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
    method : str
        "grid", "points", "latin hypercube", "sobol" or "saltelli".
    settings : mapping
        What else the function that makes the plan was given, such as size and seed.
    """

    inputs: Mapping[Any, Any]
    lay_out: Callable[[dict[Any, Any], Mapping[str, Datum]], Designs]
    read: Callable[[str, Any, Datum], Any]
    method: str = ""
    settings: Mapping[str, Any] = field(default_factory=dict)

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
        known = {**known, AIRSPEED: SPEED}
        for path in paths_of(self.inputs):
            check_input(path, known)
        read = {
            name: self.read(label_of(name), given, number_of(name, known))
            for name, given in self.inputs.items()
        }
        return self.lay_out(read, known)


def paths_of(inputs: Mapping[Any, Any]) -> list[str]:
    """Return every deck path of inputs, also each path of inputs that vary together."""
    return [path for name in inputs for path in ([name] if isinstance(name, str) else name)]


def label_of(name: _Path) -> str:
    """Return the name of an input for tables: the path, or the paths that vary together."""
    return name if isinstance(name, str) else ", ".join(name)


def number_of(name: _Path, known: Mapping[str, Datum]) -> Datum:
    """Return the number of the deck that an input varies, or the factor of several numbers."""
    if isinstance(name, str):
        return known[name]
    for path in name:
        if not has_number(known[path]):
            raise InputError(path, None, "must be a number of the deck, to vary together with others")
    return _FACTOR


def check_count(field: str, count: object) -> None:
    """Refuse anything but a whole number above zero."""
    if isinstance(count, bool) or not isinstance(count, int | np.integer) or count < 1:
        raise InputError(field, count, "must be a whole number above zero")
