"""The assignment with the largest sum is the one that SciPy finds, over random matrices of every kind."""

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from proprotor.stability.assignment import best_assignment

RNG = np.random.default_rng(17)


def _near_a_permutation(rows, columns):
    gain = 0.1 * RNG.random((rows, columns))
    gain[np.arange(rows), RNG.permutation(columns)[:rows]] += 1
    return gain


KINDS = {
    "any numbers": lambda *shape: RNG.normal(size=shape),
    "many ties": lambda *shape: RNG.integers(0, 3, shape).astype(float),
    "all equal": lambda *shape: np.zeros(shape),
    "each column twice": lambda rows, columns: np.repeat(RNG.random((rows, columns)), 2, axis=1)[:, :columns],
    "one column best for all": lambda *shape: RNG.random(shape) + 5 * (np.arange(shape[1]) == shape[1] // 2),
    "products, the worst for the search": lambda *shape: (
        -np.outer(np.arange(shape[0]), np.arange(shape[1])) * 1.0
    ),
    "nearly a permutation": _near_a_permutation,
    "pairs that must never be": lambda *shape: np.where(RNG.random(shape) < 0.2, -1e9, RNG.random(shape)),
}


@pytest.mark.parametrize("kind", KINDS)
def test_the_sum_is_as_large_as_that_of_scipy(kind):
    for size in [1, 2, 3, 5, 8, 29] * 50:
        columns = size + int(RNG.integers(0, 3))
        gain = KINDS[kind](size, columns)
        found, best = best_assignment(gain), linear_sum_assignment(gain, maximize=True)[1]
        rows = np.arange(size)
        assert len(set(found)) == size and found.min() >= 0
        assert gain[rows, found].sum() == pytest.approx(gain[rows, best].sum(), rel=1e-13, abs=1e-12)
        if kind == "any numbers":  # one assignment alone is the best
            assert np.array_equal(found, best)


def test_no_rows_have_no_columns():
    assert best_assignment(np.empty((0, 0))).shape == (0,)


@pytest.mark.parametrize("gain", [np.full((2, 2), np.nan), np.full((2, 2), -np.inf), np.zeros((2, 1))])
def test_what_has_no_assignment_is_refused(gain):
    with pytest.raises(ValueError, match="finite gains"):
        best_assignment(gain)
