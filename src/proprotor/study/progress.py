"""How far a study is, and how long it will still take: on a terminal, in a notebook, or told to a function.

The time that is left is judged by the points that this run has computed itself.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from threading import Event, Thread
from typing import Any, Protocol

_Told = Callable[[int, int, int], object]  # points done, all points, points that failed
Shown = bool | _Told | None

_LONG = 1e6  # seconds: the estimate rests on the whole run, not on its last moments
_TICK = 0.5  # seconds between two drawings in a notebook


class Progress(Protocol):
    """What a study tells of itself."""

    def begin(self, points: int, kept: int) -> None:
        """Tell how many points there are, and how many were kept by an earlier run."""

    def advance(self, computed: int, failed: int) -> None:
        """Tell how many points were computed, and failed, since the last call."""


@contextmanager
def shown_progress(shown: Shown) -> Iterator[Progress]:
    """Show the progress of a study from its first moment on, before the number of its points is known.

    Parameters
    ----------
    shown : bool, callable or None
        None shows a bar on a terminal and in a notebook only, True a bar in any case. A callable is called with the
        numbers of points that are done, of all points, and of points that failed.
    """
    if callable(shown):
        yield _Function(shown)
    elif shown is False:
        yield _Function(lambda done, points, failed: None)
    elif _in_notebook():
        with _notebook_bar() as bar:
            yield bar
    elif shown or sys.stderr.isatty():
        with _terminal_bar() as bar:
            yield bar
    else:
        yield _Function(lambda done, points, failed: None)


class _Function:
    """Progress that is told to a function."""

    def __init__(self, tell: _Told) -> None:
        self.tell, self.done, self.points, self.failed = tell, 0, 0, 0

    def begin(self, points: int, kept: int) -> None:
        self.done, self.points = kept, points
        self.tell(self.done, self.points, self.failed)

    def advance(self, computed: int, failed: int) -> None:
        self.done, self.failed = self.done + computed, self.failed + failed
        self.tell(self.done, self.points, self.failed)


@contextmanager
def _terminal_bar() -> Iterator[Progress]:
    """Show a bar on the error stream; it moves while nothing is known yet."""
    from rich import progress as rich
    from rich.console import Console  # here, because rich takes long to import

    points_done = "{task.description}", rich.BarColumn(), rich.MofNCompleteColumn(), "{task.fields[failed]}"
    columns = (*points_done, rich.TimeElapsedColumn(), rich.TimeRemainingColumn(), "left")
    with rich.Progress(*columns, console=Console(stderr=True), speed_estimate_period=_LONG) as bar:
        task = bar.add_task("Preparing", total=None, failed="")

        def tell(done: int, points: int, failed: int) -> None:
            nonlocal task
            if bar.tasks[0].total is None:  # a new task, whose speed does not count what was kept
                bar.remove_task(task)
                task = bar.add_task("Analysing", total=points, completed=done, failed="")
            bar.update(task, completed=done, failed=f"{failed} failed" if failed else "")

        yield _Function(tell)


# Notebooks ----------------------------------------------------------------------------------------


def _in_notebook() -> bool:
    """Return whether this process is the kernel of a notebook."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return hasattr(shell, "kernel")


@contextmanager
def _notebook_bar() -> Iterator[Progress]:
    """Show a bar below the cell of a notebook, drawn anew by a thread so that its seconds go on."""
    ipython = import_module("IPython.display")  # a notebook brings it, this package does not
    handle = ipython.display(ipython.HTML(_bar(0, 0, 0, 0, 0.0)), display_id=True)
    state: dict[str, Any] = {"numbers": (0, 0, 0), "kept": 0}
    begun, ended = time.monotonic(), Event()

    def draw() -> None:
        done, points, failed = state["numbers"]
        handle.update(ipython.HTML(_bar(done, points, failed, state["kept"], time.monotonic() - begun)))

    def tick() -> None:
        while not ended.wait(_TICK):
            draw()

    def tell(done: int, points: int, failed: int) -> None:
        if not state["numbers"][1]:
            state["kept"] = done
        state["numbers"] = done, points, failed

    ticker = Thread(target=tick, daemon=True)
    ticker.start()
    try:
        yield _Function(tell)
    finally:
        ended.set()
        ticker.join()
        draw()


def _bar(done: int, points: int, failed: int, kept: int, seconds: float) -> str:
    """Return a bar as HTML."""
    if not points:
        return f"<progress></progress> Preparing, {seconds:.0f} s"
    computed = done - kept
    left = f", about {seconds / computed * (points - done):.0f} s left" if computed and done < points else ""
    told = f"{done} of {points} points" + (f", {failed} failed" if failed else "")
    return f'<progress value="{done}" max="{points}"></progress> {told}, {seconds:.0f} s{left}'
