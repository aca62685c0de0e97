"""What one move of a slider of `proprotor explore` costs its server, and whether the server grows.

OPENBLAS_NUM_THREADS=1 python -m benchmarks.explore [--moves 200] [--backend compiled] [--case xv15] [--points 60]

Processor time, which other programs on the machine do not count in; the browser draws on another core
(`benchmarks.explore_browser`). Sliders are moved at random, one at a time, and stay where they are. Moves to what is
not physical are counted, and not timed. Memory is that of the whole process.
"""

from __future__ import annotations

import argparse
import time
from typing import Any

import numpy as np
import psutil
from bokeh.document import Document
from bokeh.protocol import Protocol

import proprotor as pp
from proprotor.explore.page import ExplorePage
from proprotor.rotor.options import CHOICES, Options
from proprotor.stability.boundaries import scan_speeds

_STAGES = ("curves", "their transfer", "map", "its transfer", "curves, sent", "map, sent")


def _sent(events: list[Any]) -> int:
    """Make the message with all changes of the page, and return its size in bytes."""
    changes = [one for one in events if "Session" not in type(one).__name__]
    events.clear()
    message = Protocol().create("PATCH-DOC", changes)
    return len(message.content_json) + sum(len(part.to_bytes()) for part in message.buffers)


def timed_moves(
    page: ExplorePage, moves: int, seed: int = 1
) -> tuple[dict[str, list[float]], list[int], int]:
    """Milliseconds of each stage, move by move; the bytes sent on the last; how many moves were not physical."""
    document = Document()
    page.put_on(document)
    page.map.draw()
    events: list[Any] = []
    document.on_change(events.append)
    random = np.random.default_rng(seed)
    sliders = list(page.inputs.sliders.values())
    spent: dict[str, list[float]] = {stage: [] for stage in _STAGES}
    refused, sizes = 0, [0, 0]
    for move in range(moves):
        slider = sliders[random.integers(len(sliders))]
        slider.value = random.uniform(slider.start, slider.end)
        events.clear()
        marks = [time.process_time()]
        page.update()
        marks.append(time.process_time())
        if "Cannot be" in page.message.text:
            refused += 1
            page._reset()
            continue
        sizes[0] = _sent(events)
        marks.append(time.process_time())
        page.map.draw()
        marks.append(time.process_time())
        sizes[1] = _sent(events)
        marks.append(time.process_time())
        curves, sent, drawn, all_sent = 1e3 * np.diff(marks)
        row = (curves, sent, drawn, all_sent, curves + sent, drawn + all_sent)
        for stage, took in zip(_STAGES, row, strict=True):
            spent[stage].append(took)
        if move % max(1, moves // 10) == 0:
            print(f"{move:>8} moves {psutil.Process().memory_info().rss / 1e6:>8.1f} MB", flush=True)
    return spent, sizes, refused


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--moves", type=int, default=200)
    parser.add_argument("--points", type=int, default=60)
    parser.add_argument("--backend", default="compiled")
    parser.add_argument("--grid", default="usual")
    parser.add_argument("--case", default="xv15-uncoupled")
    given = parser.parse_args()
    case = pp.load_case(given.case)
    own = vars(Options(backend=given.backend))
    options = case.model_options({name: own[name] for name in (*CHOICES, "locked")})
    page = ExplorePage(case, given.case, scan_speeds(case, given.points), {}, options)
    page.map.grid.value = given.grid
    spent, sizes, refused = timed_moves(page, given.moves)
    done = len(spent["map"])
    what = f"{given.points} airspeeds, {given.grid} map"
    print(f"{given.case}, {given.backend}: {done} moves, {what}, {refused} not physical")
    print(f"{'':<16}{'median':>8}{'95 %':>8}  ms of processor time")
    for stage, times in spent.items():
        print(f"{stage:<16}{np.median(times):>8.1f}{np.percentile(times, 95):>8.1f}")
    print(f"{sizes[0] / 1024:.0f} kB of curves and {sizes[1] / 1024:.0f} kB of the map sent on each")


if __name__ == "__main__":
    main()
