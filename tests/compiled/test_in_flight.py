"""Trim and matrices of rotors in one compiled call: beside NumPy's, for which points, and alike in any company."""

from dataclasses import replace
from importlib import import_module

import numpy as np
import pytest

import proprotor as pp
from proprotor.compiled.library import why_not
from proprotor.units import KNOT

pytestmark = pytest.mark.skipif("there is no C compiler" in why_not(), reason="there is no C compiler")
rotor_model = import_module("proprotor.model.rotor_model")  # the package has a function of this name
SPEEDS = np.linspace(20, 420, 21) * KNOT
OPTIONS = (
    {},
    {"pitch": "rigid"},
    {"compressibility": False},
    {"rotor_speed": "constant"},
    {"locked": ("lag",)},
    {"locked": ("flap", "pitch")},
    {"structure": "diagonal"},
)
NAMES = ("coning", "lag", "elastic_pitch", "collective", "thrust", "torque")


@pytest.fixture
def served(monkeypatch):
    """Which points one call served, of each batch."""
    found, genuine = [], rotor_model.find_in_flight

    def recorded(*rotors):
        result = genuine(*rotors)
        found.append(result.served)
        return result

    monkeypatch.setattr(rotor_model, "find_in_flight", recorded)
    return found


def random_rotors(rng, count):
    """Designs of the XV-15, some far from any rotor, as values of their inputs."""
    return {
        "rotor.precone": rng.uniform(0.0, 0.06, (count, 1)),
        "rotor.control_stiffness": 10 ** rng.uniform(3.2, 5, (count, 1)),
        "rotor.chord": rng.uniform(0.2, 0.6, (count, 1)),
        "rotor.lag_frequency": rng.uniform(4.0, 70.0, (count, 1)),
        "operation.density": 10 ** rng.uniform(-1.5, 0.5, (count, 1)),
        "operation.rotor_speed": rng.uniform(30.0, 75.0, (count, 1)),
    }


def assert_alike(one, other):
    """Assert that trims and rotors are the same, for whatever reason points failed or are doubtful."""
    for name in ("converged", "reason", "warning"):
        assert (getattr(one.trim, name) == getattr(other.trim, name)).all()
    for name in NAMES:
        expected, found = getattr(one.trim, name), getattr(other.trim, name)
        scale = max(1.0, np.nanmax(np.abs(expected), initial=0.0))
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * scale)
    for name, expected in one.rotor.matrices.items():
        size = np.abs(np.nan_to_num(expected)).max(axis=(-2, -1), keepdims=True) + 1e-300
        found = other.rotor.matrices[name]
        np.testing.assert_allclose(found / size, expected / size, rtol=0, atol=2e-11, err_msg=name)


@pytest.mark.parametrize(
    "options", OPTIONS, ids=lambda options: ", ".join(map(str, options.values())) or "usual"
)
@pytest.mark.parametrize("trim", ["windmilling", "thrust", "collective"])
def test_random_rotors_are_numpys_and_those_without_reservation_are_served(options, trim, served):
    case, rng = pp.load_case("xv15-uncoupled"), np.random.default_rng(0)
    case = case.vary(random_rotors(rng, 12))
    given = {
        "windmilling": "windmill",
        "thrust": {"thrust_coefficient": 0.002},
        "collective": {"collective": 0.7},
    }
    case = replace(case, operation=replace(case.operation, trim=given[trim]))
    one, other = (case.linearize(SPEEDS, backend=backend, **options) for backend in ("numpy", "compiled"))
    assert_alike(one, other)
    (at_once,) = served
    usual = (one.trim.converged & (one.trim.warning == "")).ravel()
    assert not (at_once & ~usual).any() and at_once[usual].mean() > 0.95 and 0 < at_once.sum() < at_once.size


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("airspeed", 0.0),
        ("airspeed", 320.0),
        ("density", 0.0),
        ("density", 1e-9),
        ("speed_of_sound", 200.0),
    ],
)
def test_a_point_with_a_reservation_is_left_to_the_search(field, value, served):
    case, speeds = pp.load_case("xv15"), np.array([80.0, 100.0, 120.0])
    if field == "airspeed":
        speeds[1] = value
    else:
        numbers = np.full(3, getattr(case.operation, field))
        numbers[1] = value
        case = replace(case, operation=replace(case.operation, **{field: numbers}))
    one, other = (case.linearize(speeds, backend=backend) for backend in ("numpy", "compiled"))
    assert_alike(one, other)
    (at_once,) = served
    usual = one.trim.converged & (one.trim.warning == "")
    assert (at_once == usual).all() and at_once[[0, 2]].all()


def test_a_limp_lag_hinge_is_left_to_the_search(served):
    case, limp = (
        pp.load_case("xv15"),
        dict.fromkeys(("flap_hinge_offset", "lag_hinge_offset", "lag_stiffness"), 0.0),
    )
    case = replace(case, rotor=replace(case.rotor, **limp))
    case.linearize(SPEEDS[:3], backend="compiled")
    assert not served[0].any()


def test_a_rotor_has_the_same_bits_in_any_company():
    case, rng = pp.load_case("xv15-uncoupled"), np.random.default_rng(1)
    numbers = random_rotors(rng, 21)
    whole = case.vary(numbers).linearize(SPEEDS[8:11], backend="compiled")
    order = rng.permutation(21)
    turned = case.vary({name: array[order] for name, array in numbers.items()})
    again = turned.linearize(SPEEDS[8:11], backend="compiled")
    few = case.vary({name: array[5:6] for name, array in numbers.items()})
    alone = few.linearize(SPEEDS[8:11], backend="compiled")
    for name in "MCKB":
        expected = getattr(whole, name)
        np.testing.assert_array_equal(getattr(again, name), expected[order])
        np.testing.assert_array_equal(getattr(alone, name), expected[5:6])
    for name in NAMES:
        np.testing.assert_array_equal(getattr(again.trim, name), getattr(whole.trim, name)[order])


def test_one_point_is_that_of_a_batch_and_a_point_that_fails_spoils_no_other():
    case = pp.load_case("xv15")
    batch = case.linearize(SPEEDS[5:10], backend="compiled")
    bad = SPEEDS[5:10].copy()
    bad[3] = np.nan
    spoiled = case.linearize(bad, backend="compiled")
    alone = case.linearize(float(SPEEDS[7]), backend="compiled")
    for name in "MCKB":
        expected, found = getattr(batch, name), getattr(spoiled, name)
        assert np.isnan(found[3]).all()
        np.testing.assert_array_equal(np.delete(found, 3, 0), np.delete(expected, 3, 0))
        np.testing.assert_array_equal(getattr(alone, name), expected[2])
    assert alone.trim.thrust == batch.trim.thrust[2] and alone.trim.iterations == batch.trim.iterations[2]


def test_derivatives_by_a_complex_step_have_numpys_trims_and_reasons():
    case = pp.load_case("xv15-uncoupled").vary({"rotor.precone": np.linspace(0.0, 0.05, 7)})
    speeds = np.array([0.0, 60.0, 100.0, 150.0, 190.0, 240.0, 400.0])  # the first and the last have no trim
    one, other = (case.linearize(speeds + 1e-30j, backend=backend) for backend in ("numpy", "compiled"))
    assert (one.trim.reason == other.trim.reason).all() and (one.trim.warning == other.trim.warning).all()
    assert (one.trim.reason != "").tolist() == [True, *[False] * 5, True]
    for name in "MCK":
        for part in (np.real, np.imag):
            expected = part(getattr(one, name))
            scale = np.nanmax(np.abs(expected))
            np.testing.assert_allclose(part(getattr(other, name)), expected, rtol=0, atol=1e-12 * scale)


# Ranges in which some trims lie beyond what the bound shows, and take the path of loads.
FAR = {
    "rotor.precone": (-0.1, 0.25),
    "rotor.control_stiffness": (2e3, 4e4),
    "rotor.chord": (0.2, 1.2),
    "operation.density": (0.2, 2.4),
}


FREE_TO_PITCH = [
    one for one in OPTIONS if "rigid" not in one.values() and "pitch" not in one.get("locked", ())
]


@pytest.mark.parametrize(
    "options", FREE_TO_PITCH, ids=lambda options: ", ".join(map(str, options.values())) or "usual"
)
@pytest.mark.parametrize("trim", ["windmilling", "thrust", "collective"])
def test_trims_far_from_the_undeflected_blade_are_followed_step_by_step_as_numpy_does(
    options, trim, monkeypatch
):
    solver, rng = import_module("proprotor.rotor.trim_solver"), np.random.default_rng(1)
    inputs = {name: rng.uniform(*ends, (16, 1)) for name, ends in FAR.items()}
    case = pp.load_case("xv15-uncoupled").vary(inputs)
    given = {
        "windmilling": "windmill",
        "thrust": {"thrust_coefficient": 0.01},
        "collective": {"collective": 0.7},
    }
    case = replace(case, operation=replace(case.operation, trim=given[trim]))
    followed, genuine = [], solver.follow

    def recorded(balance, state, rows, iterations):
        path = genuine(balance, state, rows, iterations)
        followed.append((balance.options.backend, path.arrived.sum()))
        return path

    monkeypatch.setattr(solver, "follow", recorded)
    one, other = (case.linearize(SPEEDS, backend=backend, **options) for backend in ("numpy", "compiled"))
    assert_alike(one, other)
    same = one.trim.iterations == other.trim.iterations
    assert same[one.trim.converged].mean() > 0.99  # where rounding does not decide on one step more
    arrived = {
        backend: sum(count for by, count in followed if by == backend) for backend in ("numpy", "compiled")
    }
    assert arrived["numpy"] > 5 and arrived["compiled"] <= 0.05 * arrived["numpy"]
