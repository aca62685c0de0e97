"""Balance of the blade of one point, and its slopes, by the fused functions with plain numbers.

An operation of arrays takes ten times as long as one of plain numbers, so that arrays are left to the stations of the
blade alone.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from operator import add, neg
from types import ModuleType
from typing import Any, NamedTuple, cast

import numpy as np

from proprotor.rotor.airfoil import Airfoil
from proprotor.rotor.fused import plain_number
from proprotor.rotor.fused_balance import OF_AIRFOIL, PITCH_TWICE, loads_of, moments_of
from proprotor.rotor.generated import evaluate, keywords
from proprotor.rotor.kept import kept
from proprotor.rotor.quadrature import POWERS
from proprotor.rotor.section_loads import LOAD_MOMENTS, OUTBOARD, BladeSections
from proprotor.rotor.trim import FLAP_LAG, blade_pitch
from proprotor.rotor.trim_balance import Balance
from proprotor.typing import Array

Numbers = dict[str, Any]
Rows = list[list[float]]
_NO_LOADS = dict.fromkeys(LOAD_MOMENTS, 0.0)
_SIDES = ("beyond_flap_hinge", "beyond_lag_hinge")


class Here(NamedTuple):
    """The balance at a state.

    plans : the fused functions of this rotor.
    residual : of the rows that close the free unknowns.
    full, airloads : slopes of these rows with the free unknowns, as `Slopes`.
    work : results of the plan `work`, as the places of its layouts count them.
    quantities : of the whole blade.
    moments : array (loads, powers of all segments)
        Radial moments of the section loads.
    loads : array (results, stations)
        Results of the plan `section_loads`.
    """

    plans: ModuleType
    residual: list[float]
    full: Rows
    airloads: Rows
    work: Sequence[float]
    quantities: Numbers
    moments: Array
    loads: Array

    def segments(self, sides: Mapping[str, Array]) -> Numbers:
        """Return the sides of the segments and the radial moments of their loads, arrays (segments,) by name."""
        names = moments_of(self.plans)
        own = self.moments.reshape(len(self.moments), -1, POWERS).swapaxes(1, 2).reshape(len(names), -1)
        found: Numbers = {**_NO_LOADS, **sides, **dict(zip(names, own, strict=True))}
        return found

    def virtual_work(self, row: int) -> float:
        """Return the virtual work of the airloads of one blade on a row of the balance."""
        place: int = self.plans.WORK["work"][row][0]
        return self.work[place]

    def virtual_work_after(self, step: Sequence[float], free: Sequence[int], row: int) -> float:
        """Return the virtual work after a step of the free unknowns, which is subtracted from them."""
        places: list[int] = self.plans.WORK["work_slopes"][row]
        slopes = (self.work[places[PITCH_TWICE[place]]] for place in free)
        moved = sum(slope * part for slope, part in zip(slopes, step, strict=True))
        return self.virtual_work(row) + moved


@dataclass(frozen=True, eq=False)
class _Stations:
    """The stations of the blade, arrays (stations,), with the segment of each and the weights of all segments.

    given : chord and airfoil, by the names of the plan `section_loads`. A chord that all stations share is a number,
        for what depends on it alone; the airfoil meets arrays, and arrays go with arrays faster than numbers do.
    weights : array (stations, powers of all segments)
    sides : on which side of the hinges each segment is.
    """

    radii: Array
    segment: Array
    twist: Array
    bent: Array
    airfoil: Airfoil
    given: Numbers
    weights: Array
    sides: list[Numbers]

    @staticmethod
    @kept
    def of(sections: BladeSections) -> _Stations:
        """Return the stations of sections that have no axis of points."""
        quadrature, along = sections.quadrature, sections.along
        count = len(quadrature.counts)
        segment = np.repeat(np.arange(count), quadrature.counts)
        weights = np.zeros((len(segment), count, POWERS))
        weights[np.arange(len(segment)), segment] = quadrature.weights
        airfoil = cast(Airfoil, sections.airfoil)
        chords = {"chord": along.chord, "square_ratio": along.square, "cube_ratio": along.cube}
        given = {name: part.item() if part.size == 1 else part for name, part in chords.items()}
        given |= {
            name: np.broadcast_to(np.ravel(getattr(airfoil, field)), segment.shape).astype(float)
            for field, name in OF_AIRFOIL.items()
        }
        numbers = zip(*(side.tolist() for side in sections.sides.values()), strict=True)
        sides = [dict(zip(sections.sides, own, strict=True)) for own in numbers]
        flat = weights.reshape(len(segment), -1)
        radii, twist = quadrature.stations, along.twist
        bent = np.broadcast_to(along.bent, radii.shape)
        return _Stations(radii, segment, twist, bent, airfoil, given, flat, sides)

    def along(
        self, plans: ModuleType, lines: list[tuple[float, ...]], quantities: Numbers, sound: float
    ) -> tuple[Array, Array]:
        """Return the loads (results, stations), and the moments (loads, powers of all segments).

        `lines` has the results of the plan `line` for each segment.
        """
        ends = np.array([line[plans.LINE.index("ut_0") :] for line in lines]).T.take(self.segment, axis=1)
        tangential, axial = ends[:2] + ends[3:5] * self.radii
        loads = np.empty((len(plans.SECTION_LOADS), len(self.radii)))
        plans.section_loads(
            loads,
            **self.given,
            tangential_velocity=tangential,
            axial_velocity=axial,
            radial_velocity=ends[2],
            section_spin=ends[5],
            section_pitch=self.twist + quantities["pitch"],
            section_damping=quantities["section_damping"],
            density=quantities["density"],
            speed_of_sound=sound,
        )
        return loads, loads[: len(loads_of(plans))].dot(self.weights)

    def are_in_doubt(self, loads: Array, radius: float) -> bool:
        """Return whether outboard stations with these results of `section_loads` are beyond the airfoil's range."""
        first = self.radii.searchsorted(OUTBOARD * radius)
        incidence, mach = loads[-2:, first:]
        return any(mask.any() for mask in self.airfoil.warnings(incidence + self.bent[first:], mach).values())


class _Places(NamedTuple):
    """Where the entries of the rows that close the free unknowns stand among the results of `balance` and of `work`."""

    residual: list[int]
    slopes: list[list[int]]
    work: list[int]
    work_slopes: list[list[int]]

    @staticmethod
    @functools.cache
    def of(plans: ModuleType, rows: tuple[int, ...], free: tuple[int, ...]) -> _Places:
        """Return the places of the entries of some rows and columns."""
        residual, slopes = plans.BALANCE["residual"], plans.BALANCE["slopes"]
        work, work_slopes = plans.WORK["work"], plans.WORK["work_slopes"]
        return _Places(
            [residual[row][0] for row in rows],
            [[slopes[row][place] for place in free] for row in rows],
            [work[row][0] for row in rows],
            [[work_slopes[row][PITCH_TWICE[place]] for place in free] for row in rows],
        )


@dataclass(frozen=True, eq=False)
class BalanceOfOne:
    """The balance of the blade of one point: as `Balance`, with the quantities as plain numbers.

    rows, free, hinged : as of `Balance`.
    places : of the entries of the rows and columns of the free unknowns.
    of_work : what the plan `work` takes of the blade and of each segment, by name.
    """

    balance: Balance
    plans: ModuleType
    quantities: Numbers
    stations: _Stations
    load: float
    rows: list[int]
    free: list[int]
    hinged: list[bool]
    places: _Places
    of_work: list[Numbers]

    @classmethod
    def of(cls, balance: Balance) -> BalanceOfOne:
        """Return the balance of the only point of a batch."""
        quantities = {name: plain_number(value) for name, value in balance.quantities.items()}
        stations, load = _Stations.of(balance.sections), plain_number(balance.target.load)
        rows, free, hinged = balance.rows, balance.free, balance.hinged.tolist()
        places = _Places.of(balance.plans, tuple(rows), tuple(free))
        of_blade = {name: quantities[name] for name in _of_blade(balance.plans)}
        of_work = [{**of_blade, **side} for side in stations.sides]
        return cls(balance, balance.plans, quantities, stations, load, rows, free, hinged, places, of_work)

    def precone_load(self) -> list[float]:
        """Return the part of precone in the residual of the undeflected blade."""
        loads = _signed(evaluate(self.plans.precone_load, self.quantities, math.cos, math.sin))
        places = [place for place, *_ in self.plans.PRECONE_LOAD["precone_load"]]
        return [
            loads[places[row]] if hinged else 0.0 for row, hinged in zip(self.rows, self.hinged, strict=True)
        ]

    def at(self, state: Numbers, precone: float | None = None) -> Here:
        """Return the balance at a state, with a precone of its own if one is given."""
        here, plans = self.quantities | state, self.plans
        if precone is not None:
            here["precone"] = precone
        here["pitch"] = blade_pitch(here, state)
        here["structural_pitch"] = here["pitch"] + here["structural_pitch_offset"]
        found = evaluate(plans.trim_integrals, here, math.cos, math.sin)
        here.update(zip(plans.TRIM_INTEGRALS, found, strict=True))
        found = evaluate(plans.effective_stiffness, here, math.cos, math.sin)
        here.update(zip(plans.EFFECTIVE_STIFFNESS, found, strict=True))
        if self.balance.options.structure == "diagonal":
            here.update(dict.fromkeys(FLAP_LAG, 0.0))
        structure = evaluate(plans.balance, here, math.cos, math.sin)
        lines = [evaluate(plans.line, here | side, math.cos, math.sin) for side in self.stations.sides]
        sound = here["speed_of_sound"] if self.balance.options.compressibility else math.inf
        loads, moments = self.stations.along(plans, lines, here, sound)
        residual, full, airloads, work = self._linear(structure, self._work(lines, moments))
        return Here(plans, residual, full, airloads, work, here, moments, loads)

    def _work(self, lines: list[tuple[float, ...]], moments: Array) -> Sequence[float]:
        """Return the results of the plan `work`, summed over the segments."""
        own = (
            moments.reshape(len(moments), len(lines), POWERS).swapaxes(0, 1).reshape(len(lines), -1).tolist()
        )
        first, *others = (
            self.plans.work(line, of_loads, **given)
            for line, of_loads, given in zip(lines, own, self.of_work, strict=True)
        )
        return functools.reduce(_sum, others, first)

    def _linear(
        self, structure: Sequence[float], work: Sequence[float]
    ) -> tuple[list[float], Rows, Rows, list[float]]:
        """Return residual, both slopes and work from the results of the plans."""
        held, done, places = _signed(structure), _signed(work), self.places
        residual = [held[one] - done[other] for one, other in zip(places.residual, places.work, strict=True)]
        if self.balance.target.finds_collective:
            residual[-1] += self.load
        slopes = [[done[place] for place in row] for row in places.work_slopes]
        full = [
            [held[place] + slope for place, slope in zip(own, row, strict=True)]
            for own, row in zip(places.slopes, slopes, strict=True)
        ]
        none = [0.0] * len(self.free)
        airloads = [row if hinged else none for row, hinged in zip(slopes, self.hinged, strict=True)]
        return residual, full, airloads, done


def _sum(one: Sequence[float], other: Sequence[float]) -> Sequence[float]:
    return list(map(add, one, other))


@functools.cache
def _of_blade(plans: ModuleType) -> tuple[str, ...]:
    """Return the quantities of the whole blade that the plan `work` takes."""
    return tuple(name for name in keywords(plans.work) if name not in _SIDES)


def _signed(results: Sequence[float]) -> list[float]:
    """Return results so that a layout's numbers are their places: zero first, the negatives from the end."""
    return [0.0, *results, *map(neg, reversed(results))]


def solve(matrix: Rows, right: list[float]) -> list[float] | None:
    """Return the solution of a few equations by elimination with row exchange; None if there is none."""
    rows = [[*row, value] for row, value in zip(matrix, right, strict=True)]
    size = len(rows)
    for column in range(size):
        for below in range(column + 1, size):
            if abs(rows[below][column]) > abs(rows[column][column]):
                rows[column], rows[below] = rows[below], rows[column]
        upper = rows[column]
        if not abs(upper[column]) > 0:
            return None
        for lower in rows[column + 1 :]:
            factor = lower[column] / upper[column]
            for place in range(column + 1, size + 1):
                lower[place] -= factor * upper[place]
    found = [0.0] * size
    for place in range(size - 1, -1, -1):
        known = rows[place][size]
        for other in range(place + 1, size):
            known -= rows[place][other] * found[other]
        found[place] = known / rows[place][place]
    return found


def sums_of_minors(matrix: Rows) -> list[float]:
    """Return the sums of the principal minors of each size, of up to three rows."""
    size = len(matrix)
    pairs = [(i, j) for i in range(size) for j in range(i)]
    sums = [sum(matrix[i][i] for i in range(size))]
    sums.append(sum(matrix[i][i] * matrix[j][j] - matrix[i][j] * matrix[j][i] for i, j in pairs))
    if size == 3:
        (a, b, c), (d, e, f), (g, h, i) = matrix
        sums.append(a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g))
    return sums[:size]
