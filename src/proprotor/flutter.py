"""Stability boundaries: where the damping of a followed mode passes a level, to rounding.

Along a line of points each mode has a growth G, and its exact derivative from matrices a complex step away. The
cubic that has both at the ends of a step tells crossings within it, also of modes that dip and return between two
points that look stable: where it comes nearer to the level than its error, an eigen-solve at its extremum settles the
matter. Each bracketed crossing is found by Newton's method, started at the root of the cubic and kept in the bracket.

The level is a damping ratio ζ0, and G = Re λ + ζ0 |λ| is positive where the damping -Re λ/|λ| is below it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from proprotor.eigenvalue_derivatives import STEP, defect, eigenvalue_change, matrix_derivatives
from proprotor.errors import InputError
from proprotor.mode_names import name_list, name_shares
from proprotor.model import LinearModel
from proprotor.modes import decomposition, held_coordinates
from proprotor.path import Line, Path, follow
from proprotor.sweep import approach_to, line_of_case, rotor_speed_of, state_names, tip_speed
from proprotor.tracking import Spectrum, link

if TYPE_CHECKING:
    from proprotor.case import Case

_ROUNDS = 6  # of eigen-solves at extrema
_ITERATIONS = 40  # of Newton's method; with bisection as the last resort
_CLOSE = 1e-9  # of the position: the last correction, after which the next is rounding
_REAL = 1e-9  # of the largest eigenvalue: a root with less imaginary part is real
_NEUTRAL = 1e-9  # of the largest eigenvalue: growth that says nothing
_SAFETY = 4.0  # the error of a cubic over one step is a sixteenth of that over two; a quarter is taken
_TOLD = 0.05  # of a mode: the least participation that its mechanism names
_RANGE = (0.2, 1.2, 51)  # of the tip speed: where a flutter point is looked for, and at how many points


@dataclass(frozen=True)
class Boundary:
    """One crossing of a damping level.

    Attributes
    ----------
    position : float
        Airspeed in m/s, or another input in SI.
    mode : str
        Name of the mode that crosses, which it has wherever it is followed.
    kind : "flutter" or "divergence"
        A pair, or a real root.
    onset : bool
        Whether damping falls through the level as the position grows; it rises through it otherwise.
    eigenvalue : complex
        rad/s.
    rate : float
        dG/dposition, 1/s per unit of the position: the growth Re λ + ζ0 |λ| with ζ0 the level.
    eigenvalue_rate : complex
        dλ/dposition.
    mechanism : mapping of str to float
        Participation at the boundary, the largest first, by the names of modes.
    defect : float
        1 for a well-separated mode; large where the mode nearly falls into one with another
        (`proprotor.eigenvalue_derivatives.defect`).
    eigen_solves : int
        Spent on this crossing beyond those that bracketed it.
    """

    position: float
    mode: str
    kind: str
    onset: bool
    eigenvalue: complex
    rate: float
    eigenvalue_rate: complex
    mechanism: Mapping[str, float]
    defect: float
    eigen_solves: int

    @property
    def frequency(self) -> float:
        """|Im λ|, rad/s."""
        return abs(self.eigenvalue.imag)


@dataclass(frozen=True)
class FlutterPoint:
    """The lowest onset of instability, and all boundaries of the range that was searched.

    Attributes
    ----------
    speed : float
        m/s; NaN where nothing becomes unstable.
    frequency : float
        rad/s.
    mode, kind : str
    boundaries : tuple of Boundary
        By airspeed.
    unstable_at_start : tuple of str
        Modes that are beyond the level at the lowest airspeed already.
    searched : tuple of float
        Lowest and highest airspeed that could be analysed, m/s.
    eigen_solves : int
        All of them; `scan_solves` is what it took to bracket every boundary.
    scan_solves : int
    level : float
        Damping ratio.
    """

    speed: float
    frequency: float
    mode: str
    kind: str
    boundaries: tuple[Boundary, ...]
    unstable_at_start: tuple[str, ...]
    searched: tuple[float, float]
    eigen_solves: int
    scan_solves: int
    level: float = 0.0

    def margin(self, airspeed: float) -> float:
        """How far the flutter speed lies above an airspeed (m/s), as a part of it; NaN where nothing flutters."""
        return self.speed / airspeed - 1


class Crossings(NamedTuple):
    """Boundaries along a line, by position, with the modes beyond the level at its start."""

    boundaries: tuple[Boundary, ...]
    unstable_at_start: tuple[str, ...]
    searched: tuple[float, float]
    scan_solves: int
    eigen_solves: int


def growth(values: NDArray, level: float = 0.0) -> NDArray:
    """G = Re λ + ζ0 |λ|, 1/s: positive where the damping ratio is below the level."""
    return values.real + level * np.abs(values) if level else values.real


def growth_rate(values: NDArray, changes: NDArray, level: float = 0.0) -> NDArray:
    """Change of G with a change of λ."""
    if not level:
        return changes.real
    size = np.abs(values)
    return changes.real + level * (values.conj() * changes).real / np.where(size > 0, size, 1)


def hermite(t: NDArray, ends: NDArray) -> NDArray:
    """The cubic with values and slopes `ends` (4, ...): at 0, at 1, slope at 0 and at 1 per unit of t."""
    value0, value1, slope0, slope1 = ends
    rise = value1 - value0
    a, b = slope0 - rise, rise - slope1
    return value0 + t * (rise + (1 - t) * (a + t * (b - a)))


def hermite_extrema(ends: NDArray) -> NDArray:
    """Where the cubics (4, m) have extrema within (0, 1): (m, 2), NaN where they have none."""
    value0, value1, slope0, slope1 = ends
    rise = value1 - value0
    c3, c2, c1 = slope0 + slope1 - 2 * rise, 3 * rise - 2 * slope0 - slope1, slope0
    with np.errstate(all="ignore"):
        root = np.sqrt(c2**2 - 3 * c3 * c1)
        q = -(c2 + np.where(c2 < 0, -root, root))
        found = np.stack([q / (3 * c3), c1 / q], axis=-1)
    return np.where((found > 0) & (found < 1), found, np.nan)


def hermite_root(ends: NDArray) -> NDArray:
    """A root in (0, 1) of cubics (4, m) with values of opposite sign at the ends, by bisection and then secants."""
    low, high = np.zeros(ends.shape[1]), np.ones(ends.shape[1])
    rising = ends[1] > ends[0]
    for _ in range(52):
        middle = (low + high) / 2
        above = (hermite(middle, ends) > 0) == rising
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return (low + high) / 2


class _Scan:
    """A path with growth and its derivative at every point, into which points can be put."""

    def __init__(self, line: Line, path: Path, level: float) -> None:
        self.line, self.level, self.path = line, level, path
        self._changes = np.full(path.spectrum.values.shape, np.nan, dtype=complex)
        if len(path.points):
            model = line.linearize(path.positions[path.points] + 1j * STEP)
            here = Spectrum(*(part[path.points] for part in path.spectrum))
            self._changes[path.points] = eigenvalue_change(model, matrix_derivatives(model), here)

    @property
    def positions(self) -> NDArray:
        """Of the points of the path (k,)."""
        return self.path.positions[self.path.points]

    def growths(self) -> tuple[NDArray, NDArray]:
        """Growth and its derivative by the position, of the followed states (k, states)."""
        changes = np.take_along_axis(self._changes[self.path.points], self.path.places, 1)
        return growth(self.path.values, self.level), growth_rate(self.path.values, changes, self.level)

    def put(self, after: NDArray, positions: NDArray) -> bool:
        """Put points into steps; whether any of them could be analysed."""
        found, changes = solved(self.line, positions)
        works = np.isfinite(found.values).all(axis=1)
        if works.any():
            found = Spectrum(*(part[works] for part in found))
            self.path = self.path.with_points(after[works], positions[works], found)
            self._changes = np.concatenate([self._changes, changes[works]])
        return bool(works.any())


def solved(line: Line, positions: NDArray) -> tuple[Spectrum, NDArray]:
    """Eigen-solves at positions (k,), with the derivative of every eigenvalue by the position (k, states)."""
    model = line.linearize(positions + 1j * STEP)
    found = decomposition(model)
    return found, eigenvalue_change(model, matrix_derivatives(model), found)


def _cubics(scan: _Scan) -> tuple[NDArray, NDArray, NDArray]:
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


def _settle(scan: _Scan) -> None:
    """Put points where a mode may cross the level twice within a step and neither end tells."""
    for _ in range(_ROUNDS):
        if len(scan.positions) < 2:
            return
        ends, error, counts = _cubics(scan)
        steps, states = np.nonzero(counts & np.isfinite(ends).all(axis=0))
        cubic, noise = ends[:, steps, states], error[steps, states]
        at = hermite_extrema(cubic)
        peak = hermite(at, cubic[:, :, None])
        floor = _NEUTRAL * np.nanmax(np.abs(scan.path.values), initial=0)
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


class _Brackets:
    """Steps over which a followed state crosses, closed in on for all of them at once."""

    def __init__(self, scan: _Scan) -> None:
        ends, _, counts = _cubics(scan)
        floor = _NEUTRAL * np.nanmax(np.abs(scan.path.values), initial=0)
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
        self.ends = [Spectrum(*(part[row] for part in path.spectrum)) for row in points]
        self.found = {}
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
            works = np.isfinite(spectrum.values).all(axis=1)
            active, position, changes = active[works], position[works], changes[works]
            spectrum = Spectrum(*(part[works] for part in spectrum))
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
                    Spectrum(*(part[row] for part in spectrum)),
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

    def _place(self, active: NDArray, position: NDArray, spectrum: Spectrum) -> NDArray:
        """Which state of each trial point is the one that crosses, followed from the ends of the bracket.

        From the nearer end; where a pair parts into real roots between the ends, from the one that is of the trial's
        kind, since a pair does not tell which of two real roots it becomes.
        """
        rows = np.arange(len(active))
        nearer = np.argmin(np.abs(self.x[:, active] - position), axis=0)
        places, alike = np.empty((2, len(active)), dtype=int), np.empty((2, len(active)), dtype=bool)
        for end, found in enumerate(self.ends):
            start = Spectrum(*(part[active] for part in found))
            both = Spectrum(*(np.concatenate(parts) for parts in zip(start, spectrum, strict=True)))
            successor = link(both, rows, len(active) + rows).successor
            own = self.place[end, active]
            places[end] = successor[rows, own]
            alike[end] = (start.values[rows, own].imag == 0) == (spectrum.values[rows, places[end]].imag == 0)
        chosen = np.where(alike[0] == alike[1], nearer, alike[1].astype(int))
        return places[chosen, rows]

    def _narrow(
        self, active: NDArray, position: NDArray, value: NDArray, place: NDArray, spectrum: Spectrum
    ) -> None:
        """The trial points take the place of the end on their side."""
        end = (np.sign(value) != np.sign(self.value[0, active])).astype(int)
        for row, crossing in enumerate(active):
            side = end[row]
            self.x[side, crossing], self.value[side, crossing] = position[row], value[row]
            self.place[side, crossing] = place[row]
            for kept, new in zip(self.ends[side], spectrum, strict=True):
                kept[crossing] = new[row]


def find_crossings(
    line: Line, *, level: float = 0.0, rotor_speed: float | None = None, approach: Line | None = None
) -> Crossings:
    """All crossings of a damping level along a line, with exact positions.

    Parameters
    ----------
    line : Line
        With a `linearize` that takes complex positions and is analytic in them.
    level : float
        Damping ratio that counts as the boundary.
    rotor_speed : float, optional
        rad/s, for the names of modes.
    approach : Line, optional
        From where modes get their names: see `proprotor.sweep.sweep`.

    Returns
    -------
    Crossings

    Raises
    ------
    InputError
        When the level is no damping ratio.
    """
    if not -1 < level < 1:
        raise InputError("level", level, "must be a damping ratio, between -1 and 1")
    model = line.linearize(np.asarray(line.positions, dtype=float))
    scan = _Scan(line, follow(model, line), level)
    _settle(scan)
    path = scan.path
    if not len(path.points):
        return Crossings((), (), (np.nan, np.nan), 0, 0)
    named = state_names(model, line, path, rotor_speed, approach)
    names = [named.names[state] for state in path.places[named.point]]
    crossing = _Brackets(scan) if len(path.points) > 1 else None
    boundaries = []
    if crossing is not None:
        crossing.close()
        for place in crossing.found:
            boundaries.append(_boundary(crossing, place, names, model, rotor_speed))
    boundaries = _distinct(sorted(boundaries, key=lambda found: found.position))
    scan_solves = len(path.points) + named.eigen_solves
    return Crossings(
        tuple(boundaries),
        _beyond(path.values[0], names, level),
        (float(scan.positions[0]), float(scan.positions[-1])),
        scan_solves,
        scan_solves + (0 if crossing is None else int(crossing.solves.sum())),
    )


def _beyond(values: NDArray, names: list[str], level: float) -> tuple[str, ...]:
    """Modes beyond the level."""
    above = growth(values, level) > _NEUTRAL * np.abs(values).max()
    return tuple(dict.fromkeys(names[state] for state in np.flatnonzero(above & (values.imag >= 0))))


def _boundary(
    crossing: _Brackets, place: int, names: list[str], model: LinearModel, rotor_speed: float | None
) -> Boundary:
    position, spectrum, state, change, slope = crossing.found[place]
    value = complex(spectrum.values[state])
    real = abs(value.imag) <= _REAL * np.abs(spectrum.values).max()
    mode = Spectrum(spectrum.values[[state]], spectrum.right[:, [state]], spectrum.left[[state]])
    shares = name_shares(
        model.dofs, held_coordinates(model), mode.values, mode.left, mode.right, rotor_speed
    )[:, 0]
    told = name_list(model.dofs)
    largest = [k for k in np.argsort(-shares) if shares[k] >= _TOLD]
    return Boundary(
        position=float(position),
        mode=names[crossing.states[place]],
        kind="divergence" if real else "flutter",
        onset=bool(crossing.onset[place]) == bool(crossing.x[1, place] >= crossing.x[0, place]),
        eigenvalue=value if value.imag >= 0 else value.conjugate(),
        rate=float(slope),
        eigenvalue_rate=complex(change if value.imag >= 0 else np.conj(change)),
        mechanism={told[k]: float(shares[k]) for k in largest},
        defect=float(defect(mode)[0]),
        eigen_solves=int(crossing.solves[place]),
    )


def _distinct(boundaries: list[Boundary]) -> list[Boundary]:
    """Both states of a pair that parts within a step may be found to cross as the same root: it counts once."""
    kept: list[Boundary] = []
    for found in boundaries:
        again = any(
            abs(found.position - other.position) <= 1e-7 * abs(found.position)
            and abs(found.eigenvalue - other.eigenvalue) <= 1e-6 * max(1.0, abs(found.eigenvalue))
            for other in kept
        )
        if not again:
            kept.append(found)
    return kept


def boundaries(
    case: Case,
    airspeeds: Any,
    vary: Mapping[str, ArrayLike] | None = None,
    *,
    level: float = 0.0,
    **options: Any,
) -> Crossings:
    """All boundaries of a case along airspeeds, or along one input at one airspeed.

    Parameters
    ----------
    case : Case
    airspeeds : array (points,) in m/s, text such as "50:400:5kt", or pint quantity
        The scan; one airspeed with `vary`.
    vary : mapping of str to array (points,), optional
        One input by its path in the deck, and the values of the scan in SI: a critical control stiffness, support
        frequency or rotor speed.
    level : float
        Damping ratio that counts as the boundary.
    **options
        See `proprotor.options.Options`.

    Raises
    ------
    InputError
        As `proprotor.sweep.sweep_case`.
    """
    line = line_of_case(case, airspeeds, vary, options)
    if line is None:
        raise InputError("case", case.name, "must be one design: give one input to vary")
    near = approach_to(case, line, line.linearize(line.positions), options)
    return find_crossings(line, level=level, rotor_speed=rotor_speed_of(case), approach=near)


def flutter_point(case: Case, airspeeds: Any = None, *, level: float = 0.0, **options: Any) -> FlutterPoint:
    """The lowest airspeed at which a mode becomes unstable, with all boundaries of the range.

    Parameters
    ----------
    case : Case
    airspeeds : array (points,) in m/s, text such as "50:400:5kt", or pint quantity, optional
        The scan; 0.2 to 1.2 of the tip speed by default.
    level : float
        Damping ratio that counts as the boundary: 0.03 for a margin of 3 % of critical.
    **options
        See `proprotor.options.Options`.

    Raises
    ------
    InputError
        As `boundaries`.
    """
    if airspeeds is None:
        airspeeds = np.linspace(*_RANGE[:2], _RANGE[2]) * tip_speed(case)
    found = boundaries(case, airspeeds, level=level, **options)
    onsets = [boundary for boundary in found.boundaries if boundary.onset]
    first = onsets[0] if onsets else None
    return FlutterPoint(
        speed=first.position if first else np.nan,
        frequency=first.frequency if first else np.nan,
        mode=first.mode if first else "",
        kind=first.kind if first else "",
        boundaries=found.boundaries,
        unstable_at_start=found.unstable_at_start,
        searched=found.searched,
        eigen_solves=found.eigen_solves,
        scan_solves=found.scan_solves,
        level=level,
    )
