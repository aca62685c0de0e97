"""Mast, engines and interconnect shaft of two rotors: torsional chains, and what each part becomes in its limits."""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from proprotor.errors import InputError
from proprotor.model.side import Side
from proprotor.stability.modes import decomposition, eigenvalues
from tests import airframes

RIGID = {"airloads": "none", "locked": ("flap", "lag", "pitch", "gimbal")}
DRIVE, ENGINE, MAST, SHAFT, INTERCONNECT = 20.0, 45.0, 2.5e5, 6e3, 3e4
TRAIN = pp.DriveTrain(
    drive_inertia=DRIVE, engine_inertia=ENGINE, mast_stiffness=MAST, interconnect_stiffness=INTERCONNECT
)
RIGID_MAST = replace(TRAIN, mast_stiffness=None)


def aircraft(train, **more):
    """An aircraft whose rotors have no precone, so that their inertia about the shaft is that of straight blades."""
    case = airframes.aircraft(drive_train=train)
    return replace(case, rotor=replace(case.rotor, precone=0.0), **more)


def rotor_inertia(case):
    return float(case.rotor.n_blades * case.rotor.blade_inertia) + DRIVE


def turning(model):
    """The model of the drive train alone, with hubs that do not move."""
    return model.submodel(tuple(name for name in model.dofs if "azimuth" in name or "mast twist" in name))


def chain(inertias, springs):
    """Frequencies of inertias in a row with springs between neighbours, rad/s, the lowest first."""
    stiffness = np.zeros((len(inertias),) * 2)
    for place, spring in enumerate(springs):
        ends = np.ix_([place, place + 1], [place, place + 1])
        stiffness[ends] += spring * np.array([[1, -1], [-1, 1]])
    root = np.diag(np.asarray(inertias) ** -0.5)
    return np.sqrt(np.abs(np.linalg.eigvalsh(root @ stiffness @ root)))


def frequencies(model):
    values = eigenvalues(model)
    assert np.abs(values.real).max() < 1e-6 * np.abs(values).max()
    return np.sort(values.imag[values.imag > 1e-3])


# Chains ---------------------------------------------------------------------------------------------------------------


def test_two_inertias_of_each_side_are_a_chain_of_four():
    case = aircraft(TRAIN)
    rotor = rotor_inertia(case)
    model = turning(case.linearize(100.0, **RIGID))
    expected = chain([rotor, ENGINE, ENGINE, rotor], [MAST, INTERCONNECT, MAST])
    np.testing.assert_allclose(frequencies(model), expected[1:], rtol=1e-10)
    np.testing.assert_allclose(
        expected[2], np.sqrt(MAST * (1 / rotor + 1 / ENGINE))
    )  # symmetric: two inertias
    names = dict(zip(model.modes().name.values, model.modes().frequency.values, strict=True))
    assert names["symmetric mast twist"] == pytest.approx(expected[2])
    assert names["antisymmetric rotor speed"] == pytest.approx(expected[1])
    assert names["symmetric rotor speed"] == 0


def test_an_engine_that_is_out_leaves_a_chain_of_four_other_inertias():
    case, gearbox = aircraft(TRAIN), 3.0
    side = Side(case.rotor, case.operation, None, replace(TRAIN, engine_inertia=gearbox))
    model = turning(replace(case, left=side).linearize(100.0, **RIGID))
    rotor = rotor_inertia(case)
    assert model.halves_couple
    expected = chain([rotor, ENGINE, gearbox, rotor], [MAST, INTERCONNECT, MAST])
    np.testing.assert_allclose(frequencies(model), expected[1:], rtol=1e-10)


def test_rigid_masts_leave_two_inertias_and_a_shaft():
    case = aircraft(RIGID_MAST)
    side = rotor_inertia(case) + ENGINE
    model = turning(case.linearize(100.0, **RIGID))
    np.testing.assert_allclose(frequencies(model), chain([side, side], [INTERCONNECT])[1:], rtol=1e-10)


def test_shafts_to_a_constant_speed_and_dampers_stand_at_the_gearbox():
    case = aircraft(replace(TRAIN, shaft_stiffness=SHAFT, engine_damping=70.0, drive_damping=11.0))
    rotor = rotor_inertia(case)
    model = turning(case.linearize(100.0, **RIGID))
    found = decomposition(model).values
    for interconnect in (0.0, 2 * INTERCONNECT):
        mass, damping = np.diag([rotor, ENGINE]), np.diag([11.0, 70.0])
        stiffness = np.array([[MAST, -MAST], [-MAST, MAST + SHAFT + interconnect]])
        system = np.block(
            [
                [np.zeros((2, 2)), np.eye(2)],
                [-np.linalg.inv(mass) @ stiffness, -np.linalg.inv(mass) @ damping],
            ]
        )
        expected = np.linalg.eigvals(system)
        assert np.abs(found[:, None] - expected).min(axis=0) == pytest.approx(0, abs=1e-8)


def test_one_rotor_has_a_mast_too():
    base = pp.load_case("xv15-uncoupled")
    case = replace(base, rotor=replace(base.rotor, precone=0.0))
    train = replace(TRAIN, interconnect_stiffness=0.0)
    model = case.linearize(100.0, drive_train=train, **RIGID)
    assert model.dofs[-1] == "mast twist"
    found = frequencies(turning(model))
    np.testing.assert_allclose(found, [np.sqrt(MAST * (1 / rotor_inertia(case) + 1 / ENGINE))], rtol=1e-10)
    # Hub and engine turn together about the shaft: the inertia of the engine is felt there as well.
    without = case.linearize(100.0, drive_train=replace(train, mast_stiffness=None), **RIGID)
    np.testing.assert_allclose(model.M[:-1, :-1], without.M, rtol=1e-12)


# Limits ---------------------------------------------------------------------------------------------------------------


def assert_same_roots(one, other, tolerance):
    assert one.shape == other.shape
    apart = np.abs(one[:, None] - other).min(axis=1)
    assert (apart < tolerance * np.maximum(1, np.abs(one))).all()


def test_without_interconnect_both_halves_turn_alike():
    case = aircraft(replace(TRAIN, interconnect_stiffness=0.0, shaft_stiffness=SHAFT))
    model = turning(case.linearize(100.0))
    one, other = model.blocks
    for matrix in (model.M, model.C, model.K):
        np.testing.assert_array_equal(matrix[np.ix_(one, one)], matrix[np.ix_(other, other)])


def test_a_very_stiff_interconnect_locks_the_antisymmetric_speed():
    case = aircraft(pp.DriveTrain(interconnect_stiffness=1e13))
    constant = replace(case, drive_train=None)
    model, locked = case.linearize(100.0), constant.linearize(100.0, rotor_speed="constant")
    found, expected = (
        decomposition(one.submodel(tuple(name for name in one.dofs if name.startswith("anti")))).values
        for one in (model, locked)
    )
    found = found[np.abs(found) < 1e4]  # without the pair of the stiff shaft
    assert_same_roots(np.sort_complex(found), np.sort_complex(expected), 1e-6)
    free, own = (
        decomposition(one.submodel(tuple(name for name in one.dofs if name.startswith("sym")))).values
        for one in (model, constant.linearize(100.0))
    )
    np.testing.assert_array_equal(free, own)  # symmetric motion does not strain the shaft


def test_a_very_stiff_mast_is_a_rigid_one():
    stiff = aircraft(replace(TRAIN, mast_stiffness=1e12)).linearize(100.0)
    found, expected = eigenvalues(stiff), eigenvalues(aircraft(RIGID_MAST).linearize(100.0))
    assert_same_roots(np.sort_complex(found[np.abs(found) < 1e4]), np.sort_complex(expected), 1e-6)


# Points with and without shafts ---------------------------------------------------------------------------------------


def test_a_batch_with_shafts_at_some_points_has_the_roots_of_its_points():
    """None of both azimuths held, the antisymmetric one alone, and both."""
    shaft, between = np.array([0.0, 0.0, SHAFT]), np.array([0.0, INTERCONNECT, 0.0])
    batch = aircraft(replace(TRAIN, shaft_stiffness=shaft, interconnect_stiffness=between)).linearize(100.0)
    every, alone = decomposition(batch), eigenvalues(batch)
    lacks = np.isnan(every.values).sum(axis=1)
    assert lacks.tolist() == [2, 1, 0]
    for place in range(3):
        one = aircraft(
            replace(TRAIN, shaft_stiffness=shaft[place], interconnect_stiffness=between[place])
        ).linearize(100.0)
        for found in (every.values[place], alone[place]):
            assert_same_roots(eigenvalues(one), found[np.isfinite(found)], 1e-9)
        here, modes = one.modes(), batch.modes().isel(airspeed=place)
        count = here.sizes["mode"]
        assert modes.name.values[:count].tolist() == here.name.values.tolist()
        assert (modes.missing.item() == "") == (place == 2)
        np.testing.assert_allclose(modes.participation[:count], here.participation, atol=1e-9)
    assert np.isfinite(every.right).all()


def test_the_state_space_of_a_mixed_batch_has_the_states_of_its_points():
    train = replace(TRAIN, shaft_stiffness=np.array([0.0, SHAFT]))
    both = aircraft(train).linearize(100.0).to_state_space()
    one = aircraft(replace(TRAIN, shaft_stiffness=np.array([0.0]))).linearize(100.0).to_state_space()
    state = both.states.index("symmetric azimuth")
    assert "symmetric azimuth" not in one.states and "antisymmetric azimuth" in one.states
    assert np.isnan(both.A[0, state]).all() and np.isfinite(both.A[1]).all()
    np.testing.assert_allclose(np.delete(np.delete(both.A[0], state, 0), state, 1), one.A[0], rtol=1e-12)


def test_a_study_over_the_interconnect_has_room_for_every_root():
    case = pp.load_case("xv15-aircraft", {"drive_train.interconnect_stiffness": "1e4 N*m/rad"})
    inputs = {"drive_train.interconnect_stiffness": [0.0, 1e4]}
    found = pp.study(case, inputs, [100.0, 110.0], quantities=("modes", "eigenvalue"))
    assert np.isnan(found.eigenvalue.values).sum(axis=-1).tolist() == [[1, 1], [0, 0]]
    assert (found.missing.values[0] != "").all() and (found.missing.values[1] == "").all()


def test_a_study_of_one_half_has_the_roots_of_this_half():
    """The interconnect holds the azimuth of the antisymmetric half alone."""
    train = {"drive_train.interconnect_stiffness": "1e4 N*m/rad"}
    for half in ("symmetric", "antisymmetric"):
        case = pp.load_case("xv15-aircraft", {**train, "support.symmetry": half})
        found = pp.study(
            case, {"drive_train.interconnect_stiffness": [1e4, 2e4]}, [100.0], quantities="eigenvalue"
        )
        assert np.isfinite(found.eigenvalue.values).all() and "missing" not in found
        assert found.sizes["state"] == 2 * 21 - 2 - (half == "symmetric")


def test_a_study_over_the_shaft_of_one_side_has_room_for_every_root():
    settings = {
        "drive_train.interconnect_stiffness": "1e4 N*m/rad",
        "left.drive_train.shaft_stiffness": "1e3 N*m/rad",
    }
    case = pp.load_case("xv15-aircraft", settings)
    found = pp.study(case, {"left.drive_train.shaft_stiffness": [0.0, 1e3]}, [100.0], quantities="eigenvalue")
    assert np.isnan(found.eigenvalue.values).sum(axis=-1).tolist() == [[1], [0]]


# Refusals -------------------------------------------------------------------------------------------------------------


def test_a_mast_needs_an_inertia_at_its_end():
    with pytest.raises(InputError, match=r"^engine_inertia = 0.0: must be above zero with a mast_stiffness"):
        pp.DriveTrain(mast_stiffness=1e5)
    with pytest.raises(InputError, match=r"^mast_stiffness = 0.0: must be above zero"):
        pp.DriveTrain(mast_stiffness=0.0, engine_inertia=1.0)
    for name in ("engine_inertia", "engine_damping", "interconnect_stiffness"):
        with pytest.raises(InputError, match=rf"^{name} = -1.0: must not be negative"):
            pp.DriveTrain(**{name: -1.0})


def test_a_deck_gives_the_whole_drive_train():
    settings = {
        "drive_train.drive_inertia": "20 kg*m**2",
        "drive_train.mast_stiffness": "250 kN*m/rad",
        "drive_train.engine_inertia": "45 kg*m**2",
        "drive_train.engine_damping": "9 N*m*s/rad",
        "drive_train.interconnect_stiffness": "30 kN*m/rad",
    }
    found = pp.load_case("xv15-aircraft", settings)
    assert found.drive_train == replace(TRAIN, engine_damping=9.0)
    out = pp.load_case("xv15-aircraft", settings | {"left.drive_train.engine_inertia": "3 kg*m**2"})
    assert out.left.drive_train == replace(found.drive_train, engine_inertia=3.0)
    assert out.linearize(100.0).halves_couple and not found.linearize(100.0).halves_couple
    with pytest.raises(InputError, match=r"left.drive_train.interconnect_stiffness"):
        pp.load_case("xv15-aircraft", settings | {"left.drive_train.interconnect_stiffness": "3 N*m/rad"})
