"""Balance of one blade at many points, with its slopes, at all of the loads or at a share of them.

A share multiplies precone, and the airloads in the rows of flap, lag and pitch.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from proprotor_equations import airloads
from proprotor_equations import trim as equations

from proprotor.rotor.generated import evaluate
from proprotor.rotor.options import Options
from proprotor.rotor.section_loads import BladeSections, load_moments, segment_quantities
from proprotor.rotor.trim import UNKNOWNS, Target, take, with_trim
from proprotor.typing import Array

LARGEST_STEP = 0.3  # rad; Newton starts far from a blade that has coned and lagged
_COLLECTIVE = UNKNOWNS.index("collective")
_COMPLEX_STEP = 1e-30

State = dict[str, Array]


class Slopes(NamedTuple):
    """Change of the balances with the free unknowns, N m/rad, (n, k, k).

    full : with all of the airloads.
    airloads : what the airloads have in it on the rows of flap, lag and pitch; zero on the row that closes the trim.
    """

    full: Array
    airloads: Array

    @classmethod
    def unknown(cls, n: int, k: int) -> Slopes:
        """Not a number at n points with k unknowns."""
        return cls(*np.full((2, n, k, k), np.nan))

    def put(self, rows: Array, slopes: Slopes) -> None:
        """Note those of some of the points."""
        self.full[rows], self.airloads[rows] = slopes

    def at(self, share: Array) -> Array:
        """The slopes (n, k, k) at a share (n,) of the loads."""
        slopes: Array = self.full - (1 - share[:, None, None]) * self.airloads
        return slopes

    def by_moments(self, sprung: Array) -> Slopes:
        """The same per unit of the moments that springs and centrifugal force make of flap and lag, not of the angles.

        So counted a spring as stiff as can be that turns with the pitch changes no slope.
        """
        structure = np.where(sprung[:, None], self.full - self.airloads, np.eye(len(sprung)))
        angles = solve(structure, np.broadcast_to(np.eye(len(sprung)), structure.shape))
        return Slopes(self.full @ angles, self.airloads @ angles)

    def of(self, rows: Array) -> Slopes:
        """Those of some of the points."""
        return Slopes(self.full[rows], self.airloads[rows])


class Linear(NamedTuple):
    """The balance near a state.

    residual : array (n, k)
        With all of the airloads, of the rows that close the free unknowns, N m; N for thrust.
    slopes : Slopes
    work, work_slopes : array (n, 5), (n, 5, k)
        Virtual work of the airloads on all rows, and less their change with the free unknowns.
    pool, segments : dict
        Quantities of the whole blade, and those of each segment with the moments of its loads.
    """

    residual: Array
    slopes: Slopes
    work: Array
    work_slopes: Array
    pool: dict[str, Any]
    segments: dict[str, Any]


@dataclass(frozen=True, eq=False)
class Balance:
    """Balance of one blade at many points: inputs, and the unknowns that are free."""

    sections: BladeSections
    quantities: Mapping[str, Any]
    options: Options
    target: Target
    free: list[int]

    @property
    def rows(self) -> list[int]:
        """Rows that close the free unknowns, in their order."""
        return [self.target.row if place == _COLLECTIVE else place for place in self.free]

    @property
    def hinged(self) -> Array:
        """Which of these rows (k,) are the blade's flap, lag and pitch."""
        return np.array([place != _COLLECTIVE for place in self.free], dtype=bool)

    def air_direction(self, points: int) -> Array:
        """Direction of the air at 0.75 R (points,), rad."""
        airspeed, rotor_speed, radius = (
            np.real(self.quantities[name]) for name in ("airspeed", "rotor_speed", "radius")
        )
        return np.broadcast_to(np.arctan2(airspeed, 0.75 * rotor_speed * radius), (points,))

    @property
    def sprung(self) -> Array:
        """Which of these rows (k,) are the blade's flap and lag."""
        return np.array([UNKNOWNS[place] in ("coning", "lag") for place in self.free], dtype=bool)

    def pool(self, state: State, rows: Array, share: Array | float | None = None) -> dict[str, Any]:
        """Quantities of the whole blade at a state, and at a share of its precone."""
        there = {name: value[rows] for name, value in state.items()}
        given = take(self.quantities, rows)
        if share is not None:
            given["precone"] = share * given["precone"]
        return with_trim(given, self.options, there)

    def loads(self, pool: Mapping[str, Any], rows: Array, **wanted: Any) -> dict[str, Any]:
        """Quantities of each segment and the radial moments of its loads."""
        sections = self.sections.take(rows)
        segments = segment_quantities(sections, pool)
        return segments | load_moments(
            sections, segments, compressibility=self.options.compressibility, **wanted
        )

    def residual(
        self, pool: Mapping[str, Any], segments: Mapping[str, Any], rows: Array
    ) -> tuple[Array, Array]:
        """Residual (n, 5) of balances and thrust, and the steady airloads in it."""
        motion = {
            "virtual_motion": evaluate(equations.virtual_motion, segments),
            "steady_loads": evaluate(airloads.steady_loads, segments),
        }
        work = evaluate(airloads.steady_work, motion)[..., 0]
        residual = evaluate(equations.residual, pool)[..., 0] - work
        load = np.asarray(self.target.load)
        residual[..., self.target.row] += load[rows] if load.ndim else load
        return residual, work

    def left(self, state: State, rows: Array, share: float | None = None) -> Array:
        """Residual (n, k) with all of the airloads, without slopes."""
        pool = self.pool(state, rows, share)
        residual, _ = self.residual(pool, self.loads(pool, rows, steady_only=True), rows)
        return residual[:, self.rows]

    def slopes(
        self, state: State, rows: Array, pool: Mapping[str, Any], segments: Mapping[str, Any]
    ) -> tuple[Slopes, Array]:
        """Change of the balances with the free unknowns, and the airloads' part (n, 5, k) in that of all rows."""
        motion = {
            name: evaluate(getattr(equations, name), segments)
            for name in ("virtual_motion", "displacement_motion", "geometric_stiffness")
        }
        motion["load_derivatives"] = evaluate(airloads.load_derivatives, segments)
        of_airloads = evaluate(airloads.stiffness, motion)
        structure = evaluate(equations.jacobian, pool)
        if self.options.frequencies is not None and _COLLECTIVE in self.free:
            structure = np.broadcast_to(structure, of_airloads.shape).copy()
            structure[..., _COLLECTIVE] = self._with_collective(state, rows)
        whole = (structure + of_airloads)[..., self.free]
        of_airloads = of_airloads[..., self.free]
        blade = of_airloads[:, self.rows] * self.hinged[:, None]
        return Slopes(whole[:, self.rows], blade), of_airloads

    def _with_collective(self, state: State, rows: Array) -> Array:
        """Change (n, 5) of the structure's balances with the collective, on which tabulated frequencies may depend."""
        there = {name: np.real(value) for name, value in state.items()}
        there["collective"] = there["collective"] + 1j * _COMPLEX_STEP
        real = {name: np.real(value) for name, value in take(self.quantities, rows).items()}
        pool = with_trim(real, self.options, {name: value[rows] for name, value in there.items()})
        change: Array = evaluate(equations.residual, pool)[..., 0].imag / _COMPLEX_STEP
        return change

    def near(
        self,
        state: State,
        rows: Array,
        share: Array | float | None = None,
        doubts: dict[str, Array] | None = None,
    ) -> Linear:
        """Residual and slopes at a state and a share of the precone, with all they are made of."""
        pool = self.pool(state, rows, share)
        segments = self.loads(pool, rows, doubts=doubts)
        residual, work = self.residual(pool, segments, rows)
        slopes, work_slopes = self.slopes(state, rows, pool, segments)
        return Linear(residual[:, self.rows], slopes, work, work_slopes, pool, segments)

    def relieved(self, here: Linear, share: Array) -> Array:
        """Residual (n, k) at a share (n,) of the airloads."""
        work = here.work[:, self.rows] * self.hinged
        relieved: Array = here.residual + (1 - share[:, None]) * work
        return relieved

    def precone_load(self, rows: Array) -> Array:
        """What precone adds to the residual (n, k) of the undeflected blade."""
        load = np.zeros((len(rows), len(self.free)))
        load[:, self.hinged] = evaluate(equations.precone_load, take(self.quantities, rows))[
            ..., self.free[: sum(self.hinged)], 0
        ]
        return load

    def take_step(self, state: State, rows: Array, step: Array) -> None:
        """Take a step (n, k) off the free unknowns."""
        for column, place in enumerate(self.free):
            state[UNKNOWNS[place]][rows] -= step[:, column]


def solve(slopes: Array, right: Array) -> Array:
    """slopes⁻¹ right, (n, k, m); NaN at the points whose slopes have no inverse."""
    try:
        return np.linalg.solve(slopes, right)
    except np.linalg.LinAlgError:  # at one point: it is undefined there, not at the others
        good = np.isfinite(slopes).all(axis=(1, 2)) & (np.abs(np.linalg.det(slopes)) > 0)
        found = np.full(right.shape, np.nan, dtype=np.result_type(slopes, right))
        found[good] = np.linalg.solve(slopes[good], right[good])
        return found


def newton_step(slopes: Array, residual: Array) -> Array:
    """Step (n, k) to take off the unknowns; NaN where the slopes have no inverse."""
    step = solve(slopes, residual[..., None])[..., 0]
    return step if np.iscomplexobj(step) else np.clip(step, -LARGEST_STEP, LARGEST_STEP)


def copy_state(state: State, rows: Array, onto: State) -> None:
    """Set one state to another at some points."""
    for name in UNKNOWNS:
        onto[name][rows] = state[name][rows]
