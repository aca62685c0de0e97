"""Trim, batches of points and designs, points that fail, and inputs that cannot be used."""

from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import Phase, assume, given, settings

import proprotor as pp
from tests.rotors import SPEED_OF_SOUND, between, flights

some_rotors = settings(max_examples=50, derandomize=True, deadline=None, phases=[Phase.generate])

ROTOR = {
    "n_blades": 3,
    "radius": 4.0,
    "root_cutout": 0.4,
    "flap_hinge_offset": 0.2,
    "lag_hinge_offset": 0.5,
    "precone": 0.03,
    "flap_stiffness": 3e5,
    "lag_stiffness": 1e6,
    "flap_outboard_fraction": 0.3,
    "lag_outboard_fraction": 0.8,
    "gimbal_stiffness": 2e4,
    "pitch_gimbal_coupling": -0.3,
    "pitch_inertia": 1.5,
    "control_stiffness": 4e4,
    "flap_damping": 300.0,
    "lag_damping": 200.0,
    "pitch_damping": 5.0,
    "gimbal_damping": 80.0,
    "structural_pitch_offset": 0.1,
    "chord": 0.35,
    "twist": -0.6,
    "airfoil": pp.Airfoil(lift_slope=5.7, zero_lift_angle=-0.02, drag=0.01, moment=-0.01),
}
STATION, MASS = np.array([0.0, 2.0, 4.0]), np.array([8.0, 7.0, 5.0])
OPERATION = pp.Operation(rotor_speed=45.0, density=1.1, speed_of_sound=SPEED_OF_SOUND)
POWERED = replace(OPERATION, trim={"collective": 0.75})
STATE = ("collective", "coning", "lag", "elastic_pitch", "thrust", "torque")


def rotor(**changes):
    return pp.Rotor.from_mass_distribution(STATION, MASS, **(ROTOR | changes))


def numbers(model):
    """All a model says of its points, by name."""
    return {name: getattr(model.trim, name) for name in STATE} | {
        name: getattr(model, name) for name in "MCK"
    }


def alone(rotor, operation, airspeed, **options):
    """One point as a batch of one: a design has the same bits in every batch."""
    return pp.rotor_model(rotor, operation, np.reshape(airspeed, 1), **options)


def assert_same_point(model, place, single):
    """Bit for bit."""
    for name, value in numbers(model).items():
        assert np.array_equal(value[place], np.reshape(numbers(single)[name], np.shape(value[place]))), name


def assert_rounding_of(model, single):
    """The numbers of one point by plain numbers are those of a batch of one to rounding."""
    one = single.trim
    for name in ("converged", "reason", "warning", "iterations"):
        assert getattr(one, name) == getattr(model.trim, name)[0], name
    for name in ("collective", "coning", "lag", "elastic_pitch"):
        assert abs(getattr(one, name) - getattr(model.trim, name)[0]) < 1e-13, name
    for name in "MCK":
        row = np.abs(getattr(model, name)[0]).max(axis=-1, keepdims=True)
        assert (np.abs(getattr(single, name) - getattr(model, name)[0]) <= 1e-12 * row).all(), name


# The state ----------------------------------------------------------------------------------------


@some_rotors
@given(flights())
def test_a_windmilling_rotor_has_no_torque(flight):
    """To rounding of the torque that a radian of pitch makes."""
    model = replace(flight, operation=replace(flight.operation, trim="windmill")).model()
    assume(model.trim.converged)
    per_radian = abs(model.K[model.dofs.index("azimuth"), model.dofs.index("pitch_0")])
    assert abs(model.trim.torque) < 1e-13 * per_radian


@some_rotors
@given(flights(), between(0.3, 0.9))
def test_a_given_collective_is_kept(flight, collective):
    """To the bit, and the elastic pitch comes on top."""
    trim = replace(flight, operation=replace(flight.operation, trim={"collective": collective})).model().trim
    assume(trim.converged)
    assert trim.collective == collective
    assert trim.pitch == collective + trim.elastic_pitch


LOCKS = {
    "flap": ({"locked": ("flap",)}, {"coning"}),
    "lag": ({"locked": "lag"}, {"lag"}),
    "pitch": ({"locked": ["pitch"]}, {"elastic_pitch"}),
    "gimbal": ({"locked": ("gimbal",)}, set()),
    "rigid pitch": ({"pitch": "rigid"}, {"elastic_pitch"}),
    "coupled pitch": ({"pitch": "coupling"}, {"elastic_pitch"}),
    "rigid blades": ({"locked": ("flap", "lag", "pitch")}, {"coning", "lag", "elastic_pitch"}),
}


@pytest.mark.parametrize("name", LOCKS)
@pytest.mark.parametrize("trim", ["windmill", {"collective": 0.7}])
def test_locked_coordinates_stay_at_zero(name, trim):
    options, still = LOCKS[name]
    model = pp.rotor_model(rotor(), replace(OPERATION, trim=trim), np.array([70.0, 100.0]), **options)
    assert model.trim.converged.all()
    for angle in ("coning", "lag", "elastic_pitch"):
        assert np.all(getattr(model.trim, angle) == 0) == (angle in still)


# The linear model is the derivative of the trim: what moves steadily in it is a trim a little furth

BLADE = ("flap_0", "lag_0", "pitch_0")


STEPS, WEIGHTS = np.array([-3, -2, -1, 1, 2, 3]), np.array([-1, 9, -45, 45, -9, 1]) / 60


def slopes(rotor, operation, airspeed, step):
    """Derivatives of trim angles, thrust and torque by central differences of sixth order, all points at once."""
    trim = pp.rotor_model(rotor, operation, np.broadcast_to(airspeed, STEPS.shape)).trim
    assume(trim.converged.all())
    return {name: WEIGHTS @ getattr(trim, name) / step for name in STATE}


def trimmed(rotor, operation, airspeed):
    """The model of a rotor that has a trim: one whose controls are soft enough to diverge has none.

    Beyond 20 deg rigid hinges are no model of a blade, and neighbouring collectives may find other trims.
    """
    model = pp.rotor_model(rotor, operation, airspeed)
    assume(model.trim.converged.all())
    assume(
        max(abs(getattr(model.trim, name)) for name in ("coning", "lag", "elastic_pitch")) < np.radians(20)
    )
    return model


def powered(flight, collective=0.6):
    return replace(flight.operation, trim={"collective": collective})


def expected_slopes(model, column):
    """Angles from the blade's static balance, loads from the rows of z and ψs."""
    blade = [model.dofs.index(name) for name in BLADE]
    angles = -np.linalg.solve(model.K[np.ix_(blade, blade)], column[blade])
    loads = {}
    for name, row in (("thrust", "z"), ("torque", "azimuth")):
        place = model.dofs.index(row)
        loads[name] = -(column[place] + model.K[place, blade] @ angles)
    return dict(zip(("coning", "lag", "elastic_pitch"), angles, strict=True)) | loads


def assert_slopes(found, expected, model, per):
    """To 1e-8 of what a radian of the angles would be, or the spring force of one."""
    rows = {"thrust": "z", "torque": "azimuth"}
    sizes = {name: np.abs(model.K[model.dofs.index(row)]).max() for name, row in rows.items()}
    for name, value in expected.items():
        assert abs(found[name] - value) < 1e-8 * sizes.get(name, 1.0) / per, name


@some_rotors
@given(flights())
def test_trim_changes_with_airspeed_as_the_rotor_answers_axial_motion(flight):
    """ż is a little more airspeed."""
    operation, step = powered(flight), 3e-5 * flight.airspeed
    model = trimmed(flight.rotor, operation, flight.airspeed)
    found = slopes(flight.rotor, operation, flight.airspeed + STEPS * step, step)
    assert_slopes(found, expected_slopes(model, model.C[:, model.dofs.index("z")]), model, flight.airspeed)


@some_rotors
@given(flights())
def test_trim_changes_with_rotor_speed_as_the_rotor_answers_a_turning_shaft(flight):
    """ψ̇s is a little more rotor speed, except for the propeller moment, which has the steady one on purpose."""
    rotor, operation = replace(flight.rotor, propeller_moment=False), powered(flight)
    model, step = trimmed(rotor, operation, flight.airspeed), 3e-5 * flight.rotor_speed
    faster = replace(operation, rotor_speed=flight.rotor_speed + STEPS * step)
    found = slopes(rotor, faster, flight.airspeed, step)
    column = model.C[:, model.dofs.index("azimuth")]
    assert_slopes(found, expected_slopes(model, column), model, flight.rotor_speed)


@some_rotors
@given(flights())
def test_trim_changes_with_collective_as_the_rotor_answers_pitch(flight):
    """Collective is pitch that does not load the control system."""
    model, step = trimmed(flight.rotor, powered(flight), flight.airspeed), 3e-5
    found = slopes(flight.rotor, powered(flight, 0.6 + STEPS * step), flight.airspeed, step)
    pitch = model.dofs.index("pitch_0")
    column = model.K[:, pitch].copy()
    column[pitch] -= flight.rotor.n_blades * flight.rotor.control_stiffness
    assert_slopes(found, expected_slopes(model, column), model, 1.0)


# Batches ------------------------------------------------------------------------------------------

TABLES = {
    "chord": (np.array([0.0, 2.0, 4.0]), np.array([0.4, 0.4, 0.25])),
    "twist": (np.linspace(0.0, 4.0, 9), np.linspace(0.5, -0.2, 9) ** 3),
}


@pytest.mark.parametrize(
    "options", [{}, {"pitch": "coupling"}, {"airloads": "lift-slope", "locked": ("gimbal",)}]
)
@pytest.mark.parametrize("trim", ["windmill", {"collective": 0.7}])
@pytest.mark.parametrize("changes", [{}, TABLES], ids=["numbers", "tables"])
def test_a_batch_of_airspeeds_is_its_points_bit_for_bit(options, trim, changes):
    given, operation = rotor(**changes), replace(OPERATION, trim=trim)
    airspeeds = np.linspace(50.0, 150.0, 12).reshape(3, 4)
    grid = pp.rotor_model(given, operation, airspeeds, **options)
    line = pp.rotor_model(given, operation, airspeeds.ravel(), **options)
    assert grid.M.shape == (3, 4, len(grid.dofs), len(grid.dofs))
    assert grid.trim.converged.shape == (3, 4)
    for place, airspeed in np.ndenumerate(airspeeds):
        single = alone(given, operation, airspeed, **options)
        assert_same_point(grid, place, single)
        assert_same_point(line, np.ravel_multi_index(place, airspeeds.shape), single)
        one = pp.rotor_model(given, operation, airspeed, **options)
        assert one.M.shape == 2 * (len(grid.dofs),)
        assert one.trim.collective.shape == ()
        assert_rounding_of(single, one)


def test_no_airspeed_at_all_is_an_empty_batch():
    model = pp.rotor_model(rotor(), OPERATION, np.array([]))
    assert model.K.shape == (0, 18, 18)
    assert model.trim.converged.shape == (0,)


# Fields of a rotor that can be an array, with three values each that belong to one blade.
DESIGNS = {
    "n_blades": [3, 4, 5],
    "root_cutout": [0.3, 0.5, 0.9],
    "precone": [0.0, 0.02, 0.05],
    "flap_stiffness": [2e5, 3e5, 5e5],
    "lag_stiffness": [8e5, 1e6, 2e6],
    "flap_outboard_fraction": [0.0, 0.5, 1.0],
    "lag_outboard_fraction": [1.0, 0.5, 0.0],
    "gimbal_stiffness": [0.0, 1e4, 3e4],
    "pitch_gimbal_coupling": [-0.4, 0.0, 0.3],
    "pitch_inertia": [1.0, 1.5, 2.0],
    "control_stiffness": [3e4, 4e4, 9e4],
    "flap_damping": [0.0, 10.0, 300.0],
    "lag_damping": [0.0, 10.0, 300.0],
    "pitch_damping": [0.0, 1.0, 30.0],
    "gimbal_damping": [0.0, 10.0, 300.0],
    "structural_pitch_offset": [-0.3, 0.0, 0.2],
    "chord": [0.3, 0.35, 0.4],
    "twist": [-0.7, -0.6, -0.5],
}
MASSES = (
    "blade_mass",
    "blade_first_moment",
    "blade_inertia",
    "flap_first_moment",
    "flap_inertia",
    "lag_first_moment",
    "lag_inertia",
)
SHAPES = {"one airspeed": ((3,), ()), "as many airspeeds": ((3,), (3,)), "a grid": ((3, 1), (4,))}


def scaled_blades(scale):
    """Rotors of another size, hinges and mass along with it."""
    given = rotor()
    changes = {
        name: getattr(given, name) * scale for name in ("radius", "flap_hinge_offset", "lag_hinge_offset")
    }
    for name in MASSES:
        changes[name] = getattr(given, name) * scale ** (1 + ("mass" not in name) + ("inertia" in name))
    return replace(given, **changes)


MOVES_STATIONS = ("root_cutout", "radius, hinges and masses")


def assert_near_point(model, place, single):
    """To rounding of the largest entry; a torque that balances to nothing, of the thrust's moment at the tip."""
    balanced = np.abs(single.trim.thrust) * rotor().radius
    for name, value in numbers(model).items():
        expected = numbers(single)[name]
        scale = max(np.abs(expected).max(), balanced if name == "torque" else 1.0)
        assert np.abs(value[place] - expected).max() <= 1e-12 * scale, name


def comparison(field):
    """How the designs are run, and how they are compared."""
    return (POWERED, assert_near_point) if field in MOVES_STATIONS else (OPERATION, assert_same_point)


@pytest.mark.parametrize("shapes", SHAPES)
@pytest.mark.parametrize("field", [*DESIGNS, MOVES_STATIONS[1]])
def test_an_array_of_designs_is_its_designs(field, shapes):
    """Bit for bit, or to rounding."""
    shape, speeds = SHAPES[shapes]
    airspeeds = np.array([70.0, 90.0, 110.0, 130.0])[: speeds[0] if speeds else 1].reshape(speeds)

    def with_values(values):
        return replace(rotor(), **{field: values}) if field in DESIGNS else scaled_blades(values)

    values = np.array(DESIGNS.get(field, [0.9, 1.0, 1.1])).reshape(shape)
    operation, assert_equal_point = comparison(field)
    batch = pp.rotor_model(with_values(values), operation, airspeeds)
    assert batch.trim.converged.all()
    designs, points = np.broadcast_arrays(values, airspeeds)
    assert batch.M.shape[:-2] == designs.shape
    for place in np.ndindex(designs.shape):
        single = alone(with_values(designs[place].item()), operation, points[place])
        assert_equal_point(batch, place, single)
        one = pp.rotor_model(with_values(designs[place].item()), operation, points[place])
        assert_rounding_of(single, one)


@pytest.mark.parametrize("field", ["rotor_speed", "density", "speed_of_sound", "collective"])
def test_an_array_of_operations_is_its_operations_bit_for_bit(field):
    values = {"rotor_speed": [40.0, 45.0], "density": [0.9, 1.2], "speed_of_sound": [300.0, 340.0]}
    values = np.array(values.get(field, [0.6, 0.7]))
    airspeeds = np.array([60.0, 80.0, 100.0])

    def with_values(value):
        return replace(OPERATION, **({"trim": {field: value}} if field == "collective" else {field: value}))

    batch = pp.rotor_model(rotor(), with_values(values[:, None]), airspeeds)
    for i, j in np.ndindex(2, 3):
        assert_same_point(batch, (i, j), alone(rotor(), with_values(values[i].item()), airspeeds[j]))


# Points that fail ---------------------------------------------------------------------------------

FAILED = {
    "not a number": (np.nan, "airspeed is not a finite number"),
    "infinite": (np.inf, "airspeed is not a finite number"),
    "backwards": (-10.0, "airspeed is negative"),
    "at rest": (0.0, "no windmilling trim"),
    "sonic tip": (290.0, "tip Mach number 1.0"),
}


def assert_failed(model, place, reason):
    assert not model.trim.converged[place]
    assert reason in model.trim.reason[place]
    for name, value in numbers(model).items():
        assert np.isnan(value[place]).all(), name


@pytest.mark.parametrize("case", FAILED)
def test_a_point_without_trim_says_why_and_leaves_the_others_alone(case):
    """Nor does it warn: a warning fails any test."""
    airspeed, reason = FAILED[case]
    model = pp.rotor_model(rotor(), OPERATION, np.array([80.0, airspeed, 100.0, airspeed]))
    for place in (1, 3):
        assert_failed(model, place, reason)
    for place in (0, 2):
        assert model.trim.reason[place] == ""
        assert_same_point(model, place, alone(rotor(), OPERATION, model.airspeed[place]))


@pytest.mark.parametrize("case", FAILED)
def test_a_single_point_without_trim_says_why(case):
    airspeed, reason = FAILED[case]
    assert_failed(pp.rotor_model(rotor(), OPERATION, airspeed), (), reason)


def test_a_fast_tip_is_no_failure_without_compressibility():
    model = pp.rotor_model(rotor(), OPERATION, 290.0, compressibility=False)
    assert model.trim.converged


@pytest.mark.parametrize("density", [0.0, np.array([1.1, 0.0, 1.1])], ids=["everywhere", "at one point"])
def test_nothing_windmills_in_a_vacuum(density):
    airspeeds = np.array([80.0, 90.0, 100.0])
    model = pp.rotor_model(rotor(), replace(OPERATION, density=density), airspeeds)
    assert_failed(model, 1, "vacuum")
    for place in np.flatnonzero(np.broadcast_to(density, 3)):
        assert_same_point(model, place, alone(rotor(), OPERATION, airspeeds[place]))


@pytest.mark.parametrize("airspeed", [0.0, 80.0])
def test_a_rotor_in_vacuum_has_no_airloads(airspeed):
    operation = replace(OPERATION, density=0.0, trim={"collective": 0.4})
    models = [pp.rotor_model(rotor(), operation, airspeed, airloads=kind) for kind in ("full", "none")]
    assert models[0].trim.thrust == models[0].trim.torque == 0
    assert_same_point(models[0], (), models[1])


FAILING_DESIGNS = ("precone", "root_cutout", "structural_pitch_offset", "chord", "twist", "n_blades")


@pytest.mark.parametrize("field", FAILING_DESIGNS)
def test_a_failed_point_leaves_other_designs_alone(field):
    values, airspeeds = np.array(DESIGNS[field]), np.array([80.0, np.nan, 100.0])
    operation, assert_equal_point = comparison(field)
    batch = pp.rotor_model(replace(rotor(), **{field: values}), operation, airspeeds)
    assert batch.trim.converged.tolist() == [True, False, True]
    for place in (0, 2):
        single = replace(rotor(), **{field: values[place].item()})
        assert_equal_point(batch, place, alone(single, operation, airspeeds[place]))


# Inputs that cannot be used -----------------------------------------------------------------------

NAN = float("nan")


def numbers_of_a_rotor():
    return [entry.name for entry in fields(pp.Rotor) if entry.name not in ("airfoil", "propeller_moment")]


RULES = [
    *((name, NAN, "must be finite") for name in numbers_of_a_rotor()),
    *((name, "heavy", "must be a number") for name in ("radius", "precone", "flap_stiffness")),
    *((name, 0.0, "must be above zero") for name in ("radius", "chord", *MASSES[::2])),
    *((name, -1.0, "must be above zero") for name in ("radius", "chord", "blade_mass", "blade_inertia")),
    *((name, -1.0, "must not be negative") for name in ("flap_hinge_offset", "root_cutout")),
    *((name, -1.0, "must not be negative") for name in ("flap_first_moment", "lag_first_moment")),
    *((f"{name}_stiffness", -1.0, "must not be negative") for name in ("flap", "lag", "gimbal", "control")),
    *((f"{name}_damping", -1.0, "must not be negative") for name in ("flap", "lag", "pitch", "gimbal")),
    ("pitch_inertia", -1.0, "must not be negative"),
    *(
        (f"{name}_outboard_fraction", value, "between 0 and 1")
        for name in ("flap", "lag")
        for value in (-0.1, 1.1)
    ),
    *(("n_blades", value, "whole number of at least 3") for value in (2, 0, 3.5)),
    *(("precone", value, "within 90 deg") for value in (np.pi / 2, -2.0)),
    *(("root_cutout", value, "inboard of the tip") for value in (4.0, 5.0)),
    ("lag_hinge_offset", 0.1, "inboard of the flap hinge"),
    ("lag_hinge_offset", 4.0, "inboard of the tip"),
    ("lag_hinge_offset", np.array([0.5, 0.1]), "inboard of the flap hinge"),
    ("root_cutout", np.array([0.5, 4.1]), "inboard of the tip"),
    ("chord", ([0.0, 4.0], [0.3, 0.2, 0.1]), "two lists of equal length"),
    ("chord", ([0.0, 4.0], [0.3, 0.0]), "must be above zero"),
    ("twist", ([0.0, 2.0, 2.0], [0.3, 0.2, 0.1]), "increase from root to tip"),
    ("twist", ([0.0, 4.0], [0.3, NAN]), "must be finite"),
    ("precone", ([0.0, 1.0], [0.03, 0.03]), "must be a number"),
]


@pytest.mark.parametrize(("field", "value", "rule"), RULES, ids=lambda part: str(part)[:24])
def test_a_rotor_that_cannot_be_is_refused(field, value, rule):
    with pytest.raises(pp.InputError, match=rule) as error:
        replace(rotor(), **{field: value})
    assert error.value.field == field


@pytest.mark.parametrize(
    ("field", "changes", "rule"),
    [
        ("lag_hinge_offset", {"flap_hinge_offset": 0.6}, "inboard of the flap hinge"),
        ("root_cutout", {"radius": 0.3}, "inboard of the tip"),
        ("lag_hinge_offset", {"radius": 0.45}, "inboard of the tip"),
        ("flap_inertia", {"flap_inertia": 400.0}, "breaks I_βα² ≤ I_b I_β"),
        ("flap_inertia", {"blade_inertia": 60.0}, "breaks I_βα² ≤ I_b I_β"),
    ],
)
@pytest.mark.parametrize("many", [False, True], ids=["a number", "an array"])
def test_parts_of_a_rotor_must_fit_each_other(field, changes, rule, many):
    """The one at fault is told, whether there is one design or one of several is wrong."""
    if many:
        changes = {name: np.array([getattr(rotor(), name), value]) for name, value in changes.items()}
    with pytest.raises(pp.InputError, match=rule) as error:
        replace(rotor(), **changes)
    assert error.value.field == field


def test_mass_integrals_belong_to_one_blade():
    """Each pair of these may, but not all together."""
    with pytest.raises(pp.InputError, match="Gram matrix"):
        replace(rotor(), blade_mass=0.6 * rotor().blade_mass)


@pytest.mark.parametrize(
    ("station", "mass", "rule"),
    [
        ([0.0, 4.0], [7.0], "two lists of equal length"),
        ([0.0], [7.0], "two lists of equal length"),
        ([0.0, 2.0, 1.0], [7.0, 7.0, 7.0], "increase from root to tip"),
        ([0.0, NAN], [7.0, 7.0], "must be finite"),
        ([0.0, 4.0], [7.0, NAN], "must be finite"),
        ([0.0, 2.0, 4.0], [7.0, -1.0, 7.0], "must not be negative"),
    ],
)
def test_a_mass_distribution_that_cannot_be_is_refused(station, mass, rule):
    with pytest.raises(pp.InputError, match=rule) as error:
        pp.Rotor.from_mass_distribution(station, mass, **ROTOR)
    assert error.value.field == "mass_distribution"


@pytest.mark.parametrize(
    ("field", "value", "rule"),
    [
        *((name, NAN, "must be finite") for name in ("rotor_speed", "density", "speed_of_sound")),
        *(
            (name, value, "must be above zero")
            for name in ("rotor_speed", "speed_of_sound")
            for value in (0.0, -1.0)
        ),
        ("density", -1.0, "must not be negative"),
        ("trim", "hover", "known: windmill"),
        ("trim", {}, 'must be "windmill" or one target'),
        ("trim", {"collective": 0.6, "thrust": 1.0}, 'must be "windmill" or one target'),
        ("trim", 0.6, 'must be "windmill" or one target'),
        ("trim", {"cyclic": 0.6}, "known: collective"),
        ("trim", {"collective": NAN}, "must be finite"),
    ],
)
def test_an_operation_that_cannot_be_is_refused(field, value, rule):
    with pytest.raises(pp.InputError, match=rule) as error:
        replace(OPERATION, **{field: value})
    assert error.value.field.split(".")[0] == field


@pytest.mark.parametrize(
    ("field", "value", "rule"),
    [
        *((name, NAN, "must be finite") for name in ("lift_slope", "zero_lift_angle", "drag", "moment")),
        *((name, -0.1, "must not be negative") for name in ("lift_slope", "drag")),
    ],
)
def test_an_airfoil_that_cannot_be_is_refused(field, value, rule):
    with pytest.raises(pp.InputError, match=rule) as error:
        replace(ROTOR["airfoil"], **{field: value})
    assert error.value.field == field


OPTIONS = ("pitch", "airloads", "compressibility", "rotor_speed", "locked")


def test_an_unknown_option_is_told_the_known_ones():
    with pytest.raises(pp.InputError) as error:
        pp.rotor_model(rotor(), OPERATION, 80.0, wake="free")
    assert error.value.field == "wake"
    assert all(name in str(error.value) for name in OPTIONS)


@pytest.mark.parametrize(
    ("option", "value", "rule"),
    [
        ("pitch", "free", "dynamic, coupling, rigid"),
        ("airloads", "None", "full, lift-slope, none"),
        ("compressibility", "yes", "True, False"),
        ("rotor_speed", "fixed", "windmilling, constant"),
        ("locked", "wing", "flap, lag, pitch, gimbal"),
        ("locked", ("flap", "wing"), "flap, lag, pitch, gimbal"),
    ],
)
def test_an_unknown_choice_is_told_the_known_ones(option, value, rule):
    with pytest.raises(pp.InputError, match=rule) as error:
        pp.rotor_model(rotor(), OPERATION, 80.0, **{option: value})
    assert error.value.field == option


@pytest.mark.parametrize(
    ("field", "pitch"), [("pitch_inertia", "dynamic"), ("control_stiffness", "coupling")]
)
def test_an_option_needs_what_it_divides_by(field, pitch):
    with pytest.raises(pp.InputError, match="must be above zero with pitch") as error:
        pp.rotor_model(rotor(**{field: 0.0}), OPERATION, 80.0, pitch=pitch)
    assert error.value.field == field
