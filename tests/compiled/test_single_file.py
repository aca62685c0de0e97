"""The solver as one header and one source: examples, return codes, and the interface for Fortran."""

import ctypes
import os
import re
import shlex
import shutil
import subprocess

import numpy as np
import pytest

from proprotor.compiled import eigenvalues
from proprotor.compiled.library import GENERATED, SOURCES, library, why_not
from proprotor.compiled.single_file import write_single_file
from tests.documentation import DOCS, blocks

needs_compiler = pytest.mark.skipif("there is no C compiler" in why_not(), reason="there is no C compiler")
FLAGS = ("-O1", "-std=gnu11", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror")
DONE, BAD_SIZE = 0, 1
# x'' + 0.2 x' + k x = 0 with k = 4 and 9: -0.1 + i sqrt(k - 0.01)
ROOTS = ((-0.1, 3.99**0.5), (-0.1, 8.99**0.5))


def example(kind, folder, name):
    (block,) = [block for block in blocks(DOCS / "howto" / "compiled.md") if block.kind == kind]
    (folder / name).write_text(block.text, encoding="utf-8")
    return folder / name


def compiled(folder, compiler, *flags):
    """Build `proprotor.c` of a folder with a compiler, and return the command."""
    command = [*compiler, *flags, "-c", "proprotor.c"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)


def numbers(command):
    printed = subprocess.run([command], check=True, capture_output=True, text=True).stdout
    return [[float(number) for number in re.findall(r"-?\d*\.\d+", line)] for line in printed.splitlines()]


@needs_compiler
def test_the_sources_of_the_library_compile_without_a_warning():
    command = [
        *shlex.split(os.environ.get("CC") or "cc"),
        *FLAGS,
        "-fsyntax-only",
        f"-I{SOURCES}",
        f"-I{GENERATED}",
    ]
    done = subprocess.run(
        [*command, *sorted(SOURCES.glob("*.c"))], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


@needs_compiler
def test_the_example_in_c_prints_the_roots(tmp_path):
    write_single_file(tmp_path)
    compiler, source = shlex.split(os.environ.get("CC") or "cc"), example("c", tmp_path, "example.c")
    command = [*compiler, *FLAGS, "proprotor.c", source.name, "-lm", "-o", "example"]
    subprocess.run(command, cwd=tmp_path, check=True)
    np.testing.assert_allclose(numbers(tmp_path / "example"), ROOTS, rtol=0, atol=1e-6)


@pytest.mark.skipif(not shutil.which("gfortran"), reason="there is no gfortran")
@needs_compiler
def test_the_example_in_fortran_prints_the_roots(tmp_path):
    write_single_file(tmp_path)
    compiled(tmp_path, ["cc"], *FLAGS)
    source = example("fortran", tmp_path, "example.f90")
    command = ["gfortran", "proprotor.f90", source.name, "proprotor.o", "-lm", "-o", "example"]
    subprocess.run(command, cwd=tmp_path, check=True)
    np.testing.assert_allclose(numbers(tmp_path / "example"), ROOTS, rtol=0, atol=1e-6)


def test_the_interface_for_fortran_is_that_of_the_header():
    """Functions, arguments in order, their kinds, what is passed by value, and the return codes."""
    header, module = (
        (SOURCES / f"proprotor.{ending}").read_text(encoding="utf-8") for ending in ("h", "f90")
    )
    module = re.sub(r"&\n\s*|!.*", "", module)
    functions = re.findall(r"^int (\w+)\((.*)\);$", header, re.MULTILINE)
    assert len(functions) == 2
    kinds = {
        "int": "c_int",
        "long long": "c_long_long",
        "double": "c_double",
        "unsigned char": "c_signed_char",
    }
    for name, arguments in functions:
        given = re.search(rf"function {name}\((.*?)\) bind\(c\)(.*?)end function", module, re.DOTALL)
        assert re.split(r",\s*", given[1]) == [re.search(r"(\w+)$", one)[1] for one in arguments.split(", ")]
        lines = dict(declarations(given[2]))
        for argument in arguments.split(", "):
            of_c, star, own = re.match(r"(?:const )?([a-z ]+?) ?(\*?)(\w+)$", argument).groups()
            line = lines[own]
            assert ("value" in line) == (not star) or "c_ptr" in line, own
            assert kinds[of_c] in line or "c_ptr" in line, own
            assert ("intent(in)" in line) == ("const" in argument), own
    codes = re.search(r"enum \{ (.*) \}", header)[1].lower().split(", ")
    assert [f"{code} = {number}" in module for number, code in enumerate(codes)] == [True] * 3


def declarations(text):
    """Name and type of each argument of an interface."""
    for line in text.splitlines():
        of, colons, names = line.partition("::")
        if colons and "import" not in of:
            for name in names.split(","):
                yield name.strip().partition("(")[0], of


@needs_compiler
def test_the_plain_interface_has_the_bits_of_the_library_and_refuses_sizes():
    matrices = np.random.default_rng(0).standard_normal((11, 9, 9))
    values, right = np.empty((11, 9), dtype=complex), np.empty((11, 9, 9), dtype=complex)
    rest, solve = np.ones(11, dtype=bool), library().proprotor_eigenvalues
    places = [ctypes.c_void_p(one.ctypes.data) for one in (matrices, values, right, rest)]
    assert solve(9, ctypes.c_longlong(11), *places) == DONE
    expected, vectors = eigenvalues.eig(matrices)
    assert (values == expected).all() and (right == vectors).all() and not rest.any()
    for n, count in ((0, 1), (-1, 1), (eigenvalues.MOST_STATES + 1, 1), (9, -1)):
        assert solve(n, ctypes.c_longlong(count), *places) == BAD_SIZE
    motion = library().proprotor_roots_of_motion
    parts = [places[0]] * 3 + [places[1], places[3]]
    for n, held in ((0, ()), (3, (3,)), (3, (-1,)), (2, (0, 1, 1)), (200, range(60))):
        numbers_of_held = (ctypes.c_int * max(len(held), 1))(*held)
        assert motion(n, len(held), numbers_of_held, ctypes.c_longlong(1), *parts) == BAD_SIZE
