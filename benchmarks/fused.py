"""The fused functions of a whole rotor beside `lambdify(cse=True)` and beside the readable functions.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.fused

Without airloads, from the numbers of a blade to M, C and K, as in benchmarks/peers.md; with airloads, from the trim and
the loads of the segments of the XV-15 to M, C, K and B. Rounds are interleaved, all of one run. A time is the median of
the rounds, and a ratio is the median of the ratios of the rounds. Processor time.
"""

from __future__ import annotations

import platform
from collections.abc import Callable, Mapping
from typing import Any
from unittest import mock

import numpy as np
from proprotor_equations import inertia
from proprotor_equations import rotor as readable
from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks.peers import generated_rotor
from benchmarks.peers.cost import BATCHES, seconds
from benchmarks.peers.lambdified import Lambdified, rotor_expressions
from benchmarks.peers.random_rotors import random_rotors, rotor
from proprotor.rotor import fused
from proprotor.rotor.generated import evaluate

ROUNDS = 9
ROUND_SECONDS = 0.1
ASKED = dict(zip(BATCHES, (0.5, 1.0, 0.9), strict=True))  # of the time of lambdify(cse=True)

Work = dict[str, Callable[[], object]]


def fused_matrices(quantities: Mapping[str, Any]) -> dict[str, Any]:
    """Return the matrices of a rotor without airloads by the fused functions, from the numbers of its blade."""
    known = dict(quantities) | evaluate(inertia.dependent_inertias, quantities)._asdict()
    known |= fused.effective_stiffness(known)
    one = np.ndim(known["coning"]) == 0
    return fused.rotor_matrices(known, None, 1 if one else len(known["coning"]), one)


def without_airloads(count: int, lambdified: Lambdified) -> Work:
    """Return what is timed of random rotors without airloads."""
    quantities = random_rotors(count)
    given = rotor(quantities, 0) if count == 1 else quantities
    return {
        "lambdify": lambda: lambdified(given),
        "fused": lambda: fused_matrices(given),
        "readable": lambda: generated_rotor.rotor_matrices(given),
    }


def with_airloads(count: int) -> Work:
    """Return what is timed of the XV-15's rotor with airloads."""
    case = pp.load_case("xv15-uncoupled")
    with mock.patch.object(fused, "rotor_matrices", wraps=fused.rotor_matrices) as called:
        pp.rotor_model(case.rotor, case.operation, 100.0 if count == 1 else np.linspace(60.0, 180.0, count))
    given = called.call_args.args
    together = {**given[1], **given[0]}

    def by_readable_functions() -> object:
        blade = evaluate(readable.blade_matrices, together)
        return evaluate(readable.fixed_frame, together, *blade)

    return {"fused": lambda: fused.rotor_matrices(*given), "readable": by_readable_functions}


def times(work: Work, count: int) -> dict[str, np.ndarray]:
    """Return microseconds a point of each round, by name."""
    calls = {name: max(1, int(ROUND_SECONDS / seconds(one, 1))) for name, one in work.items()}
    rounds = [
        {name: seconds(one, calls[name]) / calls[name] / count * 1e6 for name, one in work.items()}
        for _ in range(ROUNDS)
    ]
    return {name: np.array([found[name] for found in rounds]) for name in work}


def versions() -> str:
    """Return the versions of NumPy and Python, the kernel of the linear algebra and the processor."""
    blas = np.show_config(mode="dicts")["Build Dependencies"]["blas"]
    kernel = blas.get("openblas configuration", blas.get("name", "unknown"))
    return f"numpy {np.__version__}, {kernel}; {platform.machine()}, Python {platform.python_version()}"


def main() -> None:
    """Print times and ratios."""
    console = Console()
    console.print(versions())
    table = Table(
        "airloads", "batch", "lambdify", "fused", "readable", "fused / lambdify", "asked", "fused / readable"
    )
    lambdified = Lambdified(rotor_expressions(), cse=True)
    for count in BATCHES:
        found = times(without_airloads(count, lambdified), count)
        numbers = [f"{np.median(found[name]):.3g} μs" for name in ("lambdify", "fused", "readable")]
        ratios = [np.median(found["fused"] / found[name]) for name in ("lambdify", "readable")]
        table.add_row("no", str(count), *numbers, f"{ratios[0]:.2f}", str(ASKED[count]), f"{ratios[1]:.2f}")
    for count in BATCHES:
        found = times(with_airloads(count), count)
        numbers = [f"{np.median(found[name]):.3g} μs" for name in ("fused", "readable")]
        ratio = np.median(found["fused"] / found["readable"])
        table.add_row("yes", str(count), "", *numbers, "", "", f"{ratio:.2f}")
    console.print(table)


if __name__ == "__main__":
    main()
