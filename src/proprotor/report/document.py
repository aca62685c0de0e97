"""The parts of a report, the same for every layout."""

from __future__ import annotations

from dataclasses import dataclass
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
    """A plot with its caption, a description for readers who cannot see it, and its share of the width of a sheet."""

    kind: ClassVar[str] = "picture"
    name: str
    caption: str
    alt: str
    svg: bytes
    share: float = 1.0


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
    sections : tuple of Section
    """

    title: str
    subtitle: str
    date: str
    verdict: tuple[str, ...]
    caution: tuple[str, ...]
    sections: tuple[Section, ...]
