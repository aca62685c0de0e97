"""Crossings of a damping level along lines of models, all lines at once: found, bracketed and closed in on.

The level is a damping ratio ζ0, and G = Re λ + ζ0 |λ| is positive where the damping -Re λ/|λ| is below it. Each root
has G and its exact derivative at every point, from matrices a complex step away. Over a step from one point to the next
a root is followed by its vectors, and the cubic that has values and slopes of both ends, in a band of its likely error,
tells how often G changes its sign: `proprotor.stability.steps`. Where that is not settled the step is parted at the point in
question, until it is; the error of the cubic is known by then. Each crossing is found by Newton's method, started at
the root of the cubic and kept in its bracket.

Where the lowest onset of each line is all that is wanted the points are solved for their eigenvalues alone, linked by
the nearest ones (`proprotor.stability.screening`). Differences stand for derivatives, and the steps that may hold the onset by
that are the only ones whose ends get vectors.

Whether G has a sign is a matter of its error (`proprotor.stability.root_error`). A root within it is neutral, and counts as not
beyond the level; one that is neutral all along crosses nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from proprotor.errors import InputError
from proprotor.model.first_order import held_coordinates, missing_roots, some_points
from proprotor.model.linear_model import LinearModel
from proprotor.stability.cubic import hermite_root
from proprotor.stability.eigenvalue_derivatives import eigenvalue_change, second_order_left, with_changes
from proprotor.stability.matching import POOR, Modes, Spectrum, link
from proprotor.stability.modes import decomposition
from proprotor.stability.root_error import growth, growth_error, refined_near, roots
from proprotor.stability.root_pairs import MANY, along_scan
from proprotor.stability.screening import steps_by_values
from proprotor.stability.steps import Steps, first_steps, parted, undecided
from proprotor.typing import Array

Models = Callable[[Array, Array], LinearModel]  # lines (k,) of int and positions (k,) to the models there

_ROUNDS = 20  # of parting
_MOST_SOLVES = 1000  # of a line, after which no more of its steps are parted
_HALVINGS = 6  # of a step at whose other end nothing can be analysed
_ITERATIONS = 60  # of Newton's method; with bisection as the last resort
_CLOSE = 1e-9  # of the position: the last correction, after which the next is rounding
_TRUST = 0.5  # in cubics whose slopes are differences
_JUMP = 1e-6  # of a root and of 1 rad/s: growth that is left where a bracket has collapsed upon a jump
JUMPS = "the model jumps, as from one trim to another"
_SURE = 4.0  # errors of the growth that a slope must make over a bracket to count


def growth_rate(values: Array, changes: Array, level: float = 0.0) -> Array:
    """Change of G with a change of λ."""
    if not level:
        return changes.real
    size = np.abs(values)
    return changes.real + level * (values.conj() * changes).real / np.where(size > 0, size, 1)


class Points(NamedTuple):
    """Points of lines: the roots of each, refined, and how they move.

    line, position (k,); spectrum; change (k, states), of each root by the position; growth, its change, `slope`, and
    its error (k, states).
    """

    line: Array
    position: Array
    spectrum: Spectrum
    change: Array
    growth: Array
    slope: Array
    error: Array

    def at(self, points: Array) -> Points:
        """Some of the points."""
        line, position, *rest = (part[points] for part in self._arrays)
        return Points(line, position, self.spectrum.at(points), *rest)

    def joined(self, other: Points) -> Points:
        """The points of both."""
        line, position, *rest = (
            np.concatenate(parts) for parts in zip(self._arrays, other._arrays, strict=True)
        )
        return Points(line, position, self.spectrum.joined(other.spectrum), *rest)

    @property
    def _arrays(self) -> tuple[Array, ...]:
        return self.line, self.position, self.change, self.growth, self.slope, self.error


class Solved(NamedTuple):
    """What came of a number of eigen-solves.

    points : those that work, None where there is none; works (k,), which of those asked for they are; reason (k,) of
    the others, and warning of all; missing (k,), why a point has fewer eigenvalues than others.
    """

    points: Points | None
    works: Array
    reason: Array
    warning: Array
    missing: Array


def solved(
    models: Models,
    line: Array,
    position: Array,
    level: float,
    forgiving: bool = False,
    states: int | None = None,
    plain: bool = False,
) -> Solved:
    """Eigen-solves at points of lines; where one of them cannot be had it spoils no other.

    `states` says how many eigenvalues there is room for, where some points have fewer than others elsewhere. If `plain`
    eigenvalues alone: the spectrum has no vectors and the derivatives are NaN, for a quarter of the cost.

    Raises
    ------
    InputError
        For an input that cannot be, unless `forgiving`: then it is the reason of its point.
    """
    try:
        return _solved(models, line, position, level, states, plain)
    except np.linalg.LinAlgError as error:
        told: Exception = error
    except InputError as error:
        if not forgiving:
            raise
        told = error
    if len(line) == 1:
        reason = np.array([" ".join(str(told).split("\n"))], dtype=object)
        nothing = np.array([""], dtype=object)
        return Solved(None, np.array([False]), reason, nothing, nothing)
    halves = [
        solved(models, line[half], position[half], level, forgiving, states, plain)
        for half in np.array_split(np.arange(len(line)), 2)
    ]
    return _together(*halves)


def _together(one: Solved, other: Solved) -> Solved:
    told = (np.concatenate(parts) for parts in zip(one[1:], other[1:], strict=True))
    if one.points is None or other.points is None:
        return Solved(other.points if one.points is None else one.points, *told)
    return Solved(one.points.joined(other.points), *told)


def _solved(
    models: Models, line: Array, position: Array, level: float, states: int | None, plain: bool
) -> Solved:
    if plain:
        return _values_alone(models(line, position), line, position, level, states)
    model, changes = with_changes(lambda x: models(line, x), position)
    spectrum = decomposition(model, None if states is None else held_coordinates(model, states))
    works, states = spectrum.works, spectrum.values.shape[-1]
    if not works.any():
        return Solved(None, works, *_told(model, states))
    part, some = some_points(model, works), spectrum.at(works)
    modes = some.all_modes
    left = second_order_left(part, modes.left)
    found = refined_near(part, some, level, left)
    mass, damping, stiffness = (np.broadcast_to(one, model.K.shape)[works] for one in changes)
    moved = Modes(found.values, modes.right, modes.left)
    change = eigenvalue_change(part, (mass, damping, stiffness), moved, left)
    points = Points(
        line[works],
        position[works],
        Spectrum(found.values, some.right, some.shapes),
        change,
        growth(found.values, level),
        growth_rate(found.values, change, level),
        growth_error(found.error, level),
    )
    return Solved(points, works, *_told(model, states))


def _values_alone(
    model: LinearModel, line: Array, position: Array, level: float, states: int | None
) -> Solved:
    """The points without vectors and derivatives."""
    values, error = roots(model, level)
    works = np.asarray(np.isfinite(values).any(axis=-1))
    states = values.shape[-1] if states is None else states
    if not works.any():
        return Solved(None, works, *_told(model, states))
    more = states - values.shape[-1]
    values, error = (
        np.pad(part[works], [(0, 0), (0, more)], constant_values=np.nan) for part in (values, error)
    )
    unknown = np.full(values.shape, complex(np.nan))
    spectrum = Spectrum(values, np.empty((*values.shape, 0), dtype=complex))
    points = Points(
        line[works],
        position[works],
        spectrum,
        unknown,
        growth(values, level),
        unknown.real,
        growth_error(error, level),
    )
    return Solved(points, works, *_told(model, states))


def _told(model: LinearModel, states: int) -> tuple[Array, Array, Array]:
    """Why points failed, what makes them doubtful, and why they have fewer roots than so many."""
    reason, warning = (np.array(part, dtype=object) for part in (model.trim.reason, model.trim.warning))
    return reason, warning, missing_roots(model, states)


class Search:
    """Points and steps of lines, and the crossings in them.

    Parameters
    ----------
    models : callable
        Models at points of lines; takes complex positions and is analytic in them, or refuses them.
    line, position : array (k,)
        The points of all lines, in the order of their lines and rising along each.
    level : float
        Damping ratio.
    names : bool
        Whether steps are parted wherever they do not tell which root is which, and not only near the level.
    onset_only : bool
        Whether the lowest onset of each line is all that is wanted.
    forgiving : bool
        Whether an input that cannot be is the reason of its points, and not raised.
    states : int, optional
        Eigenvalues of a point with all that any point has; by default those of the points given.
    """

    def __init__(
        self,
        models: Models,
        line: Array,
        position: Array,
        level: float = 0.0,
        *,
        names: bool = False,
        onset_only: bool = False,
        forgiving: bool = False,
        states: int | None = None,
    ) -> None:
        self.models, self.level, self.names, self.onset_only = models, level, names, onset_only
        self.forgiving = forgiving
        # Steps of lines on which nothing settles, as where the trim jumps to and fro.
        self.unsettled: list[Steps] = []
        self.scanned = solved(models, line, position, level, forgiving, states, plain=onset_only)
        some = self.scanned.points
        self.states = states if some is None else some.growth.shape[1]
        self.solves = np.bincount(line[self.scanned.works], minlength=int(line.max(initial=-1)) + 1)
        if self.scanned.points is not None:
            self.points = self.scanned.points
            self._reach_edges(line, position)
            self.first_points = self.points
            order = np.lexsort((self.points.position, self.points.line))
            same = np.diff(self.points.line[order]) == 0
            before, after = order[:-1][same], order[1:][same]
            if onset_only:
                self.steps = steps_by_values(self.points.spectrum.values, before, after)
                self._screen()
            else:
                self.steps = first_steps(self.points.spectrum, before, after)
            self._settle()

    def _screen(self) -> None:
        """Keep the steps that may hold the lowest onset, and solve their ends with vectors and derivatives.

        Differences from point to point stand for derivatives; with them the cubics are trusted half as much.
        """
        points, steps = with_differences(self.points, self.steps, self.level), self.steps
        share = undecided(steps, points, False, self.level, _TRUST, along_scan)
        asked = np.isfinite(share)
        asked[steps.crossing(points)[0]] = True
        asked |= (
            np.bincount(points.line)[points.line[steps.before]] < MANY
        )  # too few to tell much by differences
        kept = steps.at(np.flatnonzero(asked & self._before_onset()))
        ends = np.unique(np.concatenate([kept.before, kept.after]))
        if not len(ends):
            self.steps = kept
            return
        exact = solved(
            self.models, points.line[ends], points.position[ends], self.level, self.forgiving, self.states
        )
        if exact.points is None:
            self.steps = kept.at(np.array([], dtype=int))
            return
        np.add.at(self.solves, exact.points.line, 1)
        place = np.full(len(points.position), -1)
        place[ends[exact.works]] = np.arange(len(exact.points.position))
        before, after = place[kept.before], place[kept.after]
        both = (before >= 0) & (after >= 0)
        self.points = exact.points
        self.steps = first_steps(exact.points.spectrum, before[both], after[both])

    def _reach_edges(self, line: Array, position: Array) -> None:
        """Halve the steps from a point that works to one that does not: boundaries may lie there."""
        works = self.scanned.works
        edges = np.flatnonzero((line[1:] == line[:-1]) & (works[1:] != works[:-1]))
        good, bad = (np.where(works[edges], edges + k, edges + 1 - k) for k in (0, 1))
        line, good, bad = line[edges], position[good], position[bad]
        for _ in range(_HALVINGS if len(line) else 0):
            middle = (good + bad) / 2
            found = solved(
                self.models, line, middle, self.level, self.forgiving, self.states, plain=self.onset_only
            )
            good, bad = np.where(found.works, middle, good), np.where(found.works, bad, middle)
            if found.points is not None:
                self.points = self.points.joined(found.points)
                np.add.at(self.solves, found.points.line, 1)

    def _settle(self) -> None:
        """Part steps until each tells how often every root crosses."""
        for _ in range(_ROUNDS):
            wanted = np.flatnonzero(self.steps.open & self._before_onset())
            share = undecided(self.steps.at(wanted), self.points, self.names, self.level)
            self.steps.open[wanted] = False
            line = self.points.line[self.steps.before[wanted]]
            left = np.isfinite(share) & (self.solves[line] > _MOST_SOLVES)
            for one in np.flatnonzero(left).tolist():
                self.unsettled.append(self.steps.at(wanted[one : one + 1]))
            chosen = np.isfinite(share) & ~left
            if not chosen.any() or not self._part(wanted[chosen], share[chosen]):
                break
        order = np.lexsort((self.points.position[self.steps.before], self.points.line[self.steps.before]))
        self.steps = self.steps.at(order)

    def _before_onset(self) -> Array:
        """Which steps are not beyond one, on their line, over which a root becomes unstable for certain."""
        start = self.points.position[self.steps.before]
        if not self.onset_only:
            return np.ones(len(start), dtype=bool)
        line = self.points.line[self.steps.before]
        first = np.full(len(self.solves), np.inf)
        certain = self.steps.onsets(self.points)
        np.minimum.at(first, line[certain], start[certain])
        return np.asarray(start <= first[line])

    def _part(self, chosen: Array, share: Array) -> bool:
        """Put a point into each of some steps; whether any could be analysed."""
        x, line = self.points.position, self.points.line[self.steps.before[chosen]]
        start, end = x[self.steps.before[chosen]], x[self.steps.after[chosen]]
        at = start + share * (end - start)
        between = solved(self.models, line, at, self.level, self.forgiving, self.states)
        if between.points is None:
            return False
        self.points = self.points.joined(between.points)
        np.add.at(self.solves, line[between.works], 1)
        self.steps = parted(self.steps, chosen[between.works], self.points, len(x))
        return True


def with_differences(points: Points, steps: Steps, level: float) -> Points:
    """The points with differences to their neighbours in place of derivatives."""
    values = points.spectrum.values
    length = (points.position[steps.after] - points.position[steps.before])[:, None]
    rate = (steps.later(values) - values[steps.before]) / length
    there = np.empty(rate.shape, dtype=complex)
    np.put_along_axis(there, steps.successor, rate, 1)
    sums, weights = np.zeros(values.shape, dtype=complex), np.zeros((len(values), 1))
    for place, part in ((steps.before, rate), (steps.after, there)):  # the nearer neighbour counts more
        np.add.at(sums, place, part / length)
        np.add.at(weights, place, 1 / length)
    change = sums / np.where(weights > 0, weights, 1)
    return points._replace(change=change, slope=growth_rate(values, change, level))


class Crossing(NamedTuple):
    """One root through the level.

    line; position; spectrum of its point, and the state of it that crosses; change of the root and slope of G by the
    position; onset, whether it becomes unstable; start, the point of the search before it, and from_state, the state
    there; value, of the root at the position; solves beyond the search.
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
    """Steps over which a followed root crosses, closed in on for all of them at once.

    Parameters
    ----------
    search : Search
    close : float, optional
        The last correction of a position, in its unit; a billionth of it by default.
    """

    def __init__(self, search: Search, close: float | None = None) -> None:
        steps, points = search.steps, search.points
        self.models, self.level, self.forgiving = search.models, search.level, search.forgiving
        self.states = search.states
        rows, states, ends = steps.crossing(points)
        if search.onset_only:
            rows, states, ends = _lowest_onsets(rows, states, ends, points.line[steps.before])
        self.start, self.from_state = steps.before[rows], states
        self.count, self.line = len(rows), points.line[self.start]
        last, to_state = steps.after[rows], steps.successor[rows, states]
        self.x = np.stack([points.position[self.start], points.position[last]])
        self.scale = np.abs(self.x).max(axis=0, initial=0)
        self.near = np.full(self.count, close) if close else _CLOSE * self.scale
        self.cubic = ends
        self.onset = ends[1] > ends[0]
        self.place = np.stack([states, to_state])
        self.ends = [points.spectrum.at(self.start), points.spectrum.at(last)]
        self.solves = np.zeros(self.count, dtype=int)
        self.found: dict[int, Crossing] = {}
        self.lost: dict[int, str] = {}  # why those were not found that were not

    def close(self) -> list[Crossing]:
        """Newton's method on every crossing, by the derivative at the last point, within the bracket."""
        active = np.arange(self.count)
        with np.errstate(all="ignore"):
            share = hermite_root(self.cubic) if self.count else np.empty(0)
        guess = self.x[0] + share * (self.x[1] - self.x[0])
        for _ in range(_ITERATIONS):
            if not len(active):
                break
            tried = solved(
                self.models, self.line[active], guess[active], self.level, self.forgiving, self.states
            )
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
            # Within its error the growth says no more, if it is the slope that made it as small as that.
            done = (np.abs(value) <= error) & (np.abs(slope) * width > _SURE * error)
            done |= (np.abs(correction) <= self.near[active]) & (np.abs(value) > error)
            collapsed = ~done & (width <= 4e-16 * self.scale[active])
            size = np.abs(points.spectrum.values[rows, place])
            jumps = collapsed & (np.abs(value) > np.fmax(error, _JUMP * (1 + size)))
            self.lost |= dict.fromkeys(active[jumps].tolist(), JUMPS)
            done |= collapsed
            for one in np.flatnonzero(done & ~jumps).tolist():
                self._keep(int(active[one]), points, one, int(place[one]), float(correction[one]))
            beyond = value > error
            self._narrow(active, beyond, points, place)
            newton = points.position + correction
            low, high = self.x[:, active].min(axis=0), self.x[:, active].max(axis=0)
            inside = (newton > low) & (newton < high) & (np.abs(value) > error)
            guess[active] = np.where(inside, newton, (low + high) / 2)
            active = active[~done]
        return list(self.found.values())

    def _keep(self, crossing: int, points: Points, row: int, place: int, correction: float) -> None:
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
        """Which state of each trial point is the one that crosses, followed from the ends of the bracket.

        From the nearer end. Where roots fall into one on the way from there, from the end that tells better which is
        which; if neither does, from the one beyond the level, where they have parted. Where a pair parts into real
        roots between the ends, from the one that is of the trial's kind, since a pair does not tell which of two real
        roots it becomes.
        """
        rows, spectrum = np.arange(len(active)), points.spectrum
        nearer = np.argmin(np.abs(self.x[:, active] - points.position), axis=0)
        places, alike = np.empty((2, len(active)), dtype=int), np.empty((2, len(active)), dtype=bool)
        quality = np.empty((2, len(active)))
        for end, found in enumerate(self.ends):
            start = found.at(active)
            step = link(start.joined(spectrum), rows, len(active) + rows)
            own = self.place[end, active]
            places[end], quality[end] = step.successor[rows, own], step.quality[rows, own]
            alike[end] = (start.values[rows, own].imag == 0) == (spectrum.values[rows, places[end]].imag == 0)
        beyond = self.onset[active].astype(int)
        better = np.where(quality.max(axis=0) < POOR, beyond, quality.argmax(axis=0))
        clear = np.where(quality[nearer, rows] < POOR, better, nearer)
        chosen = np.where(alike[0] == alike[1], clear, alike[1].astype(int))
        followed: Array = places[chosen, rows]
        return followed

    def _narrow(self, active: Array, beyond: Array, points: Points, place: Array) -> None:
        """The trial points take the place of the end on their side."""
        end = (beyond == self.onset[active]).astype(int)
        for row, crossing in enumerate(active):
            side = end[row]
            self.x[side, crossing], self.place[side, crossing] = points.position[row], place[row]
            for kept, new in zip(self.ends[side], points.spectrum, strict=True):
                if kept is not None and new is not None:
                    kept[crossing] = new[row]


def each_once(found: list[Crossing]) -> list[Crossing]:
    """Crossings by line and position, each root once."""
    kept: list[Crossing] = []
    for one in sorted(found, key=lambda one: (one.line, one.position)):
        if not any(_same(one, other) for other in reversed(kept[-8:])):
            kept.append(one)
    return kept


def _same(one: Crossing, other: Crossing) -> bool:
    """Return whether two crossings are one: both states of a pair that joins within a step may be found to cross."""
    near = abs(one.position - other.position) <= 1e-7 * max(abs(one.position), abs(other.position))
    values = [complex(found.value.real, abs(found.value.imag)) for found in (one, other)]
    alike = abs(values[0] - values[1]) <= 1e-6 * max(1.0, abs(one.value))
    return one.line == other.line and one.onset == other.onset and near and alike


def _lowest_onsets(rows: Array, states: Array, ends: Array, line: Array) -> tuple[Array, Array, Array]:
    """Of each line those onsets that lie in its first step with any."""
    onset = ends[1] > ends[0]
    rows, states, ends = rows[onset], states[onset], ends[:, onset]
    first = np.full(int(line.max(initial=-1)) + 1, np.iinfo(int).max)
    np.minimum.at(first, line[rows], rows)  # steps are in the order of their lines and positions
    lowest = rows == first[line[rows]]
    return rows[lowest], states[lowest], ends[:, lowest]
