"""Boundaries against closed forms, and those of the XV-15 against other ways to them."""

import numpy as np
import pytest
from scipy.optimize import brentq

import proprotor as pp
from proprotor.model.first_order import state_matrix
from proprotor.stability.boundaries import boundaries, find_crossings
from proprotor.stability.cubic import hermite, hermite_extrema, hermite_root
from proprotor.stability.flutter import flutter_point
from proprotor.stability.parameter_lines import ParameterLine
from proprotor.stability.root_error import growth
from tests.known_systems import along

KNOT = 1852 / 3600


def crossings(matrices, positions, **options):
    return find_crossings(
        ParameterLine(np.asarray(positions, dtype=float), along(matrices), "p", "1"), **options
    )


def oscillator(damping, stiffness=lambda x: 100.0 + 0 * x):
    """One coordinate of unit mass."""
    return lambda x: (np.eye(1), damping(x) * np.eye(1), stiffness(x) * np.eye(1))


# Closed forms ---------------------------------------------------------------------------------------


def test_a_mode_that_loses_and_regains_its_damping():
    """λ² + cλ + 100 with c = (p - 3.21)(p - 7.89): onset at the first zero, recovery at the second."""
    found = crossings(oscillator(lambda x: (x - 3.21) * (x - 7.89)), np.arange(0, 11))
    first, second = found.boundaries
    assert (first.onset, second.onset) == (True, False)
    assert [first.position, second.position] == pytest.approx([3.21, 7.89], rel=1e-12)
    assert first.eigenvalue == pytest.approx(10j, abs=1e-10) and first.kind == "flutter"
    assert first.rate == pytest.approx((7.89 - 3.21) / 2, rel=1e-9)  # G = -c/2
    assert found.unstable_at_start == ()


@pytest.mark.parametrize("level", [-0.01, 0.0, 0.02, 0.05])
def test_any_damping_level(level):
    """ζ = c/20 with c = 2 - p: the level is passed at 2 - 20 ζ0."""
    (found,) = crossings(oscillator(lambda x: 2 - x), np.linspace(0, 5, 11), level=level).boundaries
    assert found.position == pytest.approx(2 - 20 * level, rel=1e-12)
    assert -found.eigenvalue.real / abs(found.eigenvalue) == pytest.approx(level, abs=1e-12)


def test_the_least_damping_of_a_search_is_told_with_its_mode_and_position():
    """ζ = c/20 with c = 1 + (p - 6)²: a twentieth at p = 6; beside it a mode of 30 % and a neutral one."""

    def three(x):
        damping = np.diag([6.0, 1.0, 0.0]) + (x - 6) ** 2 * np.diag([0.0, 1.0, 0.0])
        return np.eye(3), damping, np.diag([100.0, 100.0, 0.0])

    found = crossings(three, np.arange(0, 11), level=0.01)
    assert found.boundaries == () and found.searched == (0, 10)
    assert found.least.ratio == pytest.approx(1 / 20, rel=1e-12)
    assert found.least.position == 6 and found.least.mode == "q1"
    failed = crossings(oscillator(lambda x: 1 + 0 * x, lambda x: x + np.nan), np.arange(3)).least
    assert np.isnan(failed.ratio) and failed.mode == ""


def test_an_unstable_mode_is_the_least_damped():
    """Growth of a real root is -1, of a pair -Re λ/|λ|."""
    grown = crossings(oscillator(lambda x: 2 - x), np.arange(0, 6)).least
    assert grown.ratio == pytest.approx(-3 / 20, rel=1e-12) and grown.position == 5
    diverged = crossings(oscillator(lambda x: 5.0 + 0 * x, lambda x: 1 - x / 7.3), np.arange(0, 11)).least
    assert diverged.ratio == -1 and diverged.position == 8


@pytest.mark.parametrize("depth", [1e-1, 1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("at", [50.3, 52.5, 54.9])
def test_a_hump_between_two_points_of_the_scan_is_found(at, depth):
    """Damping dips through zero and returns within one step of 5: c = ((p - at)² - depth) / 100."""
    positions = np.arange(0, 101, 5.0)
    found = crossings(oscillator(lambda x: ((x - at) ** 2 - depth) / 100), positions)
    expected = [at - np.sqrt(depth), at + np.sqrt(depth)]
    assert [boundary.position for boundary in found.boundaries] == pytest.approx(expected, rel=1e-10)
    assert [boundary.onset for boundary in found.boundaries] == [True, False]


def test_a_narrow_hump_on_a_line_that_is_no_parabola():
    """The cubic of a step does not know this dip, and its error tells that it must be looked at."""

    def damping(x):
        return 1.0 - 1.05 * np.exp(-(((x - 42.3) / 4.0) ** 2))

    found = crossings(oscillator(damping), np.arange(0, 101, 5.0))
    half = 4.0 * np.sqrt(np.log(1.05))
    assert [boundary.position for boundary in found.boundaries] == pytest.approx([42.3 - half, 42.3 + half])


def test_a_dip_that_stays_above_the_level_is_no_boundary():
    found = crossings(oscillator(lambda x: ((x - 52.5) ** 2 + 1e-3) / 100), np.arange(0, 101, 5.0))
    assert found.boundaries == ()


def test_divergence_is_a_real_root_through_zero():
    """k = 1 - V/V_D with heavy damping: the slow root is zero where k is."""
    (found,) = crossings(
        oscillator(lambda x: 5.0 + 0 * x, lambda x: 1 - x / 7.3), np.arange(0, 11)
    ).boundaries
    assert found.position == pytest.approx(7.3, rel=1e-11)
    assert found.kind == "divergence" and found.onset and found.frequency == 0
    assert found.eigenvalue_rate == pytest.approx(1 / (5.0 * 7.3), rel=1e-9)


def test_divergence_of_a_pair_that_parts_within_the_same_step():
    """λ² + 0.1λ + 1 - V/V_D: stable pair at one end of a step, two real roots of either sign at the other."""
    (found,) = crossings(
        oscillator(lambda x: 0.1 + 0 * x, lambda x: 1 - x / 7.3), np.arange(0, 12, 2)
    ).boundaries
    assert found.position == pytest.approx(7.3, rel=1e-11)
    assert found.kind == "divergence"


def test_flutter_of_two_modes_by_routh():
    """Springs that airspeed couples against symmetry: λ⁴ + a λ³ + b λ² + c λ + d has a pair on the axis where
    c(ab - c) = a² d."""
    damping, still = np.diag([0.3, 0.5]), np.array([[90.0, 3.0], [3.0, 140.0]])
    air = np.array([[0.0, 40.0], [-30.0, -8.0]])
    found = crossings(lambda x: (np.eye(2), damping, still + x**2 * air), np.linspace(0, 2, 11))

    def routh(x):
        k = still + x**2 * air
        a, c = np.trace(damping), damping[0, 0] * k[1, 1] + damping[1, 1] * k[0, 0]
        b, d = np.trace(k) + np.linalg.det(damping), np.linalg.det(k)
        return c * (a * b - c) - a**2 * d

    (boundary,) = found.boundaries
    assert boundary.position == pytest.approx(brentq(routh, 0.2, 2.0, xtol=1e-14), rel=1e-11)
    assert boundary.onset and boundary.eigen_solves <= 12
    assert set(boundary.mechanism) <= {"q0", "q1"} and sum(boundary.mechanism.values()) == pytest.approx(1)


def test_the_crossing_of_modes_does_not_matter_to_a_boundary_between_them():
    """The mode that becomes unstable crosses another in the same step."""

    def matrices(x):
        stiffness = np.diag([100.0, 0.0]) + (60 + 10 * x) * np.diag([0.0, 1.0])
        return np.eye(2), np.diag([0.5, 0.0]) + (4.05 - x) * np.diag([0.0, 0.1]), stiffness

    (found,) = crossings(matrices, np.arange(0, 10, 3)).boundaries
    assert found.position == pytest.approx(4.05, rel=1e-11)
    assert max(found.mechanism, key=found.mechanism.get) == "q1" and found.mode == "q1"


def test_lines_that_fall_are_searched_as_those_that_rise():
    up = crossings(oscillator(lambda x: (x - 3.21) * (x - 7.89)), np.arange(0, 11)).boundaries
    down = crossings(oscillator(lambda x: (x - 3.21) * (x - 7.89)), np.arange(10, -1, -1)).boundaries
    assert [b.position for b in down] == pytest.approx([b.position for b in up], rel=1e-12)
    assert [b.onset for b in down] == [b.onset for b in up]


def test_no_line_of_failed_points_has_boundaries():
    found = crossings(lambda x: (np.eye(1), np.nan * x * np.eye(1), np.nan * x * np.eye(1)), [0.0, 1.0])
    assert found.boundaries == () and found.eigen_solves == 0


# Parts ----------------------------------------------------------------------------------------------


def test_cubics():
    """Of p³ - 2p² + p + 1 on (0, 2): values, extrema and a root."""
    from numpy.polynomial import Polynomial

    cubic = Polynomial([0.3, 1, -2, 1])
    ends = np.array([cubic(0), cubic(2), 2 * cubic.deriv()(0), 2 * cubic.deriv()(2)])[:, None]
    t = np.linspace(0, 1, 7)
    np.testing.assert_allclose(hermite(t, ends), cubic(2 * t), rtol=1e-13)
    np.testing.assert_allclose(
        np.sort(2 * hermite_extrema(ends)[0]), np.sort(cubic.deriv().roots()), rtol=1e-12
    )
    moved = np.array([-1.0, 2.0, 0.5, 0.1])[:, None]
    assert hermite(hermite_root(moved), moved) == pytest.approx(0, abs=1e-12)
    assert np.isnan(hermite_extrema(np.array([0.0, 1.0, 1.0, 1.0])[:, None])).all()


def test_growth_has_the_sign_of_what_damping_lacks():
    value = np.array([-1 + 10j, -0.1 + 10j, 0.1 + 10j, -2.0 + 0j])
    ratio = -value.real / np.abs(value)
    for level in (0.0, 0.02, 0.5):
        assert np.array_equal(growth(value, level) > 0, ratio < level)


# The XV-15 ------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


@pytest.fixture(scope="module")
def point(case):
    return case.flutter_point("50:420:5kt")


def test_the_boundaries_of_the_xv15_are_neutral_and_all_there_are(case, point):
    """Each has a root on the imaginary axis at its frequency, and the number of unstable roots changes there alone."""
    found = [boundary.position for boundary in point.boundaries]
    for boundary in point.boundaries:
        values = np.linalg.eigvals(state_matrix(case.linearize(boundary.position)))
        nearest = values[np.abs(values - 1j * boundary.frequency).argmin()]
        assert abs(nearest - 1j * boundary.frequency) < 1e-8 * boundary.frequency
    speeds = np.linspace(50, 420, 1851) * KNOT
    unstable = (np.linalg.eigvals(state_matrix(case.linearize(speeds))).real > 0).sum(axis=1)
    changes = speeds[:-1][np.diff(unstable) != 0]
    assert len(changes) == len(found) >= 2
    assert np.all((changes <= found) & (found <= changes + 0.2 * KNOT))


def test_a_boundary_costs_few_eigen_solves_and_does_not_depend_on_the_scan(case, point):
    other = case.flutter_point("60:420:17kt")
    assert other.speed == pytest.approx(point.speed, rel=1e-10)
    assert other.frequency == pytest.approx(point.frequency, rel=1e-9)
    for found in (point, other):
        assert all(boundary.eigen_solves <= 12 for boundary in found.boundaries)
        assert found.eigen_solves - found.scan_solves == sum(b.eigen_solves for b in found.boundaries)


def test_what_a_flutter_point_tells(case, point):
    assert point.mode == "chord" and point.kind == "flutter"
    assert point.unstable_at_start == ()
    assert case.flutter_point("50:100:10kt", section_damping=False).unstable_at_start == (
        "progressive pitch",
    )
    first = next(boundary for boundary in point.boundaries if boundary.onset)
    assert first.position == point.speed and max(first.mechanism, key=first.mechanism.get) == "chord"
    assert point.margin(point.speed / 1.2) == pytest.approx(0.2)
    assert point.margin(300 * KNOT) > 0


def test_the_rate_of_a_boundary_is_that_of_differences(case, point):
    first = next(boundary for boundary in point.boundaries if boundary.onset)
    ends = np.linalg.eigvals(state_matrix(case.linearize(first.position + np.array([-0.01, 0.01]))))
    nearest = [values[np.abs(values - first.eigenvalue).argmin()] for values in ends]
    assert (nearest[1] - nearest[0]) / 0.02 == pytest.approx(first.eigenvalue_rate, rel=1e-5)


def test_a_range_without_instability_has_no_flutter_point(case):
    calm = case.flutter_point("200:250:10kt")
    assert np.isnan(calm.speed) and calm.mode == "" and calm.boundaries == () and calm.unstable_at_start == ()
    assert np.isnan(calm.margin(100.0))
    modes = case.sweep("200:250:10kt")
    least = modes.damping_ratio.where(modes.damping_ratio == modes.damping_ratio.min(), drop=True)
    assert calm.least_damping == pytest.approx(least.item(), rel=1e-9)
    assert (calm.least_damping_mode, calm.least_damping_speed) == (least.mode.item(), least.airspeed.item())


def test_boundaries_in_another_input(case, point):
    """At the flutter speed of the deck, the deck's own control stiffness is a boundary of control stiffness."""
    own = case.given["rotor.control_stiffness"].si
    found = boundaries(case, point.speed, {"rotor.control_stiffness": np.linspace(0.9, 1.1, 5) * own})
    nearest = min(found.boundaries, key=lambda b: abs(b.position - own))
    assert nearest.position == pytest.approx(own, rel=1e-9)
    assert nearest.mode == "chord" and not nearest.onset  # a stiffer control system is the stable side


def test_bad_levels_are_refused(case):
    with pytest.raises(pp.InputError, match="damping ratio"):
        flutter_point(case, "300:400:50kt", level=2.0)


def test_a_boundary_in_an_input_of_finite_elements():
    """The wing of beams takes no complex numbers: its stiffness is a boundary at the flutter speed that it has."""
    wing = pp.load_case("xv15-wing")
    speed = wing.flutter_point("300:340:20kt").speed
    own = wing.given["support.beam_stiffness"].si
    found = boundaries(wing, speed, {"support.beam_stiffness": np.array([0.95, 1.03]) * own})
    assert min(abs(b.position - own) for b in found.boundaries) < 1e-6 * own
