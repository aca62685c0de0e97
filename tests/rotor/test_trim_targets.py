"""Trim to a thrust or power coefficient: reached, defined as stated, and doubtful or failed points said to be so.

C_T = T/(ρπR²(ΩR)²) and C_P = QΩ/(ρπR²(ΩR)³), power put into the rotor positive; T and Q from the nonlinear airloads.
"""

import numpy as np
import pytest

import proprotor as pp
from tests.derive.test_airloads_virtual_work import Case
from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import AZIMUTH, HUB_MOMENT, UNIT, blades, clock, linearised
from tests.oracles.random_rotors import DENSITY, SPEED_OF_SOUND, random_rotor
from tests.oracles.virtual_work import (
    airload_rows,
    nose_up_rotation,
    quadrature,
    section_flow,
    section_loads,
)

TARGETS = {
    "climb": {"thrust_coefficient": 0.008},
    "brake": {"thrust_coefficient": -0.004},
    "no thrust": {"thrust_coefficient": 0.0},
    "power": {"power_coefficient": 0.01},
    "windmill brake": {"power_coefficient": -0.003},
    "no power": {"power_coefficient": 0.0},
}


def coefficients(case, model):
    """C_T and C_P of the nonlinear rotor at the trim of the model."""
    rotor, trim = case.oracle(model)
    steady = -airload_rows(case.air, rotor, Motion(trim), 0.0).real
    tip_speed = rotor.rotor_speed * case.air.radius
    force = DENSITY * np.pi * case.air.radius**2 * tip_speed**2
    thrust, torque = steady[2], steady[AZIMUTH]
    return {
        "thrust_coefficient": thrust / force,
        "power_coefficient": -torque * rotor.rotor_speed / (force * tip_speed),
    }


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("options", [{}, {"compressibility": False}, {"locked": ("flap", "pitch")}])
@pytest.mark.parametrize("name", TARGETS)
def test_targets_are_reached(name, options, seed):
    ((coefficient, value),) = TARGETS[name].items()
    case = Case(seed, 100.0, TARGETS[name], options.get("compressibility", True), tables=seed == 2)
    model = case.model(**{key: choice for key, choice in options.items() if key == "locked"})
    assert abs(coefficients(case, model)[coefficient] - value) < 1e-10 * 0.01


@pytest.mark.parametrize("coefficient", ["thrust_coefficient", "power_coefficient"])
def test_a_target_is_met_by_the_collective_that_gives_it(coefficient):
    given = Case(3, 110.0, {"collective": 0.85})
    reached = coefficients(given, given.model())[coefficient]
    found = Case(3, 110.0, {coefficient: reached}).model()
    assert abs(found.trim.collective - 0.85) < 1e-10
    for name in ("coning", "lag", "elastic_pitch", "thrust", "torque"):
        assert np.isclose(getattr(found.trim, name), getattr(given.model().trim, name), rtol=1e-9)


def test_windmilling_is_no_power():
    windmill, target = (Case(4, 90.0, trim).model() for trim in ("windmill", {"power_coefficient": 0.0}))
    for name in ("collective", "coning", "lag", "elastic_pitch", "thrust"):
        assert np.isclose(getattr(windmill.trim, name), getattr(target.trim, name), rtol=1e-12)
    for name in "MCK":
        expected = getattr(windmill, name)
        assert np.abs(getattr(target, name) - expected).max() <= 1e-12 * np.abs(expected).max()


def test_targets_may_change_along_a_sweep():
    pair = random_rotor(5)
    speeds, wanted = np.array([60.0, 90.0, 130.0]), np.array([0.008, 0.002, -0.003])

    def thrust(speeds, target):
        operation = operated(pair, {"thrust_coefficient": target})
        return pp.rotor_model(pair.package, operation, speeds).trim.thrust

    together = thrust(speeds, wanted)
    single = [thrust(*point) for point in zip(speeds, wanted, strict=True)]
    assert np.allclose(together, single, rtol=1e-12)
    assert np.allclose(together / together[0], wanted / wanted[0], rtol=1e-10)


def operated(pair, trim, density=DENSITY):
    return pp.Operation(
        rotor_speed=pair.rotor_speed, density=density, speed_of_sound=SPEED_OF_SOUND, trim=trim
    )


# What a steady torque does


def hub_rotation_rows(air, rotor, q, time):
    """Virtual work of the airloads by the rotation vector of the hub, as a generalised force on the left-hand side."""
    station, weight = quadrature(air, rotor)
    force, moment = section_loads(air, station, blades(rotor, station, q, clock(rotor, time)))
    virtual = blades(
        rotor, station, Motion(q.value[..., None, :], UNIT[HUB_MOMENT]), clock(rotor, time, running=False)
    )
    work = (force * weight[:, None])[..., None, :, :, :] * virtual.position.rate
    pitching_work = (moment * weight)[..., None, :, :] * nose_up_rotation(virtual)
    return -(work.sum((-3, -2, -1)) + pitching_work.sum((-2, -1)))


POWERED = {"seed": 6, "airspeed": 110.0, "trim": {"thrust_coefficient": 0.01}}


def test_airload_matrices_at_a_thrust_coefficient():
    case = Case(**POWERED)
    model, airloads = case.airloads()
    rotor, trim = case.oracle(model)
    expected = linearised(lambda q, time: airload_rows(case.air, rotor, q, time), trim, 0.017)
    case.assert_match(airloads, expected, model)


def test_a_steady_torque_tilts_with_the_hub():
    """Hub rows are resultants; the work done by a rotation vector has half of the torque that tilts."""
    case = Case(**POWERED)
    model, (_, _, K) = case.airloads()
    rotor, trim = case.oracle(model)
    _, _, work = linearised(lambda q, time: hub_rotation_rows(case.air, rotor, q, time), trim, 0.0)
    half = np.zeros((3, 3))
    half[0, 1], half[1, 0] = -model.trim.torque / 2, model.trim.torque / 2
    apart = K[HUB_MOMENT, HUB_MOMENT] - work[:, HUB_MOMENT]
    assert abs(model.trim.torque) > 1e3
    assert np.abs(apart - half).max() < 1e-10 * np.abs(K[HUB_MOMENT, HUB_MOMENT]).max()


# Points that fail


FAILING = {
    "too much thrust": ({"thrust_coefficient": 0.4}, 100.0, "no trim with this thrust coefficient found"),
    "too much power": ({"power_coefficient": 2.0}, 100.0, "no trim with this power coefficient found"),
    "no power from still air": (
        {"power_coefficient": -0.01},
        0.0,
        "no trim with this power coefficient found",
    ),
    "still air": ("windmill", 0.0, "no windmilling trim found"),
    "supersonic tip": ({"thrust_coefficient": 0.0}, 320.0, "tip Mach number 1."),
    "backwards": ({"power_coefficient": 0.0}, -1.0, "airspeed is negative"),
    "no airspeed": ({"thrust_coefficient": 0.0}, np.nan, "airspeed is not a finite number"),
}


@pytest.mark.parametrize("name", FAILING)
def test_points_without_trim_say_why(name):
    """The next point is none the worse for it."""
    trim, airspeed, reason = FAILING[name]
    pair = random_rotor(7)
    model = pp.rotor_model(pair.package, operated(pair, trim), [airspeed])
    assert not model.trim.converged[0]
    assert model.trim.reason[0].startswith(reason)
    for value in (model.trim.collective, model.trim.thrust, model.M, model.C, model.K, model.B):
        assert np.isnan(value[0]).all()


@pytest.mark.parametrize("trim", ["windmill", {"thrust_coefficient": 0.0}, {"power_coefficient": 0.0}])
def test_nothing_finds_its_collective_in_a_vacuum(trim):
    pair = random_rotor(7)
    model = pp.rotor_model(pair.package, operated(pair, trim, density=0.0), 100.0)
    assert model.trim.reason == "no trim by airloads in a vacuum: give a collective"


def test_a_failed_point_leaves_the_others_alone():
    pair = random_rotor(8)
    operation = operated(pair, {"thrust_coefficient": 0.005})
    speeds = np.array([80.0, 330.0, 120.0])
    model = pp.rotor_model(pair.package, operation, speeds)
    assert model.trim.converged.tolist() == [True, False, True]
    for place in (0, 2):
        single = pp.rotor_model(pair.package, operation, speeds[place])
        assert np.allclose(model.K[place], single.K, rtol=1e-12, atol=1e-12 * np.abs(single.K).max())


@pytest.mark.parametrize(
    ("trim", "message"),
    [
        ({"thrust_coeff": 0.01}, "unknown trim 'thrust_coeff'; did you mean thrust_coefficient"),
        ({"thrust_coefficient": np.nan}, "trim.thrust_coefficient = nan: must be finite"),
        ({"thrust_coefficient": 0.1, "collective": 0.2}, "one target"),
        ({}, "one target"),
        ("hover", "unknown trim 'hover'"),
    ],
)
def test_trims_that_make_no_sense_are_refused(trim, message):
    with pytest.raises(pp.InputError, match=message):
        operated(random_rotor(7), trim)


# Points that are doubtful


INDUCED, STALL, MACH = "induced velocity", "angle of attack beyond 12 deg", "Mach number beyond 0.85"


def doubts(case, model):
    """What makes a point doubtful, each as a multiple of what would be just acceptable."""
    rotor, trim = case.oracle(model)
    station = np.linspace(0.5, 1.0, 200) * case.air.radius
    flow = section_flow(case.air, station, blades(rotor, station, Motion(trim), clock(rotor, 0.0)))
    mach = np.abs(flow.speed).max() / case.air.speed_of_sound
    disk = np.pi * case.air.radius**2
    induced = abs(model.trim.thrust) / (2 * DENSITY * disk * case.airspeed**2)
    angle = np.degrees(np.abs(flow.angle_of_attack).max())
    return {INDUCED: induced / 0.05, STALL: angle / 12.0, MACH: mach / 0.85}


CONDITIONS = [
    *((airspeed, "windmill") for airspeed in (15.0, 40.0, 90.0, 150.0, 190.0, 240.0)),
    *(
        (airspeed, {"thrust_coefficient": c})
        for airspeed in (30.0, 70.0, 140.0)
        for c in (-0.01, 0.0, 0.01, 0.04)
    ),
    *((airspeed, {"collective": 0.6}) for airspeed in (20.0, 60.0, 100.0, 235.0)),
    (70.0, {"thrust_coefficient": 0.0125}),  # a little more induced velocity than is acceptable
    (180.0, {"collective": 0.69}),  # stalled at half the radius, not at the tip
    (220.0, {"collective": 0.76}),  # stalled further in only
]


@pytest.mark.parametrize(("airspeed", "trim"), CONDITIONS)
def test_doubtful_points_are_warned_of_and_no_others(airspeed, trim):
    case = Case(9, airspeed, trim, n_blades=3)
    model = case.model()
    found = doubts(case, model)
    assert all(abs(excess - 1) > 0.01 for excess in found.values()), "a point on the edge tests nothing"
    expected = [doubt for doubt, excess in found.items() if excess > 1]
    told = [part for part in str(model.trim.warning).split("; ") if part]
    assert len(told) == len(expected)
    assert all(part.startswith(doubt) for part, doubt in zip(told, expected, strict=True))


def test_the_induced_velocity_is_told_as_a_share_of_the_airspeed():
    case = Case(9, 40.0, {"thrust_coefficient": 0.01}, n_blades=3)
    model = case.model()
    share = 0.05 * doubts(case, model)[INDUCED]
    assert f"induced velocity, neglected, would be {share:.0%} of the airspeed" in str(model.trim.warning)


def test_warnings_are_told_with_the_modes():
    pair, case = random_rotor(9, n_blades=3), pp.load_case("xv15-uncoupled")
    flown = pp.Case("doubtful", pair.package, operated(pair, {"collective": 0.6}), case.support)
    speeds = np.array([20.0, 100.0])
    model = flown.linearize(speeds)
    assert (flown.sweep(speeds).warning.values == model.trim.warning).all()
    assert (model.trim.warning != "").tolist() == [True, False]
