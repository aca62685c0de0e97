"""Modes in real numbers against their definitions in complex ones, a point and a mode at a time."""

import numpy as np
import pytest

from proprotor.stability.real_modes import RealModes, by_pairs, closeness, likeness, mode_of_states


def spectra(seed, states, count):
    """Eigenvalues and vectors of random matrices, each a little different, in parts of one number of pairs."""
    rng = np.random.default_rng(seed)
    matrices = rng.normal(size=(states, states)) + 0.05 * rng.normal(size=(count, states, states))
    values, right = (part.astype(complex) for part in np.linalg.eig(matrices))
    for points, pairs in by_pairs(values):
        yield values[points], right[points], pairs


@pytest.mark.parametrize(("seed", "states"), [(0, 2), (1, 5), (2, 8), (3, 13)])
def test_vectors_and_likeness_are_those_of_complex_numbers(seed, states):
    for values, right, pairs in spectra(seed, states, 12):
        real, left = RealModes.of(values, right, pairs), np.linalg.inv(right)
        assert (real.pairs, real.upper.shape[1]) == (pairs, states - pairs)
        for point, upper in enumerate(real.upper):
            np.testing.assert_array_equal(real.values[point], values[point, upper])
            np.testing.assert_array_equal(real.right[..., point], right[point][:, upper])
            np.testing.assert_allclose(real.left[..., point].T, left[point, upper], atol=1e-10)
        found = likeness(real.at(slice(None, -1)), real.at(slice(1, None)))
        for step in range(len(values) - 1):
            to = real.places[step + 1]
            forward = np.abs(left[step] @ right[step + 1])[real.upper[step]][:, to]
            back = np.abs(left[step + 1] @ right[step])[to][:, real.upper[step]].T
            np.testing.assert_allclose(found[..., step], np.sqrt(forward * back), rtol=1e-7, atol=1e-9)


def test_every_state_belongs_to_the_mode_that_it_or_its_conjugate_is():
    for values, right, pairs in spectra(4, 9, 20):
        real = RealModes.of(values, right, pairs)
        own = np.take_along_axis(real.values, mode_of_states(values, real.upper), 1)
        np.testing.assert_array_equal(np.where(values.imag < 0, own.conj(), own), values)


def test_parts_hold_each_point_that_works_once():
    values = np.array([[1 + 1j, 1 - 1j], [1, 2], [np.nan, np.nan], [2 + 1j, 2 - 1j], [3 + 1j, 3 - 1j]])
    found = [(points.tolist(), pairs) for points, pairs in by_pairs(values, 2)]
    assert found == [([1], 0), ([0, 3], 1), ([4], 1)]


def test_closeness_is_the_farther_end_by_the_nearest_point_of_the_way():
    rng = np.random.default_rng(5)
    apart, later = rng.normal(size=(2, 50)) + 1j * rng.normal(size=(2, 50))
    way = apart + np.linspace(0, 1, 100_001)[:, None] * (later - apart)
    expected = np.maximum(np.abs(apart), np.abs(later)) / np.abs(way).min(axis=0)
    np.testing.assert_allclose(closeness(apart, later), expected, rtol=1e-4)
    assert closeness(np.zeros(1, complex), np.zeros(1, complex)) == 0  # two roots that are one
    assert np.isnan(closeness(np.array([np.nan + 0j]), np.ones(1, complex)))
