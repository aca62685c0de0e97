"""Outputs over time: against SciPy's simulation, an integrator, and the frequency response."""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.signal import StateSpace, lsim

import proprotor as pp

SPEED = 128.0
OUTPUTS = ["x", "force_x", "moment_y", "gimbal_1c"]


@cache
def model(speed=SPEED):
    return pp.load_case("xv15").linearize(speed)


def test_inputs_that_run_linearly_are_followed_exactly():
    """SciPy has the same interpolation, in code of its own; an integrator takes the steps that it likes."""
    time = np.linspace(0, 2, 201)
    random = np.random.default_rng(2)
    run = {"cyclic_1c": 0.01 * random.standard_normal(201), "gust_x": random.standard_normal(201)}
    found = pp.time_response(model(), time, run)
    space = model().to_state_space()
    inputs = np.zeros((201, len(space.inputs)))
    for name, values in run.items():
        inputs[:, space.inputs.index(name)] = values
    _, expected, _ = lsim(StateSpace(space.A, space.B, space.C, space.D), inputs, time)
    assert np.abs(found.response.values - expected).max(axis=0) == pytest.approx(
        np.zeros(len(space.outputs)), abs=1e-9 * np.abs(expected).max()
    )

    def rate(now, state):
        return space.A @ state + space.B @ [np.interp(now, time, column) for column in inputs.T]

    done = solve_ivp(rate, (0, 0.2), np.zeros(len(space.A)), rtol=1e-10, atol=1e-12, max_step=0.01)
    at_end = space.C @ done.y[:, -1] + space.D @ inputs[20]
    assert found.response.values[20] == pytest.approx(at_end, rel=1e-5, abs=1e-7 * np.abs(at_end).max())


def test_the_transform_of_an_impulse_is_the_frequency_response():
    """∫ h e^{-iωt} dt, whose trapezoidal error at this step is of the order of (ωh)²/12 and less."""
    step = 5e-4
    time = step * np.arange(40_001)  # 20 s, after which what is slowest has decayed by e^-12
    found = pp.time_response(model(), time, impulses={"cyclic_1s": 1.0}, outputs=OUTPUTS)
    omega = np.array([2.0, 15.0, 40.0])
    direct = pp.frequency_response(model(), omega, inputs=["cyclic_1s"], outputs=OUTPUTS)
    space = model().to_state_space()
    feedthrough = space.D[[space.outputs.index(name) for name in OUTPUTS], space.inputs.index("cyclic_1s")]
    weights = np.full(len(time), step)
    weights[[0, -1]] /= 2
    for place, frequency in enumerate(omega):
        transform = (weights * np.exp(-1j * frequency * time)) @ found.response.values + feedthrough
        expected = direct.response.values[place, :, 0]
        assert np.abs(transform - expected) == pytest.approx(
            0 * omega[:1].repeat(4), abs=2e-3 * np.abs(expected).max()
        )


def test_energy_over_time_is_energy_over_frequency():
    """Parseval: ∫ y² dt = 1/π ∫ |H|² dω, for an output that an input moves through states alone."""
    time = np.arange(0, 30, 1e-3)
    found = pp.time_response(model(), time, impulses={"gust_x": 1.0}, outputs=["x rate"])
    over_time = np.trapezoid(found.response.values[:, 0] ** 2, time)
    omega = np.concatenate([[0.0], np.geomspace(1e-3, 3e3, 40_000)])
    gain = pp.frequency_response(model(), omega, inputs=["gust_x"], outputs=["x rate"]).magnitude.values
    assert over_time == pytest.approx(np.trapezoid(gain[:, 0, 0] ** 2, omega) / np.pi, rel=1e-3)


def test_a_step_settles_at_the_static_response():
    found = pp.time_response(model(), "0:60:0.02 s", {"gust_x": "1 m/s"}, outputs=OUTPUTS)
    static = pp.frequency_response(model(), 0.0, inputs=["gust_x"], outputs=OUTPUTS).response.values[0, :, 0]
    assert found.response.values[-1] == pytest.approx(static.real, rel=1e-6, abs=1e-9)


def test_every_point_of_a_batch_is_its_own():
    batch = pp.load_case("xv15").linearize([SPEED, 230.0])
    found = pp.time_response(batch, "0:1:0.01 s", {"collective": "1 deg"}, outputs=OUTPUTS)
    alone = pp.time_response(model(), "0:1:0.01 s", {"collective": np.pi / 180}, outputs=OUTPUTS)
    assert found.response.values[0] == pytest.approx(alone.response.values, rel=1e-9, abs=1e-9)
    assert found.sizes["airspeed"] == 2


@pytest.mark.parametrize(
    ("time", "inputs", "told"),
    [
        ("1 s", {}, "time: must be two times or more that rise"),
        ([0.0, 0.1, 0.3], {}, "time: must run in even steps"),
        ("0:1:0.1 s", {"gust_w": 1.0}, "inputs = gust_w: unknown input"),
        (
            "0:1:0.1 s",
            {"gust_x": [1.0, 2.0]},
            "gust_x = array of shape (2,): must be one number, or a finite",
        ),
        ("0:1:0.1 s", {"gust_x": "1 kg"}, "gust_x = 1 kg: "),
    ],
)
def test_what_cannot_be_is_refused(time, inputs, told):
    with pytest.raises(pp.InputError) as caught:
        pp.time_response(model(), time, inputs)
    assert str(caught.value).startswith(told)


# Single gusts ---------------------------------------------------------------------------------------------------------


def exact_in_a_gust(gradient, output):
    """An oscillator makes the cosine: the whole system is linear, and one exponential leads to any time in the gust."""
    space = model().to_state_space()
    column, states = space.inputs.index("gust_x"), len(space.A)
    omega = np.pi * SPEED / gradient
    # Further states: 1/2, cos/2 and sin/2; the gust is the first less the second.
    whole = np.zeros((states + 3, states + 3))
    whole[:states, :states], whole[:states, states] = space.A, space.B[:, column]
    whole[:states, states + 1] = -space.B[:, column]
    whole[states + 1, states + 2], whole[states + 2, states + 1] = -omega, omega
    start = np.zeros(states + 3)
    start[states : states + 2] = 0.5
    row = space.outputs.index(output)

    def at(time):
        state = expm(whole * time) @ start
        return space.C[row] @ state[:states] + space.D[row, column] * (state[states] - state[states + 1])

    return at


@pytest.mark.parametrize("gradient", [9.144, 60.0])
def test_the_response_in_a_gust_is_that_of_an_exponential(gradient):
    found = pp.discrete_gust(model(), gradient, outputs=["force_x", "x"])
    for output in ("force_x", "x"):
        exact = exact_in_a_gust(gradient, output)
        history = found.response.sel(output=output).isel(gradient=0)
        for share in (0.3, 0.9):
            place = int(np.argmin(np.abs(found.time.values - share * 2 * gradient / SPEED)))
            expected = exact(float(found.time[place]))
            assert float(history[place]) == pytest.approx(expected, rel=1e-3)
        assert found.highest.sel(output=output).item() == history.values.max()
        assert found.lowest.sel(output=output).item() == history.values.min()


def test_a_long_gust_is_followed_statically():
    found = pp.discrete_gust(model(), "3 km", size="2 m/s", outputs=["force_x"], duration="1 s")
    static = pp.frequency_response(model(), 0.0, inputs=["gust_x"], outputs=["force_x"]).response.values
    peak = 2 * static.real.item()
    extreme = found.highest if peak > 0 else found.lowest
    assert float(extreme.squeeze()) == pytest.approx(peak, rel=1e-2)
    assert float(found.gust.max()) == pytest.approx(2.0, rel=1e-4)


def test_gusts_of_a_regulation_in_one_call():
    gradients = np.array([9.144, 30.0, 106.68])
    found = pp.discrete_gust(
        model(), gradients, size=pp.design_gust("10000 ft", gradients), outputs=["force_x"], duration="0.5 s"
    )
    assert found.gust.max("time").values == pytest.approx(pp.design_gust("10000 ft", gradients), rel=1e-3)


@pytest.mark.parametrize(
    ("how", "told"),
    [
        ({"gradient": -1.0}, "gradient = -1.0: must be above zero"),
        ({"gradient": 10.0, "component": "up"}, "component = up: must be"),
        ({"gradient": 10.0, "duration": 0.0}, "duration = 0.0: must be above zero"),
    ],
)
def test_gusts_that_are_none_are_refused(how, told):
    with pytest.raises(pp.InputError) as caught:
        pp.discrete_gust(model(), **how)
    assert str(caught.value).startswith(told)


def test_a_gust_needs_one_point_that_flies():
    with pytest.raises(pp.InputError, match="must be one point"):
        pp.discrete_gust(pp.load_case("xv15").linearize([100.0, 120.0]), 10.0)
    with pytest.raises(pp.InputError, match="must be above zero: the rotor flies through"):
        pp.discrete_gust(pp.load_case("xv15-uncoupled").linearize(0.0), 10.0)
