"""Points within steps that are solved before they are asked for."""

import numpy as np
import pytest

from proprotor.stability.points import solve_points
from proprotor.stability.points_ahead import PointsAhead
from tests.known_systems import linear_model

FAILS = 0.375  # beyond the middle of the first half of a step from 0 to 1


class Asked:
    """A spring whose stiffness is 1 + the position, and the points that were solved in each call."""

    def __init__(self):
        self.calls = []

    def __call__(self, line, position):
        self.calls.append(sorted(zip(line.tolist(), position.tolist(), strict=True)))
        return solve_points(self.models, line, position, 0.0)

    def models(self, line, position):
        at = np.asarray(position).real
        if (at == FAILS).any():
            raise np.linalg.LinAlgError("Eigenvalues did not converge")
        one = np.ones((len(at), 1, 1))
        return linear_model(one, 0.2 * one, 1 + np.asarray(position)[:, None, None] * one, ("spring",))


def within(ahead, asked, low, high, share=0.5, line=0):
    low, high, share, line = np.broadcast_arrays(*map(np.atleast_1d, (low, high, share, line)))
    return ahead.within(line, np.stack([low, high]).astype(float), share.astype(float), asked)


def test_halves_and_quarters_of_a_halved_step_are_not_solved_again():
    asked = Asked()
    ahead = PointsAhead()
    within(ahead, asked, 0, 1)
    assert asked.calls[0] == [(0, eighth / 8) for eighth in range(1, 8)]
    count = len(asked.calls)
    found, works = within(ahead, asked, [0.5, 0], [1, 0.5])
    assert found.position.tolist() == [0.75, 0.25] and works.all()
    found, works = within(ahead, asked, [0, 0.75], [0.25, 1])
    assert found.position.tolist() == [0.125, 0.875]
    np.testing.assert_allclose(np.abs(found.spectrum.values[:, 0]) ** 2, [1.125, 1.875], rtol=1e-12)
    assert len(asked.calls) == count
    assert len(ahead.lines) == 1  # 0.625; 0.375 failed


def test_a_point_ahead_that_fails_is_a_failure_once_it_is_asked_for():
    asked = Asked()
    ahead = PointsAhead()
    found, works = within(ahead, asked, 0, 1)
    assert works.all() and found.position.tolist() == [0.5]
    found, works = within(ahead, asked, [0.25, 0.5], [0.5, 0.75])
    assert works.tolist() == [False, True] and found.position.tolist() == [0.625]
    found, works = within(ahead, asked, 0.25, 0.5)
    assert found is None and not works.any()


@pytest.mark.parametrize(("count", "share"), [(1, 0.4), (3, 0.5)], ids=["not halved", "many steps"])
def test_nothing_is_solved_ahead_where_it_would_cost_more_than_it_spares(count, share):
    asked = Asked()
    ahead = PointsAhead()
    found, _ = within(ahead, asked, np.zeros(count), np.ones(count), share, np.arange(count))
    assert asked.calls == [[(line, share) for line in range(count)]]
    assert found.line.tolist() == list(range(count)) and ahead.lines == []
