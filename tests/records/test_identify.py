"""Frequency and damping of records whose modes are known, and errors that are as large as they say.

The share of records whose result lies within one and within 1.96 standard errors is compared with 68.3 and 95 % by the
binomial distribution: a right method fails one such check in 10,000.
"""

import re

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.stats import binom

import proprotor as pp
from proprotor.records.identify import METHODS
from tests.records.decays import BEAM, HERTZ, decay

RECORDS = 120
CHANCE = 1e-4
CHORD = (4.6, 0.05, 0.7, 1.0)


def score(mode, hertz, ratio):
    """How many standard errors damping and frequency of a mode are off."""
    off = mode.damping_ratio - ratio, mode.frequency - HERTZ * hertz
    return float(off[0] / mode.damping_error), float(off[1] / mode.frequency_error)


def scores(records, expected, **how):
    """The scores of the one mode of each record (records, 2)."""
    return np.array([score(pp.identify(record, **how).isel(mode=0), *expected) for record in records])


def with_one_mode(method):
    return {"method": method} | ({"modes": 1} if method == METHODS[0] else {})


def assert_errors_are_as_told(found):
    for column in found.T:
        for limit, share in ((1.0, 0.6827), (1.95996, 0.95)):
            inside = int((np.abs(column) < limit).sum())
            chance = min(binom.cdf(inside, len(column), share), binom.sf(inside - 1, len(column), share))
            assert chance > CHANCE / 2, (limit, inside / len(column))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("noise", [0.01, 0.1])
def test_errors_of_one_mode_are_as_large_as_they_say(method, noise):
    records = (decay(seed=seed, noise=noise) for seed in range(RECORDS))
    assert_errors_are_as_told(scores(records, BEAM[:2], **with_one_mode(method)))


def test_errors_of_two_modes_in_two_channels_are_as_large_as_they_say():
    results = [
        pp.identify(decay((BEAM, CHORD), seed=seed, channels=2), modes=2) for seed in range(RECORDS // 2)
    ]
    for place, (hertz, ratio, *_) in enumerate((BEAM, CHORD)):
        assert_errors_are_as_told(np.array([score(one.isel(mode=place), hertz, ratio) for one in results]))


def test_errors_of_a_mode_of_the_xv15_are_as_large_as_they_say():
    """The records are the model's own, by the exponential of its state matrix; the roots by its eigenvalues."""
    model = pp.load_case("xv15").linearize("200 kt")
    space, modes = model.to_state_space(), model.modes()
    beam = modes.isel(mode=modes.name.values.tolist().index("beam"))
    row = space.outputs.index("x acceleration") if "x acceleration" in space.outputs else 0
    step, count = 0.01, 500
    by_step = expm(space.A * step)
    # The start is the real part of the mode's vector: displacements, then rates.
    values, vectors = np.linalg.eig(space.A)
    state = vectors[:, np.argmin(np.abs(values - beam.eigenvalue.item()))].real
    clean = []
    for _ in range(count):
        clean.append(space.C[row] @ state)
        state = by_step @ state
    clean, random = np.array(clean) / np.max(np.abs(clean)), np.random.default_rng(1)
    records = [
        pp.Record(step * np.arange(count), clean + 0.05 * random.standard_normal(count), ["hub"])
        for _ in range(RECORDS)
    ]
    root = beam.eigenvalue.item()
    expected = root.imag / HERTZ, -root.real / abs(root)
    for method in METHODS:
        assert_errors_are_as_told(scores(records, expected, **with_one_mode(method)))


@pytest.mark.parametrize("method", METHODS)
def test_without_noise_the_mode_is_found_to_its_last_digits(method):
    found = pp.identify(decay(noise=0.0, rate=1000.0), method)
    accuracy = 2e-3 if method == "moving block" else 1e-4  # cycles of a whole number of samples are not exact
    assert found.damping_ratio.item() == pytest.approx(BEAM[1], rel=accuracy)
    assert found.frequency.item() == pytest.approx(HERTZ * BEAM[0], rel=accuracy)


def test_a_growing_mode_has_a_negative_damping():
    for method in METHODS:
        found = pp.identify(decay(((3.2, -0.02, 0.2, 0.0),)), method)
        off = found.damping_ratio.item() + 0.02
        assert abs(off) < 5 * found.damping_error.item()


def test_modes_are_as_many_as_there_are():
    assert pp.identify(decay()).sizes["mode"] == 1
    assert pp.identify(decay((BEAM, CHORD), channels=2)).sizes["mode"] == 2
    found = pp.identify(decay((BEAM, CHORD), channels=2), frequency="4.5 Hz")
    assert found.frequency.item() == pytest.approx(HERTZ * 4.6, rel=0.01)
    assert (found.amplitude.values / CHORD[2]).ravel() == pytest.approx([1, 1], abs=0.15)
    assert found.noise.values == pytest.approx([0.05, 0.05], rel=0.1)


@pytest.mark.parametrize("method", METHODS[1:])
def test_two_close_modes_are_refused_by_the_methods_for_one(method):
    beat = decay(((3.2, 0.01, 1.0, 0.0), (3.6, 0.01, 0.8, 0.0)), noise=0.02, seconds=6.0)
    with pytest.raises(pp.InputError, match="two close modes beat so"):
        pp.identify(beat, method)
    found = pp.identify(beat)
    assert found.frequency.values / HERTZ == pytest.approx([3.2, 3.6], rel=2e-3)


def test_two_modes_closer_than_the_record_tells_apart_are_doubtful():
    close = decay(((3.2, 0.02, 1.0, 0.0), (3.35, 0.02, 0.8, 1.5)), noise=1e-3)
    found = pp.identify(close, modes=2)
    assert all("closer than one over" in warning for warning in found.warning.values)


def test_noise_that_is_not_white_is_told():
    white = decay(noise=0.0)
    random = np.random.default_rng(3).standard_normal(len(white.time))
    coloured = np.convolve(random, np.ones(8) / 8, mode="same")
    found = pp.identify(pp.Record(white.time, white.values[:, 0] + 0.1 * coloured, ["a"]), modes=1)
    assert "not white" in found.warning.item()
    assert pp.identify(decay(), modes=1).warning.item() == ""


def test_a_mode_beside_others_is_found_by_its_frequency():
    found = pp.identify(decay((BEAM, (9.0, 0.02, 1.0, 0.0)), noise=0.01), "moving block", frequency="3 Hz")
    assert found.frequency.item() == pytest.approx(HERTZ * 3.2, rel=2e-3)
    assert found.damping_ratio.item() == pytest.approx(0.03, abs=4 * found.damping_error.item())


@pytest.mark.parametrize(
    ("how", "told"),
    [
        (
            {"method": "moving blok"},
            "method = moving blok: unknown method 'moving blok'; did you mean moving block?",
        ),
        ({"channels": ["chanel 0"]}, "channels = chanel 0: unknown channel"),
        ({"between": ("0 s", "0.5 s"), "method": "moving block"}, "record = 0.505 s: is too short: it holds"),
        (
            {"between": ("0 s", "0.01 s")},
            "between = 0 to 0.01 s: must hold at least 16 samples; the record has 0 to",
        ),
        ({"between": "1 s"}, "between = 1 s: must be two times"),
        (
            {"frequency": "70 Hz", "method": "logarithmic decrement"},
            "record = step of 0.005 s: is too coarse",
        ),
        ({"modes": 2, "method": "moving block"}, 'modes = 2: goes with the method "least squares"'),
        ({"modes": 0}, "modes = 0: must be a whole number above zero"),
        ({"block": "1 s"}, 'block = 1 s: goes with the method "moving block"'),
        ({"block": "3.9 s", "method": "moving block"}, "block = 3.9 s: must hold 2 cycles"),
        (
            {"block": "0.1 s", "method": "moving block"},
            "block = 0.1 s: must hold 2 cycles of 3.2 Hz and leave",
        ),
        ({"frequency": "-3 Hz"}, "frequency = -3 Hz: must be one number above zero"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(how, told):
    with pytest.raises(pp.InputError) as caught:
        pp.identify(decay(), **how)
    assert str(caught.value).startswith(told) and "\n" not in str(caught.value)


def test_methods_for_one_mode_take_one_channel():
    with pytest.raises(pp.InputError, match="must be one channel for the method"):
        pp.identify(decay(channels=2), "moving block")
    assert pp.identify(decay(channels=2), "moving block", channels=["channel 1"]).sizes["mode"] == 1


def test_noise_alone_shows_no_mode_above_it():
    for method in METHODS[1:]:
        with pytest.raises(pp.InputError, match=r"above the noise|must decay"):
            pp.identify(decay((), noise=1.0), method, frequency="5 Hz")
    with pytest.raises(pp.InputError, match="must move: all its samples are equal"):
        pp.identify(decay((), noise=0.0))


# Files ----------------------------------------------------------------------------------------------------------------

GOOD = "time [ms], beam [N*m], chord\n" + "".join(f"{5 * k}, {k % 7}, {-k % 5}\n" for k in range(40))


def test_a_record_is_read_from_a_file(tmp_path):
    (tmp_path / "a.csv").write_text(GOOD)
    record = pp.read_record(tmp_path / "a.csv")
    assert record.channels == ("beam", "chord") and record.units == ("N*m", "")
    assert record.step == pytest.approx(0.005) and record.values.shape == (40, 2)
    assert record.name == "a.csv" and record.values[8].tolist() == [1, 2]
    part = record.part(["chord"], ("0.05 s", "0.15 s"))
    assert part.time[0] == pytest.approx(0.05) and part.values.shape == (21, 1)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("time [ms]", "when [ms]", "unknown column 'time'"),
        ("time [ms]", "time [m]", "column 1 (time [m]): "),
        ("time [ms]", "time", "column 1 (time): "),
        ("25, 5, 0", "25, , 0", "line 7, column 2 (beam [N*m]): is empty"),
        ("25, 5, 0", "27, 5, 0", "time: must run in even steps of 0.005 s"),
        ("25, 5, 0", "25, x, 0", 'line 7, column 2 (beam [N*m]): "x" is no number'),
        (GOOD.partition("\n")[2], "0, 1, 2\n", "time: must be at least 16 samples"),
    ],
)
def test_a_malformed_file_is_told_with_its_line(tmp_path, old, new, told):
    (tmp_path / "a.csv").write_text(GOOD.replace(old, new, 1))
    with pytest.raises(pp.InputError, match=re.escape(f"record = a.csv: {told}")):
        pp.read_record(tmp_path / "a.csv")


def test_arrays_that_are_no_record_are_refused():
    time = np.arange(20) / 10
    for values, names, told in (
        (np.zeros((19, 1)), ["a"], "must have a row for each of 20 samples"),
        (np.zeros((20, 2)), ["a", "a"], "must be different names"),
        (np.full(20, np.nan), ["a"], "must be finite"),
    ):
        with pytest.raises(pp.InputError, match=told):
            pp.Record(time, values, names)
