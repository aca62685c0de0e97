"""Execute the notebooks and write what they show to docs/notebooks.

python -m derive.pages.notebooks                 all of them
python -m derive.pages.notebooks 3-springs       some

A page is the notebook's own text, its code, and the Markdown and pictures of its outputs. `make lab` opens the
notebooks in JupyterLab, where `derive` can be imported and jupytext reads the files as notebooks.
"""

from __future__ import annotations

import asyncio
import base64
import re
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from derive.files import write_whole

if TYPE_CHECKING:
    from nbformat import NotebookNode

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = ROOT / "notebooks"
PAGES = ROOT / "docs" / "notebooks"
TIMEOUT = 300  # s for a cell
FORGET = "# %%\n%reset -f"  # a cell after which the kernel has no names


def sources() -> list[Path]:
    """Return the notebooks in their order."""
    return sorted(NOTEBOOKS.glob("*.py"))


def page_of(source: Path) -> Path:
    """Return the page of a notebook."""
    return PAGES / f"{source.stem}.md"


def executed(chosen: Sequence[Path]) -> list[NotebookNode]:
    """Run notebooks in a kernel of this interpreter, whatever kernels are installed, and return them with outputs.

    They run one after another in one kernel, so that what several of them derive is derived once. A notebook begins
    without the names of those before it.

    Raises
    ------
    nbclient.exceptions.CellExecutionError
        If a cell raises.
    """
    import jupytext
    from jupyter_client.kernelspec import KernelSpecManager
    from jupyter_client.manager import AsyncKernelManager
    from nbclient import NotebookClient

    class OwnKernel(AsyncKernelManager):
        """A kernel of this interpreter, reached over sockets in the file system."""

        def __init__(self, **options: Any) -> None:
            super().__init__(
                transport="ipc", kernel_spec_manager=KernelSpecManager(kernel_dirs=[]), **options
            )

    notebooks: list[NotebookNode] = [jupytext.read(source) for source in chosen]
    together: NotebookNode = jupytext.reads("", "py:percent")
    for notebook in notebooks:
        together.cells += [*jupytext.reads(FORGET, "py:percent").cells, *notebook.cells]
    in_root = {"metadata": {"path": str(ROOT)}}
    client = NotebookClient(
        together, kernel_manager_class=OwnKernel, kernel_name="python3", timeout=TIMEOUT, resources=in_root
    )
    asyncio.run(client.async_execute())  # closes the loop and its sockets at the end
    return notebooks


def rendered(source: Path, notebook: NotebookNode) -> tuple[str, dict[str, bytes]]:
    """Return the page as Markdown, and its pictures by file name."""
    pictures: dict[str, bytes] = {}
    blocks = [
        f"<!-- Written by python -m derive.pages.notebooks from notebooks/{source.name}; edit that. -->"
    ]
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            blocks.append(cell.source)
        elif cell.source:
            blocks.append(f"```python\n{cell.source}\n```")
            blocks += _outputs(cell, source.stem, pictures)
    return "\n\n".join(map(_linked_from_page, blocks)) + "\n", pictures


def _outputs(cell: NotebookNode, stem: str, pictures: dict[str, bytes]) -> Iterator[str]:
    for output in cell.outputs:
        if output.output_type == "stream":
            yield f"```text\n{output.text.rstrip()}\n```"
            continue
        if "image/png" in output.data:
            name = f"{stem}-{len(pictures) + 1}.png"
            pictures[name] = base64.b64decode(output.data["image/png"])
            yield f"![{output.metadata.get('image/png', {}).get('alt', '')}]({name})"
        elif "text/markdown" in output.data:
            yield output.data["text/markdown"]
        else:
            yield f"```text\n{output.data['text/plain']}\n```"


def _linked_from_page(text: str) -> str:
    """Change links to what they are in docs/notebooks: to documents, other notebooks and the rest of the repository."""
    text = text.replace("](../docs/", "](../")
    text = re.sub(r"\]\((\d-[\w-]+)\.py", r"](\1.md", text)
    return re.sub(r"\]\(\.\./(derive|generated|tests)/", r"](../../\1/", text)


def write(source: Path, notebook: NotebookNode) -> None:
    """Write the page and pictures of a notebook that ran, and remove pictures that it no longer has."""
    text, pictures = rendered(source, notebook)
    PAGES.mkdir(parents=True, exist_ok=True)
    for old in PAGES.glob(f"{source.stem}-[0-9]*.png"):
        old.unlink()
    for name, data in pictures.items():
        write_whole(PAGES / name, data)
    write_whole(page_of(source), text)


def main() -> int:
    """Run the command; return 2 for a notebook that does not exist."""
    wanted = sys.argv[1:]
    unknown = set(wanted) - {source.stem for source in sources()}
    if unknown:
        known = ", ".join(source.stem for source in sources())
        print(f"no such notebook: {', '.join(sorted(unknown))}; known: {known}")
        return 2
    chosen = [source for source in sources() if not wanted or source.stem in wanted]
    for source, notebook in zip(chosen, executed(chosen), strict=True):
        write(source, notebook)
        print(f"written: {page_of(source).relative_to(ROOT)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
