"""A design is in a batch what it is alone, whatever the others of the batch are.

Designs are drawn from values at which something of the model comes or goes: a shaft that holds the azimuth or none,
parts of the drive train, hinges at the centre, springs, dampers and couplings of zero, a vacuum. What each of them has
alone is the expected value.
"""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from proprotor.model.first_order import state_matrix
from proprotor.stability.modes import decomposition, eigenvalues
from proprotor.study.sampling import points

SHAFT = "drive_train.shaft_stiffness"
TRAIN = {
    "drive_train.drive_inertia": "20 kg*m**2",
    "drive_train.drive_damping": "30 N*m*s/rad",
    SHAFT: "2e4 N*m/rad",
}
CASE = pp.load_case("xv15-uncoupled", TRAIN)
STATIONS = pp.load_case("xv15-mass-distribution", TRAIN)  # its integrals follow the hinges wherever these go
WING = pp.load_case("xv15-wing", TRAIN)
COMES_AND_GOES = {
    SHAFT: (0.0, 0.0, 3e3, 2e6),
    "drive_train.drive_inertia": (0.0, 25.0),
    "drive_train.drive_damping": (0.0, 40.0),
    "rotor.flap_hinge_offset": (0.0, 0.24),
    "rotor.lag_hinge_offset": (0.24, 0.42),
    "rotor.precone": (0.0, 0.04),
    "rotor.root_cutout": (0.0, 0.33),
    "rotor.flap_frequency": (0.0, 59.8),
    "rotor.gimbal_stiffness": (0.0, 17e3),
    "rotor.pitch_gimbal_coupling": (0.0, -0.268),
    "rotor.airfoil.drag": (0.0, 0.0065),
    "rotor.airfoil.moment": (0.0, -0.01),
    "operation.density": (0.0, 1.225, 1.225, 1.225),
}
OPTIONS = [
    {},
    {"airloads": "none"},
    {"equations": "published", "pitch": "coupling"},
    {"locked": ("gimbal",), "section_damping": True},
    {"rotor_speed": "constant"},
]
DESIGNS = 7
SPEED = 130.0
ALIKE = 1e-9  # of the largest: trims stop within rounding of each other, and eigenvalues follow them


def drawn(seed):
    """Values (designs,) by path; at least one design with a shaft and one without, both with a trim."""
    random = np.random.default_rng(seed)
    values = {path: random.choice(choice, DESIGNS) for path, choice in COMES_AND_GOES.items()}
    values[SHAFT][:2] = 0.0, 3e3
    values["operation.density"][:2] = 1.225
    return values


def alone(values, place):
    return {path: float(numbers[place]) for path, numbers in values.items()}


def by_size(values):
    values = values[~np.isnan(values)]
    return values[np.lexsort((values.imag.round(3), np.abs(values.real).round(3), np.abs(values).round(3)))]


def assert_same_roots(found, expected):
    """One to one, each within what rounding may do to it: a double root by its square root."""
    found, expected = (values[~np.isnan(values)] for values in (found, expected))
    assert len(found) == len(expected)
    if not len(expected):
        return
    largest = np.abs(expected).max()
    apart = np.abs(found[:, None] - expected)
    lone = np.sort(np.abs(expected[:, None] - expected), axis=1)[:, 1] > 1e-4 * largest
    assert np.all(apart.min(axis=0)[lone] <= ALIKE * largest)
    assert np.all(apart.min(axis=0) <= 1e-6 * largest)


@pytest.mark.parametrize("options", OPTIONS, ids=str)
@pytest.mark.parametrize("seed", [1, 2])
def test_a_design_has_alone_what_it_has_in_a_batch(seed, options):
    values = drawn(seed)
    batch = STATIONS.vary(values).linearize(SPEED, **options)
    together, space = decomposition(batch), batch.to_state_space()
    every, table = eigenvalues(batch), batch.modes()
    response = pp.frequency_response(batch, [0.5, 20.0])
    for place in range(DESIGNS):
        one = STATIONS.vary(alone(values, place)).linearize(SPEED, **options)
        assert batch.trim.reason[place] == one.trim.reason
        for name in "MCKB":
            np.testing.assert_allclose(
                getattr(batch, name)[place],
                getattr(one, name),
                rtol=1e-9,
                atol=1e-9 * scale(getattr(one, name)),
            )
        single = decomposition(one)
        assert_same_roots(every[place], single.values)
        assert_same_roots(together.values[place], single.values)
        assert_same_roots(table.eigenvalue.values[place], one.modes().eigenvalue.values)
        own = table.isel(airspeed=place)
        shares = own.participation.sum("dof").values
        assert np.allclose(shares[np.isfinite(own.eigenvalue.values)], 1)
        assert_same_system(space, place, one.to_state_space())
        single_response = pp.frequency_response(one, [0.5, 20.0])
        assert_same_response(response.isel(airspeed=place), single_response)
        growth = single.values.real.max()
        if (
            not abs(growth) < ALIKE * np.abs(single.values).max()
        ):  # the sign of a neutral root is one of rounding
            assert response.stable.values[place] == single_response.stable == (growth < 0)


def scale(numbers):
    return np.nan_to_num(np.abs(numbers)).max()


def assert_same_system(batch, place, one):
    """States and outputs that a design has alone; of those of the others, NaN, or the azimuth's rate besides it."""
    states = [batch.states.index(name) for name in one.states]
    outputs = [batch.outputs.index(name) for name in one.outputs]
    others = sorted(set(range(len(batch.states))) - set(states))
    for name, rows, columns in (("A", states, states), ("B", states, slice(None)), ("C", outputs, states)):
        own = getattr(batch, name)[place][rows][:, columns]
        np.testing.assert_allclose(own, getattr(one, name), rtol=1e-8, atol=1e-8 * scale(getattr(one, name)))
    np.testing.assert_allclose(batch.D[place][outputs], one.D, rtol=1e-8, atol=1e-8 * scale(one.D))
    assert np.isnan(batch.A[place][others]).all() and np.isnan(batch.A[place][:, others]).all()
    assert np.isnan(batch.B[place][others]).all() and np.isnan(batch.C[place][:, others]).all()
    assert set(batch.outputs) - set(one.outputs) <= {"azimuth", "azimuth rate"}


def assert_same_response(found, alone):
    own = found.sel(output=alone.output)
    np.testing.assert_allclose(
        own.response.values, alone.response.values, rtol=1e-6, atol=1e-9 * scale(alone.response.values)
    )


@pytest.mark.parametrize("seed", [1, 3])
def test_a_study_finds_for_a_design_what_it_finds_for_it_alone(seed):
    values = drawn(seed)
    quantities = ("eigenvalue", "least_stable", "trim", "vectors", "modes")
    speeds = [120.0, 140.0, 160.0]
    found = pp.study(STATIONS, points(values), speeds, quantities, workers=1)
    for place in range(DESIGNS):
        design = {path: [value] for path, value in alone(values, place).items()}
        one = pp.study(STATIONS, points(design), speeds, quantities, workers=1).isel(design=0)
        here = found.isel(design=place)
        for speed in range(len(speeds)):
            for name in ("eigenvalue", "mode_eigenvalue"):
                assert_same_roots(here[name].values[speed], one[name].values[speed])
        for name in ("growth_rate", "damping_ratio", "frequency", "collective", "coning", "thrust", "torque"):
            np.testing.assert_allclose(here[name], one[name], rtol=1e-6, atol=1e-9 * scale(here[name].values))
        assert here.reason.values.tolist() == one.reason.values.tolist()
        assert here.warning.values.tolist() == one.warning.values.tolist()
        told = here.missing.values[here.reason.values == ""]
        assert all(("no shaft holds the azimuth" in text) == (values[SHAFT][place] == 0) for text in told)
        without = np.isnan(here.eigenvalue.values.real)
        assert np.isnan(np.moveaxis(here.vector.values, 1, -1)[without]).all()
        assert np.isnan(here.mode_quality.values[np.isnan(here.mode_eigenvalue.values.real)]).all()


def test_designs_with_and_without_a_shaft_flutter_in_company_as_they_do_alone():
    """Also where one of them meets a bad input, by which the batch is searched in parts."""
    stiffness, speeds = [0.0, 1e4], np.arange(140.0, 260.0, 10.0)
    options = {"structure": "tabulated", "pitch": "coupling", "section_damping": False}

    def tabulated(gap):
        def flap(speed):
            return np.where((speed > gap[0]) & (speed < gap[1]), -1.0, 1.85)

        return pp.BladeFrequencies(
            at_rotor_speed=CASE.operation.rotor_speed, against="airspeed", at=[0, 300], flap=flap, lag=1.2
        )

    alone = [
        CASE.vary({SHAFT: value}).flutter_point(speeds, frequencies=tabulated((0.0, 0.0)), **options)
        for value in stiffness
    ]
    assert all(np.isfinite(point.speed) for point in alone)
    for gap in ((0.0, 0.0), (145.0, 155.0)):
        found = pp.study(
            CASE, {SHAFT: stiffness}, speeds, "flutter", frequencies=tabulated(gap), workers=1, **options
        )
        for place, point in enumerate(alone):
            assert found.flutter_speed.values[place] == pytest.approx(point.speed, abs=1e-4)
            assert found.flutter_mode.values[place] == point.mode
        works = found.reason.values == ""
        assert not works.all() if gap[1] else works.all()
        without = "no shaft holds the azimuth"
        assert all(str(told).startswith(without) for told in found.missing.values[0][works[0]])
        assert not (found.missing.values[1] != "").any()


def test_a_batch_of_designs_that_are_alike_tells_of_nothing_missing():
    for stiffness in ([0.0, 0.0], [1e4, 2e4]):
        assert "missing" not in CASE.vary({SHAFT: stiffness}).linearize(SPEED).modes()
        assert "missing" not in pp.study(CASE, {SHAFT: stiffness}, [SPEED], workers=1)


def test_the_smallest_batches_of_a_study_have_room_for_the_states_of_all():
    """Batches of one design each, with and without a shaft, go into one table."""
    stiffness = [0.0, 1e4, 0.0]
    whole = pp.study(CASE, {SHAFT: stiffness}, [SPEED], ("eigenvalue", "vectors"), workers=1)
    parts = pp.study(CASE, {SHAFT: stiffness}, [SPEED], ("eigenvalue", "vectors"), workers=1, batch=1)
    assert whole.sizes == parts.sizes
    assert np.isnan(whole.eigenvalue.values).sum() == 2
    np.testing.assert_allclose(whole.eigenvalue.values, parts.eigenvalue.values, rtol=1e-9)


def test_a_map_is_at_every_point_that_of_one_design():
    axes = {SHAFT: [0.0, 1e3, 1e6], "rotor.precone": [0.0, 0.02, 0.05]}
    found = CASE.stability_map(axes, airspeed=SPEED).growth
    for stiffness in axes[SHAFT]:
        for precone in axes["rotor.precone"]:
            one = CASE.vary({SHAFT: stiffness, "rotor.precone": precone}).linearize(SPEED)
            here = found.sel({SHAFT: stiffness, "rotor.precone": precone}).item()
            assert here == pytest.approx(np.linalg.eigvals(state_matrix(one)).real.max(), rel=1e-9)


@pytest.mark.parametrize("own", ["0 N*m/rad", "1e4 N*m/rad"])
@pytest.mark.parametrize(
    "stiffness", [(0.0, 10.0, 1e3, 1e5), (1e5, 1e3, 10.0, 0.0), (0.0,), (1e3, 1e4)], ids=str
)
def test_along_a_shaft_a_root_begins_where_the_shaft_does(own, stiffness):
    """And what is followed on either side is what a design has alone."""
    case = pp.load_case("xv15-uncoupled", TRAIN | {SHAFT: own})
    found = case.sweep(SPEED, {SHAFT: np.array(stiffness)})
    for place, value in enumerate(stiffness):
        one = case.vary({SHAFT: value}).sweep(SPEED)
        assert_same_roots(found.eigenvalue.values[place], one.eigenvalue.values[0])
    if 0.0 in stiffness and len(stiffness) > 1:
        roots = found.eigenvalue.sel(mode=["rotor speed", "rotor speed, second root"]).values
        free, softest = stiffness.index(0.0), stiffness.index(10.0)
        assert np.isfinite(roots[softest]).all()
        (kept,) = roots[free][np.isfinite(roots[free].real)]
        # A soft spring and a damper: the new root is the stiffness over what holds the speed, next to nothing.
        new, old = sorted(roots[softest], key=abs)
        assert abs(old / kept - 1) < 1e-3
        assert abs(new) < 1e-3 * abs(kept)
        assert (found.missing.values != "").tolist() == (np.array(stiffness) == 0).tolist()


def test_following_over_the_beginning_of_a_shaft_tells_which_root_is_new():
    """Vectors at the free point are those at a vanishing stiffness: each state goes on as itself, the last is new."""
    model = CASE.vary({SHAFT: [0.0, 1e-6]}).linearize(SPEED)
    spectrum = decomposition(model)
    assert np.isnan(spectrum.values[0, -1]) and np.isfinite(spectrum.values[1]).all()
    new = np.argmin(np.abs(spectrum.values[1]))
    modes = spectrum.all_modes
    like = np.abs(modes.left[0] @ modes.right[1])
    assert like[-1].argmax() == new
    for state in range(len(like) - 1):
        successor = like[state].argmax()
        assert abs(spectrum.values[1, successor] - spectrum.values[0, state]) < 1e-6 * abs(
            spectrum.values[0, 0]
        )


def test_a_shaft_that_is_not_there_yet_has_its_derivative():
    """The free azimuth has no displacement among the states: a spring on it must be felt all the same."""
    case = CASE.vary({SHAFT: 0.0})
    found = case.sensitivity("eigenvalue", [SHAFT], airspeed=SPEED, mode="torsion").derivative.values.item()
    step = 1.0
    values = [
        case.vary({SHAFT: stiffness}).sweep(SPEED).eigenvalue.sel(mode="torsion").item()
        for stiffness in (step, 2 * step)
    ]
    ahead = (values[1] - values[0]) / step
    assert abs(ahead) > 0
    assert found == pytest.approx(ahead, rel=1e-3)


def test_options_may_differ_within_a_batch_too():
    stiffness, coupling = np.array([0.0, 1e4, 0.0]), np.array([0.0, 0.3, -0.2])
    options = {"pitch": "coupling", "pitch_flap_coupling": coupling}
    batch = CASE.linearize(SPEED, drive_train=pp.DriveTrain(shaft_stiffness=stiffness), **options)
    for place in range(3):
        one = CASE.linearize(
            SPEED,
            drive_train=pp.DriveTrain(shaft_stiffness=stiffness[place]),
            pitch="coupling",
            pitch_flap_coupling=coupling[place],
        )
        assert_same_roots(eigenvalues(batch)[place], eigenvalues(one))


def test_a_wing_of_beams_in_a_mixed_batch():
    values = {SHAFT: [0.0, 1e4, 0.0], "operation.density": [1.225, 0.0, 1.0]}
    batch = WING.vary(values).linearize(SPEED)
    for place in range(3):
        one = WING.vary({path: numbers[place] for path, numbers in values.items()}).linearize(SPEED)
        assert_same_roots(eigenvalues(batch)[place], eigenvalues(one))


def test_rotors_alone_without_mass_somewhere_spoil_no_other():
    """A free hub and a free gimbal tilt against each other where the pitch does not feel the gimbal."""
    rotor = CASE.rotor
    model = pp.rotor_model(rotor, CASE.operation, np.array([SPEED, SPEED]), airloads="none")
    names = tuple(name for name in model.dofs if name.startswith(("flap", "gimbal")))
    held = model.submodel(names)
    mass = held.M.copy()
    mass[1, :, 0] = mass[1, 0, :] = 0.0
    mixed = replace(held, M=mass)
    found = mixed.modes()
    assert_same_roots(found.eigenvalue.values[0], held.modes().eigenvalue.values[0])
    assert np.isnan(found.eigenvalue.values[1]).all()
    assert "without any mass" in str(found.reason.values[1]) and not found.reason.values[0]
    assert np.isnan(state_matrix(mixed)[1]).all() and np.isfinite(state_matrix(mixed)[0]).all()


def test_the_same_design_is_neutral_in_any_company():
    """A root of nothing but rounding has no damping ratio, whatever the largest root of another design is."""
    case = CASE.vary({SHAFT: [0.0, 0.0], "rotor.control_stiffness": [1e4, 1e26]})
    one = CASE.vary({SHAFT: 0.0, "rotor.control_stiffness": 1e4}).linearize(SPEED).modes()
    here = case.linearize(SPEED).modes().isel(airspeed=0)
    np.testing.assert_allclose(here.damping_ratio, one.damping_ratio, rtol=1e-6)


def test_many_designs_are_refused_where_one_is_asked_for():
    case = CASE.vary({"rotor.precone": [0.0, 0.02, 0.05]})
    with pytest.raises(pp.InputError, match="case = xv15-uncoupled: must be one design, not 3"):
        case.attribution(SPEED)
