"""Tasks whose time is compared between two versions of the package, in a process of its own for each version.

    python -m benchmarks.speed_tasks

The process reads names of tasks from its input, and answers each with the processor time of one call in seconds, or
with the peak memory in MB.
"""

from __future__ import annotations

import resource
import sys
import time
from collections.abc import Callable

import numpy as np

import proprotor as pp
from proprotor.model.first_order import state_matrix
from proprotor.stability.modes import eigenvalues

KNOT = 1852 / 3600
SCAN = np.linspace(50, 400, 71) * KNOT  # m/s
COMPILED_TASK = "{}, compiled"
COMPILED = tuple(
    map(COMPILED_TASK.format, ("flutter_point", "sweep", "one point"))
)  # an earlier version has none
POINTS = 2000  # of a batch: as many as a study analyses at once


def tasks() -> dict[str, Callable[[], object]]:
    """What is timed."""
    case = pp.load_case("xv15-uncoupled")
    eight = pp.load_case("xv15-uncoupled", {"rotor.n_blades": "8", "support.includes_rotor": "false"})
    batch = np.linspace(160, 380, POINTS) * KNOT

    reactionless = eight.linearize(np.linspace(160, 380, 50) * KNOT, reactionless=True)
    compiled = {"backend": "compiled"}
    flutter, sweep, one = COMPILED
    return {
        flutter: lambda: case.flutter_point(SCAN, **compiled),
        sweep: lambda: case.sweep(SCAN, **compiled),
        one: lambda: state_matrix(case.linearize(150.0, **compiled)),
        "flutter_point": lambda: case.flutter_point(SCAN),
        "sweep": lambda: case.sweep(SCAN),
        "one point": lambda: state_matrix(case.linearize(150.0)),
        "reactionless": lambda: eigenvalues(reactionless),
        "memory": lambda: state_matrix(case.linearize(batch)),
    }


def main() -> None:
    """Answer names until there are no more."""
    known = tasks()
    for line in sys.stdin:
        name = line.strip()
        if name == "peak memory":
            print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024, flush=True)
            continue
        start = time.process_time()
        known[name]()
        print(time.process_time() - start, flush=True)


if __name__ == "__main__":
    main()
