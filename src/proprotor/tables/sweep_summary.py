"""Numbers of a sweep that tables and plots show: frequency, damping, unstable ranges, modes that move the support."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from proprotor.rotor.motions import is_of_loop, is_of_rotor
from proprotor.typing import Array, Dataset

# Shares of the way that both roots go, and of a root: the line of a name goes on where the name passes no farther.
_BRIDGED, _NEARLY = 2.0, 0.02


class UnstableRange(NamedTuple):
    """A range of airspeed in which a root is unstable.

    Attributes
    ----------
    mode : str
        What moves in the root at the first airspeed at which it is unstable.
    start, stop : float
        m/s, by linear interpolation of Re s between neighbouring points of the sweep.
    open_start, open_stop : bool
        Whether the root is unstable at the first, or the last, point already, so that `start` or `stop`
        is the end of the sweep and not a boundary.
    branch : str
        Label of the exact root.
    """

    mode: str
    start: float
    stop: float
    open_start: bool
    open_stop: bool
    branch: str


def damped_frequency(sweep: Dataset) -> Array:
    """Return |Im s| (airspeed, mode) in rad/s, NaN at failed points."""
    eigenvalue = sweep.eigenvalue.values
    return np.where(np.isnan(eigenvalue), np.nan, np.abs(eigenvalue.imag))


def growth_rate(sweep: Dataset) -> Array:
    """Return Re s (airspeed, mode) in rad/s, exactly zero where it is zero within the error of the root."""
    real = sweep.eigenvalue.values.real
    return np.where(np.abs(real) <= sweep.eigenvalue_error.values, 0.0, real)


def damping_percent(sweep: Dataset) -> Array:
    """Return the damping ratio -Re s/|s| (airspeed, mode) in percent of critical, negative where a mode is unstable."""
    return np.where(growth_rate(sweep) == 0, 0.0, 100 * sweep.damping_ratio.values)


def unstable_ranges(sweep: Dataset) -> list[UnstableRange]:
    """Return the ranges of airspeed in which a root is unstable, by mode in the order of the sweep, then by airspeed.

    Roots are followed, whatever their names: a name that passes from a stable root to an unstable one crosses nothing.
    Boundaries are interpolated, so they are as good as the sweep is fine; failed points are passed over.
    """
    airspeed, names = sweep.airspeed.values, sweep.mode.values.tolist()
    growth, branch = growth_rate(sweep), sweep.branch.values
    ranges = []
    for label in dict.fromkeys(branch[growth > 0].tolist()):
        points, places = np.nonzero((branch == label) & np.isfinite(growth))
        for first, start, stop, before, beyond in _ranges(airspeed[points], growth[points, places]):
            ranges.append(UnstableRange(names[places[first]], start, stop, before, beyond, label))
    return sorted(ranges, key=lambda found: (names.index(found.mode), found.start))


def _ranges(airspeed: Array, growth: Array) -> Iterator[tuple[int, float, float, bool, bool]]:
    """Yield the first unstable point of each range, its start and stop, and whether these are ends of the sweep."""
    unstable = np.concatenate([[False], growth > 0, [False]])
    changes = np.flatnonzero(unstable[:-1] != unstable[1:])  # to unstable and back to stable, in turn
    for first, after in changes.reshape(-1, 2).tolist():
        open_start, open_stop = first == 0, after == len(growth)
        start = airspeed[0] if open_start else _zero(airspeed, growth, first - 1)
        stop = airspeed[-1] if open_stop else _zero(airspeed, growth, after - 1)
        yield first, float(start), float(stop), open_start, open_stop


def _zero(airspeed: Array, growth: Array, i: int) -> float:
    """Return the airspeed at which the line through points i and i + 1 is zero."""
    return float(airspeed[i] - growth[i] * (airspeed[i + 1] - airspeed[i]) / (growth[i + 1] - growth[i]))


def leaps(sweep: Dataset) -> Array:
    """Return where a name passes to a distant root (points - 1, mode), so that a line between the points is no root.

    Two roots that veer and exchange their motions are near each other: from one point to the next, the name goes no
    farther than twice as far as both roots do, or than 2 % of the root. Then the line of the name goes on.
    """
    values, branch = sweep.eigenvalue.values, sweep.branch.values
    both = np.isfinite(values[:-1]) & np.isfinite(values[1:])
    found = np.zeros(both.shape, dtype=bool)
    for point, mode in np.argwhere(both & (branch[:-1] != branch[1:])):
        here, there = values[point], values[point + 1]
        ways = [
            there[branch[point + 1] == branch[point, mode]] - here[mode],
            there[mode] - here[branch[point] == branch[point + 1, mode]],
        ]
        moved = sum(float(np.abs(way).max(initial=0)) for way in ways)
        reach = max(_BRIDGED * moved, _NEARLY * float(np.abs(here[mode])))
        found[point, mode] = np.abs(there[mode] - here[mode]) > reach
    return found


def support_coordinates(sweep: Dataset) -> list[str]:
    """Return the coordinates of the support, which are all but the rotor's."""
    return [name for name in sweep.dof.values.tolist() if not (is_of_rotor(name) or is_of_loop(name))]


def support_share(sweep: Dataset) -> Array:
    """Return the largest participation of the support in each mode (mode,) along the sweep, 0 to 1."""
    share = sweep.participation.sel(dof=support_coordinates(sweep)).sum("dof").values
    return np.asarray(np.nanmax(share, axis=0, initial=0))


def broad_modes(sweep: Dataset) -> set[str]:
    """Return the modes that have broad lines: modes of the support, and modes that are unstable at some point."""
    grows = (growth_rate(sweep) > 0).any(axis=0)
    return {*support_coordinates(sweep), *sweep.mode.values[grows].tolist()}


def modes_of_interest(sweep: Dataset, count: int) -> list[int]:
    """Return the places of at most `count` modes, in the order of the sweep.

    Unstable modes come first, then the support's, then other modes that move the support most.
    """
    stable = ~(growth_rate(sweep) > 0).any(axis=0)
    of_rotor = ~np.isin(sweep.mode.values, support_coordinates(sweep))
    by_interest = np.lexsort([-support_share(sweep), of_rotor, stable])
    return sorted(by_interest[:count].tolist())
