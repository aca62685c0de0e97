"""Names of inputs and outputs for plots: "chord: frequency" for support.modes[chord].frequency."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

_LOAD = re.compile(r"(?:(.+) )?(force|moment)_([xyz])")
_MODE = re.compile(r"support\.modes\[(.+)\]\.(.+)")
_OTHERS = {"rotor.chord": "blade chord"}  # the wing has a chord too, and one mode is called chord


def short_name(path: str) -> str:
    """Return the name of an input without the section of the deck in which it stands."""
    if found := _MODE.fullmatch(path):
        return f"{found[1]}: {found[2].replace('_', ' ')}"
    if path in _OTHERS:
        return _OTHERS[path]
    return path.removeprefix("rotor.").removeprefix("operation.").replace(".", " ").replace("_", " ")


def output_name(name: str) -> str:
    """Return an output as a sentence has it: "hub force along x" for force_x, "hub moment about y" for moment_y."""
    if found := _LOAD.fullmatch(name):
        way = "along" if found[2] == "force" else "about"
        return " ".join(filter(None, (found[1], f"hub {found[2]} {way} {found[3]}")))
    return name.replace("_", " ")


def short_names(paths: Sequence[str]) -> list[str]:
    """Return short names of several inputs; the whole path for inputs that would have the same short name."""
    names = [short_name(path) for path in paths]
    counts = Counter(names)
    return [name if counts[name] == 1 else path for name, path in zip(names, paths, strict=True)]
