"""The parts of a report, the same for every layout."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar


@dataclass(frozen=True)
class Text:
    """Paragraphs; a layout sets warnings apart."""

    kind: ClassVar[str] = "text"
    paragraphs: tuple[str, ...]
    warning: bool = False


@dataclass(frozen=True)
class Table:
    """A table; the first column names the rows.

    Attributes
    ----------
    caption : str
    columns : tuple of str
    rows : tuple of tuple of str
        A cell for each column.
    numbers : frozenset of str
        Columns of numbers, which a layout aligns to the right.
    """

    kind: ClassVar[str] = "table"
    caption: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numbers: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Picture:
    """A plot with its caption, drawn in the form that a layout asks for.

    Attributes
    ----------
    name, caption : str
    alt : str
        A description for readers who cannot see the plot.
    draw : callable
        Returns the plot as a file of the form "svg" or "png".
    share : float
        Share of the width of a sheet.
    """

    kind: ClassVar[str] = "picture"
    name: str
    caption: str
    alt: str
    draw: Callable[[str], bytes]
    share: float = 1.0

    @cached_property
    def svg(self) -> bytes:
        """The plot as lines, for a page."""
        return self.draw("svg")

    @cached_property
    def png(self) -> bytes:
        """The plot as dots, for text processors, which cannot read lines."""
        return self.draw("png")


@dataclass(frozen=True)
class Section:
    """A heading and the blocks below the heading."""

    title: str
    blocks: tuple[Text | Table | Picture, ...]

    @property
    def anchor(self) -> str:
        """The name to which a link to the section points."""
        return "-".join("".join(c if c.isalnum() else " " for c in self.title.lower()).split())


@dataclass(frozen=True)
class Document:
    """A whole report.

    Attributes
    ----------
    title, subtitle : str
    date : str
        ISO 8601.
    verdict : tuple of str
        Sentences on the results.
    caution : tuple of str
        Reservations about the results, a sentence each.
    summary : tuple of Text and Table
        What else stands on the first page.
    sections : tuple of Section
        What stands on the further pages.
    """

    title: str
    subtitle: str
    date: str
    verdict: tuple[str, ...]
    caution: tuple[str, ...]
    summary: tuple[Text | Table, ...]
    sections: tuple[Section, ...]
