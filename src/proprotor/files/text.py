"""Text files that users give, decoded in one place.

A byte order mark at the start of a file says how the file is encoded: UTF-8, as Notepad writes it, or UTF-16 and
UTF-32, as PowerShell's ``>`` does. Without a mark the text is UTF-8, or what a format allows beside it.
"""

from __future__ import annotations

import codecs
import io
import os
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from proprotor.errors import InputError

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

# Marks of UTF-32 stand before those of UTF-16, with one of which they begin.
_MARKS = {
    codecs.BOM_UTF8: "utf-8",
    codecs.BOM_UTF32_LE: "utf-32-le",
    codecs.BOM_UTF32_BE: "utf-32-be",
    codecs.BOM_UTF16_LE: "utf-16-le",
    codecs.BOM_UTF16_BE: "utf-16-be",
}
# How files begin that are no text, and what they are.
_NO_TEXTS = {
    b"PK\x03\x04": "a workbook or an archive; save a sheet as CSV in UTF-8",
    b"\xd0\xcf\x11\xe0": "an old workbook or document; save a sheet as CSV in UTF-8",
    b"\x89HDF": "a file of HDF5",
    b"MATLAB 5": "a file of MATLAB",
    b"\x93NUMPY": "an array of NumPy",
    b"%PDF": "a PDF",
}
_LONGEST_MARK = max(map(len, _MARKS))


def read_text(
    file: Path | Traversable, field: str, label: str, largest: int, *, encoding: str = "utf-8"
) -> str:
    """Return the text of a file, with its line ends unchanged.

    Parameters
    ----------
    file : path
    field, label : str
        Name of the input and name of the file, for messages.
    largest : int
        Largest allowed size of the file, bytes.
    encoding : str
        Encoding of a text without a byte order mark; "latin-1" accepts any bytes.

    Raises
    ------
    InputError
        When the file does not exist, cannot be read, is larger than allowed, is a workbook, or is not text of its
        encoding.
    """
    content = None
    try:
        if is_file(file):
            with file.open("rb") as stream:
                content = stream.read(largest + 1)
    except OSError as error:  # such as a name too long, or a folder that this user may not enter
        raise InputError(field, label, f"cannot be read ({error.strerror})") from None
    if content is None:
        raise InputError(field, label, "no such file")
    if what := next((what for start, what in _NO_TEXTS.items() if content.startswith(start)), ""):
        raise InputError(field, label, f"must be text, and is {what}")
    if len(content) > largest:
        raise InputError(field, label, f"must not be larger than {largest} bytes")
    mark, encoding = _encoding(content, encoding)
    try:
        return content[mark:].decode(encoding)
    except UnicodeDecodeError as error:
        line = content[: mark + error.start].count(b"\n") + 1
        rule = f"must be text in {encoding.upper()}: line {line} is not; save the file in that encoding"
        raise InputError(field, label, rule) from None


def is_file(path: Path | Traversable) -> bool:
    """Return whether there is a file at a path.

    Raises
    ------
    OSError
        When the path cannot be followed, such as a name too long, or a folder that this user may not enter. From Python
        3.14 on, `pathlib.Path.is_file` takes that for "no file".
    """
    if isinstance(path, Path):
        with suppress(
            FileNotFoundError, NotADirectoryError, ValueError
        ):  # the last: a name with a null character
            path.stat()
    return path.is_file()


def check_file(field: str, path: str | os.PathLike[str]) -> None:
    """Refuse a path at which there is no file.

    Raises
    ------
    InputError
        When there is none, or the path cannot be followed.
    """
    try:
        there = is_file(Path(path))
    except OSError as error:
        raise InputError(field, str(path), f"cannot be read ({error.strerror or error})") from None
    if not there:
        raise InputError(field, str(path), "no such file")


def open_text(path: Path, *, encoding: str = "utf-8") -> io.TextIOWrapper:
    """Return a text file opened after its byte order mark, with all line ends as ``\\n``; see `read_text`."""
    file = path.open("rb")
    mark, encoding = _encoding(file.read(_LONGEST_MARK), encoding)
    file.seek(mark)
    return io.TextIOWrapper(file, encoding=encoding, newline=None)


def _encoding(content: bytes, usual: str) -> tuple[int, str]:
    """Return how many bytes the mark of a file has, and the encoding of what follows."""
    for mark, encoding in _MARKS.items():
        if content.startswith(mark):
            return len(mark), encoding
    return 0, usual
