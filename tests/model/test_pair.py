"""Two mirrored rotors on an airframe: halves of the motion, against both rotors in coordinates of their own."""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from proprotor.errors import InputError
from proprotor.model.first_order import state_matrix
from proprotor.model.linear_model import INPUTS
from proprotor.model.mount import mount
from proprotor.model.pair import mount_pair
from proprotor.model.rotor_model import rotor_model
from proprotor.model.several_rotors import MountedRotor, mount_rotors
from proprotor.model.side import Side
from proprotor.rotor.motions import HUB
from proprotor.stability.frequency_response import frequency_response
from proprotor.stability.modes import decomposition, eigenvalues
from tests import airframes

SPEEDS = np.array([60.0, 110.0, 150.0])
HALVES = ("symmetric", "antisymmetric")
TRAIN = pp.DriveTrain(drive_inertia=20.0, engine_inertia=40.0, engine_damping=9.0, interconnect_stiffness=4e4)


def other_side(case, **changes):
    """A left side with another precone and control system."""
    rotor = replace(case.rotor, precone=0.02, control_stiffness=0.7 * case.rotor.control_stiffness)
    return Side(**{"rotor": rotor, "operation": case.operation, "drive_train": case.drive_train} | changes)


def in_own_coordinates(case, airspeed):
    """Both rotors in their own coordinates on the whole airframe: everything twice what half of it has."""
    frame = case.support.at(airspeed, case.operation.density)
    names = [name.replace(" ", "_") for name in frame.names]
    doubled = {kind: 2 * getattr(frame, kind) for kind in ("mass", "damping", "stiffness")}
    left = case if case.left is None else case.left
    models = [
        rotor_model(side.rotor, side.operation, airspeed, drive_train=side.drive_train)
        for side in (case, left)
    ]
    rotors = {
        "right": MountedRotor(models[0], frame.hub),
        "left": MountedRotor(models[1], airframes.MIRROR @ frame.left_hub, mirrored=True),
    }
    whole = mount_rotors(rotors, replace(frame, names=tuple(names), **doubled))
    if case.drive_train is not None:
        turns = np.zeros(len(whole.dofs))
        turns[[whole.dofs.index(f"{side} azimuth") for side in rotors]] = 1, -1
        shaft = case.drive_train.interconnect_stiffness * np.outer(turns, turns)
        whole = replace(whole, K=whole.K + shaft)
    return whole


def assert_among(found, whole, tolerance=1e-10):
    """Each root of each point is one of the roots of the whole problem."""
    for own, every in zip(found, whole, strict=True):
        apart = np.abs(own[:, None] - every).min(axis=1)
        assert (apart <= tolerance * np.maximum(np.abs(own), 1)).all()


# The halves -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("train", [None, TRAIN], ids=["no drive train", "interconnected"])
def test_the_halves_have_the_roots_of_both_rotors_in_their_own_coordinates(train):
    case = airframes.aircraft(drive_train=train)
    model = case.linearize(SPEEDS)
    assert not model.halves_couple and [len(own) for own in model.blocks] == [18, 18]
    whole = in_own_coordinates(case, SPEEDS)
    found, expected = decomposition(model).values, np.linalg.eigvals(state_matrix(whole))
    assert_among(found, expected)
    # What the whole problem has besides are the roots at zero of coordinates that are rates in the halves.
    free = 4 + 2 - (train is not None)
    assert found.shape[1] + free == expected.shape[1]
    at_zero = np.sort(np.abs(expected), axis=1)
    assert (at_zero[:, free - 1] < 1e-6).all() and (at_zero[:, free] > 1e-2).all()


def test_the_blocks_between_the_halves_are_zero_and_so_are_vectors():
    model = airframes.aircraft(drive_train=TRAIN).linearize(SPEEDS)
    one, other = model.blocks
    for matrix in (model.M, model.C, model.K):
        assert not matrix[..., one, :][..., other].any() and not matrix[..., other, :][..., one].any()
    assert not model.B[:, one, 6:].any() and not model.B[:, other, :6].any()
    spectrum = decomposition(model)
    every, n = spectrum.all_modes, len(model.dofs)
    held = every.right.shape[-2] - n
    (_, first), (_, last) = spectrum.blocks
    assert (first.start, first.stop, last.stop) == (0, 33, 67)
    for rows, columns in ((one, last), (other, first)):
        rates = [held + place for place in rows]
        assert not every.right[:, rates, columns].any() and not every.left[:, columns, rates].any()
    np.testing.assert_allclose(
        every.left @ every.right, np.broadcast_to(np.eye(held + n), every.left.shape), atol=1e-8
    )


@pytest.mark.parametrize("half", HALVES)
def test_a_half_is_the_problem_of_one_rotor(half):
    frame = airframes.half(half, 3)
    case = airframes.aircraft(frame)
    model = case.linearize(SPEEDS)
    rotor = rotor_model(case.rotor, case.operation, SPEEDS)
    expected = mount(rotor, frame.at(SPEEDS, case.operation.density))
    assert model.dofs[6:] == tuple(f"{half} {name}" for name in expected.dofs[6:])
    for name in "MCKB":
        size = np.abs(getattr(expected, name)).max()
        np.testing.assert_allclose(getattr(model, name), getattr(expected, name), rtol=0, atol=1e-14 * size)
    assert model.inputs == tuple(f"{half} {name}" for name in INPUTS)
    whole = airframes.aircraft(
        airframes.joined(frame, airframes.half(HALVES[half == HALVES[0]], 8))
    ).linearize(SPEEDS)
    np.testing.assert_array_equal(whole.submodel(model.dofs).K, model.K)


@pytest.mark.parametrize("half", HALVES)
def test_a_very_heavy_body_gives_the_rotor_on_its_elastic_coordinates(half):
    frame = airframes.half(half, 3)
    heavy = frame.mass.copy()
    heavy[:3, :3] *= 1e12
    found = eigenvalues(airframes.aircraft(replace(frame, mass=heavy)).linearize(100.0))
    kept = slice(3, 6)
    matrices = {name: getattr(frame, name)[kept, kept] for name in airframes.MATRICES}
    fixed = replace(
        frame,
        **matrices,
        hub=frame.hub[:, kept],
        left_hub=frame.left_hub[:, kept],
        names=frame.names[kept],
        symmetry=frame.symmetry[kept],
        rigid_body=(),
        rates=(),
    )
    expected = eigenvalues(airframes.aircraft(fixed).linearize(100.0))
    assert_among([expected], [found], 1e-6)
    assert np.count_nonzero(np.abs(found) < 1e-3) == len(found) - len(expected) == 4


def test_a_batch_is_its_points():
    case = airframes.aircraft(drive_train=TRAIN)
    case = replace(case, left=other_side(case))
    batch = case.linearize(SPEEDS)
    for place, speed in enumerate(SPEEDS):
        one = case.linearize(speed)
        for name in "MCKB":
            np.testing.assert_allclose(getattr(one, name), getattr(batch, name)[place], rtol=1e-11, atol=1e-9)


# Sides that differ ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"drive_train": replace(TRAIN, engine_inertia=0.0, engine_damping=0.0)},
        {"operation": "stopped"},
    ],
    ids=["another rotor", "an engine out", "another collective"],
)
def test_sides_that_differ_are_one_problem_with_the_roots_of_both_rotors(changes):
    case = airframes.aircraft(drive_train=TRAIN)
    if "operation" in changes:
        changes = {"operation": replace(case.operation, trim={"thrust_coefficient": 0.001})}
    case = replace(case, left=other_side(case, **changes))
    model = case.linearize(SPEEDS)
    assert model.halves_couple and len(model.blocks) == 1
    expected = np.linalg.eigvals(state_matrix(in_own_coordinates(case, SPEEDS)))
    assert_among(eigenvalues(model), expected, 1e-9)
    half = len(model.dofs) // 2
    assert np.abs(model.K[:, :half, half:]).max() > 0


def test_equal_sides_given_twice_are_the_halves():
    case = airframes.aircraft(drive_train=TRAIN)
    twice = replace(case, left=Side(case.rotor, case.operation, None, case.drive_train))
    assert_among(eigenvalues(twice.linearize(SPEEDS)), eigenvalues(case.linearize(SPEEDS)), 1e-9)


def test_a_mirror_image_has_the_same_roots():
    case = airframes.aircraft(drive_train=TRAIN)
    one = replace(case, left=other_side(case))
    mirrored = replace(
        case, rotor=one.left.rotor, left=Side(case.rotor, case.operation, None, case.drive_train)
    )
    assert_among(eigenvalues(one.linearize(SPEEDS)), eigenvalues(mirrored.linearize(SPEEDS)), 1e-9)


def test_an_airframe_that_couples_its_halves_is_one_problem():
    frame = airframes.whole()
    uneven = frame.stiffness.copy()
    uneven[3:6, 9:12] = 3e4 * np.arange(9.0).reshape(3, 3)
    uneven[9:12, 3:6] = uneven[3:6, 9:12].T
    case = airframes.aircraft(replace(frame, stiffness=uneven))
    model = case.linearize(SPEEDS)
    assert model.halves_couple
    expected = np.linalg.eigvals(state_matrix(in_own_coordinates(case, SPEEDS)))
    assert_among(eigenvalues(model), expected)


def test_a_coordinate_of_neither_symmetry_couples_both_halves():
    """The same airframe in coordinates of its right and left side, elastic ones each on one side alone."""
    frame = airframes.whole()
    turn = np.eye(12)
    turn[3:6, 9:12], turn[9:12, 3:6], turn[9:12, 9:12] = np.eye(3), np.eye(3), -np.eye(3)
    matrices = {name: turn.T @ getattr(frame, name) @ turn for name in airframes.MATRICES}
    hubs = {name: getattr(frame, name) @ turn for name in ("hub", "left_hub")}
    symmetry = tuple("" if place % 6 > 2 else own for place, own in enumerate(frame.symmetry))
    sides = replace(frame, **matrices, **hubs, symmetry=symmetry)
    found = eigenvalues(airframes.aircraft(sides).linearize(SPEEDS))
    assert_among(found, eigenvalues(airframes.aircraft(frame).linearize(SPEEDS)), 1e-9)


def test_the_rotors_are_taken_off_an_airframe_that_includes_them():
    """By the share of a rigid rotor, of which each half has one."""
    case = airframes.aircraft()
    frame = case.support
    share = rotor_model(case.rotor, case.operation, 100.0).mass_at_rest[:6, :6]
    halves = [(frame.hub + sign * frame.left_hub) / 2 for sign in (1, -1)]
    heavy = frame.mass + sum(hub.T @ share @ hub for hub in halves)
    other = replace(frame, mass=heavy, includes_rotor="rigid")
    found = airframes.aircraft(other).linearize(100.0)
    np.testing.assert_allclose(found.M, case.linearize(100.0).M, rtol=1e-12, atol=1e-9)
    twice = replace(case, support=other, left=Side(case.rotor, case.operation))
    np.testing.assert_allclose(twice.linearize(100.0).M, found.M, rtol=1e-12, atol=1e-9)


# Trim -----------------------------------------------------------------------------------------------------------------


def test_a_point_fails_where_either_rotor_fails():
    case = airframes.aircraft()
    fast = replace(case.operation, speed_of_sound=230.0)
    model = replace(case, left=other_side(case, operation=fast)).linearize([100.0, 150.0])
    alone = rotor_model(other_side(case).rotor, fast, [100.0, 150.0]).trim
    assert alone.reason[0] == "" and alone.reason[1] != ""
    assert model.trim.reason.tolist() == ["", f"left rotor: {alone.reason[1]}"]
    assert model.trim.converged.tolist() == [True, False]
    assert np.isfinite(model.K[0]).all() and np.isnan(model.K[1]).all()
    np.testing.assert_array_equal(model.trim.collective, case.linearize([100.0, 150.0]).trim.collective)


def test_a_point_is_doubtful_where_either_rotor_is():
    case = airframes.aircraft()
    near = replace(case.operation, speed_of_sound=270.0)
    model = replace(case, left=other_side(case, operation=near)).linearize([60.0, 150.0])
    alone = rotor_model(other_side(case).rotor, near, [60.0, 150.0]).trim.warning
    assert alone[0] == "" and alone[1] != ""
    assert model.trim.warning.tolist() == ["", f"left rotor: {alone[1]}"]
    both = replace(case, operation=near, left=other_side(case, operation=near)).linearize(150.0)
    own, left = str(both.rotor.trim.warning), str(both.left.trim.warning)
    assert str(both.trim.warning) == (own if own == left else f"{own}; left rotor: {left}")


def test_motions_that_make_no_load_at_the_hub_are_there_on_both_sides():
    """Reactionless motions of four blades: the same roots in both halves, each with a name of its own."""
    case = airframes.aircraft()
    four = replace(case, rotor=replace(case.rotor, n_blades=4))
    modes = four.linearize(100.0, reactionless=True).modes()
    names = modes.name.values.tolist()
    assert len(set(names)) == len(names)
    for kind in ("flap", "lag", "pitch"):
        one, other = (names.index(f"{half} differential {kind}") for half in HALVES)
        assert modes.eigenvalue.values[one] == pytest.approx(modes.eigenvalue.values[other], rel=1e-12)


def test_a_shaft_on_one_side_alone_needs_an_interconnect():
    case = airframes.aircraft(drive_train=pp.DriveTrain(shaft_stiffness=1e4))
    stiffness = np.array([0.0, 1e4])
    left = pp.DriveTrain(interconnect_stiffness=stiffness)
    case = replace(case, drive_train=replace(case.drive_train, interconnect_stiffness=stiffness))
    model = replace(case, left=other_side(case, drive_train=left)).linearize(100.0)
    assert "holds the azimuth of one side alone" in model.trim.reason[0] and model.trim.reason[1] == ""
    assert np.isnan(model.K[0]).all() and np.isfinite(model.K[1]).all()


def test_one_rotor_does_not_go_on_both_halves():
    frame = airframes.joined(airframes.half("symmetric", 3), airframes.half("antisymmetric", 8))
    case = airframes.aircraft(frame)
    with pytest.raises(InputError, match="support = an aircraft: has two rotors"):
        mount(rotor_model(case.rotor, case.operation, 90.0), frame)


@pytest.mark.parametrize("name", ["rotor_speed", "density"])
def test_both_sides_turn_at_one_speed_in_one_air(name):
    case = airframes.aircraft()
    operation = replace(case.operation, **{name: 1.01 * getattr(case.operation, name)})
    with pytest.raises(InputError, match=f"left.operation.{name} = .* must be that of the right side"):
        replace(case, left=other_side(case, operation=operation)).linearize(90.0)


# Inputs and outputs ---------------------------------------------------------------------------------------------------


def test_a_half_has_the_state_space_of_one_rotor():
    frame = airframes.half("symmetric", 3)
    case = airframes.aircraft(airframes.joined(frame, airframes.half("antisymmetric", 8)))
    found = frequency_response(case.linearize(90.0), "0.5:5:0.5 Hz")
    rotor = rotor_model(case.rotor, case.operation, 90.0)
    one = mount(rotor, frame.at(90.0, case.operation.density))
    expected = frequency_response(replace(one, rates=frame.rates), "0.5:5:0.5 Hz")
    assert (
        "x" not in expected.output.values and "x rate" in expected.output.values
    )  # heave has no displacement
    for output in expected.output.values:
        for name in INPUTS:
            pair = found.response.sel(output=f"symmetric {output}", input=f"symmetric {name}")
            alone = expected.response.sel(output=output, input=name)
            scale = np.abs(expected.response.sel(input=name)).max().item()
            np.testing.assert_allclose(pair, alone, rtol=1e-9, atol=1e-13 * scale)
            across = found.response.sel(output=f"symmetric {output}", input=f"antisymmetric {name}")
            assert not across.values.any()
    units = dict(zip(found.output.values, found.output_unit.values, strict=True))
    assert units["antisymmetric moment_x"] == "N*m" and units["symmetric x rate"] == "m/s"
    assert units["symmetric flap_1c"] == "rad" and units["antisymmetric azimuth rate"] == "rad/s"


def test_inputs_and_loads_of_sides_that_differ_are_those_of_both_rotors():
    """Hub loads of each rotor from its own equations, in a motion of both rotors in their own coordinates."""
    case = airframes.aircraft(drive_train=TRAIN)
    case = replace(case, left=other_side(case))
    omega, airspeed = 11.0, 100.0
    found = frequency_response(case.linearize(airspeed), [omega])
    whole, frame = in_own_coordinates(case, airspeed), case.support.at(airspeed, case.operation.density)
    sides = [
        (rotor_model(side.rotor, side.operation, airspeed, drive_train=side.drive_train), hub)
        for side, hub in ((case, frame.hub), (case.left, frame.left_hub))
    ]
    n, own = len(whole.dofs), len(sides[0][0].dofs) - 6
    dynamic = whole.K + 1j * omega * whole.C - omega**2 * whole.M
    for sign, half in ((1, "symmetric"), (-1, "antisymmetric")):
        for column, name in enumerate(INPUTS):
            load = np.zeros(n)
            to_rotor = []
            for place, (rotor, hub) in enumerate(sides):
                rows = np.zeros((6 + own, n))
                rows[:6, :12] = hub
                rows[6:, 12 + place * own : 12 + (place + 1) * own] = np.eye(own)
                to_rotor.append(rows)
                load += rows.T @ rotor.B[:, column] * (sign if place else 1)
            motion = np.linalg.solve(dynamic, load)
            loads, hubs = [], []
            for place, (rotor, _) in enumerate(sides):
                alone = to_rotor[place] @ motion
                inner = rotor.K + 1j * omega * rotor.C - omega**2 * rotor.M
                given = rotor.B[:6, column] * (sign if place else 1)
                loads.append(given - (inner @ alone)[:6])
                hubs.append(alone[:6])
            for which, way in ((HALVES[0], 1), (HALVES[1], -1)):
                rates = [1j * omega * hub for hub in hubs]
                for values, names in ((loads, LOADS), (rates, [f"{axis} rate" for axis in HUB])):
                    expected = (values[0] + way * values[1]) / 2
                    here = found.response.sel(input=f"{half} {name}").isel(frequency=0)
                    got = [here.sel(output=f"{which} {axis}").item() for axis in names]
                    np.testing.assert_allclose(got, expected, rtol=0, atol=1e-9 * np.abs(expected).max())


LOADS = ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z")


# Refusals -------------------------------------------------------------------------------------------------------------


def test_what_does_not_go_with_two_rotors_is_refused():
    case = airframes.aircraft()
    side = other_side(case)
    alone = replace(airframes.aircraft(airframes.half("symmetric", 3)), left=side)
    with pytest.raises(
        InputError, match=r"^support.symmetry = symmetric: must hold symmetric and antisymmetric"
    ):
        alone.linearize(100.0)
    with pytest.raises(
        InputError, match=r"^left.drive_train.interconnect_stiffness = 0.0: must be that of the right"
    ):
        replace(
            airframes.aircraft(drive_train=TRAIN), left=replace(side, drive_train=pp.DriveTrain())
        ).linearize(100.0)
    wrong = replace(case.support, rates=("symmetric heave", "symmetric beam"))
    with pytest.raises(
        InputError, match=r"^support.rates = symmetric beam: must be coordinates along which nothing"
    ):
        replace(case, support=wrong).linearize(100.0)
    rotors = [rotor_model(case.rotor, case.operation, 100.0, locked=locked) for locked in ((), "lag")]
    with pytest.raises(
        InputError,
        match=r"^left: must have the coordinates of the right rotor in the same order; the (left|right) one alone has",
    ):
        mount_pair(rotors[0], case.support, rotors[1])
    with pytest.raises(InputError, match=r"^left.pitch_inertia = 0.0: must be above zero"):
        replace(case, left=other_side(case, rotor=replace(case.rotor, pitch_inertia=0.0))).linearize(100.0)


def test_one_rotor_has_no_left_side_and_no_interconnect():
    case = pp.load_case("xv15-uncoupled")
    with pytest.raises(InputError, match=r"^left: goes with an aircraft that has two rotors"):
        replace(case, left=Side(case.rotor, case.operation)).linearize(100.0)
    with pytest.raises(
        InputError, match=r"^drive_train.interconnect_stiffness = 40000.0: must be zero without"
    ):
        replace(case, drive_train=TRAIN).linearize(100.0)
