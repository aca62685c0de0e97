"""Matrix Market files of every kind read as SciPy writes them, and files that are not what they say are refused."""

import numpy as np
import pytest
from scipy.io import mmwrite
from scipy.sparse import coo_array

from proprotor.support.matrix_market import MatrixMarketError, read_matrix

RNG = np.random.default_rng(0)
FULL = RNG.uniform(-1, 1, (5, 5)) * 10.0 ** RNG.integers(-9, 9, (5, 5))
MATRICES = {
    "general": FULL,
    "symmetric": FULL + FULL.T,
    "skew-symmetric": FULL - FULL.T,
    "whole": np.arange(25).reshape(5, 5),
    "oblong": FULL[:3],
    "zero": np.zeros((3, 3)),
}


@pytest.mark.parametrize("sparse", [False, True])
@pytest.mark.parametrize("kind", MATRICES)
def test_a_matrix_is_read_as_it_was_written(tmp_path, kind, sparse):
    matrix = MATRICES[kind]
    mmwrite(
        tmp_path / "m.mtx",
        coo_array(matrix) if sparse else matrix,
        comment="a comment\nof two lines",
        precision=17,
    )
    found = read_matrix(tmp_path / "m.mtx")
    assert hasattr(found, "tocsc") == sparse
    np.testing.assert_array_equal(found.toarray() if sparse else found, matrix)


@pytest.mark.parametrize("symmetry", ["symmetric", "skew-symmetric"])
@pytest.mark.parametrize("given", ["1 1 0\n2 1 3\n3 2 4\n", "1 2 -3\n2 3 -4\n"])
def test_either_triangle_may_be_given(tmp_path, symmetry, given):
    if symmetry == "skew-symmetric":
        given = given.replace("1 1 0\n", "")
    elif "1 2 -3" in given:
        given = given.replace("-", "")
    text = f"%%MatrixMarket matrix coordinate real {symmetry}\n%\n\n3 3 {given.count(chr(10))}\n{given}"
    (tmp_path / "m.mtx").write_text(text)
    sign = -1 if symmetry == "skew-symmetric" else 1
    expected = np.array([[0, sign * 3, 0], [3, 0, sign * 4], [0, 4, 0]])
    np.testing.assert_array_equal(read_matrix(tmp_path / "m.mtx").toarray(), expected)


def test_entries_given_twice_add_up_and_digits_do_no_harm(tmp_path):
    text = "%%matrixmarket MATRIX coordinate real general\n2 2 2\n1 1 0.1234567890123456789012345e0\n1 1 1\n"
    (tmp_path / "m.mtx").write_text(text)
    assert read_matrix(tmp_path / "m.mtx").toarray().tolist() == [[1.1234567890123457, 0], [0, 0]]


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_exponents_of_fortran_tabs_and_comments_between_entries(tmp_path, end):
    lines = [
        "%%MatrixMarket matrix coordinate real general",
        "% made up",
        "2\t2\t2",
        "",
        "1\t1\t1.5D+01",
        "% d",
        " 2 2 -2.d-1 ",
    ]
    (tmp_path / "m.mtx").write_bytes(end.join(lines).encode())
    assert read_matrix(tmp_path / "m.mtx").toarray().tolist() == [[15.0, 0], [0, -0.2]]


HEAD = "%%MatrixMarket matrix "
WRONG = {
    "array real symmetric\n3 5\n" + "1\n" * 15: "cannot be symmetric with 3 x 5",
    "array real symmetric\n3 3\n" + "1\n" * 5: "must have 6 lines of 1 numbers after its sizes, not 5 of 1",
    "array real general\n3 3\n" + "1\n" * 10: "must have 9 lines of 1 numbers after its sizes, not 10 of 1",
    "array real general\n2 2\n1 2\n3 4\n": "must have 4 lines of 1 numbers after its sizes, not 2 of 2",
    "array real general\n2 2\n1\n2\nx\n4\n": "a line that is not its entries' numbers",
    "array real general\n2 2\n1\n2\n1_0\n4\n": "a line that is not its entries' numbers",
    "array real general\n6000 6000\n": "is too large: 6000 x 6000",
    "coordinate real general\n3 3 1\n0 1 1\n": "an entry outside 3 x 3",
    "coordinate real general\n3 3 1\n1 4 1\n": "an entry outside 3 x 3",
    "coordinate real general\n3 3 1\n1 1.5 1\n": "an entry outside 3 x 3",
    "coordinate real general\n3 3 1\n1 nan 1\n": "an entry outside 3 x 3",
    "coordinate real general\n3 3 1\n1 1e300 1\n": "an entry outside 3 x 3",
    "coordinate real general\n3 3\n1 1 1\n": "must have 3 whole numbers after its heading",
    "coordinate real general\n": "must have 3 whole numbers after its heading",
    "coordinate real general\n3 3 99999999999999999999\n": "must have 3 whole numbers after its heading",
    "coordinate real symmetric\n3 3 2\n1 2 1\n2 1 1\n": "entries on both sides",
    "coordinate real skew-symmetric\n3 3 1\n1 1 1\n": "entries on the diagonal",
    "coordinate complex general\n1 1 1\n1 1 1 0\n": "must hold real numbers, not complex",
    "coordinate pattern general\n1 1 1\n1 1\n": "must hold real numbers, not pattern",
    "vector real general\n1 1 1\n1 1 1\n": "its heading has unknown words",
    "array real\n1 1\n1\n": "it has no heading",
}


@pytest.mark.parametrize("text", WRONG)
def test_a_file_that_is_not_what_it_says_is_refused(tmp_path, text):
    (tmp_path / "m.mtx").write_text(HEAD + text)
    with pytest.raises(MatrixMarketError) as caught:
        read_matrix(tmp_path / "m.mtx")
    assert WRONG[text] in str(caught.value)
    assert "\n" not in str(caught.value)
