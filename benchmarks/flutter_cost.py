"""What a stability boundary and its derivatives cost, and how good they are.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.flutter_cost
    OPENBLAS_NUM_THREADS=1 python -m benchmarks.flutter_cost --against FOLDER    # of another version of the project

An eigen-solve is one airspeed linearised (trim included) and all its eigenvalues and vectors. The derivatives of a
boundary take one more eigen-solve, for the vectors, and one batch of models a complex step away, one for each input.

Costs of trim, boundary and study are told in eigenvalue problems: one is LAPACK's eigenvalues of one state matrix, by
processor time, the median over rounds in which all take their turn. Against another version, commands and boundaries
run in processes of their own, in turns, and the ratios of the same round count. As in an installed package, modules are
compiled before the first round.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks import environments
from benchmarks.fused import versions
from benchmarks.study import INPUTS
from proprotor import sampling
from proprotor.deck.vary import design_inputs
from proprotor.model.first_order import state_matrix
from proprotor.stability.boundaries import find_crossings
from proprotor.stability.flutter import flutter_point
from proprotor.stability.modes import decomposition
from proprotor.stability.parameter_lines import ParameterLine
from proprotor.stability.sensitivity import at_boundary
from proprotor.study.study import study
from proprotor.units import KNOT

SCANS = (2, 5, 10, 20, 40)  # kt
REPEATS = 15
ROUNDS = 5
# Programs that print their processor time last.
COMMAND = """import atexit, time
atexit.register(lambda: print(time.process_time()))
from proprotor.commands.main import main
main({words})
"""
ANALYSIS = """import time
import numpy as np
import proprotor as pp
case, scan = pp.load_case("xv15-uncoupled"), np.linspace(25, 205, 71)
for _ in range(2):
    begin = time.process_time()
    {call}
print(time.process_time() - begin)
"""
DAMPED = "{'support.modes[chord].damping_ratio': np.linspace(0.005, 0.02, 9)}"
CALLS = {
    "flutter_point, 71 airspeeds": "case.flutter_point(scan)",
    "boundaries along a stiffness": (
        "case.boundaries(180.0, {'rotor.control_stiffness': np.linspace(1e4, 4e4, 51)})"
    ),
    "boundary against 9 damping ratios": f"case.boundary_against({DAMPED}, scan)",
    "stability map, 9 by 71": f"case.stability_map({{**{DAMPED}, 'airspeed': scan}})",
    "study of 200 flutter speeds": (
        "pp.study(case, {'rotor.precone': np.linspace(0.01, 0.06, 200)}, np.linspace(80, 195, 20), 'flutter', "
        "workers=1, progress=False)"
    ),
}
PROGRAMS = {
    "proprotor --help": COMMAND.format(words=["--help"]),
    "proprotor flutter xv15": COMMAND.format(words=["flutter", "xv15"]),
    "proprotor sweep xv15": COMMAND.format(words=["sweep", "xv15", "--speed", "50:400:5kt"]),
    **{name: ANALYSIS.format(call=call) for name, call in CALLS.items()},
}
SPEEDS = np.linspace(160, 380, 20) * KNOT
DESIGNS = 500


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
        found = find_crossings(ParameterLine(ends, lambda speed: case.linearize(speed)))
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


def in_eigenvalue_problems(console: Console, case: pp.Case) -> None:
    """Cost of trim, boundary and study, in eigenvalues of one state matrix."""
    scan = np.linspace(50, 400, 71) * KNOT
    matrices = state_matrix(case.linearize(scan))
    inputs = {name: limits for name, limits in INPUTS.items() if name != "airspeed"}
    designs = sampling.latin_hypercube(inputs, DESIGNS, seed=1)
    works: dict[str, tuple[Callable[[], object], int]] = {
        "": (lambda: np.linalg.eigvals(matrices), len(scan)),
        "trim and matrices of 71 airspeeds, a point": (lambda: case.linearize(scan), len(scan)),
        "and of 2000": (lambda: case.linearize(np.linspace(50, 400, 2000) * KNOT), 2000),
        "all boundaries of a scan of 71 airspeeds": (lambda: flutter_point(case, scan), 1),
        f"study of {DESIGNS} designs at {len(SPEEDS)} airspeeds, a design": (
            lambda: study(case, designs, SPEEDS, "flutter", workers=1, progress=False),
            DESIGNS,
        ),
    }
    rounds = [
        {name: _processor_time(work) / count for name, (work, count) in works.items()} for _ in range(ROUNDS)
    ]
    one = np.median([spent[""] for spent in rounds])
    table = Table("", "eigenvalue problems", title=f"one eigenvalue problem takes {1e6 * one:.0f} µs")
    for name in filter(None, works):
        table.add_row(name, f"{np.median([spent[name] / spent[''] for spent in rounds]):.2f}")
    console.print(table)


def against(console: Console, folder: Path) -> None:
    """Processor time of commands and boundaries, as a ratio to that of the version in another folder."""
    here = Path(__file__).parents[1]
    table = Table("", "s", "there, s", "ratio", title=f"against {folder}")
    with TemporaryDirectory() as compiled:
        for name, code in PROGRAMS.items():
            runs = [
                [_of_process(place, code, compiled) for place in (here, folder)] for _ in range(1 + ROUNDS)
            ]
            rounds = np.array(runs[1:])
            own, other = np.median(rounds, axis=0)
            table.add_row(name, f"{own:.3f}", f"{other:.3f}", f"{np.median(rounds[:, 0] / rounds[:, 1]):.2f}")
    console.print(table)


def _of_process(folder: Path, code: str, compiled: str) -> float:
    """Processor time that a program says it took with the package of a folder, s; its modules are compiled once."""
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=environments.of_package(folder, compiled),
        capture_output=True,
        text=True,
        check=True,
    )
    return float(done.stdout.split()[-1])


def _processor_time(work: Callable[[], object]) -> float:
    begin = time.process_time()
    work()
    return time.process_time() - begin


def fastest(work: Callable[[], object]) -> float:
    """Least processor time of some runs, s."""
    return min(_processor_time(work) for _ in range(REPEATS))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--against", type=Path, help="folder of another version of the project")
    folder = parser.parse_args().against
    console, case = Console(width=120), pp.load_case("xv15-uncoupled")
    console.print(versions())
    if folder is not None:
        against(console, folder.resolve())
        return
    in_eigenvalue_problems(console, case)
    crossings(console, case)
    one_bracket(console, case)
    derivatives(console, case)


if __name__ == "__main__":
    main()
