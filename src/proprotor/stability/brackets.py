"""Crossings of a damping level, closed in on by Newton's method, all of them at once.

Each crossing is started at the root of the cubic over its step and kept in its bracket. A root within its error
(`proprotor.stability.root_error`) is neutral, and counts as not beyond the level.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from proprotor.stability.crossings import Search
from proprotor.stability.cubic import hermite_root
from proprotor.stability.matching import POOR, Spectrum, match_modes
from proprotor.stability.points import Points
from proprotor.typing import Array

JUMPS = "the model jumps, as from one trim to another"
_ITERATIONS = 60  # of Newton's method; with bisection as the last resort
_CLOSE = 1e-9  # of the position: the last correction, after which the next is rounding
_JUMP = 1e-6  # of a root and of 1 rad/s: growth that is left where a bracket has collapsed upon a jump
_SURE = 4.0  # errors of the growth that a slope must make over a bracket to count
_CAUTION = 16.0  # times the next correction that the change of the slope over a bracket lets expect


class Crossing(NamedTuple):
    """One root through the level.

    line; position; spectrum of the position, and the state that crosses; value of the root; change of the root and
    slope of G with the position; onset, whether the root becomes unstable; start, the point of the search before the
    crossing, and from_state, its state at this point; solves, eigen-solves beyond those of the search.
    """

    line: int
    position: float
    spectrum: Spectrum
    state: int
    value: complex
    change: complex
    slope: float
    onset: bool
    start: int
    from_state: int
    solves: int


class Brackets:
    """Steps over which a followed root crosses, each a bracket of one crossing.

    Parameters
    ----------
    search : Search
    close : float, optional
        The error that a position may have, in its unit; by default the last correction is a billionth of the position,
        and the error is rounding.
    """

    def __init__(self, search: Search, close: float | None = None) -> None:
        steps, points = search.steps, search.points
        self._search = search
        rows, states, ends = steps.crossing(points)
        if search.onset_only:
            rows, states, ends = _lowest_onsets(rows, states, ends, points.line[steps.before])
        self.start, self.from_state = steps.before[rows], states
        self.count, self.line = len(rows), points.line[self.start]
        last, to_state = steps.after[rows], steps.successor[rows, states]
        self.x = np.stack([points.position[self.start], points.position[last]])
        self.step = self.x.copy()
        self.scale = np.abs(self.x).max(axis=0, initial=0)
        self.near = np.full(self.count, close) if close else _CLOSE * self.scale
        self.allowed = close or 0.0
        self.cubic = ends
        self.onset = ends[1] > ends[0]
        self.place = np.stack([states, to_state])
        self.ends = [points.spectrum.at(self.start), points.spectrum.at(last)]
        self.solves = np.zeros(self.count, dtype=int)
        self.found: dict[int, Crossing] = {}
        self.lost: dict[int, str] = {}  # of each crossing that was not found: why

    def close(self) -> list[Crossing]:
        """Run Newton's method on every crossing, by the derivative at the last point, within the bracket."""
        active = np.arange(self.count)
        with np.errstate(all="ignore"):
            share = hermite_root(self.cubic)
        guess = self.x[0] + share * (self.x[1] - self.x[0])
        for _ in range(_ITERATIONS):
            if not len(active):
                break
            tried = self._search.solve(self.line[active], guess[active])
            for row in np.flatnonzero(~tried.works):
                self.lost[int(active[row])] = str(tried.reason[row])
            if tried.points is None:
                break
            active, points = active[tried.works], tried.points
            place = self._place(active, points)
            rows = np.arange(len(active))
            value, slope, error = (part[rows, place] for part in (points.growth, points.slope, points.error))
            self.solves[active] += 1
            with np.errstate(all="ignore"):  # at a double root the slope has no bound
                correction = -value / slope
            width = np.abs(self.x[1, active] - self.x[0, active])
            # Growth within its error is as good as zero, if the slope over the bracket is larger than the error.
            done = (np.abs(value) <= error) & (np.abs(slope) * width > _SURE * error)
            last = np.abs(correction) <= self.near[active]
            last |= (
                _CAUTION * self._next_correction(active, points.position, slope, correction) <= self.allowed
            )
            done |= last & (np.abs(value) > error)
            collapsed = ~done & (width <= 4e-16 * self.scale[active])
            size = np.abs(points.spectrum.values[rows, place])
            jumps = collapsed & (np.abs(value) > np.fmax(error, _JUMP * (1 + size)))
            self.lost |= dict.fromkeys(active[jumps].tolist(), JUMPS)
            done |= collapsed
            for one in np.flatnonzero(done & ~jumps).tolist():
                self._keep(int(active[one]), points, one, int(place[one]), float(correction[one]))
            self._narrow(active, value > error, points, place)
            newton = points.position + correction
            low, high = self.x[:, active].min(axis=0), self.x[:, active].max(axis=0)
            inside = (newton > low) & (newton < high) & (np.abs(value) > error)
            guess[active] = np.where(inside, newton, (low + high) / 2)
            active = active[~done]
        return list(self.found.values())

    def _next_correction(self, active: Array, position: Array, slope: Array, correction: Array) -> Array:
        """Return the size of the correction that would follow, from how the slope changes to the ends of the step.

        Newton's method leaves the square of a correction times G'' / 2G'.
        """
        length = self.step[1, active] - self.step[0, active]
        with np.errstate(all="ignore"):
            change = np.abs(slope - self.cubic[2:, active] / length) / np.abs(position - self.step[:, active])
            return np.asarray(correction**2 * change.max(axis=0) / (2 * np.abs(slope)))

    def _keep(self, crossing: int, points: Points, row: int, place: int, correction: float) -> None:
        """Record the crossing at a trial point, with a last correction if this stays within the bracket."""
        low, high = self.x[:, crossing]
        if not (np.isfinite(correction) and low <= points.position[row] + correction <= high):
            correction = 0.0
        slope = float(points.slope[row, place])
        self.found[crossing] = Crossing(
            int(self.line[crossing]),
            float(points.position[row]) + correction,
            points.spectrum.at(row),
            place,
            complex(points.spectrum.values[row, place] + correction * points.change[row, place]),
            complex(points.change[row, place]),
            slope,
            slope > 0 if slope else bool(self.onset[crossing]),
            int(self.start[crossing]),
            int(self.from_state[crossing]),
            int(self.solves[crossing]),
        )

    def _place(self, active: Array, points: Points) -> Array:
        """Return which state of each trial point is the one that crosses, followed from an end of the bracket.

        The state is followed from the nearer end. Where roots fall into one on the way, it is followed from the end
        with the better quality; if both are poor, from the end beyond the level, where the roots have parted. Where a
        pair parts into real roots between the ends, it is followed from the end of the same kind as the trial point,
        since a pair does not tell which of two real roots it becomes.
        """
        nearer = np.argmin(np.abs(self.x[:, active] - points.position), axis=0)
        place, quality, alike = self._followed(active, nearer, points)
        rest = np.flatnonzero((quality < POOR) | ~alike)  # elsewhere the other end does not matter
        if len(rest):
            place[rest] = self._place_by_both(active[rest], nearer[rest], points.at(rest))
        return place

    def _followed(self, active: Array, end: Array, points: Points) -> tuple[Array, Array, Array]:
        """Return which state of each trial point an end of its bracket, 0 or 1, becomes.

        Then the quality of this step, and whether both are real or both are one of a pair.
        """
        count, rows, values = len(active), np.arange(len(active)), points.spectrum.values
        starts = self.ends[0].at(active).joined(self.ends[1].at(active)).at(end * count + rows)
        own = self.place[end, active]
        step = match_modes(starts.joined(points.spectrum), rows, count + rows)
        place, quality = (part[rows, own] for part in step)
        return place, quality, (starts.values[rows, own].imag == 0) == (values[rows, place].imag == 0)

    def _place_by_both(self, active: Array, nearer: Array, points: Points) -> Array:
        """Return which state of each trial point is the one that crosses, by both ends of its bracket."""
        rows = np.arange(len(active))
        followed = [self._followed(active, np.full(len(active), end), points) for end in (0, 1)]
        places, quality, alike = map(np.stack, zip(*followed, strict=True))
        beyond = self.onset[active].astype(int)
        better = np.where(quality.max(axis=0) < POOR, beyond, quality.argmax(axis=0))
        clear = np.where(quality[nearer, rows] < POOR, better, nearer)
        chosen = np.where(alike[0] == alike[1], clear, alike[1].astype(int))
        return np.asarray(places[chosen, rows])

    def _narrow(self, active: Array, beyond: Array, points: Points, place: Array) -> None:
        """Replace the end of each bracket that lies on the same side of the level as its trial point by this point."""
        sides = (beyond == self.onset[active]).astype(int)
        for row, (crossing, side) in enumerate(zip(active, sides, strict=True)):
            self.x[side, crossing], self.place[side, crossing] = points.position[row], place[row]
            for kept, new in zip(self.ends[side][:3], points.spectrum[:3], strict=True):
                if kept is not None and new is not None:
                    kept[crossing] = new[row]


def each_once(found: list[Crossing]) -> list[Crossing]:
    """Return crossings by line and position, each root once."""
    kept: list[Crossing] = []
    for one in sorted(found, key=lambda one: (one.line, one.position)):
        if not any(_same(one, other) for other in reversed(kept[-8:])):
            kept.append(one)
    return kept


def _same(one: Crossing, other: Crossing) -> bool:
    """Return whether two crossings are one: both states of a pair that joins within a step may be found to cross."""
    if one.spectrum.block[one.state] != other.spectrum.block[other.state]:
        return False
    near = abs(one.position - other.position) <= 1e-7 * max(abs(one.position), abs(other.position))
    values = [complex(found.value.real, abs(found.value.imag)) for found in (one, other)]
    alike = abs(values[0] - values[1]) <= 1e-6 * max(1.0, abs(one.value))
    return one.line == other.line and one.onset == other.onset and near and alike


def _lowest_onsets(rows: Array, states: Array, ends: Array, line: Array) -> tuple[Array, Array, Array]:
    """Return the onsets that lie in the first step of each line with any onset."""
    onset = ends[1] > ends[0]
    rows, states, ends = rows[onset], states[onset], ends[:, onset]
    first = np.full(int(line.max(initial=-1)) + 1, np.iinfo(int).max)
    np.minimum.at(first, line[rows], rows)  # steps are in the order of their lines and positions
    lowest = rows == first[line[rows]]
    return rows[lowest], states[lowest], ends[:, lowest]
