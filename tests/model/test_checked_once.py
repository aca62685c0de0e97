"""What one answer needs once is computed once: the mass check of a model, the mass of a rotor at rest."""

import numpy as np
import pytest

import proprotor as pp
from proprotor.errors import InputError
from proprotor.model import linear_model, massless
from proprotor.model.first_order import first_order, state_matrix
from proprotor.model.mass_at_rest import mass_at_rest
from proprotor.rotor.motions import ROTOR_SPEED
from proprotor.stability.modes import decomposition, eigenvalues

SPEEDS = np.linspace(60.0, 150.0, 7)


@pytest.mark.parametrize("name", ["xv15-uncoupled", "xv15-wing"])
def test_the_mass_of_a_model_is_checked_once(monkeypatch, name):
    checks = []
    monkeypatch.setattr(
        linear_model, "massless", lambda *given: checks.append(1) or massless.massless(*given)
    )
    model = pp.load_case(name).linearize(SPEEDS)
    state_matrix(model), eigenvalues(model), decomposition(model)
    assert len(checks) == 1


def test_another_mass_is_checked_anew():
    """A model made from another has a check of its own, however the other was checked."""
    model = pp.load_case("xv15-uncoupled").linearize(100.0)
    assert not model.massless
    with pytest.raises(InputError, match="no inverse"):
        state_matrix(linear_model.replace(model, M=np.zeros_like(model.M), hub=None))


def test_the_mass_at_rest_of_a_rotor_is_kept_and_cannot_be_written_to():
    case = pp.load_case("xv15-uncoupled")
    kept = mass_at_rest(case.rotor)
    assert mass_at_rest(case.rotor) is kept
    assert mass_at_rest(case.vary({"rotor.precone": 0.05}).rotor) is not kept
    with pytest.raises(ValueError, match="read-only"):
        kept[0, 0] = 1.0


@pytest.mark.parametrize("name", ["xv15-uncoupled", "xv15-wing"])
def test_the_state_matrix_is_that_of_the_equations_of_motion(name):
    """M q̈ = -C q̇ - K q for any state, with the accelerations of the state matrix."""
    model = pp.load_case(name).linearize(SPEEDS)
    matrix, n = first_order(model), len(model.dofs)
    held = [place for place, dof in enumerate(model.dofs) if dof != ROTOR_SPEED]
    state = np.random.default_rng(3).normal(size=matrix.shape[-1])
    rate, displacement = state[-n:], np.zeros(n)
    displacement[held] = state[:-n]
    np.testing.assert_array_equal(matrix[:, :-n] @ state, np.tile(rate[held], (len(SPEEDS), 1)))
    forces = np.abs(model.C) @ np.abs(rate) + np.abs(model.K) @ np.abs(displacement)
    left = np.einsum("pij,pj->pi", model.M, matrix[:, -n:] @ state) + model.C @ rate + model.K @ displacement
    assert np.abs(left).max() < 1e-12 * forces.max()
