"""The backend of a study: told in its results, and one from its first batch to its last, also after a kill."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import proprotor as pp
from proprotor import sampling
from proprotor.compiled.library import library, why_not
from proprotor.errors import InputError
from proprotor.files import source_code
from proprotor.study import backend as study_backend
from proprotor.study import workers as study_workers
from proprotor.study.study import study

needs_compiler = pytest.mark.skipif(bool(why_not()), reason=why_not())
CASE = pp.load_case("xv15-uncoupled")
PLAN = sampling.sobol(
    {"rotor.precone": ("1 deg", "4 deg"), "support.modes[chord].frequency": ("4.9 Hz", "5.9 Hz")}, 8
)
SPEEDS = np.array([150.0, 180.0, 210.0])
QUANTITIES = ("eigenvalue", "flutter")


def run(folder=None, backend="auto", **changed):
    asked = {"airspeed": SPEEDS, "quantities": QUANTITIES, "workers": 1, "batch": 6, "checkpoint": folder}
    return study(CASE, PLAN, **asked | changed, backend=backend)


def taken(found):
    return json.loads(found.attrs["options"])["backend"]


def batches(folder):
    return {path.name: path.stat().st_mtime_ns for path in Path(folder).glob("batch-*")}


ELSEWHERE = """
import sys
from proprotor.errors import InputError
from tests.study.test_study_backend import run
try:
    run(sys.argv[1])
except InputError as error:
    print(error)
"""


def without_a_compiler(folder, tmp_path):
    """What the same study, with backend="auto", says in a process that finds no compiler."""
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join(filter(None, sys.path)),
        "CC": str(tmp_path / "no-compiler"),
    }
    command = [sys.executable, "-c", ELSEWHERE, str(folder)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert not done.returncode, done.stderr
    return done.stdout.strip()


@pytest.fixture(scope="module")
def by_numpy():
    return run(backend="numpy")


@needs_compiler
def test_results_say_what_was_taken_and_what_was_asked(by_numpy):
    found = run()
    assert taken(found) == "compiled" and taken(by_numpy) == "numpy"
    assert json.loads(found.attrs["study"])["options"] == {"backend": "auto"}
    assert taken(study(CASE, PLAN, SPEEDS, workers=1)) == "numpy"
    assert (found.flutter_note == by_numpy.flutter_note).all()
    assert np.nanmax(np.abs(found.flutter_speed - by_numpy.flutter_speed)) < 1e-9
    assert np.isfinite(found.flutter_speed).any()


@needs_compiler
def test_workers_load_the_library_that_is_built_before_them_and_have_its_bits(monkeypatch):
    alone, built = run(), []
    library.cache_clear()
    why_not.cache_clear()
    genuine = study_workers.check_loadable
    monkeypatch.setattr(
        study_workers,
        "check_loadable",
        lambda analysis: built.append(library.cache_info().currsize) or genuine(analysis),
    )
    xr.testing.assert_identical(run(workers=2), alone)
    assert built == [1]


@needs_compiler
def test_a_study_that_numpy_began_goes_on_with_numpy(tmp_path, by_numpy):
    folder = tmp_path / "kept"
    assert without_a_compiler(folder, tmp_path) == ""
    kept = batches(folder)
    lost = sorted(kept)[1::2]
    for name in lost:
        (folder / name).unlink()
    found = run(folder)
    assert taken(found) == "numpy"
    for name in found.data_vars:
        xr.testing.assert_identical(found[name], by_numpy[name])
    assert {name: kept[name] for name in kept if name not in lost}.items() <= batches(folder).items()


@needs_compiler
def test_a_study_that_compiled_functions_began_says_why_it_does_not_go_on_without_them(tmp_path):
    folder = tmp_path / "kept"
    whole = run(folder)
    sorted(folder.glob("batch-*"))[0].unlink()
    kept = batches(folder)
    told = without_a_compiler(folder, tmp_path)
    assert told.startswith("checkpoint = ") and "\n" not in told
    assert (
        "holds a study begun with the compiled functions, of which there are none here: there is no C" in told
    )
    with pytest.raises(InputError, match=r'^backend = numpy: must be "compiled", with which the study in'):
        run(folder, "numpy")
    assert batches(folder) == kept
    xr.testing.assert_identical(run(folder), whole)
    compiled = run(folder, "compiled")
    assert taken(compiled) == "compiled" and compiled.equals(whole)


@needs_compiler
def test_batches_of_another_compiler_are_refused(tmp_path, monkeypatch):
    run(tmp_path)
    script = tmp_path / ".other"
    script.write_text('#!/bin/sh\n[ "$1" = --version ] && echo other && exit\nexec cc "$@"\n')
    script.chmod(0o755)
    monkeypatch.setenv("CC", str(script))
    with pytest.raises(InputError, match=r"holds another study \(different: versions\)"):
        run(tmp_path)


@needs_compiler
def test_a_worker_without_a_compiler_is_told_and_no_design_gets_the_blame(monkeypatch):
    request = study.__globals__["requested"](
        CASE, PLAN, SPEEDS, QUANTITIES, None, {}, "", "compiled"
    ).with_coordinates()
    monkeypatch.setattr(study_backend, "why_not", lambda: "there is no C compiler")
    with pytest.raises(InputError, match=r"^workers = .*: cannot go on .*: there is no C compiler"):
        request.analysis(request.batch((slice(0, 2), slice(0, 3))))


def test_an_unknown_backend_is_refused_before_anything_is_kept(tmp_path):
    with pytest.raises(InputError, match="must be one of numpy, compiled, auto"):
        run(tmp_path / "kept", "fast")
    assert not (tmp_path / "kept").exists()


def test_code_that_is_compiled_is_in_the_fingerprint():
    names = {name for name, _ in source_code.modules()}
    for package, ending in (("proprotor/compiled", ".c"), ("proprotor/compiled", ".h")):
        folder = Path(pp.__file__).parent / "compiled"
        assert {f"{package}/{path.name}" for path in folder.glob(f"*{ending}")} <= names
    assert {"proprotor_equations/fused/plain.h", "proprotor_equations/fused/general.h"} <= names
