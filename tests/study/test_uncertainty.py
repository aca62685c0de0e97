"""Distributions and Sobol indices: against functions whose indices and percentiles are known.

The Ishigami function sin x1 + a sin² x2 + b x3⁴ sin x1 with x uniform on (−π, π), a = 7, b = 0.1 has (Ishigami and
Homma, 1990) the variance a²/8 + bπ⁴/5 + b²π⁸/18 + 1/2, of which (1 + bπ⁴/5)²/2 is x1's alone, a²/8 x2's, and
b²π⁸ (1/18 − 1/50) that of x1 with x3.
"""

import json

import numpy as np
import pytest
import xarray as xr

import proprotor as pp
from proprotor import sampling
from proprotor.datum import Datum
from proprotor.errors import InputError
from proprotor.exchange.netcdf import load_results, save_results
from proprotor.study.study import study
from proprotor.study.uncertainty import distribution, share_below, sobol_indices
from proprotor.study.variables import STABLE, UNSTABLE
from proprotor.tables.percentiles import percentile_text

A, B = 7.0, 0.1
KNOWN = {f"x{place}": Datum("1", 1.0, "", "assumed", "") for place in (1, 2, 3)}


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


def drawn_by_chance(seed, size=256):
    """Results of y = 3 x1 + x2 over base samples that are independent draws, laid out as SALib's."""
    one, other = np.random.default_rng(seed).random((2, size, 2))
    first, second = (np.where(np.arange(2) == place, other, one) for place in (0, 1))
    x = np.stack([one, first, second, other], axis=1).reshape(-1, 2)
    sample = {"method": "saltelli", "size": size, "seed": seed, "inputs": ["x1", "x2"], "second_order": False}
    return xr.Dataset({"y": ("design", 3 * x[:, 0] + x[:, 1])}, attrs={"sample": json.dumps(sample)})


def held(samples, level):
    """How many of the intervals of first and total shares hold the true ones, 9/10 and 1/10."""
    count = 0
    for sample in samples:
        found = sobol_indices(sample, of="y", confidence=level)
        for name in ("first", "total"):
            count += int((np.abs(found[name] - [0.9, 0.1]) < found[f"{name}_half_interval"]).sum())
    return count


def test_intervals_hold_the_true_shares_as_often_as_they_say():
    """Of 160 intervals of 40 samples of independent draws; the limits are four deviations of 80 that are independent.

    A Sobol sequence is better than chance, and its intervals, which do not know it, hold more often.
    """
    by_chance = list(map(drawn_by_chance, range(40)))
    for level in (0.95, 0.5):
        off = 4 * 160 * np.sqrt(level * (1 - level) / 80)
        assert abs(held(by_chance, level) - 160 * level) < off, level
    plans = (sampling.saltelli(dict.fromkeys(("x1", "x2"), (0, 1)), 64, seed=seed) for seed in range(20))
    assert held((results(plan, lambda x1, x2: 3 * x1 + x2) for plan in plans), 0.95) >= 76


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


def speeds(values, notes, above=None):
    """Flutter speeds of a sample between 100 and 200 m/s; `above`, limits of designs that stay stable up to there."""
    stable, unstable = np.array(notes) == STABLE, np.array(notes) == UNSTABLE
    data = {
        "flutter_speed": ("design", np.array(values, dtype=float), {"units": "m/s"}),
        "flutter_speed_above": ("design", np.where(stable, 200.0 if above is None else above, np.nan)),
        "flutter_speed_below": ("design", np.where(unstable, 100.0, np.nan)),
        "flutter_note": ("design", np.array(notes, dtype=object)),
    }
    drawn = {"sample": json.dumps({"method": "sobol"})}
    return xr.Dataset(data, {"airspeed": ("airspeed", [100.0, 200.0])}, drawn)


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
    assert list(found.at_least.values) == [-np.inf, 160, 180, 200, 200]
    assert list(found.at_most.values) == [100, 160, 180, np.inf, np.inf]
    assert share_below(study_found, 155.0) == 4 / 9
    assert share_below(study_found, 200.0) == 7 / 9 and share_below(study_found, 100.0) == 1 / 9
    for limit in (90.0, 210.0):
        with pytest.raises(InputError, match="airspeeds of the study"):
            share_below(study_found, limit)


def test_limits_within_the_values_leave_a_percentile_between_two_bounds():
    """One design failed from 140 m/s on and was stable below: it may be any of those above 140, and moves the rest.

    In order 110, 120, (140 to inf), 150, 160: the third is 140 if it lies at its limit, and 150 if beyond.
    """
    part = f"{STABLE}; 2 airspeeds failed, at 150 m/s: tip Mach"
    found = speeds(
        [150, np.nan, 120, 160, 110], ["", part, "", "", ""], [np.nan, 140, np.nan, np.nan, np.nan]
    )
    found["flutter_speed_above"][1] = 140.0
    percent = distribution(found, percentiles=(40, 60, 80, 100))
    assert list(percent.at_least.values) == [120, 140, 150, 160]
    assert list(percent.at_most.values) == [120, 150, 160, np.inf]
    np.testing.assert_array_equal(percent.value, [120, np.nan, np.nan, np.inf])
    assert [percentile_text(percent, place) for place in range(4)] == [
        "120.00",
        "140.00 to 150.00",
        "150.00 to 160.00",
        "> 160.00",
    ]
    assert share_below(found, 140.0) == 2 / 5
    with pytest.raises(InputError, match=r"limit = 141.*known, -inf to 140 m/s"):
        share_below(found, 141.0)


def test_a_design_unstable_from_the_start_lies_below_whatever_mode_follows():
    """Stability is lost below 100 m/s; that a second mode becomes unstable at 180 m/s does not make it better."""
    found = speeds([180.0, 120.0], [UNSTABLE, ""])
    percent = distribution(found, percentiles=(50, 100))
    assert list(percent.value.values) == [-np.inf, 120] and (percent.known, percent.below) == (1, 1)
    assert share_below(found, 110.0) == 1 / 2


def test_designs_that_were_chosen_have_no_percentiles():
    chosen = speeds([120.0, 150.0], ["", ""]).drop_attrs()
    for of_sample in (distribution, lambda found: share_below(found, 130.0)):
        with pytest.raises(InputError, match=r"drawn at random.*a grid has no percentiles"):
            of_sample(chosen)
    for plan, drawn in (
        (sampling.points({"x1": [1.0, 2.0]}), False),
        (sampling.points({"x1": [1.0, 2.0]}, drawn=True), True),
        (sampling.latin_hypercube({"x1": (0, 1)}, 2), True),
        (sampling.grid({"x1": [1.0, 2.0]}), False),
    ):
        assert ("sample" in plan.resolve(KNOWN).attributes) == drawn


def test_results_of_before_without_limits_are_refused():
    with pytest.raises(InputError, match="flutter_speed_above and flutter_speed_below: run the study again"):
        distribution(speeds([120.0], [""]).drop_vars("flutter_speed_above"))


def test_a_number_beside_the_flutter_speed_is_known_of_stable_designs_too():
    """The least damping of a design is a number, whether a mode becomes unstable or not."""
    found = speeds([120.0, np.nan], ["", STABLE]).assign(flutter_least_damping=("design", [-0.1, 0.2]))
    percent = distribution(found, "flutter_least_damping", (50, 100))
    assert list(percent.value.values) == [-0.1, 0.2] and percent.above == 0


def test_indices_say_what_became_of_designs_beyond_the_airspeeds(sampled):
    """Cut off at a limit, the indices are those of the function cut off: here of min(x, 0.9) and x alone matters."""
    plan = sampling.saltelli(dict.fromkeys(("x1", "x2"), (0, 1)), 256)
    found = results(plan, lambda x1, x2: 100 * x1 + 100)
    y, limit = found.y.values, 190.0
    beyond = y >= limit
    flutter = speeds(np.where(beyond, np.nan, y), np.where(beyond, STABLE, ""), limit)
    flutter = flutter.assign_attrs(found.attrs)
    with pytest.raises(InputError, match='widen the airspeeds, or take beyond="limit"'):
        sobol_indices(flutter)
    with pytest.raises(InputError, match='beyond = limits: must be "left out" or "limit"'):
        sobol_indices(flutter, beyond="limits")
    cut = sobol_indices(flutter, beyond="limit")
    other = sobol_indices(found.assign(y=("design", np.minimum(y, limit))), of="y")
    np.testing.assert_array_equal(cut.total, other.total)
    assert cut.left_out == 0 and cut.at_limit == beyond.sum()
    assert cut.attrs["treatment"] == (
        f"0 of 256 base samples are left out; {beyond.sum()} designs beyond the airspeeds of the study count with "
        "their limit."
    )
    few = speeds(np.where(y > 199.5, np.nan, y), np.where(y > 199.5, STABLE, ""), 199.5)
    told = sobol_indices(few.assign_attrs(found.attrs)).attrs["treatment"]
    left_out = int((y.reshape(-1, 4) > 199.5).any(axis=1).sum())
    assert 0 < left_out < 13
    assert told == (
        f"{left_out} of 256 base samples are left out, {left_out} of them for a design beyond the airspeeds of the "
        "study."
    )
    assert sobol_indices(sampled, of="y").attrs["treatment"] == "0 of 2048 base samples are left out."


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
