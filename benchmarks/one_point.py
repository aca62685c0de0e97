"""What stands between an airspeed and the state matrix, part by part, and what blocks of a rotor are worth.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.one_point

The unit is e, one `numpy.linalg.eigvals` of a state matrix of the XV-15. A part within another is taken off it. Rounds
are interleaved, all of one run: in each round a time is divided by the e of the round, and what is printed is the
median of these ratios. Processor time. The floor of a part is what LAPACK alone takes for it, of the same matrices in
one call.

All without the trim is timed with the trim known beforehand. The parts are timed where they are, each with what the
clock takes, and after a trim that leaves little of them in the caches of the core.

The last line has eigenvalues of a rotor of eight blades with its reactionless motions, in blocks that do not couple and
as one problem.
"""

from __future__ import annotations

import platform
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from importlib import import_module
from unittest import mock

import numpy as np
from rich.console import Console
from rich.table import Table

import proprotor as pp
from benchmarks.peers.cost import BATCHES, seconds
from benchmarks.study import Stopwatch
from proprotor.model import configuration
from proprotor.model.first_order import state_matrix
from proprotor.stability.modes import eigenvalues

rotor_model = import_module("proprotor.model.rotor_model")  # the package has a function by this name
ROUNDS = {1: 9, 100: 9, 10_000: 7}
CALLS = {1: 100, 100: 5, 10_000: 1}  # of `linearize` in a round
LAPACK_CALLS = 200  # matrices of e in a round
TRIM, ROTOR, MOUNT, STATES = "trim", "matrices of the rotor", "rotor on its support", "state matrix"
REST = "all else: numbers, shapes, checks, records"
OUTSIDE = "all without the trim"
ASKED = {1: 4.0, 100: 0.5, 10_000: 0.25}  # e a point; of a batch that of rotor, support and state matrix
BLADES, ASKED_OF_BLOCKS = 8, 0.4


def kernel() -> str:
    """NumPy's version, its BLAS and the machine."""
    blas = np.show_config(mode="dicts")["Build Dependencies"]["blas"]
    name = blas.get("openblas configuration", blas.get("name", "unknown"))
    return f"numpy {np.__version__}, {name}; {platform.machine()}, Python {platform.python_version()}"


@contextmanager
def watched() -> Iterator[Stopwatch]:
    """Time of the parts of `linearize`."""
    watch = Stopwatch()
    places = {
        TRIM: (rotor_model, "solve_trim"),
        ROTOR: (rotor_model.fused, "rotor_matrices"),
        MOUNT: (configuration, "mount"),
    }
    with ExitStack() as patches:
        for part, (owner, name) in places.items():
            patches.enter_context(mock.patch.object(owner, name, watch.timed(part, getattr(owner, name))))
        yield watch


def parts(case: pp.Case, airspeed: float | np.ndarray, calls: int) -> dict[str, float]:
    """Seconds of each part of one way from the airspeed to the state matrix."""
    with watched() as watch:
        linearize, states = watch.timed(REST, case.linearize), watch.timed(STATES, state_matrix)
        for _ in range(calls):
            states(linearize(airspeed))
    return {part: watch.spent[part] / calls for part in (TRIM, ROTOR, MOUNT, STATES, REST)}


@contextmanager
def known_trim() -> Iterator[None]:
    """Find a trim once and give it again and again."""
    genuine, found = rotor_model.solve_trim, []

    def again(*given: object, **named: object) -> object:
        if not found:
            found.append(genuine(*given, **named))
        return found[0]

    with mock.patch.object(rotor_model, "solve_trim", again):
        yield


def floors(case: pp.Case, airspeed: float | np.ndarray) -> dict[str, Callable[[], object]]:
    """What LAPACK alone does in two of the parts: the mass check, and the solution of the linear equations."""
    model = case.linearize(airspeed)
    held = [place for place, name in enumerate(model.dofs) if name not in model.azimuths]
    loads = np.concatenate([model.K[..., held], model.C], axis=-1)
    return {MOUNT: lambda: np.linalg.cholesky(model.M), STATES: lambda: np.linalg.solve(model.M, loads)}


def one_size(case: pp.Case, count: int) -> tuple[dict[str, float], dict[str, float]]:
    """Parts and floors of a batch of so many points, e a point."""
    airspeed = 120.0 if count == 1 else np.linspace(80.0, 180.0, count)
    matrices = np.repeat(state_matrix(case.linearize(120.0))[None], LAPACK_CALLS, axis=0)
    least = floors(case, airspeed)
    found, lapack = defaultdict(list), defaultdict(list)
    calls = CALLS[count]
    for _ in range(ROUNDS[count]):
        e = seconds(lambda: np.linalg.eigvals(matrices), 1) / LAPACK_CALLS * count
        for part, spent in parts(case, airspeed, calls).items():
            found[part].append(spent / e)
        with known_trim():
            state_matrix(case.linearize(airspeed))
            outside = seconds(lambda: state_matrix(case.linearize(airspeed)), calls) / calls
        found[OUTSIDE].append(outside / e)
        for part, work in least.items():
            lapack[part].append(seconds(work, calls) / calls / e)
    return tuple({part: float(np.median(all_)) for part, all_ in each.items()} for each in (found, lapack))


def print_parts(console: Console, case: pp.Case) -> None:
    """Print every part at every size of a batch."""
    columns = [f"{count} {title}" for count in BATCHES for title in ("", "floor")]
    table = Table("e a point", *columns)
    sizes = [one_size(case, count) for count in BATCHES]
    for part in (TRIM, ROTOR, MOUNT, STATES, REST, OUTSIDE):
        numbers = [f"{each[part]:.3f}" if part in each else "" for size in sizes for each in size]
        table.add_row(part, *numbers)
    console.print(table)
    for count, (found, _) in zip(BATCHES, sizes, strict=True):
        three = found[ROTOR] + found[MOUNT] + found[STATES]
        reached, what = (
            (found[OUTSIDE], OUTSIDE) if count == 1 else (three, "rotor, support and state matrix")
        )
        console.print(f"{count} points, {what}: {reached:.3f} e a point, asked {ASKED[count]}")


def print_blocks(console: Console, case: pp.Case) -> None:
    """Print what eigenvalues of a rotor with reactionless motions cost, in blocks and joined."""
    case = replace(case, rotor=replace(case.rotor, n_blades=BLADES))
    model = case.linearize(np.linspace(80.0, 140.0, 200), reactionless=True)
    joined = replace(model, apart=())
    assert model.massless.sum() == joined.massless.sum() == 0  # checked before the clock starts
    ratios = [
        seconds(lambda: eigenvalues(model), 1) / seconds(lambda: eigenvalues(joined), 1)
        for _ in range(ROUNDS[1])
    ]
    sizes = " + ".join(str(len(block)) for block in model.blocks)
    console.print(
        f"{BLADES} blades, eigenvalues of blocks of {sizes} coordinates / of all together: "
        f"{np.median(ratios):.3f}, asked {ASKED_OF_BLOCKS}"
    )


def main() -> None:
    """Print all of it."""
    console, case = Console(width=120, highlight=False), pp.load_case("xv15")
    console.print(kernel())
    print_parts(console, case)
    print_blocks(console, case)


if __name__ == "__main__":
    main()
