"""Quasi-steady damping of turning sections, by thin-airfoil theory and the rotation of a straight blade written out."""

import dataclasses
import inspect

import numpy as np
import pytest
from proprotor_equations import FIXED_COORDINATES, section

import proprotor as pp
from proprotor.model.linear_model import INPUTS
from proprotor.rotor.airfoil import SectionCoefficients
from proprotor.rotor.options import Options
from tests.oracles.random_rotors import random_rotor

SPEED = 90.0
NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)


# One section ---------------------------------------------------------------------------------------


def flat_plate(**changes):
    """Loads of a plate of lift slope 2π whose quarter chord flies straight at no incidence while it turns nose up."""
    turning = {
        "density": 1.2,
        "chord": 0.4,
        "section_spin": 3.0,
        "section_damping": 1.0,
        "radial_velocity": 0.0,
    }
    turning |= {"tangential_velocity": 30.0, "axial_velocity": 40.0, "section_pitch": np.arctan(4 / 3)}
    turning |= {"speed_of_sound": 340.0} | changes
    air = section.air_at_section(**given_to(section.air_at_section, turning))._asdict()
    pool = turning | air | dict.fromkeys((f"{c}_coefficient{d}" for c in COEFFICIENTS for d in BY), 0.0)
    pool |= {"lift_coefficient": 2 * np.pi * air["lift_incidence"], "lift_coefficient_alpha": 2 * np.pi}
    forces, moment = (f(**given_to(f, pool)) for f in (section.forces, section.pitching_moment))
    return turning, air, forces, moment


COEFFICIENTS, BY = ("lift", "drag", "moment"), ("", "_alpha", "_mach")


def given_to(function, pool):
    return {name: pool[name] for name in inspect.signature(function).parameters}


def test_lift_of_a_turning_plate_is_that_of_its_whole_camber_line():
    """Glauert: c_l = 2 ∫ (w/U)(1 − cos θ) dθ of the upwash w = ω (x − c/4) along the chord, x = c/2 (1 − cos θ)."""
    turning, air, forces, _ = flat_plate()
    theta = np.pi / 2 * (1 + NODES)
    x = turning["chord"] / 2 * (1 - np.cos(theta))
    upwash = turning["section_spin"] * (x - turning["chord"] / 4) / air["section_speed"]
    lift_coefficient = 2 * (np.pi / 2 * WEIGHTS) @ (upwash * (1 - np.cos(theta)))
    lift = 0.5 * turning["density"] * turning["chord"] * air["section_speed"] ** 2 * lift_coefficient
    assert air["section_speed"] == 50.0 and abs(air["angle_of_attack"]) < 1e-15
    np.testing.assert_allclose((forces.fx, forces.fn), (0.8 * lift, 0.6 * lift), rtol=1e-13)
    np.testing.assert_allclose(forces.fn_spin * turning["section_spin"], forces.fn, rtol=1e-13)


def test_moment_of_a_turning_plate_is_theodorsens():
    """- π ρ b³ U (1/2 − a) α' about the axis a b aft of the middle, b = c/2 and a = −1/2; without the apparent mass."""
    turning, air, _, moment = flat_plate()
    b, a = turning["chord"] / 2, -0.5
    expected = -np.pi * turning["density"] * b**3 * air["section_speed"] * (0.5 - a) * turning["section_spin"]
    np.testing.assert_allclose(moment.m, expected, rtol=1e-13)
    np.testing.assert_allclose(moment.m_spin * turning["section_spin"], expected, rtol=1e-13)


def test_lift_and_moment_grow_with_the_speed_alone_when_a_section_turns():
    """Both are ρ U ω times what the chord says: half of what U² would make of them, in u_T and u_P alike."""
    _, air, forces, moment = flat_plate()
    along = 0.6 * np.array([forces.fx_ut, forces.fn_ut]) + 0.8 * np.array([forces.fx_up, forces.fn_up])
    np.testing.assert_allclose(along * air["section_speed"], [forces.fx, forces.fn], rtol=1e-13)
    np.testing.assert_allclose((0.6 * moment.m_ut + 0.8 * moment.m_up) * 50.0, moment.m, rtol=1e-13)
    _, _, still, none = flat_plate(section_damping=0.0)
    assert (still.fn, still.fn_spin, none.m, none.m_spin) == (0, 0, 0, 0)


# A rotor -------------------------------------------------------------------------------------------


def flat_rotor() -> tuple[pp.Rotor, pp.Operation]:
    """The XV-15's rotor without precone: its blades lie in the disk when flap and lag are locked."""
    case = pp.load_case("xv15-uncoupled")
    rotor = dataclasses.replace(case.rotor, precone=0.0, chord=lambda r: 0.3 + 0.01 * r)
    return rotor, dataclasses.replace(case.operation, trim={"collective": 0.7})


def stations(rotor: pp.Rotor) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Radius, weight and chord along one blade."""
    half = (rotor.radius - rotor.root_cutout) / 2
    r = rotor.root_cutout + half * (1 + NODES)
    return r, half * WEIGHTS, 0.3 + 0.01 * r


def lift_of_the_turn(rotor, operation, cone=0.0):
    """Lift (stations,) per rad/s of a section's turn with Prandtl and Glauert's factor, and tan φ."""
    r, _, chord = stations(rotor)
    speed = np.cos(cone) * np.hypot(operation.rotor_speed * r, SPEED)
    factor = 1 / np.sqrt(1 - (speed / operation.speed_of_sound) ** 2)
    lift = operation.density * chord**2 / 4 * speed * rotor.airfoil.lift_slope * factor
    return lift, SPEED / (operation.rotor_speed * r)


def damping_constant(rotor: pp.Rotor, operation: pp.Operation) -> float:
    """Integral of pi/8 rho c³ U along one blade."""
    r, weight, chord = stations(rotor)
    return np.pi / 8 * operation.density * weight @ (chord**3 * np.hypot(operation.rotor_speed * r, SPEED))


def rotation_about_span(psi: float, rotor: pp.Rotor) -> np.ndarray:
    """Turn of a section about the radius at azimuth psi per unit of each coordinate: hub, pitch, and gimbal by K_PG.

    The roll of the yoke and what the swashplate gives back of it cancel.
    """
    turn = dict.fromkeys(FIXED_COORDINATES, 0.0)
    turn |= {"alpha_x": np.cos(psi), "alpha_y": np.sin(psi)}
    turn |= {"pitch_0": 1.0, "pitch_1c": np.cos(psi), "pitch_1s": np.sin(psi)}
    turn |= {"gimbal_1c": -rotor.pitch_gimbal_coupling * np.cos(psi)}
    turn |= {"gimbal_1s": -rotor.pitch_gimbal_coupling * np.sin(psi)}
    return np.array([turn[name] for name in FIXED_COORDINATES])


def tilt_of_span(psi: float) -> np.ndarray:
    """Rise of the span out of the disk, which turns the section with the rotor speed: hub and gimbal."""
    rise = dict.fromkeys(FIXED_COORDINATES, 0.0)
    rise |= {
        "alpha_x": np.sin(psi),
        "alpha_y": -np.cos(psi),
        "gimbal_1c": np.cos(psi),
        "gimbal_1s": np.sin(psi),
    }
    return np.array([rise[name] for name in FIXED_COORDINATES])


def displacements(psi: float, r: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Displacement (coordinates, stations) to the trailing edge and along the shaft, per unit of each coordinate."""
    back = dict.fromkeys(FIXED_COORDINATES, 0.0 * r)
    back |= {"x": np.sin(psi) + 0 * r, "y": -np.cos(psi) + 0 * r, "alpha_z": -r, "azimuth": -r}
    up = tilt_of_span(psi)[:, None] * r
    up[FIXED_COORDINATES.index("z")] = 1.0
    return np.array([back[name] for name in FIXED_COORDINATES]), up


def expected(rotor: pp.Rotor, operation: pp.Operation) -> tuple[np.ndarray, np.ndarray]:
    """What the damping of the sections adds to C and K: the work of its moment and lift, per turn and rate of turn."""
    constant, omega, step = damping_constant(rotor, operation), operation.rotor_speed, 1e-6
    damping, stiffness = np.zeros((18, 18)), np.zeros((18, 18))
    r, weight, _ = stations(rotor)
    lift, slope = lift_of_the_turn(rotor, operation)
    sine, cosine = slope / np.hypot(1, slope), 1 / np.hypot(1, slope)
    for psi in 0.3 + 2 * np.pi * np.arange(rotor.n_blades) / rotor.n_blades:
        turn = rotation_about_span(psi, rotor)
        back, up = displacements(psi, r)
        work = constant * turn - (back * sine + up * cosine) @ (weight * lift)
        # The rate of a rotating component is that of the coordinate and Omega times its change with azimuth. A tilt of
        # the hub has such a change and yet is no rotation, which the rise of the span takes off again.
        change = (rotation_about_span(psi + step, rotor) - rotation_about_span(psi - step, rotor)) / (
            2 * step
        )
        damping += np.outer(work, turn)
        stiffness += omega * np.outer(work, change + tilt_of_span(psi))
    return damping, stiffness


def test_damping_of_the_sections_of_a_flat_rotor():
    rotor, operation = flat_rotor()
    options = {"locked": ("flap", "lag")}
    without = pp.rotor_model(rotor, operation, SPEED, section_damping=False, **options)
    damped = pp.rotor_model(rotor, operation, SPEED, **options)
    assert (
        damped.trim.elastic_pitch == without.trim.elastic_pitch
    )  # a flat blade does not turn about its span at trim
    places = [FIXED_COORDINATES.index(name) for name in without.dofs]
    for name, matrix in zip("CK", expected(rotor, operation), strict=True):
        change = getattr(damped, name) - getattr(without, name)
        reference = matrix[np.ix_(places, places)]
        size = np.abs(reference).max(axis=1)  # of each row
        assert np.abs(change - reference).max(axis=1) == pytest.approx(0 * size, abs=1e-8 * size.max())
        assert (size > 0.01 * size.max()).sum() == {"C": 12, "K": 8}[name]


def test_a_tilt_that_stays_is_no_rotation():
    """Hub and gimbal tilted and held: no section turns about its span, so nothing is damped."""
    rotor, operation = flat_rotor()
    _, stiffness = expected(rotor, operation)
    held = [FIXED_COORDINATES.index(name) for name in ("alpha_x", "alpha_y")]
    assert np.abs(stiffness[:, held]).max() < 1e-6 * np.abs(stiffness).max()


def test_a_coned_blade_turns_about_its_span_in_steady_flight():
    """At Ω sin β_P; the lift of that turn is part of the thrust."""
    rotor, operation = flat_rotor()
    rotor = dataclasses.replace(rotor, precone=0.1)
    locked = {"locked": ("flap", "lag", "pitch")}
    with_it, without = (
        pp.rotor_model(rotor, operation, SPEED, section_damping=damped, **locked).trim.thrust
        for damped in (True, False)
    )
    lift, slope = lift_of_the_turn(rotor, operation, cone=0.1)
    along_shaft = lift * operation.rotor_speed * np.sin(0.1) / np.hypot(1, slope) * np.cos(0.1)
    expected_thrust = rotor.n_blades * stations(rotor)[1] @ along_shaft
    assert expected_thrust > 50
    assert with_it - without == pytest.approx(expected_thrust, rel=1e-8)


class CurvedLift:
    """An airfoil whose lift bends with angle of attack, whose drag and moment change with it."""

    contains_compressibility = True

    def coefficients(self, alpha, mach):
        zero = 0 * alpha
        lift = (0.2 + 5.7 * alpha - 4 * alpha**2, 5.7 - 8 * alpha, zero)
        drag = (0.02 + 0.4 * alpha**2, 0.8 * alpha, zero)
        moment = (-0.03 + 0.1 * alpha, 0.1 + zero, zero)
        return SectionCoefficients(*lift, *drag, *moment)


def curved_rotor(**options):
    """Thrust and torque of a coned rigid rotor with such sections by collective and airspeed, and its model."""
    rotor, operation = flat_rotor()
    rotor = dataclasses.replace(rotor, precone=0.12, airfoil=CurvedLift(), twist=-0.6)
    options |= {"locked": ("flap", "lag"), "pitch": "rigid"}

    def loads(collective, speed):
        given = dataclasses.replace(operation, trim={"collective": collective})
        trim = pp.rotor_model(rotor, given, speed, **options).trim
        return np.array([trim.thrust, trim.torque])

    return rotor, operation, loads, pp.rotor_model(rotor, operation, SPEED, **options)


def test_the_lift_of_a_steady_turn_is_that_of_the_bent_curve_at_three_quarters_of_the_chord():
    """Thrust written out, section by section; drag has the angle of attack of the quarter chord."""
    rotor, operation, loads, _ = curved_rotor()
    r, weight, chord = stations(rotor)
    cone, omega = rotor.precone, operation.rotor_speed
    u_t, u_p = omega * r * np.cos(cone), SPEED * np.cos(cone)
    speed, inflow = np.hypot(u_t, u_p), np.arctan2(u_p, u_t)
    alpha = 0.7 - 0.6 * (r / rotor.radius - 0.75) - inflow
    turned = alpha + omega * np.sin(cone) * chord / 2 / speed
    c_l, c_d = 0.2 + 5.7 * turned - 4 * turned**2, 0.02 + 0.4 * alpha**2
    normal = operation.density / 2 * chord * speed**2 * (c_l * np.cos(inflow) - c_d * np.sin(inflow))
    radial = (
        -operation.density / 2 * chord * speed * c_d * SPEED * np.sin(cone)
    )  # drag of the air along the blade
    thrust = rotor.n_blades * weight @ (normal * np.cos(cone) + radial * np.sin(cone))
    assert loads(0.7, SPEED)[0] == pytest.approx(thrust, rel=1e-9)


def test_steady_loads_change_as_the_equations_say_where_the_lift_curve_bends():
    """By collective, which is an input, and by airspeed, which is the hub's motion along the shaft."""
    _, _, loads, model = curved_rotor()
    rows, step = [model.dofs.index(name) for name in ("z", "azimuth")], 1e-4
    by_collective = (loads(0.7 + step, SPEED) - loads(0.7 - step, SPEED)) / (2 * step)
    np.testing.assert_allclose(by_collective, model.B[rows, INPUTS.index("collective")], rtol=1e-7)
    by_speed = (loads(0.7, SPEED + step) - loads(0.7, SPEED - step)) / (2 * step)
    np.testing.assert_allclose(by_speed, -model.C[rows, model.dofs.index("z")], rtol=1e-7)


# The option ----------------------------------------------------------------------------------------


def test_damping_is_on_where_nothing_is_said_but_for_the_published_equations():
    assert Options().section_damping is True
    assert Options(airloads="lift-slope").section_damping is True
    assert Options(equations="published").section_damping is False
    assert Options(equations="published", section_damping=True).section_damping is True
    assert Options(section_damping=False).section_damping is False


@pytest.mark.parametrize(
    "options", [{}, {"equations": "published"}, {"pitch": "coupling"}, {"pitch": "rigid"}]
)
def test_what_is_not_said_is_what_is_meant(options):
    case = pp.load_case("xv15-uncoupled")
    meant = Options(**options).section_damping
    unsaid = case.linearize(SPEED, **options)
    said, other = (case.linearize(SPEED, section_damping=choice, **options) for choice in (meant, not meant))
    for name in "MCK":
        assert np.array_equal(getattr(unsaid, name), getattr(said, name))
    assert np.abs(unsaid.C - other.C).max() > 1e-4 * np.abs(unsaid.C).max()


def test_lift_slope_airloads_keep_the_lift_of_the_turn_and_not_the_moment():
    """Without lift slope nothing of the damping is left in them; in the full airloads the moment is."""
    bare = {"airfoil": pp.Airfoil(lift_slope=0.0, drag=0.01), "precone": 0.0}
    pair = random_rotor(3, **bare)
    operation = pp.Operation(
        rotor_speed=pair.rotor_speed, density=1.1, speed_of_sound=340.0, trim={"collective": 0.7}
    )

    def damping(airloads, **options):
        return pp.rotor_model(pair.package, operation, SPEED, airloads=airloads, **options).C

    assert np.array_equal(damping("lift-slope"), damping("none"))
    assert np.abs(damping("full") - damping("full", section_damping=False)).max() > 1.0
