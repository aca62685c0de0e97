"""The compiled functions under the sanitizers of addresses and of undefined behaviour."""

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.verify

ROOT = Path(__file__).parents[2]
SANITIZERS = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-g")
LESS = "-O1"  # less than the library has: sooner compiled, and fewer accesses are optimised away unchecked


def compiler():
    return shlex.split(os.environ.get("CC") or "cc")


def with_sanitizers(folder):
    """The command of a compiler with sanitizers, whose flags come after those of the library and win."""
    command = folder / "sanitizes"
    flags = shlex.join([*SANITIZERS, LESS])
    command.write_text(f'#!/bin/sh\nexec {shlex.join(compiler())} "$@" {flags}\n', encoding="utf-8")
    command.chmod(0o755)
    return command


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    """Variables with which a process builds and takes a library with sanitizers."""
    try:
        found = [
            subprocess.run(
                [*compiler(), f"-print-file-name={name}"], capture_output=True, text=True, check=True
            ).stdout.strip()
            for name in ("libasan.so", "libubsan.so")
        ]
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("there is no C compiler")
    if not all(Path(path).is_absolute() for path in found):
        pytest.skip("the compiler has no sanitizers")
    folder = tmp_path_factory.mktemp("sanitizers")
    return os.environ | {
        "CC": str(with_sanitizers(folder)),
        "PROPROTOR_CACHE": str(folder / "cache"),
        "LD_PRELOAD": " ".join(found),
        # Python itself leaves memory to the system as it ends.
        "ASAN_OPTIONS": "detect_leaks=0:abort_on_error=0:exitcode=99",
        "OPENBLAS_NUM_THREADS": "1",
    }


def sanitized(environment, *arguments):
    command = [sys.executable, "-m", "tests.verify.sanitized", *arguments]
    return subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False)


def test_the_sanitizer_reports_memory_that_does_not_belong_to_a_batch(environment):
    done = sanitized(environment, "--fault")
    assert done.returncode == 99 and "heap-buffer-overflow" in done.stderr, done.stderr


def test_hostile_batches_touch_no_memory_but_their_own(environment):
    done = sanitized(environment)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("300 eigenvalue problems"), done.stdout
