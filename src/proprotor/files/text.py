"""Text files that users give: read without the byte order mark that some editors write first."""

from __future__ import annotations

import codecs
import io
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from proprotor.errors import InputError

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable


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
        Encoding of the text; "latin-1" accepts any bytes.

    Raises
    ------
    InputError
        When the file does not exist, cannot be read, is larger than allowed or is not text of that encoding.
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
    if len(content) > largest:
        raise InputError(field, label, f"must not be larger than {largest} bytes")
    try:
        return content.removeprefix(codecs.BOM_UTF8).decode(encoding)
    except UnicodeDecodeError:
        raise InputError(field, label, f"must be text in {encoding.upper()}") from None


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


def open_text(path: Path, *, encoding: str = "utf-8") -> io.TextIOWrapper:
    """Return a text file opened after its byte order mark, with all line ends as ``\\n``; see `read_text`."""
    file = path.open("rb")
    if file.read(len(codecs.BOM_UTF8)) != codecs.BOM_UTF8:
        file.seek(0)
    return io.TextIOWrapper(file, encoding=encoding, newline=None)
