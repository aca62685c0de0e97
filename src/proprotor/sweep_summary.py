"""What a sweep says at a glance: frequency, damping, where modes are unstable, which move the support."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from proprotor_equations import FIXED_COORDINATES

from proprotor.arrays import Array

if TYPE_CHECKING:
    import xarray


class UnstableRange(NamedTuple):
    """Airspeeds between which a mode is unstable.

    Attributes
    ----------
    mode : str
    start, stop : float
        m/s, by linear interpolation of Re s between neighbouring points of the sweep.
    open_start, open_stop : bool
        Whether the mode is unstable at the first, or the last, point already, so that `start` or `stop`
        is the end of the sweep and not a boundary.
    """

    mode: str
    start: float
    stop: float
    open_start: bool
    open_stop: bool


def damped_frequency(sweep: xarray.Dataset) -> Array:
    """|Im s| (airspeed, mode) in rad/s, NaN at failed points."""
    eigenvalue = sweep.eigenvalue.values
    return np.where(np.isnan(eigenvalue), np.nan, np.abs(eigenvalue.imag))


def growth_rate(sweep: xarray.Dataset) -> Array:
    """Re s (airspeed, mode) in rad/s, exactly zero where it is neutral: zero within the error of the root."""
    real = sweep.eigenvalue.values.real
    return np.where(np.abs(real) <= sweep.eigenvalue_error.values, 0.0, real)


def damping_percent(sweep: xarray.Dataset) -> Array:
    """Damping ratio -Re s/|s| (airspeed, mode) in percent of critical, negative where a mode is unstable."""
    return np.where(growth_rate(sweep) == 0, 0.0, 100 * sweep.damping_ratio.values)


def unstable_ranges(sweep: xarray.Dataset) -> list[UnstableRange]:
    """Ranges of airspeed in which a mode is unstable, by mode in the order of the sweep, then by airspeed.

    Boundaries are interpolated, so they are as good as the sweep is fine; failed points are passed over.
    """
    airspeed, growth = sweep.airspeed.values, growth_rate(sweep)
    ranges = []
    for place, mode in enumerate(sweep.mode.values):
        good = np.isfinite(growth[:, place])
        for found in _ranges(airspeed[good], growth[good, place]):
            ranges.append(UnstableRange(str(mode), *found))
    return ranges


def _ranges(airspeed: Array, growth: Array) -> Iterator[tuple[float, float, bool, bool]]:
    unstable = np.concatenate([[False], growth > 0, [False]])
    starts, ends = (
        np.flatnonzero(~unstable[:-1] & unstable[1:]),
        np.flatnonzero(unstable[:-1] & ~unstable[1:]),
    )
    for first, after in zip(starts.tolist(), ends.tolist(), strict=True):
        open_start, open_stop = first == 0, after == len(growth)
        start = airspeed[0] if open_start else _zero(airspeed, growth, first - 1)
        stop = airspeed[-1] if open_stop else _zero(airspeed, growth, after - 1)
        yield float(start), float(stop), open_start, open_stop


def _zero(airspeed: Array, growth: Array, i: int) -> float:
    """Where the line through points i and i + 1 is zero."""
    return float(airspeed[i] - growth[i] * (airspeed[i + 1] - airspeed[i]) / (growth[i + 1] - growth[i]))


def support_coordinates(sweep: xarray.Dataset) -> list[str]:
    """Coordinates that are not the rotor's."""
    return [name for name in sweep.dof.values.tolist() if name not in FIXED_COORDINATES]


def support_share(sweep: xarray.Dataset) -> Array:
    """How much each mode (mode,) moves the support: its largest participation along the sweep, 0 to 1."""
    share = sweep.participation.sel(dof=support_coordinates(sweep)).sum("dof").values
    largest: Array = np.nanmax(share, axis=0, initial=0)
    return largest
