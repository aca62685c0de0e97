"""Designs of a case: numbers varied one at a time and in batches, and exact derivatives by a complex step."""

import numpy as np
import pytest

import proprotor as pp
from proprotor.errors import InputError

AIRSPEED = 150.0  # m/s
PATHS = list(pp.design_inputs(pp.load_case("xv15-uncoupled")))


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15-uncoupled")


def matrices(case, airspeed=AIRSPEED, **options):
    model = case.linearize(airspeed, **options)
    assert model.trim.converged.all()
    return np.concatenate([model.M, model.C, model.K], axis=-1)


def step_of(case, path):
    """A ten-thousandth of the number, or of one where it is zero."""
    return 1e-4 * (abs(case.given[path].si) or 1.0)


def stencil(case, path):
    """Offsets of two Richardson-extrapolated central differences; to one side of a share that may not exceed one."""
    return np.array([-2.0, -1.0, 1.0, 2.0]) * step_of(case, path)


def richardson(case, path):
    """Derivative of the matrices by differences of ordinary real models, error of fourth order."""
    varied = case.vary({path: case.given[path].si + stencil(case, path)})
    m2, m1, p1, p2 = matrices(varied, np.full(4, AIRSPEED))
    return (8 * (p1 - m1) - (p2 - m2)) / (12 * step_of(case, path))


@pytest.fixture(scope="module")
def complex_derivatives(case):
    """Derivatives of the matrices with every input of the deck, from one batch."""
    tiny, n = 1e-30, len(PATHS)
    values = {path: case.given[path].si + 1j * tiny * np.eye(n)[place] for place, path in enumerate(PATHS)}
    return dict(zip(PATHS, np.imag(matrices(case.vary(values), np.full(n, AIRSPEED))) / tiny, strict=True))


@pytest.mark.parametrize("path", [path for path in PATHS if not path.endswith("outboard_fraction")])
def test_a_complex_step_is_the_derivative_of_the_matrices(case, complex_derivatives, path):
    """Through springs, trim, airloads and support; differences lose digits where the number moves little."""
    whole = np.abs(matrices(case)).max(axis=(-2, -1)) * 1e-16 / step_of(case, path)
    expected = richardson(case, path)
    error = np.abs(complex_derivatives[path] - expected).max()
    assert error < 1e-8 * np.abs(expected).max() + 10 * whole


@pytest.mark.parametrize("path", ["rotor.flap_outboard_fraction", "rotor.lag_outboard_fraction"])
def test_a_complex_step_of_a_share_at_its_bound(case, complex_derivatives, path):
    inside = case.vary({path: 0.5})
    step, tiny = 1e-4, 1e-30
    exact = np.imag(matrices(inside.vary({path: 0.5 + 1j * tiny}))) / tiny
    m2, m1, p1, p2 = (matrices(inside.vary({path: 0.5 + k * step})) for k in (-2, -1, 1, 2))
    expected = (8 * (p1 - m1) - (p2 - m2)) / (12 * step)
    assert np.abs(exact - expected).max() < 1e-8 * np.abs(expected).max()
    one_sided = (matrices(case) - matrices(case.vary({path: 1 - 1e-6}))) / 1e-6
    assert np.abs(complex_derivatives[path] - one_sided).max() < 1e-4 * np.abs(one_sided).max()


def test_airspeed_takes_a_complex_step(case):
    tiny, step = 1e-30, 0.05
    exact = np.imag(matrices(case, AIRSPEED + 1j * tiny)) / tiny
    m2, m1, p1, p2 = (matrices(case, AIRSPEED + k * step) for k in (-2, -1, 1, 2))
    expected = (8 * (p1 - m1) - (p2 - m2)) / (12 * step)
    assert np.abs(exact - expected).max() < 1e-9 * np.abs(expected).max()


@pytest.mark.parametrize(
    "options", [{"pitch": "coupling"}, {"equations": "published"}, {"airloads": "lift-slope"}]
)
def test_options_take_a_complex_step_too(case, options):
    path, tiny = "rotor.precone", 1e-30
    here, step = case.given[path].si, step_of(case, path)
    exact = np.imag(matrices(case.vary({path: here + 1j * tiny}), **options)) / tiny
    m2, m1, p1, p2 = (matrices(case.vary({path: here + k * step}), **options) for k in (-2, -1, 1, 2))
    expected = (8 * (p1 - m1) - (p2 - m2)) / (12 * step)
    assert np.abs(exact - expected).max() < 1e-8 * np.abs(expected).max()


def test_the_imaginary_part_leaves_the_real_one(case):
    varied = case.vary({"rotor.radius": case.rotor.radius * (1 + 1e-30j)})
    assert np.abs(matrices(varied).real - matrices(case)).max() < 1e-13 * np.abs(matrices(case)).max()


def test_a_batch_of_designs_is_its_designs(case):
    cone, stiff = np.radians([1.0, 2.0, 3.0]), np.array([6000.0, 9000.0, 12000.0])
    values = {"rotor.precone": cone, "rotor.control_stiffness": stiff, "support.modes[chord].frequency": 30.0}
    batch = matrices(case.vary(values), np.full(3, AIRSPEED))
    for place in range(3):
        one = {path: np.ravel(value)[place if np.ndim(value) else 0] for path, value in values.items()}
        assert np.array_equal(batch[place], matrices(case.vary(one), np.array([AIRSPEED]))[0])


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"pitch": "coupling"},
        {"equations": "published"},
        {"equations": "published", "airloads": "lift-slope", "compressibility": False},
        {"airloads": "none"},
        {"section_damping": False},
    ],
)
def test_one_of_many_designs_is_that_design_bit_for_bit(case, options):
    cone, density = np.radians([1.0, 2.0, 3.0]), np.array([0.8, 1.0, 1.2])
    airspeeds = np.array([40.0, 120.0, 180.0])
    batch = case.vary({"rotor.precone": cone, "operation.density": density}).linearize(airspeeds, **options)
    for place in range(3):
        one = case.vary({"rotor.precone": cone[place], "operation.density": density[place]})
        model = one.linearize(airspeeds[place : place + 1], **options)
        assert all(np.array_equal(getattr(batch, name)[place], getattr(model, name)[0]) for name in "MCKB")


BLADES_MOVED = {
    # from the centre to beyond hinges and inner stations of the twist
    "cutout": {"rotor.root_cutout": np.linspace(0.0, 0.3, 12)},
    "radius": {"rotor.radius": np.linspace(0.9, 1.1, 12)},
    "both": {"rotor.radius": np.linspace(1.1, 0.9, 12), "rotor.root_cutout": np.linspace(0.02, 0.3, 12)},
    "hinges": {
        "rotor.flap_hinge_offset": np.array([0, 0, 0, 0, 2, 2, 4, 6, 8, 10, 12, 20]) / 100,
        "rotor.lag_hinge_offset": np.array([0, 2, 8, 20, 2, 6, 4, 12, 8, 30, 14, 20]) / 100,
        "rotor.root_cutout": np.tile([0.0, 0.05], 6),
    },
}


@pytest.mark.parametrize("moved", BLADES_MOVED)
@pytest.mark.parametrize(
    "options", [{}, {"equations": "published", "airloads": "lift-slope", "compressibility": False}]
)
def test_one_of_many_blades_is_that_blade_bit_for_bit(moved, options):
    """Whatever stations and segments the others have: they differ in number."""
    case = pp.load_case("xv15-mass-distribution")
    values = {path: share * case.rotor.radius for path, share in BLADES_MOVED[moved].items()}
    airspeeds = np.linspace(40.0, 180.0, 12)
    varied = case.vary(values)
    assert len(np.unique(varied.rotor.quadrature.counts, axis=0)) >= 2
    batch = varied.linearize(airspeeds, **options)
    assert np.isfinite(batch.M).all()  # with hinges at the centre, too, where it has no inverse
    assert batch.trim.converged[values.get("rotor.flap_hinge_offset", airspeeds) > 0].all()
    for place in range(len(airspeeds)):
        design = case.vary({path: value[place] for path, value in values.items()})
        one = design.linearize(airspeeds[place : place + 1], **options)
        for name in "MCKB":
            assert np.array_equal(getattr(batch, name)[place], getattr(one, name)[0]), (place, name)
        assert batch.trim.warning[place] == one.trim.warning[0]
        assert batch.trim.reason[place] == one.trim.reason[0]


def test_supports_alone_may_be_many(case):
    frequencies = np.array([20.0, 25.0])
    model = case.vary({"support.modes[beam].frequency": frequencies}).linearize(AIRSPEED)
    assert model.M.shape[0] == 2 and model.airspeed.shape == (2,) and model.trim.reason.shape == (2,)
    place = model.dofs.index("beam")
    assert np.diff(model.K[:, place, place]) > 0
    assert np.array_equal(np.delete(model.K[0], place, 0), np.delete(model.K[1], place, 0))


def test_what_follows_from_a_number_follows(case):
    faster = case.vary({"rotor.flap_frequency": 2 * case.given["rotor.flap_frequency"].si})
    assert faster.rotor.flap_stiffness == pytest.approx(4 * case.rotor.flap_stiffness, rel=1e-15)
    turning = case.vary({"operation.rotor_speed": 50.0})
    assert np.array_equal(turning.support.stiffness, case.support.stiffness)


def test_the_tables_stretch_with_the_radius(case):
    larger = case.vary({"rotor.radius": 1.1 * case.rotor.radius})
    assert np.allclose(larger.rotor.twist[0], 1.1 * case.rotor.twist[0])
    assert larger.rotor.twist[0][-1] == pytest.approx(larger.rotor.radius)


def test_given_values_change_nothing(case):
    same = case.vary({path: case.given[path].si for path in PATHS})
    assert np.array_equal(matrices(same), matrices(case))


def test_a_mass_distribution_with_many_hinges():
    case = pp.load_case("xv15-mass-distribution")
    offsets = np.array([0.15, 0.2438, 0.4])
    batch = case.vary({"rotor.flap_hinge_offset": offsets}).rotor
    for place, offset in enumerate(offsets):
        one = case.vary({"rotor.flap_hinge_offset": offset}).rotor
        assert batch.flap_inertia[place] == one.flap_inertia


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"rotor.precon": 0.1}, "did you mean rotor.precone?"),
        ({"precone": 0.1}, "unknown input"),
        ({"rotor.n_blades": 4}, "it is a whole number"),
        ({"rotor.precone": "2 kg"}, "must be an angle"),
        ({"rotor.precone": np.nan}, "must be finite"),
        ({"rotor.radius": -1.0}, "rotor.radius = -1 m"),
        ({"operation.rotor_speed": np.array([1.0, 0.0])}, "must be above zero"),
        ({"support.modes[beam].generalized_mass": -1.0}, "must not be negative"),
    ],
)
def test_wrong_values_are_refused(case, values, told):
    with pytest.raises(InputError) as error:
        case.vary(values)
    assert told in str(error.value)


def test_a_case_without_a_deck_has_no_inputs(case):
    bare = pp.Case(name="bare", rotor=case.rotor, operation=case.operation, support=case.support)
    with pytest.raises(InputError, match="must be made from a deck"):
        pp.design_inputs(bare)
