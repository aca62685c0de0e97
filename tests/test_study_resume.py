"""A study that is killed goes on where it was: nothing lost, nothing computed twice, the same bits."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import proprotor as pp
from proprotor import sampling, source_code, study_workers
from proprotor.checkpoint import Checkpoint
from proprotor.errors import InputError
from proprotor.study import study
from proprotor.study_batch import Analysis

PRECONE = "rotor.precone"
CASE = pp.load_case("xv15")
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
from tests.test_study_resume import run
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
        "import os, signal; from proprotor import study_workers\n"
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
from proprotor import InputError, study_batch
from tests.test_study_resume import run

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
ROOT = Path(__file__).parents[1]


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
from proprotor import source_code
from proprotor.study_batch import QUANTITIES

for name in pp.list_cases():
    found = pp.study(pp.load_case(name), {"operation.density": [1.0, 1.1]}, [60.0, 70.0], QUANTITIES, workers=1)
    assert (found.reason == "").all(), name
print([name for name in sys.modules if name.startswith("proprotor.") and name.split(".")[1] in source_code.SHOWING])
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
    with pytest.raises(InputError, match=r"^code = .*\.py: was changed after this process had read it"):
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


def test_two_studies_do_not_share_a_folder(tmp_path):
    with Checkpoint(tmp_path).open({}, {}), pytest.raises(InputError, match="in use"):
        run(tmp_path)
    study_workers.end_workers()


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
