"""Two rotors on one support: the aircraft's symmetric half is the semispan."""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from proprotor.errors import InputError
from proprotor.model.first_order import state_matrix
from proprotor.model.rotor_model import rotor_model
from proprotor.model.several_rotors import MountedRotor, mount_rotors
from proprotor.rotor.motions import HUB

TOLERANCE = 1e-9  # of an eigenvalue: a matrix of twice the size
FLIPPED = np.array([1, -1, 1, -1, 1, -1.0])  # y and the turns about x and z, seen in a mirror across y


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


def semispan(case, stiffer, **options):
    support = replace(case.support, stiffness=case.support.stiffness * stiffer)
    return replace(case, support=support).linearize([100.0, 160.0], rotor_speed="constant", **options)


def aircraft(case, stiffer):
    """Symmetric modes as the semispan's, antisymmetric ones with springs stiffer by a factor."""
    half = case.support

    def both(matrix, factor=1.0):
        none = np.zeros_like(matrix)
        return 2 * np.block([[matrix, none], [none, factor * matrix]])

    names = [f"{kind} {name}" for kind in ("symmetric", "antisymmetric") for name in half.names]
    right = np.hstack([half.hub, half.hub])
    left = FLIPPED[:, None] * np.hstack([half.hub, -half.hub])
    support = pp.NormalModes(
        names, both(half.mass), both(half.damping), both(half.stiffness, stiffer), right, includes_rotor=True
    )
    rotor = rotor_model(case.rotor, case.operation, [100.0, 160.0], rotor_speed="constant")
    rotors = {
        "right": MountedRotor(rotor, right),
        "left": MountedRotor(rotor, left, mirrored=True),
    }
    return mount_rotors(rotors, support)


def sorted_values(model):
    values = np.linalg.eigvals(state_matrix(model))
    return [np.sort_complex(point) for point in values]


def test_symmetric_modes_are_those_of_the_semispan(case):
    """And the antisymmetric ones those of a semispan on their springs."""
    whole = sorted_values(aircraft(case, 1.5))
    halves = [sorted_values(semispan(case, stiffer)) for stiffer in (1.0, 1.5)]
    for point, both in enumerate(whole):
        expected = np.concatenate([half[point] for half in halves])
        assert len(both) == len(expected)
        nearest = np.abs(both[:, None] - expected).min(axis=0)
        np.testing.assert_array_less(nearest, TOLERANCE * np.maximum(np.abs(expected), 1))


def test_a_mirrored_rotor_turns_the_other_way(case):
    """On its bare hub: gyroscopic moments and the torque change sign, inertia does not."""
    rotor = rotor_model(case.rotor, case.operation, 120.0, airloads="none", rotor_speed="constant").submodel(
        HUB
    )
    nothing = np.zeros((6, 6))
    support = pp.NormalModes(HUB, nothing, nothing, nothing, np.eye(6), includes_rotor=False)
    models = [
        mount_rotors({"one": MountedRotor(rotor, np.eye(6), mirrored=mirrored)}, support)
        for mirrored in (False, True)
    ]
    gyroscopic = [model.C[3, 4] for model in models]
    polar = models[0].M[5, 5]
    assert gyroscopic[0] == pytest.approx(case.operation.rotor_speed * polar, rel=1e-3)
    assert gyroscopic[1] == -gyroscopic[0]
    np.testing.assert_array_equal(np.diag(models[1].M), np.diag(models[0].M))


def test_what_cannot_be_mounted(case):
    rotor = rotor_model(case.rotor, case.operation, 100.0)
    with pytest.raises(InputError, match=r"rotors: must be one or more"):
        mount_rotors({}, case.support)
    with pytest.raises(InputError, match=r"rotors\[a\].hub = array of shape \(6, 2\)"):
        mount_rotors({"a": MountedRotor(rotor, np.eye(6)[:, :2])}, case.support)
    with pytest.raises(InputError, match=r"mass_at_rest: must be given with the model"):
        bare = replace(rotor, mass_at_rest=None)
        mount_rotors({"a": MountedRotor(bare, case.support.hub)}, case.support)
    with pytest.raises(InputError, match=r"rotors\[a\].model = .* must begin with"):
        mount_rotors({"a": MountedRotor(rotor.submodel(("x", "y")), case.support.hub)}, case.support)


def test_a_name_that_rotor_and_support_share_is_refused(case):
    rotor = case.linearize(100.0).rotor
    own = replace(rotor, dofs=(*rotor.dofs[:6], "sensor", *rotor.dofs[7:]))
    clashing = replace(case.support, names=("beam", "sensor", "torsion"), includes_rotor=False)
    with pytest.raises(InputError, match=r"^support.names = sensor: must not be a name of the rotor's own"):
        pp.mount(own, clashing)
