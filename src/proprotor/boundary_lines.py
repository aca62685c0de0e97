"""The lines of a stability map, parted where another mode takes over, each named after the mode that is neutral."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from proprotor.arrays import Array
from proprotor.modes import decomposition
from proprotor.options import parse_options
from proprotor.stability_map import AIRSPEED
from proprotor.tracking import Spectrum, conjugate, link

if TYPE_CHECKING:
    import xarray

    from proprotor.case import Case


class BoundaryLine(NamedTuple):
    """A line along which one mode is neutral.

    Parameters
    ----------
    mode : str
        Its name.
    x, y : array (vertices,)
        In SI, as the axes of the map.
    frequency : array (vertices,)
        Of the mode, rad/s.
    """

    mode: str
    x: Array
    y: Array
    frequency: Array


def boundary_lines(
    case: Case, found: xarray.Dataset, *, airspeed: Any = None, **options: Any
) -> list[BoundaryLine]:
    """The lines of a stability map by mode.

    The root that is neutral at a vertex is followed to the next by its vectors; its name is looked for at the middle of
    each line.
    Where one mode takes over from another, the step from the last vertex of the one belongs to the other.

    Parameters
    ----------
    case : Case
    found : xarray.Dataset
        Of `Case.stability_map`.
    airspeed : float in m/s, text such as "300 kt", or pint quantity, optional
        As it was given for the map.
    **options
        As they were given for the map, see `proprotor.options.Options`.

    Returns
    -------
    list of BoundaryLine

    Raises
    ------
    InputError
        For an unknown option.
    """
    parse_options(case.model_options(options))  # which tells an unknown one, also where there is no line
    names = [str(name) for name in found.axis.values]
    lines = []
    roots = found.boundary_eigenvalue.values
    for places in _parted(found.boundary.values):
        vertices, frequency = found.boundary.values[places], np.abs(roots[places].imag)
        for part in _same_mode(case, names, vertices, roots[places], airspeed, options):
            middle = vertices[part][len(vertices[part]) // 2]
            mode = _mode_at(
                case, names, middle, float(frequency[part][len(vertices[part]) // 2]), airspeed, options
            )
            drawn = slice(max(part.start - 1, 0), part.stop)
            lines.append(BoundaryLine(mode, vertices[drawn, 0], vertices[drawn, 1], frequency[drawn]))
    return lines


def _parted(boundary: Array) -> Iterator[Array]:
    """Places (vertices,) of each line of a boundary in which NaN parts them."""
    good: Array = np.asarray(np.isfinite(boundary).all(axis=1))
    for part in np.split(np.arange(len(boundary)), np.flatnonzero(~good)):
        chosen = part[good[part]]
        if len(chosen):
            yield chosen


def _at(case: Case, names: list[str], point: Array, airspeed: Any) -> tuple[Case, Any]:
    """The case, and the airspeeds, at points (..., 2) of the plane."""
    given = dict(zip(names, np.moveaxis(point, -1, 0), strict=True))
    speed = given.pop(AIRSPEED, airspeed)
    return case.vary(given), speed


def _same_mode(
    case: Case, names: list[str], vertices: Array, roots: Array, airspeed: Any, options: dict[str, Any]
) -> Iterator[slice]:
    """Stretches of vertices along which the root that is neutral at one is that which is neutral at the next."""
    varied, speed = _at(case, names, vertices, airspeed)
    spectrum = decomposition(varied.linearize(speed, **options))
    state = _nearest_state(spectrum, roots)
    before = np.arange(len(vertices) - 1)
    works = spectrum.works & np.isfinite(roots)
    good = before[works[:-1] & works[1:]]
    same = np.zeros(len(before), dtype=bool)
    after = link(spectrum, good, good + 1).successor[np.arange(len(good)), state[good]]
    same[good] = (after == state[good + 1]) | (after == conjugate(spectrum.values)[good + 1, state[good + 1]])
    jumps = np.flatnonzero(~same) + 1
    for start, stop in zip((0, *jumps), (*jumps, len(vertices)), strict=True):
        yield slice(int(start), int(stop))


def _nearest_state(spectrum: Spectrum, roots: Array) -> Array:
    apart = np.abs(spectrum.values - roots[:, None])
    state: Array = np.where(np.isnan(apart), np.inf, apart).argmin(axis=1)
    return state


def _mode_at(
    case: Case, names: list[str], point: Array, frequency: float, airspeed: Any, options: dict[str, Any]
) -> str:
    from proprotor.speed import in_metres_per_second

    varied, speed = _at(case, names, point, airspeed)
    modes = varied.sweep(in_metres_per_second(speed).reshape(-1), **options).isel(airspeed=0)
    values = modes.eigenvalue.values
    # Neutral at this point: the least growth in size of those with this frequency.
    distance = np.hypot(values.real, np.abs(values.imag) - frequency)
    return str(modes.mode.values[np.nanargmin(distance)])
