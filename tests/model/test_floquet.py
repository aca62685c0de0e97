"""Floquet exponents against systems whose transition is known, and doubts of the average of the XV-15.

A constant system seen from axes that turn is periodic: x = R(ψ) y with y' = B y has the transition exp(B T).
"""

import dataclasses

import numpy as np
import pytest
import scipy.linalg

import proprotor as pp
from proprotor.errors import InputError
from proprotor.model.floquet import (
    LIMIT,
    averaged,
    change_by_average,
    exponents,
    roots_of_average,
    transition,
)
from proprotor.stability.floquet import floquet

CASE = pp.load_case("xv15")


def turning(rate, count, states=4, seed=0):
    """B, and A of the same system in axes that turn by one turn of the first two states in a period of 2π/rate."""
    rng = np.random.default_rng(seed)
    constant = rng.standard_normal((states, states)) - 2 * np.eye(states)
    psi = 2 * np.pi * np.arange(count) / count
    turn = np.broadcast_to(np.eye(states), (count, states, states)).copy()
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(psi)
    turn[:, 0, 1], turn[:, 1, 0] = -np.sin(psi), np.sin(psi)
    spin = np.zeros((states, states))
    spin[0, 1], spin[1, 0] = -rate, rate
    return constant, spin + turn @ constant @ np.swapaxes(turn, -1, -2)


@pytest.mark.parametrize("count", [7, 8])
def test_transition_of_a_constant_system_in_axes_that_turn(count):
    rate = 5.0
    constant, around = turning(rate, count)
    found = transition(around, 2 * np.pi / rate)
    expected = scipy.linalg.expm(constant * 2 * np.pi / rate)
    assert np.abs(found - expected).max() < 1e-6 * np.abs(expected).max()


def test_without_an_angle_exponents_are_the_roots():
    around = CASE.around([120.0, 150.0], shaft_angle=1e-10)
    mean = averaged(around)
    roots = roots_of_average(mean)
    found = exponents(around, roots, CASE.passage)
    assert np.abs(found - roots).max() < 1e-6 * np.abs(roots).max()
    axial = CASE.linearize([120.0, 150.0])
    for name in "MCK":
        expected = getattr(axial, name)
        assert np.abs(getattr(mean, name) - expected).max() < 1e-9 * np.abs(expected).max(), name


def test_what_the_average_leaves_out_grows_with_the_square_of_the_angle():
    """Harmonics of the matrices are of the order of the angle, and act on a root twice."""
    changes = []
    for angle in (0.005, 0.01):
        around = CASE.around(140.0, shaft_angle=angle)
        roots = roots_of_average(averaged(around))
        changes.append(np.abs(exponents(around, roots, CASE.passage) - roots).max())
    assert 3.0 < changes[1] / changes[0] < 5.0


def test_a_doubtful_average_says_so():
    speeds = np.array([100.0, 200.0])
    found = floquet(CASE, speeds, shaft_angle=np.radians(12))
    change = found.damping_change.values
    assert change[0] < LIMIT < change[1]
    assert "averaging" not in found.warning.values[0]
    assert "averaging over azimuth moves the damping" in found.warning.values[1]
    assert np.array_equal(
        CASE.linearize(speeds, shaft_angle=np.radians(12)).trim.warning, found.warning.values
    )


def test_changes_of_damping_leave_out_what_is_well_damped():
    roots = np.array([[-1 + 10j, -5 + 5j, -3 + 0j], [np.nan] * 3])
    moved = roots + np.array([0.5, 3.0, 1.0])
    change = change_by_average(roots, moved)
    assert np.isclose(change[0], 1 / abs(roots[0, 0]) - 0.5 / abs(moved[0, 0]))
    assert np.isnan(change[1])


def test_the_trim_goes_with_the_exponents():
    found = floquet(CASE, "250 kt", shaft_angle=0.05, cyclic="level")
    assert np.abs(found.gimbal_tilt.mean("azimuth")).max() < 1e-12
    assert np.abs(found.cyclic).max() > 0.01
    assert found.attrs["limit"] == LIMIT
    with pytest.raises(InputError, match="load_factor"):
        floquet(CASE, "250 kt")


@pytest.mark.parametrize(
    ("options", "field"),
    [
        ({"shaft_angle": 0.3}, "shaft_angle"),
        ({"shaft_angle": np.nan}, "shaft_angle"),
        ({"load_factor": 2.0, "equations": "published"}, "load_factor"),
        ({"shaft_angle": 0.1, "airloads": "lift-slope"}, "shaft_angle"),
        ({"shaft_angle": 0.1, "lift": "lagged"}, "shaft_angle"),
        ({"shaft_angle": 0.1, "pitch": "coupling"}, "shaft_angle"),
        ({"shaft_angle": 0.1, "reactionless": True}, "shaft_angle"),
        ({"shaft_angle": 0.1, "cyclic": "level", "locked": ("gimbal", "flap")}, "cyclic"),
    ],
)
def test_what_is_not_served_is_refused(options, field):
    with pytest.raises(InputError, match=field):
        CASE.linearize(150.0, **options)


def test_frequencies_in_tables_are_refused():
    with pytest.raises(InputError, match="structure"):
        pp.load_case("xv15-bell-frequencies").linearize(150.0, shaft_angle=0.05)


def test_attribution_is_refused():
    with pytest.raises(InputError, match="shaft_angle"):
        CASE.attribution(150.0, shaft_angle=0.05)


def test_a_point_without_airspeed_has_its_reason():
    operation = pp.Operation(rotor_speed=48.0, density=1.2, speed_of_sound=340.0, trim={"collective": 0.3})
    model = pp.rotor_model(CASE.rotor, operation, [0.0, 100.0], load_factor=2.0)
    assert "airspeed" in str(model.trim.reason[0])
    assert model.trim.reason[1] == ""


def test_a_tip_that_advances_beyond_mach_1_has_its_reason():
    model = CASE.linearize([150.0, 250.0], shaft_angle=np.radians(15))
    assert model.trim.reason[0] == ""
    assert "where the blade advances" in str(model.trim.reason[1])
    assert np.isnan(model.M[1]).all()
    assert CASE.linearize(250.0).trim.reason == ""


def test_a_gimbal_that_nothing_levels_has_its_reason():
    """In a vacuum no cyclic pitch tilts a gimbal."""
    operation = pp.Operation(rotor_speed=48.0, density=0.0, speed_of_sound=340.0, trim={"collective": 0.3})
    model = pp.rotor_model(CASE.rotor, operation, 100.0, load_factor=2.0, cyclic="level", pitch="rigid")
    assert "no periodic trim found" in str(model.trim.reason)


def test_a_free_aircraft_is_refused():
    with pytest.raises(InputError, match="stands still"):
        pp.load_case("xv15-aircraft").linearize(150.0, shaft_angle=0.05)


def test_blades_with_an_aerodynamic_centre_beside_their_axis_are_refused():
    rotor = dataclasses.replace(CASE.rotor, aerodynamic_center=0.01)
    with pytest.raises(InputError, match="pitch axis"):
        pp.rotor_model(rotor, CASE.operation, 150.0, shaft_angle=0.05)


def test_control_loops_are_refused():
    closed = dataclasses.replace(CASE, loops=("a loop",))
    with pytest.raises(InputError, match="without control loops"):
        closed.around(150.0, shaft_angle=0.05)


def test_a_flutter_speed_is_where_its_mode_has_no_damping():
    """The search takes derivatives by a complex step through the periodic trim."""
    angle = np.radians(4)
    point = CASE.flutter_point("320:360:20kt", shaft_angle=angle)
    found = CASE.linearize(point.speed, shaft_angle=angle).modes()
    damping = found.damping_ratio.values[list(found.name.values).index(point.mode)]
    assert abs(damping) < 1e-8


def test_sensitivities_are_exact_at_an_angle():
    options = {"shaft_angle": 0.05}
    found = CASE.sensitivity("damping", ["rotor.precone"], airspeed=150.0, **options)
    assert bool(found.exact.all())
