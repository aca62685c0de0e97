"""The line along which a sweep runs: airspeeds or values of an input, in the unit that engineers use."""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np

from proprotor.model.stamp import density_of
from proprotor.plots.input_names import short_name
from proprotor.typing import Array, Dataset
from proprotor.units import KEAS, KTAS, airspeed_unit, factor_to_si, speed_factor

# Usual units of a quantity in rad/s, by the end of its name.
_RATES = {"rotor_speed": "rpm", "frequency": "Hz"}
_USUAL = {"rad": "deg", "m/s": "kt", "rad/s": "Hz"}
_AIRSPEEDS = ("airspeed", "flutter_speed")
_SYMBOLS = {"**2": "²", "**3": "³", "*": "·"}


class Positions(NamedTuple):
    """Positions along a line, and the label of their axis.

    name : dimension of the sweep, "airspeed" or the path of an input; values (points,) in `unit`; unit : as in decks;
    factor : the unit in SI units; label : of the axis.
    """

    name: str
    values: Array
    unit: str
    factor: float
    label: str


def positions(sweep: Dataset, unit: str | None = None) -> Positions:
    """Return the positions of the points of a sweep in a unit, by default the usual unit.

    Raises
    ------
    InputError
        If the unit is unknown, or does not fit the airspeed or the input.
    """
    name = str(sweep.eigenvalue.dims[0])
    density = density_of(sweep.attrs)
    return axis_of(name, sweep[name].values, sweep[name].attrs.get("units", ""), unit, density)


def with_gaps(leaps: Array, positions: Array, *values: Array) -> list[Array]:
    """Return positions and values (points,) with NaN inserted wherever the name of a mode leaps to another root.

    A line through the returned points has a gap where it would otherwise join two different roots.

    Parameters
    ----------
    leaps : array (points - 1,) of bool
        Leaps of one mode, see `proprotor.tables.sweep_summary.leaps`.
    positions, *values : array (points,)
    """
    at = np.flatnonzero(leaps)
    middle = (positions[at] + positions[at + 1]) / 2
    return [np.insert(positions, at + 1, middle), *(np.insert(of, at + 1, np.nan) for of in values)]


def axis_of(
    name: str, values: Array, si_unit: str, unit: str | None = None, density: float | None = None
) -> Positions:
    """Return values (points,) of an input or of an airspeed, in SI units, as positions of an axis; see `positions`.

    With a density of the air, kg/m³, the unit of an airspeed may be keas.
    """
    unit = _usual_unit(name, si_unit) if unit is None else unit
    short = short_name(name)
    short = short[:1].upper() + short[1:]
    if name in _AIRSPEEDS:
        unit, factor = airspeed_unit(unit), float(speed_factor(unit, density, field="unit"))
        label = f"{short}, {unit}" if unit in (KTAS, KEAS) else f"{short} ({unit}, true)"
        return Positions(name, values / factor, unit, factor, label)
    factor = 1.0 if unit == si_unit else factor_to_si(unit, unit, si_unit)
    return Positions(name, values / factor, unit, factor, short + (f" ({written(unit)})" if unit else ""))


def _usual_unit(name: str, si_unit: str) -> str:
    """Return the unit that engineers use for an input with this SI unit; the SI unit if there is no other."""
    if si_unit == "rad/s":
        return next((unit for end, unit in _RATES.items() if name.endswith(end)), "rad/s")
    return _USUAL.get(si_unit, si_unit)


def written(unit: str) -> str:
    """Return a unit as it is printed: N·m/rad for N*m/rad."""
    return re.sub(r"\*\*2|\*\*3|\*", lambda found: _SYMBOLS[found[0]], unit)
