"""Stability boundaries along a line: where the damping of a mode passes a level, to rounding.

Every crossing in a range is looked for, flutter and divergence, also where two crossings lie between two points of the
scan: `proprotor.stability.crossings` says how.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from proprotor.errors import InputError
from proprotor.model import stamp
from proprotor.model.configuration import Configuration
from proprotor.model.doubts import doubts_along
from proprotor.stability.boundary import NOWHERE, Boundary, Crossings, Failed, LeastDamping
from proprotor.stability.brackets import JUMPS, Brackets, Crossing, each_once
from proprotor.stability.branches import name_states
from proprotor.stability.crossings import Search
from proprotor.stability.eigenvalue_derivatives import defect
from proprotor.stability.following import Branches
from proprotor.stability.kinds import kinds
from proprotor.stability.matching import Matches, Spectrum
from proprotor.stability.mode_names import Moving, moving
from proprotor.stability.parameter_lines import ParameterLine, approach_to, line_of_case, tip_speed
from proprotor.stability.points import Points, Solved
from proprotor.typing import Array

_TAKES_PART = 0.05  # least participation of a motion that the mechanism of a boundary names
_TOGETHER = 1e-3  # of a position: stretches without a followed mode that lie nearer to each other are one
_RANGE = (0.2, 1.2, 51)  # of the tip speed: where boundaries are looked for, and at how many points


def scan_speeds(case: Configuration, points: int = _RANGE[2]) -> Array:
    """Return the airspeeds at which boundaries are looked for: 0.2 to 1.2 of the tip speed.

    Parameters
    ----------
    case : Case
    points : int
        Number of airspeeds.

    Returns
    -------
    array (points,)
        m/s.
    """
    return scan_shares(points) * tip_speed(case)


def scan_shares(points: int = _RANGE[2]) -> Array:
    """Return the airspeeds of the default scan as shares of the tip speed.

    Parameters
    ----------
    points : int
        Number of airspeeds.

    Returns
    -------
    array (points,)
        Dimensionless, rising.
    """
    return np.linspace(*_RANGE[:2], points)


def boundaries(
    case: Configuration,
    airspeeds: Any = None,
    vary: Mapping[str, ArrayLike] | None = None,
    *,
    level: float = 0.0,
    **options: Any,
) -> Crossings:
    """Return all boundaries of a case along airspeeds, or along one input at one airspeed.

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
        line = replace(line, positions=steps_of_scan(line.positions, tip_speed(case)))
    search = _search(line, level)
    found = _crossings(line, search, approach_to(case, line, search.scanned.works, options))
    own = stamp.of_case(case, options, vary or ())
    carried = tuple(replace(boundary, stamp=own) for boundary in found.boundaries)
    return found._replace(boundaries=carried, stamp=own)


def steps_of_scan(positions: Array, tip: float) -> Array:
    """Return airspeeds with equally spaced points in each step that is wider than the default scan's.

    Wider steps hide crossings.

    Parameters
    ----------
    positions : array (k,)
        Rising airspeeds, m/s.
    tip : float
        Tip speed, m/s.

    Returns
    -------
    array (points,)
        m/s, rising, the given airspeeds among them.
    """
    low, high, points = _RANGE
    widest = (high - low) / (points - 1) * tip
    parts = np.maximum(np.ceil(np.diff(positions) / widest * (1 - 1e-9)), 1).astype(int)
    between = [
        low + np.arange(count) / count * (high - low)
        for (low, high), count in zip(pairwise(positions), parts, strict=True)
    ]
    return np.concatenate([*between, positions[-1:]])


def find_crossings(
    line: ParameterLine, *, level: float = 0.0, approach: ParameterLine | None = None
) -> Crossings:
    """Find all crossings of a damping level along a line, with exact positions.

    Parameters
    ----------
    line : ParameterLine
        With a `linearize` that takes complex positions and is analytic in the position; positions in any order.
    level : float
        Damping ratio that counts as the boundary.
    approach : ParameterLine, optional
        The way from the anchor, where modes get their names: see `proprotor.stability.sweep.sweep`.

    Returns
    -------
    Crossings

    Raises
    ------
    InputError
        When the level is no damping ratio, or the line came without a function that linearises.
    """
    line = _rising(line)
    return _crossings(line, _search(line, level), approach)


def _rising(line: ParameterLine) -> ParameterLine:
    """Return the line with each of its positions once, from the lowest to the highest."""
    return replace(line, positions=np.unique(np.asarray(line.positions, dtype=float)))


def _search(line: ParameterLine, level: float) -> Search:
    """Search the scan of a line, once linearised, for crossings of a level, with points between where needed."""
    if not -1 < level < 1:
        raise InputError("level", level, "must be a damping ratio, between -1 and 1")
    own = np.zeros(len(line.positions), dtype=int)
    return Search(lambda _, x: line.models(x), own, line.positions, level, names=True)


def _crossings(line: ParameterLine, search: Search, approach: ParameterLine | None) -> Crossings:
    """Close in on the crossings of a search of a line, and name what crosses."""
    positions, scanned = line.positions, search.scanned
    doubts = doubts_along(positions, scanned.warning)
    if scanned.points is None:
        failed = _failed(positions, scanned, np.empty(0))
        return Crossings((), (), (np.nan, np.nan), 0, 0, doubts=doubts, failed=failed)
    branches, points = _branches(search, positions), search.points
    named = name_states(branches, line, approach)
    brackets = Brackets(search)
    found = each_once(brackets.close())
    labels = [_label(one, search, branches, named.names, named.point) for one in found]
    boundaries, beyond, least = _named(found, labels, search, line)
    solves = int(search.solves.sum()) + named.eigen_solves
    return Crossings(
        boundaries,
        beyond,
        (float(points.position.min()), float(points.position.max())),
        solves,
        solves + int(brackets.solves.sum()),
        least,
        doubts,
        failed=_failed(positions, scanned, np.sort(points.position)) + _lost(search, brackets),
    )


def _branches(search: Search, positions: Array) -> Branches:
    """Return the branches of a search of one line: points of the scan, failed ones too, then points between them."""
    points, works = search.points, np.flatnonzero(search.scanned.works)
    between = np.arange(len(works), len(points.position))
    place = np.concatenate([works, len(positions) + np.arange(len(between))])
    count = len(positions) + len(between)
    rows = np.zeros(count, dtype=int)
    rows[place] = np.arange(len(place))
    spectrum = points.spectrum.at(rows)
    failed = np.setdiff1d(np.arange(count), place)
    spectrum.values[failed] = spectrum.right[failed] = np.nan
    order = np.argsort(points.position, kind="stable")
    return Branches(
        spectrum,
        place[order],
        Matches(search.steps.successor, search.steps.quality),
        np.concatenate([positions, points.position[between]]),
    )


def _label(found: Crossing, search: Search, branches: Branches, names: list[str], at: int) -> str:
    """Return the label of the branch that crosses, from the names of the states at a point of the branches."""
    order = np.argsort(search.points.position, kind="stable")
    point = int(np.flatnonzero(order == found.start)[0])
    branch = int(np.flatnonzero(branches.places[point] == found.from_state)[0])
    return names[int(branches.places[at][branch])]


def _named(
    found: list[Crossing], labels: list[str], search: Search, line: ParameterLine
) -> tuple[tuple[Boundary, ...], tuple[str, ...], LeastDamping]:
    """Name what moves at crossings, in modes beyond the level at the lowest position, and in the least damped mode."""
    points = search.points
    least = _least_damped(points)
    rows = np.array([int(points.position.argmin()), 0 if least is None else least[0]])
    model = line.models(np.array([*points.position[rows], *(one.position for one in found)]))
    values, right = (
        np.stack([*getattr(points.spectrum.at(rows), part), *(getattr(one.spectrum, part) for one in found)])
        for part in ("values", "right")
    )
    every = Spectrum(values, right, blocks=points.spectrum.blocks).all_modes
    moves, kind = moving(model, every.values, every.left, every.right), kinds(model, every)
    names, warnings = moves.names, model.trim.warning.tolist()
    above = (points.growth[rows[0]] > points.error[rows[0]]) & (values[0].imag >= 0)
    boundaries = tuple(
        replace(
            _boundary(one, moves, row, str(kind[row, one.state])),
            branch=label,
            warning=str(warnings[row]),
            level=search.level,
        )
        for row, (one, label) in enumerate(zip(found, labels, strict=True), start=len(rows))
    )
    beyond = tuple(dict.fromkeys(names[0, above].tolist()))
    if least is None:
        return boundaries, beyond, NOWHERE
    value = values[1, least[1]]
    ratio, position = float(-value.real / abs(value)), float(points.position[rows[1]])
    return boundaries, beyond, LeastDamping(ratio, str(names[1, least[1]]), position)


def _least_damped(points: Points) -> tuple[int, int] | None:
    """Return the point and the state with the least damping ratio -Re λ/|λ|; None where no point has a mode.

    Roots at zero within their error have no damping ratio and are left out.
    """
    values = points.spectrum.values
    size = np.abs(values)
    moves = (values.imag >= 0) & (size > points.error)
    if not moves.any():
        return None
    ratio = np.where(moves, -values.real, np.inf) / np.where(moves, size, 1)
    point, state = np.unravel_index(np.argmin(ratio), ratio.shape)
    return int(point), int(state)


def _boundary(found: Crossing, moves: Moving, row: int, kind: str) -> Boundary:
    """Return the boundary of a crossing, with what moves in its mode: a row of `moves`."""
    value = found.value
    shares = moves.shares[row, :, found.state]
    largest = [k for k in np.argsort(-shares) if shares[k] >= _TAKES_PART]
    return Boundary(
        position=found.position,
        mode=str(moves.names[row, found.state]),
        kind=kind,
        onset=found.onset,
        eigenvalue=value if value.imag >= 0 else value.conjugate(),
        rate=found.slope,
        eigenvalue_rate=complex(found.change if value.imag >= 0 else np.conj(found.change)),
        mechanism={moves.known[k]: float(shares[k]) for k in largest},
        defect=float(defect(found.spectrum.modes(np.array([found.state])))[0]),
        eigen_solves=found.solves,
    )


def _failed(positions: Array, scanned: Solved, works: Array) -> tuple[Failed, ...]:
    """Return stretches in which the scan failed, for one reason each, between points that work.

    positions (points,) of the scan; works, rising positions of all points that could be analysed.
    """
    found: list[Failed] = []
    failed = set(np.flatnonzero(~scanned.works).tolist())
    for place in sorted(failed):
        here, reason = float(positions[place]), str(scanned.reason[place])
        above = works[np.searchsorted(works, here) :]
        end = here if place + 1 in failed or not len(above) else float(above[0])
        if place - 1 in failed and _without_numbers(found[-1].reason) == _without_numbers(reason):
            found[-1] = found[-1]._replace(last=end)
            continue
        below = works[: np.searchsorted(works, here)]
        start = here if place - 1 in failed or not len(below) else float(below[-1])
        found.append(Failed(start, end, reason))
    return tuple(found)


def _lost(search: Search, brackets: Brackets) -> tuple[Failed, ...]:
    """Return stretches over which a mode passes the level, or may, and cannot be followed; neighbours as one."""
    rule = "a mode passes the level where it cannot be followed"
    found = []
    for k, why in brackets.lost.items():
        low, high = np.sort(brackets.x[:, k]).tolist()
        found.append(Failed(low, high, f"{rule}: {why}"))
    found += [Failed(low, high, f"{rule}: {JUMPS}") for _, low, high in search.unsettled]
    joined: list[Failed] = []
    for one in sorted(found):
        if joined and one.first <= joined[-1].last + _TOGETHER * abs(one.first):
            joined[-1] = joined[-1]._replace(last=max(one.last, joined[-1].last))
        else:
            joined.append(one)
    return tuple(joined)


def _without_numbers(reason: str) -> str:
    """Return a reason without its numbers, which differ from point to point."""
    return re.sub(r"[-+.\deE]*\d", "", reason)
