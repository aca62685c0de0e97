"""The kinds of lines in the catalogue of `derive.equations`: what each makes of a derivation.

The summary of a generated function is the first line of its derivation's docstring, unless the line gives another.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from derive import airloads, beam, blade_element, function, moving, multiblade
from derive import kinematics as kin
from derive.coordinates import (
    BLADE_INFLOW,
    LOAD,
    MOTION,
    REACTIONLESS_PAIR,
    SEGMENT_LOADS,
    SEGMENT_MOTIONS,
    Coordinate,
    names,
)
from derive.function import (
    FORCE,
    MOMENT,
    DimensionOf,
    Function,
    coordinate_dimension,
    force_per,
    per_time,
    plus,
    row_dimension,
)
from derive.rotor import Assembly, Call, Recipe, made
from derive.symbols import NUMBER, Dimension, dimension_of_unit

Dropped = frozenset[str]
Derivation = Callable[..., Any]

# Where AIAA-2002-1604 has the equation of each row of a blade.
ROW_EQUATION = {
    **dict.fromkeys(kin.HUB_TRANSLATION, "hub force, Eqs. 4-11"),
    **dict.fromkeys(kin.HUB_ROTATION, "hub moment, Eqs. 4-11"),
    "flap": "flap, Eqs. 12-13",
    "lag": "lag, as Eqs. 12-13",
    "pitch": "pitch, Eqs. 32-34",
    "azimuth": "rotor torque, Eq. 17",
    "gimbal_flap": "gimbal, Eqs. 1-3",
    "gimbal_roll": "gimbal, Eqs. 1-3",
}


@dataclass(frozen=True)
class Line:
    """A line of the catalogue: a function to generate, derived when it is asked for.

    `drops` says that a dropped term can change the function; the derivation then takes the names of dropped terms.
    """

    name: str
    drops: bool
    derive: Callable[[Dropped], Function]


@dataclass(frozen=True)
class Step:
    """A step of the derivation: the module generated from it, the module's title and a line for each function."""

    module: str
    title: str
    lines: tuple[Line, ...]
    template: str = "module.py.jinja"

    def line(self, name: str) -> Line:
        return next(line for line in self.lines if line.name == name)

    def derived(self, line: Line, dropped: Dropped) -> Function:
        return dataclasses.replace(line.derive(dropped), module=self.module)

    def changing(self, dropped: Dropped) -> list[Function]:
        """Derive the functions that a dropped term can change."""
        return [self.derived(line, dropped) for line in self.lines if line.drops]

    @property
    def changes(self) -> bool:
        """Whether a dropped term can change any function of the module."""
        return any(line.drops for line in self.lines)


def _without(derivation: Derivation, drops: bool, dropped: Dropped) -> Derivation:
    """Return the derivation without dropped terms, if dropped terms can change it."""
    return functools.partial(derivation, dropped=dropped) if drops else derivation


def _summary(derivation: Derivation) -> str:
    return (derivation.__doc__ or "").partition("\n")[0]


def values(
    name: str,
    derivation: Derivation,
    origin: str,
    returned: Iterable[sp.Symbol] | None = None,
    drops: bool = False,
) -> Line:
    """Make a function of named values: all steps of the derivation, or the steps of some symbols, in that order."""

    def derive(dropped: Dropped) -> Function:
        found = _without(derivation, drops, dropped)()
        steps = list(found.items() if isinstance(found, Mapping) else found)
        made = tuple(symbol for symbol, _ in steps)
        wanted = made if returned is None else tuple(symbol for symbol in returned if symbol in made)
        return Function("", name, _summary(derivation), origin, steps, values=wanted)

    return Line(name, drops, derive)


def matrix(
    name: str,
    derivation: Derivation,
    origin: str,
    rows: Iterable[str],
    columns: Iterable[str],
    dimension: DimensionOf,
    equation: Mapping[str, str] | str = "",
    drops: bool = False,
    **more: Any,
) -> Line:
    """Make a matrix, an entry for each row and column; `equation`, by row, replaces the origin above the entries."""
    rows, columns = tuple(rows), tuple(columns)

    def derive(dropped: Dropped) -> Function:
        value = _without(derivation, drops, dropped)
        found = function.entries(rows, columns, value, dimension, equation or origin)
        parts = {"summary": _summary(derivation)} | more
        return Function("", name, origin=origin, rows=rows, columns=columns, entries=found, **parts)

    return Line(name, drops, derive)


def column(
    name: str, derivation: Derivation, origin: str, rows: Iterable[str], equation: Mapping[str, str]
) -> Line:
    """Make one column: the virtual work in trim by row."""

    def entry(row: str, _: str) -> sp.Expr:
        return derivation(row)

    entry.__doc__ = derivation.__doc__
    return matrix(name, entry, origin, rows, ("trim",), lambda row, _: row_dimension(row), equation)


def blade_matrix(name: str, derivation: Derivation, order: int, drops: bool = False) -> Line:
    """Make a matrix of one blade in rotating axes; `order` counts the time derivatives of the column's coordinate."""
    rows = kin.COORDINATES

    def derive(dropped: Dropped) -> Function:
        value = _without(derivation, drops, dropped)
        found = function.entries(rows, rows, value, force_per(order), ROW_EQUATION)
        origin = "AIAA-2002-1604: " + "; ".join(dict.fromkeys(ROW_EQUATION[row] for row, _ in found))
        return Function("", name, _summary(derivation), origin, rows=rows, columns=rows, entries=found)

    return Line(name, drops, derive)


def rotor_matrix(name: str, derivation: Derivation, origin: str, order: int, **more: Any) -> Line:
    """Make a matrix of the rotor in the fixed frame; `order` counts the time derivatives of the column's coordinate."""
    parts = {
        "rows": multiblade.FIXED_COORDINATES,
        "columns": multiblade.FIXED_COORDINATES,
        "equation": "Eq. 17",
    }
    return matrix(name, derivation, origin, dimension=force_per(order), **parts | more)


def loads_matrix(name: str, derivation: Derivation, origin: str, columns: Iterable[str]) -> Line:
    """Make the generalised loads of a segment: steady loads, or loads per unit of the segment's motions."""

    def dimension(load: str, column: str) -> Dimension:
        return plus(LOAD[load].dimension, minus=MOTION[column].dimension if column in MOTION else NUMBER)

    return matrix(name, derivation, origin, names(SEGMENT_LOADS), columns, dimension)


def virtual_motion(rows: Iterable[str], drops: bool = False) -> Line:
    """Make W of a segment, for the rows of a balance."""
    origin = "virtual displacements of the sections, Eqs. 2-11"

    def dimension(load: str, row: str) -> Dimension:
        return plus(row_dimension(row), minus=LOAD[load].dimension)

    return matrix(
        "virtual_motion", airloads.virtual_motion, origin, names(SEGMENT_LOADS), rows, dimension, drops=drops
    )


def trim_velocity(derivation: Derivation = airloads.trim_velocity, drops: bool = False) -> Line:
    """Make the velocity of the air along a segment in trim."""
    motions = names(motion for motion in SEGMENT_MOTIONS if motion.argument != "theta")
    return matrix(
        "trim_velocity",
        derivation,
        "u_T and u_P of Eqs. 14-15 at trim",
        motions,
        ("trim",),
        lambda motion, _: MOTION[motion].dimension,
        drops=drops,
    )


def motion_matrix(
    name: str,
    derivation: Derivation,
    origin: str,
    columns: Iterable[str],
    order: int = 0,
    drops: bool = False,
) -> Line:
    """Make U of a segment for the motions in the columns, or for the rates of these motions (`order` 1)."""

    def dimension(motion: str, column: str) -> Dimension:
        return plus(MOTION[motion].dimension, per_time(order), minus=coordinate_dimension(column))

    return matrix(name, derivation, origin, names(SEGMENT_MOTIONS), columns, dimension, drops=drops)


def geometry_matrix(
    name: str,
    derivation: Derivation,
    origin: str,
    rows: Iterable[str],
    columns: Iterable[str] = (*kin.COORDINATES, "value"),
) -> Line:
    """Make numbers at trim, such as directions and angles, and their change with each coordinate."""

    def dimension(_: str, column: str) -> Dimension:
        return NUMBER if column == "value" else plus(NUMBER, minus=coordinate_dimension(column))

    return matrix(name, derivation, origin, rows, columns, dimension)


def arms_matrix(name: str, derivation: Derivation, origin: str, rows: tuple[str, ...], mass: int = 0) -> Line:
    """Make what is linear in the arms of a blade, or with `mass` integrals of the mass times two arms."""

    def length(name: str) -> int:
        return {"hub_arm": 0, "at_center": 0, "per_radius": -1}.get(name, 1)

    def dimension(row: str, column: str) -> Dimension:
        return mass, length(row) + length(column), 0

    return matrix(name, derivation, origin, rows, moving.ARM_NAMES, dimension)


def work_matrix(
    name: str,
    derivation: Derivation,
    origin: str,
    rows: Iterable[str],
    columns: Iterable[str],
    equation: Mapping[str, str] | str = "",
    drops: bool = False,
) -> Line:
    """Make the change of the rows' virtual work with the coordinates of the columns."""
    return matrix(name, derivation, origin, rows, columns, force_per(0), equation, drops)


def product(
    name: str,
    summary: str,
    products: Callable[[], Mapping[str, sp.MatrixExpr]] = airloads.products,
    origin: str = "virtual work of Eqs. 12 and 32",
) -> Line:
    """Make the sum over the segments of a blade that gives one of the blade's matrices."""
    return Line(name, False, lambda _: Function("", name, summary, origin, product=products()[name]))


def circulation_matrix(name: str, derivation: Derivation, origin: str) -> Line:
    """Make the change of a segment's circulation in one shape function, per unit of the segment's motions."""

    def dimension(_: str, motion: str) -> Dimension:
        return plus((0, 4, -2), minus=MOTION[motion].dimension)

    return matrix(name, derivation, origin, ("circulation",), names(SEGMENT_MOTIONS), dimension)


def circulation_loads(name: str, derivation: Derivation, origin: str) -> Line:
    """Make the generalised loads of a segment per unit of U c_l in one shape function."""

    def dimension(load: str, _: str) -> Dimension:
        return plus(LOAD[load].dimension, minus=(0, 1, -1))

    return matrix(name, derivation, origin, names(SEGMENT_LOADS), ("circulation",), dimension)


def inflow_work(name: str, derivation: Derivation, origin: str) -> Line:
    """Make W of the inflow of a segment: what loads of the segment add to the loads that make the inflow."""

    def dimension(load: str, _: str) -> Dimension:
        return plus(FORCE, minus=LOAD[load].dimension)

    return matrix(name, derivation, origin, names(SEGMENT_LOADS), names(BLADE_INFLOW), dimension)


def inflow_stiffness(name: str, derivation: Derivation, origin: str) -> Line:
    """Make the change of the loads that make the inflow with the coordinates of a blade, of one segment."""

    def dimension(_: str, column: str) -> Dimension:
        return plus(FORCE, minus=coordinate_dimension(column))

    return matrix(name, derivation, origin, names(BLADE_INFLOW), kin.COORDINATES, dimension)


def reactionless_matrix(name: str, kind: str, order: int, motions: tuple[Coordinate, ...]) -> Line:
    """Make a matrix of motions of the blades that do not reach the hub."""
    told = "motion of neighbouring blades against each other, even N"
    if motions == REACTIONLESS_PAIR:
        told = "motions of a harmonic whose sum over the blades vanishes"
    return matrix(
        name,
        functools.partial(multiblade.reactionless, kind),
        "multiblade coordinates beyond Eq. 17, for more than three blades",
        names(motions),
        names(motions),
        force_per(order),
        "blade angles beyond Eq. 17",
        summary=f"{kind.capitalize()} matrix of the {told}.",
        blade_matrices=("mass", "damping", "stiffness")[: 3 - order],
    )


def assembly(name: str, recipe: Recipe, origin: str, find: Callable[[str], Call]) -> Line:
    """Make a function that calls other functions of the catalogue; `find` looks them up by module and name."""

    def derive(_: Dropped) -> Function:
        return Assembly(
            "",
            name,
            recipe.summary,
            origin,
            blade_matrices=recipe.blade_matrices,
            lines=made(recipe.lines, find),
            results=recipe.results,
            segments=recipe.segments,
        )

    return Line(name, False, derive)


def transform_matrix(name: str, derivation: Derivation, origin: str) -> Line:
    """Make the coordinates of a blade from the coordinates of the rotor."""
    return matrix(
        name,
        derivation,
        origin,
        kin.COORDINATES,
        multiblade.FIXED_COORDINATES,
        lambda row, column: plus(coordinate_dimension(row), minus=coordinate_dimension(column)),
        row_prefix="BLADE_",
    )


def element_matrix(name: str, derivation: Derivation, origin: str, order: int) -> Line:
    """Make a matrix of a beam element; `order` counts the time derivatives of the column's motion."""

    def dimension(row: str, column: str) -> Dimension:
        motions = plus(beam.dimension_of_motion(row), beam.dimension_of_motion(column))
        return plus(MOMENT, per_time(order), minus=motions)

    return matrix(name, derivation, origin, beam.COORDINATES, beam.COORDINATES, dimension)


def element_motion(name: str, derivation: Derivation, origin: str) -> Line:
    """Make the motion of a section of a beam element from the motions of its ends."""

    def dimension(axis: str, column: str) -> Dimension:
        return plus(beam.dimension_of_motion(axis), minus=beam.dimension_of_motion(column))

    return matrix(name, derivation, origin, beam.AXES, beam.COORDINATES, dimension)


def station_matrix(name: str, derivation: Derivation, origin: str, order: int) -> Line:
    """Make a matrix of a blade element per length; `order` counts the time derivatives of the column's motion."""

    def dimension(row: str, column: str) -> Dimension:
        motions = plus(blade_element.dimension_of_motion(row), blade_element.dimension_of_motion(column))
        return plus(dimension_of_unit("N"), per_time(order), minus=motions)

    return matrix(name, derivation, origin, blade_element.COORDINATES, blade_element.COORDINATES, dimension)


def station_motion(name: str, derivation: Derivation, origin: str) -> Line:
    """Make displacements and slopes of a station of a blade element from the motions of its ends."""

    def dimension(row: str, column: str) -> Dimension:
        return plus(blade_element.dimension_of_motion(row), minus=blade_element.dimension_of_motion(column))

    return matrix(name, derivation, origin, blade_element.MOTIONS, blade_element.COORDINATES, dimension)
