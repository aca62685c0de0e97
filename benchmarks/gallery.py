"""Makes the pictures of the pages of docs/ whose code draws them: docs/gallery, docs/pictures and docs/damping.png.

python -m benchmarks.gallery [PAGE ...]
"""

from __future__ import annotations

import contextlib
import re
import sys
import tempfile
import warnings
from collections.abc import Iterator
from pathlib import Path

import matplotlib

from benchmarks.pictures import in_few_colours
from tests.documentation import Runner, blocks, name_of, pages

_SHOWN = re.compile(r"!\[[^\]]*\]\(([^)]+)\)")


def drawn_by(page: Path) -> list[Path]:
    """Return the pictures of a page under names that its code writes, each where the page has it."""
    code = "".join(block.text for block in blocks(page))
    shown = [(page.parent / target).resolve() for target in _SHOWN.findall(page.read_text(encoding="utf-8"))]
    return [
        path
        for path in shown
        if re.search(rf"(--plot |\"){re.escape(path.name)}\b", code) or path.name == _DEMO[-1]
    ]


# README and the first page show what `make` draws.
_DEMO = ("sweep", "xv15", "--speed", "50:400:5kt", "--plot", "damping.png")


def draw(page: Path) -> Iterator[Path]:
    """Run the code of a page in a folder of its own, and put its pictures where the page has them."""
    from click.testing import CliRunner
    from matplotlib import pyplot

    from proprotor.commands.main import main as proprotor

    wanted = drawn_by(page)
    if not wanted:
        return
    with tempfile.TemporaryDirectory() as name, contextlib.chdir(name), warnings.catch_warnings():
        warnings.simplefilter("error")
        runner = Runner(Path(name))
        for block in blocks(page):
            runner.run(block)
        if _DEMO[-1] in (path.name for path in wanted):
            CliRunner().invoke(proprotor, list(_DEMO), catch_exceptions=False)
        pyplot.close("all")
        for path in wanted:
            _keep(Path(name) / path.name, path)
            yield path


def _keep(made: Path, path: Path) -> None:
    """Keep a picture: a GIF as it is, of others few colours."""
    if made.suffix == ".gif":
        path.write_bytes(made.read_bytes())
    else:
        path.write_bytes(in_few_colours(made))


def main() -> None:
    matplotlib.use("Agg")
    for page in pages():
        if sys.argv[1:] and name_of(page) not in sys.argv[1:]:
            continue
        for path in draw(page):
            print(f"{path.stat().st_size / 1024:6.0f} kB  {path.name} of {name_of(page)}", flush=True)


if __name__ == "__main__":
    main()
