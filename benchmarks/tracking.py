"""Modes followed in steps of 5 kt against modes followed in steps of 0.1 kt, and what following costs.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.tracking             # some minutes
    OPENBLAS_NUM_THREADS=1 python -m benchmarks.tracking --every     # every design judged in steps of 0.1 kt

Each bundled case and 200 random designs around the XV-15 are swept from 50 to 400 kt in steps of 5 kt, with the
division of steps that `Case.sweep` does. The judge follows the same modes in steps of 0.1 kt (every tenth design; 0.5
kt for the others) from point to point without dividing any. Where the two differ, the step in question is looked at in
steps of 0.002 kt, which says which of them is right.
"""

from __future__ import annotations

import sys
import time
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

import proprotor as pp
from proprotor.model.first_order import state_matrix
from proprotor.stability.following import Branches, follow
from proprotor.stability.matching import chain, match_modes
from proprotor.stability.modes import decomposition
from proprotor.stability.parameter_lines import ParameterLine
from proprotor.units import KNOT

COARSE, FINE, LESS_FINE, FINEST = 5.0, 0.1, 0.5, 0.002  # kt
DESIGNS, POINTS, BATCH = 200, 10_000, 1000
SAME = 1e-6  # of an eigenvalue
VARIED = {
    "rotor.precone": 1.0,
    "rotor.flap_frequency": 0.2,
    "rotor.lag_frequency": 0.2,
    "rotor.structural_pitch_offset": 0.5,
    "rotor.gimbal_stiffness": 0.5,
    "rotor.pitch_gimbal_coupling": 0.5,
    "rotor.pitch_inertia": 0.4,
    "rotor.control_stiffness": 0.5,
    "rotor.chord": 0.2,
    "rotor.airfoil.lift_slope": 0.1,
    "rotor.airfoil.drag": 0.5,
    "operation.rotor_speed": 0.1,
    "operation.density": 0.2,
    "support.modes[beam].frequency": 0.3,
    "support.modes[beam].damping_ratio": 0.9,
    "support.modes[chord].frequency": 0.3,
    "support.modes[chord].damping_ratio": 0.9,
    "support.modes[torsion].frequency": 0.3,
    "support.modes[torsion].generalized_mass": 0.3,
}


def random_designs(count: int) -> list[pp.Case]:
    """Designs with inputs of the XV-15 spread evenly about their values."""
    rng, case = np.random.default_rng(1), pp.load_case("xv15-uncoupled")
    spread = np.array(list(VARIED.values()))
    own = np.array([case.given[path].si for path in VARIED])
    values = own * (1 + spread * rng.uniform(-1, 1, (count, len(own))))
    return [case.vary(dict(zip(VARIED, row, strict=True))) for row in values]


def values_of(branches: Branches, points: int) -> NDArray:
    """Followed eigenvalues (points, states) of the first points of the spectrum; NaN at failed points."""
    values = branches.spectrum.values[:points].copy()
    own = branches.points < points
    values[branches.points[own]] = np.take_along_axis(values[branches.points[own]], branches.places[own], 1)
    return values


def judged(case: pp.Case, step: float) -> tuple[int, int, int, int]:
    """Eigen-solves, double assignments, steps that differ from the judge's, and those of them in which it is right."""
    coarse = np.arange(50, 400.1, COARSE) * KNOT
    branches = follow(case.linearize(coarse), ParameterLine(coarse, case.linearize))
    works = branches.points[branches.points < len(coarse)]
    twice = sum(len(set(row)) < len(row) for row in branches.places.tolist())
    found = values_of(branches, len(coarse))
    differing = wrong = 0
    for first, last in pairwise(works):
        if last > first + 1:  # a failed point between
            continue
        ends = found[[first, last]]
        if not _agree(case, coarse[[first, last]], ends, round(COARSE / step)):
            differing += 1
            wrong += not _agree(case, coarse[[first, last]], ends, round(COARSE / FINEST))
    return len(branches.points), twice, differing, wrong


def _agree(case: pp.Case, span: NDArray, ends: NDArray, steps: int) -> bool:
    """Whether states followed in many steps from one end of a span arrive where they are said to."""
    line = np.linspace(*span, steps + 1)
    every = values_of(follow(case.linearize(line)), len(line))
    start = np.abs(ends[0][:, None] - every[0]).argmin(axis=1)
    arrived = every[-1][start]
    # Two roots of a pair that has parted may be told in either order, and two that have joined above or below.
    apart = np.abs(arrived - ends[1]) > SAME * np.abs(ends[1])
    return not np.any(apart & ~_exchangeable(ends, arrived))


def _exchangeable(ends: NDArray, arrived: NDArray) -> NDArray:
    """States of a pair that are real at the end, and real ones of a pair at the end, with one another's roots."""
    parted = (ends[0].imag != 0) & (ends[1].imag == 0)
    twin = np.abs(ends[0][:, None] - ends[0].conj()).argmin(axis=1)
    parted &= np.abs(arrived - ends[1][twin]) <= SAME * np.abs(arrived)
    joined = (ends[0].imag == 0) & (ends[1].imag != 0)
    return parted | (joined & (np.abs(arrived - ends[1].conj()) <= SAME * np.abs(arrived)))


def cost(console: Console) -> None:
    """Processor time of each part of following 10,000 points, beside `numpy.linalg.eig` on the same matrices."""
    case = pp.load_case("xv15-uncoupled")
    speeds = np.linspace(50, 400, POINTS) * KNOT
    model = case.linearize(speeds)
    matrix, spectrum = state_matrix(model), decomposition(model)
    ends = np.arange(POINTS - 1), np.arange(1, POINTS)
    steps = match_modes(spectrum, *ends)
    parts = {
        "numpy.linalg.eig alone": lambda: np.linalg.eig(matrix),
        "matrices of the equations of motion": lambda: in_batches(case, speeds),
        "state matrices": lambda: state_matrix(model),
        "eigenvalues and right vectors": lambda: decomposition(model),
        "likeness, assignment, quality": lambda: match_modes(spectrum, *ends),
        "chain": lambda: chain(steps.successor, np.arange(matrix.shape[-1])),
        "left vectors of all modes": lambda: spectrum.all_modes,
    }
    rounds = []
    for _ in range(5):
        times = []
        for part in parts.values():
            begin = time.process_time()
            part()
            times.append(time.process_time() - begin)
        rounds.append(times)
    eig, linearize, state, decomposed, linked, chained, left = np.median(rounds, axis=0)
    table = Table("part", "of eig", title=f"{POINTS} points, {matrix.shape[-1]} states; eig: {eig:.2f} s")
    shares = (eig, linearize, state, decomposed - state, linked, chained, left)
    for name, share in zip(parts, shares, strict=True):
        table.add_row(name, f"{share / eig:.3f}")
    table.add_row("followed, from state matrices on", f"{(decomposed + linked + chained) / eig:.2f}")
    table.add_row("with left vectors", f"{(decomposed + linked + chained + left) / eig:.2f}")
    table.add_row("and from airspeeds on", f"{(linearize + decomposed + linked + chained + left) / eig:.2f}")
    console.print(table)


def in_batches(case: pp.Case, speeds: NDArray) -> None:
    """Linearise as a study does, a batch at a time."""
    for start in range(0, len(speeds), BATCH):
        case.linearize(speeds[start : start + BATCH])


def main() -> None:
    console = Console(width=120)
    cost(console)
    begin = time.perf_counter()
    for name in pp.list_cases():
        told(console, name, [pp.load_case(name)], [FINE])
    designs = random_designs(DESIGNS)
    tenth = [FINE if "--every" in sys.argv or k % 10 == 0 else LESS_FINE for k in range(DESIGNS)]
    told(console, f"{DESIGNS} random designs", designs, tenth)
    console.print(f"{time.perf_counter() - begin:.0f} s")


def told(console: Console, name: str, designs: list[pp.Case], steps: list[float]) -> None:
    """Print what the judge finds on some designs."""
    found = np.array([judged(design, step) for design, step in zip(designs, steps, strict=True)])
    solves, twice, differing, wrong = found.sum(axis=0)
    console.print(
        f"{name}: {solves / len(designs):.0f} eigen-solves a sweep, {twice} double assignments, "
        f"{wrong} swaps; {differing - wrong} steps in which the coarser judge was wrong"
    )


if __name__ == "__main__":
    main()
