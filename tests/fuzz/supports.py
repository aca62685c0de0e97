"""Supports from files: .npz archives and Matrix Market files with their list of names."""

from __future__ import annotations

import functools
import io
import pickle
import zipfile
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
from scipy.io import mmwrite
from scipy.sparse import coo_array

from proprotor.support.matrix_files import read_matrix_market, read_npz
from proprotor.support.normal_modes import CARRIES, HUB_AXES, INCLUDES_ROTOR, SHAFT
from tests.fuzz.mutation import NUMBERS, other_lines, other_number, several, spoiled_bytes

_HUB = [f"hub_{axis}" for axis in HUB_AXES]
_VALUES = (0.0, -1.0, 1e-300, 1e300, np.nan, np.inf, 1e16, 1e-16, 1e6)


@functools.cache
def seeds(n: int, sparse: bool) -> dict[str, Any]:
    """A structure of n coordinates, six of them the hub's."""
    rng = np.random.default_rng(n)
    factor = rng.uniform(-1, 1, (n, n)) * (rng.random((n, n)) < (0.2 if sparse else 1.0))
    mass = np.diag(rng.uniform(100, 2000, n)) + 10 * (factor + factor.T)
    stiffness = 1e6 * (factor @ factor.T + np.eye(n))
    names = np.array(_HUB + [f"node_{k}" for k in range(n - 6)])
    return {"mass": mass, "stiffness": stiffness, "damping": 1e-3 * stiffness, "dofs": names}


def make(rng: Random) -> tuple[dict[str, bytes], dict]:
    """The files of an input by name, and how they are used."""
    arrays = dict(seeds(rng.choice((6, 7, 12)), rng.random() < 0.5))
    options = _options(rng) if rng.random() < 0.4 else {}
    if rng.random() < 0.5:
        if rng.random() < 0.3:  # modal coordinates
            arrays["hub"], options["carries"] = np.eye(6, len(arrays["dofs"])), rng.choice(CARRIES)
        return {"support.npz": _npz(rng, arrays)}, {"kind": "npz", "options": options}
    return _market(rng, arrays), {"kind": "mtx", "options": options}


def use(folder: Path, kind: str, options: dict) -> None:
    if kind == "npz":
        support = read_npz(folder / "support.npz", **options)
    else:
        files = {path.stem: path for path in folder.iterdir()}
        support = read_matrix_market(
            folder / "mass.mtx",
            folder / "stiffness.mtx",
            files.get("damping"),
            dofs=folder / "dofs.txt",
            **options,
        )
    n = len(support.names)
    for name in ("mass", "damping", "stiffness"):
        matrix = getattr(support, name)
        assert matrix.shape == (n, n), f"{name} has another shape"
        assert np.isfinite(matrix).all(), f"{name} is not finite"
    assert support.hub.shape == (6, n), "the hub has another shape"
    assert np.isfinite(support.hub).all(), "the hub is not finite"


def _options(rng: Random) -> dict[str, Any]:
    """Some options, good or bad."""
    choices = {
        "modes": (1, 2, 6, 7, 100, 10**9),
        "damping_ratio": (0.01, [0.01, 0.02], 0.999, 1.0, -1.0, float("nan"), []),
        "includes_rotor": (*INCLUDES_ROTOR, "loose", 1),
        "shaft": (*SHAFT, "loose", None),
        "carries": (*CARRIES, "three rotors", None),
        "rotor_mass": (0.0, 100.0, 1e300, -1.0, float("nan"), float("inf")),
        "length_unit": (0.0254, 1e-300, 1e300, 0.0, -1.0, float("inf")),
        "mass_unit": (175.0, 1e-300, 1e300, 0.0, float("nan")),
        "hub": (
            dict(zip(HUB_AXES, _HUB, strict=True)),
            {axis: f"-hub_{axis}" for axis in HUB_AXES},
            {axis: "hub_x" for axis in HUB_AXES},
            {"x": "hub_x"},
            {"w": "hub_x"},
            {},
        ),
    }
    names = rng.sample(list(choices), rng.randint(1, 3))
    return {name: rng.choice(choices[name]) for name in names}


def good_archive(n: int) -> bytes:
    """An .npz file as it should be."""
    return _archive({f"{name}.npy": _npy(array) for name, array in seeds(n, False).items()})


def good_market(n: int) -> dict[str, bytes]:
    """Matrix Market files and the list of names as they should be."""
    arrays = seeds(n, False)
    files = {f"{name}.mtx": _mtx(Random(0), arrays[name]) for name in ("mass", "stiffness", "damping")}
    return files | {"dofs.txt": "\n".join(arrays["dofs"]).encode()}


# Archives -----------------------------------------------------------------------------------------


class _Call:
    """What a pickle would call; the file that would appear tells that it was."""

    def __reduce__(self) -> tuple:
        return (open, ("executed", "w"))


_HEADS = (
    "{'descr': '|O', 'fortran_order': False, 'shape': (1,), }",
    "{'descr': '<f8', 'fortran_order': False, 'shape': (1000000, 1000000), }",
    "{'descr': '<f8', 'fortran_order': False, 'shape': (-1, 6), }",
    "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999, 6), }",
    "{'descr': '<f8', 'fortran_order': False, 'shape': (), }",
    "{'descr': [('a', '<f8'), ('b', '|O')], 'fortran_order': False, 'shape': (6, 6), }",
    "{'descr': '<U1000000000', 'fortran_order': False, 'shape': (6,), }",
    "{'descr': '<f8', 'fortran_order': 1, 'shape': (6, 6), }",
    "{'descr': 'x', 'fortran_order': False, 'shape': (6, 6), }",
    "{'descr': ('<f8', (6,)), 'fortran_order': False, 'shape': (6, ), }",
    "open('executed', 'w')",
    "{" * 2000,
    "9" * 5000,
)


def _npz(rng: Random, arrays: dict[str, Any]) -> bytes:
    for _ in range(rng.choice((0, 1, 1, 2))):
        _spoil_array(rng, arrays)
    content = {f"{name}.npy": _npy(array) for name, array in arrays.items()}
    match rng.randrange(6):
        case 0:
            content[rng.choice(list(content))] = _npy_with_head(rng)
        case 1:
            name = rng.choice(list(content))
            content[name] = spoiled_bytes(rng, content[name])
        case 2:
            content[
                rng.choice(
                    ("../executed.npy", "mass", "/tmp/executed.npy", "notes.txt", "damping.npy", "mass.npy\n")
                )
            ] = rng.randbytes(40)
        case _:
            pass
    whole = _archive(content, rng.choice((zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)))
    return spoiled_bytes(rng, whole) if rng.random() < 0.25 else whole


def _archive(content: dict[str, bytes], compression: int = zipfile.ZIP_STORED) -> bytes:
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", compression) as file:
        for name, data in content.items():
            entry = zipfile.ZipInfo(name)  # without the time of day
            entry.compress_type = compression
            file.writestr(entry, data)
    return archive.getvalue()


def _npy(array: np.ndarray) -> bytes:
    file = io.BytesIO()
    np.lib.format.write_array(file, array, allow_pickle=True)
    return file.getvalue()


def _npy_with_head(rng: Random) -> bytes:
    head = rng.choice(_HEADS).encode()
    body = pickle.dumps(_Call()) if rng.random() < 0.5 else bytes(8 * 36)
    version = rng.choice((b"\1\0", b"\2\0", b"\3\0", b"\7\0"))
    length = len(head).to_bytes(2 if version == b"\1\0" else 4, "little")
    return b"\x93NUMPY" + version + length + head + body


def _spoil_array(rng: Random, arrays: dict[str, Any]) -> None:
    name = rng.choice(list(arrays))
    array = np.atleast_1d(arrays[name])
    match rng.randrange(10):
        case 0:
            del arrays[name]
        case 1:
            arrays[name] = array.astype(rng.choice(("U3", "O")))
        case 2:
            arrays[name] = array[: rng.randint(0, len(array))]
        case 3:
            arrays[name] = array[..., None]
        case 4 if array.size:
            arrays[name] = array.reshape(-1)[:1].reshape(())
        case 5 if array.dtype.kind == "f":
            with np.errstate(all="ignore"):
                arrays[name] = array.astype(rng.choice(("f2", "f4", "i4", "u1", "c16", "?", ">f8", "M8[s]")))
        case 6 if name == "dofs":
            arrays[name] = np.array([rng.choice((*_HUB, "", "a\nb", "é", "x" * 999)) for _ in array])
        case 7:
            arrays[rng.choice(("weight", "mass", "dofs", "damping"))] = array
        case _:
            if name == "dofs" or array.ndim != 2 or not array.size:
                return
            array = array.astype(float) if array.dtype.kind in "fiu" else np.eye(len(array))
            row, column = (rng.randrange(n) for n in array.shape)
            array[row, column] = value = rng.choice(_VALUES) * rng.choice((1, -1))
            if rng.random() < 0.5 and array.shape[0] == array.shape[1]:
                array[column, row] = value
            arrays[name] = array


# Matrix Market ------------------------------------------------------------------------------------


def _market(rng: Random, arrays: dict[str, Any]) -> dict[str, bytes]:
    files = {f"{name}.mtx": _mtx(rng, arrays[name]) for name in ("mass", "stiffness", "damping")}
    files["dofs.txt"] = "\n".join(arrays["dofs"]).encode()
    if rng.random() < 0.3:
        del files["damping.mtx"]
    name = rng.choice(list(files))
    if rng.random() < 0.3:
        files[name] = spoiled_bytes(rng, files[name], list(files.values()))
    else:
        ways = (other_number, other_lines, _other_head)
        files[name] = several(rng, files[name].decode(), ways).encode("utf-8", "replace")
    if rng.random() < 0.03:
        del files[rng.choice(list(files))]
    return files


def _mtx(rng: Random, matrix: np.ndarray) -> bytes:
    file = io.BytesIO()
    mmwrite(file, matrix if rng.random() < 0.5 else coo_array(matrix), precision=rng.choice((6, 17)))
    return file.getvalue()


def _other_head(rng: Random, text: str) -> str:
    """The line that says what the file is, or the one that says how large, changed."""
    lines = text.split("\n")
    if rng.random() < 0.5:
        words = ("%%MatrixMarket", "matrix", "coordinate", "array", "real", "complex", "integer", "pattern")
        words += ("general", "symmetric", "skew-symmetric", "hermitian", "vector", "double", "")
        head = lines[0].split(" ")
        head[rng.randrange(len(head))] = rng.choice(words)
        lines[0] = " ".join(head)
    elif sizes := [k for k, line in enumerate(lines) if line and not line.startswith("%")]:
        words = lines[sizes[0]].split(" ")
        words[rng.randrange(len(words))] = rng.choice((*NUMBERS, "6", "7", "36", "50000", "2000000000"))
        lines[sizes[0]] = " ".join(words)
    return "\n".join(lines)
