"""Structure options: springs that turn with the pitch, without their flap-lag stiffness, tabulated frequencies.

Frequencies in vacuum at zero cone are held to 1e-12 of one per rev.
"""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from tests.derive.test_airloads_virtual_work import CASES, Case, steady_rows
from tests.derive.test_lagrangian import assert_model_matches, expected_matrices
from tests.oracles import nonlinear_rotor
from tests.oracles.motion import Motion
from tests.oracles.nonlinear_rotor import AZIMUTH, FLAP, LAG, PITCH, hinge_spring_energy, rows_in_vacuum
from tests.oracles.random_rotors import NO_LINKAGES, NO_OFFSETS, SPEED_OF_SOUND, random_rotor

SPEED = 47.0
BLADES = ("flap_0", "flap_1c", "flap_1s", "lag_0", "lag_1c", "lag_1s")


def flat_rotor(n_blades=3, **changes):
    """Nothing bends it in vacuum, and no dampers."""
    flat = {"precone": 0.0, "flap_damping": 0.0, "lag_damping": 0.0, "flap_outboard_fraction": 0.9}
    return random_rotor(5, n_blades=n_blades, **(NO_LINKAGES | NO_OFFSETS | flat | changes)).package


def in_vacuum(rotor, collective=0.4, airspeed=0.0, **options):
    """Flap and lag of a rotor whose gimbal and hub are held."""
    operation = pp.Operation(
        rotor_speed=SPEED, density=0.0, speed_of_sound=SPEED_OF_SOUND, trim={"collective": collective}
    )
    options = {"airloads": "none", "pitch": "rigid", "locked": ("gimbal",)} | options
    return pp.rotor_model(rotor, operation, airspeed, **options).submodel(BLADES)


def tabulated(rotor, frequencies, **where):
    return in_vacuum(rotor, structure="tabulated", frequencies=frequencies, **where)


def per_rev(model):
    return model.modes().frequency.values / SPEED


def in_fixed_frame(collective, cyclic):
    """A blade motion at ν per rev is at ν in the collective and at |ν − 1| and ν + 1 in the cyclic coordinates."""
    return [collective, abs(cyclic - 1), cyclic + 1]


def assert_has_frequencies(model, flap, lag, cyclic_flap=None):
    cyclic_flap = flap if cyclic_flap is None else cyclic_flap
    expected = sorted(in_fixed_frame(flap, cyclic_flap) + in_fixed_frame(lag, lag))
    assert np.allclose(per_rev(model), expected, rtol=0, atol=1e-12)


# Without the flap-lag stiffness


def springs_in_series(rotor, turn):
    """Stiffness of hub springs and of blade springs turned by the pitch, by adding their flexibilities."""
    softness = np.array([1 / rotor.flap_stiffness, 1 / rotor.lag_stiffness])
    outboard = np.array([rotor.flap_outboard_fraction, rotor.lag_outboard_fraction])
    c, s = np.cos(turn), np.sin(turn)
    blade = np.array([[c, -s], [s, c]])
    return np.linalg.inv(np.diag((1 - outboard) * softness) + blade @ np.diag(outboard * softness) @ blade.T)


@pytest.mark.parametrize("n_blades", [3, 4])
def test_diagonal_springs_lack_the_flap_lag_stiffness_alone(n_blades):
    rotor = flat_rotor(n_blades)
    coupled, diagonal = in_vacuum(rotor), in_vacuum(rotor, structure="diagonal")
    flap_lag = springs_in_series(rotor, 0.4 + rotor.structural_pitch_offset)[0, 1]
    blades = np.kron([[0, 1], [1, 0]], np.diag([n_blades, n_blades / 2, n_blades / 2]))
    assert np.allclose(
        coupled.K - diagonal.K, flap_lag * blades, rtol=0, atol=1e-12 * np.abs(coupled.K).max()
    )
    assert abs(flap_lag) > 1e-2 * rotor.flap_stiffness
    assert np.array_equal(coupled.M, diagonal.M)
    assert np.array_equal(coupled.C, diagonal.C)


def without_flap_with_lag(rotor, flap, lag, turn):
    """Energy of the hinge springs, less what flap and lag share."""
    still = Motion(0.0)
    return hinge_spring_energy(rotor, flap, still, turn) + hinge_spring_energy(rotor, still, lag, turn)


@pytest.mark.parametrize("name", ["windmilling", "powered, tables"])
def test_diagonal_springs_in_trim_pitch_and_stability(name, monkeypatch):
    """Of a bent blade in the air, with pitch dynamics: the trim balances, and the matrices follow from the energy."""
    monkeypatch.setattr(nonlinear_rotor, "hinge_spring_energy", without_flap_with_lag)
    case = Case(**CASES[name])
    model = case.model(structure="diagonal", airloads="none")
    assert_balanced(case, model)
    assert_model_matches(model, expected_matrices(rows_in_vacuum, case.pair, model), case.pair, 1e-10)


def assert_balanced(case, model):
    terms = np.array(steady_rows(case, model))
    balanced = [FLAP, LAG, PITCH] + [AZIMUTH] * (case.operation.trim == "windmill")
    largest = np.abs(terms).max(axis=0)
    largest[AZIMUTH] = largest[FLAP]  # a torque of the air alone, zero by cancellation along the blade
    assert (np.abs(terms.sum(axis=0))[balanced] < 1e-11 * largest[balanced]).all()


def test_diagonal_springs_couple_no_flap_or_lag_of_a_flat_blade():
    model = in_vacuum(flat_rotor(), structure="diagonal")
    flap, lag = slice(0, 3), slice(3, 6)
    for matrix in (model.M, model.C, model.K):
        assert not matrix[flap, lag].any()
        assert not matrix[lag, flap].any()


# Tabulated frequencies


@pytest.mark.parametrize("n_blades", [3, 4])
@pytest.mark.parametrize(("flap", "lag"), [(1.1, 0.6), (1.85, 1.3), (1.02, 2.4)])
def test_numbers_are_the_rotating_frequencies(n_blades, flap, lag):
    model = tabulated(flat_rotor(n_blades), pp.BladeFrequencies(at_rotor_speed=SPEED, flap=flap, lag=lag))
    assert_has_frequencies(model, flap, lag)


AT = np.array([0.1, 0.4, 0.9])
FLAP_TABLE, LAG_TABLE = np.array([1.05, 1.2, 1.3]), np.array([1.8, 1.5, 1.2])


@pytest.mark.parametrize("against", ["collective", "airspeed"])
def test_tables_hold_at_their_entries_and_beyond_their_ends(against):
    frequencies = pp.BladeFrequencies(
        at_rotor_speed=SPEED, flap=FLAP_TABLE, lag=LAG_TABLE, against=against, at=AT
    )
    for at, entry in ((0.1, 0), (0.4, 1), (0.9, 2), (-0.3, 0), (1.2, 2)):
        if against == "airspeed" and at < 0:
            continue
        model = tabulated(flat_rotor(), frequencies, **{against: at})
        assert_has_frequencies(model, FLAP_TABLE[entry], LAG_TABLE[entry])


@pytest.mark.parametrize("against", ["collective", "airspeed"])
def test_tables_are_smooth_between_their_entries(against):
    """No overshoot, and no kink: the slope at an entry is the same from both sides."""
    curve = np.array([1.1, 1.1, 1.7, 1.7])
    frequencies = pp.BladeFrequencies(
        at_rotor_speed=SPEED, flap=curve, lag=2.0, against=against, at=[0.0, 0.3, 0.6, 0.9]
    )

    def flap(at):
        squared = tabulated(flat_rotor(), frequencies, **{against: at})
        return np.sqrt(squared.K[..., 0, 0] / squared.M[..., 0, 0]) / SPEED

    between = flap(np.linspace(0.0, 0.9, 91))
    assert between.min() > 1.1 - 1e-12 and between.max() < 1.7 + 1e-12
    assert (np.diff(between) > -1e-12).all()
    for entry in (0.3, 0.6):
        left, here, right = flap(entry + np.array([-1e-5, 0.0, 1e-5]))
        assert abs((here - left) - (right - here)) < 1e-3 * 1e-5


@pytest.mark.parametrize("against", ["collective", "airspeed"])
def test_functions_are_taken_at_every_point(against):
    frequencies = pp.BladeFrequencies(
        at_rotor_speed=SPEED,
        flap=lambda at: 1.05 + 0.3 * at**2,
        lag=lambda at: 1.9 - np.sin(at),
        against=against,
    )
    points = np.array([0.05, 0.31, 0.77])
    rotor = flat_rotor()
    batch = tabulated(rotor, frequencies, **{against: points})
    for place, at in enumerate(points):
        single = tabulated(rotor, frequencies, **{against: at})
        assert_has_frequencies(single, 1.05 + 0.3 * at**2, 1.9 - np.sin(at))
        assert np.allclose(batch.K[place], single.K, rtol=1e-14)


def test_airspeed_and_collective_are_not_mistaken_for_each_other():
    by_speed = pp.BladeFrequencies(
        at_rotor_speed=SPEED, flap=lambda v: 1 + v / 100, lag=2.0, against="airspeed"
    )
    by_pitch = pp.BladeFrequencies(at_rotor_speed=SPEED, flap=lambda pitch: 1 + pitch, lag=2.0)
    assert_has_frequencies(tabulated(flat_rotor(), by_speed, collective=0.7, airspeed=40.0), 1.4, 2.0)
    assert_has_frequencies(tabulated(flat_rotor(), by_pitch, collective=0.7, airspeed=40.0), 1.7, 2.0)


@pytest.mark.parametrize("n_blades", [3, 4])
def test_cyclic_flap_may_stand_for_the_gimbal(n_blades):
    """The XV-15 of AIAA-2002-1604: coning at 1.85 per rev, the gimbal at 1.0355."""
    frequencies = pp.BladeFrequencies(at_rotor_speed=SPEED, flap=1.85, cyclic_flap=1.0355, lag=1.3)
    assert_has_frequencies(tabulated(flat_rotor(n_blades), frequencies), 1.85, 1.3, cyclic_flap=1.0355)


def test_cyclic_flap_may_be_tabulated_too():
    frequencies = pp.BladeFrequencies(
        at_rotor_speed=SPEED, flap=FLAP_TABLE, cyclic_flap=[1.01, 1.03, 1.07], lag=1.3, at=AT
    )
    for at, flap, cyclic in zip(AT, FLAP_TABLE, (1.01, 1.03, 1.07), strict=True):
        assert_has_frequencies(tabulated(flat_rotor(), frequencies, collective=at), flap, 1.3, cyclic)


def test_cyclic_flap_like_the_collective_changes_nothing():
    same, alone = (
        pp.BladeFrequencies(at_rotor_speed=SPEED, flap=1.2, lag=1.3, **more)
        for more in ({"cyclic_flap": 1.2}, {})
    )
    actual, expected = tabulated(flat_rotor(), same), tabulated(flat_rotor(), alone)
    assert np.allclose(actual.K, expected.K, rtol=1e-14)


def test_the_springs_of_the_rotor_no_longer_matter():
    frequencies = pp.BladeFrequencies(at_rotor_speed=40.0, flap=FLAP_TABLE, lag=LAG_TABLE, at=AT)
    case = Case(**CASES["powered"])
    given = {"structure": "tabulated", "frequencies": frequencies}
    other = {
        "flap_stiffness": 1e5,
        "lag_stiffness": 3e6,
        "flap_outboard_fraction": 0.0,
        "structural_pitch_offset": 0.2,
    }
    stiff = replace(case.pair.package, **other)
    here, there = (
        pp.rotor_model(rotor, case.operation, 110.0, **given) for rotor in (case.pair.package, stiff)
    )
    for name in "MCK":
        assert np.array_equal(getattr(here, name), getattr(there, name))


def tabulated_energy(frequencies):
    """½ K_β β² + ½ K_ζ ζ² of springs that make up what centrifugal force leaves of the frequencies at zero cone."""

    def energy(rotor, flap, lag, turn):
        at = rotor.collective
        flap_arm = np.maximum(rotor.station - rotor.flap_hinge_offset, 0)
        lag_arm = np.maximum(rotor.station - rotor.lag_hinge_offset, 0)
        centrifugal_flap = rotor.mass @ (rotor.station * flap_arm)
        centrifugal_lag = rotor.lag_hinge_offset * rotor.mass @ lag_arm
        flap_inertia, lag_inertia = rotor.mass @ flap_arm**2, rotor.mass @ lag_arm**2
        flap_spring = flap_inertia * frequencies.flap(at) ** 2 - centrifugal_flap
        lag_spring = lag_inertia * frequencies.lag(at) ** 2 - centrifugal_lag
        return 0.5 * frequencies.at_rotor_speed**2 * (flap_spring * flap * flap + lag_spring * lag * lag)

    return energy


@pytest.mark.parametrize("share", [1.0, 1.4])
@pytest.mark.parametrize("name", ["windmilling", "powered, tables"])
def test_tabulated_springs_in_trim_and_stability(name, share, monkeypatch):
    """Of a bent blade in the air: the trim balances at its own collective, and the springs do not turn."""
    case = Case(**CASES[name])
    frequencies = pp.BladeFrequencies(
        at_rotor_speed=share * case.pair.rotor_speed,
        flap=lambda at: 1.3 - 0.2 * at,
        lag=lambda at: 1.9 - 0.6 * at,
    )
    monkeypatch.setattr(nonlinear_rotor, "hinge_spring_energy", tabulated_energy(frequencies))
    model = case.model(structure="tabulated", frequencies=frequencies, airloads="none")
    assert_balanced(case, model)
    assert_model_matches(model, expected_matrices(rows_in_vacuum, case.pair, model), case.pair, 1e-10)


# At another rotor speed


def coefficients(rotor):
    """e S/I of flap and lag by the mass integrals of the rotor: what centrifugal force adds to a square per rev."""
    flap = rotor.flap_hinge_offset * rotor.flap_first_moment / rotor.flap_inertia
    return 1 + flap, rotor.lag_hinge_offset * rotor.lag_first_moment / rotor.lag_inertia


@pytest.mark.parametrize("share", [0.5, 1.0, 1.7])
@pytest.mark.parametrize("n_blades", [3, 4])
def test_a_spring_holds_at_another_rotor_speed(n_blades, share):
    """ν² = ν_c² + K/IΩ²: K/I is what ν² - ν_c² at the stated speed leaves, times the square of that speed."""
    rotor, flap, cyclic, lag = flat_rotor(n_blades), 1.4, 1.6, 1.3
    frequencies = pp.BladeFrequencies(at_rotor_speed=SPEED * share, flap=flap, cyclic_flap=cyclic, lag=lag)
    of_flap, of_lag = coefficients(rotor)
    flap, cyclic = (np.sqrt(of_flap + (nu**2 - of_flap) * share**2) for nu in (flap, cyclic))
    lag = np.sqrt(of_lag + (lag**2 - of_lag) * share**2)
    assert_has_frequencies(tabulated(rotor, frequencies), flap, lag, cyclic_flap=cyclic)


def test_springs_given_by_their_frequencies_are_the_springs():
    """Uncoupled springs of a rotor, told by the frequencies that they make at one speed, hold at five others."""
    rotor = flat_rotor(flap_outboard_fraction=0.0, lag_outboard_fraction=0.0)
    of_flap, of_lag = coefficients(rotor)
    stated = 1.3 * SPEED
    flap = np.sqrt(of_flap + rotor.flap_stiffness / (rotor.flap_inertia * stated**2))
    lag = np.sqrt(of_lag + rotor.lag_stiffness / (rotor.lag_inertia * stated**2))
    table = pp.BladeFrequencies(at_rotor_speed=stated, flap=flap, lag=lag)
    speeds = np.array([20.0, 35.0, 47.0, 61.1, 75.0])
    operation = pp.Operation(
        rotor_speed=speeds, density=1.1, speed_of_sound=SPEED_OF_SOUND, trim={"collective": 0.9}
    )
    options = {"airloads": "full", "pitch": "rigid"}
    by_springs = pp.rotor_model(rotor, operation, 60.0, **options)
    by_table = pp.rotor_model(rotor, operation, 60.0, structure="tabulated", frequencies=table, **options)
    assert by_springs.trim.converged.all() and by_springs.K.shape[0] == len(speeds)
    for name in "MCK":
        one, other = getattr(by_springs, name), getattr(by_table, name)
        assert np.abs(one - other).max() < 1e-11 * np.abs(one).max(), name


def springs_that_keep_their_coupling(frequencies):
    """½ {β ζ} [K_table + K_eff(turn) - K_eff(turn at the collective)] {β ζ}ᵀ, the rotor's own springs in K_eff."""

    def energy(rotor, flap, lag, turn):
        rigid = Motion(rotor.collective + rotor.structural_pitch_offset)
        turned = hinge_spring_energy(rotor, flap, lag, turn)
        return (
            tabulated_energy(frequencies)(rotor, flap, lag, turn)
            + turned
            - hinge_spring_energy(rotor, flap, lag, rigid)
        )

    return energy


@pytest.mark.parametrize("name", ["windmilling", "powered, tables"])
def test_springs_of_a_table_that_keep_the_pitch_coupling(name, monkeypatch):
    """Against the energy of that blade: trim, and every entry of M, C and K of flap, lag, pitch, gimbal and azimuth."""
    case = Case(**CASES[name])
    frequencies = pp.BladeFrequencies(
        at_rotor_speed=1.2 * case.pair.rotor_speed,
        flap=lambda at: 1.3 - 0.2 * at,
        lag=lambda at: 1.9 - 0.6 * at,
        pitch_coupling="springs",
    )
    monkeypatch.setattr(nonlinear_rotor, "hinge_spring_energy", springs_that_keep_their_coupling(frequencies))
    model = case.model(structure="tabulated", frequencies=frequencies, airloads="none")
    assert_balanced(case, model)
    assert_model_matches(model, expected_matrices(rows_in_vacuum, case.pair, model), case.pair, 1e-10)


@pytest.mark.parametrize("pitch_coupling", ["none", "springs"])
def test_a_complex_step_goes_through_the_springs(pitch_coupling):
    """Derivatives of K with rotor speed, precone and control stiffness, beside central differences of whole trims."""
    case = Case(**CASES["windmilling"])
    table = pp.BladeFrequencies(
        at_rotor_speed=SPEED, flap=FLAP_TABLE + 0.3, lag=LAG_TABLE, at=AT, pitch_coupling=pitch_coupling
    )

    def stiffness(**changes):
        rotor = replace(case.pair.package, **{k: v for k, v in changes.items() if k != "rotor_speed"})
        operation = replace(
            case.operation, rotor_speed=changes.get("rotor_speed", case.operation.rotor_speed)
        )
        model = pp.rotor_model(rotor, operation, case.airspeed, structure="tabulated", frequencies=table)
        assert np.all(model.trim.converged)
        return model.K

    for name in ("rotor_speed", "precone", "control_stiffness"):
        value = getattr(case.operation if name == "rotor_speed" else case.pair.package, name)
        exact = stiffness(**{name: value + 1e-30j}).imag / 1e-30
        step = 1e-4 * value
        high, low = stiffness(**{name: np.array([value + step, value - step])})
        difference = (high - low) / (2 * step)
        assert np.abs(exact - difference).max() < 2e-6 * np.abs(difference).max(), name


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({"flap": 1.0, "lag": 1.3}, ["flap", "cyclic flap"]),
        ({"flap": 1.9, "lag": 0.05}, ["lag"]),
        ({"flap": 1.9, "lag": 1.3, "cyclic_flap": 1.0}, ["cyclic flap"]),
        ({"flap": 1.9, "lag": 1.3}, []),
    ],
)
def test_a_frequency_below_that_of_centrifugal_force_is_told(given, named):
    """No blade has such a spring, whose stiffness is negative: the points say so, and keep the frequency."""
    frequencies = pp.BladeFrequencies(at_rotor_speed=SPEED, **given)
    warning = str(tabulated(flat_rotor(), frequencies).trim.warning)
    rule = "the given {} frequency is below that of centrifugal force alone, so its spring is negative"
    assert [rule.format(name) in warning.split("; ") for name in ("flap", "cyclic flap", "lag")] == [
        name in named for name in ("flap", "cyclic flap", "lag")
    ]


# What is refused

FLAT = {"flap": 1.1, "lag": 1.2}
BAD_TABLES = {
    "no rotor speed": (
        FLAT | {"at_rotor_speed": np.nan},
        "^at_rotor_speed: is missing; frequencies per revolution hold at one rotor speed",
    ),
    "rotor speed as text": (
        FLAT | {"at_rotor_speed": "458 rpm"},
        "at_rotor_speed = 458 rpm: must be a number",
    ),
    "rotor at rest": (FLAT | {"at_rotor_speed": 0.0}, "at_rotor_speed = 0.0: must be above zero"),
    "rotor speed without end": (FLAT | {"at_rotor_speed": np.inf}, "at_rotor_speed = inf: must be finite"),
    "rotor speeds": (FLAT | {"at_rotor_speed": [40.0, 50.0]}, "at_rotor_speed.*: must be one number"),
    "pitch coupling": (
        FLAT | {"pitch_coupling": "some"},
        "pitch_coupling = some: must be one of none, springs",
    ),
    "against": (
        {"flap": 1.1, "lag": 1.2, "against": "thrust"},
        "against = thrust: must be one of collective, airspeed",
    ),
    "at falls": ({"flap": [1, 2], "lag": 1.2, "at": [0.4, 0.1]}, r"at = \[0.4, 0.1\]: must increase"),
    "at is no list": ({"flap": 1.1, "lag": 1.2, "at": 0.4}, "at = 0.4: must increase"),
    "at is no number": ({"flap": [1, 2], "lag": 1.2, "at": [0.1, np.nan]}, "at"),
    "at has one entry": ({"flap": [1.1], "lag": 1.2, "at": [0.1]}, "at"),
    "no at": (
        {"flap": [1.1, 1.2], "lag": 1.2},
        r"flap = array of shape \(2,\): must have one entry for each of at",
    ),
    "lengths": (
        {"flap": 1.1, "lag": [1, 2, 3], "at": [0, 1]},
        r"lag = array of shape \(3,\): must have one entry",
    ),
    "negative": ({"flap": -1.1, "lag": 1.2}, "flap = -1.1: must be above zero"),
    "zero": ({"flap": 1.1, "lag": 0.0}, "lag = 0.0: must be above zero"),
    "not a number": (
        {"flap": 1.1, "lag": 1.2, "cyclic_flap": np.nan},
        "cyclic_flap = nan: must be above zero",
    ),
}


@pytest.mark.parametrize("bad", BAD_TABLES)
def test_tables_that_make_no_sense_are_refused(bad):
    given, message = BAD_TABLES[bad]
    with pytest.raises(pp.InputError, match=message):
        pp.BladeFrequencies(**{"at_rotor_speed": SPEED} | given)


@pytest.mark.parametrize("structure", ["coupled", "diagonal"])
def test_frequencies_go_with_tabulated_structure_only(structure):
    frequencies = pp.BladeFrequencies(at_rotor_speed=SPEED, flap=1.1, lag=1.2)
    with pytest.raises(pp.InputError, match='must be BladeFrequencies, with structure="tabulated" only'):
        in_vacuum(flat_rotor(), structure=structure, frequencies=frequencies)
    for missing in (None, 1.1):
        with pytest.raises(pp.InputError, match=r"frequencies.*must be BladeFrequencies"):
            in_vacuum(flat_rotor(), structure="tabulated", frequencies=missing)


def test_unknown_structures_are_refused_with_the_known_ones():
    with pytest.raises(pp.InputError, match="structure = stiff: must be one of coupled, diagonal, tabulated"):
        in_vacuum(flat_rotor(), structure="stiff")
