"""Binary files of results, with the oddities that programs, versions and parameters bring, each by name."""

from dataclasses import replace

import numpy as np
import pytest

import proprotor as pp
from proprotor.errors import InputError
from proprotor.support.nastran import nastran_modes
from tests.nastran.written import HUB, LABELS, OTHER, Op2, Run, run_of

SINGLE = 1e-6  # words of 4 bytes hold single precision
VECTORS = {"x": "T1", "y": "T2", "z": "T3", "alpha_x": "R1", "alpha_y": "R2", "alpha_z": "R3"}


def run(seed=1, modes=4, **other):
    """Modes of random numbers, with frequencies and generalised masses of their own."""
    random = np.random.default_rng(seed)
    return Run(
        eigenvalue=np.sort(random.uniform(10.0, 100.0, modes)) ** 2,
        mass=random.uniform(0.5, 2.0, modes),
        motion=random.normal(size=(6, modes)),
        **other,
    )


def read(path, **options):
    return nastran_modes(path, **dict(grid=HUB, includes_rotor=False, hub=VECTORS) | options)


def assert_modes(support, given, rtol=SINGLE):
    """The support has the frequencies, masses and motion of the run."""
    np.testing.assert_allclose(np.diag(support.mass), given.mass, rtol=rtol)
    np.testing.assert_allclose(np.diag(support.stiffness), given.mass * given.eigenvalue, rtol=3 * rtol)
    np.testing.assert_allclose(support.hub, given.motion, rtol=rtol, atol=rtol)


def refusal(path, **options):
    """The one line with which a file is refused."""
    with pytest.raises(InputError) as caught:
        read(path, **options)
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("post", [-1, -2])
@pytest.mark.parametrize("program", LABELS)
def test_the_label_of_a_version_is_no_damage(tmp_path, program, post):
    given = run()
    file = Op2(label=tuple(LABELS[program]), post=post).lama(given).vectors(given)
    assert_modes(read(file.save(tmp_path / "a.op2")), given)


@pytest.mark.parametrize("order", "<>")
@pytest.mark.parametrize("width", [4, 8])
def test_words_of_four_and_of_eight_bytes_in_either_order(tmp_path, width, order):
    given = run()
    file = Op2(order=order, width=width).other_blocks().lama(given).vectors(given).other_blocks()
    assert_modes(read(file.save(tmp_path / "a.op2")), given, SINGLE if width == 4 else 1e-14)


@pytest.mark.parametrize(
    ("name", "version"),
    [("OUGV1", ""), ("OUG1", "20140   0   ....OUG1    "), ("OPHIG", ""), ("BOUGV1", ""), ("BOPHIG", "")],
)
def test_names_of_the_table_with_or_without_a_version_behind(tmp_path, name, version):
    """MSC's tables since 2014 may have a version behind the name; POST -4 writes OPHIG, basic axes BOUGV1."""
    given = run()
    file = Op2().lama(given).vectors(given, name, version=version)
    assert_modes(read(file.save(tmp_path / "a.op2")), given)


def test_eigenvectors_may_come_before_their_eigenvalues_and_in_pieces(tmp_path):
    given = run()
    assert_modes(read(Op2().vectors(given, split=3).lama(given).save(tmp_path / "a.op2")), given)


def test_a_file_may_end_without_its_last_zero(tmp_path):
    given = run()
    path = Op2().lama(given).vectors(given).save(tmp_path / "a.op2")
    path.write_bytes(path.read_bytes()[:-12])
    assert_modes(read(path), given)


def test_output_axes_go_before_basic_axes(tmp_path):
    """A file with both tables has the motion of one mode in two coordinate systems."""
    given, basic = run(), run()
    basic.motion = -basic.motion
    for order in ([basic, given], [given, basic]):
        file = Op2().lama(given)
        for one in order:
            file.vectors(one, "BOUGV1" if one is basic else "OUGV1")
        assert_modes(read(file.save(tmp_path / "a.op2")), given)


def test_without_lama_masses_must_be_told_and_frequencies_come_with_the_vectors(tmp_path):
    given = run()
    path = Op2().vectors(given).save(tmp_path / "a.op2")
    message = refusal(path)
    assert "has no eigenvalue table (LAMA)" in message
    assert "generalized_mass = 1" in message and "PARAM,POSTEXT,YES" in message
    assert_modes(read(path, generalized_mass=given.mass), given)
    given.mass = np.ones(4)
    assert_modes(read(path, generalized_mass=1.0), given)
    assert refusal(path, generalized_mass=0.0).startswith("generalized_mass = 0.0: must be above zero")
    full = Op2().lama(given).vectors(given).save(tmp_path / "b.op2")
    assert refusal(full, generalized_mass=1.0).startswith("generalized_mass = 1.0: must not be given")


def test_complex_vectors_alone_are_refused_and_real_ones_beside_them_kept(tmp_path):
    given = run()
    alone = Op2().lama(given, name="CLAMA", approach=9).complex_vectors(given).save(tmp_path / "a.op2")
    assert refusal(alone).endswith("has complex eigenvectors alone: ask Nastran for real ones (SOL 103)")
    for order in (0, 1):
        file = Op2().lama(given)
        for part in ([file.vectors, file.complex_vectors], [file.complex_vectors, file.vectors])[order]:
            part(given)
        assert_modes(read(file.save(tmp_path / "b.op2")), given)


def test_a_table_by_the_name_of_another_is_read_by_its_codes(tmp_path):
    """Complex vectors in a table that is called LAMA, as a public writer leaves them."""
    given = run()
    path = Op2().complex_vectors(given, name="LAMA").lama(given).vectors(given).save(tmp_path / "a.op2")
    assert_modes(read(path), given)


def test_two_subcases_have_their_own_modes_and_tables(tmp_path):
    one, two = run(1), run(2, subcase=20)
    path = Op2().lama(one).lama(two).vectors(one).vectors(two).save(tmp_path / "a.op2")
    assert refusal(path) == "subcase: must be given: the file has 1, 20"
    assert refusal(path, subcase=3) == "subcase = 3: is not in the file, which has 1, 20"
    assert_modes(read(path, subcase=1), one)
    assert_modes(read(path, subcase=20), two)


def test_superelements_of_one_subcase_do_not_overwrite_one_another(tmp_path):
    """Each has its own grid points and numbers its modes from 1; the one with the hub is taken."""
    inner, outer = run(1, label="SUPERELEMENT 1", points=(OTHER, 8)), run(2, label="SUPERELEMENT 0")
    for order in ([inner, outer], [outer, inner]):
        file = Op2()
        for one in order:
            file.lama(one).vectors(one)
        assert_modes(read(file.save(tmp_path / "a.op2")), outer)


def test_two_different_sets_at_the_hub_are_refused_and_equal_ones_are_one(tmp_path):
    one, other = run(1), run(2)
    path = Op2().lama(one).lama(other).vectors(one).vectors(other).save(tmp_path / "a.op2")
    assert refusal(path).startswith("subcase = 1: has 2 sets of eigenvectors of the grid point that differ")
    twice = Op2().lama(one).vectors(one).vectors(one).save(tmp_path / "b.op2")
    assert_modes(read(twice), one)


def test_vectors_by_grid_point_take_their_frequencies_from_lama(tmp_path):
    given = run()
    assert_modes(read(Op2().lama(given).vectors_by_point(given).save(tmp_path / "a.op2")), given)
    bare = Op2().vectors_by_point(given).save(tmp_path / "b.op2")
    assert "ask Nastran for SORT1" in refusal(bare, generalized_mass=1.0)


def test_buckling_is_no_vibration(tmp_path):
    given = run()
    path = Op2().lama(given, name="BLAMA", approach=8).vectors(given, approach=8).save(tmp_path / "a.op2")
    assert "has no real eigenvectors" in refusal(path)


def test_modes_keep_the_numbers_of_the_run(tmp_path):
    given = run(first=7)
    support = read(Op2().lama(given).vectors(given).save(tmp_path / "a.op2"), modes=2)
    assert support.names == ("mode_7", "mode_8")


def test_rigid_motions_have_no_frequency_and_unstable_ones_are_refused(tmp_path):
    given = run()
    given.eigenvalue[0] = -1e-6
    path = Op2().lama(given).vectors(given).save(tmp_path / "a.op2")
    assert np.diag(read(path).stiffness)[0] == 0.0
    given.eigenvalue[0] = -100.0
    path = Op2().lama(given).vectors(given).save(tmp_path / "a.op2")
    assert "must have modes of a stable structure: eigenvalue 1 is -100" in refusal(path)


def test_a_file_that_is_cut_off_anywhere_is_refused_by_the_name_of_the_table(tmp_path):
    given = run()
    content = Op2().lama(given).vectors(given).bytes()
    path = tmp_path / "a.op2"
    seen = set()
    for length in range(0, len(content) - 12, 24):
        path.write_bytes(content[:length])
        seen.add(refusal(path).split(": ", 1)[1])
    assert {text for text in seen if "ends early" in text} == {
        f"ends early{where}: the run or a copy of the file was cut off"
        for where in ("", " in the table LAMA", " in the table OUGV1")
    }


def test_a_byte_that_was_lost_is_damage(tmp_path):
    """As by a copy that turned line ends."""
    given = run()
    content = Op2().lama(given).vectors(given).bytes()
    path = tmp_path / "a.op2"
    path.write_bytes(content[:900] + content[901:])
    assert "is damaged" in refusal(path) or "ends early" in refusal(path)


def test_lengths_around_a_record_that_differ_are_damage(tmp_path):
    given = run()
    content = bytearray(Op2().lama(given).vectors(given).bytes())
    after = content.index(b"OUGV1   ") + 8
    content[after] += 4
    path = tmp_path / "a.op2"
    path.write_bytes(content)
    assert refusal(path).endswith("is damaged in the table LAMA: the lengths around a record differ")


@pytest.mark.parametrize("content", [b"", b"GRID,1,,0.,0.,0.\n", b"\0" * 400, bytes(range(256)) * 9])
def test_another_file_is_refused(tmp_path, content):
    path = tmp_path / "a.op2"
    path.write_bytes(content)
    assert "has no modes: it is no .op2, .h5, .pch, .op4 or .f06 file" in refusal(path)


def test_what_is_missing_is_named(tmp_path):
    given = run()
    path = Op2().lama(given).vectors(given).save(tmp_path / "a.op2")
    assert refusal(path, grid=5).startswith("grid = 5: has no eigenvectors in the file")
    assert refusal(tmp_path / "none.op2").endswith("no such file")
    assert "has no real eigenvectors" in refusal(Op2().lama(given).save(tmp_path / "b.op2"))
    assert refusal(path, coordinates="a.pch").startswith("coordinates = a.pch: must be given with an .op4")


@pytest.mark.parametrize("width", [4, 8])
@pytest.mark.parametrize("wide", [False, True])
@pytest.mark.parametrize("name", ["GEOM1", "GEOM1S"])
def test_an_output_system_of_the_grid_point_is_doubted_unless_axes_are_named(tmp_path, name, wide, width):
    """A motion in local axes looks like any other motion."""
    given = run()
    systems = {OTHER: 3, HUB: 5, 2000: 0}
    file = Op2(width=width).points(systems, name, wide).lama(given).vectors(given)
    path = file.save(tmp_path / "a.op2")
    assert "grid point 1101 has the output coordinate system 5" in str(read(path, hub=None).warning)
    assert read(path).warning is None  # axes are named
    basic = (
        Op2(width=width)
        .points(systems, name, wide)
        .lama(given)
        .vectors(given, "BOUGV1")
        .save(tmp_path / "b.op2")
    )
    assert read(basic, hub=None).warning is None
    none = (
        Op2(width=width)
        .points(systems | {HUB: 0}, name, wide)
        .lama(given)
        .vectors(given)
        .save(tmp_path / "c.op2")
    )
    assert read(none, hub=None).warning is None


def test_the_doubt_of_axes_stands_at_every_result(tmp_path):
    case = pp.load_case("xv15-uncoupled")
    support = case.support
    given = run_of(support.mass, support.stiffness, support.hub)
    path = Op2(width=8).points({HUB: 5}).lama(given).vectors(given).save(tmp_path / "a.op2")
    read_in = read(path, hub=None, includes_rotor=support.includes_rotor)
    found = replace(case, support=read_in).sweep([100.0, 150.0])
    assert all("output coordinate system 5" in str(text) for text in found.warning.values.ravel())
