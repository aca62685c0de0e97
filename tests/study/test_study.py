"""Many designs at once: each as if it were alone, failures apart, flutter speeds as a root finder has them.

A batch must give the bits of batches of one point, so comparisons with `case.vary(...).linearize(...)` are exact;
one point that is no batch has a rendering of its own, which agrees to 1e-13.
"""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from click.testing import CliRunner
from scipy.optimize import brentq

import proprotor as pp
from proprotor import sampling
from proprotor.commands.main import main
from proprotor.errors import InputError
from proprotor.exchange.netcdf import load_results, save_results
from proprotor.model.first_order import state_matrix
from proprotor.study import workers as study_workers
from proprotor.study.batch import Analysis, Batch
from proprotor.study.study import study
from proprotor.study.variables import QUANTITIES, STABLE, UNSTABLE, variables
from proprotor.units import unit_registry

DEG, KT = np.pi / 180, 1852 / 3600
PRECONE, CHORD_MODE = "rotor.precone", "support.modes[chord].frequency"
CASE = pp.load_case("xv15-uncoupled")


def eigenvalues(numbers, airspeed, **options):
    """Of one design at one airspeed, from the model alone: a batch of one."""
    model = CASE.vary(numbers).linearize(np.array([airspeed]), **options)
    return np.linalg.eigvals(state_matrix(model))[0]


def by_frequency(values):
    """|Im s| first, the upper of a pair first, then Re s."""
    return np.array(sorted(values, key=lambda s: (abs(s.imag), s.imag < 0, s.real)))


# Layout -------------------------------------------------------------------------------------------


def test_a_grid_has_every_combination_and_each_is_that_of_the_design_alone():
    found = study(CASE, {PRECONE: ["1 deg", 0.05], CHORD_MODE: "5:6:0.5 Hz"}, [90.0, 130.0])
    assert found.eigenvalue.dims == (PRECONE, CHORD_MODE, "airspeed", "state")
    assert np.allclose(found[PRECONE], [DEG, 0.05], rtol=1e-15)
    assert np.allclose(found[CHORD_MODE], 2 * np.pi * np.array([5, 5.5, 6]), rtol=1e-15)
    assert (found.reason == "").all()
    for precone in found[PRECONE].values:
        for frequency in found[CHORD_MODE].values:
            for airspeed in found.airspeed.values:
                point = {PRECONE: precone, CHORD_MODE: frequency}
                alone = by_frequency(eigenvalues(point, airspeed))
                assert np.array_equal(found.eigenvalue.sel(point | {"airspeed": airspeed}), alone)


def test_a_list_has_designs_side_by_side():
    values = {PRECONE: [0.02, 0.04], CHORD_MODE: [30.0, 33.0], "operation.density": 1.1}
    found = study(CASE, sampling.points(values), 120.0)
    assert found.eigenvalue.dims == ("design", "state")
    assert found[PRECONE].dims == ("design",) and found.airspeed == 120.0
    assert np.array_equal(found["operation.density"], [1.1, 1.1])
    second = {PRECONE: 0.04, CHORD_MODE: 33.0, "operation.density": 1.1}
    assert np.array_equal(found.eigenvalue[1], by_frequency(eigenvalues(second, 120.0)))


def test_airspeed_may_be_an_input_of_each_design():
    found = study(CASE, sampling.points({PRECONE: [0.02, 0.04], "airspeed": ["200 kt", "250 kt"]}))
    assert found.growth_rate.dims == ("design",)
    assert np.allclose(found.airspeed, [200 * KT, 250 * KT], rtol=1e-15)
    alone = by_frequency(eigenvalues({PRECONE: 0.04}, float(found.airspeed[1])))
    assert np.array_equal(found.eigenvalue[1], alone)


def test_airspeeds_alone_make_a_study():
    found = study(CASE, {}, "200:220:10kt")
    assert found.eigenvalue.dims == ("design", "airspeed", "state") and found.sizes["airspeed"] == 3


def test_every_variable_has_its_unit_and_meaning():
    found = study(CASE, {PRECONE: [0.04]}, [120.0, 125.0], QUANTITIES)
    assert set(found.data_vars) == set(variables(QUANTITIES)) - {"missing"}  # nothing is
    units = {name: it.attrs.get("units") for name, it in found.variables.items()}
    assert units["eigenvalue"] == units["frequency"] == "rad/s"
    assert (units["growth_rate"], units["thrust"], units["torque"]) == ("1/s", "N", "N*m")
    assert (units[PRECONE], units["airspeed"], units["flutter_speed"]) == ("rad", "m/s", "m/s")
    assert all("long_name" in it.attrs for it in found.data_vars.values())
    assert "assumed" in found.attrs["reservations"] and found.attrs["case"] == "xv15-uncoupled"


def test_the_least_stable_mode_is_that_of_the_eigenvalues():
    found = study(CASE, {PRECONE: [0.0, 0.05]}, [100.0, 200.0, 230.0])
    values = found.eigenvalue.values
    ratio = -values.real / np.abs(values)
    assert np.array_equal(found.growth_rate, values.real.max(axis=-1))
    assert np.array_equal(found.damping_ratio, ratio.min(axis=-1))
    place = ratio.argmin(axis=-1)[..., None]
    assert np.array_equal(found.frequency, np.abs(np.take_along_axis(values, place, -1)[..., 0].imag))


def test_trim_is_that_of_the_model():
    found = study(CASE, {PRECONE: [0.02, 0.05]}, [100.0, 200.0], "trim")
    assert "eigenvalue" not in found
    trim = CASE.vary({PRECONE: 0.05}).linearize(np.array([200.0])).trim
    for name in ("collective", "coning", "lag", "elastic_pitch", "thrust", "torque"):
        assert float(found[name][1, 1]) == float(getattr(trim, name)[0])


def test_vectors_satisfy_the_equations_of_motion():
    found = study(CASE, {PRECONE: [0.02, 0.05]}, [100.0, 200.0], ["eigenvalue", "vectors"])
    model = CASE.vary({PRECONE: np.array([[0.02], [0.05]])}).linearize(np.array([[100.0, 200.0]]))
    s = found.eigenvalue.values[..., None, :]
    shape = found.vector.transpose(..., "dof", "state").values
    terms = [model.M @ (shape * s**2), model.C @ (shape * s), model.K @ shape]
    size = sum(np.abs(term) for term in terms).max(axis=-2)
    assert (np.abs(sum(terms)).max(axis=-2) < 1e-9 * size).all()
    assert np.allclose(np.abs(shape).max(axis=-2), 1, rtol=1e-12)


def test_options_are_those_of_the_model():
    found = study(CASE, {PRECONE: [0.04]}, 120.0, pitch="coupling", locked=("gimbal",))
    alone = by_frequency(eigenvalues({PRECONE: 0.04}, 120.0, pitch="coupling", locked=("gimbal",)))
    assert np.array_equal(found.eigenvalue[0], alone)


def test_followed_modes_are_the_same_eigenvalues_in_their_places():
    """At steps of 0.1 kt no mode of any design moves farther than to the nearest eigenvalue, and none is lost."""
    speeds = np.arange(200, 230, 0.2) * KT
    found = study(CASE, {PRECONE: [0.03, 0.05]}, speeds, ["eigenvalue", "modes", "vectors"])
    values = found.mode_eigenvalue.values
    assert np.array_equal(np.sort_complex(values), np.sort_complex(found.eigenvalue.values))
    assert np.array_equal(values[:, 0], found.eigenvalue[:, 0])
    steps = np.abs(np.diff(values, axis=1))
    nearest = np.abs(values[:, 1:, None, :] - values[:, :-1, :, None]).min(axis=-1)
    assert np.allclose(steps, nearest, rtol=1e-12)
    assert np.isnan(found.mode_quality[:, 0]).all() and (found.mode_quality[:, 1:] > 0.9).all()
    assert {"beam", "chord", "torsion"} <= set(found.mode_coordinate.values.ravel())


def test_modes_are_followed_over_failed_points_and_coarse_steps():
    fine = study(CASE, {PRECONE: [0.03, 0.05]}, np.arange(200, 240, 0.5) * KT, "modes").isel(
        airspeed=slice(None, None, 10)
    )
    coarse = study(CASE, {PRECONE: [0.03, np.nan, 0.05]}, np.arange(200, 240, 5) * KT, "modes")
    assert np.allclose(coarse.mode_eigenvalue[[0, 2]], fine.mode_eigenvalue, rtol=1e-9)
    assert np.isnan(coarse.mode_eigenvalue[1]).all() and (coarse.mode_coordinate[1] == "").all()


# Inputs -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "given", ["2 deg", 2 * DEG, unit_registry().Quantity(2, "deg"), ["2 deg"], np.array([2 * DEG])]
)
def test_an_input_may_have_any_unit(given):
    designs = sampling.grid({PRECONE: given}).resolve(pp.design_inputs(CASE))
    assert np.allclose(designs.values[PRECONE], [2 * DEG], rtol=1e-15)


def test_a_range_includes_its_end():
    designs = sampling.grid({PRECONE: "0:1:0.1 deg"}).resolve(pp.design_inputs(CASE))
    assert np.allclose(designs.values[PRECONE] / DEG, np.arange(11) / 10, rtol=1e-12)


WRONG = [
    (dict(inputs={"rotor.precon": [0.1]}), "rotor.precone"),
    (dict(inputs={"precone": [0.1]}), "unknown input"),
    (dict(inputs={PRECONE: "2 kg"}), "must be an angle"),
    (dict(inputs={PRECONE: "4:1:1 deg"}), "must rise"),
    (dict(inputs={PRECONE: "1:4:1 m"}), "must be an angle"),
    (dict(inputs={PRECONE: []}), "at least one"),
    (dict(inputs={PRECONE: [[0.1]]}), PRECONE),
    (dict(inputs=[1, 2]), "mapping"),
    (dict(inputs=sampling.points({PRECONE: [1, 2], CHORD_MODE: [1, 2, 3]})), "equal lengths"),
    (dict(inputs={PRECONE: [0.1], "airspeed": [100]}), "airspeed"),
    (dict(airspeed=None), "must be given"),
    (dict(airspeed=[[100.0]]), "list of speeds"),
    (dict(quantities="eigenvalues"), "did you mean eigenvalue"),
    (dict(quantities=()), "quantities"),
    (dict(quantities="flutter"), "range of increasing speeds"),
    (dict(quantities="flutter", airspeed=[120.0, 110.0]), "range of increasing speeds"),
    (dict(pich="rigid"), "did you mean pitch"),
    (dict(pitch="stiff"), "must be one of"),
    (dict(workers=0), "workers"),
    (dict(batch=0), "batch"),
    (dict(tolerance=-1.0), "tolerance"),
]


@pytest.mark.parametrize("wrong, told", WRONG)
def test_a_wrong_argument_is_told(wrong, told):
    with pytest.raises(InputError) as error:
        study(CASE, **({"inputs": {PRECONE: [0.04]}, "airspeed": 120.0} | wrong))
    assert told in str(error.value)


def test_a_latin_hypercube_has_one_design_in_each_layer():
    inputs = {PRECONE: ("1 deg", "3 deg"), CHORD_MODE: sampling.Relative(0.9, 1.1)}
    designs = sampling.latin_hypercube(inputs, 50, seed=3).resolve(pp.design_inputs(CASE))
    nominal = pp.design_inputs(CASE)[CHORD_MODE].si
    for name, low, high in ((PRECONE, DEG, 3 * DEG), (CHORD_MODE, 0.9 * nominal, 1.1 * nominal)):
        layers = np.floor((designs.values[name] - low) / (high - low) * 50)
        assert sorted(layers) == list(range(50))


def test_a_sobol_sequence_has_one_design_in_each_dyadic_layer():
    """A (0, m, 1)-net in each coordinate, scrambled or not."""
    designs = sampling.sobol({PRECONE: (0, 1), CHORD_MODE: (0, 1)}, 64).resolve(pp.design_inputs(CASE))
    for values in designs.values.values():
        assert sorted(np.floor(values * 64)) == list(range(64))
    with pytest.raises(InputError, match="power of two"):
        sampling.sobol({PRECONE: (0, 1)}, 100)


def test_a_normal_input_has_its_mean_and_deviation():
    inputs = {PRECONE: sampling.Normal("2 deg", "0.5 deg")}
    values = sampling.sobol(inputs, 4096).resolve(pp.design_inputs(CASE)).values[PRECONE]
    assert abs(values.mean() / DEG - 2) < 0.01 and abs(values.std() / DEG - 0.5) < 0.01
    assert abs(np.mean(values < 2.5 * DEG) - 0.8413) < 0.002  # one deviation above the mean


@pytest.mark.parametrize("given", [("3 deg", "1 deg"), "1 deg", (1, 2, 3), sampling.Normal(1, 0)])
def test_a_wrong_distribution_is_told(given):
    with pytest.raises(InputError, match=PRECONE):
        sampling.latin_hypercube({PRECONE: given}, 4).resolve(pp.design_inputs(CASE))


# Failures -----------------------------------------------------------------------------------------


def test_failed_points_have_their_reason_and_spoil_no_other():
    """No such blade, no number, no trim at rest, tip Mach above 1; the others to the last bit."""
    hinge = CASE.rotor.lag_hinge_offset
    inputs = {
        PRECONE: [0.04, 0.04, np.nan, 0.05, 0.03],
        "rotor.lag_hinge_offset": [hinge, 0.1, hinge, hinge, hinge],
    }
    found = study(CASE, sampling.points(inputs), [0.0, 120.0, 300.0], (*QUANTITIES[:3],))
    reason = found.reason.values
    assert (reason[[0, 3, 4], 1] == "").all()
    assert all("rotor.lag_hinge_offset = 0.1 m: must not lie inboard" in text for text in reason[1])
    assert all("rotor.precone" in text and "finite" in text for text in reason[2])
    assert all("windmilling" in text for text in reason[[0, 3, 4], 0])
    assert all("Mach" in text for text in reason[[0, 3, 4], 2])
    assert (np.isnan(found.growth_rate) == (found.reason != "")).all()
    assert (np.isnan(found.eigenvalue).all("state") == (found.reason != "")).all()
    good = {name: [values[row] for row in (0, 3, 4)] for name, values in inputs.items()}
    whole = study(CASE, sampling.points(good), 120.0)
    assert np.array_equal(found.eigenvalue[[0, 3, 4], 1], whole.eigenvalue)


def test_a_single_matrix_that_lapack_refuses_spoils_no_other(monkeypatch):
    """Whatever point of the batch is refused: it alone has the reason."""
    genuine = np.linalg.eigvals
    target = state_matrix(CASE.vary({PRECONE: 0.05}).linearize(np.array([130.0])))[0]

    def refuses(matrices):
        if (matrices.reshape(-1, *target.shape) == target).all(axis=(-2, -1)).any():
            raise np.linalg.LinAlgError("Eigenvalues did not converge")
        return genuine(matrices)

    whole = study(CASE, {PRECONE: [0.04, 0.05, 0.03]}, [120.0, 130.0, 140.0])
    monkeypatch.setattr(np.linalg, "eigvals", refuses)
    found = study(CASE, {PRECONE: [0.04, 0.05, 0.03]}, [120.0, 130.0, 140.0])
    expected = np.zeros((3, 3), dtype=bool)
    expected[1, 1] = True
    assert np.array_equal(found.reason == "Eigenvalues did not converge", expected)
    assert np.array_equal(found.eigenvalue.values[~expected], whole.eigenvalue.values[~expected])


def test_a_study_in_which_all_fails_is_a_result():
    found = study(CASE, {PRECONE: [np.nan, 2.0]}, [100.0, 120.0], ("least_stable", "flutter"))
    assert np.isnan(found.growth_rate).all() and (found.reason != "").all()
    assert np.isnan(found.flutter_speed).all() and (found.flutter_note != "").all()


# Flutter speed ------------------------------------------------------------------------------------


def largest_growth(numbers, airspeed):
    return eigenvalues(numbers, airspeed).real.max()


def test_flutter_speed_is_that_of_a_root_finder_on_single_points():
    inputs = sampling.points({PRECONE: [0.03, 0.05, 0.045], CHORD_MODE: [33.6, 33.6, 31.0]})
    found = study(CASE, inputs, "160:460:20kt", "flutter")
    assert (found.flutter_note == "").all()
    for design in range(3):
        numbers = {name: float(found[name][design]) for name in (PRECONE, CHORD_MODE)}
        growth = [largest_growth(numbers, speed) for speed in found.airspeed.values]
        first = next(place for place, value in enumerate(growth) if value > 0)
        ends = found.airspeed.values[first - 1], found.airspeed.values[first]
        exact = brentq(lambda speed, numbers=numbers: largest_growth(numbers, speed), *ends, xtol=1e-9)
        assert abs(float(found.flutter_speed[design]) - exact) < 1e-6
        at_boundary = eigenvalues(numbers, exact)
        expected = abs(at_boundary[at_boundary.real.argmax()].imag)
        assert abs(float(found.flutter_frequency[design]) - expected) < 1e-5 * expected
        assert found.flutter_coordinate[design] == "chord"


def test_a_design_whose_search_meets_a_bad_input_spoils_no_other():
    """A frequency that is none between two airspeeds of the range, where one design has its boundary."""
    inputs = sampling.points({CHORD_MODE: [30.0, 28.0, 29.5, 29.0]})
    # Without pitch equations no mode is undamped: the growth whose zero is sought is none of rounding.
    options = {"structure": "tabulated", "pitch": "coupling"}

    def flap(gap):
        return lambda speed: np.where((speed > gap[0]) & (speed < gap[1]), -1.0, 1.85)

    def analysed(gap):
        table = pp.BladeFrequencies(
            at_rotor_speed=CASE.operation.rotor_speed,
            against="airspeed",
            at=[0, 300],
            flap=flap(gap),
            lag=1.2,
        )
        return study(CASE, inputs, "160:460:20kt", "flutter", frequencies=table, workers=1, **options)

    whole = analysed((0.0, 0.0))
    speeds = whole.flutter_speed.values
    assert np.isfinite(speeds).all() and speeds[1] != speeds[0]
    found = analysed((speeds[1] - 0.02, speeds[1] + 0.02))
    expected = np.array([False, True, False, False])
    assert np.array_equal(np.isnan(found.flutter_speed), expected)
    assert "frequencies" in str(found.flutter_note.values[1])
    for name in ("flutter_speed", "flutter_frequency", "flutter_coordinate"):
        assert np.array_equal(found[name].values[~expected], whole[name].values[~expected]), name


@pytest.mark.parametrize("quantities", ["flutter", "modes", "eigenvalue", ("flutter", "least_stable")])
def test_a_batch_of_nothing_but_bad_inputs_says_why(quantities):
    found = study(CASE, {PRECONE: [2.0, 3.0]}, [120.0, 140.0], quantities, workers=1)
    for place, precone in enumerate((2.0, 3.0)):
        with pytest.raises(InputError) as refused:
            CASE.vary({PRECONE: precone})
        reason = " ".join(str(refused.value).split("\n"))
        assert (found.reason.values[place] == reason).all()
        assert "flutter" not in quantities or found.flutter_note.values[place] == reason


def test_an_airspeed_of_one_design_that_is_none_spoils_no_other():
    inputs = {PRECONE: [0.04, 0.05, 0.03], "airspeed": [120.0, -1.0, 140.0]}
    found = study(CASE, sampling.points(inputs))
    assert (found.reason.values != "").tolist() == [False, True, False]
    assert "airspeed" in str(found.reason.values[1])
    alone = study(CASE, sampling.points({name: values[2:] for name, values in inputs.items()}))
    assert np.array_equal(found.eigenvalue[2], alone.eigenvalue[0])


def test_designs_without_a_flutter_speed_say_why():
    found = study(CASE, {PRECONE: [0.04]}, [100.0, 110.0], "flutter")
    assert np.isnan(found.flutter_speed) and found.flutter_note == STABLE
    found = study(CASE, {PRECONE: [0.04]}, [230.0, 231.0], "flutter")
    assert np.isnan(found.flutter_speed) and found.flutter_note == UNSTABLE


# Batches and processes ----------------------------------------------------------------------------

SAMPLE = sampling.latin_hypercube({PRECONE: ("1 deg", "4 deg"), CHORD_MODE: sampling.Relative(0.9, 1.1)}, 30)


@pytest.fixture(scope="module")
def reference():
    return study(CASE, SAMPLE, [110.0, 120.0], workers=1)


@pytest.mark.parametrize("how", [dict(batch=7), dict(batch=1), dict(batch=9, workers=2)])
def test_results_do_not_depend_on_batches_and_processes(reference, how):
    xr.testing.assert_identical(study(CASE, SAMPLE, [110.0, 120.0], **how), reference)


def test_a_long_line_of_airspeeds_is_divided():
    speeds = np.linspace(100, 150, 23)
    inputs = {PRECONE: [0.03, 0.04]}
    xr.testing.assert_identical(study(CASE, inputs, speeds, batch=5), study(CASE, inputs, speeds))


def test_a_worker_has_one_blas_thread_and_ends_with_its_input():
    worker = study_workers.Worker()
    try:
        assert worker.ask(print) is None  # anything that can be called is taken for an analysis
        names = worker.ask(())  # "analysed" by print, which answers nothing and writes elsewhere
        assert names is None and worker.lives
        worker.process.stdin.close()
        assert worker.process.wait(timeout=30) == 0
    finally:
        worker.end()


class Deadly(study_workers.Worker):
    """Killed as it is asked, the first times that it is asked for a batch."""

    deaths = 0

    def ask(self, message):
        if isinstance(message, Batch) and Deadly.deaths > 0:
            Deadly.deaths -= 1
            self.process.kill()
        return super().ask(message)


@pytest.fixture
def deadly(monkeypatch):
    study_workers.end_workers()
    monkeypatch.setattr(study_workers, "Worker", Deadly)
    yield Deadly
    study_workers.end_workers()


def test_a_worker_that_dies_loses_nothing(reference, deadly):
    """Its batch goes to another process."""
    deadly.deaths = 2
    found = study(CASE, SAMPLE, [110.0, 120.0], batch=6, workers=2)
    assert deadly.deaths == 0
    xr.testing.assert_identical(found, reference)


def test_a_batch_that_kills_every_worker_is_told(deadly):
    deadly.deaths = 100
    batch = Batch({PRECONE: np.array([0.04])}, np.array([100.0]))
    with pytest.raises(RuntimeError, match="has killed 3 worker processes"):
        list(study_workers.Processes(Analysis(CASE, ("trim",)), [(0, batch)], 1).results())
    assert deadly.deaths == 97 and study_workers.idle_workers() == 0


def test_a_case_that_other_processes_cannot_load_is_analysed_here(reference):
    twist = CASE.rotor.twist
    local = replace(CASE, rotor=replace(CASE.rotor, twist=lambda r: np.interp(r, *twist)))
    values = sampling.points({"airspeed": np.linspace(100, 120, 6)})
    with pytest.warns(UserWarning, match="one process analyses the study"):
        found = study(local, values, workers=2, batch=3)
    assert (found.reason == "").all()


def test_an_error_of_the_program_is_no_failed_point():
    broken = replace(CASE, support="none")
    with pytest.raises(AttributeError):
        study(broken, {"airspeed": [100.0, 110.0]})


def test_a_progress_bar_counts_points(capsys):
    study(CASE, {PRECONE: [0.04]}, [0.0, 110.0, 120.0, 130.0], batch=2, progress=True)
    told = capsys.readouterr().err
    assert "4/4" in told and "1 failed" in told
    study(CASE, {PRECONE: [0.04]}, 110.0)
    assert capsys.readouterr().err == ""


# Files --------------------------------------------------------------------------------------------


def test_results_come_back_from_a_file_as_they_were(tmp_path):
    found = study(CASE, {PRECONE: [0.04, np.nan], CHORD_MODE: [30.0, 33.0]}, [100.0, 120.0], QUANTITIES)
    save_results(found, tmp_path / "study.nc")
    loaded = load_results(tmp_path / "study.nc")
    assert set(loaded.variables) == set(found.variables) and loaded.attrs == found.attrs
    for name, variable in found.variables.items():
        assert loaded[name].dims == variable.dims and loaded[name].attrs == variable.attrs
        if variable.dtype.kind in "fc":
            assert loaded[name].dtype == variable.dtype
            assert np.array_equal(loaded[name], variable, equal_nan=True)
            assert np.array_equal(np.signbit(loaded[name].values.imag), np.signbit(variable.values.imag))
        else:
            assert (loaded[name].values == variable.values).all()


def test_any_reader_opens_a_file_of_results(tmp_path):
    found = study(CASE, {PRECONE: [0.04]}, [100.0, 120.0])
    save_results(found, tmp_path / "study.nc")
    with xr.open_dataset(tmp_path / "study.nc") as plain:
        assert np.array_equal(plain.eigenvalue_real, found.eigenvalue.real)
        assert np.array_equal(plain.eigenvalue_imag, found.eigenvalue.imag)
        assert plain.eigenvalue_real.attrs["units"] == "rad/s" and plain.airspeed.attrs["units"] == "m/s"
        assert {it.dtype.kind for it in plain.variables.values()} <= set("fiUO")


def test_a_tracked_sweep_can_be_stored_too(tmp_path):
    found = CASE.sweep([100.0, 110.0, 120.0])
    save_results(found, tmp_path / "sweep.nc")
    loaded = load_results(tmp_path / "sweep.nc")
    assert np.array_equal(loaded.eigenvalue, found.eigenvalue, equal_nan=True)
    assert np.array_equal(loaded["shape"], found["shape"], equal_nan=True)


def test_a_file_that_cannot_be_is_told(tmp_path):
    found = study(CASE, {PRECONE: [0.04]}, 100.0)
    for path, told in (("study.txt", "must end in .nc"), ("missing/study.nc", "folder that exists")):
        with pytest.raises(InputError, match=told):
            save_results(found, tmp_path / path)
    (tmp_path / "folder.nc").mkdir()
    with pytest.raises(InputError, match="must be a file"):
        save_results(found, tmp_path / "folder.nc")
    (tmp_path / "text.nc").write_text("no results")
    for path, told in (("none.nc", "no such file"), ("text.nc", "cannot be read")):
        with pytest.raises(InputError, match=told):
            load_results(tmp_path / path)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["folder.nc", "text.nc"]


# Command line -------------------------------------------------------------------------------------


@pytest.fixture
def run():
    return lambda *arguments: CliRunner().invoke(main, ["study", *arguments])


def test_the_command_writes_what_the_function_finds(run, tmp_path):
    path = tmp_path / "study.nc"
    done = run("xv15-uncoupled", "--vary", f"{PRECONE}=1:3:1 deg", "--vary", f"{CHORD_MODE}=5 Hz, 6 Hz",
               "--speed", "200 kt", "--pitch", "coupling", "--out", str(path))  # fmt: skip
    assert done.exit_code == 0, done.output
    assert "6 points, 0 failed" in done.output and "assumed" in done.output
    expected = study(CASE, {PRECONE: "1:3:1 deg", CHORD_MODE: ["5 Hz", "6 Hz"]}, "200 kt", pitch="coupling")
    loaded = load_results(path)
    assert loaded.eigenvalue.shape == (3, 2, expected.sizes["state"])
    assert np.allclose(
        loaded.eigenvalue, expected.eigenvalue.values.reshape(loaded.eigenvalue.shape), rtol=1e-15
    )


def test_the_command_samples_and_finds_flutter_speeds(run, tmp_path):
    path = tmp_path / "study.nc"
    done = run("xv15-uncoupled", "--vary", f"{PRECONE}=1:3 deg", "--vary", f"{CHORD_MODE}=0.9:1.1 of deck", "--sample",
               "sobol", "--size", "8", "--speed", "160:460:30kt", "--flutter", "--out", str(path))  # fmt: skip
    assert done.exit_code == 0, done.output
    assert "flutter speed" in done.output
    loaded = load_results(path)
    assert json.loads(loaded.attrs["sample"])["method"] == "sobol" and loaded.sizes["design"] == 8
    assert (np.isfinite(loaded.flutter_speed) | (loaded.flutter_note != "")).all()


def test_the_command_tells_what_is_wrong(run, tmp_path):
    speed = ("--speed", "200 kt")
    for arguments, told in (
        (("--vary", "rotor.precon=1 deg", *speed), "rotor.precone"),
        (("--vary", PRECONE, *speed), "--vary"),
        (("--vary", f"{PRECONE}=1 deg", "--vary", f"{PRECONE}=2 deg", *speed), "twice"),
        (("--vary", f"{PRECONE}=1 deg", "--sample", "sobol", *speed), "two limits"),
        (("--vary", f"{PRECONE}=1 deg", *speed, "--out", "study.csv"), "must end in .nc"),
        (("--vary", f"{PRECONE}=1 deg", "--speed", "200"), "unit"),
    ):
        done = run("xv15-uncoupled", *arguments)
        assert done.exit_code == 2 and told in done.output, done.output


def test_a_study_in_which_all_fails_ends_with_code_1(run):
    done = run("xv15-uncoupled", "--vary", f"{PRECONE}=100 deg", "--speed", "200 kt")
    assert done.exit_code == 1 and "1 failed" in done.output and "within 90 deg" in done.output


# Documentation ------------------------------------------------------------------------------------

DOCS = (Path(__file__).parents[2] / "docs" / "studies.md").read_text(encoding="utf-8")


def test_the_examples_of_the_documentation_run(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names = {}
    for code in re.findall(r"```python\n(.*?)```", DOCS, re.DOTALL):
        exec(code, names)
        assert capsys.readouterr().out
    assert (names["found"].flutter_note == "").all() and (names["sampled"].flutter_note == "").all()


def test_the_documentation_names_every_quantity():
    assert [name for name in QUANTITIES if f'`"{name}"`' not in DOCS] == []
