"""Modes followed from point to point, and what they are called.

Known systems first: crossing, veering, and pairs that part into real roots; then rotors in a vacuum, whose whirl is
known; then the XV-15 and designs around it, followed in coarse steps and in fine ones.
"""

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

import proprotor as pp
from benchmarks.tracking import values_of
from proprotor.errors import InputError
from proprotor.rotor.motions import motions, name_list
from proprotor.stability import following
from proprotor.stability.following import follow
from proprotor.stability.matching import POOR, match_modes
from proprotor.stability.mode_names import _assign_names, _groups
from proprotor.stability.modes import decomposition
from proprotor.stability.parameter_lines import ParameterLine
from proprotor.stability.sweep import sweep, sweep_case
from tests.known_systems import along, continued, linear_model, oscillators, roots

KNOT = 1852 / 3600


def followed(linearize, positions):
    """Eigenvalues of the points in their places, of those states that start in the upper half plane or real."""
    path = follow(linearize(positions), ParameterLine(positions, linearize))
    return values_of(path, len(positions)), path


def by_start(values):
    """Columns in the order of their first values."""
    return values[:, np.lexsort([values[0].real, values[0].imag])]


# Crossing and veering -------------------------------------------------------------------------------


@pytest.mark.parametrize("points", [3, 6, 11])
@pytest.mark.parametrize("coupling", [0.0, 0.3, 1.0, 3.0, 10.0, 40.0])
def test_modes_cross_without_coupling_and_veer_with_it(coupling, points):
    """ω² = 100 ∓ √(h² + ε²): with any ε the lower stays the lower, however few the points."""
    p = np.linspace(0, 1, points)
    values, _ = followed(along(lambda x: oscillators(x, coupling)), p)
    found = by_start(values)[:, 2:]  # the upper half plane
    half = 50 * (1 - 2 * p)
    swing = np.sign(half) * np.abs(half) if coupling == 0 else np.sqrt(half**2 + coupling**2)
    if points % 2 and coupling == 0:  # at equal springs any two vectors are modes
        half = np.where(half == 0, np.nan, half)
    expected = np.sqrt(np.stack([100 - swing, 100 + swing], axis=1))
    good = ~np.isnan(half) if coupling == 0 else np.ones(points, bool)
    np.testing.assert_allclose(found[good].imag, expected[good], rtol=1e-12)


@pytest.mark.parametrize("coupling", [0.0, 0.2, 0.5, 0.9, 1.1, 1.5, 3.0])
def test_damped_modes_veer_or_cross_as_their_roots_do(coupling):
    """Roots of oscillators whose damping differs pass in the complex plane on one side of a double root or the other.

    With C = diag(c + d, c - d) and equal springs k there is a double root at ε = d √k, near 1 here. The judge
    follows roots alone in steps so small that the nearest is the next.
    """
    damping = (0.3, 0.1)  # d = 0.1, √k = 10
    linearize = along(lambda x: oscillators(x, coupling, damping))
    dense = np.linspace(0, 1, 20001)
    expected = continued(roots(linearize(dense)))[::2000]
    values, _ = followed(linearize, dense[::2000])
    np.testing.assert_allclose(by_start(values), by_start(expected), rtol=1e-9)
    crosses = np.abs(by_start(expected)[-1, 2]) > 11
    assert crosses == (coupling < 1.0)


def test_random_systems_are_followed_as_their_roots_are():
    """Three coordinates, random and not symmetric, at 9 points against roots followed in 800 steps each."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        stiffness, way = rng.normal(size=(2, 3, 3)) * 20
        damping, more = rng.normal(size=(2, 3, 3)) * 0.3
        still = np.diag([80.0, 110.0, 140.0])

        def matrices(x, way=way, stiffness=stiffness, damping=damping, more=more, still=still):
            return np.eye(3), damping + x * more, still + stiffness + x * way

        linearize, dense = along(matrices), np.linspace(0, 1, 6401)
        every = continued(roots(linearize(dense)))
        if np.abs(np.diff(every, axis=0)).max() > 0.3:  # too near a double root to judge
            continue
        values, path = followed(linearize, dense[::800])
        if path.quality.min() < POOR:
            continue
        np.testing.assert_allclose(by_start(values), by_start(every[::800]), rtol=1e-8)


def test_a_step_that_hides_a_veering_has_a_poor_quality():
    """Without a way to look between its points the passage is judged by the shapes; quality and warning say so.

    What lies beyond the step is as doubtful as the step: labels there may be exchanged.
    """
    p = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
    data = sweep(along(lambda x: oscillators(x, 1.0))(p), ParameterLine(p, name="p", units="1"))
    quality = data.tracking_quality.min("mode").values
    assert quality[3:].max() < POOR and quality[:3].min() > POOR
    assert [
        place for place, text in enumerate(data.warning.values) if "which root is which: q0, q1" in text
    ] == [3]
    looked = sweep(
        along(lambda x: oscillators(x, 1.0))(p),
        ParameterLine(p, along(lambda x: oscillators(x, 1.0)), "p", "1"),
    )
    assert looked.tracking_quality.min() > POOR and not looked.warning.any()
    assert looked.attrs["eigen_solves"] > len(p)
    assert looked.eigenvalue.dims == ("p", "mode") and looked.sizes["p"] == len(p)


def test_two_modes_that_nothing_couples_are_not_looked_at_between_points():
    p = np.linspace(0, 1, 6)
    _, path = followed(along(lambda x: oscillators(x, 0.0, (0.2, 0.1))), p)
    assert len(path.points) == len(p)
    assert path.quality.min() > 0.99


# Real roots -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("points", [5, 8, 21, 101])
def test_a_pair_that_parts_into_real_roots_and_joins_again(points):
    """λ² + cλ + 1 with c = 1 + 8 p (1 - p): real where c > 2; one mode goes through, a second root where real."""
    p = np.linspace(0, 1, points)
    c = 1 + 8 * p * (1 - p)
    linearize = along(lambda x: (np.eye(1), (1 + 8 * x * (1 - x)) * np.eye(1), np.eye(1)))
    data = sweep(linearize(p), ParameterLine(p, linearize, "p", "1"))
    real = c > 2
    assert data.mode.values.tolist() == (["q0", "q0, second root"] if real.any() else ["q0"])
    assert np.isfinite(data.eigenvalue.values[:, 0]).all()
    for here, ratio, values in zip(real, c, data.eigenvalue.values, strict=True):
        expected = np.roots([1, ratio, 1])
        if here:
            np.testing.assert_allclose(np.sort(values.real), np.sort(expected.real), rtol=1e-9)
            assert np.all(values.imag == 0)
        else:
            assert values[0] == pytest.approx(expected[expected.imag > 0][0], rel=1e-12)
            assert np.isnan(values[1:]).all()


def test_three_real_roots_of_which_two_join():
    """A pair parts, and one of its roots joins that of another coordinate: every root is there once at each point."""

    def matrices(x):
        damping = np.array([[3.0, 0.0], [0.0, 6.0]]) - x * np.array([[2.5, 0.0], [0.0, 0.0]])
        stiffness = np.array([[2.0, 0.4], [-1.5, 8.0]]) + x * np.array([[2.0, 0.0], [0.0, 2.0]])
        return np.eye(2), damping, stiffness

    p = np.linspace(0, 1, 21)
    linearize = along(matrices)
    data = sweep(linearize(p), ParameterLine(p, linearize, "p", "1"))
    for values, found in zip(roots(linearize(p)), data.eigenvalue.values, strict=True):
        upper, found = np.sort_complex(values[values.imag >= -1e-12]), found[np.isfinite(found)]
        np.testing.assert_allclose(np.sort_complex(found), upper, rtol=1e-7, atol=1e-7)


# One step -------------------------------------------------------------------------------------------


def test_steps_are_the_best_assignments():
    """The short way by the best of each row is the assignment scipy finds on the whole matrix."""
    case = pp.load_case("xv15-uncoupled")
    spectrum = decomposition(case.linearize(np.linspace(60, 200, 40)))
    steps, left = match_modes(spectrum, np.arange(39), np.arange(1, 40)), np.linalg.inv(spectrum.right)
    for step in range(39):
        forward = np.abs(left[step] @ spectrum.right[step + 1])
        backward = np.abs(left[step + 1] @ spectrum.right[step]).T
        apart = np.abs(spectrum.values[step][:, None] - spectrum.values[step + 1])
        gain = np.sqrt(forward * backward) - apart / np.abs(spectrum.values[step]).max()
        rows = np.arange(len(gain))
        best = gain[linear_sum_assignment(gain, maximize=True)].sum()
        assert gain[rows, steps.successor[step]].sum() == pytest.approx(best, rel=1e-12)
        assert sorted(steps.successor[step]) == list(rows)


def test_left_vectors_are_the_inverse_of_the_right_ones():
    spectrum = decomposition(pp.load_case("xv15-uncoupled").linearize(np.array([60.0, 120.0, 190.0])))
    product = spectrum.all_modes.left @ spectrum.right
    np.testing.assert_allclose(product, np.broadcast_to(np.eye(product.shape[-1]), product.shape), atol=1e-10)


# Names ----------------------------------------------------------------------------------------------


def rotor(**changes):
    return pp.Rotor.from_mass_distribution(
        [0.0, 4.0],
        [7.0, 5.0],
        **{
            "n_blades": 3,
            "radius": 4.0,
            "root_cutout": 0.4,
            "flap_hinge_offset": 0.3,
            "lag_hinge_offset": 0.5,
            "precone": 0.0,
            "flap_stiffness": 3e5,
            "lag_stiffness": 1e6,
            "gimbal_stiffness": 2e4,
            "pitch_gimbal_coupling": 0.0,
            "pitch_inertia": 1.5,
            "control_stiffness": 4e4,
            "chord": 0.35,
            "twist": -0.6,
            "airfoil": pp.Airfoil(lift_slope=5.7, drag=0.01),
        }
        | changes,
    )


OMEGA = 45.0
VACUUM = {"rotor_speed": OMEGA, "density": 0.0, "speed_of_sound": 340.0}


@pytest.mark.parametrize("ratio", [0.4, 0.8, 1.3, 1.9, 3.6])
def test_whirl_in_the_fixed_frame_and_in_the_rotating_one(ratio):
    """Blades of flap frequency ν: ν + 1 whirls with the rotor; |ν - 1| with it for ν < 1, against it for ν > 1."""
    model = pp.rotor_model(
        rotor(),
        pp.Operation(**VACUUM, trim={"collective": 0.4}),
        np.array([50.0]),
        airloads="none",
        pitch="rigid",
        rotor_speed="constant",
        locked=("lag", "gimbal"),
        structure="tabulated",
        frequencies=pp.BladeFrequencies(at_rotor_speed=OMEGA, flap=ratio, lag=2.0),
    ).submodel(("flap_0", "flap_1c", "flap_1s"))
    modes = sweep(model).isel(airspeed=0)
    assert modes.mode.values.tolist() == ["coning", "regressive flap", "progressive flap"]
    np.testing.assert_allclose(
        modes.frequency / OMEGA, [ratio, abs(ratio - 1), ratio + 1], rtol=1e-9, atol=1e-9
    )
    assert modes.whirl.values[1:] == pytest.approx([np.sign(1 - ratio), 1], abs=1e-9)


def test_names_come_from_the_coordinates():
    dofs = ("beam", "flap_0", "flap_1c", "flap_1s", "azimuth", "gimbal_1c", "gimbal_1s", "lag_2c", "lag_2s")
    assert name_list((*dofs, "pitch_d", "pitch_0", "yaw")) == [
        "beam",
        "coning",
        "regressive flap",
        "progressive flap",
        "rotor speed",
        "regressive gimbal",
        "progressive gimbal",
        "regressive lag 2",
        "progressive lag 2",
        "differential pitch",
        "collective pitch",
        "yaw",
    ]
    assert [motion.places for motion in motions(dofs)] == [(0,), (1,), (2, 3), (4,), (5, 6), (7, 8)]


def test_a_pair_has_one_name_though_its_halves_would_go_apart():
    """Two real roots that want different names must not tear a pair between them."""
    values = np.array([-1 + 2j, -1 - 2j, -3.0, -4.0])
    shares = np.array([[0.55, 0.55, 0.9, 0.1], [0.45, 0.45, 0.1, 0.9]])
    groups, modes = _groups(("a", "b"), ((0, 1),), (0, 1)), [0, 2, 3]
    names = _assign_names(groups, values[None], np.array([modes]), shares[:, modes, None])
    assert names[:, 0].tolist() == [0, 1, 1]


@pytest.mark.parametrize("name", ["xv15-uncoupled", "xv15-mass-distribution"])
def test_every_mode_has_a_name_of_its_own_in_any_range(name):
    case = pp.load_case(name)
    whole = case.sweep("50:400:10kt")
    names = whole.mode.values.tolist()
    assert len(set(names)) == len(names)
    assert {"beam", "chord", "torsion", "coning", "rotor speed"} <= set(names)
    assert {
        f"{way} {part}" for way in ("regressive", "progressive") for part in ("flap", "lag", "pitch")
    } <= set(names)
    for part in ("50:90:10kt", "360:400:10kt", "150:160:10kt"):
        some = case.sweep(part)
        expected = whole.sel(airspeed=some.airspeed, method="nearest")
        assert set(some.mode.values.tolist()) <= set(names)
        for mode in some.mode.values.tolist():
            np.testing.assert_allclose(
                some.eigenvalue.sel(mode=mode), expected.eigenvalue.sel(mode=mode), rtol=1e-9, err_msg=mode
            )


def test_names_are_those_of_cruise_where_an_input_varies():
    case = pp.load_case("xv15-uncoupled")
    own = case.sweep([150.0]).isel(airspeed=0)
    springs = np.linspace(0.9, 1.1, 5) * case.given["rotor.control_stiffness"].si
    modes = case.sweep(150.0, {"rotor.control_stiffness": springs})
    assert modes.eigenvalue.dims == ("rotor.control_stiffness", "mode")
    assert modes["rotor.control_stiffness"].attrs["units"] == "N*m/rad"
    middle = modes.isel({"rotor.control_stiffness": 2})
    assert middle.mode.values.tolist() == own.mode.values.tolist()
    np.testing.assert_allclose(middle.eigenvalue, own.eigenvalue, rtol=1e-9)


def test_a_sweep_of_an_input_takes_one_input_and_one_airspeed():
    case = pp.load_case("xv15-uncoupled")
    with pytest.raises(pp.InputError, match="one input"):
        case.sweep(150.0, {"rotor.precone": [0.0, 0.1], "rotor.radius": [3.0, 4.0]})
    with pytest.raises(pp.InputError, match="one airspeed"):
        case.sweep([150.0, 160.0], {"rotor.precone": [0.0, 0.1]})
    with pytest.raises(pp.InputError, match="did you mean"):
        case.sweep(150.0, {"rotor.precon": [0.0, 0.1]})


def test_the_anchor_falls_back_to_a_speed_that_has_a_trim():
    """Where the tip is supersonic at seven tenths of the tip speed, a lower airspeed serves."""
    case = pp.load_case("xv15-uncoupled")
    tip = case.operation.rotor_speed * case.rotor.radius
    slow = case.vary({"operation.speed_of_sound": 1.15 * tip})
    for design, share in ((case, 0.7), (slow, 0.5)):
        where = sweep_case(design, "50:90:20kt").attrs["named_at"]
        assert where.removeprefix("airspeed ").removesuffix(" m/s") == f"{share * tip:.6g}"


# No swap --------------------------------------------------------------------------------------------


def swaps(case, coarse, times):
    """How many eigenvalues of a sweep lie on another branch than that of the same sweep in finer steps."""
    fine = np.linspace(coarse[0], coarse[-1], times * (len(coarse) - 1) + 1)
    judge = follow(case.linearize(fine))
    path = follow(case.linearize(coarse), ParameterLine(coarse, case.linearize))
    expected, found = values_of(judge, len(fine))[::times], values_of(path, len(coarse))
    started = np.abs(found[0][:, None] - expected[0]).argmin(axis=1)
    apart = np.abs(found - expected[:, started])
    return int((apart > 1e-6 * np.abs(found)).sum())


def test_no_swap_on_the_xv15_in_steps_of_5_knots():
    """Judged in steps of 0.1 kt where branches meet; benchmarks/tracking.py judges the whole range and more cases."""
    case = pp.load_case("xv15-uncoupled")
    assert swaps(case, np.arange(100, 200.1, 5) * KNOT, 50) == 0


def test_no_swap_on_random_designs():
    rng = np.random.default_rng(11)
    case = pp.load_case("xv15-uncoupled")
    for _ in range(2):
        scale = rng.uniform(0.8, 1.25, 4)
        paths = (
            "rotor.lag_frequency",
            "rotor.control_stiffness",
            "rotor.chord",
            "support.modes[chord].frequency",
        )
        design = case.vary({path: case.given[path].si * s for path, s in zip(paths, scale, strict=True)})
        assert swaps(design, np.arange(100, 200.1, 5) * KNOT, 50) == 0


def test_no_two_modes_take_the_same_root():
    modes = pp.load_case("xv15-uncoupled").sweep("50:400:5kt")
    for values in modes.eigenvalue.values:
        values = values[np.isfinite(values)]
        apart = np.abs(values[:, None] - values) + 1e9 * np.eye(len(values))
        assert apart.min() > 1e-6


def test_failed_points_break_neither_steps_nor_names():
    p = np.linspace(0, 1, 11)

    def matrices(x):
        mass, damping, stiffness = oscillators(x, 5.0, (0.1, 0.2))
        return mass, damping, np.where((x > 0.45) & (x < 0.55), np.nan, stiffness)

    whole, _ = followed(along(lambda x: oscillators(x, 5.0, (0.1, 0.2))), p)
    data = sweep(along(matrices)(p), ParameterLine(p, along(matrices), "p", "1"))
    assert np.isnan(data.eigenvalue.values[5]).all() and data.reason.values[5] == "fails here"
    assert np.isnan(data.tracking_quality.values[5]).all()
    rest = np.delete(np.arange(11), 5)
    np.testing.assert_allclose(
        np.sort_complex(data.eigenvalue.values[rest].ravel()),
        np.sort_complex(whole[rest][:, whole[0].imag > 0].ravel()),
        rtol=1e-12,
    )


def test_one_point_and_none_are_sweeps_too():
    model = linear_model(np.eye(2)[None], 0.1 * np.eye(2)[None], np.diag([4.0, 9.0])[None], ("a", "b"))
    modes = sweep(model)
    assert modes.mode.values.tolist() == ["a", "b"]
    assert modes.tracking_quality.values.tolist() == [[1, 1]]
    nothing = np.zeros((0, 2, 2))
    assert sweep(linear_model(nothing, nothing, nothing)).sizes["mode"] == 0


def test_two_motions_with_one_frequency_all_along_do_not_part_a_line_for_ever():
    """Nothing tells their roots apart at any point, so that no halving helps: the step is given up and stays poor."""

    def matrices(x):
        way = 1e12 * x  # along which rounding picks the vectors
        symmetric, parted = np.array([[0.0, 1.0], [1.0, 0.0]]), np.diag([1.0, -1.0])
        noise = 1e-12 * (np.cos(way) * symmetric + np.sin(way) * parted)
        return np.eye(2), np.zeros((2, 2)), 196 * np.eye(2) + noise

    lines = [ParameterLine(np.array([0.0, end]), along(matrices)) for end in np.linspace(0.1, 1.0, 10)]
    paths = [follow(line.models(line.positions), line) for line in lines]
    assert max(len(path.points) for path in paths) < 300
    assert min(path.steps.quality.min() for path in paths) < POOR


# Points ahead ---------------------------------------------------------------------------------------


def veering(positions):
    """Two oscillators whose frequencies meet and turn away over a narrow stretch."""
    x = np.asarray(positions, dtype=float)
    stiffness = np.zeros((len(x), 2, 2))
    stiffness[:, 0, 0], stiffness[:, 1, 1] = 1.0 + x, 2.0 - x
    stiffness[:, 0, 1] = stiffness[:, 1, 0] = 2e-3
    return linear_model(np.eye(2), np.diag([0.01, 0.012]), stiffness)


def test_points_solved_ahead_change_no_branch(monkeypatch):
    """They save batches: the points of the branches, places and trust are those of one halving at a time."""
    line, found, batches = np.linspace(0.0, 1.0, 4), [], []
    for ahead in (1, 16):
        monkeypatch.setattr(following, "_AHEAD", ahead)
        sizes = []

        def counted(positions, sizes=sizes):
            sizes.append(len(positions))
            return veering(positions)

        found.append(follow(veering(line), ParameterLine(line, counted)))
        batches.append(sizes)
    one, other = found
    assert len(one.points) > 8 and len(batches[1]) < len(batches[0])
    np.testing.assert_array_equal(one.positions[one.points], other.positions[other.points])
    np.testing.assert_array_equal(one.places, other.places)
    np.testing.assert_array_equal(one.quality, other.quality)


def test_a_point_ahead_that_cannot_be_analysed_stops_nothing():
    """A point that nobody needs is no reason to fail."""
    line = np.linspace(0.0, 1.0, 4)

    def picky(positions):
        if len(positions) > 4:  # more than the steps that need a point
            raise InputError("x", positions, "is refused")
        return veering(positions)

    assert len(follow(veering(line), ParameterLine(line, picky)).points) > 8
