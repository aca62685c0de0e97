"""The XV-15's modes at 200 and 300 kt for every combination of switches: computed, kept in a file, compared.

A mode is the size of its eigenvalue per revolution, |s|/Ω, and its damping ratio, which together are the eigenvalue; a real
root is a mode with damping ratio 1 or -1. Its coordinate, the one that takes part most, is there for the reader only.
"""

import csv
import itertools
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment

import proprotor as pp
from benchmarks.xv15_switches import KNOT, PAPER_FREQUENCIES
from proprotor.options import CHOICES

FILE = Path(__file__).with_name("xv15_switches.csv")
SWITCHES = ("equations", "pitch", "structure", "airloads", "compressibility", "rotor_speed")
KNOTS = (200, 300)
HEADER = (*SWITCHES, "knots", "coordinate", "frequency", "damping_ratio")

# Matrices that differ by 1e-14 of each entry have eigenvalues that differ by less than 1e-12 of their size (condition
# numbers reach 260). Rounding, of the linear algebra and of ten digits in the file, stays far below this:
TOLERANCE = 1e-8  # of the frequency; the damping ratio is a number of order 1
NO_FREQUENCY = 1e-9  # per rev; the rotor's speed without airloads has an eigenvalue of zero

Point = tuple[str, ...]  # a choice for each switch, and knots


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


def computed() -> Modes:
    """Modes of the model as it is, both speeds in one call."""
    case = pp.load_case("xv15")
    found = {}
    for choice in itertools.product(*(CHOICES[name] for name in SWITCHES)):
        options = dict(zip(SWITCHES, choice, strict=True))
        if options["structure"] == "tabulated":
            options["frequencies"] = PAPER_FREQUENCIES
        modes = case.linearize(np.array(KNOTS) * KNOT, **options).modes()
        for place, knots in enumerate(KNOTS):
            columns = (modes[name].values[place] for name in ("dominant", "natural_frequency", "damping_ratio"))
            rows = [_mode(*row, case.operation.rotor_speed) for row in zip(*columns, strict=True)]
            found[*map(str, choice), str(knots)] = sorted((row for row in rows if row), key=lambda row: row[1:])
    return found


def _mode(coordinate: str, frequency: float, damping_ratio: float, rotor_speed: float) -> Mode | None:
    """A mode per revolution; none where the batch has a longer list of modes at another speed."""
    if not coordinate:
        return None
    if frequency < NO_FREQUENCY * rotor_speed:
        return Mode(coordinate, 0.0, 0.0)
    return Mode(coordinate, float(frequency / rotor_speed), float(damping_ratio))


def kept() -> Modes:
    """Modes of the file."""
    found: Modes = {}
    with FILE.open(newline="", encoding="utf-8") as file:
        for *point, coordinate, frequency, damping_ratio in itertools.islice(csv.reader(file), 1, None):
            found.setdefault(tuple(point), []).append(Mode(coordinate, float(frequency), float(damping_ratio)))
    return found


def keep(modes: Modes) -> None:
    """Write the file."""
    with FILE.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADER)
        for point, rows in modes.items():
            writer.writerows((*point, row[0], f"{row[1]:.9e}", f"{row[2]:.11f}") for row in rows)


def accepted(was: Modes, now: Modes) -> Modes:
    """`now`, with the old digits of every point where nothing moved: a difference of files shows what did."""
    moved = {change.point for change in changes(was, now)}
    return {point: now[point] if point in moved else was[point] for point in now}


def changes(was: Modes, now: Modes) -> list[Change]:
    """What moved by more than the tolerance, or came or went; the largest first."""
    found = [change for point in {**was, **now} for change in _pairs(point, was.get(point, []), now.get(point, []))]
    return sorted((change for change in found if change.size > TOLERANCE), key=lambda change: -change.size)


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


def told(found: list[Change], points: int, most: int = 30) -> str:
    """Where modes moved, switch by switch, and the largest changes."""
    lines = [f"{len(found)} modes moved, at {len({change.point for change in found})} of {points} points."]
    for place, name in enumerate((*SWITCHES, "knots")):
        counts = Counter(change.point[place] for change in found)
        lines.append(f"  {name:<16}" + ", ".join(f"{choice} {count}" for choice, count in counts.items()))
    widths = (12, 9, 11, 12, 7, 13, 5, 13)
    header = (*SWITCHES[:4], "compr.", "rotor speed", "kt", "coordinate")
    lines.append("".join(f"{text:<{width}}" for text, width in zip(header, widths, strict=True)) + _COLUMNS)
    for change in found[:most]:
        known = change.now or change.was
        cells = (*change.point, known.coordinate)
        lines.append("".join(f"{text:<{width}}" for text, width in zip(cells, widths, strict=True)) + _movement(change))
    lines += [f"and {len(found) - most} more, which moved less"] if len(found) > most else []
    return "\n".join(lines)


_COLUMNS = f"{'frequency per rev, was and is':<34}damping in % of critical, was and is"


def _movement(change: Change) -> str:
    was, now = change.was, change.now
    if was is None or now is None:
        verb, mode = ("came", now) if was is None else ("went", was)
        return f"{verb}: {mode.frequency:.5f} per rev, {100 * mode.damping_ratio:.4f} %"
    frequency = f"{was.frequency:.5f}  {now.frequency:.5f}  {now.frequency - was.frequency:+.2e}"
    old, new = 100 * was.damping_ratio, 100 * now.damping_ratio
    return f"{frequency:<34}{old:.4f}  {new:.4f}  {new - old:+.2e}"
