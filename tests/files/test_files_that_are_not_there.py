"""Every reader says in one line that there is no file, or that its path cannot be followed, under every Python.

From Python 3.14 on, `pathlib.Path.is_file` takes a path that cannot be followed for one without a file.
"""

import pytest

import proprotor as pp
from proprotor.errors import InputError
from proprotor.support.matrix_files import read_matrix_market
from proprotor.support.nastran import nastran_modes

READERS = {
    "results": (".nc", pp.load_results),
    "matrix": (".mtx", lambda path: read_matrix_market(path, path, dofs=["chord"])),
    "modes": (".op2", lambda path: nastran_modes(path, grid=1, includes_rotor=False)),
}


@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize(
    ("name", "rule"), [("none", "no such file"), ("a" * 300, r"cannot be read \(.*too long\)")]
)
def test_one_line_says_why(tmp_path, reader, name, rule):
    ending, read = READERS[reader]
    with pytest.raises(InputError, match=rule):
        read(tmp_path / f"{name}{ending}")
