"""The lowest onset is the same whichever of several equally good assignments of roots a search takes.

Roots on one line, as those of oscillators with one damping, and a pair that parts into two real roots have several
assignments with the same sum of distances. An adversary chooses among them by a random price that is too small to buy a
worse one, and dense roots tell where the lowest onset lies.
"""

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from proprotor.stability import screening
from proprotor.stability.brackets import Brackets
from proprotor.stability.crossings import Search
from proprotor.stability.steps import first_steps
from tests.known_systems import along, roots

PRICE = 1e-10  # of the largest distance: too little to buy a longer way
DENSE = np.linspace(0, 10, 20001)
CLOSE = 6e-4  # a step of the dense roots, and a little
ADVERSARIES = range(3)


def adversary(seed):
    """Steps by values as a search asks for them, each by a random one of the best assignments."""
    random = np.random.default_rng(seed)

    def steps_by_values(values, block, before, after):
        successor = np.empty((len(before), values.shape[1]), dtype=int)
        assert (block == 0).all() and np.isfinite(values).all()
        for step, ends in enumerate(zip(before, after, strict=True)):
            apart = np.abs(np.subtract.outer(*values[list(ends)]))
            price = PRICE * apart.max() * random.random(apart.shape)
            rows, successor[step] = linear_sum_assignment(apart + price)
            best = apart[linear_sum_assignment(apart)].sum()
            assert apart[rows, successor[step]].sum() <= best + PRICE * len(rows) * apart.max()
        return first_steps(before, after, successor, np.full(successor.shape, np.nan))

    return steps_by_values


def lowest_onset(matrices, points):
    scan = np.linspace(0, 10, points)
    search = Search(lambda _, x: along(matrices)(x), np.zeros(points, dtype=int), scan, onset_only=True)
    return min((one.position for one in Brackets(search).close() if one.onset), default=np.inf)


def by_dense_roots(matrices):
    unstable = (roots(along(matrices)(DENSE)).real > 1e-9).any(axis=1)
    assert not unstable[0]
    return DENSE[unstable.argmax()] if unstable.any() else np.inf


def on_one_line(rate, width):
    """Two oscillators with one damping; where they meet one of them grows if the width is above 0.3."""
    coupling = width * np.array([[0.0, 1.0], [-1.0, 0.0]])

    def matrices(x):
        stiffness = np.diag([100.0, 0.0]) + (100 + rate * (x - 6.13)) * np.diag([0.0, 1.0])
        return np.eye(2), 0.03 * np.eye(2) + 0 * x, stiffness + coupling

    return matrices


def pairs_that_part(seed):
    """Three oscillators whose pairs are two real roots for a while, one of which may diverge meanwhile."""
    random = np.random.default_rng(seed)
    damping, least, where, rise = (random.uniform(*of, 3) for of in ((0.5, 12), (0.1, 3), (0, 10), (0.05, 4)))
    coupling = random.uniform(0, 0.6) * random.normal(size=(3, 3))
    least[1] = -0.2

    def matrices(x):
        stiffness = np.diag(least) + np.eye(3) * (rise * (x - where) ** 2) + coupling
        return np.eye(3), np.diag(2 * damping) + 0 * x, stiffness

    return matrices


def stable_at_start(make):
    """Seeds of systems that are stable at 0."""
    return [seed for seed in range(16) if (roots(along(make(seed))(np.zeros(1))).real < -1e-3).all()]


SYSTEMS = {
    **{
        f"on one line, {rate}, {width}": on_one_line(rate, width)
        for rate in (4.0, 12.0)
        for width in (0.29, 0.3005, 0.35)
    },
    **{f"pairs that part, {seed}": pairs_that_part(seed) for seed in stable_at_start(pairs_that_part)},
}


@pytest.mark.parametrize("points", [4, 8, 20])
@pytest.mark.parametrize("system", SYSTEMS)
def test_the_lowest_onset_does_not_depend_on_which_equal_assignment_is_taken(monkeypatch, system, points):
    expected = by_dense_roots(SYSTEMS[system])
    own = lowest_onset(SYSTEMS[system], points)
    assert own == pytest.approx(expected, abs=CLOSE)
    for seed in ADVERSARIES:
        monkeypatch.setattr(screening, "_steps_by_values", adversary(seed))
        assert lowest_onset(SYSTEMS[system], points) == pytest.approx(own, rel=1e-9)


@pytest.mark.parametrize("rates", [(-12.0, 12.0), (-5.0, 12.0), (-12.0, 4.0)])
@pytest.mark.parametrize("points", [7, 20])
def test_roots_that_pass_within_a_step_are_seen_though_the_nearest_ones_turn_back(rates, points):
    """Wherever within a step they meet: the roots that are nearest to each other at its ends are not the same ones."""
    coupling = 0.305 * np.array([[0.0, 1.0], [-1.0, 0.0]])
    for where in np.linspace(5.01, 5.01 + 10 / (points - 1), 6):

        def matrices(x, where=where):
            stiffness = 100 * np.eye(2) + (x - where) * np.diag(rates)
            return np.eye(2), 0.03 * np.eye(2) + 0 * x, stiffness + coupling

        assert lowest_onset(matrices, points) == pytest.approx(by_dense_roots(matrices), abs=CLOSE)
