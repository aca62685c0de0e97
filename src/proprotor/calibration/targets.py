"""The numbers of test points that a mode of a case has to meet, each with its standard error."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from proprotor.errors import InputError
from proprotor.model.configuration import Configuration
from proprotor.tables.points import DAMPING, FREQUENCY, Points, Quantity
from proprotor.units import KEAS, speed_factor


class Target(NamedTuple):
    """A measured number of a mode.

    airspeed : m/s; mode : name; quantity : "frequency" (damped, rad/s) or "damping" (ratio); value, error : SI
    """

    airspeed: float
    mode: str
    quantity: str
    value: float
    error: float


def targets_of(points: Points, case: Configuration, mode: str | None = None) -> tuple[Target, ...]:
    """Return the targets in test points.

    Parameters
    ----------
    points : Points
    case : Case
        For equivalent airspeeds and frequencies per revolution.
    mode : str, optional
        Of points whose file names no mode.

    Raises
    ------
    InputError
        Without columns for the airspeed and for frequency or damping, for a point without a mode, and a number without
        an error bar.
    """
    density, rotor_speed = case.operation.density, case.operation.rotor_speed
    across = Quantity("airspeed", "m/s", 1.0, {"keas": float(speed_factor(KEAS, density))})
    up = (Quantity(FREQUENCY, "rad/s", 1.0, {"per rev": float(rotor_speed)}), Quantity(DAMPING, ""))
    points.check(across, up)
    found = [target for quantity in up for target in _of_quantity(points, across, quantity, mode)]
    if not found:
        raise InputError(
            "points", points.name, "must have a point with an airspeed and a frequency or a damping"
        )
    return tuple(found)


def _of_quantity(points: Points, across: Quantity, up: Quantity, mode: str | None) -> Iterator[Target]:
    """Yield the targets in the column of a quantity; none where the file has no such column."""
    columns = points.on_axes(across, up)
    if columns is None:
        return
    x, y = columns
    for place in np.flatnonzero(np.isfinite(x.values) & np.isfinite(y.values)):
        name = str(points.mode[place]) or mode
        where = f"{points.name}, point {place + 1}"
        if not name:
            raise InputError("points", where, "must name its mode in a column mode, or mode must be given")
        error = float(y.high[place] - y.low[place]) / 2
        if not error > 0:
            rule = (
                f"needs the error of its {up.name}, in a column {up.name}_error, by which points are weighted"
            )
            raise InputError("points", where, rule)
        yield Target(float(x.values[place]), name, up.name, float(y.values[place]), error)
