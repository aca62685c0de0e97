"""Where an aircraft must be free of flutter, and where it is: altitudes, rotor speeds, powers and conditions of a deck.

Each altitude, rotor speed and power of a condition is a line of airspeeds, and the boundaries of all lines of a
condition are found at once, each exactly (`proprotor.stability.boundary_search`). The lowest onset is held against the
speed up to which the condition must be free of flutter (`proprotor.stability.envelope_speeds`), and the least damping
at that speed, with its slope, says how near the next instability is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.configuration import Configuration
from proprotor.stability.boundaries import scan_shares
from proprotor.stability.boundary_search import Lines, OfLine, check_size, models_of, points_of, search_lines
from proprotor.stability.envelope_dataset import (
    MET,
    NOT_KNOWN,
    NOT_MET,
    envelope_dataset,
    with_limits,
    with_worst,
)
from proprotor.stability.envelope_speeds import EnvelopeSpeeds, altitudes_of, envelope_speeds
from proprotor.stability.kinds import FLUTTER, flies_free, kinds
from proprotor.stability.mode_names import moving
from proprotor.stability.points import Solved, solve_points
from proprotor.stability.sensitivity import damping_rate
from proprotor.typing import Array, Dataset
from proprotor.units import KEAS, KNOT, in_metres_per_second

if TYPE_CHECKING:
    from proprotor.deck.conditions import Condition

_BEYOND = 1.1  # of the speed required: where a search ends at the earliest
_ROUNDING = 1e-12  # of an airspeed
_FEWEST = 80  # airspeeds of a line, at least about


class _Damping(NamedTuple):
    """The least damped mode at one airspeed of each line (k,).

    ratio : damping ratio, NaN where the airspeed failed; rate : its change with the true airspeed, s/m; mode : what
    moves; warning : what makes the airspeed doubtful; reason : why the airspeed failed
    """

    ratio: Array
    rate: Array
    mode: Array
    warning: Array
    reason: Array


class _Cells(NamedTuple):
    """What was found on the lines (k,) of a condition.

    found : boundaries of stability; below : of the damping required, None where none is; at_start, at_end : damping at
    the lowest airspeed and at the speed required; start, required, dive : these speeds and V_D or M_D, m/s, true
    """

    found: list[OfLine]
    below: list[OfLine] | None
    at_start: _Damping
    at_end: _Damping
    start: Array
    required: Array
    dive: Array


def envelope(
    case: Configuration,
    airspeeds: Any = None,
    *,
    variants: Sequence[str] | None = None,
    **options: Any,
) -> Dataset:
    """Return where a case is free of flutter in the envelope of its deck.

    Parameters
    ----------
    case : Case
        From a deck with a section [envelope].
    airspeeds : array (points,) in m/s, text such as "100:400:10keas", or pint quantity, optional
        The scan of every line; by default from 0.2 of the tip speed to 1.2 of it, or to 1.1 of the speed required
        where that is higher. Equivalent airspeeds hold in the air of each altitude.
    variants : sequence of str, optional
        Names of the deck's variants; all of them by default. The deck itself is always a condition, a normal one.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    xarray.Dataset
        Over ``condition``, ``rotor_speed`` (rad/s), ``power`` (W) and ``altitude`` (m), where the coordinates of rotor
        speed and power are NaN for those of the condition's own deck; one of the altitudes is that at which V_D meets
        M_D, if it lies between those of the deck. onset, the lowest true airspeed at which a mode
        becomes unstable, of an aircraft that flies free by flutter, m/s, NaN where none does; equivalent_onset, m/s,
        and mach_onset; mode, kind and frequency, rad/s; margin, the onset over the speed required, less 1;
        damping_onset, the lowest true airspeed up to the dive speed at which a mode has less than the damping required,
        m/s; damping, the least damping ratio at the speed required, damping_rate, its change with the equivalent
        airspeed, s/m, and damping_mode; verdict, "met", "not met" or "not known", and why; note, reason and searched
        as in `Case.boundary_against`; warning, what makes the onset or the damping doubtful; turning, the rotor speed,
        rad/s. Over condition and altitude: required, m/s, true, and failure (condition,). Over the altitude: dive, V_D
        or M_D, m/s, true; density, kg/m³; speed_of_sound, m/s. limits (limit, height), the equivalent airspeeds of V_D
        and M_D and of the speeds required of normal conditions and of failures at many heights, m/s. Attributes: worst,
        the worst case in words; worst_place, its four positions; damping_ratio, the damping required; eigen_solves;
        the case and its options (`proprotor.model.stamp`).

    Raises
    ------
    InputError
        For a deck without an envelope, an unknown variant or option, an altitude without a standard atmosphere, and
        airspeeds that do not rise.
    """
    from proprotor.deck.conditions import conditions_of  # here, because pydantic takes long to import

    conditions = conditions_of(case, variants)
    section = case.deck.envelope
    offset = conditions[0].case.given.get("operation.temperature_offset")
    kelvin = 0.0 if offset is None else float(offset.si)
    speeds = envelope_speeds(section, altitudes_of(section), kelvin)
    level = 0.0 if section.damping_ratio is None else float(section.damping_ratio.si)
    turning, powers = (
        None if axis is None else np.array(axis.si) for axis in (section.rotor_speeds, section.powers)
    )
    shape = _size(turning), _size(powers), len(speeds.altitude)
    check_size("envelope", len(conditions) * int(np.prod(shape)), _FEWEST)
    parts, solves = [], 0
    for condition in conditions:
        lines = _inputs(condition.case, speeds, turning, powers)
        required = speeds.failure if condition.failure else speeds.normal
        own = 0.0 if condition.failure else level
        cells, count = _cells(condition.case, lines, speeds, required, airspeeds, own, options)
        parts.append(_dataset(condition, cells, speeds, own, shape))
        solves += count
    data = with_limits(envelope_dataset(parts, conditions, speeds, turning, powers), section, kelvin)
    carried = stamp.of_case(case, options, ("operation.altitude",))
    return with_worst(data).assign_attrs(carried | {"damping_ratio": level, "eigen_solves": solves})


def _size(values: Array | None) -> int:
    return 1 if values is None else len(values)


def _inputs(
    case: Configuration, speeds: EnvelopeSpeeds, turning: Array | None, powers: Array | None
) -> dict[str, Array]:
    """Return the inputs (k,) of the lines of a condition: rotor speeds, then powers, then altitudes."""
    own = np.array([case.operation.rotor_speed]) if turning is None else turning
    given = np.zeros(1) if powers is None else powers
    omega, power, altitude = (
        part.ravel() for part in np.meshgrid(own, given, speeds.altitude, indexing="ij")
    )
    lines = {"operation.altitude": altitude, "operation.rotor_speed": omega}
    if powers is not None:
        density = np.tile(speeds.density, len(own) * len(given))
        disk = np.pi * case.rotor.radius**2
        lines["operation.trim.power_coefficient"] = power / (
            density * disk * (omega * case.rotor.radius) ** 3
        )
    return lines


def _cells(
    case: Configuration,
    inputs: Mapping[str, Array],
    speeds: EnvelopeSpeeds,
    required: Array,
    airspeeds: Any,
    level: float,
    options: Mapping[str, Any],
) -> tuple[_Cells, int]:
    """Return what was found on the lines of a condition, and the number of eigen-solves."""
    tips = inputs["operation.rotor_speed"] * case.rotor.radius
    every = len(tips) // len(required)
    wanted, dive = np.tile(required, every), np.tile(speeds.dive, every)
    scans = _scans(airspeeds, tips, wanted, np.tile(speeds.density, every))
    whole = Lines(inputs, *points_of(scans, tips.tolist()))
    found, solves = search_lines(case, whole, 0.0, options)
    below = None
    if level:
        up_to = [np.append(scan[scan < end], end) for scan, end in zip(scans, dive, strict=True)]
        some = Lines(inputs, *points_of(up_to, tips.tolist()))
        below, count = search_lines(case, some, level, options)
        solves += count
    start = np.array([scan[0] for scan in scans])
    at_start, at_end = (_damping(case, whole, at, options) for at in (start, wanted))
    return _Cells(found, below, at_start, at_end, start, wanted, dive), solves + 2 * len(tips)


def _scans(airspeeds: Any, tips: Array, required: Array, density: Array) -> list[Array]:
    """Return the scan of each line (k,): as asked for, or far enough for the speed required."""
    if airspeeds is None:
        shares = scan_shares()
        ends = np.fmax(shares[-1] * tips, _BEYOND * required)
        return [np.array([shares[0] * tip, end]) for tip, end in zip(tips, ends, strict=True)]
    asked = in_metres_per_second(airspeeds, density[:, None])
    if asked.ndim == 0 or asked.shape[-1] < 2 or not np.all(np.diff(asked) > 0):
        raise InputError("airspeeds", airspeeds, "must be a range of airspeeds that rise")
    return list(np.broadcast_to(asked, (len(tips), asked.shape[-1])))


def _damping(case: Configuration, lines: Lines, speeds: Array, options: Mapping[str, Any]) -> _Damping:
    """Return the least damped mode at one airspeed of each line, of a free aircraft among its modes of flutter."""
    models = models_of(case, lines, options)
    count = np.arange(len(speeds))
    solved = solve_points(models, count, speeds, 0.0, forgiving=True)
    ratio, rate = np.full(len(speeds), np.nan), np.full(len(speeds), np.nan)
    mode = np.full(len(speeds), "", dtype=object)
    if solved.points is not None:
        works = np.flatnonzero(solved.works)
        ratio[works], rate[works], mode[works] = _least(case, solved, models(works, speeds[works]))
    reason, warning = (np.array(part, dtype=str) for part in (solved.reason, solved.warning))
    return _Damping(ratio, rate, mode.astype(str), warning, reason)


def _least(case: Configuration, solved: Solved, model: Any) -> tuple[Array, Array, Array]:
    """Return damping ratio, its change with the airspeed and name of the least damped mode of each point that works."""
    points = solved.points
    assert points is not None
    every, values = points.spectrum.all_modes, points.spectrum.values
    size = np.abs(values)
    counts = (values.imag >= 0) & (size > points.error)
    if flies_free(case):
        counts &= kinds(model, every) == FLUTTER
    ratios = np.where(counts, -values.real, np.inf) / np.where(counts, size, 1.0)
    rows, place = np.arange(len(values)), ratios.argmin(axis=-1)
    rates = damping_rate(values, points.change)
    names = moving(model, every.values, every.left, every.right).names
    found = np.where(np.isfinite(ratios[rows, place]), ratios[rows, place], np.nan)
    return found, rates[rows, place], names[rows, place]


# Verdicts -------------------------------------------------------------------------------------------------------------


def _dataset(
    condition: Condition[Any],
    cells: _Cells,
    speeds: EnvelopeSpeeds,
    level: float,
    shape: tuple[int, ...],
) -> dict[str, Array]:
    """Return the variables of a condition, each of the shape (rotor speeds, powers, altitudes)."""
    free = flies_free(condition.case)
    onsets = [_onset(own, free) for own in cells.found]
    onset = np.array([np.nan if one is None else one.crossing.position for one in onsets])
    falls = np.full(onset.shape, np.nan)
    if cells.below is not None:
        lows = [_onset(own, free) for own in cells.below]
        falls = np.array([np.nan if one is None else one.crossing.position for one in lows])
    per = np.tile(speeds.per_equivalent, len(onset) // len(speeds.altitude))
    sound = np.tile(speeds.speed_of_sound, len(per) // len(speeds.altitude))
    verdicts = [
        _verdict(_Place(cells, line, onset[line], falls[line], level, per[line]))
        for line in range(len(onset))
    ]
    parts: dict[str, Any] = {
        "onset": onset,
        "equivalent_onset": onset / per,
        "mach_onset": onset / sound,
        "mode": ["" if one is None else one.mode for one in onsets],
        "kind": ["" if one is None else one.kind for one in onsets],
        "frequency": [np.nan if one is None else abs(one.crossing.value.imag) for one in onsets],
        "margin": onset / cells.required - 1,
        "damping_onset": falls,
        "damping": cells.at_end.ratio,
        "damping_rate": cells.at_end.rate * per,
        "damping_mode": cells.at_end.mode,
        "verdict": [verdict for verdict, _ in verdicts],
        "why": [why for _, why in verdicts],
        "warning": [
            (one.warning if one is not None else "") or str(at)
            for one, at in zip(onsets, cells.at_end.warning, strict=True)
        ],
        "note": [own.note for own in cells.found],
        "reason": [own.reason for own in cells.found],
        "searched": np.array([own.searched for own in cells.found]),
    }
    return {name: _shaped(np.asarray(part), shape) for name, part in parts.items()}


def _shaped(values: Array, shape: tuple[int, ...]) -> Array:
    return values.reshape(*shape, *values.shape[1:])


def _onset(own: OfLine, free: bool) -> Any:
    """Return the lowest onset of a line, of a free aircraft by flutter; None without one."""
    return next(
        (one for one in own.boundaries if one.crossing.onset and (not free or one.kind == FLUTTER)), None
    )


class _Place(NamedTuple):
    """One line of a condition: its onset, where damping falls below the one required, and the speeds, m/s, true."""

    cells: _Cells
    line: int
    onset: float
    falls: float
    level: float
    per_equivalent: float

    def written(self, speed: float) -> str:
        """Return a true airspeed as an equivalent one in words."""
        return f"{speed / self.per_equivalent / KNOT:.4g} {KEAS}"


def _verdict(place: _Place) -> tuple[str, str]:
    """Return whether a line meets the requirement, and why it does not, or why this is not known."""
    if why := _broken(place):
        return NOT_MET, why
    if why := _unknown(place):
        return NOT_KNOWN, why
    return MET, ""


def _broken(place: _Place) -> str:
    """Return why a line does not meet the requirement; empty if nothing shows that it does not."""
    cells, line, level, written = place.cells, place.line, place.level, place.written
    start, ratio = written(cells.start[line]), cells.at_start.ratio[line]
    mode = cells.at_start.mode[line]
    if ratio < 0:
        return f"{mode} is unstable at the lowest airspeed already, {start}"
    if place.onset <= cells.required[line]:
        return f"unstable from {written(place.onset)}, needed {written(cells.required[line])}"
    if level and ratio < level:
        return f"{mode} has {100 * ratio:.2g} % damping at {start}, needed {100 * level:g} %"
    if place.falls <= cells.dive[line]:
        return f"damping below {100 * level:g} % from {written(place.falls)}, needed to {written(cells.dive[line])}"
    return ""


def _unknown(place: _Place) -> str:
    """Return why it is not known whether a line meets the requirement; empty if it is known."""
    cells, line, written = place.cells, place.line, place.written
    if cells.start[line] > cells.required[line]:
        return f"the search begins at {written(cells.start[line])}"
    searches = [(cells.found[line], cells.required[line])]
    if cells.below is not None:
        searches.append((cells.below[line], cells.dive[line]))
    for own, end in searches:
        if any(speed <= end for speed in own.gaps):
            return own.reason
        if not own.searched[1] >= end * (1 - _ROUNDING):
            return own.reason or f"the search ends at {written(own.searched[1])}"
    return "" if np.isfinite(cells.at_end.ratio[line]) else str(cells.at_end.reason[line])
