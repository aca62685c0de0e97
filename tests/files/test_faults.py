"""Disks that are full, places that cannot be written, programs that are killed: results appear whole or not at all.

`test_command_line`, `test_figures` and `test_study_resume` have the plain cases of a table, a figure and a study; here
is what they leave: every other output, real failures of the operating system, and ends in the middle of a write.

A full disk is made by a limit on the size of a file, at which the operating system refuses to write on. A folder that
cannot be written is one below a file: permissions do not hold the superuser.
"""

import os
import re
import resource
import signal
import subprocess
import sys
import time
from contextlib import contextmanager

import numpy as np
import pytest
from click.testing import CliRunner

import proprotor as pp
from benchmarks.paper_figures.command import figures
from derive import __main__ as derivation
from derive import emit
from derive.audit import report
from proprotor.commands.main import main
from proprotor.files.output import write_whole
from proprotor.stability.mode_names import _assign_names, _groups
from proprotor.study.checkpoint import Checkpoint
from tests import accept_golden
from tests.csv_files import without_comments
from tests.golden.modes import Mode, Record
from tests.study.test_study_resume import run as study


def run(*arguments, command=main):
    return CliRunner().invoke(command, [str(argument) for argument in arguments])


@contextmanager
def full_disk(size=500):
    """No file of this process can grow beyond so many bytes; Python is told, not killed.

    Modules that are imported meanwhile are not kept compiled: the import system does not notice that their files
    end early, and all later processes would read them.
    """
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    compiles, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        sys.dont_write_bytecode = compiles


def content(folder):
    return {path.name: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


# A full disk --------------------------------------------------------------------------------------

SWEEP = ("sweep", "xv15-uncoupled", "--speed", "100:200:50kt")
STUDY = (
    "study",
    "xv15-uncoupled",
    "--speed",
    "100:200:50kt",
    "--vary",
    "rotor.precone=1:3:1 deg",
    "--workers",
    "1",
)
MAP = ("map", "xv15-uncoupled", "--x", "airspeed=200:260:5kt", "--y", "rotor.precone=1:2:1 deg")
OUTPUTS = {
    "out.csv": (*SWEEP, "--csv"),
    "out.png": (*SWEEP, "--plot"),
    "out.svg": (*SWEEP, "--plot"),
    "out.nc": (*STUDY, "--out"),
    "map.csv": (*MAP, "--csv"),
    "map.pdf": (*MAP, "--plot"),
    "deck.toml": ("new", "--force"),
}


@pytest.mark.parametrize("name", OUTPUTS)
def test_an_output_on_a_full_disk_is_told_and_leaves_what_was(tmp_path, name):
    (tmp_path / name).write_bytes(b"before")
    with full_disk():
        done = run(*OUTPUTS[name], tmp_path / name)
    assert done.exit_code == 1, done.output
    assert isinstance(done.exception, SystemExit)
    told = [line for line in done.stderr.splitlines() if "cannot be written" in line]
    assert len(told) == 1 and name in told[0]
    assert content(tmp_path) == {name: b"before"}


@pytest.mark.parametrize("name", OUTPUTS)
def test_an_output_that_has_no_place_is_told(tmp_path, name):
    (tmp_path / "file").write_bytes(b"before")
    for folder in (tmp_path / "file", "/proc/self"):
        done = run(*OUTPUTS[name], f"{folder}/{name}")
        assert done.exit_code in (1, 2) and isinstance(done.exception, SystemExit), done.output
        assert sum("Error: " in line for line in done.stderr.splitlines()) == 1
    assert content(tmp_path) == {"file": b"before"}


def test_a_figure_on_a_full_disk_leaves_what_was(tmp_path):
    """The picture does not fit, so there are no numbers of it either."""
    (tmp_path / "figure-12.csv").write_bytes(b"before")
    with full_disk():
        done = CliRunner().invoke(figures, ["12", "--samples", "0", "--out", str(tmp_path)])
    assert done.exit_code == 1 and isinstance(done.exception, SystemExit), done.output
    assert sum("cannot be written" in line for line in done.stderr.splitlines()) == 1
    assert content(tmp_path) == {"figure-12.csv": b"before"}


def test_a_full_disk_under_the_standard_output_is_no_traceback():
    code = "from proprotor.commands.main import main; main()"
    command = [sys.executable, "-c", code, *SWEEP, "--json"]
    with open("/dev/full", "w", encoding="utf-8") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode != 0
    assert "No space left on device" in done.stderr


def test_results_that_do_not_fit_leave_what_was(tmp_path):
    sweep = pp.load_case("xv15-uncoupled").sweep(np.array([80.0, 90.0]))
    pp.save_results(sweep, tmp_path / "modes.nc")
    before = content(tmp_path)
    for size in (0, 5000, 20000):
        with full_disk(size), pytest.raises(OSError):
            pp.save_results(sweep, tmp_path / "modes.nc")
    assert content(tmp_path) == before


def test_a_checkpoint_on_a_full_disk_keeps_the_batches_it_has(tmp_path):
    folder = tmp_path / "batches"
    study(folder, workers=1)
    whole = content(folder)
    for path in sorted(folder.glob("batch-*"))[3:]:
        path.unlink()
    kept = content(folder)
    with full_disk(), pytest.raises(OSError):
        study(folder, workers=1)
    assert content(folder) == kept
    study(folder, workers=1)
    assert content(folder) == whole


def test_a_checkpoint_on_a_full_disk_is_told_by_the_command(tmp_path):
    with full_disk():
        done = run(*STUDY, "--checkpoint", tmp_path / "batches")
    assert done.exit_code in (1, 2) and isinstance(done.exception, SystemExit), done.output
    assert sum("--checkpoint" in line or "checkpoint =" in line for line in done.stderr.splitlines()) == 1


def test_equations_are_derived_before_any_is_written_and_each_file_is_whole(tmp_path, monkeypatch, capsys):
    (tmp_path / "pitch.py").write_text("before")
    files = {"pitch.py": "short", "trim.py": "x" * 5000, "wing.py": "never"}
    monkeypatch.setattr(emit, "derive_files", lambda progress: files)
    with full_disk(), pytest.raises(OSError):
        emit.update(tmp_path)
    assert content(tmp_path) == {"pitch.py": b"short"}

    def fails(progress):
        raise ValueError("derivation")

    monkeypatch.setattr(emit, "derive_files", fails)
    with pytest.raises(ValueError):
        emit.update(tmp_path)
    assert content(tmp_path) == {"pitch.py": b"short"}


def test_equations_that_cannot_be_written_are_told(monkeypatch, capsys):
    def full():
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(emit, "update", full)
    monkeypatch.setattr(sys, "argv", ["derive"])
    assert derivation.main() == 1
    assert capsys.readouterr().err == "the equations cannot be written (No space left on device)\n"


MODES = {("200",): [Mode("chord", 0.5, 0.01)] * 40}


def test_accepted_modes_that_do_not_fit_leave_those_before(tmp_path):
    record = Record(tmp_path / "modes.csv", ("knots",))
    accept_golden.accept(record, MODES)
    before = content(tmp_path)
    moved = {("200",): [Mode("chord", 0.6, 0.01)] * 40}
    with full_disk(), pytest.raises(OSError):
        accept_golden.accept(record, moved)
    assert content(tmp_path) == before


def test_verdicts_that_do_not_fit_leave_those_before(tmp_path, monkeypatch):
    monkeypatch.setattr(report, "RECORD", tmp_path / "audit.csv")
    report.record([("1",) * len(report.HEADER)])
    before = content(tmp_path)
    with full_disk(), pytest.raises(OSError):
        report.record([("1" * 100,) * len(report.HEADER)] * 10)
    assert content(tmp_path) == before


# Killed in the middle -----------------------------------------------------------------------------

WRITES = """
import sys, time
from pathlib import Path
from proprotor.files.output import write_whole

def slowly(file):
    file.write(b"half")
    file.flush()
    print("half written", flush=True)
    time.sleep(60)

write_whole(Path(sys.argv[1]), slowly)
"""


@pytest.mark.parametrize("there", [True, False])
@pytest.mark.parametrize("sent", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_a_program_killed_in_the_middle_of_a_write_leaves_what_was(tmp_path, sent, there):
    path = tmp_path / "modes.csv"
    if there:
        path.write_bytes(b"before")
    command = [sys.executable, "-c", WRITES, path]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    assert process.stdout.readline() == b"half written\n"
    process.send_signal(sent)
    process.communicate()
    assert process.returncode != 0
    found = content(tmp_path)
    assert found.pop("modes.csv", None) == (b"before" if there else None)
    assert all(
        re.fullmatch(r"\.proprotor-[0-9a-f]+\.tmp", name) for name in found
    )  # of one that could not clean up
    write_whole(path, lambda file: file.write(b"after"))
    assert path.read_bytes() == b"after"


KEEPS = """
import sys
import numpy as np
from proprotor.study.checkpoint import Checkpoint
kept = Checkpoint(sys.argv[1])
with kept.open({"study": "1"}, {"batches": 2000}):
    print("begun", flush=True)
    for number in range(2000):
        kept.save(number, {"x": np.full(20000, float(number))})
"""


def test_a_study_killed_while_it_keeps_batches_has_whole_ones(tmp_path):
    """Wherever in a write it ends: twice, at different moments."""
    for moment in (0.05, 0.12):
        folder = tmp_path / str(moment)
        process = subprocess.Popen([sys.executable, "-c", KEEPS, folder], stdout=subprocess.PIPE)
        assert process.stdout.readline() == b"begun\n"
        time.sleep(moment)
        process.kill()
        process.communicate()
        kept = Checkpoint(folder)
        with kept.open({"study": "1"}, {"batches": 2000}):
            found = dict(kept.finished(2000))  # a damaged one would warn
        assert len(found) == len(list(folder.glob("batch-*")))
        for number, batch in found.items():
            np.testing.assert_array_equal(batch["x"], np.full(20000, float(number)))
        assert not list(folder.glob(".*.tmp"))


# Checkpoints that are not what was written --------------------------------------------------------


@pytest.fixture
def kept(tmp_path):
    checkpoint = Checkpoint(tmp_path)
    with checkpoint.open({"study": "1"}, {"batches": 3}):
        for number in range(3):
            checkpoint.save(number, {"x": np.array([float(number)])})
    return checkpoint


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: b"",
        lambda data: data[:-1],
        lambda data: data + b"\0",
        lambda data: data[:40],
        lambda data: data[:32] + data[32:][::-1],
        lambda data: bytes(32) + data[32:],
        lambda data: os.urandom(len(data)),
    ],
    ids=["empty", "short", "long", "head alone", "turned", "digest gone", "noise"],
)
def test_a_damaged_batch_is_refused_and_the_rest_kept(kept, damage):
    place = kept.folder / "batch-00000001"
    place.write_bytes(damage(place.read_bytes()))
    with pytest.warns(UserWarning, match="batch-00000001 is damaged"):
        found = dict(kept.finished(3))
    assert sorted(found) == [0, 2]
    assert not place.exists()


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "null", '{"identity": 1, "division": 2}', '{"identity": {}}', "\0\0", "1e999"]
)
def test_a_damaged_manifest_is_refused_and_the_batches_kept(kept, text):
    batches = content(kept.folder)
    (kept.folder / "manifest.json").write_text(text)
    with pytest.raises(pp.InputError) as caught, kept.open({"study": "1"}, {"batches": 3}):
        pass
    assert "\n" not in str(caught.value)
    assert {name: data for name, data in content(kept.folder).items() if name.startswith("batch")} == {
        name: data for name, data in batches.items() if name.startswith("batch")
    }


# What inputs of the fuzzing campaign have found ---------------------------------------------------


@contextmanager
def within(seconds):
    def late(*_):
        raise TimeoutError

    previous = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, previous)


def test_a_pair_that_is_likest_a_rate_alone_gets_a_name_for_two():
    """The rotor speed has room for one state: a pair that was given its name was torn for ever."""
    shares = np.array([[0.1, 0.1, 0.9], [0.9, 0.9, 0.1]])  # of x and of azimuth, in a pair and a real root
    with within(5):
        groups, modes = _groups(("x", "azimuth"), ((0, 1),), (0,)), [0, 2]
        values = np.array([[-1 + 1j, -1 - 1j, -1 + 0j]])
        names = _assign_names(groups, values, np.array([modes]), shares[:, modes, None])
    assert names[:, 0].tolist() == [0, 1]


def test_speeds_that_all_fail_have_a_row_each_in_a_file(tmp_path):
    done = run("sweep", "xv15-uncoupled", "--speed", "900:920:10kt", "--csv", tmp_path / "modes.csv")
    assert done.exit_code == 1 and isinstance(done.exception, SystemExit)
    lines = without_comments(tmp_path / "modes.csv")
    assert len(lines) == 4
    assert all("Mach number" in line for line in lines[1:])


@pytest.mark.parametrize("field", ["blade_mass", "chord"])
def test_a_whole_number_beyond_all_floats_is_refused(tmp_path, field):
    deck = tmp_path / "deck.toml"
    number = "9" * 400
    deck.write_text(
        f'base = "xv15-uncoupled"\n[rotor]\n{field} = {{ r_over_R = [0, 1], value = [1, {number}], unit = "m" }}\n'
    )
    with pytest.raises(pp.InputError):
        pp.load_case(deck)
