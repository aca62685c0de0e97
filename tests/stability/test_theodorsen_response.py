"""Frequency responses with Theodorsen's function: against the nonlinear rotor, closed forms and lagging states."""

import numpy as np
import pytest
import sympy as sp

import proprotor as pp
from benchmarks import reed_bland as report
from proprotor.errors import InputError
from proprotor.model import theodorsen
from tests.model.test_lift_lag import CASES, Case, one_each, with_shapes  # noqa: F401 (a fixture)
from tests.oracles import lagging_lift

HUB = ("x", "y", "z", "alpha_x", "alpha_y", "alpha_z")
OMEGA = np.array([0.0, 0.5, 12.0, 60.0])


def hankel(k):
    """C(k) by Hankel functions of many digits, of a section whose flow changes with exp(ikt)."""
    second, first = sp.hankel2(1, k), sp.hankel2(0, k)
    return complex((second / (second + sp.I * first)).evalf(30))


def on_six_coordinates(case, **options):
    """The random rotor as a case, its hub held by springs in all axes."""
    hub = np.eye(6)
    support = pp.NormalModes(HUB, 1e3 * hub, 0 * hub, 1e6 * hub, hub, False)
    whole = pp.Case("random", case.pair.package, case.operation, support)
    return whole, whole.linearize(case.airspeed, **case.switches, **options)


# The function -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("k", [1e-8, 1e-3, 0.05, 0.3, 1.0, 7.0, 200.0])
def test_the_function_beside_bessel_functions_of_many_digits(k):
    expected = hankel(sp.Rational(k))
    found = theodorsen._theodorsen(np.array([k, -k]))
    np.testing.assert_allclose(found, [expected, np.conj(expected)], rtol=1e-14)


def test_the_function_at_rest_and_in_haste():
    assert theodorsen._theodorsen(np.array(0.0)) == 1
    assert theodorsen._theodorsen(np.array(1e6)) == pytest.approx(0.5, abs=1e-6)


# The nonlinear rotor ----------------------------------------------------------------------------------------


def by_hankel(reduced):
    """The oracle's factor for exp(st) with imaginary s: reduced is s c/2U."""
    k = np.imag(reduced)
    values = report.theodorsen(np.abs(k))  # by Hankel functions
    return np.where(k < 0, np.conj(values), values)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("omega", OMEGA[1:])
def test_every_section_of_the_nonlinear_rotor_lags_by_the_function(name, omega, monkeypatch):
    """To rounding; tables have few stations of their own, which the lag is no linear function of."""
    case, relative = Case(**CASES[name]), 1e-6 if "tables" in name else 1e-11
    _, model = on_six_coordinates(case)
    (late,) = theodorsen.at_frequencies(model, np.array([omega]))
    found = 1j * omega * (late.C - model.C) + late.K - model.K
    monkeypatch.setattr(lagging_lift, "jones", by_hankel)
    rotor, trim = case.pair.oracle(model.trim)
    expected, gusts = lagging_lift.what_lag_adds(case.air, rotor, trim, 1j * omega)
    np.testing.assert_allclose(found, expected, rtol=0, atol=relative * np.abs(expected).max())
    np.testing.assert_allclose((late.B - model.B)[:, 3:], gusts, rtol=0, atol=relative * np.abs(gusts).max())
    assert np.abs(expected).max() > 1e-3 * np.abs(omega * model.C).max()


def test_a_response_is_that_of_the_nonlinear_rotor(monkeypatch):
    """Motions and hub loads by gusts, from dynamic stiffness and loads of the oracle."""
    case, omega = Case(**CASES["windmilling"]), 12.0
    _, model = on_six_coordinates(case)
    found = pp.frequency_response(model, [omega], lift="theodorsen", inputs=["gust_x", "gust_z"])
    monkeypatch.setattr(lagging_lift, "jones", by_hankel)
    rotor, trim = case.pair.oracle(model.trim)
    added, gusts = lagging_lift.what_lag_adds(case.air, rotor, trim, 1j * omega)
    dynamic = model.K + 1j * omega * model.C - omega**2 * model.M + added
    loads = model.B.astype(complex)
    loads[:, 3:] += gusts
    motion = np.linalg.solve(dynamic, loads)[:, [3, 5]]
    alone = model.rotor.K + 1j * omega * model.rotor.C - omega**2 * model.rotor.M + added
    of_hub = loads[:6, [3, 5]] - alone[:6] @ motion
    response = found.response.isel(frequency=0)
    for name in ("x", "alpha_y", "flap_1c", "lag_1s", "gimbal_1s"):
        np.testing.assert_allclose(
            response.sel(output=name), motion[model.dofs.index(name)], rtol=1e-9, atol=1e-15
        )
    names = ["force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z"]
    np.testing.assert_allclose(response.sel(output=names), of_hub, rtol=0, atol=1e-9 * np.abs(of_hub).max())


# States that lag --------------------------------------------------------------------------------------------

MODELS = {
    "as it is": {},
    "blades that follow the swashplate": {"pitch": "rigid"},
    "constant speed": {"rotor_speed": "constant"},
    "lift slope": {"airloads": "lift-slope"},
    "locked gimbal": {"locked": ("gimbal",)},
    "a mast that twists": {
        "drive_train": pp.DriveTrain(drive_inertia=5.0, mast_stiffness=4e5, engine_inertia=9.0)
    },
}


@pytest.mark.parametrize("name", MODELS)
def test_with_the_function_of_jones_it_is_the_model_with_a_pair_of_states_at_every_station(
    name,
    monkeypatch,
    with_shapes,  # noqa: F811
):
    """The same responses by two ways: of all outputs to all inputs."""
    case, options = Case(**CASES["windmilling"]), MODELS[name]
    monkeypatch.setattr(theodorsen, "_theodorsen", lambda k: lagging_lift.jones(1j * k))
    _, model = on_six_coordinates(case, **options)
    found = pp.frequency_response(model, OMEGA[1:], lift="theodorsen").response
    with_shapes(case.pair.package.quadrature.stations.size, one_each)
    _, lagging = on_six_coordinates(case, lift="lagged", **options)
    expected = pp.frequency_response(lagging, OMEGA[1:]).response.sel(output=found.output)
    size = np.abs(expected).max(("frequency", "input"))
    moved = (size > 1e-9 * size.max()).values
    assert moved.sum() > 20
    error = (np.abs(found - expected) / size).values[:, moved]
    assert error.max() < 1e-7


@pytest.mark.parametrize("deck", ["xv15", "xv15-aircraft"])
def test_beside_the_states_of_a_deck(deck):
    """Within 3 per cent of the largest response in modulus, where lift at once is more than 10 per cent away.

    Jones' function is within 2.1 per cent in modulus and 1.3 degrees in phase.
    """
    case, omega = pp.load_case(deck), np.array([1.0, 5.0, 12.0, 40.0])
    speeds = np.array([120.0, 150.0])
    exact = pp.frequency_response(case.linearize(speeds), omega, lift="theodorsen")
    states = pp.frequency_response(case.linearize(speeds, lift="lagged"), omega)
    at_once = pp.frequency_response(case.linearize(speeds), omega)
    names = [name for name in exact.output.values if "gimbal" in name or "force" in name]
    one, other, quasi_steady = (
        np.abs(found.response.sel(output=names)) for found in (exact, states, at_once)
    )
    size = one.max(("frequency", "input"))
    assert float((np.abs(one - other) / size).max()) < 0.03
    assert float((np.abs(one - quasi_steady) / size).max()) > 0.1


def test_the_strips_of_a_wing_lag_by_the_function_of_their_own_frequency():
    case, omega = pp.load_case("xv15-aircraft"), 9.0
    model = case.linearize(150.0)
    wing = case.support.wing
    (late,) = theodorsen.at_frequencies(model, np.array([omega]))
    speed, density = 150.0, float(case.operation.density)
    k = omega * float(case.given["support.wing_aerodynamics.chord"].si) / (2 * speed)
    held = 1 - hankel(k)
    n = len(case.support.names)
    of_wing = -held * (1j * omega * density * speed * wing.damping + density * speed**2 * wing.stiffness)
    on_rotors = theodorsen._on_support(
        [
            theodorsen._LateRotor.of(case.rotor, case.operation, model.origin.options, model, model).added(
                omega, model
            )
        ],
        case.support.at(150.0, case.operation.density),
    ).submodel(model.dofs)
    found = 1j * omega * (late.C - model.C) + late.K - model.K
    rest = found - (1j * omega * on_rotors.C + on_rotors.K)
    np.testing.assert_allclose(rest[:n, :n], of_wing, rtol=0, atol=1e-10 * np.abs(of_wing).max())
    rest[:n, :n] = 0
    np.testing.assert_allclose(rest, 0, atol=1e-10 * np.abs(of_wing).max())


def test_at_rest_lift_of_steady_wind_is_that_at_once():
    """A gust along the shaft that stays moves the collective coordinates as without lag."""
    case = pp.load_case("xv15-uncoupled")
    model = case.linearize(140.0)
    inputs, outputs = ["gust_z"], ["flap_0", "lag_0", "pitch_0", "force_z"]
    late, at_once = (
        pp.frequency_response(model, 0.0, inputs=inputs, outputs=outputs, lift=lift).response.values
        for lift in ("theodorsen", None)
    )
    np.testing.assert_allclose(late, at_once, rtol=1e-9)
    assert np.abs(late.imag).max() < 1e-9 * np.abs(late).max()


def test_failed_points_are_nan_and_the_batch_is_its_points():
    case = pp.load_case("xv15-uncoupled")
    batch = pp.frequency_response(case.linearize(np.array([140.0, 2000.0])), OMEGA[1:], lift="theodorsen")
    one = pp.frequency_response(case.linearize(140.0), OMEGA[1:], lift="theodorsen")
    assert np.isnan(batch.response.values[1]).all() and batch.reason.values[1]
    size = np.abs(one.response.values).max()
    np.testing.assert_allclose(batch.response.values[0], one.response.values, rtol=1e-9, atol=1e-12 * size)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"lift": "lagged"}, 'goes with a model whose lift is quasi-steady, not "lagged"'),
        ({"equations": "published"}, 'goes with equations="consistent"'),
        ({"airloads": "none"}, 'goes with airloads="full" or "lift-slope"'),
    ],
)
def test_what_has_no_function_is_refused(options, message):
    model = pp.load_case("xv15-uncoupled").linearize(140.0, **options)
    with pytest.raises(InputError, match=f"lift = theodorsen: {message}"):
        pp.frequency_response(model, 1.0, lift="theodorsen")


def test_a_rotor_alone_and_another_word_are_refused():
    case = pp.load_case("xv15-uncoupled")
    alone = pp.rotor_model(case.rotor, case.operation, 140.0)
    with pytest.raises(InputError, match="lift = theodorsen: goes with a model of a case"):
        pp.frequency_response(alone, 1.0, lift="theodorsen")
    with pytest.raises(InputError, match='lift = lagged: must be "theodorsen", or left out'):
        pp.frequency_response(case.linearize(140.0), 1.0, lift="lagged")
