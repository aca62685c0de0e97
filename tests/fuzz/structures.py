"""Universal files and files of MATLAB: numbers, lines and bytes of good ones changed."""

from __future__ import annotations

import io
from pathlib import Path
from random import Random

import numpy as np
from scipy.io import savemat

from proprotor.support.matlab_file import read_matlab
from proprotor.support.universal_modes import universal_modes
from tests.fuzz.mutation import other_lines, other_number, several, spoiled_bytes

_NODES = {101: (3.0, 5.0, 1.0), 11: (3.5, 5.2, 1.1), 12: (4.1, 4.8, 0.9), 13: (4.0, 5.1, 1.6)}
_END = "    -1"


def _row(*numbers: float) -> str:
    return "".join(f"{number:13.5E}" for number in numbers)


def _universal() -> str:
    """Units, nodes and two modes, one in dataset 55 and one in dataset 2414, of a body that heaves and pitches."""
    lines = [
        _END,
        "   164",
        f"{1:10d}{'SI: Meter (newton)':20}{2:10d}",
        _row(1, 1, 1),
        _row(0),
        _END,
        _END,
        "  2411",
    ]
    for name, place in _NODES.items():
        lines += [f"{name:10d}{1:10d}{1:10d}{11:10d}", _row(*place)]
    at = np.array(_NODES[101])
    shape = []
    for name, place in _NODES.items():
        moved = np.cross([0, 0.4, 0], np.array(place) - at) + np.array([0, 0, 1])
        shape += [f"{name:10d}", _row(*moved, 0.0, 0.4, 0.0)]
    texts = ["NONE"] * 5
    kinds = "".join(f"{number:10d}" for number in (1, 2, 3, 8, 2, 6))
    mode = "".join(f"{number:10d}" for number in (2, 4, 1, 1))
    lines += [_END, _END, "    55", *texts, kinds, mode, _row(3.2, 1500, 0.01, 0.0), *shape, _END]
    eight = "".join(f"{number:10d}" for number in (1, 0, 1, 0, 1, 2, 0, 0))
    head = [f"{1:10d}", "MODE", f"{1:10d}", *texts, kinds, eight, f"{0:10d}{0:10d}"]
    lines += [_END, "  2414", *head, _row(0, 5.1, 0, 900, 0.01, 0), _row(*[0.0] * 6), *shape, _END]
    return "\n".join(lines)


def _matlab(compressed: bool) -> bytes:
    file = io.BytesIO()
    hub = np.eye(6, 3)
    wing = {
        "M": np.diag([9.0, 8.0, 7.0]),
        "K": np.diag([9e3, 8e4, 7e5]),
        "Phi": hub,
        "names": ["a", "b", "c"],
    }
    savemat(file, {"wing": wing, "notes": "made up"}, do_compression=compressed)
    return b"MATLAB 5.0 MAT-file made up".ljust(116) + file.getvalue()[116:]  # without the time of day


_UNIVERSAL, _MATLAB = _universal(), [_matlab(compressed) for compressed in (False, True)]


def make(rng: Random) -> tuple[dict[str, bytes], dict]:
    """The files of an input by name, and how they are used."""
    if rng.random() < 0.3:
        return {"wing.mat": spoiled_bytes(rng, rng.choice(_MATLAB), _MATLAB)}, {"rigid": False}
    text = several(rng, _UNIVERSAL, (other_number, other_lines))
    content = text.encode("latin-1", "replace")
    if rng.random() < 0.3:
        content = spoiled_bytes(rng, content)
    return {"modes.unv": content}, {"rigid": rng.random() < 0.5}


def use(folder: Path, rigid: bool) -> None:
    if (folder / "wing.mat").exists():
        support = read_matlab(folder / "wing.mat", carries="one rotor")
    else:
        nodes = [11, 12, 13] if rigid else []
        support = universal_modes(folder / "modes.unv", 101, includes_rotor=False, rigid_nodes=nodes)
    n = len(support.names)
    for name, shape in {"mass": (n, n), "damping": (n, n), "stiffness": (n, n), "hub": (6, n)}.items():
        matrix = getattr(support, name)
        assert matrix.shape == shape, f"{name} has another shape"
        assert np.isfinite(matrix).all(), f"{name} is not finite"
