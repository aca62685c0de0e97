"""What a sweep runs along: airspeeds, or an input of the deck, in the unit that people use."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from proprotor.plots.input_names import short_name
from proprotor.typing import Array
from proprotor.units import factor_to_si

if TYPE_CHECKING:
    import xarray

_RATES = {"rotor_speed": "rpm", "frequency": "Hz"}  # of rad/s, by what it is
_USUAL = {"rad": "deg", "m/s": "kt", "rad/s": "Hz"}
_SYMBOLS = {"**2": "²", "**3": "³", "*": "·"}


class Positions(NamedTuple):
    """Positions along a line, and what to write on the axis.

    name : dimension of the sweep, "airspeed" or the path of an input; values (points,) in `unit`; unit : as decks have
    it; factor : how many SI units that is; label : of the axis.
    """

    name: str
    values: Array
    unit: str
    factor: float
    label: str


def positions(sweep: xarray.Dataset, unit: str | None = None) -> Positions:
    """Where the points of a sweep lie, in a unit, by default the usual one.

    Raises
    ------
    InputError
        When the unit is unknown, or not one of what varies.
    """
    name = str(sweep.eigenvalue.dims[0])
    return axis_of(name, sweep[name].values, sweep[name].attrs.get("units", ""), unit)


def with_gaps(leaps: Array, positions: Array, *values: Array) -> list[Array]:
    """Positions and values (points,) with one more position, without values, wherever a name leaps to another root.

    Parameters
    ----------
    leaps : array (points - 1,) of bool
        Of one mode, see `proprotor.tables.sweep_summary.leaps`.
    positions, *values : array (points,)
    """
    at = np.flatnonzero(leaps)
    middle = (positions[at] + positions[at + 1]) / 2
    return [np.insert(positions, at + 1, middle), *(np.insert(of, at + 1, np.nan) for of in values)]


def axis_of(name: str, values: Array, si_unit: str, unit: str | None = None) -> Positions:
    """Values of an input or of the airspeed for an axis; see `positions`."""
    unit = usual_unit(name, si_unit) if unit is None else unit
    factor = 1.0 if unit == si_unit else factor_to_si(unit, unit, si_unit)
    told = "Airspeed" if name == "airspeed" else short_name(name)
    return Positions(name, values / factor, unit, factor, with_unit(told, unit))


def usual_unit(name: str, si_unit: str) -> str:
    """The unit in which the field thinks of an input with this SI unit; SI where there is none."""
    last = name.rpartition(".")[2]
    if si_unit == "rad/s":
        return next((unit for end, unit in _RATES.items() if last.endswith(end)), "rad/s")
    return _USUAL.get(si_unit, si_unit)


def with_unit(told: str, unit: str) -> str:
    """A label with its unit in brackets, if it has one."""
    return f"{told[:1].upper()}{told[1:]} ({written(unit)})" if unit else f"{told[:1].upper()}{told[1:]}"


def written(unit: str) -> str:
    """A unit as it is printed: N·m/rad for N*m/rad."""
    return re.sub(r"\*\*2|\*\*3|\*", lambda found: _SYMBOLS[found[0]], unit)
