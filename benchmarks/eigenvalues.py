"""The compiled eigenvalues of adversarial matrices: how far each matrix would have to move to have them exactly.

    python -m benchmarks.eigenvalues --matrices 1000000 --exact 10000 --hours 1

Matrices are those of `tests/compiled/matrices.py`, family after family and of 1 to 64 rows in turn, each batch from a
seed of its own. The backward error of an eigenvalue λ of A is the smallest singular value of A - λ over the norm of A:
a matrix that far away has λ exactly. Of the first batches the singular values are computed. Of the others inverse
iteration gives an upper bound of the smallest: |x| / |y| of any y and x = (A - λ) y. For each matrix all eigenvalues
are taken. What the compiled functions hand over is counted, not judged: LAPACK's eigenvalues stand there.
"""

from __future__ import annotations

import argparse
import time
from collections import defaultdict
from dataclasses import dataclass

import numpy as np

from proprotor.compiled import eigenvalues as compiled
from proprotor.typing import Array
from tests.compiled.matrices import FAMILIES, backward_error, normalised

ALLOWED = 1e-14  # of the norm
SIZES = tuple(range(1, 65))
BATCH = 16  # matrices of a family and size: two full vectors at least
STEPS = 4  # of the inverse iteration
_SEED = 2026


@dataclass
class Tally:
    """What was found of a family; `decided` counts the bounds that singular values had to replace."""

    matrices: int = 0
    handed_over: int = 0
    worst: float = 0.0
    missed: int = 0
    decided: int = 0


def bound_on_error(matrices: Array, values: Array, rng: np.random.Generator) -> Array:
    """Return an upper bound of the backward error of each matrix by inverse iteration; NaN where that fails."""
    alike, size = normalised(matrices)
    n = alike.shape[-1]
    norm = np.linalg.norm(alike, axis=(1, 2))
    own = values.real / size[:, None] + 1j * (values.imag / size[:, None])
    upper = own.imag >= 0  # the others are conjugates, of a real matrix
    lane, place = np.nonzero(upper)
    moved = alike[lane] - own[lane, place][:, None, None] * np.eye(n)
    # Moved by rounding, so that hardly a pivot is zero; the bound is of the matrix itself.
    rounding = 6e-16 / np.sqrt(n) * np.where(norm == 0, 1, norm)[lane, None, None]
    solver = moved + rounding * rng.standard_normal(moved.shape)
    y = rng.standard_normal((len(lane), n, 1)) + 0j
    best = np.full(len(lane), np.inf)
    for _ in range(STEPS):
        try:
            y = np.linalg.solve(solver, np.linalg.solve(solver.conj().swapaxes(1, 2), y))
        except np.linalg.LinAlgError:  # a zero pivot all the same
            return np.full(len(matrices), np.nan)
        y /= np.linalg.norm(y, axis=1, keepdims=True)
        best = np.fmin(best, np.linalg.norm(moved @ y, axis=(1, 2)))
    found = np.zeros(len(matrices))
    np.maximum.at(found, lane, best)
    return found / np.where(norm == 0, 1, norm)


def nan_lanes(rng: np.random.Generator, count: int, n: int) -> Array:
    """Return matrices of which every third holds what is no number."""
    found = rng.standard_normal((count, n, n))
    found[::3, n // 2, n // 3] = np.nan
    return found


KINDS = FAMILIES | {"NaN lanes": nan_lanes}


def batch(number: int) -> tuple[str, Array]:
    """Return the family and the matrices of a batch."""
    family, n = list(KINDS)[number % len(KINDS)], SIZES[number // len(KINDS) % len(SIZES)]
    return family, KINDS[family](np.random.default_rng([_SEED, number]), BATCH, n)


def judge(number: int, exact: bool) -> tuple[str, Tally]:
    """Return the family of a batch, and what was found."""
    family, matrices = batch(number)
    served = ~compiled.handed_over(matrices)
    found = Tally(len(matrices), int((~served).sum()))
    if not served.any():
        return family, found
    given = matrices[served]
    values = compiled.eigvals(given)
    if exact:
        error = backward_error(given, values)
    else:
        error = bound_on_error(given, values, np.random.default_rng(number))
        doubtful = ~(error <= ALLOWED)  # the bound may be too high: singular values decide
        if doubtful.any():
            found.decided = int(doubtful.sum())
            error[doubtful] = backward_error(given[doubtful], values[doubtful])
    found.worst, found.missed = float(error.max()), int((~(error <= ALLOWED)).sum())
    return family, found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--matrices", type=int, default=1_000_000)
    parser.add_argument(
        "--exact", type=int, default=10_000, help="matrices whose singular values are computed"
    )
    parser.add_argument("--hours", type=float, default=10.0, help="stop after this time with what is done")
    given = parser.parse_args()
    families: defaultdict[str, Tally] = defaultdict(Tally)
    start, done = time.perf_counter(), 0
    while done < given.matrices and time.perf_counter() - start < 3600 * given.hours:
        family, found = judge(done // BATCH, done < given.exact)
        so_far = families[family]
        so_far.matrices += found.matrices
        so_far.handed_over += found.handed_over
        so_far.missed += found.missed
        so_far.decided += found.decided
        so_far.worst = max(so_far.worst, found.worst)
        done += found.matrices
    print("| family | matrices | handed over | worst backward error | above 1e-14 |")
    print("|---|---|---|---|---|")
    for family, one in families.items():
        print(f"| {family} | {one.matrices} | {one.handed_over} | {one.worst:.1e} | {one.missed} |")
    totals = ("matrices", "handed_over", "missed", "decided")
    total = [sum(getattr(one, name) for one in families.values()) for name in totals]
    worst = max(one.worst for one in families.values())
    print(f"| all | {total[0]} | {total[1]} | {worst:.1e} | {total[2]} |")
    seconds = time.perf_counter() - start
    exact = min(given.exact, done) + total[3]
    print(f"\nOf {exact} matrices by singular values, of the others by inverse iteration; {seconds:.0f} s")


if __name__ == "__main__":
    main()
