"""Files that are either written whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import IO

from proprotor.errors import InputError


def write_whole(path: str | os.PathLike[str], write: Callable[[IO[bytes]], object]) -> None:
    """Write a file beside its place and put it there when it is complete.

    Parameters
    ----------
    path : str or path
        A file that exists is replaced, and stays as it is when writing fails.
    write : callable
        Writes the content to the binary file it is given.

    Raises
    ------
    InputError
        When the path is something other than a file.
    OSError
        When the file cannot be written.
    """
    place = Path(path).resolve()  # a link stays a link
    if place.exists() and not place.is_file():
        raise InputError("output", path, "must be a file")
    unfinished = place.with_name(f".{place.name}.{os.getpid()}.tmp")
    try:
        with unfinished.open("xb") as file:
            write(file)
        os.replace(unfinished, place)
    finally:
        unfinished.unlink(missing_ok=True)
