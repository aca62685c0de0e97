"""Balance of the blade of one point, and its slopes, by the fused functions with plain numbers.

An operation of arrays takes ten times as long as one of plain numbers, so that arrays are left to the stations of the
blade alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, cast

import numpy as np
from proprotor_equations import trim as equations
from proprotor_equations.fused import rotor as springs
from proprotor_equations.fused import trim as plans

from proprotor.rotor.airfoil import Airfoil
from proprotor.rotor.fused import plain_number
from proprotor.rotor.fused_balance import LOADS, MOMENTS, OF_AIRFOIL, PITCH_TWICE
from proprotor.rotor.generated import evaluate
from proprotor.rotor.quadrature import POWERS
from proprotor.rotor.section_loads import LOAD_MOMENTS, BladeSections
from proprotor.rotor.trim import FLAP_LAG
from proprotor.rotor.trim_balance import Balance
from proprotor.typing import Array

Numbers = dict[str, Any]
Rows = list[list[float]]
_NO_LOADS = dict.fromkeys(LOAD_MOMENTS, 0.0)
_LINES = plans.LINE.index("ut_0")


class Here(NamedTuple):
    """The balance at a state.

    residual : of the rows that close the free unknowns.
    full, airloads : slopes of these rows with the free unknowns, as `Slopes`.
    work, work_slopes : virtual work of the airloads on all five rows, and minus its change with the free unknowns.
    quantities : of the whole blade.
    moments : array (loads, powers of all segments)
        Radial moments of the section loads.
    loads : array (results, stations)
        Results of the plan `section_loads`.
    """

    residual: list[float]
    full: Rows
    airloads: Rows
    work: list[float]
    work_slopes: Rows
    quantities: Numbers
    moments: Array
    loads: Array

    def segments(self, sides: Mapping[str, Array]) -> Numbers:
        """Return the sides of the segments and the radial moments of their loads, arrays (segments,) by name."""
        own = self.moments.reshape(len(LOADS), -1, POWERS).swapaxes(1, 2).reshape(len(MOMENTS), -1)
        found: Numbers = {**_NO_LOADS, **sides, **dict(zip(MOMENTS, own, strict=True))}
        return found


@dataclass(frozen=True, eq=False)
class _Stations:
    """The stations of the blade, arrays (stations,), with the segment of each and the weights of all segments.

    given : chord and airfoil, by the names of the plan `section_loads`.
    weights : array (stations, powers of all segments)
    sides : on which side of the hinges each segment is.
    """

    radii: Array
    segment: Array
    twist: Array
    given: Numbers
    weights: Array
    sides: list[Numbers]

    @classmethod
    def of(cls, sections: BladeSections) -> _Stations:
        """Return the stations of sections that have no axis of points."""
        quadrature, along = sections.quadrature, sections.along
        segment = np.repeat(np.arange(len(quadrature.counts)), quadrature.counts)
        weights = np.zeros((len(segment), len(quadrature.counts), POWERS))
        weights[np.arange(len(segment)), segment] = quadrature.weights
        airfoil = vars(cast(Airfoil, sections.airfoil))
        of_airfoil = {
            name: plain_number(airfoil[field]) if np.size(airfoil[field]) == 1 else np.ravel(airfoil[field])
            for field, name in OF_AIRFOIL.items()
        }
        given = of_airfoil | {"chord": along.chord, "square_ratio": along.square, "cube_ratio": along.cube}
        numbers = zip(*(side.tolist() for side in sections.sides.values()), strict=True)
        sides = [dict(zip(sections.sides, own, strict=True)) for own in numbers]
        flat = weights.reshape(len(segment), -1)
        return cls(quadrature.stations, segment, along.twist, given, flat, sides)

    def along(self, lines: list[tuple[float, ...]], quantities: Numbers, sound: float) -> tuple[Array, Array]:
        """Return the loads (results, stations), and the moments (loads, powers of all segments).

        `lines` has the results of the plan `line` for each segment.
        """
        ends = np.array(lines)[:, _LINES:].T[:, self.segment]
        ut_0, up_0, radial, ut_1, up_1, spin = ends
        given = self.given | {
            "tangential_velocity": ut_0 + ut_1 * self.radii,
            "axial_velocity": up_0 + up_1 * self.radii,
            "radial_velocity": radial,
            "section_spin": spin,
            "section_pitch": self.twist + quantities["pitch"],
            "section_damping": quantities["section_damping"],
            "density": quantities["density"],
            "speed_of_sound": sound,
        }
        loads = np.empty((len(plans.SECTION_LOADS), len(self.radii)))
        plans.section_loads(np.sqrt, np.arctan, loads, **given)
        return loads, loads[: len(LOADS)].dot(self.weights)


@dataclass(frozen=True, eq=False)
class BalanceOfOne:
    """The balance of the blade of one point: as `Balance`, with the quantities as plain numbers.

    rows, free, hinged : as of `Balance`.
    """

    balance: Balance
    quantities: Numbers
    stations: _Stations
    load: float
    rows: list[int]
    free: list[int]
    hinged: list[bool]

    @classmethod
    def of(cls, balance: Balance) -> BalanceOfOne:
        """Return the balance of the only point of a batch."""
        quantities = {name: plain_number(value) for name, value in balance.quantities.items()}
        stations, load = _Stations.of(balance.sections), plain_number(balance.target.load)
        hinged = balance.hinged.tolist()
        return cls(balance, quantities, stations, load, balance.rows, balance.free, hinged)

    def precone_load(self) -> list[float]:
        """Return the part of precone in the residual of the undeflected blade."""
        loads = evaluate(equations.precone_load, self.quantities)[:, equations.TRIM].tolist()
        return [loads[row] if hinged else 0.0 for row, hinged in zip(self.rows, self.hinged, strict=True)]

    def at(self, state: Numbers, precone: float | None = None) -> Here:
        """Return the balance at a state, with a precone of its own if one is given."""
        here = self.quantities | state
        if precone is not None:
            here["precone"] = precone
        here["pitch"] = state["collective"] + state["elastic_pitch"]
        here["structural_pitch"] = here["pitch"] + here["structural_pitch_offset"]
        found = evaluate(plans.trim_integrals, here, math.cos, math.sin)
        here.update(zip(plans.TRIM_INTEGRALS, found, strict=True))
        found = evaluate(springs.effective_stiffness, here, math.cos, math.sin)
        here.update(zip(springs.EFFECTIVE_STIFFNESS, found, strict=True))
        if self.balance.options.structure == "diagonal":
            here.update(dict.fromkeys(FLAP_LAG, 0.0))
        structure = evaluate(plans.balance, here, math.cos, math.sin)
        lines = [evaluate(plans.line, here | side, math.cos, math.sin) for side in self.stations.sides]
        sound = here["speed_of_sound"] if self.balance.options.compressibility else math.inf
        loads, moments = self.stations.along(lines, here, sound)
        return self._linear(structure, self._work(here, lines, moments), here, moments, loads)

    def _work(self, here: Numbers, lines: list[tuple[float, ...]], moments: Array) -> list[float]:
        """Return the results of the plan `work`, summed over the segments."""
        segment, parts = here | _NO_LOADS, []
        for place, (line, side) in enumerate(zip(lines, self.stations.sides, strict=True)):
            own = moments[:, POWERS * place : POWERS * (place + 1)].ravel().tolist()
            segment.update(side)
            segment.update(zip(plans.LINE, line, strict=True))
            segment.update(zip(MOMENTS, own, strict=True))
            parts.append(evaluate(plans.work, segment))
        return parts[0] if len(parts) == 1 else [sum(results) for results in zip(*parts, strict=True)]

    def _linear(
        self,
        structure: tuple[float, ...],
        work: list[float],
        here: Numbers,
        moments: Array,
        loads: Array,
    ) -> Here:
        """Return residual and slopes from the results of the plans."""
        held, lifted = _signed(structure), _signed(work)
        done = [lifted[number] for (number,) in plans.WORK["work"]]
        columns = [PITCH_TWICE[place] for place in self.free]
        slopes = [[lifted[numbers[place]] for place in columns] for numbers in plans.WORK["work_slopes"]]
        residual = [held[plans.BALANCE["residual"][row][0]] - done[row] for row in self.rows]
        if self.balance.target.finds_collective:
            residual[-1] += self.load
        full = []
        for row in self.rows:
            numbers = plans.BALANCE["slopes"][row]
            own = zip(self.free, slopes[row], strict=True)
            full.append([held[numbers[place]] + slope for place, slope in own])
        none = [0.0] * len(self.free)
        rows = zip(self.rows, self.hinged, strict=True)
        airloads = [slopes[row] if hinged else none for row, hinged in rows]
        return Here(residual, full, airloads, done, slopes, here, moments, loads)


def _signed(results: Sequence[float]) -> list[float]:
    """Return results so that a layout's numbers are their places: zero first, the negatives from the end."""
    return [0.0, *results, *(-result for result in reversed(results))]


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
