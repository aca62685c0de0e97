"""The compiled solver of eigenvalue problems: all kinds of matrices, by singular values and residuals."""

import numpy as np
import pytest

from proprotor.compiled import eigenvalues as compiled
from proprotor.compiled.library import why_not
from tests.compiled.matrices import FAMILIES, backward_error, residual

pytestmark = pytest.mark.skipif("there is no C compiler" in why_not(), reason="there is no C compiler")
SIZES = (1, 2, 3, 4, 5, 8, 13, 29, 40, 64)
BACKWARD = 1e-14  # of the norm


@pytest.mark.parametrize("family", FAMILIES)
def test_eigenvalues_and_vectors_are_those_of_a_matrix_that_differs_by_rounding(family):
    rng = np.random.default_rng(1)
    for n in SIZES:
        matrices = FAMILIES[family](rng, 19, n)
        values, right = compiled.eig(matrices)
        assert (backward_error(matrices, values) <= BACKWARD).all() or family == "denormal", n
        assert (residual(matrices, values, right) <= 10 * BACKWARD).all(), n
        alone = compiled.eigvals(matrices)
        assert (backward_error(matrices, alone) <= BACKWARD).all() or family == "denormal", n


@pytest.mark.parametrize("family", FAMILIES)
def test_almost_nothing_is_handed_over_to_lapack(family):
    rng = np.random.default_rng(2)
    matrices = [FAMILIES[family](rng, 40, n) for n in SIZES]
    share = np.mean(np.concatenate([compiled.handed_over(batch) for batch in matrices]))
    assert share == 1.0 if family == "denormal" else share < 0.02


def test_vectors_have_length_one_and_pairs_are_conjugate():
    matrices = FAMILIES["random"](np.random.default_rng(3), 25, 12)
    values, right = compiled.eig(matrices)
    np.testing.assert_allclose(np.linalg.norm(right, axis=1), 1.0, rtol=1e-14)
    for own, vectors in zip(values, right, strict=True):
        for place in np.flatnonzero(own.imag > 0):
            other = int(np.argmin(np.abs(own - own[place].conj())))
            assert own[other] == own[place].conj()
            turn = vectors[:, other].conj() @ vectors[:, place].conj()
            assert abs(abs(turn) - 1) < 1e-12


def test_a_matrix_has_the_same_bits_in_any_company():
    rng = np.random.default_rng(4)
    matrices = np.concatenate([family(rng, 3, 9) for name, family in FAMILIES.items() if name != "of motion"])
    values, right = compiled.eig(matrices)
    order = rng.permutation(len(matrices))
    again, turned = compiled.eig(matrices[order])
    assert (again == values[order]).all() and (turned == right[order]).all()
    for place in range(0, len(matrices), 7):
        assert (compiled.eigvals(matrices[place : place + 1])[0] == values[place]).all()


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_what_is_not_finite_spoils_no_other_and_is_refused_as_by_numpy(bad):
    matrices = FAMILIES["random"](np.random.default_rng(5), 21, 7)
    expected = compiled.eigvals(matrices)
    matrices[10, 3, 4] = bad
    rest = compiled.handed_over(matrices)
    assert rest[10] and rest.sum() == 1
    good = np.delete(matrices, 10, axis=0)
    assert (compiled.eigvals(good) == np.delete(expected, 10, axis=0)).all()
    with pytest.raises(np.linalg.LinAlgError):
        compiled.eigvals(matrices)


def test_shapes_are_those_of_numpy():
    matrices = FAMILIES["random"](np.random.default_rng(6), 12, 5).reshape(3, 4, 5, 5)
    values, right = compiled.eig(matrices)
    assert (
        values.shape == (3, 4, 5)
        and right.shape == (3, 4, 5, 5)
        and compiled.eigvals(matrices).shape == (3, 4, 5)
    )
    assert compiled.eigvals(matrices[:0]).shape == (0, 4, 5)
    large = FAMILIES["random"](np.random.default_rng(7), 1, compiled.MOST_STATES + 1)
    assert (np.sort(compiled.eigvals(large)) == np.sort(np.linalg.eigvals(large))).all()


def motions(rng, count, n):
    mass, stiffness, damping = (rng.standard_normal((count, n, n)) for _ in range(3))
    return mass @ mass.swapaxes(1, 2) + np.eye(n), damping, stiffness @ stiffness.swapaxes(1, 2)


@pytest.mark.parametrize("held", [(), (0, 2, 3), (0, 1, 2, 3, 4)])
def test_roots_of_motion_solve_the_equations_of_motion(held):
    mass, damping, stiffness = motions(np.random.default_rng(8), 30, 5)
    values, rest = compiled.roots_of_motion(mass, damping, stiffness, held)
    assert not rest.any() and values.shape == (30, 5 + len(held))
    own = np.zeros((5, 5))
    own[list(held), list(held)] = 1
    for place in range(30):
        for root in values[place]:  # of M s² + C s + K, where K acts on the held coordinates alone
            rates = mass[place] * root + damping[place] + (stiffness[place] @ own) / root
            smallest = np.linalg.svd(rates, compute_uv=False)[-1]
            assert smallest <= 1e-11 * np.linalg.norm(rates)


def test_more_states_than_the_compiled_functions_have_room_for_are_handed_over():
    half = compiled.MOST_STATES // 2
    for n, expected in ((half, False), (half + 1, True)):
        _, rest = compiled.roots_of_motion(*motions(np.random.default_rng(10), 2, n), range(n))
        assert (rest == expected).all()


def test_a_mass_matrix_that_needs_exchanges_of_rows_is_handed_over():
    mass, damping, stiffness = motions(np.random.default_rng(9), 20, 4)
    mass[7] = np.eye(4)[[1, 0, 3, 2]]
    mass[11] = 0.0
    mass[13, 2] = np.nan
    expected, _ = compiled.roots_of_motion(*motions(np.random.default_rng(9), 20, 4), range(4))
    values, rest = compiled.roots_of_motion(mass, damping, stiffness, range(4))
    assert np.flatnonzero(rest).tolist() == [7, 11, 13]
    assert (values[~rest] == expected[~rest]).all()
