"""Files that are either written whole or not at all.

Every file that this package writes is written by `write_whole`; a test looks for other writers.
"""

from __future__ import annotations

import errno
import os
import secrets
import stat
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from proprotor.errors import InputError

_NEW = 0o666  # permissions of a new file, before the system applies the user's umask


def write_whole(path: str | os.PathLike[str], write: Callable[[IO[bytes]], object]) -> None:
    """Write a file under another name and move the complete file to its place.

    Any number of threads and processes may write one path at once: each writes a file of its own, and the last complete
    file stays.

    Parameters
    ----------
    path : str or path
        An existing file is replaced and keeps its permissions; when writing fails, the old file stays as it was. A
        symbolic link stays a link: the file at the end of the link is replaced.
    write : callable
        Called with a binary file, writes the content to that file, or by other means to the path ``file.name``.

    Raises
    ------
    InputError
        When the path is a folder or another thing that is no file.
    OSError
        When the file cannot be written.
    """
    place, before = _place(path)
    with _unfinished(place, before) as file:
        write(file)
        file.flush()
        os.fsync(file.fileno())
        file.close()  # Windows cannot move an open file
        if before is not None:
            _make_like(file.name, before)
        os.replace(file.name, place)


def check_writable(path: str | os.PathLike[str]) -> None:
    """Raise what `write_whole` would raise for a path, before the content has been computed.

    A file is made in the folder and removed again, because permissions alone do not show whether that works.

    Parameters
    ----------
    path : str or path

    Raises
    ------
    InputError
        When the path is a folder or another thing that is no file.
    OSError
        When no file can be made in the folder, or an existing file may not be replaced.
    """
    with _unfinished(*_place(path)):
        pass


def check_place(path: str | os.PathLike[str], ending: str, field: str = "path") -> None:
    """Refuse a path to which no file of a kind can be written, before the content has been computed.

    Parameters
    ----------
    path : str or path
    ending : str
        Ending of that kind of file, such as ``.nc``.
    field : str
        Name of the path in messages.

    Raises
    ------
    InputError
        When the path has another ending, is a folder, lies in no folder that exists, or cannot be written.
    """
    place = Path(os.path.realpath(path))
    if place.suffix.lower() != ending:
        raise InputError(field, os.fspath(path), f"must end in {ending}")
    if not place.parent.is_dir():
        raise InputError(field, os.fspath(path), "must be in a folder that exists")
    try:
        check_writable(path)
    except InputError as error:
        raise InputError(field, os.fspath(path), error.rule) from None
    except OSError as error:
        raise InputError(field, os.fspath(path), f"cannot be written ({error.strerror or error})") from None


def _place(path: str | os.PathLike[str]) -> tuple[Path, os.stat_result | None]:
    """Return the real path of a file, with links followed, and the state of the present file; None without a file."""
    place = Path(os.path.realpath(path))
    try:
        before = place.stat()
    except FileNotFoundError:
        return place, None
    if not stat.S_ISREG(before.st_mode):
        raise InputError("output", path, "must be a file")
    if not os.access(place, os.W_OK):  # os.replace would not ask for this permission
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
    return place, before


@contextmanager
def _unfinished(place: Path, before: os.stat_result | None) -> Iterator[IO[bytes]]:
    """Yield a new file of a random name in the same folder, and remove that file unless it was moved to its place.

    The random name does not contain the final one, which may be as long as the system allows.
    """
    # Never readable by more people than the final file.
    mode = _NEW if before is None else before.st_mode & _NEW
    name = place.with_name(f".proprotor-{secrets.token_hex(8)}.tmp")
    file = open(name, "xb", opener=lambda path, flags: os.open(path, flags, mode))  # noqa: SIM115, closed below
    try:
        with file:
            yield file
    finally:
        name.unlink(missing_ok=True)


def _make_like(name: str, before: os.stat_result) -> None:
    """Give a file the permissions of an earlier one, and the same owner if this user may set the owner."""
    if hasattr(os, "chown"):
        with suppress(PermissionError):
            os.chown(name, before.st_uid, before.st_gid)
    if os.stat(name).st_mode != before.st_mode:
        os.chmod(name, stat.S_IMODE(before.st_mode))
