"""Which code computes: a fingerprint of the text of all modules that a result can depend on.

A version does not tell: between two of them code changes, and results with it.
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
_PACKAGES = (Path(__file__).parent, Path(proprotor_equations.__file__).parent)
# What only shows results; no study imports it.
SHOWING = ("commands", "explore", "figures", "plots", "report_page")


def modules() -> Iterator[tuple[str, Path]]:
    """Name and place of every module of the package and of the equations, but those that only show results."""
    for package in _PACKAGES:
        for path in sorted(package.rglob("*.py")):
            within = path.relative_to(package)
            if within.parts[0] not in SHOWING:
                yield f"{package.name}/{within.as_posix()}", path


@functools.cache
def code_fingerprint() -> str:
    """SHA-256 of the code of this process, in hexadecimal.

    Raises
    ------
    InputError
        When a file is newer than what was imported of it: what this process runs is no longer there to be read.
    """
    digest = hashlib.sha256()
    for name, path in modules():
        if _IMPORTED < path.stat().st_mtime <= time.time():  # a time to come is a wrong clock, and no change
            raise InputError("code", path, "was changed after this process had read it: start Python again")
        text = path.read_bytes()
        digest.update(f"{name}:{len(text)}:".encode() + text)
    return digest.hexdigest()


def check_code(expected: str) -> None:
    """Raise an InputError unless this process runs the code that a study was begun with."""
    if code_fingerprint() != expected:
        import platform

        rule = "runs other code of proprotor than the study was begun with: install the same, or start again"
        raise InputError("workers", platform.node(), rule)
