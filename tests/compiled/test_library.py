"""The library of compiled functions: built once, kept, rebuilt when damaged, and reasons where there is none."""

import json
import os
import subprocess
import sys

import pytest

from proprotor.compiled.library import why_not

needs_compiler = pytest.mark.skipif("there is no C compiler" in why_not(), reason="there is no C compiler")
SPEEDS = "[100.0, 150.0]"


def answer(code, **environment):
    """What a process of its own prints, with the files of its cache."""
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert not done.returncode, done.stderr
    return json.loads(done.stdout)


ROOTS = """
import json
from proprotor.compiled.eigenvalues import eigvals
import numpy as np
found = eigvals(np.random.default_rng(0).standard_normal((11, 9, 9)))
print(json.dumps([[x.real, x.imag] for x in found.ravel().tolist()]))
"""
REASON = """
import json
from proprotor.compiled.library import why_not
print(json.dumps(why_not()))
"""
OPTIONS = """
import json
import proprotor as pp
from proprotor.errors import InputError
case, said = pp.load_case("xv15-uncoupled"), []
said.append(case.linearize([100.0, 150.0], backend="auto").origin.options.backend)
try:
    case.linearize([100.0, 150.0], backend="compiled")
except InputError as error:
    said.append(str(error))
print(json.dumps(said))
"""


@needs_compiler
def test_the_library_is_built_once_and_a_damaged_one_again(tmp_path):
    cache = {"PROPROTOR_CACHE": str(tmp_path / "cache")}
    first = answer(ROOTS, **cache)
    (built,) = (tmp_path / "cache").iterdir()
    made = built.stat().st_mtime_ns
    assert answer(ROOTS, **cache) == first and built.stat().st_mtime_ns == made
    built.write_bytes(b"no library")
    assert answer(ROOTS, **cache) == first and built.stat().st_size > 1000


@needs_compiler
def test_every_width_of_vectors_has_the_same_bits(tmp_path):
    cache = {"PROPROTOR_CACHE": str(tmp_path)}
    compiler = os.environ.get("CC") or "cc"
    widths = [answer(ROOTS, CC=f"{compiler} -DLANES={lanes}", **cache) for lanes in (2, 4, 8)]
    assert widths[0] == widths[1] == widths[2]
    assert len(list(tmp_path.iterdir())) == 3  # each flag has a library of its own


def test_without_a_compiler_numpy_computes_and_the_refusal_is_one_line(tmp_path):
    none = {"CC": str(tmp_path / "no-compiler"), "PROPROTOR_CACHE": str(tmp_path)}
    assert "there is no C compiler" in answer(REASON, **none)
    taken, refusal = answer(OPTIONS, **none)
    assert taken == "numpy"
    assert (
        refusal.startswith("backend = compiled:")
        and "there is no C compiler" in refusal
        and "\n" not in refusal
    )


def test_a_compiler_that_fails_says_why(tmp_path):
    script = tmp_path / "cc"
    fails = 'case "$*" in *-shared*) echo "no room on the disk" >&2; exit 1;; esac'
    script.write_text(f'#!/bin/sh\n{fails}\nexec cc "$@"\n')
    script.chmod(0o755)
    reason = answer(REASON, CC=str(script), PROPROTOR_CACHE=str(tmp_path / "cache"))
    assert "no room on the disk" in reason or "there is no C compiler" in reason


@needs_compiler
def test_a_cache_that_cannot_be_made_says_which_variable_helps(tmp_path):
    place = tmp_path / "file"
    place.write_text("a file where the folder should be")
    reason = answer(REASON, PROPROTOR_CACHE=str(place / "cache"))
    assert "cannot be kept" in reason and "PROPROTOR_CACHE" in reason
