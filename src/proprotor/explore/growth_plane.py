"""The stability of a case in the plane of two inputs, a few points at a time, so that a page can answer in between."""

from __future__ import annotations

from collections.abc import Generator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from proprotor.case import Case
from proprotor.errors import InputError
from proprotor.model.linear_model import LinearModel
from proprotor.stability.map import largest_growth
from proprotor.stability.parameter_lines import AIRSPEED, models_at
from proprotor.typing import Array

_Parts = Generator[None, None, list[Array]]
_AT_ONCE = 220  # points of one part: about as long as the modes along 60 airspeeds


@dataclass(frozen=True, eq=False)
class GrowthPlane:
    """The largest growth of all modes on a grid.

    Attributes
    ----------
    names : (str, str)
        Inputs x and y: paths of the deck, or "airspeed".
    x, y : array (columns,), (rows,)
        SI, rising.
    growth : array (rows, columns)
        Largest Re s of all modes, 1/s; NaN at failed points.
    reason, warning : array (rows, columns) of str
        Reasons for which a point failed, or is doubtful; empty for all other points.
    """

    names: tuple[str, str]
    x: Array
    y: Array
    growth: Array
    reason: Array
    warning: Array

    @property
    def boundary(self) -> list[Array]:
        """The lines (vertices, 2) of x and y between stable and unstable points, interpolated within the cells."""
        from contourpy import contour_generator  # here, because it takes long to import

        height = np.ma.masked_invalid(self.growth)
        lines: Any = contour_generator(self.x, self.y, height, corner_mask=True).lines(0.0)
        return list(lines)


def growth_plane(
    case: Case,
    axes: Mapping[str, Array],
    airspeed: float | None,
    values: Mapping[str, float] | None = None,
    options: Mapping[str, Any] | None = None,
) -> Generator[None, None, GrowthPlane]:
    """Return the whole plane, as the value of a generator that yields after each part of the grid.

    Points are those of `Case.stability_map`, whose boundary is exact; the boundary of the plane is interpolated.

    Parameters
    ----------
    case : Case
    axes : mapping of str to array
        Two inputs, x and y, and their values in SI, rising.
    airspeed : float, optional
        m/s, where "airspeed" is none of the axes.
    values : mapping of str to float, optional
        SI values of other inputs by path; those of the axes are left out.
    options : mapping, optional
        See `proprotor.rotor.options.Options`.

    Raises
    ------
    InputError
        For axes that are not two, an airspeed that is missing, and values that are not physical.
    """
    if len(axes) != 2:
        raise InputError("map", ", ".join(axes), "must have two different inputs")
    if AIRSPEED not in axes and airspeed is None:
        raise InputError("airspeed", None, "must be given, or be one of the axes")
    others = {path: value for path, value in (values or {}).items() if path not in axes}
    varied = case.vary(others) if others else case
    (x_name, x), (y_name, y) = axes.items()
    if AIRSPEED in axes:
        parts = yield from _along_airspeeds(varied, axes, options or {})
        if y_name == AIRSPEED:
            parts = [part.T for part in parts]
    else:
        parts = yield from _at_airspeed(varied, axes, airspeed, options or {})
    growth, reason, warning = parts
    return GrowthPlane((x_name, y_name), x, y, growth, reason, warning)


def _along_airspeeds(case: Case, axes: Mapping[str, Array], options: Mapping[str, Any]) -> _Parts:
    """Return growth, reasons and warnings (designs, airspeeds); the designs of all parts are built once."""
    ((name, values),) = ((path, given) for path, given in axes.items() if path != AIRSPEED)
    designs, speeds = case.vary({name: values[:, None]}), axes[AIRSPEED]
    found = []
    for some in np.array_split(speeds, min(len(speeds), -(-len(values) * len(speeds) // _AT_ONCE))):
        at = np.broadcast_to(some, (len(values), len(some)))
        found.append(_told(designs.linearize(at, **options)))
        yield
    return [np.concatenate(part, axis=1) for part in zip(*found, strict=True)]


def _at_airspeed(
    case: Case, axes: Mapping[str, Array], airspeed: float | None, options: Mapping[str, Any]
) -> _Parts:
    """Return growth, reasons and warnings (rows, columns) of two inputs at one airspeed."""
    (x_name, x), (y_name, y) = axes.items()
    across, up = (part.ravel() for part in np.meshgrid(x, y))
    found = []
    for start in range(0, len(across), _AT_ONCE):
        some = slice(start, start + _AT_ONCE)
        inputs = {AIRSPEED: airspeed, x_name: across[some], y_name: up[some]}
        found.append(_told(models_at(case, inputs, options)))
        yield
    return [np.concatenate(part).reshape(len(y), len(x)) for part in zip(*found, strict=True)]


def _told(model: LinearModel) -> tuple[Array, Array, Array]:
    """Return growth, reason and warning of each point."""
    return largest_growth(model)[0], model.trim.reason, model.trim.warning
