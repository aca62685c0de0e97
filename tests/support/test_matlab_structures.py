"""Matrices in files of MATLAB: variables or fields of a struct, with names of either kind; the same modes as by number.

SciPy writes the files as MATLAB does. A file of version 7.3 is HDF5 behind a head of 512 bytes, which is enough to
know it.
"""

import numpy as np
import pytest
from scipy.io import savemat
from scipy.sparse import csc_array

import proprotor as pp
from proprotor.errors import InputError
from proprotor.support.matlab_file import read_matlab
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


@pytest.mark.parametrize("kind", FILES)
@pytest.mark.parametrize("compressed", [False, True])
def test_a_file_of_matlab_is_the_structure(tmp_path, kind, compressed):
    found = read_matlab(filed(tmp_path, FILES[kind], do_compression=compressed), includes_rotor=False, **ONE)
    assert found.names == (NAMES if kind in NAMED else ("mode_1", "mode_2", "mode_3"))
    np.testing.assert_array_equal(found.mass, M)
    np.testing.assert_array_equal(found.stiffness, K)
    np.testing.assert_array_equal(found.damping, 0 * C if kind == "without damping" else C)
    np.testing.assert_array_equal(found.hub, HUB)


def test_a_file_of_version_4(tmp_path):
    found = read_matlab(filed(tmp_path, SHORT, format="4"), **ONE)
    np.testing.assert_array_equal(found.stiffness, K)


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
