"""A spinner on the error stream where a command has shown nothing for most of a second; only on a terminal."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Lock, Timer
from typing import Any, TextIO

_PATIENCE = 0.5  # seconds without a sign of life, from the start of the command on
_SOON = 0.1  # seconds that a step may take after a long silence, so that a short one does not flicker


class _Spinner:
    """A spinner with what is being done and for how long; steps within steps change the text."""

    def __init__(self) -> None:
        self.steps: list[str] = []
        self.quiet_since = time.monotonic()
        self.timer: Timer | None = None
        self.bar: Any = None
        self.lock = Lock()  # between the thread of the command and that of the timer

    def begin(self, step: str) -> None:
        """Begin a step; the first one may start the spinner after a while."""
        self.steps.append(step)
        if len(self.steps) > 1:
            self._tell()
            return
        left = self.quiet_since + _PATIENCE - time.monotonic()
        self.timer = Timer(max(_SOON, left), self._show)
        self.timer.daemon = True
        self.timer.start()

    def call(self, step: str) -> None:
        """Give the present step another name."""
        self.steps[-1] = step
        self._tell()

    def end(self) -> None:
        """End the present step, and the spinner with the last one."""
        with self.lock:
            self.steps.pop()
        if self.steps:
            self._tell()
            return
        assert self.timer is not None
        self.timer.cancel()
        self.timer.join()  # otherwise the spinner could start after it was stopped
        if self.bar is not None:
            self.bar.stop()
            self.bar, self.quiet_since = None, time.monotonic()

    def _show(self) -> None:
        from rich import progress as rich  # here, because rich takes long to import
        from rich.console import Console

        columns = (rich.SpinnerColumn("line"), rich.TextColumn("{task.description}", markup=False))
        with self.lock:
            if not self.steps:  # the last one ended while rich was imported
                return
            console = Console(stderr=True)
            self.bar = rich.Progress(*columns, rich.TimeElapsedColumn(), console=console, transient=True)
            self.bar.add_task(self.steps[-1])
            self.bar.start()

    def _tell(self) -> None:
        with self.lock:
            if self.bar is not None:
                self.bar.update(self.bar.task_ids[0], description=self.steps[-1])


_SPINNER = _Spinner()


@contextmanager
def waiting(step: str) -> Iterator[Callable[[str], None]]:
    """Show a spinner beside the name of a step, once nothing has been shown for a while; only on a terminal.

    The command gets a function that gives the step another name as it goes on. Steps may hold further steps.
    """
    if not _watched():
        yield lambda step: None
        return
    _SPINNER.begin(step)
    try:
        yield _SPINNER.call
    finally:
        _SPINNER.end()


def is_terminal(stream: TextIO | None) -> bool:
    """Return whether a standard stream is a terminal; one that was closed before the start of Python is None."""
    return stream is not None and stream.isatty()


def _watched() -> bool:
    """Return whether the error stream is a terminal that can move its cursor, or TTY_COMPATIBLE says so."""
    told = os.environ.get("TTY_COMPATIBLE")
    return told == "1" if told in ("0", "1") else is_terminal(sys.stderr) and os.environ.get("TERM") != "dumb"
