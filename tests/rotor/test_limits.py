"""Inputs at their limits: nothing there, nothing moving, very stiff, very soft; and no jump anywhere between.

A warning fails any test. What is very stiff comes to what does not move, as 1/stiffness; what is very soft comes to
what has no spring, as the stiffness.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import Phase, assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment

import proprotor as pp
from proprotor.model.first_order import state_matrix
from proprotor.stability.modes import decomposition
from tests.c81_files import made_up_tables
from tests.rotors import flights, random_support, seeds

any_rotor = settings(max_examples=12, derandomize=True, deadline=None, phases=[Phase.generate])
AIRSPEED = 100.0
CASE = pp.load_case("xv15-uncoupled")
ROTOR, OPERATION = CASE.rotor, CASE.operation
BASE = CASE.linearize(AIRSPEED)


def entries(model):
    """M, C and K one after another, by what inertia at 1/rev would put there."""
    size, speed = np.sqrt(np.diag(BASE.M)), OPERATION.rotor_speed
    parts = [getattr(model, name) / np.outer(size, size) / speed**power for power, name in enumerate("MCK")]
    return np.concatenate([part.reshape(*part.shape[:-2], -1) for part in parts], axis=-1)


def slow_roots(model, count):
    """The eigenvalues of the lowest `count` states, per rev."""
    values = np.linalg.eigvals(state_matrix(model)) / OPERATION.rotor_speed
    return values[np.argsort(np.abs(values))][:count]


def distance(some, others):
    """The largest distance of roots from those they are nearest to, one to one."""
    away = np.abs(some[:, None] - others)
    return away[linear_sum_assignment(away)].max()


# Nothing there ------------------------------------------------------------------------------------


@any_rotor
@given(flights(), seeds)
def test_a_rotor_without_precone_offsets_and_couplings(flight, seed):
    nothing = dict.fromkeys(
        ("precone", "structural_pitch_offset", "pitch_gimbal_coupling", "gimbal_stiffness", "root_cutout"),
        0.0,
    )
    flight = flight.without_dampers().with_rotor(**nothing)
    model = flight.on(random_support(flight, seed))
    assume(model.trim.converged)
    assert all(np.isfinite(getattr(model, name)).all() for name in "MCK")


@pytest.mark.parametrize(
    "name", ["precone", "structural_pitch_offset", "pitch_gimbal_coupling", "root_cutout"]
)
def test_next_to_nothing_is_next_to_none(name):
    none, little, twice = (
        entries(replace(CASE, rotor=replace(ROTOR, **{name: value})).linearize(AIRSPEED))
        for value in (0.0, 1e-7, 2e-7)
    )
    step = np.abs(little - none).max()
    assert 0 < step < 1e-4
    assert np.abs(twice - 2 * little + none).max() < 1e-3 * step + 1e-12


@pytest.mark.parametrize("kind", ["full", "lift-slope", "none"])
@pytest.mark.parametrize("pitch", ["dynamic", "coupling", "rigid"])
def test_no_airspeed_is_the_limit_of_low_airspeeds(kind, pitch):
    """With the collective of a rotor at rest in still air; a rotor that windmills there is none."""
    case = replace(CASE, operation=replace(OPERATION, trim={"collective": 0.05}))
    model = case.linearize(np.array([0.0, 1e-9, 1e-4, 1e-3]), airloads=kind, pitch=pitch)
    assert model.trim.converged.all(), model.trim.reason
    found = np.concatenate([getattr(model, name).reshape(4, -1) for name in "MCK"], axis=-1)
    assert np.isfinite(found).all()
    scale = np.abs(found).max()
    away = np.abs(found - found[0]).max(axis=-1) / scale
    assert away[1] < 1e-9 and away[2] < 1e-3 and away[3] < 1e-2
    windmilling = CASE.linearize(0.0, airloads=kind, pitch=pitch)
    assert not windmilling.trim.converged and windmilling.trim.reason


def assert_numbers_or_a_reason(model):
    """A point has its matrices and modes, or says why not."""
    converged = bool(model.trim.converged)
    assert converged == (model.trim.reason == "")
    numbers = [np.isfinite(getattr(model, name)).all() for name in "MCK"]
    assert all(numbers) if "without any mass" in str(model.trim.reason) else numbers == [converged] * 3
    assert np.isfinite(decomposition(model).values).all() == converged
    assume(converged)


@any_rotor
@given(
    flights(),
    seeds,
    st.sampled_from(["full", "lift-slope", "none"]),
    st.sampled_from(["dynamic", "coupling", "rigid"]),
)
def test_any_rotor_on_any_support_at_no_airspeed(flight, seed, airloads, pitch):
    operation = replace(flight.operation, trim={"collective": 0.05})
    flight = replace(flight, operation=operation, airspeed=0.0)
    assert_numbers_or_a_reason(flight.on(random_support(flight, seed), airloads=airloads, pitch=pitch))


# Stiff and soft -----------------------------------------------------------------------------------

STIFF = {
    "flap": ("flap_stiffness", "flap_inertia"),
    "lag": ("lag_stiffness", "lag_inertia"),
    "gimbal": ("gimbal_stiffness", "blade_inertia"),
    "pitch": ("control_stiffness", "pitch_inertia"),
}


# Springs inboard of the pitch bearing act on flap and on lag; those outboard turn with the pitch, and the stiffest flap
# spring leaves the blade free to flap and lag along its chord.
HUB_SPRINGS = replace(CASE, rotor=replace(ROTOR, flap_outboard_fraction=0.0, lag_outboard_fraction=0.0))


def with_spring(case, name, per_rev_squared):
    """The case with one spring, by what gives the coordinate 1/rev."""
    field, inertia = STIFF[name]
    stiffness = per_rev_squared * getattr(ROTOR, inertia) * OPERATION.rotor_speed**2
    return replace(case, rotor=replace(case.rotor, **{field: stiffness})).linearize(AIRSPEED)


@pytest.mark.parametrize("name", STIFF)
def test_a_very_stiff_spring_locks_its_hinge(name):
    """Ten times as stiff, a tenth from the locked hinge."""
    locked = HUB_SPRINGS.linearize(AIRSPEED, locked=[name])
    expected = np.linalg.eigvals(state_matrix(locked)) / OPERATION.rotor_speed
    away = [
        distance(slow_roots(with_spring(HUB_SPRINGS, name, factor), len(expected)), expected)
        for factor in (1e5, 1e6)
    ]
    assert away[0] < 1e-3
    assert away[1] / away[0] == pytest.approx(0.1, rel=0.05)


@pytest.mark.parametrize("name", STIFF)
@pytest.mark.parametrize("stiffness", [1e7, 1e9, 1e12, 1e20, 1e60])
def test_a_spring_may_be_as_stiff_as_can_be(name, stiffness):
    """Where springs turn with the pitch nothing may be left of the loads in the digits: such a point has its reason."""
    model = with_spring(HUB_SPRINGS, name, stiffness)
    assert model.trim.converged
    locked = HUB_SPRINGS.linearize(AIRSPEED, locked=[name])
    assert model.trim.collective == pytest.approx(float(locked.trim.collective), abs=1e-6)
    turning = with_spring(CASE, name, stiffness)
    assert bool(turning.trim.converged) == (turning.trim.reason == "")
    for one in (model, turning):
        assert all(np.isfinite(getattr(one, part)).all() == bool(one.trim.converged) for part in "MCK")
    assert turning.trim.converged or stiffness > 1e9


@any_rotor
@given(
    flights(),
    seeds,
    st.sampled_from(sorted(STIFF)),
    st.sampled_from([1e-20, 1e-9, 1e-4, 1e4, 1e8, 1e30]),
)
def test_any_spring_of_any_rotor_may_be_very_stiff_or_very_soft(flight, seed, name, per_rev_squared):
    field, inertia = STIFF[name]
    stiffness = per_rev_squared * getattr(flight.rotor, inertia) * flight.rotor_speed**2
    model = flight.with_rotor(**{field: stiffness}).on(random_support(flight, seed))
    assert_numbers_or_a_reason(model)


@pytest.mark.parametrize("name", ["flap", "lag", "gimbal"])
def test_a_very_soft_spring_is_none(name):
    """From 1e-4 of what would hold a blade at 1/rev down, a tenth of the spring is a tenth of the way."""
    found = [entries(with_spring(CASE, name, share)) for share in (0.0, 1e-5, 1e-4, 1e-20)]
    assert all(np.isfinite(one).all() for one in found)
    tenth, whole, hardly = (np.abs(one - found[0]).max() for one in found[1:])
    assert whole > 0
    assert tenth / whole == pytest.approx(0.1, rel=0.02)
    assert hardly < 1e-12


# Hinges at the centre -----------------------------------------------------------------------------


@any_rotor
@given(flights(hinges="at centre"), seeds)
def test_what_moves_the_blade_as_another_coordinate_does_is_told(flight, seed):
    """Flapping about the centre is the gimbal's tilt, and lagging about it is the rotor's turning, once more.

    So it is with masses on the pitch axis: those beside it feel the turn of a section as well.
    """
    flight = flight.with_rotor(offset_mass=None)
    support = random_support(flight, seed)
    whole, constant, hinged, both = (
        flight.on(support, **options)
        for options in (
            {},
            {"rotor_speed": "constant"},
            {"locked": ["gimbal"]},
            {"locked": ["gimbal"], "rotor_speed": "constant"},
        )
    )
    assume(both.trim.converged)
    for model, told in ((whole, "azimuth"), (whole, "gimbal_1c"), (constant, "flap_1s"), (hinged, "lag_0")):
        assert not model.trim.converged and np.isfinite(model.M).all()
        assert told in str(model.trim.reason) and "without any mass" in str(model.trim.reason)
    assert np.isfinite(np.linalg.eigvals(state_matrix(both))).all()


def test_a_hinge_at_the_centre_spoils_no_other_point():
    """Of a batch."""
    offsets = np.array([0.0, 0.08]) * ROTOR.radius

    def case(place):
        return replace(CASE, rotor=with_hinges(offsets[place], offsets[place]))

    both, alone = (case(place) for place in (slice(None), 1))
    model, alone = both.linearize(AIRSPEED), alone.linearize(np.array([AIRSPEED]))
    assert list(model.trim.converged) == [False, True]
    np.testing.assert_array_equal(model.K[1], alone.K[0])
    modes = model.modes()
    assert "flap_1c" in str(modes.reason[0].values) and np.isnan(modes.eigenvalue[0]).all()
    np.testing.assert_array_equal(modes.eigenvalue[1], alone.modes().eigenvalue[0])
    swept = case(0).sweep([90.0, AIRSPEED])
    assert all("without any mass" in reason for reason in swept.reason.values) and not swept.sizes["mode"]
    assert case(0).sweep([90.0, AIRSPEED], locked=["gimbal"], rotor_speed="constant").sizes["mode"] > 10


@pytest.mark.parametrize("factor", [1e-9, 1e9])
def test_supports_that_hold_everything_or_nothing(factor):
    """A stiff support leaves the rotor on a rigid hub; a soft one lets it go, and neither is no number."""
    support = replace(
        CASE.support, stiffness=CASE.support.stiffness * factor, damping=0 * CASE.support.damping
    )
    model = replace(CASE, support=support).linearize(AIRSPEED)
    values = np.linalg.eigvals(state_matrix(model))
    assert np.isfinite(values).all()
    if factor > 1:
        free = [name for name in BASE.dofs if name not in CASE.support.names]
        expected = np.linalg.eigvals(state_matrix(BASE.submodel(free))) / OPERATION.rotor_speed
        assert distance(slow_roots(model, len(expected)), expected) < 1e-5


# No jumps -----------------------------------------------------------------------------------------

STEPS = 10.0 ** np.array([-3, -4, -6, -8])
ROUNDING = 1e-11  # of the entries below, where trim, quadrature and slopes have done their part
R = ROTOR.radius
STATIONS = R * np.array([0.0, 0.25, 0.6, 1.0])
TWIST = {"twist": (STATIONS, np.array([0.45, 0.25, 0.08, -0.1]))}
CHORD = {"chord": (STATIONS, np.array([0.5, 0.42, 0.36, 0.33]))}
OFFSET = 0.09 * R


def with_hinges(flap, lag, **changes):
    """A blade with hinges, and the mass integrals that belong to them; its mass per length has a corner at OFFSET."""
    mass = np.array([8.0, 12.0, 3.0, 6.0])
    station = np.array([0.0, OFFSET, 0.5 * R, R])
    given = {
        name: getattr(ROTOR, name)
        for name in (
            *(
                "n_blades",
                "radius",
                "root_cutout",
                "precone",
                "flap_stiffness",
                "lag_stiffness",
                "gimbal_stiffness",
            ),
            *("flap_outboard_fraction", "lag_outboard_fraction", "pitch_gimbal_coupling", "pitch_inertia"),
            *("control_stiffness", "chord", "twist", "airfoil"),
        )
    }
    return pp.Rotor.from_mass_distribution(
        station, mass, flap_hinge_offset=flap, lag_hinge_offset=lag, **given
    )


# A number at which something changes its kind, and the rotor at a number; True where it may also be below.
SPECIAL = {
    "both hinges at the root cutout": (ROTOR.root_cutout, lambda x: with_hinges(x, x), True),
    "flap hinge at the root cutout": (ROTOR.root_cutout, lambda x: with_hinges(x, 0.2 * R), True),
    "lag hinge at the root cutout": (ROTOR.root_cutout, lambda x: with_hinges(0.0, x), True),
    "lag hinge at the flap hinge": (0.1, lambda x: with_hinges(0.1, x), False),
    "hinges at the centre": (0.0, lambda x: with_hinges(x, x), False),
    "hinges at a station of the twist": (STATIONS[1], lambda x: with_hinges(x, x, **TWIST), True),
    "hinges at a station of the chord": (STATIONS[1], lambda x: with_hinges(x, x, **CHORD), True),
    "flap hinge at a corner of the mass": (OFFSET, lambda x: with_hinges(x, 0.2 * R), True),
    "lag hinge at a corner of the mass": (OFFSET, lambda x: with_hinges(0.0, x), True),
    "root cutout at a station of the twist": (
        STATIONS[1],
        lambda x: replace(ROTOR, root_cutout=x, **TWIST),
        True,
    ),
    "root cutout at a station of the chord": (
        STATIONS[1],
        lambda x: replace(ROTOR, root_cutout=x, **CHORD),
        True,
    ),
    "no root cutout": (0.0, lambda x: replace(ROTOR, root_cutout=x), False),
    "no precone": (0.0, lambda x: replace(ROTOR, precone=x), True),
    "no pitch-gimbal coupling": (0.0, lambda x: replace(ROTOR, pitch_gimbal_coupling=x), True),
    "no structural offset": (0.0, lambda x: replace(ROTOR, structural_pitch_offset=x), True),
    "all flexibility outboard": (1.0, lambda x: replace(ROTOR, flap_outboard_fraction=2 - x), False),
    "no flexibility outboard": (0.0, lambda x: replace(ROTOR, lag_outboard_fraction=x), False),
    "no spring": (0.0, lambda x: replace(ROTOR, lag_stiffness=1e5 * x), False),
    "no twist": (0.0, lambda x: replace(ROTOR, twist=x), True),
}


def assert_no_jump(at, special, below, slope=None):
    """What is `at` a number changes in proportion to a step away from it, for steps of any size, on either side.

    The proportion may be up to 30 times that of the largest steps, for what bends; a root in place of a proportion
    would be ten thousand times that.
    """
    here = at(special)
    assert np.isfinite(here).all()
    for side in (1, -1) if below else (1,):
        change = np.array([np.abs(at(special + side * step) - here).max() for step in STEPS])
        steepest = max(change[:2] / STEPS[:2])
        assert (change <= 30 * steepest * STEPS + ROUNDING).all(), f"side {side}: {change}"


@pytest.mark.parametrize("name", SPECIAL)
@pytest.mark.parametrize(
    "options", [{}, {"equations": "published", "airloads": "lift-slope"}], ids=["full", "paper"]
)
def test_nothing_jumps_where_an_input_is_special(name, options):
    special, rotor_at, below = SPECIAL[name]
    assert_no_jump(
        lambda x: entries(replace(CASE, rotor=rotor_at(x)).linearize(AIRSPEED, **options)), special, below
    )


def test_nothing_jumps_where_angle_or_mach_number_are_at_a_knot_of_a_table():
    """Somewhere along the blade they always are; the collective and the airspeed sweep a section through them."""
    tables = {
        name: (np.deg2rad(alpha), mach, values) for name, (alpha, mach, values) in made_up_tables().items()
    }
    rotor = replace(ROTOR, airfoil=pp.AirfoilTable(**tables))
    collective = CASE.linearize(AIRSPEED).trim.collective

    def at_collective(x):
        operation = replace(OPERATION, trim={"collective": collective + x})
        return entries(replace(CASE, rotor=rotor, operation=operation).linearize(AIRSPEED))

    assert_no_jump(at_collective, 0.0, True)
    assert_no_jump(lambda x: entries(replace(CASE, rotor=rotor).linearize(AIRSPEED + x)), 0.0, True)


# Integrals of one blade belong together: alone they cannot be varied. Its hinges can, where its mass is distributed.
TOGETHER = (
    "flap_inertia",
    "lag_inertia",
    "blade_inertia",
    "flap_first_moment",
    "lag_first_moment",
    "hinge_offset",
)
INPUTS = [("xv15-uncoupled", path) for path in pp.design_inputs(CASE) if not path.endswith(TOGETHER)]
INPUTS += [("xv15-mass-distribution", f"rotor.{hinge}_hinge_offset") for hinge in ("flap", "lag")]


@pytest.mark.parametrize(("deck", "path"), INPUTS)
def test_every_input_of_a_deck_changes_the_matrices_without_a_jump(deck, path):
    """17 steps over a twentieth of the input: none is much larger than the others."""
    case = pp.load_case(deck)
    number = pp.design_inputs(case)[path].si
    share = np.linspace(-0.5, 0.497, 18)
    one_sided = (
        path.endswith("lag_hinge_offset") or (path.endswith("fraction") and number == 0) or number == 0
    )
    share = share - share[0] if one_sided else share
    share = -share - 0.5 if path.endswith(("flap_hinge_offset", "fraction")) and number else share
    found = entries(case.vary({path: number + 0.05 * (number or 0.02) * share}).linearize(AIRSPEED))
    assert np.isfinite(found).all()
    step = np.abs(np.diff(found, axis=0)).max(axis=-1)
    assert step.max() <= 4 * np.median(step) + ROUNDING
