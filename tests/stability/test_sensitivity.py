"""Exact derivatives against closed forms and against differences extrapolated to no step."""

from dataclasses import fields

import numpy as np
import pytest

import proprotor as pp
from proprotor.deck.vary import design_inputs
from proprotor.model.first_order import state_matrix
from proprotor.stability.eigenvalue_derivatives import defect
from proprotor.stability.flutter import flutter_point
from proprotor.stability.modes import decomposition
from proprotor.stability.sensitivity import _NEARLY_DEFECTIVE, _input_rates, damping_rate, sensitivity
from proprotor.support.beam_wing import beam_structure
from tests.known_systems import linear_model

KNOT = 1852 / 3600
AIRSPEED = 300 * KNOT
SPEED_OF_XV15 = 204.6  # m/s, roughly: of the chord mode with the hinges below
LEVELS = 7  # of differences, each with half the step of the one before
# Of eigenvalues and of flutter speeds: relative, for what changes them by more than a ten-thousandth part when it
# doubles. Below that rounding of the eigenvalues, some 1e-13 of the largest, is all that differences see.
EIGENVALUE, SPEED, LEAST = 1e-8, 1e-6, 1e-4


def extrapolated(values_at, at, step):
    """Richardson's limit of central differences (...,), the entry of its table that agrees best with its neighbours."""
    steps = step * 0.5 ** np.arange(LEVELS)
    values = values_at(np.concatenate([at + steps, at - steps]))
    column = (values[:LEVELS] - values[LEVELS:]) / (2 * steps.reshape(-1, *[1] * (values.ndim - 1)))
    best, error = column[0], np.full(column[0].shape, np.inf)
    for order in range(1, LEVELS):
        finer = (4**order * column[1:] - column[:-1]) / (4**order - 1)
        for row, entry in enumerate(finer):
            apart = np.maximum(np.abs(entry - column[row]), np.abs(entry - column[row + 1]))
            best, error = np.where(apart < error, entry, best), np.minimum(apart, error)
        column = finer
    return best


def largest_step(case, path):
    """A step of an input both ways that the case allows, at most a tenth of it."""
    own = float(case.given[path].si)
    step = 0.1 * (abs(own) or 0.1)
    for _ in range(8):
        try:
            case.vary({path: np.array([own - step, own + step])})
        except pp.InputError:
            step /= 3
        else:
            return step
    return 0.0


@pytest.fixture(scope="module")
def case():
    """The XV-15 with all flexibility a little away from the end of its range, so that it may vary both ways."""
    own = pp.load_case("xv15-uncoupled")
    inside = {
        "rotor.flap_outboard_fraction": 0.9,
        "rotor.lag_outboard_fraction": 0.9,
        "rotor.airfoil.moment": -0.01,
    }
    return own.vary(inside | {"rotor.airfoil.zero_lift_angle": -0.01})


# Closed forms ---------------------------------------------------------------------------------------


def test_an_oscillator():
    """λ = -ζω + iω√(1 - ζ²) by m, c and k of mλ² + cλ + k."""
    given = {"m": 2.0, "c": 0.6, "k": 50.0}

    def linearize(values):
        m, c, k = (np.asarray(values[name])[..., None, None] * np.eye(1) for name in "mck")
        return linear_model(m, c, k)

    model = linearize(given)
    spectrum = decomposition(model)
    mode = spectrum.modes(np.flatnonzero(spectrum.values.imag > 0))
    value = mode.values[0]
    slope = 2 * given["m"] * value + given["c"]
    expected = [-(value**2) / slope, -value / slope, -1 / slope]
    np.testing.assert_allclose(_input_rates(linearize, given, model, mode)[:, 0], expected, rtol=1e-13)


def test_the_change_of_a_damping_ratio():
    value, change = np.array([-0.3 + 4j, -2.0 + 0j, 0j]), np.array([0.2 - 0.7j, 1.0 + 0j, 1.0 + 0j])
    step = 1e-7
    moved = value + step * np.outer([1, -1], change)
    with np.errstate(all="ignore"):
        ratio = -moved.real / np.abs(moved)
    expected = (ratio[0] - ratio[1]) / (2 * step)
    found = damping_rate(value, change)
    np.testing.assert_allclose(found[:2], expected[:2], rtol=1e-8, atol=1e-9)
    assert np.isnan(found[2])


# The XV-15 ------------------------------------------------------------------------------------------


def test_eigenvalues_by_every_input_of_the_deck(case):
    found = sensitivity(case, "eigenvalue", airspeed=AIRSPEED)
    values, compared = found.eigenvalue.values, 0
    for path in found.input.values.tolist():

        def values_at(numbers, path=path):
            every = np.linalg.eigvals(state_matrix(case.vary({path: numbers}).linearize(AIRSPEED)))
            nearest = np.abs(every[:, None, :] - values[:, None]).argmin(axis=2)
            return np.take_along_axis(every, nearest, axis=1)

        own, step = float(case.given[path].si), largest_step(case, path)
        assert step > 0, path
        limit = extrapolated(values_at, own, step)
        exact = found.derivative.sel(input=path).values
        scale = np.maximum(np.abs(exact), LEAST * np.abs(values) / (abs(own) or 1.0))
        assert (np.abs(limit - exact) / scale).max() < EIGENVALUE, path
        compared += 1
    assert compared == len(design_inputs(case)) >= 30


def neutral_points(design, near, points):
    """Airspeed and eigenvalue (k,) at which the root of each design that is nearest to one at hand has no growth."""

    def root(speed):
        every = np.linalg.eigvals(state_matrix(design.linearize(speed)))
        return every[np.arange(len(every)), np.abs(every - near).argmin(axis=1)]

    old, new = np.full(points, SPEED_OF_XV15 - 0.2), np.full(points, SPEED_OF_XV15 + 0.2)
    before, here = root(old), root(new)
    for _ in range(8):  # the secant method on all of them, until rounding
        with np.errstate(all="ignore"):
            step = -here.real * (new - old) / (here.real - before.real)
        old, before = new, here
        new = new + np.where(np.isfinite(step), step, 0)
        here = root(new)
    return np.stack([new, here.imag], axis=1)


def test_the_flutter_speed_by_every_input_of_the_deck(case):
    found = sensitivity(case, airspeed="330:410:20kt")
    assert found.attrs["value"] == pytest.approx(SPEED_OF_XV15, abs=0.5)
    frequency = neutral_points(case, 33j, 1)[0, 1]
    paths = found.input.values.tolist()
    own = np.array([float(case.given[path].si) for path in paths])
    step = np.array([largest_step(case, path) for path in paths]) / 8
    moves = step[:, None] * np.array([1, 0.25, -1, -0.25])
    # One batch: four designs for each input, all other inputs as they are.
    each = np.repeat(np.arange(len(paths)), 4)
    varied = case.vary({path: own[k] + np.where(each == k, moves.ravel(), 0) for k, path in enumerate(paths)})
    both = neutral_points(varied, 1j * frequency, len(each)).reshape(len(paths), 4, 2)
    by_step = (both[:, :2] - both[:, 2:]) / (2 * moves[:, :2, None])
    limit = (16 * by_step[:, 1] - by_step[:, 0]) / 15
    exact = np.stack([found.derivative.values, found.frequency_derivative.values], axis=1)
    size = np.array([SPEED_OF_XV15, frequency]) / np.where(own == 0, 1, np.abs(own))[:, None]
    error = np.abs(limit - exact) / np.maximum(np.abs(exact), 10 * LEAST * size)
    assert error.max() < SPEED, dict(zip(paths, error.max(axis=1), strict=True))
    assert found.sizes["input"] == len(design_inputs(case)) >= 30


def test_damping_of_one_mode(case):
    paths = ["rotor.precone", "rotor.chord"]
    found = sensitivity(case, "damping", paths, airspeed=AIRSPEED, mode="chord")
    assert found.derivative.shape == (2, 1) and found.damping.item() > 0
    for path in paths:

        def ratio_at(numbers, path=path):
            every = np.linalg.eigvals(state_matrix(case.vary({path: numbers}).linearize(AIRSPEED)))
            target = sensitivity(
                case, "eigenvalue", [path], airspeed=AIRSPEED, mode="chord"
            ).eigenvalue.item()
            nearest = every[np.arange(len(every)), np.abs(every - target).argmin(axis=1)]
            return -nearest.real / np.abs(nearest)

        limit = extrapolated(ratio_at, float(case.given[path].si), largest_step(case, path))
        assert found.derivative.sel(input=path).item() == pytest.approx(limit, rel=1e-8)


@pytest.mark.parametrize("level", [0.01, 0.02])
def test_a_boundary_of_another_level(case, level):
    path = "support.modes[chord].damping_ratio"
    found = sensitivity(case, wrt=[path], airspeed="300:390:30kt", mode="chord", level=level)
    own = float(case.given[path].si)
    speeds = []
    for value in (own * 1.01, own * 0.99):
        every = flutter_point(case.vary({path: value}), "300:390:30kt", level=level).boundaries
        speeds.append(next(boundary.position for boundary in every if boundary.mode == "chord"))
    assert found.derivative.item() == pytest.approx((speeds[0] - speeds[1]) / (0.02 * own), rel=1e-4)


def test_density_and_chord_act_alike():
    """Airloads are proportional to ρ c, but for the damping of turning sections, and nothing else depends on either:

    p dV/dp is the same.
    """
    inputs = ["operation.density", "rotor.chord"]
    relative = pp.load_case("xv15-uncoupled").sensitivity(wrt=inputs, section_damping=False).relative.values
    assert relative[0] == pytest.approx(relative[1], rel=1e-10)


def test_what_a_dataset_tells(case):
    found = sensitivity(case, wrt=["rotor.precone", "operation.rotor_speed"], airspeed="350:410:20kt")
    assert found.unit.values.tolist() == ["rad", "rad/s"]
    assert found.value.values.tolist() == [case.given[path].si for path in found.input.values]
    np.testing.assert_allclose(found.relative, found.derivative * found.value)
    assert found.attrs["mode"] == "chord" and 350 * KNOT < found.attrs["value"] < 410 * KNOT
    assert found.defect >= 1 and not found.nearly_defective


def test_a_nearly_defective_root_is_flagged():
    """Two oscillators with C = diag(c ± d) and K = diag(k ± dc/2), coupled by ε.

    With s = λ² + cλ + k their roots have s² = ε² + d² (λ + c/2)², and two fall into one at s = 0 and ε = dω.
    """
    c, d, k = 0.2, 0.1, 100.0
    double = d * np.sqrt(k - c**2 / 4)

    def worst(coupling):
        between = coupling * np.array([[0.0, 1.0], [1.0, 0.0]])
        stiffness = np.diag([k + d * c / 2, k - d * c / 2]) + between
        return defect(
            decomposition(linear_model(np.eye(2), np.diag([c + d, c - d]), stiffness)).all_modes
        ).max()

    assert worst(0.0) == pytest.approx(1, abs=0.02)
    assert worst(double * (1 + 1e-4)) > _NEARLY_DEFECTIVE
    assert worst(3 * double) < _NEARLY_DEFECTIVE


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"of": "flutter"}, "must be one of flutter_speed, damping, eigenvalue"),
        ({"wrt": ["rotor.precon"]}, "did you mean rotor.precone"),
        ({"of": "damping"}, "must be given"),
        ({"of": "damping", "airspeed": 150.0, "mode": "cord"}, "did you mean chord"),
        ({"of": "damping", "airspeed": [150.0, 160.0]}, "must be one speed"),
        ({"of": "damping", "airspeed": 1000.0}, "Mach"),
        ({"airspeed": "200:250:25kt"}, "nothing becomes unstable"),
        ({"airspeed": "200:250:25kt", "mode": "beam"}, "has no boundary"),
    ],
)
def test_what_cannot_be_had_is_told(case, arguments, message):
    with pytest.raises(pp.InputError, match=message):
        sensitivity(case, **arguments)


def near_eigenvalue(case, near, path, value):
    """The eigenvalue that is nearest to another one, with another value of an input."""
    every = np.linalg.eigvals(state_matrix(case.vary({path: value}).linearize(AIRSPEED)))
    return every[np.abs(every - near).argmin()]


def test_inputs_of_a_beam_wing_are_exact():
    """Through the modes of the wing, its damping and its airloads."""
    wing = pp.load_case("xv15-wing", OFFSET_WING)
    paths = [path for path in design_inputs(wing) if path.startswith("support.")]
    found = sensitivity(wing, "eigenvalue", paths, airspeed=AIRSPEED, mode="beam")
    assert found.exact.values.all()
    near = found.eigenvalue.item()
    for path in paths:
        own = float(wing.given[path].si)
        step = 1e-3 * (abs(own) or 1.0)
        ends = [near_eigenvalue(wing, near, path, own + sign * step) for sign in (-2, -1, 1, 2)]
        limit = np.dot([1, -8, 8, -1], ends) / (12 * step)
        derivative = found.derivative.sel(input=path).item()
        assert abs(derivative - limit) * step < 1e-8 * abs(near) * 1e-3, path


OFFSET_WING = {
    "support.mass_forward": "-4 in",
    "support.mass_up": "2 in",
    "support.downstop": "false",
    "support.wing_aerodynamics.lift_slope": "5.7 /rad",
    "support.wing_aerodynamics.chord": "5.25 ft",
    "support.wing_aerodynamics.elastic_axis": "0.35",
}


@pytest.mark.parametrize("path", ["support.beam_stiffness", "support.mast_length", "support.mass_forward"])
def test_the_flutter_speed_of_a_beam_wing(path):
    wing = pp.load_case("xv15-wing", {"support.mass_forward": "-4 in"})
    found = sensitivity(wing, wrt=[path], airspeed="310:350:20kt")
    assert found.exact.item()
    own = float(wing.given[path].si)
    ends = [
        flutter_point(wing.vary({path: own * (1 + share)}), "310:350:20kt").boundaries[0].position
        for share in (-1e-3, 1e-3)
    ]
    assert found.derivative.item() == pytest.approx((ends[1] - ends[0]) / (2e-3 * own), rel=1e-4)


def test_numbers_of_a_file_are_derived_by_differences(tmp_path):
    """A file takes no complex numbers: its inputs are told to be less than exact, and are right."""
    wing = pp.load_case("xv15-wing", {"support.elements": "2"})
    given = {path.removeprefix("support."): number.si for path, number in wing.given.items()}
    parts = [
        kind(**{entry.name: given[entry.name] for entry in fields(kind) if entry.name in given})
        for kind in (pp.Wing, pp.Pylon)
    ]
    structure = beam_structure(*parts)
    np.savez(tmp_path / "wing.npz", mass=structure.mass, stiffness=structure.stiffness, dofs=structure.names)
    (tmp_path / "filed.toml").write_text(FILED, encoding="utf-8")
    case = pp.load_case(tmp_path / "filed.toml")
    paths = ["rotor.precone", "support.rotor_mass", "support.damping_ratio"]
    found = sensitivity(case, "eigenvalue", paths, airspeed=AIRSPEED, mode="mode_1")
    assert found.exact.values.tolist() == [True, False, False]
    near = found.eigenvalue.item()
    for path in paths:
        own = float(case.given[path].si)
        ends = [near_eigenvalue(case, near, path, own * factor) for factor in (0.999, 1.001)]
        limit = (ends[1] - ends[0]) / (0.002 * own)
        assert found.derivative.sel(input=path).item() == pytest.approx(limit, rel=1e-4)


FILED = """
base = "xv15"
[case]
name = "filed"
title = "filed"
[support]
kind = "matrices"
file = "wing.npz"
includes_rotor = false
rotor_mass = "12.42 slug"
modes = 6
damping_ratio = "1 %"
"""
