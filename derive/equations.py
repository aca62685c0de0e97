"""The intermediate form: every function to be generated, its entries with their equation, unit and dimension.

Nothing is printed here and nothing is derived here. `derive.emit` turns these records into NumPy modules; the audit and
the notebooks read the same records.
"""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

import sympy as sp

from derive import (
    airloads,
    drive_train,
    flap_lag_springs,
    inertia,
    lift_slope,
    multiblade,
    pitch,
    section,
    trim,
)
from derive import kinematics as kin
from derive import symbols as s
from derive.published import CONSISTENT, PUBLISHED
from derive.symbols import NUMBER, QUANTITIES, Dimension

FORCE: Dimension = (1, 1, -2)
MOMENT: Dimension = (1, 2, -2)
LENGTH: Dimension = (0, 1, 0)
PER_SECOND: Dimension = (0, 0, -1)

Steps = Iterable[tuple[sp.Symbol, sp.Expr]]
Names = Collection[str]
# Of the entry of a row and a column, by their names.
ValueOf = Callable[[str, str], sp.Expr]
DimensionOf = Callable[[str, str], Dimension]

# Where the paper has the equation of each row (AIAA-2002-1604).
ROW_EQUATION = {
    **dict.fromkeys(kin.HUB_TRANSLATION, "hub force, Eqs. 4-11"),
    **dict.fromkeys(kin.HUB_ROTATION, "hub moment, Eqs. 4-11"),
    "flap": "flap, Eqs. 12-13",
    "lag": "lag, as Eqs. 12-13",
    "pitch": "pitch, Eqs. 32-34",
    "azimuth": "rotor torque, Eq. 17",
    "gimbal_flap": "gimbal, Eqs. 1-3",
    "gimbal_roll": "gimbal, Eqs. 1-3",
    "hub_k": "hub force, Eqs. 4-11",
}
FIXED_EQUATION = dict.fromkeys(multiblade.FIXED_COORDINATES, "Eq. 17")


class DimensionError(ValueError):
    """A term whose dimension is not that of its entry."""


@dataclass(frozen=True)
class Entry:
    """One entry of a matrix or one value: the expression, where it comes from, and its dimension."""

    value: sp.Expr
    equation: str
    dimension: Dimension


@dataclass(frozen=True)
class Function:
    """A function to generate: temporaries, then named values, the entries of a matrix, or a matrix product.

    `blade_matrices` are whole-matrix arguments whose entries the expressions index; a `product` is summed over the
    blade's segments. A `signature` is that of the consistent function a published one stands in for.
    """

    module: str
    name: str
    summary: str
    origin: str
    steps: list[tuple[sp.Symbol, sp.Expr]] = field(default_factory=list)
    values: tuple[sp.Symbol, ...] = ()
    rows: tuple[str, ...] = ()
    columns: tuple[str, ...] = ()
    entries: dict[tuple[str, str], Entry] = field(default_factory=dict)
    blade_matrices: tuple[str, ...] = ()
    product: sp.MatrixExpr | None = None
    signature: tuple[sp.Symbol, ...] | None = None

    @property
    def arguments(self) -> list[sp.Symbol]:
        """Keyword arguments: those the expressions need, or a wider signature they share with another set."""
        return list(self.signature) if self.signature is not None else self.needed

    @property
    def needed(self) -> list[sp.Symbol]:
        """Free symbols in the order of their declaration; one that is no declared quantity is refused."""
        if self.product is not None:
            return sorted(self.product.atoms(sp.MatrixSymbol), key=lambda matrix: matrix.name)
        known = {symbol for symbol, _ in self.steps}
        expressions = [value for _, value in self.steps] + [entry.value for entry in self.entries.values()]
        free = set().union(*(expression.free_symbols for expression in expressions)) if expressions else set()
        free = {symbol for symbol in free if not isinstance(symbol, sp.Indexed)} - _INDEX_SYMBOLS
        free -= known
        unknown = free - set(QUANTITIES)
        if unknown:
            raise ValueError(
                f"{self.module}.{self.name} uses symbols that are no argument: {sorted(map(str, unknown))}"
            )
        return [symbol for symbol in QUANTITIES if symbol in free]

    def check_dimensions(self) -> None:
        """Raise DimensionError unless every step and entry has its symbol's or its entry's dimension."""
        for symbol, value in self.steps:
            _require(value, QUANTITIES[symbol].dimension, f"{self.module}.{self.name}: {symbol}")
        for place, entry in self.entries.items():
            _require(entry.value, entry.dimension, f"{self.module}.{self.name}: {place}")


def _require(expression: sp.Expr, dimension: Dimension, where: str) -> None:
    found = dimension_of(expression, where)
    if expression != 0 and found != dimension:
        raise DimensionError(f"{where} has dimension {found}, not {dimension}: {expression}")


def dimension_of(expression: sp.Expr, where: str = "") -> Dimension:
    """Dimension of an expression; all terms of a sum must agree and functions take numbers."""
    if expression.is_number:
        return NUMBER
    if isinstance(expression, sp.Indexed):
        return _blade_entry_dimension(expression)
    if expression.is_Symbol:
        return QUANTITIES[expression].dimension
    if expression.is_Add:
        dimensions = {dimension_of(term, where) for term in expression.args}
        if len(dimensions) != 1:
            raise DimensionError(f"{where}: terms of different dimension in {expression}")
        return dimensions.pop()
    if expression.is_Mul:
        return tuple(
            sum(parts) for parts in zip(*(dimension_of(a, where) for a in expression.args), strict=True)
        )
    if expression.is_Pow:
        exponent = expression.exp
        return tuple(d * exponent for d in dimension_of(expression.base, where))
    for argument in expression.args:
        _require(argument, NUMBER, where)
    return NUMBER


def _plus(*dimensions: Dimension, minus: Dimension = NUMBER) -> Dimension:
    return tuple(sum(parts) - m for *parts, m in zip(*dimensions, minus, strict=True))


def coordinate_dimension(name: str) -> Dimension:
    return LENGTH if name in kin.HUB_TRANSLATION or name in ("x", "y", "z") else NUMBER


def row_dimension(name: str) -> Dimension:
    """Virtual work per unit of the row's coordinate."""
    return FORCE if coordinate_dimension(name) == LENGTH else MOMENT


# Names that stand for whole matrices and places in them, not for quantities.
_INDEX_SYMBOLS = {*multiblade.BLADE_INDEX.values(), *multiblade.GUST_INDEX.values()}
_INDEX_SYMBOLS |= {
    base.label for base in (multiblade.MASS, multiblade.DAMPING, multiblade.STIFFNESS, multiblade.GUSTS)
}
_TIME_ORDER = {multiblade.MASS: 2, multiblade.DAMPING: 1, multiblade.STIFFNESS: 0}


def _blade_entry_dimension(entry: sp.Indexed) -> Dimension:
    """Dimension of an entry of a blade's mass, damping or stiffness matrix, or of its gust loads."""
    names = {symbol: name for name, symbol in multiblade.BLADE_INDEX.items()}
    row, column = entry.indices
    if entry.base == multiblade.GUSTS:
        return _plus(row_dimension(names[row]), minus=(0, 1, -1))
    order = _per_time(_TIME_ORDER[entry.base])
    return _plus(row_dimension(names[row]), order, minus=coordinate_dimension(names[column]))


def _per_time(order: int) -> Dimension:
    return (0, 0, order)


def _force_per(order: int) -> DimensionOf:
    """Of a matrix that takes a derivative of the coordinates, of some order in time, to forces."""

    def dimension(row: str, column: str) -> Dimension:
        return _plus(row_dimension(row), _per_time(order), minus=coordinate_dimension(column))

    return dimension


def _entries(
    rows: Names, columns: Names, value: ValueOf, dimension: DimensionOf, equation: Mapping[str, str] | str
) -> dict[tuple[str, str], Entry]:
    entries = {}
    for row in rows:
        for column in columns:
            expression = value(row, column)
            if expression != 0:
                origin = equation if isinstance(equation, str) else equation[row]
                entries[row, column] = Entry(expression, origin, dimension(row, column))
    return entries


def blade_matrix(module: str, name: str, summary: str, value: ValueOf, order: int) -> Function:
    """A matrix of one blade in rotating axes; `order` counts the time derivatives of the column's coordinate."""
    coordinates = kin.COORDINATES
    entries = _entries(coordinates, coordinates, value, _force_per(order), ROW_EQUATION)
    origin = "AIAA-2002-1604: " + "; ".join(dict.fromkeys(ROW_EQUATION[row] for row, _ in entries))
    return Function(module, name, summary, origin, rows=coordinates, columns=coordinates, entries=entries)


def values(
    module: str,
    name: str,
    summary: str,
    origin: str,
    steps: Steps,
    returned: tuple[sp.Symbol, ...] | None = None,
) -> Function:
    """A function that returns named values: all of its steps, if not some."""
    steps = list(steps)
    returned = tuple(symbol for symbol, _ in steps) if returned is None else returned
    return Function(module, name, summary, origin, steps, values=returned)


def inertia_shared() -> Iterator[Function]:
    yield values(
        "inertia",
        "dependent_inertias",
        "Three mass integrals that follow from the others and the hinge offsets.",
        "AIAA-2002-1604, nomenclature: integrals over the blade outboard of each hinge",
        list(inertia.dependent_inertias().items()),
    )


def inertia_functions(dropped: frozenset[str] = CONSISTENT) -> Iterator[Function]:
    blade = inertia.BladeInertia(dropped)
    yield values(
        "inertia",
        "trim_integrals",
        "Sines and cosines of the trim angles, and the mass integrals over the arms of the deflected blade.",
        "the blade's reference line with precone, coning and lag, Eq. 2",
        list(inertia.trim_integrals(dropped).items()),
    )
    yield blade_matrix("inertia", "mass", "Mass matrix of one blade in rotating axes.", blade.mass, 2)
    yield blade_matrix(
        "inertia",
        "gyroscopic",
        "Gyroscopic (Coriolis) matrix of one blade in rotating axes.",
        blade.gyroscopic,
        1,
    )
    yield blade_matrix(
        "inertia",
        "centrifugal_stiffness",
        "Centrifugal stiffness of one blade in rotating axes.",
        blade.centrifugal,
        0,
    )


def spring_shared() -> Iterator[Function]:
    yield values(
        "flap_lag_springs",
        "effective_stiffness",
        "Hub and blade springs in series, and their derivatives with structural pitch.",
        "AIAA-2002-1604, Eqs. 18-31",
        flap_lag_springs.effective_stiffness(),
        tuple(flap_lag_springs.STIFFNESS.values()),
    )
    yield values(
        "flap_lag_springs",
        "stiffness_of_frequencies",
        "Diagonal stiffness of given rotating frequencies, and what cyclic flapping has above collective.",
        "AIAA-2002-1604, nomenclature: flap and lag frequency",
        flap_lag_springs.stiffness_of_frequencies(),
    )


def spring_functions(dropped: frozenset[str] = CONSISTENT) -> Iterator[Function]:
    yield blade_matrix(
        "flap_lag_springs",
        "stiffness",
        "Stiffness of one blade's flap and lag springs, which turn with its pitch.",
        lambda i, j: flap_lag_springs.stiffness(i, j, dropped),
        0,
    )


def pitch_shared() -> Iterator[Function]:
    yield blade_matrix(
        "pitch", "damping", "Dampers of one blade and its share of the gimbal's.", pitch.damping, 1
    )
    yield values(
        "pitch",
        "couplings",
        "Pitch-flap and pitch-lag coupling of the control system's flexibility.",
        "AIAA-2002-1604, Eqs. 33-37",
        list(pitch.couplings().items()),
    )


def pitch_functions(dropped: frozenset[str] = CONSISTENT) -> Iterator[Function]:
    yield blade_matrix(
        "pitch", "mass", "Pitch inertia of one blade, lumped.", lambda i, j: pitch.mass(i, j, dropped), 2
    )
    yield blade_matrix(
        "pitch",
        "stiffness",
        "Control system, propeller moment, and one blade's share of the gimbal spring and damper.",
        lambda i, j: pitch.stiffness(i, j, dropped),
        0,
    )


def section_shared() -> Iterator[Function]:
    yield values(
        "section",
        "air_at_section",
        "Speed and direction of the air, angle of attack and Mach number of a section.",
        "quasi-steady strip theory, as NASA TN D-7677",
        section.air_at_section(),
    )
    yield values(
        "section",
        "prandtl_glauert",
        "Prandtl-Glauert factor and its derivative with Mach number; Mach below 1.",
        "Prandtl-Glauert similarity rule",
        section.prandtl_glauert(),
    )
    for name, summary, loads in (
        ("forces", "Forces of a section per unit span", section.FORCES),
        ("pitching_moment", "Pitching moment of a section per unit span", ("m",)),
    ):
        yield values(
            "section",
            name,
            f"{summary} and derivatives with the air's velocity and the pitch.",
            "quasi-steady strip theory, as NASA TN D-7677",
            section.steps_of(loads),
            tuple(symbol for (load, _), symbol in section.SECTION_LOADS.items() if load in loads),
        )
    yield values(
        "section",
        "steady_forces",
        "Forces of a section per unit span, without derivatives.",
        "quasi-steady strip theory, as NASA TN D-7677",
        section.steady_steps(),
        tuple(section.SECTION_LOADS[load, ""] for load in section.FORCES),
    )


_SEGMENT_ROW = {"x_0": LENGTH, "n_0": LENGTH, "d_0": LENGTH, "rotation": NUMBER}
_SEGMENT_MOTION_DIMENSION = {
    motion: NUMBER if motion == "theta" else ((0, 1, -1) if motion.endswith("_0") else PER_SECOND)  # spin too
    for motion in airloads.SEGMENT_MOTION
}


def _segment_matrix(
    name: str,
    summary: str,
    rows: Names,
    columns: Names,
    value: ValueOf,
    dimension: DimensionOf,
    origin: str,
) -> Function:
    return Function(
        "airloads",
        name,
        summary,
        origin,
        rows=tuple(rows),
        columns=tuple(columns),
        entries=_entries(rows, columns, value, dimension, origin),
    )


def _virtual_motion(name: str, rows: Names, dropped: frozenset[str]) -> Function:
    return _segment_matrix(
        name,
        "W: displacement at r = 0 and per unit radius along i', n, d, and rotation about d, of a segment for each row.",
        airloads.SEGMENT_LOADS,
        rows,
        lambda load, row: airloads.virtual_motion(row, load, dropped),
        lambda load, row: _plus(_SEGMENT_ROW.get(load, NUMBER), minus=coordinate_dimension(row)),
        "virtual displacements of the sections, Eqs. 2-11",
    )


def _motion_matrix(name: str, summary: str, columns: Names, value: ValueOf, order: int) -> Function:
    return _segment_matrix(
        name,
        summary,
        airloads.SEGMENT_MOTION,
        columns,
        value,
        lambda motion, column: _plus(
            _SEGMENT_MOTION_DIMENSION[motion], _per_time(order), minus=coordinate_dimension(column)
        ),
        "perturbation velocities and pitch, Eqs. 14-16",
    )


def _unknowns(value: ValueOf) -> ValueOf:
    """The same for trim unknowns; couplings act on perturbations from trim alone."""
    no_coupling = {s.pitch_flap_coupling: 0, s.pitch_lag_coupling: 0}
    return lambda motion, unknown: value(motion, trim.blade_coordinate(unknown)).subs(no_coupling)


def airload_functions(dropped: frozenset[str] = CONSISTENT) -> Iterator[Function]:
    yield values(
        "airloads",
        "segment_geometry",
        "Trim geometry of a straight segment between hinges: sines and cosines, its line and its flap arm.",
        "the blade's reference line with precone, coning and lag, Eq. 2",
        airloads.segment_geometry(dropped),
    )
    yield _segment_matrix(
        "trim_velocity",
        "Trim velocity of the air at r = 0 and per unit radius, along a segment, and the sections' rotation.",
        tuple(motion for motion in airloads.SEGMENT_MOTION if motion != "theta"),
        ("trim",),
        lambda motion, _: airloads.trim_velocity(motion, dropped),
        lambda motion, _: _SEGMENT_MOTION_DIMENSION[motion],
        "u_T and u_P of Eqs. 14-15 at trim",
    )
    yield _virtual_motion("virtual_motion", kin.COORDINATES, dropped)
    yield _motion_matrix(
        "rate_motion",
        "U for rates: velocity of the air along a segment for the rate of each coordinate.",
        kin.COORDINATES,
        lambda motion, name: airloads.rate_motion(motion, name, dropped),
        1,
    )
    yield _motion_matrix(
        "displacement_motion",
        "U for displacements: velocity of the air along a segment, and pitch, for each coordinate.",
        kin.COORDINATES,
        lambda motion, name: airloads.displacement_motion(motion, name, dropped),
        0,
    )
    yield _segment_matrix(
        "gust_motion",
        "U for gusts: velocity of the air along a segment for air that moves along the rotating axes.",
        airloads.SEGMENT_MOTION,
        airloads.GUSTS,
        lambda motion, gust: airloads.gust_motion(motion, gust, dropped),
        lambda motion, gust: NUMBER,
        "perturbation velocities, Eqs. 14-15, of moving air",
    )
    yield _segment_matrix(
        "geometric_stiffness",
        "G: change of the steady airloads' virtual work with each coordinate, of one segment.",
        kin.COORDINATES,
        kin.COORDINATES,
        lambda row, name: airloads.geometric_stiffness(row, name, dropped),
        _force_per(0),
        "steady loads on the moving blade, beyond Eqs. 14-16",
    )


def lift_slope_shared() -> Iterator[Function]:
    moments = lift_slope.moments()
    yield values(
        "lift_slope",
        "load_moments",
        "Radial moments of the section derivatives proportional to the lift slope, over one segment, in closed form.",
        "u_T = Omega r and u_P = V, constant chord, no compressibility, as NASA TN D-7677; valid down to V = 0",
        [*lift_slope.ends(), *lift_slope.integrals(), *moments],
        tuple(symbol for symbol, _ in moments),
    )


def airload_shared() -> Iterator[Function]:
    yield _segment_matrix(
        "load_derivatives",
        "L: generalised loads of a segment per unit of its motions, from radial moments of the section's derivatives.",
        airloads.SEGMENT_LOADS,
        airloads.SEGMENT_MOTION,
        _load_derivative,
        lambda load, motion: _plus(
            FORCE if load.endswith("_0") else MOMENT, minus=_SEGMENT_MOTION_DIMENSION[motion]
        ),
        "strip theory on a straight segment, as NASA TN D-7677",
    )
    yield _segment_matrix(
        "steady_loads",
        "Steady generalised loads of a segment.",
        airloads.SEGMENT_LOADS,
        ("trim",),
        lambda load, _: airloads.steady_load(load),
        lambda load, _: FORCE if load.endswith("_0") else MOMENT,
        "strip theory on a straight segment",
    )
    summaries = {
        "damping": "Airload damping of one blade in rotating axes, C = - sum W^T L U.",
        "stiffness": "Airload stiffness of one blade in rotating axes, K = - sum W^T L U - G.",
        "gust_loads": "Loads of gusts on one blade in rotating axes, on the right of the equations of motion.",
        "steady_work": "Virtual work of the steady airloads of one blade, one column.",
    }
    for name, product in airloads.products().items():
        yield Function("airloads", name, summaries[name], "virtual work of Eqs. 12 and 32", product=product)


def _load_derivative(load: str, motion: str) -> sp.Expr:
    """The moment that L holds, or nothing where the section has no such derivative."""
    name = "m" if load == "rotation" else f"f{load[0]}"
    argument = f"_{motion}" if motion in ("theta", "spin") else f"_{motion[:2]}"
    if section.load_derivatives()[section.SECTION_LOADS[name, argument]] == 0:
        return sp.Integer(0)
    return airloads.load_derivative(load, motion)


def trim_shared() -> Iterator[Function]:
    columns = {"flap": "flap", "lag": "lag", "pitch": "pitch", "collective": "pitch"}
    yield Function(
        "trim",
        "residual",
        "Steady balance of one blade without airloads: flap, lag, pitch moment, torque and thrust.",
        "AIAA-2002-1604, Eqs. 12 and 32, steady part",
        rows=trim.STEADY_ROWS,
        columns=("trim",),
        entries=_entries(
            trim.STEADY_ROWS,
            ("trim",),
            lambda row, _: trim.residual(row),
            lambda row, _: row_dimension(row),
            ROW_EQUATION,
        ),
    )
    yield Function(
        "trim",
        "precone_load",
        "Steady centrifugal load of precone on the undeflected blade: flap, lag and pitch moment.",
        "AIAA-2002-1604, Eqs. 12 and 32, steady part",
        rows=trim.HINGED,
        columns=("trim",),
        entries=_entries(
            trim.HINGED,
            ("trim",),
            lambda row, _: trim.precone_load(row),
            lambda row, _: row_dimension(row),
            ROW_EQUATION,
        ),
    )
    yield Function(
        "trim",
        "jacobian",
        "Derivative of the residual with coning, lag, elastic pitch and collective, without airloads.",
        "AIAA-2002-1604, Eqs. 12 and 32, differentiated",
        rows=trim.STEADY_ROWS,
        columns=tuple(columns),
        entries=_entries(
            trim.STEADY_ROWS, columns, trim.jacobian, lambda row, _: row_dimension(row), ROW_EQUATION
        ),
    )
    for function in (
        _virtual_motion("virtual_motion", trim.STEADY_ROWS, CONSISTENT),
        _motion_matrix(
            "displacement_motion",
            "U for the unknowns: velocity of the air along a segment, and pitch.",
            tuple(columns),
            _unknowns(airloads.displacement_motion),
            0,
        ),
        _segment_matrix(
            "geometric_stiffness",
            "G for the unknowns: change of the steady airloads' virtual work, of one segment.",
            trim.STEADY_ROWS,
            tuple(columns),
            _unknowns(airloads.geometric_stiffness),
            lambda row, _: row_dimension(row),
            "steady loads on the moving blade",
        ),
    ):
        yield dataclasses.replace(function, module="trim")


def multiblade_shared() -> Iterator[Function]:
    places = {name: place for place, name in enumerate(multiblade.FIXED_COORDINATES)}

    def placed(value: Callable[[int, int], sp.Expr]) -> ValueOf:
        return lambda row, column: value(places[row], places[column])

    for name, value, order, summary in (
        ("mass", multiblade.mass, 2, "Mass matrix of the rotor in the fixed frame."),
        ("damping", multiblade.damping, 1, "Damping and gyroscopic matrix of the rotor in the fixed frame."),
        ("stiffness", multiblade.stiffness, 0, "Stiffness matrix of the rotor in the fixed frame."),
    ):
        entries = _entries(
            multiblade.FIXED_COORDINATES,
            multiblade.FIXED_COORDINATES,
            placed(value),
            _force_per(order),
            FIXED_EQUATION,
        )
        yield Function(
            "multiblade",
            name,
            summary,
            "AIAA-2002-1604, Eqs. 7-9 and 17: sum over N blades, any N of at least 3",
            rows=multiblade.FIXED_COORDINATES,
            columns=multiblade.FIXED_COORDINATES,
            entries=entries,
            blade_matrices=("mass", "damping", "stiffness")[: 3 - order],
        )

    yield Function(
        "multiblade",
        "gust_loads",
        "Loads on the rotor's coordinates per unit of gusts, on the right of the equations of motion.",
        "AIAA-2002-1604, Eqs. 7-9 and 17: sum over N blades",
        rows=multiblade.FIXED_COORDINATES,
        columns=multiblade.FIXED_GUSTS,
        entries=_entries(
            multiblade.FIXED_COORDINATES,
            multiblade.FIXED_GUSTS,
            lambda row, column: multiblade.gust_loads(places[row], multiblade.FIXED_GUSTS.index(column)),
            lambda row, _: _plus(row_dimension(row), minus=(0, 1, -1)),
            FIXED_EQUATION,
        ),
        blade_matrices=("gusts",),
    )
    yield from reactionless_functions()
    excess = flap_lag_springs.cyclic_flap_stiffness_excess
    yield Function(
        "multiblade",
        "cyclic_restraint",
        "Stiffness that only cyclic flapping feels, for cyclic and collective frequencies given apart.",
        "separate cyclic and collective flap frequencies, as NASA TN D-7677",
        rows=multiblade.FIXED_COORDINATES,
        columns=multiblade.FIXED_COORDINATES,
        entries=_entries(
            multiblade.FIXED_COORDINATES,
            multiblade.FIXED_COORDINATES,
            placed(lambda row, column: multiblade.cyclic_restraint(row, column, excess)),
            lambda row, column: MOMENT,
            FIXED_EQUATION,
        ),
    )


def reactionless_functions() -> Iterator[Function]:
    summaries = {
        "reactionless": (
            "motions of a harmonic whose sum over the blades vanishes",
            multiblade.REACTIONLESS_PAIR,
        ),
        "differential": ("motion of neighbouring blades against each other, even N", multiblade.DIFFERENTIAL),
    }
    for prefix, (summary, names) in summaries.items():
        for kind, order in (("mass", 2), ("damping", 1), ("stiffness", 0)):
            yield Function(
                "multiblade",
                f"{prefix}_{kind}",
                f"{kind.capitalize()} matrix of the {summary}.",
                "multiblade coordinates beyond Eq. 17, for more than three blades",
                rows=names,
                columns=names,
                entries=_entries(
                    names,
                    names,
                    functools.partial(multiblade.reactionless, kind),
                    _force_per(order),
                    "blade angles beyond Eq. 17",
                ),
                blade_matrices=("mass", "damping", "stiffness")[: 3 - order],
            )


def drive_train_shared() -> Iterator[Function]:
    for kind, order in (("mass", 2), ("damping", 1), ("stiffness", 0)):
        yield Function(
            "drive_train",
            kind,
            f"{kind.capitalize()} that engine and shaft add to the rotor in the fixed frame.",
            "energies of engine and shaft on the azimuth of Eq. 17",
            rows=multiblade.FIXED_COORDINATES,
            columns=multiblade.FIXED_COORDINATES,
            entries=_entries(
                multiblade.FIXED_COORDINATES,
                multiblade.FIXED_COORDINATES,
                functools.partial(drive_train.matrix, kind),
                _force_per(order),
                FIXED_EQUATION,
            ),
        )


def _nothing(dropped: frozenset[str] = CONSISTENT) -> Iterator[Function]:
    """A module that is the same in both sets of equations."""
    return iter(())


# In the order of the derivation: what both sets of equations share, and what a dropped term can change.
STEPS = {
    "inertia": (inertia_shared, inertia_functions),
    "flap_lag_springs": (spring_shared, spring_functions),
    "pitch": (pitch_shared, pitch_functions),
    "section": (section_shared, _nothing),
    "airloads": (airload_shared, airload_functions),
    "lift_slope": (lift_slope_shared, _nothing),
    "trim": (trim_shared, _nothing),
    "multiblade": (multiblade_shared, _nothing),
    "drive_train": (drive_train_shared, _nothing),
}


@functools.cache
def _consistent(changing: Callable[..., Iterator[Function]]) -> tuple[Function, ...]:
    return tuple(changing())


def consistent_functions(module: str) -> list[Function]:
    """All functions of a module, with every first-order term."""
    shared, changing = STEPS[module]
    return [*shared(), *_consistent(changing)]


def reduced_functions(module: str, dropped: frozenset[str] = PUBLISHED) -> list[Function]:
    """The functions that dropped terms can change, without those terms, under the consistent signatures."""
    _, changing = STEPS[module]
    signatures = {function.name: tuple(function.arguments) for function in _consistent(changing)}
    return [
        dataclasses.replace(function, signature=signatures[function.name]) for function in changing(dropped)
    ]


REDUCED_MODULES = tuple(module for module, (_, changing) in STEPS.items() if changing is not _nothing)
