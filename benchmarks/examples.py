"""Makes what docs/examples shows of its scripts: a notebook of each, its picture, and the page that lists them.

python -m benchmarks.examples

A script in the percent format is the example; all else follows from it.
"""

from __future__ import annotations

import runpy
import shutil
import tempfile
import warnings
from contextlib import chdir, redirect_stdout
from io import StringIO
from pathlib import Path

import jupytext
import matplotlib
import nbformat

from benchmarks.pictures import in_few_colours

EXAMPLES = Path(__file__).parents[1] / "docs" / "examples"
PAGE = EXAMPLES / "index.md"
HEAD = """<!-- Written by python -m benchmarks.examples; edit the scripts. -->

# Examples

Whole examples to take and change: a script, the same as a notebook, and the deck where the example has one of its own.
Put the files of an example into a folder, and in an environment with proprotor ([install](../install.md)) run the
script, `python changed-rotor.py`, or open the notebook in Jupyter. An example takes seconds, and draws the picture
below its files.

None of them runs in the browser without installing. Python for browsers, Pyodide 314.0.7 when this was looked up in
December 2026, has NumPy, SciPy and all other compiled packages that proprotor needs, in versions that it takes, but for
psutil, of which there is no build for browsers. The builds of NumPy and SciPy stand on the servers of Pyodide alone and
in neither of the indexes of Python and of JavaScript packages, so that a site that brings all along cannot be made of
these; and no page of this site fetches anything from elsewhere.
"""


def scripts() -> list[Path]:
    """Return the scripts of the examples."""
    return sorted(EXAMPLES.glob("*.py"))


def notebook_of(script: Path) -> str:
    """Return a script as a notebook, without outputs and with the same bytes each time."""
    notebook = jupytext.read(script)
    for place, cell in enumerate(notebook.cells):
        cell["id"] = f"cell-{place}"
    notebook.metadata.pop("jupytext", None)
    return nbformat.writes(notebook, version=nbformat.NO_CONVERT) + "\n"


def run(script: Path, folder: Path) -> str:
    """Run a script in a folder with a copy of the decks, warnings as errors, and return what it prints."""
    matplotlib.use("Agg")
    from matplotlib import pyplot

    for deck in EXAMPLES.glob("*.toml"):
        shutil.copy(deck, folder)
    printed = StringIO()
    with chdir(folder), redirect_stdout(printed), warnings.catch_warnings():
        warnings.simplefilter("error")
        runpy.run_path(str(script), run_name="example")
    pyplot.close("all")
    return printed.getvalue()


def page() -> str:
    """Return the page that lists the examples."""
    blocks = [HEAD]
    for script in scripts():
        title, _, about = jupytext.read(script).cells[0].source.partition("\n")
        decks = [
            deck.name for deck in EXAMPLES.glob("*.toml") if deck.name in script.read_text(encoding="utf-8")
        ]
        files = [script.name, f"{script.stem}.ipynb", *decks]
        links = ", ".join(f"[{name}]({name})" for name in files)
        blocks.append(
            f"#{title}\n\n{about.strip()}\n\n{links}\n\n![{title.lstrip('# ')}]({script.stem}.png)\n"
        )
    return "\n".join(blocks)


def main() -> None:
    for script in scripts():
        script.with_suffix(".ipynb").write_text(notebook_of(script), encoding="utf-8", newline="\n")
        with tempfile.TemporaryDirectory() as folder:
            run(script, Path(folder))
            picture = in_few_colours(Path(folder) / f"{script.stem}.png")
            script.with_suffix(".png").write_bytes(picture)
        print(f"made: {script.stem}")
    PAGE.write_text(page(), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
