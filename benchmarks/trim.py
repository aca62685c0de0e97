"""The trim of the XV-15, in eigenvalue problems of its state matrix.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.trim

The trim by the fused functions and by the readable functions, with the parts of the first: the section loads along the
blade, the rest of the balance, and the search around both. One point goes by plain numbers, and its parts are not
parted. Rounds are interleaved, all of one run, and a ratio is the median of the ratios of the rounds. Processor time.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any
from unittest import mock

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks.peers.cost import BATCHES, seconds
from proprotor.model.first_order import state_matrix
from proprotor.rotor import fused_balance, trim_balance
from proprotor.rotor.trim_solver import solve_trim

ROUNDS = 9
ROUND_SECONDS = 0.1
ASKED = dict(zip(BATCHES, (4.0, 0.35, 0.20), strict=True))  # with the section loads


def inputs(case: pp.Case, count: int) -> tuple[tuple[Any, ...], dict[str, Any]]:
    """Return what the model gives to the trim."""
    module = sys.modules["proprotor.model.rotor_model"]
    with mock.patch.object(module, "solve_trim", wraps=solve_trim) as called:
        case.linearize(120.0 if count == 1 else np.linspace(60.0, 180.0, count))
    return called.call_args.args, called.call_args.kwargs


def by_readable_functions(work: Callable[[], object]) -> Callable[[], object]:
    """Return the same work as the readable functions do it."""

    def readable() -> None:
        with mock.patch.object(trim_balance, "serves_sections", return_value=False):
            work()

    return readable


def part(work: Callable[[], object], module: Any, name: str) -> float:
    """Return the seconds that a function takes within the work."""
    spent, original = [], getattr(module, name)

    def timed(*given: Any, **more: Any) -> Any:
        start = time.process_time()
        found = original(*given, **more)
        spent.append(time.process_time() - start)
        return found

    with mock.patch.object(module, name, timed):
        work()
    return sum(spent)


def round_of(work: Callable[[], object], matrix: np.ndarray, count: int) -> list[float]:
    """Return the parts of a point's trim and the trim by readable functions, in eigenvalue problems."""
    calls = max(1, int(ROUND_SECONDS / seconds(work, 1)))
    unit = seconds(lambda: np.linalg.eigvals(matrix), 200) / 200 * count
    whole = seconds(work, calls) / calls
    loads = part(work, fused_balance, "_load_moments")
    balance = part(work, trim_balance, "balanced") - loads
    readable = seconds(by_readable_functions(work), 1)
    return [value / unit for value in (whole, loads, balance, whole - loads - balance, readable)]


def main() -> None:
    """Print the table."""
    console, case = Console(), pp.load_case("xv15")
    console.print(f"numpy {np.__version__}, Python {sys.version.split()[0]}")
    table = Table(
        "batch", "trim", "asked", "section loads", "rest of balance", "search", "readable functions"
    )
    matrix = state_matrix(case.linearize(120.0))
    for count in BATCHES:
        given, more = inputs(case, count)
        rounds = [round_of(lambda: solve_trim(*given, **more), matrix, count) for _ in range(ROUNDS)]  # noqa: B023
        whole, *parts, readable = (f"{value:.3g}" for value in np.median(rounds, axis=0))
        shown = parts if count > 1 else ["", "", ""]
        table.add_row(str(count), whole, str(ASKED[count]), *shown, readable)
    console.print(table)


if __name__ == "__main__":
    main()
