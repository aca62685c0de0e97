"""Points taken a few at a time have the bits that they have alone, whatever the batch."""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from proprotor.errors import InputError
from proprotor.model.batches import as_grid, at_rows, few_at_once, joint_shape
from proprotor.model.first_order import in_one_axis, state_matrix
from proprotor.model.massless import massless
from proprotor.model.mount import mount
from proprotor.stability.modes import decomposition, eigenvalues, few_spectra

SPEEDS = np.linspace(40.0, 190.0, 600)  # more points than are taken at once
SOME = [0, 255, 256, 257, 511, 512, 599]


@pytest.fixture(scope="module")
def case():
    return pp.load_case("xv15")


@pytest.fixture(scope="module")
def model(case):
    return case.linearize(SPEEDS)


@pytest.mark.parametrize("shape", [(), (1,), (0,), (256,), (257,), (1000,), (3, 200), (300, 3), (2, 1000)])
def test_every_point_is_taken_once(shape):
    taken = np.zeros(shape, dtype=int)
    for rows in few_at_once(shape):
        taken[rows] += 1
    assert (taken == 1).all()


def test_what_all_points_share_is_taken_whole():
    shape, rows = (4, 5), slice(1, 3)
    own, shared, of_columns = np.empty((4, 5, 6, 6)), np.empty((6, 6)), np.empty((5, 6, 6))
    assert at_rows(own, rows, shape).shape == (2, 5, 6, 6)
    assert at_rows(shared, rows, shape) is shared and at_rows(of_columns, rows, shape) is of_columns
    assert at_rows(shared, ..., ()) is shared


def test_shapes_that_do_not_fit_are_refused():
    assert joint_shape((), (), ()) == () and joint_shape((), (3, 1), (2,)) == (3, 2)
    with pytest.raises(ValueError, match="broadcast"):
        joint_shape((2,), (3,))


def at(model, point):
    """The model at one point, by its arrays alone."""
    matrices = {name: matrix[point] for name, matrix in model.matrices.items()}
    trim = type(model.trim)(**{name: np.asarray(value[point]) for name, value in vars(model.trim).items()})
    return replace(model, **matrices, trim=trim, airspeed=np.asarray(model.airspeed[point]))


def test_state_matrices_and_mounted_rotors_of_a_batch_are_those_of_its_points(case, model):
    matrix = state_matrix(model)
    for point in SOME:
        np.testing.assert_array_equal(state_matrix(at(model, point)), matrix[point])
        alone = mount(at(model.rotor, point), case.support)
        for name in ("M", "C", "K", "B", "hub"):
            whole = getattr(model, name)
            np.testing.assert_array_equal(getattr(alone, name), whole[point] if whole.ndim > 2 else whole)


def test_a_batch_with_two_axes_has_the_matrices_of_a_flat_one(case, model):
    grid = {name: matrix.reshape(2, 300, *matrix.shape[1:]) for name, matrix in model.matrices.items()}
    np.testing.assert_array_equal(
        state_matrix(replace(model, **grid)).reshape(600, 29, 29), state_matrix(model)
    )


def test_supports_of_many_designs_are_mounted_as_each_of_them(case, model):
    """Designs along one axis of a batch, airspeeds along the other: neither all vary nor all are shared."""
    factors = np.array([0.5, 1.0, 2.0])[:, None, None, None]
    many = replace(case.support, stiffness=factors * case.support.stiffness)
    mounted = mount(model.rotor, many)
    for row, factor in enumerate(factors[:, 0, 0, 0]):
        one = mount(model.rotor, replace(case.support, stiffness=factor * case.support.stiffness))
        np.testing.assert_array_equal(mounted.K[row], one.K)
        np.testing.assert_array_equal(mounted.M[row], one.M)


def test_singular_and_failed_points_are_found_among_many():
    rng = np.random.default_rng(2)
    factors = rng.normal(size=(600, 4, 6))
    mass = factors @ np.swapaxes(factors, -1, -2)
    mass[[3, 300, 599]] = np.diag([1.0, 1.0, 1.0, 0.0])
    mass[[4, 301]] = np.nan
    assert np.flatnonzero(massless(mass)).tolist() == [3, 300, 599]
    assert np.argwhere(massless(mass.reshape(2, 300, 4, 4))).tolist() == [[0, 3], [1, 0], [1, 299]]
    assert not massless(mass[4]) and massless(mass[3]) and not massless(mass[5])


def test_a_rotor_without_what_its_options_need_is_refused_each_time(case):
    rotor = replace(case.rotor, pitch_inertia=np.array([0.0, 1.0]))
    for _ in range(2):
        with pytest.raises(InputError, match=r'pitch_inertia = .*must be above zero with pitch="dynamic"'):
            pp.rotor_model(rotor, case.operation, 100.0)
        with pytest.raises(
            InputError, match=r'control_stiffness = .*must be above zero with pitch="coupling"'
        ):
            pp.rotor_model(
                replace(case.rotor, control_stiffness=0.0), case.operation, 100.0, pitch="coupling"
            )
    assert pp.rotor_model(rotor, case.operation, 100.0, pitch="rigid").trim.converged.all()


def test_designs_at_all_airspeeds_are_a_grid():
    speeds, precone, mass = np.array([50.0, 60.0, 70.0]), np.array([0.02, 0.03]), np.array([1.0, 1.0])
    numbers, along = as_grid({"a": precone.repeat(3), "b": mass.repeat(3)}, np.tile(speeds, 2))
    assert np.array_equal(numbers["a"], precone[:, None]) and np.array_equal(numbers["b"], mass[:, None])
    assert np.array_equal(along, [speeds, speeds])
    numbers, along = as_grid({"b": mass.repeat(3)}, np.tile(speeds, 2))  # one design
    assert numbers["b"].shape == (1, 1) and along.shape == (1, 6)


@pytest.mark.parametrize(
    "a", [[1, 2, 3, 4, 5, 6], [1, 1, 2, 3, 3, 3], [1, 1, 1, 2, 2, 3], [1, 1, 1, 1, 2, 2], [1, 2, 2, 2, 2, 2]]
)
def test_other_points_are_no_grid(a):
    given, speeds = np.array(a, dtype=float), np.arange(6.0)
    numbers, along = as_grid({"a": given}, speeds)
    assert numbers["a"] is given and along is speeds


def test_a_grid_in_one_axis_has_the_bits_of_its_points(case):
    precone, speeds = np.array([0.03, 0.04]), np.array([90.0, 120.0, 150.0])
    grid = in_one_axis(case.vary({"rotor.precone": precone[:, None]}).linearize(np.tile(speeds, (2, 1))))
    points = case.vary({"rotor.precone": precone.repeat(3)}).linearize(np.tile(speeds, 2))
    for name in "MCK":
        assert np.array_equal(getattr(grid, name), getattr(points, name))
    assert np.array_equal(grid.airspeed, points.airspeed)
    assert np.array_equal(grid.trim.reason, points.trim.reason)


def test_eigenvalues_a_few_points_at_a_time_are_those_of_all_state_matrices(model):
    of_all = np.linalg.eigvals(state_matrix(model))
    assert np.array_equal(eigenvalues(model), of_all)
    whole = decomposition(model).values
    assert np.array_equal(np.concatenate([spectrum.values for _, spectrum in few_spectra(model)]), whole)
