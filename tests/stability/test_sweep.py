"""Eigenvalues and modes of a model, and modes followed along a line of points.

Small systems with known roots first, then a rotor on a wing.
"""

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

import proprotor as pp
from proprotor.rotor.trim import Trim
from proprotor.stability.following import _branches_of, follow
from proprotor.stability.matching import Spectrum
from proprotor.stability.modes import decomposition
from proprotor.stability.sweep import sweep
from tests.rotors import SPEED_OF_SOUND

many = settings(max_examples=100, derandomize=True, deadline=None, phases=[Phase.generate])


def system(mass, damping, stiffness, dofs=("a", "b"), airspeeds=None):
    """A linear model of matrices at hand, one point for each airspeed or a single one."""
    mass, damping, stiffness = np.broadcast_arrays(mass, damping, stiffness)
    airspeed = np.zeros(mass.shape[:-2]) if airspeeds is None else np.asarray(airspeeds, dtype=float)
    texts = {name: np.full(airspeed.shape, "", dtype=object) for name in ("reason", "warning")}
    nothing = {entry.name: np.zeros(airspeed.shape) for entry in fields(Trim)}
    return pp.LinearModel(mass, damping, stiffness, tuple(dofs), Trim(**nothing | texts), airspeed)


def oscillators(natural_frequency, damping_ratio):
    """Uncoupled, of unit mass: (..., n) each."""
    one = np.eye(np.shape(natural_frequency)[-1])
    stiffness = np.asarray(natural_frequency)[..., None] ** 2 * one
    return (
        one,
        2 * np.asarray(damping_ratio)[..., None] * np.asarray(natural_frequency)[..., None] * one,
        stiffness,
    )


# One point ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("ratio", [0.3, 0.0, -0.2])
def test_an_oscillator_has_its_frequency_and_damping(ratio):
    """s = −ζω + iω√(1 − ζ²): a negative ratio grows."""
    modes = system(*oscillators([10.0], [ratio]), dofs=("a",)).modes()
    assert modes.eigenvalue.shape == (1,)
    assert np.allclose(modes.eigenvalue, -10 * ratio + 10j * np.sqrt(1 - ratio**2), rtol=1e-14)
    assert np.allclose(modes.frequency, 10 * np.sqrt(1 - ratio**2), rtol=1e-14)
    assert np.allclose(modes.natural_frequency, 10.0, rtol=1e-14)
    assert np.allclose(modes.damping_ratio, ratio, rtol=0, atol=1e-14)


def test_each_real_root_is_a_mode_of_its_own():
    """Overdamped: −1 and −4; diverging: 2 and −3. Frequency 0, and fully damped or fully unstable."""
    modes = system(np.eye(2), np.diag([5.0, 1.0]), np.diag([4.0, -6.0])).modes()
    assert np.allclose(np.sort(modes.eigenvalue.values.real), [-4, -3, -1, 2], rtol=1e-14)
    assert np.all(modes.frequency == 0)
    assert np.array_equal(modes.damping_ratio, -np.sign(modes.eigenvalue.values.real))


def test_the_dominant_coordinate_and_the_shape():
    modes = system(*oscillators([3.0, 1.0, 2.0], [0.1, 0.1, 0.1]), dofs=("a", "b", "c")).modes()
    assert modes.dominant.values.tolist() == ["b", "c", "a"]
    assert np.allclose(modes["shape"], np.eye(3)[[1, 2, 0]])
    assert np.allclose(modes.participation, np.eye(3)[[1, 2, 0]])


WING = ("beam", "chord", "torsion")


def wing(damping_ratio=0.02):
    """Three modes of a cantilever wing with the rotor ahead of its tip."""
    hub = np.zeros((6, 3))
    hub[[0, 4], 0] = 0.9, 0.3
    hub[[1, 3], 1] = 1.0, -0.2
    hub[[0, 4], 2] = 1.4, 1.0
    return pp.NormalModes.from_frequencies(
        WING,
        generalized_mass=[2000.0, 2500.0, 1500.0],
        frequency=[20.0, 38.0, 56.0],
        damping_ratio=[damping_ratio] * 3,
        hub=hub,
        includes_rotor=False,
    )


def tiltrotor(**changes):
    rotor = pp.Rotor.from_mass_distribution(
        [0.0, 4.0],
        [7.0, 5.0],
        **{
            "n_blades": 3,
            "radius": 4.0,
            "root_cutout": 0.4,
            "flap_hinge_offset": 0.3,
            "lag_hinge_offset": 0.5,
            "precone": 0.03,
            "flap_stiffness": 3e5,
            "lag_stiffness": 1e6,
            "flap_outboard_fraction": 0.3,
            "lag_outboard_fraction": 0.8,
            "gimbal_stiffness": 2e4,
            "pitch_gimbal_coupling": -0.3,
            "pitch_inertia": 1.5,
            "control_stiffness": 4e4,
            "chord": 0.35,
            "twist": -0.6,
            "airfoil": pp.Airfoil(lift_slope=5.7, drag=0.01),
        }
        | changes,
    )
    operation = pp.Operation(rotor_speed=45.0, density=1.1, speed_of_sound=SPEED_OF_SOUND)
    return pp.Case("tiltrotor", rotor, operation, wing())


@pytest.mark.parametrize(("rotor_speed", "rates_only"), [("windmilling", 1), ("constant", 0)])
def test_rotor_speed_is_a_rate_so_a_model_has_an_odd_number_of_states(rotor_speed, rates_only):
    model = tiltrotor().linearize(100.0, rotor_speed=rotor_speed)
    values = decomposition(model).values
    assert values.shape == (2 * len(model.dofs) - rates_only,)
    modes = model.modes()
    pairs = modes.eigenvalue.values[modes.frequency > 0]
    real = modes.eigenvalue.values[modes.frequency == 0]
    assert 2 * len(pairs) + len(real) == len(values)
    together = np.sort_complex([*pairs, *pairs.conj(), *real])
    assert np.allclose(together, np.sort_complex(values), rtol=1e-13)


def test_modes_satisfy_the_equations_of_motion():
    """(s²M + sC + K) v = 0 with the azimuth's motion its rate divided by s; the largest component is 1."""
    model = tiltrotor().linearize(100.0)
    modes = model.modes()
    assert np.all(np.diff(modes.frequency) >= 0)
    assert np.allclose(np.abs(modes["shape"]).max("dof"), 1)
    assert np.allclose(modes.participation.sum("dof"), 1)
    for s, shape in zip(modes.eigenvalue.values, modes["shape"].values, strict=True):
        terms = np.array([s**2 * model.M @ shape, s * model.C @ shape, model.K @ shape])
        assert np.abs(terms.sum(axis=0)).max() < 1e-10 * np.abs(terms).max()


def test_modes_of_a_batch_are_those_of_its_points():
    airspeeds = np.array([[60.0, 90.0], [np.nan, 120.0]])
    modes = tiltrotor().linearize(airspeeds).modes()
    assert modes.eigenvalue.shape[:2] == (2, 2)
    assert np.isnan(modes.eigenvalue.values[1, 0]).all()
    assert "not a finite number" in str(modes.reason.values[1, 0])
    for place in ((0, 0), (0, 1), (1, 1)):
        single = tiltrotor().linearize(airspeeds[place]).modes()
        # One point alone has a rendering of its own, whose matrices agree to 1e-13.
        np.testing.assert_allclose(
            modes.eigenvalue.values[place][: single.sizes["mode"]], single.eigenvalue.values, rtol=1e-10
        )


# Known systems that cross and veer ----------------------------------------------------------------

LINE = np.linspace(0.0, 1.0, 11)


def tracked(model):
    """Followed eigenvalues (points, states)."""
    return values_of(follow(model))


def values_of(branches):
    """Eigenvalues of branches (points, states)."""
    return np.take_along_axis(branches.spectrum.values[branches.points], branches.places, 1)


def upper(values):
    """Of each conjugate pair the one with the positive frequency, in the order of the first point's frequency."""
    columns = np.flatnonzero(values[0].imag > 0)
    return values[:, columns[np.argsort(values[0, columns].imag)]]


@pytest.mark.parametrize("points", [3, 4, 11, 101])
def test_uncoupled_modes_cross(points):
    """However far apart the points: the mode of the same coordinate is the same mode."""
    p = np.linspace(0, 1, points)
    frequency = np.stack([9 + 3 * p, 11 - 2 * p], axis=-1)
    values = upper(tracked(system(*oscillators(frequency, 0 * frequency + [0.01, 0.05]), airspeeds=p)))
    assert np.allclose(np.abs(values), frequency, rtol=1e-13)
    assert np.allclose(-values.real / np.abs(values), [0.01, 0.05], rtol=1e-11)


def test_modes_of_almost_one_frequency_cross_in_damping():
    ratio = np.stack([0.02 + 0.1 * LINE, 0.1 - 0.1 * LINE], axis=-1)
    frequency = np.broadcast_to([10.0, 10.2], ratio.shape)
    values = upper(tracked(system(*oscillators(frequency, ratio), airspeeds=LINE)))
    assert np.allclose(-values.real / np.abs(values), ratio, rtol=0, atol=1e-12)


def coupled(p, coupling):
    """Two springs that change places, coupled: ω² is their mean ± √(half their difference² + coupling²)."""
    half = 50 * (1 - 2 * p)
    stiffness = np.zeros((len(p), 2, 2))
    stiffness[:, 0, 0], stiffness[:, 1, 1] = 100 - half, 100 + half
    stiffness[:, 0, 1] = stiffness[:, 1, 0] = coupling
    swing = np.sqrt(half**2 + coupling**2)
    return system(np.eye(2), 0.01 * np.eye(2), stiffness, airspeeds=p), 100 - swing, 100 + swing


def test_coupled_modes_veer_and_keep_their_order_though_they_swap_shapes():
    """The points are close enough to see the shapes turn."""
    model, low, high = coupled(np.linspace(0, 1, 41), 20.0)
    values = upper(tracked(model))
    assert np.allclose(np.abs(values) ** 2, np.stack([low, high], axis=-1), rtol=1e-12)


def test_a_veering_that_falls_between_two_points_is_a_crossing():
    """Shapes tell what nobody has seen happen."""
    model, low, high = coupled(np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0]), 0.5)
    values = upper(tracked(model))
    first = np.where(model.airspeed < 0.5, low, high)
    second = np.where(model.airspeed < 0.5, high, low)
    assert np.allclose(np.abs(values) ** 2, np.stack([first, second], axis=-1), rtol=1e-12)


@many
@given(st.integers(0, 10**6))
def test_order_and_scale_of_the_eigenvectors_do_not_matter(seed):
    """Pairs shuffled and scaled at every point are put back."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 6))
    frequency = rng.uniform(5, 15, n) + np.linspace(0, 1, 21)[:, None] * rng.uniform(-4, 4, n)
    ratio = np.broadcast_to(rng.uniform(-0.05, 0.2, n), frequency.shape)
    ordered = decomposition(system(*oscillators(frequency, ratio), dofs=[f"q{i}" for i in range(n)]))
    expected = values_of(_branches_of(ordered, np.arange(21.0)))
    found = values_of(_branches_of(shuffle(ordered, rng), np.arange(21.0)))
    columns = [np.abs(expected[0] - value).argmin() for value in found[0]]
    assert sorted(columns) == list(range(2 * n))
    assert np.array_equal(found, expected[:, columns])


def shuffle(spectrum, rng):
    """The same spectrum with its pairs in any order and vectors of any length and phase."""
    points, states = spectrum.values.shape
    pairs = np.array([rng.permutation(states // 2) for _ in range(points)])
    order = np.stack([2 * pairs, 2 * pairs + 1], axis=-1).reshape(points, states)
    factor = rng.uniform(0.1, 10, pairs.shape) * np.exp(1j * rng.uniform(0, 6, pairs.shape))
    factor = np.stack([factor, factor.conj()], axis=-1).reshape(points, 1, states)
    return Spectrum(
        np.take_along_axis(spectrum.values, order, 1),
        np.take_along_axis(spectrum.right, order[:, None, :], 2) * factor,
    )


@pytest.mark.parametrize("failed", [[5], [0], [10], [4, 5, 6], list(range(10))])
def test_failed_points_are_passed_over(failed):
    p = np.linspace(0, 1, 11)
    frequency = np.stack([9 + 3 * p, 11 - 2 * p], axis=-1)
    damping_ratio = 0 * frequency + [0.01, 0.05]
    mass, damping, stiffness = oscillators(frequency, damping_ratio)
    mass = np.broadcast_to(mass, stiffness.shape).copy()
    mass[failed] = np.nan
    values = sweep(system(mass, damping, stiffness, airspeeds=p)).eigenvalue.values
    assert np.isnan(values[failed]).all()
    rest = np.setdiff1d(np.arange(11), failed)
    ratio = -values[rest].real / np.abs(values[rest])
    assert np.allclose(np.sort(ratio, axis=1), [0.01, 0.05], rtol=1e-11)
    assert np.ptp(ratio, axis=0).max() < 1e-12


# Sweeps -------------------------------------------------------------------------------------------


def assert_every_root_appears(model, modes):
    """At each point the sweep has each root of the model or its conjugate, once."""
    for values, found in zip(decomposition(model).values, modes.eigenvalue.values, strict=True):
        above, found = np.sort_complex(values[values.imag >= 0]), found[np.isfinite(found)]
        assert np.allclose(np.sort_complex(found.real + 1j * np.abs(found.imag)), above, rtol=1e-12)


def test_every_mode_of_a_sweep_appears_once_under_its_own_name():
    case, airspeeds = tiltrotor(), np.linspace(50.0, 180.0, 27)
    model, modes = case.linearize(airspeeds), case.sweep(airspeeds)
    names = modes.mode.values.tolist()
    assert len(set(names)) == len(names)
    assert_every_root_appears(model, modes)
    assert all(any(name in mode for mode in names) for name in (*WING, "gimbal", "coning", "lag", "pitch"))


def test_modes_do_not_depend_on_how_finely_they_are_followed():
    airspeeds = np.linspace(50.0, 180.0, 27)
    fine, coarse = tiltrotor().sweep(airspeeds), tiltrotor().sweep(airspeeds[::2])
    assert fine.mode.values.tolist() == coarse.mode.values.tolist()
    assert np.array_equal(fine.eigenvalue.values[::2], coarse.eigenvalue.values)


def test_a_failed_airspeed_in_the_middle_does_not_break_a_sweep():
    airspeeds = np.linspace(50.0, 180.0, 27)
    whole = tiltrotor().sweep(airspeeds)
    broken = tiltrotor().sweep(np.insert(airspeeds, 13, np.nan))
    assert broken.mode.values.tolist() == whole.mode.values.tolist()
    assert np.isnan(broken.eigenvalue.values[13]).all()
    assert "not a finite number" in str(broken.reason.values[13])
    assert np.array_equal(np.delete(broken.eigenvalue.values, 13, axis=0), whole.eigenvalue.values)


def test_a_sweep_of_failed_airspeeds_says_why():
    modes = tiltrotor().sweep(np.array([np.nan, -10.0]))
    assert np.isnan(modes.eigenvalue.values).all()
    assert [reason != "" for reason in modes.reason.values] == [True, True]


def test_a_sweep_is_along_a_line():
    with pytest.raises(pp.InputError, match="list of speeds"):
        tiltrotor().sweep(np.full((2, 2), 100.0))


def diverging(points):
    """A spring that gives way: an oscillation, then two real roots, of which one grows beyond p = 0.8."""
    p = np.linspace(0, 1, points)
    stiffness = np.zeros((points, 2, 2))
    stiffness[:, 0, 0], stiffness[:, 1, 1] = 4 - 5 * p, 30.0
    stiffness[:, 0, 1] = stiffness[:, 1, 0] = 0.5
    return system(np.eye(2), np.diag([1.0, 0.2]), stiffness, airspeeds=p)


@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("points", [7, 21, 40, 41])
def test_a_divergence_is_not_lost_where_a_pair_becomes_two_real_roots(points, backwards):
    """At each point the least stable root of the model is in the sweep."""
    model = diverging(points)
    if backwards:
        model = system(model.M[::-1], model.C[::-1], model.K[::-1], airspeeds=model.airspeed)
    roots = decomposition(model).values.real.max(axis=1)
    assert roots.max() > 0.5
    found = np.nanmax(sweep(model).eigenvalue.values.real, axis=1)
    assert np.allclose(found, roots, rtol=1e-12)
