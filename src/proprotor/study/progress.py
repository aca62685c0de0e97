"""How far a study is, and how long it will still take, judged by the points that this run has computed itself."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

_LONG = 1e6  # seconds: the estimate rests on the whole run, not on its last moments

_Advance = Callable[[int, int], None]  # points computed, of which failed


@contextmanager
def progress_bar(points: int, kept: int, shown: bool | None) -> Iterator[_Advance]:
    """Show a progress bar on the error stream.

    Parameters
    ----------
    points : int
        All points of the study.
    kept : int
        Points found in a checkpoint, which count as done but not for the estimate of the time.
    shown : bool or None
        None shows the bar on a terminal only.

    Yields
    ------
    callable
        To be called with the number of points computed, and of points failed, since it was called last.
    """
    if shown is False:
        yield lambda computed, failed: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeRemainingColumn

    console = Console(stderr=True)
    points_done = "{task.description}", BarColumn(), MofNCompleteColumn(), "{task.fields[failed]}"
    columns = (*points_done, TimeRemainingColumn(), "left")
    disabled = shown is None and not console.is_terminal
    with Progress(*columns, console=console, speed_estimate_period=_LONG, disable=disabled) as progress:
        task = progress.add_task("Analysing", total=points, completed=kept, failed="")
        failures = 0

        def advance(computed: int, failed: int) -> None:
            nonlocal failures
            failures += failed
            progress.update(task, advance=computed, failed=f"{failures} failed" if failures else "")

        yield advance
