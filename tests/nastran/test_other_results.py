"""HDF5, punch and print files, and the same modes in each."""

import subprocess
import sys

import numpy as np
import pytest

from proprotor.errors import InputError
from tests.nastran.test_op2 import assert_modes, read, refusal, run
from tests.nastran.written import HUB, OTHER, save_hdf5, save_printed, save_punch

SEVEN_DIGITS = 1e-6
DOUBLE = 1e-14


def test_hdf5(tmp_path):
    given = run()
    assert_modes(read(save_hdf5(tmp_path / "a.h5", [given])), given, DOUBLE)


def test_hdf5_with_two_subcases_and_complex_vectors_beside(tmp_path):
    one, two = run(1), run(2, subcase=3)
    path = save_hdf5(tmp_path / "a.h5", [one, two], complex_too=True)
    assert refusal(path) == "subcase: must be given: the file has 1, 3"
    assert_modes(read(path, subcase=1), one, DOUBLE)
    assert_modes(read(path, subcase=3), two, DOUBLE)


def test_hdf5_without_eigenvalues_needs_the_masses(tmp_path):
    given = run()
    path = save_hdf5(tmp_path / "a.h5", [given], eigenvalues=False)
    assert "has no eigenvalue table" in refusal(path)
    assert_modes(read(path, generalized_mass=given.mass), given, DOUBLE)


def test_hdf5_of_buckling_of_complex_modes_and_of_another_program(tmp_path):
    h5py = pytest.importorskip("h5py")
    given = run()
    buckling = save_hdf5(tmp_path / "a.h5", [given], approach=8)
    assert "has no real eigenvectors" in refusal(buckling)
    with h5py.File(tmp_path / "b.h5", "w") as file:
        file["NASTRAN/RESULT/NODAL/EIGENVECTOR_CPLX"] = np.zeros(3)
    assert "has complex eigenvectors alone" in refusal(tmp_path / "b.h5")
    with h5py.File(tmp_path / "c.h5", "w") as file:
        file["model"] = np.zeros(3)
    assert "has no results of MSC Nastran" in refusal(tmp_path / "c.h5")
    with h5py.File(tmp_path / "d.h5", "w") as file:
        file["NASTRAN/RESULT/NODAL/EIGENVECTOR"] = np.zeros(3)
    assert "is damaged, or has other tables" in refusal(tmp_path / "d.h5")
    content = buckling.read_bytes()
    (tmp_path / "e.h5").write_bytes(content[: len(content) // 2])
    assert "is damaged" in refusal(tmp_path / "e.h5")


def test_hdf5_tells_the_output_system_of_the_grid_point(tmp_path):
    path = save_hdf5(tmp_path / "a.h5", [run()], systems={OTHER: 3, HUB: 5})
    assert "grid point 1101 has the output coordinate system 5" in str(read(path, hub=None).warning)
    assert read(save_hdf5(tmp_path / "b.h5", [run()], systems={OTHER: 3, HUB: 0}), hub=None).warning is None


AFTER_HDF5 = """
import subprocess
import sys
import h5py

with h5py.File(sys.argv[1], "w") as file:
    file["x"] = [1.0]

import proprotor as pp

found = pp.load_case("xv15-uncoupled").sweep([80.0, 90.0])
pp.save_results(found, sys.argv[2])
print(pp.load_results(sys.argv[2]).equals(found))
"""


def test_results_are_saved_after_an_hdf5_file_was_opened(tmp_path):
    """The wheels of h5py and of netCDF4 bring an HDF5 library each; not any two of them go together."""
    command = [sys.executable, "-c", AFTER_HDF5, tmp_path / "modes.h5", tmp_path / "sweep.nc"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.stdout == "True\n", done.stderr


def test_without_h5py_the_extra_is_named(tmp_path, monkeypatch):
    path = save_hdf5(tmp_path / "a.h5", [run()])
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(InputError, match=r'needs h5py for .*: pip install "proprotor\[nastran\]"$'):
        read(path)


def test_punch(tmp_path):
    given = run()
    path = save_punch(tmp_path / "a.pch", [given])
    assert "has no eigenvalue table" in refusal(path)
    assert_modes(read(path, generalized_mass=given.mass), given, SEVEN_DIGITS)


def test_punch_with_two_subcases_and_other_results(tmp_path):
    """Displacements of a static subcase in the same file, and complex vectors, are not the modes."""
    one, two = run(1), run(2, subcase=3)
    parts = [
        save_punch(tmp_path / "1.pch", [run(5)], kind="DISPLACEMENTS"),
        save_punch(tmp_path / "2.pch", [one]),
        save_punch(tmp_path / "3.pch", [two], form="REAL-IMAGINARY"),
        save_punch(tmp_path / "4.pch", [two]),
    ]
    path = tmp_path / "a.pch"
    path.write_text("".join(part.read_text() for part in parts))
    assert_modes(read(path, subcase=1, generalized_mass=one.mass), one, SEVEN_DIGITS)
    assert_modes(read(path, subcase=3, generalized_mass=two.mass), two, SEVEN_DIGITS)
    assert "has complex eigenvectors alone" in refusal(parts[2])


def test_punch_that_is_cut_off_or_sorted_by_points(tmp_path):
    text = save_punch(tmp_path / "a.pch", [run(points=(HUB,))]).read_text()
    lines = text.splitlines(keepends=True)
    (tmp_path / "b.pch").write_text("".join(lines[:8]))
    assert "is damaged: a blank stands where a number must be" in refusal(
        tmp_path / "b.pch", generalized_mass=1
    )
    sorted_by_points = text.replace("$EIGENVALUE =", "$POINT ID =  ")
    (tmp_path / "c.pch").write_text(sorted_by_points)
    assert "ask Nastran for SORT1" in refusal(tmp_path / "c.pch", generalized_mass=1)


@pytest.mark.parametrize("rows_of_a_page", [50, 3, 1])
def test_print_with_pages_that_break_anywhere(tmp_path, rows_of_a_page):
    given = run(points=(OTHER, 8, 9, HUB, 2000, 2001))
    path = save_printed(tmp_path / "a.f06", [given], rows_of_a_page=rows_of_a_page)
    assert_modes(read(path), given, SEVEN_DIGITS)


def test_print_with_two_subcases(tmp_path):
    one, two = run(1), run(2, subcase=3)
    path = save_printed(tmp_path / "a.f06", [one, two])
    assert_modes(read(path, subcase=1), one, SEVEN_DIGITS)
    assert_modes(read(path, subcase=3), two, SEVEN_DIGITS)


def test_print_of_buckling_has_no_cycles(tmp_path):
    assert "has no real eigenvectors" in refusal(save_printed(tmp_path / "a.f06", [run()], cycles=False))


def test_print_with_stars_in_place_of_a_number(tmp_path):
    path = save_printed(tmp_path / "a.f06", [run(points=(HUB,))])
    text = path.read_text().splitlines()
    place = next(number for number, line in enumerate(text) if line.startswith(f"{HUB:14d}"))
    text[place] = text[place][:25] + "  *************" + text[place][40:]
    path.write_text("\n".join(text))
    assert "must be numbers" in refusal(path)


def test_text_that_is_not_in_the_encoding_of_its_mark(tmp_path):
    (tmp_path / "a.pch").write_bytes(b"\xff\xfe" + "$TITLE".encode("utf-16-le") + b"\x00")
    assert "is damaged: it is not text in utf-16" in refusal(tmp_path / "a.pch")
