"""The console on which commands print."""

from __future__ import annotations

from typing import Any

from rich.console import Console
from rich.text import Text

from proprotor.errors import printable


class PlainConsole(Console):
    """A console that prints text without markup, and a space for each character that may not be shown."""

    def __init__(self) -> None:
        super().__init__(markup=False, highlight=False, emoji=False)

    def print(self, *objects: Any, **more: Any) -> None:
        super().print(*map(_shown, objects), **more)


def _shown(entry: Any) -> Any:
    """Return text with its unprintable characters replaced, and any other object unchanged."""
    if isinstance(entry, Text):
        entry.plain = printable(entry.plain, keep="\n")
    return printable(entry, keep="\n") if isinstance(entry, str) else entry
