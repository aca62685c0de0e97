"""Accepted modes in a CSV file: kept, compared with those of the model as it is, and told.

A mode is the size of its eigenvalue per revolution, |s|/Ω, and its damping ratio, which together are the
eigenvalue; a real root has a damping ratio of 1 or -1. The coordinate that takes part most is there for the
reader and is not compared.
"""

from __future__ import annotations

import csv
import io
import itertools
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray
from scipy.optimize import linear_sum_assignment

from proprotor.files.output import write_whole

# Eigenvalues have condition numbers up to 260: matrices that differ by 1e-14 of each entry have eigenvalues that
# differ by less than 1e-12 of their size. Rounding, also to the digits of the file, stays far below this:
TOLERANCE = 1e-8  # of the frequency; the damping ratio is a number of order 1
NO_FREQUENCY = 1e-9  # per rev; the rotor's speed without airloads has an eigenvalue of zero
COMMAND = "python -m tests.accept_golden"

Point = tuple[str, ...]  # a choice for each column of a record


class Mode(NamedTuple):
    coordinate: str
    frequency: float
    damping_ratio: float


class Change(NamedTuple):
    """A mode that moved, or that only one side has."""

    point: Point
    was: Mode | None
    now: Mode | None

    @property
    def size(self) -> float:
        """What the tolerance bounds."""
        if self.was is None or self.now is None:
            return np.inf
        frequencies = (self.was.frequency, self.now.frequency)
        relative = abs(np.subtract(*frequencies)) / max(*frequencies, NO_FREQUENCY)
        return max(relative, abs(self.was.damping_ratio - self.now.damping_ratio))


Modes = dict[Point, list[Mode]]


@dataclass(frozen=True)
class Record:
    """A file of accepted modes.

    Attributes
    ----------
    file : Path
    columns : tuple of str
        What a point is named by: the switches, the deck, the airspeed.
    """

    file: Path
    columns: tuple[str, ...]

    def kept(self) -> Modes:
        """Modes of the file; none where there is no file yet."""
        found: Modes = {}
        if not self.file.exists():
            return found
        with self.file.open(newline="", encoding="utf-8") as file:
            for *point, coordinate, frequency, damping_ratio in itertools.islice(csv.reader(file), 1, None):
                mode = Mode(coordinate, float(frequency), float(damping_ratio))
                found.setdefault(tuple(point), []).append(mode)
        return found

    def keep(self, modes: Modes) -> None:
        """Write the file, whole or not at all."""
        text = io.StringIO(newline="")
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow((*self.columns, "coordinate", "frequency", "damping_ratio"))
        for point, rows in modes.items():
            writer.writerows((*point, row[0], f"{row[1]:.9e}", f"{row[2]:.11f}") for row in rows)
        write_whole(self.file, lambda file: file.write(text.getvalue().encode()))

    def told(self, found: Sequence[Change], points: int, most: int = 30) -> str:
        """Where modes moved, choice by choice, and the largest changes."""
        lines = [
            f"{len(found)} modes moved, at {len({change.point for change in found})} of {points} points:",
            *self._counts(found),
        ]
        shown = [(*change.point, (change.now or change.was).coordinate) for change in found[:most]]
        head = (*self.columns, "coordinate")
        widths = [max(map(len, column)) + 2 for column in zip(head, *shown, strict=True)]
        lines.append(_row(head, widths) + f"{'frequency, per rev':<32}damping, % of critical")
        for change, cells in zip(found, shown, strict=False):
            lines.append(_row(cells, widths) + movement(change))
        if len(found) > most:
            lines.append(f"and {len(found) - most} more, which moved less")
        return "\n".join(lines)

    def _counts(self, found: Sequence[Change]) -> Iterator[str]:
        for place, name in enumerate(self.columns):
            counts = Counter(change.point[place] for change in found)
            yield f"  {name:<16}" + ", ".join(f"{choice} {count}" for choice, count in counts.items())


def modes_at_each(modes: xarray.Dataset, rotor_speed: float) -> Iterator[list[Mode]]:
    """The modes of each point of a batch along the airspeed."""
    along = modes.transpose("airspeed", ...)
    per_rev = along.natural_frequency.values / rotor_speed
    for point in zip(along.dominant.values, per_rev, along.damping_ratio.values, strict=True):
        yield [_mode(*row) for row in zip(*point, strict=True) if np.isfinite(row[1])]


def accepted(was: Modes, now: Modes) -> Modes:
    """`now`, with the old digits of every point where nothing moved: a difference of files shows what did."""
    moved = {change.point for change in changes(was, now)}
    return {point: now[point] if point in moved else was[point] for point in now}


def changes(was: Modes, now: Modes) -> list[Change]:
    """What moved by more than the tolerance, or came or went; the largest first."""
    found = itertools.chain.from_iterable(
        _pairs(point, was.get(point, []), now.get(point, [])) for point in was | now
    )
    return sorted((change for change in found if change.size > TOLERANCE), key=lambda change: -change.size)


def movement(change: Change) -> str:
    """What a mode was and is, and the difference."""
    was, now = change.was, change.now
    if was is None or now is None:
        verb, mode = ("came", now) if was is None else ("went", was)
        return f"{verb}: {mode.frequency:.5f} per rev, {100 * mode.damping_ratio:.4f} %"
    numbers = (*was[1:], *now[1:], now.frequency - was.frequency, now.damping_ratio - was.damping_ratio)
    old, old_ratio, new, new_ratio, change_, ratio_change = numbers
    frequency = f"{old:.5f} -> {new:.5f}, {change_:+.1e}"
    return f"{frequency:<32}{100 * old_ratio:.4f} -> {100 * new_ratio:.4f}, {100 * ratio_change:+.1e}"


def _mode(coordinate: str, frequency: float, damping_ratio: float) -> Mode:
    """A mode, exactly zero where it is zero but for rounding."""
    if frequency < NO_FREQUENCY:
        return Mode(str(coordinate), 0.0, 0.0)
    return Mode(str(coordinate), float(frequency), float(damping_ratio))


def _pairs(point: Point, was: list[Mode], now: list[Mode]) -> Iterator[Change]:
    """Each mode with the one whose eigenvalue is nearest, one to one."""
    distance = np.abs(_eigenvalues(was)[:, None] - _eigenvalues(now))
    rows, columns = linear_sum_assignment(distance)
    yield from (Change(point, was[i], now[j]) for i, j in zip(rows, columns, strict=True))
    yield from (Change(point, was[i], None) for i in sorted(set(range(len(was))) - set(rows)))
    yield from (Change(point, None, now[j]) for j in sorted(set(range(len(now))) - set(columns)))


def _eigenvalues(modes: list[Mode]) -> np.ndarray:
    """s/Ω."""
    frequency, ratio = np.array([mode[1:] for mode in modes]).reshape(-1, 2).T
    return frequency * (-ratio + 1j * np.sqrt(np.maximum(1 - ratio**2, 0)))


def _row(cells: Sequence[str], widths: Sequence[int]) -> str:
    return "".join(f"{cell:<{width}}" for cell, width in zip(cells, widths, strict=True))
