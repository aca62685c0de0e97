"""A study is repeated from its results or from a file, to the last bit, whatever its inputs were given as."""

import json
import tomllib

import numpy as np
import pytest
import xarray as xr
from click.testing import CliRunner
from scipy import stats

import proprotor as pp
from proprotor import sampling
from proprotor.commands.main import main
from proprotor.units import unit_registry

PRECONE, STIFFNESS, CHORD = "rotor.precone", "rotor.control_stiffness", "support.modes[chord].frequency"
CASE = pp.load_case("xv15-uncoupled", {PRECONE: "2 deg"})
Q = unit_registry().Quantity
DEG = np.pi / 180


class OwnDistribution:
    def ppf(self, share):
        return 0.03 + 0.01 * share


STUDIES = {
    "a grid of texts": ({PRECONE: "1:3:1 deg", CHORD: ["5 Hz", "6 Hz"]}, "200 kt", {}),
    "a grid of quantities": ({PRECONE: Q(np.array([1.0, 2.0]), "deg"), CHORD: Q(5, "Hz")}, Q(200, "kt"), {}),
    "a grid of arrays": ({PRECONE: np.linspace(0.02, 0.04, 150)}, 100.0, {}),
    "labelled arrays": ({PRECONE: xr.DataArray([1.0, 2.0], attrs={"units": "deg"})}, [100.0, 110.0], {}),
    "a list": (sampling.points({PRECONE: [0.02, 0.04], CHORD: 33.0}, drawn=True), "100:120:10 m/s", {}),
    "long airspeeds": ({PRECONE: [0.02]}, np.linspace(100, 110, 120), {}),
    "airspeeds among the inputs": (sampling.points({"airspeed": ["200 kt", "220 kt"]}), None, {}),
    "a sample": (
        sampling.latin_hypercube(
            {
                PRECONE: ("1 deg", "3 deg"),
                STIFFNESS: sampling.Relative(0.8, 1.2, logarithmic=True),
                CHORD: sampling.Normal("5 Hz", "0.1 Hz"),
                "operation.density": stats.uniform(1.1, scale=0.2),
                "rotor.blade_mass": sampling.LogRange(40.0, 50.0),
                ("rotor.radius", "rotor.chord"): (0.98, 1.02),
            },
            4,
            seed=7,
        ),
        "200:220:20kt",
        {"pitch": "coupling", "locked": ("gimbal",), "drive_train": None},
    ),
    "quantities as limits": (sampling.sobol({PRECONE: (Q(1, "deg"), Q(3, "deg"))}, 2), 100.0, {}),
    "saltelli": (sampling.saltelli({PRECONE: (0.02, 0.04), CHORD: (30, 33)}, 2, 3, True), 100.0, {}),
    "records among the options": (
        {PRECONE: [0.02]},
        100.0,
        {
            "structure": "tabulated",
            "frequencies": pp.BladeFrequencies(at_rotor_speed=47.0, flap=1.9, lag=1.2),
            "drive_train": pp.DriveTrain(drive_inertia=100.0),
        },
    ),
}


@pytest.mark.parametrize("what", STUDIES)
def test_a_study_is_repeated_from_its_results_and_from_files(what, tmp_path):
    inputs, airspeed, options = STUDIES[what]
    found = pp.study(CASE, inputs, airspeed, "least_stable", workers=1, **options)
    xr.testing.assert_identical(pp.study(found, workers=1), found)
    pp.save_results(found, tmp_path / "study.nc")
    xr.testing.assert_identical(pp.study(pp.load_results(tmp_path / "study.nc"), workers=1), found)
    pp.save_study(found, tmp_path / "study.toml")
    again = pp.study(tmp_path / "study.toml", workers=1)
    # A list that the results hold is written out in the file, and stays out of the attributes again.
    xr.testing.assert_identical(again, found)


def test_a_case_that_was_varied_is_repeated_and_a_case_without_deck_is_given_again(tmp_path):
    varied = CASE.vary({"rotor.chord": 0.36, CHORD: "5.5 Hz"})
    found = pp.study(varied, {PRECONE: [0.03]}, 100.0, workers=1)
    described = json.loads(found.attrs["study"])
    assert described["set"] == {PRECONE: "2 deg"}
    assert described["vary"] == {"rotor.chord": 0.36, CHORD: pytest.approx(2 * np.pi * 5.5)}
    pp.save_study(found, tmp_path / "study.toml")
    xr.testing.assert_identical(pp.study(tmp_path / "study.toml", workers=1), found)
    xr.testing.assert_identical(pp.study(varied, tmp_path / "study.toml", workers=1), found)
    own = pp.Case("own", CASE.rotor, CASE.operation, CASE.support)
    alone = pp.study(own, sampling.points({"airspeed": [100.0, 110.0]}), workers=1)
    with pytest.raises(pp.InputError, match="case: must be given again"):
        pp.study(alone)
    xr.testing.assert_identical(pp.study(own, alone, workers=1), alone)


def test_a_deck_that_changed_is_told(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    deck = tmp_path / "mine.toml"
    deck.write_text('base = "xv15-uncoupled"\n[case]\nname = "mine"\ntitle = "Mine"\n')
    found = pp.study(pp.load_case("mine.toml"), {PRECONE: [0.03]}, 100.0, workers=1)
    (tmp_path / "studies").mkdir()
    pp.save_study(found, "studies/a.toml")
    assert tomllib.loads((tmp_path / "studies/a.toml").read_text())["study"]["case"] == "../mine.toml"
    xr.testing.assert_equal(pp.study("studies/a.toml", workers=1), found)
    deck.write_text(f'{deck.read_text()}[rotor]\nradius = "12 ft"\n')
    with pytest.raises(pp.InputError, match="case = mine: must be the case of the study, whose deck had"):
        pp.study("studies/a.toml")


def test_what_cannot_be_written_is_told_when_it_is_repeated():
    plan = sampling.latin_hypercube({PRECONE: OwnDistribution()}, 2)
    found = pp.study(CASE, plan, 100.0, workers=1)
    with pytest.raises(pp.InputError, match=r"rotor.precone = OwnDistribution: must be given again"):
        pp.study(found)
    table = pp.BladeFrequencies(at_rotor_speed=47.0, flap=lambda x: 1.9 + 0 * x, lag=1.2)
    found = pp.study(CASE, {PRECONE: [0.03]}, 100.0, workers=1, structure="tabulated", frequencies=table)
    with pytest.raises(pp.InputError, match=r"frequencies: must be given again: the study had function"):
        pp.study(found)
    with pytest.raises(pp.InputError, match="must say what was asked"):
        pp.study(found.drop_attrs())


BY_HAND = """
[study]
case = "xv15-uncoupled"
plan = "latin-hypercube"
size = 3
seed = 2
airspeed = "200:300:50kt"
quantities = ["flutter"]

[set]
"rotor.precone" = "2 deg"

[inputs]
"rotor.control_stiffness" = ["8000 ft*lbf/rad", "16000 ft*lbf/rad"]

[options]
pitch = "coupling"
"""


def test_a_file_may_be_written_by_hand(tmp_path):
    (tmp_path / "a.toml").write_text(BY_HAND)
    plan = sampling.latin_hypercube({STIFFNESS: ("8000 ft*lbf/rad", "16000 ft*lbf/rad")}, 3, 2)
    asked = pp.study(CASE, plan, "200:300:50kt", "flutter", workers=1, pitch="coupling")
    xr.testing.assert_equal(pp.study(tmp_path / "a.toml", workers=1), asked)


WRONG = [
    ("size = 3", "sise = 3", "did you mean size?"),
    ("[set]", "[sets]", "did you mean set?"),
    ('plan = "latin-hypercube"', 'plan = "hypercube"', "did you mean latin-hypercube?"),
    ('plan = "latin-hypercube"', 'plan = "grid"', "does not go with size, seed"),
    ("size = 3\n", "", "a sample has a size"),
    ('["8000 ft*lbf/rad", "16000 ft*lbf/rad"]', "{ low = 1 }", "must have low and high"),
    ('["8000 ft*lbf/rad", "16000 ft*lbf/rad"]', "{ loww = 1, high = 2 }", "did you mean low?"),
    ('["8000 ft*lbf/rad", "16000 ft*lbf/rad"]', '{ scipy = "norma" }', "did you mean"),
    ('["8000 ft*lbf/rad", "16000 ft*lbf/rad"]', '{ scipy = "norm", args = [1, 2, 3] }', "arguments of scipy"),
    ("rotor.control_stiffness", "rotor.control_stif", "rotor.control_stiffness"),
    ("pitch = ", "pich = ", "did you mean pitch?"),
    ('"xv15-uncoupled"', '"xv15-uncupled.toml"', "did you mean the bundled deck xv15-uncoupled?"),
    ("[study]", "[study", "is not TOML"),
]


@pytest.mark.parametrize(("old", "new", "told"), WRONG)
def test_a_wrong_file_is_told_in_one_message(tmp_path, old, new, told):
    assert old in BY_HAND
    (tmp_path / "a.toml").write_text(BY_HAND.replace(old, new, 1))
    with pytest.raises(pp.InputError) as caught:
        pp.study(tmp_path / "a.toml")
    assert told in str(caught.value) and "\n" not in str(caught.value)


def test_what_stands_in_a_study_cannot_be_given_beside_it(tmp_path):
    (tmp_path / "a.toml").write_text(BY_HAND)
    for given in ({"airspeed": 100.0}, {"pitch": "rigid"}, {"quantities": "trim"}, {"inputs": {}}):
        with pytest.raises(pp.InputError, match=f"{next(iter(given))} = .*: stands in the study"):
            pp.study(tmp_path / "a.toml", **given)
    with pytest.raises(pp.InputError, match="must be a case"):
        pp.study(5)


# The command --------------------------------------------------------------------------------------


def run(*words):
    done = CliRunner().invoke(main, [str(word) for word in words])
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    return done


def test_the_command_writes_its_study_and_repeats_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    asked = ("xv15-uncoupled", "--vary", f"{PRECONE}=1:2:1 deg", "--speed", "200:240:40kt", "--flutter")
    done = run("study", *asked, "--workers", 1, "--out", "a.nc", "--csv", "a.csv", "--save", "a.toml")
    assert done.exit_code == 0, done.stderr
    first, table = pp.load_results("a.nc"), (tmp_path / "a.csv").read_bytes()
    text = f'{(tmp_path / "a.toml").read_text()}json = "a.json"\n'
    assert text.count("[outputs]") == 1 and text.index("[outputs]") > text.index("[options]")
    (tmp_path / "a.toml").write_text(text)
    for written in ("a.nc", "a.csv"):
        (tmp_path / written).unlink()
    assert run("study", "a.toml", "--workers", 1).exit_code == 0
    xr.testing.assert_identical(pp.load_results("a.nc"), first)
    assert (tmp_path / "a.csv").read_bytes() == table
    assert len(json.loads((tmp_path / "a.json").read_text())["designs"]) == 2
    again = run("study", "a.nc", "--workers", 1, "--json")
    assert json.loads(again.stdout)["designs"] == json.loads((tmp_path / "a.json").read_text())["designs"]


def test_the_command_refuses_changes_of_a_study_that_it_repeats(tmp_path):
    (tmp_path / "a.toml").write_text(BY_HAND)
    for option in (
        ("--pitch", "rigid"),
        ("--seed", 3),
        ("--speed", "100 kt"),
        ("--set", "rotor.precone=1 deg"),
    ):
        done = run("study", tmp_path / "a.toml", *option)
        assert done.exit_code == 2 and f"{option[0]}: stands in the study of" in done.stderr


def test_a_grid_prints_its_designs_and_a_sample_its_percentiles():
    common = ("study", "xv15-uncoupled", "--speed", "160:400:80kt", "--flutter", "--workers", 1)
    grid = run(*common, "--vary", f"{PRECONE}=2 deg, 4 deg").stdout
    assert "% of designs" not in grid and "> 400.00" in grid and "flutter speeds of 1 of 2 designs" in grid
    common = ("study", "xv15-uncoupled", "--speed", "160:360:100kt", *common[4:])
    sample = run(*common, "--vary", f"{PRECONE}=2:4 deg", "--sample", "sobol", "--size", 4).stdout
    assert "% of designs" in sample and "> 360.0" in sample
