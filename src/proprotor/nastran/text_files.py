"""Lines of text files of any size, one after another."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from proprotor.files.text import open_text


def lines_of(path: Path) -> Iterator[str]:
    """Yield the lines of a file, without their ends.

    Raises
    ------
    OSError
        When the file cannot be read.
    """
    with open_text(path, encoding="latin-1") as file:  # titles may have any encoding
        for line in file:
            yield line.rstrip("\n")
