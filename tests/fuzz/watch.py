"""What a program does while it reads an input: files it writes, processes it starts, code it runs, time it takes.

An audit hook of Python stays for the life of the process; it is at work inside `watched` alone.
"""

from __future__ import annotations

import ast
import os
import signal
import sys
import threading
import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

# Of the processor, for one input; the slowest takes a tenth of this. A busy machine does not make an input slow.
SECONDS = 10.0
WAITING = 120.0  # seconds of the clock: only an input that waits for something, and does not work, gets there

# Events by the start of their names, as the audit event table of Python has them.
_RUNS_CODE = ("exec", "compile", "import", "marshal.", "pickle.", "code.__new__", "ctypes.")
_STARTS = (
    "os.system",
    "os.exec",
    "os.fork",
    "os.forkpty",
    "os.posix_spawn",
    "os.spawn",
    "os.startfile",
    "pty.",
)
_STARTS += (
    "subprocess.",
    "socket.",
    "urllib.",
    "http.",
    "ftplib.",
    "smtplib.",
    "webbrowser.",
    "os.kill",
    "signal.",
)
_CHANGES_FILES = ("os.remove", "os.rename", "os.mkdir", "os.rmdir", "os.link", "os.symlink", "os.truncate")
_CHANGES_FILES += (
    "os.chmod",
    "os.chown",
    "os.lchown",
    "os.utime",
    "os.setxattr",
    "os.removexattr",
    "shutil.",
)
# numpy reads the head of an array with ast.literal_eval, whose parser makes a tree and no code.
_KNOWN = (ast.parse.__code__,)
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND


class Breach(BaseException):
    """Something no input may bring about; not an `Exception`, so that nothing on the way takes it for a mistake."""


class TooSlow(BaseException):
    """An input that works for longer than `SECONDS`, or waits for longer than `WAITING`."""


class _Watch:
    """The state of the hook: who is watched, where it may write, and what it did."""

    thread: int | None = None
    folder: Path | None = None
    installed = False
    breaches: list[str] = []  # noqa: RUF012


@contextmanager
def watched(output: Path | None = None) -> Iterator[list[str]]:
    """Watch this thread; files may be written in `output` and nowhere else.

    Yields
    ------
    list of str
        What was done that may not be, also where the `Breach` it raised was taken for something else.
    """
    if not _Watch.installed:
        sys.addaudithook(_hook)
        _Watch.installed = True
    limits = {signal.SIGPROF: (signal.ITIMER_PROF, SECONDS), signal.SIGALRM: (signal.ITIMER_REAL, WAITING)}
    previous = {number: signal.signal(number, _too_slow) for number in limits}
    _Watch.folder, _Watch.breaches = output and output.resolve(), []
    for timer, seconds in limits.values():
        signal.setitimer(timer, seconds)
    _Watch.thread = threading.get_ident()
    try:
        yield _Watch.breaches
    finally:
        _Watch.thread = None
        for number, (timer, _) in limits.items():
            signal.setitimer(timer, 0)
            signal.signal(number, previous[number])


def _too_slow(number: int, _: Any) -> None:
    told = f"{SECONDS} s of the processor" if number == signal.SIGPROF else f"{WAITING} s of waiting"
    raise TooSlow(told)


def _hook(event: str, arguments: tuple[Any, ...]) -> None:
    if _Watch.thread is None or threading.get_ident() != _Watch.thread:
        return
    if told := _told(event, arguments):
        here = traceback.extract_stack(sys._getframe(1), limit=12)
        _Watch.breaches.append(f"{''.join(traceback.format_list(here))}{told}")
        raise Breach(told)


def _told(event: str, arguments: tuple[Any, ...]) -> str | None:
    """What is wrong with an event; None where nothing is."""
    if event == "open":
        path, mode, flags = (*arguments, None, 0)[:3]
        writes = any(letter in (mode or "") for letter in "wax+") or (flags or 0) & _WRITING
        return f"wrote {path}" if writes and not _allowed(path) else None
    if event in ("compile", "exec") and sys._getframe(2).f_code in _KNOWN:
        return None
    if event.startswith(_CHANGES_FILES):
        paths = [one for one in arguments if isinstance(one, str | bytes | os.PathLike)]
        return None if paths and all(map(_allowed, paths)) else f"{event} {arguments!r:.80}"
    if event.startswith((*_RUNS_CODE, *_STARTS)) and event != "signal.setitimer":
        return f"{event} {arguments!r:.80}"
    return None


def _allowed(path: Any) -> bool:
    if _Watch.folder is None or isinstance(path, int):
        return False
    return Path(os.path.realpath(os.fsdecode(path))).is_relative_to(_Watch.folder)
