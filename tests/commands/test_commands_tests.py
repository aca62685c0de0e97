"""Commands on what was measured: a record becomes a test point, test points become a deck."""

import json

import pytest
from click.testing import CliRunner

import proprotor as pp
from proprotor.commands.main import main
from tests import extras
from tests.records.decays import decay


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    record = decay(((3.2, 0.03, 1.0, 0.4), (4.6, 0.05, 0.7, 1.0)), channels=2)
    rows = [f"{time},{one},{two}" for time, (one, two) in zip(record.time, record.values, strict=True)]
    (tmp_path / "decay.csv").write_text("time [s],a [N*m],b [N*m]\n" + "\n".join(rows))
    (tmp_path / "points.csv").write_text(extras.POINTS)
    return tmp_path


def run(*words):
    done = CliRunner().invoke(main, list(words), env={"COLUMNS": "120"})
    assert done.exit_code == 0, done.output
    return done.stdout


def refused(*words):
    done = CliRunner().invoke(main, list(words))
    assert (done.exit_code, done.stdout) == (2, "") and len(done.stderr.splitlines()) == 1
    return done.stderr


def test_a_record_becomes_a_point_that_others_read(folder):
    run(
        *("identify", "decay.csv", "--frequency", "3 Hz", "--between", "0.1:4 s"),
        *("--at", "250 keas", "--called", "beam", "--csv", "point.csv"),
    )
    points = pp.read_points("point.csv")
    assert points.mode.tolist() == ["beam"] and points.columns["airspeed"].head.unit == "keas"
    frequency, damping = points.columns["frequency"], points.columns["damping"]
    assert frequency.values[0] == pytest.approx(3.2, rel=5e-3) and damping.values[0] == pytest.approx(
        3, rel=0.1
    )
    assert frequency.high[0] > frequency.values[0] > frequency.low[0]
    told = json.loads(run("identify", "decay.csv", "--json"))
    assert [mode["frequency [Hz]"] for mode in told["modes"]] == pytest.approx([3.2, 4.6], rel=5e-3)
    assert "? " not in run("identify", "decay.csv")


def test_times_that_are_none_are_refused():
    assert "--between = 1 s: must be two times" in refused("identify", "decay.csv", "--between", "1 s")
    assert "RECORD = no.csv" in refused("identify", "no.csv")
    assert "--at = fast" in refused("identify", "decay.csv", "--at", "fast")


def test_points_become_a_deck(folder):
    path = "support.modes[beam].frequency"
    words = ("calibrate", "xv15-uncoupled", "--to", "points.csv", "--input", f"{path}=2:5 Hz")
    told = json.loads(run(*words, "--set", "rotor.precone=2 deg", "--out", "fitted.toml", "--json"))
    fitted = pp.load_case("fitted.toml")
    assert fitted.given[path].status == "calibrated"
    assert told["inputs"][0]["input"] == path and told["correlation"] == [[pytest.approx(1)]]
    assert fitted.given["rotor.precone"].si == pytest.approx(2 * 3.141592653589793 / 180)
    assert "--input" in refused(*words[:4], "--input", f"{path}=2")
    assert "must end in .toml" in refused(*words, "--out", "fitted.txt")
    assert "must not vary an input twice" in refused(*words, "--input", path)


def test_single_gusts_and_turbulence_have_options_of_their_own():
    words = ("gust", "xv15-uncoupled", "--speed", "200 kt", "--output", "force_x")
    assert "goes with --gradient" in refused(*words, "--velocity", "1 m/s")
    assert "goes without --gradient" in refused(*words, "--gradient", "30 ft", "--scale", "500 ft")
    (row,) = json.loads(run(*words, "--gradient", "30 ft", "--json"))["outputs"]
    assert row["lowest"] < 0 < row["highest"] and row["unit"] == "N"
    assert "not damped" in refused("gust", "xv15", "--speed", "440 kt")


def test_measured_modes_stand_beside_those_of_a_model():
    told = json.loads(run("mac", "xv15", "xv15-uncoupled", "--distance", "1 m", "--json"))
    assert told["distance (m)"] == 1.0 and [mode["model"] for mode in told["modes"]] == [
        "beam",
        "chord",
        "torsion",
    ]
