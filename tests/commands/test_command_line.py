"""The command `proprotor`: what it prints and writes, and what it says of inputs it cannot use."""

import csv
import json
import math
import re
import shlex
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

import proprotor as pp
from proprotor.commands.main import main
from proprotor.commands.sweep import sweep
from proprotor.files.output import write_whole
from proprotor.rotor.options import CHOICES, LOCKABLE
from tests.csv_files import without_comments

SWEEP = ("sweep", "xv15-uncoupled", "--speed", "300:400:20kt")


def run(*arguments: str | Path) -> Result:
    result = CliRunner().invoke(main, [str(a) for a in arguments], env={"COLUMNS": "200"})
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result


@pytest.fixture(scope="module")
def table() -> str:
    return run(*SWEEP).stdout


@pytest.fixture(scope="module")
def expected():
    return pp.load_case("xv15-uncoupled").sweep("300:400:20kt")


def test_table_has_a_row_for_each_airspeed_and_the_support_modes(table, expected):
    rows = [line.split() for line in table.splitlines() if line.strip()[:3].isdigit()]
    assert [float(row[0]) for row in rows] == [300, 320, 340, 360, 380, 400]
    header = next(line for line in table.splitlines() if line.strip().startswith("beam"))
    assert {"beam", "chord", "torsion"} <= set(header.split())
    per_rev = (
        expected.frequency.sel(mode="beam").values[0] / pp.load_case("xv15-uncoupled").operation.rotor_speed
    )
    percent = 100 * expected.damping_ratio.sel(mode="beam").values[0]
    assert f"{per_rev:.3f}   {percent:.2f}" in table


def test_table_states_convention_inputs_and_calibration(table):
    text = " ".join(table.split())
    assert "-Re s/|s| in percent of critical" in text
    assert "not read in a source" in text
    assert "Calibration:" in text


def test_instability_is_marked_and_its_airspeed_interpolated(table, expected):
    growth = expected.eigenvalue.sel(mode="chord").values.real
    i = np.flatnonzero((growth[:-1] < 0) & (growth[1:] > 0))[0]
    boundary = 300 + 20 * (i + growth[i] / (growth[i] - growth[i + 1]))
    assert f"chord: unstable from about {boundary:.0f} KTAS (interpolated)" in table
    assert "*" in next(line for line in table.splitlines() if line.strip().startswith("400"))


def test_all_modes_appear_when_asked_for(expected):
    output = run(*SWEEP, "--all-modes").stdout
    words = set(output.split())
    assert all(set(mode.split()) <= words for mode in expected.mode.values.tolist())
    assert "more modes" not in output


def test_failed_airspeeds_are_rows_with_their_reason():
    result = run("sweep", "xv15-uncoupled", "--speed", "0:600:200kt")
    rows = {line.split()[0]: line for line in result.stdout.splitlines() if line.strip()[:1].isdigit()}
    assert result.exit_code == 0
    reasons = pp.load_case("xv15-uncoupled").sweep("0:600:200kt").reason.values
    assert reasons[0] and reasons[0] in rows["0"]
    assert reasons[3] and reasons[3] in rows["600"]
    assert rows["200"].count(".") > 4


def test_doubtful_airspeeds_are_marked_and_explained(tmp_path):
    file = tmp_path / "modes.csv"
    output = run("sweep", "xv15-uncoupled", "--speed", "400:500:50kt", "--csv", file).stdout
    points = pp.load_case("xv15-uncoupled").sweep("400:500:50kt")
    doubtful = points.warning.values != ""
    assert doubtful.any()
    marks = [
        line.split()[0].endswith("?")
        for line in output.splitlines()
        if line.strip()[:3] in ("400", "450", "500")
    ]
    np.testing.assert_array_equal(
        np.array(marks).reshape(-1, 3), np.broadcast_to(doubtful, (len(marks) // 3, 3))
    )
    for text in {part for texts in points.warning.values[doubtful] for part in str(texts).split("; ")}:
        assert text in output
        assert text in file.read_text(encoding="utf-8")


def test_nothing_but_failed_airspeeds_is_a_failure():
    result = run("sweep", "xv15-uncoupled", "--speed", "0 kt")
    assert result.exit_code == 1
    assert "No airspeed could be analysed." in result.stdout


def test_csv_is_the_sweep(tmp_path):
    file = tmp_path / "modes.csv"
    assert run("sweep", "xv15-uncoupled", "--speed", "0:200:100kt", "--csv", file).exit_code == 0
    rows = list(csv.DictReader(without_comments(file)))
    case = pp.load_case("xv15-uncoupled")
    modes = case.sweep("0:200:100kt")
    assert len(rows) == modes.damping_ratio.size
    for row in rows:
        point = modes.sel(mode=row["mode"]).isel(airspeed=int(float(row["airspeed (KTAS)"]) / 100))
        if point.reason.item():
            assert row["failure"] == point.reason.item()
            assert row["damping (% of critical)"] == row["Im s (rad/s)"] == row["frequency (per rev)"] == ""
        else:
            s = complex(float(row["Re s (rad/s)"]), float(row["Im s (rad/s)"]))
            assert s == point.eigenvalue.item()
            assert float(row["frequency (per rev)"]) == abs(s.imag) / case.operation.rotor_speed
            assert float(row["damping (% of critical)"]) == pytest.approx(-100 * s.real / abs(s))


def test_json_is_valid_and_has_every_mode(expected):
    def refuse(constant: str):
        raise AssertionError(constant)

    result = run("sweep", "xv15-uncoupled", "--speed", "0:400:200kt", "--json", "--airloads", "lift-slope")
    document = json.loads(result.stdout, parse_constant=refuse)
    assert document["options"]["airloads"] == "lift-slope"
    assert {p["mode"] for p in document["points"]} == set(expected.mode.values.tolist())
    assert [p["failure"] != "" for p in document["points"]].count(True) == len(expected.mode)
    assert all((p["Re s (rad/s)"] is None) == (p["failure"] != "") for p in document["points"])


@pytest.mark.parametrize("name", ["damping.png", "damping.PDF", "damping.svg"])
def test_plot_is_written(tmp_path, name):
    file = tmp_path / name
    result = run(*SWEEP, "--plot", file)
    assert result.exit_code == 0
    assert str(file) in result.stderr
    assert file.stat().st_size > 10_000
    assert [entry.name for entry in tmp_path.iterdir()] == [name]


def test_plot_is_not_blank(tmp_path):
    from matplotlib.image import imread

    file = tmp_path / "damping.png"
    run(*SWEEP, "--plot", file)
    image = imread(file)[..., :3]
    below = image[image.shape[0] // 2 :]
    for half in (image, below):
        assert len(np.unique(half.reshape(-1, 3), axis=0)) > 100
        assert 0.01 < np.mean(half.min(axis=-1) < 0.9) < 0.9


def test_airspeeds_are_shown_in_the_unit_they_were_given_in():
    for speed, unit, shown in (
        ("1e2:150:25 m/s", "m/s", ["100", "125", "150"]),
        ("250.5kt", "KTAS", ["250.5"]),
        ("250.5 ktas", "KTAS", ["250.5"]),
        ("250:260:5keas", "KEAS", ["250", "255", "260"]),
        ("360 km*h**-1", "km*h**-1", ["360"]),
    ):
        lines = run("sweep", "xv15-uncoupled", "--speed", speed).stdout.splitlines()
        start = next(i for i, line in enumerate(lines) if "/rev  " in line)
        assert lines[start].split()[0] == unit
        assert [line.split()[0] for line in lines[start + 1 : start + 1 + len(shown)]] == shown


def test_options_reach_the_model():
    chosen = ("--pitch", "rigid", "--rotor-speed", "constant", "--no-compressibility", "--locked", "gimbal")
    document = json.loads(run(*SWEEP, *chosen, "--locked", "lag", "--json").stdout)
    options = {
        "pitch": "rigid",
        "rotor_speed": "constant",
        "compressibility": False,
        "locked": ("gimbal", "lag"),
    }
    modes = pp.load_case("xv15-uncoupled").sweep("300:400:20kt", **options)
    assert [p["mode"] for p in document["points"][: len(modes.mode)]] == modes.mode.values.tolist()
    found = [p["damping (% of critical)"] for p in document["points"]]
    np.testing.assert_allclose(found, 100 * modes.damping_ratio.values.ravel(), rtol=1e-9)


def test_every_option_of_the_model_is_a_flag_that_says_what_it_does():
    parameters = {p.name: p for p in sweep.params}
    for name in (*CHOICES, "pitch_flap_coupling", "pitch_lag_coupling", "locked"):
        assert len(parameters[name].help) > 20
    for name, choices in CHOICES.items():
        # a structure that is not given is the deck's, see test_deck_rotor_options.py
        assert parameters[name].default == (choices[0] if name != "structure" else None)
        if not isinstance(choices[-1], bool):
            assert tuple(parameters[name].type.choices) == choices
    assert tuple(parameters["locked"].type.choices) == LOCKABLE


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("sweep", "xv16", "--speed", "50kt"), "did you mean xv15?"),
        (("sweep", "no/such.toml", "--speed", "50kt"), "no such file"),
        (("sweep", "xv15-uncoupled", "--speed", "50"), "--speed = 50: needs a unit"),
        (("sweep", "xv15-uncoupled", "--speed", "50kg"), "--speed = 50kg: must be a speed"),
        (("sweep", "xv15-uncoupled", "--speed", "400:50:5kt"), "must rise"),
        (("sweep", "xv15-uncoupled", "--speed", "-5kt"), "must not be negative"),
        (("sweep", "xv15-uncoupled", "--speed", "fast"), "must be a speed"),
        (("sweep", "xv15-uncoupled"), "--speed"),
        (
            ("sweep", "xv15-uncoupled", "--speed", "50kt", "--pitch", "stiff"),
            "'dynamic', 'coupling', 'rigid'",
        ),
        (
            ("sweep", "xv15-uncoupled", "--speed", "50kt", "--locked", "wing"),
            "'flap', 'lag', 'pitch', 'gimbal'",
        ),
        (("sweep", "xv15-uncoupled", "--speed", "50kt", "--plot", "damping.gif"), ".png, .pdf, .svg"),
        (("sweep", "xv15-uncoupled", "--speed", "50kt", "--csv", "/"), "--csv = /: must be a file"),
        (("sweep", "xv15-uncoupled", "--speed", "50kt", "--pitch-lag-coupling", "-0.3"), 'pitch="coupling"'),
        (("cases", "xv16"), "did you mean xv15?"),
        (("fly",), "fly"),
    ],
)
def test_an_unusable_input_is_told_without_a_traceback(arguments, told):
    result = run(*arguments)
    assert result.exit_code == 2
    assert told in result.stderr
    assert result.stdout == ""


def test_a_deck_with_several_faults_tells_them_all(tmp_path):
    deck = tmp_path / "wrong.toml"
    deck.write_text('base = "xv15-uncoupled"\n[rotor]\nradius = "-1 ft"\nprecone = "2 kg"\n')
    result = run("sweep", deck, "--speed", "50kt")
    assert result.exit_code == 2
    assert "rotor.radius" in result.stderr
    assert "rotor.precone" in result.stderr


@pytest.mark.parametrize("option", ["--csv", "--plot"])
def test_an_output_that_cannot_be_written_is_one_message(tmp_path, option):
    result = run("sweep", "xv15-uncoupled", "--speed", "50kt", option, tmp_path / "missing" / "out.png")
    assert result.exit_code == 1
    assert len(result.stderr.strip().splitlines()) == 1
    assert "cannot be written" in result.stderr


def test_a_file_is_written_whole_or_not_at_all(tmp_path):
    def half(file):
        file.write(b"half")
        raise OSError("disk full")

    kept = tmp_path / "kept.csv"
    kept.write_bytes(b"before")
    for name in ("kept.csv", "new.csv"):
        with pytest.raises(OSError, match="disk full"):
            write_whole(tmp_path / name, half)
    assert {file.name: file.read_bytes() for file in tmp_path.iterdir()} == {"kept.csv": b"before"}


def test_a_file_behind_a_link_is_replaced_and_the_link_kept(tmp_path):
    (tmp_path / "file").write_bytes(b"before")
    (tmp_path / "link").symlink_to("file")
    write_whole(tmp_path / "link", lambda file: file.write(b"after"))
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "file").read_bytes() == b"after"


def test_cases_are_listed_by_name_and_title():
    output = run("cases").stdout
    assert [line.split()[0] for line in output.splitlines()] == list(pp.list_cases())
    assert pp.load_case("xv15-uncoupled").title in output


def test_a_case_tells_the_inputs_that_were_not_read_in_a_source():
    output = run("cases", "xv15-uncoupled").stdout
    case = pp.load_case("xv15-uncoupled")
    for path, number in case.sources.items():
        told = f"{path} = {number.written}" in output
        assert told == (number.status not in ("published", "derived"))
    for warning in case.warnings:
        assert " ".join(warning.split()) in " ".join(output.split())


@pytest.mark.parametrize("arguments", [("--help",), ("sweep", "--help"), ("cases", "--help")])
def test_help_has_exit_codes(arguments):
    result = run(*arguments)
    assert result.exit_code == 0
    assert "Exit codes:" in result.stdout


def test_help_starts_without_the_slow_imports():
    slow = ("pint", "pydantic", "xarray", "matplotlib", "rich", "proprotor.plots")
    code = f"""
import sys
from proprotor.commands.main import main
main(["--help"], standalone_mode=False)
main(["sweep", "--help"], standalone_mode=False)
print([name for name in {slow} if name in sys.modules])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "[]"


def test_python_runs_the_package_as_the_command():
    """On Windows the folder of scripts is often in no search path."""

    def output(way, *words):
        return subprocess.run([sys.executable, *way, *words], capture_output=True, text=True)

    for words in (["--help"], ["cases"], ["sweep", "xv15"]):
        module, script = (
            output(way, *words)
            for way in (
                ["-m", "proprotor"],
                ["-c", "from proprotor.commands.main import main; main(prog_name='proprotor')"],
            )
        )
        assert (module.returncode, module.stdout, module.stderr) == (
            script.returncode,
            script.stdout,
            script.stderr,
        )


def test_a_reader_that_leaves_early_is_no_error():
    command = f"{sys.executable} -c 'from proprotor.commands.main import main; main()'"
    script = f"{command} sweep xv15-uncoupled --speed 50:400:1kt | head -1"
    done = subprocess.run(["bash", "-c", script], capture_output=True, text=True)
    assert done.stdout.startswith("XV-15")
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(("terminal", "seconds"), [(True, 1.3), (True, 0), (False, 1.3)])
def test_what_takes_long_is_announced_on_a_terminal(capsys, monkeypatch, terminal, seconds):
    from proprotor.commands.waiting import waiting

    monkeypatch.setenv("TTY_COMPATIBLE", "1" if terminal else "0")  # what rich takes for a terminal
    with waiting("Counting"):
        time.sleep(seconds)
    captured = capsys.readouterr()
    assert ("Counting" in captured.err) == (terminal and seconds > 1)
    assert captured.out == ""


def test_a_neutral_mode_is_not_called_unstable():
    document = json.loads(run(*SWEEP, "--airloads", "none", "--json").stdout)
    azimuth = [p for p in document["points"] if p["mode"] == "rotor speed"]
    assert all(
        p["damping (% of critical)"] == 0 and math.isclose(p["Re s (rad/s)"], 0, abs_tol=1e-9)
        for p in azimuth
    )
    assert document["unstable ranges (m/s, interpolated)"] == []


def test_a_shortened_warning_names_a_command_that_prints_the_whole_of_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a deck.toml").write_text('base = "xv15"\n\n[case]\nname = "other"\ntitle = "Another"\n')
    printed = (
        CliRunner().invoke(main, ["sweep", "a deck.toml", "--speed", "200kt"], env={"COLUMNS": "80"}).output
    )
    commands = set(re.findall(r"\((proprotor cases [^)]*)\)", " ".join(printed.split())))
    assert commands == {"proprotor cases 'a deck.toml'"}
    for command in commands:
        told = CliRunner().invoke(main, shlex.split(command)[1:])
        assert told.exit_code == 0 and "Warning: The nacelle's centre of mass" in " ".join(
            told.output.split()
        )
