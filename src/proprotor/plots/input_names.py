"""Short names of a deck's inputs for plots: "chord: frequency" for support.modes[chord].frequency."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

_MODE = re.compile(r"support\.modes\[(.+)\]\.(.+)")
_OTHERS = {"rotor.chord": "blade chord"}  # the wing has a chord too, and one mode is called chord


def short_name(path: str) -> str:
    """Return the name of an input without the section of the deck in which it stands."""
    if found := _MODE.fullmatch(path):
        return f"{found[1]}: {found[2].replace('_', ' ')}"
    if path in _OTHERS:
        return _OTHERS[path]
    return path.removeprefix("rotor.").removeprefix("operation.").replace(".", " ").replace("_", " ")


def short_names(paths: Sequence[str]) -> list[str]:
    """Return short names of several inputs; the whole path for inputs that would have the same short name."""
    names = [short_name(path) for path in paths]
    counts = Counter(names)
    return [name if counts[name] == 1 else path for name, path in zip(names, paths, strict=True)]
