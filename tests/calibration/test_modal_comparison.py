"""Measured modes beside those of a model: the criterion by hand, and a structure against itself."""

from dataclasses import replace

import numpy as np
import pytest
import pyuff

import proprotor as pp
from proprotor.calibration.modal_comparison import _assurance as assurance
from proprotor.model import mass_at_rest
from proprotor.model.rotor_share import rotor_share
from proprotor.support.universal_modes import universal_modes

CASE = pp.load_case("xv15")


def test_the_criterion_by_hand():
    one = np.array([[3.0, 0.0, 0.0, 0.0, 0.5, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]]).T
    other = np.array([[1.0, 1.0, 0.0, 0.0, 1.0, 0.0]]).T
    # At a distance of 2 m: a = (3, 0, 1), b = (1, 1, 2) in x, y and 2 α_y; a·b = 5, a·a = 10, b·b = 6.
    assert assurance(one, other, 2.0) == pytest.approx(np.array([[25 / 60], [1 / 6]]))
    assert assurance(one, one, 2.0) == pytest.approx(np.array([[1, 0], [0, 1]]))


def measured(frequency=(0.95, 1.02, 1.0), damping=0.01):
    """Modes of the wing with its rotor as a point mass, in another order and with frequencies that are off."""
    support = CASE.support
    at_hub = support.hub.T @ rotor_share(mass_at_rest(CASE.rotor), "mass only") @ support.hub
    share = support.hub.T @ rotor_share(mass_at_rest(CASE.rotor), "gimballed") @ support.hub
    bare = support.mass - share if support.includes_rotor else support.mass
    square, shapes = np.linalg.eig(np.linalg.solve(bare + at_hub, support.stiffness))
    order = np.argsort(square)
    mass = np.einsum("im,ij,jm->m", shapes, bare + at_hub, shapes)[order]
    own = np.sqrt(square[order])
    scale = np.ones(len(own))
    scale[: len(frequency)] = frequency
    return own, pp.NormalModes.from_frequencies(
        [f"test {place}" for place in range(len(own))],
        mass,
        own * scale,
        np.full(len(own), damping),
        support.hub @ shapes[:, order],
        "mass only",
    )


def test_a_structure_is_compared_with_its_rotor_held_as_in_the_test():
    own, test = measured()
    found = pp.compare_modes(CASE, test)
    assert found.pair_mac.values == pytest.approx(np.ones(len(own)), abs=1e-9)
    assert found.model_frequency.values == pytest.approx(own, rel=1e-9)
    misfit = found.frequency_misfit.values
    assert misfit[:3] == pytest.approx([1 / 0.95 - 1, 1 / 1.02 - 1, 0], abs=1e-9)
    assert len(set(found.pair.values.tolist())) == len(own)
    assert found.measured_damping.values == pytest.approx(np.full(len(own), 0.01))


def test_the_model_is_itself():
    found = pp.compare_modes(CASE, CASE.support)
    assert np.diagonal(found.mac.values) == pytest.approx(np.ones(found.sizes["model"]))
    assert found.frequency_misfit.values == pytest.approx(np.zeros(found.sizes["measured"]), abs=1e-9)


def test_two_modes_that_move_the_hub_alike_are_told():
    _, test = measured()
    hub = np.array(test.hub)
    hub[:, 1] = hub[:, 0] * 1.5
    found = pp.compare_modes(CASE, replace(test, hub=hub))
    assert found.pair_mac.values[1] < 0.9 or "as much like it" in found.warning.values[1]


def test_more_measured_modes_than_the_model_has():
    own, test = measured()
    doubled = pp.NormalModes.from_frequencies(
        [f"test {place}" for place in range(2 * len(own))],
        np.tile(test.mass.diagonal(), 2),
        np.concatenate([own, 3 * own]),
        np.full(2 * len(own), 0.01),
        np.concatenate([test.hub, np.roll(test.hub, 1, axis=0)], axis=1),
        "mass only",
    )
    found = pp.compare_modes(CASE, doubled)
    assert (found.pair.values == "").sum() == len(own)
    assert set(found.warning.values[found.pair.values == ""]) == {"no mode of the model is left for it"}


def test_what_cannot_be_compared_is_refused():
    with pytest.raises(pp.InputError, match="must carry one rotor"):
        pp.compare_modes(pp.load_case("xv15-aircraft"), CASE.support)
    path = "support.beam_frequency"
    many = CASE.vary({path: np.array([0.9, 1.0]) * float(CASE.given[path].si)})
    with pytest.raises(pp.InputError, match="must be one design"):
        pp.compare_modes(many, CASE.support)


def test_modes_of_a_universal_file_are_compared(tmp_path):
    """Written by pyuff with the six motions of the hub's node, in the axes of an aircraft: X = -z, Y = y, Z = x."""
    own, test = measured(frequency=(1.0, 1.0, 0.9))
    shapes = np.stack([-test.hub[2], test.hub[1], test.hub[0], -test.hub[5], test.hub[4], test.hub[3]])
    hertz = own * np.array([1.0, 1.0, 0.9, *np.ones(len(own) - 3)]) / (2 * np.pi)
    sets = [
        {
            "type": 55, "id1": "a", "id2": "b", "id3": "c", "id4": "d", "id5": "e", "model_type": 1,
            "analysis_type": 2, "data_ch": 3, "spec_data_type": 8, "data_type": 2, "n_data_per_node": 6,
            "load_case": 1, "mode_n": place + 1, "freq": hertz[place], "modal_m": test.mass[place, place],
            "modal_damp_vis": 0.01, "modal_damp_his": 0.0, "node_nums": [7],
            **{f"r{k + 1}": np.array([shapes[k, place]]) for k in range(6)},
        }
        for place in range(len(own))
    ]  # fmt: skip
    pyuff.UFF(str(tmp_path / "gvt.unv")).write_sets(sets, mode="overwrite")
    read = universal_modes(
        tmp_path / "gvt.unv", 7, includes_rotor="mass only", length_unit=1.0, mass_unit=1.0
    )
    found = pp.compare_modes(CASE, read)
    order = np.argsort(hertz)  # of the file's modes by frequency
    assert found.pair_mac.values == pytest.approx(np.ones(len(own)), abs=1e-6)
    assert found.model_frequency.values == pytest.approx(own[order], rel=1e-9)
    assert found.measured_frequency.values == pytest.approx(2 * np.pi * hertz[order], rel=1e-5)
    worst = int(np.flatnonzero(order == 2)[0])
    assert found.frequency_misfit.values[worst] == pytest.approx(1 / 0.9 - 1, rel=1e-3)
