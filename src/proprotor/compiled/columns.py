"""Numbers of many points in memory, as the compiled functions find them: see columns.h."""

from __future__ import annotations

import ctypes
import threading
from typing import Any

import numpy as np

from proprotor.typing import Array

_WIDEST = 64  # bytes of a vector register
_MOST_KEPT = 2**20  # bytes
_FIRST_BYTE: Any = ctypes.c_char.from_buffer


class Column(ctypes.Structure):
    """Where numbers begin, and how many places lie between those of two points and of two stations."""

    _fields_ = (("at", ctypes.c_void_p), ("point", ctypes.c_ssize_t), ("along", ctypes.c_ssize_t))


def place_of(array: Array) -> tuple[int, int, int]:
    """Return where an array begins, and the strides of its last two axes as of `Column`.

    Arrays of floats (along,), (points, along) and (1, along) are columns.
    """
    strides = [
        stride // array.itemsize if size > 1 else 0
        for stride, size in zip(array.strides, array.shape, strict=True)
    ]
    point, along = [0, 0, *strides][-2:]
    return array.__array_interface__["data"][0], point, along


def column(value: Any, kept: list[Array]) -> Column:
    """Return a number, or an array as of `place_of`, as a column; `kept` keeps it in memory."""
    array = np.asarray(value, dtype=float)
    kept.append(array)
    return Column(*place_of(array))


def start_of(array: Array) -> int:
    """Return where an array begins, as a number.

    The buffer of an array tells that in a quarter of the time that NumPy takes, which counts for a single point.
    """
    try:
        return ctypes.addressof(_FIRST_BYTE(array))
    except (TypeError, ValueError, BufferError):  # not for writing, empty, or with gaps
        return int(array.__array_interface__["data"][0])


def address(array: Array) -> Any:
    """Return where an array begins, as an argument of a function of the library."""
    return ctypes.c_void_p(start_of(array))


class _Own(threading.local):
    """Memory of each thread."""

    def __init__(self) -> None:
        self.memory = np.empty(0, dtype=np.uint8)


_OWN = _Own()


def lane_room(vectors: int) -> Array:
    """Return memory for vectors of lanes, at a place where they may begin, until the thread asks again.

    The caller holds the array for as long as its address is in use: an address alone does not keep much memory.
    A few vectors have the same place each time: to get new memory takes longer than most calls.
    """
    size = (vectors + 1) * _WIDEST
    memory = _OWN.memory
    if size > len(memory):
        memory = np.empty(size, dtype=np.uint8)
        if size <= _MOST_KEPT:
            _OWN.memory = memory
    start = -start_of(memory) % _WIDEST
    return memory[start:]
