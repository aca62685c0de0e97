"""The compiled plans beside NumPy's: trims, matrices and roots of random rotors in the air, and what is not served."""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from proprotor import sampling
from proprotor.compiled.library import why_not
from proprotor.model.first_order import state_matrix
from proprotor.stability.modes import decomposition, eigenvalues

pytestmark = pytest.mark.skipif("there is no C compiler" in why_not(), reason="there is no C compiler")
KNOT = 1852 / 3600
SPEEDS = np.linspace(60, 400, 45) * KNOT
OPTIONS = (
    {},
    {"pitch": "rigid"},
    {"pitch": "coupling"},
    {"airloads": "none"},
    {"airloads": "lift-slope"},
    {"compressibility": False},
    {"section_damping": False},
    {"rotor_speed": "constant"},
    {"equations": "published"},
    {"lift": "lagged"},
    {"inflow": "dynamic"},
    {"locked": ("lag", "gimbal")},
    {"structure": "diagonal"},
)


def both(case, speeds, **options):
    return [case.linearize(speeds, backend=backend, **options) for backend in ("numpy", "compiled")]


def assert_alike(one, other):
    assert (one.trim.converged == other.trim.converged).all() and (one.trim.reason == other.trim.reason).all()
    for name in ("coning", "lag", "elastic_pitch", "collective"):
        np.testing.assert_allclose(getattr(one.trim, name), getattr(other.trim, name), rtol=0, atol=1e-12)
    assert (one.trim.warning == other.trim.warning).all()
    expected, found = state_matrix(one), state_matrix(other)
    size = np.abs(np.nan_to_num(expected)).max(axis=(-2, -1), keepdims=True)
    np.testing.assert_allclose(found / size, expected / size, rtol=0, atol=1e-12)


def in_pairs(one, other):
    """Sort roots by frequency, so that both lists have them in one order."""
    return (np.sort_complex(np.round(values, 4)) for values in (one, other))


@pytest.mark.parametrize("name", pp.list_cases())
def test_cases_have_the_same_models_and_roots(name):
    case = pp.load_case(name)
    one, other = both(case, SPEEDS)
    assert_alike(one, other)
    expected, found = in_pairs(eigenvalues(one), eigenvalues(other))
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-4)
    assert other.origin.options.backend == "compiled"


@pytest.mark.parametrize(
    "options", OPTIONS, ids=lambda options: ", ".join(map(str, options.values())) or "usual"
)
def test_every_option_has_the_same_model(options):
    assert_alike(*both(pp.load_case("xv15"), SPEEDS, **options))


def test_designs_that_differ_have_the_same_models():
    case, rng = pp.load_case("xv15"), np.random.default_rng(0)
    inputs = {
        "rotor.control_stiffness": rng.uniform(5e3, 4e4, (25, 1)),
        "rotor.precone": rng.uniform(0.0, 0.05, (25, 1)),
        "rotor.chord": rng.uniform(0.3, 0.45, (25, 1)),
        "operation.density": rng.uniform(0.6, 1.2, (25, 1)),
    }
    assert_alike(*both(case.vary(inputs), SPEEDS[::9]))


def test_aerodynamic_centres_beside_the_pitch_axis_are_numpys():
    case = pp.load_case("xv15")
    beside = replace(case, rotor=replace(case.rotor, aerodynamic_center=0.02))
    assert_alike(*both(beside, SPEEDS[::9]))
    alone, moved = (one.linearize(SPEEDS[::9], backend="compiled").K for one in (case, beside))
    assert np.abs(moved - alone).max() > 1e-3 * np.abs(alone).max()


def test_one_point_of_a_batch_is_that_of_the_batch():
    case = pp.load_case("xv15")
    alone, batch = (eigenvalues(case.linearize(speed, backend="compiled")) for speed in (SPEEDS[20], SPEEDS))
    expected, found = in_pairs(batch[20], alone)
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-4)


def test_vectors_belong_to_their_roots():
    model = pp.load_case("xv15").linearize(SPEEDS, backend="compiled")
    found, matrix = decomposition(model), state_matrix(model)
    left = matrix @ found.right - found.right * found.values[..., None, :]
    assert (np.linalg.norm(left, axis=-2) <= 1e-13 * np.linalg.norm(matrix, axis=(-2, -1))[:, None]).all()


def test_a_flutter_speed_is_the_same():
    case, scan = pp.load_case("xv15"), np.linspace(50, 400, 36) * KNOT
    one, other = (case.flutter_point(scan, backend=backend) for backend in ("numpy", "compiled"))
    assert abs(one.speed - other.speed) < 1e-9 and one.mode == other.mode


def test_a_study_has_the_same_vectors():
    case, plan = (
        pp.load_case("xv15-uncoupled"),
        sampling.latin_hypercube({"airspeed": ("160 kt", "380 kt")}, 40, seed=1),
    )
    one, other = (
        pp.study(case, plan, quantities=("eigenvalue", "vectors"), workers=1, backend=backend)
        for backend in ("numpy", "compiled")
    )
    values = one.eigenvalue.values
    apart = np.abs(values[..., :, None] - values[..., None, :]) + np.where(
        np.eye(values.shape[-1]) > 0, np.inf, 0
    )
    alone = apart.min(axis=-1) > 1.0  # rad/s: the vectors of roots that are one may be any
    expected, found = (np.moveaxis(part.vector.values, -1, -2)[alone] for part in (one, other))
    assert alone.mean() > 0.8
    assert np.abs(found - expected).max() < 1e-8
