"""The console on which commands print."""

from __future__ import annotations

import os
import sys
import textwrap
from typing import Any

from rich.console import Console
from rich.text import Text

from proprotor.errors import printable

_PIPED = 80  # characters of a line in a file or a pipe


class PlainConsole(Console):
    """A console that prints text without markup, and a space for each character that may not be shown.

    Lines are as wide as the terminal, or as COLUMNS says. In a file or a pipe they have 80 characters, however wide the
    terminal is from which the command was started, so that the same command writes the same text.
    """

    def __init__(self) -> None:
        told = os.environ.get("COLUMNS", "").isdigit()
        at_terminal = sys.stdout is not None and sys.stdout.isatty()  # None where a shell has closed it
        width = None if told or at_terminal else _PIPED
        super().__init__(markup=False, highlight=False, emoji=False, width=width)

    def print(self, *objects: Any, **more: Any) -> None:
        super().print(*map(_shown, objects), **more)

    def print_hanging(self, lead: str, text: str) -> None:
        """Print a text after a lead; further lines are indented as far as the lead is long."""
        indent = " " * len(lead)
        room = max(self.width, 2 * len(lead))
        lines = textwrap.wrap(
            text,
            room,
            initial_indent=lead,
            subsequent_indent=indent,
            break_long_words=False,
            break_on_hyphens=False,
        )
        for line in lines or [lead]:
            self.print(line, soft_wrap=True)


def _shown(entry: Any) -> Any:
    """Return text with its unprintable characters replaced, and any other object unchanged."""
    if isinstance(entry, Text):
        entry.plain = printable(entry.plain, keep="\n")
    return printable(entry, keep="\n") if isinstance(entry, str) else entry
