"""`make verify` runs the numerical tests under the kernels that it says."""

import ast
import subprocess

import pytest

from tests.verify import kernels


def test_the_numerical_tests_are_there():
    for name in kernels.NUMERICAL:
        assert len([*(kernels.ROOT / "tests").glob(f"*/test_{name}.py")]) == 1, name


EIGENVALUES = {"eig", "eigvals", "eigh", "eigvalsh", "modes", "sweep", "flutter_point"}


@pytest.mark.parametrize("name", kernels.ALONE)
def test_of_a_file_that_is_run_in_part_every_test_that_takes_eigenvalues_is_run(name):
    """Those that call one of them, or a function of the file that does."""
    (path,) = (kernels.ROOT / "tests").glob(f"*/test_{name}.py")
    bodies = [
        node for node in ast.parse(path.read_text(encoding="utf-8")).body if isinstance(node, ast.FunctionDef)
    ]
    uses = {
        body.name: {getattr(node, "attr", getattr(node, "id", "")) for node in ast.walk(body)}
        for body in bodies
    }
    taking = set(EIGENVALUES)
    while more := {name for name, used in uses.items() if used & taking} - taking:
        taking |= more
    assert {name for name in taking if name.startswith("test_")} == set(kernels.ALONE[name])


@pytest.fixture
def told(monkeypatch):
    """Commands that would run, with the kernel that each asks for.

    The first kernel is the one that the processor takes of itself; the second is one that it lacks.
    """
    asked = []

    def run(command, *, env, **_):
        kernel = env["OPENBLAS_CORETYPE"]
        asked.append((kernel, command))
        fails = kernel == kernels.KERNELS[2]
        return subprocess.CompletedProcess(command, int(fails), f"what is printed under {kernel}")

    own, lacking = kernels.KERNELS[:2]

    def core_in_force(kernel=None):
        return "Other" if kernel == lacking else kernel or own

    monkeypatch.setattr(kernels, "core_in_force", core_in_force)
    monkeypatch.setattr(kernels.subprocess, "run", run)
    return asked


def test_the_own_kernel_and_one_that_is_lacking_are_passed_over_and_one_that_fails_fails(told, capsys):
    assert kernels.main(["-x"]) == 1
    own, lacking, failing, last = kernels.KERNELS
    assert {kernel for kernel, _ in told} == {failing, last} and len(told) == 2
    assert all("tests/stability/test_golden.py" in command and command[-1] == "-x" for _, command in told)
    printed = capsys.readouterr().out
    for kernel in (failing, last):
        assert f"{kernel}:\nwhat is printed under {kernel}\n" in printed
    assert f"{lacking}: passed over, as this processor or OpenBLAS has Other in its place" in printed
    assert f"{own}: passed over, as `make test` runs under it" in printed
    assert printed.endswith(f"under {failing}, {last}; failed under {failing}\n")


def test_a_kernel_that_nobody_has_is_not_in_force():
    assert kernels.core_in_force("NoSuchKernel") != "NoSuchKernel"


def test_the_own_kernel_is_that_of_a_process_that_asks_for_none(monkeypatch):
    monkeypatch.delenv("OPENBLAS_CORETYPE", raising=False)
    own = kernels.core_in_force()
    assert kernels.core_in_force("NoSuchKernel") == own
    monkeypatch.setenv("OPENBLAS_CORETYPE", "Nehalem")
    assert kernels.core_in_force() == kernels.core_in_force("Nehalem")
