"""Airload matrices and the trim against the nonlinear airloads by virtual work.

Tolerance: the oracle is exact to rounding (a complex step, and quadrature converged to 1e-13), and so is a
converged quadrature on the other side. A block is held to 1e-11 of its largest entry, those that vanish to
1e-13 on the scale of the inertia (`comparison`). Steady loads and their balance are held to 1e-11 of their
largest term.
"""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from tests.oracles.comparison import assert_matrices_match, picked
from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import (
    AZIMUTH,
    DOFS,
    FLAP,
    LAG,
    PITCH,
    inertia_rows,
    linearised,
    spring_rows,
)
from tests.oracles.random_rotors import NO_LINKAGES, RotorInAir
from tests.oracles.virtual_work import airload_rows, lift_slope_rows

POWERED = {"collective": 0.8}

THREE_AIRFOILS = (
    pp.Airfoil(lift_slope=6.3, zero_lift_angle=-0.07, drag=0.02, moment=-0.075),
    pp.Airfoil(lift_slope=5.4, zero_lift_angle=-0.02, drag=0.006, moment=-0.008),
    pp.Airfoil(lift_slope=6.0, zero_lift_angle=-0.01, drag=0.009, moment=-0.02),
)


def regions(*ends, blend):
    return pp.AirfoilRegions(airfoils=THREE_AIRFOILS, region_ends=ends, blend=blend)


CASES = {
    "windmilling": {"seed": 1, "n_blades": 3, "airspeed": 90.0, "trim": "windmill"},
    "windmilling, tables": {"seed": 2, "n_blades": 4, "tables": True, "airspeed": 130.0, "trim": "windmill"},
    "powered": {"seed": 3, "n_blades": 4, "airspeed": 110.0, "trim": POWERED},
    "powered, tables": {"seed": 4, "n_blades": 3, "tables": True, "airspeed": 120.0, "trim": POWERED},
    "five blades": {"seed": 5, "n_blades": 5, "airspeed": 100.0, "trim": POWERED},
    "incompressible": {"seed": 6, "airspeed": 110.0, "trim": "windmill", "compressibility": False},
    "incompressible, powered, tables": {
        "seed": 7,
        "tables": True,
        "airspeed": 110.0,
        "trim": POWERED,
        "compressibility": False,
    },
    "hinges inboard of the cutout": {"seed": 8, "airspeed": 110.0, "trim": POWERED, "root_cutout": 0.9},
    "slow flight": {"seed": 9, "airspeed": 20.0, "trim": {"collective": 0.2}},
    "airfoils by region": {
        "seed": 12,
        "airspeed": 115.0,
        "trim": "windmill",
        "airfoil": regions(0.45, 0.8, blend=0.0),
    },
    "airfoils by region, blended, powered, tables": {
        "seed": 13,
        "tables": True,
        "airspeed": 105.0,
        "trim": POWERED,
        "airfoil": regions(0.3, 0.7, blend=[0.15, 0.4]),
    },
    "no section damping": {"seed": 10, "airspeed": 105.0, "trim": "windmill", "section_damping": False},
    "no section damping, powered, tables": {
        "seed": 11,
        "tables": True,
        "airspeed": 100.0,
        "trim": POWERED,
        "section_damping": False,
    },
}


class Case(RotorInAir):
    def airloads(self, kind="full", **options):
        """(the model with airloads, what they add to its matrices)."""
        loaded, bare = self.model(airloads=kind, **options), self.model(airloads="none", **options)
        assert loaded.dofs == bare.dofs
        return loaded, [getattr(loaded, name) - getattr(bare, name) for name in "MCK"]

    def oracle(self, model):
        return self.pair.oracle(model.trim)

    def assert_match(self, actual, expected, model):
        rotor, trim = self.oracle(model)
        inertia, _, _ = linearised(lambda q, time: inertia_rows(rotor, q, time), trim, 0.0)
        assert_matrices_match(
            actual,
            [picked(matrix, model.dofs) for matrix in expected],
            picked(inertia, model.dofs),
            self.pair.rotor_speed,
            model.dofs,
            relative=1e-11,
            rounding=1e-13,
        )


@pytest.fixture(params=CASES)
def case(request):
    return Case(**CASES[request.param])


def steady_rows(case, model):
    """The terms of the static equations, each on the left-hand side."""
    rotor, trim = case.oracle(model)
    steady = Motion(trim)
    return (
        inertia_rows(rotor, steady, 0.0).real,
        spring_rows(rotor, steady, 0.0).real,
        airload_rows(case.air, rotor, steady, 0.0).real,
    )


def test_airload_matrices_are_derivatives_of_virtual_work(case):
    model, airloads = case.airloads()
    rotor, trim = case.oracle(model)
    expected = linearised(lambda q, time: airload_rows(case.air, rotor, q, time), trim, 0.017)
    case.assert_match(airloads, expected, model)


def test_the_trim_is_an_equilibrium(case):
    model = case.model()
    terms = np.array(steady_rows(case, model))
    balanced = [FLAP, LAG, PITCH]
    if case.operation.trim == "windmill":
        balanced.append(AZIMUTH)
    largest = np.abs(terms).max(axis=0)
    largest[AZIMUTH] = largest[FLAP]  # a torque of the air alone, zero by cancellation along the blade
    residual = np.abs(terms.sum(axis=0))
    assert (residual[balanced] < 1e-11 * largest[balanced]).all()


def test_thrust_and_torque_are_the_steady_loads_of_the_hub(case):
    model = case.model()
    _, _, airloads = steady_rows(case, model)
    thrust, torque = -airloads[2], -airloads[AZIMUTH]
    scale = np.abs(airloads[FLAP])
    assert abs(model.trim.thrust - thrust) < 1e-11 * abs(thrust)
    assert abs(model.trim.torque - torque) < 1e-11 * max(abs(torque), scale)
    if case.operation.trim != "windmill":
        assert abs(torque) > 0.1 * scale, "a powered trim must carry a steady torque"


@pytest.mark.parametrize("name", ["windmilling", "powered, tables", "incompressible", "no section damping"])
def test_lift_slope_airloads_keep_the_change_of_incidence_alone(name):
    """At the trim of the full airloads."""
    case = Case(**CASES[name])
    model, airloads = case.airloads("lift-slope")
    assert np.isclose(model.trim.thrust, case.model().trim.thrust, rtol=1e-12)
    rotor, trim = case.oracle(model)
    expected = linearised(lambda q, time: lift_slope_rows(case.air, rotor, trim, q, time), trim, 0.0)
    case.assert_match(airloads, expected, model)


@pytest.mark.parametrize("name", ["windmilling", "powered, tables"])
def test_airloads_without_pitch_dynamics(name):
    case = Case(**CASES[name])
    model, airloads = case.airloads(pitch="rigid")
    rotor, trim = case.oracle(model)
    expected = linearised(lambda q, time: airload_rows(case.air, rotor, q, time), trim, 0.0)
    case.assert_match(airloads, expected, model)


def pitch_flap_and_pitch_lag_coupling(rotor, trim):
    """K_Pβ and K_Pζ: the control spring against the pitch moment of springs and masses of a blade bent further."""
    step = 1e-30
    linked = rotor.kinematic_pitch_flap_coupling * trim[FLAP] + rotor.kinematic_pitch_lag_coupling * trim[LAG]
    loose = replace(rotor, collective=rotor.collective - linked, control_stiffness=0.0, **NO_LINKAGES)

    def pitch_moment(bent):
        q = Motion(trim + 1j * step * np.eye(len(trim))[bent])
        return (inertia_rows(loose, q, 0.0) + spring_rows(loose, q, 0.0))[PITCH].imag / step

    return [pitch_moment(bent) / rotor.n_blades / rotor.control_stiffness for bent in (FLAP, LAG)]


def with_couplings(case, model, unturned):
    """What airloads add whose pitch follows flap and lag, the loads of the pitch being those of the air `unturned`."""
    rotor, trim = case.oracle(model)
    flap_coupling, lag_coupling = pitch_flap_and_pitch_lag_coupling(rotor, trim)
    _, C, K = linearised(lambda q, time: airload_rows(case.air, rotor, q, time), trim, 0.0)
    _, _, by_angle = linearised(lambda q, time: airload_rows(unturned, rotor, q, time), trim, 0.0)
    pitch = by_angle[:, PITCH : PITCH + 3]
    K[:, FLAP : FLAP + 3] -= flap_coupling * pitch
    K[:, LAG : LAG + 3] -= lag_coupling * pitch
    return np.zeros_like(C), C, K


@pytest.mark.parametrize("name", ["windmilling", "powered, tables"])
def test_quasi_static_pitch_couples_flap_and_lag_into_the_airloads(name):
    """Pitch follows −K_Pβ δβ − K_Pζ δζ of each blade in the airloads only, a static angle that turns no section."""
    case = Case(**CASES[name], aerodynamic_center=0.0)
    model, airloads = case.airloads(pitch="coupling")
    unturned = replace(case.air, section_damping=False)
    case.assert_match(airloads, with_couplings(case, model, unturned), model)


@pytest.mark.parametrize("name", ["windmilling", "powered, tables"])
def test_quasi_static_pitch_moves_the_aerodynamic_centre(name):
    """In collective motions, whose pitch stands still in a section's eyes; a cyclic one turns once a revolution."""
    case = Case(**CASES[name])
    model, (_, _, actual) = case.airloads(pitch="coupling")
    _, _, expected = with_couplings(case, model, case.air)
    own, whole = ([dofs.index(name) for name in ("flap_0", "lag_0")] for dofs in (model.dofs, DOFS))
    rows = [DOFS.index(name) for name in model.dofs]
    difference = np.abs(actual[:, own] - expected[np.ix_(rows, whole)])
    assert (difference.max(axis=0) < 1e-10 * np.abs(expected[:, whole]).max(axis=0)).all()
