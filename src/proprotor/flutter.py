"""Stability boundaries of a case: where the damping of a mode passes a level, to rounding.

Every crossing in a range is found, flutter and divergence, those between two points of the scan included:
`proprotor.crossings` says how.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from proprotor import summary
from proprotor.arrays import Array
from proprotor.crossings import NEUTRAL, Brackets, Scan, growth, settle
from proprotor.eigenvalue_derivatives import defect
from proprotor.errors import InputError
from proprotor.mode_names import Moving, moving, name_list
from proprotor.model import LinearModel
from proprotor.path import Line, Path, follow
from proprotor.speed import in_metres_per_second
from proprotor.sweep import approach_to, line_of_case, names_at, state_names, tip_speed
from proprotor.tracking import Spectrum

if TYPE_CHECKING:
    from proprotor.case import Case

_REAL = 1e-9  # of the largest eigenvalue: a root with less imaginary part is real
_TOLD = 0.05  # of a mode: the least participation that its mechanism names
_RANGE = (0.2, 1.2, 51)  # of the tip speed: where boundaries are looked for, and at how many points


@dataclass(frozen=True, repr=False)
class Boundary:
    """One crossing of a damping level.

    Attributes
    ----------
    position : float
        Airspeed in m/s, or another input in SI.
    mode : str
        What moves most in the mode that crosses, by `proprotor.mode_names`: its name at the boundary itself.
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
        (`proprotor.eigenvalue_derivatives.defect`).
    eigen_solves : int
        Spent on this crossing beyond those that bracketed it.
    branch : str
        The exact root that crosses, by what moves in it where branches are named (`proprotor.branches`).
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

    def __repr__(self) -> str:
        return summary.of_flutter_point(self)

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


class Crossings(NamedTuple):
    """Boundaries along a line, with the modes beyond the level at its start.

    Parameters
    ----------
    boundaries : tuple of Boundary
        By position.
    unstable_at_start : tuple of str
        Modes beyond the level at the first position that could be analysed.
    searched : tuple of float
        First and last position that could be analysed, m/s or in SI units of the input.
    scan_solves, eigen_solves : int
        What it took to bracket every boundary, and in all.
    """

    boundaries: tuple[Boundary, ...]
    unstable_at_start: tuple[str, ...]
    searched: tuple[float, float]
    scan_solves: int
    eigen_solves: int

    def __repr__(self) -> str:
        return summary.of_crossings(self)


def find_crossings(line: Line, *, level: float = 0.0, approach: Line | None = None) -> Crossings:
    """All crossings of a damping level along a line, with exact positions.

    Parameters
    ----------
    line : Line
        With a `linearize` that takes complex positions and is analytic in them.
    level : float
        Damping ratio that counts as the boundary.
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
    model = line.models(np.asarray(line.positions, dtype=float))
    scan = Scan(line, follow(model, line), level)
    settle(scan)
    path = scan.path
    if not len(path.points):
        return Crossings((), (), (np.nan, np.nan), 0, 0)
    named = state_names(model, line, path, approach)
    names = [named.names[state] for state in path.places[named.point]]
    crossing = Brackets(scan) if len(path.points) > 1 else None
    boundaries = []
    if crossing is not None:
        crossing.close()
    if crossing is not None and crossing.found:
        moves = _moving_at_crossings(crossing)
        for row, place in enumerate(crossing.found):
            boundaries.append(_boundary(crossing, place, names, moves, row))
    boundaries = _distinct(sorted(boundaries, key=lambda found: found.position))
    scan_solves = len(path.points) + named.eigen_solves
    return Crossings(
        tuple(boundaries),
        _beyond(model, path, level),
        (float(scan.positions[0]), float(scan.positions[-1])),
        scan_solves,
        scan_solves + (0 if crossing is None else int(crossing.solves.sum())),
    )


def _beyond(model: LinearModel, path: Path, level: float) -> tuple[str, ...]:
    """What moves in the modes that are beyond the level at the first point."""
    first = int(path.points[0])
    values = path.spectrum.values[first]
    above = growth(values, level) > NEUTRAL * np.abs(values).max()
    names = np.array(name_list(model.dofs))[names_at(model, path.spectrum, first)]
    return tuple(dict.fromkeys(names[above & (values.imag >= 0)].tolist()))


def _moving_at_crossings(crossing: Brackets) -> Moving:
    """What moves in all modes of every crossing."""
    positions = np.array([position for position, *_ in crossing.found.values()])
    spectra = [spectrum for _, spectrum, *_ in crossing.found.values()]
    stacked = (np.stack([getattr(spectrum, part) for spectrum in spectra]) for part in ("values", "right"))
    values, right, left = Spectrum(*stacked).all_modes
    return moving(crossing.scan.line.models(positions), values, left, right)


def _boundary(crossing: Brackets, place: int, names: list[str], moves: Moving, row: int) -> Boundary:
    position, spectrum, state, change, slope = crossing.found[place]
    value = complex(spectrum.values[state])
    real = abs(value.imag) <= _REAL * np.abs(spectrum.values).max()
    shares = moves.shares[row, :, state]
    largest = [k for k in np.argsort(-shares) if shares[k] >= _TOLD]
    return Boundary(
        position=float(position),
        mode=str(moves.names[row, state]),
        kind="divergence" if real else "flutter",
        onset=bool(crossing.onset[place]) == bool(crossing.x[1, place] >= crossing.x[0, place]),
        eigenvalue=value if value.imag >= 0 else value.conjugate(),
        rate=float(slope),
        eigenvalue_rate=complex(change if value.imag >= 0 else np.conj(change)),
        mechanism={moves.known[k]: float(shares[k]) for k in largest},
        defect=float(defect(spectrum.modes(np.array([state])))[0]),
        eigen_solves=int(crossing.solves[place]),
        branch=names[crossing.states[place]],
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
        The scan, 0.2 to 1.2 of the tip speed by default; one airspeed with `vary`.
    vary : mapping of str to array (points,), optional
        One input by its path in the deck, and the values of the scan in SI: a critical control stiffness, support
        frequency or rotor speed.
    level : float
        Damping ratio that counts as the boundary.
    **options
        See `proprotor.options.Options`.

    Returns
    -------
    Crossings
        By position, m/s or in SI units of the input.

    Raises
    ------
    InputError
        As `proprotor.sweep.sweep_case`.
    """
    if airspeeds is None:
        if vary is not None:
            raise InputError("airspeeds", None, "must be one airspeed where an input varies")
        airspeeds = scan_speeds(case)
    line = line_of_case(case, airspeeds, vary, options)
    if line is None:
        raise InputError("case", case.name, "must be one design: give one input to vary")
    near = approach_to(case, line, line.models(line.positions), options)
    return find_crossings(line, level=level, approach=near)


def scan_speeds(case: Case, points: int = _RANGE[2]) -> Array:
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
    )
