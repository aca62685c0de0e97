"""The compiled eigenvalues of adversarial matrices: how far each matrix would have to move to have them exactly.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.eigenvalues --matrices 1000000 --exact 10000 --keep tallies.json

Matrices are those of `tests/compiled/matrices.py`, family after family and of 1 to 64 rows in turn, each batch from a
seed of its own. The backward error of an eigenvalue λ of A is the smallest singular value of A - λ over the norm of A:
a matrix that far away has λ exactly. All eigenvalues of each matrix are taken, of a pair the upper one, and bounded by
inverse iteration (`benchmarks/inverse_iteration.py`); singular values decide where a bound is above what is allowed.
Of one matrix in a hundred, spread over all families and sizes, singular values are computed as well, and each bound is
compared with its singular value. What the compiled functions hand over is counted, not judged: LAPACK's eigenvalues
stand there.

With `--keep` a run that was stopped goes on where it was. The summary of what is done so far is printed each time.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np

from benchmarks.inverse_iteration import bounds_of_singular_values
from proprotor.compiled import eigenvalues as compiled
from proprotor.files.output import write_whole
from proprotor.typing import Array
from tests.compiled.matrices import FAMILIES, divided, normalised

ALLOWED = 1e-14  # of the norm
SIZES = tuple(range(1, 65))
BATCH = 16  # matrices of a family and size: two full vectors at least
_EACH = 20.0  # s between two lines of progress, and two states of the file
_SEED = 2026


@dataclass
class Tally:
    """What was found of a family, as parts of the norm where they are errors.

    matrices, handed_over, missed : numbers of matrices, `missed` of those above what is allowed; exact : matrices of
    which singular values were computed; worst : largest backward error, or bound; below : the most by which a bound
    lies below its singular value.
    """

    matrices: int = 0
    handed_over: int = 0
    exact: int = 0
    missed: int = 0
    worst: float = 0.0
    below: float = 0.0

    def add(self, other: Tally) -> None:
        """Add what was found of more matrices."""
        for field in fields(self):
            own, new = getattr(self, field.name), getattr(other, field.name)
            setattr(self, field.name, own + new if isinstance(own, int) else max(own, new))


# Matrices --------------------------------------------------------------------------------------------


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


# Their backward errors -------------------------------------------------------------------------------


def upper_half(values: Array) -> Array:
    """Return the eigenvalues above the real axis or on it, of all matrices as many as the most have of them."""
    most = int((values.imag >= 0).sum(axis=1).max())
    return np.take_along_axis(values, np.argsort(-values.imag, axis=1, kind="stable")[:, :most], axis=1)


def singular_values(matrices: Array, values: Array) -> Array:
    """Return the smallest singular values (k, m) of A - λ."""
    moved = matrices[:, None] - values[..., None, None] * np.eye(matrices.shape[-1])
    return np.linalg.svd(moved, compute_uv=False)[..., -1]


def judge(number: int, every: int) -> tuple[str, Tally]:
    """Return the family of a batch, and what was found; of one matrix in `every` also by singular values."""
    family, matrices = batch(number)
    served = ~compiled.handed_over(matrices)
    found = Tally(len(matrices), int((~served).sum()))
    if not served.any():
        return family, found
    alike, size = normalised(matrices[served])
    values = upper_half(divided(compiled.eigvals(matrices[served]), size[:, None]))
    norm = np.linalg.norm(alike, axis=(1, 2))
    norm = np.where(norm == 0, 1, norm)
    error = bounds_of_singular_values(alike, values, np.random.default_rng(number)).max(axis=1) / norm
    places = BATCH * number + np.flatnonzero(served)
    exact = (places % every == 0) | ~(error <= ALLOWED)
    if exact.any():
        bound = error[exact]
        error[exact] = singular_values(alike[exact], values[exact]).max(axis=1) / norm[exact]
        found.exact, found.below = int(exact.sum()), float((error[exact] - bound).max())
    found.worst, found.missed = float(error.max()), int((~(error <= ALLOWED)).sum())
    return family, found


# A run -----------------------------------------------------------------------------------------------


@dataclass
class Run:
    """How far a run is: batches done, processor time in s, and what was found of each family."""

    every: int
    done: int
    seconds: float
    families: dict[str, Tally]

    def keep(self, place: Path | None) -> None:
        """Write the state of the run into a file."""
        if place is not None:
            text = json.dumps(asdict(self))
            write_whole(place, lambda file: file.write(text.encode()))

    def go_on(self, batches: int, until: float, place: Path | None) -> None:
        """Judge batches until all are done or the time is over, and keep what was found."""
        told = time.perf_counter()
        while self.done < batches and time.perf_counter() < until:
            start = time.process_time()
            family, found = judge(self.done, self.every)
            self.families.setdefault(family, Tally()).add(found)
            self.seconds, self.done = self.seconds + time.process_time() - start, self.done + 1
            if time.perf_counter() - told > _EACH:
                told = time.perf_counter()
                self.keep(place)
                print(f"{BATCH * self.done} matrices, {self.seconds:.0f} s", file=sys.stderr, flush=True)
        self.keep(place)


def started(place: Path | None, every: int) -> Run:
    """Return the run of a file, or a new one."""
    if place is None or not place.exists():
        return Run(every, 0, 0.0, {})
    kept = json.loads(place.read_text(encoding="utf-8"))
    if kept["every"] != every:
        raise SystemExit(f"{place} is of a run with singular values of one matrix in {kept['every']}")
    return Run(
        every, kept["done"], kept["seconds"], {name: Tally(**one) for name, one in kept["families"].items()}
    )


def table(run: Run) -> str:
    """Return what was found, family by family, and of all."""
    whole = Tally()
    for one in run.families.values():
        whole.add(one)
    lines = [
        "| family | matrices | handed over | worst backward error | above 1e-14 |",
        "|---|---|---|---|---|",
    ]
    for family, one in [*run.families.items(), ("all", whole)]:
        lines.append(f"| {family} | {one.matrices} | {one.handed_over} | {one.worst:.1e} | {one.missed} |")
    lines.append(
        f"\n{whole.exact} matrices by singular values, below which no bound lies by more than {whole.below:.1e}; "
        f"the others by inverse iteration; {run.seconds:.0f} s"
    )
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--matrices", type=int, default=1_000_000)
    parser.add_argument(
        "--exact", type=int, default=10_000, help="matrices whose singular values are computed"
    )
    parser.add_argument("--hours", type=float, default=10.0, help="stop after this time with what is done")
    parser.add_argument("--keep", type=Path, help="file with the state of the run, to go on with")
    given = parser.parse_args()
    run = started(given.keep, max(1, given.matrices // given.exact))
    run.go_on(-(-given.matrices // BATCH), time.perf_counter() + 3600 * given.hours, given.keep)
    print(table(run))


if __name__ == "__main__":
    main()
