"""The numerical tests under several kernels of OpenBLAS, which round differently.

    python -m tests.verify.kernels                (part of make verify)

OpenBLAS has kernels for several kinds of processor and takes the best that a processor can. What holds under one may
hang on its rounding: the sign of a root that is zero, the order of two that are equal. Here each kernel is asked for by
name; one that this processor, or this build, does not have is told and passed over, and so is the one that it takes of
itself: `make test` runs all tests under that.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# Of the widest instructions to the narrowest: AVX-512, AVX2, AVX; Zen is AVX2 with blocks of its own.
KERNELS = ("SkylakeX", "Haswell", "Zen", "Sandybridge")
# What compares eigenvalues, vectors and what is followed, found and counted from them. The other tests ask about text,
# files, messages and single formulas, which no kernel computes; all of them together would take an hour.
NUMERICAL = (
    "attribution",
    "design",
    "flutter",
    "golden",
    "invariants",
    "limits",
    "mixed_batches",
    "random_decks",
    "scaling",
    "sensitivity",
    "stability_map",
    "stiffness_factors",
    "study",
    "sweep",
    "tracking",
    "trim",
    "trim_targets",
)
# Of a file that asks about entries of matrices too, the tests that take eigenvalues.
ALONE = {
    "invariants": (
        "test_mass_is_nowhere_negative",
        "test_mass_is_positive_once_the_hub_carries_inertia",
        "test_collective_and_cyclic_motions_are_those_of_one_blade",
        "test_nothing_grows_when_all_rotating_frequencies_are_above_one_per_rev",
        "test_blades_lagging_below_one_per_rev_shake_a_soft_hub_apart",
        "test_a_gimbal_below_one_per_rev_is_unstable_although_every_blade_is_above",
        "test_a_support_turned_about_the_shaft_keeps_its_eigenvalues",
        "test_flap_lag_and_gimbal_frequencies_of_a_flat_rotor",
    ),
}
_CORE = re.compile(r"^Core: (\w+)$", re.MULTILINE)
_TRIED = "import numpy; numpy.linalg.eigvals(numpy.random.default_rng(0).normal(size=(40, 40)))"


def environment(kernel: str | None) -> dict[str, str]:
    """Variables with which a process takes a kernel, or the one that it finds best, on one thread."""
    return os.environ | {"OPENBLAS_NUM_THREADS": "1"} | ({"OPENBLAS_CORETYPE": kernel} if kernel else {})


def core_in_force(kernel: str | None = None) -> str:
    """The kernel that a process has which asks for one, or for none; "" where it cannot work, or has no OpenBLAS."""
    tried = subprocess.run(
        [sys.executable, "-c", _TRIED],
        env=environment(kernel) | {"OPENBLAS_VERBOSE": "2"},
        capture_output=True,
        text=True,
        check=False,
    )
    found = _CORE.search(tried.stdout + tried.stderr)
    return found[1] if found and not tried.returncode else ""


def selected() -> Iterator[str]:
    """Files and tests that are run, as pytest names them."""
    for name in NUMERICAL:
        for path in (ROOT / "tests").glob(f"*/test_{name}.py"):
            file = path.relative_to(ROOT).as_posix()
            yield from (f"{file}::{test}" for test in ALONE[name]) if name in ALONE else (file,)


def tested(kernel: str, arguments: list[str]) -> bool:
    """Run the tests under a kernel, print what they print when they are done, and return whether all passed.

    The files of the tests stand in a folder of this run alone: runs that start and end at the same time would else
    remove the same folders of earlier runs, and the one that comes second would fail.
    """
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *selected(), *arguments]
    with tempfile.TemporaryDirectory() as own:
        done = subprocess.run(
            command,
            env=environment(kernel) | {"PYTEST_DEBUG_TEMPROOT": own},
            cwd=ROOT,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            check=False,
        )
    print(f"{kernel}:\n{done.stdout}", flush=True)
    return not done.returncode


def main(arguments: list[str] | None = None) -> int:
    """Run the tests under every kernel but the process's own; further arguments are those of pytest.

    Each kernel has a process of its own, and there are as many at a time as processors: kernels take about the same
    time, so that all processors are busy until the end.
    """
    given = sys.argv[1:] if arguments is None else arguments
    asked = []
    own = core_in_force()
    for kernel in KERNELS:
        if kernel == own:
            print(f"{kernel}: passed over, as `make test` runs under it", flush=True)
        elif (core := core_in_force(kernel)) != kernel:
            print(
                f"{kernel}: passed over, as this processor or OpenBLAS has {core or 'none'} in its place",
                flush=True,
            )
        else:
            asked.append(kernel)
    with ThreadPoolExecutor(os.cpu_count()) as processors:
        passed = processors.map(lambda kernel: tested(kernel, given), asked)
        failed = [kernel for kernel, all_passed in zip(asked, passed, strict=True) if not all_passed]
    print(
        f"numerical tests run under {', '.join(asked) or 'no kernel'}; "
        f"failed under {', '.join(failed) or 'none'}"
    )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
