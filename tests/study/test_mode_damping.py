"""Damping of a support's modes along the airspeeds: against made-up roots, scipy's eigenvectors and the sweep."""

import numpy as np
import pytest
import scipy.linalg
import xarray as xr

import proprotor as pp
from proprotor.errors import InputError
from proprotor.study import mode_damping, study

KNOT = 1852 / 3600
SPEEDS = np.array([10.0, 20.0, 30.0, 40.0, 50.0])


def root(damping, frequency=1.0):
    return frequency * (-damping + 1j * np.sqrt(1 - np.square(damping)))


def made_up(names, dampings, shares=1.0):
    """A study of one design: names (airspeeds, states), damping ratios, and shares of the support."""
    dims, values = ("design", "airspeed", "state"), root(np.array(dampings))[None]
    data = {
        "mode_eigenvalue": (dims, values),
        "mode_name": (dims, np.array(names, dtype=object)[None]),
        "mode_support_share": (dims, np.broadcast_to(shares, values.shape)),
    }
    return xr.Dataset(data, {"airspeed": SPEEDS, "design": [0]})


EXCHANGE = made_up(
    [["beam", "lag"], ["lag", "beam"], ["lag", "beam"], ["beam", "lag"], ["beam", "lag"]],
    [[0.1, 0.5], [0.2, 0.4], [0.3, 0.35], [0.6, -0.1], [0.7, -0.2]],
)


def test_a_name_tells_at_low_speeds_and_its_root_is_followed_at_high_ones():
    """The name passes to the second root at 20 m/s; that root is followed beyond the middle, whatever its name."""
    found = mode_damping(EXCHANGE, "beam")
    assert found.dims == ("design", "airspeed")
    np.testing.assert_allclose(found[0], [0.1, 0.4, 0.35, -0.1, -0.2])
    np.testing.assert_allclose(mode_damping(EXCHANGE, "beam", named_to=10.0)[0], [0.1, 0.2, 0.3, 0.6, 0.7])
    np.testing.assert_allclose(mode_damping(EXCHANGE, "beam", named_to=50.0)[0], [0.1, 0.4, 0.35, 0.6, 0.7])


def test_failed_airspeeds_have_no_damping_and_are_passed_over():
    failed = EXCHANGE.copy(deep=True)
    failed.mode_eigenvalue[0, 2] = np.nan
    failed.mode_name[0, 2] = ""
    np.testing.assert_allclose(mode_damping(failed, "beam")[0], [0.1, 0.4, np.nan, -0.1, -0.2])
    failed.mode_eigenvalue[0, :4] = np.nan
    failed.mode_name[0, :4] = ""
    np.testing.assert_allclose(mode_damping(failed, "beam")[0], [*[np.nan] * 4, 0.7])


def test_the_least_damping_is_of_the_modes_that_move_the_support():
    shares = np.tile([1.0, 0.5], (5, 1))
    shares[3:, 1] = 0.09
    found = made_up(
        EXCHANGE.mode_name.values[0], [[0.1, 0.5], [0.2, 0.1], [0.3, 0.3], [0.6, -1e-3], [0.7, -0.2]], shares
    )
    np.testing.assert_allclose(mode_damping(found)[0], [0.1, 0.1, 0.3, 0.6, 0.7])


def test_what_has_no_damping_is_refused():
    with pytest.raises(InputError, match="chord"):
        mode_damping(EXCHANGE, "chord")
    with pytest.raises(InputError, match="along airspeeds"):
        mode_damping(EXCHANGE.isel(airspeed=0), "beam")
    with pytest.raises(InputError, match="quantities"):
        mode_damping(EXCHANGE.drop_vars("mode_eigenvalue"))


@pytest.mark.parametrize("deck", ["v22-fifth-scale", "wrats-888-off"])
def test_modes_that_keep_their_names_are_those_of_the_sweep(deck):
    case, speeds = pp.load_case(deck), np.arange(80, 181, 5) * KNOT
    modes = case.sweep(speeds, pitch="coupling")
    found = study(case, {}, speeds, "modes", workers=1, pitch="coupling")
    for name in case.support.names:
        np.testing.assert_allclose(
            mode_damping(found, name)[0], modes.damping_ratio.sel(mode=name), rtol=1e-6, atol=1e-9
        )


def test_the_share_of_the_support_is_that_of_left_times_right_vectors():
    case = pp.load_case("xv15-uncoupled")
    found = study(case, {}, [100.0, 120.0], "modes", workers=1, pitch="coupling").isel(design=0, airspeed=1)
    model = case.linearize(120.0, pitch="coupling")
    n, inverse = len(model.dofs), np.linalg.inv(model.M)
    state = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ model.K, -inverse @ model.C]])
    values, left, right = scipy.linalg.eig(state, left=True)
    products = np.abs(left.conj() * right)
    shares = (products[:n] + products[n:]) / products.sum(axis=0)
    support = shares[[model.dofs.index(name) for name in case.support.names]].sum(axis=0)
    for value, share in zip(found.mode_eigenvalue.values, found.mode_support_share.values, strict=True):
        place = np.abs(values - value).argmin()
        assert abs(values[place] - value) < 1e-6
        assert share == pytest.approx(support[place], abs=1e-7)
