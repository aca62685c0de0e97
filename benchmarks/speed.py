"""What an analysis costs beside LAPACK alone, beside `lambdify(cse=True)`, and beside an earlier version.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.speed [--points 10000] [--rounds 5] [--baseline WORKTREE]
    OPENBLAS_NUM_THREADS=1 python -m benchmarks.speed --profile          # µs a point by part of a study
    OPENBLAS_NUM_THREADS=1 python -m benchmarks.speed --memory --baseline WORKTREE

Rounds are interleaved: all of one row are timed in turn. A time is processor time, a ratio is the median of the ratios
of the rounds. One eigenvalue problem, e, is `numpy.linalg.eigvals` of one state matrix of the same points. With a C
compiler the rows have the ratio of compiled functions (`backend="compiled"`) from the same rounds.

The earlier version is a worktree of the repository at the last commit before sections had an effective twist:

    git worktree add --detach ../baseline 35e295d
    OPENBLAS_NUM_THREADS=1 python -m benchmarks.speed --baseline ../baseline

It runs with the packages of this environment. As in an installed package, modules are compiled before the first round.
"""

from __future__ import annotations

import argparse
import os
import platform
import resource
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks import environments, fused, stations
from benchmarks.flutter_cost import DESIGNS
from benchmarks.peers.cost import BATCHES
from benchmarks.peers.lambdified import Lambdified, rotor_expressions
from benchmarks.speed_tasks import COMPILED, COMPILED_TASK
from benchmarks.speed_tasks import POINTS as BATCH
from benchmarks.study import INPUTS, SPEEDS, lines, matrices, plan, profile
from proprotor import sampling
from proprotor.compiled.library import why_not
from proprotor.model.first_order import state_matrix
from proprotor.stability.modes import eigenvalues
from proprotor.study.study import study
from proprotor.study.variables import DEFAULT_QUANTITIES
from proprotor.units import KNOT

ROOT = Path(__file__).parents[1]
HUNDRED = np.linspace(160, 380, 100) * KNOT
OUTBOARD = np.array([0.05, 0.1, 0.2, 0.4, 0.8, 1.2])  # airspeed by tip speed
COMMAND = ("flutter", "xv15")

Work = Mapping[str, tuple[Callable[[], object], int]]  # and how many points or designs or calls each is


class Row(NamedTuple):
    """A line of the table: what is compared, the ratio with what is asked of it, and the same of compiled functions."""

    what: str
    found: float
    asked: float
    unit: str = ""
    compiled: float = np.nan
    asked_compiled: float = np.nan


def processor_time(work: Callable[[], object]) -> float:
    """Seconds of one call."""
    start = time.process_time()
    work()
    return time.process_time() - start


def rounds_of(work: Work, rounds: int) -> dict[str, np.ndarray]:
    """Seconds a point of each round, by name; the first round, which fills caches, does not count."""
    found: dict[str, list[float]] = {name: [] for name in work}
    for _ in range(rounds + 1):
        for name, (task, count) in work.items():
            found[name].append(processor_time(task) / count)
    return {name: np.array(times[1:]) for name, times in found.items()}


def ratio(times: Mapping[str, np.ndarray], one: str, other: str) -> float:
    """Median of the ratios of the rounds."""
    return float(np.median(times[one] / times[other]))


# Beside LAPACK -------------------------------------------------------------------------------------


def beside_lapack(case: pp.Case, points: int, rounds: int) -> list[Row]:
    """Studies, single points and searches in eigenvalue problems."""
    matrix, along = matrices(case, points), in_lines(case, points)
    designs = sampling.latin_hypercube(
        {name: limits for name, limits in INPUTS.items() if name != "airspeed"}, DESIGNS, seed=1
    )

    def tasks(backend: str) -> Work:
        def studied(inputs: tuple[Any, ...], *more: str) -> Callable[[], object]:
            quantities = (*DEFAULT_QUANTITIES, *more)
            return lambda: study(case, *inputs, quantities=quantities, **settings)

        options = {"backend": backend}
        settings = options | {"workers": 1, "progress": False}
        alone, hundred = (partial(case.linearize, speed, **options) for speed in (150.0, HUNDRED))
        return {
            "study": (studied((plan(points),)), points),
            "with vectors": (studied((plan(points),), "vectors"), points),
            "followed": (studied(lines(points), "vectors", "modes"), len(along)),
            "one point": (lambda: [state_matrix(alone()) for _ in range(20)], 20),
            "hundred": (lambda: eigenvalues(hundred()), len(HUNDRED)),
            "flutter": (lambda: study(case, designs, SPEEDS, "flutter", **settings), DESIGNS),
        }

    backends = ("numpy",) if why_not() else ("numpy", "compiled")
    lapack: Work = {
        "e": (lambda: np.linalg.eigvals(matrix), points),
        "eig": (lambda: np.linalg.eig(matrix), points),
        "eig of lines": (lambda: np.linalg.eig(along), len(along)),
    }
    ours = {f"{name}, {backend}": task for backend in backends for name, task in tasks(backend).items()}
    times = rounds_of({**lapack, **ours}, rounds)

    def row(what: str, name: str, beside: str, asked: float, compiled: float = np.nan, unit: str = "") -> Row:
        found = [ratio(times, f"{name}, {backend}", beside) for backend in backends]
        return Row(what, found[0], asked, unit, *found[1:] or [np.nan], compiled)

    return [
        row(f"study of {points} points / eigvals", "study", "e", 1.40, 0.30),
        row("with vectors / eig", "with vectors", "eig", 1.40, 0.50),
        row("with vectors and modes followed / eig", "followed", "eig of lines", 1.75),
        row("one point to the state matrix", "one point", "e", 8, 2.5, "e"),
        row("100 points with eigvals, a point", "hundred", "e", 1.9, 0.3, "e"),
        row(f"flutter speed of a design, {len(SPEEDS)} speeds", "flutter", "e", 40, 6, "e"),
    ]


def in_lines(case: pp.Case, points: int) -> np.ndarray:
    """State matrices of the designs of `lines`, at all airspeeds."""
    inputs, speeds = lines(points)
    values = inputs.resolve(pp.design_inputs(case)).values
    found = state_matrix(
        case.vary({name: array[:, None] for name, array in values.items()}).linearize(speeds)
    )
    return found.reshape(-1, *found.shape[-2:])


# Beside lambdify, and the stations -----------------------------------------------------------------


def beside_lambdify() -> list[Row]:
    """The whole rotor without airloads."""
    lambdified, found = Lambdified(rotor_expressions(), cse=True), []
    for count in BATCHES:
        times = fused.times(fused.without_airloads(count, lambdified), count)
        what = f"whole rotor without airloads / lambdify(cse=True), batch {count}"
        found.append(Row(what, ratio(times, "fused", "lambdify"), fused.ASKED[count]))
    return found


def of_stations(case: pp.Case) -> list[Row]:
    """The stations of a blade, and the largest error of a moment of the section loads."""
    tip_speed = case.operation.rotor_speed * case.rotor.radius
    count, by_itself, _ = stations.errors(case, OUTBOARD * tip_speed)[stations.OURS]
    return [
        Row("radial stations of the XV-15", count, 37),
        Row("largest error of a moment of its loads, in itself", float(by_itself.max()), 1e-9),
    ]


# Beside an earlier version -------------------------------------------------------------------------


class Version:
    """A process that runs the tasks of `benchmarks.speed_tasks` with the package of a worktree."""

    def __init__(self, worktree: Path) -> None:
        self.compiled = TemporaryDirectory()
        self.environment = environments.of_package(worktree, self.compiled.name) | {
            "OPENBLAS_NUM_THREADS": "1"
        }
        tasks = [sys.executable, str(ROOT / "benchmarks" / "speed_tasks.py")]
        self.process = subprocess.Popen(
            tasks,
            env=self.environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            cwd=worktree,
        )

    def ask(self, name: str) -> float:
        """Return the processor time of a task, s, or the peak memory, MB."""
        assert self.process.stdin is not None and self.process.stdout is not None  # pipes
        self.process.stdin.write(name + "\n")
        self.process.stdin.flush()
        return float(self.process.stdout.readline())

    def command(self) -> float:
        """Return the processor time of a command in a process of its own, s."""
        code = f"import sys; from proprotor.commands.main import main; sys.argv[1:] = {list(COMMAND)}; main()"
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(
            [sys.executable, "-c", code], env=self.environment, stdout=subprocess.DEVNULL, check=True
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def end(self) -> None:
        """End the process."""
        assert self.process.stdin is not None  # a pipe
        self.process.stdin.close()
        self.process.wait()
        self.compiled.cleanup()


AGAINST = {
    "flutter_point": ("flutter_point, 71 airspeeds / earlier", 0.40, 0.25),
    "sweep": ("sweep of 71 airspeeds / earlier", 0.45, 0.30),
    "one point": ("one point to the state matrix / earlier", 1.0, np.nan),
    "reactionless": ("eight blades with reactionless coordinates, eigenvalues / earlier", 0.4, np.nan),
    "command": (f"proprotor {' '.join(COMMAND)}, processor time / earlier", 0.55, np.nan),
}


def beside_earlier(baseline: Path, rounds: int) -> list[Row]:
    """Tasks of this version by those of an earlier one."""
    versions = Version(ROOT), Version(baseline)
    found: dict[str, list[float]] = {name: [] for name in (*AGAINST, *COMPILED)}
    for _ in range(rounds + 1):
        for name in AGAINST:
            ours, theirs = (one.command() if name == "command" else one.ask(name) for one in versions)
            found[name].append(ours / theirs)
            if not why_not() and (compiled := COMPILED_TASK.format(name)) in COMPILED:
                found[compiled].append(versions[0].ask(compiled) / theirs)
    for one in versions:
        one.end()
    middle = {name: float(np.median(ratios[1:])) if ratios else np.nan for name, ratios in found.items()}
    return [
        Row(what, middle[name], asked, "", middle.get(COMPILED_TASK.format(name), np.nan), asked_compiled)
        for name, (what, asked, asked_compiled) in AGAINST.items()
    ]


def memory(baseline: Path | None) -> list[Row]:
    """Peak memory of a process that linearises a batch, beyond that before, MB, and by that of an earlier version."""
    found = []
    for place in (ROOT, baseline):
        if place is not None:
            version = Version(place)
            before = version.ask("peak memory")
            version.ask("memory")
            found.append(version.ask("peak memory") - before)
            version.end()
    rows = [Row(f"memory of a batch of {BATCH} points, MB", found[0], np.inf)]
    return rows + [Row("by that of the earlier version", found[0] / one, 1.0) for one in found[1:]]


# Printing -------------------------------------------------------------------------------------------


def print_rows(console: Console, rows: list[Row]) -> None:
    table = Table("", "found", "asked for, at most", "compiled", "asked for, at most")
    for row in rows:
        numbers = (f"{row.found:.3g}", f"{row.asked:g}", f"{row.compiled:.3g}", f"{row.asked_compiled:g}")
        table.add_row(row.what, *("" if one == "nan" else f"{one} {row.unit}".strip() for one in numbers))
    console.print(table)


def print_profile(console: Console, case: pp.Case, points: int) -> None:
    """Microseconds a point of each part of a study, and its share of LAPACK's time."""
    study(case, plan(1), workers=1, progress=False)  # what is imported then is no part of a study
    times = profile(case, points)
    lapack = times["eigenvalues (LAPACK)"]
    table = Table("part of a study", "µs a point", "of LAPACK's time")
    for part, spent in (*times.items(), ("the study", sum(times.values()))):
        table.add_row(part, f"{1e6 * spent / points:.1f}", f"{spent / lapack:.3f}")
    console.print(table)


def conditions(baseline: Path | None) -> str:
    """The versions and the kernel that were measured."""
    blas = np.show_config(mode="dicts")["Build Dependencies"]["blas"]
    kernel = os.environ.get("OPENBLAS_CORETYPE") or blas.get(
        "openblas configuration", blas.get("name", "unknown")
    )
    told = f"numpy {np.__version__}, {kernel}; {platform.machine()}, Python {platform.python_version()}"
    if baseline is None:
        return told
    commit = ["git", "-C", str(baseline), "rev-parse", "--short", "HEAD"]
    return f"{told}; earlier version {subprocess.check_output(commit, text=True).strip()}"


def main() -> None:
    """Print the table, or what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=10_000)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--baseline", type=Path, help="worktree of an earlier version")
    parser.add_argument("--profile", action="store_true", help="microseconds a point of each part of a study")
    parser.add_argument("--memory", action="store_true", help="peak memory of a batch")
    asked = parser.parse_args()
    baseline = None if asked.baseline is None else asked.baseline.resolve()
    console, case = Console(width=110, highlight=False), pp.load_case("xv15-uncoupled")
    console.print(conditions(baseline))
    if asked.profile:
        print_profile(console, case, asked.points)
    if asked.memory:
        print_rows(console, memory(baseline))
    if asked.profile or asked.memory:
        return
    rows = beside_lapack(case, asked.points, asked.rounds) + beside_lambdify() + of_stations(case)
    if baseline is not None:
        rows += beside_earlier(baseline, asked.rounds)
    print_rows(console, rows)


if __name__ == "__main__":
    main()
