"""The rotor in vacuum against its Lagrangian: the whole of M, C and K of random rotors, no entry left out.

Tolerance: a block is held to 1e-10 of its own largest entry, by the Lagrangian and by the accelerations. The
accelerations are exact to rounding, but the model is that of the trim before its last step, of up to 1e-13 rad,
and springs that turn with the pitch have slopes of 1e8 N m/rad²: 1e-5 N m/rad. Blocks smaller than that by
cancellation, and those that vanish, are held to what is left on the scale of the inertia: 1e-12 after the
eighth-order differences of the Lagrangian, else 1e-13 (`comparison`).
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
        rotor_speed=pair.rotor_speed,
        density=density,
        speed_of_sound=SPEED_OF_SOUND,
        trim={"collective": 0.75},
    )
    model = pp.rotor_model(pair.package, operation, AIRSPEED, airloads="none", **options)
    assert model.trim.converged, model.trim.reason
    return model


def expected_matrices(rows, pair, model, time=0.0):
    rotor, trim = pair.oracle(model.trim)
    return linearised(lambda q, instant: rows(rotor, q, instant), trim, time)


def assert_model_matches(model, expected, pair, relative=1e-10, rounding=1e-13):
    inertia = expected[0]
    assert_matrices_match(
        (model.M, model.C, model.K),
        [picked(matrix, model.dofs) for matrix in expected],
        picked(inertia, model.dofs),
        pair.rotor_speed,
        model.dofs,
        relative,
        rounding,
    )


def test_the_coordinates_are_those_of_equation_17():
    assert in_vacuum(random_rotor(0)).dofs == DOFS


@pytest.mark.parametrize("n_blades", [3, 4, 5])
def test_matrices_are_second_derivatives_of_the_lagrangian(n_blades):
    pair = random_rotor(10 + n_blades, n_blades=n_blades)
    model = in_vacuum(pair)
    steady = [model.trim.coning, model.trim.lag, model.trim.elastic_pitch]
    assert np.abs(steady).min() > 1e-3, "the trim must bend the blade for this to test anything"
    expected = expected_matrices(lagrange_rows, pair, model, time=0.013)
    assert_model_matches(model, expected, pair, relative=1e-10, rounding=1e-12)


VARIANTS = {
    "as drawn": {},
    "without the propeller moment": {"propeller_moment": False},
    "springs inboard of the bearing": {"flap_outboard_fraction": 0.0, "lag_outboard_fraction": 0.0},
    "springs outboard of the bearing": {"flap_outboard_fraction": 1.0, "lag_outboard_fraction": 1.0},
    "flap spring inboard, lag spring outboard": {"flap_outboard_fraction": 0.0, "lag_outboard_fraction": 1.0},
    "hinges at the centre": {"flap_hinge_offset": 0.0, "lag_hinge_offset": 0.0},
    "coincident hinges": {"flap_hinge_offset": 0.4, "lag_hinge_offset": 0.4},
    "no precone": {"precone": 0.0},
    "no linkages on the hinges": {"kinematic_pitch_flap_coupling": 0.0, "kinematic_pitch_lag_coupling": 0.0},
    "strong linkages on the hinges": {
        "kinematic_pitch_flap_coupling": -0.8,
        "kinematic_pitch_lag_coupling": 0.6,
    },
    "softer control system where the swashplate tilts": {"cyclic_control_stiffness": 9e3},
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
    assert_model_matches(model, expected_matrices(rows_in_vacuum, pair, model), pair)


def test_trim_in_vacuum_balances_springs_and_centrifugal_force():
    pair = random_rotor(40)
    model = in_vacuum(pair, density=0.0)
    rotor, trim = pair.oracle(model.trim)
    steady = Motion(trim)
    inertia, springs = inertia_rows(rotor, steady, 0.0).real, spring_rows(rotor, steady, 0.0).real
    # No inertia force pitches a blade: springs and the propeller moment balance there.
    scale = np.abs(inertia[FLAP])
    assert np.abs((inertia + springs)[[FLAP, LAG, PITCH]]).max() < 1e-11 * scale
    assert_model_matches(model, expected_matrices(rows_in_vacuum, pair, model), pair)


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
    trim = {"flap_0": model.trim.coning, "lag_0": model.trim.lag, "pitch_0": model.trim.elastic_pitch}
    assert all((angle == 0) == (dof in removed) for dof, angle in trim.items())
    assert_model_matches(model, expected_matrices(rows_in_vacuum, pair, model), pair)
