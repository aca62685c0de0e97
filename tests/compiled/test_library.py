"""The library of compiled functions: built once, kept, rebuilt when damaged, and reasons where there is none."""

import json
import os
import shutil
import subprocess
import sys
from importlib.util import find_spec

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


def compiler_that_refuses(folder, argument):
    """The command of a compiler that fails where an argument holds a word."""
    script = folder / "refuses"
    fails = f'case "$*" in *{argument}*) echo "cannot do {argument}" >&2; exit 1;; esac'
    script.write_text(f'#!/bin/sh\n{fails}\nexec cc "$@"\n')
    script.chmod(0o755)
    return str(script)


ROOTS = """
import json
from proprotor.compiled.eigenvalues import eigvals
import numpy as np
found = eigvals(np.random.default_rng(0).standard_normal((11, 9, 9)))
print(json.dumps([[x.real, x.imag] for x in found.ravel().tolist()]))
"""
MODELS = """
import json
import numpy as np
import proprotor as pp
from proprotor.model.first_order import state_matrix
case = pp.load_case("xv15").vary({"rotor.precone": np.linspace(0.0, 0.05, 11)})
model = case.linearize(np.linspace(60.0, 180.0, 11), backend="compiled")
found = (*model.matrices.values(), *model.rotor.matrices.values(), model.trim.thrust, state_matrix(model))
print(json.dumps([part.ravel().tolist() for part in found]))
"""
SCANS = """
import json
import numpy as np
from proprotor.compiled.screening import screened_steps
rng, states, points = np.random.default_rng(0), 19, 200
x = np.linspace(0, 3, points)[:, None]
damping, rise, wave = rng.normal(size=(3, states))
values = -0.05 - 0.3 * damping**2 + 0.4 * np.sin(wave * x) ** 2 + 1j * (rng.normal(size=states) + 0.2 * rise * x)
values[:, -6:] = values[:, -6:].real
steps = np.arange(points - 1), np.arange(1, points), np.tile(np.arange(states), (points - 1, 1))
line, block, error = np.zeros(points, dtype=int), np.zeros(states, dtype=int), np.full(values.shape, 1e-9)
found = [screened_steps(values, error, block, x.ravel(), line, steps, level) for level in (0.0, 0.02, 0.1)]
print(json.dumps([part.tolist() for of_level in found for part in of_level]))
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
def test_processes_that_build_at_once_make_one_library_and_a_damaged_one_is_built_again(tmp_path):
    cache = {"PROPROTOR_CACHE": str(tmp_path / "cache")}
    command = [sys.executable, "-c", ROOTS]
    both = [subprocess.Popen(command, env=os.environ | cache, stdout=subprocess.PIPE) for _ in range(2)]
    first, other = (json.loads(process.communicate()[0]) for process in both)
    assert first == other and [process.returncode for process in both] == [0, 0]
    (built,) = (tmp_path / "cache").iterdir()
    made = built.stat().st_mtime_ns
    assert answer(ROOTS, **cache) == first and built.stat().st_mtime_ns == made
    built.write_bytes(b"no library")
    assert answer(ROOTS, **cache) == first and built.stat().st_size > 1000


@needs_compiler
def test_every_width_of_vectors_has_the_same_bits_and_a_library_of_its_own(tmp_path):
    """The narrowest also with a compiler that has no flag for the instructions of its processor."""
    cache = {"PROPROTOR_CACHE": str(tmp_path / "cache")}
    compiler = os.environ.get("CC") or "cc"
    commands = (
        compiler_that_refuses(tmp_path, "native"),
        *(f"{compiler} -DLANES={lanes}" for lanes in (4, 8)),
    )
    for code in (ROOTS, MODELS, SCANS):
        widths = [answer(code, CC=command, **cache) for command in commands]
        assert widths[0] == widths[1] == widths[2] == answer(code)
    assert len(list((tmp_path / "cache").iterdir())) == 3


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
    reason = answer(
        REASON, CC=compiler_that_refuses(tmp_path, "-shared"), PROPROTOR_CACHE=str(tmp_path / "cache")
    )
    assert "cannot do -shared" in reason or "there is no C compiler" in reason


@needs_compiler
@pytest.mark.parametrize(
    "variables", [{"PROPROTOR_CACHE": "{file}/cache"}, {"HOME": "{file}"}, {"HOME": "/proc"}]
)
def test_a_cache_that_cannot_be_made_says_which_variable_helps(tmp_path, variables):
    """Also a home that is not for writing, and before anything is compiled."""
    place = tmp_path / "file"
    place.write_text("a file where the folder should be")
    own = {"PROPROTOR_CACHE": "", "XDG_CACHE_HOME": "", "CC": compiler_that_refuses(tmp_path, "-shared")}
    reason = answer(REASON, **own | {name: value.format(file=place) for name, value in variables.items()})
    assert "cannot be kept" in reason and "PROPROTOR_CACHE" in reason and "\n" not in reason


@pytest.mark.parametrize("command", ["'no end", " "])
def test_a_variable_cc_that_is_no_command_is_told_or_empty(tmp_path, command):
    place = tmp_path / "file"
    place.write_text("a file where the folder should be")
    reason = answer(REASON, CC=command, PROPROTOR_CACHE=str(place))
    assert "No closing quotation" in reason if "end" in command else "'--version'" not in reason


@needs_compiler
def test_a_folder_whose_files_may_not_be_run_is_a_reason(tmp_path):
    place = tmp_path / "cache"
    place.mkdir()
    mount = f"mount -t tmpfs -o noexec none {place} && exec "
    own_mounts = ["unshare", "--map-root-user", "--mount", "sh", "-c"]
    if not shutil.which("unshare") or subprocess.run([*own_mounts, f"{mount} true"], check=False).returncode:
        pytest.skip("this system has no mounts of one process")
    done = subprocess.run(
        [*own_mounts, f'{mount} "$0" -c "$1"', sys.executable, REASON],
        env=os.environ | {"PROPROTOR_CACHE": str(place)},
        capture_output=True,
        text=True,
        check=True,
    )
    reason = json.loads(done.stdout)
    assert "cannot be loaded" in reason and "PROPROTOR_CACHE" in reason


@pytest.mark.skipif(not find_spec("ziglang"), reason="needs the package ziglang, which brings Clang")
def test_clang_builds_functions_with_the_same_bits(tmp_path):
    clang = {"CC": f"{sys.executable} -m ziglang cc", "PROPROTOR_CACHE": str(tmp_path / "cache")}
    assert answer(ROOTS, **clang) == answer(ROOTS)
