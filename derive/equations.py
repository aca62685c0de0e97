"""The catalogue: every generated function, a line for each, in the order of the derivation.

A line has the function's name, the derivation of its values or entries, and where that stands. `drops=True` marks what
a dropped term can change; everything else is the same in both sets of equations. `derive.kinds` says what each kind of
line makes, and the docstring of a derivation is the summary of the function generated from it.
"""

from __future__ import annotations

import dataclasses
import functools

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
from derive.coordinates import BLADE_GUSTS, DIFFERENTIAL, FIXED_GUSTS, LOAD, MOTION, REACTIONLESS_PAIR, names
from derive.coordinates import SEGMENT_MOTIONS as MOTIONS
from derive.function import Function, force_per, plus
from derive.kinds import (
    ROW_EQUATION,
    Dropped,
    Line,
    Step,
    blade_matrix,
    column,
    loads_matrix,
    matrix,
    motion_matrix,
    product,
    rotor_matrix,
    values,
    virtual_motion,
)
from derive.published import PUBLISHED

PAPER = "AIAA-2002-1604"
REFERENCE_LINE = "the blade's reference line with precone, coning and lag, Eq. 2"
STRIP_THEORY = "quasi-steady strip theory, as NASA TN D-7677"
CLOSED_FORM = (
    "u_T = Omega r and u_P = V, constant chord, no compressibility, as NASA TN D-7677; valid down to V = 0"
)
STEADY = f"{PAPER}, Eqs. 12 and 32, steady part"
SUM = f"{PAPER}, Eqs. 7-9 and 17: sum over N blades"
ANY_SUM = f"{SUM}, any N of at least 3"
ENGINE = "energies of engine and shaft on the azimuth of Eq. 17"

BLADE, LOADS = kin.COORDINATES, section.SECTION_LOADS.values()
M, MC, MCK = ("mass",), ("mass", "damping"), ("mass", "damping", "stiffness")


def _reactionless(kind: str, order: int, pair: bool) -> Line:
    """A matrix of motions of the blades that do not reach the hub."""
    told = "motions of a harmonic whose sum over the blades vanishes"
    if not pair:
        told = "motion of neighbouring blades against each other, even N"
    coordinates = names(REACTIONLESS_PAIR if pair else DIFFERENTIAL)
    return matrix(
        f"{'reactionless' if pair else 'differential'}_{kind}",
        functools.partial(multiblade.reactionless, kind),
        "multiblade coordinates beyond Eq. 17, for more than three blades",
        coordinates,
        coordinates,
        force_per(order),
        "blade angles beyond Eq. 17",
        summary=f"{kind.capitalize()} matrix of the {told}.",
        blade_matrices=MCK[: 3 - order],
    )


INERTIA = (
    values(
        "dependent_inertias",
        inertia.dependent_inertias,
        f"{PAPER}, nomenclature: integrals over the blade outboard of each hinge",
    ),
    values("trim_integrals", inertia.trim_integrals, REFERENCE_LINE, drops=True),
    blade_matrix("mass", inertia.mass, 2, drops=True),
    blade_matrix("gyroscopic", inertia.gyroscopic, 1, drops=True),
    blade_matrix("centrifugal_stiffness", inertia.centrifugal_stiffness, 0, drops=True),
)
SPRINGS = (
    values(
        "effective_stiffness",
        flap_lag_springs.effective_stiffness,
        f"{PAPER}, Eqs. 18-31",
        flap_lag_springs.STIFFNESS.values(),
    ),
    values(
        "stiffness_of_frequencies",
        flap_lag_springs.stiffness_of_frequencies,
        f"{PAPER}, nomenclature: flap and lag frequency",
    ),
    blade_matrix("stiffness", flap_lag_springs.stiffness, 0, drops=True),
)
PITCH = (
    blade_matrix("damping", pitch.damping, 1),
    values("couplings", pitch.couplings, f"{PAPER}, Eqs. 33-37"),
    blade_matrix("mass", pitch.mass, 2, drops=True),
    blade_matrix("stiffness", pitch.stiffness, 0, drops=True),
)
SECTION = (
    values("air_at_section", section.air_at_section, STRIP_THEORY),
    values("prandtl_glauert", section.prandtl_glauert, "Prandtl-Glauert similarity rule"),
    values("forces", section.forces, STRIP_THEORY, LOADS),
    values("pitching_moment", section.pitching_moment, STRIP_THEORY, LOADS),
    values("steady_forces", section.steady_forces, STRIP_THEORY, LOADS),
)
AIRLOADS = (
    loads_matrix(
        "load_derivatives",
        section.load_derivative,
        "strip theory on a straight segment, as NASA TN D-7677",
        names(MOTIONS),
        lambda load, motion: plus(LOAD[load].dimension, minus=MOTION[motion].dimension),
    ),
    loads_matrix(
        "steady_loads",
        airloads.steady_load,
        "strip theory on a straight segment",
        ("trim",),
        lambda load, _: LOAD[load].dimension,
    ),
    product("damping", "Airload damping of one blade in rotating axes, C = - sum W^T L U."),
    product("stiffness", "Airload stiffness of one blade in rotating axes, K = - sum W^T L U - G."),
    product(
        "gust_loads", "Loads of gusts on one blade in rotating axes, on the right of the equations of motion."
    ),
    product("steady_work", "Virtual work of the steady airloads of one blade, one column."),
    values("segment_geometry", airloads.segment_geometry, REFERENCE_LINE, drops=True),
    matrix(
        "trim_velocity",
        airloads.trim_velocity,
        "u_T and u_P of Eqs. 14-15 at trim",
        (motion.name for motion in MOTIONS if motion.argument != "theta"),
        ("trim",),
        lambda motion, _: MOTION[motion].dimension,
        drops=True,
    ),
    virtual_motion(BLADE, drops=True),
    motion_matrix("rate_motion", airloads.rate_motion, BLADE, 1, drops=True),
    motion_matrix("displacement_motion", airloads.displacement_motion, BLADE, drops=True),
    motion_matrix(
        "gust_motion",
        airloads.gust_motion,
        names(BLADE_GUSTS),
        origin="perturbation velocities, Eqs. 14-15, of moving air",
        drops=True,
    ),
    matrix(
        "geometric_stiffness",
        airloads.geometric_stiffness,
        "steady loads on the moving blade, beyond Eqs. 14-16",
        BLADE,
        BLADE,
        force_per(0),
        drops=True,
    ),
)
LIFT_SLOPE = (values("load_moments", lift_slope.load_moments, CLOSED_FORM, airloads.MOMENTS.values()),)
TRIM = (
    column("residual", trim.residual, STEADY, trim.STEADY_ROWS, equation=ROW_EQUATION),
    column("precone_load", trim.precone_load, STEADY, trim.HINGED, equation=ROW_EQUATION),
    matrix(
        "jacobian",
        trim.jacobian,
        f"{PAPER}, Eqs. 12 and 32, differentiated",
        trim.STEADY_ROWS,
        trim.UNKNOWNS,
        force_per(0),
        ROW_EQUATION,
    ),
    virtual_motion(trim.STEADY_ROWS),
    motion_matrix("displacement_motion", trim.displacement_motion, trim.UNKNOWNS),
    matrix(
        "geometric_stiffness",
        trim.geometric_stiffness,
        "steady loads on the moving blade",
        trim.STEADY_ROWS,
        trim.UNKNOWNS,
        force_per(0),
    ),
)
MULTIBLADE = (
    rotor_matrix("mass", multiblade.mass, ANY_SUM, 2, blade_matrices=M),
    rotor_matrix("damping", multiblade.damping, ANY_SUM, 1, blade_matrices=MC),
    rotor_matrix("stiffness", multiblade.stiffness, ANY_SUM, 0, blade_matrices=MCK),
    rotor_matrix(
        "gust_loads", multiblade.gust_loads, SUM, 0, columns=names(FIXED_GUSTS), blade_matrices=("gusts",)
    ),
    _reactionless("mass", 2, pair=True),
    _reactionless("damping", 1, pair=True),
    _reactionless("stiffness", 0, pair=True),
    _reactionless("mass", 2, pair=False),
    _reactionless("damping", 1, pair=False),
    _reactionless("stiffness", 0, pair=False),
    rotor_matrix(
        "cyclic_restraint",
        multiblade.cyclic_restraint,
        "separate cyclic and collective flap frequencies, as NASA TN D-7677",
        0,
    ),
)
DRIVE_TRAIN = (
    rotor_matrix("mass", drive_train.mass, ENGINE, 2),
    rotor_matrix("damping", drive_train.damping, ENGINE, 1),
    rotor_matrix("stiffness", drive_train.stiffness, ENGINE, 0),
)

STEPS = {
    step.module: step
    for step in (
        Step("inertia", "Inertia of one blade in rotating axes", INERTIA),
        Step("flap_lag_springs", "Flap-lag springs of one blade, which turn with its pitch", SPRINGS),
        Step("pitch", "Blade pitch, control system, dampers and gimbal restraint", PITCH),
        Step("section", "Loads of a blade section", SECTION),
        Step("airloads", "Airloads of one blade, segment by segment", AIRLOADS),
        Step("lift_slope", "Lift-slope airloads of the published set in closed form", LIFT_SLOPE),
        Step("trim", "Trim balance of one blade", TRIM),
        Step("multiblade", "From one blade to N blades in the fixed frame", MULTIBLADE),
        Step("drive_train", "Engine and shaft on the rotor's azimuth", DRIVE_TRAIN),
    )
}
"""Every step by the name of its module."""

REDUCED_MODULES = tuple(module for module, step in STEPS.items() if step.changes)


@functools.cache
def _consistent(module: str) -> tuple[Function, ...]:
    return tuple(STEPS[module].functions(drops=True))


def consistent_functions(module: str) -> list[Function]:
    """All functions of a module, with every first-order term."""
    return [*STEPS[module].functions(drops=False), *_consistent(module)]


def reduced_functions(module: str, dropped: Dropped = PUBLISHED) -> list[Function]:
    """The functions that dropped terms can change, without those terms, under the consistent signatures."""
    signatures = {function.name: tuple(function.arguments) for function in _consistent(module)}
    return [
        dataclasses.replace(function, signature=signatures[function.name])
        for function in STEPS[module].functions(dropped, drops=True)
    ]
