"""C81 files: read as written, and one clear line for every mistake.

The files are made up; none is that of a real airfoil.
"""

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from proprotor.errors import InputError
from proprotor.rotor.airfoil_table import AirfoilTable
from proprotor.rotor.c81 import read_c81
from tests.c81_files import as_c81, made_up_tables

TEXT = as_c81("MADE UP", **made_up_tables())
LINES = TEXT.splitlines()


@pytest.fixture
def read(tmp_path):
    path = tmp_path / "a.c81"

    def read(content: str | bytes):
        path.write_bytes(content if isinstance(content, bytes) else content.encode("latin-1"))
        return read_c81(path)

    return read


@pytest.mark.parametrize("n_mach", [1, 2, 9, 10, 18, 19, 99])
def test_a_file_reads_as_written(read, n_mach):
    tables = made_up_tables(n_mach)
    title, _, found = read(as_c81("MADE UP", **tables))
    assert title == "MADE UP"
    for name, (alpha, mach, values) in tables.items():
        np.testing.assert_allclose(found[name][0], np.deg2rad(alpha), rtol=1e-15)
        np.testing.assert_array_equal(found[name][1], mach)
        np.testing.assert_array_equal(found[name][2], values)


def test_an_airfoil_of_a_file(tmp_path):
    path = tmp_path / "a.c81"
    path.write_text(TEXT)
    table = AirfoilTable.from_c81(path)
    assert table.name == "MADE UP"
    for name, (alpha, mach, values) in made_up_tables().items():
        found = getattr(table.coefficients(np.deg2rad(alpha)[:, None], mach), f"{name}_coefficient")
        np.testing.assert_allclose(found, values, rtol=0, atol=1e-14)


def test_numbers_as_people_write_them(read):
    lines = [
        "Numbers of many kinds          2 3 1 2 1 2 and a remark",
        "            .0     .5 ".ljust(70) + "a remark beyond column 70",
        " -10.    -1.E0   -1.",
        "     0 0           0",
        "10.     1.    +1.2e0   ",
        "             0",
        " -180.    .01",
        "  180.    .01",
        "            0.",
        "  -1.0 -0.001",
        "+1.0    0.001",
        "",
        "  ",
    ]
    text = "\r\n".join(lines)
    title, _, tables = read(text)
    assert title == "Numbers of many kinds"
    np.testing.assert_allclose(tables["lift"][2], [[-1, -1], [0, 0], [1, 1.2]])
    np.testing.assert_allclose(tables["lift"][0], np.deg2rad([-10, 0, 10]))
    np.testing.assert_allclose(tables["moment"][2], [[-0.001], [0.001]])


def changed(number: int, *replacements: tuple[int, str], lines=LINES) -> str:
    """The file with columns of one line, counted from 1, overwritten."""
    line = lines[number - 1]
    for column, new in replacements:
        line = line[: column - 1].ljust(column - 1) + new + line[column - 1 + len(new) :]
    return "\n".join([*lines[: number - 1], line, *lines[number:]])


def without(number: int) -> str:
    return "\n".join([*LINES[: number - 1], *LINES[number:]])


# Of the file above line 1 has the counts, 2 and 3 the Mach numbers of lift, 4 and 5 the first of 25 rows.
DRAG = 3 + 2 * 25 + 1
MISTAKES = [
    ("", "line 1: must have six counts of two digits in columns 31 to 42"),
    (TEXT[:38], "line 1: must have six counts of two digits in columns 31 to 42"),
    (changed(1, (31, "1.")), "line 1: must have six counts of two digits in columns 31 to 42"),
    (changed(1, (31, "-1")), "line 1: must have six counts of two digits in columns 31 to 42"),
    (changed(1, (31, "00")), "line 1: must announce one Mach number and two angles of attack or more"),
    (changed(1, (31, "10")), "line 3: must have no more than the 10 values that line 1 announces"),
    (changed(1, (31, "12")), "line 3: must have a number in columns 22 to 28, not blanks"),
    (changed(1, (31, "20")), "line 3: must have a number in columns 22 to 28, not blanks"),
    (changed(1, (33, "26")), "line 54: must have a number in columns 1 to 7, not blanks"),
    (
        changed(1, (33, "24")),
        "line 52: must have blanks in columns 1 to 7, before values of the Mach numbers of drag",
    ),
    (
        changed(1, (41, "07")),
        f"line {len(LINES)}: must not be there: the counts of line 1 end the moment table before",
    ),
    (
        changed(1, (41, "09")),
        f"line {len(LINES) + 1}: is missing; it must have row 9 of 9 of the moment table",
    ),
    (TEXT + "extra", f"line {len(LINES) + 1}: must not be there"),
    (changed(6, (8, "   x   ")), "line 6: must have a number in columns 8 to 14, not 'x'"),
    (changed(6, (8, "    nan")), "line 6: must have a number in columns 8 to 14, not 'nan'"),
    (changed(6, (8, "  1e999")), "line 6: must have a number in columns 8 to 14, not '1e999'"),
    (changed(6, (8, "    1_0")), "line 6: must have a number in columns 8 to 14, not '1_0'"),
    (changed(6, (8, "   - 1.")), "line 6: must have a number in columns 8 to 14, not '- 1.'"),
    (changed(6, (8, "\t    1.")), "line 6: must have a number in columns 8 to 14, not '\\t    1.'"),
    (changed(6, (8, "   \x00\x1b  ")), "line 6: must have a number in columns 8 to 14, not '\\x00\\x1b'"),
    (changed(6, (8, "   1,2 ")), "line 6: must have a number in columns 8 to 14, not '1,2'"),
    (changed(6, (8, "  99999")), "line 6: coefficients must be finite and at most 1000 (lift)"),
    (changed(6, (1, "       ")), "line 6: must have a number in columns 1 to 7, not blanks"),
    (changed(6, (1, "-180.00")), "line 6: angles of attack must increase from row to row (lift)"),
    (changed(6, (1, " 999.00")), "line 6: the angle of attack must lie between -180 and 180 deg"),
    (changed(2, (15, " 0.0000")), "line 2: Mach numbers must increase from column to column (lift)"),
    (changed(2, (8, "-0.1000")), "line 2: Mach numbers must lie between 0 and 10 (lift)"),
    (
        changed(2, (1, "     .1")),
        "line 2: must have blanks in columns 1 to 7, before values of the Mach numbers of lift",
    ),
    (
        changed(5, (1, "     .1")),
        "line 5: must have blanks in columns 1 to 7, before values of row 1 of 25 of the lift",
    ),
    (
        without(5),
        "line 5: must have blanks in columns 1 to 7, before values of row 1 of 25 of the lift table",
    ),
    (changed(DRAG + 2, (15, "-0.0001")), f"line {DRAG + 2}: coefficients must not be less than 0 (drag)"),
    (b"\xff" * 999_999, "line 1: must have six counts"),
    (b"9" * 1_000_001, "must not be larger than 1000000 bytes"),
]


@pytest.mark.parametrize(
    ("content", "rule"), MISTAKES, ids=[f"{i}: {rule}" for i, (_, rule) in enumerate(MISTAKES)]
)
def test_a_mistake_is_told_in_one_line(read, content, rule):
    with pytest.raises(InputError) as caught:
        read(content)
    told = str(caught.value)
    assert told.startswith("table = ") and "\n" not in told
    assert caught.value.rule.startswith(rule), caught.value.rule


@pytest.mark.parametrize("name", ["nowhere.c81", ".", "/dev/zero", "\0", "a" * 9999])
def test_a_file_that_cannot_be_read(tmp_path, name):
    with pytest.raises(InputError, match=r"^table = .*: (no such file|cannot be read \(.*\))$"):
        AirfoilTable.from_c81(tmp_path / name)


edits = st.tuples(
    st.integers(0, len(TEXT) + 5),
    st.integers(0, 80),
    st.text("0123456789.eE+- \n\r\t\0xé", max_size=20),
)


@settings(max_examples=300)
@given(st.lists(edits, max_size=4))
def test_any_file_is_read_or_refused(tmp_path_factory, changes):
    text = TEXT
    for start, length, new in changes:
        text = text[:start] + new + text[start + length :]
    path = tmp_path_factory.getbasetemp() / "fuzzed.c81"
    path.write_bytes(text.encode("latin-1"))
    started = time.perf_counter()
    try:
        table = AirfoilTable.from_c81(path)
    except InputError as error:
        assert "\n" not in str(error)
    else:
        assert np.isfinite(table.coefficients(np.linspace(-4, 4, 9)[:, None], np.linspace(0, 1, 5))).all()
    assert time.perf_counter() - started < 2


@given(st.binary(max_size=300))
def test_any_bytes_are_read_or_refused(tmp_path_factory, content):
    path = tmp_path_factory.getbasetemp() / "bytes.c81"
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"^table = "):
        read_c81(path)
