"""The solver as one header and one source: the same bits in C, Fortran and Octave, examples, codes, and interfaces."""

import ctypes
import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from proprotor.compiled import eigenvalues
from proprotor.compiled.library import GENERATED, SOURCES, library, why_not
from proprotor.compiled.single_file import write_single_file
from tests.documentation import DOCS, blocks

needs_compiler = pytest.mark.skipif("there is no C compiler" in why_not(), reason="there is no C compiler")
FLAGS = ("-O1", "-std=gnu11", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror")
DONE, BAD_SIZE = 0, 1
PROGRAMS, COUNT, N = (
    Path(__file__).parent / "programs",
    11,
    5,
)  # which read 11 matrices of 5 rows, and 5 motions
# x'' + 0.2 x' + k x = 0 with k = 4 and 9: -0.1 + i sqrt(k - 0.01)
ROOTS = ((-0.1, 3.99**0.5), (-0.1, 8.99**0.5))


def example(kind, folder, name):
    (block,) = [block for block in blocks(DOCS / "howto" / "compiled.md") if block.kind == kind]
    (folder / name).write_text(block.text, encoding="utf-8")
    return folder / name


def numbers(printed):
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


def run(folder, *command):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert not done.returncode, done.stderr
    return done.stdout


def built_in_c(folder, source):
    run(
        folder,
        *shlex.split(os.environ.get("CC") or "cc"),
        *FLAGS,
        "proprotor.c",
        source,
        "-lm",
        "-o",
        "program",
    )
    return ["./program"]


def built_in_fortran(folder, source):
    run(folder, "cc", *FLAGS, "-c", "proprotor.c")
    run(
        folder, "gfortran", "-Wall", "-Werror", "proprotor.f90", source, "proprotor.o", "-lm", "-o", "program"
    )
    return ["./program"]


def built_in_octave(folder, source):
    command = ["mkoctfile", "--mex", "proprotor_mex.c", "proprotor.c"]
    run(folder, "env", f"CFLAGS={shlex.join([*FLAGS, '-fPIC'])}", *command)
    return ["octave-cli", "--quiet", "--norc", source]


LANGUAGES = {"c": ("c", built_in_c), "fortran": ("f90", built_in_fortran), "matlab": ("m", built_in_octave)}
NEEDS = {"fortran": ("gfortran",), "matlab": ("mkoctfile", "octave-cli")}
languages = pytest.mark.parametrize(
    "language",
    [
        pytest.param(
            one,
            marks=pytest.mark.skipif(
                not all(map(shutil.which, NEEDS.get(one, ()))),
                reason=f"needs {' and '.join(NEEDS.get(one, ()))}",
            ),
        )
        for one in LANGUAGES
    ],
)


@languages
@needs_compiler
def test_the_example_of_the_page_prints_the_roots(tmp_path, language):
    write_single_file(tmp_path)
    ending, build = LANGUAGES[language]
    command = build(tmp_path, example(language, tmp_path, f"example.{ending}").name)
    np.testing.assert_allclose(numbers(run(tmp_path, *command)), ROOTS, rtol=0, atol=1e-6)


@languages
@needs_compiler
def test_eigenvalues_vectors_and_roots_have_the_bits_of_those_in_python(tmp_path, language):
    """Also those of a matrix that is handed over, and of equations of motion with a coordinate that is not held."""
    write_single_file(tmp_path)
    ending, build = LANGUAGES[language]
    source = tmp_path / f"program.{ending}"
    source.write_text((PROGRAMS / f"all_functions.{ending}").read_text(encoding="utf-8"), encoding="utf-8")
    matrices = np.random.default_rng(0).standard_normal((COUNT, N, N))
    matrices[5, 1, 2] = np.nan
    mass = matrices[6:] @ matrices[6:].swapaxes(1, 2) + np.eye(N)
    matrices.tofile(tmp_path / "matrices.bin")
    np.stack([mass, matrices[:5], matrices[6:]]).tofile(tmp_path / "motion.bin")
    run(tmp_path, *build(tmp_path, source.name))
    served = ~eigenvalues.handed_over(matrices)
    assert served.sum() == COUNT - 1
    values, right = eigenvalues.eig(matrices[served])
    roots, rest = eigenvalues.roots_of_motion(mass, matrices[:5], matrices[6:], [0, 2])
    assert not rest.any()
    for name, expected in (("values", values), ("vectors", right), ("roots", roots)):
        found = np.fromfile(tmp_path / f"{name}.bin", dtype=complex)
        count = COUNT if name != "roots" else len(roots)
        found = found.reshape(count, *expected.shape[1:])
        assert (found[served] if name != "roots" else found).tobytes() == expected.tobytes(), name
    assert (np.fromfile(tmp_path / "handed_over.bin", dtype=bool) == ~served).all()


@pytest.mark.skipif(not all(map(shutil.which, NEEDS["matlab"])), reason="needs Octave")
@needs_compiler
def test_the_function_of_matlab_refuses_what_it_cannot_take(tmp_path):
    write_single_file(tmp_path)
    calls = {
        "'eigenvalues', ones(2, 3)": "square",
        "'eigenvalues', 1i * eye(2)": "real array",
        "'eigenvalues', sparse(eye(2))": "real array",
        "'eigenvalues', single(eye(2))": "real array",
        "'eigenvalues', zeros(0)": "1 to 256 states",
        "'eigenvalues', zeros(257)": "1 to 256 states",
        "'eigenvalues', ones(2, 2, 2, 2)": "real array",
        "'eigenvalues'": "proprotor_mex(",
        "'roots_of_motion', eye(2), eye(2), eye(3)": "one size",
        "'roots_of_motion', eye(2), eye(2), eye(2), 3": "coordinates that exist",
        "'roots_of_motion', eye(2), eye(2), eye(2), 0": "coordinates that exist",
        "'roots_of_motion', eye(2), eye(2), eye(2), 1.5": "coordinates that exist",
        "'roots_of_motion', eye(2), eye(2), eye(2), NaN": "coordinates that exist",
        "'roots_of_motion', eye(2), eye(2), eye(2), [1 2 1]": "coordinates that exist",
        "'roots_of_motion', eye(2), eye(2), eye(2), 'ab'": "numbers of coordinates",
        "'something'": "proprotor_mex(",
        "": "proprotor_mex(",
    }
    lines = [f"try, proprotor_mex({call}), catch e, disp(e.message), end" for call in calls]
    (tmp_path / "calls.m").write_text("\n".join(lines), encoding="utf-8")
    said = run(tmp_path, *built_in_octave(tmp_path, "calls.m")).splitlines()
    assert len(said) == len(calls)
    for line, (call, words) in zip(said, calls.items(), strict=True):
        assert words in line, (call, line)


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
