"""What studies cost, by NumPy and by compiled functions: writes the table in docs/studies.md.

    python -m benchmarks.study_table [points]         # prints the table
    python -m benchmarks.study_table [points] --page  # and writes it into the page

All times are processor times of one process with one BLAS thread, the best of several turns in which everything takes
its turn, as ratios to LAPACK's eigenvalues of the same matrices in the same run. The interpreter is free while compiled
functions run; the share of that time says what threads in one process could be worth at most.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from importlib import import_module
from typing import Any
from unittest import mock

import numpy as np

import proprotor as pp
from benchmarks.page_table import write_table
from benchmarks.study import POINTS, SPEEDS, best, lines, matrices, plan
from proprotor.compiled.library import library, why_not
from proprotor.study.study import study
from proprotor.study.variables import DEFAULT_QUANTITIES

MARK = "python -m benchmarks.study_table --page"
CALLERS = ("eigenvalues", "plans", "motion", "bounds", "shapes")  # of the library, in `proprotor.compiled`
VECTORS = (*DEFAULT_QUANTITIES, "vectors")


class Watched:
    """The library of compiled functions, with the processor time that its functions take."""

    def __init__(self) -> None:
        self.spent, self._library = 0.0, library()

    def __getattr__(self, name: str) -> Callable[..., Any]:
        function = getattr(self._library, name)

        def run(*arguments: Any) -> Any:
            begin = time.process_time()
            try:
                return function(*arguments)
            finally:
                self.spent += time.process_time() - begin

        return run


@contextmanager
def watched() -> Iterator[Watched]:
    """Watch the library while the block runs."""
    found = Watched()
    with ExitStack() as patches:
        for name in CALLERS:
            module = import_module(f"proprotor.compiled.{name}")
            patches.enter_context(mock.patch.object(module, "library", lambda: found))
        yield found


def free_share(work: Callable[[], object]) -> float:
    """Return the share of the processor time of some work in which the interpreter is free."""
    with watched() as found:
        begin = time.process_time()
        work()
        return found.spent / (time.process_time() - begin)


def studies(case: pp.Case, points: int, backend: str) -> dict[str, Callable[[], object]]:
    """Return the studies of the rows of the table."""
    own = {"workers": 1, "progress": False, "backend": backend}
    along = lines(points)
    return {
        "eigenvalues, least stable mode and trim": lambda: study(case, plan(points), **own),
        "with mode shapes": lambda: study(case, plan(points), quantities=VECTORS, **own),
        "with modes followed and named": lambda: study(case, *along, quantities=(*VECTORS, "modes"), **own),
        f"flutter speeds, {SPEEDS.size} airspeeds a design": lambda: study(case, *along, "flutter", **own),
    }


def table(points: int) -> list[str]:
    """Return the lines of the table."""
    case = pp.load_case("xv15-uncoupled")
    state = matrices(case, points)
    by_numpy, compiled = (studies(case, points, backend) for backend in ("numpy", "compiled"))
    works = [lambda: np.linalg.eigvals(state), *by_numpy.values(), *compiled.values()]
    one, *times = best(*((work, time.process_time) for work in works))
    free = [free_share(work) for work in compiled.values()]
    rows = zip(by_numpy, times[: len(by_numpy)], times[len(by_numpy) :], free, strict=True)
    return [
        "| a point of a study | by NumPy | compiled | of it, the interpreter is free |",
        "|---|---|---|---|",
        *(
            f"| {name} | {slow / one:.2f} | {fast / one:.2f} | {100 * share:.0f} % |"
            for name, slow, fast, share in rows
        ),
        "",
        f"In units of LAPACK's eigenvalues of one matrix, {1e6 * one / points:.0f} µs here; {points:,} points of the "
        f"XV-15, one process, load of the machine {os.getloadavg()[0]:.1f}.",
    ]


def main() -> None:
    """Print the table, and write it; a second start of the program has one BLAS thread."""
    if os.environ.get("OPENBLAS_NUM_THREADS") != "1":
        environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
        os.execve(
            sys.executable, [sys.executable, "-m", "benchmarks.study_table", *sys.argv[1:]], environment
        )
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("points", type=int, nargs="?", default=POINTS)
    parser.add_argument("--page", action="store_true", help="write the table into docs/studies.md")
    given = parser.parse_args()
    if why_not():
        sys.exit(f"there are no compiled functions: {why_not()}")
    found = table(given.points)
    print("\n".join(found))
    if given.page:
        write_table("studies.md", MARK, found)


if __name__ == "__main__":
    main()
