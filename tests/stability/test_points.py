"""Points of many lines solved at once, where one of them cannot be solved."""

import numpy as np
import pytest

from proprotor.stability import points
from proprotor.stability.points import solve_points
from tests.known_systems import linear_model

POSITIONS = np.array([0.1, 0.2, 0.3, 0.4, 0.6, 0.7, 0.8, 0.9])
REFUSED = 0.8  # for which LAPACK finds no eigenvalues


def models(line, position):
    """A spring and a rotor whose azimuth a shaft holds beyond 0.5: three states before, four after."""
    position = np.asarray(position).real
    if (position == REFUSED).any():
        raise np.linalg.LinAlgError("Eigenvalues did not converge")
    stiffness = np.zeros((len(position), 2, 2))
    stiffness[:, 0, 0] = 100 * position
    stiffness[:, 1, 1] = np.where(position > 0.5, 400 * position, 0)
    return linear_model(np.eye(2), np.diag([0.2, 0.4]), stiffness, ("spring", "azimuth"))


@pytest.fixture(params=[2000, 3, 1], autouse=True)
def at_once(request, monkeypatch):
    """All points at once, in parts of which one has both numbers of states, and one by one."""
    monkeypatch.setattr(points, "_AT_ONCE", request.param)


def test_a_point_that_cannot_be_solved_spoils_no_other_where_numbers_of_states_differ():
    """Roots of λ² + 0.2 λ + 100 p and λ² + 0.4 λ + 400 p, or λ + 0.4 where nothing holds the azimuth."""
    found = solve_points(models, np.zeros(len(POSITIONS), dtype=int), POSITIONS, 0.0)
    works = POSITIONS != REFUSED
    assert found.works.tolist() == works.tolist()
    assert found.reason[~works] == ["Eigenvalues did not converge"]
    assert found.points.position.tolist() == POSITIONS[works].tolist()
    for position, values in zip(POSITIONS[works], found.points.spectrum.values, strict=True):
        azimuth = np.roots([1, 0.4, 400 * position]) if position > 0.5 else [-0.4]
        expected = np.sort_complex([*np.roots([1, 0.2, 100 * position]), *azimuth])
        np.testing.assert_allclose(np.sort_complex(values[np.isfinite(values)]), expected, rtol=1e-12)
    assert ["no shaft" in str(text) for text in found.missing] == [bool(p < 0.5) for p in POSITIONS]


def test_plain_points_have_room_for_the_most_states_as_well():
    found = solve_points(models, np.zeros(len(POSITIONS), dtype=int), POSITIONS, 0.0, plain=True)
    assert found.points.spectrum.values.shape == (len(POSITIONS) - 1, 4)
    assert np.isnan(found.points.spectrum.values).sum() == (POSITIONS < 0.5).sum()
