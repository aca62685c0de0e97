"""Boundaries along a sweep, as plots mark and tell them: which mode is unstable where, and its value there."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.model.doubts import doubtful_near, marked
from proprotor.plots.line_of_sweep import Positions, written
from proprotor.tables.sweep_summary import UnstableRange, damped_frequency, growth_rate, unstable_ranges
from proprotor.typing import Array, Dataset
from proprotor.units import KNOT, KTAS


class _Boundary(NamedTuple):
    """A zero of the damping of a mode, interpolated between points of the sweep.

    mode : that is unstable beyond the boundary, or before it; place : along the sweep, in SI units; value : of the
    mode at the place, interpolated; onset : the mode becomes unstable in the direction of the sweep.
    """

    mode: str
    place: float
    value: float
    onset: bool


class Told(NamedTuple):
    """What a sweep tells, in words.

    unstable : where each mode is that is unstable anywhere, "unstable above 340"; headline : what becomes unstable
    first, or where along an input something is; short : the same where other sweeps stand beside it.
    """

    unstable: dict[str, str]
    headline: str
    short: str


def told_by(sweep: Dataset, line: Positions, rotor_speed: ArrayLike | None = None) -> Told:
    """Return what a sweep tells; with a rotor speed, rad/s, frequencies per revolution too."""
    ranges = _ranges(sweep)
    unstable = {
        mode: " and ".join(_words([one], sweep, line) for one in ranges if one.mode == mode)
        for mode in dict.fromkeys(one.mode for one in ranges)
    }
    return Told(
        {mode: f"unstable {where}" for mode, where in (_by_name(sweep, line) | unstable).items()},
        _headline(ranges, sweep, line, rotor_speed),
        _short(ranges, sweep, line),
    )


def _by_name(sweep: Dataset, line: Positions) -> dict[str, str]:
    """Return where each name is an unstable root's, point by point: a name may come to one that is already unstable."""
    unstable = growth_rate(sweep) > 0
    along = sweep[line.name].values
    found = {}
    for mode, own in zip(sweep.mode.values.tolist(), unstable.T, strict=True):
        if own.any():
            ends = dict.fromkeys(
                _number(place, sweep, line) for place in (along[own].min(), along[own].max())
            )
            found[mode] = " to ".join(ends) if len(ends) > 1 else f"at {next(iter(ends))}"
    return found


def boundaries_of(sweep: Dataset, values: Array) -> list[_Boundary]:
    """Return the boundaries of a sweep with the values (points, modes) at them, such as frequencies."""
    along, branch = sweep[_line_of(sweep)].values, sweep.branch.values
    found: list[_Boundary] = []
    for one in _ranges(sweep):
        points, places = np.nonzero((branch == one.branch) & np.isfinite(values))
        order = np.argsort(along[points])
        x, y = along[points][order], values[points, places][order]
        for place, open_end, onset in ((one.start, one.open_start, True), (one.stop, one.open_stop, False)):
            if not open_end:
                found.append(_Boundary(one.mode, place, float(np.interp(place, x, y)), onset))
    return found


def fixed_airspeed(sweep: Dataset) -> str:
    """Return at which airspeed a sweep over an input was made, as ", at 350 KTAS"; "" if it differs along the sweep."""
    if "airspeed" not in sweep or "airspeed" in sweep.eigenvalue.dims:
        return ""
    airspeed = np.unique(sweep.airspeed.values)
    return f", at {airspeed[0] / KNOT:.4g} {KTAS}" if len(airspeed) == 1 else ""


def _line_of(sweep: Dataset) -> str:
    return str(sweep.eigenvalue.dims[0])


def _ranges(sweep: Dataset) -> list[UnstableRange]:
    """Return the unstable ranges along the line of a sweep, which `unstable_ranges` reads under the name airspeed."""
    name = _line_of(sweep)
    return unstable_ranges(
        sweep if name == "airspeed" else sweep.drop_vars("airspeed").rename({name: "airspeed"})
    )


def _headline(
    ranges: list[UnstableRange], sweep: Dataset, line: Positions, rotor_speed: ArrayLike | None
) -> str:
    if line.name != "airspeed":
        return _along_input(ranges, sweep, line) + fixed_airspeed(sweep)
    if not ranges:
        return _none(sweep, line)
    first = _first(ranges)
    if first.open_start:
        return f"{first.mode} is unstable at {_number(first.start, sweep, line)} {line.unit} already"
    frequency = next(
        one.value
        for one in boundaries_of(sweep, damped_frequency(sweep))
        if one.onset and one[:2] == (first.mode, first.start)
    )
    omega = None if rotor_speed is None else np.asarray(rotor_speed, dtype=float)
    turns = f", {frequency / omega:.2f} per rev" if omega is not None and omega.ndim == 0 else ""
    at = f"{_number(first.start, sweep, line)} {line.unit}"
    return f"{first.mode} becomes unstable at {at}: {frequency / (2 * np.pi):.2f} Hz{turns}"


def _short(ranges: list[UnstableRange], sweep: Dataset, line: Positions) -> str:
    """Return the headline in few words: "beam from 340 KTAS"."""
    if not ranges:
        return "all stable"
    if line.name != "airspeed":
        return _along_input(ranges, sweep, line)
    first = _first(ranges)
    return f"{first.mode} from {_number(first.start, sweep, line)} {line.unit}"


def _first(ranges: list[UnstableRange]) -> UnstableRange:
    return min(ranges, key=lambda one: (not one.open_start, one.start))


def _none(sweep: Dataset, line: Positions) -> str:
    """Return that nothing is unstable, and of which points that is said."""
    ends = f"{_rounded(line.values.min())} to {_rounded(line.values.max())} {written(line.unit)}".rstrip()
    failed = bool((sweep.reason.values != "").any())
    return f"no mode is unstable from {ends}" + (", where it could be analysed" if failed else "")


def _along_input(ranges: list[UnstableRange], sweep: Dataset, line: Positions) -> str:
    """Return where along an input something is unstable, each range with the modes at its ends."""
    if not ranges:
        return _none(sweep, line)
    unit = written(line.unit)
    told = []
    for joined in _joined(ranges):
        ends = _ends(joined)
        open_ends = (ends[0].open_start, ends[1].open_stop)
        free = [one.mode for one, is_open in zip(ends, open_ends, strict=True) if not is_open]
        modes = dict.fromkeys(free or [one.mode for one in joined[:1]])
        told.append(f"{_words(joined, sweep, line)} {unit}".rstrip() + f" ({', '.join(modes)})")
    return f"unstable {' and '.join(told)}"


def _joined(ranges: list[UnstableRange]) -> Iterator[list[UnstableRange]]:
    """Yield ranges that overlap, whatever their modes, together."""
    group: list[UnstableRange] = []
    for one in sorted(ranges, key=lambda one: one.start):
        if group and one.start > max(other.stop for other in group):
            yield group
            group = []
        group.append(one)
    yield group


def _ends(ranges: list[UnstableRange]) -> tuple[UnstableRange, UnstableRange]:
    """Return the range that starts first and the one that stops last."""
    return min(ranges, key=lambda one: one.start), max(ranges, key=lambda one: one.stop)


def _words(ranges: list[UnstableRange], sweep: Dataset, line: Positions) -> str:
    """Return in words where ranges that overlap reach: "above 340", "below 9260", "300 to 340" or "throughout"."""
    first, last = _ends(ranges)
    start, stop = _number(first.start, sweep, line), _number(last.stop, sweep, line)
    if first.open_start:
        return "throughout" if last.open_stop else f"below {stop}"
    return f"above {start}" if last.open_stop else f"{start} to {stop}"


def _number(place: float, sweep: Dataset, line: Positions) -> str:
    """Return a place along the sweep as it is written; with the mark of a doubt if a point beside it is doubtful."""
    near = "warning" in sweep and doubtful_near(sweep[line.name].values, sweep.warning.values, place)
    return marked(_rounded(place / line.factor), near)


def _rounded(value: float) -> str:
    """Return a number that was interpolated: whole from 100 on, three digits below."""
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"
