"""The lines of a stability map, parted where another mode takes over, each named after the mode that is neutral."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from proprotor.arrays import Array
from proprotor.errors import InputError
from proprotor.mode_names import moving
from proprotor.modes import decomposition
from proprotor.stability_map import AIRSPEED, largest_growth
from proprotor.stamp import options_of

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
    warning : array of str
        (vertices,): what makes a vertex doubtful; empty where nothing does.
    """

    mode: str
    x: Array
    y: Array
    frequency: Array
    warning: Array = np.empty(0, dtype=str)


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
        That of the map, which need not be repeated.
    **options
        Those of the map, see `proprotor.options.Options`. The map has its own, which need not be repeated but where
        they hold functions.

    Returns
    -------
    list of BoundaryLine

    Raises
    ------
    InputError
        For an unknown option, and another option, airspeed or case than the map's.
    """
    options = options_of(found.attrs, case, options)
    airspeed = _airspeed_of(found, airspeed)
    names = [str(name) for name in found.axis.values]
    lines = []
    for vertices, warning in _parted(found.boundary.values, found.boundary_warning.values):
        frequency = _frequencies(case, names, vertices, airspeed, float(found.attrs["level"]), options)
        for part in _same_mode(frequency, float(np.max(case.operation.rotor_speed))):
            middle = vertices[part][len(vertices[part]) // 2]
            mode = _mode_at(
                case, names, middle, float(frequency[part][len(vertices[part]) // 2]), airspeed, options
            )
            drawn = slice(max(part.start - 1, 0), part.stop)
            x, y = vertices[drawn].T
            lines.append(BoundaryLine(mode, x, y, frequency[drawn], warning[drawn]))
    return lines


def _airspeed_of(found: xarray.Dataset, given: Any) -> float | None:
    """The airspeed of a map in m/s; None where it is one of its axes."""
    from proprotor.speed import in_metres_per_second

    own = found.attrs.get(AIRSPEED)
    if given is not None and (own is None or not np.isclose(in_metres_per_second(given), own, rtol=1e-12)):
        rule = "is one of the axes of the map" if own is None else f"must be {own:.6g} m/s, that of the map"
        raise InputError(AIRSPEED, given, f"{rule}, or be left out" if own is not None else rule)
    return None if own is None else float(own)


def _parted(boundary: Array, warning: Array) -> Iterator[tuple[Array, Array]]:
    """Lines (vertices, 2) of a boundary in which NaN parts them, with their warnings (vertices,)."""
    good: Array = np.asarray(np.isfinite(boundary).all(axis=1))
    for part in np.split(np.arange(len(boundary)), np.flatnonzero(~good)):
        chosen = part[good[part]]
        if len(chosen):
            yield boundary[chosen], warning[chosen]


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
