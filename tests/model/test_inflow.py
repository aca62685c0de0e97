"""Induced velocity against a nonlinear rotor in a field of inflow, closed forms of momentum theory, and in analyses.

Tolerances: matrices are exact to rounding on both sides (complex steps), entries that cancel to 1e-13 of the largest of
their block. Closed forms are those of small inflow angles, with an error of the square of the inflow ratio.
"""

import sys
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

import proprotor as pp
from proprotor.errors import InputError
from proprotor.model.first_order import state_matrix
from proprotor.stability.origins import model_parts
from proprotor.study.study import study
from tests.oracles import induced_flow
from tests.oracles.nonlinear_rotor import DOFS
from tests.oracles.random_rotors import DENSITY, SPEED_OF_SOUND, RotorInAir, random_rotor
from tests.stability.test_sensitivity import EIGENVALUE, extrapolated, largest_step

RIGID = {"pitch": "rigid", "locked": ["flap", "lag", "gimbal"]}
INFLOW = induced_flow.INFLOW
CASES = {
    "windmilling": {"seed": 41, "n_blades": 3, "airspeed": 90.0, "trim": "windmill"},
    "powered, tables": {
        "seed": 42,
        "tables": True,
        "n_blades": 4,
        "airspeed": 120.0,
        "trim": {"collective": 0.8},
    },
    "climb with much thrust": {"seed": 43, "airspeed": 40.0, "trim": {"thrust_coefficient": 0.012}},
    "incompressible, no section damping": {
        "seed": 44,
        "n_blades": 5,
        "airspeed": 100.0,
        "trim": {"power_coefficient": 0.004},
        "compressibility": False,
        "section_damping": False,
    },
}


@pytest.fixture(params=CASES, scope="module")
def case(request):
    return RotorInAir(**CASES[request.param])


# Against the nonlinear rotor ---------------------------------------------------------------------------------


@pytest.mark.parametrize("azimuth", [0.0, 0.7])
def test_matrices_are_those_of_a_nonlinear_rotor_in_a_field_of_inflow(case, azimuth):
    """With everything at work, and at any azimuth."""
    model, bare = case.model(inflow="dynamic"), case.model(inflow="momentum", airloads="none")
    assert model.dofs == (*DOFS, *INFLOW) and model.rates == INFLOW
    rotor, trim = case.pair.oracle(model.trim)
    expected = induced_flow.linearised(
        case.air, rotor, trim, float(model.trim.inflow), azimuth / case.pair.rotor_speed
    )
    own = len(DOFS)
    actual = [matrix.copy() for matrix in (model.C, model.K)]
    for matrix, vacuum in zip(actual, (bare.C, bare.K), strict=True):
        matrix[:own, :own] -= vacuum
    assert abs(float(model.trim.inflow)) > 0.02
    for found, known in zip((*actual, model.B[:, 3:]), expected, strict=True):
        for rows in (slice(own), slice(own, None)):
            size = np.abs(known[rows]).max()
            np.testing.assert_allclose(found[rows], known[rows], rtol=1e-10, atol=1e-13 * size)
    masses = np.zeros(model.M.shape)
    masses[range(own, own + 3), range(own, own + 3)] = induced_flow.apparent_masses(case.air)
    masses[:own, :own] = bare.M
    np.testing.assert_allclose(model.M, masses, rtol=1e-14, atol=1e-14)
    assert not model.K[:, own:].any()  # only the rates are states


def test_steady_induced_velocity_alone_is_the_same_rotor_without_states(case):
    whole, steady = case.model(inflow="dynamic"), case.model(inflow="momentum")
    own = len(DOFS)
    assert steady.dofs == DOFS
    for name in "MCK":
        np.testing.assert_array_equal(getattr(whole, name)[:own, :own], getattr(steady, name))
    np.testing.assert_array_equal(whole.B[:own], steady.B)
    assert whole.trim.inflow == steady.trim.inflow


def test_lift_slope_airloads_have_no_steady_loads_that_turn():
    """A uniform gust along the axis and a uniform inflow against it are the same air: so are their loads."""
    case = RotorInAir(seed=47, airspeed=110.0, trim={"collective": 0.8})
    model = case.model(inflow="dynamic", airloads="lift-slope", pitch="coupling")
    own, n = model.dofs.index("inflow_0"), len(DOFS) - 3
    np.testing.assert_allclose(
        model.C[:n, own], model.B[:n, 5], rtol=1e-11, atol=1e-11 * np.abs(model.B).max()
    )
    flapped = case.model(inflow="dynamic", pitch="coupling")
    tilted = [one.K[own + 2, places(one, "gimbal_1s")[0]] for one in (model, flapped)]
    assert tilted[0] != tilted[1]  # the steady thrust turns with the gimbal in full airloads alone


# The trim ----------------------------------------------------------------------------------------------------


def independent(case, collective):
    """Induced velocity of a rigid rotor at a collective, by bisection between thrust and stream tube."""
    model = case.model(**RIGID)
    rotor, trim = case.pair.oracle(model.trim)
    rotor = replace(rotor, collective=collective)
    area = np.pi * case.air.radius**2

    def left(induced):
        return induced_flow.thrust(case.air, rotor, trim, induced) - 2 * DENSITY * area * induced * (
            case.airspeed + induced
        )

    return brentq(left, -0.4999 * case.airspeed, 40.0, xtol=1e-13)


@pytest.mark.parametrize(
    ("airspeed", "collective"),
    [(100.0, 0.6), (100.0, 0.8), (100.0, 0.95), (100.0, 0.1), (20.0, 0.95), (20.0, 0.1), (5.0, 0.05)],
)
def test_the_trim_meets_the_stream_tube(airspeed, collective):
    case = RotorInAir(seed=45, airspeed=airspeed, trim={"collective": collective})
    found = case.model(inflow="momentum", **RIGID).trim
    assert float(found.inflow) == pytest.approx(independent(case, collective), abs=1e-10)


@pytest.mark.parametrize(("airspeed", "collective"), [(20.0, 0.09), (20.0, 0.05), (20.0, 0.02), (5.0, 0.01)])
def test_a_rotor_that_brakes_more_than_its_air_could_without_inflow_has_a_trim(airspeed, collective):
    """The thrust without induced velocity has no root of momentum theory; the smaller thrust with it has one."""
    case = RotorInAir(seed=45, airspeed=airspeed, trim={"collective": collective})
    area = np.pi * case.air.radius**2
    assert case.model(**RIGID).trim.thrust < -DENSITY * area * airspeed**2 / 2
    found = case.model(inflow="momentum", **RIGID).trim
    assert float(found.inflow) == pytest.approx(independent(case, collective), abs=1e-10)


def test_in_a_vacuum_there_is_no_inflow():
    """A given collective has a trim without air, but inflow would have no mass; a point with air beside it has both."""
    case = pp.load_case("xv15-uncoupled")
    operation = replace(case.operation, density=np.array([0.0, DENSITY]), trim={"collective": 0.7})
    both = {
        inflow: pp.rotor_model(case.rotor, operation, 150.0, inflow=inflow).trim
        for inflow in ("momentum", "dynamic")
    }
    assert both["momentum"].converged.tolist() == [True, True]
    assert both["momentum"].inflow[0] == 0
    assert both["dynamic"].converged.tolist() == [False, True]
    assert "vacuum" in both["dynamic"].reason[0]
    assert both["dynamic"].inflow[1] == both["momentum"].inflow[1]


@pytest.mark.parametrize(
    "trim", [{"thrust_coefficient": 0.01}, {"power_coefficient": 0.001}, {"collective": 0.3}]
)
def test_hover_has_a_trim(trim):
    """Without airspeed T = 2ρA λ²."""
    case = RotorInAir(seed=46, airspeed=0.0, trim=trim)
    found = case.model(inflow="dynamic")
    area = np.pi * case.air.radius**2
    assert float(found.trim.thrust) == pytest.approx(
        2 * DENSITY * area * float(found.trim.inflow) ** 2, rel=1e-12
    )
    assert "induced" not in str(found.trim.warning)


def test_a_given_thrust_has_the_root_of_the_quadratic():
    case = RotorInAir(**CASES["climb with much thrust"])
    trim, area = case.model(inflow="momentum").trim, np.pi * case.air.radius**2
    thrust = 0.012 * DENSITY * area * (case.pair.rotor_speed * case.air.radius) ** 2
    root = np.sqrt((case.airspeed / 2) ** 2 + thrust / (2 * DENSITY * area)) - case.airspeed / 2
    assert float(trim.inflow) == pytest.approx(root, rel=1e-12)
    assert float(trim.thrust) == pytest.approx(thrust, rel=1e-12)


def test_a_stream_tube_without_a_root_is_a_failed_point_that_spoils_no_other():
    case = RotorInAir(seed=48, airspeed=90.0, trim={"thrust_coefficient": -0.01})
    speeds = np.array([0.0, 5.0, 60.0, 90.0, -1.0, np.nan])
    package, operation = case.pair.package, case.operation
    trim = pp.rotor_model(package, operation, speeds, inflow="dynamic").trim
    assert trim.converged.tolist() == [False, False, True, True, False, False]
    assert all("mass flow" in reason for reason in trim.reason[:2])
    assert "negative" in trim.reason[4] and "finite" in trim.reason[5]
    assert (speeds + 2 * trim.inflow)[2:4].min() > 0
    alone = pp.rotor_model(package, operation, speeds[3], inflow="dynamic")
    assert alone.trim.inflow == trim.inflow[3]
    assert np.isnan(trim.inflow[0])


def test_the_trim_without_inflow_is_untouched(case):
    trim = case.model().trim
    assert trim.inflow == 0.0


# Closed forms ------------------------------------------------------------------------------------------------

SMALL = 0.01  # inflow ratio


def slow_rotor(chord=0.35, **changed):
    """Constant chord from the centre, no twist and no drag, at hardly any inflow: lift = ρ a c/2 (Ωr) (Ωr θ - u_P).

    The collective is that of no thrust, because there is no climb with so little mass flow at another.
    """
    base = random_rotor(50, n_blades=3).package
    rotor = replace(
        base,
        chord=chord,
        twist=0.0,
        root_cutout=1e-6,
        precone=0.0,
        airfoil=pp.Airfoil(lift_slope=5.7, zero_lift_angle=0.0, drag=0.0, moment=0.0),
        aerodynamic_center=0.0,
        offset_mass=None,
        pitch_gimbal_coupling=0.0,
        kinematic_pitch_flap_coupling=0.0,
        kinematic_pitch_lag_coupling=0.0,
        **changed,
    )
    operation = pp.Operation(
        rotor_speed=40.0, density=DENSITY, speed_of_sound=SPEED_OF_SOUND, trim={"collective": 1.5 * SMALL}
    )
    options = {
        "compressibility": False,
        "section_damping": False,
        "pitch": "rigid",
        "locked": ["flap", "lag"],
    }
    model = pp.rotor_model(rotor, operation, SMALL * 40.0 * rotor.radius, inflow="dynamic", **options)
    assert model.trim.converged, model.trim.reason
    return rotor, model


def deficiency(rotor, model, chord=0.35):
    """1/(1 + σa/8μ), μ the mass flow over ρAΩR: (uniform, harmonics)."""
    solidity = rotor.n_blades * chord / (np.pi * rotor.radius)
    airspeed, induced = float(model.airspeed), float(model.trim.inflow)
    tip_speed = 40.0 * rotor.radius
    return [
        1 / (1 + solidity * 5.7 / (8 * flow / tip_speed))
        for flow in (airspeed + 2 * induced, airspeed + induced)
    ]


def places(model, *names):
    return [model.dofs.index(name) for name in names]


def test_a_step_of_collective_ends_at_the_lift_deficiency():
    """Thrust of a rigid rotor once the inflow has settled, over thrust at once."""
    rotor, model = slow_rotor()
    uniform, _ = deficiency(rotor, model)
    (z, inflow) = places(model, "z", "inflow_0")
    at_once = model.B[z, 0]
    settled = at_once - model.C[z, inflow] * model.B[inflow, 0] / model.C[inflow, inflow]
    assert uniform < 0.4
    assert settled / at_once == pytest.approx(uniform, rel=5 * SMALL**2 / uniform)


def test_a_step_of_cyclic_pitch_ends_at_the_lift_deficiency_of_the_harmonics():
    rotor, model = slow_rotor()
    _, harmonic = deficiency(rotor, model)
    (alpha_y, inflow) = places(model, "alpha_y", "inflow_1c")
    at_once = model.B[alpha_y, 1]
    settled = at_once - model.C[alpha_y, inflow] * model.B[inflow, 1] / model.C[inflow, inflow]
    assert settled / at_once == pytest.approx(harmonic, rel=5 * SMALL**2 / harmonic)


def test_gimbal_flapping_is_damped_by_what_the_harmonics_leave():
    """ρ a c N Ω R⁴/16 for a flapping that is slow beside the inflow, times the lift deficiency."""
    rotor, model = slow_rotor()
    _, harmonic = deficiency(rotor, model)
    gimbal, inflow = places(model, "gimbal_1c", "gimbal_1s"), places(model, "inflow_1c", "inflow_1s")
    bare = slow_rotor_in_vacuum(rotor)
    own = model.C[np.ix_(gimbal, gimbal)] - bare
    across = model.C[np.ix_(gimbal, inflow)] @ np.linalg.inv(model.C[np.ix_(inflow, inflow)])
    left = own - across @ model.C[np.ix_(inflow, gimbal)]
    at_once = DENSITY * 5.7 * 0.35 * rotor.n_blades * 40.0 * rotor.radius**4 / 16
    np.testing.assert_allclose(np.diag(own), at_once, rtol=5 * SMALL)
    np.testing.assert_allclose(np.diag(left), at_once * harmonic, rtol=5 * SMALL)


def slow_rotor_in_vacuum(rotor):
    operation = pp.Operation(
        rotor_speed=40.0, density=DENSITY, speed_of_sound=SPEED_OF_SOUND, trim={"collective": 1.5 * SMALL}
    )
    model = pp.rotor_model(
        rotor,
        operation,
        SMALL * 40.0 * rotor.radius,
        airloads="none",
        inflow="momentum",
        compressibility=False,
        section_damping=False,
        pitch="rigid",
        locked=["flap", "lag"],
    )
    gimbal = places(model, "gimbal_1c", "gimbal_1s")
    return model.C[np.ix_(gimbal, gimbal)]


def test_inflow_of_a_rotor_that_stands_still_decays_as_the_mass_of_air_and_its_flow_say():
    rotor, model = slow_rotor()
    tip_speed, airspeed, induced = 40.0 * rotor.radius, float(model.airspeed), float(model.trim.inflow)
    lift = 3 * 0.35 / (np.pi * rotor.radius) * 5.7 / 8 * tip_speed
    uniform = -3 * np.pi / (8 * rotor.radius) * 2 * (airspeed + 2 * induced + lift)
    harmonic = -45 * np.pi / (16 * rotor.radius) * (airspeed + induced + lift) / 2
    own = places(model, *INFLOW)
    rates = np.diag(-np.linalg.solve(model.M[np.ix_(own, own)], model.C[np.ix_(own, own)]))
    np.testing.assert_allclose(rates, [uniform, harmonic, harmonic], rtol=5 * SMALL**2)


# Laws --------------------------------------------------------------------------------------------------------


def test_a_hub_that_moves_ahead_is_a_rotor_at_another_airspeed():
    """Uniform inflow after a steady change of the hub's speed, beside trims on both sides of the airspeed."""
    case, step = RotorInAir(seed=45, airspeed=100.0, trim={"collective": 0.8}), 1e-3
    model = case.model(inflow="dynamic", **RIGID)
    (z, inflow) = places(model, "z", "inflow_0")
    ahead, behind = (
        case.model(inflow="momentum", airspeed=100.0 + sign * step, **RIGID).trim.inflow for sign in (1, -1)
    )
    settled = -model.C[inflow, z] / model.C[inflow, inflow]
    assert settled == pytest.approx(float(ahead - behind) / (2 * step), rel=1e-6)


def test_a_hub_that_tilts_meets_the_undisturbed_air_at_an_angle_and_takes_its_inflow_along(case):
    """Turned with hub and blades, the rotor sees a gust V α across its axis, and its induced velocity as before."""
    model = case.model(inflow="dynamic")
    own = model.dofs.index("inflow_0")
    x, y = places(model, "alpha_x", "alpha_y")
    gust_x, gust_y = model.B[own:, 3], model.B[own:, 4]
    size = np.abs(case.airspeed * model.B[own:, 3:5]).max()
    np.testing.assert_allclose(model.K[own:, y], -case.airspeed * gust_x, rtol=0, atol=1e-12 * size)
    np.testing.assert_allclose(model.K[own:, x], case.airspeed * gust_y, rtol=0, atol=1e-12 * size)


def test_turning_the_axes_about_the_shaft_changes_nothing(case):
    model, angle = case.model(inflow="dynamic"), 0.6
    cosine, sine = np.cos(angle), np.sin(angle)
    turn = np.eye(len(model.dofs))
    for first, second, sense in (
        *(("x", "y", 1), ("alpha_x", "alpha_y", 1)),
        *((f"{name}_1c", f"{name}_1s", 1) for name in ("flap", "lag", "pitch", "gimbal", "inflow")),
    ):
        pair = places(model, first, second)
        turn[np.ix_(pair, pair)] = [[cosine, -sense * sine], [sense * sine, cosine]]
    for name in "MCK":
        matrix = getattr(model, name)
        np.testing.assert_allclose(turn.T @ matrix @ turn, matrix, rtol=0, atol=1e-12 * np.abs(matrix).max())


def test_hardly_any_blade_leaves_the_quasi_steady_rotor():
    """With less and less chord the air moves less and less: what airloads are left are those without inflow."""
    chord = 1e-9
    rotor, model = slow_rotor(chord)
    own = places(model, "z", "alpha_y", "gimbal_1c", "gimbal_1s")
    inflow = places(model, *INFLOW)
    across = model.C[np.ix_(own, inflow)] @ np.linalg.inv(model.C[np.ix_(inflow, inflow)])
    change = across @ model.C[np.ix_(inflow, own)]
    for place, name in enumerate(("z", "alpha_y")):
        loads = DENSITY * 5.7 * chord * rotor.n_blades * 40.0 * rotor.radius**2 / 4
        loads *= 1 if name == "z" else rotor.radius**2 / 4
        assert abs(change[place, place]) < 1e-6 * loads
    assert abs(float(model.trim.inflow)) < 1e-6 * float(model.airspeed)


# In analyses -------------------------------------------------------------------------------------------------


def test_modes_have_names(xv15):
    names = xv15.linearize("250 kt", inflow="dynamic").modes().name.values.tolist()
    assert {"uniform inflow", "cyclic inflow"} <= set(names)
    assert len(set(names)) == len(names)


@pytest.fixture(scope="module")
def xv15():
    return pp.load_case("xv15-uncoupled")


@pytest.mark.parametrize("deck", ["xv15-uncoupled", "xv15-aircraft", "xv15-bell-frequencies"])
@pytest.mark.parametrize("inflow", ["momentum", "dynamic"])
def test_the_matrices_are_the_sum_of_their_origins(deck, inflow):
    case = pp.load_case(deck)
    model = case.linearize(np.array([110.0, 150.0]), inflow=inflow)
    parts = model_parts(case, model)
    assert "inflow" in parts
    for name in "MCK":
        whole = getattr(model, name)
        total = sum(getattr(part, name) for part in parts.values())
        np.testing.assert_allclose(total, whole, rtol=0, atol=1e-12 * np.abs(whole).max())


@pytest.mark.parametrize("inflow", ["momentum", "dynamic"])
def test_derivatives_of_roots_through_the_induced_velocity(xv15, inflow):
    """Exact derivatives beside differences extrapolated to no step."""
    paths = ["rotor.radius", "rotor.airfoil.lift_slope", "operation.density", "operation.rotor_speed"]
    found = xv15.sensitivity("eigenvalue", airspeed=150.0, wrt=paths, inflow=inflow)
    values = found.eigenvalue.values
    for path in paths:
        own = float(xv15.given[path].si)

        def values_at(numbers, path=path):
            every = np.linalg.eigvals(
                state_matrix(xv15.vary({path: numbers}).linearize(150.0, inflow=inflow))
            )
            nearest = np.abs(every[:, None, :] - values[:, None]).argmin(axis=2)
            return np.take_along_axis(every, nearest, axis=1)

        limit = extrapolated(values_at, own, largest_step(xv15, path))
        exact = found.derivative.sel(input=path).values
        scale = np.maximum(np.abs(exact), 1e-4 * np.abs(values) / abs(own))
        assert (np.abs(limit - exact) / scale).max() < EIGENVALUE, path


def test_the_trim_of_a_complex_step_is_exact():
    """Of the induced velocity with the density, at a thrust whose root has a closed form."""
    case = RotorInAir(**CASES["climb with much thrust"])
    area, speed = np.pi * case.air.radius**2, case.airspeed
    operation = replace(case.operation, density=DENSITY + 1e-30j, trim={"collective": 0.35})
    model = pp.rotor_model(case.pair.package, operation, speed, inflow="momentum")
    step = 1e-5
    moved = [
        pp.rotor_model(
            case.pair.package, replace(operation, density=DENSITY + sign * step), speed, inflow="momentum"
        ).trim.inflow
        for sign in (1, -1)
    ]
    assert float(np.imag(model.trim.inflow)) / 1e-30 == pytest.approx(
        float(moved[0] - moved[1]) / (2 * step), rel=1e-6
    )
    thrust, induced = model.trim.thrust, model.trim.inflow
    left = thrust - 2 * operation.density * area * induced * (speed + induced)
    assert abs(left.imag) < 1e-10 * abs(thrust.imag)


def test_motions_that_do_not_reach_the_hub_have_no_inflow():
    case = pp.load_case("xv15-uncoupled")
    rotor = replace(case.rotor, n_blades=5)
    five = pp.Case("five blades", rotor, case.operation, case.support)
    few, every = (five.linearize(150.0, inflow="dynamic", reactionless=choice) for choice in (False, True))
    steady = five.linearize(150.0, inflow="momentum", reactionless=True)
    for group in every.apart:
        alone, without = (replace(model, apart=()).submodel(group) for model in (every, steady))
        np.testing.assert_array_equal(alone.K, without.K)
        np.testing.assert_array_equal(alone.C, without.C)
    roots = np.linalg.eigvals(state_matrix(every))
    for root in np.linalg.eigvals(state_matrix(few)):
        assert np.abs(roots - root).min() < 1e-9 * abs(root)


def test_backends_and_batches_agree(xv15):
    speeds = np.array([110.0, 150.0])
    batch = xv15.linearize(speeds, inflow="dynamic")
    one = xv15.linearize(speeds[1], inflow="dynamic")
    for name in "MCKB":
        np.testing.assert_array_equal(getattr(batch, name)[1], getattr(one, name))
    auto = xv15.linearize(speeds, inflow="dynamic", backend="auto")
    for name in "MCKB":
        matrix = getattr(batch, name)
        np.testing.assert_allclose(getattr(auto, name), matrix, rtol=0, atol=1e-12 * np.abs(matrix).max())


def test_one_boundary_by_search_by_sweep_and_by_study(xv15):
    point = xv15.flutter_point("300:420:20kt", inflow="dynamic")
    model = xv15.linearize(point.speed, inflow="dynamic")
    roots = np.linalg.eigvals(state_matrix(model))
    assert np.abs(roots.real[np.abs(roots.imag - point.frequency).argmin()]) < 1e-6
    plan = {"rotor.precone": [xv15.given["rotor.precone"].si]}
    designs = study(xv15, plan, "300:420:20kt", quantities=("flutter", "trim"), inflow="dynamic")
    assert designs.flutter_speed.values[0] == pytest.approx(point.speed, rel=2e-3)


def test_a_frequency_response_has_the_inflow(xv15):
    """At a frequency that is high for the inflow, air that has no time to move leaves the response without inflow."""
    asked = {"inputs": ["gust_z"], "outputs": ["force_z"]}
    omega = np.array([1.0, 3000.0])
    with_states, steady = (
        pp.frequency_response(model, omega, **asked).magnitude.values.ravel()
        for model in (
            xv15.linearize("250 kt", inflow=inflow, rotor_speed="constant")
            for inflow in ("dynamic", "momentum")
        )
    )
    assert with_states[1] == pytest.approx(steady[1], rel=2e-2)
    assert abs(with_states[0] / steady[0] - 1) > 2e-2


def test_states_have_units(xv15):
    space = xv15.linearize("250 kt", inflow="dynamic").to_state_space()
    assert "inflow_1s rate" in space.states


# What is refused ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "field", "said"),
    [
        ({"inflow": "pitt-peters"}, "inflow", "none, momentum, dynamic"),
        ({"inflow": "dynamic", "equations": "published"}, "inflow", "consistent"),
        ({"inflow": "momentum", "equations": "published"}, "inflow", "consistent"),
        ({"inflow": "dynamic", "airloads": "none"}, "inflow", "lift-slope"),
        ({"inflow": "dynamic", "lift": "lagged"}, "inflow", "twice"),
        ({"inflow": "momentum", "lift": "lagged-blades"}, "inflow", "twice"),
        ({"inflow": "dynamic", "shaft_angle": 0.1}, "shaft_angle", 'inflow="none"'),
        ({"inflow": "momentum", "load_factor": 1.5}, "load_factor", 'inflow="none"'),
    ],
)
def test_what_has_no_inflow_is_refused_before_anything_is_computed(xv15, options, field, said, monkeypatch):
    monkeypatch.setattr(sys.modules["proprotor.model.rotor_model"], "model_quantities", None)
    with pytest.raises(InputError, match=said) as caught:
        xv15.linearize("250 kt", **options)
    assert caught.value.field == field


def test_lift_of_the_wing_may_lag_beside_the_inflow():
    model = pp.load_case("xv15-aircraft").linearize("250 kt", inflow="dynamic", lift="lagged-wing")
    assert {"symmetric inflow_0", "antisymmetric inflow_1c", "symmetric slow wing lift"} <= set(model.dofs)


def test_theodorsen_goes_without_inflow(xv15):
    model = xv15.linearize("250 kt", inflow="dynamic")
    with pytest.raises(InputError, match="inflow"):
        pp.frequency_response(
            model, np.array([5.0]), inputs=["gust_x"], outputs=["force_x"], lift="theodorsen"
        )


def test_frequencies_against_airspeed_are_refused():
    found = pp.load_case("xv15-bell-frequencies")
    against = replace(
        found.frequencies,
        against="airspeed",
    )
    with pytest.raises(InputError, match="against the collective"):
        found.linearize("250 kt", inflow="momentum", structure="tabulated", frequencies=against)
