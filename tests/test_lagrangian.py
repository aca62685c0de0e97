"""The rotor in vacuum against its Lagrangian: the whole of M, C and K of random rotors, no entry left out.

Tolerance: the eighth-order differences of the Lagrangian are good to 1e-13 of the largest entry of a matrix. The
smallest blocks that do not vanish are some 1e-4 of the largest, so 1e-8 of each block leaves an order of magnitude.
The acceleration form of the oracle is exact to rounding, and gives each block to 1e-10.
"""

import numpy as np
import pytest

import proprotor as pp
from tests.oracles.comparison import assert_matrices_match, picked
from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import (
    DOFS,
    FLAP,
    LAG,
    PITCH,
    inertia_rows,
    lagrange_rows,
    linearised,
    rows_in_vacuum,
    spring_rows,
)
from tests.oracles.random_rotors import SPEED_OF_SOUND, random_rotor

AIRSPEED = 110.0


def in_vacuum(pair, density=1.225, **options):
    """The rotor at a trim bent by steady airloads (of `density`), their perturbations left out."""
    operation = pp.Operation(
        rotor_speed=pair.rotor_speed, density=density, speed_of_sound=SPEED_OF_SOUND, trim={"collective": 0.75}
    )
    model = pp.rotor_model(pair.package, operation, AIRSPEED, airloads="none", **options)
    assert model.trim.converged, model.trim.reason
    return model


def expected_matrices(rows, pair, model, time=0.0):
    rotor, trim = pair.oracle(model.trim)
    return linearised(lambda q, instant: rows(rotor, q, instant), trim, time)


def assert_model_matches(model, expected, pair, relative):
    inertia = expected[0]
    assert_matrices_match(
        (model.M, model.C, model.K),
        [picked(matrix, model.dofs) for matrix in expected],
        picked(inertia, model.dofs),
        pair.rotor_speed,
        model.dofs,
        relative,
    )


def test_the_coordinates_are_those_of_equation_17():
    assert in_vacuum(random_rotor(0)).dofs == DOFS


@pytest.mark.parametrize("n_blades", [3, 4, 5])
def test_matrices_are_second_derivatives_of_the_lagrangian(n_blades):
    pair = random_rotor(10 + n_blades, n_blades=n_blades)
    model = in_vacuum(pair)
    steady = [model.trim.coning, model.trim.lag, model.trim.elastic_pitch]
    assert np.abs(steady).min() > 1e-3, "the trim must bend the blade for this to test anything"
    assert_model_matches(model, expected_matrices(lagrange_rows, pair, model, time=0.013), pair, relative=1e-8)


VARIANTS = {
    "as drawn": {},
    "without the propeller moment": {"propeller_moment": False},
    "springs inboard of the bearing": {"flap_outboard_fraction": 0.0, "lag_outboard_fraction": 0.0},
    "springs outboard of the bearing": {"flap_outboard_fraction": 1.0, "lag_outboard_fraction": 1.0},
    "flap spring inboard, lag spring outboard": {"flap_outboard_fraction": 0.0, "lag_outboard_fraction": 1.0},
    "hinges at the centre": {"flap_hinge_offset": 0.0, "lag_hinge_offset": 0.0},
    "coincident hinges": {"flap_hinge_offset": 0.4, "lag_hinge_offset": 0.4},
    "no precone": {"precone": 0.0},
    "no pitch-gimbal coupling": {"pitch_gimbal_coupling": 0.0},
    "strong pitch-gimbal coupling": {"pitch_gimbal_coupling": 0.7},
    "no dampers": dict.fromkeys(("flap_damping", "lag_damping", "pitch_damping", "gimbal_damping"), 0.0),
    "heavy pitch inertia": {"pitch_inertia": 8.0},
}


@pytest.mark.parametrize("variant", VARIANTS)
def test_matrices_follow_from_accelerations(variant):
    seed = 20 + list(VARIANTS).index(variant)
    pair = random_rotor(seed, **VARIANTS[variant])
    model = in_vacuum(pair)
    assert_model_matches(model, expected_matrices(rows_in_vacuum, pair, model), pair, relative=1e-10)


def test_trim_in_vacuum_balances_springs_and_centrifugal_force():
    pair = random_rotor(40)
    model = in_vacuum(pair, density=0.0)
    rotor, trim = pair.oracle(model.trim)
    steady = Motion(trim, np.zeros(len(DOFS)), np.zeros(len(DOFS)))
    inertia, springs = inertia_rows(rotor, steady, 0.0).real, spring_rows(rotor, steady, 0.0).real
    for row in (FLAP, LAG, PITCH):
        assert abs(inertia[row] + springs[row]) < 1e-9 * max(abs(inertia[[FLAP, LAG]]).max(), abs(springs[row]))
    assert_model_matches(model, expected_matrices(rows_in_vacuum, pair, model), pair, relative=1e-10)


OPTIONS = {
    "rigid pitch": ({"pitch": "rigid"}, DOFS[12:15]),
    "constant speed": ({"rotor_speed": "constant"}, ("azimuth",)),
    "locked flap": ({"locked": ("flap",)}, DOFS[6:9]),
    "locked lag": ({"locked": ("lag",)}, DOFS[9:12]),
    "locked gimbal": ({"locked": ("gimbal",)}, DOFS[16:18]),
    "rigid propeller": (
        {"pitch": "rigid", "rotor_speed": "constant", "locked": ("flap", "lag", "gimbal")},
        DOFS[6:],
    ),
}


@pytest.mark.parametrize("name", OPTIONS)
def test_removed_coordinates_leave_the_others_as_they_were(name):
    """At its own trim: a locked or eliminated coordinate stays at zero."""
    options, removed = OPTIONS[name]
    pair = random_rotor(50)
    model = in_vacuum(pair, **options)
    assert model.dofs == tuple(dof for dof in DOFS if dof not in removed)
    for dof, angle in (("flap_0", model.trim.coning), ("lag_0", model.trim.lag), ("pitch_0", model.trim.elastic_pitch)):
        assert (angle == 0) == (dof in removed)
    assert_model_matches(model, expected_matrices(rows_in_vacuum, pair, model), pair, relative=1e-10)
