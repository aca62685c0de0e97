"""The flaperon against Glauert's integrals for a bent camber line, and against the loads of a whole wing by hand."""

import numpy as np
import pytest
from scipy.integrate import quad

import proprotor as pp
from proprotor.support.wing_aerodynamics import Strips, WingAerodynamics, flap_derivatives

EXACT = 1e-9
WING = {
    "support.wing_aerodynamics.lift_slope": "5.7/rad",
    "support.wing_aerodynamics.chord": "5.25 ft",
    "support.wing_aerodynamics.elastic_axis": "0.35",
}


@pytest.mark.parametrize("chord", [0.1, 0.25, 0.5, 0.9, 1.0])
def test_lift_and_moment_are_those_of_thin_airfoil_theory(chord):
    """A camber line with the slope -1 behind the hinge: A0 = 1/π ∫, A1, A2 = -2/π ∫ cos nθ; c_l = π(2 A0 + A1)."""
    hinge = np.arccos(2 * chord - 1)  # x = (1 - cos θ)/2 at (1 - chord)
    integral = [quad(lambda t, n=n: np.cos(n * t), hinge, np.pi)[0] for n in range(3)]
    a0, a1, a2 = integral[0] / np.pi, 2 * integral[1] / np.pi, 2 * integral[2] / np.pi
    a1, a2 = -a1, -a2
    lift = np.pi * (2 * a0 + a1)
    moment = -np.pi / 4 * (a1 - a2)
    effectiveness, about_quarter = flap_derivatives(np.asarray(chord))
    assert 2 * np.pi * effectiveness == pytest.approx(lift, abs=EXACT)
    assert about_quarter == pytest.approx(moment, abs=EXACT)


def test_a_rigid_wing_has_the_lift_and_the_moment_of_its_flapped_part():
    """Strips that rise and pitch as one body; the flap reaches from 40 % to 90 % of the span."""
    span, chord, axis, slope = 5.0, 1.6, 0.35, 5.7
    _, weights = np.polynomial.legendre.leggauss(20)
    ones = np.ones((20, 1))
    strips = Strips(weights / 2 * span, np.hstack([ones, 0 * ones]), np.hstack([0 * ones, ones]))
    wing = WingAerodynamics(
        lift_slope=slope, chord=chord, elastic_axis=axis, flap_chord=0.25, flap_inboard=0.4, flap_outboard=0.9
    )
    effectiveness, moment = flap_derivatives(np.asarray(0.25))
    lift = 0.5 * chord * slope * float(effectiveness) * 0.5 * span
    about_axis = lift * (axis - 0.25) * chord + 0.5 * chord**2 * float(moment) * 0.5 * span
    np.testing.assert_allclose(wing.flap_loads(strips)[:, 0], [lift, about_axis], rtol=EXACT)


def test_the_input_grows_with_dynamic_pressure_and_loads_the_wing_alone():
    case = pp.load_case("xv15", WING | {"support.wing_aerodynamics.flap_chord": "0.25"})
    model = case.linearize([80.0, 160.0])
    assert model.inputs[-1] == "flaperon"
    column = model.B[..., -1]
    np.testing.assert_allclose(column[1], 4 * column[0], rtol=EXACT)
    assert (column[:, len(case.support.names) :] == 0).all() and (column[:, 0] != 0).all()
    space = model.to_state_space()
    assert space.D.shape[-1] == len(model.inputs)
    still = pp.load_case("xv15", WING).linearize([80.0, 160.0])
    for name in "MCK":
        np.testing.assert_array_equal(getattr(model, name), getattr(still, name))


def test_derivatives_by_the_flaperon_are_exact():
    case = pp.load_case("xv15", WING | {"support.wing_aerodynamics.flap_chord": "0.25"})
    case = case.with_control(
        pp.ControlLoop(name="f", sensors="beam rate", inputs="flaperon", gain=-0.1, actuator_bandwidth=60.0)
    )
    path, value, step = "support.wing_aerodynamics.flap_chord", 0.25, 1e-5
    found = case.sensitivity("damping", [path], airspeed=150.0, mode="beam")
    ends = [
        case.sensitivity("damping", [path], airspeed=150.0, mode="beam").damping.item()
        for case in (case.vary({path: value + sign * step}) for sign in (1, -1))
    ]
    assert found.exact.all()
    assert found.derivative.item() == pytest.approx((ends[0] - ends[1]) / (2 * step), rel=1e-6)


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        ({"flap_chord": "1.2"}, "must lie between 0 and 1"),
        ({"flap_chord": "0"}, "must be above 0"),
        ({"flap_chord": "0.2", "flap_inboard": "0.9", "flap_outboard": "0.5"}, "inboard before outboard"),
    ],
)
def test_a_flaperon_off_the_wing_is_refused(settings, told):
    given = {f"support.wing_aerodynamics.{name}": value for name, value in settings.items()}
    with pytest.raises(pp.InputError) as error:
        pp.load_case("xv15", WING | given)
    assert told in str(error.value) and len(str(error.value).splitlines()) == 1


def test_an_aircraft_has_no_flaperon():
    with pytest.raises(pp.InputError, match="an aircraft has no flaperon"):
        pp.load_case("xv15-aircraft", {"support.wing_aerodynamics.flap_chord": "0.25"})
