"""Short names of a deck's inputs for plots: "chord: frequency" for support.modes[chord].frequency."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

_MODE = re.compile(r"support\.modes\[(.+)\]\.(.+)")
_SECTIONS = ("rotor.", "operation.")
_TOLD = {"rotor.chord": "blade chord"}  # the wing has one too, and a mode of that name


def short_name(path: str) -> str:
    """An input by what it is, without the section of the deck it stands in."""
    if found := _MODE.fullmatch(path):
        return f"{found[1]}: {found[2].replace('_', ' ')}"
    if path in _TOLD:
        return _TOLD[path]
    for section in _SECTIONS:
        path = path.removeprefix(section)
    return path.replace(".", " ").replace("_", " ")


def short_names(paths: Sequence[str]) -> list[str]:
    """Short names of several inputs; the whole path where two would read the same."""
    names = [short_name(path) for path in paths]
    counts = Counter(names)
    return [name if counts[name] == 1 else path for name, path in zip(names, paths, strict=True)]
