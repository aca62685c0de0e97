"""What a stability boundary and its derivatives cost, and how good they are.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.flutter_cost

An eigen-solve is one airspeed linearised (trim included) and all its eigenvalues and vectors. The derivatives of a
boundary take one more eigen-solve, for the vectors, and one batch of models a complex step away, one for each input.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from proprotor.design import design_inputs
from proprotor.flutter import find_crossings, flutter_point
from proprotor.modes import decomposition
from proprotor.path import Line
from proprotor.sensitivity import at_boundary
from proprotor.speed import KNOT

SCANS = (2, 5, 10, 20, 40)  # kt
REPEATS = 15


def crossings(console: Console, case: pp.Case) -> None:
    """Eigen-solves for each boundary, by how wide the scan brackets it."""
    table = Table("scan, kt", "boundary, kt", "mode", "eigen-solves to bracket all", "and for this boundary")
    for step in SCANS:
        found = flutter_point(case, np.arange(50, 400.1, step) * KNOT)
        for boundary in found.boundaries:
            table.add_row(
                str(step),
                f"{boundary.position / KNOT:.9f}",
                boundary.mode,
                str(found.scan_solves),
                str(boundary.eigen_solves),
            )
    console.print(table)


def one_bracket(console: Console, case: pp.Case) -> None:
    """Eigen-solves beyond the ends of a bracket that holds one boundary, by how wide it is."""
    line = np.array([-0.5, 0.5])
    centre = 373.0
    for width in (5, 10, 20, 40):
        ends = (centre + width * line) * KNOT
        found = find_crossings(Line(ends, lambda speed: case.linearize(speed)))
        boundary = next(b for b in found.boundaries if b.onset)
        beyond = found.eigen_solves - len(ends)
        console.print(
            f"bracket of {width} kt: {boundary.position / KNOT:.9f} kt, {beyond} eigen-solves beyond its ends, "
            f"of them {boundary.eigen_solves} of Newton's method"
        )


def derivatives(console: Console, case: pp.Case) -> None:
    """Time of all derivatives of a boundary, in eigen-solves."""
    found = flutter_point(case, np.arange(350, 390.1, 5) * KNOT)
    boundary = next(b for b in found.boundaries if b.onset)
    inputs = design_inputs(case)
    solve = fastest(lambda: decomposition(case.linearize(boundary.position)).all_modes)
    every = fastest(lambda: at_boundary(case, boundary, inputs, {}))
    console.print(
        f"one eigen-solve {1e3 * solve:.2f} ms; all {len(inputs)} derivatives of the boundary {1e3 * every:.2f} ms: "
        f"{every / solve:.2f} eigen-solves"
    )
    numbers = {path: float(number.si) for path, number in inputs.items()}
    each = np.eye(len(numbers))
    varied = {path: value + 1e-30j * each[k] for k, (path, value) in enumerate(numbers.items())}
    batch = fastest(lambda: case.vary(varied).linearize(boundary.position))
    console.print(f"of it, {len(inputs)} models a complex step away {batch / solve:.2f}")


def fastest(work: Callable[[], object]) -> float:
    """Least processor time of some runs, s."""
    times = []
    for _ in range(REPEATS):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return min(times)


def main() -> None:
    console, case = Console(width=120), pp.load_case("xv15")
    crossings(console, case)
    one_bracket(console, case)
    derivatives(console, case)


if __name__ == "__main__":
    main()
