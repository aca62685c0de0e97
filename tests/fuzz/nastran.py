"""Files of a Nastran run: results in binary and in text, and matrices.

HDF5 files are left out: among 20,000 spoiled ones the HDF5 library (2.0, of h5py 3.16) damaged its own memory, which a
process may not survive and no reader can prevent. Files of a wrong content or cut off are in tests/nastran.
"""

from __future__ import annotations

import functools
import tempfile
from pathlib import Path
from random import Random

import numpy as np

from proprotor.support.nastran import nastran_modes
from tests.fuzz.mutation import other_lines, other_number, several, spoiled_bytes
from tests.nastran import written
from tests.nastran.written import HUB, Op2, Run

_TEXTS = (".pch", ".f06", ".bdf", ".op4")  # endings of files that are spoiled as texts, most of the time
_COORDINATES = [(HUB, component) for component in range(1, 7)] + [(5001, 0), (5002, 0)]


@functools.cache
def seeds() -> dict[str, bytes]:
    """Files as they should be, by name."""
    random = np.random.default_rng(0)
    run = Run(np.array([400.0, 1225.0]), np.array([1.0, 2.0]), random.normal(size=(6, 2)))
    matrix = random.normal(size=(8, 8))
    matrices = {"KAA": 1e6 * (matrix @ matrix.T + np.eye(8)), "MAA": np.diag(random.uniform(100.0, 900.0, 8))}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for width in (4, 8):
            Op2(width=width).lama(run).vectors(run).other_blocks().save(folder / f"words{width}.op2")
        Op2(order=">").lama(run).vectors_by_point(run).complex_vectors(run).save(folder / "points.op2")
        written.save_punch(folder / "a.pch", [run])
        written.save_printed(folder / "a.f06", [run])
        written.save_dmig(folder / "large.bdf", matrices, _COORDINATES)
        written.save_dmig(folder / "small.bdf", matrices, _COORDINATES, small=True)
        for layout in ("dense", "sparse", "bigmat"):
            written.save_op4(folder / f"{layout}.op4", matrices, layout=layout)
            written.save_op4(folder / f"binary-{layout}.op4", matrices, "binary", layout)
        written.save_extrn(folder / "extrn.asm", _COORDINATES)
        return {path.name: path.read_bytes() for path in sorted(folder.iterdir())}


def make(rng: Random) -> tuple[dict[str, bytes], dict]:
    """The files of an input by name, and how they are used."""
    files = seeds()
    name = rng.choice([name for name in files if name != "extrn.asm"])
    given = {name: files[name]}
    options: dict = {}
    if name.endswith(".op4"):
        given["extrn.asm"], options["coordinates"] = files["extrn.asm"], "extrn.asm"
    if rng.random() < 0.3 or name.endswith(".pch"):
        options["generalized_mass"] = rng.choice((1.0, 1.0, [1.0, 2.0], 0.0, float("nan")))
    if rng.random() < 0.3:
        options["modes"] = rng.choice((1, 2, 6, 10**9))
    spoiled = rng.choice(list(given))
    given[spoiled] = _spoiled(rng, spoiled, given[spoiled], list(files.values()))
    return given, {"name": name, "options": options}


def use(folder: Path, name: str, options: dict) -> None:
    support = nastran_modes(folder / name, HUB, includes_rotor=False, **_in(folder, options))
    n = len(support.names)
    for field in ("mass", "damping", "stiffness"):
        matrix = getattr(support, field)
        assert matrix.shape == (n, n), f"{field} has another shape"
        assert np.isfinite(matrix).all(), f"{field} is not finite"
    assert support.hub.shape == (6, n), "the hub has another shape"
    assert np.isfinite(support.hub).all(), "the hub is not finite"


def _in(folder: Path, options: dict) -> dict:
    """The options, with the path of the file of coordinates."""
    if "coordinates" not in options:
        return options
    return options | {"coordinates": folder / options["coordinates"]}


def _spoiled(rng: Random, name: str, content: bytes, others: list[bytes]) -> bytes:
    if name.endswith(_TEXTS) and not name.startswith("binary") and rng.random() < 0.7:
        return several(rng, content.decode("latin-1"), (other_number, other_lines)).encode("utf-8", "replace")
    return spoiled_bytes(rng, content, others)
