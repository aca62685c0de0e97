"""The lines of a stability map, parted where another mode takes over, each named after the mode that is neutral."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from proprotor.arrays import Array
from proprotor.mode_names import moving
from proprotor.modes import decomposition
from proprotor.options import parse_options
from proprotor.stability_map import AIRSPEED, largest_growth

if TYPE_CHECKING:
    import xarray

    from proprotor.case import Case

_JUMP = 0.2  # of a frequency: more than that from one vertex to the next is another mode
_DIVERGES = 1e-6  # of the rotor speed: a root this slow is real


class BoundaryLine(NamedTuple):
    """A line along which one mode is neutral.

    Parameters
    ----------
    mode : str
        What moves in it at the middle of the line.
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

    The mode of every vertex is told from the next by its frequency; its name is looked for at the middle of each line.
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
    for vertices in _parted(found.boundary.values):
        frequency = _frequencies(case, names, vertices, airspeed, float(found.attrs["level"]), options)
        for part in _same_mode(frequency, float(np.max(case.operation.rotor_speed))):
            middle = vertices[part][len(vertices[part]) // 2]
            mode = _mode_at(
                case, names, middle, float(frequency[part][len(vertices[part]) // 2]), airspeed, options
            )
            drawn = slice(max(part.start - 1, 0), part.stop)
            lines.append(BoundaryLine(mode, vertices[drawn, 0], vertices[drawn, 1], frequency[drawn]))
    return lines


def _parted(boundary: Array) -> Iterator[Array]:
    """Lines (vertices, 2) of a boundary in which NaN parts them."""
    good: Array = np.asarray(np.isfinite(boundary).all(axis=1))
    for part in np.split(np.arange(len(boundary)), np.flatnonzero(~good)):
        chosen = part[good[part]]
        if len(chosen):
            yield boundary[chosen]


def _at(case: Case, names: list[str], point: Array, airspeed: Any) -> tuple[Case, Any]:
    """The case, and the airspeeds, at points (..., 2) of the plane."""
    given = dict(zip(names, np.moveaxis(point, -1, 0), strict=True))
    speed = given.pop(AIRSPEED, airspeed)
    return case.vary(given), speed


def _frequencies(
    case: Case, names: list[str], vertices: Array, airspeed: Any, level: float, options: dict[str, Any]
) -> Array:
    varied, speed = _at(case, names, vertices, airspeed)
    return np.asarray(largest_growth(varied.linearize(speed, **options), level)[1].imag)


def _same_mode(frequency: Array, rotor_speed: float) -> Iterator[slice]:
    """Stretches of vertices along which the frequency does not jump."""
    larger = np.maximum(frequency[1:], frequency[:-1])
    jumps = (
        np.flatnonzero(np.abs(np.diff(frequency)) > np.maximum(_JUMP * larger, _DIVERGES * rotor_speed)) + 1
    )
    for start, stop in zip((0, *jumps), (*jumps, len(frequency)), strict=True):
        yield slice(int(start), int(stop))


def _mode_at(
    case: Case, names: list[str], point: Array, frequency: float, airspeed: Any, options: dict[str, Any]
) -> str:
    varied, speed = _at(case, names, point, airspeed)
    model = varied.linearize(speed, **options)
    values, right, left = decomposition(model).all_modes
    # Neutral at this point: the least growth in size of those with this frequency.
    nearest = np.argmin(np.hypot(values.real, np.abs(values.imag) - frequency))
    return str(moving(model, values, left, right).names[nearest])
