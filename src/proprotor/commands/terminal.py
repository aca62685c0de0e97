"""The texts that the command line prints on a sweep and on a case, and the console that prints them."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.text import Text

from proprotor.errors import printable
from proprotor.model.doubts import MARK
from proprotor.model.options_in_force import options_in_result, options_text
from proprotor.model.provenance import doubtful_inputs, reservations
from proprotor.tables.sweep_table import CONVENTION, SweepTable, heading

if TYPE_CHECKING:
    from proprotor.case import Case


def print_sweep(case: Case, table: SweepTable, all_modes: bool = False) -> None:
    """Print the case, the inputs that it rests on, the table of a sweep and where modes are unstable.

    Parameters
    ----------
    case : Case
    table : SweepTable
    all_modes : bool
        Whether to print every mode, in as many tables as needed, and not only the modes of interest.
    """
    console = PlainConsole()
    warnings = [_shortened(f"Warning: {text}", case, console.width) for text in case.warnings]
    for line in (
        heading(case),
        f"Model: {options_text(options_in_result(table.sweep.attrs))}.",
        CONVENTION,
        *reservations(case),
        *warnings,
        "",
    ):
        console.print(line)
    for row in table.lines(console.width, all_modes):
        console.print(row, soft_wrap=True)
    for line in table.doubts():
        console.print(f"{MARK} {line}", style="yellow")
    if mixed := table.mixed():
        console.print(mixed)
    for line in table.verdict():
        console.print(line, style="bold")


def print_case(case: Case) -> None:
    """Print the description of a case, and each input that was not read in a source."""
    console = PlainConsole()
    warnings = (f"Warning: {text}" for text in case.warnings)
    for paragraph in filter(None, (case.title, case.description, *reservations(case), *warnings)):
        console.print(f"{paragraph}\n")
    for path, number in doubtful_inputs(case).items():
        console.print(f"{number.status:<11} {path} = {number.written}", soft_wrap=True)
        console.print(f"{'':<11} {number.source}", soft_wrap=True)


class PlainConsole(Console):
    """A console that prints text without markup, and a space for each character that may not be shown."""

    def __init__(self, *, stderr: bool = False) -> None:
        super().__init__(markup=False, highlight=False, emoji=False, stderr=stderr)

    def print(self, *objects: Any, **more: Any) -> None:
        super().print(*map(_shown, objects), **more)


def _shown(it: Any) -> Any:
    """Return text with its unprintable characters replaced, and anything else as it is."""
    if isinstance(it, Text):
        it.plain = printable(it.plain, keep="\n")
    return printable(it, keep="\n") if isinstance(it, str) else it


def _shortened(text: str, case: Case, width: int) -> str:
    """Return about two lines of a warning, and the command that prints the whole warning."""
    return textwrap.shorten(text, 2 * width - 20, placeholder=f" ... (proprotor cases {case.name})")
