"""What a study costs beside LAPACK alone, and what two cores are worth.

    python -m benchmarks.study [points]

Every ratio is of two times of one run on the same matrices, the best of several turns taken one after the other. One
BLAS thread throughout. Times of one process are its processor time, those of two are on the clock: with anything else
running, the latter say little.
"""

from __future__ import annotations

import os
import sys
import time
from collections import defaultdict
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from functools import wraps
from importlib import import_module
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from proprotor import sampling
from proprotor.model import configuration
from proprotor.model.first_order import state_matrix
from proprotor.rotor import fused_balance
from proprotor.rotor import section_loads as blade_airloads
from proprotor.study import workers as study_workers
from proprotor.study.study import study
from proprotor.study.variables import DEFAULT_QUANTITIES

# The packages have functions by these names.
rotor_model, modes = map(import_module, ("proprotor.model.rotor_model", "proprotor.stability.modes"))
POINTS = 10_000
TURNS = 3
BATCH = 2000  # points: as many as a study analyses at once
SPEEDS = np.linspace(160, 380, 20) * 1852 / 3600  # m/s
INPUTS = {
    "rotor.precone": ("1.5 deg", "3.5 deg"),
    "rotor.control_stiffness": sampling.Relative(0.7, 1.5),
    "rotor.pitch_inertia": sampling.Relative(0.8, 1.2),
    "rotor.lag_frequency": sampling.Relative(0.9, 1.1),
    "support.modes[beam].frequency": sampling.Relative(0.9, 1.1),
    "support.modes[chord].frequency": sampling.Relative(0.9, 1.1),
    "airspeed": ("160 kt", "380 kt"),
}
# Parts of a study: functions by the place where they are looked up. A part within another is taken off it, and what is
# in none is the rest.
PARTS = {
    "numbers of the deck to rotor and support": [(pp.Case, "vary")],
    "stations along the blade": [(blade_airloads.BladeSections, "of")],
    "trim: section loads": [(fused_balance, "_load_moments")],
    "trim: the rest": [(rotor_model, "solve_trim")],
    "matrices of the rotor": [(rotor_model.fused, "rotor_matrices")],
    "rotor on its support": [(configuration, "mount")],
    "state matrix": [(modes, "have_modes"), (modes, "first_order_at")],
    "eigenvalues (LAPACK)": [(np.linalg, "eigvals")],
}
REST = "all else: inputs, checks, order, results"


def plan(points: int) -> sampling.Plan:
    """Designs, each at an airspeed of its own."""
    return sampling.latin_hypercube(INPUTS, points, seed=1)


def lines(points: int) -> tuple[sampling.Plan, np.ndarray]:
    """Designs, each along the same 20 airspeeds."""
    inputs = {name: limits for name, limits in INPUTS.items() if name != "airspeed"}
    return sampling.latin_hypercube(inputs, points // SPEEDS.size, seed=1), SPEEDS


def matrices(case: pp.Case, points: int) -> np.ndarray:
    """The state matrices of the designs of `plan`."""
    values = plan(points).resolve(pp.design_inputs(case)).values
    found = []
    for start in range(0, points, 1000):
        some = {name: array[start : start + 1000] for name, array in values.items()}
        airspeed = some.pop("airspeed")
        found.append(state_matrix(case.vary(some).linearize(airspeed)))
    return np.concatenate(found)


def best(*tasks: tuple[Callable[[], Any], Callable[[], float]]) -> list[float]:
    """Least time of each task by its clock, all taken in turns."""
    times = np.full(len(tasks), np.inf)
    for _ in range(TURNS):
        for place, (task, clock) in enumerate(tasks):
            start = clock()
            task()
            times[place] = min(times[place], clock() - start)
    return times.tolist()


def processor_time_of_workers() -> float:
    """Of the worker processes that wait for a study, s (Linux)."""
    fields = [
        Path(f"/proc/{worker.process.pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
        for worker in study_workers._idle
    ]
    return sum(int(field[11]) + int(field[12]) for field in fields) / os.sysconf("SC_CLK_TCK")


def on_two_threads(function: Callable, array: np.ndarray) -> None:
    """A LAPACK function over both halves of a batch at once."""
    with ThreadPoolExecutor(2) as threads:
        list(threads.map(function, np.array_split(array, 2)))


class Stopwatch:
    """Time spent in some functions, each without what others of them take."""

    def __init__(self) -> None:
        self.spent, self.within = defaultdict(float), [0.0]

    def timed(self, part: str, function: Callable) -> Callable:
        """The function, with its time put down to a part."""

        @wraps(function)  # its arguments are looked up by name
        def run(*arguments: Any, **named: Any) -> Any:
            start = time.process_time()
            self.within.append(0.0)
            try:
                return function(*arguments, **named)
            finally:
                took = time.process_time() - start
                self.spent[part] += took - self.within.pop()
                self.within[-1] += took

        return run


def evaluations(case: pp.Case, points: int) -> list[float]:
    """Processor time of each evaluation of the section loads in the trim of one batch, s."""
    numbers = plan(points).resolve(pp.design_inputs(case)).values
    airspeed = numbers.pop("airspeed")
    genuine, found = fused_balance._load_moments, []

    def timed(*given: Any) -> Any:
        start = time.process_time()
        moments = genuine(*given)
        found.append(time.process_time() - start)
        return moments

    with mock.patch.object(fused_balance, "_load_moments", timed):
        case.vary(numbers).linearize(airspeed)
    return found


def profile(case: pp.Case, points: int) -> dict[str, float]:
    """Processor time of each part of a study of one process, s."""
    watch = Stopwatch()
    with ExitStack() as patches:
        for part, places in PARTS.items():
            for owner, name in places:
                patches.enter_context(mock.patch.object(owner, name, watch.timed(part, getattr(owner, name))))
        start = time.process_time()
        study(case, plan(points), workers=1)
        whole = time.process_time() - start
    return {part: watch.spent[part] for part in PARTS} | {REST: whole - sum(watch.spent.values())}


def floors(case: pp.Case, points: int) -> dict[str, float]:
    """What a part cannot do without, s a point.

    Of the trim one evaluation of all section loads with their derivatives, which the equations of motion take as well;
    of the state matrix the solution of its linear equations; of the eigenvalues all.
    """
    full = min(evaluations(case, points))
    numbers = plan(points).resolve(pp.design_inputs(case)).values
    airspeed = numbers.pop("airspeed")
    linear = case.vary(numbers).linearize(airspeed)
    right = np.concatenate([linear.K, linear.C], axis=-1)[..., 1:]
    matrix = state_matrix(linear)
    solve, values = best(
        (lambda: np.linalg.solve(linear.M, right), time.process_time),
        (lambda: np.linalg.eigvals(matrix), time.process_time),
    )
    least = {"trim: section loads": full, "state matrix": solve, "eigenvalues (LAPACK)": values}
    return {part: spent / points for part, spent in least.items()}


def print_ratios(console: Console, case: pp.Case, points: int) -> None:
    A = matrices(case, points)
    vectors = (*DEFAULT_QUANTITIES, "vectors")
    study(case, plan(points), workers=2)  # both worker processes started
    console.print(
        f"{study_workers.idle_workers()} worker processes wait; load of the machine {os.getloadavg()[0]:.1f}"
    )
    processor, clock = time.process_time, time.perf_counter
    one, values, one_with, followed, pairs, two, threads, both = best(
        (lambda: study(case, plan(points), workers=1), processor),
        (lambda: np.linalg.eigvals(A), processor),
        (lambda: study(case, plan(points), quantities=vectors, workers=1), processor),
        (lambda: study(case, *lines(points), quantities=(*vectors, "modes"), workers=1), processor),
        (lambda: np.linalg.eig(A), processor),
        (lambda: study(case, plan(points), workers=2), clock),
        (lambda: on_two_threads(np.linalg.eigvals, A), clock),
        (lambda: study(case, plan(points), workers=2), processor_time_of_workers),
    )
    table = Table(
        "",
        "study, s",
        "LAPACK alone, s",
        "ratio",
        "asked for",
        title=f"{points} points, {A.shape[-1]} states",
    )
    rows = (
        ("eigenvalues, one process", one, values, "1.25"),
        ("with vectors, one process", one_with, pairs, "1.4"),
        ("with vectors and modes followed, one process", followed, pairs, "1.4"),
        ("eigenvalues, two processes (threads for LAPACK)", two, threads, "1.25"),
    )
    for name, ours, lapack, asked in rows:
        table.add_row(name, f"{ours:.2f}", f"{lapack:.2f}", f"{ours / lapack:.2f}", asked)
    console.print(table)
    console.print(f"two processes against one: {one / two:.2f} × as fast on the clock (asked for: 1.6)")
    console.print(
        f"their processor time together: {both:.2f} s, so {2 * one / both:.2f} × on two cores that do nothing else"
    )


def print_profile(console: Console, case: pp.Case, points: int) -> None:
    times, least = profile(case, points), floors(case, BATCH)
    whole, lapack = sum(times.values()), times["eigenvalues (LAPACK)"]
    columns = ("part", "µs a point", "% of the study", "of LAPACK's time", "floor, µs")
    table = Table(*columns, title="where one process spends its time")
    for part, spent in (*times.items(), ("the study", whole)):
        floor = f"{1e6 * least[part]:.1f}" if part in least else ""
        table.add_row(
            part, f"{1e6 * spent / points:.1f}", f"{100 * spent / whole:.1f}", f"{spent / lapack:.3f}", floor
        )
    console.print(table)
    told = ", ".join(f"{1e6 * one / BATCH:.1f}" for one in evaluations(case, BATCH))
    console.print(f"section loads in the trim of a batch: {told} µs a point")


def main() -> None:
    """Print all of it; a second start of the program has one BLAS thread."""
    if os.environ.get("OPENBLAS_NUM_THREADS") != "1":
        environment = os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
        os.execve(sys.executable, [sys.executable, "-m", "benchmarks.study", *sys.argv[1:]], environment)
    points = int(sys.argv[1]) if len(sys.argv) > 1 else POINTS
    console, case = Console(width=110, highlight=False), pp.load_case("xv15-uncoupled")
    print_ratios(console, case, points)
    print_profile(console, case, points)


if __name__ == "__main__":
    main()
