"""Coordinates that do not couple are problems of their own, by the structure of the model."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

import proprotor as pp
from proprotor.model.first_order import state_matrix
from proprotor.model.several_rotors import MountedRotor, mount_rotors
from proprotor.model.side import Side
from proprotor.stability.modes import decomposition, eigenvalues

SPEEDS = np.array([60.0, 110.0, 150.0])
ROUNDING = 1e-12  # of the largest eigenvalue: two ways to solve one problem


def with_blades(name, n_blades):
    case = pp.load_case(name)
    return replace(case, rotor=replace(case.rotor, n_blades=n_blades))


def linearized(case):
    return case.linearize(SPEEDS, reactionless=True)


def with_two_sides():
    """An aircraft of five-bladed rotors whose left rotor has other springs."""
    case = with_blades("xv15-aircraft", 5)
    left = replace(case.rotor, flap_stiffness=1.1 * case.rotor.flap_stiffness)
    return replace(case, left=Side(left, case.operation, case.frequencies, case.drive_train))


def two_on_one_support():
    case = with_blades("xv15", 4)
    alone = pp.rotor_model(case.rotor, case.operation, SPEEDS, reactionless=True)
    left = MountedRotor(alone, case.support.hub, mirrored=True)
    return mount_rotors({"right": MountedRotor(alone, case.support.hub), "left": left}, case.support)


MODELS = {
    "three blades": (lambda: linearized(with_blades("xv15", 3)), [15]),
    "four blades": (lambda: linearized(with_blades("xv15", 4)), [15, 3]),
    "five blades": (lambda: linearized(with_blades("xv15", 5)), [15, 6]),
    "eight blades": (lambda: linearized(with_blades("xv15", 8)), [15, 6, 6, 3]),
    "rigid pitch": (
        lambda: with_blades("xv15", 8).linearize(SPEEDS, reactionless=True, pitch="rigid"),
        [12, 4, 4, 2],
    ),
    "aircraft": (lambda: linearized(with_blades("xv15-aircraft", 6)), [None, None, 6, 3, 6, 3]),
    "two sides": (lambda: linearized(with_two_sides()), [None, 12]),
    "two rotors": (two_on_one_support, [None, 3, 3]),
}


@pytest.fixture(scope="module", params=MODELS)
def model(request):
    return MODELS[request.param][0]()


@pytest.mark.parametrize("name", MODELS)
def test_reactionless_motions_are_blocks_of_their_own(name):
    make, sizes = MODELS[name]
    found = [len(block) for block in make().blocks]
    assert [size if wanted else None for size, wanted in zip(found, sizes, strict=True)] == sizes


def test_blocks_hold_each_coordinate_once_and_do_not_couple(model):
    assert sorted(itertools.chain(*model.blocks)) == list(range(len(model.dofs)))
    for one, other in itertools.permutations(model.blocks, 2):
        for name in "MCK":
            assert not getattr(model, name)[:, np.array(one)[:, None], other].any()


def test_eigenvalues_of_blocks_are_those_of_the_whole_state_matrix(model):
    whole = np.linalg.eigvals(state_matrix(model))
    for found in (eigenvalues(model), decomposition(model).values):
        for own, joined in zip(found, whole, strict=True):
            apart = np.abs(own[:, None] - joined)
            rows, columns = linear_sum_assignment(apart)
            assert apart[rows, columns].max() < ROUNDING * np.abs(joined).max()


def test_vectors_of_blocks_are_those_of_the_whole_state_matrix(model):
    spectrum = decomposition(model)
    for matrix, values, right in zip(state_matrix(model), spectrum.values, spectrum.right, strict=True):
        left = np.abs(matrix @ right - right * values).max()
        assert left < ROUNDING * np.abs(matrix).max()


def test_a_part_of_a_model_has_the_parts_of_the_blocks():
    model = linearized(with_blades("xv15", 8))
    kept = ("flap_2c", "beam", "flap_2s", "lag_d", "flap_0")
    assert model.submodel(kept).apart == (("flap_2c", "flap_2s"), ("lag_d",))
    assert model.submodel(kept).blocks == [[1, 4], [0, 2], [3]]
