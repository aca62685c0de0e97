"""Where the time of a study of flutter speeds goes, in eigenvalue problems a design.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.flutter_parts [--backend compiled] [--rounds 5]

One eigenvalue problem is LAPACK's of one state matrix. Designs and airspeeds are those of `benchmarks/flutter_cost.py`.
Processor time, medians over rounds that take turns with LAPACK.
"""

from __future__ import annotations

import argparse
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any
from unittest.mock import patch

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks.flutter_cost import DESIGNS, SPEEDS
from benchmarks.study import INPUTS, matrices
from proprotor import sampling
from proprotor.stability import crossings, root_error
from proprotor.study import flutter_speeds
from proprotor.study.study import study

_POINTS = 2000
SCAN, EIGENVALUES, SCREENING = "scan", "eigenvalues of the scan", "screening of the steps"
EXACT, NAMES, WHOLE = "points with vectors and derivatives", "names of the modes that cross", "a design"


class _Timed:
    """Processor time of some functions by the part that they belong to, s."""

    def __init__(self) -> None:
        self.spent: dict[str, float] = defaultdict(float)

    def counting(self, function: Callable[..., Any], part: Callable[..., str]) -> Callable[..., Any]:
        """Return the function, whose time counts for the part that its arguments tell."""

        def timed(*given: Any, **named: Any) -> Any:
            begin = time.process_time()
            found = function(*given, **named)
            self.spent[part(*given, **named)] += time.process_time() - begin
            return found

        return timed

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Time the parts of studies."""

        def solved(*_: Any, plain: bool = False, **__: Any) -> str:
            return SCAN if plain else EXACT

        watched: tuple[tuple[Any, str, Callable[..., str]], ...] = (
            (crossings.Search, "solve", solved),
            (root_error, "eigenvalues", lambda *_: EIGENVALUES),
            (crossings, "screened", lambda *_, **__: SCREENING),
            (flutter_speeds, "_put_onsets", lambda *_: NAMES),
        )
        with ExitStack() as stack:
            for place, name, part in watched:
                stack.enter_context(patch.object(place, name, self.counting(getattr(place, name), part)))
            yield


def parts(backend: str, rounds: int) -> dict[str, float]:
    """Return the cost of each part in eigenvalue problems a design, the median over rounds."""
    case, found = pp.load_case("xv15-uncoupled"), defaultdict[str, list[float]](list)
    inputs = {name: limits for name, limits in INPUTS.items() if name != "airspeed"}
    designs, matrix = sampling.latin_hypercube(inputs, DESIGNS, seed=1), matrices(case, _POINTS)
    for _ in range(rounds + 1):
        timed, begin = _Timed(), time.process_time()
        with timed.watching():
            study(case, designs, SPEEDS, "flutter", backend=backend, workers=1, progress=False)
        middle = time.process_time()
        np.linalg.eigvals(matrix)
        one = (time.process_time() - middle) / _POINTS
        timed.spent[WHOLE] = middle - begin
        for name, spent in timed.spent.items():
            found[name].append(spent / DESIGNS / one)
    return {name: float(np.median(costs[1:])) for name, costs in found.items()}


def main() -> None:
    """Print the parts."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--backend", default="compiled", choices=("numpy", "compiled"))
    parser.add_argument("--rounds", type=int, default=5)
    given = parser.parse_args()
    cost = parts(given.backend, given.rounds)
    told = {EIGENVALUES: cost[EIGENVALUES], "trims and matrices of the scan": cost[SCAN] - cost[EIGENVALUES]}
    told |= {name: cost[name] for name in (SCREENING, EXACT, NAMES)}
    told |= {"all else": cost[WHOLE] - sum(told.values()), WHOLE: cost[WHOLE]}
    table = Table("part of a flutter speed", "eigenvalue problems", title=f'backend="{given.backend}"')
    for name, number in told.items():
        table.add_row(name, f"{number:.2f}")
    Console(width=100).print(table)


if __name__ == "__main__":
    main()
