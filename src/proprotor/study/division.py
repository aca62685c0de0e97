"""How a study is divided into batches: points analysed at once, and the memory that they take."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from proprotor.needs import check_memory, free_memory
from proprotor.study.designs import check_count
from proprotor.study.variables import ALONG_AIRSPEEDS
from proprotor.study.workers import cores, threads_of

if TYPE_CHECKING:
    from distributed import Client

    from proprotor.study.request import Request

_MOST_POINTS = 2500  # of a batch: enough for the cost of NumPy itself to vanish; many more leave the cache
_MOST_SEARCHED = 10_000  # of a batch of searches, which solve a part of their points at a time
_FEWEST_POINTS = 50
_BYTES_PER_POINT = 100_000  # while a batch is analysed; the XV-15 takes 30 kB, 46 kB with vectors
_BYTES_PER_WORKER = 150e6  # of a process with NumPy, SciPy and a case
_SHARE_OF_MEMORY = 0.25  # of the free memory, for the batches of all processes together

Block = tuple[slice, slice]  # designs and airspeeds of a batch


def blocks_of(request: Request, points: int) -> list[Block]:
    """Return the designs and airspeeds of each batch of about so many points."""
    designs, speeds = request.shape
    whole_lines = bool(set(ALONG_AIRSPEEDS) & set(request.analysis.quantities))
    columns = [slice(0, speeds)] if speeds <= points or whole_lines else _slices(speeds, points)
    width = columns[0].stop
    return [(rows, some) for rows in _slices(designs, max(1, points // width)) for some in columns]


def _slices(size: int, width: int) -> list[slice]:
    return [slice(start, min(start + width, size)) for start in range(0, size, width)]


def check_needs(request: Request, batch: int | None, workers: int | None, client: Client | None) -> None:
    """Refuse results, batches and workers that do not fit into memory.

    Raises
    ------
    InputError
        For results, a batch or workers that are too large or too many, or no whole numbers above zero.
    """
    for name, count in (("batch", batch), ("workers", workers)):
        if count is not None:
            check_count(name, count)
    designs, speeds = request.shape
    given = f"{designs} designs at {speeds} airspeeds"
    check_memory("inputs", given, request.size, "the results", "take fewer, or fewer quantities")
    if client is not None:  # whose computers have memory of their own
        return
    at_once = min(batch or 1, designs * speeds)
    processes = min(workers or 1, -(-designs * speeds // at_once))
    if processes > 1:
        check_memory("workers", workers, _BYTES_PER_WORKER * processes, f"{processes} processes")
    check_memory("batch", batch, _BYTES_PER_POINT * at_once * processes, "the batches of all workers")


def points_at_once(request: Request, workers: int | None, client: Client | None) -> int:
    """Return the points of a batch: the batches of all workers fit into memory and come out even.

    A search for flutter speeds solves its scan in parts, so that more designs fit into the same memory, and the few
    points with vectors of all these designs at once, which cost the less the more they are.
    """
    if client is not None:
        workers, most = threads_of(client), _MOST_POINTS
    else:
        workers = workers or cores()
        fitting = _SHARE_OF_MEMORY * free_memory() / workers / _BYTES_PER_POINT
        most = int(np.clip(fitting, _FEWEST_POINTS, _MOST_POINTS))
    if most == _MOST_POINTS and set(request.analysis.quantities) == {"flutter"}:
        most = _MOST_SEARCHED
    points = int(np.prod(request.shape))
    rounds = -(-points // (most * workers))
    return -(-points // (rounds * workers))
