"""Steps screened by compiled functions: the decisions of NumPy, and no crossing that dense roots show is left out."""

from itertools import pairwise

import numpy as np
import pytest

from proprotor.compiled.library import why_not
from proprotor.compiled.screening import nearest_roots, serves_screening
from proprotor.stability.matching import Spectrum
from proprotor.stability.points import Points
from proprotor.stability.root_error import growth
from proprotor.stability.screening import screened

pytestmark = pytest.mark.skipif("there is no C compiler" in why_not(), reason="there is no C compiler")

LENGTH, WITHIN = 10.0, 40  # of a scan, and dense points in a step
SEEDS = {n: range(40 * n, 40 * n + 6) for n in (1, 2, 5, 14)}


def roots(seed, n, x):
    """Roots (k, 2n) of coupled oscillators, some circulatory, which meet, part, become real and cross along x (k,)."""
    random, x = np.random.default_rng(seed), x[:, None]
    base, turn = random.normal(size=(2, n, n))
    damping, stiffness = random.uniform(0.0, 0.4, n), random.uniform(10.0, 60.0, n)
    rise, wave = 3 * random.normal(size=n), random.uniform(0.2, 1.5, n)
    coupling = random.uniform(0, 1) * (base + base.T) + random.uniform(0, 0.4) * (turn - turn.T)
    moving = (stiffness + rise * x + 6 * np.sin(wave * x))[:, :, None] * np.eye(n)
    matrix = np.zeros((len(x), 2 * n, 2 * n))
    matrix[:, :n, n:], matrix[:, n:, n:] = np.eye(n), -np.diag(damping * (seed % 5 > 0))
    matrix[:, n:, :n] = -moving - coupling * (0.3 + 0.05 * x[:, :, None])
    return np.linalg.eigvals(matrix)


def scan(n, points, level, apart):
    """Points of scans of systems of n coordinates, with eigenvalues alone; `apart` puts two systems into blocks."""
    position = np.linspace(0, LENGTH, points)
    sizes = (n, n + 1) if apart else (n,)
    ends = np.cumsum([0, *(2 * size for size in sizes)])
    own = [np.concatenate([roots(seed, size, position) for size in sizes], axis=1) for seed in SEEDS[n]]
    values = np.concatenate(own).astype(complex)
    blocks = tuple((np.arange(*of), slice(*of)) for of in pairwise(ends)) if apart else ()
    unknown = np.full(values.shape, np.nan)
    error = np.where(np.random.default_rng(n).random(values.shape) < 0.2, 1e-9, 0.0)
    return Points(
        np.repeat(np.arange(len(own)), points),
        np.tile(position, len(own)),
        Spectrum(values, unknown[..., None], blocks=blocks),
        unknown.astype(complex),
        growth(values, level),
        unknown,
        error,
    )


def steps_of(points):
    before = np.flatnonzero(np.diff(points.line) == 0)
    return before, before + 1


@pytest.mark.parametrize("apart", [False, True])
@pytest.mark.parametrize("level", [0.0, 0.03, -0.02])
@pytest.mark.parametrize("count", [5, 8, 40])
def test_decisions_are_those_of_numpy(count, level, apart):
    asked_of, onsets_of, open_of = 0, 0, 0
    for n in SEEDS:
        points = scan(n, count, level, apart)
        steps = steps_of(points)
        asked, onsets = screened(points, *steps, level)
        compiled = screened(points, *steps, level, compiled=True)
        np.testing.assert_array_equal(compiled[0], asked)
        np.testing.assert_array_equal(compiled[1], onsets)
        asked_of, onsets_of, open_of = (
            asked_of + asked.sum(),
            onsets_of + len(onsets),
            open_of + (~asked).sum(),
        )
    assert asked_of > 30 and (count < 40 or open_of > 30) and (count < 40 or level or onsets_of > 3)


@pytest.mark.parametrize("apart", [False, True])
@pytest.mark.parametrize("n", SEEDS)
def test_the_nearest_root_is_that_of_least_distance_in_its_block(n, apart):
    points = scan(n, 60, 0.0, apart)
    (before, after), values, block = steps_of(points), points.spectrum.values, points.spectrum.block
    successor, shared = nearest_roots(values, block, before, after)
    square = values[before][:, :, None] - values[after][:, None, :]
    square = square.real**2 + square.imag**2
    square[:, block[:, None] != block] = np.inf
    np.testing.assert_array_equal(successor, square.argmin(axis=2))
    different = np.array([len(set(row)) for row in successor.tolist()])
    np.testing.assert_array_equal(shared, different < values.shape[1])
    assert shared.any() and not shared.all()


@pytest.mark.parametrize("n", SEEDS)
def test_no_step_with_a_crossing_is_left_out(n):
    points = scan(n, 24, 0.0, apart=False)
    asked, _ = screened(points, *steps_of(points), 0.0, compiled=True)
    dense = np.linspace(0, LENGTH, 23 * WITHIN + 1)
    crossed = []
    for seed in SEEDS[n]:
        unstable = (roots(seed, n, dense).real > 1e-7).sum(axis=1)
        crossed.append([len(set(unstable[k * WITHIN : (k + 1) * WITHIN + 1])) > 1 for k in range(23)])
    crossed = np.array(crossed).ravel()
    assert crossed.any() and asked[crossed].all()


def test_states_that_a_point_lacks_are_left_to_numpy():
    points = scan(2, 8, 0.0, apart=False)
    points.spectrum.values[5, -1] = np.nan
    assert not serves_screening(points.spectrum.values)
    own, other = (screened(points, *steps_of(points), 0.0, compiled) for compiled in (True, False))
    assert (own[0] == other[0]).all() and (own[1] == other[1]).all()
