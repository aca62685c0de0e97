"""Branches that the tests take, of src and of derive: python -m tests.branch_coverage, after a run under coverage.

Coverage's own percentage counts lines as well; this counts branches alone, and fails below the least share of either.
"""

from __future__ import annotations

import json
import sys
import tempfile
from collections import defaultdict
from pathlib import Path
from typing import NamedTuple

from coverage import Coverage

LEAST = 0.95
WORST = 15  # modules that are told


class Branches(NamedTuple):
    taken: int
    all: int

    @property
    def share(self) -> float:
        return self.taken / self.all if self.all else 1.0

    def told(self, name: str) -> str:
        return f"{100 * self.share:6.1f} %  {self.taken:5} of {self.all:5}  {name}"


def by_module() -> dict[str, Branches]:
    """Branches of each file that was measured."""
    data = Coverage()
    data.load()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "coverage.json")
        data.json_report(outfile=str(file))
        files = json.loads(file.read_text(encoding="utf-8"))["files"]
    return {
        name: Branches(found["summary"]["covered_branches"], found["summary"]["num_branches"])
        for name, found in files.items()
    }


def by_package(modules: dict[str, Branches]) -> dict[str, Branches]:
    """Of src and of derive."""
    sums: dict[str, list[Branches]] = defaultdict(list)
    for name, found in modules.items():
        sums[Path(name).parts[0]].append(found)
    return {name: Branches(*map(sum, zip(*found, strict=True))) for name, found in sorted(sums.items())}


def main() -> None:
    modules = by_module()
    packages = by_package(modules)
    for name, found in sorted(modules.items(), key=lambda item: item[1].taken - item[1].all)[:WORST]:
        print(found.told(name))
    print("branches taken:")
    for name, found in packages.items():
        print(found.told(name))
    low = [name for name, found in packages.items() if found.share < LEAST]
    if low or set(packages) != {"src", "derive"}:
        sys.exit(
            f"less than {100 * LEAST:g} % of the branches of {' and '.join(low) or 'a package'} are tested"
        )


if __name__ == "__main__":
    main()
