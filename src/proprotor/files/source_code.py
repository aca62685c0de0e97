"""A fingerprint of the text of all modules that a result can depend on, those that are compiled included.

A version number is not enough: between two versions the code changes, and results with the code.
"""

from __future__ import annotations

import functools
import hashlib
import time
from collections.abc import Iterator
from pathlib import Path

import proprotor_equations

from proprotor.errors import InputError

_IMPORTED = time.time()
_PACKAGES = (Path(__file__).parents[1], Path(proprotor_equations.__file__).parent)
_CODE = (".py", ".c", ".h")
SHOWING = ("commands", "explore", "plots", "report")  # rooms that only show results: no study imports them


def modules() -> Iterator[tuple[str, Path]]:
    """Yield name and path of all code that a result depends on, in the package and in the generated equations."""
    for package in _PACKAGES:
        for path in sorted(package.rglob("*.*")):
            within = path.relative_to(package)
            if path.suffix in _CODE and within.parts[0] not in SHOWING:
                yield f"{package.name}/{within.as_posix()}", path


@functools.cache
def code_fingerprint() -> str:
    """Return the SHA-256 of the code that this process runs, in hexadecimal.

    Raises
    ------
    InputError
        When a file was changed after its import: the code that this process runs can then no longer be read.
    """
    digest = hashlib.sha256()
    for name, path in modules():
        # A time in the future comes from a wrong clock, not from a change.
        if _IMPORTED < path.stat().st_mtime <= time.time():
            raise InputError("code", path, "was changed after this process had read it: start Python again")
        text = path.read_bytes()
        digest.update(f"{name}:{len(text)}:".encode() + text)
    return digest.hexdigest()


def check_code(expected: str) -> None:
    """Raise an `InputError` unless this process runs the code with which a study was begun."""
    if code_fingerprint() != expected:
        import platform

        rule = "runs other code of proprotor than the study was begun with: install the same, or start again"
        raise InputError("workers", platform.node(), rule)
