"""Lines of text files of any size, one after another."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from proprotor.files.text import open_text
from proprotor.nastran.found import FileFault


def lines_of(path: Path) -> Iterator[str]:
    """Yield the lines of a file, without their ends.

    Raises
    ------
    FileFault
        When the file begins with the mark of an encoding that it does not keep.
    OSError
        When the file cannot be read.
    """
    with open_text(path, encoding="latin-1") as file:  # titles may have any encoding
        try:
            for line in file:
                yield line.rstrip("\n")
        except UnicodeDecodeError as error:
            raise FileFault(f"is damaged: it is not text in {error.encoding}, as it begins") from None
