"""Stability boundaries of a case: where the damping of a mode passes a level, to rounding.

Every crossing in a range is looked for, flutter and divergence, those between two points of the scan included:
`proprotor.stability.crossings` says how.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.doubts import Doubt, doubts_along
from proprotor.model.stamp import Stamp
from proprotor.stability import summary
from proprotor.stability.crossings import JUMPS, Brackets, Crossing, Points, Search, Solved, each_once
from proprotor.stability.eigenvalue_derivatives import defect
from proprotor.stability.following import Line, Path
from proprotor.stability.least_damping import NOWHERE, LeastDamping, least_damped
from proprotor.stability.matching import Spectrum, Steps
from proprotor.stability.mode_names import Moving, moving
from proprotor.stability.sweep import approach_to, line_of_case, state_names, tip_speed
from proprotor.typing import Array
from proprotor.units import in_metres_per_second

if TYPE_CHECKING:
    from proprotor.model.configuration import Configuration

_TOLD = 0.05  # of a mode: the least participation that its mechanism names
_TOGETHER = 1e-3  # of a position: stretches that cannot be followed and lie nearer to each other are one
_RANGE = (0.2, 1.2, 51)  # of the tip speed: where boundaries are looked for, and at how many points


@dataclass(frozen=True, repr=False)
class Boundary:
    """One crossing of a damping level.

    Attributes
    ----------
    position : float
        Airspeed in m/s, or another input in SI.
    mode : str
        What moves most in the mode that crosses, by `proprotor.stability.mode_names`: its name at the boundary itself.
    kind : "flutter" or "divergence"
        A pair, or a real root.
    onset : bool
        Whether damping falls through the level as the position grows; it rises through it otherwise.
    eigenvalue : complex
        rad/s.
    rate : float
        dG/dposition, 1/s per unit of the position: the growth Re λ + ζ0 |λ| with ζ0 the level.
    eigenvalue_rate : complex
        dλ/dposition, rad/s per SI unit of the position.
    mechanism : mapping of str to float
        Participation at the boundary, dimensionless, the largest first, by the names of modes.
    defect : float
        Dimensionless: 1 for a well-separated mode, large where the mode nearly falls into one with another
        (`proprotor.stability.eigenvalue_derivatives.defect`).
    eigen_solves : int
        Spent on this crossing beyond those that bracketed it.
    branch : str
        The exact root that crosses, by what moves in it where branches are named (`proprotor.stability.branches`).
    warning : str
        What makes the boundary doubtful, such as Mach numbers beyond what the airfoil knows; empty where nothing does.
    level : float
        Damping ratio that is crossed.
    stamp : mapping of str to str
        The case and the options in force, see `proprotor.model.stamp`; empty on a line that is of no case.
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
    branch: str = ""
    warning: str = ""
    level: float = 0.0
    stamp: Stamp = field(default_factory=dict)

    def __repr__(self) -> str:
        return summary.of_boundary(self)

    @property
    def frequency(self) -> float:
        """|Im λ|, rad/s."""
        return abs(self.eigenvalue.imag)


@dataclass(frozen=True, repr=False)
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
        What moves in the modes that are beyond the level at the lowest airspeed already.
    searched : tuple of float
        Lowest and highest airspeed that could be analysed, m/s.
    failed : tuple of Failed
        Airspeeds of the scan that could not be analysed, with the reason.
    eigen_solves : int
        All of them; `scan_solves` is what it took to bracket every boundary.
    scan_solves : int
    level : float
        Damping ratio.
    least_damping : float
        The smallest damping ratio of any mode at the airspeeds of the search, dimensionless; NaN where there is none.
    least_damping_mode : str
    least_damping_speed : float
        Where that was, m/s.
    doubts : tuple of Doubt
        What makes airspeeds of the search doubtful, and from where to where in m/s.
    stamp : mapping of str to str
        The case and the options in force, see `proprotor.model.stamp`.
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
    least_damping: float = np.nan
    least_damping_mode: str = ""
    least_damping_speed: float = np.nan
    doubts: tuple[Doubt, ...] = ()
    stamp: Stamp = field(default_factory=dict)
    failed: tuple[Failed, ...] = ()

    def __repr__(self) -> str:
        return summary.of_flutter_point(self)

    @property
    def warning(self) -> str:
        """What makes the flutter speed doubtful; empty where nothing does."""
        return next((found.warning for found in self.boundaries if found.position == self.speed), "")

    def margin(self, airspeed: Any) -> float:
        """How far the flutter speed lies above an airspeed, as a part of it.

        Parameters
        ----------
        airspeed : float in m/s, text such as "250 kt", or pint quantity

        Returns
        -------
        float
            Dimensionless; NaN where nothing becomes unstable.
        """
        return self.speed / float(in_metres_per_second(airspeed)) - 1


class Failed(NamedTuple):
    """A stretch of a scan that could not be analysed.

    Parameters
    ----------
    first, last : float
        Between what works, or the ends of the scan: m/s or in SI units of the input.
    reason : str
        Why.
    """

    first: float
    last: float
    reason: str


class Crossings(NamedTuple):
    """Boundaries along a line, with the modes beyond the level at its start.

    Parameters
    ----------
    boundaries : tuple of Boundary
        By position.
    unstable_at_start : tuple of str
        Modes beyond the level at the lowest position that could be analysed.
    searched : tuple of float
        Lowest and highest position that could be analysed, m/s or in SI units of the input.
    scan_solves, eigen_solves : int
        What it took to bracket every boundary, and in all.
    least : LeastDamping
        The smallest damping ratio of any mode at the points of the search, with the mode's name and the position.
    doubts : tuple of Doubt
        What makes positions of the scan doubtful, and from where to where.
    stamp : mapping of str to str
        The case and the options in force, see `proprotor.model.stamp`; empty on a line that is of no case.
    failed : tuple of Failed
        Positions of the scan that could not be analysed, with the reason: why the range searched ends where it does, or
        has gaps; then stretches over which a mode passes the level where it cannot be followed, as in a jump of the
        trim.
    """

    boundaries: tuple[Boundary, ...]
    unstable_at_start: tuple[str, ...]
    searched: tuple[float, float]
    scan_solves: int
    eigen_solves: int
    least: LeastDamping = NOWHERE
    doubts: tuple[Doubt, ...] = ()
    stamp: Stamp = {}  # noqa: RUF012 - never changed
    failed: tuple[Failed, ...] = ()

    def __repr__(self) -> str:
        return summary.of_crossings(self)


def find_crossings(line: Line, *, level: float = 0.0, approach: Line | None = None) -> Crossings:
    """All crossings of a damping level along a line, with exact positions.

    Parameters
    ----------
    line : Line
        With a `linearize` that takes complex positions and is analytic in them; positions in any order.
    level : float
        Damping ratio that counts as the boundary.
    approach : Line, optional
        From where modes get their names: see `proprotor.stability.sweep.sweep`.

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
    line = _rising(line)
    positions = line.positions
    search = Search(
        lambda _, x: line.models(x), np.zeros(len(positions), dtype=int), positions, level, names=True
    )
    scanned = search.scanned
    doubts = doubts_along(positions, scanned.warning)
    if scanned.points is None:
        failed = _failed(positions, scanned, np.empty(0))
        return Crossings((), (), (np.nan, np.nan), 0, 0, doubts=doubts, failed=failed)
    path, points = _path(search, positions), search.points
    failed = _failed(positions, scanned, np.sort(points.position))
    named = state_names(line.models(positions), line, path, approach)
    branches = [named.names[state] for state in path.places[named.point]]
    brackets = Brackets(search)
    found = each_once(brackets.close())
    ends, least = _at_points(line, points)
    scan_solves = int(search.solves.sum()) + named.eigen_solves
    return Crossings(
        tuple(_boundaries(found, [_branch(one, search, path, branches) for one in found], line)),
        ends,
        (float(points.position.min()), float(points.position.max())),
        scan_solves,
        scan_solves + int(brackets.solves.sum()),
        least,
        doubts,
        failed=failed + _lost(search, brackets),
    )


def _rising(line: Line) -> Line:
    """The line with each of its positions once, from the lowest to the highest."""
    return replace(line, positions=np.unique(np.asarray(line.positions, dtype=float)), end=None)


def _at_points(line: Line, points: Points) -> tuple[tuple[str, ...], LeastDamping]:
    """What moves in the modes beyond the level at the lowest position, and in the one that is damped least."""
    least = least_damped(points)
    rows = np.array([int(points.position.argmin()), 0 if least is None else least[0]])
    values, right, left = points.spectrum.at(rows).all_modes
    names = moving(line.models(points.position[rows]), values, left, right).names
    above = (points.growth[rows[0]] > points.error[rows[0]]) & (values[0].imag >= 0)
    beyond = tuple(dict.fromkeys(names[0, above].tolist()))
    if least is None:
        return beyond, NOWHERE
    value = values[1, least[1]]
    position = float(points.position[rows[1]])
    return beyond, LeastDamping(float(-value.real / abs(value)), str(names[1, least[1]]), position)


def _failed(positions: Array, scanned: Solved, works: Array) -> tuple[Failed, ...]:
    """Stretches between points that work in which the scan failed, for one reason each.

    positions (points,) of the scan; works, those of all points that could be analysed, rising.
    """
    found: list[Failed] = []
    failed = set(np.flatnonzero(~scanned.works).tolist())
    for place in sorted(failed):
        here, told = float(positions[place]), str(scanned.reason[place])
        above = works[np.searchsorted(works, here) :]
        end = here if place + 1 in failed or not len(above) else float(above[0])
        if place - 1 in failed and _without_numbers(found[-1].reason) == _without_numbers(told):
            found[-1] = found[-1]._replace(last=end)
            continue
        below = works[: np.searchsorted(works, here)]
        start = here if place - 1 in failed or not len(below) else float(below[-1])
        found.append(Failed(start, end, told))
    return tuple(found)


def _lost(search: Search, brackets: Brackets) -> tuple[Failed, ...]:
    """Stretches over which a mode passes the level, or may, and cannot be followed; neighbouring ones as one."""
    told = "a mode passes the level where it cannot be followed"
    x = search.points.position
    found = []
    for k, why in brackets.lost.items():
        low, high = np.sort(brackets.x[:, k]).tolist()
        found.append(Failed(low, high, f"{told}: {why}"))
    for step in search.unsettled:
        found.append(Failed(float(x[step.before[0]]), float(x[step.after[0]]), f"{told}: {JUMPS}"))
    joined: list[Failed] = []
    for one in sorted(found):
        if joined and one.first <= joined[-1].last + _TOGETHER * abs(one.first):
            joined[-1] = joined[-1]._replace(last=max(one.last, joined[-1].last))
        else:
            joined.append(one)
    return tuple(joined)


def _without_numbers(reason: str) -> str:
    return re.sub(r"[-+.\deE]*\d", "", reason)


def _path(search: Search, positions: Array) -> Path:
    """The points of a search of one line as a path: those of the scan, failed ones too, then those between them."""
    points, works = search.points, np.flatnonzero(search.scanned.works)
    between = np.arange(len(works), len(points.position))
    place = np.concatenate([works, len(positions) + np.arange(len(between))])
    count = len(positions) + len(between)
    values, right, shapes = (
        None if part is None else _in_places(part, place, count) for part in points.spectrum
    )
    assert values is not None and right is not None  # of points that work
    spectrum = Spectrum(values, right, shapes)
    order = np.argsort(points.position, kind="stable")
    return Path(
        spectrum,
        place[order],
        Steps(search.steps.successor, search.steps.quality),
        np.concatenate([positions, points.position[between]]),
    )


def _in_places(part: Array, place: Array, count: int) -> Array:
    """Rows at their places among so many, NaN at the others."""
    whole = np.full((count, *part.shape[1:]), np.nan, dtype=part.dtype)
    whole[place] = part
    return whole


def _branch(found: Crossing, search: Search, path: Path, branches: list[str]) -> str:
    """Name of the root that crosses, as it is followed along the path."""
    order = np.argsort(search.points.position, kind="stable")
    point = int(np.flatnonzero(order == found.start)[0])
    return branches[int(np.flatnonzero(path.places[point] == found.from_state)[0])]


def _boundaries(found: list[Crossing], branches: list[str], line: Line) -> Iterator[Boundary]:
    """The boundaries of crossings, with what moves there and what makes them doubtful."""
    if not found:
        return
    model = line.models(np.array([one.position for one in found]))
    spectra = Spectrum(
        *(np.stack([getattr(one.spectrum, part) for one in found]) for part in ("values", "right"))
    )
    values, right, left = spectra.all_modes
    moves = moving(model, values, left, right)
    for row, (one, branch, warning) in enumerate(
        zip(found, branches, model.trim.warning.tolist(), strict=True)
    ):
        yield replace(_boundary(one, branch, moves, row), warning=str(warning))


def _boundary(found: Crossing, branch: str, moves: Moving, row: int) -> Boundary:
    value = found.value
    shares = moves.shares[row, :, found.state]
    largest = [k for k in np.argsort(-shares) if shares[k] >= _TOLD]
    return Boundary(
        position=found.position,
        mode=str(moves.names[row, found.state]),
        kind="divergence" if value.imag == 0 else "flutter",
        onset=found.onset,
        eigenvalue=value if value.imag >= 0 else value.conjugate(),
        rate=found.slope,
        eigenvalue_rate=complex(found.change if value.imag >= 0 else np.conj(found.change)),
        mechanism={moves.known[k]: float(shares[k]) for k in largest},
        defect=float(defect(found.spectrum.modes(np.array([found.state])))[0]),
        eigen_solves=found.solves,
        branch=branch,
    )


def boundaries(
    case: Configuration,
    airspeeds: Any = None,
    vary: Mapping[str, ArrayLike] | None = None,
    *,
    level: float = 0.0,
    **options: Any,
) -> Crossings:
    """All boundaries of a case along airspeeds, or along one input at one airspeed.

    Parameters
    ----------
    case : Case
    airspeeds : array (points,) in m/s, text such as "50:400:5kt", or pint quantity, optional
        The scan, 0.2 to 1.2 of the tip speed by default; one airspeed with `vary`. Steps wider than 2 % of the tip
        speed are divided, so that a coarse scan finds what the default one finds.
    vary : mapping of str to array (points,), optional
        One input by its path in the deck, and the values of the scan in SI: a critical control stiffness, support
        frequency or rotor speed.
    level : float
        Damping ratio that counts as the boundary.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    Crossings
        By position, m/s or in SI units of the input.

    Raises
    ------
    InputError
        As `proprotor.stability.sweep.sweep_case`.
    """
    if airspeeds is None:
        if vary is not None:
            raise InputError("airspeeds", None, "must be one airspeed where an input varies")
        airspeeds = scan_speeds(case)
    line = line_of_case(case, airspeeds, vary, options)
    if line is None:
        raise InputError("case", case.name, "must be one design: give one input to vary")
    line = _rising(line)
    if vary is None:
        line = replace(line, positions=_in_small_steps(line.positions, _widest_step(case)))
    near = approach_to(case, line, line.models(line.positions), options)
    found = find_crossings(line, level=level, approach=near)
    own = stamp.of_case(case, options)
    carried = tuple(replace(boundary, level=level, stamp=own) for boundary in found.boundaries)
    return found._replace(boundaries=carried, stamp=own)


def _widest_step(case: Configuration) -> float:
    """Return the widest step of airspeed in m/s that a search takes: the default scan's; wider ones hide crossings."""
    low, high, points = _RANGE
    return (high - low) / (points - 1) * tip_speed(case)


def _in_small_steps(positions: Array, widest: float) -> Array:
    """Return rising positions (k,) with equally spaced points in each step that is wider than the widest allowed."""
    parts = np.maximum(np.ceil(np.diff(positions) / widest * (1 - 1e-9)), 1).astype(int)
    step, part = (
        np.repeat(np.arange(len(parts)), parts),
        np.concatenate([np.arange(0), *(np.arange(k) for k in parts)]),
    )
    between = positions[step] + part / parts[step] * np.diff(positions)[step]
    return np.append(between, positions[-1:])


def scan_speeds(case: Configuration, points: int = _RANGE[2]) -> Array:
    """Airspeeds where boundaries are looked for: 0.2 to 1.2 of the tip speed.

    Parameters
    ----------
    case : Case
    points : int
        How many.

    Returns
    -------
    array (points,)
        m/s.
    """
    return np.linspace(*_RANGE[:2], points) * tip_speed(case)


def flutter_point(
    case: Configuration, airspeeds: Any = None, *, level: float = 0.0, **options: Any
) -> FlutterPoint:
    """The lowest airspeed at which a mode becomes unstable, with all boundaries of the range.

    Parameters
    ----------
    case : Case
    airspeeds : array (points,) in m/s, text such as "50:400:5kt", or pint quantity, optional
        The scan; 0.2 to 1.2 of the tip speed by default.
    level : float
        Damping ratio that counts as the boundary: 0.03 for a margin of 3 % of critical.
    **options
        See `proprotor.rotor.options.Options`.

    Returns
    -------
    FlutterPoint

    Raises
    ------
    InputError
        As `boundaries`.
    """
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
        least_damping=found.least.ratio,
        least_damping_mode=found.least.mode,
        least_damping_speed=found.least.position,
        doubts=found.doubts,
        stamp=found.stamp,
        failed=found.failed,
    )
