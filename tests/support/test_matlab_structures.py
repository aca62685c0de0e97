"""Matrices in files of MATLAB: variables or fields of a struct, with names of either kind; the same modes as by number.

SciPy writes the files as MATLAB does. A file of version 7.3 is HDF5 behind a head of 512 bytes, which is enough to
know it.
"""

import contextlib
import io
import struct

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.io import loadmat, savemat
from scipy.sparse import csc_array

import proprotor as pp
from proprotor.errors import InputError
from proprotor.support.matlab_file import read_matlab
from proprotor.support.matlab_level5 import MatlabFault, variables_of
from proprotor.support.matrix_files import support_from_matrices
from proprotor.support.normal_modes import HUB_AXES
from tests.support.test_modal_files import FOOT, FREQUENCY, HUB, MASS, NAMES, RATIO, SLUG

M, K, C = np.diag(MASS), np.diag(MASS * FREQUENCY**2), np.diag(2 * RATIO * FREQUENCY * MASS)
CELLS = np.array(NAMES, dtype=object)
SHORT = {"M": M, "C": C, "K": K, "Phi": HUB}
LONG = {"mass": M, "damping": C, "stiffness": K, "hub": HUB, "dofs": CELLS}
ONE = {"carries": "one rotor"}
FILES = {
    "variables": SHORT,
    "variables with long names and dofs": LONG,
    "in capitals": {name.upper(): value for name, value in LONG.items()},
    "beside other variables": SHORT | {"notes": "a test", "t": np.arange(5.0), "x": {"a": 1.0}},
    "a struct": {"wing": SHORT},
    "a struct with names in rows of text": {"wing": SHORT | {"names": np.array([*NAMES])}},
    "a struct in a struct": {"model": {"left": {"modal": LONG}, "comment": "half an aircraft"}},
    "sparse matrices": SHORT | {name: csc_array(SHORT[name]) for name in "MCK"},
    "sparse matrices in a struct": {"fe": SHORT | {name: csc_array(SHORT[name]) for name in "MCK"}},
    "without damping": {name: SHORT[name] for name in ("M", "K", "Phi")},
}

NAMED = (
    "variables with long names and dofs",
    "in capitals",
    "a struct with names in rows of text",
    "a struct in a struct",
)


def filed(folder, content, **settings):
    path = folder / "wing.mat"
    savemat(path, content, **settings)
    return path


def in_memory(content, **settings) -> bytes:
    file = io.BytesIO()
    savemat(file, content, **settings)
    return file.getvalue()


GOOD = [
    in_memory(FILES["sparse matrices in a struct"] | LONG, do_compression=packed) for packed in (False, True)
]


@pytest.mark.parametrize("kind", FILES)
@pytest.mark.parametrize("compressed", [False, True])
def test_a_file_of_matlab_is_the_structure(tmp_path, kind, compressed):
    found = read_matlab(filed(tmp_path, FILES[kind], do_compression=compressed), includes_rotor=False, **ONE)
    assert found.names == (NAMES if kind in NAMED else ("mode_1", "mode_2", "mode_3"))
    np.testing.assert_array_equal(found.mass, M)
    np.testing.assert_array_equal(found.stiffness, K)
    np.testing.assert_array_equal(found.damping, 0 * C if kind == "without damping" else C)
    np.testing.assert_array_equal(found.hub, HUB)


def test_variables_are_those_that_scipy_reads(tmp_path):
    """Whole, single, complex and sparse numbers, text, cells, structs and arrays of structs."""
    rng = np.random.default_rng(1)
    given = {
        "bytes": np.arange(6, dtype=np.uint8).reshape(2, 3),
        "large": rng.integers(-(2**60), 2**60, (3, 2)),
        "single": rng.random((2, 2), dtype=np.float32),
        "complex": rng.random((2, 3)) + 1j * rng.random((2, 3)),
        "pages": rng.random((2, 3, 4)),
        "empty": np.zeros((0, 3)),
        "yes": np.array([[True, False]]),
        "text": "Größe",
        "rows": np.array(["ab", "cde"]),
        "cells": np.array(["a", np.eye(2), "ccc"], dtype=object),
        "sparse": csc_array(rng.random((4, 3)) * (rng.random((4, 3)) > 0.5)),
        "struct": {"a": 1.0, "b": {"c": "x", "d": np.eye(3)}},
    }
    for compressed in (False, True):
        path = filed(tmp_path, given, do_compression=compressed)
        found = variables_of(path.read_bytes())
        assert found.keys() == given.keys()
        theirs = loadmat(path)
        for name in ("bytes", "large", "single", "complex", "pages", "empty", "yes"):
            np.testing.assert_array_equal(found[name], theirs[name])
        np.testing.assert_array_equal(found["sparse"].toarray(), theirs["sparse"].toarray())
        assert found["text"] == ["Größe"] and found["rows"] == ["ab ", "cde"]
        assert found["cells"][0] == ["a"] and found["cells"][2] == ["ccc"]
        np.testing.assert_array_equal(found["cells"][1], np.eye(2))
        assert found["struct"]["a"] == 1.0 and found["struct"]["b"]["c"] == ["x"]
        np.testing.assert_array_equal(found["struct"]["b"]["d"], np.eye(3))


def test_a_file_of_a_computer_with_the_other_order_of_bytes(tmp_path):
    """A matrix of doubles, its elements written one after another with the most significant byte first."""
    values = np.array([[1.5, -2.0], [3.25, 4.0]])
    flags = struct.pack(">IIII", 6, 8, 6, 0)
    sizes, name = struct.pack(">IIii", 5, 8, 2, 2), struct.pack(">HH4s", 1, 1, b"M")
    numbers = struct.pack(">II4d", 9, 32, *values.T.ravel())
    body = flags + sizes + name + numbers
    head = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack(">H", 0x0100) + b"MI"
    np.testing.assert_array_equal(variables_of(head + struct.pack(">II", 14, len(body)) + body)["M"], values)


@given(st.data())
@settings(max_examples=300, deadline=None)
def test_any_damage_is_a_fault_of_the_file(data):
    """SciPy's reader ends the process at some of these."""
    content = bytearray(GOOD[data.draw(st.booleans())])
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(124, len(content) - 1))
        content[place : place + data.draw(st.integers(0, 4))] = data.draw(st.binary(max_size=4))
    with contextlib.suppress(MatlabFault):
        variables_of(bytes(content))


def test_one_mode_has_both_axes(tmp_path):
    one = {"M": M[:1, :1], "K": K[:1, :1], "Phi": HUB[:, :1]}
    found = read_matlab(filed(tmp_path, one), **ONE)
    assert found.mass.shape == (1, 1)
    np.testing.assert_array_equal(found.hub, HUB[:, :1])


def test_finite_elements_with_the_hub_by_name(tmp_path):
    names = [f"hub_{axis}" for axis in HUB_AXES]
    content = {"M": csc_array(np.eye(6)), "K": 9.0 * np.eye(6), "dofs": np.array(names, dtype=object)}
    found = read_matlab(filed(tmp_path, content))
    assert found.names == tuple(names)
    np.testing.assert_array_equal(found.hub, np.eye(6))


def test_sparse_matrices_on_modal_coordinates_need_no_names():
    found = support_from_matrices(csc_array(M), csc_array(K), hub=HUB, **ONE)
    assert found.names == ("mode_1", "mode_2", "mode_3")


def test_a_deck_names_a_file_of_matlab_with_units_and_damping_by_mode(tmp_path):
    energy = SLUG * FOOT**2
    scaled = {"M": M / energy, "K": K / energy, "Phi": HUB / np.array([[FOOT]] * 3 + [[1.0]] * 3)}
    filed(tmp_path, {"wing": scaled})
    (tmp_path / "deck.toml").write_text(
        'base = "xv15-uncoupled"\n[case]\nname = "m"\ntitle = "m"\n[support]\nkind = "matrices"\nfile = "wing.mat"\n'
        'includes_rotor = false\ncarries = "one rotor"\nlength_unit = "1 ft"\nmass_unit = "1 slug"\n'
        f"damping_ratio = {{ value = {RATIO.tolist()} }}\n",
        encoding="utf-8",
    )
    found = pp.load_case(tmp_path / "deck.toml").support
    for matrix, expected in {"mass": M, "stiffness": K, "damping": C, "hub": HUB}.items():
        np.testing.assert_allclose(
            getattr(found, matrix), expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max()
        )


REFUSED = {
    "no matrices": ({"x": 1.0}, {}, "has no mass and stiffness: name them M and K, or mass and stiffness"),
    "no stiffness": ({"M": M, "Phi": HUB}, {}, "has no mass and stiffness"),
    "two structures": (
        {"a": SHORT, "b": LONG},
        {},
        "has mass and stiffness in several places: a, b; keep one",
    ),
    "numbers for names": (
        SHORT | {"dofs": np.arange(3)},
        ONE,
        "must have names of coordinates as text in dofs",
    ),
    "the hub twice": (
        SHORT,
        ONE | {"hub": {"x": "a"}},
        "^hub: must not be given with a file that has the motion",
    ),
    "a row of masses": (SHORT | {"M": MASS[None]}, ONE, "^mass = "),
    "text for a matrix": (SHORT | {"M": "heavy"}, ONE, "^mass = .*: must be real numbers"),
    "a struct for a matrix": (SHORT | {"M": {"a": 1}}, ONE, "has no mass and stiffness"),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_a_file_of_matlab_that_is_no_support(tmp_path, kind):
    content, options, message = REFUSED[kind]
    with pytest.raises(InputError, match=message) as caught:
        read_matlab(filed(tmp_path, content), **options)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (
            b"MATLAB 7.3 MAT-file".ljust(512) + b"\x89HDF\r\n\x1a\n",
            r"is of version 7.3: save it with save\(name, ..., '-v7'\)",
        ),
        (b"\x89HDF\r\n\x1a\n", "is of version 7.3"),
        (b"MATLAB 5.0 MAT-file", "is damaged, or another kind of file"),
        (b"", "is damaged, or another kind of file"),
        (in_memory(SHORT, format="4"), "is damaged, or another kind of file: save it with"),
        (None, "no such file"),
    ],
)
def test_files_that_cannot_be_read(tmp_path, content, message):
    path = tmp_path / "wing.mat"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match=message) as caught:
        read_matlab(path)
    assert "\n" not in str(caught.value)
