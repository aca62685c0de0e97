"""Flutter speeds of random designs by compiled functions, beside those by NumPy: every note, mode and speed.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.compiled_boundaries [--designs 500] [--seed 1]

Designs are a Latin hypercube of the inputs of `benchmarks/study.py`. Both backends search the same scan. What they find
must be the same in every word, and flutter speeds must agree to 1e-9 m/s.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass

import numpy as np

import proprotor as pp
from benchmarks.flutter_cost import SPEEDS
from benchmarks.study import INPUTS
from proprotor import sampling
from proprotor.study.study import study
from proprotor.typing import Dataset

ALLOWED = 1e-9  # m/s, of a flutter speed
_DECK = "xv15-uncoupled"


@dataclass(frozen=True)
class Comparison:
    """What two backends found of some designs.

    designs, with_flutter : numbers of designs, and of those with a flutter speed; differ : by variable, the designs
    whose words are not the same; worst : by variable, the largest difference of numbers, in the unit of the variable.
    """

    designs: int
    with_flutter: int
    differ: dict[str, list[int]]
    worst: dict[str, float]

    @property
    def agrees(self) -> bool:
        """Whether every word is the same, and every flutter speed agrees."""
        return not any(self.differ.values()) and self.worst["flutter_speed"] <= ALLOWED


def found_by(backend: str, designs: int, seed: int, tolerance: float) -> Dataset:
    """Return the flutter speeds of random designs by a backend."""
    inputs = {name: limits for name, limits in INPUTS.items() if name != "airspeed"}
    plan = sampling.latin_hypercube(inputs, designs, seed=seed)
    case = pp.load_case(_DECK)
    return study(
        case, plan, SPEEDS, "flutter", backend=backend, tolerance=tolerance, workers=1, progress=False
    )


def compare(one: Dataset, other: Dataset) -> Comparison:
    """Compare all variables of two studies of the same designs; a number is not to be there in one of them alone."""
    differ: dict[str, list[int]] = {}
    worst: dict[str, float] = {}
    for name, values in one.data_vars.items():
        own, new = values.values, other[name].values
        if np.issubdtype(own.dtype, np.number):
            apart = np.abs(own - new)
            alone = np.isnan(own) != np.isnan(new)
            worst[str(name)] = float(np.max(apart, where=~np.isnan(apart), initial=0.0))
        else:
            alone = own != new
        places = alone.reshape(len(own), -1).any(axis=1) if own.ndim else np.atleast_1d(alone)
        differ[str(name)] = np.flatnonzero(places).tolist()
    count = len(one.flutter_speed)
    return Comparison(count, int(np.isfinite(one.flutter_speed.values).sum()), differ, worst)


def main() -> None:
    """Print the comparison; fail if something differs."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--designs", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--tolerance", type=float, default=1e-10, help="of a flutter speed, m/s")
    given = parser.parse_args()
    both = [
        found_by(backend, given.designs, given.seed, given.tolerance) for backend in ("numpy", "compiled")
    ]
    found = compare(*both)
    print(f"{found.designs} designs, {found.with_flutter} with a flutter speed")
    for name, places in found.differ.items():
        largest = f"; largest difference {found.worst[name]:.1e}" if name in found.worst else ""
        print(f"{name}: {len(places)} designs differ{largest}")
    if not found.agrees:
        sys.exit("the compiled functions find something else")


if __name__ == "__main__":
    main()
