"""A box of inputs: every input of a case between two limits."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from typing import Any, NamedTuple

import numpy as np

from proprotor.case import Case
from proprotor.datum import Datum
from proprotor.deck.vary import inputs_at
from proprotor.errors import InputError
from proprotor.study import sampling
from proprotor.study.input_ranges import LogRange, Range, read_distribution
from proprotor.typing import Array

_MOST_CORNERS = 256  # that are all tried: of a box of eight inputs
_AT_LIMIT = 1e-9  # of the width of the box: what counts as lying on its side


class Box(NamedTuple):
    """Numbers of a deck by path, with their limits (inputs,) in SI.

    A place in the box is an array (inputs,) of numbers from 0, at the lower limit, to 1.
    """

    known: Mapping[str, Datum]
    low: Array
    high: Array

    @property
    def width(self) -> Array:
        """Difference of the limits (inputs,), SI."""
        return np.asarray(self.high - self.low)

    def values(self, places: Array) -> dict[str, Array]:
        """Return the inputs (designs,) by path at places (designs, inputs); at a limit exactly the limit."""
        values = np.where(places == 1, self.high, self.low + places * self.width)
        return dict(zip(self.known, values.T, strict=True))

    def sides(self, place: Array) -> list[str]:
        """Return "low", "high" or "inside" for each input of a place."""
        return [
            "low" if at <= _AT_LIMIT else "high" if at >= 1 - _AT_LIMIT else "inside" for at in place.tolist()
        ]

    @property
    def has_few_corners(self) -> bool:
        """Whether all corners can be tried."""
        return bool(2 ** len(self.known) <= _MOST_CORNERS)

    @property
    def corners(self) -> Array:
        """All corners (designs, inputs) of a box that has few; none of a box that has many."""
        count = len(self.known)
        all_corners = product((0.0, 1.0), repeat=count if self.has_few_corners else 0)
        return np.array(list(all_corners) if self.has_few_corners else []).reshape(-1, count)

    def inside(self, size: int, seed: int) -> Array:
        """Return places (size, inputs) that fill the box evenly, by a Sobol sequence."""
        unit = sampling.sobol(dict.fromkeys(self.known, sampling.Range(0.0, 1.0)), size, seed)
        drawn = unit.resolve(dict.fromkeys(self.known, Datum("", None, "")))
        return np.stack(list(drawn.values.values()), axis=-1)


def box_of(case: Case, limits: Mapping[str, Any]) -> Box:
    """Return the box of some limits.

    Parameters
    ----------
    case : Case
    limits : mapping
        By deck path a pair of limits in any unit, or a `Range`, `LogRange` or `Relative` of `proprotor.sampling`.

    Raises
    ------
    InputError
        For an unknown input, and a distribution without ends.
    """
    if not limits:
        raise InputError("box", None, "must have at least one input with its limits")
    known, ends = inputs_at(case, limits), []
    for path, given in limits.items():
        read = read_distribution(path, given, known[path])
        if not isinstance(read, Range | LogRange):
            raise InputError(
                path, given, "must have two limits: a distribution without ends has no worst design"
            )
        ends.append((read.low, read.high))
    low, high = np.array(ends, dtype=float).T
    return Box(known, low, high)
