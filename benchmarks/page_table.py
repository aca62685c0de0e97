"""Puts what benchmarks find into pages of the documentation, as tables between two marks.

A mark is a comment that names the command which writes the table. Where a command writes several tables of a page, the
name of the table follows:

    <!-- python -m benchmarks.linkages --page -->
    <!-- python -m benchmarks.xv15_switches --page: switches -->
    <!-- end of the table -->
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from rich.table import Table

from proprotor.files.output import write_whole

DOCS = Path(__file__).resolve().parents[1] / "docs"
END = "<!-- end of the table -->"


class PageTable(NamedTuple):
    """A table that a benchmark prints, and writes below the mark of this name in a page."""

    mark: str
    headings: tuple[str, ...]
    rows: list[tuple[str, ...]]

    def printed(self, title: str) -> Table:
        """Return the table as one of a terminal."""
        table = Table(*self.headings, title=title)
        for row in self.rows:
            table.add_row(*row)
        return table

    def write(self, page: str) -> None:
        """Put the table into a page of docs/."""
        write_table(page, self.mark, markdown(self.headings, self.rows))


def page_is_wanted(description: str) -> bool:
    """Read the command line of a benchmark and return whether its tables go into their page."""
    parser = argparse.ArgumentParser(description=description.partition("\n")[0])
    parser.add_argument("--page", action="store_true", help="write the tables into their page of docs/")
    return bool(parser.parse_args().page)


def markdown(headings: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """Return the lines of a table."""
    first, *others = (
        "|" + "|".join(f" {cell} " if cell else " " for cell in line) + "|" for line in (headings, *rows)
    )
    return [first, "|" + "---|" * len(headings), *others]


def with_table(text: str, mark: str, lines: Sequence[str]) -> str:
    """Return the text of a page with other lines between a mark and the end of its table.

    Raises
    ------
    ValueError
        If the page lacks the mark, or the end after it.
    """
    begin = f"<!-- {mark} -->"
    before, found, rest = text.partition(begin)
    _, ended, after = rest.partition(END)
    if not found or not ended:
        raise ValueError(f"the page has no place for a table: {begin} and {END}")
    return "\n".join([f"{before}{begin}", "", *lines, "", f"{END}{after}"])


def write_table(page: str, mark: str, lines: Sequence[str]) -> None:
    """Put the lines of a table after its mark into a page of docs/."""
    path = DOCS / page
    text = with_table(path.read_text(encoding="utf-8"), mark, lines).encode()
    write_whole(path, lambda file: file.write(text))
