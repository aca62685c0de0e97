"""The data of the lines on the page: one line for each mode, in the units of the axes."""

from __future__ import annotations

from typing import Any

import numpy as np
from proprotor_equations import FIXED_COORDINATES

from proprotor.explore.analysis import LiveModes
from proprotor.plots.line_of_sweep import with_gaps
from proprotor.plots.style import COLOURS, mode_places
from proprotor.rotor.motions import SECOND, is_of_loop, name_list

_DASHES = ("solid", "dashed", "dotted")
_ROTOR_NAMES = frozenset(name_list(FIXED_COORDINATES))  # modes with other names are modes of the support


def curves(found: LiveModes, rotor_speed: float, speed_unit: float) -> dict[str, list[Any]]:
    """Return the columns of Bokeh's source of lines, with a row for each mode.

    A line is broken where the name of its mode leaps to another root.

    Parameters
    ----------
    found : LiveModes
    rotor_speed : float
        rad/s, for frequencies per revolution.
    speed_unit : float
        Unit of the axis of airspeed, in m/s.
    """
    places = mode_places(found.names).values()
    turns = found.eigenvalue / rotor_speed
    unstable = {one.mode for one in found.unstable}
    broad = [
        name in unstable
        or not (name.removesuffix(SECOND) in _ROTOR_NAMES or is_of_loop(name.removesuffix(SECOND)))
        for name in found.names
    ]
    values = zip(found.leaps.T, found.damping.T, turns.real.T, np.abs(turns.imag).T, strict=True)
    lines = [with_gaps(leaps, found.airspeed / speed_unit, *of_mode) for leaps, *of_mode in values]
    axes = ("airspeed", "damping", "growth", "frequency")
    return {
        "mode": found.names,
        **{axis: [line[place].astype(np.float32) for line in lines] for place, axis in enumerate(axes)},
        "colour": [COLOURS[place % len(COLOURS)] for place in places],
        "dash": [_DASHES[place // len(COLOURS) % len(_DASHES)] for place in places],
        "width": [3.0 if one else 1.5 for one in broad],
    }


def ends(columns: dict[str, list[Any]]) -> dict[str, Any]:
    """Return the end of each root locus, at the highest airspeed that could be analysed: a marker for the reader."""
    at_end = np.full((2, len(columns["mode"])), np.nan, np.float32)
    for place, line in enumerate(zip(columns["growth"], columns["frequency"], strict=True)):
        works = np.flatnonzero(np.isfinite(line[0]))
        if len(works):
            at_end[:, place] = [axis[works[-1]] for axis in line]
    growth, frequency = at_end
    return {"mode": columns["mode"], "growth": growth, "frequency": frequency, "colour": columns["colour"]}
