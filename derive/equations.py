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
    beam,
    blade_element,
    drive_train,
    flap_lag_springs,
    inertia,
    inflow,
    lift_lag,
    lift_slope,
    moving,
    multiblade,
    offset_mass,
    pitch,
    rotor,
    section,
    trim,
)
from derive import kinematics as kin
from derive.coordinates import (
    BLADE_GUSTS,
    BLADE_INFLOW,
    DIFFERENTIAL,
    FIXED_GUSTS,
    REACTIONLESS_PAIR,
    SEGMENT_MOTIONS,
    SWASHPLATE,
    names,
)
from derive.function import Function
from derive.kinds import (
    ROW_EQUATION,
    Dropped,
    Step,
    arms_matrix,
    assembly,
    blade_matrix,
    circulation_loads,
    circulation_matrix,
    column,
    element_matrix,
    element_motion,
    geometry_matrix,
    inflow_stiffness,
    inflow_work,
    loads_matrix,
    motion_matrix,
    product,
    reactionless_matrix,
    rotor_matrix,
    station_matrix,
    station_motion,
    transform_matrix,
    trim_velocity,
    values,
    virtual_motion,
    work_matrix,
)
from derive.published import CONSISTENT, PUBLISHED
from derive.rotor import Call

# Where the equations stand, besides the paper's own rows.
PAPER = "AIAA-2002-1604"
HINGES = f"{PAPER}, nomenclature: integrals over the blade outboard of each hinge"
FREQUENCIES = f"{PAPER}, nomenclature: flap and lag frequency"
REFERENCE_LINE = "the blade's reference line with precone, coning and lag, Eq. 2"
STRIP = "strip theory on a straight segment"
STRIP_THEORY = "quasi-steady strip theory, as NASA TN D-7677"
BESIDE_LINE = "mass beside the pitch axis, which AIAA-2002-1604 has not; positions as Eqs. 2-11"
BESIDE = f"{STRIP_THEORY}, at an aerodynamic centre beside the pitch axis"
LATE = "strip theory whose circulation lags by Jones' approximation of Wagner's function, NACA Report 681"
THROUGH_DISK = "momentum theory; Pitt and Peters, Vertica 5 (1981), in axial flow"
SEEN_FROM_DISK = (
    f"{STRIP}, induced velocity by the functions of the disk of Pitt and Peters, Vertica 5 (1981)"
)
CLOSED = (
    "u_T = Omega r and u_P = V, constant chord, no compressibility, as NASA TN D-7677; valid down to V = 0"
)
MOVING_AIR = "perturbation velocities, Eqs. 14-15, of moving air"
VELOCITIES = "perturbation velocities and pitch, Eqs. 14-16"
STEADY_LOADS = "steady loads on the moving blade"
BEYOND = f"{STEADY_LOADS}, beyond Eqs. 14-16"
STEADY = f"{PAPER}, Eqs. 12 and 32, steady part"
SLOPE = f"{PAPER}, Eqs. 12 and 32, differentiated"
BLADE_AXES = (
    f"{PAPER}, Eqs. 7-9: hub motion and gimbal tilt along the blade's axes, angles as multiblade sums"
)
SUM = f"{PAPER}, Eqs. 7-9 and 17: sum over N blades"
ANY_SUM = f"{SUM}, any N of at least 3"
CYCLIC = (
    "cyclic and collective flap frequencies apart, as NASA TN D-7677; collective and cyclic control systems"
)
SHAPES = "Euler-Bernoulli bending as a cubic in two planes, linear twist and extension"
STRAIN = f"strain energy of {SHAPES}"
KINETIC = f"kinetic energy of {SHAPES}"
TURNING = "energies of an Euler-Bernoulli blade that bends while it turns"
ENGINE = "energies of engine and shaft on the azimuth of Eq. 17"
TILTED = "a yoke tilted by a finite angle, the tilt of Eq. 1"
PITCHED = "pitch of Eqs. 33 and 34 with a tilted yoke and a tilted swashplate"
TURNED = "virtual rotations of the sections, Eqs. 2-11"
SPRUNG = f"{PAPER}, Eqs. 18-24 and 32-34, at the pitch of a moving trim"
WORK = f"{PAPER}, virtual work of Eqs. 12 and 32"
OF_BLADE = f"{PAPER}, Eqs. 4-16 and 32-34"
OF_ROTOR = f"{PAPER}, Eqs. 4-17 and 32-34"

BLADE, ROWS, UNKNOWNS = kin.COORDINATES, trim.STEADY_ROWS, trim.UNKNOWNS
LOADS, STIFFNESS = section.SECTION_LOADS.values(), flap_lag_springs.STIFFNESS.values()
CIRCULATION = [symbol for symbol, _ in lift_lag.change_of_circulation()] + [lift_lag.moment_of_circulation]
MOMENTS, MOTIONS = airloads.MOMENTS.values(), names(SEGMENT_MOTIONS)
M, MC, MCK, GUSTS = ("mass",), ("mass", "damping"), ("mass", "damping", "stiffness"), ("gusts",)


def _called(name: str) -> Call:
    """Look up a function of the list below by module and name, for another function to call."""
    module, function = name.split(".")
    return Call(_consistent(module, function), STEPS[module].line(function).drops)


COORDINATES = (transform_matrix("transform", multiblade.transform, BLADE_AXES),)
INERTIA = (
    values("dependent_inertias", inertia.dependent_inertias, HINGES),
    values("trim_integrals", inertia.trim_integrals, REFERENCE_LINE, drops=True),
    blade_matrix("mass", inertia.mass, 2, drops=True),
    blade_matrix("gyroscopic", inertia.gyroscopic, 1, drops=True),
    blade_matrix("centrifugal_stiffness", inertia.centrifugal_stiffness, 0, drops=True),
)
OFFSET_MASS = (
    values("trim_integrals", offset_mass.trim_integrals, BESIDE_LINE),
    blade_matrix("mass", offset_mass.mass, 2),
    blade_matrix("gyroscopic", offset_mass.gyroscopic, 1),
    blade_matrix("centrifugal_stiffness", offset_mass.centrifugal_stiffness, 0),
    values("couplings", offset_mass.couplings, BESIDE_LINE),
)
SPRINGS = (
    values("effective_stiffness", flap_lag_springs.effective_stiffness, f"{PAPER}, Eqs. 18-31", STIFFNESS),
    values("stiffness_of_frequencies", flap_lag_springs.stiffness_of_frequencies, FREQUENCIES),
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
    values("air_beside_axis", section.air_beside_axis, BESIDE),
    values("about_axis", section.about_axis, BESIDE),
)
AIRLOADS = (
    loads_matrix("load_derivatives", section.load_derivative, f"{STRIP}, as NASA TN D-7677", MOTIONS),
    loads_matrix("steady_loads", airloads.steady_load, STRIP, ("trim",)),
    product("damping", "Airload damping of one blade in rotating axes, C = - sum W^T L U."),
    product("stiffness", "Airload stiffness of one blade in rotating axes, K = - sum W^T L U - G."),
    product(
        "gust_loads", "Loads of gusts on one blade in rotating axes, on the right of the equations of motion."
    ),
    product("steady_work", "Virtual work of the steady airloads of one blade, one column."),
    values("segment_geometry", airloads.segment_geometry, REFERENCE_LINE, drops=True),
    trim_velocity(drops=True),
    virtual_motion(BLADE, drops=True),
    motion_matrix("rate_motion", airloads.rate_motion, VELOCITIES, BLADE, 1, drops=True),
    motion_matrix("displacement_motion", airloads.displacement_motion, VELOCITIES, BLADE, drops=True),
    motion_matrix("gust_motion", airloads.gust_motion, MOVING_AIR, names(BLADE_GUSTS), drops=True),
    work_matrix("geometric_stiffness", airloads.geometric_stiffness, BEYOND, BLADE, BLADE, drops=True),
)
LIFT_LAG = (
    values("change_of_circulation", lift_lag.change_of_circulation, LATE),
    values("change_beside_axis", lift_lag.change_beside_axis, f"{LATE}, beside the pitch axis", CIRCULATION),
    circulation_matrix("change", lift_lag.change, LATE),
    circulation_loads("load", lift_lag.load, LATE),
    product("change_by_rates", "Change of a blade's circulation per rate.", lift_lag.products, LATE),
    product(
        "change_by_displacements",
        "Change of a blade's circulation per displacement.",
        lift_lag.products,
        LATE,
    ),
    product("change_by_gusts", "Change of a blade's circulation per gust.", lift_lag.products, LATE),
    product("work", "Virtual work of a blade's circulation, one column.", lift_lag.products, LATE),
)
INFLOW = (
    values("momentum", inflow.momentum, THROUGH_DISK),
    inflow_work("virtual_motion", inflow.virtual_motion, SEEN_FROM_DISK),
    motion_matrix("motion", inflow.motion, SEEN_FROM_DISK, names(BLADE_INFLOW)),
    inflow_stiffness(
        "geometric_stiffness", inflow.geometric_stiffness, f"{STEADY_LOADS}, seen from the disk"
    ),
)
LIFT_SLOPE = (values("load_moments", lift_slope.load_moments, CLOSED, MOMENTS),)
TRIM = (
    column("residual", trim.residual, STEADY, ROWS, ROW_EQUATION),
    column("precone_load", trim.precone_load, STEADY, trim.HINGED, ROW_EQUATION),
    work_matrix("jacobian", trim.jacobian, SLOPE, ROWS, UNKNOWNS, ROW_EQUATION),
    column("offset_residual", offset_mass.steady, BESIDE_LINE, ROWS, ROW_EQUATION),
    work_matrix("offset_jacobian", offset_mass.steady_slope, BESIDE_LINE, ROWS, UNKNOWNS, ROW_EQUATION),
    virtual_motion(ROWS),
    motion_matrix("displacement_motion", trim.displacement_motion, VELOCITIES, UNKNOWNS),
    work_matrix("geometric_stiffness", trim.geometric_stiffness, STEADY_LOADS, ROWS, UNKNOWNS),
)
MULTIBLADE = (
    rotor_matrix("mass", multiblade.mass, ANY_SUM, 2, blade_matrices=M),
    rotor_matrix("damping", multiblade.damping, ANY_SUM, 1, blade_matrices=MC),
    rotor_matrix("stiffness", multiblade.stiffness, ANY_SUM, 0, blade_matrices=MCK),
    rotor_matrix("swashplate_loads", multiblade.swashplate_loads, SUM, 0, columns=names(SWASHPLATE)),
    rotor_matrix(
        "gust_loads", multiblade.gust_loads, SUM, 0, columns=names(FIXED_GUSTS), blade_matrices=GUSTS
    ),
    reactionless_matrix("reactionless_mass", "mass", 2, REACTIONLESS_PAIR),
    reactionless_matrix("reactionless_damping", "damping", 1, REACTIONLESS_PAIR),
    reactionless_matrix("reactionless_stiffness", "stiffness", 0, REACTIONLESS_PAIR),
    reactionless_matrix("differential_mass", "mass", 2, DIFFERENTIAL),
    reactionless_matrix("differential_damping", "damping", 1, DIFFERENTIAL),
    reactionless_matrix("differential_stiffness", "stiffness", 0, DIFFERENTIAL),
    rotor_matrix("cyclic_restraint", multiblade.cyclic_restraint, CYCLIC, 0),
)
DRIVE_TRAIN = (
    rotor_matrix("mass", drive_train.mass, ENGINE, 2),
    rotor_matrix("damping", drive_train.damping, ENGINE, 1),
    rotor_matrix("stiffness", drive_train.stiffness, ENGINE, 0),
)
ROTOR = (
    assembly("blade_airloads", rotor.BLADE_AIRLOADS, WORK, _called),
    assembly("blade_matrices", rotor.BLADE_MATRICES, OF_BLADE, _called),
    assembly("fixed_frame", rotor.FIXED_FRAME, f"{PAPER}, Eqs. 7-9 and 17", _called),
    assembly("matrices", rotor.MATRICES, OF_ROTOR, _called),
)
BEAM = (
    element_motion("motion", beam.motion, SHAPES),
    element_matrix("mass", beam.mass, KINETIC, 2),
    element_matrix("beam_stiffness", beam.beam_stiffness, STRAIN, 0),
    element_matrix("chord_stiffness", beam.chord_stiffness, STRAIN, 0),
    element_matrix("torsion_stiffness", beam.torsion_stiffness, STRAIN, 0),
    element_matrix("axial_stiffness", beam.axial_stiffness, STRAIN, 0),
)
MOVING = (
    values("blade_angles", moving.blade_angles, REFERENCE_LINE),
    values("section_angles", moving.section_angles, REFERENCE_LINE),
    values("tilt_of_yoke", moving.tilt_of_yoke, TILTED),
    arms_matrix("arm_inertia", moving.arm_inertia, HINGES, moving.ARM_NAMES, 1),
    arms_matrix("arms_of_segment", moving.arms_of_segment, REFERENCE_LINE, moving.LINE_ROWS),
    geometry_matrix("points", moving.points, REFERENCE_LINE, moving.POINT_ROWS),
    geometry_matrix("axes", moving.axes, REFERENCE_LINE, moving.AXIS_ROWS),
    geometry_matrix("pitch_of_blade", moving.pitch_of_blade, PITCHED, moving.PITCH_ROWS),
    geometry_matrix("rotation_of_section", moving.rotation_of_section, TURNED, ("rotation",), BLADE),
    trim_velocity(moving.trim_velocity),
    work_matrix("force_stiffness", moving.force_stiffness, STEADY_LOADS, BLADE, BLADE),
    work_matrix("moment_stiffness", moving.moment_stiffness, STEADY_LOADS, BLADE, BLADE),
    work_matrix("pitch_stiffness", moving.pitch_stiffness, PITCHED, BLADE, BLADE),
    column("spring_moment", moving.spring_moment, SPRUNG, BLADE, ROW_EQUATION),
    work_matrix("spring_stiffness", moving.spring_stiffness, SPRUNG, BLADE, BLADE),
)
BLADE_ELEMENT = (
    station_motion("motion", blade_element.motion, TURNING),
    values("tension", blade_element.tension, TURNING),
    station_matrix("mass", blade_element.mass, TURNING, 2),
    station_matrix("stiffness", blade_element.stiffness, TURNING, 0),
    station_matrix("twist_stiffness", blade_element.twist_stiffness, TURNING, 0),
)

STEPS = {
    step.module: step
    for step in (
        Step("coordinates", "Coordinates, loads and motions", COORDINATES, "coordinates.py.jinja"),
        Step("inertia", "Inertia of one blade in rotating axes", INERTIA),
        Step("offset_mass", "Mass beside the pitch axis of one blade in rotating axes", OFFSET_MASS),
        Step("flap_lag_springs", "Flap-lag springs of one blade, which turn with its pitch", SPRINGS),
        Step("pitch", "Blade pitch, control system, dampers and gimbal restraint", PITCH),
        Step("section", "Loads of a blade section", SECTION),
        Step("airloads", "Airloads of one blade, segment by segment", AIRLOADS),
        Step("lift_lag", "Lag of lift, in shape functions along the blade", LIFT_LAG),
        Step(
            "inflow", "Dynamic inflow in axial flight: momentum, and what a blade has to do with it", INFLOW
        ),
        Step("lift_slope", "Lift-slope airloads of the published set in closed form", LIFT_SLOPE),
        Step("trim", "Trim balance of one blade", TRIM),
        Step("multiblade", "From one blade to N blades in the fixed frame", MULTIBLADE),
        Step("drive_train", "Engine and shaft on the rotor's azimuth", DRIVE_TRAIN),
        Step("rotor", "A whole rotor in one call", ROTOR, "rotor.py.jinja"),
        Step("moving", "One blade about a trim that moves", MOVING),
        Step("beam", "A beam element, x up, y along it, z forward", BEAM),
        Step("blade_element", "An element of an elastic blade, per length", BLADE_ELEMENT),
    )
}
"""Every step by the name of its module."""

REDUCED_MODULES = tuple(module for module, step in STEPS.items() if step.changes)


@functools.cache
def _consistent(module: str, name: str) -> Function:
    step = STEPS[module]
    return step.derived(step.line(name), CONSISTENT)


def consistent_functions(module: str) -> list[Function]:
    """Return all functions of a module, with every first-order term."""
    return [_consistent(module, line.name) for line in STEPS[module].lines]


def reduced_functions(module: str, dropped: Dropped = PUBLISHED) -> list[Function]:
    """Return the functions that dropped terms can change, without these terms but with the consistent signatures."""
    return [
        dataclasses.replace(function, signature=tuple(_consistent(module, function.name).arguments))
        for function in STEPS[module].changing(dropped)
    ]
