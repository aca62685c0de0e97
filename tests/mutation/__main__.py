"""Make every mutant, and tell which of them nothing sees.

python -m tests.mutation [--processes 2] [--report docs/mutation.md]

Exit code 1 if any survives.
"""

import argparse
import sys
import time
from pathlib import Path

from tests.mutation.report import report
from tests.mutation.survey import mutant_counts, survey


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__.partition("\n")[0])
    parser.add_argument("--processes", type=int, default=2, help="how many work side by side (2)")
    parser.add_argument("--report", type=Path, help="a Markdown file to write")
    given = parser.parse_args()
    start, total = time.perf_counter(), sum(mutant_counts().values())

    def told(count: int) -> None:
        print(f"\r{count} of {total}", end="", file=sys.stderr, flush=True)

    outcomes = survey(given.processes, told)
    page = report(outcomes, time.perf_counter() - start, given.processes)
    if given.report is not None:
        given.report.write_text(page, encoding="utf-8")
    print(file=sys.stderr)
    print(page[page.index("**") :])
    return int(any(not outcome.detected for outcome in outcomes))


if __name__ == "__main__":
    sys.exit(main())
