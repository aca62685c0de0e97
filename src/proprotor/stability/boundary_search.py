"""Boundaries along many lines of airspeeds at once, a line for each design of a case.

The boundaries of all lines are found together, each exactly (`proprotor.stability.crossings`,
`proprotor.stability.brackets`). What cannot be analysed on one line is the reason of that line, and spoils no other.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from proprotor.model.configuration import Configuration
from proprotor.model.linear_model import LinearModel
from proprotor.needs import check_memory
from proprotor.stability.boundaries import steps_of_scan
from proprotor.stability.brackets import JUMPS, Brackets, Crossing, each_once
from proprotor.stability.crossings import Search
from proprotor.stability.kinds import kinds
from proprotor.stability.matching import Spectrum
from proprotor.stability.mode_names import moving
from proprotor.stability.parameter_lines import AIRSPEED, models_at
from proprotor.stability.points import Models
from proprotor.typing import Array
from proprotor.units import KNOT, KTAS

_NOTHING = "no airspeed could be analysed"
_AT_ONCE = 2048  # points of one batch
_BYTES_PER_POINT, _BYTES_AT_ONCE = 100.0, 230_000.0  # of each point, and while a point is analysed


class Lines(NamedTuple):
    """Lines of airspeeds, one for each design.

    inputs : by path, the values (k,) of the inputs by which the designs differ, SI; line, position (points,) : all
    points of the scans, in the order of the lines and rising along each, m/s.
    """

    inputs: Mapping[str, Array]
    line: Array
    position: Array


class Found(NamedTuple):
    """A boundary of one line.

    crossing; mode, what moves; kind, see `proprotor.stability.kinds`; warning, what makes the boundary doubtful.
    """

    crossing: Crossing
    mode: str
    kind: str
    warning: str


class OfLine(NamedTuple):
    """What was found on one line.

    boundaries, by airspeed; note, why there is no onset, or that it is not the first instability; reason, why airspeeds
    failed; searched, the lowest and the highest airspeed that could be analysed, m/s; gaps, the airspeeds of the scan
    that could not be analysed, and the lower ends of steps in which a boundary was lost, m/s.
    """

    boundaries: list[Found]
    note: str
    reason: str
    searched: tuple[float, float] = (np.nan, np.nan)
    gaps: tuple[float, ...] = ()


def search_lines(
    case: Configuration, lines: Lines, level: float, options: Mapping[str, Any]
) -> tuple[list[OfLine], int]:
    """Return what was found on each line, and the number of eigen-solves.

    Parameters
    ----------
    case : Case
    lines : Lines
    level : float
        Damping ratio that counts as the boundary.
    options : mapping
        See `proprotor.rotor.options.Options`.
    """
    found: list[OfLine] = []
    solves = 0
    for some in _batches(lines):
        own, count = _boundaries_of(case, some, level, options)
        found += own
        solves += count
    return found, solves


def models_of(case: Configuration, lines: Lines, options: Mapping[str, Any]) -> Models:
    """Return a function that takes lines (k,) and airspeeds (k,) and returns the models there."""

    def models(line: Array, position: Array) -> LinearModel:
        inputs = {path: values[line] for path, values in lines.inputs.items()}
        return models_at(case, inputs | {AIRSPEED: position}, options)

    return models


def check_size(field: str, lines: int, airspeeds: int) -> None:
    """Refuse a search along lines of so many airspeeds that it does not fit into memory."""
    count = lines * max(airspeeds, 1)
    size = _BYTES_PER_POINT * count + _BYTES_AT_ONCE * min(count, _AT_ONCE)
    check_memory(field, f"{count:.4g} points", size, "the boundaries", "take larger steps")


def points_of(scans: Sequence[Array], tips: Sequence[float]) -> tuple[Array, Array]:
    """Return line and position (points,) of the scans of all lines, with no step wider than that of a default scan.

    Parameters
    ----------
    scans : sequence of array
        Rising airspeeds of each line, m/s.
    tips : sequence of float
        Tip speed of each line, m/s.
    """
    whole = [steps_of_scan(own, tip) for own, tip in zip(scans, tips, strict=True)]
    return np.repeat(np.arange(len(whole)), [len(scan) for scan in whole]), np.concatenate(whole)


def _batches(lines: Lines) -> Iterator[Lines]:
    """Yield the lines in batches of about `_AT_ONCE` points, whole lines each, numbered from 0."""
    batch = (np.cumsum(np.bincount(lines.line)) - 1) // _AT_ONCE
    for number in np.unique(batch):
        rows = np.flatnonzero(batch == number)
        points = np.isin(lines.line, rows)
        line = lines.line[points] - rows[0]
        inputs = {path: values[rows] for path, values in lines.inputs.items()}
        yield Lines(inputs, line, lines.position[points])


def _boundaries_of(
    case: Configuration, lines: Lines, level: float, options: Mapping[str, Any]
) -> tuple[list[OfLine], int]:
    """Return what was found on each line, and the number of eigen-solves."""

    models = models_of(case, lines, options)
    search = Search(models, lines.line, lines.position, level, forgiving=True)
    count = int(lines.line.max()) + 1
    failed = [lines.position[(lines.line == line) & ~search.scanned.works].tolist() for line in range(count)]
    reasons = [_reason(search, lines, line) for line in range(count)]
    if search.scanned.points is None:
        return [
            OfLine([], _NOTHING, reason, gaps=tuple(gaps))
            for reason, gaps in zip(reasons, failed, strict=True)
        ], 0
    brackets = Brackets(search)
    boundaries = _named(each_once(brackets.close()), models)
    for line, low, why in _lost(search, brackets):
        reasons[line] = "; ".join(filter(None, (reasons[line], f"a boundary was lost: {why}")))
        failed[line].append(low)
    found = []
    for line, reason in enumerate(reasons):
        own = [one for one in boundaries if one.crossing.line == line]
        note, searched = _note(search, line, own, level)
        found.append(OfLine(own, note, reason, searched, tuple(sorted(failed[line]))))
    return found, int(search.solves.sum() + brackets.solves.sum())


def _lost(search: Search, brackets: Brackets) -> Iterator[tuple[int, float, str]]:
    """Yield the line, the lower end and the reason of each step in which a boundary was lost or may be."""
    for place, why in brackets.lost.items():
        yield int(brackets.line[place]), float(brackets.x[:, place].min()), why
    for line, low, _ in search.unsettled:
        yield line, low, JUMPS


def _note(search: Search, line: int, own: list[Found], level: float) -> tuple[str, tuple[float, float]]:
    """Return the note on a line, and the range that could be analysed."""
    points = search.points
    places = np.flatnonzero(points.line == line)
    if not len(places):
        return _NOTHING, (np.nan, np.nan)
    position = points.position[places]
    low, high = float(position.min()), float(position.max())
    first = places[position.argmin()]
    if np.any(points.growth[first] > points.error[first]):
        beyond = f"below {100 * level:g} % of critical" if level else "unstable"
        return f"already {beyond} at the lowest airspeed, {low / KNOT:.4g} {KTAS}", (low, high)
    stable = not any(one.crossing.onset for one in own)
    return f"no mode becomes unstable up to {high / KNOT:.4g} {KTAS}" * stable, (low, high)


def _named(crossings: Sequence[Crossing], models: Any) -> list[Found]:
    """Return the boundaries of crossings, with what moves in each and what makes it doubtful."""
    if not crossings:
        return []
    lines, positions = np.array([(one.line, one.position) for one in crossings]).T
    model = models(lines.astype(int), positions)
    spectrum = stacked(crossings)
    every = spectrum.all_modes
    names, kind = moving(model, every.values, every.left, every.right).names, kinds(model, every)
    return [
        Found(one, str(names[row, one.state]), str(kind[row, one.state]), str(model.trim.warning[row]))
        for row, one in enumerate(crossings)
    ]


def stacked(crossings: Sequence[Crossing]) -> Spectrum:
    """Return the spectra of crossings as one, a point for each."""
    values, right = (
        np.stack([getattr(one.spectrum, part) for one in crossings]) for part in ("values", "right")
    )
    shapes = [one.spectrum.shapes for one in crossings]
    known = [shape for shape in shapes if shape is not None]
    own = np.stack(known) if len(known) == len(shapes) else None
    return crossings[0].spectrum._replace(values=values, right=right, shapes=own)


def _reason(search: Search, lines: Lines, line: int) -> str:
    """Return why airspeeds of a line failed, by the first of them; empty where all could be analysed."""
    places = np.flatnonzero((lines.line == line) & ~search.scanned.works)
    if not len(places):
        return ""
    where = f"{len(places)} airspeeds from {lines.position[places[0]] / KNOT:.4g} {KTAS} on"
    return f"{where}: {search.scanned.reason[places[0]]}"
