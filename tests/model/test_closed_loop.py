"""Control loops around a model: closed forms, python-control, a march with a true delay, and differences.

Tolerances: `EXACT` where both sides are the same numbers by different arithmetic; `SLOPE` is what central differences
of the stated step can resolve.
"""

from dataclasses import replace

import control
import numpy as np
import pytest
import scipy.signal
from scipy.integrate import solve_ivp

import proprotor as pp
from proprotor.control.control_law import ControlLaw
from proprotor.control.control_loop import ControlLoop
from proprotor.control.pade import phase_limit, sections
from proprotor.model import stamp
from proprotor.model.closed_loop import close_loops
from proprotor.model.first_order import state_matrix
from proprotor.model.linear_model import LinearModel
from proprotor.model.sensors import sensor
from proprotor.stability.modes import eigenvalues
from proprotor.stability.origins import model_parts

EXACT = 1e-9
SLOPE = 1e-6
CASE = pp.load_case("xv15-uncoupled")
SPEED = 150.0
DAMPER = ControlLoop(
    name="damper",
    sensors="beam rate",
    inputs="cyclic_1c",
    gain=0.05,
    law=([1.0, 0.0], [1.0, 5.0, 10.0]),
    actuator_bandwidth=125.0,
    actuator_damping=0.7,
    delay=0.01,
)


def single(m, c, k, load=1.0):
    """One degree of freedom, m q̈ + c q̇ + k q = b u, as a model of this package."""
    trim = CASE.linearize(SPEED).trim
    return LinearModel(
        M=np.array([[m]]),
        C=np.array([[c]]),
        K=np.array([[k]]),
        dofs=("pitch",),
        trim=trim,
        airspeed=np.array(SPEED),
        B=np.array([[load]]),
        inputs=("collective",),
    )


def near(found, expected, tolerance=EXACT):
    """Whether two sets of roots are the same, each root with its own nearest one."""
    left = list(found)
    for root in expected:
        place = int(np.argmin([abs(one - root) for one in left]))
        assert abs(left[place] - root) < tolerance * (1 + abs(root)), (root, left[place])
        left.pop(place)
    assert not left


# Closed forms ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("what", "coefficients"),
    [
        ("pitch", lambda m, c, k, g: [m, c, k - g]),
        ("pitch rate", lambda m, c, k, g: [m, c - g, k]),
        ("pitch acceleration", lambda m, c, k, g: [m - g, c, k]),
    ],
)
def test_a_gain_on_one_degree_of_freedom_moves_one_coefficient(what, coefficients):
    m, c, k, g = 2.0, 0.3, 50.0, -0.7
    closed = close_loops(single(m, c, k), [ControlLoop(name="g", sensors=what, inputs="collective", gain=g)])
    near(eigenvalues(closed), np.roots(coefficients(m, c, k, g)))


@pytest.mark.parametrize("order", [1, 2, 3, 4, 8])
@pytest.mark.parametrize("what", [0, 1, 2])
def test_a_whole_loop_on_one_degree_of_freedom_has_the_roots_of_its_polynomial(order, what):
    """(m s² + c s + k) d(s) - g s^what n(s) of law, delay and actuator, written out by SciPy's polynomials alone."""
    m, c, k, g, tau, omega, zeta = 2.0, 0.3, 50.0, 1.7, 0.03, 40.0, 0.6
    ending = ("", " rate", " acceleration")[what]
    law = ([0.5, 2.0], [0.1, 1.0, 6.0, 1.0])
    loop = ControlLoop(
        name="one",
        sensors=f"pitch{ending}",
        inputs="collective",
        law=law,
        gain=g,
        delay=tau,
        delay_order=order,
        actuator_bandwidth=omega,
        actuator_damping=zeta,
    )
    num, den = control.pade(tau, order)
    below = np.polymul(np.polymul(law[1], den), [1 / omega**2, 2 * zeta / omega, 1.0])
    above = g * np.polymul(np.polymul(law[0], num), [1.0] + [0.0] * what)
    near(
        eigenvalues(close_loops(single(m, c, k), [loop])),
        np.roots(np.polysub(np.polymul([m, c, k], below), above)),
        1e-7,  # roots of a polynomial of degree up to 15 from its coefficients
    )


def test_an_actuator_of_first_order():
    loop = ControlLoop(name="one", sensors="pitch", inputs="collective", gain=-3.0, actuator_bandwidth=8.0)
    near(eigenvalues(close_loops(single(2.0, 0.3, 50.0), [loop])), np.roots(np.polyadd(
        np.polymul([2.0, 0.3, 50.0], [1 / 8.0, 1.0]), [3.0])))  # fmt: skip


@pytest.mark.parametrize("order", range(1, 9))
def test_the_chain_of_sections_is_the_approximation_that_python_control_has(order):
    s = 1j * np.linspace(0.1, 12, 30)
    chain = np.ones_like(s)
    for a, b in sections(order):
        chain *= (b - s) / (b + s) if a is None else (s**2 - a * s + b) / (s**2 + a * s + b)
    num, den = control.pade(1.0, order)
    np.testing.assert_allclose(chain, np.polyval(num, s) / np.polyval(den, s), rtol=1e-8)
    below = 1j * np.linspace(0, phase_limit(order), 50)
    error = np.degrees(np.abs(np.angle(np.polyval(num, below) / np.polyval(den, below) * np.exp(below))))
    assert error[-1] == pytest.approx(1.0, abs=1e-6) and (error[:-1] < 1.0).all()


# Against python-control on the whole rotor ----------------------------------------------------------------------------


def in_python_control(case, loops):
    """The closed loop by python-control: the open state space of the model, and loops of its own making."""
    opened = case.open_loop(SPEED).to_state_space().to_control()
    feedback = 0
    for loop in loops:
        law = control.ss(loop.law.A, loop.law.B, loop.law.C, loop.law.D) * control.ss([], [], [], loop.mixing)
        chain = control.tf([1.0], [1.0])
        if loop.delay:
            chain *= control.tf(*control.pade(loop.delay, loop.delay_order))
        if loop.actuator_bandwidth:
            w, z = loop.actuator_bandwidth, loop.actuator_damping
            chain *= control.tf([w**2], [1.0, 2 * z * w, w**2]) if z else control.tf([w], [1.0, w])
        take = np.zeros((len(loop.sensors), opened.noutputs))
        for row, name in enumerate(loop.sensors):
            take[row, opened.output_labels.index(name)] = 1
        give = np.zeros((opened.ninputs, len(loop.inputs)))
        for column, name in enumerate(loop.inputs):
            give[opened.input_labels.index(name), column] = 1
        chains = control.append(*[control.ss(chain)] * len(loop.inputs))
        feedback += control.ss([], [], [], give) * chains * (loop.gain * law) * control.ss([], [], [], take)
    return control.feedback(opened, feedback, sign=1)


LOOPS = {
    "gain": [ControlLoop(name="a", sensors="x rate", inputs="cyclic_1c", gain=0.02)],
    "acceleration straight through": [
        ControlLoop(name="a", sensors="x acceleration", inputs="cyclic_1c", gain=0.003)
    ],
    "whole": [replace(DAMPER, sensors=("x rate",))],
    "acceleration by a whole loop": [replace(DAMPER, sensors=("z acceleration",), gain=0.01)],
    "two loops": [
        replace(DAMPER, sensors=("gimbal_1c",), inputs=("cyclic_1s",), gain=0.3, name="gimbal"),
        replace(DAMPER, sensors=("x acceleration",), gain=0.02, delay=None),
    ],
    "several sensors and inputs": [
        ControlLoop(
            name="m",
            sensors=("x acceleration", "azimuth rate"),
            inputs=("collective", "cyclic_1s"),
            law=(
                np.array([[-3.0, 1.0], [0.0, -8.0]]),
                np.array([[1.0, 0.2], [0.1, 1.0]]),
                np.array([[0.03, 0.0], [0.01, 0.02]]),
                np.array([[0.001, 0.0], [0.0, 0.002]]),
            ),
            actuator_bandwidth=100.0,
            delay=0.02,
        )
    ],
    "a weighted sum": [
        ControlLoop(
            name="w",
            sensors=("x acceleration", "alpha_y acceleration"),
            weights=(1.0, -1.4),
            inputs="cyclic_1c",
            gain=0.002,
            actuator_bandwidth=100.0,
        )
    ],
}


@pytest.mark.parametrize("kind", LOOPS)
def test_python_control_has_the_same_roots(kind):
    closed = CASE.with_control(*LOOPS[kind])
    found = eigenvalues(closed.linearize(SPEED))
    near(found, in_python_control(CASE, LOOPS[kind]).poles(), 1e-7)
    opened = eigenvalues(CASE.linearize(SPEED))
    assert max(np.abs(found - root).min() for root in opened) > 1e-3  # the loops matter


def test_python_control_has_the_same_response_of_loads_and_motions_to_gusts():
    loops = LOOPS["two loops"]
    found = pp.frequency_response(CASE.with_control(*loops).linearize(SPEED), [3.0, 20.0, 60.0])
    other = in_python_control(CASE, loops)
    expected = np.moveaxis(other(1j * found.frequency.values), -1, 0)
    assert found.output.values.tolist() == list(CASE.open_loop(SPEED).to_state_space().outputs)
    np.testing.assert_allclose(found.response.values, expected, rtol=1e-7, atol=1e-6)


# A true delay ---------------------------------------------------------------------------------------------------------


def test_a_march_with_the_true_delay_decays_and_turns_as_the_approximation_says():
    """m q̈ + c q̇ + k q = g q̇(t - τ), marched interval by interval with the solution before as its own history."""
    m, c, k, g, tau = 1.0, 0.4, 900.0, -1.2, 0.02
    loop = ControlLoop(name="late", sensors="pitch rate", inputs="collective", gain=g, delay=tau)
    roots = eigenvalues(close_loops(single(m, c, k), [loop]))
    slow = roots[np.abs(np.abs(roots.imag) - np.sqrt(k / m)).argmin()]
    past = lambda t: np.array([1.0, 0.0])  # noqa: E731
    times, values = [], []
    for step in range(150):
        start = step * tau
        now = values[-1][:, -1] if values else np.array([1.0, 0.0])
        solved = solve_ivp(
            lambda t, x, past=past: [x[1], (-c * x[1] - k * x[0] + g * past(t - tau)[1]) / m],
            (start, start + tau), now, rtol=1e-10, atol=1e-12, dense_output=True,
        )  # fmt: skip
        past = solved.sol
        at = np.linspace(start, start + tau, 20)
        times.append(at[:-1])
        values.append(solved.sol(at))
    t, q = np.concatenate(times), np.concatenate([part[0, :-1] for part in values])
    peak = np.flatnonzero((q[1:-1] > q[:-2]) & (q[1:-1] >= q[2:])) + 1
    late = peak[t[peak] > 0.6]
    decay = np.polyfit(t[late], np.log(q[late]), 1)[0]
    period = np.diff(t[late]).mean()
    assert decay == pytest.approx(slow.real, rel=2e-3)
    assert 2 * np.pi / period == pytest.approx(abs(slow.imag), rel=2e-3)
    assert abs(decay - (-c / 2)) > 0.1  # the loop matters


# Derivatives ----------------------------------------------------------------------------------------------------------


def test_derivatives_by_every_number_of_a_loop_are_those_of_differences():
    case = CASE.with_control(replace(DAMPER, gain=0.3, delay_order=2))
    paths = [path for path in pp.design_inputs(case) if path.startswith("control.")]
    assert [path.rpartition(".")[2] for path in paths] == [
        "gain",
        "actuator_bandwidth",
        "actuator_damping",
        "delay",
    ]
    paths += ["rotor.precone", "operation.density"]
    found = case.sensitivity("eigenvalue", paths, airspeed=SPEED, mode="beam")
    assert found.exact.all()
    start = complex(found.eigenvalue.values[0])
    for path in paths:
        value, ends = float(pp.design_inputs(case)[path].si), []
        for sign in (1, -1):
            roots = eigenvalues(case.vary({path: value * (1 + sign * 1e-5)}).linearize(SPEED))
            ends.append(roots[np.abs(roots - start).argmin()])
        slope = (ends[0] - ends[1]) / (2e-5 * value)
        exact = complex(found.derivative.sel(input=path).values[0])
        assert abs(exact - slope) < SLOPE * (1 + abs(slope)), path


def test_numbers_of_loops_may_be_arrays_beside_airspeeds():
    case = CASE.with_control(DAMPER)
    gains = np.array([0.0, 0.1, 0.3])
    many = case.vary({"control.loops[damper].gain": gains[:, None]}).linearize([120.0, SPEED])
    assert many.M.shape[:2] == (3, 2)
    for row, gain in enumerate(gains):
        one = case.vary({"control.loops[damper].gain": gain}).linearize([120.0, SPEED])
        for name in "MCK":
            np.testing.assert_allclose(getattr(many, name)[row], getattr(one, name), rtol=1e-12, atol=1e-9)


def test_a_scheduled_gain_is_the_gain_of_each_airspeed_with_its_slope():
    speeds, factors = [100.0, 140.0, 180.0], [1.0, 0.6, 0.2]
    scheduled = CASE.with_control(replace(DAMPER, scheduled_at=speeds, scheduled_gains=factors))
    for speed, factor in zip([90.0, *speeds, 200.0], [1.0, *factors, 0.2], strict=True):
        alone = CASE.with_control(replace(DAMPER, gain=DAMPER.gain * factor))
        np.testing.assert_allclose(scheduled.linearize(speed).M, alone.linearize(speed).M, rtol=1e-12)
    step, at = 1e-30, 150.0
    slope = scheduled.linearize(at + 1j * step).C.imag / step
    ends = [scheduled.linearize(at + sign * 1e-3).C for sign in (1, -1)]
    np.testing.assert_allclose(slope, (ends[0] - ends[1]) / 2e-3, rtol=1e-5, atol=1e-4)


# The analyses ---------------------------------------------------------------------------------------------------------


def test_modes_have_the_names_of_the_loop_and_the_rotor_keeps_its_own():
    found = CASE.with_control(DAMPER).linearize(SPEED).modes()
    names = set(found.name.values.tolist())
    assert {"damper law", "damper delay 1", "damper delay 2", "damper actuator"} <= names
    assert {"beam", "chord", "torsion", "regressive gimbal"} <= names


def test_sweep_flutter_map_study_and_boundaries_take_the_closed_loop():
    worse = ControlLoop(
        name="worse", sensors="chord rate", inputs="collective", gain=0.003, actuator_bandwidth=125.0
    )
    case = CASE.with_control(worse)
    speeds = "300:420:20kt"
    flutter = case.flutter_point(speeds)
    assert abs(flutter.speed - CASE.flutter_point(speeds).speed) > 1.0
    model = case.linearize(flutter.speed)
    assert abs(eigenvalues(model).real).min() < 1e-6
    swept = case.sweep(speeds)
    least = swept.damping_ratio.min("mode").values
    first = int(np.flatnonzero(least < 0)[0])
    assert swept.airspeed.values[first - 1] < flutter.speed < swept.airspeed.values[first]
    gains = np.array([0.0, 0.003])
    path = "control.loops[worse].gain"
    mapped = case.stability_map({"airspeed": speeds, path: gains})
    assert np.isfinite(mapped.boundary.values).any()
    by_gain = case.boundary_against({path: gains}, speeds)
    assert float(by_gain["first"][1]) == pytest.approx(flutter.speed, abs=1e-6)
    studied = pp.study(case, {path: gains}, speeds, ("flutter",), workers=1)
    assert float(studied.flutter_speed[1]) == pytest.approx(flutter.speed, abs=2e-5)
    assert float(studied.flutter_speed[0]) == pytest.approx(CASE.flutter_point(speeds).speed, abs=2e-5)


def test_what_drives_a_mode_counts_the_loops_and_sums_to_the_model():
    case = CASE.with_control(DAMPER, *LOOPS["several sensors and inputs"])
    model = case.linearize(SPEED)
    parts = model_parts(case, model)
    for name in "MCK":
        whole = getattr(model, name)
        np.testing.assert_allclose(
            sum(getattr(part, name) for part in parts.values()),
            whole,
            rtol=1e-9,
            atol=1e-9 * np.abs(whole).max(),
        )
    assert np.any(parts["control loops"].C)
    found = case.attribution(SPEED, "beam")
    assert abs(complex(found.contribution.sum("origin").values[0])) < 1e-6
    assert (
        "control loops" in found.origin.values
        and "control loops" not in CASE.attribution(SPEED).origin.values
    )


def test_results_say_which_loops_are_closed():
    found = CASE.with_control(DAMPER).sweep([SPEED, 160.0])
    assert found.attrs["control"] == "damper: beam rate to cyclic_1c"
    assert "control loops closed: damper" in stamp.line(found.attrs)
    assert CASE.sweep([SPEED, 160.0]).attrs["control"] == "none"
    assert found.attrs["deck"] != CASE.sweep([SPEED, 160.0]).attrs["deck"]


def test_two_rotors_keep_their_halves_apart_unless_a_loop_joins_them():
    aircraft = pp.load_case("xv15-aircraft")
    half = ControlLoop(name="half", sensors="symmetric x rate", inputs="symmetric cyclic_1c", gain=0.01)
    across = replace(half, sensors=("antisymmetric x rate",))
    opened = aircraft.linearize(SPEED)
    kept, joined = (aircraft.with_control(loop).linearize(SPEED) for loop in (half, across))
    assert not opened.halves_couple and not kept.halves_couple and joined.halves_couple
    anti = [place for place, name in enumerate(opened.symmetry) if name == "antisymmetric"]
    for name in "MCK":
        own = np.ix_(anti, anti)
        np.testing.assert_array_equal(getattr(kept, name)[own], getattr(opened, name)[own])
    near(
        eigenvalues(kept),
        np.linalg.eigvals(state_matrix(kept)),
        1e-6,
    )


# Laws of other programs, and refusals ---------------------------------------------------------------------------------


def test_laws_of_other_programs_have_the_same_response():
    num, den = [2.0, 1.0], [1.0, 3.0, 5.0]
    omega = np.array([0.3, 2.0, 11.0])
    expected = np.polyval(num, 1j * omega) / np.polyval(den, 1j * omega)
    for given in (
        (num, den),
        control.tf(num, den),
        control.ss(control.tf(num, den)),
        scipy.signal.TransferFunction(num, den),
        scipy.signal.StateSpace(*scipy.signal.tf2ss(num, den)),
    ):
        np.testing.assert_allclose(ControlLaw.of(given).response(omega)[:, 0, 0], expected, rtol=1e-12)
    several = control.tf([[num, [1.0]], [[3.0], [1.0, 0.0]]], [[den, [1.0, 2.0]], [[1.0, 4.0], [1.0, 7.0]]])
    np.testing.assert_allclose(
        ControlLaw.of(several).response(omega), np.moveaxis(several(1j * omega), -1, 0), rtol=1e-12
    )


REFUSED = {
    "improper": (
        dict(law=([1.0, 0.0, 0.0], [1.0, 2.0])),
        "numerator = [1.0, 0.0, 0.0]: must not have a higher",
    ),
    "discrete": (dict(law=control.tf([1.0], [1.0, 0.5], 0.1)), "must be continuous"),
    "no law": (dict(law="pid"), "must be a transfer function"),
    "zero denominator": (dict(law=([1.0], [0.0])), "must not be zero"),
    "sizes": (dict(sensors=("x", "y")), "need weights"),
    "weights": (dict(sensors=("x", "y"), weights=(1.0,)), "one for each of the 2 sensors"),
    "delay": (dict(delay=-1.0), "delay = -1.0"),
    "order": (dict(delay=0.1, delay_order=9), "whole number, 1 to 8"),
    "damping alone": (dict(actuator_damping=0.7), "actuator_bandwidth"),
    "schedule": (dict(scheduled_at=[2.0, 1.0], scheduled_gains=[1.0, 1.0]), "airspeeds or more that rise"),
    "half a schedule": (dict(scheduled_gains=[1.0, 1.0]), "scheduled_at"),
    "not finite": (dict(gain=np.nan), "must be finite"),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_a_loop_that_cannot_be_is_refused_in_one_message(kind):
    given, told = REFUSED[kind]
    with pytest.raises(pp.InputError) as error:
        ControlLoop(**{"name": "a", "sensors": "beam", "inputs": "collective"} | given)
    assert told in str(error.value) and len(str(error.value).splitlines()) == 1


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (dict(sensors="bean rate"), "control.loops[damper].sensors = bean rate: unknown motion; known"),
        (dict(sensors="azimuth"), "take its rate or acceleration"),
        (dict(inputs="gust_x"), "unknown input; known: collective, cyclic_1c, cyclic_1s"),
        (dict(inputs="flaperon"), "unknown input"),
    ],
)
def test_a_sensor_or_input_that_the_model_has_not_is_named_with_those_that_it_has(given, told):
    with pytest.raises(pp.InputError) as error:
        CASE.with_control(replace(DAMPER, **given)).linearize(SPEED)
    assert told in str(error.value)


def test_loops_without_a_solution_are_refused_and_spoil_no_other_point():
    m = 2.0
    exact = ControlLoop(name="a", sensors="pitch acceleration", inputs="collective", gain=m)
    with pytest.raises(pp.InputError, match="straight back to the loads"):
        close_loops(single(m, 0.1, 3.0), [exact])
    both = close_loops(single(m, 0.1, 3.0), [replace(exact, gain=np.array([m, 0.5]))])
    assert "straight back" in both.trim.reason[0] and both.trim.reason[1] == ""
    near(eigenvalues(both)[1], np.roots([m - 0.5, 0.1, 3.0]))


def test_a_law_that_is_unstable_by_itself_is_told_with_the_case():
    case = CASE.with_control(replace(DAMPER, law=([1.0], [1.0, -1.0])))
    assert any("unstable by itself, with a pole at 1 " in text for text in case.warnings)
    assert not any("unstable by itself" in text for text in case.with_control(DAMPER).warnings)


def test_a_delay_that_its_order_does_not_reach_makes_the_point_doubtful():
    case = CASE.with_control(replace(DAMPER, delay=0.1, delay_order=1))
    told = str(case.linearize(SPEED).trim.warning)
    limit = phase_limit(1) / 0.1 / (2 * np.pi)
    assert "control loop damper: its delay is approximated to order 1" in told and f"{limit:.3g} Hz" in told


def test_a_sensor_reads_what_the_state_space_has_as_output():
    model = CASE.open_loop(SPEED)
    space = model.to_state_space()
    omega = np.array([7.0])
    s = 1j * omega[0]
    motion = np.linalg.solve(s**2 * model.M + s * model.C + model.K, model.B)
    response = space.C @ np.linalg.solve(s * np.eye(len(space.A)) - space.A, space.B) + space.D
    for name in ("x", "alpha_y rate", "z acceleration", "gimbal_1c", "azimuth rate"):
        row = sensor(model, name).at(omega)[0]
        np.testing.assert_allclose(row @ motion, response[space.outputs.index(name)], rtol=1e-8, atol=1e-12)
