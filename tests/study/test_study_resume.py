"""A study that is killed goes on where it was: nothing lost, nothing computed twice, the same bits."""

import os
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import proprotor as pp
from proprotor import sampling
from proprotor.errors import InputError
from proprotor.files import source_code
from proprotor.study import workers as study_workers
from proprotor.study.batch import Analysis
from proprotor.study.checkpoint import Checkpoint
from proprotor.study.study import study

PRECONE = "rotor.precone"
CASE = pp.load_case("xv15-uncoupled")
PLAN = sampling.sobol(
    {PRECONE: ("1 deg", "4 deg"), "support.modes[chord].frequency": ("4.9 Hz", "5.9 Hz")}, 32
)
SPEEDS = np.array([100.0, 140.0, 330.0])  # the last has a tip Mach number above 1: reasons are kept too
BATCH = 6  # two designs: 16 batches


def run(folder, **changed):
    return study(
        **{"case": CASE, "inputs": PLAN, "airspeed": SPEEDS, "batch": BATCH, "checkpoint": folder} | changed
    )


@pytest.fixture(scope="module")
def uninterrupted():
    return run(None)


def batches(folder):
    return {path.name: path.stat().st_mtime_ns for path in folder.glob("batch-*")}


SCRIPT = """
from tests.study.test_study_resume import run
import sys
run(sys.argv[1], workers=2)
"""


def test_a_study_killed_in_the_middle_goes_on(tmp_path, uninterrupted, monkeypatch):
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    command = [sys.executable, "-c", SCRIPT, str(tmp_path)]
    process = subprocess.Popen(command, env=environment)
    deadline = time.monotonic() + 60
    while len(batches(tmp_path)) < 4 and time.monotonic() < deadline:
        time.sleep(0.002)
    process.send_signal(signal.SIGKILL)
    process.wait()
    kept = batches(tmp_path)
    assert 4 <= len(kept) < 16
    computed = []
    analyse = Analysis.__call__
    monkeypatch.setattr(Analysis, "__call__", lambda self, batch: computed.append(1) or analyse(self, batch))
    found = run(tmp_path, workers=1)
    assert len(computed) == 16 - len(kept)
    assert kept.items() <= batches(tmp_path).items() and len(batches(tmp_path)) == 16
    assert not list(tmp_path.glob(".*.tmp"))
    xr.testing.assert_identical(found, uninterrupted)
    computed.clear()
    xr.testing.assert_identical(run(tmp_path), uninterrupted)
    assert not computed


def test_workers_end_with_a_study_that_is_killed(tmp_path):
    """Nobody is left behind who computes for nobody."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    script = (
        "import os, signal; from proprotor.study import workers as study_workers\n"
        "print(study_workers.Worker().process.pid, flush=True); os.kill(os.getpid(), signal.SIGKILL)"
    )
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True)
    pid, deadline = int(done.stdout), time.monotonic() + 30
    while os.path.exists(f"/proc/{pid}") and time.monotonic() < deadline:
        time.sleep(0.01)
    assert done.returncode == -signal.SIGKILL and not os.path.exists(f"/proc/{pid}")


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("study")
    run(folder)
    return folder


@pytest.mark.parametrize("damage", ["flipped", "short", "empty"])
def test_a_damaged_batch_is_told_and_computed_again(finished, uninterrupted, damage):
    place = sorted(finished.glob("batch-*"))[5]
    content = bytearray(place.read_bytes())
    content[len(content) // 2] ^= 1
    place.write_bytes({"flipped": content, "short": content[:-1], "empty": b""}[damage])
    with pytest.warns(UserWarning, match=f"{place.name} is damaged: the batch is computed again"):
        found = run(finished)
    xr.testing.assert_identical(found, uninterrupted)
    xr.testing.assert_identical(run(finished), uninterrupted)


OTHER = [
    ({"inputs": sampling.sobol(PLAN.inputs, 32, seed=1)}, "inputs"),
    ({"inputs": sampling.sobol(PLAN.inputs, 16)}, "inputs"),
    ({"airspeed": SPEEDS + 1e-9}, "airspeeds"),
    ({"case": CASE.vary({PRECONE: 0.0437})}, "case"),
    ({"quantities": "trim"}, "quantities"),
    ({"pitch": "rigid"}, "options"),
    ({"tolerance": 1e-3}, "tolerance"),
]


def test_batches_of_another_study_are_refused(finished):
    kept = batches(finished)
    for changed, what in OTHER:
        with pytest.raises(InputError, match=rf"holds another study \(different: {what}\)"):
            run(finished, **changed)
    place = finished / "manifest.json"
    manifest = place.read_text()
    place.write_text(manifest.replace('"versions": "', '"versions": "of old '))
    with pytest.raises(InputError, match=r"different: versions"):
        run(finished)
    place.write_text(manifest)
    assert batches(finished) == kept


# Code ---------------------------------------------------------------------------------------------

RESUMED = """
import sys
from proprotor.study import batch as study_batch
from proprotor import InputError
from tests.study.test_study_resume import run

def computed(self, batch):
    raise AssertionError("a batch that is there was computed again")

study_batch.Analysis.__call__ = computed
try:
    run(sys.argv[1])
except InputError as error:
    print(error)
else:
    print("resumed")
"""
ROOT = Path(__file__).parents[2]


@pytest.fixture
def copied_code(tmp_path):
    """A folder with copies of both packages."""
    for package in (ROOT / "src" / "proprotor", ROOT / "generated" / "proprotor_equations"):
        shutil.copytree(package, tmp_path / "code" / package.name)
    return tmp_path / "code"


def resumed_with(code, folder):
    """What a study of that code makes of the batches in a folder."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(code), *filter(None, sys.path)])}
    command = [sys.executable, "-c", RESUMED, str(folder)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    return done.stdout.strip() or done.stderr


def test_batches_of_other_code_are_refused(finished, copied_code):
    kept = batches(finished)
    with (copied_code / "proprotor_equations" / "pitch.py").open("a") as file:
        file.write("\n# another way to compute\n")
    rule = "holds another study (different: code); give another folder, or delete this one"
    told = resumed_with(copied_code, finished)
    assert told.startswith("checkpoint = ") and told.endswith(rule) and "\n" not in told
    assert batches(finished) == kept


def test_batches_outlive_a_change_of_what_only_draws(finished, copied_code):
    with (copied_code / "proprotor" / "plots" / "__init__.py").open("a") as file:
        file.write("\n# another colour\n")
    assert resumed_with(copied_code, finished) == "resumed"


def test_all_that_computes_is_in_the_fingerprint():
    names = {name for name, _ in source_code.modules()}
    loaded = {name.replace(".", "/") for name in sys.modules if name.startswith("proprotor")}
    left_out = {f"proprotor/{name}" for name in source_code.SHOWING}
    for name in loaded:
        if not any(f"{name}/".startswith(f"{folder}/") for folder in left_out):
            assert {f"{name}.py", f"{name}/__init__.py"} & names, name


STUDIES = """
import sys
import proprotor as pp
from proprotor.files import source_code
from proprotor.study.variables import QUANTITIES

for name in pp.list_cases():
    found = pp.study(pp.load_case(name), {"operation.density": [1.0, 1.1]}, [60.0, 70.0], QUANTITIES, workers=1)
    assert (found.reason == "").all(), name
by_name = {"proprotor.explore", "proprotor.explore.notebook"}  # imported with the names of `pp`, and not called
used = set(sys.modules) - by_name
print([name for name in used if name.startswith("proprotor.") and name.split(".")[1] in source_code.SHOWING])
"""


def test_no_study_uses_what_is_left_out_of_the_fingerprint():
    done = subprocess.run([sys.executable, "-c", STUDIES], capture_output=True, text=True)
    assert done.stdout == "[]\n", done.stderr


def test_workers_of_other_code_are_refused(tmp_path, monkeypatch):
    monkeypatch.setitem(study.__globals__, "code_fingerprint", lambda: "0" * 64)
    with pytest.raises(InputError, match=r"^workers = .*: runs other code of proprotor than the study"):
        run(tmp_path, workers=2)
    assert not batches(tmp_path)


def test_code_that_changed_since_it_was_imported_keeps_no_batches(tmp_path, monkeypatch):
    monkeypatch.setattr(source_code, "_IMPORTED", 0.0)
    source_code.code_fingerprint.cache_clear()
    with pytest.raises(InputError, match=r"^code = .*: was changed after this process had read it"):
        run(tmp_path / "kept")
    assert not (tmp_path / "kept").exists()


def test_a_study_goes_on_in_the_batches_it_began_with(finished, uninterrupted):
    kept = batches(finished)
    xr.testing.assert_identical(run(finished, batch=50), uninterrupted)
    assert batches(finished) == kept


def test_a_folder_of_something_else_is_refused(tmp_path):
    (tmp_path / "thesis.txt").write_text("keep")
    with pytest.raises(InputError, match="must be an empty folder"):
        run(tmp_path)
    with pytest.raises(InputError, match="cannot be used"):
        run(tmp_path / "thesis.txt")
    (tmp_path / "manifest.json").write_text("{}")
    with pytest.raises(InputError, match="cannot be read"):
        run(tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir() if not path.name.startswith(".")) == [
        "manifest.json",
        "thesis.txt",
    ]


# One study at a time ------------------------------------------------------------------------------


def test_two_studies_do_not_share_a_folder(tmp_path):
    """Neither another process nor another thread; and who is refused removes nothing."""
    with Checkpoint(tmp_path).open({}, {}):
        unfinished = tmp_path / ".proprotor-0123456789abcdef.tmp"
        unfinished.write_bytes(b"half of a batch")
        with pytest.raises(InputError, match="in use by a study that is running"):
            run(tmp_path)
        assert unfinished.read_bytes() == b"half of a batch"
    study_workers.end_workers()


TOGETHER = """
import sys, time
import numpy as np
from proprotor import InputError
from proprotor.study.checkpoint import Checkpoint

name = sys.argv[1]
for folder in sys.stdin:
    try:
        kept = Checkpoint(folder.strip())
        with kept.open({"study": name}, {"batches": 3}):
            for number in range(3):
                kept.save(number, {"x": np.full(100, float(name))})
            time.sleep(0.01)
        print("kept", flush=True)
    except InputError as error:
        print(error.rule, flush=True)
"""


def test_studies_begun_together_in_one_folder_never_mix(tmp_path):
    """Forty times four processes: one has the folder, and what is in it is that one's."""
    command = [sys.executable, "-c", TOGETHER]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, "bufsize": 1}
    others = [subprocess.Popen([*command, str(number)], **pipes) for number in range(4)]
    try:
        for turn in range(40):
            folder = tmp_path / str(turn)
            for process in others:
                process.stdin.write(f"{folder}\n")
            told = [process.stdout.readline().strip() for process in others]
            assert told.count("kept") == 1, told
            winner = str(told.index("kept"))
            refusals = ("is in use by a study that is running", "holds another study (different: study)")
            assert all(text == "kept" or text.startswith(refusals) for text in told)
            kept = Checkpoint(folder)
            with kept.open({"study": winner}, {"batches": 3}):
                found = dict(kept.finished(3))
            assert sorted(found) == [0, 1, 2]
            assert all((batch["x"] == float(winner)).all() for batch in found.values())
    finally:
        for process in others:
            process.communicate()


def test_studies_of_threads_never_mix(tmp_path):
    """The same call twice at once is one study; the numbers are its own, whoever had the folder."""

    def begun(precone):
        try:
            return study(CASE, {PRECONE: [precone]}, 100.0, batch=1, checkpoint=tmp_path, workers=1)
        except InputError as error:
            return error.rule

    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(begun, (0.02, 0.03, 0.04, 0.05)))
    kept = [results for results in found if not isinstance(results, str)]
    assert len(kept) == 1
    xr.testing.assert_identical(kept[0], study(CASE, {PRECONE: kept[0][PRECONE].values}, 100.0, workers=1))


DIES = """
import os, signal, sys
from proprotor.study.checkpoint import Checkpoint
with Checkpoint(sys.argv[1]).open({}, {}):
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_the_hold_of_a_study_that_was_killed_holds_nobody(tmp_path):
    done = subprocess.run([sys.executable, "-c", DIES, tmp_path])
    assert done.returncode == -signal.SIGKILL
    with Checkpoint(tmp_path).open({}, {}):
        pass


def test_a_batch_of_another_study_is_none_of_this(finished, tmp_path, uninterrupted):
    """Even where one was copied into the folder, or two were exchanged."""
    run(tmp_path / "other", case=CASE.vary({PRECONE: 0.0437}))
    first, second, third = sorted(finished.glob("batch-*"))[:3]
    shutil.copy(tmp_path / "other" / first.name, first)
    exchanged = second.read_bytes(), third.read_bytes()
    third.write_bytes(exchanged[0])
    second.write_bytes(exchanged[1])
    with pytest.warns(UserWarning, match="is damaged: the batch is computed again") as told:
        found = run(finished)
    assert len(told) == 3
    xr.testing.assert_identical(found, uninterrupted)


class Lead:
    """A blade whose frequency is a method of an object, as people write them."""

    def __init__(self, value):
        self.value = value

    def curve(self, x):
        return self.value + 0 * x


def test_a_study_of_other_functions_is_another(tmp_path):
    """Frequencies by methods of two objects: the second call once returned the results of the first."""

    def of(value):
        table = pp.BladeFrequencies(
            at_rotor_speed=CASE.operation.rotor_speed, flap=Lead(value).curve, lag=1.5
        )
        return replace(CASE, frequencies=table)

    inputs = {"inputs": {PRECONE: [0.03]}, "airspeed": 100.0, "structure": "tabulated"}
    found = run(tmp_path, case=of(1.1), **inputs)
    xr.testing.assert_identical(run(tmp_path, case=of(1.1), **inputs), found)
    with pytest.raises(InputError, match=r"holds another study \(different: case\)"):
        run(tmp_path, case=of(1.9), **inputs)
    assert not np.array_equal(run(None, case=of(1.9), **inputs).eigenvalue, found.eigenvalue)


def test_a_study_that_ends_with_an_error_keeps_what_it_has(tmp_path, uninterrupted, monkeypatch):
    analyse, count = Analysis.__call__, iter(range(100))

    def stops(self, batch):
        if next(count) == 7:
            raise KeyboardInterrupt
        return analyse(self, batch)

    with monkeypatch.context() as patch:
        patch.setattr(Analysis, "__call__", stops)
        with pytest.raises(KeyboardInterrupt):
            run(tmp_path, workers=1)
    assert len(batches(tmp_path)) == 7
    xr.testing.assert_identical(run(tmp_path), uninterrupted)
