"""Lag of lift against sections that lag one by one, against closed forms of one section, and in every analysis."""

import sys
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.linalg import expm
from scipy.special import iv, kn

import proprotor as pp
from benchmarks import reed_bland as report
from proprotor.errors import InputError
from proprotor.model import lift_lag
from proprotor.model.first_order import state_matrix
from proprotor.model.several_rotors import MountedRotor
from proprotor.rotor import motions
from proprotor.rotor.lift_lag import polynomials
from proprotor.rotor.motions import LAG_SHAPES
from proprotor.rotor.options import LOCKABLE
from proprotor.stability.origins import model_parts
from tests.oracles.lagging_lift import jones, what_lag_adds
from tests.oracles.nonlinear_rotor import DOFS
from tests.oracles.random_rotors import RotorInAir

ROTOR_MODEL = sys.modules["proprotor.model.rotor_model"]
FREQUENCIES = 1j * np.array([0.3, 8.0, 45.0, 130.0]) + np.array([0.0, -3.0, 2.0, 0.0])
CASES = {
    "windmilling": {"seed": 21, "n_blades": 3, "airspeed": 90.0, "trim": "windmill"},
    "powered, tables": {
        "seed": 22,
        "tables": True,
        "n_blades": 4,
        "airspeed": 120.0,
        "trim": {"collective": 0.8},
    },
    "no section damping": {
        "seed": 23,
        "airspeed": 110.0,
        "trim": {"collective": 0.8},
        "section_damping": False,
    },
    "incompressible": {"seed": 24, "airspeed": 100.0, "trim": "windmill", "compressibility": False},
}


@pytest.fixture
def with_shapes(monkeypatch):
    """Set the number of shape functions, polynomials or a pair of states at every station of a rotor."""
    monkeypatch.setattr(
        ROTOR_MODEL, "_design", ROTOR_MODEL._design.__wrapped__
    )  # the kept one has its own number

    def set_shapes(count, shapes=None):
        monkeypatch.setattr(ROTOR_MODEL, "lag_coordinates", lambda: motions.lag_coordinates(count))
        monkeypatch.setattr(ROTOR_MODEL, "with_lag", lambda group: motions.with_lag(group, count))
        made = polynomials(count) if shapes is None else shapes
        monkeypatch.setattr(lift_lag, "polynomials", lambda _: made)

    return set_shapes


def one_each(share):
    """Shape functions that are 1 at one station each."""
    return np.eye(np.shape(share)[-1])


def dynamic(model, s):
    """s² M + s C + K and loads of the inputs on the coordinates whose lift does not lag, the others condensed."""
    whole, own = s**2 * model.M + s * model.C + model.K, len(model.dofs) - len(model.rates)
    assert not model.K[:, own:].any()  # only the rates of what lags are states
    lag, late = (s * model.M + model.C)[own:, own:], model.C[:own, own:]
    across = late @ np.linalg.inv(lag)
    return whole[:own, :own] - across @ whole[own:, :own], model.B[:own] - across @ model.B[own:]


@pytest.fixture(scope="module")
def xv15():
    return pp.load_case("xv15-uncoupled")


class Case(RotorInAir):
    def lagging_one_by_one(self, quasi_steady, s):
        """The same as `dynamic`, from the nonlinear rotor."""
        rotor, trim = self.pair.oracle(quasi_steady.trim)
        added, gusts = what_lag_adds(self.air, rotor, trim, s)
        loads = quasi_steady.B.astype(complex)
        loads[:, 3:] += gusts
        return s**2 * quasi_steady.M + s * quasi_steady.C + quasi_steady.K + added, loads


def size_of(model, s):
    """What airloads and springs put into an entry of the dynamic stiffness."""
    diagonal = np.abs(np.diagonal(s * model.C + model.K))
    return np.sqrt(np.outer(diagonal, diagonal))


# Against sections that lag one by one -----------------------------------------------------------------------


@pytest.mark.parametrize("name", CASES)
def test_a_pair_of_states_at_every_station_is_the_nonlinear_rotor(name, with_shapes):
    """To rounding; the lag is no linear function of the chord, for which a table's few stations are chosen."""
    case, relative = Case(**CASES[name]), 1e-6 if "tables" in name else 1e-11
    quasi_steady = case.model()
    assert quasi_steady.dofs == DOFS
    with_shapes(case.pair.package.quadrature.stations.size, one_each)
    model = case.model(lift="lagged")
    for s in FREQUENCIES:
        expected, of_inputs = case.lagging_one_by_one(quasi_steady, s)
        actual, loads = dynamic(model, s)
        size = size_of(quasi_steady, s)
        np.testing.assert_array_less(np.abs(actual - expected) / size, relative)
        np.testing.assert_allclose(loads, of_inputs, rtol=0, atol=relative * np.abs(of_inputs).max())
        instant = s**2 * quasi_steady.M + s * quasi_steady.C + quasi_steady.K
        assert np.abs((expected - instant) / size).max() > 0.05  # there is something to see


def blade_alone(case, quasi_steady, s):
    """Dynamic stiffness (3, 3) of flap, lag and pitch of all blades that move alike with exp(st), each in its axes."""
    whole, _ = case.lagging_one_by_one(quasi_steady, s)
    places = [DOFS.index(f"{angle}_0") for angle in ("flap", "lag", "pitch")]
    return whole[np.ix_(places, places)]


@pytest.mark.parametrize("n_blades", [4, 5, 7, 8])
def test_reactionless_motions_lag_at_the_frequency_of_the_blades(n_blades, with_shapes):
    """In the n-th harmonic a blade of the nonlinear rotor moves with s + inΩ, its neighbours out of phase."""
    case = Case(30 + n_blades, 105.0, "windmill", n_blades=n_blades)
    quasi_steady = case.model()
    with_shapes(case.pair.package.quadrature.stations.size, one_each)
    model = case.model(lift="lagged", reactionless=True)
    assert model.apart
    for group in model.apart:
        block, turning = replace(model, apart=()).submodel(group), "_d" not in group[0]
        harmonic = 1j * int(group[0].rpartition("_")[2][:-1]) if turning else 0.0
        for s in FREQUENCIES:
            alone = blade_alone(case, quasi_steady, s + harmonic * case.pair.rotor_speed)
            wave = np.kron(np.eye(3), [[1.0], [1j]]) if turning else np.eye(3)
            found, _ = dynamic(replace(block, B=np.zeros((len(group), 1))), s)
            expected = wave @ alone / (2 if turning else 1)
            np.testing.assert_allclose(found @ wave, expected, rtol=0, atol=1e-11 * np.abs(expected).max())


@pytest.mark.parametrize("name", CASES)
def test_two_shape_functions_are_enough(name, with_shapes):
    """Beside sections that lag one by one: within one per cent of what airloads and springs put into an entry."""
    case = Case(**CASES[name])
    quasi_steady, errors = case.model(), {}
    expected = [case.lagging_one_by_one(quasi_steady, s)[0] for s in FREQUENCIES]
    for count in (1, LAG_SHAPES, 4, 8):
        with_shapes(count)
        model = case.model(lift="lagged")
        errors[count] = max(
            np.max(np.abs(dynamic(model, s)[0] - one) / size_of(quasi_steady, s))
            for s, one in zip(FREQUENCIES, expected, strict=True)
        )
    assert errors[1] > errors[LAG_SHAPES] > 3 * errors[4] > 3 * errors[8]
    assert errors[LAG_SHAPES] < 0.01


@pytest.mark.parametrize(("count", "error"), [(LAG_SHAPES, 1e-3), (LAG_SHAPES + 1, 1e-4)])
def test_roots_with_few_shape_functions_are_those_with_many(count, error, with_shapes, xv15):
    """Of modes with less than 20 per cent of damping, over a range of airspeeds."""
    speeds, roots = np.array([60.0, 120.0, 180.0]), []
    for shapes in (count, 8):
        with_shapes(shapes)
        roots.append(np.linalg.eigvals(state_matrix(xv15.linearize(speeds, lift="lagged"))))
    for few, many in zip(*roots, strict=True):
        swinging = many[(many.imag > 0) & (-many.real < 0.2 * np.abs(many))]
        assert len(swinging) >= 9
        nearest = np.abs(few[:, None] - swinging).min(axis=0)
        np.testing.assert_array_less(nearest, error * np.abs(swinging))


@pytest.mark.parametrize("count", [1, 2, 3])
def test_lift_of_a_steady_motion_is_that_at_once_whatever_the_shape_functions(count, with_shapes):
    rng = np.random.default_rng(7)
    case = Case(**CASES["powered, tables"])
    with_shapes(count, lambda share: rng.uniform(-1, 1, (np.shape(share)[-1], count)))
    quasi_steady, model = case.model(), case.model(lift="lagged")
    steady = [DOFS.index(name) for name in ("z", "alpha_z", "flap_0", "lag_0", "pitch_0", "azimuth")]
    stiffness, loads = dynamic(model, 0.0)
    size = np.abs(quasi_steady.K).max()
    np.testing.assert_allclose(
        stiffness[np.ix_(steady, steady)],
        quasi_steady.K[np.ix_(steady, steady)],
        rtol=1e-12,
        atol=1e-13 * size,
    )
    np.testing.assert_allclose(loads[steady, 5], quasi_steady.B[steady, 5], rtol=1e-11, atol=1e-9)
    assert model.trim.collective == quasi_steady.trim.collective


# One section ------------------------------------------------------------------------------------------------

SPEED, CHORD = 100.0, 0.5
K = np.array([0.0, 0.01, 0.03, 0.1, 0.2, 0.3, 0.5, 1.0, 3.0])  # reduced frequencies


@pytest.fixture(scope="module")
def wings():
    """Blades that hardly turn, so that all their sections meet the same air: three wings along the wind."""
    rotor = pp.Rotor(
        n_blades=3,
        radius=2.0,
        root_cutout=0.5,
        blade_mass=10.0,
        blade_first_moment=10.0,
        blade_inertia=13.0,
        flap_first_moment=10.0,
        flap_inertia=13.0,
        lag_first_moment=10.0,
        lag_inertia=13.0,
        flap_stiffness=1e6,
        lag_stiffness=1e6,
        chord=CHORD,
        twist=0.0,
        airfoil=pp.Airfoil(lift_slope=6.0),
    )
    operation = pp.Operation(
        rotor_speed=1e-7, density=1.0, speed_of_sound=340.0, trim={"collective": np.pi / 2}
    )
    options = {"locked": LOCKABLE, "rotor_speed": "constant", "compressibility": False}

    def model(**more):
        return pp.rotor_model(rotor, operation, SPEED, **options, **more)

    return model


def lift_ratio(wings, k):
    """Damping force of a wing that moves across the wind, over that of a wing whose lift comes at once."""
    s = 2j * k * SPEED / CHORD
    still, at_once, model = wings(airloads="none"), wings(), wings(lift="lagged")
    x = model.dofs.index("x")
    across = dynamic(model, s)[0][x, x] - s**2 * still.M[x, x]
    return across / (s * at_once.C[x, x]) if k else 1.0


def test_one_section_is_jones_function(wings):
    for k in K[1:]:
        np.testing.assert_allclose(lift_ratio(wings, k), jones(1j * k), rtol=1e-10)


def test_one_section_beside_theodorsen(wings):
    """Within 2.5 per cent in modulus; the phase is as Jones' function has it, within a degree and a half."""
    ratio = np.array([lift_ratio(wings, k) for k in K[1:]])
    exact = report.theodorsen(K[1:])
    assert np.max(np.abs(np.abs(ratio) / np.abs(exact) - 1)) < 0.025
    assert np.max(np.abs(np.degrees(np.angle(ratio / exact)))) < 1.5


def wagner(s):
    """Lift after a step of the incidence, s half chords later: Wagner's function as an integral of Bessel functions.

    1 - ∫ exp(-xs) / (x² ((K0 - K1)² + π² (I0 + I1)²)) dx, from the cut of C(k) along the negative real axis.
    """

    def density(log):
        x = np.exp(log)
        bessel = (kn(0, x) - kn(1, x)) ** 2 + np.pi**2 * (iv(0, x) + iv(1, x)) ** 2
        return np.exp(-x * s) / (x * bessel)

    return 1 - quad(density, np.log(1e-8), np.log(50.0), limit=200)[0]


def test_wagner_of_this_file_begins_with_one_half():
    np.testing.assert_allclose(wagner(0.0), 0.5, rtol=1e-6)


def test_a_step_of_the_wind_beside_wagner(wings):
    """Within 1.5 per cent at every time."""
    at_once, model = wings(), wings(lift="lagged")
    lag, own = slice(6, None), slice(None, 6)
    x, gust = 0, model.inputs.index("gust_x")
    decay = np.linalg.solve(model.M[lag, lag], model.C[lag, lag])
    driven = np.linalg.solve(model.M[lag, lag], model.B[lag, gust])
    for s in (0.0, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0):
        time = s * CHORD / 2 / SPEED
        state = np.linalg.solve(decay, driven - expm(-decay * time) @ driven)
        force = model.B[x, gust] - model.C[own, lag][x] @ state
        ratio = force / at_once.B[x, gust]
        expected = 1 - 0.165 * np.exp(-0.0455 * s) - 0.335 * np.exp(-0.3 * s)
        np.testing.assert_allclose(ratio, expected, rtol=1e-10)
        np.testing.assert_allclose(ratio, wagner(s), rtol=0.015)


def test_air_that_passes_in_no_time_gives_lift_at_once():
    """A chord of 1e-14 m with the lift of a whole one."""
    case = Case(**CASES["no section damping"])
    thin = replace(
        case.pair.package,
        chord=1e-14,
        airfoil=pp.Airfoil(lift_slope=2e14, zero_lift_angle=-0.02, drag=1e12, moment=0.0),
    )
    quasi_steady, model = (
        pp.rotor_model(thin, case.operation, case.airspeed, **case.switches, lift=lift)
        for lift in ("quasi-steady", "lagged")
    )
    for s in FREQUENCIES:
        expected = s**2 * quasi_steady.M + s * quasi_steady.C + quasi_steady.K
        np.testing.assert_array_less(
            np.abs(dynamic(model, s)[0] - expected) / size_of(quasi_steady, s), 1e-12
        )


# In every analysis ------------------------------------------------------------------------------------------


def test_names_of_modes(xv15):
    """A lag of the collective motion has one real root, one of the cyclic motion a pair near the rotor's speed."""
    sweep = xv15.sweep("120:180:20kt", lift="lagged")
    names = sweep.mode.values.tolist()
    assert names[-8:] == [
        f"{kind} {lag} lift{shape}"
        for lag in ("slow", "fast")
        for shape in ("", " 2")
        for kind in ("collective", "cyclic")
    ]
    assert not (sweep.reason != "").any()
    for name in names[-8:]:
        roots = sweep.eigenvalue.sel(mode=name).values
        assert (roots.real < 0).all()
        turning = roots.imag / float(xv15.operation.rotor_speed)
        np.testing.assert_allclose(turning, 1.0 if name.startswith("cyclic") else 0.0, atol=0.03)
    quasi_steady = xv15.sweep("120:180:20kt")
    for name in quasi_steady.mode.values.tolist()[:3]:  # the wing's modes keep their frequencies and names
        ratio = sweep.frequency.sel(mode=name) / quasi_steady.frequency.sel(mode=name)
        np.testing.assert_allclose(ratio, 1.0, atol=0.05)


def test_the_collective_lag_and_the_rotor_speed_may_swing_together(xv15):
    """Two rates that meet become a pair, which has one of their names; the other name stands for no mode then."""
    modes = xv15.linearize(130.0, lift="lagged").modes()
    named = dict(zip(modes.name.values.tolist(), modes.eigenvalue.values, strict=True))
    assert "collective slow lift 2" in named
    assert ("rotor speed" in named) != ("collective slow lift" in named)
    assert named.get("rotor speed", named.get("collective slow lift")).imag > 1


def test_one_point_is_a_batch_and_a_batch_its_points(xv15):
    speeds = np.array([60.0, 90.0, 140.0])
    batch = xv15.linearize(speeds, lift="lagged")
    for place, speed in enumerate(speeds):
        one = xv15.linearize(float(speed), lift="lagged")
        for name in "MCKB":
            own = getattr(one, name)
            np.testing.assert_allclose(
                getattr(batch, name)[place], own, rtol=1e-12, atol=1e-13 * np.abs(own).max()
            )


def test_a_failed_point_spoils_no_other(xv15):
    model = xv15.linearize(np.array([100.0, 2000.0]), lift="lagged")
    assert model.trim.reason[0] == "" and model.trim.reason[1] != ""
    assert np.isfinite(model.C[0]).all() and np.isnan(model.C[1]).all()
    alone = xv15.linearize(100.0, lift="lagged")
    np.testing.assert_allclose(model.C[0], alone.C, rtol=1e-12, atol=1e-13 * np.abs(alone.C).max())


@pytest.mark.parametrize("name", ["chord", "radius", "root_cutout"])
def test_derivatives_by_a_complex_step(name):
    """Beside central differences of the same model."""
    case, step = Case(**CASES["powered, tables"]), 1e-6
    rotor = case.pair.package

    def moved(by):
        value = getattr(rotor, name)
        value = (value[0], value[1] + by) if isinstance(value, tuple) else value + by
        return pp.rotor_model(replace(rotor, **{name: value}), case.operation, case.airspeed, lift="lagged")

    exact, ahead, behind = moved(1e-30j), moved(step), moved(-step)
    for kind in "MCK":
        derivative = getattr(exact, kind).imag / 1e-30
        difference = (getattr(ahead, kind) - getattr(behind, kind)) / (2 * step)
        assert np.abs(derivative[18:]).max() > 0
        np.testing.assert_allclose(derivative, difference, rtol=1e-4, atol=1e-7 * np.abs(derivative).max())


def test_origins_add_up_and_have_the_lag_apart(xv15):
    model = xv15.linearize(150.0, lift="lagged")
    parts = model_parts(xv15, model)
    for place, kind in enumerate("MCK"):
        whole = getattr(model, kind)
        np.testing.assert_allclose(
            sum(part[place] for part in parts.values()), whole, rtol=1e-9, atol=1e-12 * np.abs(whole).max()
        )
    quasi_steady = model_parts(xv15, xv15.linearize(150.0))
    assert set(parts) - set(quasi_steady) == {"lag of lift"}


def test_state_space_and_frequency_response(xv15):
    model = xv15.linearize(120.0, lift="lagged")
    space = model.to_state_space()
    assert len(space.states) == 2 * len(model.dofs) - 1 - len(model.rates)
    assert space.states[-1] == "fast lift 2_1s rate" and "fast lift 2_1s" not in space.states
    omega = np.array([2.0, 30.0])
    found = pp.frequency_response(model, omega, inputs=["gust_z", "cyclic_1c"], outputs=["gimbal_1c"])
    loads = model.B[:, [model.inputs.index(name) for name in ("gust_z", "cyclic_1c")]]
    for place, w in enumerate(omega):
        motion = np.linalg.solve(model.K + 1j * w * model.C - w**2 * model.M, loads)
        expected = motion[model.dofs.index("gimbal_1c")]
        np.testing.assert_allclose(found.response.values[place, 0], expected, rtol=1e-9)
    every = pp.frequency_response(model, omega)
    units = dict(zip(every.output.values, every.output_unit.values, strict=True))
    assert units["slow lift_1c rate"] == "m/s"


def test_an_aircraft_lags_in_both_halves_of_its_motion():
    aircraft = pp.load_case("xv15-aircraft")
    model = aircraft.linearize(150.0, lift="lagged")
    assert sum(name.startswith("symmetric slow lift") for name in model.rates) == 3 * LAG_SHAPES
    assert set(model.rates) >= {"antisymmetric fast lift 2_1s"}
    values = model.modes().eigenvalue.values
    assert np.isfinite(values).all()


def test_several_rotors_lag(xv15):
    alone = pp.rotor_model(xv15.rotor, xv15.operation, 100.0, lift="lagged", rotor_speed="constant")
    support = pp.NormalModes(
        tuple("abcdef"), 1e4 * np.eye(6), np.zeros((6, 6)), 1e6 * np.eye(6), np.eye(6), False
    )
    rotors = {name: MountedRotor(alone, np.eye(6)) for name in ("left", "right")}
    model = pp.mount_rotors(rotors, support)
    assert len(model.rates) == 2 * len(alone.rates)
    assert {"left slow lift_0", "right fast lift 2_1s"} <= set(model.rates)
    values, pairs = (np.linalg.eigvals(state_matrix(one)) for one in (model, pp.mount(alone, support)))
    assert len(values) == 2 * len(model.dofs) - len(model.rates)
    assert np.isfinite(values).all() and np.isfinite(pairs).all()


def test_a_locked_rotor_and_blades_that_follow_the_swashplate(xv15):
    """Without pitch equations the pitch is an input of what lags, too."""
    free = xv15.linearize(120.0, lift="lagged")
    rigid = xv15.linearize(120.0, lift="lagged", pitch="rigid")
    place = rigid.dofs.index("slow lift_0")
    collective = free.dofs.index("pitch_0")
    np.testing.assert_allclose(
        rigid.B[place, 0], -free.K[free.dofs.index("slow lift_0"), collective], rtol=1e-9
    )


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"equations": "published"}, "consistent"),
        ({"airloads": "none"}, "lift-slope"),
    ],
)
def test_what_has_no_equations_is_refused(xv15, options, told):
    with pytest.raises(InputError, match=f"lift = lagged: goes with .*{told}"):
        xv15.linearize(100.0, lift="lagged", **options)
