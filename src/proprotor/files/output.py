"""Files that are either written whole or not at all: every file that this package writes goes through here."""

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

_NEW = 0o666  # permissions of a new file, of which the system takes off what the user's umask says


def write_whole(path: str | os.PathLike[str], write: Callable[[IO[bytes]], object]) -> None:
    """Write a file beside its place and put it there when it is complete.

    Any number of threads and processes may write one path at once: each writes a file of its own, and the last to be
    complete stays.

    Parameters
    ----------
    path : str or path
        A file that exists is replaced, keeps its permissions, and stays as it is when writing fails. A symbolic link
        stays a link: the file that it leads to is replaced.
    write : callable
        Writes the content to the binary file it is given, or, by its own means, to the path ``file.name``.

    Raises
    ------
    InputError
        When the path is something other than a file.
    OSError
        When the file cannot be written.
    """
    place, before = _place(path)
    with _unfinished(place, before) as file:
        write(file)
        file.flush()
        os.fsync(file.fileno())
        file.close()  # Windows moves no file that is open
        if before is not None:
            _make_like(file.name, before)
        os.replace(file.name, place)


def check_writable(path: str | os.PathLike[str]) -> None:
    """Raise what `write_whole` would raise for a path, before what is to be written has been computed.

    A file is made in the folder and removed again: whether that works, permissions alone do not tell.

    Parameters
    ----------
    path : str or path

    Raises
    ------
    InputError
        When the path is something other than a file.
    OSError
        When no file can be made in its folder, or the file that is there may not be replaced.
    """
    place, before = _place(path)
    with _unfinished(place, before):
        pass


def check_place(path: str | os.PathLike[str], ending: str, field: str = "path") -> None:
    """Refuse a path that no file of a kind can be written to, before what is to be written has been computed.

    Parameters
    ----------
    path : str or path
    ending : str
        That the kind of file has, such as ``.nc``.
    field : str
        What a message calls the path.

    Raises
    ------
    InputError
        When the path has another ending, is a folder, lies in none, or cannot be written.
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
    """Return where the file is, links followed, and what is there now; None for nothing."""
    place = Path(os.path.realpath(path))
    try:
        before = place.stat()
    except FileNotFoundError:
        return place, None
    if not stat.S_ISREG(before.st_mode):
        raise InputError("output", path, "must be a file")
    if not os.access(place, os.W_OK):  # moving another file over it would not ask
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
    return place, before


@contextmanager
def _unfinished(place: Path, before: os.stat_result | None) -> Iterator[IO[bytes]]:
    """A new file in the same folder that nobody else has, removed at the end unless it was moved to its place.

    Its name says nothing of the place, whose name may be as long as the system allows.
    """
    mode = _NEW if before is None else before.st_mode & _NEW  # never open to more people than it will be
    name = place.with_name(f".proprotor-{secrets.token_hex(8)}.tmp")
    file = open(name, "xb", opener=lambda path, flags: os.open(path, flags, mode))  # noqa: SIM115, closed below
    try:
        with file:
            yield file
    finally:
        name.unlink(missing_ok=True)


def _make_like(name: str, before: os.stat_result) -> None:
    """Give a file the owner, as far as this user may, and the permissions that another had."""
    if hasattr(os, "chown"):
        with suppress(PermissionError):
            os.chown(name, before.st_uid, before.st_gid)
    if os.stat(name).st_mode != before.st_mode:
        os.chmod(name, stat.S_IMODE(before.st_mode))
