"""Compiled functions of equations of motion: on a support, mass in every motion, and modes, by their definitions."""

import numpy as np
import pytest

from proprotor.compiled import eigenvalues, motion
from proprotor.compiled.library import why_not
from proprotor.model.massless import massless

pytestmark = pytest.mark.skipif("there is no C compiler" in why_not(), reason="there is no C compiler")
POINTS = 53  # a last vector has fewer points than lanes


@pytest.mark.parametrize("modes", [1, 4, 11])
@pytest.mark.parametrize("shared", [False, True])
def test_a_rotor_on_a_support_is_a_product_of_matrices(modes, shared):
    rng = np.random.default_rng(modes)
    matrices = [rng.standard_normal((POINTS, 9, columns)) for columns in (9, 9, 9, 4)]
    leading = () if shared else (POINTS,)
    hub = rng.standard_normal((*leading, 6, modes))
    additions = [rng.standard_normal((*leading, modes, modes)) for _ in range(3)]
    turn = np.zeros((*leading, 9, modes + 3))
    turn[..., :6, :modes], turn[..., 6:, modes:] = hub, np.eye(3)
    back = np.swapaxes(turn, -1, -2)
    expected = [back @ matrix @ turn for matrix in matrices[:3]] + [back @ matrices[3]]
    for matrix, addition in zip(expected, additions, strict=False):
        matrix[:, :modes, :modes] += addition
    found, certain = motion.on_support(matrices, motion.Support(hub, additions))
    assert (certain == motion.have_mass(found[0])).all()
    for one, other in zip(found, expected, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-13 * np.abs(other).max())
    without, _ = motion.on_support(matrices[:3], motion.Support(hub, additions))
    assert len(without) == 3 and all((one == other).all() for one, other in zip(without, found, strict=False))
    for matrix in matrices:
        matrix[5, 2, 3] = np.nan
    again, certain = motion.on_support(matrices, motion.Support(hub, additions))
    assert not certain[5]
    own = motion.Support(hub if shared else hub[9:10], [part if shared else part[9:10] for part in additions])
    alone, _ = motion.on_support([matrix[9:10] for matrix in matrices], own)
    for one, other, single in zip(again, found, alone, strict=True):
        assert np.isnan(one[5]).any() and (np.delete(one, 5, 0) == np.delete(other, 5, 0)).all()
        assert (single == other[9]).all()


def masses(rng, n):
    """Mass matrices of coordinates of all sizes, with a motion of less and less mass."""
    base = rng.standard_normal((POINTS, n, n))
    base[:, -1] = base[:, 0] + np.geomspace(1e-9, 1.0, POINTS)[:, None] * base[:, -1]
    size = np.geomspace(1e-3, 1e3, n)
    return base @ base.swapaxes(1, 2) * size[:, None] * size


@pytest.mark.parametrize("n", [2, 5, 18])
def test_a_motion_has_mass_for_certain_where_no_small_part_of_a_coordinate_is_left(n):
    mass = masses(np.random.default_rng(n), n)
    found = motion.have_mass(mass)
    minors = np.stack([np.linalg.det(mass[:, :k, :k]) for k in range(n + 1)], axis=1)
    share = minors[:, 1:] / minors[:, :-1] / mass.diagonal(0, 1, 2)
    clear = (np.abs(share - 1e-6) > 1e-7).all(axis=1)
    assert (found == (share > 1e-6).all(axis=1))[clear].all() and 0.1 < found.mean() < 0.9
    order = np.random.default_rng(1).permutation(POINTS)
    assert (motion.have_mass(mass[order]) == found[order]).all()


def test_massless_motions_are_the_same_with_compiled_functions():
    mass = masses(np.random.default_rng(2), 6)
    mass[3] = 0.0
    mass[4, 1, 2] = np.nan
    mass[5] *= -1.0
    assert (massless(mass, compiled=True) == massless(mass)).all() and massless(mass)[3]
    grid = mass[:52].reshape(4, 13, 6, 6)
    assert (massless(grid, compiled=True) == massless(grid)).all()
    assert massless(mass[3], compiled=True) and not massless(mass[-1], compiled=True)


@pytest.mark.parametrize("held", [(), (0, 2), (0, 1, 2, 3, 4)])
def test_vectors_of_motion_solve_the_equations_of_motion(held):
    rng = np.random.default_rng(3)
    mass, damping, stiffness = (rng.standard_normal((POINTS, 5, 5)) for _ in range(3))
    mass += 5 * np.eye(5)
    mass[8, :, 1] = np.nan
    mass[9] = np.eye(5)[[1, 0, 3, 2, 4]]
    values, right, rest = eigenvalues.modes_of_motion(mass, damping, stiffness, held)
    assert rest[8] and rest[9] and rest.sum() == 2
    displacement, rate = right[:, : len(held)], right[:, len(held) :]
    left = mass @ (rate * values[:, None]) + damping @ rate + stiffness[:, :, list(held)] @ displacement
    assert np.abs(left[~rest]).max() < 1e-12
    assert np.abs((displacement * values[:, None] - rate[:, list(held)])[~rest]).max(initial=0.0) < 1e-12
    np.testing.assert_allclose(np.linalg.norm(right[~rest], axis=1), 1.0, rtol=1e-14)
    alone, again = eigenvalues.roots_of_motion(mass, damping, stiffness, held)
    assert (again == rest).all() and np.isfinite(alone[~rest]).all()
    few = [part[20:21] for part in (mass, damping, stiffness)]
    assert (eigenvalues.modes_of_motion(*few, held)[1] == right[20]).all()


def test_a_problem_with_too_many_states_is_left_to_others():
    n = eigenvalues.MOST_STATES // 2 + 1
    one = np.eye(n)[None]
    assert eigenvalues.roots_of_motion(one, one, one, range(n))[1].all()


@pytest.mark.parametrize("n", [3, 100])
def test_state_matrices_solve_the_equations_of_motion(n):
    rng = np.random.default_rng(n)
    mass, damping, stiffness = (rng.standard_normal((POINTS, n, n)) for _ in range(3))
    mass += 3 * n * np.eye(n)
    held = list(range(0, n, 2))
    found, unsafe = motion.state_matrices(mass, damping, stiffness, held)
    rows = found[:, len(held) :]
    left = mass @ rows + np.concatenate([stiffness[..., held], damping], axis=-1)
    assert not unsafe.any() and np.abs(left).max() < 1e-11
    assert (found[:, : len(held)] == np.eye(n + len(held))[len(held) + np.array(held)]).all()
