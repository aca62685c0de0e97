"""Boundaries: the same for every scan and every way to ask, none lost beside fast or neutral roots, none made up."""

import numpy as np
import pytest
from scipy.optimize import brentq

import proprotor as pp
from proprotor import sampling
from proprotor.model.first_order import state_matrix
from proprotor.stability.boundaries import boundaries, find_crossings
from proprotor.stability.brackets import Brackets
from proprotor.stability.crossings import Search
from proprotor.stability.parameter_lines import ParameterLine
from proprotor.study.study import study
from proprotor.study.variables import STABLE, UNSTABLE
from tests.known_systems import along, roots
from tests.rotors import Flight, random_support
from tests.stability.test_root_error import exact_roots

KNOT = 1852 / 3600
RPM_458 = 458 * (np.pi / 30)
STIFFNESS, PRECONE = "rotor.control_stiffness", "rotor.precone"
PLAIN = {"section_damping": False}
TABULATED = {
    "section_damping": False,
    "structure": "tabulated",
    "frequencies": pp.BladeFrequencies(
        at_rotor_speed=RPM_458, against="airspeed", at=[0, 300], flap=1.85, lag=[1.3, 1.4]
    ),
}


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


def crossings(matrices, positions, **options):
    return find_crossings(
        ParameterLine(np.asarray(positions, dtype=float), along(matrices), "p", "1"), **options
    )


def told(found):
    return [(b.position, b.onset) for b in found.boundaries]


# Every scan tells the same -------------------------------------------------------------------------


def test_two_crossings_of_a_level_four_hundredths_of_a_knot_apart_are_found_by_every_scan(case):
    """A level next to where the least damping of all modes turns round: dense roots pass it twice, .04 kt apart."""
    knots = np.linspace(362, 370, 8001)
    values = np.linalg.eigvals(state_matrix(case.linearize(knots * KNOT)))
    ratio = np.where(values.imag > 0, -values.real / np.abs(values), np.inf).min(axis=-1)
    lowest = int(ratio.argmin())
    level = float(ratio[lowest - 20] + ratio[lowest + 20]) / 2
    expected = knots[np.flatnonzero(np.diff(ratio < level))]
    assert len(expected) == 2 and 0.03 < expected[1] - expected[0] < 0.05
    for scan in ("100:420:2kt", "100:420:5kt", "100:420:20kt", "358:378:20kt", "90:440:70kt"):
        found = case.flutter_point(scan, level=level)
        near = np.array([b.position / KNOT for b in found.boundaries if 362 < b.position / KNOT < 370])
        assert len(near) == 2, scan
        assert near == pytest.approx(expected, abs=0.003), scan


@pytest.mark.parametrize("points", [2, 3, 5, 12])
def test_roots_that_exchange_damping_where_they_pass_are_seen_from_afar(points):
    """Two oscillators, one damped and one hardly, coupled against symmetry: where they meet one grows, nowhere else."""
    width = 0.35

    def matrices(x):
        apart = 4.0 * (x - 6.13)
        stiffness = np.diag([100.0, 0.0]) + (100 + apart) * np.diag([0.0, 1.0])
        coupling = np.array([[0.0, width], [-width, 0.0]])
        return np.eye(2), 0.03 * np.eye(2) + 0 * x, stiffness + coupling

    dense = np.linspace(0, 10, 20001)
    unstable = (roots(along(matrices)(dense)).real > 0).sum(axis=1)
    expected = dense[np.flatnonzero(np.diff(unstable))]
    assert len(expected) == 2
    found = crossings(matrices, np.linspace(0, 10, points))
    assert [b.position for b in found.boundaries] == pytest.approx(expected, abs=5.1e-4)
    assert [b.onset for b in found.boundaries] == [True, False]


@pytest.mark.parametrize("points", [3, 4, 5, 7, 8, 20, 40])
@pytest.mark.parametrize("width", [0.29, 0.3005, 0.305, 0.35, 1.0])
@pytest.mark.parametrize("rate", [0.4, 4.0, 12.0])
def test_a_search_for_onsets_sees_what_lies_between_its_points(points, width, rate):
    """The same two, as a study looks for them: by eigenvalues first. At 0.29 the damping is not all exchanged."""

    def matrices(x):
        stiffness = np.diag([100.0, 0.0]) + (100 + rate * (x - 6.13)) * np.diag([0.0, 1.0])
        coupling = np.array([[0.0, width], [-width, 0.0]])
        return np.eye(2), 0.03 * np.eye(2) + 0 * x, stiffness + coupling

    dense = np.linspace(0, 10, 20001)
    unstable = (roots(along(matrices)(dense)).real > 0).any(axis=1)
    assert unstable.any() == (width > 0.3) and not unstable[0]
    scan = np.linspace(0, 10, points)
    search = Search(lambda _, x: along(matrices)(x), np.zeros(points, dtype=int), scan, onset_only=True)
    found = min((one.position for one in Brackets(search).close() if one.onset), default=np.inf)
    assert found == pytest.approx(dense[unstable.argmax()] if unstable.any() else np.inf, abs=5.1e-4)


@pytest.mark.parametrize("points", [2, 4, 9])
def test_a_pair_that_is_two_real_roots_for_a_while_diverges_meanwhile(points):
    """λ² + 2λ + k with k = (p - 4.2)² - 0.01: one real root beyond zero within a step whose ends are pairs."""

    def matrices(x):
        return np.eye(1), 2 * np.eye(1) + 0 * x, ((x - 4.2) ** 2 - 0.01) * np.eye(1)

    found = crossings(matrices, np.linspace(0, 10, points))
    assert [b.position for b in found.boundaries] == pytest.approx([4.1, 4.3], rel=1e-9)
    assert [(b.kind, b.onset) for b in found.boundaries] == [("divergence", True), ("divergence", False)]


@pytest.mark.parametrize("points", [2, 3, 4, 5, 7, 12])
def test_a_real_root_that_crosses_and_comes_back_before_it_joins_another_is_seen(points):
    """λ² + 2aλ + c(p - r)(p - s): real roots at one end of a step, a pair at the other, divergence from r to s."""
    random = np.random.default_rng(3)
    for _ in range(60):
        first, second = np.sort(random.uniform(1, 9, 2))
        damping, stiffness = random.uniform(0.3, 2.0), random.uniform(0.02, 2.0)

        def matrices(x, a=damping, c=stiffness, r=first, s=second):
            return np.eye(1), 2 * a * np.eye(1) + 0 * x, c * (x - r) * (x - s) * np.eye(1)

        found = told(crossings(matrices, np.linspace(0, 10, points)))
        assert found == [(pytest.approx(first), True), (pytest.approx(second), False)]


@pytest.mark.parametrize("points", [2, 3, 4, 9])
@pytest.mark.parametrize("mirrored", [False, True])
def test_real_roots_on_both_sides_of_the_level_that_join_below_it_cross_it_twice(points, mirrored):
    """λ = μ ± √δ with μ = (p - 6)/10 and δ = 1 - p/5: one root falls before both meet, and the pair rises after."""

    def matrices(x):
        p = 10 - x if mirrored else x
        middle, split = (p - 6) / 10, 1 - p / 5
        return np.eye(1), -2 * middle * np.eye(1), (middle**2 - split) * np.eye(1)

    found = crossings(matrices, np.linspace(0, 10, points))
    expected = [(-0.08 + 0.032**0.5) / 0.02, 6.0]
    expected = [10 - p for p in reversed(expected)] if mirrored else expected
    assert [b.position for b in found.boundaries] == pytest.approx(expected, rel=1e-8)
    assert [b.onset for b in found.boundaries] == [False, True]
    kinds = ["divergence", "flutter"]
    assert [b.kind for b in found.boundaries] == (kinds[::-1] if mirrored else kinds)


def test_positions_may_come_in_any_order(case):
    speeds = np.arange(60, 400, 20) * KNOT
    expected = case.flutter_point(speeds, **PLAIN)
    assert expected.unstable_at_start and expected.searched == pytest.approx((speeds[0], speeds[-1]))
    for order in (speeds[::-1], np.random.default_rng(0).permutation(speeds), np.repeat(speeds, 2)):
        found = case.flutter_point(order, **PLAIN)
        assert told(found) == told(expected)
        assert found.unstable_at_start == expected.unstable_at_start and found.searched == expected.searched


def test_where_a_range_cannot_be_analysed_it_says_why(case):
    found = case.flutter_point("300:700:20kt")
    (failed,) = found.failed
    assert "Mach" in failed.reason and failed.last == pytest.approx(700 * KNOT)
    assert failed.first == found.searched[1]
    # It ends where the tip is at Mach 1, but for a 64th of a step.
    operation = case.operation
    limit = np.sqrt(operation.speed_of_sound**2 - (operation.rotor_speed * case.rotor.radius) ** 2)
    assert limit - 20 / 64 * KNOT - 1e-9 <= found.searched[1] <= limit
    assert "Not analysed" in repr(found) and "Mach" in repr(found)
    assert case.flutter_point("300:400:20kt").failed == ()


def test_a_boundary_next_to_where_analysis_ends_is_found():
    """Damping 2.9 - p, and no model from 3 on: the last point that works is 2."""

    def matrices(x):
        gone = np.where(np.real(x) > 3.0, np.nan, 0.0)
        return np.eye(1), (2.9 - x) * np.eye(1), (100.0 + 0 * x + gone) * np.eye(1)

    found = crossings(matrices, [0.0, 2.0, 4.0, 6.0])
    assert told(found) == [(pytest.approx(2.9, rel=1e-12), True)]
    assert found.failed == ((found.searched[1], 6.0, "fails here"),) and 2.96 < found.searched[1] <= 3.0


def test_a_jump_of_the_model_is_told_and_is_no_boundary():
    """Damping 1 that is -1 from 3.3 on: nothing crosses zero, and it says where it passes it."""

    def matrices(x):
        return (
            np.eye(1),
            np.where(np.real(x) < 3.3, 1.0, -1.0) * np.eye(1) + 0 * x,
            (100.0 + 0 * x) * np.eye(1),
        )

    found = crossings(matrices, np.arange(0.0, 11.0, 2.0))
    assert found.boundaries == ()
    (failed,) = found.failed
    assert failed.first == pytest.approx(3.3, rel=1e-12) and "jumps" in failed.reason


# Neutral -------------------------------------------------------------------------------------------


def test_a_root_that_is_neutral_all_along_crosses_nothing():
    """An undamped oscillator, and one that loses its damping at 3.3, with gyroscopic terms between two more."""
    turning = np.array([[0.0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]])

    def matrices(x):
        damping = 4 * turning + (3.3 - x) * np.diag([0, 0, 0, 0.1])
        return np.eye(4), damping, np.diag([70.0, 130.0, 200.0, 300.0]) + x * np.diag([1.0, 2.0, 3.0, 4.0])

    found = crossings(matrices, np.linspace(0, 10, 6))
    assert told(found) == [(pytest.approx(3.3, rel=1e-12), True)]
    assert found.unstable_at_start == ()


def test_undamped_modes_that_fall_into_one_become_unstable_there():
    """k = diag(100, 140) with ±a p between: λ² = -120 ± √(400 - a²p²), neutral until ap = 20."""

    def matrices(x):
        between = np.array([[0.0, 1.0], [-1.0, 0.0]])
        return np.eye(2), np.zeros((2, 2)), np.diag([100.0, 140.0]) + 3 * x * between

    found = crossings(matrices, np.linspace(0, 10, 8))
    (boundary,) = found.boundaries
    assert boundary.position == pytest.approx(20 / 3, rel=1e-7) and boundary.onset
    assert abs(boundary.eigenvalue - 1j * np.sqrt(120)) < 1e-3


@pytest.mark.parametrize("stiffness", [1e9, 1e13, 1e18])
def test_a_stiff_control_system_hides_no_boundary(case, stiffness):
    """The flutter speed of the wing with a control system that is all but rigid, by roots in 60 digits."""
    stiff = case.vary({STIFFNESS: stiffness})
    rigid = case.flutter_point("150:500:10kt", pitch="rigid").speed
    for scan in ("150:500:10kt", "150:500:50kt"):
        found = stiff.flutter_point(scan)
        assert found.unstable_at_start == () and found.speed == pytest.approx(rigid, rel=1e-3)
        first = next(b for b in found.boundaries if b.onset)
        for step in (-1e-6, 1e-6):
            (root,) = exact_roots(stiff.linearize([found.speed + step]), [first.eigenvalue])
            assert np.sign(float(root.real)) == np.sign(step)


def hinged(offset):
    """A rotor with a gimbal and flap hinges so near the centre that little mass moves between them."""
    rotor = pp.Rotor.from_mass_distribution(
        np.array([0.0, 3.8]), np.array([5.0, 3.0]), n_blades=3, radius=3.8, root_cutout=0.4,
        flap_hinge_offset=offset, lag_hinge_offset=0.3, precone=0.03, flap_stiffness=3e4, lag_stiffness=2e5,
        control_stiffness=3e4, pitch_inertia=1.5, gimbal_stiffness=2e4, chord=0.36, twist=-0.6,
        airfoil=pp.Airfoil(lift_slope=5.7, zero_lift_angle=-0.02, drag=0.008, moment=-0.01),
    )  # fmt: skip
    operation = pp.Operation(rotor_speed=55.0, density=1.1, speed_of_sound=340.0, trim="windmill")
    return pp.Case("hinged", rotor, operation, random_support(Flight(rotor, operation, 100.0), 3))


@pytest.mark.parametrize("offset", [1e-2, 1e-3, 1e-5])
def test_a_hinge_near_the_centre_moves_no_boundary(offset):
    case = hinged(offset)
    found = case.flutter_point("60:400:20kt", section_damping=True)
    assert len(found.boundaries) == 2
    for boundary in found.boundaries:
        for step in (-1e-6, 1e-6):
            model = case.linearize([boundary.position + step], section_damping=True)
            (root,) = exact_roots(model, [boundary.eigenvalue])
            assert (float(root.real) > 0) == ((step > 0) == boundary.onset)


# Every way to ask tells the same -------------------------------------------------------------------

QUESTIONS = [
    (PLAIN, "160:460:20kt"),
    ({"section_damping": True}, "200:500:25kt"),
    (TABULATED, "50:480:20kt"),
    ({"pitch": "coupling"}, "60:480:30kt"),
]


def sign_changes(case, options, low, high, count=4001):
    """Airspeeds between which the number of growing roots rises, leaving out those neutral to a millionth."""
    speeds = np.linspace(low, high, count)
    growing = (np.linalg.eigvals(state_matrix(case.linearize(speeds, **options))).real > 1e-6).sum(axis=1)
    return [(speeds[k], speeds[k + 1]) for k in np.flatnonzero(np.diff(growing) > 0)]


@pytest.mark.parametrize("options, scan", QUESTIONS)
def test_all_ways_to_ask_tell_the_same_flutter_speed(case, options, scan):
    varied = case.vary({PRECONE: 0.03})
    point = varied.flutter_point(scan, **options)
    low, high = point.searched
    ends = sign_changes(varied, options, low, high)
    assert ends[0][0] <= point.speed <= ends[0][1]  # eigenvalues alone, at 4001 airspeeds
    along_speed = varied.boundaries(scan, **options)
    assert along_speed.boundaries == point.boundaries
    designs = study(case, {PRECONE: [0.02, 0.03]}, scan, "flutter", **options)
    found = designs.sel({PRECONE: 0.03})
    assert float(found.flutter_speed) == pytest.approx(point.speed, rel=1e-8)
    assert float(found.flutter_frequency) == pytest.approx(point.frequency, rel=1e-7)
    note = UNSTABLE if point.unstable_at_start else ""
    assert str(found.flutter_note.values) == note
    sensitivity = varied.sensitivity("flutter_speed", [PRECONE], airspeed=scan, **options)
    assert sensitivity.attrs["value"] == point.speed
    # At the flutter speed the deck's own precone is a boundary of precone.
    across = boundaries(varied, point.speed, {PRECONE: np.linspace(0.02, 0.041, 4)}, **options)
    assert min(abs(b.position - 0.03) for b in across.boundaries) < 1e-7


def test_a_map_has_the_boundary_of_a_flutter_point_also_beside_a_neutral_root(case):
    """With tabulated frequencies the azimuth is neutral: it makes neither an edge nor a crossing of one."""
    values = [0.02, 0.03, 0.04]
    plane = case.stability_map({PRECONE: values, "airspeed": "430:480:10kt"}, **TABULATED)
    for value in values:
        point = case.vary({PRECONE: value}).flutter_point("430:480:10kt", **TABULATED)
        assert np.isfinite(point.speed)
        on_line = plane.boundary.values[np.abs(plane.boundary.values[:, 0] - value) < 1e-12]
        assert on_line[:, 1] == pytest.approx([point.speed], rel=1e-8)
        lowest = point.unstable_at_start
        assert (plane.growth.sel({PRECONE: value}).values[0] > 0) == bool(lowest)
    root = plane.boundary_eigenvalue.values[np.isfinite(plane.boundary_eigenvalue.values)]
    assert np.all(np.abs(root.real) < 1e-6 * np.abs(root))


@pytest.mark.parametrize(
    "options, expected",
    [({"section_damping": False}, {"", UNSTABLE}), ({"pitch": "coupling"}, {"", STABLE})],
)
def test_designs_of_a_study_have_the_flutter_points_they_have_alone(case, options, expected):
    """Random designs: lowest onset, or none; stable, or unstable from the start."""
    rng, count = np.random.default_rng(4), 12
    values = {
        PRECONE: rng.uniform(0.0, 0.07, count),
        STIFFNESS: case.given[STIFFNESS].si * rng.uniform(0.3, 3.0, count),
    }
    scan = "140:380:24kt"
    found = study(case, sampling.points(values), scan, "flutter", **options)
    for row, note in enumerate(found.flutter_note.values):
        design = case.vary({path: value[row] for path, value in values.items()})
        point = design.flutter_point(scan, **options)
        assert float(found.flutter_speed[row]) == pytest.approx(point.speed, rel=1e-8, nan_ok=True)
        assert (note == UNSTABLE) == bool(point.unstable_at_start)
        assert (note == STABLE) == (np.isnan(point.speed) and not point.unstable_at_start)
    assert expected <= set(found.flutter_note.values.tolist())


def test_growth_and_least_damping_of_a_study_leave_neutral_roots_out(case):
    """A locked rotor in a vacuum has nothing but the wing's own damping, and neutral roots."""
    options = {"airloads": "none", "locked": ("lag",)}
    still = {
        path: [0.0] for path in pp.design_inputs(case) if path.startswith("rotor.") and "damping" in path
    }
    found = study(
        case, sampling.points({PRECONE: [0.03], **still}), [100.0, 120.0], "least_stable", **options
    )
    modes = (
        case.vary({PRECONE: 0.03, **dict.fromkeys(still, 0.0)}).linearize([100.0, 120.0], **options).modes()
    )
    assert np.all(found.growth_rate.values <= 0)
    assert np.isnan(modes.damping_ratio.values[np.abs(modes.eigenvalue.values) < 1e-8]).all()


def test_boundaries_say_the_branch_and_what_moves(case):
    point = case.flutter_point("160:420:20kt")
    first = next(b for b in point.boundaries if b.onset)
    assert first.branch in case.sweep("160:420:20kt").mode.values
    assert first.mode == max(first.mechanism, key=first.mechanism.get) == "chord"


def test_a_boundary_by_another_root_finder(case):
    """Brent's method on the largest real part, which no neutral root spoils here."""

    def growth(speed):
        return np.linalg.eigvals(state_matrix(case.linearize(speed))).real.max()

    exact = brentq(growth, 180.0, 200.0, xtol=1e-10)
    assert case.flutter_point("350:400:25kt").speed == pytest.approx(exact, rel=1e-10)
