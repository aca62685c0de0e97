"""Crossings of a damping level along a path of followed modes: found, bracketed and closed in on.

Each mode has a growth G, and its exact derivative from matrices a complex step away. The cubic that has both at the
ends of a step tells crossings within it, also of modes that dip and return between two points that look stable: where
it comes nearer to the level than its error, an eigen-solve at its extremum settles the matter. Each bracketed crossing
is found by Newton's method, started at the root of the cubic and kept in the bracket.

The level is a damping ratio ζ0, and G = Re λ + ζ0 |λ| is positive where the damping -Re λ/|λ| is below it.
"""

from __future__ import annotations

import numpy as np

from proprotor.arrays import Array
from proprotor.cubic import hermite, hermite_extrema, hermite_root
from proprotor.eigenvalue_derivatives import eigenvalue_change, with_changes
from proprotor.modes import decomposition
from proprotor.path import Line, Path
from proprotor.tracking import Spectrum, link

_ROUNDS = 6  # of eigen-solves at extrema
_ITERATIONS = 40  # of Newton's method; with bisection as the last resort
_CLOSE = 1e-9  # of the position: the last correction, after which the next is rounding
NEUTRAL = 1e-9  # of the largest eigenvalue: growth that says nothing
_SAFETY = 4.0  # the error of a cubic over one step is a sixteenth of that over two; a quarter is taken


def growth(values: Array, level: float = 0.0) -> Array:
    """G = Re λ + ζ0 |λ|, 1/s: positive where the damping ratio is below the level."""
    return values.real + level * np.abs(values) if level else values.real


def growth_rate(values: Array, changes: Array, level: float = 0.0) -> Array:
    """Change of G with a change of λ."""
    if not level:
        return changes.real
    size = np.abs(values)
    return changes.real + level * (values.conj() * changes).real / np.where(size > 0, size, 1)


class Scan:
    """A path with growth and its derivative at every point, into which points can be put."""

    def __init__(self, line: Line, path: Path, level: float) -> None:
        self.line, self.level, self.path = line, level, path
        self._changes = np.full(path.spectrum.values.shape, np.nan, dtype=complex)
        if len(path.points):
            model, changes = with_changes(line.models, path.positions[path.points])
            here = path.spectrum.at(path.points).all_modes
            self._changes[path.points] = eigenvalue_change(model, changes, here)

    @property
    def positions(self) -> Array:
        """Of the points of the path (k,)."""
        return self.path.positions[self.path.points]

    def growths(self) -> tuple[Array, Array]:
        """Growth and its derivative by the position, of the followed states (k, states)."""
        changes = np.take_along_axis(self._changes[self.path.points], self.path.places, 1)
        return growth(self.path.values, self.level), growth_rate(self.path.values, changes, self.level)

    def put(self, after: Array, positions: Array) -> bool:
        """Put points into steps; whether any of them could be analysed."""
        found, changes = solved(self.line, positions)
        works = found.works
        if works.any():
            self.path = self.path.with_points(after[works], positions[works], found.at(works))
            self._changes = np.concatenate([self._changes, changes[works]])
        return bool(works.any())


def solved(line: Line, positions: Array) -> tuple[Spectrum, Array]:
    """Eigen-solves at positions (k,), with the derivative of every eigenvalue by the position (k, states)."""
    model, changes = with_changes(line.models, positions)
    found = decomposition(model)
    return found, eigenvalue_change(model, changes, found.all_modes)


def _cubics(scan: Scan) -> tuple[Array, Array, Array]:
    """Ends (4, steps, states) of the cubics of all steps, their likely errors, and whether a state counts in a step."""
    x, (value, slope) = scan.positions, scan.growths()
    length = np.diff(x)[:, None]
    ends = np.stack([value[:-1], value[1:], slope[:-1] * length, slope[1:] * length])
    error = np.zeros(value.shape)
    if len(x) > 2:
        whole = (x[2:] - x[:-2])[:, None]
        over_two = np.stack([value[:-2], value[2:], slope[:-2] * whole, slope[2:] * whole])
        error[1:-1] = np.abs(
            hermite(((x[1:-1] - x[:-2]) / (x[2:] - x[:-2]))[:, None], over_two) - value[1:-1]
        )
    below = scan.path.values.imag < 0
    return ends, np.maximum(error[:-1], error[1:]) / _SAFETY, ~(below[:-1] & below[1:])


def settle(scan: Scan) -> None:
    """Put points where a mode may cross the level twice within a step and neither end tells."""
    for _ in range(_ROUNDS):
        if len(scan.positions) < 2:
            return
        ends, error, counts = _cubics(scan)
        steps, states = np.nonzero(counts & np.isfinite(ends).all(axis=0))
        cubic, noise = ends[:, steps, states], error[steps, states]
        at = hermite_extrema(cubic)
        peak = hermite(at, cubic[:, :, None])
        floor = NEUTRAL * np.nanmax(np.abs(scan.path.values), initial=0)
        sides = np.where(np.abs(cubic[:2]) <= floor, 0.0, np.sign(cubic[:2]))
        side = np.where(sides[0] != 0, sides[0], sides[1])
        # An extremum beyond the level, or nearer to it than the cubic is exact, though neither end is beyond;
        # with ends on either side, two extrema that are on the wrong ones. Neutral all along is no crossing.
        hidden = (sides[0] * sides[1] >= 0)[:, None] & (side[:, None] * peak < noise[:, None] + floor)
        order = hermite(np.sort(at, axis=1), cubic[:, :, None])
        thrice = (sides[0] * sides[1] < 0) & (side * order[:, 0] < -noise) & (side * order[:, 1] > noise)
        hidden = (hidden | thrice[:, None]) & (side != 0)[:, None]
        which, extremum = np.nonzero(hidden & np.isfinite(at))
        if not len(which):
            return
        step, first = np.unique(steps[which], return_index=True)  # one point in a step and round
        share = np.clip(at[which, extremum][first], 0.02, 0.98)
        x = scan.positions
        if not scan.put(step, x[step] + share * (x[step + 1] - x[step])):
            return


class Brackets:
    """Steps over which a followed state crosses, closed in on for all of them at once."""

    def __init__(self, scan: Scan) -> None:
        ends, _, counts = _cubics(scan)
        floor = NEUTRAL * np.nanmax(np.abs(scan.path.values), initial=0)
        side = np.where(np.abs(ends[:2]) <= floor, -1.0, np.sign(ends[:2]))
        steps, self.states = np.nonzero(counts & (side[0] != side[1]) & np.isfinite(ends).all(axis=0))
        path, x = scan.path, scan.positions
        self.scan, self.count = scan, len(steps)
        self.x = np.stack([x[steps], x[steps + 1]])
        self.cubic = ends[:, steps, self.states]
        self.value = np.where(np.abs(self.cubic[:2]) <= floor, -floor, self.cubic[:2])
        self.onset = self.value[1] > 0
        points = np.stack([path.points[steps], path.points[steps + 1]])
        self.place = np.stack([path.places[steps, self.states], path.places[steps + 1, self.states]])
        self.ends = [path.spectrum.at(row) for row in points]
        self.found: dict[int, tuple[float, Spectrum, int, complex, float]] = {}
        self.solves = np.zeros(self.count, dtype=int)

    def close(self) -> None:
        """Newton's method on every crossing, by the derivative at the last point, within the bracket."""
        active = np.arange(self.count)
        with np.errstate(all="ignore"):
            share = hermite_root(self.cubic) if self.count else np.empty(0)
        guess = self.x[0] + share * (self.x[1] - self.x[0])
        for _ in range(_ITERATIONS):
            if not len(active):
                return
            position = guess[active]
            spectrum, changes = solved(self.scan.line, position)
            works = spectrum.works
            active, position, changes = active[works], position[works], changes[works]
            spectrum = spectrum.at(works)
            place = self._place(active, position, spectrum)
            rows = np.arange(len(active))
            value = growth(spectrum.values[rows, place], self.scan.level)
            slope = growth_rate(spectrum.values[rows, place], changes[rows, place], self.scan.level)
            self.solves[active] += 1
            with np.errstate(all="ignore"):  # at a double root the slope has no bound
                correction = -value / slope
            scale = np.maximum(np.abs(self.x[0, active]), np.abs(self.x[1, active]))
            done = np.abs(correction) <= _CLOSE * scale
            done |= np.abs(self.x[1, active] - self.x[0, active]) <= 4e-16 * scale
            for row in np.flatnonzero(done):
                self.found[int(active[row])] = (
                    position[row] + (correction[row] if np.isfinite(correction[row]) else 0.0),
                    spectrum.at(row),
                    int(place[row]),
                    changes[row, place[row]],
                    slope[row],
                )
            self._narrow(active, position, value, place, spectrum)
            newton = position + correction
            low, high = self.x[:, active].min(axis=0), self.x[:, active].max(axis=0)
            inside = (newton > low) & (newton < high)
            guess[active] = np.where(inside, newton, (low + high) / 2)
            active = active[~done]

    def _place(self, active: Array, position: Array, spectrum: Spectrum) -> Array:
        """Which state of each trial point is the one that crosses, followed from the ends of the bracket.

        From the nearer end; where a pair parts into real roots between the ends, from the one that is of the trial's
        kind, since a pair does not tell which of two real roots it becomes.
        """
        rows = np.arange(len(active))
        nearer = np.argmin(np.abs(self.x[:, active] - position), axis=0)
        places, alike = np.empty((2, len(active)), dtype=int), np.empty((2, len(active)), dtype=bool)
        for end, found in enumerate(self.ends):
            start = found.at(active)
            successor = link(start.joined(spectrum), rows, len(active) + rows).successor
            own = self.place[end, active]
            places[end] = successor[rows, own]
            alike[end] = (start.values[rows, own].imag == 0) == (spectrum.values[rows, places[end]].imag == 0)
        chosen = np.where(alike[0] == alike[1], nearer, alike[1].astype(int))
        followed: Array = places[chosen, rows]
        return followed

    def _narrow(self, active: Array, position: Array, value: Array, place: Array, spectrum: Spectrum) -> None:
        """The trial points take the place of the end on their side."""
        end = (np.sign(value) != np.sign(self.value[0, active])).astype(int)
        for row, crossing in enumerate(active):
            side = end[row]
            self.x[side, crossing], self.value[side, crossing] = position[row], value[row]
            self.place[side, crossing] = place[row]
            for kept, new in zip(self.ends[side], spectrum, strict=True):
                if kept is not None and new is not None:
                    kept[crossing] = new[row]
