"""Compiled motions of the coordinates beside those of NumPy: random modes, with roots at zero and states that miss."""

import numpy as np
import pytest

from proprotor.compiled import shapes
from proprotor.compiled.library import why_not

pytestmark = pytest.mark.skipif("there is no C compiler" in why_not(), reason="there is no C compiler")
N, POINTS = 5, 40


def given(held):
    rng = np.random.default_rng(1)
    states = N + len(held)
    values, right = (
        rng.standard_normal((POINTS, *size)) + 1j * rng.standard_normal((POINTS, *size))
        for size in ((states,), (states, states))
    )
    return values, right, rng.permuted(np.tile(np.arange(states), (POINTS, 1)), axis=1)


def expected(held, value, vector):
    """The motion of one mode, coordinate by coordinate, in multiples of its largest one."""
    motion = np.array([vector[len(held) + place] / value for place in range(N)])
    for state, place in enumerate(held):
        motion[place] = vector[state]
    return motion / motion[np.abs(motion).argmax()]


@pytest.mark.parametrize("held", [(), (1, 3), (0, 1, 2, 3, 4)])
def test_motions_are_displacements_or_rates_over_the_eigenvalue(held):
    values, right, order = given(held)
    found = shapes.coordinate_motions(N, held, values, right, order)
    for point in range(POINTS):
        for mode, column in enumerate(order[point]):
            motion = expected(held, values[point, column], right[point, :, column])
            np.testing.assert_allclose(found[point, :, mode], motion, rtol=1e-13)
    assert (found == 1).any(axis=1).all()


def test_a_rate_without_a_root_has_no_displacement_and_a_state_that_misses_has_no_motion():
    held = (1, 3)
    values, right, order = given(held)
    alone = shapes.coordinate_motions(N, held, values, right, order)
    values[4, 2], values[6, 3] = 0.0, np.nan
    found = shapes.coordinate_motions(N, held, values, right, order)
    at_zero, missing = found[4, :, order[4] == 2][0], found[6, :, order[6] == 3][0]
    assert np.isnan(at_zero[[0, 2, 4]]).all() and np.isnan(missing).all()
    ratio = right[4, :2, 2] / right[4, np.abs(right[4, :2, 2]).argmax(), 2]
    np.testing.assert_allclose(at_zero[list(held)], ratio, rtol=1e-13)
    others = np.delete(np.arange(POINTS), (4, 6))
    assert (found[others] == alone[others]).all()
