"""Boundaries along a sweep, as plots mark them: which mode, where, and a value of the mode there."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from proprotor.tables.sweep_summary import unstable_ranges
from proprotor.typing import Array, Dataset


class _Boundary(NamedTuple):
    """A zero of the damping of a mode, interpolated between points of the sweep.

    mode : that is unstable beyond the boundary, or before it; place : along the sweep, in SI units; value : of the
    mode at the place, interpolated; onset : the mode becomes unstable in the direction of the sweep.
    """

    mode: str
    place: float
    value: float
    onset: bool


def boundaries_of(sweep: Dataset, values: Array) -> list[_Boundary]:
    """Return the boundaries of a sweep with the values (points, modes) at them, such as frequencies."""
    name = str(sweep.eigenvalue.dims[0])
    if name != "airspeed":  # `unstable_ranges` reads the line of a sweep under this name
        sweep = sweep.drop_vars("airspeed").rename({name: "airspeed"})
    along, branch = sweep.airspeed.values, sweep.branch.values
    found: list[_Boundary] = []
    for one in unstable_ranges(sweep):
        points, places = np.nonzero((branch == one.branch) & np.isfinite(values))
        order = np.argsort(along[points])
        x, y = along[points][order], values[points, places][order]
        for place, open_end, onset in ((one.start, one.open_start, True), (one.stop, one.open_stop, False)):
            if not open_end:
                found.append(_Boundary(one.mode, place, float(np.interp(place, x, y)), onset))
    return found
