"""Gusts and swashplate against the nonlinear rotor, the state space against the matrices, and the drive train.

Tolerance: 1e-10 of the largest entry of a block, blocks that vanish to 1e-14 of the largest load by the same inputs.
"""

from itertools import pairwise, product

import numpy as np
import pytest

import proprotor as pp
from tests.derive.test_airloads_virtual_work import CASES, Case
from tests.oracles.comparison import GROUPS
from tests.oracles.inputs import (
    control_columns,
    gust_columns,
    lift_slope_gust_columns,
    swashplate_columns,
)
from tests.oracles.nonlinear_rotor import DOFS
from tests.oracles.random_rotors import NO_OFFSETS
from tests.oracles.virtual_work import airload_rows, lift_slope_rows

INPUTS = ("collective", "cyclic_1c", "cyclic_1s", "gust_x", "gust_y", "gust_z")
SWASHPLATE, GUSTS = slice(0, 3), slice(3, 6)
HUB = DOFS[:6]
LOADS = ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z")
FLIGHTS = ("windmilling", "powered, tables", "five blades", "incompressible")


# Loads by inputs against the nonlinear rotor


def assert_loads_match(actual, expected, dofs):
    """Columns (n, 3): each entry to 1e-10 of the largest by the three inputs on its kind of coordinate."""
    rows = [[dofs.index(dof) for dof in group if dof in dofs] for group in GROUPS]
    for places, column in product(filter(None, rows), range(3)):
        error = np.abs(actual[places, column] - expected[places, column]).max()
        block, largest = np.abs(expected[places]).max(), np.abs(expected[:, column]).max()
        assert error <= 1e-10 * block + 1e-14 * largest, f"{dofs[places[0]]} by input {column}: {error:.3g}"


def kept(columns, model):
    return columns[[DOFS.index(name) for name in model.dofs]]


@pytest.mark.parametrize("pitch", ["dynamic", "coupling", "rigid"])
@pytest.mark.parametrize("name", FLIGHTS)
def test_gusts_load_the_sections(name, pitch):
    case = Case(**CASES[name])
    model = case.model(pitch=pitch)
    expected = gust_columns(case.air, *case.oracle(model), time=0.017)
    assert_loads_match(model.B[:, GUSTS], kept(expected, model), model.dofs)


def test_gusts_change_the_incidence_alone_with_lift_slope_airloads():
    case = Case(**CASES["powered, tables"])
    model = case.model(airloads="lift-slope")
    expected = lift_slope_gust_columns(case.air, *case.oracle(model), time=0.017)
    assert_loads_match(model.B[:, GUSTS], kept(expected, model), model.dofs)


@pytest.mark.parametrize("airloads", ["full", "lift-slope"])
@pytest.mark.parametrize("name", FLIGHTS)
def test_a_gust_is_the_hub_moving_the_other_way(name, airloads):
    """Air that moves along with the hub loads nothing, and inertia does not feel a steady velocity."""
    model = Case(**CASES[name]).model(airloads=airloads)
    assert np.abs(model.B[:, GUSTS] - model.C[:, :3]).max() <= 1e-13 * np.abs(model.C[:, :3]).max()


def airload_functions(case, trim):
    return {
        "full": lambda rotor, q, time: airload_rows(case.air, rotor, q, time),
        "lift-slope": lambda rotor, q, time: lift_slope_rows(case.air, rotor, trim, q, time),
        "none": lambda rotor, q, time: 0.0,
    }


@pytest.mark.parametrize("pitch", ["coupling", "rigid"])
@pytest.mark.parametrize("airloads", ["full", "lift-slope", "none"])
@pytest.mark.parametrize("name", ["windmilling", "powered, tables"])
def test_blades_follow_the_swashplate_at_once_without_pitch_equations(name, airloads, pitch):
    """Airloads, springs that turn, propeller moment, and the pitch inertia of cyclic pitch through K_PG."""
    case = Case(**CASES[name])
    model = case.model(pitch=pitch, airloads=airloads)
    rotor, trim = case.oracle(model)
    expected = swashplate_columns(rotor, trim, 0.017, airload_functions(case, trim)[airloads])
    assert_loads_match(model.B[:, SWASHPLATE], kept(expected, model), model.dofs)


@pytest.mark.parametrize("airloads", ["full", "none"])
@pytest.mark.parametrize("name", ["windmilling", "powered, tables"])
def test_the_swashplate_pulls_at_the_pitch_through_the_control_system(name, airloads):
    case = Case(**CASES[name])
    model = case.model(airloads=airloads)
    expected = control_columns(*case.oracle(model), time=0.017)
    assert_loads_match(model.B[:, SWASHPLATE], kept(expected, model), model.dofs)
    stiffness, blades = case.pair.fields["control_stiffness"], case.pair.fields["n_blades"]
    pulled = [model.B[model.dofs.index(f"pitch_{n}"), place] for place, n in enumerate(("0", "1c", "1s"))]
    assert np.allclose(pulled, stiffness * blades * np.array([1, 0.5, 0.5]), rtol=1e-14)


@pytest.mark.parametrize("locked", [("flap",), ("lag", "gimbal"), ("pitch",)])
def test_inputs_load_what_is_left(locked):
    case = Case(**CASES["powered, tables"])
    model = case.model(locked=locked, rotor_speed="constant")
    assert model.B.shape == (len(model.dofs), len(INPUTS))
    expected = gust_columns(case.air, *case.oracle(model), time=0.017)
    assert_loads_match(model.B[:, GUSTS], kept(expected, model), model.dofs)


# State space


class FourBlades:
    """A rotor of the random ones on a wing; reactionless motions and all."""

    def __init__(self):
        self.case = Case(**CASES["windmilling, tables"])

    def linearize(self, airspeed, **options):
        pair = self.case.pair
        support = pp.load_case("xv15-uncoupled").support
        case = pp.Case("four blades", pair.package, self.case.operation, support)
        return case.linearize(airspeed, **options)


ROTORS = {"xv15-uncoupled": lambda: pp.load_case("xv15-uncoupled"), "four blades": FourBlades}
OPTIONS = {
    "all free": {},
    "constant speed": {"rotor_speed": "constant"},
    "on a shaft": {"drive_train": pp.DriveTrain(drive_inertia=20.0, drive_damping=30.0, shaft_stiffness=4e4)},
    "rigid pitch": {"pitch": "rigid"},
    "pitch by coupling, lag locked": {"pitch": "coupling", "locked": ("lag",)},
    "reactionless": {"reactionless": True},
}


@pytest.fixture(params=OPTIONS)
def options(request):
    return OPTIONS[request.param]


@pytest.fixture(params=ROTORS)
def mounted(request, options):
    return ROTORS[request.param]().linearize(120.0, **options)


def without_hub(**options):
    """The XV-15 rotor alone, free to move as a whole: no massless direction with the gimbal locked."""
    case = pp.load_case("xv15-uncoupled")
    return pp.rotor_model(
        case.rotor, case.operation, 120.0, rotor_speed="constant", locked=("gimbal",), **options
    )


def laplace(model, s):
    """Response (n, inputs) of the coordinates at s."""
    return np.linalg.solve(s**2 * model.M + s * model.C + model.K, model.B)


def rotor_motion(model, motion):
    """Motion of the coordinates of the rotor alone; those held are at zero."""
    if model.rotor is None:
        return motion
    moving = dict(zip(model.dofs, motion, strict=True))
    own = [moving.get(name, np.zeros(len(INPUTS))) for name in model.rotor.dofs[6:]]
    return np.concatenate([model.hub @ motion, own])


def expected_outputs(model, s):
    """Every output by its name, straight from the matrices."""
    motion = laplace(model, s)
    rotor, moved = model.rotor or model, rotor_motion(model, motion)
    loads = rotor.B - (s**2 * rotor.M + s * rotor.C + rotor.K) @ moved
    rows = dict(zip(model.dofs, motion, strict=True)) | dict(zip(HUB, moved, strict=False))
    rows |= {f"{name} rate": s * row for name, row in rows.items()}
    rows |= {f"{name} acceleration": s**2 * rows[name] for name in HUB}
    return rows | dict(zip(LOADS, loads, strict=False))


def load_scales(model, s):
    """What the loads on the hub are made of: they may cancel, as on a hub without mass."""
    rotor, moved = model.rotor or model, rotor_motion(model, laplace(model, s))
    parts = np.abs(s**2 * rotor.M) + np.abs(s * rotor.C) + np.abs(rotor.K)
    return dict(zip(LOADS, parts @ np.abs(moved) + np.abs(rotor.B), strict=False))


def transfer(system, s):
    return system.C @ np.linalg.solve(s * np.eye(len(system.A)) - system.A, system.B + 0j) + system.D


def random_points(seed, rotor_speed=48.0):
    rng = np.random.default_rng(seed)
    return rotor_speed * (rng.uniform(-0.5, 2, 4) + 1j * rng.uniform(-3, 3, 4))


def assert_transfer_is_that_of_the_matrices(model):
    system = model.to_state_space()
    for s in random_points(seed=len(system.states)):
        expected = expected_outputs(model, s)
        scale = expected | load_scales(model, s)
        for name, row in zip(system.outputs, transfer(system, s), strict=True):
            assert np.abs(row - expected[name]).max() <= 1e-10 * np.abs(scale[name]).max(), name


def test_transfer_functions_are_those_of_the_matrices(mounted):
    assert_transfer_is_that_of_the_matrices(mounted)


@pytest.mark.parametrize("pitch", ["dynamic", "rigid"])
def test_transfer_functions_of_a_rotor_alone(pitch):
    assert_transfer_is_that_of_the_matrices(without_hub(pitch=pitch))


def test_eigenvalues_of_the_state_matrix_are_the_modes(mounted):
    """Each of them, at which the matrices of the model have a motion without load."""
    found, modes = np.linalg.eigvals(mounted.to_state_space().A), mounted.modes().eigenvalue.values
    upper = found[found.imag >= 0]
    assert len(upper) == len(modes)
    assert np.abs(upper[:, None] - modes).min(axis=1).max() < 1e-10 * np.abs(modes).max()
    root = np.sqrt(np.diag(mounted.M))
    M, C, K = (getattr(mounted, name) / np.outer(root, root) for name in "MCK")
    for s in upper:
        singular = np.linalg.svd(s**2 * M + s * C + K, compute_uv=False)
        assert singular[-1] < 1e-10 * singular[0]


def test_names_are_those_of_the_physics_and_unique(mounted):
    system = mounted.to_state_space()
    assert system.inputs == INPUTS
    for names, size in (
        (system.states, system.A.shape[-1]),
        (system.inputs, system.B.shape[-1]),
        (system.outputs, system.C.shape[-2]),
    ):
        assert len(names) == len(set(names)) == size
    rates = [name for name in system.states if name.endswith(" rate")]
    assert rates == [f"{name} rate" for name in mounted.dofs]


def test_coordinates_held_at_zero_load_the_hub_with_nothing():
    model = pp.load_case("xv15-uncoupled").linearize(120.0, rotor_speed="constant")
    part = model.submodel(tuple(name for name in model.dofs if not name.startswith("gimbal")))
    assert_transfer_is_that_of_the_matrices(part)


def test_failed_points_are_nan_in_the_state_space():
    system = pp.load_case("xv15-uncoupled").linearize([120.0, -1.0]).to_state_space()
    for matrix in (system.A, system.B, system.C, system.D):
        assert np.isfinite(matrix[0]).all()
    assert np.isnan(system.A[1]).any()


def test_a_batch_is_the_single_points():
    case, speeds = pp.load_case("xv15-uncoupled"), np.array([100.0, 140.0])
    batch = case.linearize(speeds).to_state_space()
    for place, speed in enumerate(speeds):
        single = case.linearize(speed).to_state_space()
        for name in "ABCD":
            together, alone = getattr(batch, name)[place], getattr(single, name)
            assert np.abs(together - alone).max() <= 1e-12 * np.abs(alone).max()


def test_python_control_has_the_same_system(mounted):
    pytest.importorskip("control")
    system = mounted.to_state_space()
    exported = system.to_control()
    for name in "ABCD":
        assert np.array_equal(getattr(exported, name), getattr(system, name))
    assert tuple(exported.state_labels) == system.states
    assert tuple(exported.input_labels) == system.inputs
    assert tuple(exported.output_labels) == system.outputs
    s = random_points(seed=1)[0]
    assert np.allclose(exported(s), transfer(system, s), rtol=1e-8, atol=1e-8)


def test_python_control_takes_one_point():
    pytest.importorskip("control")
    batch = pp.load_case("xv15-uncoupled").linearize([100.0, 120.0]).to_state_space()
    with pytest.raises(pp.InputError, match=r"airspeed = array of shape \(2,\): must be one speed"):
        batch.to_control()


# Drive train


@pytest.mark.parametrize("pitch", ["dynamic", "coupling"])
def test_no_drive_train_is_one_of_nothing(pitch):
    """Bit for bit."""
    case = pp.load_case("xv15-uncoupled")
    without = case.linearize(120.0, pitch=pitch)
    with_nothing = case.linearize(120.0, pitch=pitch, drive_train=pp.DriveTrain())
    for name in ("M", "C", "K", "B"):
        assert np.array_equal(getattr(without, name), getattr(with_nothing, name))
    assert not with_nothing.shaft_holds_azimuth


def test_a_drive_train_adds_to_azimuth_and_hub():
    """What turns with the rotor turns with its hub as well; damper and shaft act between rotor and hub."""
    case = Case(**CASES["windmilling"])
    train = pp.DriveTrain(drive_inertia=31.0, drive_damping=7.0, shaft_stiffness=5e4)
    free, driven = case.model(), case.model(drive_train=train)
    azimuth, turn = free.dofs.index("azimuth"), free.dofs.index("alpha_z")
    added = {name: np.zeros((18, 18)) for name in "MCK"}
    added["M"][np.ix_([azimuth, turn], [azimuth, turn])] = 31.0
    added["C"][azimuth, azimuth], added["K"][azimuth, azimuth] = 7.0, 5e4
    for name in "MCK":
        change = getattr(driven, name) - getattr(free, name)
        assert np.abs(change - added[name]).max() <= 1e-13 * np.abs(getattr(free, name)).max()
        assert np.array_equal(change != 0, added[name] != 0)
    assert np.array_equal(free.B, driven.B)


def test_a_rigid_rotor_on_a_shaft_is_a_torsion_pendulum():
    case = Case(**CASES["powered"], **NO_OFFSETS)
    train = pp.DriveTrain(drive_inertia=40.0, drive_damping=600.0, shaft_stiffness=3e5)
    locked = ("flap", "lag", "pitch", "gimbal")
    model = case.model(airloads="none", locked=locked, drive_train=train).submodel(("azimuth",))
    fields = case.pair.fields
    polar = fields["n_blades"] * fields["blade_inertia"] * np.cos(fields["precone"]) ** 2 + 40.0
    expected = [root for root in np.roots([polar, 600.0, 3e5]) if root.imag > 0]
    assert np.allclose(model.modes().eigenvalue.values, expected, rtol=1e-12)


def test_a_shaft_makes_the_azimuth_a_state():
    case, train = pp.load_case("xv15-uncoupled"), pp.DriveTrain(shaft_stiffness=1e4)
    n = len(case.linearize(120.0).dofs)
    free, held = (case.linearize(120.0, drive_train=t).to_state_space() for t in (None, train))
    assert (len(free.states), len(held.states)) == (2 * n - 1, 2 * n)
    assert "azimuth" not in free.states
    assert "azimuth" in held.states


def roots(model):
    values = model.modes().eigenvalue.values
    return np.concatenate([values, values[values.imag > 0].conj()])


def test_a_stiff_shaft_is_constant_speed():
    """To first order in the shaft's flexibility: ten times the stiffness leaves a tenth of the difference."""
    case = pp.load_case("xv15-uncoupled")
    constant = roots(case.linearize(120.0, rotor_speed="constant"))

    def apart(stiffness):
        found = roots(case.linearize(120.0, drive_train=pp.DriveTrain(shaft_stiffness=stiffness)))
        assert len(found) == len(constant) + 2
        return np.abs(constant[:, None] - found).min(axis=1)

    differences = [apart(stiffness).max() for stiffness in (1e9, 1e10, 1e11)]
    assert differences[0] < 0.1
    for softer, stiffer in pairwise(differences):
        assert 9.5 < softer / stiffer < 10.5


@pytest.mark.parametrize("name", ["drive_inertia", "drive_damping", "shaft_stiffness"])
@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf])
def test_a_drive_train_has_no_negative_parts(name, value):
    with pytest.raises(pp.InputError, match=name):
        pp.DriveTrain(**{name: value})


def test_a_drive_train_needs_a_rotor_that_may_change_its_speed():
    case = pp.load_case("xv15-uncoupled")
    with pytest.raises(pp.InputError, match='goes with rotor_speed="windmilling"'):
        case.linearize(120.0, drive_train=pp.DriveTrain(), rotor_speed="constant")
    with pytest.raises(pp.InputError, match="drive_train = 3: must be a DriveTrain"):
        case.linearize(120.0, drive_train=3)
