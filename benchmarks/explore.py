"""What one move of a slider of `proprotor explore` costs.

OPENBLAS_NUM_THREADS=1 python -m benchmarks.explore [--moves 200]

Processor time of the server, which other programs on the machine do not count in; the browser draws on another core.
Sliders are moved at random, one at a time, and stay where they are. Moves to what is not physical are counted, and
not timed.
"""

from __future__ import annotations

import argparse
import time

import numpy as np
from bokeh.document import Document
from bokeh.protocol import Protocol

import proprotor as pp
from proprotor.errors import InputError
from proprotor.explore.analysis import live_modes
from proprotor.explore.curves import curves, ends
from proprotor.explore.inputs import first_inputs, slider_input
from proprotor.explore.page import ExplorePage, messages, readout
from proprotor.rotor.options import CHOICES, default_choice
from proprotor.stability.boundaries import scan_speeds
from proprotor.units import KNOT

_POINTS = 60
_STAGES = ("analysis", "drawing data", "transfer", "all")


def timed_moves(moves: int, seed: int = 1) -> tuple[dict[str, list[float]], int, int]:
    """Milliseconds of each stage, move by move; bytes of the last transfer; and how many moves were not physical."""
    case = pp.load_case("xv15-uncoupled")
    speeds = scan_speeds(case, _POINTS)
    options = {name: default_choice(name, {}) for name in CHOICES}
    page, document = ExplorePage(case, "xv15-uncoupled", speeds, {}, options), Document()
    page.put_on(document)
    events: list[object] = []
    document.on_change(events.append)
    random, values = np.random.default_rng(seed), {}
    sliders = [slider_input(case, path) for path in first_inputs(case)]
    spent: dict[str, list[float]] = {stage: [] for stage in _STAGES}
    refused = size = 0
    for _ in range(moves):
        slider = sliders[random.integers(len(sliders))]
        values[slider.path] = random.uniform(slider.low, slider.high) * slider.factor
        start = time.process_time()
        try:
            found = live_modes(case, speeds, values, **options)
        except InputError:
            refused += 1
            values.pop(slider.path)
            continue
        analysed = time.process_time()
        columns = curves(found, float(case.operation.rotor_speed), KNOT)
        dots, told = ends(columns), (readout(found, values, page.inputs), messages(found))
        drawn = time.process_time()
        events.clear()
        page.lines.data, page.dots.data = columns, dots
        page.readout.text, page.message.text = told
        message = Protocol().create("PATCH-DOC", list(events))
        size = len(message.content_json) + sum(len(part.to_bytes()) for part in message.buffers)
        sent = time.process_time()
        marks = (start, analysed, drawn, sent)
        for stage, first, last in zip(_STAGES, marks[:-1] + marks[:1], marks[1:] + marks[-1:], strict=True):
            spent[stage].append(1e3 * (last - first))
    return spent, size, refused


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--moves", type=int, default=200)
    spent, size, refused = timed_moves(parser.parse_args().moves)
    print(f"{len(spent['all'])} moves of a {_POINTS}-point sweep of the XV-15, {refused} not physical")
    print(f"{'':<14}{'median':>8}{'95 %':>8}  ms of processor time")
    for stage, times in spent.items():
        print(f"{stage:<14}{np.median(times):>8.1f}{np.percentile(times, 95):>8.1f}")
    print(f"{size / 1024:.0f} kB sent to the browser on each")


if __name__ == "__main__":
    main()
