"""Equations of a few unknowns at many points: known solutions, rows to exchange, no inverse, the company of a point.

Whole numbers make the expected solutions exact: a right side is the product of a matrix and a solution, not rounded.
"""

import numpy as np
import pytest

from proprotor.rotor import trim_bound
from proprotor.rotor.elimination import by_lapack, eliminate, points_last, solve

RNG = np.random.default_rng(20)
SIZES = (1, 2, 3, 4)
EXCHANGED = np.array([[0.0, 2, 1, 0], [3, 0, 0, 1], [0, 0, 1, 4], [1, 1, 0, 0]])  # no pivot in the first row


def whole_numbers(size, points, sides=3):
    """Matrices (k, k, n) with a large diagonal, solutions and right sides (k, sides, n), all of whole numbers."""
    matrix = RNG.integers(-9, 10, (size, size, points)).astype(float)
    matrix += 40 * np.eye(size)[..., None]
    solution = RNG.integers(-99, 100, (size, sides, points)).astype(float)
    return matrix, solution, np.einsum("ijn,jmn->imn", matrix, solution)


@pytest.mark.parametrize("solved", [eliminate, by_lapack])
@pytest.mark.parametrize("size", SIZES)
def test_known_solutions_are_found(solved, size):
    matrix, solution, right = whole_numbers(size, 50)
    np.testing.assert_allclose(solved(matrix, right), solution, rtol=0, atol=1e-12)


@pytest.mark.parametrize("size", SIZES)
def test_the_unit_of_a_row_does_not_matter(size, monkeypatch):
    monkeypatch.setattr("proprotor.rotor.elimination.by_lapack", None)  # nothing may need it
    matrix, solution, right = whole_numbers(size, 50)
    units = 2.0 ** RNG.integers(-60, 60, (size, 1, 50))
    found = eliminate(matrix * units, right * units)
    np.testing.assert_allclose(found, solution, rtol=0, atol=1e-12)


@pytest.mark.parametrize("small", [0.0, 1e-17, 1e-5])
def test_rows_are_exchanged_where_the_elimination_would_lose_digits(small):
    matrix, solution, right = whole_numbers(4, 5)
    matrix[..., 2] = EXCHANGED + small * np.eye(4)
    right[..., 2] = matrix[..., 2] @ solution[..., 2]
    with np.errstate(all="ignore"):
        found = eliminate(matrix, right)
    np.testing.assert_allclose(found, solution, rtol=1e-13, atol=1e-12)


@pytest.mark.parametrize(
    "without", [np.zeros((3, 3)), np.ones((3, 3)), np.diag([1.0, 2, 0]), np.full((3, 3), np.nan)]
)
def test_a_matrix_without_inverse_is_nan_and_spoils_no_other_point(without):
    matrix, solution, right = whole_numbers(3, 4)
    matrix[..., 1] = without
    with np.errstate(all="ignore"):
        found = eliminate(matrix, right)
    assert np.isnan(found[..., 1]).all()
    np.testing.assert_allclose(np.delete(found, 1, -1), np.delete(solution, 1, -1), rtol=0, atol=1e-12)


@pytest.mark.parametrize("size", SIZES)
def test_a_point_has_the_same_bits_in_every_batch(size):
    matrix, right = RNG.normal(size=(size, size, 67)), RNG.normal(size=(size, 5, 67))
    together = eliminate(matrix, right)
    for points in (slice(5, 6), slice(3, 20), [66, 0, 8]):
        np.testing.assert_array_equal(
            eliminate(matrix[..., points], right[..., points]), together[..., points]
        )


def test_lapack_has_points_first():
    matrix, solution, right = whole_numbers(4, 6)
    found = solve(np.moveaxis(matrix, -1, 0), np.moveaxis(right, -1, 0))
    np.testing.assert_allclose(points_last(found), solution, rtol=0, atol=1e-12)


@pytest.mark.parametrize("size", SIZES)
def test_the_bound_is_a_bound_of_the_spectral_radius_and_sharp(size):
    matrix = RNG.uniform(
        1, 2, (size, size, 40)
    )  # each step takes two thirds off the error, by Birkhoff's theorem
    radius = np.abs(np.linalg.eigvals(np.moveaxis(matrix, -1, 0))).max(axis=-1)
    bound = trim_bound._radius(matrix, enough=0.0)
    assert (bound >= radius).all()
    np.testing.assert_allclose(bound, radius, rtol=np.log(4) / 3**8)


def test_a_matrix_of_zeros_has_no_radius():
    assert trim_bound._radius(np.zeros((3, 3, 2)), enough=0.0) == pytest.approx(0, abs=1e-8)
