"""Matrices of a reduced structure, as DMIG and as files of OUTPUT4, against the same structure given as arrays."""

import numpy as np
import pytest
from scipy.linalg import eigh

from proprotor.nastran.dmig import read_dmig, write_dmig
from proprotor.nastran.found import FileFault
from proprotor.nastran.op4 import read_op4
from proprotor.nastran.reduced import reduced_from_dmig
from proprotor.nastran.text_files import lines_of
from proprotor.support.beam_wing import beam_structure
from proprotor.support.matrix_files import support_from_matrices
from tests.nastran.test_op2 import read, refusal
from tests.nastran.written import HUB, save_dmig, save_extrn, save_op4
from tests.support.test_beam_wing import xv15_wing

INCH, SLINCH = 0.0254, 4.4482216152605 / 0.0254
TEN_DIGITS = 5e-10  # half a unit of the last of ten digits, in fields of 16 characters
DOUBLE = 1e-13
AXES = {"x": "T3", "y": "T2", "z": "-T1", "alpha_x": "R3", "alpha_y": "R2", "alpha_z": "-R1"}
# Component of each motion of the hub x, y, z, αx, αy, αz in these axes, with its sign.
COMPONENTS, SIGNS = [3, 2, 1, 6, 5, 4], [1.0, 1.0, -1.0, 1.0, 1.0, -1.0]


@pytest.fixture(scope="module")
def structure():
    """The XV-15's wing: the hub's six motions are coordinates, the rest scalar points."""
    wing, pylon, _ = xv15_wing()
    return beam_structure(wing, pylon)


@pytest.fixture(scope="module")
def in_the_run(structure):
    """Matrices in inches and lbf s²/in, on the hub's grid point and scalar points, and the coordinates' points."""
    at_hub = structure.hub.any(axis=0)
    unit = np.ones(len(structure.names))
    unit[at_hub] = np.array(SIGNS) * np.where(np.arange(6) < 3, INCH, 1.0)
    scale = np.outer(unit, unit) / (SLINCH * INCH**2)
    points = iter(range(5001, 9000))
    component = iter(COMPONENTS)
    coordinates = [(HUB, next(component)) if hub else (next(points), 0) for hub in at_hub]
    return {"KAAX": structure.stiffness * scale, "MAAX": structure.mass * scale}, coordinates


def supports(structure, path, **options):
    """The support from the file, and the support of the structure in SI."""
    units = dict(length_unit=INCH, mass_unit=SLINCH)
    found = read(path, hub=AXES, **units | options)
    modes = options.get("modes")
    return found, support_from_matrices(
        structure.mass, structure.stiffness, dofs=structure.names, modes=modes
    )


def assert_same(found, expected, rtol):
    """The lowest modes of two supports are the same, whatever the order of their coordinates."""
    for field in ("mass", "stiffness"):
        ours, theirs = np.diag(getattr(found, field)), np.diag(getattr(expected, field))
        np.testing.assert_allclose(ours, theirs, rtol=rtol)
    np.testing.assert_allclose(np.abs(found.hub), np.abs(expected.hub), rtol=100 * rtol, atol=100 * rtol)


@pytest.mark.parametrize("form", [6, 1])
@pytest.mark.parametrize("small", [False, True])
def test_dmig(structure, in_the_run, tmp_path, form, small):
    """Fields of 16 characters and between commas, the lower triangle or all entries."""
    path = save_dmig(tmp_path / "a.pch", *in_the_run, form=form, small=small)
    found, expected = supports(structure, path, modes=6)
    change = np.diag(found.stiffness) / np.diag(expected.stiffness) - 1
    assert (np.abs(change) < rounding(structure, 6)).all()
    np.testing.assert_allclose(np.abs(found.hub), np.abs(expected.hub), rtol=1e-6, atol=1e-6)


def rounding(structure, count):
    """By how much ω² of the lowest modes can change if every entry of both matrices loses its last digits."""
    square, shapes = eigh(structure.stiffness, structure.mass)
    square, shapes = square[:count], np.abs(shapes[:, :count])
    parts = (structure.stiffness, structure.mass)
    weights = [np.einsum("ik,ij,jk->k", shapes, np.abs(part), shapes) for part in parts]
    return TEN_DIGITS * (weights[0] / square + weights[1])


def test_coordinates_keep_the_names_of_points_and_components(in_the_run, tmp_path):
    support = read(save_dmig(tmp_path / "a.pch", *in_the_run), hub=AXES)
    assert f"{HUB}.T1" in support.names and "5001" in support.names
    (place,) = np.flatnonzero(support.hub[2])
    assert support.names[place] == f"{HUB}.T1" and support.hub[2, place] == -1.0


@pytest.mark.parametrize("order", "<>")
@pytest.mark.parametrize("width", [4, 8])
@pytest.mark.parametrize("layout", ["dense", "sparse", "bigmat"])
def test_binary_output4(structure, in_the_run, tmp_path, layout, width, order):
    matrices, coordinates = in_the_run
    named = {"KAA": matrices["KAAX"], "MAA": matrices["MAAX"]}
    path = save_op4(tmp_path / "a.op4", named, "binary", layout, order, width)
    beside = save_extrn(tmp_path / "a.pch", coordinates)
    assert_same(*supports(structure, path, modes=6, coordinates=beside), DOUBLE * 1e3)
    for name, matrix in read_op4(path).items():
        np.testing.assert_array_equal(matrix, named[name])


@pytest.mark.parametrize("layout", ["dense", "sparse", "bigmat"])
def test_output4_as_text(structure, in_the_run, tmp_path, layout):
    matrices, coordinates = in_the_run
    named = {"KAA": matrices["KAAX"], "MAA": matrices["MAAX"]}
    path = save_op4(tmp_path / "a.op4", named, layout=layout)
    for name, matrix in read_op4(path).items():
        np.testing.assert_allclose(matrix, named[name], rtol=1e-15, atol=0)
    beside = save_extrn(tmp_path / "a.asm", coordinates)
    assert_same(*supports(structure, path, modes=6, coordinates=beside), DOUBLE * 1e3)


@pytest.mark.parametrize("form", ["text", "binary"])
def test_complex_and_other_matrices_beside_do_no_harm(in_the_run, tmp_path, form):
    matrices, _ = in_the_run
    others = {"QHH": np.array([[1 + 2j, 0.5j], [3.0, 4.0]]), "KAA": matrices["KAAX"], "PA": np.ones((4, 1))}
    found = read_op4(save_op4(tmp_path / "a.op4", others, form))
    assert list(found) == ["KAA", "PA"]
    np.testing.assert_allclose(found["KAA"], matrices["KAAX"], rtol=1e-15)


def test_structural_damping_of_the_elements_is_left_out_and_said_so(in_the_run, tmp_path):
    matrices, coordinates = in_the_run
    path = save_dmig(tmp_path / "a.pch", matrices | {"K4AAX": 0.02 * matrices["KAAX"]}, coordinates)
    support = read(path, hub=AXES, modes=6)
    assert "structural damping of the elements (K4AAX) is left out" in str(support.warning)
    none = save_dmig(tmp_path / "b.pch", matrices | {"K4AAX": 0 * matrices["KAAX"]}, coordinates)
    assert read(none, hub=AXES, modes=6).warning is None


@pytest.mark.parametrize(
    "entry", [f"GRID,{HUB},,1.,2.,3.,5", f"GRID   *{HUB:16d}{'':16}1.              2.\n*       3.{5:30d}"]
)
def test_the_output_system_of_the_grid_point_is_in_the_bulk_data(in_the_run, tmp_path, entry):
    path = save_dmig(tmp_path / "a.pch", *in_the_run, before=entry)
    assert "grid point 1101 has the output coordinate system 5" in str(read(path, hub=None, modes=6).warning)
    assert read(path, hub=AXES, modes=6).warning is None


def test_viscous_damping_is_read(in_the_run, tmp_path):
    matrices, coordinates = in_the_run
    path = save_dmig(tmp_path / "a.pch", matrices | {"BAAX": 0.02 * matrices["MAAX"]}, coordinates)
    support = read(path, hub=AXES, modes=6)
    np.testing.assert_allclose(np.diag(support.damping), 0.02 * np.diag(support.mass), rtol=1e-6)


def test_matrices_that_are_no_structure(in_the_run, tmp_path):
    matrices, coordinates = in_the_run
    path = save_dmig(tmp_path / "a.pch", {"KAAX": matrices["KAAX"]}, coordinates)
    assert "must have a mass MAA or MAAX and a stiffness KAA or KAAX: it has KAAX" in refusal(path)
    path = save_dmig(tmp_path / "b.pch", matrices | {"M2GG": matrices["MAAX"]}, coordinates)
    assert read(path, hub=AXES, modes=2).names == ("mode_1", "mode_2")
    whole = {"KGG": matrices["KAAX"], "K4GG": matrices["KAAX"], "MGG": matrices["MAAX"]}
    assert read(save_dmig(tmp_path / "e.pch", whole, coordinates), hub=AXES, modes=2).names == (
        "mode_1",
        "mode_2",
    )
    several = {"K1": matrices["KAAX"], "K2": matrices["KAAX"], "M1": matrices["MAAX"]}
    path = save_dmig(tmp_path / "c.pch", several, coordinates)
    assert "has several matrices that could be its stiffness: K1, K2" in refusal(path)
    path = save_dmig(tmp_path / "d.pch", matrices, [(point + 1, part) for point, part in coordinates])
    assert refusal(path).startswith(f"grid = {HUB}: has no coordinate {HUB}.T1 in the matrices")


def test_what_does_not_go_with_matrices(in_the_run, tmp_path):
    matrices, coordinates = in_the_run
    path = save_dmig(tmp_path / "a.pch", matrices, coordinates)
    assert refusal(path, subcase=1).startswith("subcase = 1: must not be given with matrices")
    assert refusal(path, generalized_mass=1.0).startswith("generalized_mass = 1.0: must not be given")
    assert refusal(path, carries="two rotors").startswith("carries = two rotors: must be one rotor")
    assert refusal(path, coordinates=path).endswith("must be given with an .op4 file only")
    op4 = save_op4(tmp_path / "a.op4", {"KAA": matrices["KAAX"], "MAA": matrices["MAAX"]})
    assert refusal(op4).startswith("coordinates: is missing: an .op4 file needs the file of bulk data")
    assert refusal(op4, coordinates=tmp_path / "none").endswith("no such file")
    assert "has no entry EXTRN" in refusal(op4, coordinates=path)
    less = save_extrn(tmp_path / "less.pch", coordinates[:-1])
    assert "must have a mass MAA" in refusal(op4, coordinates=less)


@pytest.mark.parametrize("form", ["text", "binary"])
def test_output4_that_is_cut_off(in_the_run, tmp_path, form):
    path = save_op4(tmp_path / "a.op4", {"KAA": in_the_run[0]["KAAX"]}, form)
    content = path.read_bytes()
    for share in (0.1, 0.5, 0.9):
        path.write_bytes(content[: int(share * len(content))])
        with pytest.raises(FileFault, match=r"ends early|is damaged"):
            read_op4(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("DMIG*   KAAX                           1               1\n", "the matrix KAAX has no heading"),
        ("DMIG    KAAX           0       6       2       0\nDMIG    KAAX    one\n", "cannot be read"),
        ("DMIG    KAAX           0       6       2       0\nDMIG,KAAX,1,1,,1,1,x\n", "cannot be read"),
        ("DMIG    KAAX           0\n", "cannot be read"),
    ],
)
def test_entries_that_are_damaged(text, message):
    with pytest.raises(FileFault, match=message):
        read_dmig(text.splitlines())


def test_complex_and_rectangular_entries_are_passed_over(tmp_path):
    text = "DMIG,QHH,0,1,3,0\nDMIG,QHH,1,1,,1,1,1.0,2.0\nDMIG,P,0,9,1,0,,,1\nDMIG,P,1,,,1,1,1.0\n"
    text += "DMIG,M1,0,6,1,0\nDMIG,M1,1,1,,1,1,2.5-1\n+,2,,1.D1\nDMIG,K1,0,6,1,0\nDMIG,K1,2,,,2,,3.0\n"
    (tmp_path / "a.bdf").write_text(text)
    found = reduced_from_dmig(tmp_path / "a.bdf")
    assert found.names == ("1.T1", "2")
    np.testing.assert_array_equal(found.mass, [[0.25, 10.0], [10.0, 0.0]])
    np.testing.assert_array_equal(found.stiffness, [[0.0, 0.0], [0.0, 3.0]])


@pytest.mark.parametrize(
    ("value", "field"),
    [
        (1 / 3, ".3333333333333D0"),
        (-1 / 3, "-.333333333333D0"),
        (-2e5 / 3, "-6.66666666667D4"),
        (1e-10 / 3, ".33333333333D-10"),
        (-2e-101 / 3, "-.666666667D-101"),
        (1.0, "1.000000000000D0"),
        (1 - 1e-16, "1.000000000000D0"),
        (-1e12 / 3, "-3.3333333333D11"),
    ],
)
def test_a_field_has_as_many_digits_as_it_has_room_for(value, field):
    *_, line = write_dmig("M", np.array([[value]]), [(1, 0)])
    assert line == f"*{1:23d}{0:16d}{field}"


def test_fields_of_eight_characters_hold_two_terms_a_line(tmp_path):
    text = "DMIG    M1             0       6       1       0\n"
    text += "DMIG    M1             1       1               1       1     2.5        \n"
    text += "               2       0     1.5               3       0     0.5        \n"
    path = tmp_path / "a.bdf"
    path.write_text(text)
    assert read_dmig(lines_of(path)).matrices["M1"][0].tolist() == [2.5, 1.5, 0.5]
