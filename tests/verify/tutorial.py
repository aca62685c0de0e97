"""The tutorial with the package that is installed: its blocks run in their order and print what the page shows.

    python -m tests.verify.tutorial                (part of make verify, in an environment that has the wheels alone)

The last line that is printed is the file of the package that ran.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

import proprotor
from tests.documentation import DOCS, Runner, blocks

PAGE = DOCS / "tutorial.md"


def main() -> int:
    """Run the tutorial in a folder of its own."""
    os.environ["MPLBACKEND"] = "Agg"
    with tempfile.TemporaryDirectory() as folder:
        before = os.getcwd()
        os.chdir(folder)
        try:
            runner = Runner(Path(folder))
            for block in blocks(PAGE):
                print(f"line {block.line}: {block.first}", flush=True)
                runner.run(block)
        finally:
            os.chdir(before)
    print(proprotor.__file__)
    return 0


if __name__ == "__main__":
    sys.exit(main())
