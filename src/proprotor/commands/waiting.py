"""A spinner on the error stream while a step takes more than a second."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import Timer

_PATIENCE = 1.0  # seconds


@contextmanager
def waiting(what: str) -> Iterator[None]:
    """Show a spinner beside the text `what` once a step takes more than a second; only on a terminal."""
    from rich.console import Console  # here, because rich takes long to import
    from rich.text import Text

    console = Console(stderr=True)
    if not console.is_terminal:
        yield
        return
    spinner = console.status(Text(what), spinner="line")
    timer = Timer(_PATIENCE, spinner.start)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()  # otherwise the spinner could start after it was stopped
        spinner.stop()
