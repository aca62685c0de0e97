"""Turbulence and what it does to a rotor on a wing: against Lyapunov's equation, python-control, quadrature by SciPy,
and records of turbulence made sample by sample.
"""

from functools import cache

import control
import numpy as np
import pytest
from scipy.integrate import quad
from scipy.linalg import expm, solve_continuous_lyapunov
from scipy.special import gamma

import proprotor as pp
from proprotor.responses.spectral_integral import rule_for
from proprotor.responses.turbulence import COMPONENTS, SPECTRA, dryden_filter

SPEED = 128.0
GUSTS = {"vertical": "gust_x", "lateral": "gust_y", "longitudinal": "gust_z"}


@cache
def model(speed=SPEED):
    return pp.load_case("xv15").linearize(speed)


def with_filter(turbulence, speed=SPEED):
    """Model and filter of Dryden in one system that white noise drives: A, B, C."""
    space, own = model(speed).to_state_space(), dryden_filter(turbulence, speed)
    column = [space.inputs.index(GUSTS[turbulence.component])]
    states, more = len(space.A), len(own.A)
    whole = np.block([[space.A, space.B[:, column] @ own.C], [np.zeros((more, states)), own.A]])
    driven = np.concatenate([np.zeros((states, 1)), own.B])
    return whole, driven, np.concatenate([space.C, space.D[:, column] @ own.C], axis=1)


@pytest.mark.parametrize("component", COMPONENTS)
def test_root_mean_squares_are_those_of_lyapunov(component):
    turbulence = pp.Turbulence("dryden", component, "2 ft/s", "300 m")
    system, driven, output = with_filter(turbulence)
    # Solved again with states of unit variance: the error is one of rounding beside the largest state.
    rough = solve_continuous_lyapunov(system, -driven @ driven.T)
    unit = np.sqrt(np.abs(rough.diagonal()))
    scaled, by_unit = system * unit / unit[:, None], driven / unit[:, None]
    covariance = solve_continuous_lyapunov(scaled, -by_unit @ by_unit.T)
    expected = np.sqrt(np.einsum("ij,jk,ik->i", output * unit, covariance, output * unit))
    found = pp.gust_response(model(), turbulence)
    assert found.rms.values == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("spectrum", SPECTRA)
def test_spectra_are_those_of_python_control(spectrum):
    turbulence = pp.Turbulence(spectrum)
    omega = np.array([0.3, 4.0, 20.0, 55.0])
    found = pp.gust_response(model(), turbulence, frequency=omega, outputs=["force_x", "moment_y"])
    system = model().to_state_space().to_control()
    for output in ("force_x", "moment_y"):
        one = system[system.output_labels.index(output), system.input_labels.index("gust_x")]
        gain = np.abs(control.frequency_response(one, omega).complex) ** 2
        expected = gain * turbulence.density(omega, SPEED)
        assert found.psd.sel(output=output).values == pytest.approx(expected, rel=1e-9)


def test_the_root_mean_square_is_the_integral_of_the_spectrum():
    """By the trapezoidal rule over frequencies that the method did not choose."""
    omega = np.concatenate([[0.0], np.geomspace(1e-4, 3e4, 60_000)])
    found = pp.gust_response(model(), frequency=omega, outputs=["force_x", "x acceleration", "gimbal_1c"])
    tail = 1.5 * omega[-1] * found.psd.values[-1]  # ∫ ω^(-5/3) beyond the last frequency
    variance = np.trapezoid(found.psd.values, omega, axis=0) + tail
    assert found.rms.values == pytest.approx(np.sqrt(variance), rel=1e-4)


@pytest.mark.parametrize("spectrum", SPECTRA)
@pytest.mark.parametrize("component", COMPONENTS)
def test_a_spectrum_has_its_intensity(spectrum, component):
    own = pp.Turbulence(spectrum, component, 3.0, 500.0)
    parts = [quad(own.density, low, high, args=(100.0,))[0] for low, high in ((0, 1), (1, 30), (30, np.inf))]
    assert sum(parts) == pytest.approx(9.0, rel=2e-4)  # 1.339 has four digits


def test_the_constant_of_von_karman():
    """a = Γ(1/3) / (√π Γ(5/6)), for which the integral of the spectrum along is 1."""
    assert gamma(1 / 3) / (np.sqrt(np.pi) * gamma(5 / 6)) == pytest.approx(1.339, abs=5e-4)


@pytest.mark.parametrize("component", COMPONENTS)
def test_the_filter_of_dryden_has_its_spectrum(component):
    own = pp.Turbulence("dryden", component, 1.7, 400.0)
    system, driven, output = dryden_filter(own, 90.0)
    for omega in (0.0, 0.1, 0.7, 5.0):
        gain = output @ np.linalg.solve(1j * omega * np.eye(len(system)) - system, driven)
        assert abs(gain.item()) ** 2 / np.pi == pytest.approx(float(own.density(omega, 90.0)), rel=1e-12)


def test_turbulence_made_sample_by_sample_has_these_root_mean_squares():
    """Noise of each step has the covariance that Van Loan's matrix gives; the record is long beside all decays."""
    turbulence = pp.Turbulence("dryden", "longitudinal", 1.0, "100 m")
    system, driven, output = with_filter(turbulence)
    step, samples, size = 0.01, 400_000, len(system)
    both = np.block([[-system, driven @ driven.T], [np.zeros((size, size)), system.T]]) * step
    power = expm(both)
    forward = power[size:, size:].T
    covariance = forward @ power[:size, size:]
    values, vectors = np.linalg.eigh((covariance + covariance.T) / 2)
    random = np.random.default_rng(11).standard_normal((samples, size)) * np.sqrt(values.clip(0)) @ vectors.T
    names = model().to_state_space().outputs
    rows = [names.index(name) for name in ("force_z", "lag_0", "z acceleration")]
    state, squares = np.zeros(size), np.zeros(len(rows))
    for sample in range(samples):
        state = forward @ state + random[sample]
        squares += (output[rows] @ state) ** 2
    found = pp.gust_response(model(), turbulence, outputs=[names[row] for row in rows])
    # 4000 s hold about 1000 independent pieces of 4 s: a root mean square is known to 3 %.
    assert np.sqrt(squares / samples) == pytest.approx(found.rms.values, rel=0.1)


def test_an_integral_over_a_sharp_resonance():
    """∫ ω0² / |s² + 2ζω0 s + ω0²|² dω from zero is π / (4 ζ ω0)."""
    omega, ratio = 7.0, 1e-5
    roots = omega * np.array([-ratio + 1j * np.sqrt(1 - ratio**2), -ratio - 1j * np.sqrt(1 - ratio**2)])
    at, weight = rule_for(roots)
    found = weight @ (omega**2 / np.abs(-(at**2) + 2j * ratio * omega * at + omega**2) ** 2)
    assert found == pytest.approx(np.pi / (4 * ratio * omega), rel=1e-9)


def test_points_that_are_not_damped_have_a_reason_and_spoil_no_other():
    batch = pp.load_case("xv15").linearize([SPEED, 230.0])
    found = pp.gust_response(batch, outputs=["force_x"])
    assert found.stable.values.tolist() == [True, False]
    assert found.reason.values[0] == "" and "not damped" in found.reason.values[1]
    assert np.isnan(found.rms.values[1]).all() and np.isnan(found.psd.values[1]).all()
    alone = pp.gust_response(model(), outputs=["force_x"])
    assert found.rms.values[0] == pytest.approx(alone.rms.values, rel=1e-12)


def test_an_aircraft_meets_a_gust_in_the_half_of_its_symmetry():
    case = pp.load_case("xv15-aircraft")
    both = case.linearize(SPEED)
    for component, half in (("vertical", "symmetric"), ("lateral", "antisymmetric")):
        found = pp.gust_response(both, pp.Turbulence(component=component))
        moved = {str(name).partition(" ")[0] for name in found.output.values[found.rms.values > 0]}
        assert moved <= {half} and (moved or not found.stable.all())


@pytest.mark.parametrize(
    ("how", "told"),
    [
        ({"spectrum": "Karman"}, "spectrum = Karman: must be"),
        ({"component": "up"}, "component = up: must be"),
        ({"intensity": "-1 m/s"}, "intensity = -1 m/s: must be one number above zero"),
        ({"scale": "5 kg"}, "scale = 5 kg: "),
    ],
)
def test_turbulence_that_is_none_is_refused(how, told):
    with pytest.raises(pp.InputError) as caught:
        pp.Turbulence(**how)
    assert str(caught.value).startswith(told)


def test_what_has_no_answer_is_refused():
    with pytest.raises(pp.InputError, match=r"airspeed = 0.0: must be above zero: turbulence is frozen"):
        pp.gust_response(pp.load_case("xv15-uncoupled").linearize(0.0))
    with pytest.raises(pp.InputError, match="unknown output 'force_u'"):
        pp.gust_response(model(), outputs=["force_u"])
    with pytest.raises(pp.InputError, match="spectrum = von-karman: must be dryden"):
        dryden_filter(pp.Turbulence(), SPEED)


def test_design_values_of_the_regulation():
    """14 CFR 25.341 at the altitudes of its text, in its own units."""
    foot = 0.3048
    for altitude, gust in ((0, 56.0), (15_000, 44.0), (60_000, 20.86), (7_500, 50.0)):
        assert pp.design_gust(f"{altitude} ft", "350 ft") == pytest.approx(gust * foot, rel=1e-9)
    for altitude, intensity in ((0, 90.0), (24_000, 79.0), (60_000, 79.0), (12_000, 84.5)):
        assert pp.design_turbulence(f"{altitude} ft") == pytest.approx(intensity * foot, rel=1e-9)
    half = pp.design_gust(0.0, 350 * foot / 2, alleviation=0.8, density=1.225 / 4)
    assert half == pytest.approx(56 * foot * 0.8 * 0.5 ** (1 / 6) * 2, rel=1e-9)
    for how in ({"altitude": "70000 ft", "gradient": "100 ft"}, {"altitude": 0.0, "gradient": "10 ft"}):
        with pytest.raises(pp.InputError, match=r"must be (one altitude )?from"):
            pp.design_gust(**how)
    with pytest.raises(pp.InputError, match="alleviation = 2: must be above zero and at most 1"):
        pp.design_turbulence(0.0, alleviation=2)
