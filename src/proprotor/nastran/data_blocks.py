"""Records of the data blocks of a binary file, as the module OUTPUT2 of Nastran writes them (.op2).

A file is a chain of Fortran records. A record of one word is a marker: a positive one comes before a record of data, a
negative one begins the next record of a data block, and zero ends the block. A file may begin with a block of a date
and a label (PARAM,POST,-1), which each program and version writes in its own way and which says nothing about the rest,
or without one (PARAM,POST,-2). Words have 4 or 8 bytes, in either byte order, as the length of the first marker shows.

The layout is that of the DMAP guides of MSC and Siemens, chapter "OUTPUT2".
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from typing import BinaryIO, Literal, NamedTuple

import numpy as np

from proprotor.nastran.found import FileFault
from proprotor.typing import Array

_LENGTH = 4  # bytes of the length before and after each Fortran record, also where words have 8
_NAME, _BEFORE_CONTENT = 0, 2  # places of records in a block: name, trailer, heading, then content
_CHARACTERS = 4  # of text in a word, also where words have 8 bytes


class Record(NamedTuple):
    """A record of a data block: the name and the place of the block in the file, and the words of the record."""

    name: str
    block: int
    content: bytes
    order: str
    width: int

    def integers(self, first: int = 0, last: int | None = None) -> Array:
        """Return words as whole numbers."""
        return self._words(f"{self.order}i{self.width}", first, last)

    def reals(self, first: int = 0, last: int | None = None) -> Array:
        """Return words as real numbers."""
        return self._words(f"{self.order}f{self.width}", first, last)

    def text(self, first: int, last: int) -> str:
        """Return words as text."""
        return _text(self.content, self.width, first, last)

    @property
    def words(self) -> int:
        """Return the number of words."""
        return len(self.content) // self.width

    def _words(self, kind: str, first: int, last: int | None) -> Array:
        """Return words of a kind; bytes that make no whole word at the end are left out."""
        whole = self.content[: self.words * self.width]
        return np.frombuffer(whole, dtype=kind)[first:last]


def records(file: BinaryIO, size: int, wanted: Callable[[str], bool]) -> Iterator[Record]:
    """Yield the records of the data blocks whose names are wanted; other blocks are passed over unread.

    Parameters
    ----------
    file : binary file
        At its beginning.
    size : int
        Bytes of the file.
    wanted : callable

    Raises
    ------
    FileFault
        When the file does not begin with a marker, or its chain of records breaks or ends early.
    """
    chain = _Chain(file, size)
    block = 0
    while not chain.at_end():
        name, keep = "", False
        for place in itertools.count():
            parts, goes_on = chain.record(keep or place == _NAME)
            if place == _NAME and parts:  # words of a version may follow the name
                name = chain.block = _name(parts[0], chain.width)
            content = b"".join(parts[1:])  # the first word says of which type the record is
            if keep and content:
                yield Record(name, block, content, chain.order, chain.width)
            if not goes_on:
                break
            keep = place >= _BEFORE_CONTENT and wanted(name)
        block += 1


def _name(content: bytes, width: int) -> str:
    """Return the name of a block, two words; empty for the date at the beginning of a file."""
    return _text(content, width, 0, 2) if len(content) == 2 * width else ""


def _text(content: bytes, width: int, first: int, last: int) -> str:
    """Return words of a record as text, four characters each."""
    words = [content[place * width : place * width + _CHARACTERS] for place in range(first, last)]
    return b"".join(words).decode("latin-1").rstrip("\x00 ")


class _Chain:
    """The chain of Fortran records of an open file."""

    def __init__(self, file: BinaryIO, size: int) -> None:
        self._file, self._size, self._at = file, size, 0
        self.block = ""
        self.order, self.width = self._form()

    def at_end(self) -> bool:
        """Return whether nothing follows; some programs leave out the last zero."""
        return self._at >= self._size

    def record(self, keep: bool) -> tuple[list[bytes], bool]:
        """Return the parts of a record up to the marker that ends it, and whether the block goes on."""
        parts = []
        while (marker := self._marker()) > 0:
            parts.append(self._data(keep))
        return parts, marker < 0

    def _marker(self) -> int:
        """Return the next marker."""
        if self.at_end():
            raise FileFault(self._cut_off())
        content = self._data(True)
        if len(content) != self.width:
            raise FileFault(f"is damaged{self._where()}: a record of {len(content)} bytes is no marker")
        return int.from_bytes(content, _endian(self.order), signed=True)

    def _data(self, keep: bool) -> bytes:
        """Return the next Fortran record, or pass over it unread."""
        length = self._length()
        if length < 0 or self._at + length + _LENGTH > self._size:
            raise FileFault(self._cut_off())
        content = self._file.read(length) if keep else b""
        if not keep:
            self._file.seek(length, 1)
        self._at += length
        if self._length() != length:
            raise FileFault(f"is damaged{self._where()}: the lengths around a record differ")
        return content

    def _length(self) -> int:
        """Return the number of bytes that stands before and after a record."""
        self._at += _LENGTH
        return int.from_bytes(self._file.read(_LENGTH), _endian(self.order), signed=True)

    def _form(self) -> tuple[str, int]:
        """Return byte order and bytes of a word, which the length of the first marker shows."""
        first = self._file.read(_LENGTH)
        self._file.seek(0)
        for order in "<>":
            if len(first) == _LENGTH and int.from_bytes(first, _endian(order)) in (4, 8):
                return order, int.from_bytes(first, _endian(order))
        raise FileFault("is no .op2 file: it does not begin with a marker")

    def _cut_off(self) -> str:
        """Return the fault of a file that ends early."""
        return f"ends early{self._where()}: the run or a copy of the file was cut off"

    def _where(self) -> str:
        """Return the place of a fault."""
        return f" in the table {self.block}" if self.block else ""


def _endian(order: str) -> Literal["little", "big"]:
    """Return the name of a byte order."""
    return "little" if order == "<" else "big"
