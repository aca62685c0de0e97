"""The fused functions beside the readable ones, which are their oracle: random rotors, batches, one point, options.

An entry may differ by 1e-13 of what is added in its row: the two add the same terms in another order. Of the terms
that rotation adds to C and K, many cancel.
"""

import dataclasses
import inspect

import numpy as np
import pytest
from proprotor_equations import flap_lag_springs
from proprotor_equations import rotor as readable
from proprotor_equations.fused import general, offset, plain

import proprotor as pp
from proprotor.rotor import fused
from proprotor.rotor.generated import evaluate, keywords
from proprotor.rotor.section_loads import LOAD_MOMENTS

ROUNDING = 1e-13
MATRICES = "MCKB"
SEGMENTS = {"beyond_flap_hinge": np.array([0.0, 1.0, 1.0]), "beyond_lag_hinge": np.array([0.0, 0.0, 1.0])}


def random_rotors(count, seed=0):
    """Numbers of order one for every quantity, (count,), and for every load of three segments, (count, 3)."""
    rng = np.random.default_rng(seed)
    names = [name for name in keywords(readable.matrices) if name not in (*SEGMENTS, "equations")]
    of_segments = [name for name in names if name in LOAD_MOMENTS]
    blade = {name: rng.uniform(-1.0, 1.0, count) for name in names if name not in of_segments}
    blade |= {name: rng.uniform(0.3, 0.9, count) for name in ("rotor_speed", "n_blades")}
    return blade, SEGMENTS | {name: rng.uniform(-1.0, 1.0, (count, 3)) for name in of_segments}


def on_axis(blade, segments):
    """The same rotors with nothing beside the pitch axis."""
    beside = [name for name in keywords(offset.in_vacuum) if name.startswith("offset_")]
    alone = {name: 0 * load if name.startswith("fd_spin") else load for name, load in segments.items()}
    return {name: value for name, value in blade.items() if name not in beside}, alone


def expected_matrices(blade, segments):
    loads = segments if segments else SEGMENTS | dict.fromkeys(LOAD_MOMENTS, 0.0)
    return evaluate(readable.matrices, loads | blade)._asdict()


def assert_alike(found, expected, rotor_speed):
    """Compare the matrices by their rows; what is added in a row of C is C and Ω M, in a row of K also Ω C."""
    size = dict.fromkeys(MATRICES, 0.0)
    for before, name in zip(("", "M", "C", "K"), MATRICES, strict=True):
        row = np.abs(expected[name]).max(axis=-1, keepdims=True)
        size[name] = row + (np.abs(np.reshape(rotor_speed, (-1, 1, 1))) * size[before] if before else 0.0)
        assert found[name].shape[-2:] == expected[name].shape[-2:]
        assert (np.abs(found[name] - expected[name]) <= ROUNDING * size[name]).all(), name


def at(blade, rows):
    """Quantities of some rotors, (rows,); of a single place as plain numbers."""
    return {
        name: value
        if isinstance(value, float | bool)
        else value[rows]
        if np.ndim(rows)
        else float(value[rows])
        for name, value in blade.items()
    }


def one_of(blade, segments, place):
    """One rotor as plain numbers, its segments as arrays (3,)."""
    numbers = at(blade, place)
    if segments is None:
        return numbers, None
    return numbers, {name: value[place] if value.ndim > 1 else value for name, value in segments.items()}


def without_what_is_rare(blade):
    """The same rotors without linkages and drive train: plain numbers, zero."""
    return blade | dict.fromkeys(plain.ABSENT, 0.0)


@pytest.fixture(params=["in air", "in vacuum"])
def general_rotors(request):
    blade, segments = on_axis(*random_rotors(300))
    return blade, segments if request.param == "in air" else None


@pytest.fixture(params=["offset", "general", "plain"])
def rotors(request, general_rotors):
    blade, segments = general_rotors
    if request.param == "offset":
        blade, beside = random_rotors(300)
        return blade | {"beside_axis": True}, None if segments is None else beside
    return (without_what_is_rare(blade) if request.param == "plain" else blade), segments


def test_fused_is_readable(rotors):
    assert_alike(fused.rotor_matrices(*rotors, 300), expected_matrices(*rotors), rotors[0]["rotor_speed"])


def test_one_point_is_readable(rotors):
    for place in range(20):
        one = one_of(*rotors, place)
        found = fused.rotor_matrices(*one, 1, one=True)
        assert_alike(found, expected_matrices(*one), one[0]["rotor_speed"])
        assert all(matrix.shape[0] == 1 for matrix in found.values())


def test_one_point_has_the_bits_of_a_batch(rotors):
    whole = fused.rotor_matrices(*rotors, 300)
    for place in range(0, 300, 7):
        one = fused.rotor_matrices(*one_of(*rotors, place), 1, one=True)
        for name in MATRICES:
            assert np.array_equal(one[name][0], whole[name][place])


def test_a_rotor_without_linkages_takes_the_plans_without_them(general_rotors):
    """Where all of them are the plain number zero; an array goes with the plans for all rotors, and agrees."""
    blade, segments = general_rotors
    rare = without_what_is_rare(blade)
    assert fused.plans_of(rare) is fused.plans_of({}) is plain
    zeros = rare | dict.fromkeys(plain.ABSENT, np.zeros(300))
    for name in plain.ABSENT:
        for value in (np.zeros(300), np.zeros(()), 0.1, 0j, 1e-30j):
            assert fused.plans_of(rare | {name: value}) is general
    matrices = (fused.rotor_matrices(one, segments, 300) for one in (rare, zeros))
    assert_alike(*matrices, blade["rotor_speed"])


def test_what_is_absent_is_in_no_plan_for_plain_rotors():
    functions = [f for f in vars(plain).values() if inspect.isfunction(f)]
    taken = [
        {name for f in functions for name in keywords(getattr(of, f.__name__))} for of in (plain, general)
    ]
    assert len(functions) > 5 and not taken[0] & {*plain.ABSENT} and taken[1] >= {*plain.ABSENT}


def test_springs_are_readable():
    names = keywords(flap_lag_springs.effective_stiffness)
    rng = np.random.default_rng(1)
    given = {name: rng.uniform(0.3, 0.9, 100) for name in names}
    expected = flap_lag_springs.effective_stiffness(**given)._asdict()
    found = fused.effective_stiffness(given)
    assert found.keys() == expected.keys()
    for name, value in expected.items():
        assert np.abs(found[name] - value).max() <= ROUNDING * np.abs(value).max()
    number = fused.effective_stiffness({name: float(value[3]) for name, value in given.items()})
    for name, value in number.items():
        assert (
            type(value) is float and abs(value - expected[name][3]) <= ROUNDING * np.abs(expected[name]).max()
        )


def test_a_rotor_has_the_same_bits_in_every_batch(rotors, monkeypatch):
    blade, segments = rotors
    whole = fused.rotor_matrices(blade, segments, 300)
    monkeypatch.setattr(fused, "_BLOCK", 7)
    parted = fused.rotor_matrices(blade, segments, 300)
    rows = np.array([5, 211, 17])
    some = fused.rotor_matrices(
        at(blade, rows),
        segments and {k: v[rows] if v.ndim > 1 else v for k, v in segments.items()},
        3,
    )
    alone = fused.rotor_matrices(
        at(blade, np.array([211])),
        segments and {k: v[211:212] if v.ndim > 1 else v for k, v in segments.items()},
        1,
    )
    for name in MATRICES:
        assert np.array_equal(whole[name], parted[name])
        assert np.array_equal(whole[name][rows], some[name])
        assert np.array_equal(whole[name][211], alone[name][0])


def test_numbers_that_all_points_share(rotors):
    """Plain numbers and arrays of one beside arrays of all points are the same as arrays of all points."""
    blade, segments = rotors
    shared = {"precone": 0.3, "blade_mass": np.array([0.7]), "pitch": 0.2}
    spread = {name: np.full(300, np.ravel(value)[0]) for name, value in shared.items()}
    mixed, full = (fused.rotor_matrices(blade | more, segments, 300) for more in (shared, spread))
    for name in MATRICES:
        assert np.array_equal(mixed[name], full[name])


@pytest.mark.parametrize(
    "name",
    ["precone", "lag", "rotor_speed", "pitch_gimbal_coupling", "fn_up_1", "kinematic_pitch_flap_coupling"],
)
def test_a_complex_step_goes_through_both_renderings(rotors, name):
    blade, segments = rotors
    if segments is None and name.startswith("fn"):
        name = "coning"
    step, moved = 1e-30j, [dict(part) if part else None for part in (blade, segments)]
    moved[name in LOAD_MOMENTS][name] = moved[name in LOAD_MOMENTS][name] + step
    # An imaginary part is divided by its step; the real part, added, is the size of what cancels.
    slopes = {k: v.real + v.imag / 1e-30 for k, v in expected_matrices(*moved).items()}
    found = fused.rotor_matrices(*moved, 300)
    speed = blade["rotor_speed"] + 1.0
    assert_alike({k: v.real + v.imag / 1e-30 for k, v in found.items()}, slopes, speed)
    one = {
        k: v if isinstance(v, float) else complex(np.ravel(v)[4 * (np.size(v) > 1)])
        for k, v in moved[0].items()
    }
    along = moved[1] and {k: v[4] if v.ndim > 1 else v for k, v in moved[1].items()}
    found = fused.rotor_matrices(one, along, 1, one=True)
    found = {k: v.real + v.imag / 1e-30 for k, v in found.items()}
    assert_alike(found, {k: v[4] for k, v in slopes.items()}, speed[4])


# In the model

FREQUENCIES = pp.BladeFrequencies(at_rotor_speed=40.0, flap=1.1, lag=1.6, cyclic_flap=1.3)
SERVED = (
    {},
    {"airloads": "none"},
    {"airloads": "lift-slope"},
    {"compressibility": False},
    {"section_damping": True},
    {"pitch": "coupling"},
    {"pitch": "rigid"},
    {"reactionless": True},
    {"structure": "diagonal"},
    {"structure": "tabulated", "frequencies": FREQUENCIES},
    {"rotor_speed": "constant", "locked": ("lag",)},
    {"drive_train": pp.DriveTrain(drive_inertia=20.0, drive_damping=3.0, shaft_stiffness=2e3)},
)


def is_called(monkeypatch):
    """A list that grows with every call of the fused matrices."""
    calls, original = [], fused.rotor_matrices

    def counting(*given, **more):
        calls.append(given)
        return original(*given, **more)

    monkeypatch.setattr(fused, "rotor_matrices", counting)
    return calls


@pytest.mark.parametrize("options", SERVED, ids=str)
@pytest.mark.parametrize("airspeed", [100.0, np.linspace(60.0, 180.0, 4)], ids=["one", "batch"])
def test_every_option_that_is_served(options, airspeed, monkeypatch):
    case, calls = pp.load_case("xv15-uncoupled"), is_called(monkeypatch)
    speed = case.operation.rotor_speed
    model = pp.rotor_model(case.rotor, case.operation, airspeed, **options)
    assert len(calls) == 1
    monkeypatch.setattr(fused, "serves", lambda equations: False)
    expected = pp.rotor_model(case.rotor, case.operation, airspeed, **options)
    assert len(calls) == 1
    assert_alike(*({name: getattr(m, name) for name in MATRICES} for m in (model, expected)), speed)


def test_a_linkage_of_zero_among_others_is_no_linkage_to_rounding():
    """A design has the bits of every batch that varies the linkage, and to rounding those without a linkage."""
    case, speeds = pp.load_case("xv15-uncoupled"), np.linspace(60.0, 180.0, 3)

    def model(linkage):
        rotor = dataclasses.replace(case.rotor, kinematic_pitch_flap_coupling=linkage)
        return pp.rotor_model(rotor, case.operation, speeds)

    among, alone = model(np.array([[0.0], [0.2], [-0.1]])), model(np.array([[0.0]]))
    without = model(0.0)
    for name in MATRICES:
        assert np.array_equal(getattr(among, name)[0], getattr(alone, name)[0])
    found, expected = ({name: getattr(m, name) for name in MATRICES} for m in (alone, without))
    for name in MATRICES:
        size = np.abs(expected[name]).max(axis=(-2, -1), keepdims=True)
        assert (np.abs(found[name][0] - expected[name]) <= 1e-12 * size).all(), name


def test_published_equations_take_the_readable_functions(monkeypatch):
    case, calls = pp.load_case("xv15-uncoupled"), is_called(monkeypatch)
    assert pp.rotor_model(case.rotor, case.operation, 100.0, equations="published").trim.converged
    assert calls == []


def test_equations_of_a_user_take_the_readable_functions():
    own = dataclasses.replace(fused.EQUATION_SETS["consistent"], pitch=object())
    assert not fused.serves(own)
