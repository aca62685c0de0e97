"""How far a study is, and how long it will take, judged by what this run has computed itself."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

_LONG = 1e6  # seconds: the estimate rests on the whole run, not on its last moments

Advance = Callable[[int, int], None]  # points computed, of which failed


@contextmanager
def progress_bar(points: int, kept: int, shown: bool | None) -> Iterator[Advance]:
    """A progress bar on the error stream.

    Parameters
    ----------
    points : int
        All points of the study.
    kept : int
        Points found in a checkpoint: they count as done, and not for the estimate.
    shown : bool or None
        None shows it on a terminal only.
    """
    if shown is False:
        yield lambda computed, failed: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    console = Console(stderr=True)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[told]}"),
        TimeRemainingColumn(),
        TextColumn("left"),
    )
    disabled = shown is None and not console.is_terminal
    with Progress(*columns, console=console, speed_estimate_period=_LONG, disable=disabled) as progress:
        task = progress.add_task("Analysing", total=points, completed=kept, told="")
        failures = 0

        def advance(computed: int, failed: int) -> None:
            nonlocal failures
            failures += failed
            told = f"{failures} failed" if failures else ""
            progress.update(task, advance=computed, told=told)

        yield advance
