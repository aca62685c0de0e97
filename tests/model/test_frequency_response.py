"""Frequency responses against an oscillator in closed form, and against python-control."""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from proprotor.model.linear_model import INPUTS
from proprotor.rotor.motions import HUB
from proprotor.stability.frequency_response import frequency_response
from tests.known_systems import linear_model

MASS, DAMPING, STIFFNESS, FORCE = 40.0, 60.0, 9000.0, 7.0  # kg, N s/m, N/m, N per m/s of gust
OMEGA = np.array([0.0, 5.0, 15.0, np.sqrt(STIFFNESS / MASS), 40.0])


@pytest.fixture(scope="module")
def oscillator():
    """Hub coordinates that know nothing of each other; gust_z drives z alone."""
    one = np.eye(len(HUB))
    loads = np.zeros((len(HUB), len(INPUTS)))
    loads[HUB.index("z"), INPUTS.index("gust_z")] = FORCE
    return replace(linear_model(MASS * one, DAMPING * one, STIFFNESS * one, HUB), B=loads)


@pytest.fixture(scope="module")
def xv15():
    return pp.load_case("xv15-uncoupled").linearize(np.array([100.0, 140.0]))


def test_one_oscillator_in_closed_form(oscillator):
    """x = F/(k - mω² + icω), and what the spring, damper and mass pull at: nothing but F holds the hub."""
    found = frequency_response(oscillator, OMEGA, inputs=["gust_z"]).response.sel(input="gust_z")
    expected = FORCE / (STIFFNESS - MASS * OMEGA**2 + 1j * DAMPING * OMEGA)
    for output, factor in (("z", 1), ("z rate", 1j * OMEGA), ("z acceleration", -(OMEGA**2))):
        np.testing.assert_allclose(found.sel(output=output), factor * expected, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(found.sel(output="x"), 0)
    # an alone-standing model: loads on the hub are those of the gust less all that the coordinates answer, none
    np.testing.assert_allclose(found.sel(output="force_z"), 0, atol=1e-9)


def test_magnitude_phase_and_units(oscillator):
    found = frequency_response(oscillator, OMEGA)
    at = found.sel(input="gust_z", output="z")
    np.testing.assert_allclose(at.magnitude * np.exp(1j * at.phase), at.response)
    resonance = at.isel(frequency=3)
    assert resonance.phase == pytest.approx(-np.pi / 2)
    assert resonance.magnitude == pytest.approx(FORCE / (DAMPING * OMEGA[3]))
    units = dict(zip(found.output.values, found.output_unit.values, strict=True))
    assert units["z"] == "m"
    assert units["z rate"] == "m/s"
    assert units["alpha_x acceleration"] == "rad/s**2"
    assert units["force_x"] == "N"
    assert units["moment_y"] == "N*m"
    assert dict(zip(found.input.values, found.input_unit.values, strict=True)) == {
        "collective": "rad",
        "cyclic_1c": "rad",
        "cyclic_1s": "rad",
        "gust_x": "m/s",
        "gust_y": "m/s",
        "gust_z": "m/s",
    }
    assert found.stable
    assert found.frequency.attrs["units"] == "rad/s"


def test_the_same_as_python_control(xv15):
    omega = np.geomspace(0.5, 300.0, 40)
    found = frequency_response(xv15, omega)
    assert found.response.dims == ("airspeed", "frequency", "output", "input")
    alone = replace(
        xv15,
        **{name: getattr(xv15, name)[1] for name in ("M", "C", "K", "B", "airspeed")},
        rotor=_second(xv15.rotor),
    )
    system = alone.to_state_space().to_control()
    expected = np.moveaxis(system(1j * omega), -1, 0)
    np.testing.assert_allclose(
        found.response.values[1], expected, rtol=1e-7, atol=1e-9 * np.abs(expected).max()
    )
    assert tuple(found.output.values) == tuple(system.output_labels)
    assert tuple(found.input.values) == tuple(system.input_labels)


def _second(rotor):
    return replace(rotor, **{name: getattr(rotor, name)[1] for name in ("M", "C", "K", "B", "airspeed")})


def test_the_static_limit_of_a_rotor_is_its_stiffness(xv15):
    """At no frequency K q = B u, but for the azimuth, of which only the rate is known: its damping holds that."""
    found = frequency_response(xv15, 0.0, inputs=["gust_x"]).isel(airspeed=0, frequency=0)
    model = xv15
    place = model.dofs.index("azimuth")
    matrix = model.K[0].copy()
    matrix[:, place] = model.C[0][:, place]
    still = np.linalg.solve(matrix, model.B[0][:, INPUTS.index("gust_x")])
    for name in ("flap_1c", "lag_0", "gimbal_1s"):
        assert found.response.sel(output=name).item() == pytest.approx(
            still[model.dofs.index(name)], rel=1e-6
        )
    assert found.response.sel(output="azimuth rate").item() == pytest.approx(still[place], rel=1e-6)


def test_flutter_is_told(xv15):
    assert frequency_response(xv15, 1.0).stable.values.all()
    assert not frequency_response(pp.load_case("xv15-uncoupled").linearize(210.0), 1.0).stable


def test_failed_points_are_nan_and_spoil_no_others():
    model = pp.load_case("xv15-uncoupled").linearize(np.array([140.0, 330.0]))
    assert model.trim.reason[1]
    found = frequency_response(model, [1.0, 10.0])
    assert np.isfinite(found.response.values[0]).all()
    assert np.isnan(found.response.values[1]).all()
    assert found.stable.values.tolist() == [True, False]


def test_an_undamped_resonance_has_no_answer():
    one = np.eye(len(HUB))
    model = replace(linear_model(one, 0 * one, 4 * one, HUB), B=np.eye(6))
    found = frequency_response(model, [1.0, 2.0], outputs=["z"]).response
    assert np.isfinite(found.values[0]).all()
    assert np.isnan(found.values[1]).all()


@pytest.mark.parametrize(
    ("frequency", "names", "message"),
    [
        ("9.5", {}, "frequency = 9.5: needs a unit"),
        (-1.0, {}, "frequency = -1.0: must be finite and not negative"),
        (np.inf, {}, "frequency = inf"),
        (1.0, {"inputs": ["gust"]}, "unknown input 'gust'; did you mean gust_"),
        (1.0, {"outputs": ["force_q"]}, "unknown output 'force_q'; did you mean force_"),
    ],
)
def test_what_cannot_be_answered(oscillator, frequency, names, message):
    with pytest.raises(pp.InputError) as error:
        frequency_response(oscillator, frequency, **names)
    assert message in str(error.value)


def test_a_model_without_inputs():
    with pytest.raises(pp.InputError, match="B: must be given"):
        frequency_response(linear_model(np.eye(1), np.eye(1), np.eye(1)), 1.0)
