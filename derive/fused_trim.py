"""The trim of a blade as plans of operations, from the same functions of the catalogue as the readable modules.

Nothing is derived here. The plans follow each other in a step of Newton's method: `line` is where a segment is and how
the air meets it, `section_loads` are the loads of the sections along it, `work` is what these loads do in the balances,
and `balance` is the rest of the balances.

A section has a straight lift line here, with the Prandtl-Glauert factor. Without compressibility the speed of sound is
infinite.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import sympy as sp

from derive import airloads, lift_slope, section
from derive import symbols as s
from derive.coordinates import SEGMENT_LOADS, SEGMENT_MOTIONS, names
from derive.fused import FusedFunction, Group, arguments, named_values, sum_of
from derive.plain import Catalogue, entries_of
from derive.plan import Matrix, Place, Steps, plan, without_other_names
from derive.trim import HINGED, STEADY_ROWS

zero_lift_angle = s.quantity("zero_lift_angle", r"\alpha_0", "rad", "angle of attack without lift")
square_ratio = s.quantity(
    "square_ratio", "k_2", "", "effective square of the chord over the square of the effective chord"
)
cube_ratio = s.quantity(
    "cube_ratio", "k_3", "", "effective cube of the chord over the cube of the effective chord"
)

_COEFFICIENT, _DAMPING = section.COEFFICIENT, section.section_damping
_ALONG_LINES = ("virtual_motion", "displacement_motion", "geometric_stiffness")
_LOADS, _MOTIONS = names(SEGMENT_LOADS), names(SEGMENT_MOTIONS)


def line(rotors: Catalogue) -> FusedFunction:
    """Geometry of a segment at trim, and the velocity of the air at r = 0 and per unit radius along it."""
    geometry = rotors.function("airloads", "segment_geometry").steps
    velocity = rotors.entries("airloads", "trim_velocity")
    air = [(sp.Symbol(row, real=True), value) for (row, _), value in velocity.items()]
    used = {symbol for name in _ALONG_LINES for symbol in rotors.function("trim", name).needed}
    wanted = [symbol.name for symbol, _ in [*(step for step in geometry if step[0] in used), *air]]
    made = plan([*geometry, *air], {}, wanted)
    return FusedFunction("line", _summary(line), made, arguments(made, [*geometry, *air]))


def section_loads(rotors: Catalogue) -> FusedFunction:
    """Loads of a section with a straight lift line per unit span, their derivatives, and two numbers for doubts."""
    steps, _ = without_other_names(rotors.steps(_steps_of_section(rotors)))
    known = {symbol for symbol, _ in steps}
    wanted = [symbol.name for symbol in section.SECTION_LOADS.values() if symbol in known]
    wanted += [section.lift_incidence.name, section.mach.name]
    made = plan(steps, {}, wanted, short_lived=True)
    return FusedFunction("section_loads", _summary(section_loads), made, arguments(made, steps), into=True)


def _steps_of_section(rotors: Catalogue) -> list[tuple[sp.Symbol, sp.Expr]]:
    """Return the steps to the loads of a section about its pitch axis, whose aerodynamic centre may lie beside it."""
    if section.center_along in rotors.absent:
        return _steps_to_center(section.air_at_section())
    about = {
        symbol: value for symbol, value in section.about_axis().items() if value != section.AT_CENTER[symbol]
    }
    at_center = {symbol: section.AT_CENTER[symbol] for symbol in about}
    alike = {center: symbol for symbol, center in section.AT_CENTER.items() if symbol not in about}
    air = section.air_beside_axis()[2:]  # the place of the centre is given
    own = [(at_center.get(symbol, symbol), value) for symbol, value in _steps_to_center(air)]
    return [*own, *_replaced(list(about.items()), alike)]


def _steps_to_center(air: Steps) -> list[tuple[sp.Symbol, sp.Expr]]:
    """Return the steps to the loads of an aerodynamic centre; powers of the chord have effective values of their own.

    The derivative g' of the Prandtl-Glauert factor comes as the Mach number times g'/g, which is g² - 1.
    """
    lift, moment, growth = (sp.Symbol(name, real=True) for name in ("straight_lift", "own_moment", "growth"))
    factor, mach = section.prandtl_glauert_factor, section.mach
    given = {
        _COEFFICIENT["lift", ""]: lift,
        _COEFFICIENT["lift", "alpha"]: factor * lift_slope.lift_slope,
        _COEFFICIENT["lift", "mach"]: growth * lift / mach,
        _COEFFICIENT["moment", ""]: moment,
        _COEFFICIENT["moment", "mach"]: growth * moment / mach,
    }
    given |= {_COEFFICIENT[at]: 0 for at in (("drag", "alpha"), ("drag", "mach"), ("moment", "alpha"))}
    by_mach = {section.FORCE_COEFFICIENT[force, "mach"] for force in ("chordwise", "normal")}
    forces = _replaced(section.forces(), given | {_DAMPING: _DAMPING * square_ratio})
    return [
        *_replaced(air, {_DAMPING: _DAMPING * square_ratio}),
        section.prandtl_glauert()[0],
        (growth, factor**2 - 1),
        (lift, factor * lift_slope.lift_slope * (section.lift_incidence - zero_lift_angle)),
        (moment, factor * _COEFFICIENT["moment", ""] * square_ratio),
        *_put_in(by_mach, forces),
        *_replaced(section.pitching_moment()[2:], given | {_DAMPING: _DAMPING * cube_ratio}),
    ]


def _put_in(
    names: set[sp.Symbol], steps: Iterable[tuple[sp.Symbol, sp.Expr]]
) -> list[tuple[sp.Symbol, sp.Expr]]:
    """Put some steps into those that need them."""
    steps = list(steps)
    given = {symbol: value for symbol, value in steps if symbol in names}
    return [step for step in _replaced(steps, given) if step[0] not in given]


def _replaced(steps: Steps, new: dict[sp.Symbol, sp.Expr]) -> Iterator[tuple[sp.Symbol, sp.Expr]]:
    return ((symbol, sp.sympify(value).xreplace(new)) for symbol, value in steps)


def work(rotors: Catalogue) -> FusedFunction:
    """Virtual work of a segment's steady airloads on the balances, and minus its change with coning, lag and pitch."""
    virtual = rotors.entries("trim", "virtual_motion")
    steady = rotors.entries("airloads", "steady_loads")
    steps, of_motion = _loads_of_motion(rotors)
    done = {
        (row, "trim"): sum(virtual.get((load, row), 0) * steady.get((load, "trim"), 0) for load in _LOADS)
        for row in STEADY_ROWS
    }
    geometric = rotors.entries("trim", "geometric_stiffness")
    changes = {
        (row, name): -geometric.get((row, name), 0)
        - sum(virtual.get((load, row), 0) * of_motion.get((load, name), 0) for load in _LOADS)
        for row in STEADY_ROWS
        for name in HINGED
    }
    none = {
        moment: sp.Integer(0) for moment in airloads.MOMENTS.values() if moment.name not in _moments(rotors)
    }
    done, changes = (
        {place: value.xreplace(none) for place, value in part.items()} for part in (done, changes)
    )
    matrices = {"work": _matrix(("trim",), done), "work_slopes": _matrix(HINGED, changes)}
    made = plan(list(_replaced(steps, none)), matrices, short_lived=True)
    groups = (
        Group("line", "the results of `line`", tuple(line(rotors).plan.results)),
        Group("moments", "the moments of r^0, r^1 and r^2 of each load of `section_loads`", _moments(rotors)),
    )
    in_groups = {name for group in groups for name in group.members}
    others = [symbol for symbol in arguments(made, steps) if symbol.name not in in_groups]
    return FusedFunction("work", _summary(work), made, others, groups)


def _moments(rotors: Catalogue) -> tuple[str, ...]:
    """Return the names of the radial moments of the loads of `section_loads`, in the order of these loads."""
    loads = section_loads(rotors).plan.results[:-2]  # without the two numbers for doubts
    return tuple(airloads.MOMENTS[load, power].name for load in loads for power in airloads.POWERS)


def _loads_of_motion(rotors: Catalogue) -> tuple[list[tuple[sp.Symbol, sp.Expr]], dict[Place, sp.Expr]]:
    """Return L U by steps: loads of a segment per unit of coning, lag and pitch, those that are not zero."""
    derivatives = rotors.entries("airloads", "load_derivatives")
    motion = rotors.entries("trim", "displacement_motion")
    named = {
        (row, column): value if value.is_number else sp.Symbol(f"motion_{row}_{column}", real=True)
        for (row, column), value in motion.items()
    }
    steps = [(symbol, motion[place]) for place, symbol in named.items() if symbol.is_Symbol]
    found: dict[Place, sp.Expr] = {}
    for load in _LOADS:
        for name in HINGED:
            value = sum(derivatives.get((load, m), 0) * named.get((m, name), 0) for m in _MOTIONS)
            if value != 0:
                found[load, name] = sp.Symbol(f"load_{load}_{name}", real=True)
                steps.append((found[load, name], value))
    return steps, found


def balance(rotors: Catalogue) -> FusedFunction:
    """Steady balance of one blade without airloads, and its change with coning, lag, elastic pitch and collective."""
    residual, slopes = (
        sum_of(rotors.entries("trim", name) for name in (own, f"offset_{own}"))
        for own in ("residual", "jacobian")
    )
    matrices = {
        "residual": _matrix(("trim",), residual),
        "slopes": _matrix(rotors.function("trim", "jacobian").columns, slopes),
    }
    made = plan([], matrices)
    return FusedFunction("balance", _summary(balance), made, arguments(made, []))


def precone_load(rotors: Catalogue) -> FusedFunction:
    """Precone's part in the steady balance of the undeflected blade."""
    function = rotors.function("trim", "precone_load")
    made = plan([], {"precone_load": Matrix(function.rows, function.columns, entries_of(function))})
    return FusedFunction("precone_load", _summary(precone_load), made, arguments(made, []))


def _matrix(columns: Sequence[str], entries: dict[Place, sp.Expr]) -> Matrix:
    return Matrix(STEADY_ROWS, tuple(columns), {place: sp.sympify(value) for place, value in entries.items()})


def _summary(of: object) -> str:
    return (of.__doc__ or "").partition("\n")[0]


def functions_of_trim(rotors: Catalogue) -> list[FusedFunction]:
    """Return all fused functions of the trim."""
    return [
        named_values(rotors, "inertia", "trim_integrals"),
        line(rotors),
        section_loads(rotors),
        work(rotors),
        balance(rotors),
        precone_load(rotors),
    ]
