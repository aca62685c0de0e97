"""Distributions and Sobol indices: against functions whose indices and percentiles are known.

The Ishigami function sin x1 + a sin² x2 + b x3⁴ sin x1 with x uniform on (−π, π), a = 7, b = 0.1 has (Ishigami and
Homma, 1990) the variance a²/8 + bπ⁴/5 + b²π⁸/18 + 1/2, of which (1 + bπ⁴/5)²/2 is x1's alone, a²/8 x2's, and
b²π⁸ (1/18 − 1/50) that of x1 with x3.
"""

from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

import proprotor as pp
from proprotor import sampling
from proprotor.errors import InputError
from proprotor.exchange.netcdf import load_results, save_results
from proprotor.study.study import study
from proprotor.study.uncertainty import distribution, share_below, sobol_indices
from proprotor.study.variables import STABLE, UNSTABLE

A, B = 7.0, 0.1
KNOWN = {f"x{place}": SimpleNamespace(si=1.0, unit="") for place in (1, 2, 3)}


def ishigami(x1, x2, x3):
    return np.sin(x1) + A * np.sin(x2) ** 2 + B * x3**4 * np.sin(x1)


def results(plan, function):
    """What a study would give, of a function in place of a rotor."""
    designs = plan.resolve(KNOWN)
    y = function(**designs.values)
    return xr.Dataset({"y": ("design", y)}, designs.coordinates, designs.attributes)


@pytest.fixture(scope="module")
def sampled():
    plan = sampling.saltelli(dict.fromkeys(KNOWN, (-np.pi, np.pi)), 2048, second_order=True)
    return results(plan, ishigami)


def test_the_indices_of_the_ishigami_function(sampled):
    found = sobol_indices(sampled, of="y")
    alone = np.array([(1 + B * np.pi**4 / 5) ** 2 / 2, A**2 / 8, 0])
    together = B**2 * np.pi**8 * (1 / 18 - 1 / 50)
    variance = alone.sum() + together
    assert np.isclose(variance, A**2 / 8 + B * np.pi**4 / 5 + B**2 * np.pi**8 / 18 + 1 / 2, rtol=1e-12)
    first, total = alone / variance, (alone + together * np.array([1, 0, 1])) / variance
    # Within twice the half width of the 95 % intervals, which are themselves below 0.1 at this size.
    assert list(found.input.values) == ["x1", "x2", "x3"]
    assert (np.abs(found["first"] - first) < 2 * found.first_half_interval).all()
    assert (np.abs(found.total - total) < 2 * found.total_half_interval).all()
    assert (found.total_half_interval < 0.1).all() and (found.first_half_interval < 0.1).all()
    assert abs(float(found.second.sel(input="x1", other_input="x3")) - together / variance) < 0.05
    assert abs(float(found.second.sel(input="x1", other_input="x2"))) < 0.05
    assert float(found.second.sel(input="x3", other_input="x1")) == float(found.second[0, 2])


def test_indices_of_a_sum_need_no_second_order():
    """y = 3 x1 + x2 with equal ranges: 9/10 and 1/10 of the variance, and none of it together."""
    plan = sampling.saltelli(dict.fromkeys(KNOWN, (0, 1)), 1024)
    found = sobol_indices(results(plan, lambda x1, x2, x3: 3 * x1 + x2), of="y")
    assert len(plan.resolve(KNOWN)) == 1024 * 5 and "second" not in found
    assert np.allclose(found["first"], [0.9, 0.1, 0], atol=0.02)
    assert np.allclose(found.total, [0.9, 0.1, 0], atol=0.02)


def test_indices_are_those_of_a_study_from_a_file(sampled, tmp_path):
    save_results(sampled, tmp_path / "study.nc")
    xr.testing.assert_identical(
        sobol_indices(load_results(tmp_path / "study.nc"), of="y"), sobol_indices(sampled, of="y")
    )


def test_base_samples_with_a_failed_design_are_left_out(sampled):
    failed = sampled.copy(deep=True)
    failed.y[:400:20] = np.nan
    found = sobol_indices(failed, of="y")
    assert found.left_out == 20
    assert np.allclose(found.total, sobol_indices(sampled, of="y").total, atol=0.05)
    failed.y[::50] = np.nan
    with pytest.raises(InputError, match="must be known in 95%"):
        sobol_indices(failed, of="y")


def test_what_has_no_indices_is_told(sampled):
    plan = sampling.sobol(dict.fromkeys(KNOWN, (0, 1)), 16)
    with pytest.raises(InputError, match="saltelli"):
        sobol_indices(results(plan, ishigami), of="y")
    with pytest.raises(InputError, match="variable of the results"):
        sobol_indices(sampled, of="z")
    with pytest.raises(InputError, match="same for every design"):
        sobol_indices(sampled.assign(y=("design", np.ones(sampled.sizes["design"]))), of="y")
    with pytest.raises(InputError, match="one number for each design"):
        sobol_indices(sampled.expand_dims("airspeed", axis=1), of="y")
    with pytest.raises(InputError, match="power of two"):
        sampling.saltelli({"x1": (0, 1)}, 100)


def test_percentiles_of_a_known_distribution():
    plan = sampling.sobol({"x1": sampling.Normal(10, 2)}, 4096)
    found = distribution(results(plan, lambda x1: x1), of="y", percentiles=(2.275, 50, 84.134))
    assert np.allclose(found.value, [6, 10, 12], atol=0.02)
    assert (found.known, found.above, found.below, found.failed) == (4096, 0, 0, 0)


def speeds(values, notes):
    data = {
        "flutter_speed": ("design", np.array(values, dtype=float), {"units": "m/s"}),
        "flutter_note": ("design", np.array(notes, dtype=object)),
    }
    return xr.Dataset(data, {"airspeed": ("airspeed", [100.0, 200.0])})


def test_designs_beyond_the_airspeeds_count_without_a_number():
    nan = np.nan
    study_found = speeds(
        [150, nan, 120, nan, 180, nan, 160, 170, nan, 110],
        ["", STABLE, "", UNSTABLE, "", STABLE, "", "", "tip Mach", ""],
    )
    found = distribution(study_found, percentiles=(10, 50, 70, 90, 100))
    assert (found.known, found.above, found.below, found.failed) == (6, 2, 1, 1)
    # In order: -inf, 110, 120, 150, 160, 170, 180, inf, inf; the least that is not below the share of nine.
    assert list(found.value.values) == [-np.inf, 160, 180, np.inf, np.inf]
    assert found.value.attrs["units"] == "m/s"
    assert share_below(study_found, 155.0) == 4 / 9
    for limit in (90.0, 210.0):
        with pytest.raises(InputError, match="airspeeds of the study"):
            share_below(study_found, limit)


def test_a_distribution_of_nothing_is_told():
    with pytest.raises(InputError, match="no value for any design"):
        distribution(speeds([np.nan], ["no trim"]))
    with pytest.raises(InputError, match="percentiles"):
        distribution(speeds([120.0], [""]), percentiles=(-1, 50))


def test_the_flutter_speed_of_the_xv15_hangs_on_its_control_system():
    """Control stiffness from 5000 to 22400 ft lbf/rad moves the boundary by 95 kt, the density by 5 % a few."""
    case = pp.load_case("xv15-uncoupled")
    inputs = {
        "rotor.control_stiffness": ("8000 ft*lbf/rad", "16000 ft*lbf/rad"),
        "operation.density": sampling.Relative(0.98, 1.02),
    }
    plan = sampling.saltelli(inputs, 16)
    found = study(case, plan, "280:480:25kt", "flutter")
    assert (found.flutter_note == "").all()
    indices = sobol_indices(found)
    assert indices.total.sel(input="rotor.control_stiffness") > 0.8
    assert indices.total.sel(input="operation.density") < 0.2
    values = distribution(found, percentiles=(0, 100)).value
    assert values[0] == found.flutter_speed.min() and values[1] == found.flutter_speed.max()
    assert "assumed" in distribution(found).attrs["reservations"]
