"""Every mutant against the checks of its function."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Collection, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context

from tests.mutation.checks import all_checks, checks_of
from tests.mutation.mutants import Mutant, MutatedFunction, generated_functions

_PARCEL = 100  # mutants that a process takes at a time


@dataclass(frozen=True)
class Outcome:
    """A mutant, the largest difference it makes over what is allowed, and the seconds that took."""

    mutant: Mutant
    excess: float
    seconds: float

    @property
    def detected(self) -> bool:
        return self.excess > 1


def survey(processes: int = 2, told: Callable[[int], None] = lambda count: None) -> list[Outcome]:
    """Outcomes of all mutants of all generated functions, in the order of the source.

    `told` hears how many there are so far.

    Raises
    ------
    ValueError
        When a check already fails without any mutant.
    """
    broken = sorted({".".join(check.sees) for check in all_checks() if not check.excess() <= 1})
    if broken:
        raise ValueError(f"no mutant, and yet wrong: {', '.join(broken)}")
    parcels = [
        (module, function, range(start, min(start + _PARCEL, count)))
        for (module, function), count in mutant_counts().items()
        for start in range(0, count, _PARCEL)
    ]
    outcomes: list[Outcome] = []
    with ProcessPoolExecutor(processes, get_context("spawn"), initializer=all_checks) as pool:
        for found in pool.map(outcomes_of, *zip(*parcels, strict=True)):
            outcomes += found
            told(len(outcomes))
    return outcomes


@functools.cache
def mutant_counts() -> dict[tuple[str, str], int]:
    """Number of mutants of each generated function."""
    return {names: sum(1 for _ in MutatedFunction(*names).mutants()) for names in generated_functions()}


def outcomes_of(module: str, function: str, places: Collection[int]) -> list[Outcome]:
    """Of some mutants of a function, by their places in its list."""
    return list(_outcomes(module, function, places))


def _outcomes(module: str, function: str, places: Collection[int]) -> Iterator[Outcome]:
    checks = checks_of((module, function))
    with MutatedFunction(module, function).each(places) as mutants:
        before = time.perf_counter()
        for mutant in mutants:
            excess = 0.0
            for check in checks:
                excess = max(excess, check.excess())
                if excess == float("inf"):
                    break
            now = time.perf_counter()
            yield Outcome(mutant, excess, now - before)
            before = now
