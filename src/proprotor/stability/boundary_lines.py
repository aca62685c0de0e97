"""The lines of a stability map, divided where another mode takes over, each named after the mode that is neutral."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise, starmap
from typing import Any, NamedTuple

import numpy as np

from proprotor.errors import InputError
from proprotor.model.configuration import Configuration
from proprotor.model.first_order import some_points
from proprotor.model.options_of_result import options_of
from proprotor.rotor.motions import name_list
from proprotor.stability.branches import names_of
from proprotor.stability.matching import Spectrum, conjugate, match_modes
from proprotor.stability.modes import decomposition
from proprotor.stability.parameter_lines import AIRSPEED, models_at
from proprotor.typing import Array, Dataset
from proprotor.units import in_metres_per_second


class BoundaryLine(NamedTuple):
    """A line along which one mode is neutral.

    Parameters
    ----------
    mode : str
        What moves in the mode at the middle of the line.
    x, y : array (vertices,)
        Vertices in SI, as the axes of the map.
    frequency : array (vertices,)
        Frequency of the mode, rad/s.
    warning : array of str
        (vertices,): what makes a vertex doubtful; empty where nothing does.
    """

    mode: str
    x: Array
    y: Array
    frequency: Array
    warning: Array = np.empty(0, dtype=str)


def boundary_lines(
    case: Configuration, found: Dataset, *, airspeed: Any = None, **options: Any
) -> list[BoundaryLine]:
    """Return the lines of a stability map by mode.

    The root that is neutral at a vertex is followed to the next by its vectors; its name is taken from the middle of
    each line. Where one mode takes over from another, the step from the last vertex of the first mode belongs to the
    second.

    Parameters
    ----------
    case : Case
    found : xarray.Dataset
        Of `Case.stability_map`.
    airspeed : float in m/s, text such as "300 kt", or pint quantity, optional
        The airspeed of the map, which need not be repeated.
    **options
        The options of the map, see `proprotor.rotor.options.Options`, which need not be repeated unless they hold
        functions.

    Returns
    -------
    list of BoundaryLine

    Raises
    ------
    InputError
        For an unknown option, and another option, airspeed or case than the map's.
    """
    options = options_of(found.attrs, case, options)
    speed = _airspeed_of(case, found, airspeed)
    own = {} if speed is None else {AIRSPEED: speed}
    names = [str(name) for name in found.axis.values]
    roots, warning = found.boundary_eigenvalue.values, found.boundary_warning.values
    lines = []
    for places in _parted(found.boundary.values):
        vertices, frequency = found.boundary.values[places], np.abs(roots[places].imag)
        model = models_at(case, own | dict(zip(names, vertices.T, strict=True)), options)
        spectrum = decomposition(model)
        state = spectrum.nearest(roots[places][:, None])[:, 0]
        for part in _same_mode(spectrum, state, np.isfinite(roots[places])):
            middle = (part.start + part.stop) // 2
            moved = names_of(some_points(model, [middle]), spectrum.at([middle]))[state[middle]]
            mode = name_list(model.dofs)[moved]
            drawn = slice(max(part.start - 1, 0), part.stop)
            x, y = vertices[drawn].T
            lines.append(BoundaryLine(mode, x, y, frequency[drawn], warning[places][drawn]))
    return lines


def _airspeed_of(case: Configuration, found: Dataset, given: Any) -> float | None:
    """Return the airspeed of a map in m/s; None where the airspeed is one of its axes."""
    own = found.attrs.get(AIRSPEED)
    asked = None if given is None else in_metres_per_second(given, case.operation.density)
    if asked is not None and (own is None or not np.isclose(asked, own, rtol=1e-12)):
        rule = f"must be {own:.6g} m/s, that of the map, or be left out" if own is not None else ""
        raise InputError(AIRSPEED, given, rule or "is one of the axes of the map")
    return None if own is None else float(own)


def _parted(boundary: Array) -> Iterator[Array]:
    """Yield places (vertices,) of each line of a boundary in which NaN stands between lines."""
    good: Array = np.asarray(np.isfinite(boundary).all(axis=1))
    for part in np.split(np.arange(len(boundary)), np.flatnonzero(~good)):
        chosen = part[good[part]]
        if len(chosen):
            yield chosen


def _same_mode(spectrum: Spectrum, state: Array, known: Array) -> Iterator[slice]:
    """Yield stretches of vertices along which the same root is neutral."""
    before, works = np.arange(len(state) - 1), spectrum.works & known
    good = before[works[:-1] & works[1:]]
    same = np.zeros(len(before), dtype=bool)
    after = match_modes(spectrum, good, good + 1).successor[np.arange(len(good)), state[good]]
    same[good] = (after == state[good + 1]) | (after == conjugate(spectrum.values)[good + 1, state[good + 1]])
    jumps = (np.flatnonzero(~same) + 1).tolist()
    yield from starmap(slice, pairwise([0, *jumps, len(state)]))
