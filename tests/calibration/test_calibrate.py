"""Inputs fitted to test points: known inputs come back within their covariance, and doubts are told."""

from functools import cache

import numpy as np
import pytest
from scipy.stats import chi2

import proprotor as pp
from proprotor.calibration.predicted import Predictor
from proprotor.calibration.targets import targets_of

CASE = pp.load_case("xv15-uncoupled")
INPUTS = ("rotor.control_stiffness", "support.modes[chord].frequency", "support.modes[beam].damping_ratio")
SHARES = (1.12, 0.97, 0.9)  # of the values of the deck: the values that are to come back
SPEEDS = (80.0, 120.0, 150.0)
MODES = ("beam", "chord")
FREQUENCY_ERROR, DAMPING_ERROR = 0.003, 0.001  # relative, absolute


def start(path):
    return float(CASE.given[path].si)


@cache
def truth():
    return CASE.vary({path: share * start(path) for path, share in zip(INPUTS, SHARES, strict=True)})


@cache
def exact():
    """Frequency and damping of the modes of the true design, by the sweep."""
    found = truth().sweep(list(SPEEDS))
    return [
        (speed, mode, *(float(found[name].sel(mode=mode)[place]) for name in ("frequency", "damping_ratio")))
        for place, speed in enumerate(SPEEDS)
        for mode in MODES
    ]


def written_points(
    folder, seed=None, head="airspeed [m/s], frequency [rad/s], frequency_error, damping, damping_error, mode"
):
    """Test points with noise of the stated errors."""
    random = np.random.default_rng(seed)
    lines = [head]
    for speed, mode, frequency, damping in exact():
        error = FREQUENCY_ERROR * frequency
        if seed is not None:
            frequency, damping = random.normal(frequency, error), random.normal(damping, DAMPING_ERROR)
        lines.append(f"{speed}, {frequency!r}, {error!r}, {damping!r}, {DAMPING_ERROR}, {mode}")
    (folder / "points.csv").write_text("\n".join(lines))
    return pp.read_points(folder / "points.csv")


def test_exact_points_give_the_inputs_back(tmp_path):
    found = pp.calibrate(CASE, written_points(tmp_path), INPUTS).found
    assert found.value.values / [start(path) for path in INPUTS] == pytest.approx(SHARES, rel=1e-6)
    assert found.attrs["chi_squared"] < 1e-8 and found.warning.item() == ""
    assert np.abs(found.misfit.values).max() < 1e-4


def test_inputs_come_back_within_their_covariance(tmp_path):
    """(p - p0)ᵀ V⁻¹ (p - p0) of records with independent noise is χ² with as many degrees of freedom as inputs."""
    total, misfits, count = 0.0, 0.0, 6
    expected = np.array(SHARES) * [start(path) for path in INPUTS]
    for seed in range(count):
        found = pp.calibrate(CASE, written_points(tmp_path, seed), INPUTS).found
        off = found.value.values - expected
        total += off @ np.linalg.solve(found.covariance.values, off)
        misfits += found.attrs["chi_squared"]
    freedom = count * len(INPUTS)
    assert chi2.cdf(total, freedom) > 1e-4 and chi2.sf(total, freedom) > 1e-4
    freedom = count * (2 * len(exact()) - len(INPUTS))
    assert chi2.cdf(misfits, freedom) > 1e-4 and chi2.sf(misfits, freedom) > 1e-4


def test_derivatives_are_those_of_differences(tmp_path):
    targets = targets_of(written_points(tmp_path), CASE)
    predictor = Predictor(CASE, INPUTS, targets, {})
    at = predictor.at.copy()
    found = predictor.move_to(at)
    for place, value in enumerate(at):
        step = 1e-3 * value * (np.arange(len(at)) == place)
        one, two = (predictor.values(at + far * step) - predictor.values(at - far * step) for far in (1, 2))
        difference = (8 * one - two) / (12e-3 * value)
        assert found[:, place] == pytest.approx(difference, rel=1e-6, abs=1e-8 * np.abs(difference).max())


def test_an_input_without_effect_is_told(tmp_path):
    """The wing of the deck xv15 has stiffnesses that are fitted to its frequencies: their own values have no effect."""
    inputs = ["rotor.control_stiffness", "support.chord_stiffness"]
    case = pp.load_case("xv15")
    found = pp.calibrate(case, written_points(tmp_path), inputs).found
    assert "the points do not tell +1.00 support.chord_stiffness" in found.warning.item()
    size = float(case.given["support.chord_stiffness"].si)
    assert found.standard_error.sel(input="support.chord_stiffness").item() > 100 * size


def test_a_bound_holds_and_is_told(tmp_path):
    stiffness = start(INPUTS[0])
    bounds = {INPUTS[0]: (0.9 * stiffness, 1.05 * stiffness), INPUTS[1]: None, INPUTS[2]: None}
    found = pp.calibrate(CASE, written_points(tmp_path), bounds).found
    assert found.value.values[0] == pytest.approx(1.05 * stiffness, rel=1e-6)
    assert found.at_bound.values.tolist() == [True, False, False]
    assert f"{INPUTS[0]} is at a bound" in found.warning.item()
    assert found.standard_error.values[0] == 0


def test_a_misfit_beyond_the_errors_is_told(tmp_path):
    found = pp.calibrate(CASE, written_points(tmp_path), [INPUTS[2]]).found
    assert found.attrs["chance"] < 0.01 and "more than their errors explain" in found.warning.item()


def test_the_deck_has_the_values_and_where_they_come_from(tmp_path):
    points = written_points(tmp_path, 3)
    calibration = pp.calibrate(CASE, points, INPUTS)
    text = pp.calibrated_deck(calibration, "xv15-uncoupled", tmp_path / "new.toml")
    (tmp_path / "new.toml").write_text(text)
    again = pp.load_case(tmp_path / "new.toml")
    for path, value in zip(INPUTS, calibration.found.value.values, strict=True):
        number = again.given[path]
        assert float(number.si) == pytest.approx(value, rel=1e-10)
        assert number.status == "calibrated" and number.source.startswith(
            "calibrated to points.csv, standard error"
        )
    assert (
        "support.modes[chord].frequency" in again.calibration
        and "damping of beam, chord in points.csv" in again.calibration
    )
    assert again.title.endswith("(calibrated to points.csv)")
    first, second = (case.linearize(120.0).modes().eigenvalue.values for case in (calibration.case, again))
    assert first == pytest.approx(second, rel=1e-8)
    others = set(CASE.given) - set(INPUTS)
    assert all(again.given[path].status == CASE.given[path].status for path in others)


def test_points_may_have_the_units_of_a_test(tmp_path):
    """Equivalent airspeed, frequency per revolution and percent, with the ends of the error bar."""
    speed, mode, frequency, damping = exact()[1]
    density = (float(CASE.operation.density) / 1.225) ** 0.5
    per_rev = frequency / float(CASE.operation.rotor_speed)
    head = "airspeed [keas], frequency [per rev], frequency_error, damping [%], damping_low, damping_high"
    percent = 100 * damping
    row = f"{speed * density * 3600 / 1852!r},{per_rev!r},0.01,{percent!r},{percent - 0.2},{percent + 0.4}"
    (tmp_path / "a.csv").write_text(f"{head}\n{row}")
    first, second = targets_of(pp.read_points(tmp_path / "a.csv"), CASE, mode)
    assert first[:3] == (pytest.approx(speed, rel=1e-4), mode, "frequency")
    assert first.value == pytest.approx(frequency) and first.error == pytest.approx(
        0.01 * frequency / per_rev
    )
    assert second.value == pytest.approx(damping) and second.error == pytest.approx(0.003)


@pytest.mark.parametrize(
    ("inputs", "how", "told"),
    [
        (["rotor.precon"], {}, "rotor.precon: unknown input"),
        ([], {}, "inputs: must name at least one input"),
        ({INPUTS[0]: (1.0, 2.0)}, {}, f"{INPUTS[0]} = "),
        ({INPUTS[0]: "1 N"}, {}, f"{INPUTS[0]} = 1 N: must have two bounds"),
        (INPUTS, {"section_dampin": True}, "section_dampin"),
    ],
)
def test_inputs_that_cannot_be_are_refused(tmp_path, inputs, how, told):
    with pytest.raises(pp.InputError) as caught:
        pp.calibrate(CASE, written_points(tmp_path), inputs, **how)
    assert str(caught.value).startswith(told)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            "airspeed [m/s], frequency [Hz], frequency_error\n100, 3, 0.1",
            "must name its mode in a column mode",
        ),
        ("airspeed [m/s], frequency [Hz], mode\n100, 3, beam", "needs the error of its frequency"),
        (
            "airspeed [m/s], frequency [Hz], frequency_error, damping, damping_error, mode\n"
            "100, 3, 0.1, 0.1, 0.1, bean\n90, 3, 0.1, 0.1, 0.1, beam",
            "mode = bean: unknown mode",
        ),
        ("frequency [Hz], damping, mode\n3, 0.1, beam", "needs a column airspeed"),
        ("airspeed [m/s], frequency [Hz], frequency_error, mode\n100, , 0.1, beam", "must have a point with"),
        (
            "airspeed [m/s], frequency [Hz], frequency_error, mode\n100, 3, 0.1, beam",
            "must be at most as many",
        ),
    ],
)
def test_points_that_say_too_little_are_refused(tmp_path, text, told):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(pp.InputError, match=told):
        pp.calibrate(CASE, pp.read_points(tmp_path / "a.csv"), INPUTS)


def test_a_case_of_many_designs_is_refused(tmp_path):
    many = CASE.vary({INPUTS[0]: np.array([0.9, 1.0]) * start(INPUTS[0])})
    with pytest.raises(pp.InputError, match="must be one number to start from"):
        pp.calibrate(many, written_points(tmp_path), [INPUTS[0]])
