"""Variables of a file of MATLAB, versions 5 to 7 ("Level 5"): numbers, text, cells, structs and sparse matrices.

The package has a reader of its own. SciPy's reader (`scipy.io.loadmat` of 1.17), with which the tests compare, ends the
process without a message at some damaged files. The format is published by The MathWorks, "MAT-File Format".
"""

from __future__ import annotations

import math
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np

from proprotor.typing import Array

_HEAD = 128  # bytes before the first variable
_ORDERS = {b"IM": "<", b"MI": ">"}
_NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
_ENCODINGS = {2: "latin-1", 4: "utf-16", 16: "utf-8", 17: "utf-16", 18: "utf-32"}
_MATRIX, _COMPRESSED = 14, 15
_CELL, _STRUCT, _TEXT, _SPARSE, _NUMERIC = 1, 2, 4, 5, range(6, 16)  # classes of arrays
_COMPLEX = 0x0800  # flag of an array
_DEEPEST = 12  # arrays within arrays
_MOST = 100_000  # entries of a cell array or a struct
_LARGEST = 500_000_000  # bytes of a variable, unpacked


class MatlabFault(Exception):
    """Fault of a file, as the end of a sentence."""


_DAMAGED = MatlabFault("is damaged: a variable does not have the size that it says")


@dataclass
class _Bytes:
    """Bytes of elements, one after another."""

    content: memoryview
    order: str
    place: int = 0

    def take(self, count: int) -> memoryview:
        """Return the next bytes."""
        if not 0 <= count <= len(self.content) - self.place:
            raise _DAMAGED
        self.place += count
        return self.content[self.place - count : self.place]

    def element(self) -> tuple[int, memoryview]:
        """Return type and content of the next element; four bytes or fewer stand in its tag."""
        tag = self.take(8)
        kind, size = (int(word) for word in np.frombuffer(tag, f"{self.order}u4"))
        if kind >> 16:
            if kind >> 16 > 4:
                raise _DAMAGED
            return kind & 0xFFFF, tag[4 : 4 + (kind >> 16)]
        content = self.take(size)
        if kind != _COMPRESSED:
            self.take(min(-size % 8, len(self.content) - self.place))
        return kind, content

    def numbers(self) -> Array:
        """Return the numbers of the next element."""
        kind, content = self.element()
        if kind not in _NUMBERS or len(content) % int(_NUMBERS[kind][1]):
            raise _DAMAGED
        return np.frombuffer(content, self.order + _NUMBERS[kind])

    @property
    def has_more(self) -> bool:
        """Whether an element follows."""
        return self.place < len(self.content)


def variables_of(content: bytes) -> dict[str, Any]:
    """Return the variables of a file by name.

    Returns
    -------
    dict
        Arrays (rows, columns), sparse matrices, text as a list of rows, a cell array as a list, a struct as a
        dictionary; None for other things.

    Raises
    ------
    MatlabFault
        When the file is damaged, of another version or too large.
    """
    order = _ORDERS.get(content[_HEAD - 2 : _HEAD])
    if order is None:
        raise MatlabFault("is damaged, or another kind of file: save it with save(name, ..., '-v7')")
    elements, found = _Bytes(memoryview(content)[_HEAD:], order), {}
    while elements.has_more:
        kind, inner = elements.element()
        if kind == _COMPRESSED:
            kind, inner = _Bytes(_unpacked(inner), order).element()
        if kind == _MATRIX:
            name, value = _array(_Bytes(inner, order), 0)
            found[name] = value
    return found


def _unpacked(content: memoryview) -> memoryview:
    """Return the content of a compressed element."""
    try:
        whole = zlib.decompressobj().decompress(content, _LARGEST + 1)
    except zlib.error:
        raise _DAMAGED from None
    if len(whole) > _LARGEST:
        raise MatlabFault(f"must not hold a variable of more than {_LARGEST // 10**6} MB")
    return memoryview(whole)


def _array(parts: _Bytes, depth: int) -> tuple[str, Any]:
    """Return name and value of an array."""
    if not parts.has_more:  # an empty entry of a cell array or a struct
        return "", np.zeros((0, 0))
    flags, sizes = parts.numbers(), parts.numbers()
    name = bytes(parts.element()[1]).decode("latin-1")
    if not len(flags) or len(sizes) < 2 or (sizes < 0).any() or depth > _DEEPEST:
        raise _DAMAGED
    shape = tuple(int(size) for size in sizes)
    kind, is_complex = int(flags[0]) & 0xFF, bool(int(flags[0]) & _COMPLEX)
    if kind in _NUMERIC:
        return name, _numeric(parts, shape, is_complex)
    read = {_CELL: _cells, _STRUCT: _struct, _TEXT: _text, _SPARSE: _sparse}.get(kind)
    return name, read(parts, shape, depth) if read else None


def _numeric(parts: _Bytes, shape: tuple[int, ...], is_complex: bool) -> Array:
    """Return numbers; MATLAB keeps them in as few bytes as hold them."""
    values = parts.numbers()
    if is_complex:
        imaginary = parts.numbers()
        if len(imaginary) != len(values):
            raise _DAMAGED
        values = values + 1j * imaginary
    if len(values) != math.prod(shape):
        raise _DAMAGED
    native = values.astype(values.dtype.newbyteorder("="))
    return native.reshape(shape, order="F")


def _text(parts: _Bytes, shape: tuple[int, ...], depth: int) -> list[str]:
    """Return text as a list of rows."""
    kind, content = parts.element()
    encoding = _ENCODINGS.get(kind)
    if encoding is None or len(shape) != 2:
        raise _DAMAGED
    if encoding in ("utf-16", "utf-32"):
        encoding += "-le" if parts.order == "<" else "-be"
    letters = bytes(content).decode(encoding, "replace")
    if len(letters) != math.prod(shape):
        raise _DAMAGED
    return [letters[row :: shape[0]] for row in range(shape[0])]


def _cells(parts: _Bytes, shape: tuple[int, ...], depth: int) -> list[Any]:
    """Return the entries of a cell array, columns one after another."""
    return [_inner(parts, depth) for _ in range(_few(math.prod(shape)))]


def _struct(parts: _Bytes, shape: tuple[int, ...], depth: int) -> Any:
    """Return a struct as a dictionary; a list of them for an array of structs."""
    lengths, names = parts.numbers(), bytes(parts.element()[1])
    if len(lengths) != 1 or int(lengths[0]) < 1 or len(names) % int(lengths[0]):
        raise _DAMAGED
    step = int(lengths[0])
    fields = [names[k : k + step].split(b"\0")[0].decode("latin-1") for k in range(0, len(names), step)]
    _few(math.prod(shape) * len(fields))
    found = [{name: _inner(parts, depth) for name in fields} for _ in range(_few(math.prod(shape)))]
    return found[0] if len(found) == 1 else found


def _sparse(parts: _Bytes, shape: tuple[int, ...], depth: int) -> Any:
    """Return a sparse matrix of real numbers."""
    from scipy.sparse import csc_array

    rows, starts, values = parts.numbers(), parts.numbers(), parts.numbers()
    if len(shape) != 2 or len(starts) != shape[1] + 1 or starts[0] != 0 or (np.diff(starts) < 0).any():
        raise _DAMAGED
    count = int(starts[-1])
    if not count <= min(len(rows), len(values)):
        raise _DAMAGED
    rows, values = rows[:count].astype(np.int64), values[:count].astype(float)
    if ((rows < 0) | (rows >= shape[0])).any():
        raise _DAMAGED
    matrix = csc_array((values, rows, starts.astype(np.int64)), shape=shape)
    matrix.sum_duplicates()
    return matrix


def _inner(parts: _Bytes, depth: int) -> Any:
    """Return an array within another one."""
    kind, content = parts.element()
    if kind != _MATRIX:
        raise _DAMAGED
    return _array(_Bytes(content, parts.order), depth + 1)[1]


def _few(count: int) -> int:
    """Return a number of entries, unless there are more than a support can have."""
    if count > _MOST:
        raise MatlabFault(f"must not have a cell array or a struct of more than {_MOST} entries")
    return count
