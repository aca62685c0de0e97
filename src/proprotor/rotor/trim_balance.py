"""Balance of one blade at many points, and its slopes, with all of the airloads or with a share λ of the airloads.

The share multiplies precone, and the airloads in the rows of flap, lag and pitch.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from proprotor_equations import airloads
from proprotor_equations import trim as equations

from proprotor.rotor.elimination import solve
from proprotor.rotor.fused import have_c, plans_of
from proprotor.rotor.fused_balance import Room, balanced, segments_of, serves_sections
from proprotor.rotor.generated import evaluate
from proprotor.rotor.offset_mass import OffsetMass
from proprotor.rotor.options import Options
from proprotor.rotor.section_loads import BladeSections, load_moments, segment_quantities
from proprotor.rotor.trim import UNKNOWNS, Target, has_offset_mass, take, with_trim
from proprotor.typing import Array

LARGEST_STEP = 0.3  # rad; Newton starts far from a blade that has coned and lagged
_COMPLEX_STEP = 1e-30
_REAL = np.dtype(float)
# rad, the last step: the error of the loads. Convergence is quadratic, so the trim itself is exact to rounding.
_CONVERGED = 1e-13
# rad, a step that is no smaller than half of the step before: rounding limits convergence, as for a spring a hundred
# million times as stiff as everything else that holds the blade.
_STALLED = 1e-9

State = dict[str, Array]  # the unknowns by name, (points,)


class Slopes(NamedTuple):
    """Change of the balances with the free unknowns, N m/rad, (n, k, k).

    full : with all of the airloads.
    airloads : the part of the airloads in the rows of flap, lag and pitch; zero in the row that closes the collective.
    """

    full: Array
    airloads: Array

    @classmethod
    def unknown(cls, n: int, k: int) -> Slopes:
        """Return NaN at n points with k unknowns."""
        return cls(*np.full((2, n, k, k), np.nan))

    def put(self, rows: Array, slopes: Slopes) -> None:
        """Set the slopes at some of the points."""
        self.full[rows], self.airloads[rows] = slopes

    def at(self, share: Array) -> Array:
        """Return the slopes (..., n, k, k) at a share (..., n) of the loads."""
        return np.asarray(self.full - (1 - share[..., None, None]) * self.airloads)

    def by_moments(self, sprung: Array) -> Slopes:
        """Return the slopes per unit of the moments that springs and centrifugal force set against flap and lag.

        Counted in this way, a spring of any stiffness that turns with the pitch changes no slope. The other angles
        are counted as moments too, of the stiffest of these springs, so that units do not matter.
        """
        springs, places = self.full - self.airloads, np.flatnonzero(sprung)
        stiffest = np.abs(springs[:, places]).max(axis=(1, 2), initial=0.0)
        own = np.where(stiffest > 0, stiffest, 1.0)[:, None, None] * np.eye(len(sprung))
        angles = solve(
            np.where(sprung[:, None], springs, own), np.broadcast_to(np.eye(len(sprung)), springs.shape)
        )
        return Slopes(self.full @ angles, self.airloads @ angles)

    def of(self, rows: Array | slice) -> Slopes:
        """Return the slopes at some of the points."""
        return Slopes(self.full[rows], self.airloads[rows])


class Linear(NamedTuple):
    """The balance linearised at a state.

    residual : array (n, k)
        With all of the airloads, of the rows that close the free unknowns, N m; N for thrust.
    slopes : Slopes
    work, work_slopes : array (n, 5), (n, 5, k)
        Virtual work of the airloads on all rows, and minus its change with the free unknowns.
    quantities : dict
        Quantities of the whole blade.
    along : callable
        Returns the quantities of each segment with the radial moments of the section loads.
    """

    residual: Array
    slopes: Slopes
    work: Array
    work_slopes: Array
    quantities: dict[str, Any]
    along: Callable[[], dict[str, Any]]


@dataclass(frozen=True, eq=False)
class Balance:
    """Balance of one blade at many points: inputs, and the places of the free unknowns among `UNKNOWNS`."""

    sections: BladeSections
    quantities: Mapping[str, Any]
    options: Options
    target: Target
    free: list[int]
    points: int
    room: Room = field(default_factory=Room)

    @functools.cached_property
    def fused(self) -> bool:
        """Whether the fused functions hold the airfoil and the springs."""
        return serves_sections(self.sections) and self.options.frequencies is None

    @functools.cached_property
    def compiled(self) -> bool:
        """Whether compiled functions evaluate the plans: for real numbers, not for derivatives by a complex step."""
        numbers = (*self.quantities.values(), *vars(self.sections.airfoil).values())
        return (
            self.options.backend == "compiled"
            and have_c(self.plans)
            and not self.sections.is_complex
            and not any(map(is_complex, numbers))
        )

    @functools.cached_property
    def plans(self) -> ModuleType:
        """The fused functions for this rotor."""
        return plans_of(self.quantities)

    @property
    def rows(self) -> list[int]:
        """Rows of the balance that close the free unknowns, in the order of these unknowns."""
        return [self.target.row if place == equations.COLLECTIVE else place for place in self.free]

    @property
    def hinged(self) -> Array:
        """Which of these rows (k,) are flap, lag and pitch of the blade."""
        return np.array([place != equations.COLLECTIVE for place in self.free], dtype=bool)

    @property
    def sprung(self) -> Array:
        """Which of these rows (k,) are flap and lag of the blade."""
        return np.array([place in (equations.FLAP, equations.LAG) for place in self.free], dtype=bool)

    def air_direction(self, points: int) -> Array:
        """Return the direction of the air at 0.75 R (points,), rad."""
        airspeed, rotor_speed, radius = (
            np.real(self.quantities[name]) for name in ("airspeed", "rotor_speed", "radius")
        )
        return np.broadcast_to(np.arctan2(airspeed, 0.75 * rotor_speed * radius), (points,))

    def near(
        self,
        state: State,
        rows: Array,
        share: Array | float | None = None,
        doubts: dict[str, Array] | None = None,
    ) -> Linear:
        """Return residual and slopes at a state and a share of the precone, with the quantities behind both."""
        quantities = self.at(state, rows, share)
        if self.fused:
            sections = self.sections_at(rows)
            found = balanced(
                self.plans,
                sections,
                quantities,
                self.options.compressibility,
                self.room,
                doubts,
                self.compiled,
            )
            residual, structure, work, of_airloads, moments = found
            residual -= work
            along = functools.partial(segments_of, self.plans, moments, sections)
        else:
            segments = self._loads(quantities, rows, doubts=doubts)
            work = self._work(segments)
            residual = _residual(quantities) - work
            structure, of_airloads = self._slopes(state, rows, quantities, segments)
            along = functools.partial(dict, segments)
        blade = self._square(of_airloads)
        slopes = Slopes(self._square(structure) + blade, blade * self.hinged[:, None])
        residual = self._to_target(residual, rows)
        return Linear(
            residual[:, self.rows], slopes, work, np.take(of_airloads, self.free, axis=-1), quantities, along
        )

    def left(self, state: State, rows: Array, share: float | None = None) -> Array:
        """Return the residual (n, k) with all of the airloads, without slopes."""
        quantities = self.at(state, rows, share)
        work = self._work(self._loads(quantities, rows, steady_only=True))
        residual = _residual(quantities) - work
        return self._to_target(residual, rows)[:, self.rows]

    def relieved(self, here: Linear, share: Array) -> Array:
        """Return the residual (n, k) at a share (n,) of the airloads."""
        work = here.work[:, self.rows] * self.hinged
        return np.asarray(here.residual + (1 - share[:, None]) * work)

    def precone_load(self, rows: Array) -> Array:
        """Return the part of precone and of mass beside the axis in the residual (n, k) of the undeflected blade."""
        load = np.zeros((len(rows), len(self.free)))
        places = np.array(self.free)[self.hinged]
        given = take(self.quantities, rows)
        precone = evaluate(equations.precone_load, given)
        load[:, self.hinged] = precone[..., places, equations.TRIM]
        if has_offset_mass(given):
            flat = dict.fromkeys((*UNKNOWNS, "precone"), 0.0) | {
                "collective": self.air_direction(self.points)[rows]
            }
            beside = evaluate(equations.offset_residual, with_trim(given | flat, self.options, flat))
            load[:, self.hinged] += np.real(beside[..., places, equations.TRIM])
        return load

    def take_step(self, state: State, rows: Array, step: Array) -> None:
        """Subtract a step (n, k) from the free unknowns."""
        for column, place in enumerate(self.free):
            state[UNKNOWNS[place]][rows] -= step[:, column]

    def _square(self, slopes: Array) -> Array:
        """Return the rows that close the free unknowns, and the columns of these unknowns, (n, k, k)."""
        rows, columns = (np.array(places, dtype=int) for places in (self.rows, self.free))
        places = slopes.shape[-1] * rows[:, None] + columns
        return np.asarray(np.take(slopes.reshape(*slopes.shape[:-2], -1), places, axis=-1))

    def at(self, state: State, rows: Array, share: Array | float | None = None) -> dict[str, Any]:
        """Return the quantities of the whole blade at a state and at a share of its precone."""
        given = dict(self.quantities) if self._is_all(rows) else take(self.quantities, rows)
        if share is not None:
            given["precone"] = share * given["precone"]
            given |= _at_share(given, share)
        return with_trim(given, self.options, take(state, rows))

    def sections_at(self, rows: Array) -> BladeSections:
        """Return the sections at some of the points."""
        return self.sections if self._is_all(rows) else self.sections.take(rows)

    def _is_all(self, rows: Array) -> bool:
        """Return whether these are all points, in their order."""
        return len(rows) == self.points and bool((rows == np.arange(self.points)).all())

    def _loads(self, quantities: Mapping[str, Any], rows: Array, **wanted: Any) -> dict[str, Any]:
        """Return the quantities of each segment and the radial moments of the section loads."""
        sections = self.sections_at(rows)
        segments = segment_quantities(sections, quantities)
        return segments | load_moments(
            sections, segments, compressibility=self.options.compressibility, **wanted
        )

    def _work(self, segments: Mapping[str, Any]) -> Array:
        """Return the virtual work (n, 5) of the steady airloads on balances and thrust."""
        motion = {
            "virtual_motion": evaluate(equations.virtual_motion, segments),
            "steady_loads": evaluate(airloads.steady_loads, segments),
        }
        return np.asarray(evaluate(airloads.steady_work, motion)[..., airloads.TRIM])

    def _to_target(self, residual: Array, rows: Array) -> Array:
        """Add the load of the target to its row of a residual (n, 5)."""
        load = np.asarray(self.target.load)
        residual[..., self.target.row] += load[rows] if load.ndim else load
        return residual

    def _slopes(
        self, state: State, rows: Array, quantities: Mapping[str, Any], segments: Mapping[str, Any]
    ) -> tuple[Array, Array]:
        """Return the change (n, 5, 4) of the balances with the unknowns: of the structure, and of the airloads."""
        motion = {
            name: evaluate(getattr(equations, name), segments)
            for name in ("virtual_motion", "displacement_motion", "geometric_stiffness")
        }
        motion["load_derivatives"] = evaluate(airloads.load_derivatives, segments)
        of_airloads = evaluate(airloads.stiffness, motion)
        structure = evaluate(equations.jacobian, quantities)
        if has_offset_mass(quantities):
            structure = structure + evaluate(equations.offset_jacobian, quantities)
        if self.options.frequencies is not None and equations.COLLECTIVE in self.free:
            structure = np.broadcast_to(structure, of_airloads.shape).copy()
            structure[..., equations.COLLECTIVE] = self._with_collective(state, rows)
        return structure, of_airloads

    def _with_collective(self, state: State, rows: Array) -> Array:
        """Return the change (n, 5) of the structure's balances with the collective by a complex step.

        Tabulated frequencies may depend on the collective, and the generated Jacobian does not know the table.
        """
        real = {name: np.real(value) for name, value in state.items()}
        real["collective"] = real["collective"] + 1j * _COMPLEX_STEP
        given = {name: np.real(value) for name, value in take(self.quantities, rows).items()}
        quantities = with_trim(given, self.options, take(real, rows))
        return np.asarray(_residual(quantities).imag / _COMPLEX_STEP)


def _at_share(quantities: Mapping[str, Any], share: Any) -> dict[str, Any]:
    """Return the integrals of mass beside the pitch axis at a share of the offset; nothing for a blade without any."""
    if not has_offset_mass(quantities):
        return {}
    squares = ("offset_cosine_inertia", "offset_product_inertia", "offset_sine_inertia")
    return {
        entry.name: quantities[entry.name] * (share**2 if entry.name in squares else share)
        for entry in fields(OffsetMass)
    }


def _residual(quantities: Mapping[str, Any]) -> Array:
    """Return the balance (n, 5) without airloads."""
    residual = evaluate(equations.residual, quantities)[..., equations.TRIM]
    if has_offset_mass(quantities):
        residual = residual + evaluate(equations.offset_residual, quantities)[..., equations.TRIM]
    return np.asarray(residual)


def is_complex(value: Any) -> bool:
    """Return whether a number or an array is complex."""
    if type(value) is float:  # as most are: to ask about arrays takes longer
        return False
    return isinstance(value, complex) or getattr(value, "dtype", _REAL).kind == "c"


def newton_step(slopes: Array, residual: Array) -> Array:
    """Return the step (n, k) to subtract from the unknowns; NaN if the slopes have no inverse."""
    step = solve(slopes, residual[..., None])[..., 0]
    return step if np.iscomplexobj(step) else np.minimum(np.maximum(step, -LARGEST_STEP), LARGEST_STEP)


def is_last(size: Any, before: Any) -> Any:
    """Return whether a step, a number or an array (n,), is the last, by its size and the size of the step before."""
    return (size <= _CONVERGED) | ((size <= _STALLED) & (size >= before / 2))


def copy_state(state: State, rows: Array, onto: State) -> None:
    """Set one state to another at some of the points."""
    for name in UNKNOWNS:
        onto[name][rows] = state[name][rows]
